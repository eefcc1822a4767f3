// SPDX-License-Identifier: Apache-2.0
// Triangles with vertices in floats, many at a time. They wait in a queue until they fill a vector; triangles of a few
// pixels are then met one pixel of each per step.
//
//    waiting   x, y, d of three corners, id, rect     | t0 | t1 | ... | t15 |   full: all are set up together
//    walk      step 1: the first pixel of each of them; step 2: the second of each; ... up to 3 x 3
//
// Triangles of a scan often cover one sample or none. Met one after the other, each would use a lane of a vector. Side
// by side they use all lanes, and the loop is as long as the largest of them needs.

// Included once for every target.
#if defined(FRONTMOST_RAYCAST_TRIANGLE_QUEUE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FRONTMOST_RAYCAST_TRIANGLE_QUEUE_INL_H_
#undef FRONTMOST_RAYCAST_TRIANGLE_QUEUE_INL_H_
#else
#define FRONTMOST_RAYCAST_TRIANGLE_QUEUE_INL_H_
#endif

#include "base/compactor-inl.h"
#include "raycast/tile/large_triangles-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::raycast_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using frontmost::HWY_NAMESPACE::Compactor;

/// A triangle whose rectangle of samples is at most this wide and high is met together with others.
constexpr int kWalkLimit = 3;

class RayTriangleQueue {
 public:
  RayTriangleQueue(const RayTileInput& frame, const TilePlace& place, RayTileBuffer& buffer, LargeRayTriangles& large)
      : t_(frame.transform), facing_(frame.facing), place_(place), buffer_(buffer), large_(large) {}

  struct Batch {
    VF x[3], y[3], d[3];
    VU id, rect;  // x0, y0, x1, y1: pixels of the tile, one byte each from the lowest
  };

  /// Adds the lanes of `kept`; meets the triangles once they fill a vector.
  HWY_INLINE void Add(const Batch& batch, MF kept) {
    const Compactor<DF> compact(kept);
    for (std::size_t k = 0; k < 3; ++k) {
      compact.Store(batch.x[k], x_[k] + count_);
      compact.Store(batch.y[k], y_[k] + count_);
      compact.Store(batch.d[k], d_[k] + count_);
    }
    compact.Store(batch.id, id_ + count_);
    compact.Store(batch.rect, rect_ + count_);
    count_ += compact.count();
    while (count_ >= kLanes) Flush(kLanes);
  }

  void Finish() {
    while (count_ > 0) Flush(std::min(count_, kLanes));
  }

 private:
  /// Key planes of one vector of triangles.
  struct Planes {
    alignas(64) float gx[kRayLanes], gy[kRayLanes], k0[kRayLanes], low[kRayLanes], high[kRayLanes];
  };

  /// key_plane() for triangles between near and far.
  HWY_INLINE void SetKeyPlanes(std::size_t from, Planes& planes) const {
    const DF d;
    const DD dd;
    const DHF dh;
    for (std::size_t i = 0; i < kLanes; i += kDoubles) {
      const auto at = [&](const float* p) HWY_ATTR { return hn::PromoteTo(dd, hn::LoadU(dh, p + from + i)); };
      const VD ax = at(x_[0]), ay = at(y_[0]), ad = at(d_[0]);
      const VD px = hn::Sub(at(x_[1]), ax), py = hn::Sub(at(y_[1]), ay), pd = hn::Sub(at(d_[1]), ad);
      const VD qx = hn::Sub(at(x_[2]), ax), qy = hn::Sub(at(y_[2]), ay), qd = hn::Sub(at(d_[2]), ad);
      const VD nx = hn::Sub(hn::Mul(py, qd), hn::Mul(pd, qy));
      const VD ny = hn::Sub(hn::Mul(pd, qx), hn::Mul(px, qd));
      const VD nd = hn::Sub(hn::Mul(px, qy), hn::Mul(py, qx));
      const VD det = hn::Add(hn::Add(hn::Mul(nx, ax), hn::Mul(ny, ay)), hn::Mul(nd, ad));
      const VD across =
          hn::Add(hn::Mul(nx, hn::Set(dd, double(place_.centre_x))), hn::Mul(ny, hn::Set(dd, double(place_.centre_y))));
      VD scale, k0;
      if (t_.orthographic) {
        scale = hn::Div(hn::Set(dd, double(t_.inverse_range)), nd);
        k0 = hn::Sub(hn::Set(dd, double(t_.far) * double(t_.inverse_range)), hn::Mul(hn::Sub(det, across), scale));
      } else {
        scale = hn::Div(hn::Set(dd, double(t_.near)), det);
        k0 = hn::Mul(hn::Add(across, nd), scale);
      }
      hn::Store(hn::DemoteTo(dh, hn::Mul(nx, scale)), dh, planes.gx + i);
      hn::Store(hn::DemoteTo(dh, hn::Mul(ny, scale)), dh, planes.gy + i);
      hn::Store(hn::DemoteTo(dh, k0), dh, planes.k0 + i);
    }
    const VF a = hn::LoadU(d, d_[0] + from), b = hn::LoadU(d, d_[1] + from), c = hn::LoadU(d, d_[2] + from);
    const VF low = KeyOfDistance(t_, hn::Max(hn::Max(a, b), c));
    hn::Store(low, d, planes.low);
    hn::Store(KeyOfDistance(t_, hn::Min(hn::Min(a, b), c)), d, planes.high);
    const VF gx = hn::Load(d, planes.gx), gy = hn::Load(d, planes.gy), k0 = hn::Load(d, planes.k0);
    const VF steepest = hn::Set(d, kSteepest);
    const MF usual =
        hn::And(hn::And(hn::Le(hn::Abs(gx), steepest), hn::Le(hn::Abs(gy), steepest)), hn::Le(hn::Abs(k0), steepest));
    if (HWY_LIKELY(hn::AllTrue(d, usual))) return;
    hn::Store(hn::IfThenElseZero(usual, gx), d, planes.gx);
    hn::Store(hn::IfThenElseZero(usual, gy), d, planes.gy);
    hn::Store(hn::IfThenElse(usual, k0, low), d, planes.k0);
  }

