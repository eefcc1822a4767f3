// SPDX-License-Identifier: Apache-2.0
// Writes pixels into the memory of the client.
#pragma once

#include "pixels/formats.h"

namespace frontmost::gl_detail {

/// An image in the memory of the client that is written.
struct ClientTarget {
  PixelStore store;
  ImageShape shape;
  void* pixels = nullptr;
};

/// Rows of words as the planes of a Frame: colors, or depth << 8 | stencil.
struct WordRows {
  const std::uint32_t* words = nullptr;  ///< of the first pixel of the part
  std::size_t stride = 0;
  WindowRect part;  ///< the pixels of the client's image that are written; all others stay
};

/// Writes after the transfer operations. The words are those of the color plane or of the other one, by the format.
/// \returns false if memory cannot be had, or if the format has an error.
[[nodiscard]] bool pack(const WordRows& rows, const Transfer& transfer, const ClientTarget& target);

}  // namespace frontmost::gl_detail
