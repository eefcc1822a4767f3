// SPDX-License-Identifier: Apache-2.0
// Draws triangles into a tile: triangles of a few pixels many at a time, larger ones one at a time, by blocks of 4 x 4
// pixels.
//
//    +--+--+--+--+      All blocks are classified at once: hidden by earlier triangles (H), wholly outside of an edge
//    |  |o |o |  |      (o), or wholly inside of all three edges (F). Full blocks need no edges any more, only depths.
//    |H |  |F |o |      Edges are affine over the tile. Bounds of the rounding of shearing and products are taken off
//    |H |F |F |  |      on both sides, so a block is classified only if the rule itself would decide every sample in
//    +--+--+--+--+      it the same way.

// Included once for every target.
#if defined(FRONTMOST_RAYCAST_TRIANGLES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FRONTMOST_RAYCAST_TRIANGLES_INL_H_
#undef FRONTMOST_RAYCAST_TRIANGLES_INL_H_
#else
#define FRONTMOST_RAYCAST_TRIANGLES_INL_H_
#endif

#include <algorithm>
#include <cstring>

#include "base/compactor-inl.h"
#include "base/highway-inl.h"
#include "base/lanes-inl.h"
#include "hwy/cache_control.h"
#include "raycast/tile/tile_kernel.h"
#include "view/facing-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::raycast_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// One tile's answer while its rays are cast: the nearest key and id of every pixel, and the farthest key of every
// block.
//
//    tile     32 x 32 pixels, 8 x 8 blocks           Within a block pixels lie row by row, so that a vector of sixteen
//    block    4 x 4 pixels, one vector of keys       lanes is a block. `farthest` has the farthest key of each block:
//                                                    a triangle or box that is farther everywhere is not looked at.

using frontmost::HWY_NAMESPACE::BitsOf;
using frontmost::HWY_NAMESPACE::Compactor;
using frontmost::HWY_NAMESPACE::ForEachBit;
using view_detail::HWY_NAMESPACE::Kept;

constexpr int kBlock = 4;  // pixels of a block's side
constexpr std::size_t kBlockPixels = kBlock * kBlock;

// Vectors of pixels, and of the queue's triangles, have at most as many lanes as a block has pixels.
using DF = hn::CappedTag<float, kBlockPixels>;
using DU = hn::RebindToUnsigned<DF>;
using DI = hn::RebindToSigned<DF>;
using VF = hn::Vec<DF>;
using VU = hn::Vec<DU>;
using VI = hn::Vec<DI>;
using MF = hn::Mask<DF>;
// Whole vectors of doubles, and half vectors of floats with as many lanes.
using DD = hn::CappedTag<double, kBlockPixels>;
using DHF = hn::Rebind<float, DD>;
using VD = hn::Vec<DD>;

// Vectors of a leaf's triangles or a node's boxes.
using LF = hn::CappedTag<float, kRayLanes>;
using LU = hn::RebindToUnsigned<LF>;
using LI = hn::RebindToSigned<LF>;
using LeafV = hn::Vec<LF>;
using LeafI = hn::Vec<LI>;
using LeafM = hn::Mask<LF>;

constexpr std::size_t kLanes = hn::MaxLanes(DF()), kLeafLanes = hn::MaxLanes(LF());
constexpr std::size_t kDoubles = hn::MaxLanes(DD());

constexpr int kBlocks = kTileSize / kBlock;  // blocks of a tile's side
constexpr std::size_t kBlockCount = kBlocks * kBlocks;
constexpr float kPixel = kSubPixels;
/// Half a unit in the last place of a float, relative.
constexpr float kHalfUlp = 0x1p-24f;

/// The tile's place; distances are from the image's centre in 1/256 pixel.
struct TilePlace {
  int x0, y0, width, height;  // pixels
  float centre_x, centre_y;   // of the tile
  float first_x, first_y;     // the first sample

  TilePlace(const RayTileInput& frame, int tile_x, int tile_y, std::size_t sample)
      : x0(tile_x * kTileSize), y0(tile_y * kTileSize) {
    const ScreenTransform& t = frame.transform;
    width = std::min(kTileSize, frame.view.width - x0);
    height = std::min(kTileSize, frame.view.height - y0);
    centre_x = float((x0 + kTileSize / 2) * kSubPixels - t.centre_x);
    centre_y = float((y0 + kTileSize / 2) * kSubPixels - t.centre_y);
    first_x = float(x0 * kSubPixels + frame.samples[sample].x - t.centre_x);
    first_y = float(y0 * kSubPixels + frame.samples[sample].y - t.centre_y);
  }
};

