// SPDX-License-Identifier: Apache-2.0
// Finds the cells that boxes reach, a vector of boxes at a time, and tests boxes against the cover.

#include "occlusion/cells.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "occlusion/box_kernel.cpp"
#include <cmath>

#include "base/highway-inl.h"
#include "base/isa.h"
// This header must come after Highway's, so it is included in a separate block.
#include "base/lane_types-inl.h"
#include "base/lanes-inl.h"
#include "occlusion/cell_rows-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::occlusion_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using namespace frontmost::HWY_NAMESPACE;
namespace {

/// A bound of the rounding of a sum of a few products, relative to the sum of their absolute values.
constexpr float kSlack = 1.0f / (1 << 20);

/// A linear function of a position.
struct Linear {
  std::array<float, 3> row;
  float offset;
};

// Corners beyond the range of floats are NaN. Of NaN and a number, Min gives the number on some processors; these
// functions give the second operand on all.
#if HWY_TARGET == HWY_NEON || HWY_TARGET == HWY_SCALAR || HWY_TARGET == HWY_EMU128
HWY_INLINE VF MinOf(VF a, VF b) { return hn::IfThenElse(hn::Lt(a, b), a, b); }
HWY_INLINE VF MaxOf(VF a, VF b) { return hn::IfThenElse(hn::Gt(a, b), a, b); }
#else
HWY_INLINE VF MinOf(VF a, VF b) { return hn::Min(a, b); }
HWY_INLINE VF MaxOf(VF a, VF b) { return hn::Max(a, b); }
#endif

/// The values of a linear function at the corners of boxes.
struct Terms {
  VF low[3], high[3];  ///< terms of each axis; the first axis includes the offset
  VF slack;

  [[nodiscard]] HWY_INLINE VF Least() const { return Sum(Lesser(0), Lesser(1), Lesser(2)); }
  [[nodiscard]] HWY_INLINE VF Greatest() const { return Sum(Greater(0), Greater(1), Greater(2)); }
  [[nodiscard]] HWY_INLINE VF AtCorner(int corner) const {
    return Sum(corner & 1 ? high[0] : low[0], corner & 2 ? high[1] : low[1], corner & 4 ? high[2] : low[2]);
  }

 private:
  [[nodiscard]] static HWY_INLINE VF Sum(VF x, VF y, VF z) { return hn::Add(hn::Add(x, y), z); }
  [[nodiscard]] HWY_INLINE VF Lesser(int axis) const { return MinOf(low[axis], high[axis]); }
  [[nodiscard]] HWY_INLINE VF Greater(int axis) const { return MaxOf(low[axis], high[axis]); }
};

/// Boxes relative to the eye.
struct Boxes {
  VF low[3], high[3];

