// SPDX-License-Identifier: Apache-2.0
// Setting up triangles in the order of submission: vertices, pixel rectangles and facing, many at a time.

#include "zbuffer/place_kernel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "zbuffer/place_kernel.cpp"
#include "base/isa.h"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"
// After Highway: a block of its own.
#include "base/compactor-inl.h"
#include "zbuffer/batch-inl.h"
#include "zbuffer/snap_piece-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::zbuffer_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

class Placer {
 public:
  Placer(const PlaceTarget& target, const WorldTriangles& piece, PieceVertices& vertices, PlacedTriangles& placed)
      : target_(target), piece_(piece), vertices_(vertices), placed_(placed) {}

  void Place() {
    (void)SnapVertices(target_.transform, piece_.positions, vertices_,
                       [](const auto&, const auto&) HWY_ATTR { return hn::Set(DF(), -1.0f); });
    ForTriples(piece_.corners, [&](std::size_t i, const std::uint32_t* corners) HWY_ATTR { PlaceVector(i, corners); });
  }

 private:
  HWY_INLINE void PlaceVector(std::size_t first, const std::uint32_t* corners) {
    const DI d;
    const DF df;
    VU numbers[3];
    hn::LoadInterleaved3(DU(), corners, numbers[0], numbers[1], numbers[2]);
    if (piece_.is_mirrored) std::swap(numbers[1], numbers[2]);
    const Corners a = Fetch(numbers[0]), b = Fetch(numbers[1]), c = Fetch(numbers[2]);
    const VF ka = FetchKeys(vertices_, a), kb = FetchKeys(vertices_, b), kc = FetchKeys(vertices_, c);
    const std::size_t live = HWY_MIN(piece_.corners.size() - first, hn::Lanes(d));
    placed_.make_room(live);
    if (!hn::AllFalse(df, hn::Lt(hn::Min(ka, hn::Min(kb, kc)), hn::Zero(df)))) {
      // Rare. All of the vector, so that the order is kept.
      for (std::size_t k = 0; k < live; ++k) append_clipped(target_, piece_, first + k, placed_);
      return;
    }
    const PixelRange px = PixelsOf(RangeOf(a.x, b.x, c.x), target_.low.x, target_.high.x, target_.view.width);
    const PixelRange py = PixelsOf(RangeOf(a.y, b.y, c.y), target_.low.y, target_.high.y, target_.view.height);
    MI keep = hn::Lt(hn::Iota(d, 0), hn::Set(d, std::int32_t(live)));
    keep = hn::AndNot(hn::Or(hn::Gt(px.first, px.last), hn::Gt(py.first, py.last)), keep);
    if (hn::AllFalse(d, keep)) return;
    const VF area = AreaOf(a, b, c);
    const MI front = hn::RebindMask(d, hn::Lt(area, hn::Zero(df)));  // counter-clockwise to the eye; y is down
    keep = hn::And(keep, Facing(target_.view.culling, front, hn::RebindMask(d, hn::Gt(area, hn::Zero(df)))));

    const Compactor<DI> compact(keep);
    const std::size_t at = placed_.count;
    const auto store = [&](std::size_t k, const Corners& corner, VF key) HWY_ATTR {
      compact.Store(corner.x, placed_.x[k].data() + at);
      compact.Store(corner.y, placed_.y[k].data() + at);
      compact.Store(key, placed_.key[k].data() + at);
    };
    // Turn the area positive: swap the last two corners of front faces.
    const auto front_f = hn::RebindMask(df, front);
    store(0, a, ka);
    store(1, Chosen(front, c, b), hn::IfThenElse(front_f, kc, kb));
    store(2, Chosen(front, b, c), hn::IfThenElse(front_f, kb, kc));
    compact.Store(hn::Min(ka, hn::Min(kb, kc)), placed_.low.data() + at);
    compact.Store(hn::Max(ka, hn::Max(kb, kc)), placed_.high.data() + at);
    const VI id = hn::Add(hn::Iota(d, 0), hn::Set(d, std::int32_t(piece_.first_id + std::uint32_t(first))));
    compact.Store(hn::BitCast(DU(), id), placed_.id.data() + at);
    compact.Store(hn::BitCast(DU(), OnlyTile(px, py)), placed_.tile.data() + at);
    placed_.count += compact.count();
  }

  [[nodiscard]] HWY_INLINE Corners Fetch(VU number) const {
    return FetchCorners(vertices_, number, piece_.first_position);
  }

  [[nodiscard]] HWY_INLINE VI OnlyTile(const PixelRange& px, const PixelRange& py) const {
    const DI d;
    static_assert(kSubmissionTile == 1 << 7);
    const VI x = hn::ShiftRight<7>(px.first), y = hn::ShiftRight<7>(py.first);
    const MI single = hn::And(hn::Eq(x, hn::ShiftRight<7>(px.last)), hn::Eq(y, hn::ShiftRight<7>(py.last)));
    const VI tile = hn::Add(hn::Mul(y, hn::Set(d, target_.grid.across)), x);
    return hn::IfThenElse(single, tile, hn::Set(d, std::int32_t(no_index)));
  }

  /// Twice the signed area, rounded once: within the guard band doubles hold it exactly.
  [[nodiscard]] static HWY_INLINE VF AreaOf(const Corners& a, const Corners& b, const Corners& c) {
    using DD = hn::ScalableTag<double>;
    using Half = hn::Rebind<std::int32_t, DD>;
    const DI d;
    const DD dd;
    const Half half;
    HWY_ALIGN_MAX std::int32_t x1[kMaxLanes], y1[kMaxLanes], x2[kMaxLanes], y2[kMaxLanes];
    HWY_ALIGN_MAX float area[kMaxLanes];
    hn::Store(hn::Sub(b.x, a.x), d, x1);
    hn::Store(hn::Sub(b.y, a.y), d, y1);
    hn::Store(hn::Sub(c.x, a.x), d, x2);
    hn::Store(hn::Sub(c.y, a.y), d, y2);
    const auto load = [&](const std::int32_t* from) HWY_ATTR { return hn::PromoteTo(dd, hn::Load(half, from)); };
    for (std::size_t i = 0; i < hn::Lanes(d); i += hn::Lanes(dd)) {
      const auto doubled = hn::Sub(hn::Mul(load(x1 + i), load(y2 + i)), hn::Mul(load(x2 + i), load(y1 + i)));
      hn::Store(hn::DemoteTo(hn::Rebind<float, DD>(), doubled), hn::Rebind<float, DD>(), area + i);
    }
    return hn::Load(DF(), area);
  }

  const PlaceTarget& target_;
  const WorldTriangles& piece_;
  PieceVertices& vertices_;
  PlacedTriangles& placed_;
};

void PlaceTriangles(const PlaceTarget& target, const WorldTriangles& piece, PieceVertices& scratch,
                    PlacedTriangles& placed) {
  Placer(target, piece, scratch, placed).Place();
}

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::zbuffer_detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace frontmost::zbuffer_detail {

FRONTMOST_KERNELS(PlaceTriangles);

void place_triangles(const PlaceTarget& target, const WorldTriangles& piece, PieceVertices& scratch,
                     PlacedTriangles& placed) {
  kernel_for(PlaceTrianglesKernels, target.isa)(target, piece, scratch, placed);
}

}  // namespace frontmost::zbuffer_detail
#endif  // HWY_ONCE
