// SPDX-License-Identifier: Apache-2.0
#include "lines/hiding/occluder_grid.h"

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <utility>

#include "base/parallel.h"
#include "base/prefetch.h"
#include "lines/hiding/grid_plan.h"
#include "lines/joined.h"
#include "surfaces/radix_sort.h"

namespace frontmost::lines_detail {
namespace {

/// One cell for so many triangles. Sixteen boxes are asked at once, so that many small cells cost more than few large
/// ones: from 4 to 32 the million-triangle terrain takes 1.1 to 0.8 s in all, and 64 gain nothing more.
constexpr double kTrianglesPerCell = 32;
constexpr double kMostCells = 1 << 22;
/// How many cells a triangle may take, all in all: what bounds memory.
constexpr double kEntriesPerTriangle = 16;
constexpr std::size_t kCellsPerPart = 32, kLargePerPart = 64, kSeenPerPart = 1024;
/// Each has a number for every cell.
constexpr std::size_t kMostParts = 16;
/// How far ahead triangles are fetched that lie anywhere.
constexpr std::size_t kAhead = 16;
/// The kernels read whole vectors beyond the last entry.
constexpr std::size_t kPadding = 64;
constexpr double infinite = std::numeric_limits<double>::infinity();

/// Grows by what rounding may have moved a corner, also one far outside of the picture.
double widened(double value, double direction) { return value + direction * 1e-9 * (1 + std::abs(value)); }

/// Sorts as the float does.
std::uint32_t ordered(float value) {
  std::uint32_t bits;
  std::memcpy(&bits, &value, sizeof bits);
  return bits & 0x80000000u ? ~bits : bits | 0x80000000u;
}

float from_ordered(std::uint32_t order) {
  const std::uint32_t bits = order & 0x80000000u ? order & 0x7FFFFFFFu : ~order;
  float value;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

/// To `value`, if that is less.
void lower(std::atomic<float>& least, float value) {
  float held = least.load(std::memory_order_relaxed);
  while (value < held && !least.compare_exchange_weak(held, value, std::memory_order_relaxed)) {
  }
}

}  // namespace

OccluderGrid::Outline OccluderGrid::outline_of(const Plan& plan, std::uint32_t triangle) const {
  const glm::uvec3& corners = plan.mesh().triangles[triangle];
  const double near = plan.sight().near();
  Outline outline;
  outline.nearest = infinite;
  const auto add = [&](const glm::dvec2& place, double distance) {
    outline.corners[std::size_t(outline.count++)] = place;
    outline.nearest = std::min(outline.nearest, widened(distance, -1));
  };
  for (int k = 0; k < 3; ++k) {
    const std::uint32_t v = corners[k], w = corners[(k + 1) % 3];
    const glm::dvec3 &p = plan.on_grid.places[v], &q = plan.on_grid.places[w];
    if (p.z >= near) add(glm::dvec2(p), p.z);
    if ((p.z < near) == (q.z < near)) continue;
    const glm::dvec3 a = plan.sight().in_eye(plan.mesh().positions[v]),
                     b = plan.sight().in_eye(plan.mesh().positions[w]);
    glm::dvec3 cut = a + (b - a) * ((near - a.z) / (b.z - a.z));
    cut.z = near;
    add(glm::dvec2(plan.sight().to_screen(cut)) * scale_, near);
  }
  return outline;
}

Footprint OccluderGrid::footprint_of(const Plan& plan, std::uint32_t triangle) const {
  Footprint none{glm::vec2(0), glm::vec2(0), std::numeric_limits<float>::infinity(), triangle};
  if (plan.on_grid.seen.facing[triangle] == 0) return none;
  const glm::uvec3& corners = plan.mesh().triangles[triangle];
  const glm::dvec3 &a = plan.on_grid.places[corners.x], &b = plan.on_grid.places[corners.y],
                   &c = plan.on_grid.places[corners.z];
  glm::dvec3 low = glm::min(glm::min(a, b), c), high = glm::max(glm::max(a, b), c);
  double nearest = widened(low.z, -1);
  if (low.z < plan.sight().near()) {
    const Outline outline = outline_of(plan, triangle);
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
  if (nearest > plan.sight().far()) return none;
  low = {widened(low.x, -1), widened(low.y, -1), 0};
  high = {widened(high.x, 1), widened(high.y, 1), 0};
  if (!(low.x <= columns_ && low.y <= rows_ && high.x >= 0 && high.y >= 0)) return none;
  return {{rounded_down(low.x), rounded_down(low.y)},
          {rounded_up(high.x), rounded_up(high.y)},
          std::min(rounded_down(nearest), std::numeric_limits<float>::max()),
          triangle};
}

/// Calls visit(cell, nearest) for every cell that the i-th triangle may touch, and how near it is there.
template <class Visitor>
void OccluderGrid::cover(const Plan& plan, std::size_t i, const Visitor& visit) const {
  const Footprint& footprint = plan.footprints[i];
  const Extent& all = plan.extents[i];
  if (!all.is_large()) {
    for (int y = all.first_row; y <= all.last_row; ++y)
      for (int x = all.first_column; x <= all.last_column; ++x) visit(number(x, y), footprint.nearest);
    return;
  }
  const Outline outline = outline_of(plan, footprint.triangle);
  const CellDepth depth = plan.on_grid.depth_of(footprint.triangle);
  for (int y = all.first_row; y <= all.last_row; ++y) {
    // Of the outline between the row's two sides alone.
    double left = infinite, right = -infinite;
    const double top = y - kPad, bottom = y + 1 + kPad;
    for (int k = 0; k < outline.count; ++k) {
      const glm::dvec2 &p = outline.corners[std::size_t(k)],
                       &q = outline.corners[std::size_t(k + 1 == outline.count ? 0 : k + 1)];
      if (std::min(p.y, q.y) > bottom || std::max(p.y, q.y) < top) continue;
      for (const double side : {std::clamp(p.y, top, bottom), std::clamp(q.y, top, bottom)}) {
        const double x = p.y == q.y ? p.x : p.x + (q.x - p.x) * ((side - p.y) / (q.y - p.y));
        left = std::min({left, x, p.y == q.y ? q.x : x});
        right = std::max({right, x, p.y == q.y ? q.x : x});
      }
    }
    left = std::max(double(footprint.low.x), widened(left, -1));
    right = std::min(double(footprint.high.x), widened(right, 1));
    const int last = column(right + kPad);
    for (int x = column(left - kPad); x <= last; ++x)
      visit(number(x, y), std::max(footprint.nearest, rounded_down(depth.nearest({double(x), double(y)}))));
  }
}

OccluderGrid::Extent OccluderGrid::extent_of(const Footprint& footprint) const {
  return {column(footprint.low.x - kPad), column(footprint.high.x + kPad), row(footprint.low.y - kPad),
          row(footprint.high.y + kPad)};
}

/// By cell, how far away the nearest triangle is, at most, that covers it whole: it hides all that lies beyond.
std::vector<std::atomic<float>> OccluderGrid::backs_of(const Plan& plan) const {
  std::vector<std::atomic<float>> backs(cell_count());
  for (std::atomic<float>& back : backs) back.store(std::numeric_limits<float>::infinity(), std::memory_order_relaxed);
  if (plan.keeps_all) return backs;
  parallel_for(plan.execution, plan.large.size(), kLargePerPart, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      const Footprint& footprint = plan.footprints[plan.large[n]];
      const Extent& all = plan.extents[plan.large[n]];
      if (plan.on_grid.is_near(footprint)) continue;
      const CellDepth depth = plan.on_grid.depth_of(footprint.triangle);
      for (int y = all.first_row; y <= all.last_row; ++y) {
        const CellDepth::Columns columns = depth.covered(y, {all.first_column, all.last_column});
        for (int x = columns.first; x <= columns.last; ++x)
          lower(backs[number(x, y)], rounded_up(depth.farthest({double(x), double(y)})));
      }
    }
  });
  return backs;
}

/// What is seen, in the order of first cells: what lies side by side on the screen does in memory. Then what becomes of
/// each. \returns rather more cells than they take together.
double OccluderGrid::find_footprints(Plan& plan) {
  const std::size_t count = plan.mesh().triangles.size();
  Buffer<Footprint> all(count);
  Buffer<std::uint64_t> keys(count);  // the first cell, then the triangle
  parallel_for(plan.execution, count, kPerPart, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      all[t] = footprint_of(plan, std::uint32_t(t));
      const bool is_seen = all[t].nearest < std::numeric_limits<float>::infinity();
      const std::size_t cell = is_seen ? number(column(all[t].low.x), row(all[t].low.y)) : cell_count();
      keys[t] = std::uint64_t(cell) << 32 | t;
    }
  });
  keys = radix_sort(std::move(keys), std::bit_width(cell_count()), plan.execution);
  const auto seen =
      std::size_t(std::lower_bound(keys.begin(), keys.end(), std::uint64_t(cell_count()) << 32) - keys.begin());
  plan.footprints = Buffer<Footprint>(seen);
  plan.extents = Buffer<Extent>(seen);
  occluders_ = Buffer<Occluder>(seen);
  std::vector<double> sums((seen + kSeenPerPart - 1) / kSeenPerPart);
  std::vector<std::vector<std::uint32_t>> large(sums.size());
  parallel_for(plan.execution, seen, kSeenPerPart, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    std::vector<std::uint32_t> found;
    for (std::size_t i = begin; i < end; ++i) {
      const std::uint32_t ahead = std::uint32_t(keys[std::min(i + kAhead, seen - 1)]);
      prefetch_line(&all[ahead]);
      prefetch_line(&plan.mesh().triangles[ahead]);
      const Footprint footprint = plan.footprints[i] = all[std::uint32_t(keys[i])];
      const Extent extent = plan.extents[i] = extent_of(footprint);
      occluders_[i] = occluder_of(plan, footprint);
      const double columns = extent.last_column - extent.first_column + 1,
                   rows = extent.last_row - extent.first_row + 1;
      double cells = columns * rows;
      if (extent.is_large()) {
        found.push_back(std::uint32_t(i));
        cells = std::min(cells, area_of(plan, footprint.triangle) + 2 * (columns + rows));
      }
      sum += cells;
    }
    sums[begin / kSeenPerPart] = sum;
    large[begin / kSeenPerPart] = std::move(found);
  });
  plan.large = joined(large);
  return std::accumulate(sums.begin(), sums.end(), 0.0);
}