  /// Meets the last `count` triangles of the queue.
  void Flush(std::size_t count) {
    const std::size_t from = count_ - count;
    count_ = from;
    Planes planes;
    SetKeyPlanes(from, planes);
    const DU du;
    const VU rect = hn::LoadU(du, rect_ + from), byte = hn::Set(du, 255u);
    Rects rects;
    rects.x0 = hn::And(rect, byte);
    rects.y0 = hn::And(hn::ShiftRight<8>(rect), byte);
    rects.columns = hn::Sub(hn::And(hn::ShiftRight<16>(rect), byte), rects.x0);
    rects.rows = hn::Sub(hn::ShiftRight<24>(rect), rects.y0);
    const auto used = hn::FirstN(du, count);
    const VU limit = hn::Set(du, std::uint32_t(kWalkLimit));
    const auto small = hn::And(hn::And(hn::Lt(rects.columns, limit), hn::Lt(rects.rows, limit)), used);
    if (!hn::AllFalse(du, small)) Walk(from, planes, rects, hn::RebindMask(DF(), small));
    ForEachBit(BitsOf(du, hn::AndNot(small, used)), [&](std::size_t lane) { DrawLarge(from, lane, planes); });
  }

  struct Rects {
    VU x0, y0, columns, rows;  // columns and rows less one
  };

  void Walk(std::size_t from, const Planes& planes, const Rects& rects, MF small) {
    const DF d;
    const DU du;
    const DI di;
    VF cx[3], cy[3], cw[3];
    for (std::size_t k = 0; k < 3; ++k) {
      cx[k] = hn::LoadU(d, x_[k] + from);
      cy[k] = hn::LoadU(d, y_[k] + from);
      cw[k] = t_.orthographic ? hn::Set(d, 1.0f) : hn::LoadU(d, d_[k] + from);
    }
    const VF gx = hn::Load(d, planes.gx), gy = hn::Load(d, planes.gy), k0 = hn::Load(d, planes.k0);
    const VF low = hn::Load(d, planes.low), high = hn::Load(d, planes.high);
    const VU small_u = hn::VecFromMask(du, hn::RebindMask(du, small));
    const std::uint32_t last_column = hn::GetLane(hn::MaxOfLanes(du, hn::And(rects.columns, small_u)));
    const std::uint32_t last_row = hn::GetLane(hn::MaxOfLanes(du, hn::And(rects.rows, small_u)));
    const auto at = [&](VU pixel, float first) HWY_ATTR {
      const VF whole = hn::Mul(hn::ConvertTo(d, hn::BitCast(di, pixel)), hn::Set(d, kPixel));
      return hn::Add(whole, hn::Set(d, first));
    };
    const VU three = hn::Set(du, 3u);
    for (std::uint32_t row = 0; row <= last_row; ++row) {
      const VU py = hn::Add(rects.y0, hn::Set(du, row));
      const VF sy = at(py, place_.first_y), v_step = hn::Mul(hn::Sub(sy, hn::Set(d, place_.centre_y)), gy);
      VF y[3];
      for (int k = 0; k < 3; ++k) y[k] = hn::Sub(cy[k], hn::Mul(sy, cw[k]));
      const MF in_rows = hn::AndNot(hn::RebindMask(d, hn::Gt(hn::Set(du, row), rects.rows)), small);
      // Pixel numbers of RayTileBuffer: 8 blocks in a row, 16 pixels in a block.
      const VU row_part = hn::Add(hn::ShiftLeft<7>(hn::ShiftRight<2>(py)), hn::ShiftLeft<2>(hn::And(py, three)));
      for (std::uint32_t column = 0; column <= last_column; ++column) {
        const VU px = hn::Add(rects.x0, hn::Set(du, column));
        const VF sx = at(px, place_.first_x);
        VF x[3];
        for (int k = 0; k < 3; ++k) x[k] = hn::Sub(cx[k], hn::Mul(sx, cw[k]));
        const EdgeSides sides = SidesOf(x, y);
        const MF here = hn::AndNot(hn::RebindMask(d, hn::Gt(hn::Set(du, column), rects.columns)), in_rows);
        const auto ids = [&]() HWY_ATTR { return hn::LoadU(du, id_ + from); };
        MF met = hn::And(Kept(d, facing_, sides.front, hn::And(sides.back, here), ids), here);
        const MF doubtful = hn::And(sides.doubtful, here);
        if (HWY_UNLIKELY(!hn::AllFalse(d, doubtful)))
          met = Resolve(met, doubtful, sx, sy, [&](std::size_t lane, float px1, float py1) {
            return keeps(facing_, id_[from + lane], facing(t_, Corners(from + lane).all(), px1, py1));
          });
        if (hn::AllFalse(d, met)) continue;
        const VF u_step = hn::Mul(hn::Sub(sx, hn::Set(d, place_.centre_x)), gx);
        const VF key = hn::Min(hn::Max(hn::Add(hn::Add(k0, u_step), v_step), low), high);
        const VU column_part = hn::Add(hn::ShiftLeft<4>(hn::ShiftRight<2>(px)), hn::And(px, three));
        MergeLanes(met, key, hn::Add(row_part, column_part), from);
      }
    }
  }

