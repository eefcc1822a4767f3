// SPDX-License-Identifier: Apache-2.0
// Lines are cut into pieces of about a cell, arcs into chords, and each piece is listed in the cells that its box
// touches. A box for a number then queries a few cells. Texts are few and are tested one by one.
#include "sheets/dimensions/obstacles.h"

#include <algorithm>
#include <cmath>

#include "pages/arc.h"

namespace frontmost::detail {
namespace {

constexpr double cell_side = 4;  // millimetres, about the size of a text
constexpr int most_cells = 512;  // along one side

double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

PageBox box_of(const PageSegment& s) { return {glm::min(s.from, s.to), glm::max(s.from, s.to)}; }

bool overlap(const PageBox& a, const PageBox& b) {
  return a.low.x <= b.high.x && b.low.x <= a.high.x && a.low.y <= b.high.y && b.low.y <= a.high.y;
}

bool meet(const PageSegment& s, const PageBox& box) {
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

bool cut(const PageSegment& a, const PageSegment& b) {
  const glm::dvec2 u = a.to - a.from, v = b.to - b.from;
  return cross(u, b.from - a.from) * cross(u, b.to - a.from) < 0 &&
         cross(v, a.from - b.from) * cross(v, a.to - b.from) < 0;
}

}  // namespace

Obstacles::Obstacles(const PageBox& area) : area_(area) {
  const glm::dvec2 size = glm::max(area.high - area.low, glm::dvec2(1));
  cells_ = glm::clamp(glm::ivec2(glm::min(glm::ceil(size / cell_side), glm::dvec2(most_cells))), 1, most_cells);
  cell_size_ = size / glm::dvec2(cells_);
  segments_in_.resize(std::size_t(cells_.x) * std::size_t(cells_.y));
}

/// Visits the cells that a box touches. Cells at the border also hold everything beyond it.
template <class Visit>
void Obstacles::visit_cells(const PageBox& box, const Visit& visit) const {
  const auto cell = [&](const glm::dvec2& at) {
    return glm::ivec2(glm::clamp((at - area_.low) / cell_size_, glm::dvec2(0), glm::dvec2(cells_ - 1)));
  };
  const glm::ivec2 low = cell(box.low), high = cell(box.high);
  for (int y = low.y; y <= high.y; ++y)
    for (int x = low.x; x <= high.x; ++x) visit(std::size_t(y) * std::size_t(cells_.x) + std::size_t(x));
}

void Obstacles::add(const PageSegment& segment) {
  // In steps, so that a long segment does not fill the box around it.
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

void Obstacles::add(const PageBox& text) { texts_.push_back(text); }

void Obstacles::add(const SheetView& view) {
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

bool Obstacles::is_free(const PageBox& box) const {
  if (!(box.low.x >= area_.low.x && box.low.y >= area_.low.y && box.high.x <= area_.high.x &&
        box.high.y <= area_.high.y))
    return false;
  for (const PageBox& text : texts_)
    if (overlap(text, box)) return false;
  bool is_free = true;
  visit_cells(box, [&](std::size_t cell) {
    for (const std::uint32_t s : segments_in_[cell]) is_free = is_free && !meet(segments_[s], box);
  });
  return is_free;
}

int Obstacles::crossings(const PageSegment& segment) const {
  constexpr int out = 1000;
  const PageBox box = box_of(segment);
  int count = 0;
  if (!(box.low.x >= area_.low.x && box.low.y >= area_.low.y && box.high.x <= area_.high.x &&
        box.high.y <= area_.high.y))
    count += out;
  for (const PageBox& text : texts_) count += meet(segment, text) ? out : 0;
  std::vector<std::uint32_t> near;
  visit_cells(box,
              [&](std::size_t cell) { near.insert(near.end(), segments_in_[cell].begin(), segments_in_[cell].end()); });
  std::sort(near.begin(), near.end());
  near.erase(std::unique(near.begin(), near.end()), near.end());
  for (const std::uint32_t s : near) count += cut(segment, segments_[s]);
  return count;
}

}  // namespace frontmost::detail