Occluder OccluderGrid::occluder_of(const Plan& plan, const Footprint& footprint) {
  glm::uvec3 v = plan.mesh().triangles[footprint.triangle];
  int turn = plan.on_grid.seen.facing[footprint.triangle];
  // Without a branch, which would be wrong as often as not.
  const auto order = [&](std::uint32_t& a, std::uint32_t& b) {
    turn *= 1 - 2 * int(b < a);
    const std::uint32_t low = std::min(a, b);
    b = std::max(a, b);
    a = low;
  };
  order(v.x, v.y), order(v.y, v.z), order(v.x, v.y);
  const Buffer<glm::vec3>& at = plan.mesh().positions.places();
  return {{at[v.x], at[v.y], at[v.z]}, {v.x, v.y, v.z}, turn, footprint.triangle, plan.on_grid.is_near(footprint)};
}

/// What each cell holds, the nearest first. Parts of the triangles count and place by themselves: where they do does
/// not matter, since cells are sorted then.
void OccluderGrid::fill_cells(const Plan& plan) {
  const std::size_t count = plan.footprints.size(), cells = cell_count();
  const std::size_t parts = std::clamp(count / kPerPart, std::size_t(1), kMostParts);
  const std::vector<std::atomic<float>> backs = backs_of(plan);
  const auto for_each_entry = [&](const auto& visit) {
    parallel_for(plan.execution, parts, 1, [&](std::size_t part, std::size_t) {
      const std::size_t end = count * (part + 1) / parts;
      for (std::size_t i = count * part / parts; i < end; ++i) {
        poll(plan.execution, i);
        cover(plan, i, [&](std::size_t cell, float nearest) {
          if (nearest <= backs[cell].load(std::memory_order_relaxed)) visit(part, cell, i, nearest);
        });
      }
    });
  };
  Buffer<std::uint32_t> next(parts * cells);  // by part and cell: of the cell's entries
  parallel_for(plan.execution, parts, 1,
               [&](std::size_t part, std::size_t) { std::fill_n(next.data() + part * cells, cells, 0u); });
  for_each_entry([&](std::size_t part, std::size_t cell, std::size_t, float) { ++next[part * cells + cell]; });
  for (std::size_t cell = 0; cell < cells; ++cell) {
    std::uint32_t sum = 0;
    for (std::size_t place = cell; place < next.size(); place += cells) sum += std::exchange(next[place], sum);
    first_[cell + 1] = first_[cell] + sum;
  }
  Buffer<std::uint64_t> keys(first_.back());  // distance, then number
  for_each_entry([&](std::size_t part, std::size_t cell, std::size_t i, float nearest) {
    keys[first_[cell] + next[part * cells + cell]++] = std::uint64_t(ordered(nearest)) << 32 | i;
  });
  set_entry_count(keys.size());
  parallel_for(plan.execution, cells, kCellsPerPart, [&](std::size_t begin, std::size_t end) {
    for (std::size_t cell = begin; cell < end; ++cell)
      std::sort(keys.data() + first_[cell], keys.data() + first_[cell + 1]);
    for (std::size_t e = first_[begin]; e < first_[end]; ++e)
      set_entry(plan, e, {from_ordered(std::uint32_t(keys[e] >> 32)), std::uint32_t(keys[e])});
  });
}

