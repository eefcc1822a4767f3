// SPDX-License-Identifier: Apache-2.0
//
//        .-----.         The vertical line at x is an edge of a plane face that is seen edge-on: a step along axis 0.
//        The |     |         same plane may be a step in another view, and is stated once.
//    .---'     |
//    |         |
//    '---------'
//    o-->|               running dimension from the left end of the view
//        x
#include "sheets/dimensions/steps.h"

#include <algorithm>
#include <cmath>

namespace frontmost::detail {
namespace {

constexpr double level = 1e-3;            // slope of lines that count as parallel to an axis
constexpr double along_axis = 2e-3;       // sine of the greatest angle between a normal and an axis
constexpr double same_line = 0.05;        // pixels
constexpr double least_share = 1.0 / 40;  // length of a step's lines, as a share of the view's longer side
constexpr double smooth = 0.9396;         // cosine of 20 degrees: triangles that turn by less are one smooth surface
constexpr double larger = 2;  // how much larger than the facets of a fillet beside it a triangle of a plane face is
constexpr std::size_t most_planes = 64;  // for each axis of a view

/// A step with the place of its plane in the world, along a direction.
struct SteppedPlane {
  PlaneStep step;
  double place, slack;   ///< in units of the scene
  glm::dvec3 direction;  ///< unit length
  std::size_t view;
  int axis;
  bool is_clear;  ///< no line lies between the step and the row
};

class StepFinder {
 public:
  StepFinder(const SteppedView& stepped, int axis)
      : view_(*stepped.view),
        covered_(stepped.covered),
        axis_(axis),
        direction_(axis == 0 ? view_.drawing->view.right() : view_.drawing->view.up()) {}

  [[nodiscard]] std::vector<SteppedPlane> run() const {
    struct Line {
      double at, low, high;  ///< along the axis, and along the other one
      double place;
    };
    const DrawingBounds box = bounds_of(*view_.drawing, true);
    std::vector<Line> lines;
    for (const DrawnPart& part : view_.drawing->parts) {
      if (part.hidden_by != 0) continue;
      const double off = std::abs(part.to[axis_] - part.from[axis_]), at = (part.from[axis_] + part.to[axis_]) / 2;
      const double a = part.from[1 - axis_], b = part.to[1 - axis_];
      if (off > std::max(level * std::abs(b - a), level) || a == b) continue;
      if (at < box.low[axis_] + same_line || at > box.high[axis_] - same_line) continue;
      const DrawnEdge& edge = view_.drawing->edges[part.edge];
      if (!is_of_plane(edge.left, edge.right) && !is_of_plane(edge.right, edge.left)) continue;
      lines.push_back({at, std::min(a, b), std::max(a, b), glm::dot(edge.from, direction_)});
    }
    std::sort(lines.begin(), lines.end(), [](const Line& a, const Line& b) { return a.at < b.at; });
    const Projection& p = view_.drawing->view.projection;
    const glm::dvec2 size = box.high - box.low;
    std::vector<SteppedPlane> all;
    for (auto begin = lines.begin(); begin != lines.end();) {
      const auto end = std::find_if(begin, lines.end(), [&](const Line& l) { return l.at > begin->at + same_line; });
      std::sort(begin, end, [](const Line& a, const Line& b) { return a.low < b.low; });
      double length = 0, reached = begin->low;
      for (auto line = begin; line != end; ++line) {
        length += std::max(0.0, line->high - std::max(line->low, reached));
        reached = std::max(reached, line->high);
      }
      if (length >= least_share * std::max(size.x, size.y))
        all.push_back({{begin->at, axis_ == 0 ? reached : begin->low, length},
                       begin->place,
                       2 * same_line * (p.right - p.left) / view_.drawing->view.width,
                       direction_,
                       0,
                       axis_,
                       false});
      begin = end;
    }
    std::stable_sort(all.begin(), all.end(),
                     [](const SteppedPlane& a, const SteppedPlane& b) { return a.step.length > b.step.length; });
    all.resize(std::min(all.size(), most_planes));
    for (SteppedPlane& plane : all) plane.is_clear = is_clear(plane.step);
    return all;
  }

