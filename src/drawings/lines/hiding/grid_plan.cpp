// SPDX-License-Identifier: Apache-2.0
// The grid is first made as fine as the number of triangles suggests, and its entries are counted. If large triangles
// take too many cells, the grid is made coarser until they fit. So memory is bounded by sixteen entries for each
// triangle and some millions.
//
// Footprints are sorted by their first cell, so that triangles that are neighbours on the screen are neighbours in
// memory, whatever the order in the file. Places are rounded outwards to floats, and every comparison of places in
// cells has a pad far above the rounding error.
#include "lines/hiding/grid_plan.h"

#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/memory.h"
#include "lines/lists.h"
#include "surfaces/radix_sort.h"

namespace frontmost::lines_detail {
namespace {

/// Triangles per cell. Sixteen boxes are tested at once, so many small cells cost more than few large ones. From 4 to
/// 32, the time for the million-triangle terrain falls from 1.1 to 0.8 s in all; 64 gains nothing more.
constexpr double kTrianglesPerCell = 32;
constexpr double kMostCells = 1 << 22;
/// The mean number of cells that a triangle may take, and the most of all; both bound memory.
constexpr double kEntriesPerTriangle = 16, kMostEntries = 4e9;
constexpr std::size_t kPerPart = 4096, kSeenPerPart = 1024;
/// How far ahead triangles at random addresses are prefetched.
constexpr std::size_t kAhead = 16;
constexpr double infinite = std::numeric_limits<double>::infinity();

/// Moved outwards by the greatest rounding error of a corner, also one far outside of the picture.
double widened(double value, double direction) { return value + direction * 1e-9 * (1 + std::abs(value)); }

}  // namespace

GridPlan::GridPlan(const SeenMesh& its_seen, const View& view, bool all, const Execution& its_execution)
    : seen(its_seen), sight(view), keeps_all(all), execution(its_execution), places_(seen.mesh.positions.size()) {
  const auto triangles = double(seen.mesh.triangles.size());
  const double most = std::min(kEntriesPerTriangle * triangles + kMostCells, kMostEntries);
  double cells = std::clamp(triangles / kTrianglesPerCell, 1.0, kMostCells);
  set_cells(view, cells);
  while (entries_ > most && cells > 1) {
    cells = std::max(1.0, std::min(cells / 2, cells * most / entries_));
    set_cells(view, cells);
  }
  if (entries_ > kMostEntries)
    throw Error(ErrorCode::limit_exceeded, "lines", "more than 4000000000 triangles in the cells of the picture");
}

/// Sets the resolution, the places of vertices in cells, and the footprints.
void GridPlan::set_cells(const View& view, double cells) {
  const double size = std::sqrt(double(view.width) * view.height / cells);
  grid.columns = std::max(1, int(std::ceil(view.width / size)));
  grid.rows = std::max(1, int(std::ceil(view.height / size)));
  scale = 1 / size;
  const Positions& positions = seen.mesh.positions;
  parallel_for(execution, positions.size(), kPerPart, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const glm::dvec3 p = sight.to_screen(sight.in_eye(positions[v]));
      places_[v] = {p.x * scale, p.y * scale, p.z};
    }
  });
  find_footprints();
}

/// Footprints of triangles that are seen, in the order of first cells, so that neighbours on the screen are neighbours
/// in memory. Then their ranges, occluders and numbers of entries.
void GridPlan::find_footprints() {
  const std::size_t count = seen.mesh.triangles.size(), cells = grid.count();
  Buffer<Footprint> all(count);
  Buffer<std::uint64_t> keys(count);  // the first cell, then the triangle
  parallel_for(execution, count, kPerPart, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      all[t] = footprint_of(std::uint32_t(t));
      const bool is_seen = all[t].nearest < std::numeric_limits<float>::infinity();
      const std::size_t cell = is_seen ? grid.number(column(all[t].low.x), row(all[t].low.y)) : cells;
      keys[t] = std::uint64_t(cell) << 32 | t;
    }
  });
  keys = radix_sort(std::move(keys), std::bit_width(cells), execution);
  const auto held = std::size_t(std::lower_bound(keys.begin(), keys.end(), std::uint64_t(cells) << 32) - keys.begin());
  footprints = Buffer<Footprint>(held);
  ranges = Buffer<CellRange>(held);
  occluders = Buffer<Occluder>(held);
  std::vector<double> sums((held + kSeenPerPart - 1) / kSeenPerPart);
  std::vector<std::vector<std::uint32_t>> found(sums.size());
  parallel_for(execution, held, kSeenPerPart, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    std::vector<std::uint32_t> large_ones;
    for (std::size_t i = begin; i < end; ++i) {
      const std::uint32_t ahead = std::uint32_t(keys[std::min(i + kAhead, held - 1)]);
      prefetch_line(&all[ahead]);
      prefetch_line(&seen.mesh.triangles[ahead]);
      const Footprint footprint = footprints[i] = all[std::uint32_t(keys[i])];
      const CellRange range = ranges[i] = range_of(footprint);
      occluders[i] = occluder_of(footprint);
      sum += entries_of(footprint, range);
      if (range.is_large()) large_ones.push_back(std::uint32_t(i));
    }
    sums[begin / kSeenPerPart] = sum;
    found[begin / kSeenPerPart] = std::move(large_ones);
  });
  large = joined(found);
  entries_ = std::accumulate(sums.begin(), sums.end(), 0.0);
}

