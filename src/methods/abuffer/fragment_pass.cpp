// SPDX-License-Identifier: Apache-2.0
// Traverses one frame several times: first to find what is seen, then to paint it.
//
// A fragment is left out of a list if fragments before it hide all of the pixel. Which fragments hide depends on the
// opacities of materials alone, because colours are not known yet. A texture may still cut holes, so a blended material
// hides nothing. Clear fragments hide together, once only a negligible share passes through all of them.

#include "abuffer/fragment_pass.h"

#include "abuffer/composite/composite_kernel.h"

namespace frontmost::abuffer_detail {
namespace {

/// Far below the rounding of a sum of floats.
constexpr float kNegligible = 0x1p-40f;

/// Extracts the fragments that may be seen from sorted lists: fragments that are hidden in the whole pixel are left
/// out.
class Lister {
 public:
  Lister(const SamplePattern& pattern, const GatherScratch& scratch, const Opacities& opacities, float negligible)
      : pattern_(pattern), s_(scratch), opacities_(opacities), negligible_(negligible) {
    lists_.scratch = &scratch;
    lists_.fragments.reserve(scratch.arrived.count);
    lists_.numbers.reserve(scratch.arrived.count);
    lists_.begin.push_back(0);
  }
  [[nodiscard]] PixelLists take() { return std::move(lists_); }

  void add_pixel(int x, int y) {
    const std::uint32_t pixel = pixel_number(std::uint32_t(x), std::uint32_t(y));
    const std::size_t group = pixel / kGroup, length = s_.length(group);
    const std::uint64_t* words = s_.slot(group, 0) + pixel % kGroup;
    const float hidden = hidden_behind(words, length);
    float passes = 1;
    for (std::size_t i = 0; i < length && words[i * kGroup] != 0; ++i) {
      const std::uint32_t number = ~std::uint32_t(words[i * kGroup]);
      // Masks were not empty when they were appended, but may have lost all samples to holes since.
      if (s_.nearest_of(number) < hidden || s_.arrived.mask(number) == 0) continue;
      add(number);
      // At a single sample no part of a pixel is left: the first opaque fragment hides the rest.
      if (pattern_.count == 1 && hides_rest(id_of(number), passes)) break;
    }
    lists_.begin.push_back(std::uint32_t(lists_.fragments.size()));
  }

 private:
  /// Whether nothing, or next to nothing, is seen behind a further fragment that covers the pixel. `passes` is the
  /// share that all fragments before it let pass.
  [[nodiscard]] bool hides_rest(PrimitiveId id, float& passes) const {
    passes *= 1 - opacities_.least(id);
    return opacities_.is_opaque(id) || passes < negligible_;
  }
  [[nodiscard]] PrimitiveId id_of(std::uint32_t number) const { return s_.triangles.id[s_.arrived.triangle[number]]; }

  /// The key behind which nothing is seen anywhere in the pixel.
  [[nodiscard]] float hidden_behind(const std::uint64_t* words, std::size_t length) const {
    // -1 hides nothing: keys of fragments are at least 0.
    float key = -1, passes = 1, farthest = std::numeric_limits<float>::infinity();
    if (pattern_.count == 1) return key;
    for (std::size_t i = 0; i < length && words[i * kGroup] != 0; ++i) {
      const std::uint32_t number = ~std::uint32_t(words[i * kGroup]);
      if (s_.arrived.mask(number) != pattern_.full()) continue;
      // Clear fragments hide only together, and so only what is behind all of them.
      farthest = std::min(farthest, s_.farthest_of(number));
      if (hides_rest(id_of(number), passes))
        key = std::max(key, opacities_.is_opaque(id_of(number)) ? s_.farthest_of(number) : farthest);
    }
    return key;
  }

  void add(std::uint32_t number) {
    const std::size_t t = s_.arrived.triangle[number];
    Fragment f;
    f.mask = s_.arrived.mask(number);
    f.primitive = s_.triangles.id[t];
    f.key = s_.arrived.key_of(number);
    f.key_dx = s_.triangles.gx[t] * kSubPixels;
    f.key_dy = s_.triangles.gy[t] * kSubPixels;
    f.opacity = opacities_.of(f.primitive);
    lists_.fragments.push_back(f);
    lists_.numbers.push_back(number);
  }

