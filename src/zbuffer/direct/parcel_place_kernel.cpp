// SPDX-License-Identifier: Apache-2.0
// Putting triangles into parcels: vertices, pixel rectangles and facing, many at a time.

#include "zbuffer/direct/parcel_kernel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "zbuffer/direct/parcel_place_kernel.cpp"
#include "base/isa.h"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"
// After Highway: a block of its own.
#include "base/compactor-inl.h"
#include "view/clip.h"
#include "zbuffer/batch-inl.h"
#include "zbuffer/snap_piece-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::zbuffer_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Which planes of the clip volume a vertex lies outside of for certain, a bit each, in the bits of a negative float.
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
    // Behind the eye as well: a linear function of a whole triangle that no corner makes small enough.
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

  /// Triangles, by the keys of their corners, all of whose corners are outside of one plane.
  [[nodiscard]] static HWY_INLINE MI Outside(VF a, VF b, VF c) {
    const DI d;
    const VI all = hn::And(hn::BitCast(d, a), hn::And(hn::BitCast(d, b), hn::BitCast(d, c)));
    return hn::And(hn::Lt(all, hn::Zero(d)), hn::Ne(hn::And(all, hn::Set(d, kOutside)), hn::Zero(d)));
  }

 private:
  // The sign and the top of the exponent: negative, finite, and with room for the six bits below.
  static constexpr std::int32_t kNone = std::int32_t(0xC0000000);  // -2

  [[nodiscard]] static HWY_INLINE VI Bit(hn::Mask<DF> mask, std::int32_t bit) {
    return hn::IfThenElseZero(hn::RebindMask(DI(), mask), hn::Set(DI(), bit));
  }
  /// More than what rounding adds to a coordinate.
  [[nodiscard]] static HWY_INLINE VF Slack(const std::array<float, 3>& row, float offset, const VF from_eye[3]) {
    const DF d;
    VF sum = hn::Set(d, std::abs(offset));
    for (std::size_t k = 0; k < 3; ++k) sum = hn::Add(sum, hn::Abs(hn::Mul(hn::Set(d, row[k]), from_eye[k])));
    return hn::Mul(sum, hn::Set(d, 1.0f / (1 << 20)));
  }

  const ScreenTransform& t_;
};

class ParcelPlacer {
 public:
  ParcelPlacer(const PlaceTarget& target, const WorldTriangles& piece, const PieceVertices& vertices, Parcel& parcel)
      : target_(target), piece_(piece), vertices_(vertices), parcel_(parcel) {}

  void Place(bool all_plain) {
    all_plain_ = all_plain;
    const DI d;
    least_x_ = hn::Set(d, parcel_.rect.x0);
    least_y_ = hn::Set(d, parcel_.rect.y0);
    greatest_x_ = hn::Set(d, parcel_.rect.x1);
    greatest_y_ = hn::Set(d, parcel_.rect.y1);
    nearest_ = hn::Set(d, parcel_.nearest);
    ForTriples(piece_.corners, [&](std::size_t i, const std::uint32_t* corners) HWY_ATTR { PlaceVector(i, corners); });
    parcel_.rect = {hn::GetLane(hn::MinOfLanes(d, least_x_)), hn::GetLane(hn::MinOfLanes(d, least_y_)),
                    hn::GetLane(hn::MaxOfLanes(d, greatest_x_)), hn::GetLane(hn::MaxOfLanes(d, greatest_y_))};
    parcel_.nearest = hn::GetLane(hn::MaxOfLanes(d, nearest_));
  }

 private:
  HWY_INLINE void PlaceVector(std::size_t first, const std::uint32_t* corners) {
    const DI d;
    VU numbers[3];
    hn::LoadInterleaved3(DU(), corners, numbers[0], numbers[1], numbers[2]);
    if (piece_.is_mirrored) std::swap(numbers[1], numbers[2]);
    const Corners a = Fetch(numbers[0]), b = Fetch(numbers[1]), c = Fetch(numbers[2]);
    MI keep = hn::Lt(hn::Iota(d, 0), hn::Set(d, std::int32_t(HWY_MIN(piece_.corners.size() - first, hn::Lanes(d)))));
    if (!all_plain_) keep = hn::And(keep, Plain(first, keep, a, b, c));

    const CoordinateRange x = RangeOf(a.x, b.x, c.x), y = RangeOf(a.y, b.y, c.y);
    const PixelRange columns = PixelsOf(x, target_.low.x, target_.high.x, target_.view.width);
    const PixelRange rows = PixelsOf(y, target_.low.y, target_.high.y, target_.view.height);
    keep = hn::AndNot(hn::Or(hn::Gt(columns.first, columns.last), hn::Gt(rows.first, rows.last)), keep);
    if (hn::AllFalse(d, keep)) return;
    const VI extent = hn::Max(hn::Sub(x.greatest, x.least), hn::Sub(y.greatest, y.least));
    const MI large = hn::And(keep, hn::Gt(extent, hn::Set(d, kSmallExtent)));
    if (!hn::AllFalse(d, large)) {
      AppendLarge(first, large);
      keep = hn::AndNot(large, keep);
    }
    const Winding winding = WindingOf(target_.view.culling, a, b, c);
    keep = hn::And(keep, winding.kept);
    if (hn::AllFalse(d, keep)) return;
    Note(keep, columns, rows);
    Store(keep, first, {a, Chosen(winding.front, c, b), Chosen(winding.front, b, c)}, TilesOf(columns, rows));
  }

  [[nodiscard]] HWY_INLINE Corners Fetch(VU number) const {
    return FetchCorners(vertices_, number, piece_.first_position);
  }

