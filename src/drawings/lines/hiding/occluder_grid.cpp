// SPDX-License-Identifier: Apache-2.0
// Cells are filled in two passes over the triangles, like all lists of this room: entries are counted, then written to
// their places. Each of up to sixteen parts of the triangles has its own counters, so threads need no locks. The cells
// are sorted afterwards, so the order of filling makes no difference.
//
//    first_      |  cell 0  | cell 1 |    cell 2     | ...     where each cell's entries begin
//    nearest_    | 1.2  3.4 |  2.0   | 0.5  0.9  7.1 |         the nearest first
//    low_x_ ...  |  boxes, one array for each side   |         in the layout of the kernels: many at a time
//
// Large triangles are first tested for cells that they cover whole. Triangles behind these are never listed there.
#include "lines/hiding/occluder_grid.h"

#include <cstring>
#include <limits>
#include <utility>

#include "lines/hiding/grid_plan.h"

namespace frontmost::lines_detail {
namespace {

constexpr std::size_t kCellsPerPart = 32, kLargePerPart = 64, kTrianglesPerPart = 4096, kTrianglesPerPoll = 16384;
/// Each part has one counter for every cell.
constexpr std::size_t kMostParts = 16;
/// The kernels read whole vectors beyond the last entry.
constexpr std::size_t kPadding = 64;

/// An integer that sorts like the float.
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

/// Sets `least` to the minimum of itself and `value`.
void lower(std::atomic<float>& least, float value) {
  float held = least.load(std::memory_order_relaxed);
  while (value < held && !least.compare_exchange_weak(held, value, std::memory_order_relaxed)) {
  }
}

/// By cell: an upper bound on the distance of the nearest triangle that covers the cell whole and so hides all beyond
/// it.
std::vector<std::atomic<float>> backs_of(const GridPlan& plan) {
  std::vector<std::atomic<float>> backs(plan.grid.count());
  for (std::atomic<float>& back : backs) back.store(std::numeric_limits<float>::infinity(), std::memory_order_relaxed);
  if (plan.keeps_all) return backs;
  parallel_for(plan.execution, plan.large.size(), kLargePerPart, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      const Footprint& footprint = plan.footprints[plan.large[n]];
      const CellRange& all = plan.ranges[plan.large[n]];
      if (plan.is_near(footprint)) continue;
      const CellDepth depth = plan.depth_of(footprint.triangle);
      for (int y = all.first_row; y <= all.last_row; ++y) {
        const CellDepth::Columns columns = depth.covered(y, {all.first_column, all.last_column});
        for (int x = columns.first; x <= columns.last; ++x)
          lower(backs[plan.grid.number(x, y)], rounded_up(depth.farthest(plan.grid.square(x, y))));
      }
    }
  });
  return backs;
}

}  // namespace

OccluderGrid::OccluderGrid(const SeenMesh& seen, const View& view, bool keeps_all, const Execution& execution,
                           const CrowdLimits& limits) {
  GridPlan plan(seen, view, keeps_all, execution);
  cells_ = CellTree(plan.grid);
  scale_ = plan.scale;
  fill_cells(plan);
  divide_crowds(plan, limits);
  fill_sides(plan);
  occluders_ = std::move(plan.occluders);
}

