// SPDX-License-Identifier: Apache-2.0
// Output files that are complete or absent.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

namespace frontmost {

/// A file being written. Until commit() nothing is visible at its place, and an existing file stays as it is.
/// Destruction without commit() leaves no trace.
///
/// If the file system can (O_TMPFILE), the bytes go to a file without a name, so that even a killed process leaves
/// nothing behind; otherwise to a hidden file beside the target. Symbolic links are followed: the file that they lead
/// to is replaced, not the link. A replaced file's permissions are kept; those of a new file follow the umask. "-" is
/// standard output. Standard output, devices and pipes are written to directly.
class OutputFile {
 public:
  enum class Staging { best, named };

  /// \throws Error file_unwritable, as all member functions do.
  /// `permissions`: those of a new file, less the umask.
  explicit OutputFile(const std::string& path, Staging staging = Staging::best, unsigned permissions = 0666);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  void write(std::span<const std::byte> bytes);
  void commit();

  /// The file's name in messages.
  [[nodiscard]] const std::string& name() const { return name_; }

 private:
  enum class Kind { standard_output, direct, unnamed, named };

  [[noreturn]] void fail(const char* doing) const;
  bool open_unnamed();
  void open_named();
  void give_name();

  std::string name_;
  std::filesystem::path target_;
  std::filesystem::path temporary_;  ///< path of the temporary file; empty if there is none
  std::optional<unsigned> mode_;     ///< permissions of the file that is replaced
  const unsigned new_mode_;          ///< permissions of a new file
  Kind kind_ = Kind::direct;
  int descriptor_ = -1;
};

}  // namespace frontmost