  [[nodiscard]] HWY_INLINE Terms Of(const Linear& linear) const {
    const DF d;
    Terms t;
    const VF offset = hn::Set(d, linear.offset);
    VF sum = hn::Abs(offset);
    for (int axis = 0; axis < 3; ++axis) {
      const VF factor = hn::Set(d, linear.row[std::size_t(axis)]);
      t.low[axis] = hn::Mul(factor, low[axis]);
      t.high[axis] = hn::Mul(factor, high[axis]);
      sum = hn::Add(sum, MaxOf(hn::Abs(t.low[axis]), hn::Abs(t.high[axis])));
    }
    t.low[0] = hn::Add(t.low[0], offset);
    t.high[0] = hn::Add(t.high[0], offset);
    t.slack = hn::Mul(sum, hn::Set(d, kSlack));
    return t;
  }
};

struct QuotientRange {
  VF least, greatest;
};

/// Returns the least and greatest quotient over the corners, rounded outwards. Precondition: d is positive.
HWY_INLINE QuotientRange Divided(const Terms& x, const VF (&inverse)[8], VF d_slack) {
  QuotientRange e{hn::Mul(x.AtCorner(0), inverse[0]), hn::Mul(x.AtCorner(0), inverse[0])};
  VF greatest_inverse = inverse[0];
  for (int corner = 1; corner < 8; ++corner) {
    const VF at = hn::Mul(x.AtCorner(corner), inverse[corner]);
    e.least = MinOf(e.least, at);
    e.greatest = MaxOf(e.greatest, at);
    greatest_inverse = MaxOf(greatest_inverse, inverse[corner]);
  }
  // x and d may both be wrong by their slack.
  const VF farthest = MaxOf(hn::Abs(e.least), hn::Abs(e.greatest));
  const VF off = hn::Mul(hn::Add(x.slack, hn::Mul(farthest, d_slack)), hn::Mul(greatest_inverse, hn::Set(DF(), 1.01f)));
  return {hn::Sub(e.least, off), hn::Add(e.greatest, off)};
}

/// A half-open range of cells, clamped to the screen. `centre` is the image's centre, in 1/256 pixel.
struct CellSpan {
  VI first, end;
};
HWY_INLINE CellSpan CellsOf(const CellGrid& grid, const QuotientRange& e, std::int32_t centre, int count) {
  const DF d;
  const DI di;
  const VF scale = hn::Set(d, grid.cells_per_unit), middle = hn::Set(d, float(centre) * grid.cells_per_unit);
  const VF margin = hn::Set(d, grid.margin), last = hn::Set(d, float(count)), zero = hn::Zero(d);
  const VF first = hn::Floor(hn::Sub(hn::Add(hn::Mul(e.least, scale), middle), margin));
  const VF end = hn::Add(hn::Floor(hn::Add(hn::Add(hn::Mul(e.greatest, scale), middle), margin)), hn::Set(d, 1.0f));
  return {hn::ConvertTo(di, hn::Min(hn::Max(first, zero), last)), hn::ConvertTo(di, hn::Min(hn::Max(end, zero), last))};
}

class BoxProjector {
 public:
  BoxProjector(const CellGrid& grid, const BoxColumns& boxes, std::vector<ScreenBox>& out)
      : grid_(grid), boxes_(boxes), out_(out) {
    const ScreenTransform& t = grid.transform;
    const float x = float(t.centre_x), y = float(t.centre_y);
    sides_[0] = Side(t.x_row, t.x_offset, x);
    sides_[1] = Side(t.x_row, t.x_offset, -x);
    sides_[2] = Side(t.y_row, t.y_offset, y);
    sides_[3] = Side(t.y_row, t.y_offset, -y);
  }

  /// Finds the boxes [first, end) on the screen, at most a vector of them.
  HWY_INLINE void Find(std::size_t first, std::size_t end) const {
    const DF d;
    const DI di;
    const ScreenTransform& t = grid_.transform;
    Boxes box;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const VF eye = hn::Set(d, t.eye[axis]);
      box.low[axis] = hn::Sub(hn::LoadU(d, boxes_.low[axis].data() + first), eye);
      box.high[axis] = hn::Sub(hn::LoadU(d, boxes_.high[axis].data() + first), eye);
    }
    const Terms depth = box.Of({t.d_row, t.d_offset});
    const VF nearest = hn::Sub(depth.Least(), depth.slack), farthest = hn::Add(depth.Greatest(), depth.slack);
    MF outside = hn::Or(hn::Lt(farthest, hn::Set(d, t.near)), hn::Gt(nearest, hn::Set(d, t.far)));
    outside = hn::Or(outside, hn::Gt(box.low[0], box.high[0]));
    for (const Linear& side : sides_) {
      const Terms terms = box.Of(side);
      outside = hn::Or(outside, hn::Lt(hn::Add(terms.Greatest(), terms.slack), hn::Zero(d)));
    }
    const Terms x = box.Of({t.x_row, t.x_offset}), y = box.Of({t.y_row, t.y_offset});
    QuotientRange across, down;
    if (t.orthographic) {
      across = {hn::Sub(x.Least(), x.slack), hn::Add(x.Greatest(), x.slack)};
      down = {hn::Sub(y.Least(), y.slack), hn::Add(y.Greatest(), y.slack)};
    } else {
      VF inverse[8];
      for (int corner = 0; corner < 8; ++corner) inverse[corner] = hn::Div(hn::Set(d, 1.0f), depth.AtCorner(corner));
      across = Divided(x, inverse, depth.slack);
      down = Divided(y, inverse, depth.slack);
    }
    // Boxes that reach before the near plane, or are so far away that floats overflow, may lie in any cell.
    const MF before_near = hn::Not(hn::Ge(nearest, hn::Set(d, t.near)));
    const MF known = hn::And(hn::Le(across.least, across.greatest), hn::Le(down.least, down.greatest));
    const CellSpan columns = CellsOf(grid_, across, t.centre_x, grid_.columns);
    const CellSpan rows = CellsOf(grid_, down, t.centre_y, grid_.rows);
    const MI whole = hn::RebindMask(di, hn::Or(before_near, hn::Not(known))), none = hn::RebindMask(di, outside);
    const auto start = [&](VI v) { return hn::IfThenZeroElse(hn::Or(whole, none), v); };
    const auto stop = [&](VI v, int count) {
      return hn::IfThenZeroElse(none, hn::IfThenElse(whole, hn::Set(di, count), v));
    };
    HWY_ALIGN_MAX std::int32_t x0[kMaxLanes], y0[kMaxLanes], x1[kMaxLanes], y1[kMaxLanes];
    HWY_ALIGN_MAX float near[kMaxLanes], far[kMaxLanes];
    hn::Store(start(columns.first), di, x0);
    hn::Store(start(rows.first), di, y0);
    hn::Store(stop(columns.end, grid_.columns), di, x1);
    hn::Store(stop(rows.end, grid_.rows), di, y1);
    const VF infinity = hn::Set(d, std::numeric_limits<float>::infinity());
    hn::Store(hn::IfThenElse(before_near, hn::Neg(infinity), nearest), d, near);
    hn::Store(hn::IfThenElse(hn::IsNaN(farthest), infinity, farthest), d, far);
    const std::size_t count = std::min(hn::Lanes(d), end - first);
    for (std::size_t i = 0; i < count; ++i) out_[first + i] = {{x0[i], y0[i], x1[i], y1[i]}, near[i], far[i]};
  }