  /// Those whose corners are on the screen as they are; the others are clipped, unless all of them is away.
  [[nodiscard]] HWY_NOINLINE MI Plain(std::size_t first, MI live, const Corners& a, const Corners& b,
                                      const Corners& c) {
    const DI d;
    const DF df;
    const VF ka = FetchKeys(vertices_, a), kb = FetchKeys(vertices_, b), kc = FetchKeys(vertices_, c);
    const MI plain = hn::Not(hn::RebindMask(d, hn::Lt(hn::Min(ka, hn::Min(kb, kc)), hn::Zero(df))));
    const MI clipped = hn::AndNot(hn::Or(plain, OutCodes::Outside(ka, kb, kc)), live);
    ForEachBit(BitsOf(d, clipped), [&](std::size_t lane) {
      const std::size_t triangle = first + lane;
      const std::array<glm::vec3, 3> world = piece_[triangle];
      if (!is_finite(world[0]) || !is_finite(world[1]) || !is_finite(world[2])) return;
      append_polygon(clip_triangle(target_.transform, world), target_.transform,
                     piece_.first_id + PrimitiveId(triangle), target_.view, parcel_.records);
    });
    return plain;
  }

  HWY_NOINLINE void AppendLarge(std::size_t first, MI large) {
    ForEachBit(BitsOf(DI(), large), [&](std::size_t lane) {
      const std::size_t triangle = first + lane;
      TriangleRecord record;
      record.id = piece_.first_id + PrimitiveId(triangle);
      glm::uvec3 corners = piece_.corners[triangle] - piece_.first_position;
      if (piece_.is_mirrored) std::swap(corners.y, corners.z);
      for (int k = 0; k < 3; ++k) {
        record.x[k] = vertices_.x[corners[k]];
        record.y[k] = vertices_.y[corners[k]];
        record.key[k] = vertices_.key[corners[k]];
      }
      if (orient(record, target_.view.culling)) parcel_.records.push_back(record);
    });
  }

  /// Widens what is known of the whole parcel.
  HWY_INLINE void Note(MI keep, const PixelRange& columns, const PixelRange& rows) {
    least_x_ = hn::IfThenElse(keep, hn::Min(least_x_, columns.first), least_x_);
    least_y_ = hn::IfThenElse(keep, hn::Min(least_y_, rows.first), least_y_);
    greatest_x_ = hn::IfThenElse(keep, hn::Max(greatest_x_, columns.last), greatest_x_);
    greatest_y_ = hn::IfThenElse(keep, hn::Max(greatest_y_, rows.last), greatest_y_);
  }

  /// ParcelColumns::tiles. Eight bits a number are enough: the largest image has 128 tiles either way.
  [[nodiscard]] static HWY_INLINE VI TilesOf(const PixelRange& columns, const PixelRange& rows) {
    static_assert(kTileSize == 1 << 7);
    const VI first = hn::Or(hn::ShiftRight<7>(columns.first), hn::ShiftLeft<8>(hn::ShiftRight<7>(rows.first)));
    const VI last = hn::Or(hn::ShiftRight<7>(columns.last), hn::ShiftLeft<8>(hn::ShiftRight<7>(rows.last)));
    return hn::Or(first, hn::ShiftLeft<16>(last));
  }

  HWY_INLINE void Store(MI keep, std::size_t first, const Corners (&corners)[3], VI tiles) {
    const DI d;
    const Compactor<DI> compact(keep);
    ParcelColumns& to = parcel_.columns();
    const std::size_t at = parcel_.count;
    for (int k = 0; k < 3; ++k) {
      // As bits, which order as the keys do while none is negative; kept triangles have none that is.
      const VI key = hn::GatherIndex(d, reinterpret_cast<const std::int32_t*>(vertices_.key.data()), corners[k].number);
      compact.Store(corners[k].x, to.x[k] + at);
      compact.Store(corners[k].y, to.y[k] + at);
      compact.Store(key, to.key[k] + at);
      nearest_ = hn::IfThenElse(keep, hn::Max(nearest_, key), nearest_);
    }
    const VI id = hn::Add(hn::Iota(d, 0), hn::Set(d, std::int32_t(piece_.first_id + std::uint32_t(first))));
    compact.Store(hn::BitCast(DU(), id), to.id + at);
    compact.Store(hn::BitCast(DU(), tiles), to.tiles + at);
    parcel_.count += compact.count();
  }

  const PlaceTarget& target_;
  const WorldTriangles& piece_;
  const PieceVertices& vertices_;
  Parcel& parcel_;
  bool all_plain_ = false;
  VI least_x_, least_y_, greatest_x_, greatest_y_;  // pixels
  VI nearest_;                                      // bits of keys
};

PieceExtent SnapPiece(const PlaceTarget& target, const WorldTriangles& piece, PieceVertices& vertices) {
  return SnapVertices(target.transform, piece.positions, vertices, OutCodes(target.transform));
}

void PlaceInParcel(const PlaceTarget& target, const WorldTriangles& piece, const PieceVertices& vertices,
                   bool all_plain, Parcel& parcel) {
  ParcelPlacer(target, piece, vertices, parcel).Place(all_plain);
}

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::zbuffer_detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace frontmost::zbuffer_detail {

FRONTMOST_KERNELS(SnapPiece);
FRONTMOST_KERNELS(PlaceInParcel);

PieceExtent snap_piece(const PlaceTarget& target, const WorldTriangles& piece, PieceVertices& vertices) {
  return kernel_for(SnapPieceKernels, target.isa)(target, piece, vertices);
}

void place_in_parcel(const PlaceTarget& target, const WorldTriangles& piece, const PieceVertices& vertices,
                     bool all_plain, Parcel& parcel) {
  kernel_for(PlaceInParcelKernels, target.isa)(target, piece, vertices, all_plain, parcel);
}

}  // namespace frontmost::zbuffer_detail
#endif  // HWY_ONCE
