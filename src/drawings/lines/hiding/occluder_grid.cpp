// SPDX-License-Identifier: Apache-2.0
// The grid is first made as fine as the number of triangles suggests, and then coarser until large triangles fit.
//
//    small: all cells of its box      large: row by row, from its left side to its right
//    |##|##|  |                       |  |  |##|  |  |
//    |##|##|  |                       |  |##|##|##|  |      each cell with the least distance of the triangle
//    +--+--+--+                       |##|##|##|##|##|      within it
//
// Places are rounded outwards to floats, and comparisons of places in cells have a pad far above the rounding error.
#include <atomic>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "base/memory.h"
#include "base/parallel.h"
#include "geometry/buckets.h"
#include "lines/hiding/hidden_parts.h"
#include "lines/lists.h"
#include "surfaces/radix_sort.h"

namespace frontmost::lines_detail {
namespace {

/// The largest coordinate, in units of cells, at which rounding cannot matter.
constexpr double kFarthest = 1e5;
/// The largest ratios of length to width at which rounding cannot matter: for a triangle's plane, and for its sides.
constexpr double kThinnest = 1e4, kThinnestSide = 1e9;
/// Margins relative to the values, far above the rounding error of a place in the picture.
constexpr double kDepthSlack = 1e-9, kSideSlack = 1e-5, kFloatSlack = 1e-6;

/// Triangles per cell. Sixteen boxes are tested at once; with 4 a terrain of a million triangles takes a third longer.
constexpr double kTrianglesPerCell = 32;
constexpr double kMostCells = 1 << 22;
/// The most entries per triangle in the mean, and the most entries of all triangles; both limits bound memory.
constexpr double kEntriesPerTriangle = 16, kMostEntries = 4e9;
constexpr std::size_t kCornersPerPart = 4096, kSeenPerPart = 1024;
/// How far ahead triangles at random addresses are prefetched.
constexpr std::size_t kFetchedAhead = 16;
constexpr double infinite = std::numeric_limits<double>::infinity();

/// Moved outwards by the greatest rounding error of a corner, even far outside of the picture.
double widened(double value, double direction) { return value + direction * 1e-9 * (1 + std::abs(value)); }

}  // namespace

/// Bounds on a triangle's distance and sides that hold in spite of rounding. The triangle lies wholly beyond the near
/// plane.
class CellDepth {
 public:
  /// Places have x and y in units of cells, and the planar distance as z. In perspective, the inverse of z is linear on
  /// the screen.
  CellDepth(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, bool is_parallel)
      : low_(std::min({a.z, b.z, c.z})), high_(std::max({a.z, b.z, c.z})), is_parallel_(is_parallel) {
    const glm::dvec3 corners[3] = {a, b, c};
    double most = 0, reach = 0;
    for (const glm::dvec3& p : corners) {
      most = std::max({most, std::abs(p.x), std::abs(p.y)});
      reach = std::max({reach, std::abs(p.x - a.x), std::abs(p.y - a.y)});
    }
    const double turn = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    const double thin = reach * reach / std::abs(turn);
    if (!(most < kFarthest && thin < kThinnestSide) || (!is_parallel && !(low_ > 0))) return;
    has_sides_ = true;
    const double sign = turn > 0 ? 1 : -1;
    for (int k = 0; k < 3; ++k) {
      const glm::dvec3 &p = corners[k], &q = corners[k == 2 ? 0 : k + 1];
      const double x = (q.x - p.x) * sign, y = (q.y - p.y) * sign;
      sides_[k] = {y * p.x - x * p.y, -y, x, kSideSlack * (std::abs(x) + std::abs(y))};
    }
    if (!(thin < kThinnest)) return;
    has_plane_ = true;
    const auto value = [&](double distance) { return is_parallel ? distance : 1 / distance; };
    const double at_a = value(a.z), along_b = value(b.z) - at_a, along_c = value(c.z) - at_a;
    linear_.by_x = (along_b * (c.y - a.y) - along_c * (b.y - a.y)) / turn;
    linear_.by_y = (along_c * (b.x - a.x) - along_b * (c.x - a.x)) / turn;
    linear_.at_0 = at_a - linear_.by_x * a.x - linear_.by_y * a.y;
    // An error in a place turns the plane, more for smaller triangles, and it may be evaluated far from the triangle.
    linear_.slack = kDepthSlack * (1 + thin) *
                    (std::max(std::abs(value(low_)), std::abs(value(high_))) +
                     (std::abs(linear_.by_x) + std::abs(linear_.by_y)) * (most * 1e-3 + 0.1 / reach));
  }