class RayTileBuffer {
 public:
  RayTileBuffer(const TilePlace& place, RayTileScratch& scratch)
      : place_(place), keys_(scratch.keys), ids_(scratch.ids), farthest_(scratch.farthest) {
    std::fill_n(keys_, RayTileScratch::kPixels, 0.0f);
    std::fill_n(ids_, RayTileScratch::kPixels, no_primitive);
    std::fill_n(farthest_, kBlockCount, 0.0f);
    if (place.width == kTileSize && place.height == kTileSize) return;
    // Pixels outside the image are nearer than anything, so they never keep a block from hiding.
    for (int y = 0; y < kTileSize; ++y)
      for (int x = 0; x < kTileSize; ++x)
        if (x >= place.width || y >= place.height) keys_[PixelIndex(x, y)] = std::numeric_limits<float>::max();
    dirty_ = ~std::uint64_t(0);
  }

  [[nodiscard]] static std::size_t PixelIndex(int x, int y) {
    return std::size_t(((y >> 2) * kBlocks + (x >> 2)) * int(kBlockPixels) + (y & 3) * kBlock + (x & 3));
  }
  [[nodiscard]] HWY_INLINE float* keys(std::size_t block) const { return keys_ + block * kBlockPixels; }
  [[nodiscard]] HWY_INLINE PrimitiveId* ids(std::size_t block) const { return ids_ + block * kBlockPixels; }

  /// Lower bounds of the keys in each block, and in the whole tile: farther triangles are hidden. The bounds may lag
  /// behind.
  [[nodiscard]] HWY_INLINE const float* farthest() const { return farthest_; }
  [[nodiscard]] HWY_INLINE float tile_farthest() const { return tile_farthest_; }

  HWY_INLINE void Merge(std::size_t pixel, float key, PrimitiveId id) {
    const bool nearer = key > keys_[pixel] || (key == keys_[pixel] && id < ids_[pixel]);
    keys_[pixel] = nearer ? key : keys_[pixel];
    ids_[pixel] = nearer ? id : ids_[pixel];
    dirty_ |= std::uint64_t(1) << (pixel / kBlockPixels);
  }

  /// Finds the farthest key of a block. Call after writing the block.
  HWY_INLINE void Update(std::size_t block) {
    farthest_[block] = FarthestOfBlock(block);
    is_stale_ = true;
  }

  /// Brings farthest() and tile_farthest() up to date.
  HWY_INLINE void Refresh() {
    if (dirty_ != 0) {
      ForEachBit(dirty_, [&](std::size_t block) HWY_ATTR { farthest_[block] = FarthestOfBlock(block); });
      dirty_ = 0;
      is_stale_ = true;
    }
    if (!is_stale_) return;
    is_stale_ = false;
    const DF d;
    VF least = hn::Load(d, farthest_);
    for (std::size_t i = kLanes; i < kBlockCount; i += kLanes) least = hn::Min(least, hn::Load(d, farthest_ + i));
    tile_farthest_ = hn::GetLane(hn::MinOfLanes(d, least));
  }

  void WriteOut(const RayTileInput& frame, std::size_t sample) const {
    const std::size_t plane = sample * frame.view.pixel_count();
    const bool whole = place_.width == kTileSize && frame.view.width % kBlock == 0;
    for (int y = 0; y < place_.height; ++y) {
      const std::size_t to =
          plane + std::size_t(place_.y0 + y) * std::size_t(frame.view.width) + std::size_t(place_.x0);
      if (whole && frame.streams) {
        StreamRow(keys_, y, frame.keys + to);
        StreamRow(ids_, y, frame.primitives + to);
      } else {
        CopyRow(keys_, y, frame.keys + to);
        CopyRow(ids_, y, frame.primitives + to);
      }
    }
  }

 private:
  [[nodiscard]] HWY_INLINE float FarthestOfBlock(std::size_t block) const {
    const DF d;
    const float* from = keys(block);
    VF least = hn::Load(d, from);
    for (std::size_t i = kLanes; i < kBlockPixels; i += kLanes) least = hn::Min(least, hn::Load(d, from + i));
    return hn::GetLane(hn::MinOfLanes(d, least));
  }

