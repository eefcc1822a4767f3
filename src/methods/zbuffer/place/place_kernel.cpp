// SPDX-License-Identifier: Apache-2.0
// Places triangles into batches: snaps vertices, and finds pixel rectangles and facing, many at a time. Small triangles
// that can be snapped whole are oriented, and appended to the columns of the batch. The indices of all other triangles
// go to `apart`, to be clipped one by one. A triangle that has no sample inside its bounding box is left out at once.

#include "zbuffer/place/triangle_batch.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "zbuffer/place/place_kernel.cpp"
#include <limits>

#include "base/highway-inl.h"
#include "base/isa.h"
// This header must come after Highway's, so it is included in a separate block.
#include "base/compactor-inl.h"
#include "view/snap-inl.h"
#include "zbuffer/packet-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::zbuffer_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace screen = view_detail::HWY_NAMESPACE;

/// Calls visit(first, pointer to a whole vector of triples) for all triples. The last vector is filled up with copies
/// of the last triple.
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

/// A vector of vertices in world space.
struct WorldVertices {
  VF x, y, z;
};

/// Computes out codes: one bit for each plane of the clip volume that a vertex is certainly outside of, in the low bits
/// of a negative float.
class OutCodes {
 public:
  explicit OutCodes(const ScreenTransform& t) : t_(t) {}

  [[nodiscard]] HWY_INLINE VF operator()(const WorldVertices& world, const screen::HomogeneousVertices& v) const {
    const DF d;
    const VF from_eye[3] = {hn::Sub(world.x, hn::Set(d, t_.eye[0])), hn::Sub(world.y, hn::Set(d, t_.eye[1])),
                            hn::Sub(world.z, hn::Set(d, t_.eye[2]))};
    const VF slack_x = Slack(t_.x_row, t_.x_offset, from_eye), slack_y = Slack(t_.y_row, t_.y_offset, from_eye);
    const VF slack_d = Slack(t_.d_row, t_.d_offset, from_eye);
    const VF guard = hn::Set(d, float(kGuardBand) * 1.000001f);
    // The test also holds for triangles behind the eye: v.x - reach is linear over the whole triangle, so it is
    // positive everywhere if it is positive at all vertices.
    const VF reach = t_.orthographic ? guard : hn::Mul(guard, hn::Add(v.d, slack_d));
    VI code = hn::Set(DI(), kNone);
    code = hn::Or(code, Bit(hn::Lt(hn::Add(v.d, slack_d), hn::Set(d, t_.near)), 1));
    code = hn::Or(code, Bit(hn::Gt(hn::Sub(v.d, slack_d), hn::Set(d, t_.far)), 2));
    code = hn::Or(code, Bit(hn::Gt(hn::Sub(v.x, slack_x), reach), 4));
    code = hn::Or(code, Bit(hn::Gt(hn::Sub(hn::Neg(v.x), slack_x), reach), 8));
    code = hn::Or(code, Bit(hn::Gt(hn::Sub(v.y, slack_y), reach), 16));
    code = hn::Or(code, Bit(hn::Gt(hn::Sub(hn::Neg(v.y), slack_y), reach), 32));
    return hn::BitCast(d, code);
  }

  /// Returns the triangles whose vertices are all outside one plane, given the vertices' keys.
  [[nodiscard]] static HWY_INLINE MI Outside(VF a, VF b, VF c) {
    const DI d;
    const VI all = hn::And(hn::BitCast(d, a), hn::And(hn::BitCast(d, b), hn::BitCast(d, c)));
    return hn::And(hn::Lt(all, hn::Zero(d)), hn::Ne(hn::And(all, hn::Set(d, kOutside)), hn::Zero(d)));
  }

 private:
  // A negative and finite float whose low six bits are free for out codes.
  static constexpr std::int32_t kNone = std::int32_t(0xC0000000);  // -2

  [[nodiscard]] static HWY_INLINE VI Bit(hn::Mask<DF> mask, std::int32_t bit) {
    return hn::IfThenElseZero(hn::RebindMask(DI(), mask), hn::Set(DI(), bit));
  }
  /// A bound greater than the rounding error of a coordinate.
  [[nodiscard]] static HWY_INLINE VF Slack(const std::array<float, 3>& row, float offset, const VF from_eye[3]) {
    const DF d;
    VF sum = hn::Set(d, std::abs(offset));
    for (std::size_t k = 0; k < 3; ++k) sum = hn::Add(sum, hn::Abs(hn::Mul(hn::Set(d, row[k]), from_eye[k])));
    return hn::Mul(sum, hn::Set(d, 1.0f / (1 << 20)));
  }

  const ScreenTransform& t_;
};