  /// A lower bound on the triangle's distance within a square; farthest(): an upper bound.
  [[nodiscard]] double nearest(const Square& square) const {
    if (!has_plane_) return low_;
    const double value = linear_.at(square, is_parallel_ ? -1 : 1);
    return std::clamp(is_parallel_ ? value : 1 / value, low_, high_);
  }

  [[nodiscard]] double farthest(const Square& square) const {
    if (!has_plane_) return high_;
    const double value = linear_.at(square, is_parallel_ ? 1 : -1);
    if (is_parallel_) return std::clamp(value, low_, high_);
    return value > 0 ? std::clamp(1 / value, low_, high_) : high_;
  }

  /// Cells of a row; none if first > last.
  struct Columns {
    int first, last;
  };

  /// The cells of row y, among `all`, that the triangle covers whole.
  [[nodiscard]] Columns covered(int y, Columns all) const {
    if (!has_sides_) return {1, 0};
    for (const Linear& side : sides_) {
      const double base = side.at_0 + side.by_y * (y + double(side.by_y < 0)) - side.slack;
      const auto column = [&](double x) { return int(std::clamp(x, all.first - 2.0, all.last + 2.0)); };
      if (side.by_x > 0)
        all.first = std::max(all.first, column(std::ceil(-base / side.by_x)));
      else if (side.by_x < 0)
        all.last = std::min(all.last, column(std::floor(base / -side.by_x) - 1));
      else if (base < 0)
        return {1, 0};
      if (all.first > all.last) return {1, 0};
    }
    return all;
  }

  /// The function a * x + b * y + c of a point in units of cells, relative to a square's corner. Where it is negative,
  /// the point is certainly outside of a side.
  struct Side {
    float a, b, c;
  };
  static constexpr Side nowhere_outside{0, 0, std::numeric_limits<float>::infinity()};

  [[nodiscard]] Side side(int k, const glm::dvec2& corner) const {
    const Linear& side = sides_[k];
    const double size = std::abs(side.by_x) + std::abs(side.by_y);
    if (!has_sides_ || !(size > 0)) return nowhere_outside;
    return {float(side.by_x / size), float(side.by_y / size),
            float((side.at_0 + side.by_x * corner.x + side.by_y * corner.y) / size + 2 * kSideSlack)};
  }

  /// An upper bound on the plane's nearness() within a cell, in the same form; `corner` is the cell's corner.
  [[nodiscard]] Side plane(const glm::dvec2& corner) const {
    if (!has_plane_) return nowhere_outside;
    const double sign = is_parallel_ ? -1 : 1;
    const double size = std::max(std::abs(nearness(low_, is_parallel_)), std::abs(nearness(high_, is_parallel_)));
    const double at = sign * (linear_.at_0 + linear_.by_x * corner.x + linear_.by_y * corner.y) + linear_.slack;
    const double spread = std::abs(at) + std::abs(linear_.by_x) + std::abs(linear_.by_y);
    return {float(sign * linear_.by_x), float(sign * linear_.by_y), float(at + kFloatSlack * (size + spread))};
  }

 private:
  /// A function that is linear over the grid.
  struct Linear {
    double at_0 = 0, by_x = 0, by_y = 0, slack = 0;
    /// The maximum (side 1) or minimum (side -1) within a square.
    [[nodiscard]] double at(const Square& s, int side) const {
      const double corner_x = s.x + (by_x * side > 0 ? s.size : 0), corner_y = s.y + (by_y * side > 0 ? s.size : 0);
      return at_0 + by_x * corner_x + by_y * corner_y + side * slack;
    }
  };

  Linear linear_, sides_[3];  ///< the functions of the sides are positive inside
  double low_, high_;         ///< least and greatest distance of a vertex
  bool is_parallel_;
  bool has_sides_ = false, has_plane_ = false;  ///< false if the triangle is seen almost edge-on or reaches too far
};

/// A float that is at most `value`, and smaller by at most 2^-22 of its size, in every rounding mode.
inline float rounded_down(double value) { return float(value - std::abs(value) * 2e-7); }
inline float rounded_up(double value) { return -rounded_down(-value); }

/// A triangle's box in cells; `nearest` is infinite for triangles that are not seen.
struct Footprint {
  glm::vec2 low, high;
  float nearest;
  std::uint32_t triangle;
};

/// The columns and rows of cells that a box touches.
struct CellRange {
  int first_column, last_column, first_row, last_row;
  /// Whether some of these cells may lie outside of the triangle.
  [[nodiscard]] bool is_large() const { return last_row - first_row >= 2 && last_column > first_column; }
};

class GridPlan {
 public:
  /// Keeps references to its arguments. O(triangles).
  GridPlan(const SeenMesh& its_seen, const View& view, bool all, const Execution& its_execution)
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

