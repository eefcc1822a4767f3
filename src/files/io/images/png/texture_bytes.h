// SPDX-License-Identifier: Apache-2.0
// Textures to PNG, for model files that embed them.
#pragma once

#include <string>

#include "frontmost/scene.h"

namespace frontmost::detail {

/// A whole PNG, 8 bits a channel with alpha. \throws Error limit_exceeded if PNG cannot hold the size; unsupported in a
/// build without libpng.
[[nodiscard]] std::string png_bytes(const Texture& texture);

}  // namespace frontmost::detail