void SnapVertices(const PlaceTarget& target, std::span<const glm::vec3> positions, SnappedVertices& vertices) {
  const ScreenTransform& t = target.transform;
  const OutCodes out_codes(t);
  const DF d;
  const DI di;
  vertices.make_room(positions.size() + kMaxLanes);
  vertices.all_plain = true;
  const VI centre_x = hn::Set(di, t.centre_x), centre_y = hn::Set(di, t.centre_y);
  VI low_x = hn::Set(di, std::numeric_limits<std::int32_t>::max()), low_y = low_x;
  VI high_x = hn::Set(di, std::numeric_limits<std::int32_t>::min()), high_y = high_x;
  VI nearest = hn::Zero(di), common = hn::Set(di, -1);
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
      key = hn::IfThenElse(plain, key, out_codes(world, homogeneous));
      vertices.all_plain = false;
    }
    hn::StoreU(key, d, vertices.key.data() + i);
    low_x = hn::Min(low_x, x);
    low_y = hn::Min(low_y, y);
    high_x = hn::Max(high_x, x);
    high_y = hn::Max(high_y, y);
    nearest = hn::Max(nearest, hn::BitCast(di, key));
    common = hn::And(common, hn::BitCast(di, key));
  });
  vertices.low = {hn::GetLane(hn::MinOfLanes(di, low_x)), hn::GetLane(hn::MinOfLanes(di, low_y))};
  vertices.high = {hn::GetLane(hn::MaxOfLanes(di, high_x)), hn::GetLane(hn::MaxOfLanes(di, high_y))};
  vertices.nearest = hn::GetLane(hn::MaxOfLanes(di, nearest));
  HWY_ALIGN_MAX std::int32_t lanes[kMaxLanes];
  hn::Store(common, di, lanes);
  vertices.common = -1;
  for (std::size_t k = 0; k < hn::Lanes(di); ++k) vertices.common &= lanes[k];
}

/// Puts the packets that SortOut() finds into the columns of a batch.
class Placer {
 public:
  Placer(const PlaceTarget& target, const WorldTriangles& triangles, const SnappedVertices& vertices,
         TriangleBatch& batch, std::vector<std::uint32_t>& apart)
      : target_(target), triangles_(triangles), vertices_(vertices), batch_(batch), apart_(apart), rect_(batch.rect) {
    nearest_ = hn::Set(DI(), batch.nearest);
  }

  void Place() {
    ForTriples(triangles_.corners,
               [&](std::size_t i, const std::uint32_t* corners) HWY_ATTR { PlacePacket(i, corners); });
    batch_.rect = rect_.rect();
    batch_.nearest = hn::GetLane(hn::MaxOfLanes(DI(), nearest_));
  }

  // The sink functions of SortOut().

  [[nodiscard]] HWY_INLINE PixelRange ColumnsOf(const CoordinateRange& x) const {
    return PixelsOf(x, target_.low.x, target_.high.x, target_.view.width);
  }
  [[nodiscard]] HWY_INLINE PixelRange RowsOf(const CoordinateRange& y) const {
    return PixelsOf(y, target_.low.y, target_.high.y, target_.view.height);
  }
  [[nodiscard]] HWY_INLINE VU Ids() const {
    const DI d;
    const std::uint32_t first = triangles_.first_id + std::uint32_t(first_);
    return hn::BitCast(DU(), hn::Add(hn::Iota(d, 0), hn::Set(d, std::int32_t(first))));
  }
  HWY_INLINE void PutLarge(MI large) { others_ |= BitsOf(DI(), large); }
  HWY_INLINE void PutSmall(const PlacedPacket& placed) {
    const DI d;
    rect_.Add(placed);
    const VI tiles = TilesOf(placed.columns, placed.rows);
    const Compactor<DI> compact(placed.kept);
    BatchColumns& to = batch_.columns();
    const std::size_t at = batch_.count;
    for (int k = 0; k < 3; ++k) {
      const Corners& corner = placed.corners[k];
      // Kept triangles have no negative key, so the bits of keys have the same order as the keys.
      const VI key = hn::GatherIndex(d, reinterpret_cast<const std::int32_t*>(vertices_.key.data()), corner.number);
      compact.Store(corner.x, to.x[k] + at);
      compact.Store(corner.y, to.y[k] + at);
      compact.Store(key, to.key[k] + at);
      nearest_ = hn::IfThenElse(placed.kept, hn::Max(nearest_, key), nearest_);
    }
    compact.Store(Ids(), to.id + at);
    compact.Store(hn::BitCast(DU(), tiles), to.tiles + at);
    batch_.count += compact.count();
  }

