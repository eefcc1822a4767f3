// SPDX-License-Identifier: Apache-2.0
// Computes coverage masks, and appends fragments to a tile.
//
// J. Pineda. A Parallel Algorithm for Polygon Rasterization. 1988 (edge functions).
//
// Coordinates are relative to the tile, in 1/256 pixel. A sample is covered if E >= 0 for three edge functions, biased
// by the top-left rule (y down, area positive: an edge is left if it goes up, top if it is level and goes right).
// Samples lie on multiples of 16 units from a pixel's corner, so an edge value at a corner may be shifted right by 4
// before stepping: a step is then a multiple of dx or -dy, and the sign is still exact.

// Included once for every target.
#if defined(FRONTMOST_ABUFFER_FRAGMENT_SINK_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FRONTMOST_ABUFFER_FRAGMENT_SINK_INL_H_
#undef FRONTMOST_ABUFFER_FRAGMENT_SINK_INL_H_
#else
#define FRONTMOST_ABUFFER_FRAGMENT_SINK_INL_H_
#endif

#include <algorithm>

#include "abuffer/gather/gather_kernel.h"
#include "base/compactor-inl.h"
#include "base/highway-inl.h"
#include "base/lane_types-inl.h"
#include "base/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::abuffer_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using namespace frontmost::HWY_NAMESPACE;

constexpr std::int32_t kStepsOfPixel = kSubPixels / SamplePattern::unit;

HWY_INLINE bool IsTopLeft(std::int32_t dx, std::int32_t dy) { return dy < 0 || (dy == 0 && dx > 0); }

struct FragmentBounds {
  VI x0, x1, y0, y1;  // both ends included
};

/// The differences of a triangle's edge functions between each sample and the pixel's corner.
struct SampleSteps {
  HWY_ALIGN_MAX std::int32_t step[3][SamplePattern::max_count];
};

/// The sample positions, padded to whole vectors.
class SampleTable {
 public:
  explicit SampleTable(const SamplePattern& p) : count_(std::size_t(p.count)), full_(p.full()) {
    for (std::size_t i = 0; i < SamplePattern::max_count; ++i) {
      x_[i] = p.x[i];
      y_[i] = p.y[i];
    }
  }

  HWY_INLINE void Fill(SampleSteps& steps, int k, std::int32_t dx, std::int32_t dy) const {
    const DI d;
    for (std::size_t i = 0; i < count_; i += hn::Lanes(d))
      hn::Store(hn::Sub(hn::Mul(hn::Set(d, dx), hn::Load(d, y_ + i)), hn::Mul(hn::Set(d, dy), hn::Load(d, x_ + i))), d,
                steps.step[k] + i);
  }

  /// Returns the mask of covered samples. e0, e1 and e2 are the edge functions at the pixel's corner.
  [[nodiscard]] HWY_INLINE std::uint64_t MaskOf(const SampleSteps& steps, std::int32_t e0, std::int32_t e1,
                                                std::int32_t e2) const {
    const DI d;
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < count_; i += hn::Lanes(d)) {
      const VI a = hn::Add(hn::Set(d, e0), hn::Load(d, steps.step[0] + i));
      const VI b = hn::Add(hn::Set(d, e1), hn::Load(d, steps.step[1] + i));
      const VI c = hn::Add(hn::Set(d, e2), hn::Load(d, steps.step[2] + i));
      const MI inside = hn::Gt(hn::Or(hn::Or(a, b), c), hn::Set(d, -1));
      bits |= BitsOf(d, inside) << i;
    }
    return bits & full_;
  }
  [[nodiscard]] std::uint64_t full() const { return full_; }

 private:
  HWY_ALIGN_MAX std::int32_t x_[SamplePattern::max_count];
  HWY_ALIGN_MAX std::int32_t y_[SamplePattern::max_count];
  std::size_t count_;
  std::uint64_t full_;
};

/// Keys are those of view/triangle_keys.h. Within a pixel, a key differs from the centre's by at most 128 units of
/// slope and the rounding of both.
constexpr float kHalfPixel = kSubPixels / 2;
/// Bound on the rounding of two keys, with a margin: each key has three roundings of at most 2^-24 of the sum of its
/// absolute terms. The second constant covers keys so small that roundings are not relative.
constexpr float kKeyRounding = 16.0f / 16777216.0f, kLeastRounding = 1e-42f;

