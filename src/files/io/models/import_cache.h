// SPDX-License-Identifier: Apache-2.0
// Answers of frontmost-import that are kept in the user's cache folder, so that a CAD file is tessellated once.
#pragma once

#include <time.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "io/models/import_answer.h"

namespace frontmost {

class ImportCache {
 public:
  /// Greatest size of all entries together. The entries that were used least recently go first.
  static constexpr std::uint64_t most_bytes = std::uint64_t(1) << 30;
  /// Share of the cache that one entry may take.
  static constexpr std::uint64_t greatest_share = 4;

  /// $XDG_CACHE_HOME/frontmost/import or ~/.cache/frontmost/import; empty if the environment names neither.
  [[nodiscard]] static std::filesystem::path folder_of_user();

  /// `words`: the program and its words. `model`, borrowed: the bytes that it reads. Make it before the program starts.
  ImportCache(std::filesystem::path folder, const std::vector<std::string>& words, Bytes model,
              std::uint64_t most = most_bytes);

  /// Returns the frames of an answer to the same words about the same bytes, in an environment that loads the same
  /// libraries, if the importer's files are unchanged; else nothing. The frames are as untrusted as an importer's.
  [[nodiscard]] std::optional<std::vector<std::byte>> find() const;
  /// Keeps an answer that names all of the importer's files; another answer may be different the next time. Nothing is
  /// kept if a file changed after this object was made, or if the folder cannot be used.
  void keep(const ImportAnswer& answer) const;

 private:
  void write(const ImportAnswer& answer) const;
  [[nodiscard]] std::optional<std::uint64_t> state_of(const std::vector<std::string>& files, bool are_old) const;
  void make_room(std::uint64_t bytes) const;

  std::filesystem::path folder_;  ///< empty: nothing can be kept
  std::string program_, question_;
  timespec start_{};
  Bytes model_;
  std::uint64_t most_;
  std::filesystem::path entry_;
};

}  // namespace frontmost