/// Of what was set before, as much stays as there is.
void OccluderGrid::set_entry_count(std::size_t count) {
  const auto resize = [](auto& values, std::size_t size) {
    std::remove_reference_t<decltype(values)> resized(size);
    std::copy(values.begin(), values.end(), resized.begin());
    values = std::move(resized);
  };
  resize(numbers_, count);
  for (Buffer<float>* values : {&low_x_, &low_y_, &high_x_, &high_y_, &nearest_}) {
    resize(*values, count + kPadding);
    std::fill(values->end() - kPadding, values->end(), 0.0f);
  }
}

void OccluderGrid::set_entry(const Plan& plan, std::size_t e, const CellEntry& entry) {
  const Footprint& f = plan.footprints[entry.footprint];
  low_x_[e] = f.low.x;
  low_y_[e] = f.low.y;
  high_x_[e] = f.high.x;
  high_y_[e] = f.high.y;
  nearest_[e] = entry.nearest;
  numbers_[e] = entry.footprint;
}

void OccluderGrid::fill_sides(const Plan& plan) {
  const std::size_t cells = first_.size() - 1;
  first_side_.resize(cells);
  std::size_t count = 0;
  for (std::size_t cell = 0; cell < cells; ++cell) {
    const Visit visited = whole(cell);
    first_side_[cell] = count;
    if (has_sides(visited)) count += visited.last - visited.first;
  }
  for (Buffer<float>& values : sides_) values = Buffer<float>(count + kPadding, 0.0f);
  if (count == 0) return;
  parallel_for(plan.execution, cells, kCellsPerPart, [&](std::size_t begin, std::size_t end) {
    for (std::size_t cell = begin; cell < end; ++cell) {
      const Visit visited = whole(cell);
      if (!has_sides(visited)) continue;
      for (std::size_t i = 0; i < visited.last - visited.first; ++i) {
        const Occluder& occluder = occluders_[numbers_[first_[cell] + i]];
        const std::size_t entry = first_side_[cell] + i;
        if (occluder.is_near) {
          for (int k = 0; k < ScreenSides::count; ++k)
            set_side(entry, k, {0, 0, std::numeric_limits<float>::infinity()});
          continue;
        }
        const CellDepth depth = plan.on_grid.depth_of(occluder.triangle);
        for (int k = 0; k < 3; ++k) set_side(entry, k, depth.side(k, visited.corner));
        set_side(entry, 3, depth.plane(visited.corner));
      }
    }
  });
}

