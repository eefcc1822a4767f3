// SPDX-License-Identifier: Apache-2.0
#include "frontmost/image.h"

#include <algorithm>
#include <cstring>
#include <set>
#include <utility>

namespace frontmost {
namespace {

/// FNV-1a over 32-bit words instead of bytes: four times as fast, and as good at telling pictures apart.
class WordHash {
 public:
  void add(std::uint32_t word) { value_ = (value_ ^ word) * 0x100000001B3u; }
  void add(std::string_view text) {
    add(std::uint32_t(text.size()));
    for (const char c : text) add(std::uint32_t(static_cast<unsigned char>(c)));
  }
  /// Machines differ in the bits of a NaN that an operation makes, so all NaNs hash alike.
  void add(float number) {
    std::uint32_t bits = 0x7FC00000u;
    if (number == number) std::memcpy(&bits, &number, sizeof bits);
    add(bits);
  }
  [[nodiscard]] std::uint64_t value() const {
    // The low bits of a word reach only the high bits of the product, so these are folded back.
    return value_ ^ (value_ >> 32);
  }

 private:
  std::uint64_t value_ = 0xCBF29CE484222325u;
};

[[noreturn]] void fail(const std::string& reason) { throw Error(ErrorCode::bad_argument, "image", reason); }

void validate_size(int width, int height) {
  constexpr int most = 1 << 20;  // keeps every product of sizes far below 64 bits
  if (width < 1 || height < 1 || width > most || height > most)
    fail(std::to_string(width) + " x " + std::to_string(height) + " pixels");
}

/// Hashes size, names and values of a plain or a deep image.
template <class AnyImage>
void add(WordHash& hash, const AnyImage& image) {
  hash.add(std::uint32_t(image.width));
  hash.add(std::uint32_t(image.height));
  for (const Channel& channel : image.channels) {
    hash.add(channel.name);
    hash.add(std::uint32_t(channel.is_integer()));
    if (channel.is_integer()) {
      for (const std::uint32_t id : channel.integers()) hash.add(id);
    } else {
      for (const float number : channel.floats()) hash.add(number);
    }
  }
}

std::size_t value_count(const Channel& channel) {
  return channel.is_integer() ? channel.integers().size() : channel.floats().size();
}

}  // namespace

const Channel* Image::find(std::string_view name) const {
  for (const Channel& channel : channels)
    if (channel.name == name) return &channel;
  return nullptr;
}

Channel* Image::find(std::string_view name) { return const_cast<Channel*>(std::as_const(*this).find(name)); }

void validate(const Image& image) {
  validate_size(image.width, image.height);
  if (image.channels.empty()) fail("no channels");
  const std::size_t count = std::size_t(image.width) * std::size_t(image.height);
  for (const Channel& channel : image.channels) {
    if (value_count(channel) != count) fail("channel " + channel.name + " does not have width x height values");
    // A file stores its channels by name, and find() would never reach the second.
    if (image.find(channel.name) != &channel) fail("two channels are named " + channel.name);
  }
}

void validate(const DeepImage& image) {
  validate_size(image.width, image.height);
  if (image.channels.empty()) fail("no channels");
  const std::size_t pixels = std::size_t(image.width) * std::size_t(image.height);
  if (image.first.size() != pixels + 1 || image.first[0] != 0 ||
      !std::is_sorted(image.first.begin(), image.first.end()))
    fail("a deep image's beginnings are not one a pixel and the end, in order");
  std::set<std::string_view> names;
  for (const Channel& channel : image.channels) {
    if (value_count(channel) != image.first[pixels])
      fail("channel " + channel.name + " does not have one value a sample");
    if (!names.insert(channel.name).second) fail("two channels are named " + channel.name);
  }
}

void validate(const Bitmap& bitmap) {
  validate_size(bitmap.width, bitmap.height);
  if (bitmap.rgba.size() != 4 * std::size_t(bitmap.width) * std::size_t(bitmap.height))
    fail("a bitmap does not have four bytes a pixel");
}

std::uint64_t content_hash(const Image& image) {
  WordHash hash;
  add(hash, image);
  return hash.value();
}

std::uint64_t content_hash(const DeepImage& image) {
  WordHash hash;
  add(hash, image);
  for (std::size_t i = 1; i < image.first.size(); ++i) hash.add(std::uint32_t(image.first[i] - image.first[i - 1]));
  return hash.value();
}

}  // namespace frontmost