  const SeenMesh& seen;
  const Sight sight;
  const bool keeps_all;  ///< as for OccluderGrid
  const Execution& execution;
  SquareGrid grid;                   ///< over the picture, with squares of size 1
  double scale = 1;                  ///< cells per pixel
  Buffer<Footprint> footprints;      ///< footprints of visible triangles, in the order of their first cells
  Buffer<CellRange> ranges;          ///< cells of each footprint
  Buffer<Occluder> occluders;        ///< occluder of each footprint
  std::vector<std::uint32_t> large;  ///< indices of footprints whose ranges are large

  [[nodiscard]] CellDepth depth_of(std::uint32_t triangle) const {
    const glm::uvec3& t = seen.mesh.triangles[triangle];
    return {places_[t.x], places_[t.y], places_[t.z], sight.is_parallel()};
  }
  /// Whether a part of the triangle may lie before the near plane.
  [[nodiscard]] bool is_near(const Footprint& footprint) const {
    return double(footprint.nearest) <= sight.near() + 1e-6 * std::abs(sight.near());
  }
  /// Calls visit(cell, nearest) for every cell that the footprint's triangle may touch, with the triangle's least
  /// distance in that cell.
  template <class Visitor>
  void visit_cells(std::size_t number, const Visitor& visit) const {
    const CellRange& all = ranges[number];
    const Footprint& footprint = footprints[number];
    if (all.is_large()) return visit_rows(footprint, all, visit);
    for (int y = all.first_row; y <= all.last_row; ++y)
      for (int x = all.first_column; x <= all.last_column; ++x) visit(grid.number(x, y), footprint.nearest);
  }

 private:
  /// The part of a triangle beyond the near plane, as a polygon in units of cells.
  struct Outline {
    std::array<glm::dvec2, 5> corners;
    int count = 0;
    double nearest = infinite;
    glm::dvec2 low{infinite}, high{-infinite};
  };
  /// The left and right ends, in cells; empty if left > right.
  struct Span {
    double left, right;
  };

