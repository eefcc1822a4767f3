// SPDX-License-Identifier: Apache-2.0
#include "lines/hiding/occluder_grid.h"

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "base/parallel.h"
#include "lines/hiding/grid_plan.h"
#include "lines/joined.h"

namespace frontmost::lines_detail {
namespace {

/// One cell for so many triangles. Sixteen boxes are asked at once, so that many small cells cost more than few large
/// ones: from 4 to 32 the million-triangle terrain takes 1.1 to 0.8 s in all, and 64 gain nothing more.
constexpr double kTrianglesPerCell = 32;
constexpr double kMostCells = 1 << 22;
/// How many cells a triangle may take, all in all: what bounds memory.
constexpr double kEntriesPerTriangle = 16;
constexpr std::size_t kCellsPerPart = 256;
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

/// Calls visit(cell, nearest) for every cell of the band that the i-th triangle may touch, and how near it is there.
template <class Visitor>
void OccluderGrid::cover(const Plan& plan, std::size_t i, const Band& band, const Visitor& visit) const {
  const Footprint& footprint = plan.footprints[i];
  const Extent& all = plan.extents[i];
  const int first_row = std::max(band.first, all.first_row), last_row = std::min(band.last, all.last_row);
  if (first_row > last_row) return;
  if (!all.is_large()) {
    for (int y = first_row; y <= last_row; ++y)
      for (int x = all.first_column; x <= all.last_column; ++x) visit(number(x, y), footprint.nearest);
    return;
  }
  const Outline outline = outline_of(plan, footprint.triangle);
  const CellDepth depth = plan.on_grid.depth_of(footprint.triangle);
  for (int y = first_row; y <= last_row; ++y) {
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
Buffer<float> OccluderGrid::backs_of(const Plan& plan) const {
  const Buffer<Footprint>& footprints = plan.footprints;
  Buffer<float> backs(cell_count(), std::numeric_limits<float>::infinity());
  for_each_band(plan, [&](const Band& band) {
    for (std::size_t n = 0; n < plan.large.size(); ++n) {
      poll(plan.execution, n);
      const std::uint32_t i = plan.large[n];
      const Extent& all = plan.extents[i];
      if (plan.on_grid.is_near(footprints[i])) continue;
      const CellDepth depth = plan.on_grid.depth_of(footprints[i].triangle);
      const int last_row = std::min(band.last, all.last_row);
      for (int y = std::max(band.first, all.first_row); y <= last_row; ++y) {
        const CellDepth::Columns columns = depth.covered(y, {all.first_column, all.last_column});
        for (int x = columns.first; x <= columns.last; ++x) {
          float& back = backs[number(x, y)];
          back = std::min(back, rounded_up(depth.farthest({double(x), double(y)})));
        }
      }
    }
  });
  return backs;
}

/// As many bands of rows as there are threads, each with its share of what begins in `cells`: where a model is narrow
/// at one end, halves of the picture would leave one thread most of the work. One in many tells the share well enough.
std::vector<OccluderGrid::Band> OccluderGrid::bands_of(const Plan& plan, const Buffer<std::uint32_t>& cells) const {
  std::vector<std::size_t> of_row(std::size_t(rows_), 0);
  std::size_t all = 0;
  const std::size_t stride = std::max<std::size_t>(1, cells.size() >> 14);
  for (std::size_t t = 0; t < cells.size(); t += stride) {
    if (cells[t] == no_index) continue;
    ++of_row[cells[t] / std::size_t(columns_)];
    ++all;
  }
  const auto count = std::size_t(std::min(thread_count(plan.execution), rows_));
  std::vector<Band> bands;
  std::size_t sum = 0;
  for (int y = 0, first = 0; y < rows_; ++y) {
    sum += of_row[std::size_t(y)];
    const bool is_full = bands.size() + 1 < count && sum * count >= all * (bands.size() + 1);
    if (!is_full && y + 1 < rows_) continue;
    bands.push_back({first, y});
    first = y + 1;
  }
  return bands;
}

/// Calls fill(band) for the bands. Every band reads all triangles, which costs less than counting in common.
template <class Fill>
void OccluderGrid::for_each_band(const Plan& plan, const Fill& fill) const {
  parallel_for(plan.execution, plan.bands.size(), 1, [&](std::size_t i, std::size_t) { fill(plan.bands[i]); });
}

/// Of what is seen, in the order of their first cells: what lies side by side on the screen does in memory.
Buffer<Footprint> OccluderGrid::footprints_by_cell(Plan& plan) const {
  const std::size_t count = plan.mesh().triangles.size();
  Buffer<Footprint> all(count);
  Buffer<std::uint32_t> cells(count);
  parallel_for(plan.execution, count, kPerPart, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      all[t] = footprint_of(plan, std::uint32_t(t));
      const bool is_seen = all[t].nearest < std::numeric_limits<float>::infinity();
      cells[t] = is_seen ? std::uint32_t(number(column(all[t].low.x), row(all[t].low.y))) : no_index;
    }
  });
  plan.bands = bands_of(plan, cells);
  std::vector<std::uint32_t> next(cell_count() + 1, 0);
  const auto for_each_seen = [&](const auto& visit) {
    for_each_band(plan, [&](const Band& band) {
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

void OccluderGrid::make_occluders(const Plan& plan) {
  const Buffer<Footprint>& footprints = plan.footprints;
  occluders_ = Buffer<Occluder>(footprints.size());
  parallel_for(plan.execution, footprints.size(), kPerPart, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::uint32_t triangle = footprints[i].triangle;
      glm::uvec3 v = plan.mesh().triangles[triangle];
      int turn = plan.on_grid.seen.facing[triangle];
      const auto order = [&](int a, int b) {
        if (v[a] < v[b]) return;
        std::swap(v[a], v[b]);
        turn = -turn;
      };
      order(0, 1), order(1, 2), order(0, 1);
      const auto& at = plan.mesh().positions.places();
      occluders_[i] = {
          {at[v.x], at[v.y], at[v.z]}, {v.x, v.y, v.z}, turn, triangle, plan.on_grid.is_near(footprints[i])};
    }
  });
}

/// What each cell holds, the nearest first.
void OccluderGrid::fill_cells(const Plan& plan) {
  const Buffer<Footprint>& footprints = plan.footprints;
  const Buffer<float> backs =
      plan.keeps_all ? Buffer<float>(cell_count(), std::numeric_limits<float>::infinity()) : backs_of(plan);
  const auto for_each_entry = [&](const auto& visit) {
    for_each_band(plan, [&](const Band& band) {
      for (std::size_t i = 0; i < footprints.size(); ++i) {
        poll(plan.execution, i);
        // They are in the order of their first rows, which the padding may have moved by one.
        if (plan.extents[i].first_row > band.last + 1) break;
        cover(plan, i, band, [&](std::size_t cell, float nearest) {
          if (nearest <= backs[cell]) visit(cell, i, nearest);
        });
      }
    });
  };
  for_each_entry([&](std::size_t cell, std::size_t, float) { ++first_[cell + 1]; });
  for (std::size_t i = 0; i + 1 < first_.size(); ++i) first_[i + 1] += first_[i];
  Buffer<std::uint64_t> keys(first_.back());  // distance, then number
  std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
  for_each_entry([&](std::size_t cell, std::size_t i, float nearest) {
    keys[next[cell]++] = std::uint64_t(ordered(nearest)) << 32 | i;
  });
  set_entry_count(keys.size());
  parallel_for(plan.execution, cell_count(), kCellsPerPart, [&](std::size_t begin, std::size_t end) {
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

/// So many cells, the places of vertices on them, and what triangles take of them.
void OccluderGrid::set_cells(Plan& plan, const View& view, double cells) {
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
  plan.footprints = footprints_by_cell(plan);
}

/// Rather more cells than the triangles take together; tells how far each reaches, and which are large.
double OccluderGrid::entries_of(Plan& plan) const {
  const Buffer<Footprint>& footprints = plan.footprints;
  const std::size_t parts = (footprints.size() + kPerPart - 1) / kPerPart;
  plan.extents = Buffer<Extent>(footprints.size());
  std::vector<double> sums(parts, 0);
  std::vector<std::vector<std::uint32_t>> large(parts);
  parallel_for(plan.execution, footprints.size(), kPerPart, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Extent all = plan.extents[i] = extent_of(footprints[i]);
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
  const glm::uvec3& t = plan.mesh().triangles[triangle];
  const glm::dvec3 &a = plan.on_grid.places[t.x], &b = plan.on_grid.places[t.y], &c = plan.on_grid.places[t.z];
  if (!(std::min({a.z, b.z, c.z}) > plan.sight().near())) return infinite;
  return std::abs((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)) / 2;
}

OccluderGrid::OccluderGrid(const SeenMesh& seen, const View& view, bool keeps_all, const LinesToCut& lines,
                           const Execution& execution) {
  const auto triangles = double(seen.mesh.triangles.size());
  Plan plan{{seen, Sight(view), Buffer<glm::dvec3>(seen.mesh.positions.size())}, execution, keeps_all, {}, {}, {}, {}};
  double cells = std::clamp(triangles / kTrianglesPerCell, 1.0, kMostCells);
  set_cells(plan, view, cells);
  // Fewer cells where triangles are large: a thousand sheets before a million cells would be a thousand million.
  const double most = kEntriesPerTriangle * triangles + kMostCells;
  for (double entries = entries_of(plan); entries > most && cells > 1; entries = entries_of(plan)) {
    cells = std::max(1.0, std::min(cells / 2, cells * most / entries));
    set_cells(plan, view, cells);
  }
  make_occluders(plan);
  fill_cells(plan);
  const std::vector<FineCells> parts = divide_crowds(plan, lines);
  number_parts(parts);
  add_entries(plan, parts);
  fill_sides(plan);
}

}  // namespace frontmost::lines_detail
