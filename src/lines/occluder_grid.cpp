// SPDX-License-Identifier: Apache-2.0
#include "lines/occluder_grid.h"

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "base/parallel.h"
#include "lines/joined.h"

namespace frontmost::lines_detail {
namespace {

/// One cell for so many triangles. Sixteen boxes are asked at once, so that many small cells cost more than few large
/// ones: from 4 to 32 the million-triangle terrain takes 1.1 to 0.8 s in all, and 64 gain nothing more.
constexpr double kTrianglesPerCell = 32;
constexpr double kMostCells = 1 << 22;
/// How many cells a triangle may take, all in all: what bounds memory.
constexpr double kEntriesPerTriangle = 16;
constexpr std::size_t kPerPart = 4096, kCellsPerPart = 256;
/// The kernels read whole vectors beyond the last entry.
constexpr std::size_t kPadding = 64;
constexpr double infinite = std::numeric_limits<double>::infinity();

/// Grows by what rounding may have moved a corner, also one far outside of the picture.
double widened(double value, double direction) { return value + direction * 1e-9 * (1 + std::abs(value)); }

/// Below the value, by up to 2^-22 of it: whatever it is rounded to.
float rounded_down(double value) { return float(value - std::abs(value) * 2e-7); }
float rounded_up(double value) { return -rounded_down(-value); }

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

/// Asks now and then whether to stop, where a part of the work is all that a thread has to do.
void poll(const Execution& execution, std::size_t i) {
  if (i % 16384 == 0) check_cancelled(execution);
}

}  // namespace

/// What the grid is made of.
struct OccluderGrid::Plan {
  const SeenMesh& seen;
  const Sight sight;
  const Execution& execution;
  const bool keeps_all;
  std::vector<std::uint32_t> large;  ///< of the footprints
  Buffer<glm::dvec3> on_grid;        ///< vertices in cells' units, z the planar distance
};

OccluderGrid::Outline OccluderGrid::outline_of(const Plan& plan, std::uint32_t triangle) const {
  const glm::uvec3& corners = plan.seen.mesh.triangles[triangle];
  const double near = plan.sight.near();
  Outline outline;
  outline.nearest = infinite;
  const auto add = [&](const glm::dvec2& place, double distance) {
    outline.corners[std::size_t(outline.count++)] = place;
    outline.nearest = std::min(outline.nearest, widened(distance, -1));
  };
  for (int k = 0; k < 3; ++k) {
    const std::uint32_t v = corners[k], w = corners[(k + 1) % 3];
    const glm::dvec3 &p = plan.on_grid[v], &q = plan.on_grid[w];
    if (p.z >= near) add(glm::dvec2(p), p.z);
    if ((p.z < near) == (q.z < near)) continue;
    const glm::dvec3 a = plan.sight.in_eye(plan.seen.mesh.positions[v]),
                     b = plan.sight.in_eye(plan.seen.mesh.positions[w]);
    glm::dvec3 cut = a + (b - a) * ((near - a.z) / (b.z - a.z));
    cut.z = near;
    add(glm::dvec2(plan.sight.to_screen(cut)) * scale_, near);
  }
  return outline;
}

OccluderGrid::Footprint OccluderGrid::footprint_of(const Plan& plan, std::uint32_t triangle) const {
  Footprint none{glm::vec2(0), glm::vec2(0), std::numeric_limits<float>::infinity(), triangle};
  if (plan.seen.facing[triangle] == 0) return none;
  const glm::uvec3& corners = plan.seen.mesh.triangles[triangle];
  const glm::dvec3 &a = plan.on_grid[corners.x], &b = plan.on_grid[corners.y], &c = plan.on_grid[corners.z];
  glm::dvec3 low = glm::min(glm::min(a, b), c), high = glm::max(glm::max(a, b), c);
  double nearest = widened(low.z, -1);
  if (low.z < plan.sight.near()) {
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
  if (nearest > plan.sight.far()) return none;
  low = {widened(low.x, -1), widened(low.y, -1), 0};
  high = {widened(high.x, 1), widened(high.y, 1), 0};
  if (!(low.x <= columns_ && low.y <= rows_ && high.x >= 0 && high.y >= 0)) return none;
  return {{rounded_down(low.x), rounded_down(low.y)},
          {rounded_up(high.x), rounded_up(high.y)},
          std::min(rounded_down(nearest), std::numeric_limits<float>::max()),
          triangle};
}

/// Calls visit(cell, nearest) for every cell of the band that the triangle may touch, and how near it is there.
template <class Visitor>
void OccluderGrid::cover(const Plan& plan, const Footprint& footprint, const Band& band, const Visitor& visit) const {
  const Extent all = extent_of(footprint);
  const int first_row = std::max(band.first, all.first_row), last_row = std::min(band.last, all.last_row);
  if (first_row > last_row) return;
  if (!all.is_large()) {
    for (int y = first_row; y <= last_row; ++y)
      for (int x = all.first_column; x <= all.last_column; ++x) visit(number(x, y), footprint.nearest);
    return;
  }
  const Outline outline = outline_of(plan, footprint.triangle);
  const CellDepth depth = depth_of(plan, footprint.triangle);
  for (int y = first_row; y <= last_row; ++y) {
    // Of the outline between the row's two sides alone.
    double left = infinite, right = -infinite;
    const double top = y - kPad, bottom = y + 1 + kPad;
    for (int i = 0; i < outline.count; ++i) {
      const glm::dvec2 &p = outline.corners[std::size_t(i)],
                       &q = outline.corners[std::size_t(i + 1 == outline.count ? 0 : i + 1)];
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
      visit(number(x, y), std::max(footprint.nearest, rounded_down(depth.nearest(x, y))));
  }
}

OccluderGrid::Extent OccluderGrid::extent_of(const Footprint& footprint) const {
  return {column(footprint.low.x - kPad), column(footprint.high.x + kPad), row(footprint.low.y - kPad),
          row(footprint.high.y + kPad)};
}

CellDepth OccluderGrid::depth_of(const Plan& plan, std::uint32_t triangle) const {
  const glm::uvec3& t = plan.seen.mesh.triangles[triangle];
  return {plan.on_grid[t.x], plan.on_grid[t.y], plan.on_grid[t.z], plan.sight.is_parallel()};
}

/// Whether some of the triangle may lie before the near plane.
bool OccluderGrid::is_near(const Plan& plan, const Footprint& footprint) const {
  return double(footprint.nearest) <= plan.sight.near() + 1e-6 * std::abs(plan.sight.near());
}

/// By cell, how far away the nearest triangle is, at most, that covers it whole: it hides all that lies beyond.
Buffer<float> OccluderGrid::backs_of(const Plan& plan, const Buffer<Footprint>& footprints) const {
  Buffer<float> backs(cell_count(), std::numeric_limits<float>::infinity());
  for_each_band(plan.execution, [&](const Band& band) {
    for (std::size_t n = 0; n < plan.large.size(); ++n) {
      poll(plan.execution, n);
      const std::uint32_t i = plan.large[n];
      const Extent all = extent_of(footprints[i]);
      if (is_near(plan, footprints[i])) continue;
      const CellDepth depth = depth_of(plan, footprints[i].triangle);
      const int last_row = std::min(band.last, all.last_row);
      for (int y = std::max(band.first, all.first_row); y <= last_row; ++y) {
        const CellDepth::Columns columns = depth.covered(y, {all.first_column, all.last_column});
        for (int x = columns.first; x <= columns.last; ++x) {
          float& back = backs[number(x, y)];
          back = std::min(back, rounded_up(depth.farthest(x, y)));
        }
      }
    }
  });
  return backs;
}

/// Calls fill(band) for bands of rows, as many as there are threads. Every band reads all triangles, which costs less
/// than counting in common.
template <class Fill>
void OccluderGrid::for_each_band(const Execution& execution, const Fill& fill) const {
  const int bands = std::min(thread_count(execution), rows_);
  parallel_for(execution, std::size_t(bands), 1, [&](std::size_t begin, std::size_t) {
    const auto start = [&](int band) { return int(std::int64_t(rows_) * band / bands); };
    fill(Band{start(int(begin)), start(int(begin) + 1) - 1});
  });
}

/// Of what is seen, in the order of their first cells: what lies side by side on the screen does in memory.
Buffer<OccluderGrid::Footprint> OccluderGrid::footprints_by_cell(const Plan& plan) const {
  const std::size_t count = plan.seen.mesh.triangles.size();
  Buffer<Footprint> all(count);
  Buffer<std::uint32_t> cells(count);
  parallel_for(plan.execution, count, kPerPart, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      all[t] = footprint_of(plan, std::uint32_t(t));
      const bool is_seen = all[t].nearest < std::numeric_limits<float>::infinity();
      cells[t] = is_seen ? std::uint32_t(number(column(all[t].low.x), row(all[t].low.y))) : no_index;
    }
  });
  std::vector<std::uint32_t> next(cell_count() + 1, 0);
  const auto for_each_seen = [&](const auto& visit) {
    for_each_band(plan.execution, [&](const Band& band) {
      const std::size_t begin = number(0, band.first), end = number(0, band.last + 1);
      for (std::size_t t = 0; t < count; ++t) {
        poll(plan.execution, t);
        if (cells[t] >= begin && cells[t] < end) visit(t);
      }
    });
  };
  for_each_seen([&](std::size_t t) { ++next[cells[t] + 1]; });
  for (std::size_t i = 0; i + 1 < next.size(); ++i) next[i + 1] += next[i];
  Buffer<Footprint> sorted(next.back());
  for_each_seen([&](std::size_t t) { sorted[next[cells[t]]++] = all[t]; });
  return sorted;
}

void OccluderGrid::make_occluders(const Plan& plan, const Buffer<Footprint>& footprints) {
  occluders_ = Buffer<Occluder>(footprints.size());
  parallel_for(plan.execution, footprints.size(), kPerPart, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::uint32_t triangle = footprints[i].triangle;
      glm::uvec3 v = plan.seen.mesh.triangles[triangle];
      int turn = plan.seen.facing[triangle];
      const auto order = [&](int a, int b) {
        if (v[a] < v[b]) return;
        std::swap(v[a], v[b]);
        turn = -turn;
      };
      order(0, 1), order(1, 2), order(0, 1);
      const auto& at = plan.seen.mesh.positions.places();
      occluders_[i] = {{at[v.x], at[v.y], at[v.z]}, {v.x, v.y, v.z}, turn, triangle, is_near(plan, footprints[i])};
    }
  });
}