  HWY_INLINE void MergeLanes(MF met, VF key, VU pixel, std::size_t from) {
    const DF d;
    alignas(64) float keys[kLanes];
    alignas(64) std::uint32_t pixels[kLanes];
    hn::Store(key, d, keys);
    hn::Store(pixel, DU(), pixels);
    ForEachBit(BitsOf(d, met),
               [&](std::size_t lane) HWY_ATTR { buffer_.Merge(pixels[lane], keys[lane], id_[from + lane]); });
  }

  [[nodiscard]] HWY_INLINE SingleCorners Corners(std::size_t i) const {
    SingleCorners corners;
    for (std::size_t k = 0; k < 3; ++k) corners.x[k] = x_[k][i], corners.y[k] = y_[k][i], corners.d[k] = d_[k][i];
    return corners;
  }

  HWY_NOINLINE void DrawLarge(std::size_t from, std::size_t lane, const Planes& planes) {
    const std::uint32_t rect = rect_[from + lane];
    LargeTriangle<SingleCorners> large;
    large.corners = Corners(from + lane);
    large.plane.gx = planes.gx[lane], large.plane.gy = planes.gy[lane], large.plane.k0 = planes.k0[lane];
    large.plane.low = planes.low[lane], large.plane.high = planes.high[lane];
    large.rect = {int(rect & 255), int(rect >> 8 & 255), int(rect >> 16 & 255), int(rect >> 24)};
    large.id = id_[from + lane];
    if (large.rect.y1 - large.rect.y0 < kTileSize / 2 || !IsThereAlready(large)) large_.Draw(large);
  }

  /// Whether the last large triangle came again with a higher id, as objects may be placed twice or a million times.
  /// The lower id hides the copy, unless material culling may leave out the lower id alone.
  [[nodiscard]] bool IsThereAlready(const LargeTriangle<SingleCorners>& large) {
    if (facing_.culling() == Culling::material) return false;
    if (last_id_ < large.id && large.corners == last_) return true;
    last_ = large.corners;
    last_id_ = large.id;
    return false;
  }

  const ScreenTransform& t_;
  const FacingRule facing_;  // a copy, as the inner loops read it
  const TilePlace& place_;
  RayTileBuffer& buffer_;
  LargeRayTriangles& large_;
  // Room for one vector more than is met at a time, as Compress stores whole vectors.
  static constexpr std::size_t kRoom = 3 * kRayLanes;
  alignas(64) float x_[3][kRoom], y_[3][kRoom], d_[3][kRoom];
  alignas(64) std::uint32_t id_[kRoom], rect_[kRoom];
  std::size_t count_ = 0;
  SingleCorners last_{};  ///< vertices of the last large triangle that was drawn
  PrimitiveId last_id_ = no_primitive;
};

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::raycast_detail
HWY_AFTER_NAMESPACE();

#endif  // include guard by target
