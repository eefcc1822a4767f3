// SPDX-License-Identifier: Apache-2.0
#include "shade/layers/layers.h"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "abuffer/tile_parts.h"
#include "view/screen_transform.h"

namespace frontmost::shading {

using abuffer_detail::FragmentColors;
using abuffer_detail::FragmentPass;
using abuffer_detail::PaintedPixels;
using abuffer_detail::PixelLists;
using abuffer_detail::Rectangle;
using abuffer_detail::TilePart;
using abuffer_detail::TileParts;

namespace {

/// Returns the first fragment within the 2 x 2 pixels around pixel p that has the same primitive, the same samples and
/// the same depth rank as fragment `i`. Returns `i` if no other fragment comes before it.
std::size_t shared_fragment(const Rectangle& pixels, const PixelLists& lists, std::size_t p, std::size_t i) {
  const auto width = std::size_t(pixels.width), x = p % width, y = p / width;
  const std::size_t left = x - x % 2, top = y - y % 2;
  for (const auto& [column, row] : {std::pair(left, top), std::pair(left + 1, top), std::pair(left, top + 1)}) {
    const std::size_t other = row * width + column;
    if (column == width || other >= p) continue;
    const std::size_t same = lists.begin[other] + (i - lists.begin[p]);
    if (same >= lists.begin[other + 1]) continue;
    const Fragment &own = lists.fragments[i], &found = lists.fragments[same];
    if (found.primitive == own.primitive && found.mask == own.mask) return same;
  }
  return i;
}

/// Colours the fragments of rectangles. Several threads may call it at once.
class LayerShader {
 public:
  LayerShader(const TriangleSource& source, const FragmentPass& pass, const FragmentShader::Colorist& colorist,
              ShadingRate rate, Isa isa)
      : source_(source), colorist_(colorist), rate_(rate), isa_(isa) {
    for (const glm::ivec2& s : pass.samples()) positions_.push_back(glm::vec2(s) / 256.0f);
  }

  /// Sets the colour numbers[i] of every fragment i, which is shaded at the mean of its samples. At the rate each_2x2,
  /// the pixels of a block share a colour if the same primitive covers the same samples at the same depth rank.
  void shade(const Rectangle& pixels, const PixelLists& lists, std::span<const std::uint32_t> numbers,
             FragmentColors& colors) const {
    const auto shader = shaders_.borrow([] { return std::make_unique<FragmentShader>(); });
    const auto receive = [&](const FragmentShader::Shaded& s) { colors.set(s.number, s.light, s.alpha, s.alphas); };
    std::vector<std::pair<std::uint32_t, std::uint32_t>> shared;  // colour numbers: from, to
    shader->begin(source_, colorist_, isa_);
    for (std::size_t p = 0; p + 1 < lists.begin.size(); ++p) {
      const glm::vec2 corner(float(pixels.x + int(p) % pixels.width), float(pixels.y + int(p) / pixels.width));
      for (std::size_t i = lists.begin[p]; i < lists.begin[p + 1]; ++i) {
        const Fragment& f = lists.fragments[i];
        if (rate_ == ShadingRate::each_2x2)
          if (const std::size_t same = shared_fragment(pixels, lists, p, i); same != i) {
            shared.push_back({numbers[same], numbers[i]});
            continue;
          }
        if (shader->is_full()) shader->hand_out(receive);
        shader->add(f.primitive, numbers[i], corner + centroid(f.mask), f.mask, 1.0f);
      }
    }
    shader->hand_out(receive);
    for (const auto& [from, to] : shared) colors.copy(from, to);
  }

 private:
  /// Returns the mean of the covered positions, in pixels.
  [[nodiscard]] glm::vec2 centroid(std::uint64_t mask) const {
    glm::vec2 sum(0);
    float count = 0;
    for (std::size_t s = 0; s < positions_.size(); ++s)
      if (mask >> s & 1) {
        sum += positions_[s];
        ++count;
      }
    return sum / count;
  }

  const TriangleSource& source_;
  const FragmentShader::Colorist& colorist_;
  ShadingRate rate_;
  Isa isa_;
  std::vector<glm::vec2> positions_;  ///< position of the sub-sample of each bit of the masks
  mutable Pool<FragmentShader> shaders_;
};

constexpr std::uint64_t kMostSamples = std::uint64_t(1) << 28;

struct DeepSample {
  glm::vec4 color;  ///< premultiplied
  float z;
  PrimitiveId primitive;
};

/// Makes the deep samples of one rectangle.
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
  /// `corner` is the vector from the rectangle's corner to that of the pixel, in 1/256 pixel.
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
      // This alpha is relative to the uncovered rest, so that compositing gives parts[i] again.
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

}  // namespace

void shade_layers(const TriangleSource& source, const FragmentPass& pass, const FragmentPass::LeaveOut& paint_otherwise,
                  const Painting& painting, const Execution& execution) {
  const LayerShader shader(source, pass, painting.colorist, painting.rate, execution.isa);
  const auto paint = [&](const Rectangle& pixels, const PixelLists& lists, FragmentColors& colors) {
    shader.shade(pixels, lists, lists.numbers, colors);
  };
  const glm::vec4& background = painting.background;
  const auto receive = [&](const Rectangle& r, const PaintedPixels* painted) {
    const TileRectangle tile{r.x, r.y, r.width, r.height};
    if (!painted)
      painting.canvas.fill(tile, background);
    else if (painted->alphas.empty())
      painting.canvas.write(tile, painted->colors, background);
    else
      painting.canvas.write_tinted(tile, *painted, background);
  };
  pass.paint(paint, receive, paint_otherwise, execution);
}

std::vector<float> shown_parts(std::span<const Fragment> fragments, std::span<const float> alphas,
                               std::size_t sample_count, const KeyAt& key_at) {
  std::vector<float> parts(fragments.size(), 0.0f);
  // The list is sorted by negated key, so that the greatest key comes first, and then by id.
  std::vector<std::tuple<float, PrimitiveId, std::uint32_t>> order;
  for (std::size_t s = 0; s < sample_count; ++s) {
    order.clear();
    for (std::uint32_t i = 0; i < fragments.size(); ++i)
      if (fragments[i].mask >> s & 1) order.push_back({-key_at(i, s), fragments[i].primitive, i});
    // Mostly the list is already in order: few fragments change places within a pixel.
    if (!std::is_sorted(order.begin(), order.end())) std::sort(order.begin(), order.end());
    float left = 1;
    for (const auto& [key, id, i] : order) {
      parts[i] += left * alphas[i];
      left *= 1 - alphas[i];
    }
  }
  for (float& part : parts) part /= float(sample_count);
  return parts;
}

DeepImage deep_layers(const Surfaces& surfaces, const View& view, const TriangleSource& source,
                      const FragmentPass& pass, const FragmentShader::Colorist& colorist, const Execution& execution) {
  const LayerShader shader(source, pass, colorist, ShadingRate::each_pixel, execution.isa);
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
    image.channels.push_back(
        id_image(surfaces, {int(planes.primitive.size()), 1}, planes.primitive, kind).channels.front());
  return image;
}

}  // namespace frontmost::shading
