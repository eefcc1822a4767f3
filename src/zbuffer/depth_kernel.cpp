// SPDX-License-Identifier: Apache-2.0
// The depth test of every fragment in order, a row of samples at a time.
//
// Coverage and keys as in tile_kernel.cpp: edge values shifted right by 8, so that a pixel's step is -dy or dx; keys
// (k0 + dx*gx) + dy*gy, limited to the triangle's own. Depths are worked out in double and rounded once, so that every
// instruction set stores the same bits.

#include "zbuffer/depth_kernel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "zbuffer/depth_kernel.cpp"
#include "base/isa.h"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::zbuffer_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Everything of a sample that is 32 bits wide lives in half vectors beside whole vectors of doubles.
using DD = hn::ScalableTag<double>;
using DDU = hn::RebindToUnsigned<DD>;
using DU = hn::Rebind<std::uint32_t, DD>;
using DI = hn::RebindToSigned<DU>;
using DF = hn::RebindToFloat<DU>;
using VU = hn::Vec<DU>;
using VF = hn::Vec<DF>;
using MU = hn::Mask<DU>;

// As in tile_kernel.cpp: over 127 pixels both ways an edge value changes by less than 2^30.
constexpr std::int64_t kEdgeLimit = std::int64_t(1) << 30;

/// Adding this to 0 <= x < 2^32 leaves x, rounded to an integer with ties to even, in the low bits of the sum.
constexpr double kRounder = 6755399441055744.0;  // 1.5 * 2^52

/// Where a vector of samples is kept.
struct Cell {
  std::uint32_t* stored;
  PrimitiveId* primitives;
  float* keys;
};

template <bool is_float>
class DepthPainter {
 public:
  DepthPainter(const DepthCall& call, const PixelRect& tile)
      : call_(call), tile_(tile), width_(tile.x1 - tile.x0 + 1), height_(tile.y1 - tile.y0 + 1) {
    const double steps = is_float ? 1.0 : double((std::uint32_t(1) << integer_bits(call.rules.format)) - 1);
    scale_ = steps;
  }

  void Draw(const PlacedTriangle& triangle) {
    TriangleRecord r = triangle.corners;
    for (int k = 0; k < 3; ++k) {
      r.x[k] -= tile_.x0 * kSubPixels;
      r.y[k] -= tile_.y0 * kSubPixels;
    }
    const DepthRules& rules = call_.rules;
    offset_ = rules.has_offset()
                  ? rules.offset_of(triangle.gx, triangle.gy, triangle.primitive_low, triangle.primitive_high)
                  : 0.0;
    id_ = r.id + call_.id_offset;
    for (std::size_t s = 0; s < call_.planes.samples.size(); ++s) DrawSample(triangle, r, s);
  }

 private:
  void DrawSample(const PlacedTriangle& t, const TriangleRecord& r, std::size_t sample) {
    const glm::ivec2 at = call_.planes.samples[sample];
    const PixelRect rect = sampled_rect(r, at, at, width_, height_);
    if (rect.x1 < rect.x0 || rect.y1 < rect.y0) return;
    std::int32_t edge[3], step_y[3];
    for (int k = 0; k < 3; ++k) {
      const int n = k == 2 ? 0 : k + 1;
      const std::int32_t dx = r.x[n] - r.x[k], dy = r.y[n] - r.y[k];
      const bool is_top_left = dy < 0 || (dy == 0 && dx > 0);
      const std::int64_t e =
          std::int64_t(dx) * (at.y - r.y[k]) - std::int64_t(dy) * (at.x - r.x[k]) - (is_top_left ? 0 : 1);
      edge[k] = std::int32_t(HWY_MAX(HWY_MIN(e >> 8, kEdgeLimit), -kEdgeLimit));
      step_x_[k] = -dy;
      step_y[k] = dx;
    }
    const int lanes = int(hn::Lanes(DD()));
    const int first = rect.x0 / lanes * lanes;
    for (int y = rect.y0; y <= rect.y1; ++y) {
      const float dy_gy = float(y * kSubPixels + at.y - r.y[0]) * t.gy;
      for (int x = first; x <= rect.x1; x += lanes) {
        std::int32_t e[3];
        for (int k = 0; k < 3; ++k) e[k] = edge[k] + x * step_x_[k] + y * step_y[k];
        const MU covered = Covered(e);
        if (hn::AllFalse(DU(), covered)) continue;
        const VF key = Key(t, x * kSubPixels + at.x - r.x[0], dy_gy);
        Put(CellAt(sample, x, y), HWY_MIN(lanes, width_ - x), covered, key);
      }
    }
  }

  [[nodiscard]] HWY_INLINE MU Covered(const std::int32_t e[3]) const {
    const DI d;
    const auto column = hn::Iota(d, 0);
    auto all = hn::Zero(d);
    for (int k = 0; k < 3; ++k) all = hn::Or(all, hn::Add(hn::Set(d, e[k]), hn::Mul(column, hn::Set(d, step_x_[k]))));
    return hn::RebindMask(DU(), hn::Gt(all, hn::Set(d, -1)));
  }

  [[nodiscard]] HWY_INLINE VF Key(const PlacedTriangle& t, std::int32_t from_x, float dy_gy) const {
    const DI di;
    const DF d;
    const VF dx = hn::ConvertTo(d, hn::Add(hn::ShiftLeft<8>(hn::Iota(di, 0)), hn::Set(di, from_x)));
    const VF key = hn::Add(hn::Add(hn::Set(d, t.corners.key[0]), hn::Mul(dx, hn::Set(d, t.gx))), hn::Set(d, dy_gy));
    return hn::Min(hn::Max(key, hn::Set(d, t.k_min)), hn::Set(d, t.k_max));
  }