  const SamplePattern& pattern_;
  const GatherScratch& s_;
  const Opacities& opacities_;
  const float negligible_;
  PixelLists lists_;
};

/// One channel of the colours, with its own alphas.
std::vector<glm::vec4> channel_of(const FragmentColors& colors, int channel) {
  std::vector<glm::vec4> table = colors.straight;
  for (std::size_t i = 0; i < table.size(); ++i) {
    const float alpha = colors.alphas[i][channel];
    if (alpha < 0) continue;
    // The fragment's contribution stays the same. A fragment with alpha 0 hides nothing and adds nothing.
    table[i][channel] *= alpha > 0 ? table[i].a / alpha : 0.0f;
    table[i].a = alpha;
  }
  return table;
}

/// Composites tinted fragments as three pictures of one channel each.
PaintedPixels composite(const CompositeInput& input, const Rectangle& pixels, const GatherScratch& fragments,
                        const FragmentColors& colors) {
  if (colors.alphas.empty()) return {composite_tile(input, pixels, fragments, colors.straight), {}};
  PaintedPixels painted;
  painted.colors.resize(std::size_t(pixels.width) * std::size_t(pixels.height));
  painted.alphas.resize(painted.colors.size());
  for (int c = 0; c < 3; ++c) {
    const std::vector<glm::vec4> channel = composite_tile(input, pixels, fragments, channel_of(colors, c));
    for (std::size_t i = 0; i < channel.size(); ++i) {
      painted.colors[i][c] = channel[i][c];
      painted.alphas[i][c] = channel[i].a;
    }
  }
  for (std::size_t i = 0; i < painted.colors.size(); ++i) {
    const glm::vec3& a = painted.alphas[i];
    painted.colors[i].a = a == glm::vec3(a.x) ? a.x : (a.x + a.y + a.z) / 3;
  }
  return painted;
}

}  // namespace

FragmentPass::FragmentPass(const Surfaces& surfaces, const View& view, const AbufferOptions& options,
                           const Execution& execution)
    : opacity_(options.opacity),
      frame_(surfaces, view, options, execution),
      opacities_(surfaces, options.opacity, execution),
      copies_(copy_rule(opacities_)) {}

PixelLists FragmentPass::lists_of(const Rectangle& pixels, const GatherScratch& fragments, float negligible) const {
  Lister lister(frame_.pattern(), fragments, opacities_, negligible);
  for (int y = 0; y < pixels.height; ++y)
    for (int x = 0; x < pixels.width; ++x) lister.add_pixel(x, y);
  return lister.take();
}

void FragmentPass::list_primitives(const Note& note, const LeaveOut& leave_out, const Execution& execution) const {
  const auto visit = [&](const Rectangle& /*pixels*/, const GatherScratch* fragments) {
    if (fragments) note({fragments->triangles.id.data(), fragments->triangles.count});
  };
  frame_.visit_tiles(copies_, visit, leave_out, execution);
}

void FragmentPass::look(const Look& look, const Execution& execution) const {
  const auto visit = [&](const Rectangle& pixels, const GatherScratch* fragments) {
    if (fragments) look(pixels, lists_of(pixels, *fragments, 0));
  };
  frame_.visit_lists(copies_, visit, nullptr, execution);
}

void FragmentPass::paint(const Paint& paint, const Receive& receive, const LeaveOut& leave_out,
                         const Execution& execution) const {
  const CompositeInput input{frame_.pattern(), opacity_, execution.isa};
  const auto visit = [&](const Rectangle& pixels, const GatherScratch* fragments) {
    if (!fragments) return receive(pixels, nullptr);
    // Colours are indexed by number of arrival, as the compositor reads them; fragments that the lists leave out have
    // no effect.
    FragmentColors colors{std::vector<glm::vec4>(fragments->arrived.count, glm::vec4(0)), {}};
    paint(pixels, lists_of(pixels, *fragments, kNegligible), colors);
    const PaintedPixels painted = composite(input, pixels, *fragments, colors);
    receive(pixels, &painted);
  };
  frame_.visit_lists(copies_, visit, leave_out, execution);
}

}  // namespace frontmost::abuffer_detail
