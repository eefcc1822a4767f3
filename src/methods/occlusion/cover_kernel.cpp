// SPDX-License-Identifier: Apache-2.0
// Finds the cells of triangles and segments, several rows of a tile at a time.

#include "occlusion/occluder.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "occlusion/cover_kernel.cpp"
#include <cmath>

#include "base/highway-inl.h"
#include "base/isa.h"
// This header must come after Highway's, so it is included in a separate block.
#include "occlusion/cell_rows-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::occlusion_detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
namespace {

using VF = hn::Vec<RowF>;
using MF = hn::Mask<RowF>;

/// A place on the screen, in cells.
struct CellPoint {
  float x, y;
};

/// The cells of some rows, as half-open ranges.
struct RowCells {
  VF first, end;
  MF counts;
};

/// Sets the cells of rows [row, row + lanes) in all tiles of one row of tiles.
HWY_INLINE void SetCells(const RowCells& cells, int row, const CellRect& clip, CellBits& bits) {
  const RowF d;
  const RowI di;
  const int tile_row = row / tile_rows, within = row % tile_rows;
  for (int tx = clip.x0 / tile_columns; tx * tile_columns < clip.x1; ++tx) {
    const VF left = hn::Set(d, float(tx * tile_columns)), zero = hn::Zero(d), most = hn::Set(d, 32.0f);
    const auto in_tile = [&](VF x) { return hn::ConvertTo(di, hn::Min(hn::Max(hn::Sub(x, left), zero), most)); };
    const auto set = hn::AndNot(LowBits(in_tile(cells.first)), LowBits(in_tile(cells.end)));
    std::uint32_t* const to = bits.rows(tile_row * bits.tiles_x() + tx) + within;
    const RowU du;
    hn::Store(hn::Or(hn::Load(du, to), hn::IfThenElseZero(hn::RebindMask(du, cells.counts), set)), du, to);
  }
}

HWY_INLINE CellRect Within(const CellRect& rect, float x0, float y0, float x1, float y1) {
  const auto cell = [](float v, int low, int high) { return int(std::min(std::max(v, float(low)), float(high))); };
  return {cell(x0, rect.x0, rect.x1), cell(y0, rect.y0, rect.y1), cell(x1 + 1.0f, rect.x0, rect.x1),
          cell(y1 + 1.0f, rect.y0, rect.y1)};
}

/// Calls visit(first row, middles of the rows) for all rows of a rectangle, whole vectors of a tile at a time.
template <class Visit>
HWY_INLINE void ForRows(const CellRect& rect, const Visit& visit) {
  const RowF d;
  const int lanes = int(hn::Lanes(d));
  for (int row = rect.y0 / lanes * lanes; row < rect.y1; row += lanes)
    visit(row, hn::Add(hn::Iota(d, 0.5f), hn::Set(d, float(row))));
}

/// The line of a triangle's left or right side.
struct SideLine {
  float x, y, slope;
  [[nodiscard]] HWY_INLINE VF At(VF row) const {
    const RowF d;
    return hn::Add(hn::Mul(hn::Sub(row, hn::Set(d, y)), hn::Set(d, slope)), hn::Set(d, x));
  }
};

/// Sets the cells whose middle lies within a clockwise triangle, to within a hundredth of a cell.
HWY_INLINE void ReachTriangle(const CellPoint (&corners)[3], const CellRect& rect, CellBits& reached) {
  const RowF d;
  const auto [low_x, high_x] = std::minmax({corners[0].x, corners[1].x, corners[2].x});
  const auto [low_y, high_y] = std::minmax({corners[0].y, corners[1].y, corners[2].y});
  // Most triangles of dense meshes lie between the middles of cells.
  if (std::ceil(low_x - 0.5f) > high_x - 0.5f || std::ceil(low_y - 0.5f) > high_y - 0.5f) return;
  const CellRect box = Within(rect, low_x, low_y, high_x, high_y);
  if (box.is_empty()) return;
  SideLine left[2], right[2];
  int left_count = 0, right_count = 0;
  for (int k = 0; k < 3; ++k) {
    const CellPoint &p = corners[k], &q = corners[k == 2 ? 0 : k + 1];
    const float rise = q.y - p.y;
    if (rise == 0) continue;
    const SideLine line{p.x, p.y, (q.x - p.x) / rise};
    // y goes down, so the right sides of a clockwise triangle go down.
    if (rise > 0) {
      right[right_count++] = line;
    } else {
      left[left_count++] = line;
    }
  }
  if (left_count == 0 || right_count == 0) return;
  if (left_count == 1) left[1] = left[0];
  if (right_count == 1) right[1] = right[0];
  const VF top = hn::Set(d, low_y), bottom = hn::Set(d, high_y), half = hn::Set(d, 0.5f);
  ForRows(box, [&](int row, VF y) HWY_ATTR {
    const VF first = hn::Ceil(hn::Sub(hn::Max(left[0].At(y), left[1].At(y)), half));
    const VF last = hn::Floor(hn::Sub(hn::Min(right[0].At(y), right[1].At(y)), half));
    SetCells({first, hn::Add(last, hn::Set(d, 1.0f)), hn::And(hn::Ge(y, top), hn::Le(y, bottom))}, row, box, reached);
  });
}

/// Sets all cells that a segment comes within `margin` of.
HWY_INLINE void EndAtSegment(CellPoint a, CellPoint b, float margin, const CellRect& rect, CellBits& ends) {
  const RowF d;
  if (a.y > b.y) std::swap(a, b);
  const float low_x = std::min(a.x, b.x), high_x = std::max(a.x, b.x), rise = b.y - a.y;
  const CellRect box = Within(rect, low_x - margin, a.y - margin, high_x + margin, b.y + margin);
  if (box.is_empty()) return;
  // Rows go up to 16384, where floats are this precise.
  constexpr float rounding = 1.0f / 512;
  const bool is_level = rise < 0.01f;
  const SideLine line{a.x, a.y, is_level ? 0.0f : (b.x - a.x) / rise};
  const VF reach = hn::Set(d, 0.5f + margin + rounding), wide = hn::Set(d, margin);
  const VF top = hn::Set(d, a.y), bottom = hn::Set(d, b.y), least = hn::Set(d, low_x), most = hn::Set(d, high_x);
  ForRows(box, [&](int row, VF y) HWY_ATTR {
    const VF from = hn::Max(hn::Sub(y, reach), top), to = hn::Min(hn::Add(y, reach), bottom);
    VF low = least, high = most;
    if (!is_level) {
      const VF at_from = line.At(from), at_to = line.At(to);
      low = hn::Max(hn::Min(at_from, at_to), least);
      high = hn::Min(hn::Max(at_from, at_to), most);
    }
    const VF first = hn::Floor(hn::Sub(low, wide)), last = hn::Floor(hn::Add(high, wide));
    const MF counts = hn::And(hn::Le(hn::Sub(y, reach), bottom), hn::Ge(hn::Add(y, reach), top));
    SetCells({first, hn::Add(last, hn::Set(d, 1.0f)), counts}, row, box, ends);
  });
}

/// The triangles of an object that turn one way.
class OneSide {
 public:
  OneSide(const OccluderPass& over, ScreenTurn turn, CoverScratch& scratch)
      : in_(over),
        turn_(turn),
        scratch_(scratch),
        triangles_(over.occluder.mesh.triangles.data() + over.occluder.part.first_triangle),
        neighbours_(over.occluder.mesh.neighbours.data() + over.occluder.part.first_triangle) {}