void OccluderGrid::fill_cells(const Plan& plan, const Buffer<Footprint>& footprints) {
  const Buffer<float> backs =
      plan.keeps_all ? Buffer<float>(cell_count(), std::numeric_limits<float>::infinity()) : backs_of(plan, footprints);
  const auto for_each_entry = [&](const auto& visit) {
    for_each_band(plan.execution, [&](const Band& band) {
      for (std::size_t i = 0; i < footprints.size(); ++i) {
        poll(plan.execution, i);
        cover(plan, footprints[i], band, [&](std::size_t cell, float nearest) {
          if (nearest <= backs[cell]) visit(cell, i, nearest);
        });
      }
    });
  };
  for_each_entry([&](std::size_t cell, std::size_t, float) { ++first_[cell + 1]; });
  for (std::size_t i = 0; i + 1 < first_.size(); ++i) first_[i + 1] += first_[i];
  const std::size_t entries = first_.back();
  Buffer<std::uint64_t> keys(entries);  // distance, then number
  std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
  for_each_entry([&](std::size_t cell, std::size_t i, float nearest) {
    keys[next[cell]++] = std::uint64_t(ordered(nearest)) << 32 | i;
  });
  for (Buffer<float>* values : {&low_x_, &low_y_, &high_x_, &high_y_, &nearest_}) {
    *values = Buffer<float>(entries + kPadding);
    std::fill(values->end() - kPadding, values->end(), 0.0f);
  }
  numbers_ = Buffer<std::uint32_t>(entries);
  parallel_for(plan.execution, cell_count(), kCellsPerPart, [&](std::size_t begin, std::size_t end) {
    for (std::size_t cell = begin; cell < end; ++cell)
      std::sort(keys.data() + first_[cell], keys.data() + first_[cell + 1]);
    for (std::size_t e = first_[begin]; e < first_[end]; ++e) {
      const Footprint& f = footprints[std::uint32_t(keys[e])];
      low_x_[e] = f.low.x;
      low_y_[e] = f.low.y;
      high_x_[e] = f.high.x;
      high_y_[e] = f.high.y;
      nearest_[e] = from_ordered(std::uint32_t(keys[e] >> 32));
      numbers_[e] = std::uint32_t(keys[e]);
    }
  });
}

