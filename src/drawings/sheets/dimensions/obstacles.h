// SPDX-License-Identifier: Apache-2.0
// The lines and texts on a page, to find free places for more text.
//
//    +----+----+----+----+      Cells are about as large as a number. Lines are cut into pieces of about a cell, arcs
//    |  __|____|___ |    |      into chords. Texts are few and are tested one by one.
//    | /  | 50 |   \|    |
//    +----+----+----+----+
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "pages/formats.h"
#include "sheets/dimensions/dimensions.h"

namespace frontmost::detail {

/// A straight line on the page.
struct PageSegment {
  glm::dvec2 from, to;
};

class Obstacles {
 public:
  explicit Obstacles(const PageBox& area) : area_(area) {
    const glm::dvec2 size = glm::max(area.high - area.low, glm::dvec2(1));
    cells_ = glm::clamp(glm::ivec2(glm::min(glm::ceil(size / cell_side), glm::dvec2(most_cells))), 1, most_cells);
    cell_size_ = size / glm::dvec2(cells_);
    segments_in_.resize(std::size_t(cells_.x) * std::size_t(cells_.y));
  }

  void add(const PageSegment& segment) {
    // A segment is added in steps, so that a long one does not fill all cells of the box around it.
    const double length = glm::distance(segment.from, segment.to);
    const int steps = int(std::clamp(std::ceil(length / cell_side), 1.0, 1.0 * most_cells));
    for (int i = 0; i < steps; ++i) {
      const PageSegment part{glm::mix(segment.from, segment.to, double(i) / steps),
                             glm::mix(segment.from, segment.to, double(i + 1) / steps)};
      const auto number = std::uint32_t(segments_.size());
      segments_.push_back(part);
      visit_cells(box_of(part), [&](std::size_t at) { segments_in_[at].push_back(number); });
    }
  }

  /// Adds a text: no line may cross it, and no text may touch it.
  void add(const PageBox& text) { texts_.push_back(text); }

  /// Adds the strokes and centre lines of a view, arcs as chords.
  void add(const SheetView& view) {
    constexpr double chord = 0.3;  // radians
    const auto add_join = [&](const glm::dvec2& from, const glm::dvec2& to, double bulge) {
      const std::optional<Arc> arc = arc_between(from, to, bulge);
      if (!arc) return add(PageSegment{from, to});
      const int count = int(std::ceil(std::abs(arc->turn) / chord));
      glm::dvec2 last = from;
      for (int i = 1; i <= count; ++i) {
        const double angle = arc->begin + arc->turn * i / count;
        const glm::dvec2 next = arc->centre + arc->radius * glm::dvec2(std::cos(angle), std::sin(angle));
        add(PageSegment{last, next});
        last = next;
      }
    };
    const Strokes& all = view.strokes;
    for (const Stroke& stroke : all.strokes)
      for (std::uint32_t i = 0; i + (stroke.is_closed ? 0 : 1) < stroke.count; ++i) {
        const std::uint32_t at = stroke.first + i, next = stroke.first + (i + 1) % stroke.count;
        add_join(view.on_page(all.points[at]), view.on_page(all.points[next]), all.bulges.empty() ? 0 : all.bulges[at]);
      }
    for (const CentreLine& line : view.centre_lines) add(PageSegment{view.on_page(line.from), view.on_page(line.to)});
  }

  /// Whether the box lies in the area and touches nothing.
  [[nodiscard]] bool is_free(const PageBox& box) const {
    if (!is_on_page(box)) return false;
    for (const PageBox& text : texts_)
      if (overlap(text, box)) return false;
    bool is_free = true;
    visit_cells(box, [&](std::size_t cell) {
      for (const std::uint32_t s : segments_in_[cell]) is_free = is_free && !meet(segments_[s], box);
    });
    return is_free;
  }

  /// The number of lines that the segment crosses; 1000 more if it leaves the area or touches a text.
  [[nodiscard]] int crossings(const PageSegment& segment) const {
    constexpr int out = 1000;
    const PageBox box = box_of(segment);
    int count = 0;
    if (!is_on_page(box)) count += out;
    for (const PageBox& text : texts_) count += meet(segment, text) ? out : 0;
    std::vector<std::uint32_t> near;
    visit_cells(
        box, [&](std::size_t cell) { near.insert(near.end(), segments_in_[cell].begin(), segments_in_[cell].end()); });
    std::sort(near.begin(), near.end());
    near.erase(std::unique(near.begin(), near.end()), near.end());
    for (const std::uint32_t s : near) count += cross_inside(segment, segments_[s]);
    return count;
  }

  /// Whether a line for which `is_wanted` is true passes through the cells of a box.
  template <class IsWanted>
  [[nodiscard]] bool has_line(const PageBox& box, const IsWanted& is_wanted) const {
    bool has = false;
    visit_cells(box, [&](std::size_t cell) {
      for (const std::uint32_t s : segments_in_[cell]) has = has || is_wanted(segments_[s]);
    });
    return has;
  }

 private:
  static constexpr double cell_side = 4;  ///< millimetres, about the size of a text
  static constexpr int most_cells = 512;  ///< along one side

  [[nodiscard]] bool is_on_page(const PageBox& box) const {
    return glm::all(glm::greaterThanEqual(box.low, area_.low)) && glm::all(glm::lessThanEqual(box.high, area_.high));
  }

  [[nodiscard]] static double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

  [[nodiscard]] static PageBox box_of(const PageSegment& s) { return {glm::min(s.from, s.to), glm::max(s.from, s.to)}; }

  [[nodiscard]] static bool overlap(const PageBox& a, const PageBox& b) {
    return a.low.x <= b.high.x && b.low.x <= a.high.x && a.low.y <= b.high.y && b.low.y <= a.high.y;
  }

  [[nodiscard]] static bool meet(const PageSegment& s, const PageBox& box) {
    if (!overlap(box_of(s), box)) return false;
    const glm::dvec2 along = s.to - s.from;
    int above = 0, below = 0;
    for (const glm::dvec2 corner :
         {box.low, glm::dvec2(box.low.x, box.high.y), glm::dvec2(box.high.x, box.low.y), box.high}) {
      const double side = cross(along, corner - s.from);
      above += side >= 0;
      below += side <= 0;
    }
    return above > 0 && below > 0;
  }

  [[nodiscard]] static bool cross_inside(const PageSegment& a, const PageSegment& b) {
    const glm::dvec2 u = a.to - a.from, v = b.to - b.from;
    return cross(u, b.from - a.from) * cross(u, b.to - a.from) < 0 &&
           cross(v, a.from - b.from) * cross(v, a.to - b.from) < 0;
  }

  /// Visits the cells that a box touches. Cells at the border also contain everything beyond the border.
  template <class Visit>
  void visit_cells(const PageBox& box, const Visit& visit) const {
    const auto cell = [&](const glm::dvec2& at) {
      return glm::ivec2(glm::clamp((at - area_.low) / cell_size_, glm::dvec2(0), glm::dvec2(cells_ - 1)));
    };
    const glm::ivec2 low = cell(box.low), high = cell(box.high);
    for (int y = low.y; y <= high.y; ++y)
      for (int x = low.x; x <= high.x; ++x) visit(std::size_t(y) * std::size_t(cells_.x) + std::size_t(x));
  }

  const PageBox area_;
  glm::ivec2 cells_;
  glm::dvec2 cell_size_;
  std::vector<PageSegment> segments_;
  std::vector<PageBox> texts_;
  std::vector<std::vector<std::uint32_t>> segments_in_;  ///< by cell
};

}  // namespace frontmost::detail