  /// Sets the reached cells and the ends of all triangles that count. \returns whether any triangle counts.
  bool Reach() {
    bool any = false;
    if (const ChosenTriangles* const chosen = in_.pass.chosen) {
      for (const std::uint32_t t : chosen->whole) any = ReachWhole(t) || any;
      for (const ClippedTriangle& cut : chosen->cut) any = ReachCut(cut, *chosen->screen) || any;
    } else {
      for (std::uint32_t t = 0; t < in_.occluder.part.triangle_count; ++t)
        if (!in_.on_screen.triangles[t].is_cut) any = ReachWhole(t) || any;
      for (const ClippedTriangle& cut : in_.on_screen.cut) any = ReachCut(cut, in_.grid.transform) || any;
    }
    return any;
  }

 private:
  [[nodiscard]] bool Counts(std::uint32_t t) const {
    const ChosenTriangles* const chosen = in_.pass.chosen;
    if (in_.on_screen.triangles[t].turn != turn_) return false;
    return !chosen || chosen->marks[t] == chosen->mark;
  }
  /// Sets the cells and ends of a triangle that is not cut, if it counts. \returns whether it counts.
  bool ReachWhole(std::uint32_t t) {
    if (!Counts(t)) return false;
    const glm::uvec3& c = triangles_[t];
    const CellPoint p[3] = {At(c.x), At(c.y), At(c.z)};
    ReachTurned(p[0], p[1], p[2]);
    for (int side = 0; side < 3; ++side)
      if (IsEnd(t, side)) End(p[side], p[side == 2 ? 0 : side + 1]);
    return true;
  }
  [[nodiscard]] bool IsEnd(std::uint32_t t, int side) const {
    const std::uint32_t beyond = neighbours_[t][side];
    return beyond == no_index || !Counts(beyond - in_.occluder.part.first_triangle);
  }
  [[nodiscard]] CellPoint Placed(std::int32_t x, std::int32_t y) const {
    const ScreenTransform& t = in_.grid.transform;
    return {float(x + t.centre_x) * in_.grid.cells_per_unit, float(y + t.centre_y) * in_.grid.cells_per_unit};
  }
  [[nodiscard]] CellPoint At(std::uint32_t vertex) const {
    const VertexOnScreen& v = in_.on_screen.vertices[vertex - in_.occluder.part.first_vertex];
    return Placed(v.x, v.y);
  }
  HWY_INLINE void ReachTurned(const CellPoint& a, const CellPoint& b, const CellPoint& c) {
    if (turn_ == ScreenTurn::clockwise)
      ReachTriangle({a, b, c}, in_.pass.rect, scratch_.reached);
    else
      ReachTriangle({a, c, b}, in_.pass.rect, scratch_.reached);
  }
  HWY_INLINE void End(const CellPoint& a, const CellPoint& b) {
    EndAtSegment(a, b, in_.grid.margin, in_.pass.rect, scratch_.ends);
  }