  template <class T>
  void CopyRow(const T* tile, int y, T* to) const {
    for (int x = 0; x < place_.width; x += kBlock)
      std::memcpy(to + x, tile + PixelIndex(x, y), std::size_t(std::min(kBlock, place_.width - x)) * sizeof(T));
  }

  /// Writes a row past the caches, as it is not read soon.
  template <class T>
  HWY_INLINE void StreamRow(const T* tile, int y, T* to) const {
    const hn::CappedTag<T, kBlock> d;
    for (int x = 0; x < kTileSize; x += kBlock)
      for (int i = 0; i < kBlock; i += int(hn::Lanes(d)))
        hn::Stream(hn::Load(d, tile + PixelIndex(x, y) + i), d, to + x + i);
  }

  const TilePlace& place_;
  float* keys_;
  PrimitiveId* ids_;
  float* farthest_;
  std::uint64_t dirty_ = 0;  // blocks whose farthest key lags behind
  bool is_stale_ = true;
  float tile_farthest_ = 0;
};

// SidesOf() makes the test of sample_rule.h for many rays and triangles at a time. Doubtful lanes are decided one by
// one by the rule itself. They are few, because their edges pass exactly through samples.

/// The lanes in which all three determinants are negative (`front`) or positive (`back`), and the lanes in which one is
/// zero (`doubtful`). Rounding is monotonic, so a difference of two products has the right sign unless it is zero.
struct EdgeSides {
  MF front, back, doubtful;
};

HWY_INLINE EdgeSides SidesOf(const VF (&x)[3], const VF (&y)[3]) {
  const DF d;
  const VF u = hn::Sub(hn::Mul(x[1], y[2]), hn::Mul(y[1], x[2]));
  const VF v = hn::Sub(hn::Mul(x[2], y[0]), hn::Mul(y[2], x[0]));
  const VF w = hn::Sub(hn::Mul(x[0], y[1]), hn::Mul(y[0], x[1]));
  const VF zero = hn::Zero(d);
  const VF least = hn::Min(hn::Min(u, v), w), most = hn::Max(hn::Max(u, v), w);
  const VF closest = hn::Min(hn::Min(hn::Abs(u), hn::Abs(v)), hn::Abs(w));
  return {hn::Lt(most, zero), hn::Gt(least, zero), hn::Eq(closest, zero)};
}

/// Decides the doubtful lanes one by one with `meets(lane, sx, sy)`.
template <class Meets>
HWY_NOINLINE MF Resolve(MF met, MF doubtful, VF sx, VF sy, Meets&& meets) {
  const DF d;
  const DI di;
  alignas(64) float x[kLanes], y[kLanes];
  alignas(64) std::int32_t answer[kLanes];
  hn::Store(sx, d, x);
  hn::Store(sy, d, y);
  hn::Store(hn::VecFromMask(di, hn::RebindMask(di, met)), di, answer);
  ForEachBit(BitsOf(d, doubtful), [&](std::size_t lane) { answer[lane] = meets(lane, x[lane], y[lane]) ? -1 : 0; });
  return hn::RebindMask(d, hn::MaskFromVec(hn::Load(di, answer)));
}

/// Returns key_of_distance() of each lane.
template <class D, class V>
HWY_INLINE V KeyOfDistance(D d, const ScreenTransform& t, V distance) {
  const V one = hn::Set(d, 1.0f);
  if (!t.orthographic) return hn::Min(hn::Mul(hn::Set(d, t.near), hn::Div(one, distance)), one);
  const V key = hn::Mul(hn::Sub(hn::Set(d, t.far), distance), hn::Set(d, t.inverse_range));
  return hn::Min(hn::Max(key, hn::Zero(d)), one);
}

/// From this many blocks on, blocks are classified by the edges first.
constexpr int kClassifyFrom = 5;
constexpr float kBlockReach = 0.5f * (kBlock - 1) * kPixel;  // from a block's middle to its outermost samples

