// SPDX-License-Identifier: Apache-2.0
// The outer shape of a glTF file: plain JSON text, or the chunks of a GLB.
#pragma once

#include <span>
#include <string_view>

#include "io/models/model_source.h"

namespace frontmost::gltf {

struct Container {
  std::string_view json;
  std::span<const std::byte> binary;  ///< the BIN chunk
  bool has_binary = false;
  bool is_glb = false;
};

/// Borrows `bytes`. Bytes after a GLB's stated length are passed over, chunks of unknown types too, as the format asks.
[[nodiscard]] Container open_container(std::span<const std::byte> bytes, const ModelSource& source);

}  // namespace frontmost::gltf