  [[nodiscard]] HWY_INLINE VU Stored(VF key) const {
    const DD d;
    const DepthMap& map = call_.rules.map;
    auto depth = hn::Add(hn::Set(d, map.at_zero), hn::Mul(hn::Set(d, map.slope), hn::PromoteTo(d, key)));
    depth = hn::Min(hn::Max(depth, hn::Set(d, map.low)), hn::Set(d, map.high));
    depth = hn::Add(depth, hn::Set(d, offset_));
    depth = hn::Min(hn::Max(depth, hn::Zero(d)), hn::Set(d, 1.0));
    if constexpr (is_float) {
      return hn::BitCast(DU(), hn::DemoteTo(DF(), depth));
    } else {
      const auto rounded = hn::Add(hn::Mul(depth, hn::Set(d, scale_)), hn::Set(d, kRounder));
      return hn::TruncateTo(DU(), hn::BitCast(DDU(), rounded));
    }
  }

  [[nodiscard]] HWY_INLINE MU Passes(VU stored, VU kept) const {
    const DU du;
    MU less, equal;
    if constexpr (is_float) {
      // The clear value may be negative, whose bits have the opposite order.
      const VF a = hn::BitCast(DF(), stored), b = hn::BitCast(DF(), kept);
      less = hn::RebindMask(du, hn::Lt(a, b));
      equal = hn::RebindMask(du, hn::Eq(a, b));
    } else {
      less = hn::RebindMask(du, hn::Lt(hn::BitCast(DI(), stored), hn::BitCast(DI(), kept)));
      equal = hn::Eq(stored, kept);
    }
    const DepthRules& rules = call_.rules;
    const MU none = hn::RebindMask(du, hn::Lt(hn::Zero(DI()), hn::Zero(DI())));
    const MU greater = hn::Not(hn::Or(less, equal));
    MU pass = rules.passes_less ? less : none;
    if (rules.passes_equal) pass = hn::Or(pass, equal);
    if (rules.passes_greater) pass = hn::Or(pass, greater);
    return pass;
  }

  [[nodiscard]] HWY_INLINE Cell CellAt(std::size_t sample, int x, int y) const {
    const DepthPlanes& p = call_.planes;
    const std::size_t i =
        (sample * std::size_t(p.height) + std::size_t(tile_.y0 + y)) * std::size_t(p.width) + std::size_t(tile_.x0 + x);
    return {p.stored + i, p.primitives + i, p.keys + i};
  }

  /// `count`: how many lanes lie inside the image. The others' memory is another tile's, or nobody's.
  HWY_INLINE void Put(const Cell& cell, int count, MU covered, VF key) const {
    if (count == int(hn::Lanes(DD()))) {
      PutWhole(cell, covered, key);
      return;
    }
    constexpr std::size_t kMost = hn::MaxLanes(DD());
    HWY_ALIGN_MAX std::uint32_t stored[kMost] = {}, primitives[kMost] = {};
    HWY_ALIGN_MAX float keys[kMost] = {};
    Copy(cell, {stored, primitives, keys}, count);
    PutWhole({stored, primitives, keys}, covered, key);
    Copy({stored, primitives, keys}, cell, count);
  }

  static HWY_INLINE void Copy(const Cell& from, const Cell& to, int count) {
    for (int i = 0; i < count; ++i) {
      to.stored[i] = from.stored[i];
      to.primitives[i] = from.primitives[i];
      to.keys[i] = from.keys[i];
    }
  }

  HWY_INLINE void PutWhole(const Cell& cell, MU covered, VF key) const {
    const DU du;
    const DF df;
    const VU stored = Stored(key), kept = hn::LoadU(du, cell.stored);
    const MU pass = hn::And(covered, Passes(stored, kept));
    if (hn::AllFalse(du, pass)) return;
    if (call_.rules.mask) hn::StoreU(hn::IfThenElse(pass, stored, kept), du, cell.stored);
    const VU id = hn::IfThenElse(pass, hn::Set(du, id_), hn::LoadU(du, cell.primitives));
    hn::StoreU(id, du, cell.primitives);
    hn::StoreU(hn::IfThenElse(hn::RebindMask(df, pass), key, hn::LoadU(df, cell.keys)), df, cell.keys);
  }

  const DepthCall& call_;
  PixelRect tile_;
  int width_, height_;
  double scale_;
  // Of the triangle that is drawn.
  double offset_ = 0;
  std::uint32_t id_ = 0;
  std::int32_t step_x_[3] = {};
};

template <bool is_float>
void DrawAll(const DepthCall& call, const PixelRect& tile, std::span<const PlacedTriangle> triangles,
             std::span<const std::uint32_t> items) {
  DepthPainter<is_float> painter(call, tile);
  for (const std::uint32_t i : items) painter.Draw(triangles[i]);
}

void DrawDepths(const DepthCall& call, const PixelRect& tile, std::span<const PlacedTriangle> triangles,
                std::span<const std::uint32_t> items) {
  if (call.rules.format == DepthFormat::f32)
    DrawAll<true>(call, tile, triangles, items);
  else
    DrawAll<false>(call, tile, triangles, items);
}

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::zbuffer_detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace frontmost::zbuffer_detail {

FRONTMOST_KERNELS(DrawDepths);

void draw_depths(const DepthCall& call, const PixelRect& tile, std::span<const PlacedTriangle> triangles,
                 std::span<const std::uint32_t> items, Isa isa) {
  kernel_for(DrawDepthsKernels, isa)(call, tile, triangles, items);
}

}  // namespace frontmost::zbuffer_detail
#endif  // HWY_ONCE
