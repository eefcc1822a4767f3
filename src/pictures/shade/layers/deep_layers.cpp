// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <numeric>
#include <tuple>

#include "abuffer/tile_parts.h"
#include "shade/layers/layers.h"
#include "view/screen_transform.h"

namespace frontmost::shading {
namespace {

using abuffer_detail::FragmentColors;
using abuffer_detail::FragmentPass;
using abuffer_detail::PixelLists;
using abuffer_detail::Rectangle;
using abuffer_detail::TilePart;
using abuffer_detail::TileParts;

constexpr std::uint64_t kMostSamples = std::uint64_t(1) << 28;

struct DeepSample {
  glm::vec4 color;  ///< premultiplied
  float z;
  PrimitiveId primitive;
};

/// The fragments at one sub-sample, nearest first.
class Order {
 public:
  /// Sorted by negated key, so the greatest key is first, then by id.
  using Place = std::tuple<float, PrimitiveId, std::uint32_t>;

  Order(std::span<const Fragment> fragments, const KeyAt& key_at) : fragments_(fragments), key_at_(key_at) {}

  [[nodiscard]] const std::vector<Place>& at(std::size_t sample) {
    order_.clear();
    for (std::uint32_t i = 0; i < fragments_.size(); ++i)
      if (fragments_[i].mask >> sample & 1) order_.push_back({-key_at_(i, sample), fragments_[i].primitive, i});
    // Mostly the list is already in order: few fragments change places within a pixel.
    if (!std::is_sorted(order_.begin(), order_.end())) std::sort(order_.begin(), order_.end());
    return order_;
  }

 private:
  std::span<const Fragment> fragments_;
  const KeyAt& key_at_;
  std::vector<Place> order_;
};

/// Makes the samples of one rectangle.
class PartMaker {
 public:
  PartMaker(const View& view, const FragmentPass& pass, const LayerShader& shader)
      : view_(view), opacity_(pass.opacity()), samples_(pass.samples()), shader_(shader) {}

  [[nodiscard]] TilePart<DeepSample> make(const Rectangle& pixels, const PixelLists& lists) const {
    std::vector<std::uint32_t> numbers(lists.fragments.size());
    std::iota(numbers.begin(), numbers.end(), 0u);
    FragmentColors colors{std::vector<glm::vec4>(numbers.size()), {}};
    shader_.shade(pixels, lists, numbers, colors);
    TilePart<DeepSample> part{pixels, {0}, {}};
    for (std::size_t p = 0; p + 1 < lists.begin.size(); ++p) {
      const int x = int(p) % pixels.width, y = int(p) / pixels.width;
      add_pixel(lists, p, colors.straight, glm::ivec2(x, y) * kSubPixels, part.items);
      part.begin.push_back(std::uint32_t(part.items.size()));
    }
    return part;
  }

 private:
  /// `corner`: the pixel's corner relative to the rectangle's, in 1/256 pixel.
  void add_pixel(const PixelLists& lists, std::size_t pixel, const std::vector<glm::vec4>& all_colors,
                 const glm::ivec2& corner, std::vector<DeepSample>& out) const {
    const std::size_t begin = lists.begin[pixel], count = lists.begin[pixel + 1] - begin;
    const auto fragments = std::span(lists.fragments).subspan(begin, count);
    const auto colors = std::span(all_colors).subspan(begin, count);
    std::vector<float> alphas;
    for (const glm::vec4& color : colors) alphas.push_back(color.a * opacity_);
    const auto key_at = [&](std::size_t i, std::size_t s) {
      return lists.key_at(begin + i, corner.x + samples_[s].x, corner.y + samples_[s].y);
    };
    const std::vector<float> parts = shown_parts(fragments, alphas, samples_.size(), key_at);
    float left = 1;
    for (std::size_t i = 0; i < fragments.size(); ++i) {
      if (!(parts[i] > 0 && left > 0)) continue;
      // Relative to the uncovered rest, so that compositing gives this part again.
      const float alpha = std::min(parts[i] / left, 1.0f);
      out.push_back({glm::vec4(glm::vec3(colors[i]) * alpha, alpha), depth_of_key(view_, fragments[i].key),
                     fragments[i].primitive});
      left -= parts[i];
    }
  }

  const View& view_;
  float opacity_;
  std::vector<glm::ivec2> samples_;
  const LayerShader& shader_;
};

/// The planes of a deep image, indexed by sample.
struct DeepPlanes {
  Buffer<float> red, green, blue, alpha, z;
  Buffer<PrimitiveId> primitive;

  explicit DeepPlanes(std::size_t n) : red(n), green(n), blue(n), alpha(n), z(n), primitive(n) {}
  void set(std::size_t i, const DeepSample& s) {
    red[i] = s.color.r;
    green[i] = s.color.g;
    blue[i] = s.color.b;
    alpha[i] = s.color.a;
    z[i] = s.z;
    primitive[i] = s.primitive;
  }
};

/// The ids of one kind for these primitives.
Channel ids_of(const Surfaces& surfaces, const Buffer<PrimitiveId>& primitives, IdKind kind) {
  return id_image(surfaces, {int(primitives.size()), 1}, {primitives.data(), primitives.size()}, kind).channels.front();
}

}  // namespace

std::vector<float> shown_parts(std::span<const Fragment> fragments, std::span<const float> alphas,
                               std::size_t sample_count, const KeyAt& key_at) {
  std::vector<float> parts(fragments.size(), 0.0f);
  Order order(fragments, key_at);
  for (std::size_t s = 0; s < sample_count; ++s) {
    float left = 1;
    for (const auto& [key, id, i] : order.at(s)) {
      parts[i] += left * alphas[i];
      left *= 1 - alphas[i];
    }
  }
  for (float& part : parts) part /= float(sample_count);
  return parts;
}

DeepImage deep_layers(const Surfaces& surfaces, const View& view, const FragmentPass& pass, const LayerShader& shader,
                      const Execution& execution) {
  const PartMaker maker(view, pass, shader);
  TileParts<DeepSample> parts(view, kMostSamples, "shade", "more than 2^28 deep samples");
  pass.look([&](const Rectangle& pixels, const PixelLists& lists) { parts.add(maker.make(pixels, lists)); }, execution);
  DeepImage image{view.width, view.height, parts.beginnings(), {}};
  DeepPlanes planes(image.first[view.pixel_count()]);
  parts.place(
      image.first, [&](std::uint64_t at, const DeepSample& s) { planes.set(at, s); }, execution);
  image.channels.push_back({"R", std::move(planes.red)});
  image.channels.push_back({"G", std::move(planes.green)});
  image.channels.push_back({"B", std::move(planes.blue)});
  image.channels.push_back({"A", std::move(planes.alpha)});
  image.channels.push_back({"Z", planes.z});
  image.channels.push_back({"ZBack", std::move(planes.z)});
  for (const IdKind kind : {IdKind::primitive, IdKind::object, IdKind::material})
    image.channels.push_back(ids_of(surfaces, planes.primitive, kind));
  return image;
}

}  // namespace frontmost::shading
