// SPDX-License-Identifier: Apache-2.0
// The answer of frontmost-import, taken from the bytes that it sends, which may be anything.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/models/import_frames.h"
#include "io/models/reader.h"

namespace frontmost {

struct ImportAnswer {
  static constexpr std::size_t most_files = 1024;

  std::vector<std::byte> model;       ///< binary glTF
  std::vector<std::string> warnings;  ///< as they are sent
  std::vector<std::string> files;     ///< as they are sent; more than `most_files`: there are others
  std::string space;                  ///< the last one that is sent
  bool has_ended = false;
};

class ImportReceiver {
 public:
  /// `most_bytes`: greatest size of the model.
  ImportReceiver(const ModelSource& source, std::uint64_t most_bytes) : source_(source), most_bytes_(most_bytes) {}

  /// Takes the whole frames at the start of `bytes`, and removes them. Reports progress.
  /// \throws Error file_malformed for an error that is sent, and for frames of unknown kinds or sizes.
  void take(std::vector<std::byte>& bytes);

  ImportAnswer answer;

 private:
  void take(import_frames::Kind kind, std::string_view text);

  const ModelSource& source_;
  const std::uint64_t most_bytes_;
};

/// The scene of a whole answer.
[[nodiscard]] Scene scene_of(const ImportAnswer& answer, const ModelSource& source);

}  // namespace frontmost
