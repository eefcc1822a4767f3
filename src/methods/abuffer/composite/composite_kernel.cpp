// SPDX-License-Identifier: Apache-2.0
// Composites sorted lists, nearest first, sixteen pixels at once. Pixels in which fragments change places are then
// composited again one by one.
//
// T. Porter, T. Duff. Compositing Digital Images. 1984 (over); L. Carpenter. The A-buffer. 1984.
//
// Each sub-sample stores its transmittance only. A fragment's weight is its opacity times the mean transmittance over
// the sub-samples that it covers, and the picture is the sum of colours by weight. Sums over sub-samples are made in
// trees that first add values half the count apart, here and in conflicts-inl.h. Sums of equal values are exact, so a
// pixel's bits depend neither on other pixels nor on the width of vectors.

#include "abuffer/composite/composite_kernel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "abuffer/composite/composite_kernel.cpp"
#include "base/highway-inl.h"
#include "base/isa.h"
// This header must come after Highway's, so it is included in a separate block.
#include "abuffer/composite/conflicts-inl.h"
#include "abuffer/gather/fragment_sink-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::abuffer_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Sixteen pixels, premultiplied.
struct GroupColors {
  HWY_ALIGN_MAX float channel[4][kGroup];
};

/// Colours of a vector of pixels, with straight alpha.
struct LaneColors {
  VF red, green, blue, alpha;
};

#if HWY_TARGET != HWY_SCALAR
/// Returns a vector with one colour of the table in every four lanes. The indices of these colours are numbers[0],
/// numbers[4], numbers[8] and so on.
template <class D>
HWY_INLINE hn::Vec<D> ColorsBeside(D d, const float* table, const std::uint32_t* numbers) {
  if constexpr (hn::MaxLanes(D()) == 4) {
    return hn::LoadU(d, table + std::size_t(4) * numbers[0]);
  } else {
    const hn::Half<D> half;
    return hn::Combine(d, ColorsBeside(half, table, numbers + hn::Lanes(half)), ColorsBeside(half, table, numbers));
  }
}
#endif

/// Returns the colours with these numbers in a table. Each colour is loaded whole, and the vectors are transposed.
/// Compared with gathering channels one by one, pictures take 4 % less time on SSE4 and AVX2, and 1 to 2 % less on
/// AVX-512.
HWY_INLINE LaneColors ColorsOf(const float* table, const std::uint32_t* numbers) {
  const DF d;
#if HWY_TARGET == HWY_SCALAR
  const float* color = table + std::size_t(4) * numbers[0];
  return {hn::Set(d, color[0]), hn::Set(d, color[1]), hn::Set(d, color[2]), hn::Set(d, color[3])};
#else
  const VF c0 = ColorsBeside(d, table, numbers), c1 = ColorsBeside(d, table, numbers + 1);
  const VF c2 = ColorsBeside(d, table, numbers + 2), c3 = ColorsBeside(d, table, numbers + 3);
  const VF even = hn::InterleaveLower(d, c0, c2), odd = hn::InterleaveLower(d, c1, c3);
  const VF upper_even = hn::InterleaveUpper(d, c0, c2), upper_odd = hn::InterleaveUpper(d, c1, c3);
  return {hn::InterleaveLower(d, even, odd), hn::InterleaveUpper(d, even, odd),
          hn::InterleaveLower(d, upper_even, upper_odd), hn::InterleaveUpper(d, upper_even, upper_odd)};
#endif
}

/// Transmittance at every sub-sample of a vector of pixels.
template <int kSamples>
class ShownThrough {
 public:
  explicit HWY_INLINE ShownThrough(VF all) {
    for (VF& left : left_) left = all;
  }

  /// Returns the sum over the sub-samples in the masks, or over all if kOfAll, and then multiplies these sub-samples by
  /// `passes`.
  template <bool kOfAll>
  HWY_INLINE VF Cover(VU low, VU high, VF passes) {
    VF sum[kStride];
    for (std::size_t i = 0; i < kStride; ++i) {
      sum[i] = CoverFrom<kOfAll, 0, 1>(left_ + i, low, high, passes);
      if (kOfAll) continue;
      low = hn::ShiftRight<1>(low);
      if (kSamples > 32) high = hn::ShiftRight<1>(high);
    }
    for (std::size_t half = kStride / 2; half > 0; half /= 2)
      for (std::size_t i = 0; i < half; ++i) sum[i] = hn::Add(sum[i], sum[i + half]);
    return sum[0];
  }

 private:
  /// Sub-samples at this distance are unrolled, and a loop does the rest. If all are unrolled, the compiler takes
  /// minutes.
  static constexpr std::size_t kStride = kSamples < 8 ? kSamples : 8, kCount = kSamples / kStride;