/// So many cells, the places of vertices on them, and what triangles take of them. \returns as find_footprints().
double OccluderGrid::set_cells(Plan& plan, const View& view, double cells) {
  const double size = std::sqrt(double(view.width) * view.height / cells);
  columns_ = std::max(1, int(std::ceil(view.width / size)));
  rows_ = std::max(1, int(std::ceil(view.height / size)));
  scale_ = glm::dvec2(1 / size);
  first_.assign(std::size_t(columns_) * std::size_t(rows_) + 1, 0);
  const Positions& positions = plan.mesh().positions;
  parallel_for(plan.execution, positions.size(), kPerPart, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const glm::dvec3 p = plan.sight().to_screen(plan.sight().in_eye(positions[v]));
      plan.on_grid.places[v] = {p.x * scale_.x, p.y * scale_.y, p.z};
    }
  });
  return find_footprints(plan);
}

/// In cells, and infinite where it reaches behind the eye.
double OccluderGrid::area_of(const Plan& plan, std::uint32_t triangle) const {
  const glm::uvec3& t = plan.mesh().triangles[triangle];
  const glm::dvec3 &a = plan.on_grid.places[t.x], &b = plan.on_grid.places[t.y], &c = plan.on_grid.places[t.z];
  if (!(std::min({a.z, b.z, c.z}) > plan.sight().near())) return infinite;
  return std::abs((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)) / 2;
}

OccluderGrid::OccluderGrid(const SeenMesh& seen, const View& view, bool keeps_all, const LinesToCut& lines,
                           const Execution& execution) {
  const auto triangles = double(seen.mesh.triangles.size());
  Plan plan{{seen, Sight(view), Buffer<glm::dvec3>(seen.mesh.positions.size())}, execution, keeps_all, {}, {}, {}};
  double cells = std::clamp(triangles / kTrianglesPerCell, 1.0, kMostCells);
  double entries = set_cells(plan, view, cells);
  // Fewer cells where triangles are large: a thousand sheets before a million cells would be a thousand million.
  const double most = kEntriesPerTriangle * triangles + kMostCells;
  while (entries > most && cells > 1) {
    cells = std::max(1.0, std::min(cells / 2, cells * most / entries));
    entries = set_cells(plan, view, cells);
  }
  fill_cells(plan);
  const std::vector<FineCells> parts = divide_crowds(plan, lines);
  number_parts(parts);
  add_entries(plan, parts);
  fill_sides(plan);
}

}  // namespace frontmost::lines_detail
