// SPDX-License-Identifier: Apache-2.0
// Triangles of any size drawn into a depth buffer one at a time, row by row.
//
// Values of a sample with 32 bits live in half vectors beside whole vectors of doubles. Depths are computed in double
// and rounded once, so that every instruction set stores the same bits.

// Included once for every target.
#if defined(FRONTMOST_ZBUFFER_DEPTH_ROWS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FRONTMOST_ZBUFFER_DEPTH_ROWS_INL_H_
#undef FRONTMOST_ZBUFFER_DEPTH_ROWS_INL_H_
#else
#define FRONTMOST_ZBUFFER_DEPTH_ROWS_INL_H_
#endif

#include <cstring>
#include <optional>

#include "base/highway-inl.h"
#include "base/wasm_lanes-inl.h"
#include "view/steep_keys-inl.h"
#include "zbuffer/depth/depth_call.h"
#include "zbuffer/packet-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::zbuffer_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using DD = hn::ScalableTag<double>;
using DDU = hn::RebindToUnsigned<DD>;
using HalfU = hn::Rebind<std::uint32_t, DD>;
using HalfI = hn::RebindToSigned<HalfU>;
using HalfF = hn::RebindToFloat<HalfU>;

constexpr std::size_t kHalfLanes = hn::MaxLanes(DD());

/// Adding this to 0 <= x < 2^32 leaves x, rounded to an integer with ties to even, in the low bits of the sum.
constexpr double kRounder = 6755399441055744.0;  // 1.5 * 2^52

/// Converts keys to stored depths, and tests which pass.
template <bool is_float>
class DepthTest {
 public:
  explicit DepthTest(const DepthRules& rules)
      : rules_(rules),
        steps_(is_float ? 1.0 : double((std::uint32_t(1) << integer_bits(rules.format)) - 1)),
        passing_((rules.passes_less ? kLess : 0) | (rules.passes_equal ? kEqual : 0) |
                 (rules.passes_greater ? kGreater : 0)) {}

  [[nodiscard]] HWY_INLINE hn::Vec<HalfU> Stored(hn::Vec<HalfF> key, hn::Vec<DD> offset) const {
    const DD d;
    const DepthMap& map = rules_.map;
    auto depth = hn::Add(hn::Set(d, map.at_zero), hn::Mul(hn::Set(d, map.slope), hn::PromoteTo(d, key)));
    depth = hn::Min(hn::Max(depth, hn::Set(d, map.low)), hn::Set(d, map.high));
    depth = hn::Add(depth, offset);
    depth = hn::Min(hn::Max(depth, hn::Zero(d)), hn::Set(d, 1.0));
    if constexpr (is_float) {
      return hn::BitCast(HalfU(), hn::DemoteTo(HalfF(), depth));
    } else {
      const auto rounded = hn::Add(hn::Mul(depth, hn::Set(d, steps_)), hn::Set(d, kRounder));
      return hn::TruncateTo(HalfU(), hn::BitCast(DDU(), rounded));
    }
  }

  [[nodiscard]] HWY_INLINE hn::Mask<HalfU> Passes(hn::Vec<HalfU> stored, hn::Vec<HalfU> kept) const {
    const HalfU du;
    hn::Mask<HalfU> less, equal;
    if constexpr (is_float) {
      // The clear value may be negative, and the bits of negative floats have the opposite order.
      const auto a = hn::BitCast(HalfF(), stored), b = hn::BitCast(HalfF(), kept);
      less = hn::RebindMask(du, hn::Lt(a, b));
      equal = hn::RebindMask(du, hn::Eq(a, b));
    } else {
      less = hn::RebindMask(du, hn::Lt(hn::BitCast(HalfI(), stored), hn::BitCast(HalfI(), kept)));
      equal = hn::Eq(stored, kept);
    }
    const auto greater = hn::Not(hn::Or(less, equal));
    auto pass = hn::RebindMask(du, hn::Lt(hn::Zero(HalfI()), hn::Zero(HalfI())));  // none
    if (rules_.passes_less) pass = less;
    if (rules_.passes_equal) pass = hn::Or(pass, equal);
    if (rules_.passes_greater) pass = hn::Or(pass, greater);
    return pass;
  }