void OccluderGrid::fill_sides(const Plan& plan) {
  first_side_.resize(cell_count());
  std::size_t count = 0;
  for (std::size_t cell = 0; cell < cell_count(); ++cell) {
    const std::size_t entries = first_[cell + 1] - first_[cell];
    first_side_[cell] = count;
    if (entries >= kMany) count += entries;
  }
  for (Buffer<float>& values : sides_) values = Buffer<float>(count + kPadding, 0.0f);
  parallel_for(plan.execution, cell_count(), kCellsPerPart, [&](std::size_t begin, std::size_t end) {
    for (std::size_t cell = begin; cell < end; ++cell) {
      const std::size_t entries = first_[cell + 1] - first_[cell];
      if (entries < kMany) continue;
      const glm::dvec2 at = corner(cell);
      for (std::size_t i = 0; i < entries; ++i) {
        const Occluder& occluder = occluders_[numbers_[first_[cell] + i]];
        const std::size_t entry = first_side_[cell] + i;
        if (occluder.is_near) {
          for (int k = 0; k < ScreenSides::count; ++k)
            set_side(entry, k, {0, 0, std::numeric_limits<float>::infinity()});
          continue;
        }
        const CellDepth depth = depth_of(plan, occluder.triangle);
        for (int k = 0; k < 3; ++k) set_side(entry, k, depth.side(k, int(at.x), int(at.y)));
        set_side(entry, 3, depth.plane(int(at.x), int(at.y)));
      }
    }
  });
}

