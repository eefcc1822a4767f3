// SPDX-License-Identifier: Apache-2.0
// Triangles of more than a few pixels, one at a time, by blocks of 4 x 4 pixels. Blocks that are hidden, or clear of
// every edge, are found first, many at a time.
//
//    +--+--+--+--+      The tile is 8 x 8 blocks. All blocks are classified at once: hidden by earlier triangles (H),
//    |  |o |o |  |      wholly outside of an edge (o), or wholly inside of all three edges (F). Full blocks need no
//    |H |  |F |o |      edges any more, only depths.
//    |H |F |F |  |
//    +--+--+--+--+
//
// Edges are affine over the tile. Bounds of the rounding of shearing and products are taken off on both sides, so a
// block is classified only if the rule itself would decide every sample in it the same way.

// Included once for every target.
#if defined(FRONTMOST_RAYCAST_LARGE_TRIANGLES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FRONTMOST_RAYCAST_LARGE_TRIANGLES_INL_H_
#undef FRONTMOST_RAYCAST_LARGE_TRIANGLES_INL_H_
#else
#define FRONTMOST_RAYCAST_LARGE_TRIANGLES_INL_H_
#endif

#include "raycast/tile/meeting-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::raycast_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// From this many blocks on, blocks are classified by the edges first.
constexpr int kClassifyFrom = 5;
constexpr float kBlockReach = 0.5f * (kBlock - 1) * kPixel;  // distance of a block's outermost samples from their
                                                             // middle

/// Columns and rows of a block's pixels from its first pixel, and the middles of the tile's blocks from its first
/// sample.
struct Offsets {
  alignas(64) float x[kBlockPixels], y[kBlockPixels], block_x[kBlockCount], block_y[kBlockCount];
  constexpr Offsets() : x(), y(), block_x(), block_y() {
    for (int i = 0; i < int(kBlockPixels); ++i) {
      x[i] = float(i % kBlock * kSubPixels);
      y[i] = float(i / kBlock * kSubPixels);
    }
    for (int i = 0; i < int(kBlockCount); ++i) {
      block_x[i] = float(i % kBlocks * kBlock * kSubPixels) + kBlockReach;
      block_y[i] = float(i / kBlocks * kBlock * kSubPixels) + kBlockReach;
    }
  }
};
constexpr Offsets kOffsets;

/// Pixels of the tile, both ends included.
struct Rect {
  int x0, y0, x1, y1;
};

/// Three vertices in floats.
struct SingleCorners {
  float x[3], y[3], d[3];

  [[nodiscard]] bool operator==(const SingleCorners& other) const {
    bool same = true;
    for (int k = 0; k < 3 && same; ++k) same = x[k] == other.x[k] && y[k] == other.y[k] && d[k] == other.d[k];
    return same;
  }

  [[nodiscard]] std::array<SampleCorner, 3> all() const {
    std::array<SampleCorner, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) corners[k] = {x[k], y[k], d[k], true};
    return corners;
  }
};

/// Three vertices, some of which may need doubles.
struct WideCorners {
  std::array<SampleCorner, 3> corners;

  [[nodiscard]] const std::array<SampleCorner, 3>& all() const { return corners; }
};

template <class Corners>
struct LargeTriangle {
  Corners corners;
  TileKeyPlane plane;
  Rect rect;
  PrimitiveId id;
};

class LargeRayTriangles {
 public:
  LargeRayTriangles(const RayTileInput& frame, const TilePlace& place, RayTileBuffer& buffer)
      : t_(frame.transform), facing_(frame.facing), place_(place), buffer_(buffer) {}

  template <class Corners>
  HWY_INLINE void Draw(const LargeTriangle<Corners>& large) {
    std::uint64_t open = BlocksOf(large.rect), full = 0;
    if (hwy::PopCount(open) < std::size_t(kClassifyFrom)) {
      std::uint64_t hidden = 0;
      ForEachBit(open, [&](std::size_t block) {
        // With few blocks, the greatest key of the whole triangle serves: computing the key of each block would cost
        // more than it hides.
        hidden |= std::uint64_t(large.plane.high < buffer_.farthest()[block]) << block;
      });
      open &= ~hidden;
    } else {
      open &= ~Hidden(large.plane);
      Edges edges;
      if (hwy::PopCount(open) >= std::size_t(kClassifyFrom) && SetEdges(large.corners.all(), edges)) {
        if (!keeps(facing_, large.id, edges.facing)) return;
        const Classes classes = Classify(edges);
        open &= ~classes.outside;
        full = classes.full;
      }
    }
    if (open == 0) return;
    DrawBlocks(large, open, full);
  }