class FragmentSink {
 public:
  FragmentSink(const GatherInput& frame, const GatherJob& job, GatherScratch& scratch)
      : samples(frame.pattern),
        pattern(frame.pattern),
        width(job.pixels.width),
        height(job.pixels.height),
        triangles(scratch.triangles),
        arrived(scratch.arrived),
        counts(scratch.counts.data()) {}

  /// Returns the pixels of the tile whose samples may lie within these bounds of vertices.
  [[nodiscard]] HWY_INLINE FragmentBounds BoundsOf(VI x_min, VI x_max, VI y_min, VI y_max) const {
    return {First(x_min, pattern.high_x), Last(x_max, pattern.low_x, width), First(y_min, pattern.high_y),
            Last(y_max, pattern.low_y, height)};
  }

  /// Returns false if the tile must be divided. Tiles of one pixel always have room, up to the limit.
  [[nodiscard]] bool HasRoom() {
    if (HWY_LIKELY(arrived.count <= kMostOfTile)) return true;
    if (width * height > 1) return false;
    // Number 0 stands for no fragment.
    if (arrived.count - Arrived::first > kMostOfPixel)
      throw Error(ErrorCode::limit_exceeded, "abuffer", "more than 1,048,575 fragments in one pixel");
    arrived.grow(arrived.count + kMostAtOnce);
    return true;
  }

  /// Appends one fragment of a pixel, unless its mask is empty; `key` holds the key's bits.
  HWY_INLINE void Append(std::uint32_t pixel, std::uint32_t key, std::uint32_t triangle, std::uint64_t mask) {
    const std::size_t n = arrived.count;
    arrived.key[n] = key;
    arrived.triangle[n] = triangle;
    arrived.mask_low[n] = std::uint32_t(mask);
    arrived.mask_high[n] = std::uint32_t(mask >> 32);
    // The entry is always written, but counted only if something is covered: a branch would be mispredicted half of the
    // time.
    const std::uint32_t covered = mask != 0;
    arrived.place[n] = pixel << kRankBits | counts[pixel];
    counts[pixel] += covered;
    arrived.count += covered;
  }

  /// Appends a vector of fragments that cover all samples.
  HWY_INLINE void AppendVector(VU key, VU place, std::uint32_t triangle) {
    const DU d;
    const std::size_t n = arrived.count;
    // Stores whole vectors without checking the room: kMostAtOnce is reserved for what one step may add.
    hn::StoreU(key, d, arrived.key.data() + n);
    hn::StoreU(place, d, arrived.place.data() + n);
    FillIn(n, triangle);
    arrived.count += hn::Lanes(d);
  }

  /// Appends those fragments of a vector that the mask `some` selects.
  HWY_INLINE void AppendSome(VU key, VU place, std::uint32_t triangle, hn::Mask<DU> some) {
    const Compactor<DU> compact(some);
    const std::size_t n = arrived.count;
    compact.Store(key, arrived.key.data() + n);
    compact.Store(place, arrived.place.data() + n);
    FillIn(n, triangle);
    arrived.count += compact.count();
  }

  const SampleTable samples;
  const SamplePattern& pattern;
  const std::int32_t width, height;
  LocalTriangles& triangles;
  Arrived& arrived;
  std::uint32_t* const counts;

 private:
  /// Fills in the triangle and the full masks of a vector of fragments from number n on.
  HWY_INLINE void FillIn(std::size_t n, std::uint32_t triangle) {
    const DU d;
    hn::StoreU(hn::Set(d, triangle), d, arrived.triangle.data() + n);
    hn::StoreU(hn::Set(d, std::uint32_t(samples.full())), d, arrived.mask_low.data() + n);
    hn::StoreU(hn::Set(d, std::uint32_t(samples.full() >> 32)), d, arrived.mask_high.data() + n);
  }

  static HWY_INLINE VI First(VI minimum, std::int32_t last) {
    const DI d;
    return hn::Max(hn::ShiftRight<8>(hn::Add(minimum, hn::Set(d, 255 - last * SamplePattern::unit))), hn::Zero(d));
  }
  static HWY_INLINE VI Last(VI maximum, std::int32_t first, std::int32_t size) {
    const DI d;
    return hn::Min(hn::ShiftRight<8>(hn::Sub(maximum, hn::Set(d, first * SamplePattern::unit))), hn::Set(d, size - 1));
  }
};

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::abuffer_detail
HWY_AFTER_NAMESPACE();

#endif  // include guard by target
