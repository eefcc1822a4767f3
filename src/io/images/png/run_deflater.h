// SPDX-License-Identifier: Apache-2.0
// Deflate for filtered rows of rendered pictures: runs of one byte, and Huffman codes made for each 64 KiB.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "frontmost/base.h"

namespace frontmost::detail {

/// Compresses pieces of one deflate stream (RFC 1951), each by itself. The bytes depend on the piece alone, on every
/// machine. What it needs is kept for the next piece.
class RunDeflater {
 public:
  explicit RunDeflater(std::size_t most_bytes);

  /// Compresses 1 to `most_bytes` bytes. What comes out ends on a byte, so that pieces can be strung together; `last`
  /// ends the stream. What is returned lies here until the next call.
  [[nodiscard]] std::span<const std::uint8_t> compress(std::span<const std::uint8_t> raw, bool last);

 private:
  Buffer<std::uint16_t> tokens_;
  Buffer<std::uint8_t> out_;
};

}  // namespace frontmost::detail