  [[nodiscard]] HWY_INLINE bool Passes(std::uint32_t stored, std::uint32_t kept) const {
    bool less, equal;
    if constexpr (is_float) {
      float a, b;
      std::memcpy(&a, &stored, sizeof a);
      std::memcpy(&b, &kept, sizeof b);
      less = a < b, equal = a == b;
    } else {
      less = stored < kept, equal = stored == kept;
    }
    return (passing_ & (less ? kLess : equal ? kEqual : kGreater)) != 0;
  }

  [[nodiscard]] const DepthRules& rules() const { return rules_; }

 private:
  static constexpr int kLess = 1, kEqual = 2, kGreater = 4;
  const DepthRules& rules_;
  double steps_;
  int passing_;
};

/// The planes' entries for a vector of samples, and the screen position of the first, in 1/256 pixel.
struct Cell {
  std::uint32_t* stored;
  PrimitiveId* primitives;
  float* keys;
  glm::ivec2 place;
};

template <bool is_float>
class DepthRows {
 public:
  DepthRows(const DepthCall& call, const Tile& tile, const DepthTest<is_float>& test)
      : call_(call), tile_(tile), test_(test) {}

  /// Draws one triangle at one of a pixel's samples. Vertices are relative to the tile.
  void Draw(const TriangleRecord& r, double offset, std::size_t sample) {
    const glm::ivec2 at = call_.planes.samples[sample];
    const PixelRect rect = sampled_rect(r, at, at, tile_.width, tile_.height);
    if (rect.is_empty()) return;
    const KeyPlane plane(r);
    const TriangleEdges edges(r, at);
    const PrimitiveId own_id = r.id - call_.id_offset;
    std::optional<ScreenCutout> cutout;
    if (call_.cutouts && call_.cutouts->has(own_id)) cutout.emplace((*call_.cutouts)[own_id], call_.rays);
    const SteepKeys steep = plane.is_steep ? SteepKeys(r) : SteepKeys();
    const Paint paint{plane, hn::Set(DD(), offset), r.id, sample, cutout ? &*cutout : nullptr};
    const HalfI d;
    const int lanes = int(hn::Lanes(d)), first = rect.x0 / lanes * lanes;
    hn::Vec<HalfI> row[3], step[3];
    for (int k = 0; k < 3; ++k) {
      const std::int32_t start = edges.first[k] + first * edges.step_x[k] + rect.y0 * edges.step_y[k];
      row[k] = hn::Add(hn::Set(d, start), hn::Mul(hn::Iota(d, 0), hn::Set(d, edges.step_x[k])));
      step[k] = hn::Set(d, lanes * edges.step_x[k]);
    }
    for (int y = rect.y0; y <= rect.y1; ++y) {
      // These operations and their order are the same as for packets, so that both give the same bits.
      const float dy_gy = float(y * kSubPixels + at.y - plane.y0) * plane.gy;
      auto e0 = row[0], e1 = row[1], e2 = row[2];
      for (int x = first; x <= rect.x1; x += lanes) {
        const auto covered = hn::RebindMask(HalfU(), hn::Gt(hn::Or(hn::Or(e0, e1), e2), hn::Set(d, -1)));
        if (!hn::AllFalse(HalfU(), covered)) {
          const glm::ivec2 from = glm::ivec2(x, y) * kSubPixels + at;
          Put(paint, x, y, covered, plane.is_steep ? KeyOf(steep, from) : Key(plane, from.x - plane.x0, dy_gy));
        }
        e0 = hn::Add(e0, step[0]);
        e1 = hn::Add(e1, step[1]);
        e2 = hn::Add(e2, step[2]);
      }
      for (int k = 0; k < 3; ++k) row[k] = hn::Add(row[k], hn::Set(d, edges.step_y[k]));
    }
  }

 private:
  /// The values that all samples of a triangle share.
  struct Paint {
    const KeyPlane& plane;
    hn::Vec<DD> offset;
    PrimitiveId id;
    std::size_t sample;
    const ScreenCutout* cutout;  ///< null if the triangle has no holes
  };

  /// The samples from `place` on that do not look into a hole.
  [[nodiscard]] static HWY_NOINLINE hn::Mask<HalfU> Solid(const ScreenCutout& cutout, const glm::ivec2& place,
                                                          hn::Mask<HalfU> seen) {
    const HalfU d;
    HWY_ALIGN_MAX std::uint32_t lanes[kHalfLanes];
    hn::Store(hn::VecFromMask(d, seen), d, lanes);
    for (std::size_t i = 0; i < hn::Lanes(d); ++i)
      if (lanes[i] != 0 && cutout.is_hole(place.x + int(i) * kSubPixels, place.y)) lanes[i] = 0;
    return hn::MaskFromVec(hn::Load(d, lanes));
  }