  /// Sets the cells and ends of a triangle that is cut, if it counts. \returns whether it counts.
  bool ReachCut(const ClippedTriangle& cut, const ScreenTransform& screen) {
    if (!Counts(cut.triangle)) return false;
    const ClippedPolygon& polygon = cut.polygon;
    const auto at = [&](int i) { return Placed(polygon.corners[std::size_t(i)].x, polygon.corners[std::size_t(i)].y); };
    for (int i = 2; i < polygon.count; ++i) ReachTurned(at(0), at(i - 1), at(i));
    // The least key at the near plane and the greatest at the far plane, however keys are rounded.
    const float nearest_key = 0.999999f,
                farthest_key = screen.orthographic ? 0.000001f : screen.near / screen.far * 1.000001f;
    // The near and far planes make ends. The sides of the guard band need none, as they lie beyond the picture.
    for (int i = 0; i < polygon.count; ++i) {
      const int next = i + 1 == polygon.count ? 0 : i + 1;
      const float key = polygon.corners[std::size_t(i)].key, next_key = polygon.corners[std::size_t(next)].key;
      if ((key >= nearest_key && next_key >= nearest_key) || (key <= farthest_key && next_key <= farthest_key))
        End(at(i), at(next));
    }
    const glm::uvec3& corners = triangles_[cut.triangle];
    for (int side = 0; side < 3; ++side) {
      if (!IsEnd(cut.triangle, side)) continue;
      const auto world = [&](int k) {
        return in_.on_screen.world[corners[k == 3 ? 0 : k] - in_.occluder.part.first_vertex];
      };
      const ClippedPolygon segment = clip_triangle(screen, {world(side), world(side + 1), world(side + 1)});
      for (int i = 1; i < segment.count; ++i)
        End(Placed(segment.corners[std::size_t(i - 1)].x, segment.corners[std::size_t(i - 1)].y),
            Placed(segment.corners[std::size_t(i)].x, segment.corners[std::size_t(i)].y));
    }
    return true;
  }

