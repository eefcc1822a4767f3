// SPDX-License-Identifier: Apache-2.0
// URIs of a glTF file: data that they hold themselves, or the name of a file beside the model.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "io/models/gltf/json.h"

namespace frontmost::gltf {

[[nodiscard]] bool is_data_uri(std::string_view uri);
/// The bytes of "data:[TYPE][;base64],...". `place` is the value that holds the URI.
[[nodiscard]] std::vector<std::byte> decode_data_uri(std::string_view uri, const JsonValue& place);
/// %20 and the like to bytes; what is not an escape stays.
[[nodiscard]] std::string percent_decode(std::string_view text);

}  // namespace frontmost::gltf