 private:
  /// Whether a triangle beside an edge is part of a plane face across the axis, and not a facet of a curved surface.
  [[nodiscard]] bool is_of_plane(PrimitiveId id, PrimitiveId other) const {
    if (id == no_primitive || std::binary_search(covered_.begin(), covered_.end(), id)) return false;
    const glm::dvec3 normal = doubled_area(id);
    const double area = glm::length(normal);
    if (!(area > 0) || glm::length(glm::cross(normal, direction_)) > along_axis * area) return false;
    if (other == no_primitive) return true;
    const glm::dvec3 beside = doubled_area(other);
    const double its_area = glm::length(beside);
    return std::abs(glm::dot(normal, beside)) < smooth * area * its_area || area > larger * its_area;
  }

  [[nodiscard]] glm::dvec3 doubled_area(PrimitiveId id) const {
    const std::array<glm::vec3, 3> c = view_.surfaces->corners(id);
    return glm::cross(glm::dvec3(c[1]) - glm::dvec3(c[0]), glm::dvec3(c[2]) - glm::dvec3(c[0]));
  }

  /// Whether the step's extension line crosses no visible line. A line that comes from one side and ends there counts,
  /// because another part continues it.
  [[nodiscard]] bool is_clear(const PlaneStep& step) const {
    return std::none_of(view_.drawing->parts.begin(), view_.drawing->parts.end(), [&](const DrawnPart& part) {
      const double a = part.from[axis_] - (step.at - same_line), b = part.to[axis_] - (step.at - same_line);
      if (part.hidden_by != 0 || (a < 0) == (b < 0)) return false;
      const double crossing = glm::mix(part.from[1 - axis_], part.to[1 - axis_], a / (a - b));
      return axis_ == 0 ? crossing > step.foot + 2 * same_line : crossing < step.foot - 2 * same_line;
    });
  }

  const DimensionedView& view_;
  const std::vector<PrimitiveId>& covered_;
  const int axis_;
  const glm::dvec3 direction_;  ///< of the axis, in the world
};

bool are_same(const SteppedPlane& a, const SteppedPlane& b) {
  const double cosine = glm::dot(a.direction, b.direction);
  return std::abs(cosine) > 1 - along_axis * along_axis &&
         std::abs(a.place - (cosine > 0 ? b.place : -b.place)) <= std::max(a.slack, b.slack);
}

}  // namespace

std::vector<ViewSteps> steps_of(std::span<const SteppedView> views) {
  std::vector<SteppedPlane> planes, spares;  // `planes` has each plane once
  for (std::size_t i = 0; i < views.size(); ++i) {
    const DimensionedView& view = *views[i].view;
    if (!view.is_dimensioned || view.surfaces == nullptr) continue;
    for (const int axis : {0, 1}) {
      if (!views[i].has_datum[axis]) continue;
      for (SteppedPlane& plane : StepFinder(views[i], axis).run()) {
        plane.view = i;
        const auto known =
            std::find_if(planes.begin(), planes.end(), [&](const SteppedPlane& c) { return are_same(c, plane); });
        plane.step.plane = std::size_t(known - planes.begin());
        if (known == planes.end())
          planes.push_back(plane);
        else if (plane.is_clear && !known->is_clear)
          *known = plane;
        else
          spares.push_back(plane);
      }
    }
  }
  std::vector<ViewSteps> all(views.size());
  for (const SteppedPlane& plane : planes) all[plane.view][std::size_t(plane.axis)].push_back(plane.step);
  for (SteppedPlane& spare : spares) {
    if (spare.view <= planes[spare.step.plane].view) continue;
    spare.step.is_spare = true;
    all[spare.view][std::size_t(spare.axis)].push_back(spare.step);
  }
  return all;
}

}  // namespace frontmost::detail
