// SPDX-License-Identifier: Apache-2.0
// Sectors: the planes of triangles that meet at a vertex are all at one depth there, and their sides through it begin
// there. What lies before what, and beside it, is the same all along a direction, and linear between two: two points,
// one on either side of a sector, say all. Strips: their corners do.
#include "lines/hiding/slices.h"

#include <glm/gtc/constants.hpp>
#include <optional>

namespace frontmost::lines_detail {
namespace {

constexpr std::size_t kFewOccluders = 32, kFewLines = 4, kFewSlicePairs = 1 << 10;
/// Cells from the apex to the points that stand for a direction: the farther, the less CellDepth's margins matter.
constexpr double kAway = 16;

/// An occluder, and the sides that bound it where the slices are.
struct Sliced {
  CellEntry entry;
  CellDepth depth;
  bool has_side[3];
};

struct Range {
  double low, high;
};

struct Slice {
  Range range;  ///< of angles, less than half a turn; or of offsets
  std::vector<std::uint32_t> occluders;
  std::vector<Range> lines;  ///< by the middle of what each takes
};

/// Halves slices as long as lines have less to ask in the halves. `corners(range)` are points between which all of a
/// slice lies, as far as it matters.
template <class Corners>
class Slicer {
 public:
  Slicer(std::vector<Sliced> occluders, bool keeps_all, std::size_t& room, const Corners& corners)
      : occluders_(std::move(occluders)), keeps_all_(keeps_all), room_(room), corners_(corners) {}

  [[nodiscard]] Slice all(std::vector<Range> lines) const {
    Slice slice{{}, {}, std::move(lines)};
    std::sort(slice.lines.begin(), slice.lines.end(),
              [](const Range& a, const Range& b) { return a.low + a.high < b.low + b.high; });
    for (std::uint32_t i = 0; i < occluders_.size(); ++i) slice.occluders.push_back(i);
    return slice;
  }

  void divide(Slice slice) {
    if (slice.occluders.size() > kFewOccluders && slice.lines.size() > kFewLines &&
        slice.occluders.size() * slice.lines.size() > kFewSlicePairs) {
      const Range &below = slice.lines[slice.lines.size() / 2 - 1], &above = slice.lines[slice.lines.size() / 2];
      const double middle = (below.low + below.high + above.low + above.high) / 4;
      if (middle > slice.range.low && middle < slice.range.high) {
        Slice halves[2] = {part_of(slice, {slice.range.low, middle}), part_of(slice, {middle, slice.range.high})};
        const std::size_t entries = halves[0].occluders.size() + halves[1].occluders.size();
        if (entries <= slice.occluders.size() + room_ && pays(slice, halves)) {
          room_ = room_ + slice.occluders.size() - entries;
          slice = {};
          divide(std::move(halves[0]));
          divide(std::move(halves[1]));
          return;
        }
      }
    }
    begins.push_back(slice.range.low);
    cells.emplace_back();
    for (const std::uint32_t i : slice.occluders) cells.back().entries.push_back(occluders_[i].entry);
    std::sort(cells.back().entries.begin(), cells.back().entries.end());
  }

  [[nodiscard]] Slice part_of(const Slice& whole, const Range& range) const {
    Slice part{range, {}, {}};
    const std::vector<Square> corners = corners_(range);
    for (const Range& line : whole.lines)
      if (line.low <= range.high + kCellPad && line.high >= range.low - kCellPad) part.lines.push_back(line);
    std::optional<std::uint32_t> cover;
    for (const std::uint32_t i : whole.occluders) {
      if (is_beside(occluders_[i], corners)) continue;
      part.occluders.push_back(i);
      if (keeps_all_ || !covers(occluders_[i], corners)) continue;
      if (!cover || is_beyond(*cover, i, corners)) cover = i;
    }
    if (!cover) return part;
    const auto kept = std::remove_if(part.occluders.begin(), part.occluders.end(),
                                     [&](std::uint32_t i) { return is_beyond(i, *cover, corners); });
    part.occluders.erase(kept, part.occluders.end());
    return part;
  }

  std::vector<double> begins;   ///< by slice
  std::vector<FineCell> cells;  ///< by slice