/// Offsets of a block's pixels from its first pixel, and of the middles of all blocks from the tile's first sample.
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

  [[nodiscard]] bool operator==(const SingleCorners&) const = default;
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
        // For few blocks, the greatest key of the whole triangle is used, because computing a key for each block would
        // cost more than it saves.
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

  /// Returns the blocks in which every key so far is greater than all keys of the triangle.
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
      // This is the key at the middle of the block, plus the change to its nearest sample, but at most the vertices'
      // greatest key.
      const VF nearest = hn::Min(hn::Add(start, hn::Add(hn::Mul(u, gx), hn::Mul(v, gy))), high);
      hidden |= BitsOf(d, hn::Lt(nearest, hn::Load(d, buffer_.farthest() + i))) << i;
    }
    return hidden;
  }

  /// Edge functions E(u, v) = e0 + u*ex + v*ey, positive inside; (u, v) is relative to the tile's centre. If |E| <=
  /// slack, the sign is uncertain.
  struct Edges {
    float ex[3], ey[3], e0[3], slack[3];
    int facing;
  };

  /// Sets the edge functions. \returns false if nothing can be decided in advance.
  bool SetEdges(const std::array<SampleCorner, 3>& corners, Edges& edges) const {
    double x[3], y[3], w[3], size[3], error[3];
    const double half = double(std::max(t_.centre_x, t_.centre_y)) + kSubPixels, tile = 0.5 * kTileSize * kSubPixels;
    for (std::size_t k = 0; k < 3; ++k) {
      const SampleCorner& c = corners[k];
      w[k] = t_.orthographic ? 1.0 : c.d;
      x[k] = c.x - double(place_.centre_x) * w[k];
      y[k] = c.y - double(place_.centre_y) * w[k];
      // `size` is the greatest size of a sheared corner, and `error` its rounding by shearing, in units in the last
      // place.
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
      // The determinant of the three corners has the sign of all edges if the triangle is in front of the eye.
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
      classes.outside |= BitsOf(d, hn::Lt(most, zero)) << i;
      classes.full |= BitsOf(d, hn::Gt(least, zero)) << i;
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

  /// Met() in doubles. Products of doubles may be rounded, so the exact rule decides if two products are equal.
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

  /// Returns one coordinate of sheared().
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

/// A triangle whose rectangle of samples is at most this wide and high is met together with others.
constexpr int kWalkLimit = 3;

/// Draws triangles with vertices in floats, many at a time. They wait in a queue until they fill a vector. Triangles of
/// up to 3 x 3 pixels are then tested in step, one pixel of each triangle at a time. Triangles of scanned models often
/// cover one sample or none. One after the other, each would use one lane of a vector. Together they use all lanes, and
/// the loop is as long as the largest of them needs.
class RayTriangleQueue {
 public:
  RayTriangleQueue(const RayTileInput& frame, const TilePlace& place, RayTileBuffer& buffer, LargeRayTriangles& large)
      : t_(frame.transform), facing_(frame.facing), place_(place), buffer_(buffer), large_(large) {}

  struct Batch {
    LeafV x[3], y[3], d[3];
    hn::Vec<LU> id, rect;  // x0, y0, x1, y1: pixels of the tile, one byte each from the lowest
  };

  /// Queues the triangles in the lanes of `kept`, and draws queued triangles as long as they fill a vector.
  HWY_INLINE void Add(const Batch& batch, LeafM kept) {
    const Compactor<LF> compact(kept);
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
    alignas(64) float gx[kLanes], gy[kLanes], k0[kLanes], low[kLanes], high[kLanes];
  };

  /// Sets key_plane() of a vector of triangles between near and far.
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
    const VF low = KeyOfDistance(d, t_, hn::Max(hn::Max(a, b), c));
    hn::Store(low, d, planes.low);
    hn::Store(KeyOfDistance(d, t_, hn::Min(hn::Min(a, b), c)), d, planes.high);
    const VF gx = hn::Load(d, planes.gx), gy = hn::Load(d, planes.gy), k0 = hn::Load(d, planes.k0);
    const VF steepest = hn::Set(d, kSteepest);
    const MF usual =
        hn::And(hn::And(hn::Le(hn::Abs(gx), steepest), hn::Le(hn::Abs(gy), steepest)), hn::Le(hn::Abs(k0), steepest));
    if (HWY_LIKELY(hn::AllTrue(d, usual))) return;
    hn::Store(hn::IfThenElseZero(usual, gx), d, planes.gx);
    hn::Store(hn::IfThenElseZero(usual, gy), d, planes.gy);
    hn::Store(hn::IfThenElse(usual, k0, low), d, planes.k0);
  }

  /// Draws the last `count` triangles of the queue.
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

  /// Returns whether the triangle is a copy of the last large triangle with a higher id. Objects may be placed in one
  /// place twice or a million times. The lower id hides the copy, except with material culling, which may cull the
  /// lower id alone.
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
  // Room for one vector more than the queue holds, because Compactor stores whole vectors.
  static constexpr std::size_t kRoom = kLanes + 2 * kRayLanes;
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