Footprint GridPlan::footprint_of(std::uint32_t triangle) const {
  Footprint none{glm::vec2(0), glm::vec2(0), std::numeric_limits<float>::infinity(), triangle};
  if (seen.facing[triangle] == 0) return none;
  const glm::uvec3& corners = seen.mesh.triangles[triangle];
  const glm::dvec3 &a = places_[corners.x], &b = places_[corners.y], &c = places_[corners.z];
  glm::dvec3 low = glm::min(glm::min(a, b), c), high = glm::max(glm::max(a, b), c);
  double nearest = widened(low.z, -1);
  if (low.z < sight.near()) {
    const Outline outline = outline_of(triangle);
    if (outline.count == 0) return none;
    nearest = outline.nearest;
    low = glm::dvec3(infinite);
    high = -low;
    for (int i = 0; i < outline.count; ++i) {
      const glm::dvec3 corner(outline.corners[std::size_t(i)], 0);
      low = glm::min(low, corner);
      high = glm::max(high, corner);
    }
  }
  if (nearest > sight.far()) return none;
  low = {widened(low.x, -1), widened(low.y, -1), 0};
  high = {widened(high.x, 1), widened(high.y, 1), 0};
  if (!(low.x <= grid.columns && low.y <= grid.rows && high.x >= 0 && high.y >= 0)) return none;
  return {{rounded_down(low.x), rounded_down(low.y)},
          {rounded_up(high.x), rounded_up(high.y)},
          std::min(rounded_down(nearest), std::numeric_limits<float>::max()),
          triangle};
}

CellRange GridPlan::range_of(const Footprint& footprint) const {
  return {column(footprint.low.x - kCellPad), column(footprint.high.x + kCellPad), row(footprint.low.y - kCellPad),
          row(footprint.high.y + kCellPad)};
}

GridPlan::Outline GridPlan::outline_of(std::uint32_t triangle) const {
  const glm::uvec3& corners = seen.mesh.triangles[triangle];
  const double near = sight.near();
  Outline outline;
  outline.nearest = infinite;
  const auto add = [&](const glm::dvec2& place, double distance) {
    outline.corners[std::size_t(outline.count++)] = place;
    outline.nearest = std::min(outline.nearest, widened(distance, -1));
  };
  for (int k = 0; k < 3; ++k) {
    const std::uint32_t v = corners[k], w = corners[(k + 1) % 3];
    const glm::dvec3 &p = places_[v], &q = places_[w];
    if (p.z >= near) add(glm::dvec2(p), p.z);
    if ((p.z < near) == (q.z < near)) continue;
    const glm::dvec3 a = sight.in_eye(seen.mesh.positions[v]), b = sight.in_eye(seen.mesh.positions[w]);
    glm::dvec3 cut = a + (b - a) * ((near - a.z) / (b.z - a.z));
    cut.z = near;
    add(glm::dvec2(sight.to_screen(cut)) * scale, near);
  }
  return outline;
}

/// The extent of the outline between the lower and upper side of a row.
GridPlan::Span GridPlan::within_row(const Outline& outline, int row) {
  Span span{infinite, -infinite};
  const double top = row - kCellPad, bottom = row + 1 + kCellPad;
  for (int k = 0; k < outline.count; ++k) {
    const glm::dvec2 &p = outline.corners[std::size_t(k)],
                     &q = outline.corners[std::size_t(k + 1 == outline.count ? 0 : k + 1)];
    if (std::min(p.y, q.y) > bottom || std::max(p.y, q.y) < top) continue;
    for (const double side : {std::clamp(p.y, top, bottom), std::clamp(q.y, top, bottom)}) {
      const double x = p.y == q.y ? p.x : p.x + (q.x - p.x) * ((side - p.y) / (q.y - p.y));
      span.left = std::min({span.left, x, p.y == q.y ? q.x : x});
      span.right = std::max({span.right, x, p.y == q.y ? q.x : x});
    }
  }
  return {widened(span.left, -1), widened(span.right, 1)};
}

Occluder GridPlan::occluder_of(const Footprint& footprint) const {
  glm::uvec3 v = seen.mesh.triangles[footprint.triangle];
  int turn = seen.facing[footprint.triangle];
  // Sorts without branches, which would be mispredicted half of the time.
  const auto order = [&](std::uint32_t& a, std::uint32_t& b) {
    turn *= 1 - 2 * int(b < a);
    const std::uint32_t low = std::min(a, b);
    b = std::max(a, b);
    a = low;
  };
  order(v.x, v.y), order(v.y, v.z), order(v.x, v.y);
  const Buffer<glm::vec3>& at = seen.mesh.positions.places();
  return {{at[v.x], at[v.y], at[v.z]}, {v.x, v.y, v.z}, turn, footprint.triangle, is_near(footprint)};
}

/// In cells; infinite for a triangle that reaches behind the near plane.
double GridPlan::area_of(std::uint32_t triangle) const {
  const glm::uvec3& t = seen.mesh.triangles[triangle];
  const glm::dvec3 &a = places_[t.x], &b = places_[t.y], &c = places_[t.z];
  if (!(std::min({a.z, b.z, c.z}) > sight.near())) return infinite;
  return std::abs((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)) / 2;
}

/// An upper bound on the number of cells.
double GridPlan::entries_of(const Footprint& footprint, const CellRange& range) const {
  const double columns = range.last_column - range.first_column + 1, rows = range.last_row - range.first_row + 1;
  if (!range.is_large()) return columns * rows;
  return std::min(columns * rows, area_of(footprint.triangle) + 2 * (columns + rows));
}

}  // namespace frontmost::lines_detail
