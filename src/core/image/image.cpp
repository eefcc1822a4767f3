// SPDX-License-Identifier: Apache-2.0
// Images: their checks and hashes, maps of a Visible's first sample (depths, ray distances, ids), and pixels of bytes.
#include "frontmost/image.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "base/word_hash.h"
#include "frontmost/scene.h"
#include "frontmost/view.h"
#include "image/srgb_pixels.h"
#include "view/answer.h"

namespace frontmost {
namespace {

/// A hash of words of 32 bits.
class PictureHash {
 public:
  void add(std::uint32_t word) { words_.add(word); }
  void add(std::string_view text) {
    add(std::uint32_t(text.size()));
    for (const char c : text) add(std::uint32_t(static_cast<unsigned char>(c)));
  }
  /// Machines differ in the bits of a NaN that an operation makes, so all NaNs hash alike.
  void add(float number) { add(number == number ? bits_as<std::uint32_t>(number) : 0x7FC00000u); }
  [[nodiscard]] std::uint64_t value() const {
    // The low bits of a word reach only the high bits of the product, so the high bits are folded back.
    return words_.value() ^ (words_.value() >> 32);
  }

 private:
  WordHash words_;
};

[[noreturn]] void fail(const std::string& reason) { throw Error(ErrorCode::bad_argument, "image", reason); }

void validate_size(int width, int height) {
  constexpr int most = 1 << 20;  // keeps every product of sizes far below 64 bits
  if (width < 1 || height < 1 || width > most || height > most)
    fail(std::to_string(width) + " x " + std::to_string(height) + " pixels");
}

/// Hashes size, names and values of a plain or a deep image.
template <class AnyImage>
void add(PictureHash& hash, const AnyImage& image) {
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

/// A file stores its channels by name, and find() would never reach the second of one name.
void check_channels(const std::vector<Channel>& channels, std::uint64_t value_count, const char* expected) {
  std::set<std::string_view> names;
  for (const Channel& channel : channels) {
    if ((channel.is_integer() ? channel.integers().size() : channel.floats().size()) != value_count)
      fail("channel " + channel.name + " does not have " + expected);
    if (!names.insert(channel.name).second) fail("two channels are named " + channel.name);
  }
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
  check_channels(image.channels, count, "width x height values");
}

void validate(const DeepImage& image) {
  validate_size(image.width, image.height);
  if (image.channels.empty()) fail("no channels");
  const std::size_t pixels = std::size_t(image.width) * std::size_t(image.height);
  if (image.first.size() != pixels + 1 || image.first[0] != 0 ||
      !std::is_sorted(image.first.begin(), image.first.end()))
    fail("a deep image needs the index of each pixel's first sample, ascending from 0, and the number of all samples");
  check_channels(image.channels, image.first[pixels], "one value for each sample");
}

void validate(const Bitmap& bitmap) {
  validate_size(bitmap.width, bitmap.height);
  if (bitmap.rgba.size() != 4 * std::size_t(bitmap.width) * std::size_t(bitmap.height))
    fail("a bitmap needs four bytes for each pixel");
}

std::uint64_t content_hash(const Image& image) {
  PictureHash hash;
  add(hash, image);
  return hash.value();
}

std::uint64_t content_hash(const DeepImage& image) {
  PictureHash hash;
  add(hash, image);
  for (std::size_t i = 1; i < image.first.size(); ++i) hash.add(std::uint32_t(image.first[i] - image.first[i - 1]));
  return hash.value();
}

namespace {

Image one_channel(int width, int height, Channel channel) {
  Image image{width, height, {}};
  image.channels.push_back(std::move(channel));
  return image;
}

/// A map with the value depth_at(x, y, planar depth) in every pixel that sees something, and `background` in all
/// others.
template <class DepthAt>
Image map_of_depths(const Visible& visible, const char* name, float background, DepthAt&& depth_at) {
  check_planes(visible, "depth image");
  const View& view = visible.view;
  Buffer<float> values(view.pixel_count());
  std::size_t i = 0;
  for (int y = 0; y < view.height; ++y)
    for (int x = 0; x < view.width; ++x, ++i)
      values[i] =
          visible.primitives[i] == no_primitive ? background : depth_at(x, y, depth_of_key(view, visible.keys[i]));
  return one_channel(view.width, view.height, {name, std::move(values)});
}

std::uint32_t id_of(const Scene& scene, const PrimitiveSource& source, IdKind kind) {
  if (kind == IdKind::object) return source.instance;
  return scene.meshes[source.mesh].material_of(source.triangle);
}

}  // namespace

Image depth_image(const Visible& visible, float background) {
  return map_of_depths(visible, "Z", background, [](int, int, float depth) { return depth; });
}

Image ray_distance_image(const Visible& visible, float background) {
  const View& view = visible.view;
  const Projection& p = view.projection;
  // The ray passes through the first sample of the pixel.
  const glm::dvec2 first = glm::dvec2(sample_offsets(view.samples)[0]) / 256.0;
  const glm::dvec2 step((p.right - p.left) / view.width, (p.top - p.bottom) / view.height);
  return map_of_depths(visible, "distance", background, [&](int x, int y, float depth) {
    const double right = p.left + (x + first.x) * step.x, up = p.top - (y + first.y) * step.y;
    return p.orthographic ? depth : float(double(depth) * std::sqrt(1 + right * right + up * up));
  });
}

Image id_image(const Surfaces& surfaces, const Visible& visible, IdKind kind) {
  check_planes(visible, "id image");
  const View& view = visible.view;
  return id_image(surfaces, {view.width, view.height}, {visible.primitives.data(), view.pixel_count()}, kind);
}

Image id_image(const Surfaces& surfaces, const glm::ivec2& size, std::span<const PrimitiveId> primitives, IdKind kind) {
  if (size.x < 0 || size.y < 0 || primitives.size() != std::size_t(size.x) * std::size_t(size.y))
    throw Error(ErrorCode::bad_argument, "id image", "the number of ids is not width x height");
  Buffer<std::uint32_t> ids(primitives.size());
  // Neighbours mostly show the same triangle, which need not be looked up again.
  PrimitiveId last_primitive = no_primitive;
  std::uint32_t last_id = no_index;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const PrimitiveId primitive = primitives[i];
    if (primitive != last_primitive) {
      last_primitive = last_id = primitive;
      if (primitive != no_primitive) {
        if (primitive >= surfaces.primitive_count())
          throw Error(ErrorCode::bad_argument, "id image", "the surfaces are not those of the Visible");
        if (kind != IdKind::primitive) last_id = id_of(surfaces.scene(), surfaces.source(primitive), kind);
      }
    }
    ids[i] = last_id;
  }
  constexpr const char* names[] = {"primitive", "object", "material"};  // by IdKind
  return one_channel(size.x, size.y, {names[int(kind)], std::move(ids)});
}

std::vector<std::uint64_t> count_pixels(const Image& ids, std::size_t count) {
  if (ids.channels.size() != 1 || !ids.channels[0].is_integer())
    throw Error(ErrorCode::bad_argument, "pixel counts", "the image must have one channel of integers");
  std::vector<std::uint64_t> pixels(count);
  for (const std::uint32_t id : ids.channels[0].integers())
    if (id < count) ++pixels[id];
  return pixels;
}

namespace {

template <class Value>
void row_of(const ColorPlanes& planes, int y, bool with_alpha, Value* out) {
  const std::size_t first = std::size_t(y) * std::size_t(planes.width);
  const float *r = planes.color[0] + first, *g = planes.color[1] + first, *b = planes.color[2] + first;
  const float* a = planes.alpha ? planes.alpha + first : nullptr;
  for (int x = 0; x < planes.width; ++x) {
    const float alpha = a ? a[x] : 1.0f;
    store_srgb({r[x], g[x], b[x]}, alpha, out);
    out += 3;
    if (with_alpha) *out++ = rounded_fraction<Value>(alpha);
  }
}

const float* plane(const Image& image, std::string_view name) {
  const Channel* channel = image.find(name);
  return channel && !channel->is_integer() ? channel->floats().data() : nullptr;
}

}  // namespace

bool ColorPlanes::is_opaque() const {
  if (!alpha) return true;
  const std::size_t count = std::size_t(width) * std::size_t(height);
  // The loop goes block by block without branches, so that the compiler can use vectors.
  constexpr std::size_t block = 4096;
  constexpr float most_clear = 254.5f / 255;  // just below the quotient: the last float that rounds to 254
  for (std::size_t first = 0; first < count; first += block) {
    const std::size_t end = std::min(count, first + block);
    unsigned clear = 0;
    for (std::size_t i = first; i < end; ++i) clear |= unsigned(!(alpha[i] > most_clear));
    if (clear) return false;
  }
  return true;
}

std::optional<ColorPlanes> color_planes(const Image& image) {
  ColorPlanes planes{
      image.width, image.height, {plane(image, "R"), plane(image, "G"), plane(image, "B")}, plane(image, "A")};
  for (const float* color : planes.color)
    if (!color) return std::nullopt;
  return planes;
}

std::string channel_list(const Image& image) {
  std::string list;
  for (const Channel& channel : image.channels) list += (list.empty() ? "" : ", ") + channel.name;
  return list;
}

void srgb8_row(const ColorPlanes& planes, int y, bool with_alpha, std::uint8_t* row) {
  row_of(planes, y, with_alpha, row);
}

void srgb16_row(const ColorPlanes& planes, int y, bool with_alpha, std::uint16_t* row) {
  row_of(planes, y, with_alpha, row);
}

Bitmap bitmap_of(const Image& image) {
  validate(image);
  const std::optional<ColorPlanes> planes = color_planes(image);
  if (!planes) throw Error(ErrorCode::bad_argument, "image", "has no channels R, G and B of floats");
  Bitmap bitmap{image.width, image.height,
                Buffer<std::uint8_t>(4 * std::size_t(image.width) * std::size_t(image.height))};
  for (int y = 0; y < image.height; ++y)
    srgb8_row(*planes, y, true, bitmap.rgba.data() + 4 * std::size_t(y) * std::size_t(image.width));
  return bitmap;
}

float linear_of_srgb(std::uint8_t srgb) { return linear_of_srgb8(srgb); }

}  // namespace frontmost
