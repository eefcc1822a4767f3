// SPDX-License-Identifier: Apache-2.0
// Cells of an occluder grid where many lines meet many triangles become many cells.
#include <algorithm>

#include "base/parallel.h"
#include "lines/hiding/grid_plan.h"

namespace frontmost::lines_detail {
namespace {

/// How many entries dividing may add: so many times those that there are, and some.
constexpr std::size_t kMostAdded = 4, kAlwaysAdded = 1 << 22;

/// What is seen of a line, before the near plane and within a picture of so many cells; nowhere if nothing is.
GridLine on_picture(const SightedEdge& edge, const OnGrid& grid, const glm::dvec2& scale, const glm::dvec2& size) {
  glm::dvec3 from = grid.sight.in_eye(edge.from), to = grid.sight.in_eye(edge.to);
  double begin = 0, end = 1;
  // Where a value that is linear along the line is not negative.
  const auto keep = [&](double at_from, double at_to) {
    if (at_from < 0 && at_to < 0) end = -1;
    if (at_from < 0 && at_to >= 0) begin = std::max(begin, at_from / (at_from - at_to));
    if (at_to < 0 && at_from >= 0) end = std::min(end, at_from / (at_from - at_to));
  };
  const auto cut = [&](auto& a, auto& b) {
    const auto along = b - a;
    if (end < 1) b = a + along * end;
    if (begin > 0) a = a + along * begin;
  };
  const auto vertex = [](const EndOn& on, bool is_cut) { return is_cut || on[0] != on[1] ? no_index : on[0]; };
  keep(from.z - grid.sight.near(), to.z - grid.sight.near());
  if (!(begin < end)) return {};
  cut(from, to);
  const double near = grid.sight.near();
  from.z = std::max(from.z, near), to.z = std::max(to.z, near);
  bool is_from_cut = begin > 0, is_to_cut = end < 1;
  glm::dvec2 a = glm::dvec2(grid.sight.to_screen(from)) * scale, b = glm::dvec2(grid.sight.to_screen(to)) * scale;
  begin = 0, end = 1;
  for (int axis = 0; axis < 2; ++axis) {
    keep(a[axis], b[axis]);
    keep(size[axis] - a[axis], size[axis] - b[axis]);
  }
  if (!(begin < end)) return {};
  cut(a, b);
  is_from_cut = is_from_cut || begin > 0, is_to_cut = is_to_cut || end < 1;
  return {a, b, vertex(edge.from_on, is_from_cut), vertex(edge.to_on, is_to_cut)};
}

}  // namespace

/// What is seen of the lines, cut off at the near plane and at the picture's sides.
std::vector<GridLine> OccluderGrid::lines_on_grid(const Plan& plan, const LinesToCut& lines) const {
  std::vector<GridLine> all(lines.count > 0 ? lines.count : plan.footprints.size());
  const glm::dvec2 size(columns_, rows_);
  parallel_for(plan.execution, all.size(), kPerPart, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      SightedEdge edge;
      if (lines.count > 0) {
        edge = lines.line(i);
      } else {
        const glm::uvec3& t = plan.mesh().triangles[plan.footprints[i].triangle];
        edge.from = plan.mesh().positions[t.x], edge.to = plan.mesh().positions[t.y];
        edge.from_on = {t.x, t.x}, edge.to_on = {t.y, t.y};
      }
      all[i] = on_picture(edge, plan.on_grid, scale_, size);
    }
  });
  return all;
}

/// Divides the cells that hold much. \returns by FineCells::cells[0] what has become of each, in their order.
std::vector<FineCells> OccluderGrid::divide_crowds(const Plan& plan, const LinesToCut& lines) {
  std::vector<std::size_t> crowded;
  double squares = 0;
  std::vector<std::uint32_t> crowd_of(cell_count(), no_index);
  for (std::size_t cell = 0; cell < cell_count(); ++cell) {
    const std::size_t entries = first_[cell + 1] - first_[cell];
    if (entries < lines.crowd) continue;
    squares += double(entries) * double(entries);
    crowd_of[cell] = std::uint32_t(crowded.size());
    crowded.push_back(cell);
  }
  if (squares <= lines.worth) return {};
  const std::vector<GridLine> on_grid = lines_on_grid(plan, lines);
  std::vector<std::vector<std::uint32_t>> passing(crowded.size());
  for (std::uint32_t i = 0; i < on_grid.size(); ++i) {
    poll(plan.execution, i);
    if (on_grid[i].from == on_grid[i].to) continue;
    visit_cells(on_grid[i], [&](const Visit& visited) {
      if (crowd_of[visited.cell] != no_index) passing[crowd_of[visited.cell]].push_back(i);
      return true;
    });
  }
  double pairs = 1;
  const auto pairs_in = [&](std::size_t i) {
    return double(first_[crowded[i] + 1] - first_[crowded[i]]) * double(passing[i].size());
  };
  for (std::size_t i = 0; i < crowded.size(); ++i) pairs += pairs_in(i);
  std::vector<FineCells> parts(crowded.size());
  const CrowdedGrid grid{plan.on_grid, plan.footprints, on_grid, plan.keeps_all};
  parallel_for(plan.execution, crowded.size(), 1, [&](std::size_t i, std::size_t) {
    const std::size_t cell = crowded[i];
    const double share = pairs_in(i) / pairs;
    Crowd crowd{
        {double(cell % std::size_t(columns_)), double(cell / std::size_t(columns_))}, {}, std::move(passing[i])};
    crowd.room = std::size_t(share * double(kMostAdded * first_[cell_count()] + kAlwaysAdded));
    for (std::size_t e = first_[cell]; e < first_[cell + 1]; ++e) crowd.entries.push_back({nearest_[e], numbers_[e]});
    parts[i] = divide(grid, std::move(crowd), plan.execution);
    if (parts[i].cells.size() == 1) parts[i] = {};  // as it was
  });
  fine_of_ = std::move(crowd_of);
  return parts;
}

/// Numbers parts behind the cells, and their entries behind those of the cells.
void OccluderGrid::number_parts(const std::vector<FineCells>& parts) {
  for (std::uint32_t& number : fine_of_) {
    if (number == no_index) continue;
    const FineCells& part = parts[number];
    if (part.cells.empty()) {
      number = no_index;
      continue;
    }
    const auto cells = std::uint32_t(fine_.size()), divisions = std::uint32_t(divisions_.size()),
               slices = std::uint32_t(slices_.size());
    number = cells;
    const auto moved = [](std::uint32_t local, std::uint32_t by) { return local == no_index ? no_index : local + by; };
    for (const FineCell& cell : part.cells) {
      fine_.push_back({cell.corner, moved(cell.division, divisions), moved(cell.slices, slices)});
      first_.push_back(first_.back() + cell.entries.size());
    }
    for (Division division : part.divisions) {
      division.first_cell += cells;
      divisions_.push_back(division);
    }
    for (Slices some : part.slices) {
      some.first_cell += cells;
      slices_.push_back(std::move(some));
    }
  }
}

/// The parts' entries, behind those of the cells.
void OccluderGrid::add_entries(const Plan& plan, const std::vector<FineCells>& parts) {
  if (parts.empty()) return;
  std::size_t e = first_[cell_count()];
  set_entry_count(first_.back());
  for (const FineCells& part : parts)
    for (const FineCell& cell : part.cells)
      for (const CellEntry& entry : cell.entries) {
        poll(plan.execution, e);
        set_entry(plan, e++, entry);
      }
}

}  // namespace frontmost::lines_detail
