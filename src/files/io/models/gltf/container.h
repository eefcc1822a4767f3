// SPDX-License-Identifier: Apache-2.0
// The container of a glTF file: plain JSON text, or the chunks of a GLB. Also its URIs, which hold data or name a file
// beside the model.
//
//   GLB   | "glTF" | 2 | length |   | size | "JSON" | text ... |   | size | "BIN" | bytes ... |   | others
//           12 bytes                  8 bytes                        8 bytes; may be missing         passed over
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/models/gltf/json.h"
#include "io/models/model_source.h"

namespace frontmost::gltf {

struct Container {
  std::string_view json;
  std::span<const std::byte> binary;  ///< the BIN chunk
  bool has_binary = false;
  bool is_glb = false;
};

/// Borrows `bytes`. Skips bytes behind a GLB's stated length, and chunks of unknown types, as the format requires.
[[nodiscard]] Container open_container(std::span<const std::byte> bytes, const ModelSource& source);

[[nodiscard]] bool is_data_uri(std::string_view uri);
/// Decodes "data:[TYPE][;base64],...". `place` is the value that holds the URI.
[[nodiscard]] std::vector<std::byte> decode_data_uri(std::string_view uri, const JsonValue& place);
/// Decodes %20 and the like; text that is no valid escape stays.
[[nodiscard]] std::string percent_decode(std::string_view text);

}  // namespace frontmost::gltf
