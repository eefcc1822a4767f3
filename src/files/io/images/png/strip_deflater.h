// SPDX-License-Identifier: Apache-2.0
// The parts of a compression library that PNG files need: deflate in pieces, and two checksums.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace frontmost::detail {

/// Compresses pieces of one deflate stream (RFC 1951), each by itself. The bytes depend on the piece, the library and
/// the code that it selects for this processor, but not on earlier pieces or the process. Memory is kept for the next
/// piece.
class StripDeflater {
 public:
  explicit StripDeflater(std::size_t most_bytes);
  ~StripDeflater();
  StripDeflater(const StripDeflater&) = delete;
  StripDeflater& operator=(const StripDeflater&) = delete;

  /// Compresses 1 to `most_bytes` bytes. The result ends on a byte and refers to nothing before it, so that pieces can
  /// be joined. `last` ends the stream. The result lies in this object until the next call.
  [[nodiscard]] std::span<const std::uint8_t> compress(std::span<const std::uint8_t> raw, bool last);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Returns the CRC-32 that PNG's chunks need.
[[nodiscard]] std::uint32_t crc32_of(std::span<const std::uint8_t> bytes);

/// Returns the Adler-32 that the zlib stream needs.
[[nodiscard]] std::uint32_t adler32_of(std::span<const std::uint8_t> bytes);

}  // namespace frontmost::detail
