// SPDX-License-Identifier: Apache-2.0
// Textures as PNG, for model files that hold them.
#pragma once

#include <string>

#include "frontmost/scene.h"

namespace frontmost::detail {

/// A whole PNG, 8 bits a channel with alpha. \throws Error limit_exceeded for what PNG cannot hold; unsupported in a
/// build without libpng.
[[nodiscard]] std::string png_bytes(const Texture& texture);

}  // namespace frontmost::detail
