// SPDX-License-Identifier: Apache-2.0
// StripDeflater by Intel's ISA-L, which takes at most a quarter of the time of zlib with Z_RLE, or by zlib alone if
// FRONTMOST_DEFLATES_BY_ZLIB is defined.
#include "io/images/png/strip_deflater.h"

#include <zlib.h>

#include <algorithm>
#include <new>
#include <stdexcept>

#include "frontmost/base.h"

#if !defined(FRONTMOST_DEFLATES_BY_ZLIB)
#include <isa-l/crc.h>
#include <isa-l/igzip_lib.h>
#if defined(__x86_64__)
#include <immintrin.h>
#endif
#endif

namespace frontmost::detail {
namespace {

/// Compresses a piece by itself into `out`, which has room for the worst case. \returns the part of `out` that was
/// filled.
std::span<const std::uint8_t> deflate_piece(z_stream& stream, std::span<const std::uint8_t> raw, bool last,
                                            Buffer<std::uint8_t>& out) {
  ::deflateReset(&stream);
  stream.next_in = const_cast<Bytef*>(raw.data());  // zlib does not write to it
  stream.avail_in = uInt(raw.size());
  stream.next_out = out.data();
  stream.avail_out = uInt(out.size());
  ::deflate(&stream, last ? Z_FINISH : Z_FULL_FLUSH);
  return {out.data(), stream.total_out};
}

/// Prepares a deflate stream without zlib's header.
void init_deflate(z_stream& stream, int level, int strategy) {
  constexpr int raw_window_bits = -15, memory = 8;
  if (::deflateInit2(&stream, level, Z_DEFLATED, raw_window_bits, memory, strategy) != Z_OK) throw std::bad_alloc();
}

}  // namespace

#if defined(FRONTMOST_DEFLATES_BY_ZLIB)

struct StripDeflater::State {
  z_stream stream{};
  Buffer<std::uint8_t> out;
};

// Z_RLE suits filtered rendered pictures, which have runs but few repeated strings. Measured at 1920 x 1080 RGB, one
// thread, level 1: a picture with noise in it 54 ms and 3.4 MB by the default strategy, 38 ms and 2.9 MB by Z_RLE; pure
// noise 90 ms against 28.
StripDeflater::StripDeflater(std::size_t most_bytes) : state_(std::make_unique<State>()) {
  init_deflate(state_->stream, 1, Z_RLE);
  // zlib's bound holds for any settings; the empty block of a flush needs some more bytes.
  state_->out = Buffer<std::uint8_t>(::deflateBound(nullptr, uLong(most_bytes)) + 64);
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

#else

namespace {

/// Level 0 has fixed Huffman codes: files of rendered pictures, depths and ids become a fifth larger to twice as large,
/// and little time is saved. Level 2 takes up to a sixth longer and saves less than a hundredth of the size. Level 3
/// takes half as long again to twenty times as long, for about the same size. Figures: docs/performance.md.
constexpr std::uint32_t deflate_level = 1;
constexpr std::size_t level_memory_size = ISAL_DEF_LVL1_DEFAULT;

/// Number of bytes below which a piece is compressed by zlib instead. In about one process of a hundred, ISA-L 2.30
/// packs small pictures into different, though valid, bytes. Differences occurred up to 2 kB, and in none of 8400
/// pieces from 3 kB on.
constexpr std::size_t small_piece = 8192;

/// Returns the most bytes that `raw` bytes can become. Bytes that do not shrink are stored in blocks of 65535, each
/// with five more bytes.
std::size_t worst_case(std::size_t raw) { return raw + 5 * (raw / 65535 + 1); }

/// ISA-L's assembly leaves the upper halves of the vector registers in use. Until they are cleared, any SSE code of the
/// thread takes up to three times as long: saving a 16-bit picture took 76 ms instead of 40.
#if defined(__x86_64__)
[[gnu::target("avx")]] void zero_upper_halves() { _mm256_zeroupper(); }
void free_upper_halves() {
  if (__builtin_cpu_supports("avx")) zero_upper_halves();
}
#else
void free_upper_halves() {}
#endif

}  // namespace

struct StripDeflater::State {
  isal_zstream stream{};
  z_stream small{};
  Buffer<std::uint8_t> level_memory{level_memory_size}, out;
};

StripDeflater::StripDeflater(std::size_t most_bytes) : state_(std::make_unique<State>()) {
  init_deflate(state_->small, 6, Z_DEFAULT_STRATEGY);
  state_->out = Buffer<std::uint8_t>(std::max(worst_case(most_bytes), ::deflateBound(nullptr, small_piece) + 64));
}

StripDeflater::~StripDeflater() { ::deflateEnd(&state_->small); }

std::span<const std::uint8_t> StripDeflater::compress(std::span<const std::uint8_t> raw, bool last) {
  if (raw.size() < small_piece) return deflate_piece(state_->small, raw, last, state_->out);
  isal_zstream& stream = state_->stream;
  ::isal_deflate_stateless_init(&stream);
  stream.level = deflate_level;
  stream.level_buf = state_->level_memory.data();
  stream.level_buf_size = std::uint32_t(state_->level_memory.size());
  stream.next_in = const_cast<std::uint8_t*>(raw.data());  // ISA-L does not write to it
  stream.avail_in = std::uint32_t(raw.size());
  stream.next_out = state_->out.data();
  stream.avail_out = std::uint32_t(state_->out.size());
  stream.end_of_stream = last;
  stream.flush = last ? NO_FLUSH : FULL_FLUSH;
  const int status = ::isal_deflate_stateless(&stream);
  free_upper_halves();
  if (status != COMP_OK) throw std::logic_error("ISA-L does not compress");
  return {state_->out.data(), stream.total_out};
}

std::uint32_t crc32_of(std::span<const std::uint8_t> bytes) {
  const std::uint32_t sum = ::crc32_gzip_refl(0, bytes.data(), bytes.size());
  free_upper_halves();
  return sum;
}

std::uint32_t adler32_of(std::span<const std::uint8_t> bytes) {
  const std::uint32_t sum = ::isal_adler32(1, bytes.data(), bytes.size());
  free_upper_halves();
  return sum;
}

#endif

}  // namespace frontmost::detail