 private:
  [[nodiscard]] static std::uint64_t BlocksOf(const Rect& r) {
    const int x0 = r.x0 / kBlock, columns = r.x1 / kBlock - x0 + 1;
    const std::uint64_t row = ((std::uint64_t(1) << columns) - 1) << x0;
    std::uint64_t blocks = 0;
    for (int y = r.y0 / kBlock; y <= r.y1 / kBlock; ++y) blocks |= row << (y * kBlocks);
    return blocks;
  }

  /// Blocks in which every key so far is greater than all keys of the triangle.
  [[nodiscard]] std::uint64_t Hidden(const TileKeyPlane& plane) const {
    const DF d;
    const float slope = std::abs(plane.gx) + std::abs(plane.gy);
    // Rounding here and of the keys is a few units in the last place of the sum.
    const float pad = 16 * kHalfUlp * (std::abs(plane.k0) + slope * (kTileSize * kPixel));
    const VF start = hn::Set(d, plane.k0 + (slope * kBlockReach + pad));
    const VF gx = hn::Set(d, plane.gx), gy = hn::Set(d, plane.gy), high = hn::Set(d, plane.high);
    const VF first_x = hn::Set(d, place_.first_x - place_.centre_x),
             first_y = hn::Set(d, place_.first_y - place_.centre_y);
    std::uint64_t hidden = 0;
    for (std::size_t i = 0; i < kBlockCount; i += kLanes) {
      const VF u = hn::Add(hn::Load(d, kOffsets.block_x + i), first_x);
      const VF v = hn::Add(hn::Load(d, kOffsets.block_y + i), first_y);
      // The key at the middle of the block, plus the change to its nearest sample. No key is greater than the vertices'
      // keys.
      const VF nearest = hn::Min(hn::Add(start, hn::Add(hn::Mul(u, gx), hn::Mul(v, gy))), high);
      hidden |= std::uint64_t(BitsOf(d, hn::Lt(nearest, hn::Load(d, buffer_.farthest() + i)))) << i;
    }
    return hidden;
  }

  /// E(u, v) = e0 + u*ex + v*ey from the tile's centre, positive inside. |E| <= slack decides nothing.
  struct Edges {
    float ex[3], ey[3], e0[3], slack[3];
    int facing;
  };

  /// \returns false if nothing can be decided in advance.
  bool SetEdges(const std::array<SampleCorner, 3>& corners, Edges& edges) const {
    double x[3], y[3], w[3], size[3], error[3];
    const double half = double(std::max(t_.centre_x, t_.centre_y)) + kSubPixels, tile = 0.5 * kTileSize * kSubPixels;
    for (std::size_t k = 0; k < 3; ++k) {
      const SampleCorner& c = corners[k];
      w[k] = t_.orthographic ? 1.0 : c.d;
      x[k] = c.x - double(place_.centre_x) * w[k];
      y[k] = c.y - double(place_.centre_y) * w[k];
      // The greatest size of a sheared corner, and its rounding by shearing in units in the last place.
      size[k] = std::max(std::abs(x[k]), std::abs(y[k])) + tile * std::abs(w[k]);
      error[k] = half * std::abs(w[k]) + size[k];
    }
    double e[3][3], det = 0, det_slack = 0;
    for (int k = 0; k < 3; ++k) {
      const int a = (k + 1) % 3, b = (k + 2) % 3;
      // Expands (x_a - u w_a)(y_b - v w_b) - (y_a - v w_a)(x_b - u w_b), in which u v cancels.
      e[k][0] = y[a] * w[b] - w[a] * y[b];
      e[k][1] = w[a] * x[b] - x[a] * w[b];
      e[k][2] = x[a] * y[b] - y[a] * x[b];
      const double slack = 8 * double(kHalfUlp) * (error[a] * size[b] + error[b] * size[a]);
      edges.slack[k] = float(slack) * 1.001f;
      // The determinant of the three corners has the sign of all edges if the triangle is before the eye.
      det += e[k][2] * w[k];
      det_slack += slack * std::abs(w[k]);
    }
    // Nothing is decided for overflow, NaN, or a triangle that is edge-on as far as rounding can tell.
    if (!(std::abs(det) > det_slack && det_slack < 0x1p120)) return false;
    const double sign = det > 0 ? 1 : -1;
    edges.facing = int(sign);
    for (int k = 0; k < 3; ++k) {
      edges.ex[k] = float(sign * e[k][0]);
      edges.ey[k] = float(sign * e[k][1]);
      edges.e0[k] = float(sign * e[k][2]);
      if (!(std::abs(edges.e0[k]) + edges.slack[k] < 0x1p100f)) return false;
    }
    return true;
  }

