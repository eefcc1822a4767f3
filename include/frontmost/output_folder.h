// SPDX-License-Identifier: Apache-2.0
// Several files that belong together: all of them are there, or none.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace frontmost {

/// Makes a folder and those that lead to it, where they are missing. The destructor removes the folders that this
/// object made, if they are empty.
class MadeFolder {
 public:
  /// \throws Error file_unwritable where the folder cannot be made or is something else.
  explicit MadeFolder(const std::string& folder);
  ~MadeFolder();
  MadeFolder(const MadeFolder&) = delete;
  MadeFolder& operator=(const MadeFolder&) = delete;

 private:
  std::vector<std::filesystem::path> made_;  ///< the outermost first
};

/// A hidden folder within another, gone with this, for files on their way there.
class StagedFolder {
 public:
  /// \throws Error file_unwritable.
  explicit StagedFolder(const std::string& folder);
  ~StagedFolder();
  StagedFolder(const StagedFolder&) = delete;
  StagedFolder& operator=(const StagedFolder&) = delete;

  /// Where the file of this name is to be written.
  [[nodiscard]] std::string path(const std::string& name) const { return (staged_ / name).string(); }
  /// A message about one of the files, with the name that the file is to have.
  [[nodiscard]] std::string told(const std::string& message) const;
  /// Moves the files to their places, in this order; they need no more room there. Those that were there are replaced,
  /// those at the end of links too, and leave their permissions. \throws Error file_unwritable.
  void commit(const std::vector<std::string>& names) const;

 private:
  std::filesystem::path folder_, staged_;
};

}  // namespace frontmost
