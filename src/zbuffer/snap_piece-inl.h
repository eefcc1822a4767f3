// SPDX-License-Identifier: Apache-2.0
// The vertices of a piece put on the screen, as many at once as the vector holds.

// Included once for every target.
#if defined(FRONTMOST_ZBUFFER_SNAP_PIECE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FRONTMOST_ZBUFFER_SNAP_PIECE_INL_H_
#undef FRONTMOST_ZBUFFER_SNAP_PIECE_INL_H_
#else
#define FRONTMOST_ZBUFFER_SNAP_PIECE_INL_H_
#endif

#include <limits>

#include "hwy/highway.h"
#include "view/snap-inl.h"
#include "zbuffer/batch-inl.h"
#include "zbuffer/place_kernel.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::zbuffer_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
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

/// Vertices before they are put on the screen.
struct WorldVertices {
  VF x, y, z;
};

/// `mark(world, homogeneous)` gives the key of those that cannot be snapped as they are: a negative number.
template <class Mark>
HWY_INLINE PieceExtent SnapVertices(const ScreenTransform& t, std::span<const glm::vec3> positions,
                                    PieceVertices& vertices, const Mark& mark) {
  const DF d;
  const DI di;
  vertices.make_room(positions.size() + kMaxLanes);
  const VI centre_x = hn::Set(di, t.centre_x), centre_y = hn::Set(di, t.centre_y);
  VI low_x = hn::Set(di, std::numeric_limits<std::int32_t>::max()), low_y = low_x;
  VI high_x = hn::Set(di, std::numeric_limits<std::int32_t>::min()), high_y = high_x;
  VI nearest = hn::Zero(di), common = hn::Set(di, -1);
  PieceExtent extent;
  ForTriples(positions, [&](std::size_t i, const float* triples) HWY_ATTR {
    WorldVertices world;
    hn::LoadInterleaved3(d, triples, world.x, world.y, world.z);
    const auto homogeneous = screen::Transform(t, world.x, world.y, world.z);
    const auto snapped = screen::Snap(t, homogeneous);
    const auto plain = screen::IsPlain(t, homogeneous);
    const VI x = hn::Add(snapped.x, centre_x), y = hn::Add(snapped.y, centre_y);
    hn::StoreU(x, di, vertices.x.data() + i);
    hn::StoreU(y, di, vertices.y.data() + i);
    VF key = snapped.key;
    if (!hn::AllTrue(d, plain)) {
      key = hn::IfThenElse(plain, key, mark(world, homogeneous));
      extent.all_plain = false;
    }
    hn::StoreU(key, d, vertices.key.data() + i);
    low_x = hn::Min(low_x, x);
    low_y = hn::Min(low_y, y);
    high_x = hn::Max(high_x, x);
    high_y = hn::Max(high_y, y);
    nearest = hn::Max(nearest, hn::BitCast(di, key));
    common = hn::And(common, hn::BitCast(di, key));
  });
  extent.low = {hn::GetLane(hn::MinOfLanes(di, low_x)), hn::GetLane(hn::MinOfLanes(di, low_y))};
  extent.high = {hn::GetLane(hn::MaxOfLanes(di, high_x)), hn::GetLane(hn::MaxOfLanes(di, high_y))};
  extent.nearest = hn::GetLane(hn::MaxOfLanes(di, nearest));
  HWY_ALIGN_MAX std::int32_t lanes[kMaxLanes];
  hn::Store(common, di, lanes);
  for (std::size_t k = 0; k < hn::Lanes(di); ++k) extent.common &= lanes[k];
  return extent;
}

HWY_INLINE Corners FetchCorners(const PieceVertices& vertices, VU number, std::uint32_t first) {
  const DI d;
  const VI n = hn::Sub(hn::BitCast(d, number), hn::Set(d, std::int32_t(first)));
  return {n, hn::GatherIndex(d, vertices.x.data(), n), hn::GatherIndex(d, vertices.y.data(), n)};
}
HWY_INLINE VF FetchKeys(const PieceVertices& vertices, const Corners& corners) {
  return hn::GatherIndex(DF(), vertices.key.data(), corners.number);
}

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::zbuffer_detail
HWY_AFTER_NAMESPACE();

#endif  // include guard by target
