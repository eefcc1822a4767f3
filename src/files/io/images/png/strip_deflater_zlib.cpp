// SPDX-License-Identifier: Apache-2.0
// StripDeflater by zlib, for builds without ISA-L.
#include <new>

#include "frontmost/base.h"
#include "io/images/png/strip_deflater.h"
#include "io/images/png/zlib_piece.h"

namespace frontmost::detail {
namespace {

/// zlib's bound for any settings, plus room for the empty block of a flush.
std::size_t worst_case(std::size_t raw) { return ::deflateBound(nullptr, uLong(raw)) + 64; }

}  // namespace

struct StripDeflater::State {
  z_stream stream{};
  Buffer<std::uint8_t> out;
};

// Z_RLE suits filtered rendered pictures, which have runs but few repeated strings. Measured at 1920 x 1080 RGB, one
// thread, level 1: a picture with noise in it 54 ms and 3.4 MB by the default strategy, 38 ms and 2.9 MB by Z_RLE; pure
// noise 90 ms against 28.
StripDeflater::StripDeflater(std::size_t most_bytes) : state_(std::make_unique<State>()) {
  constexpr int level = 1, raw_window_bits = -15, memory = 8;
  if (::deflateInit2(&state_->stream, level, Z_DEFLATED, raw_window_bits, memory, Z_RLE) != Z_OK)
    throw std::bad_alloc();
  state_->out = Buffer<std::uint8_t>(worst_case(most_bytes));
}

StripDeflater::~StripDeflater() { ::deflateEnd(&state_->stream); }

std::span<const std::uint8_t> StripDeflater::compress(std::span<const std::uint8_t> raw, bool last) {
  return deflate_piece(state_->stream, raw, last, state_->out);
}

std::uint32_t crc32_of(std::span<const std::uint8_t> bytes) {
  return std::uint32_t(::crc32(0, bytes.data(), uInt(bytes.size())));
}

std::uint32_t adler32_of(std::span<const std::uint8_t> bytes) {
  return std::uint32_t(::adler32(1, bytes.data(), uInt(bytes.size())));
}

}  // namespace frontmost::detail
