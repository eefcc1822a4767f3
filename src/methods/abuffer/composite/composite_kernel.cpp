// SPDX-License-Identifier: Apache-2.0
// Composites sorted lists, nearest first: transmittance is multiplied down, so nothing is ever read again.
//
// T. Porter, T. Duff. Compositing Digital Images. 1984 (over); L. Carpenter. The A-buffer. 1984.
//
// The sixteen pixels of a group are composited at once. Pixels in which fragments change places are then composited
// again one by one.

#include "abuffer/composite/composite_kernel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "abuffer/composite/composite_kernel.cpp"
#include "base/highway-inl.h"
#include "base/isa.h"
// This header must come after Highway's, so it is included in a separate block.
#include "abuffer/composite/conflicts-inl.h"
#include "abuffer/composite/group_composite-inl.h"
#include "abuffer/composite/pixel_composite-inl.h"
#include "abuffer/gather/fragment_sink-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::abuffer_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

class TileCompositor {
 public:
  TileCompositor(const CompositeInput& input, const Rectangle& rectangle, const GatherScratch& scratch,
                 const std::vector<glm::vec4>& colors)
      : input_(input),
        rectangle_(rectangle),
        scratch_(scratch),
        colors_(colors.data()),
        pixels_(std::size_t(rectangle.width) * std::size_t(rectangle.height)) {}

  template <int kSamples>
  std::vector<glm::vec4> Run() {
    GroupReader<(kSamples > 32)> reader(scratch_, fragments_, input_.pattern.full());
    GroupCompositor<kSamples> groups(fragments_, colors_, input_.opacity);
    for (int y = 0; y < rectangle_.height; y += 4)
      for (int x = 0; x < rectangle_.width; x += 4) {
        const auto group = std::size_t((y / 4) * kBlocksAcross + x / 4);
        GroupColors colors;
        const std::uint64_t in_conflict = reader.Read(group);
        groups.Composite(scratch_.length(group), colors);
        // At a single sample the order is that of the lists.
        if constexpr (kSamples > 1) {
          PixelCompositor<kSamples> pixels(input_, scratch_, fragments_, colors_);
          ForEachBit(in_conflict, [&](std::size_t pixel) {
            const glm::vec4 c = pixels.Composite(group, pixel);
            for (int k = 0; k < 4; ++k) colors.channel[k][pixel] = c[k];
          });
        }
        Write(colors, x, y);
      }
    return std::move(pixels_);
  }

 private:
  /// Writes the group whose first pixel is (x, y) of the rectangle, which may end within the group.
  HWY_INLINE void Write(const GroupColors& colors, int x, int y) {
    for (int row = 0; row < HWY_MIN(4, rectangle_.height - y); ++row)
      for (int column = 0; column < HWY_MIN(4, rectangle_.width - x); ++column) {
        glm::vec4& pixel = pixels_[std::size_t(y + row) * std::size_t(rectangle_.width) + std::size_t(x + column)];
        for (int k = 0; k < 4; ++k) pixel[k] = colors.channel[k][4 * row + column];
      }
  }

  const CompositeInput& input_;
  const Rectangle& rectangle_;
  const GatherScratch& scratch_;
  const glm::vec4* const colors_;
  GroupFragments fragments_;
  std::vector<glm::vec4> pixels_;
};

std::vector<glm::vec4> CompositeTile(const CompositeInput& input, const Rectangle& pixels,
                                     const GatherScratch& fragments, const std::vector<glm::vec4>& colors) {
  TileCompositor compositor(input, pixels, fragments, colors);
  // The count is a compile-time constant, so that loops over sub-samples are unrolled and transmittance stays in
  // registers.
  switch (input.pattern.count) {
    case 1: return compositor.Run<1>();
    case 2: return compositor.Run<2>();
    case 4: return compositor.Run<4>();
    case 8: return compositor.Run<8>();
    case 16: return compositor.Run<16>();
    default: return compositor.Run<64>();
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::abuffer_detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace frontmost::abuffer_detail {

FRONTMOST_KERNELS(CompositeTile);

std::vector<glm::vec4> composite_tile(const CompositeInput& input, const Rectangle& pixels,
                                      const GatherScratch& fragments, const std::vector<glm::vec4>& colors) {
  return kernel_for(CompositeTileKernels, input.isa)(input, pixels, fragments, colors);
}

}  // namespace frontmost::abuffer_detail
#endif  // HWY_ONCE
