// SPDX-License-Identifier: Apache-2.0
#include "lines/hiding/fine_cells.h"

#include <array>
#include <limits>

#include "base/parallel.h"
#include "lines/hiding/slices.h"

namespace frontmost::lines_detail {
namespace {

/// Cells with so few occluders, or so few pairs of them and lines, are not worth dividing.
constexpr std::size_t kFew = 64, kFewCellPairs = 1 << 14;
/// The smallest part is 2^-14 of a cell: still very much larger than kCellPad.
constexpr int kDeepest = 7;
constexpr std::size_t kEntriesPerPoll = 1 << 13;
/// What visiting a cell costs, counted in occluders that are asked there.
constexpr double kVisit = 128;

class CellDivider {
 public:
  CellDivider(const CrowdedGrid& grid, const Execution& execution) : grid_(grid), execution_(execution) {}

  void divide(std::uint32_t cell, Crowd crowd, int depth) {
    check_cancelled(execution_);
    fine.cells[cell].corner = {crowd.square.x, crowd.square.y};
    std::sort(crowd.entries.begin(), crowd.entries.end());
    if (crowd.entries.size() > kFew && pairs(crowd) > kFewCellPairs &&
        (divide_by_sectors(grid_, crowd, cell, fine) || divide_by_parts(cell, crowd, depth) ||
         divide_by_strips(grid_, crowd, cell, fine)))
      return;
    fine.cells[cell].entries = std::move(crowd.entries);
  }

  FineCells fine;

 private:
  struct Parts {
    Division division;
    std::array<Crowd, Division::count> of;
  };

  bool divide_by_parts(std::uint32_t cell, Crowd& crowd, int depth) {
    if (depth == kDeepest) return false;
    Parts parts = parts_of(crowd);
    const std::size_t entries = entries_of(parts);
    if (entries > crowd.entries.size() + crowd.room || !pays(crowd, parts)) return false;
    share_room(crowd, entries, parts);
    crowd = {};
    const auto first = std::uint32_t(fine.cells.size());
    parts.division.first_cell = first;
    fine.cells[cell].division = std::uint32_t(fine.divisions.size());
    fine.divisions.push_back(parts.division);
    fine.cells.resize(first + Division::count);
    for (std::uint32_t i = 0; i < Division::count; ++i) divide(first + i, std::move(parts.of[i]), depth + 1);
    return true;
  }

  [[nodiscard]] Parts parts_of(const Crowd& crowd) const {
    const double size = crowd.square.size / Division::side;
    Parts parts{{{crowd.square.x, crowd.square.y, size}, 0}, {}};
    for (int y = 0; y < Division::side; ++y)
      for (int x = 0; x < Division::side; ++x)
        parts.of[std::size_t(y * Division::side + x)].square = parts.division.at(x, y);
    add_entries(crowd, parts);
    for (std::size_t i = 0; i < crowd.lines.size(); ++i) {
      if (i % kEntriesPerPoll == 0) check_cancelled(execution_);
      const std::uint32_t line = crowd.lines[i];
      visit_parts(parts.division, grid_.lines[line].from, grid_.lines[line].to,
                  [&](int x, int y, const glm::dvec2&, const glm::dvec2&) {
                    parts.of[std::size_t(y * Division::side + x)].lines.push_back(line);
                    return true;
                  });
    }
    return parts;
  }

  /// What covers a part whole: a triangle by its number among the crowd's entries.
  struct Cover {
    float farthest = std::numeric_limits<float>::infinity();
    std::size_t entry = 0;
  };

