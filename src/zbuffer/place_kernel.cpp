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
#include "view/snap-inl.h"
#include "zbuffer/batch-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::zbuffer_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using frontmost::HWY_NAMESPACE::Compactor;
namespace screen = view_detail::HWY_NAMESPACE;

/// Calls visit(first, pointer to a whole vector of triples) over `count` triples; the last may be repeated to fill up.
template <class Triple, class Visit>
HWY_INLINE void ForTriples(std::span<const Triple> triples, const Visit& visit) {
  const std::size_t lanes = hn::Lanes(DF());
  std::size_t i = 0;
  for (; i + lanes <= triples.size(); i += lanes) visit(i, &triples[i].x);
  if (i == triples.size()) return;
  Triple rest[kMaxLanes];
  for (std::size_t k = 0; k < lanes; ++k) rest[k] = triples[HWY_MIN(i + k, triples.size() - 1)];
  visit(i, &rest[0].x);
}

class Placer {
 public:
  Placer(const PlaceTarget& target, const PieceGeometry& piece, PieceVertices& vertices, PlacedTriangles& placed)
      : target_(target), piece_(piece), vertices_(vertices), placed_(placed) {}

  void Place() {
    SnapVertices();
    ForTriples(piece_.corners, [&](std::size_t i, const std::uint32_t* corners) HWY_ATTR { PlaceVector(i, corners); });
  }

 private:
  struct Corner {
    VI number, x, y;
  };

  void SnapVertices() {
    const DF d;
    const DI di;
    const std::size_t room = piece_.positions.size() + kMaxLanes;
    if (vertices_.x.size() < room) {
      vertices_.x.resize(room);
      vertices_.y.resize(room);
      vertices_.key.resize(room);
    }
    const VI centre_x = hn::Set(di, target_.transform.centre_x), centre_y = hn::Set(di, target_.transform.centre_y);
    ForTriples(piece_.positions, [&](std::size_t i, const float* positions) HWY_ATTR {
      VF x, y, z;
      hn::LoadInterleaved3(d, positions, x, y, z);
      const auto homogeneous = screen::Transform(target_.transform, x, y, z);
      const auto snapped = screen::Snap(target_.transform, homogeneous);
      const auto plain = screen::IsPlain(target_.transform, homogeneous);
      hn::StoreU(hn::Add(snapped.x, centre_x), di, vertices_.x.data() + i);
      hn::StoreU(hn::Add(snapped.y, centre_y), di, vertices_.y.data() + i);
      hn::StoreU(hn::IfThenElse(plain, snapped.key, hn::Set(d, -1.0f)), d, vertices_.key.data() + i);
    });
  }

  [[nodiscard]] HWY_INLINE Corner Fetch(hn::Vec<DU> number) const {
    const DI d;
    const VI n = hn::Sub(hn::BitCast(d, number), hn::Set(d, std::int32_t(piece_.first_position)));
    return {n, hn::GatherIndex(d, vertices_.x.data(), n), hn::GatherIndex(d, vertices_.y.data(), n)};
  }
  [[nodiscard]] HWY_INLINE VF KeyOf(const Corner& corner) const {
    return hn::GatherIndex(DF(), vertices_.key.data(), corner.number);
  }

  HWY_INLINE void PlaceVector(std::size_t first, const std::uint32_t* corners) {
    const DI d;
    const DF df;
    hn::Vec<DU> numbers[3];
    hn::LoadInterleaved3(DU(), corners, numbers[0], numbers[1], numbers[2]);
    if (piece_.is_mirrored) std::swap(numbers[1], numbers[2]);
    const Corner a = Fetch(numbers[0]), b = Fetch(numbers[1]), c = Fetch(numbers[2]);
    const VF ka = KeyOf(a), kb = KeyOf(b), kc = KeyOf(c);
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
    const auto store = [&](std::size_t corner, VI x, VI y, VF key) HWY_ATTR {
      compact.Store(x, placed_.x[corner].data() + at);
      compact.Store(y, placed_.y[corner].data() + at);
      compact.Store(key, placed_.key[corner].data() + at);
    };
    // Turn the area positive: swap the last two corners of front faces.
    const auto front_f = hn::RebindMask(df, front);
    store(0, a.x, a.y, ka);
    store(1, hn::IfThenElse(front, c.x, b.x), hn::IfThenElse(front, c.y, b.y), hn::IfThenElse(front_f, kc, kb));
    store(2, hn::IfThenElse(front, b.x, c.x), hn::IfThenElse(front, b.y, c.y), hn::IfThenElse(front_f, kb, kc));
    compact.Store(hn::Min(ka, hn::Min(kb, kc)), placed_.low.data() + at);
    compact.Store(hn::Max(ka, hn::Max(kb, kc)), placed_.high.data() + at);
    const VI id = hn::Add(hn::Iota(d, 0), hn::Set(d, std::int32_t(piece_.first_id + std::uint32_t(first))));
    compact.Store(hn::BitCast(DU(), id), placed_.id.data() + at);
    compact.Store(hn::BitCast(DU(), OnlyTile(px, py)), placed_.tile.data() + at);
    placed_.count += compact.count();
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
  [[nodiscard]] static HWY_INLINE VF AreaOf(const Corner& a, const Corner& b, const Corner& c) {
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
  const PieceGeometry& piece_;
  PieceVertices& vertices_;
  PlacedTriangles& placed_;
};

void PlaceTriangles(const PlaceTarget& target, const PieceGeometry& piece, PieceVertices& scratch,
                    PlacedTriangles& placed) {
  Placer(target, piece, scratch, placed).Place();
}

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::zbuffer_detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace frontmost::zbuffer_detail {

FRONTMOST_KERNELS(PlaceTriangles);

void place_triangles(const PlaceTarget& target, const PieceGeometry& piece, PieceVertices& scratch,
                     PlacedTriangles& placed) {
  kernel_for(PlaceTrianglesKernels, target.isa)(target, piece, scratch, placed);
}

}  // namespace frontmost::zbuffer_detail
#endif  // HWY_ONCE
