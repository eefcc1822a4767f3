// SPDX-License-Identifier: Apache-2.0
// Reads pixels from the memory of the client.
#pragma once

#include <memory>

#include "pixels/formats.h"

namespace frontmost::gl_detail {

/// An image in the memory of the client, or a copy of it in a display list.
struct ClientImage {
  PixelStore store;
  ImageShape shape;
  const void* pixels = nullptr;
  std::shared_ptr<const std::vector<std::uint8_t>> kept;
  bool is_lost = false;  ///< there was no memory for the copy

  /// Copies the pixels, which may change or go after the call.
  void keep();
};

/// \returns colors as in Frame, depths of 24 bits or stencil values, row by row from the bottom, after the transfer
/// operations; nothing if memory cannot be had, or if the format has an error. Without pixels in memory all are 0.
[[nodiscard]] std::optional<std::vector<std::uint32_t>> unpack(const ClientImage& image, const Transfer& transfer);

/// \returns 0 or 1 for each pixel, row by row from the bottom; nothing if memory cannot be had.
[[nodiscard]] std::optional<std::vector<std::uint8_t>> unpack_bitmap(const PixelStore& store, int width, int height,
                                                                     const GLubyte* bits);

}  // namespace frontmost::gl_detail
