// SPDX-License-Identifier: Apache-2.0
// Circles of one size in a view share one number ("6x"). Its place is searched around each circle, in twelve directions
// and from near to far. A leader costs its length, and more for every line that it crosses. The cheapest place at which
// the number is free of obstacles is taken:
//
//             __6x...__            knee and shelf with the number
//            /
//           /                      leader, in one of twelve directions
//      .--<'                       tip on the circle
//     (  o  )
//
// The largest sizes go first, because their leaders have the longest ways around inner circles. Sizes without a place
// are counted, so that the caller can report them.
#include "sheets/dimensions/diameters.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace frontmost::detail {
namespace {

constexpr double least_turn = 190 * std::numbers::pi / 180;  // less is an arc, and has a radius
constexpr double same_radius = 1e-3;                         // as a share of the radius
constexpr double same_axis = 5e-3;                           // as a share of the radius
constexpr double chamfer = 0.25;                             // as a share of the radius: how much wider its rim is
constexpr double same_place = 0.05;                          // millimetres
constexpr std::size_t most_circles = 4096;                   // per view
constexpr std::size_t most_diameters = 64;
constexpr std::size_t most_tried = 12;  // circles of one size
constexpr double nearest_knee = 5, farthest_knee = 90, knee_step = 2.5;
constexpr double cost_of_crossing = 4;  // in millimetres of leader
constexpr int most_crossed = 16;        // no eye could follow a leader that crosses more

/// Whether two rounds have the same axis.
bool is_coaxial(const Round& a, const Round& b) {
  if (glm::length(glm::cross(a.axis, b.axis)) > same_axis) return false;
  const glm::dvec3 between = b.from - a.from;
  return glm::length(between - glm::dot(between, a.axis) * a.axis) <= same_axis * std::max(a.radius, b.radius);
}

bool is_same_radius(const Round& a, const Round& b) {
  return std::abs(a.radius - b.radius) <= same_radius * std::max(a.radius, b.radius);
}

/// Whether the circle ends a chamfer at a wall.
bool is_rim(const SeenCircle& circle, const std::vector<SeenCircle>& all) {
  if (circle.round->kind == RoundKind::cylinder) return false;
  return std::any_of(all.begin(), all.end(), [&](const SeenCircle& wall) {
    return wall.round->kind == RoundKind::cylinder && is_coaxial(*wall.round, *circle.round) &&
           !is_same_radius(*wall.round, *circle.round) &&
           std::abs(wall.radius - circle.radius) <= chamfer * circle.radius;
  });
}

}  // namespace

bool Diameters::is_taken(const Round& round) const {
  return std::any_of(taken_.begin(), taken_.end(),
                     [&](const Round& other) { return is_same_radius(other, round) && is_coaxial(other, round); });
}

bool Diameters::take(const Round& round) {
  if (is_taken(round)) return false;
  taken_.push_back(round);
  return true;
}

std::vector<Diameters::Group> Diameters::groups_of(const MeasuredView& view) {
  std::vector<SeenCircle> circles = view.circles();
  circles.resize(std::min(circles.size(), most_circles));
  std::vector<Group> groups;
  for (const SeenCircle& circle : circles) {
    if (circle.round->turn < least_turn || is_rim(circle, circles) || !take(*circle.round)) continue;
    // Grouped by radius and not by number: rounding may split one size.
    auto group = std::find_if(groups.begin(), groups.end(),
                              [&](const Group& g) { return is_same_radius(*g.circles[0].round, *circle.round); });
    if (group == groups.end()) {
      const double number = 2 * circle.round->radius * options_.numbers_per_unit;
      groups.push_back({diameter_sign + dimension_text(number, options_.decimals), {circle}});
      continue;
    }
    const bool is_there = std::any_of(group->circles.begin(), group->circles.end(), [&](const SeenCircle& c) {
      return glm::distance(c.centre, circle.centre) < same_place;
    });
    if (!is_there) group->circles.push_back(circle);
  }
  // The largest have the longest leaders around inner circles.
  std::stable_sort(groups.begin(), groups.end(), [](const Group& a, const Group& b) {
    return a.circles[0].round->radius > b.circles[0].round->radius;
  });
  return groups;
}

std::optional<Diameters::Leader> Diameters::best_leader(const Group& group, std::string_view text) const {
  constexpr int degrees[] = {45, 135, 315, 225, 60, 120, 300, 240, 30, 150, 330, 210};
  std::optional<Leader> best;
  const double shelf = pen_.width_of(text) + 2 * text_distance;
  for (std::size_t i = 0; i < std::min(group.circles.size(), most_tried); ++i) {
    const SeenCircle& circle = group.circles[i];
    for (const int angle : degrees) {
      const double radians = angle * std::numbers::pi / 180;
      const glm::dvec2 out(std::cos(radians), -std::sin(radians));
      const glm::dvec2 tip = circle.centre + circle.radius * out;
      const double side = out.x > 0 ? 1 : -1;
      int crossed = obstacles_.crossings({tip + 0.1 * out, tip + nearest_knee * out});
      for (double way = nearest_knee; way <= farthest_knee; way += knee_step) {
        const double cost = way + cost_of_crossing * crossed;
        if (crossed > most_crossed || (best && cost >= best->cost)) break;
        const glm::dvec2 knee = tip + way * out, end = knee + glm::dvec2(side * shelf, 0);
        const TextAlign align = side > 0 ? TextAlign::left : TextAlign::right;
        PageBox box = pen_.box_of(text, knee + glm::dvec2(side * text_distance, 0), align);
        box.high.y += 2 * text_distance;  // the shelf, and room below it
        if (obstacles_.is_free(box)) best = Leader{tip, knee, end, align, cost};
        crossed += obstacles_.crossings({knee, knee + knee_step * out});
      }
    }
  }
  return best;
}

void Diameters::count_missing(const MeasuredView& view, Dimensions& all) {
  const auto count = [&](const std::vector<const Round*>& rounds, std::size_t& number) {
    std::size_t looked_at = 0;
    for (const Round* const round : rounds)
      number += round->turn >= least_turn && (++looked_at > most_circles || take(*round));
  };
  count(view.undrawn(), all.undrawn);
  count(view.prisms(), all.prisms);
}

void Diameters::add(const MeasuredView& view, Dimensions& all) {
  all.left_out += view.circles().size() - std::min(view.circles().size(), most_circles);
  for (const Group& group : groups_of(view)) {
    const std::size_t count = group.circles.size();
    const std::string text = count > 1 ? std::to_string(count) + "\u00d7" + group.text : group.text;
    std::optional<Leader> leader;
    if (placed_ < most_diameters) leader = best_leader(group, text);
    if (!leader) {
      ++all.left_out;
      continue;
    }
    ++placed_;
    ++all.count;
    pen_.line(leader->tip, leader->knee);
    pen_.line(leader->knee, leader->end);
    pen_.arrow(leader->tip, glm::normalize(leader->tip - leader->knee));
    const double side = leader->align == TextAlign::left ? 1 : -1;
    pen_.text(text, leader->knee + glm::dvec2(side * text_distance, 0), leader->align);
  }
}

}  // namespace frontmost::detail