 private:
  /// Returns a function that is negative outside of the picture's side at `reach`: x + reach w, or -x + |reach| w.
  Linear Side(const std::array<float, 3>& row, float offset, float reach) const {
    const ScreenTransform& t = grid_.transform;
    const float sign = reach > 0 ? 1.0f : -1.0f, w = std::abs(reach) * 1.000001f + 256.0f;
    Linear side{{}, sign * offset + w * (t.orthographic ? 1.0f : t.d_offset)};
    for (std::size_t axis = 0; axis < 3; ++axis)
      side.row[axis] = sign * row[axis] + (t.orthographic ? 0.0f : w * t.d_row[axis]);
    return side;
  }

  const CellGrid& grid_;
  const BoxColumns& boxes_;
  std::vector<ScreenBox>& out_;
  std::array<Linear, 4> sides_;
};

}  // namespace

void FindOnScreen(const CellGrid& grid, const BoxColumns& boxes, const ItemRange& which, std::vector<ScreenBox>& out) {
  const BoxProjector finder(grid, boxes, out);
  for (std::size_t i = which.first; i < which.end(); i += hn::Lanes(DF())) finder.Find(i, which.end());
}

bool IsRectCovered(const CellCover& cover, const CellRect& rect, float depth) { return IsCovered(cover, rect, depth); }

void FindSights(const CellCover& cover, std::span<const ScreenBox> boxes, ObjectSight* sights) {
  for (const ScreenBox& box : boxes) {
    ObjectSight& sight = *sights++;
    sight = ObjectSight::outside;
    if (box.rect.is_empty()) continue;
    sight = IsCovered(cover, box.rect, box.nearest) ? ObjectSight::hidden : ObjectSight::may_be_seen;
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::occlusion_detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace frontmost::occlusion_detail {

FRONTMOST_KERNELS(FindOnScreen);
FRONTMOST_KERNELS(IsRectCovered);
FRONTMOST_KERNELS(FindSights);

void find_on_screen(const CellGrid& grid, const BoxColumns& boxes, const ItemRange& which, std::vector<ScreenBox>& out,
                    Isa isa) {
  kernel_for(FindOnScreenKernels, isa)(grid, boxes, which, out);
}

void find_sights_of(const CellCover& cover, std::span<const ScreenBox> boxes, ObjectSight* sights, Isa isa) {
  kernel_for(FindSightsKernels, isa)(cover, boxes, sights);
}

CoverTest cover_test(Isa isa) { return kernel_for(IsRectCoveredKernels, isa); }

}  // namespace frontmost::occlusion_detail
#endif  // HWY_ONCE