  void add_entries(const Crowd& crowd, Parts& parts) const {
    std::vector<CellDepth> depths;
    std::array<std::vector<std::size_t>, Division::count> numbers;
    std::array<Cover, Division::count> covers;
    for (std::size_t e = 0; e < crowd.entries.size(); ++e) {
      if (e % kEntriesPerPoll == 0) check_cancelled(execution_);
      // All that follow are beyond what covers each part.
      const auto is_beyond = [&](const Cover& cover) { return crowd.entries[e].nearest > cover.farthest; };
      if (e % kFew == 0 && std::all_of(covers.begin(), covers.end(), is_beyond)) break;
      const Footprint& footprint = grid_.footprints[crowd.entries[e].footprint];
      depths.push_back(grid_.on_grid.depth_of(footprint.triangle));
      visit_parts_of(parts.division, footprint, [&](std::size_t part) {
        const Square& square = parts.of[part].square;
        const CellDepth& depth = depths.back();
        const bool is_near = grid_.on_grid.is_near(footprint);
        if (!is_near && depth.is_beside(square)) return;
        const float nearest =
            is_near ? footprint.nearest : std::max(footprint.nearest, rounded_down(depth.nearest(square)));
        Cover& cover = covers[part];
        if (nearest > cover.farthest) return;
        numbers[part].push_back(e);
        parts.of[part].entries.push_back({nearest, crowd.entries[e].footprint});
        if (grid_.keeps_all || is_near || !depth.covers(square)) return;
        const float farthest = rounded_up(depth.farthest(square));
        if (farthest < cover.farthest) cover = {farthest, e};
      });
    }
    for (std::size_t part = 0; part < Division::count; ++part)
      if (covers[part].farthest < std::numeric_limits<float>::infinity())
        leave_beyond(depths, numbers[part], covers[part], parts.of[part]);
  }

  /// Leaves out what lies beyond the part's cover: by its distances, or by its plane.
  void leave_beyond(const std::vector<CellDepth>& depths, const std::vector<std::size_t>& numbers, const Cover& cover,
                    Crowd& part) const {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      const Footprint& footprint = grid_.footprints[part.entries[i].footprint];
      if (part.entries[i].nearest > cover.farthest) continue;
      if (!grid_.on_grid.is_near(footprint) && depths[numbers[i]].is_beyond(depths[cover.entry], part.square)) continue;
      part.entries[kept++] = part.entries[i];
    }
    part.entries.resize(kept);
  }

  template <class Visitor>
  static void visit_parts_of(const Division& division, const Footprint& footprint, const Visitor& visit) {
    const auto part = [&](double place, double corner) {
      return int(std::clamp(std::floor((place - corner) / division.part.size), -1.0, double(Division::side)));
    };
    const int first_x = std::max(part(footprint.low.x - kCellPad, division.part.x), 0),
              last_x = std::min(part(footprint.high.x + kCellPad, division.part.x), Division::side - 1),
              first_y = std::max(part(footprint.low.y - kCellPad, division.part.y), 0),
              last_y = std::min(part(footprint.high.y + kCellPad, division.part.y), Division::side - 1);
    for (int y = first_y; y <= last_y; ++y)
      for (int x = first_x; x <= last_x; ++x) visit(std::size_t(y * Division::side + x));
  }

  /// Whether lines ask less in the parts: in all of them, or in all but one, which may be divided again. Lines side by
  /// side have as many neighbours in small squares as in large ones.
  static bool pays(const Crowd& crowd, const Parts& parts) {
    const auto cost = [](const Crowd& c) { return double(c.lines.size()) * (double(c.entries.size()) + kVisit); };
    double sum = 0, most = 0;
    for (const Crowd& part : parts.of) {
      sum += cost(part);
      most = std::max(most, cost(part));
    }
    return sum < 0.75 * cost(crowd) || sum - most < 0.5 * cost(crowd);
  }
  /// What is left of it, by what there is to gain.
  static void share_room(const Crowd& crowd, std::size_t entries, Parts& parts) {
    double sum = 1;
    for (const Crowd& part : parts.of) sum += pairs(part);
    const auto rest = double(crowd.room + crowd.entries.size() - entries);
    for (Crowd& part : parts.of) part.room = std::size_t(rest * (pairs(part) / sum));
  }
  static double pairs(const Crowd& c) { return double(c.lines.size()) * double(c.entries.size()); }
  static std::size_t entries_of(const Parts& parts) {
    std::size_t sum = 0;
    for (const Crowd& part : parts.of) sum += part.entries.size();
    return sum;
  }

  const CrowdedGrid& grid_;
  const Execution& execution_;
};

}  // namespace

FineCells divide(const CrowdedGrid& grid, Crowd crowd, const Execution& execution) {
  CellDivider divider(grid, execution);
  divider.fine.cells.resize(1);
  divider.divide(0, std::move(crowd), 0);
  return std::move(divider.fine);
}

}  // namespace frontmost::lines_detail
