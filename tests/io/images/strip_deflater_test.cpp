// SPDX-License-Identifier: Apache-2.0
// zlib unpacks the compressed data, and checksums are compared with zlib's. If ISA-L compresses, these tests are built
// a second time with zlib in its place.
#include "io/images/png/strip_deflater.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <random>
#include <vector>

#include "support/seeds.h"

#if defined(__x86_64__)
#include <cpuid.h>
#include <immintrin.h>
#endif

namespace frontmost::test {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes random_bytes(std::size_t count, unsigned seed, unsigned different) {
  std::mt19937 random(test::noted_seed(seed));
  Bytes bytes(count);
  for (std::uint8_t& byte : bytes) byte = std::uint8_t(random() % different);
  return bytes;
}

/// Runs of all lengths, mostly short, of few byte values.
Bytes random_runs(std::size_t count, unsigned seed) {
  std::mt19937 random(test::noted_seed(seed));
  Bytes bytes;
  while (bytes.size() < count)
    bytes.insert(bytes.end(), std::min<std::size_t>(count - bytes.size(), 1 + (random() % 700 >> random() % 10)),
                 std::uint8_t(random() % 5));
  return bytes;
}

/// Bytes as a PNG filter leaves them for a smooth picture: small steps up and down.
Bytes small_steps(std::size_t count) {
  std::mt19937 random(test::noted_seed(3));
  std::normal_distribution<double> step(0, 3);
  Bytes bytes(count);
  for (std::uint8_t& byte : bytes) byte = std::uint8_t(int(step(random)));
  return bytes;
}

Bytes compressed(detail::StripDeflater& deflater, const Bytes& raw, bool last) {
  const auto packed = deflater.compress(raw, last);
  return {packed.begin(), packed.end()};
}

Bytes compressed(const Bytes& raw, bool last) {
  detail::StripDeflater deflater(raw.size());
  return compressed(deflater, raw, last);
}

/// A raw stream of `count` bytes unpacked by zlib, and whether zlib reached the stream's end.
struct Inflated {
  Bytes bytes;
  bool ends = false;
};
Inflated inflate_raw(const Bytes& packed, std::size_t count) {
  Inflated result{Bytes(count + 1), false};
  z_stream stream{};
  EXPECT_EQ(::inflateInit2(&stream, -15), Z_OK);
  stream.next_in = const_cast<Bytef*>(packed.data());
  stream.avail_in = uInt(packed.size());
  stream.next_out = result.bytes.data();
  stream.avail_out = uInt(result.bytes.size());
  const int status = ::inflate(&stream, Z_SYNC_FLUSH);
  EXPECT_TRUE(status == Z_OK || status == Z_STREAM_END) << (stream.msg ? stream.msg : "");
  EXPECT_EQ(stream.avail_in, 0u) << "nothing is left over";
  result.ends = status == Z_STREAM_END;
  result.bytes.resize(stream.total_out);
  ::inflateEnd(&stream);
  return result;
}

void expect_round_trip(const Bytes& raw) {
  for (const bool last : {false, true}) {
    const Inflated back = inflate_raw(compressed(raw, last), raw.size());
    EXPECT_TRUE(back.bytes == raw) << raw.size() << " bytes";
    EXPECT_EQ(back.ends, last) << raw.size() << " bytes";
  }
}

TEST(StripDeflater, ZlibUnpacksRunsOfEveryLength) {
  for (std::size_t length = 1; length <= 1200; ++length) {
    for (const std::uint8_t byte : {0, 7, 255}) expect_round_trip(Bytes(length, byte));
    Bytes framed(length, 0);
    framed.insert(framed.begin(), {1, 2});
    framed.insert(framed.end(), {3, 3});
    expect_round_trip(framed);
  }
}

TEST(StripDeflater, ZlibUnpacksAnyBytes) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    const std::size_t count = 1 + seed * seed;
    expect_round_trip(random_bytes(count, seed, 256));
    expect_round_trip(random_bytes(count, seed, 2 + seed % 7));
    expect_round_trip(random_runs(count, seed));
  }
}

// Noise is stored in blocks of at most 65535 bytes; other blocks end when a table of the library is full.
TEST(StripDeflater, BlocksEndAnywhere) {
  for (const std::size_t blocks : {1, 2, 4, 9})
    for (const int more : {-9, -1, 0, 1, 9}) {
      const std::size_t count = blocks * 65535 + std::size_t(more);
      expect_round_trip(random_runs(count, unsigned(count)));
      expect_round_trip(random_bytes(count, unsigned(count), 256));
      expect_round_trip(random_bytes(count, unsigned(count), 250));
      expect_round_trip(small_steps(count));
      expect_round_trip(Bytes(count, 0));
    }
}

TEST(StripDeflater, PiecesMakeOneStream) {
  Bytes all, stream;
  detail::StripDeflater deflater(70000);
  for (unsigned i = 0; i < 24; ++i) {
    const Bytes piece = i % 4 == 0   ? random_runs(1 + 2500 * i, i)
                        : i % 4 == 1 ? random_bytes(1 + 777 * i, i, 40)
                        : i % 4 == 2 ? Bytes(1 + 3000 * i, 0)
                                     : random_bytes(1 + 2000 * i, i, 256);
    const Bytes packed = compressed(deflater, piece, i == 23);
    all.insert(all.end(), piece.begin(), piece.end());
    stream.insert(stream.end(), packed.begin(), packed.end());
  }
  const Inflated back = inflate_raw(stream, all.size());
  EXPECT_TRUE(back.bytes == all);
  EXPECT_TRUE(back.ends);
}

