// SPDX-License-Identifier: Apache-2.0
// Casts one tile: its rays walk the tree together, nearest children first, and meet many triangles at a time.
//
// A. Reshetov, A. Soupikov, J. Hurley. Multi-Level Ray Tracing Algorithm. 2005 (a frustum in place of its rays).
//
// sample_rule.h defines what a ray meets, and every path here gives the same bits. Triangles of a few pixels are
// handled a vector at a time, larger ones by blocks of pixels. Each test that excludes boxes, rectangles or blocks is
// padded by a bound on the rounding of both sides.

#include "raycast/tile/tile_kernel.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raycast/tile/tile_kernel.cpp"
#include "base/highway-inl.h"
#include "base/isa.h"
#include "raycast/tile/triangles-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::raycast_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// A half-space of positions relative to the eye: a*x + b*y + c*z + offset.
struct HalfSpace {
  float n[3], offset;
  float pad;  // bounds the rounding here and that of a vertex
};

class TileCaster {
 public:
  TileCaster(const RayTileInput& frame, int tile_x, int tile_y, std::size_t sample, RayTileScratch& scratch)
      : frame_(frame),
        t_(frame.transform),
        scratch_(scratch),
        sample_(sample),
        place_(frame, tile_x, tile_y, sample),
        buffer_(place_, scratch),
        large_(frame, place_, buffer_),
        queue_(frame, place_, buffer_, large_) {}

  void Cast() {
    if (frame_.tree.root != no_index) {
      SetPlanes();
      Walk();
      queue_.Finish();
    }
    buffer_.WriteOut(frame_, sample_);
  }

 private:
  /// Returns the half-space sign * (row - at * w_row) >= 0. `sign` is such that it contains the tile's rays.
  [[nodiscard]] HalfSpace SidePlane(const std::array<float, 3>& row, float row_offset, double at, double sign) const {
    HalfSpace p{};
    const double w = t_.orthographic ? 0 : 1;
    double terms =
        std::abs(double(row_offset)) + std::abs(at) * (t_.orthographic ? 1.0 : std::abs(double(t_.d_offset)));
    for (int axis = 0; axis < 3; ++axis) {
      p.n[axis] = float(sign * (double(row[std::size_t(axis)]) - at * w * double(t_.d_row[std::size_t(axis)])));
      terms +=
          (std::abs(double(row[std::size_t(axis)])) + std::abs(at) * std::abs(double(t_.d_row[std::size_t(axis)]))) *
          double(frame_.reach[axis]);
    }
    p.offset = float(sign * (double(row_offset) - at * (t_.orthographic ? 1.0 : double(t_.d_offset))));
    p.pad = float(terms * (64 * double(kHalfUlp)));
    return p;
  }

  /// Sets the sides of the frustum of the rays: planes through the tile's outermost samples, not through the tile's
  /// sides.
  void SetPlanes() {
    const double left = place_.first_x, right = left + (place_.width - 1) * kSubPixels;
    const double top = place_.first_y, bottom = top + (place_.height - 1) * kSubPixels;
    planes_[0] = SidePlane(t_.x_row, t_.x_offset, left, 1);
    planes_[1] = SidePlane(t_.x_row, t_.x_offset, right, -1);
    planes_[2] = SidePlane(t_.y_row, t_.y_offset, top, 1);
    planes_[3] = SidePlane(t_.y_row, t_.y_offset, bottom, -1);
    depth_ = SidePlane(t_.d_row, t_.d_offset, 0, 1);
  }

  [[nodiscard]] HWY_INLINE LeafV Distance(const HalfSpace& p, const LeafV (&ends)[2][3], bool farthest) const {
    const LF d;
    LeafV sum[3];
    for (int axis = 0; axis < 3; ++axis)
      // The sign of the normal tells which end of the box is farthest along an axis, so eight corners need not be
      // tested.
      sum[axis] = hn::Mul(hn::Set(d, p.n[axis]), ends[(p.n[axis] >= 0) == farthest ? 1 : 0][axis]);
    return hn::Add(hn::Add(hn::Add(sum[0], sum[1]), sum[2]), hn::Set(d, p.offset));
  }