 private:
  template <class Holds>
  static bool all_of(const std::vector<Square>& corners, const Holds& holds) {
    return std::all_of(corners.begin(), corners.end(), holds);
  }
  static bool is_beside(const Sliced& occluder, const std::vector<Square>& corners) {
    for (int k = 0; k < 3; ++k)
      if (occluder.has_side[k] && all_of(corners, [&](const Square& p) { return occluder.depth.is_without(k, p); }))
        return true;
    return false;
  }
  static bool covers(const Sliced& occluder, const std::vector<Square>& corners) {
    return all_of(corners, [&](const Square& p) {
      for (int k = 0; k < 3; ++k)
        if (occluder.has_side[k] && !occluder.depth.is_within(k, p)) return false;
      return true;
    });
  }
  [[nodiscard]] bool is_beyond(std::uint32_t one, std::uint32_t other, const std::vector<Square>& corners) const {
    return all_of(corners,
                  [&](const Square& p) { return occluders_[one].depth.is_beyond(occluders_[other].depth, p); });
  }
  static bool pays(const Slice& slice, const Slice (&halves)[2]) {
    const auto pairs = [](const Slice& s) { return double(s.lines.size()) * double(s.occluders.size()); };
    return pairs(halves[0]) + pairs(halves[1]) < 0.75 * pairs(slice);
  }

  const std::vector<Sliced> occluders_;
  const bool keeps_all_;
  std::size_t& room_;  ///< for what halves have in common
  const Corners corners_;
};

/// The vertex within the square at which most of the lines end, if it is half of them.
std::uint32_t apex_of(const CrowdedGrid& grid, const Crowd& crowd) {
  std::vector<std::uint32_t> ends;
  const Square& s = crowd.square;
  const auto add = [&](std::uint32_t vertex) {
    if (vertex == no_index) return;
    const glm::dvec3& p = grid.on_grid.places[vertex];
    if (p.x >= s.x && p.y >= s.y && p.x <= s.x + s.size && p.y <= s.y + s.size) ends.push_back(vertex);
  };
  for (const std::uint32_t line : crowd.lines) {
    add(grid.lines[line].from_vertex);
    add(grid.lines[line].to_vertex);
  }
  std::sort(ends.begin(), ends.end());
  std::size_t most = crowd.lines.size() / 2;
  std::uint32_t apex = no_index;
  for (std::size_t i = 0, next = 0; i < ends.size(); i = next) {
    while (next < ends.size() && ends[next] == ends[i]) ++next;
    if (next - i > most) apex = ends[i], most = next - i;
  }
  return apex;
}

/// Whether the triangle is at the vertex, with no more of it in the square than its two sides there bound.
std::optional<Sliced> wedge_of(const CrowdedGrid& grid, const CellEntry& entry, const Square& square,
                               std::uint32_t vertex) {
  const Footprint& footprint = grid.footprints[entry.footprint];
  const glm::uvec3& t = grid.on_grid.seen.mesh.triangles[footprint.triangle];
  if ((t.x != vertex && t.y != vertex && t.z != vertex) || grid.on_grid.is_near(footprint)) return std::nullopt;
  const int k = t.x == vertex ? 0 : t.y == vertex ? 1 : 2, next = (k + 1) % 3, last = (k + 2) % 3;
  const auto is_long = [&](int corner) {
    return glm::length(glm::dvec2(grid.on_grid.places[t[corner]] - grid.on_grid.places[vertex])) > Slices::reach;
  };
  Sliced wedge{entry, grid.on_grid.depth_of(footprint.triangle), {next != 0, next != 1, next != 2}};
  if (!wedge.depth.is_within(next, square) || !is_long(next) || !is_long(last)) return std::nullopt;
  return wedge;
}

/// Directions in which lines leave the apex.
std::vector<Range> angles_of(const CrowdedGrid& grid, const Crowd& crowd, std::uint32_t apex) {
  std::vector<Range> angles;
  for (const std::uint32_t number : crowd.lines) {
    const GridLine& line = grid.lines[number];
    if (line.from_vertex != apex && line.to_vertex != apex) continue;
    const glm::dvec2 along = line.from_vertex == apex ? line.to - line.from : line.from - line.to;
    const double angle = std::atan2(along.y, along.x);
    angles.push_back({angle, angle});
  }
  return angles;
}

/// The axis along which lines are longest, all in all: of the lines' squares, as complex numbers.
std::optional<glm::dvec2> main_direction(const CrowdedGrid& grid, const Crowd& crowd) {
  glm::dvec2 sum(0);
  double size = 0;
  const glm::dvec2 low(crowd.square.x, crowd.square.y);
  for (const std::uint32_t number : crowd.lines) {
    const GridLine part = within_box(grid.lines[number], low, low + crowd.square.size);
    const glm::dvec2 along = part.to - part.from;
    sum += glm::dvec2(along.x * along.x - along.y * along.y, 2 * along.x * along.y);
    size += glm::dot(along, along);
  }
  if (!(glm::length(sum) > 0.25 * size)) return std::nullopt;
  const double angle = std::atan2(sum.y, sum.x) / 2;
  return glm::dvec2(std::cos(angle), std::sin(angle));
}

/// What of a square lies between two parallel lines.
std::vector<Square> strip_corners(const Square& square, const glm::dvec2& across, const Range& range) {
  std::vector<glm::dvec2> outline = {{square.x, square.y},
                                     {square.x + square.size, square.y},
                                     {square.x + square.size, square.y + square.size},
                                     {square.x, square.y + square.size}};
  for (const double side : {1.0, -1.0}) {
    const double limit = side > 0 ? range.low : -range.high;
    std::vector<glm::dvec2> rest;
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const glm::dvec2 &p = outline[i], &q = outline[(i + 1) % outline.size()];
      const double at_p = side * glm::dot(across, p) - limit, at_q = side * glm::dot(across, q) - limit;
      if (at_p >= 0) rest.push_back(p);
      if ((at_p >= 0) != (at_q >= 0)) rest.push_back(p + (q - p) * (at_p / (at_p - at_q)));
    }
    outline = std::move(rest);
  }
  std::vector<Square> corners;
  for (const glm::dvec2& p : outline) corners.push_back({p.x, p.y, 0});
  return corners;
}

void add_slices(Slices slices, std::vector<FineCell> parts, std::uint32_t cell, FineCells& fine) {
  slices.first_cell = std::uint32_t(fine.cells.size());
  fine.cells[cell].slices = std::uint32_t(fine.slices.size());
  fine.slices.push_back(std::move(slices));
  for (FineCell& part : parts) {
    part.corner = fine.cells[cell].corner;
    fine.cells.push_back(std::move(part));
  }
}

}  // namespace