  /// Sets the resolution to about `cells` cells, and computes the places of vertices and the footprints.
  void set_cells(const View& view, double cells) {
    const double size = std::sqrt(double(view.width) * view.height / cells);
    grid.columns = std::max(1, int(std::ceil(view.width / size)));
    grid.rows = std::max(1, int(std::ceil(view.height / size)));
    scale = 1 / size;
    const Positions& positions = seen.mesh.positions;
    parallel_for(execution, positions.size(), kCornersPerPart, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) {
        const glm::dvec3 p = sight.to_screen(sight.in_eye(positions[v]));
        places_[v] = {p.x * scale, p.y * scale, p.z};
      }
    });
    // In the order of first cells, neighbours on the screen are neighbours in memory.
    const std::size_t count = seen.mesh.triangles.size(), cell_count = grid.count();
    Buffer<Footprint> all(count);
    Buffer<std::uint64_t> keys(count);  // the first cell, then the triangle
    parallel_for(execution, count, kCornersPerPart, [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t) {
        all[t] = footprint_of(std::uint32_t(t));
        const bool is_seen = all[t].nearest < std::numeric_limits<float>::infinity();
        const std::size_t cell = is_seen ? grid.number(column(all[t].low.x), row(all[t].low.y)) : cell_count;
        keys[t] = std::uint64_t(cell) << 32 | t;
      }
    });
    keys = radix_sort(std::move(keys), std::bit_width(cell_count), execution);
    const auto held =
        std::size_t(std::lower_bound(keys.begin(), keys.end(), std::uint64_t(cell_count) << 32) - keys.begin());
    footprints = Buffer<Footprint>(held);
    ranges = Buffer<CellRange>(held);
    occluders = Buffer<Occluder>(held);
    std::vector<double> sums((held + kSeenPerPart - 1) / kSeenPerPart);
    std::vector<std::vector<std::uint32_t>> found(sums.size());
    parallel_for(execution, held, kSeenPerPart, [&](std::size_t begin, std::size_t end) {
      double sum = 0;
      std::vector<std::uint32_t> large_ones;
      for (std::size_t i = begin; i < end; ++i) {
        const std::uint32_t ahead = std::uint32_t(keys[std::min(i + kFetchedAhead, held - 1)]);
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

  [[nodiscard]] Footprint footprint_of(std::uint32_t triangle) const {
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
      low = glm::dvec3(outline.low, 0);
      high = glm::dvec3(outline.high, 0);
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

  [[nodiscard]] CellRange range_of(const Footprint& footprint) const {
    return {column(footprint.low.x - kCellPad), column(footprint.high.x + kCellPad), row(footprint.low.y - kCellPad),
            row(footprint.high.y + kCellPad)};
  }

  [[nodiscard]] Outline outline_of(std::uint32_t triangle) const {
    const glm::uvec3& corners = seen.mesh.triangles[triangle];
    const double near = sight.near();
    Outline outline;
    const auto add = [&](const glm::dvec2& place, double distance) {
      outline.corners[std::size_t(outline.count++)] = place;
      outline.nearest = std::min(outline.nearest, widened(distance, -1));
      outline.low = glm::min(outline.low, place);
      outline.high = glm::max(outline.high, place);
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

  [[nodiscard]] Occluder occluder_of(const Footprint& footprint) const {
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
    const Buffer<glm::vec3>& at = seen.mesh.positions.places;
    return {{at[v.x], at[v.y], at[v.z]}, {v.x, v.y, v.z}, turn, footprint.triangle, is_near(footprint)};
  }

  /// An upper bound on the number of cells that the footprint takes.
  [[nodiscard]] double entries_of(const Footprint& footprint, const CellRange& range) const {
    const double columns = range.last_column - range.first_column + 1, rows = range.last_row - range.first_row + 1;
    if (!range.is_large()) return columns * rows;
    const glm::uvec3& t = seen.mesh.triangles[footprint.triangle];
    const glm::dvec3 &a = places_[t.x], &b = places_[t.y], &c = places_[t.z];
    if (!(std::min({a.z, b.z, c.z}) > sight.near())) return columns * rows;
    const double area = std::abs((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)) / 2;
    return std::min(columns * rows, area + 2 * (columns + rows));
  }

  /// The horizontal extent of the outline within a row of cells.
  [[nodiscard]] static Span within_row(const Outline& outline, int row) {
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

  [[nodiscard]] int column(double x) const { return int(std::clamp(x, 0.0, double(grid.columns - 1))); }
  [[nodiscard]] int row(double y) const { return int(std::clamp(y, 0.0, double(grid.rows - 1))); }

  /// Visits the cells that the outline touches, row by row.
  template <class Visitor>
  void visit_rows(const Footprint& footprint, const CellRange& all, const Visitor& visit) const {
    const Outline outline = outline_of(footprint.triangle);
    const CellDepth depth = depth_of(footprint.triangle);
    for (int y = all.first_row; y <= all.last_row; ++y) {
      const Span span = within_row(outline, y);
      const int last = column(std::min(double(footprint.high.x), span.right) + kCellPad);
      for (int x = column(std::max(double(footprint.low.x), span.left) - kCellPad); x <= last; ++x)
        visit(grid.number(x, y), std::max(footprint.nearest, rounded_down(depth.nearest(grid.square(x, y)))));
    }
  }

  Buffer<glm::dvec3> places_;  ///< by vertex: x and y in cells, z the planar distance
  double entries_ = 0;         ///< an upper bound on the cells that all footprints take
};

namespace {

constexpr std::size_t kCellsPerPart = 32, kLargePerPart = 64;
/// The kernels may read whole vectors of values beyond the last entry.
constexpr std::size_t kPadding = 64;

/// An integer that sorts like the float.
std::uint32_t ordered(float value) {
  const auto bits = bits_as<std::uint32_t>(value);
  return bits & 0x80000000u ? ~bits : bits | 0x80000000u;
}

float from_ordered(std::uint32_t order) { return bits_as<float>(order & 0x80000000u ? order & 0x7FFFFFFFu : ~order); }

/// Sets `least` to the minimum of itself and `value`.
void lower(std::atomic<float>& least, float value) {
  float held = least.load(std::memory_order_relaxed);
  while (value < held && !least.compare_exchange_weak(held, value, std::memory_order_relaxed)) {
  }
}

/// By cell: an upper bound on the distance of the nearest triangle that covers the cell whole and hides all beyond it.
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
      const glm::dvec2 corner(cells_.square(cell).x, cells_.square(cell).y);
      for (std::size_t i = 0; i < first_[cell + 1] - first_[cell]; ++i) {
        const Footprint& footprint = plan.footprints[numbers_[first_[cell] + i]];
        std::optional<CellDepth> depth;
        if (!plan.is_near(footprint)) depth = plan.depth_of(footprint.triangle);
        for (int k = 0; k < ScreenSides::count; ++k) {
          const CellDepth::Side side = !depth  ? CellDepth::nowhere_outside
                                       : k < 3 ? depth->side(k, corner)
                                               : depth->plane(corner);
          sides_[3 * k][first_side_[cell] + i] = side.a;
          sides_[3 * k + 1][first_side_[cell] + i] = side.b;
          sides_[3 * k + 2][first_side_[cell] + i] = side.c;
        }
      }
    }
  });
}

}  // namespace frontmost::lines_detail