  struct Classes {
    std::uint64_t outside = 0, full = 0;
  };

  [[nodiscard]] Classes Classify(const Edges& e) const {
    const DF d;
    VF ex[3], ey[3], outer[3], inner[3];
    for (int k = 0; k < 3; ++k) {
      const float around = (std::abs(e.ex[k]) + std::abs(e.ey[k])) * kBlockReach;
      ex[k] = hn::Set(d, e.ex[k]);
      ey[k] = hn::Set(d, e.ey[k]);
      outer[k] = hn::Set(d, e.e0[k] + (around + e.slack[k]));
      inner[k] = hn::Set(d, e.e0[k] - (around + e.slack[k]));
    }
    const VF first_x = hn::Set(d, place_.first_x - place_.centre_x),
             first_y = hn::Set(d, place_.first_y - place_.centre_y);
    const VF zero = hn::Zero(d);
    Classes classes;
    for (std::size_t i = 0; i < kBlockCount; i += kLanes) {
      const VF u = hn::Add(hn::Load(d, kOffsets.block_x + i), first_x);
      const VF v = hn::Add(hn::Load(d, kOffsets.block_y + i), first_y);
      VF most = zero, least = zero;
      for (int k = 0; k < 3; ++k) {
        const VF step = hn::Add(hn::Mul(u, ex[k]), hn::Mul(v, ey[k]));
        const VF a = hn::Add(outer[k], step), b = hn::Add(inner[k], step);
        most = k == 0 ? a : hn::Min(most, a);
        least = k == 0 ? b : hn::Min(least, b);
      }
      classes.outside |= std::uint64_t(BitsOf(d, hn::Lt(most, zero))) << i;
      classes.full |= std::uint64_t(BitsOf(d, hn::Gt(least, zero))) << i;
    }
    return classes;
  }

  // -- blocks -------------------------------------------------------------------------------------------------------

  /// The three corners that the rays of every block are tested against.
  struct SingleVectors {
    VF x[3], y[3], w[3];
  };
  [[nodiscard]] HWY_INLINE SingleVectors Vectors(const SingleCorners& corners) const {
    const DF d;
    SingleVectors v;
    for (int k = 0; k < 3; ++k) {
      v.x[k] = hn::Set(d, corners.x[k]);
      v.y[k] = hn::Set(d, corners.y[k]);
      v.w[k] = hn::Set(d, t_.orthographic ? 1.0f : corners.d[k]);
    }
    return v;
  }
  [[nodiscard]] static const WideCorners& Vectors(const WideCorners& corners) { return corners; }

  template <class Corners>
  HWY_INLINE void DrawBlocks(const LargeTriangle<Corners>& large, std::uint64_t open, std::uint64_t full) {
    const DF d;
    const DU du;
    const TileKeyPlane& plane = large.plane;
    const VF gx = hn::Set(d, plane.gx), gy = hn::Set(d, plane.gy), k0 = hn::Set(d, plane.k0);
    const VF low = hn::Set(d, plane.low), high = hn::Set(d, plane.high);
    const VU id = hn::Set(du, large.id);
    const auto& vectors = Vectors(large.corners);
    ForEachBit(open, [&](std::size_t block) HWY_ATTR {
      const VF start_x = hn::Set(d, place_.first_x + float(int(block) % kBlocks * kBlock * kSubPixels));
      const VF start_y = hn::Set(d, place_.first_y + float(int(block) / kBlocks * kBlock * kSubPixels));
      const bool is_full = full >> block & 1;
      bool changed = false;
      for (std::size_t i = 0; i < kBlockPixels; i += kLanes) {
        const VF sx = hn::Add(start_x, hn::Load(d, kOffsets.x + i)), sy = hn::Add(start_y, hn::Load(d, kOffsets.y + i));
        const VF u = hn::Sub(sx, hn::Set(d, place_.centre_x)), v = hn::Sub(sy, hn::Set(d, place_.centre_y));
        const VF raw = hn::Add(hn::Add(k0, hn::Mul(u, gx)), hn::Mul(v, gy));
        const VF key = hn::Min(hn::Max(raw, low), high);
        float* keys = buffer_.keys(block) + i;
        PrimitiveId* ids = buffer_.ids(block) + i;
        const VF old_key = hn::Load(d, keys);
        const VU old_id = hn::Load(du, ids);
        const MF lower = hn::RebindMask(d, hn::Lt(id, old_id));
        MF nearer = hn::Or(hn::Gt(key, old_key), hn::And(hn::Eq(key, old_key), lower));
        if (plane.is_clipped)
          nearer = hn::And(nearer, hn::And(hn::Ge(raw, hn::Set(d, plane.cut)), hn::Le(raw, hn::Set(d, 1.0f))));
        if (hn::AllFalse(d, nearer)) continue;
        if (!is_full) nearer = hn::And(nearer, Met(large, vectors, sx, sy));
        hn::Store(hn::IfThenElse(nearer, key, old_key), d, keys);
        hn::Store(hn::IfThenElse(hn::RebindMask(du, nearer), id, old_id), du, ids);
        changed = true;
      }
      if (changed) buffer_.Update(block);
    });
  }

