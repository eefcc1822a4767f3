// SPDX-License-Identifier: Apache-2.0
// What is compressed here is unpacked by zlib, and prefix codes are held against Huffman's method as textbooks have it.
#include "io/images/png/run_deflater.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <queue>
#include <random>
#include <utility>
#include <vector>

#include "io/images/png/prefix_code.h"

namespace frontmost::test {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes random_bytes(std::size_t count, unsigned seed, unsigned different) {
  std::mt19937 random(seed);
  Bytes bytes(count);
  for (std::uint8_t& byte : bytes) byte = std::uint8_t(random() % different);
  return bytes;
}

/// Runs of all lengths, mostly short ones, of few bytes.
Bytes random_runs(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  Bytes bytes;
  while (bytes.size() < count)
    bytes.insert(bytes.end(), std::min<std::size_t>(count - bytes.size(), 1 + (random() % 700 >> random() % 10)),
                 std::uint8_t(random() % 5));
  return bytes;
}

Bytes compressed(const Bytes& raw, bool last) {
  detail::RunDeflater deflater(raw.size());
  const auto packed = deflater.compress(raw, last);
  return {packed.begin(), packed.end()};
}

/// What zlib makes of a raw stream of `count` bytes, and whether it comes to the stream's end.
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

TEST(RunDeflater, ZlibUnpacksRunsOfEveryLength) {
  for (std::size_t length = 1; length <= 1200; ++length) {
    expect_round_trip(Bytes(length, 7));
    Bytes framed(length, 0);
    framed.insert(framed.begin(), {1, 2});
    framed.insert(framed.end(), {3, 3});
    expect_round_trip(framed);
  }
}

TEST(RunDeflater, ZlibUnpacksAnyBytes) {
  for (unsigned seed = 0; seed < 200; ++seed) {
    const std::size_t count = 1 + seed * seed;
    expect_round_trip(random_bytes(count, seed, 256));
    expect_round_trip(random_bytes(count, seed, 2 + seed % 7));
    expect_round_trip(random_runs(count, seed));
  }
}

TEST(RunDeflater, BlocksEndAnywhere) {
  for (const std::size_t blocks : {1, 2, 5})
    for (const int more : {-9, -1, 0, 1, 9}) {
      const std::size_t count = (blocks << 16) + std::size_t(more);
      expect_round_trip(random_runs(count, unsigned(count)));
      expect_round_trip(random_bytes(count, unsigned(count), 256));
      expect_round_trip(Bytes(count, 0));
    }
}

// The longest codes that there are: counts that grow like Fibonacci's numbers make Huffman's tree a chain.
TEST(RunDeflater, CountsThatWouldMakeCodesTooLong) {
  Bytes raw;
  std::size_t count = 1, before = 1;
  for (std::uint8_t byte = 0; byte < 22; ++byte) {
    for (std::size_t i = 0; i < count; ++i) raw.push_back(byte);
    count += std::exchange(before, count);
  }
  raw.resize(65536);
  std::shuffle(raw.begin(), raw.end(), std::mt19937(1));
  expect_round_trip(raw);
}

TEST(RunDeflater, PiecesMakeOneStream) {
  Bytes all, stream;
  detail::RunDeflater deflater(70000);
  for (unsigned i = 0; i < 12; ++i) {
    const Bytes piece = i % 2 ? random_runs(1 + 5000 * i, i) : random_bytes(1 + 777 * i, i, 40);
    const auto packed = deflater.compress(piece, i == 11);
    all.insert(all.end(), piece.begin(), piece.end());
    stream.insert(stream.end(), packed.begin(), packed.end());
  }
  const Inflated back = inflate_raw(stream, all.size());
  EXPECT_TRUE(back.bytes == all);
  EXPECT_TRUE(back.ends);
}

std::size_t size_by_zlib(const Bytes& raw) {
  z_stream stream{};
  EXPECT_EQ(::deflateInit2(&stream, 1, Z_DEFLATED, -15, 8, Z_RLE), Z_OK);
  Bytes out(::deflateBound(&stream, uLong(raw.size())));
  stream.next_in = const_cast<Bytef*>(raw.data());
  stream.avail_in = uInt(raw.size());
  stream.next_out = out.data();
  stream.avail_out = uInt(out.size());
  EXPECT_EQ(::deflate(&stream, Z_FINISH), Z_STREAM_END);
  const std::size_t size = stream.total_out;
  ::deflateEnd(&stream);
  return size;
}

TEST(RunDeflater, FilesAreAsSmallAsByZlibsRuns) {
  std::mt19937 random(3);
  std::normal_distribution<double> step(0, 3);
  Bytes smooth(200000);
  for (std::uint8_t& byte : smooth) byte = std::uint8_t(int(step(random)));
  for (const Bytes& raw : {smooth, random_runs(200000, 9), random_bytes(200000, 1, 100)})
    EXPECT_LT(double(compressed(raw, true).size()), 1.03 * double(size_by_zlib(raw)));
  EXPECT_LT(compressed(random_bytes(200000, 1, 256), true).size(), 201500u) << "noise hardly grows";
}

/// The bits of all symbols by Huffman's method with a queue of weights: what every best code takes.
std::uint64_t least_bits(const std::vector<std::uint32_t>& counts) {
  std::priority_queue<std::uint64_t, std::vector<std::uint64_t>, std::greater<>> weights;
  for (const std::uint32_t count : counts)
    if (count > 0) weights.push(count);
  std::uint64_t bits = 0;
  while (weights.size() > 1) {
    std::uint64_t sum = weights.top();
    weights.pop();
    sum += weights.top();
    weights.pop();
    weights.push(sum);
    bits += sum;
  }
  return bits;
}

TEST(PrefixCode, LengthsAreHuffmansWhereTheyFit) {
  std::mt19937 random(5);
  for (int round = 0; round < 500; ++round) {
    std::vector<std::uint32_t> counts(2 + random() % 285);
    for (std::uint32_t& count : counts) count = random() % 3 ? random() % 1000 : 0;
    counts[0] = 1, counts.back() = 2;
    std::vector<std::uint8_t> lengths(counts.size());
    detail::find_code_lengths(counts, 32, lengths);  // no limit
    std::uint64_t bits = 0;
    double share = 0;
    for (std::size_t i = 0; i < counts.size(); ++i) {
      EXPECT_EQ(lengths[i] == 0, counts[i] == 0);
      bits += std::uint64_t(counts[i]) * lengths[i];
      if (lengths[i]) share += std::ldexp(1.0, -lengths[i]);
    }
    EXPECT_EQ(bits, least_bits(counts));
    EXPECT_EQ(share, 1.0) << "no code is left over";
  }
}

TEST(PrefixCode, NoLengthIsOverTheMost) {
  std::vector<std::uint32_t> counts = {1, 1};
  while (counts.size() < 40) counts.push_back(counts.back() + counts[counts.size() - 2]);
  for (const int most : {7, 9, 15}) {
    const std::size_t used = most == 7 ? 19 : 40;
    std::vector<std::uint8_t> lengths(used);
    detail::find_code_lengths(std::span(counts).first(used), most, lengths);
    double share = 0;
    for (const std::uint8_t length : lengths) {
      EXPECT_GE(length, 1);
      EXPECT_LE(length, most);
      share += std::ldexp(1.0, -length);
    }
    EXPECT_EQ(share, 1.0);
  }
}

// The example of RFC 1951, 3.2.2: lengths 3, 3, 3, 3, 3, 2, 4, 4 have the codes 010 011 100 101 110 00 1110 1111.
TEST(PrefixCode, CodesOfTheStandardsExample) {
  const std::vector<std::uint8_t> lengths = {3, 3, 3, 3, 3, 2, 4, 4};
  std::vector<std::uint16_t> codes(lengths.size());
  detail::assign_codes(lengths, codes);
  EXPECT_EQ(codes, (std::vector<std::uint16_t>{0b010, 0b110, 0b001, 0b101, 0b011, 0b00, 0b0111, 0b1111}));
}

}  // namespace
}  // namespace frontmost::test