  const OccluderPass& in_;
  ScreenTurn turn_;
  CoverScratch& scratch_;
  const glm::uvec3* triangles_;
  const glm::uvec3* neighbours_;
};

/// Calls visit(tile, its cells within the rectangle, rows of `solid`) for the tiles that a rectangle reaches into.
template <class Rows, class Visit>
HWY_INLINE void ForTiles(const CellRect& rect, int tiles_x, Rows* solid, const Visit& visit) {
  for (int ty = rect.y0 / tile_rows; ty * tile_rows < rect.y1; ++ty)
    for (int tx = rect.x0 / tile_columns; tx * tile_columns < rect.x1; ++tx, solid += tile_rows)
      visit(ty * tiles_x + tx, CellsWithin(rect, tx * tile_columns, ty * tile_rows), solid);
}

/// Moves cells that are reached and have no ends to `solid`, and clears both. \returns whether a cell that is reached
/// or has ends is not covered.
bool Settle(const CellRect& rect, CoverScratch& scratch, const CellCover& cover, std::uint32_t* solid) {
  const RowU d;
  auto open = hn::Zero(d);
  ForTiles(rect, cover.covered.tiles_x(), solid, [&](int tile, const CellsWithin& within, std::uint32_t* to) HWY_ATTR {
    std::uint32_t *const reached = scratch.reached.rows(tile), *const ends = scratch.ends.rows(tile);
    const std::uint32_t* const covered = cover.covered.rows(tile);
    for (int r = 0; r < tile_rows; r += int(hn::Lanes(d))) {
      const auto all = within(r), inside = hn::And(hn::Load(d, reached + r), all);
      const auto end = hn::And(hn::Load(d, ends + r), all);
      open = hn::Or(open, hn::AndNot(hn::Load(d, covered + r), hn::Or(inside, end)));
      hn::StoreU(hn::Or(hn::LoadU(d, to + r), hn::AndNot(end, inside)), d, to + r);
      hn::Store(hn::Zero(d), d, reached + r);
      hn::Store(hn::Zero(d), d, ends + r);
    }
  });
  return !hn::AllTrue(d, hn::Eq(open, hn::Zero(d)));
}

}  // namespace

bool FindSolid(const OccluderPass& over, CoverScratch& scratch, const CellCover& cover, std::uint32_t* solid) {
  const CoverPass& pass = over.pass;
  bool is_near_open = false;
  const auto add = [&](ScreenTurn turn) {
    if (OneSide(over, turn, scratch).Reach()) is_near_open = Settle(pass.rect, scratch, cover, solid) || is_near_open;
  };
  if (pass.clockwise) add(ScreenTurn::clockwise);
  if (pass.counter_clockwise) add(ScreenTurn::counter_clockwise);
  return is_near_open;
}

void AddToCover(const CoverPass& pass, const std::uint32_t* solid, CellCover& cover) {
  const RowU d;
  ForTiles(pass.rect, cover.covered.tiles_x(), solid,
           [&](int tile, const CellsWithin&, const std::uint32_t* from) HWY_ATTR {
             std::uint32_t* const covered = cover.covered.rows(tile);
             auto fresh = hn::Zero(d), all = hn::Set(d, ~0u);
             for (int r = 0; r < tile_rows; r += int(hn::Lanes(d))) {
               const auto before = hn::Load(d, covered + r), more = hn::LoadU(d, from + r), now = hn::Or(before, more);
               fresh = hn::Or(fresh, hn::AndNot(before, more));
               all = hn::And(all, now);
               hn::Store(now, d, covered + r);
             }
             if (hn::AllTrue(d, hn::Eq(fresh, hn::Zero(d)))) return;
             float& depth = cover.depth[std::size_t(tile)];
             depth = std::max(depth, pass.distance);
             if (hn::AllTrue(d, hn::Eq(all, hn::Set(d, ~0u)))) cover.full_depth[std::size_t(tile)] = depth;
           });
}

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::occlusion_detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace frontmost::occlusion_detail {

FRONTMOST_KERNELS(FindSolid);
FRONTMOST_KERNELS(AddToCover);

bool find_solid(const OccluderPass& over, CoverScratch& scratch, const CellCover& cover, std::uint32_t* solid,
                Isa isa) {
  return kernel_for(FindSolidKernels, isa)(over, scratch, cover, solid);
}

void add_to_cover(const CoverPass& pass, const std::uint32_t* solid, CellCover& cover, Isa isa) {
  kernel_for(AddToCoverKernels, isa)(pass, solid, cover);
}

}  // namespace frontmost::occlusion_detail
#endif  // HWY_ONCE