/// So many cells, the places of vertices on them, and what triangles take of them.
Buffer<OccluderGrid::Footprint> OccluderGrid::set_cells(Plan& plan, const View& view, double cells) {
  const double size = std::sqrt(double(view.width) * view.height / cells);
  columns_ = std::max(1, int(std::ceil(view.width / size)));
  rows_ = std::max(1, int(std::ceil(view.height / size)));
  scale_ = glm::dvec2(1 / size);
  first_.assign(std::size_t(columns_) * std::size_t(rows_) + 1, 0);
  const Positions& positions = plan.seen.mesh.positions;
  parallel_for(plan.execution, positions.size(), kPerPart, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const glm::dvec3 p = plan.sight.to_screen(plan.sight.in_eye(positions[v]));
      plan.on_grid[v] = {p.x * scale_.x, p.y * scale_.y, p.z};
    }
  });
  return footprints_by_cell(plan);
}

/// Rather more cells than the triangles take together; tells which are large.
double OccluderGrid::entries_of(Plan& plan, const Buffer<Footprint>& footprints) const {
  const std::size_t parts = (footprints.size() + kPerPart - 1) / kPerPart;
  std::vector<double> sums(parts, 0);
  std::vector<std::vector<std::uint32_t>> large(parts);
  parallel_for(plan.execution, footprints.size(), kPerPart, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Extent all = extent_of(footprints[i]);
      const double columns = all.last_column - all.first_column + 1, rows = all.last_row - all.first_row + 1;
      double cells = columns * rows;
      if (all.is_large()) {
        large[begin / kPerPart].push_back(std::uint32_t(i));
        cells = std::min(cells, area_of(plan, footprints[i].triangle) + 2 * (columns + rows));
      }
      sums[begin / kPerPart] += cells;
    }
  });
  plan.large = joined(large);
  double sum = 0;
  for (const double part : sums) sum += part;
  return sum;
}

/// In cells, and infinite where it reaches behind the eye.
double OccluderGrid::area_of(const Plan& plan, std::uint32_t triangle) const {
  const glm::uvec3& t = plan.seen.mesh.triangles[triangle];
  const glm::dvec3 &a = plan.on_grid[t.x], &b = plan.on_grid[t.y], &c = plan.on_grid[t.z];
  if (!(std::min({a.z, b.z, c.z}) > plan.sight.near())) return infinite;
  return std::abs((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)) / 2;
}

OccluderGrid::OccluderGrid(const SeenMesh& seen, const View& view, bool keeps_all, const Execution& execution) {
  const auto triangles = double(seen.mesh.triangles.size());
  Plan plan{seen, Sight(view), execution, keeps_all, {}, Buffer<glm::dvec3>(seen.mesh.positions.size())};
  double cells = std::clamp(triangles / kTrianglesPerCell, 1.0, kMostCells);
  Buffer<Footprint> footprints = set_cells(plan, view, cells);
  // Fewer cells where triangles are large: a thousand sheets before a million cells would be a thousand million.
  const double most = kEntriesPerTriangle * triangles + kMostCells;
  for (double entries = entries_of(plan, footprints); entries > most && cells > 1;
       entries = entries_of(plan, footprints)) {
    cells = std::max(1.0, std::min(cells / 2, cells * most / entries));
    footprints = set_cells(plan, view, cells);
  }
  make_occluders(plan, footprints);
  fill_cells(plan, footprints);
  fill_sides(plan);
}

}  // namespace frontmost::lines_detail