  [[nodiscard]] static HWY_INLINE hn::Vec<HalfF> Key(const KeyPlane& plane, std::int32_t from_x, float dy_gy) {
    const HalfI di;
    const HalfF d;
    const auto dx = hn::ConvertTo(d, hn::Add(hn::ShiftLeft<8>(hn::Iota(di, 0)), hn::Set(di, from_x)));
    const auto key = hn::Add(hn::Add(hn::Set(d, plane.k0), hn::Mul(dx, hn::Set(d, plane.gx))), hn::Set(d, dy_gy));
    return hn::Min(hn::Max(key, hn::Set(d, plane.k_min)), hn::Set(d, plane.k_max));
  }

  /// Keys of a row of samples from `first` on.
  [[nodiscard]] static HWY_INLINE hn::Vec<HalfF> KeyOf(const SteepKeys& steep, const glm::ivec2& first) {
    const HalfI d;
    view_detail::HWY_NAMESPACE::SteepColumn column;
    column.Set(steep, hn::PromoteTo(DD(), hn::Add(hn::ShiftLeft<8>(hn::Iota(d, 0)), hn::Set(d, first.x))));
    return column.At(steep, first.y);
  }

  HWY_INLINE void Put(const Paint& paint, int x, int y, hn::Mask<HalfU> covered, hn::Vec<HalfF> key) const {
    const DepthPlanes& p = call_.planes;
    const std::size_t i = (paint.sample * std::size_t(p.height) + std::size_t(tile_.y + y)) * std::size_t(p.width) +
                          std::size_t(tile_.x + x);
    const glm::ivec2 place = glm::ivec2(tile_.x + x, tile_.y + y) * kSubPixels + p.samples[paint.sample];
    const Cell cell{p.stored + i, p.primitives + i, p.keys + i, place};
    const int count = HWY_MIN(int(kHalfLanes), tile_.width - x);
    if (count == int(hn::Lanes(DD()))) {
      PutWhole(paint, cell, covered, key);
      return;
    }
    // Memory of the other lanes belongs to another tile, or lies outside the planes.
    HWY_ALIGN_MAX std::uint32_t stored[kHalfLanes] = {}, primitives[kHalfLanes] = {};
    HWY_ALIGN_MAX float keys[kHalfLanes] = {};
    const Cell copy{stored, primitives, keys, place};
    Copy(cell, copy, count);
    PutWhole(paint, copy, covered, key);
    Copy(copy, cell, count);
  }

  static HWY_INLINE void Copy(const Cell& from, const Cell& to, int count) {
    for (int i = 0; i < count; ++i) {
      to.stored[i] = from.stored[i];
      to.primitives[i] = from.primitives[i];
      to.keys[i] = from.keys[i];
    }
  }

  HWY_INLINE void PutWhole(const Paint& paint, const Cell& cell, hn::Mask<HalfU> covered, hn::Vec<HalfF> key) const {
    const HalfU du;
    const HalfF df;
    const auto stored = test_.Stored(key, paint.offset), kept = hn::LoadU(du, cell.stored);
    auto pass = hn::And(covered, test_.Passes(stored, kept));
    // The hole test comes last: one look into a texture costs as much as many depth tests.
    if (paint.cutout != nullptr) pass = Solid(*paint.cutout, cell.place, pass);
    if (hn::AllFalse(du, pass)) return;
    if (test_.rules().mask) hn::StoreU(hn::IfThenElse(pass, stored, kept), du, cell.stored);
    const auto id = hn::IfThenElse(pass, hn::Set(du, paint.id), hn::LoadU(du, cell.primitives));
    hn::StoreU(id, du, cell.primitives);
    hn::StoreU(hn::IfThenElse(hn::RebindMask(df, pass), key, hn::LoadU(df, cell.keys)), df, cell.keys);
  }

  const DepthCall& call_;
  const Tile& tile_;
  const DepthTest<is_float>& test_;
};

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::zbuffer_detail
HWY_AFTER_NAMESPACE();

#endif  // include guard by target