  [[nodiscard]] HWY_INLINE MF Met(const LargeTriangle<SingleCorners>& large, const SingleVectors& c, VF sx,
                                  VF sy) const {
    const DF d;
    VF x[3], y[3];
    for (int k = 0; k < 3; ++k) {
      x[k] = hn::Sub(c.x[k], hn::Mul(sx, c.w[k]));
      y[k] = hn::Sub(c.y[k], hn::Mul(sy, c.w[k]));
    }
    const EdgeSides sides = SidesOf(x, y);
    const auto ids = [&]() HWY_ATTR { return hn::Set(DU(), large.id); };
    const MF met = Kept(d, facing_, sides.front, sides.back, ids);
    if (HWY_LIKELY(hn::AllFalse(d, sides.doubtful))) return met;
    return Resolve(met, sides.doubtful, sx, sy, [&](std::size_t, float px, float py) {
      return keeps(facing_, large.id, facing(t_, large.corners.all(), px, py));
    });
  }

  /// Met() in doubles, whose products may be rounded: the exact rule decides if two products are equal.
  [[nodiscard]] HWY_NOINLINE MF Met(const LargeTriangle<WideCorners>& large, const WideCorners& wide, VF sx,
                                    VF sy) const {
    const DF d;
    const DI di;
    const DD dd;
    const DHF dh;
    alignas(64) float fx[kLanes], fy[kLanes];
    alignas(64) std::int32_t answer[kLanes];
    hn::Store(sx, d, fx);
    hn::Store(sy, d, fy);
    for (std::size_t i = 0; i < kLanes; i += kDoubles) {
      VD x[3], y[3], det[3];
      for (std::size_t k = 0; k < 3; ++k) {
        const SampleCorner& c = wide.corners[k];
        const double w = t_.orthographic ? 1.0 : c.d;
        x[k] = Sheared(c.x, w, c.is_single, hn::Load(dh, fx + i));
        y[k] = Sheared(c.y, w, c.is_single, hn::Load(dh, fy + i));
      }
      for (int k = 0; k < 3; ++k) {
        const int a = (k + 1) % 3, b = (k + 2) % 3;
        det[k] = hn::Sub(hn::Mul(x[a], y[b]), hn::Mul(y[a], x[b]));
      }
      alignas(64) double least[kDoubles], most[kDoubles], closest[kDoubles];
      hn::Store(hn::Min(hn::Min(det[0], det[1]), det[2]), dd, least);
      hn::Store(hn::Max(hn::Max(det[0], det[1]), det[2]), dd, most);
      hn::Store(hn::Min(hn::Min(hn::Abs(det[0]), hn::Abs(det[1])), hn::Abs(det[2])), dd, closest);
      for (std::size_t lane = 0; lane < kDoubles; ++lane) {
        const bool certain = closest[lane] > 0;
        const int sign = least[lane] > 0 ? 1 : most[lane] < 0 ? -1 : 0;
        answer[i + lane] =
            keeps(facing_, large.id, certain ? sign : facing(t_, wide.corners, fx[i + lane], fy[i + lane])) ? -1 : 0;
      }
    }
    return hn::RebindMask(d, hn::MaskFromVec(hn::Load(di, answer)));
  }

  /// One coordinate of sheared().
  static HWY_INLINE VD Sheared(double c, double w, bool is_single, hn::Vec<DHF> s) {
    const DD dd;
    const DHF dh;
    if (is_single) return hn::PromoteTo(dd, hn::Sub(hn::Set(dh, float(c)), hn::Mul(s, hn::Set(dh, float(w)))));
    return hn::Sub(hn::Set(dd, c), hn::Mul(hn::PromoteTo(dd, s), hn::Set(dd, w)));
  }

  const ScreenTransform& t_;
  const FacingRule facing_;  // a copy, as the inner loops read it
  const TilePlace& place_;
  RayTileBuffer& buffer_;
};

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::raycast_detail
HWY_AFTER_NAMESPACE();

#endif  // include guard by target