// Threads take strips in any order, and a file has the same bytes for any number of threads.
TEST(StripDeflater, NothingIsRememberedOfOtherPieces) {
  const Bytes pieces[] = {random_runs(50000, 1), random_bytes(60000, 2, 256), Bytes(40000, 0),
                          small_steps(60000),    random_bytes(300, 3, 9),     Bytes(110, 0),
                          random_runs(110, 4),   random_bytes(99, 5, 2)};
  for (const Bytes& before : pieces)
    for (const Bytes& piece : pieces)
      for (const bool last : {false, true}) {
        detail::StripDeflater deflater(60000);
        (void)deflater.compress(before, last);
        for (const bool is_last : {false, true})
          EXPECT_TRUE(compressed(deflater, piece, is_last) == compressed(piece, is_last)) << is_last;
      }
}

#ifndef FRONTMOST_DEFLATES_BY_ZLIB
// In one process of a hundred, ISA-L compresses small pictures to other bytes, which a test cannot provoke; zlib never
// does.
TEST(StripDeflater, SmallPiecesAreZlibs) {
  for (const Bytes& piece : {random_runs(110, 4), Bytes(2100, 0), random_runs(8191, 7), random_bytes(1, 5, 2)}) {
    z_stream stream{};
    ASSERT_EQ(::deflateInit2(&stream, 6, Z_DEFLATED, -15, 8, Z_DEFAULT_STRATEGY), Z_OK);
    Bytes expected(20000);
    stream.next_in = const_cast<Bytef*>(piece.data());
    stream.avail_in = uInt(piece.size());
    stream.next_out = expected.data();
    stream.avail_out = uInt(expected.size());
    EXPECT_EQ(::deflate(&stream, Z_FINISH), Z_STREAM_END);
    expected.resize(stream.total_out);
    ::deflateEnd(&stream);
    EXPECT_TRUE(compressed(piece, true) == expected) << piece.size();
  }
}
#endif

// Measured sizes by ISA-L and zlib: 98.8 and 85.8 kB for small steps, 5.7 and 3.3 kB for runs, 168.0 and 167.9 kB for a
// hundred byte values.
TEST(StripDeflater, WhatComesOutIsSmall) {
  const auto size = [](const Bytes& raw) { return compressed(raw, true).size(); };
  EXPECT_LT(size(small_steps(200000)), 110000u);
  EXPECT_LT(size(random_runs(200000, 9)), 8000u);
  EXPECT_LT(size(random_bytes(200000, 1, 100)), 170000u);
  EXPECT_LT(size(Bytes(200000, 0)), 1000u);
  EXPECT_LT(size(random_bytes(200000, 1, 256)), 200100u) << "noise hardly grows";
}

TEST(Checksums, AreZlibs) {
  for (const std::size_t count : {0, 1, 15, 16, 17, 63, 64, 65, 5552, 5553, 65521, 262144})
    for (const unsigned different : {1u, 2u, 256u}) {
      Bytes bytes = random_bytes(count + 3, unsigned(count), different);
      if (different == 1) bytes.assign(count + 3, 255);  // the greatest sums
      for (const std::size_t start : {0, 1, 3}) {
        const std::span<const std::uint8_t> part(bytes.data() + start, count);
        EXPECT_EQ(detail::crc32_of(part), ::crc32(0, part.data(), uInt(count))) << count << " bytes";
        EXPECT_EQ(detail::adler32_of(part), ::adler32(1, part.data(), uInt(count))) << count << " bytes";
      }
    }
}

#if defined(__x86_64__)
/// Parts of the registers that the processor tracks as in use; bit 2 stands for the upper halves of vectors.
[[gnu::target("xsave")]] std::uint64_t used_register_parts() { return _xgetbv(1); }

// While the upper halves are in use, code compiled for SSE is slow on this thread.
TEST(StripDeflater, UpperHalvesOfVectorRegistersAreLeftFree) {
  unsigned a = 0, b = 0, c = 0, d = 0;
  if (!__builtin_cpu_supports("avx") || !__get_cpuid_count(0xD, 1, &a, &b, &c, &d) || !(a & 4))
    GTEST_SKIP() << "this processor does not tell";
  constexpr std::uint64_t upper_halves = 4;
  const Bytes steps = small_steps(200000);
  detail::StripDeflater deflater(steps.size());
  (void)deflater.compress(steps, true);
  EXPECT_EQ(used_register_parts() & upper_halves, 0u) << "after compressing";
  (void)detail::crc32_of(steps);
  EXPECT_EQ(used_register_parts() & upper_halves, 0u) << "after CRC-32";
  (void)detail::adler32_of(steps);
  EXPECT_EQ(used_register_parts() & upper_halves, 0u) << "after Adler-32";
}
#endif

}  // namespace
}  // namespace frontmost::test