  /// Handles the sub-samples from kFirst * kStride on, in steps of kStep, relative to `left`.
  template <bool kOfAll, std::size_t kFirst, std::size_t kStep>
  static HWY_INLINE VF CoverFrom(VF* left, VU low, VU high, VF passes) {
    if constexpr (kStep < kCount) {
      const VF even = CoverFrom<kOfAll, kFirst, 2 * kStep>(left, low, high, passes);
      return hn::Add(even, CoverFrom<kOfAll, kFirst + kStep, 2 * kStep>(left, low, high, passes));
    } else {
      constexpr std::size_t sample = kFirst * kStride;
      const VF before = left[sample], after = hn::Mul(before, passes);
      if (kOfAll) {
        left[sample] = after;
        return before;
      }
      const auto bit = hn::Set(DU(), std::uint32_t(1) << sample % 32);
      const auto covered = hn::RebindMask(DF(), hn::TestBit(sample < 32 ? low : high, bit));
      left[sample] = hn::IfThenElse(covered, after, before);
      return hn::IfThenElseZero(covered, before);
    }
  }

  VF left_[kSamples];
};

template <int kSamples>
class GroupCompositor {
 public:
  GroupCompositor(const GroupFragments& fragments, const glm::vec4* table, float opacity)
      : g_(fragments), table_(reinterpret_cast<const float*>(table)), opacity_(opacity) {}

  /// Composites `length` slots in the order of depth.
  HWY_NOINLINE void Composite(std::size_t length, GroupColors& colors) {
    for (std::size_t lane = 0; lane < kGroup; lane += hn::Lanes(DF())) CompositeLanes(lane, length, colors);
  }

 private:
  static constexpr std::uint64_t kAll = kSamples == 64 ? ~std::uint64_t(0) : (std::uint64_t(1) << kSamples % 64) - 1;
  static constexpr float kScale = 1.0f / kSamples;

  HWY_INLINE void CompositeLanes(std::size_t lane, std::size_t length, GroupColors& colors) {
    const DF d;
    red_ = green_ = blue_ = hn::Zero(d);
    VF left = hn::Set(d, 1.0f);
    std::size_t slot = 0;
    for (; slot < length && CoversAll(slot * kGroup + lane); ++slot) {
      const VF alpha = Fetch(slot * kGroup + lane);
      AddWeighted(hn::Mul(left, alpha));
      left = hn::Mul(left, hn::Sub(hn::Set(d, 1.0f), alpha));
    }
    if (slot < length) left = CompositeApart(lane, slot, length, left);
    hn::Store(red_, d, colors.channel[0] + lane);
    hn::Store(green_, d, colors.channel[1] + lane);
    hn::Store(blue_, d, colors.channel[2] + lane);
    hn::Store(hn::Sub(hn::Set(d, 1.0f), left), d, colors.channel[3] + lane);
  }

  /// Continues from the first slot at which sub-samples differ. \returns the mean transmittance through all slots.
  HWY_INLINE VF CompositeApart(std::size_t lane, std::size_t slot, std::size_t length, VF before) {
    const DF d;
    const DU du;
    const VF one = hn::Set(d, 1.0f), scale = hn::Set(d, kScale);
    ShownThrough<kSamples> left(before);
    for (; slot < length; ++slot) {
      const std::size_t at = slot * kGroup + lane;
      const VF alpha = Fetch(at), passes = hn::Sub(one, alpha);
      const VU low = hn::Load(du, g_.mask_low.data() + at);
      const VU high = kSamples > 32 ? hn::Load(du, g_.mask_high.data() + at) : low;
      const VF sum =
          CoversAll(at) ? left.template Cover<true>(low, high, passes) : left.template Cover<false>(low, high, passes);
      AddWeighted(hn::Mul(hn::Mul(sum, scale), alpha));
    }
    return hn::Mul(left.template Cover<true>(hn::Zero(du), hn::Zero(du), one), scale);
  }

  [[nodiscard]] HWY_INLINE bool CoversAll(std::size_t at) const {
    const DU d;
    VU covered = hn::Xor(hn::Load(d, g_.mask_low.data() + at), hn::Set(d, std::uint32_t(kAll)));
    if (kSamples > 32)
      covered = hn::Or(covered, hn::Xor(hn::Load(d, g_.mask_high.data() + at), hn::Set(d, std::uint32_t(kAll >> 32))));
    return hn::AllTrue(d, hn::Eq(covered, hn::Zero(d)));
  }

  /// Loads the colours of a slot. \returns their opacities, which are 0 where there is no fragment.
  HWY_INLINE VF Fetch(std::size_t at) {
    const DF d;
    slot_ = ColorsOf(table_, g_.number.data() + at);
    const VF nearest = hn::Load(d, g_.nearest.data() + at);
    return hn::IfThenElseZero(hn::Gt(nearest, hn::Set(d, -1.0f)), hn::Mul(slot_.alpha, hn::Set(d, opacity_)));
  }

  HWY_INLINE void AddWeighted(VF weight) {
    red_ = hn::Add(red_, hn::Mul(weight, slot_.red));
    green_ = hn::Add(green_, hn::Mul(weight, slot_.green));
    blue_ = hn::Add(blue_, hn::Mul(weight, slot_.blue));
  }

  const GroupFragments& g_;
  const float* table_;
  const float opacity_;
  VF red_, green_, blue_;
  LaneColors slot_;
};

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