  /// Returns an upper bound of the keys at this distance or beyond.
  [[nodiscard]] HWY_INLINE LeafV NearestKey(LeafV nearest) const {
    const LF d;
    const LeafV one = hn::Set(d, 1.0f), near = hn::Set(d, t_.near);
    const LeafV key = t_.orthographic ? hn::Mul(hn::Sub(hn::Set(d, t_.far), nearest), hn::Set(d, t_.inverse_range))
                                      : hn::Div(near, nearest);
    const LeafV padded = hn::Mul(key, hn::Set(d, 1.0f + 16 * kHalfUlp));
    // The bound is 1 if the distance is not beyond near, or is NaN.
    return hn::IfThenElse(hn::Gt(nearest, near), hn::Max(hn::Min(padded, one), hn::Zero(d)), one);
  }

  /// Pushes the children that the tile may see, the nearest last.
  HWY_INLINE void LookInto(const RayNode& node) {
    const LF d;
    // Twice the room, because Compactor stores whole vectors.
    alignas(64) std::uint32_t keys[2 * kRayLanes], children[2 * kRayLanes];
    std::size_t count = 0;
    for (std::size_t first = 0; first < node.count; first += kLeafLanes) {
      LeafV ends[2][3];
      for (int axis = 0; axis < 3; ++axis) {
        const LeafV eye = hn::Set(d, t_.eye[std::size_t(axis)]);
        ends[0][axis] = hn::Sub(hn::Load(d, node.low[axis] + first), eye);
        ends[1][axis] = hn::Sub(hn::Load(d, node.high[axis] + first), eye);
      }
      // Outside means strictly outside, by more than rounding can explain; NaN is not outside.
      LeafM outside = hn::Lt(Distance(planes_[0], ends, true), hn::Set(d, -planes_[0].pad));
      for (int i = 1; i < 4; ++i)
        outside = hn::Or(outside, hn::Lt(Distance(planes_[i], ends, true), hn::Set(d, -planes_[i].pad)));
      const LeafV nearest = hn::Sub(Distance(depth_, ends, false), hn::Set(d, depth_.pad));
      const LeafV farthest = hn::Add(Distance(depth_, ends, true), hn::Set(d, depth_.pad));
      outside = hn::Or(outside, hn::Or(hn::Lt(farthest, hn::Set(d, t_.near)), hn::Gt(nearest, hn::Set(d, t_.far))));
      const LeafV key = NearestKey(nearest);
      outside = hn::Or(outside, hn::Lt(key, hn::Set(d, buffer_.tile_farthest())));
      const LU du;
      const auto used = hn::FirstN(d, std::min(kLeafLanes, node.count - first));
      const auto inside = hn::RebindMask(du, hn::AndNot(outside, used));
      const Compactor<LU> compact(inside);
      compact.Store(hn::BitCast(du, key), keys + count);
      compact.Store(hn::Load(du, node.child + first), children + count);
      count += compact.count();
    }
    Push(keys, children, count);
  }

  /// Pushes children, sorted by counting: the position of a child is the number of farther children. No branch depends
  /// on the keys.
  HWY_INLINE void Push(const std::uint32_t* keys, const std::uint32_t* children, std::size_t count) {
    const LI di;
    // The lowest bits tell equal keys apart; only the order depends on them.
    alignas(64) std::int32_t order[kRayLanes];
    for (std::size_t i = 0; i < kRayLanes; ++i)
      order[i] = i < count ? std::int32_t((keys[i] & ~std::uint32_t(kRayLanes - 1)) | i)
                           : std::numeric_limits<std::int32_t>::max();
    for (std::size_t i = 0; i < count; ++i) {
      const auto own = hn::Set(di, order[i]);
      std::size_t rank = 0;
      for (std::size_t k = 0; k < count; k += kLeafLanes)
        rank += hn::CountTrue(di, hn::Lt(hn::Load(di, order + k), own));
      scratch_.stack[waiting_ + rank] = Waiting(keys[i]) << 32 | children[i];
    }
    waiting_ += count;
  }

