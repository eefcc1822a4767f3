// SPDX-License-Identifier: Apache-2.0
// One tile's answer while its rays are cast: the nearest key and id of every pixel, and the farthest key of every
// block.
//
//    tile     32 x 32 pixels, 8 x 8 blocks           Within a block pixels lie row by row, so that a vector of sixteen
//    block    4 x 4 pixels, one vector of keys       lanes is a block. `farthest` has the farthest key of each block:
//                                                    a triangle or box that is farther everywhere is not looked at.

// Included once for every target.
#if defined(FRONTMOST_RAYCAST_TILE_BUFFER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FRONTMOST_RAYCAST_TILE_BUFFER_INL_H_
#undef FRONTMOST_RAYCAST_TILE_BUFFER_INL_H_
#else
#define FRONTMOST_RAYCAST_TILE_BUFFER_INL_H_
#endif

#include <algorithm>
#include <cstring>

#include "base/highway-inl.h"
#include "base/wasm_lanes-inl.h"
#include "hwy/cache_control.h"
#include "raycast/tile/tile_kernel.h"
#include "view/facing-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::raycast_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using view_detail::HWY_NAMESPACE::Kept;

// Vectors have at most as many lanes as a leaf, a node and a block have entries.
using DF = hn::CappedTag<float, kRayLanes>;
using DU = hn::RebindToUnsigned<DF>;
using DI = hn::RebindToSigned<DF>;
using VF = hn::Vec<DF>;
using VU = hn::Vec<DU>;
using VI = hn::Vec<DI>;
using MF = hn::Mask<DF>;
// Whole vectors of doubles, and half vectors of floats with as many lanes.
using DD = hn::CappedTag<double, kRayLanes>;
using DHF = hn::Rebind<float, DD>;
using VD = hn::Vec<DD>;

constexpr std::size_t kLanes = hn::MaxLanes(DF());
constexpr std::size_t kDoubles = hn::MaxLanes(DD());

constexpr int kBlock = 4;                    // pixels of a block's side
constexpr int kBlocks = kTileSize / kBlock;  // blocks of a tile's side
constexpr std::size_t kBlockCount = kBlocks * kBlocks;
constexpr std::size_t kBlockPixels = kBlock * kBlock;
constexpr float kPixel = kSubPixels;
/// Half a unit in the last place of a float, relative.
constexpr float kHalfUlp = 0x1p-24f;

/// Returns a bit for each lane of the mask that is set.
template <class D>
HWY_INLINE std::uint32_t BitsOf(D d, hn::Mask<D> mask) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(d, mask, bytes);
  return std::uint32_t(bytes[0]) | std::uint32_t(bytes[1]) << 8;
}

/// Calls `body(lane)` for every bit.
template <class Bits, class Body>
HWY_INLINE void ForEachBit(Bits bits, Body&& body) {
  for (; bits != 0; bits &= bits - 1) body(std::size_t(hwy::Num0BitsBelowLS1Bit_Nonzero64(bits)));
}

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
HWY_INLINE VF KeyOfDistance(const ScreenTransform& t, VF distance) {
  const DF d;
  const VF one = hn::Set(d, 1.0f);
  if (!t.orthographic) return hn::Min(hn::Mul(hn::Set(d, t.near), hn::Div(one, distance)), one);
  const VF key = hn::Mul(hn::Sub(hn::Set(d, t.far), distance), hn::Set(d, t.inverse_range));
  return hn::Min(hn::Max(key, hn::Zero(d)), one);
}

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::raycast_detail
HWY_AFTER_NAMESPACE();

#endif  // include guard by target
