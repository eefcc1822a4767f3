// SPDX-License-Identifier: Apache-2.0
//    first_      |  cell 0  | cell 1 |    cell 2     | ...     where each cell's entries begin
//    nearest_    | 1.2  3.4 |  2.0   | 0.5  0.9  7.1 |         the nearest first
//    low_x_ ...  |  boxes, one array for each side   |         in the layout of the kernels: many at a time
//
// Large triangles are first tested for cells that they cover whole. Triangles behind these are never listed there.
#include "lines/hiding/occluder_grid.h"

#include <cstring>
#include <limits>

#include "geometry/buckets.h"
#include "lines/hiding/grid_plan.h"

namespace frontmost::lines_detail {
namespace {

constexpr std::size_t kCellsPerPart = 32, kLargePerPart = 64;
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

OccluderGrid::OccluderGrid(const SeenMesh& seen, const View& view, bool keeps_all, const Execution& execution) {
  GridPlan plan(seen, view, keeps_all, execution);
  cells_ = plan.grid;
  scale_ = plan.scale;
  fill_cells(plan);
  fill_sides(plan);
  occluders_ = std::move(plan.occluders);
}

/// Fills each cell with its entries, the nearest first.
void OccluderGrid::fill_cells(const GridPlan& plan) {
  const std::vector<std::atomic<float>> backs = backs_of(plan);
  const auto list = [&](std::size_t i, const auto& add) {
    plan.visit_cells(i, [&](std::uint32_t cell, float nearest) {
      if (nearest <= backs[cell].load(std::memory_order_relaxed))
        add(cell, std::uint64_t(ordered(nearest)) << 32 | i);  // distance, then number
    });
  };
  Buckets<std::uint64_t> entries(cells_.count(), plan.footprints.size(), list, plan.execution);
  first_.assign(1, 0);
  for (std::size_t cell = 0; cell < cells_.count(); ++cell) first_.push_back(first_.back() + entries[cell].size());
  numbers_ = Buffer<std::uint32_t>(first_.back());
  for (Buffer<float>* values : {&low_x_, &low_y_, &high_x_, &high_y_, &nearest_}) {
    *values = Buffer<float>(first_.back() + kPadding);
    std::fill(values->end() - kPadding, values->end(), 0.0f);
  }
  parallel_for(plan.execution, cells_.count(), kCellsPerPart, [&](std::size_t begin, std::size_t end) {
    for (std::size_t cell = begin; cell < end; ++cell) {
      const std::span<std::uint64_t> own = entries[cell];
      std::sort(own.begin(), own.end());
      for (std::size_t i = 0, e = first_[cell]; i < own.size(); ++i, ++e) {
        const Footprint& f = plan.footprints[std::uint32_t(own[i])];
        low_x_[e] = f.low.x;
        low_y_[e] = f.low.y;
        high_x_[e] = f.high.x;
        high_y_[e] = f.high.y;
        nearest_[e] = from_ordered(std::uint32_t(own[i] >> 32));
        numbers_[e] = std::uint32_t(own[i]);
      }
    }
  });
}

OccluderGrid::Crowd OccluderGrid::largest_crowd() const {
  Crowd crowd;
  for (std::size_t cell = 0; cell < cells_.count(); ++cell)
    if (const std::size_t count = first_[cell + 1] - first_[cell]; count > crowd.count)
      crowd = {count, occluder(first_[cell]).triangle};
  return crowd;
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
      const Square square = cells_.square(cell);
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