  void Walk() {
    waiting_ = 1;
    // The key is infinity: nothing hides the root.
    scratch_.stack[0] = Waiting(0x7F800000u) << 32 | frame_.tree.root;
    while (waiting_ > 0) {
      const Waiting next = scratch_.stack[--waiting_];
      const auto bits = std::uint32_t(next >> 32), child = std::uint32_t(next);
      if (waiting_ > 0) frame_.tree.prefetch(std::uint32_t(scratch_.stack[waiting_ - 1]));
      // Refreshes at every fourth leaf only: a visit to a hidden leaf costs less than a refresh.
      if (!(child & kLeafBit) || (++leaves_met_ & 3) == 0) buffer_.Refresh();
      if (bits_as<float>(bits) < buffer_.tile_farthest()) continue;
      if (child & kLeafBit) {
        MeetLeaf(frame_.tree.leaf(child));
      } else {
        LookInto(frame_.tree.nodes[child]);
      }
    }
  }

  [[nodiscard]] HWY_INLINE LeafV Row(const std::array<float, 3>& row, float offset, const LeafV (&delta)[3]) const {
    const LF d;
    const LeafV x = hn::Mul(hn::Set(d, row[0]), delta[0]), y = hn::Mul(hn::Set(d, row[1]), delta[1]);
    return hn::Add(hn::Add(hn::Add(x, y), hn::Mul(hn::Set(d, row[2]), delta[2])), hn::Set(d, offset));
  }

  /// Returns make_corner().is_single of a vector of vertices.
  [[nodiscard]] HWY_INLINE LeafM IsSingle(LeafV x, LeafV y, LeafV distance) const {
    const LF d;
    const LeafV reach =
        t_.orthographic ? hn::Set(d, float(kGuardBand)) : hn::Mul(hn::Set(d, float(kGuardBand)), distance);
    const LeafM between = hn::And(hn::Ge(distance, hn::Set(d, std::max(t_.near, kSingleNear))),
                                  hn::Le(distance, hn::Set(d, std::min(t_.far, kSingleFar))));
    return hn::And(between, hn::And(hn::Le(hn::Abs(x), reach), hn::Le(hn::Abs(y), reach)));
  }

  /// The first and last sample column (or row) that a triangle with vertices from `low` to `high` may cover.
  struct Span {
    LeafV first, last;
  };
  [[nodiscard]] HWY_INLINE Span SamplesWithin(LeafV low, LeafV high, float first_sample, int count) const {
    const LF d;
    const LeafV pad = hn::Set(d, 32 * kHalfUlp * float(std::max(t_.centre_x, t_.centre_y)));
    const LeafV start = hn::Set(d, first_sample), scale = hn::Set(d, 1 / kPixel);
    const LeafV first = hn::Ceil(hn::Mul(hn::Sub(hn::Sub(low, pad), start), scale));
    const LeafV last = hn::Floor(hn::Mul(hn::Sub(hn::Add(high, pad), start), scale));
    return {hn::Max(first, hn::Zero(d)), hn::Min(last, hn::Set(d, float(count - 1)))};
  }

  /// Inverts three numbers to a few units in the last place, by one division. kSingleNear and kSingleFar keep the
  /// products in range.
  static HWY_INLINE void Invert(const LeafV (&d)[3], LeafV (&inverse)[3]) {
    const LeafV ab = hn::Mul(d[0], d[1]), all = hn::Div(hn::Set(LF(), 1.0f), hn::Mul(ab, d[2]));
    const LeafV c = hn::Mul(all, d[2]);
    inverse[0] = hn::Mul(c, d[1]);
    inverse[1] = hn::Mul(c, d[0]);
    inverse[2] = hn::Mul(all, ab);
  }

  void MeetLeaf(const RayLeaf& leaf) {
    for (std::size_t first = 0; first < kRayLanes; first += kLeafLanes) MeetLanes(leaf, first);
  }