 private:
  HWY_INLINE void PlacePacket(std::size_t first, const std::uint32_t* corners) {
    const DI d;
    VU numbers[3];
    hn::LoadInterleaved3(DU(), corners, numbers[0], numbers[1], numbers[2]);
    if (triangles_.is_mirrored) std::swap(numbers[1], numbers[2]);
    const Corners fetched[3] = {Fetch(numbers[0]), Fetch(numbers[1]), Fetch(numbers[2])};
    const std::size_t count = HWY_MIN(triangles_.corners.size() - first, hn::Lanes(d));
    MI live = hn::Lt(hn::Iota(d, 0), hn::Set(d, std::int32_t(count)));
    first_ = first;
    if (!vertices_.all_plain) live = hn::And(live, Plain(live, fetched));
    SortOut(fetched, live, target_.facing, *this);
    if (others_ != 0) PutApart();
  }

  [[nodiscard]] HWY_INLINE Corners Fetch(VU number) const {
    const DI d;
    const VI n = hn::Sub(hn::BitCast(d, number), hn::Set(d, std::int32_t(triangles_.first_position)));
    return {n, hn::GatherIndex(d, vertices_.x.data(), n), hn::GatherIndex(d, vertices_.y.data(), n)};
  }
  [[nodiscard]] HWY_INLINE VF KeysOf(const Corners& corners) const {
    return hn::GatherIndex(DF(), vertices_.key.data(), corners.number);
  }

  /// Returns the triangles whose vertices could all be snapped. Marks the other triangles for clipping, unless they are
  /// wholly outside one plane.
  [[nodiscard]] HWY_NOINLINE MI Plain(MI live, const Corners (&c)[3]) {
    const DI d;
    const DF df;
    const VF ka = KeysOf(c[0]), kb = KeysOf(c[1]), kc = KeysOf(c[2]);
    const MI plain = hn::Not(hn::RebindMask(d, hn::Lt(hn::Min(ka, hn::Min(kb, kc)), hn::Zero(df))));
    others_ |= BitsOf(d, hn::AndNot(hn::Or(plain, OutCodes::Outside(ka, kb, kc)), live));
    return plain;
  }

  HWY_NOINLINE void PutApart() {
    ForEachBit(others_, [&](std::size_t lane) { apart_.push_back(std::uint32_t(first_ + lane)); });
    others_ = 0;
  }

  const PlaceTarget& target_;
  const WorldTriangles& triangles_;
  const SnappedVertices& vertices_;
  TriangleBatch& batch_;
  std::vector<std::uint32_t>& apart_;
  WidenedRect rect_;
  VI nearest_;  // bits of keys
  // First triangle of the packet, and the lanes of its triangles that are drawn one by one.
  std::size_t first_ = 0;
  std::uint64_t others_ = 0;
};

void PlaceTriangles(const PlaceTarget& target, const WorldTriangles& triangles, const SnappedVertices& vertices,
                    TriangleBatch& batch, std::vector<std::uint32_t>& apart) {
  Placer(target, triangles, vertices, batch, apart).Place();
}

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::zbuffer_detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace frontmost::zbuffer_detail {

FRONTMOST_KERNELS(SnapVertices);
FRONTMOST_KERNELS(PlaceTriangles);

void snap_vertices(const PlaceTarget& target, std::span<const glm::vec3> positions, SnappedVertices& vertices) {
  kernel_for(SnapVerticesKernels, target.isa)(target, positions, vertices);
}

void place_triangles(const PlaceTarget& target, const WorldTriangles& triangles, const SnappedVertices& vertices,
                     TriangleBatch& batch, std::vector<std::uint32_t>& apart) {
  kernel_for(PlaceTrianglesKernels, target.isa)(target, triangles, vertices, batch, apart);
}

ClippedPolygon polygon_of(const PlaceTarget& target, const WorldTriangles& triangles, const SnappedVertices& vertices,
                          std::size_t triangle) {
  const ScreenTransform& t = target.transform;
  glm::uvec3 numbers = triangles.corners[triangle] - triangles.first_position;
  if (triangles.is_mirrored) std::swap(numbers.y, numbers.z);
  ClippedPolygon whole;
  for (int k = 0; k < 3; ++k) {
    const std::size_t v = numbers[k];
    if (vertices.key[v] < 0) {
      const std::array<glm::vec3, 3> world = triangles[triangle];
      if (!is_finite(world[0]) || !is_finite(world[1]) || !is_finite(world[2])) return {};
      return clip_triangle(t, world);
    }
    whole.corners[std::size_t(k)] = {vertices.x[v] - t.centre_x, vertices.y[v] - t.centre_y, vertices.key[v]};
  }
  whole.count = 3;
  return whole;
}

}  // namespace frontmost::zbuffer_detail
#endif  // HWY_ONCE
