// SPDX-License-Identifier: Apache-2.0
// Partners are found by comparing all corners with all, almost without branches, because the relevant ones are
// unpredictable.
//
//    corners of a vertex     next:  b c d a        Corner i runs from `next` to `last` around the vertex. Its partner
//                            last:  c d a b        is the corner whose `next` is its `last`: the triangle beyond
//                                                  that edge. In a closed star every corner has one partner.

#include "lines/mesh/corner_table.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lines/mesh/stars_kernel.cpp"
#include "base/highway-inl.h"
#include "base/isa.h"
// After base/highway-inl.h, for each target.
#include "base/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::lines_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using DU = hn::CappedTag<std::uint32_t, Star::most>;

struct StarCorners {
  std::size_t count;
  HWY_ALIGN std::uint32_t next[Star::most], last[Star::most];
  HWY_ALIGN std::uint32_t partner[Star::most];  ///< the corner beyond the edge to `last`
  const SeenTriangle* triangle[Star::most];

  HWY_INLINE StarCorners(const SeenMesh& seen, std::span<const Corner> corners) : count(corners.size()) {
    for (std::size_t i = 0; i < count; ++i) {
      next[i] = corners[i].next(seen.mesh);
      last[i] = corners[i].last(seen.mesh);
      triangle[i] = &seen.triangles[corners[i].triangle()];
    }
  }
  /// Sets the partners. \returns whether all are paired.
  HWY_INLINE bool Pair() {
    const DU d;
    std::uint64_t once = 0, again = 0;
    for (std::size_t b = 0; b < count; b += hn::Lanes(d)) {
      const auto lasts = hn::Load(d, last + b);
      auto partners = hn::Zero(d);
      std::uint64_t found = 0, twice = 0;
      for (std::size_t i = 0; i < count; ++i) {
        const auto is_partner = hn::Eq(lasts, hn::Set(d, next[i]));
        partners = hn::IfThenElse(is_partner, hn::Set(d, std::uint32_t(i)), partners);
        const std::uint64_t bits = frontmost::HWY_NAMESPACE::BitsOf(d, is_partner);
        twice |= found & bits;
        found |= bits;
      }
      hn::Store(partners, d, partner + b);
      once |= found << b;
      again |= twice << b;
    }
    const std::uint64_t all = (std::uint64_t(1) << count) - 1;
    // If some corner is nobody's partner, another corner has two.
    std::uint64_t partners = 0, pillows = 0;
    for (std::size_t j = 0; j < count; ++j) {
      partners |= std::uint64_t(1) << partner[j];
      pillows |= std::uint64_t(next[j] == last[partner[j]]);
    }
    return (once & all) == all && (again & all) == 0 && partners == all && pillows == 0;
  }
  HWY_INLINE bool IsSpread(std::span<const Corner> corners) const {
    std::uint32_t turns = 63, once = 0, again = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint32_t climbs = triangle[i]->climbs(corners[i].k());
      turns &= triangle[i]->turns();
      again |= once & climbs;
      once |= climbs;
    }
    return ((turns | turns >> 3) & once & ~again & 7) != 0;
  }
  HWY_INLINE std::uint16_t Asked(std::uint32_t vertex, float plain_cosine) const {
    std::uint32_t asked = 0;
    for (std::size_t j = 0; j < count; ++j) {
      const SeenTriangle &a = *triangle[j], &b = *triangle[partner[j]];
      const float cosine = a.normal.x * b.normal.x + a.normal.y * b.normal.y + a.normal.z * b.normal.z;
      const bool is_plain = int(a.facing() == b.facing()) & int(cosine > plain_cosine);
      asked |= std::uint32_t(int(last[j] > vertex) & int(!is_plain)) << j;
    }
    return std::uint16_t(asked);
  }
};

void Stars(const SeenMesh& seen, const CornerTable& table, float plain_cosine, std::size_t begin, std::size_t end,
           Star* stars) {
  for (std::size_t v = begin; v < end; ++v) {
    Star& star = stars[v - begin];
    star = {false, false, 0};
    const std::span<const Corner> at = table[v];
    if (at.size() > Star::most) continue;
    StarCorners corners(seen, at);
    if (!corners.Pair()) continue;
    star = {true, corners.IsSpread(at), corners.Asked(std::uint32_t(v), plain_cosine)};
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::lines_detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace frontmost::lines_detail {

FRONTMOST_KERNELS(Stars);

StarsKernel stars_kernel(Isa isa) { return kernel_for(StarsKernels, isa); }

}  // namespace frontmost::lines_detail
#endif  // HWY_ONCE
