// SPDX-License-Identifier: Apache-2.0
// Answers of frontmost-import that are kept in the user's cache folder, so that a CAD file is tessellated once.
#pragma once

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

  /// `question`: the program and its words. `model`, borrowed: the bytes that it reads. An empty folder keeps nothing.
  ImportCache(std::filesystem::path folder, std::string question, Bytes model, std::uint64_t most = most_bytes);

  /// Returns the frames of an answer to the same question about the same bytes, by the same version of the importer and
  /// its libraries; nothing if there is none. The frames are as untrusted as those of an importer.
  [[nodiscard]] std::optional<std::vector<std::byte>> find() const;
  /// Keeps an answer that names the importer's files; another answer may be different the next time. Whatever prevents
  /// this is passed over.
  void keep(const ImportAnswer& answer) const;

 private:
  [[nodiscard]] bool has_safe_folder() const;
  void make_room(std::uint64_t bytes) const;

  std::filesystem::path folder_;
  std::string question_;
  Bytes model_;
  std::uint64_t most_;
  std::filesystem::path entry_;
};

}  // namespace frontmost
