// SPDX-License-Identifier: Apache-2.0
// What a PNG file takes from a compression library: deflate in pieces, and two checksums. ISA-L gives them where the
// build has it (strip_deflater_isal.cpp), else zlib does (strip_deflater_zlib.cpp).
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace frontmost::detail {

/// Compresses pieces of one deflate stream (RFC 1951), each by itself. The bytes depend on the piece, on the library
/// and on what that does on this processor, never on the pieces before or on the process. What it needs is kept for the
/// next piece.
class StripDeflater {
 public:
  explicit StripDeflater(std::size_t most_bytes);
  ~StripDeflater();
  StripDeflater(const StripDeflater&) = delete;
  StripDeflater& operator=(const StripDeflater&) = delete;

  /// Compresses 1 to `most_bytes` bytes. What comes out ends on a byte and refers to nothing before it, so that pieces
  /// can be strung together; `last` ends the stream. What is returned lies here until the next call.
  [[nodiscard]] std::span<const std::uint8_t> compress(std::span<const std::uint8_t> raw, bool last);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// CRC-32 as PNG's chunks have it.
[[nodiscard]] std::uint32_t crc32_of(std::span<const std::uint8_t> bytes);

/// Adler-32 as the zlib stream has it.
[[nodiscard]] std::uint32_t adler32_of(std::span<const std::uint8_t> bytes);

}  // namespace frontmost::detail