  /// Returns the hidden ones of the triangles that touch up to 2 x 2 blocks: every pixel of the blocks shows something
  /// nearer.
  [[nodiscard]] HWY_INLINE LeafM Hidden(LeafV nearest, LeafI x0, LeafI y0, LeafI x1, LeafI y1) const {
    const LF d;
    const LI di;
    const LeafI left = hn::ShiftRight<2>(x0), right = hn::ShiftRight<2>(x1);
    const LeafI top = hn::ShiftLeft<3>(hn::ShiftRight<2>(y0)), bottom = hn::ShiftLeft<3>(hn::ShiftRight<2>(y1));
    const auto few =
        hn::And(hn::Lt(hn::Sub(right, left), hn::Set(di, 2)), hn::Lt(hn::Sub(bottom, top), hn::Set(di, 2 * kBlocks)));
    const auto farthest = [&](LeafI block) HWY_ATTR { return hn::GatherIndex(d, buffer_.farthest(), block); };
    const LeafV above = hn::Min(farthest(hn::Add(top, left)), farthest(hn::Add(top, right)));
    const LeafV below = hn::Min(farthest(hn::Add(bottom, left)), farthest(hn::Add(bottom, right)));
    return hn::And(hn::RebindMask(d, few), hn::Lt(nearest, hn::Min(above, below)));
  }

  /// Puts the homogeneous screen positions of vertices into the batch. \returns the triangles whose vertices are all
  /// single.
  HWY_INLINE LeafM PlaceCorners(const RayLeaf& leaf, std::size_t first, RayTriangleQueue::Batch& to) const {
    const LF d;
    LeafM single = hn::MaskFromVec(hn::Zero(d));
    for (int k = 0; k < 3; ++k) {
      LeafV delta[3];
      for (int axis = 0; axis < 3; ++axis)
        delta[axis] = hn::Sub(hn::Load(d, leaf.corner[k][axis] + first), hn::Set(d, t_.eye[std::size_t(axis)]));
      to.x[k] = Row(t_.x_row, t_.x_offset, delta);
      to.y[k] = Row(t_.y_row, t_.y_offset, delta);
      to.d[k] = Row(t_.d_row, t_.d_offset, delta);
      const LeafM is_single = IsSingle(to.x[k], to.y[k], to.d[k]);
      single = k == 0 ? is_single : hn::And(single, is_single);
    }
    return single;
  }

  /// Screen bounds of triangles: a rectangle of samples, and an upper bound `nearest` of the keys.
  struct Extent {
    Span across, down;
    LeafV nearest;
  };
  [[nodiscard]] HWY_INLINE Extent ExtentOf(const RayTriangleQueue::Batch& batch) const {
    const LF d;
    const auto least = [](const LeafV(&v)[3]) HWY_ATTR { return hn::Min(hn::Min(v[0], v[1]), v[2]); };
    const auto greatest = [](const LeafV(&v)[3]) HWY_ATTR { return hn::Max(hn::Max(v[0], v[1]), v[2]); };
    const LeafV one = hn::Set(d, 1.0f);
    LeafV inverse[3] = {one, one, one};
    if (!t_.orthographic) Invert(batch.d, inverse);
    LeafV xs[3], ys[3];
    for (int k = 0; k < 3; ++k) {
      xs[k] = hn::Mul(batch.x[k], inverse[k]);
      ys[k] = hn::Mul(batch.y[k], inverse[k]);
    }
    return {SamplesWithin(least(xs), greatest(xs), place_.first_x, place_.width),
            SamplesWithin(least(ys), greatest(ys), place_.first_y, place_.height),
            t_.orthographic ? KeyOfDistance(LF(), t_, least(batch.d))
                            : hn::Mul(hn::Set(d, t_.near * (1 + 16 * kHalfUlp)), greatest(inverse))};
  }

  /// Drops hidden triangles, if testing for them has paid lately.
  [[nodiscard]] HWY_INLINE LeafM WithoutHidden(LeafM kept, LeafV nearest, LeafI x0, LeafI y0, LeafI x1, LeafI y1) {
    if (hidden_credit_ <= 0 && (leaves_met_ & 15) != 0) return kept;
    const LF d;
    const std::size_t before = hn::CountTrue(d, kept);
    const LeafM left = hn::AndNot(Hidden(nearest, x0, y0, x1, y1), kept);
    // A test costs as much as two hidden triangles save.
    hidden_credit_ = std::min(hidden_credit_ + int(before - hn::CountTrue(d, left)) - 2, kMostCredit);
    return left;
  }