bool divide_by_sectors(const CrowdedGrid& grid, Crowd& crowd, std::uint32_t cell, FineCells& fine) {
  const std::uint32_t vertex = apex_of(grid, crowd);
  if (vertex == no_index) return false;
  std::vector<Sliced> wedges;
  FineCell all;
  std::vector<CellEntry> rest;
  for (const CellEntry& entry : crowd.entries) {
    if (const std::optional<Sliced> wedge = wedge_of(grid, entry, crowd.square, vertex)) {
      wedges.push_back(*wedge);
      all.entries.push_back(entry);
    } else {
      rest.push_back(entry);
    }
  }
  if (wedges.size() <= kFewOccluders || wedges.size() < rest.size()) return false;
  const glm::dvec2 place(grid.on_grid.places[vertex]);
  Slicer slicer(std::move(wedges), grid.keeps_all, crowd.room, [place](const Range& angles) {
    const auto at = [&](double angle) {
      return Square{place.x + kAway * std::cos(angle), place.y + kAway * std::sin(angle), 0};
    };
    return std::vector<Square>{at(angles.low), at(angles.high)};
  });
  const Slice whole = slicer.all(angles_of(grid, crowd, vertex));
  const double quarter = glm::half_pi<double>();
  for (int k = -2; k < 2; ++k) slicer.divide(slicer.part_of(whole, {k * quarter, (k + 1) * quarter}));
  fine.cells[cell].entries = std::move(rest);
  slicer.cells.push_back(std::move(all));
  add_slices({vertex, {}, 0, std::move(slicer.begins)}, std::move(slicer.cells), cell, fine);
  return true;
}

bool divide_by_strips(const CrowdedGrid& grid, Crowd& crowd, std::uint32_t cell, FineCells& fine) {
  const std::optional<glm::dvec2> along = main_direction(grid, crowd);
  if (!along) return false;
  const glm::dvec2 across(-along->y, along->x);
  const glm::dvec2 low(crowd.square.x, crowd.square.y);
  std::vector<Sliced> occluders;
  std::vector<CellEntry> rest;
  for (const CellEntry& entry : crowd.entries) {
    const Footprint& footprint = grid.footprints[entry.footprint];
    if (grid.on_grid.is_near(footprint))
      rest.push_back(entry);
    else
      occluders.push_back({entry, grid.on_grid.depth_of(footprint.triangle), {true, true, true}});
  }
  std::vector<Range> lines;
  for (const std::uint32_t number : crowd.lines) {
    const GridLine part = within_box(grid.lines[number], low, low + crowd.square.size);
    const double from = glm::dot(across, part.from), to = glm::dot(across, part.to);
    lines.push_back({std::min(from, to), std::max(from, to)});
  }
  Slicer slicer(std::move(occluders), grid.keeps_all, crowd.room,
                [&](const Range& range) { return strip_corners(crowd.square, across, range); });
  Slice whole = slicer.all(std::move(lines));
  const glm::dvec2 middle = low + crowd.square.size / 2;
  const double reach = crowd.square.size * (std::abs(across.x) + std::abs(across.y)) / 2 + 2 * kCellPad;
  whole.range = {glm::dot(across, middle) - reach, glm::dot(across, middle) + reach};
  slicer.divide(std::move(whole));
  if (slicer.cells.size() == 1) return false;
  fine.cells[cell].entries = std::move(rest);
  add_slices({no_index, across, 0, std::move(slicer.begins)}, std::move(slicer.cells), cell, fine);
  return true;
}

}  // namespace frontmost::lines_detail