/// Fills each cell with its entries, the nearest first. Parts of the triangles count and write on their own; the order
/// of their entries does not matter, since cells are sorted afterwards.
void OccluderGrid::fill_cells(const GridPlan& plan) {
  const std::size_t count = plan.footprints.size(), cells = cells_.count();
  const std::size_t parts = std::clamp(count / kTrianglesPerPart, std::size_t(1), kMostParts);
  const std::vector<std::atomic<float>> backs = backs_of(plan);
  const auto for_each_entry = [&](const auto& visit) {
    parallel_for(plan.execution, parts, 1, [&](std::size_t part, std::size_t) {
      const std::size_t end = count * (part + 1) / parts;
      for (std::size_t i = count * part / parts; i < end; ++i) {
        if (i % kTrianglesPerPoll == 0) check_cancelled(plan.execution);
        plan.visit_cells(i, [&](std::uint32_t cell, float nearest) {
          if (nearest <= backs[cell].load(std::memory_order_relaxed)) visit(part, cell, i, nearest);
        });
      }
    });
  };
  Buffer<std::uint32_t> next(parts * cells);  // by part and cell: the index of the next entry in the cell
  parallel_for(plan.execution, parts, 1,
               [&](std::size_t part, std::size_t) { std::fill_n(next.data() + part * cells, cells, 0u); });
  for_each_entry([&](std::size_t part, std::size_t cell, std::size_t, float) { ++next[part * cells + cell]; });
  first_.assign(cells + 1, 0);
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

/// Divides crowded cells. The entries of the parts follow those of the cells.
void OccluderGrid::divide_crowds(const GridPlan& plan, const CrowdLimits& limits) {
  std::vector<std::uint32_t> crowded;
  double squares = 0;
  for (std::uint32_t cell = 0; cell < cells_.count(); ++cell) {
    const std::size_t entries = first_[cell + 1] - first_[cell];
    if (entries < limits.least) continue;
    squares += double(entries) * double(entries);
    crowded.push_back(cell);
  }
  if (squares <= limits.worth) return;
  std::vector<DividedCell<CellEntry>> divided(crowded.size());
  parallel_for(plan.execution, crowded.size(), 1, [&](std::size_t i, std::size_t) {
    std::vector<CellEntry> entries;
    for (std::size_t e = first_[crowded[i]]; e < first_[crowded[i] + 1]; ++e)
      entries.push_back({nearest_[e], numbers_[e]});
    divided[i] = divide_entries(plan, {cells_.square(crowded[i]), std::move(entries)});
  });
  std::size_t e = first_.back();
  for (std::size_t i = 0; i < crowded.size(); ++i) {
    cells_.graft(crowded[i], divided[i].cells);
    for (std::size_t cell = 1; cell < divided[i].cells.count(); ++cell)
      first_.push_back(first_.back() + divided[i].items[cell].size());
  }
  set_entry_count(first_.back());
  for (const DividedCell<CellEntry>& one : divided)
    for (std::size_t cell = 1; cell < one.cells.count(); ++cell)
      for (const CellEntry& entry : one.items[cell]) {
        if (e % kTrianglesPerPoll == 0) check_cancelled(plan.execution);
        set_entry(plan, e++, entry);
      }
}

OccluderGrid::Crowd OccluderGrid::largest_crowd() const {
  Crowd crowd;
  for (std::size_t cell = 0; cell < cells_.count(); ++cell)
    if (const std::size_t count = first_[cell + 1] - first_[cell]; count > crowd.count)
      crowd = {count, occluder(first_[cell]).triangle};
  return crowd;
}

/// Resizes the arrays of entries and keeps as many old entries as fit.
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

void OccluderGrid::set_entry(const GridPlan& plan, std::size_t e, const CellEntry& entry) {
  const Footprint& f = plan.footprints[entry.footprint];
  low_x_[e] = f.low.x;
  low_y_[e] = f.low.y;
  high_x_[e] = f.high.x;
  high_y_[e] = f.high.y;
  nearest_[e] = entry.nearest;
  numbers_[e] = entry.footprint;
}

void OccluderGrid::fill_sides(const GridPlan& plan) {
  const std::size_t cells = cells_.count();
  first_side_.resize(cells);
  std::size_t count = 0;
  for (std::size_t cell = 0; cell < cells; ++cell) {
    first_side_[cell] = count;
    if (has_sides(cell)) count += first_[cell + 1] - first_[cell];
  }
  for (Buffer<float>& values : sides_) values = Buffer<float>(count + kPadding, 0.0f);
  if (count == 0) return;
  parallel_for(plan.execution, cells, kCellsPerPart, [&](std::size_t begin, std::size_t end) {
    for (std::size_t cell = begin; cell < end; ++cell) {
      if (!has_sides(cell)) continue;
      const Square square = cells_.square(std::uint32_t(cell));
      for (std::size_t i = 0; i < first_[cell + 1] - first_[cell]; ++i) {
        const Footprint& footprint = plan.footprints[numbers_[first_[cell] + i]];
        const std::size_t entry = first_side_[cell] + i;
        if (plan.is_near(footprint)) {
          for (int k = 0; k < ScreenSides::count; ++k)
            set_side(entry, k, {0, 0, std::numeric_limits<float>::infinity()});
          continue;
        }
        const CellDepth depth = plan.depth_of(footprint.triangle);
        for (int k = 0; k < 3; ++k) set_side(entry, k, depth.side(k, {square.x, square.y}));
        set_side(entry, 3, depth.plane({square.x, square.y}));
      }
    }
  });
}

}  // namespace frontmost::lines_detail