  HWY_INLINE void MeetLanes(const RayLeaf& leaf, std::size_t first) {
    const LF d;
    const LU du;
    RayTriangleQueue::Batch batch;
    batch.id = hn::Load(du, leaf.id + first);
    const LeafM single = PlaceCorners(leaf, first, batch);
    const LeafM used = hn::RebindMask(d, hn::Ne(batch.id, hn::Set(du, no_primitive)));
    const LeafM wide = hn::AndNot(single, used);
    if (HWY_UNLIKELY(!hn::AllFalse(d, wide))) MeetWide(leaf, first, wide);

    const Extent extent = ExtentOf(batch);
    const auto& [across, down, nearest] = extent;
    LeafM kept = hn::And(hn::And(single, used), hn::Ge(nearest, hn::Set(d, buffer_.tile_farthest())));
    kept = hn::And(kept, hn::And(hn::Le(across.first, across.last), hn::Le(down.first, down.last)));
    if (hn::AllFalse(d, kept)) return;

    // Lanes that are not kept may hold anything, so they are clamped.
    const auto as_int = [&](LeafV v) HWY_ATTR {
      return hn::ConvertTo(LI(), hn::Min(hn::Max(v, hn::Zero(d)), hn::Set(d, float(kTileSize - 1))));
    };
    const auto x0 = as_int(across.first), x1 = as_int(across.last), y0 = as_int(down.first), y1 = as_int(down.last);
    kept = WithoutHidden(kept, nearest, x0, y0, x1, y1);
    if (hn::AllFalse(d, kept)) return;
    const auto byte = [&](auto v) HWY_ATTR { return hn::BitCast(du, v); };
    batch.rect = hn::Or(hn::Or(byte(x0), hn::ShiftLeft<8>(byte(y0))),
                        hn::Or(hn::ShiftLeft<16>(byte(x1)), hn::ShiftLeft<24>(byte(y1))));
    queue_.Add(batch, kept);
  }

  /// Meets triangles with a vertex that needs doubles, one by one.
  HWY_NOINLINE void MeetWide(const RayLeaf& leaf, std::size_t first, LeafM wide) {
    ForEachBit(BitsOf(LF(), wide), [&](std::size_t bit) {
      const std::size_t lane = first + bit;
      LargeTriangle<WideCorners> large;
      const SampleTriangle triangle = make_triangle(t_, leaf.corners_of(lane));
      large.corners.corners = triangle.corners;
      large.plane = key_plane(frame_.view, t_, triangle, {place_.centre_x, place_.centre_y});
      if (large.plane.is_outside || large.plane.high < buffer_.tile_farthest()) return;
      large.rect = {0, 0, place_.width - 1, place_.height - 1};
      large.id = leaf.id[lane];
      large_.Draw(large);
    });
  }

  const RayTileInput& frame_;
  const ScreenTransform& t_;
  RayTileScratch& scratch_;
  std::size_t sample_;
  TilePlace place_;
  RayTileBuffer buffer_;
  LargeRayTriangles large_;
  RayTriangleQueue queue_;
  HalfSpace planes_[4], depth_;
  std::size_t waiting_ = 0;
  std::uint32_t leaves_met_ = 0;
  static constexpr int kMostCredit = 16;
  int hidden_credit_ = kMostCredit;
};

void CastTile(const RayTileInput& frame, int x, int y, RayTileScratch& scratch) {
  for (std::size_t sample = 0; sample < frame.samples.size(); ++sample) TileCaster(frame, x, y, sample, scratch).Cast();
}

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::raycast_detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace frontmost::raycast_detail {

FRONTMOST_KERNELS(CastTile);

void cast_tile(const RayTileInput& frame, int x, int y, RayTileScratch& scratch, Isa isa) {
  kernel_for(CastTileKernels, isa)(frame, x, y, scratch);
}

}  // namespace frontmost::raycast_detail
#endif  // HWY_ONCE
