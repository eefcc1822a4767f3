// SPDX-License-Identifier: Apache-2.0
// Overall sizes come first: width below a view, height on its left, each direction of space once. Then circles get
// diameters. Circles of one size in a view share one number ("6x"), which is placed so:
//
//             __6x...__            knee and shelf with the number
//           /                      leader, in one of twelve directions, from near to far
//      .--<'                       tip on the circle
//     (  o  )
//
// A leader costs its length, and more for every line that it crosses. The cheapest free place is taken.
//
// Positions are running dimensions between the view and its overall size:
//
//        |    |         |       extension lines from the circles
//     o->|--->|-------->|       the lower left corner of the view is the origin
//        20   45        90
//
// Steps share these rows, and are left out where a hole or a longer step leaves no room.
#include "sheets/dimensions/dimensions.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <set>

#include "rounds/found_rounds.h"
#include "sheets/dimensions/obstacles.h"
#include "sheets/dimensions/positions.h"
#include "sheets/dimensions/steps.h"

namespace frontmost::detail {
namespace {

constexpr double square = 2e-3;               // sine of the greatest angle to the line of sight, as for centre lines
constexpr double least_drawn = 0.2;           // share of a round that must be drawn, as for centre lines
constexpr double nearly_whole = 6.2;          // radians
constexpr double widest_sagitta = 0.016;      // as a share of the radius, for sides of 20 degrees
constexpr double same_place_on_paper = 0.02;  // millimetres of paper
constexpr std::size_t most_arcs = 256;        // per view
constexpr double shortest_side = 1;           // millimetres on paper, of a cylinder with a diameter from the side
constexpr double straight = 1e-4;             // square of the sine of the greatest angle between parallel lines

/// A circle of the scene as it appears in a view.
struct SeenCircle {
  const Round* round;  ///< null for flats
  glm::dvec2 centre;   ///< on the page
  double radius;       ///< millimetres on the page; of flats, half their width
  double depth = 0;    ///< of the blind hole that begins at the circle, in units of the scene
};

struct Extent {
  double low, high;                 ///< on the page
  double size;                      ///< in units of the scene
  const Round* diameter = nullptr;  ///< set if both ends belong to one cylinder
  const Flats* flats = nullptr;     ///< set if both ends are faces of one hexagon
};

bool is_seen_along(const glm::dvec3& axis, const View& camera) {
  return glm::length(glm::cross(axis, camera.forward())) <= square;
}

/// Whether enough of the round is drawn, by its drawn length in pixels.
bool is_drawn(const Round& round, double length, const View& camera) {
  const Projection& p = camera.projection;
  return length >= least_drawn * round.turn * round.radius * camera.width / (p.right - p.left);
}

/// An arc of the scene as it appears in a view.
struct SeenArc {
  const CircleArc* arc;
  glm::dvec2 middle, out;  ///< on the page; `out` points away from the centre and has unit length
};

/// A place from which a leader may start, and its direction.
struct Anchor {
  glm::dvec2 tip, out;
  glm::dvec2 from;  ///< the opposite point of the circle, or the centre of the arc
};

/// A hexagon or square of the scene as it appears in a view.
struct SeenFlats {
  const Flats* flats;
  SeenCircle circle;             ///< circle that touches the faces
  std::vector<glm::dvec2> outs;  ///< normals of the faces that are drawn, on the page
};

struct MeasuredView {
  PageBox box;                        ///< the box of all drawn lines
  std::vector<SeenCircle> circles;    ///< seen along their axes, and drawn to at least a fifth
  std::vector<const Round*> undrawn;  ///< cylinders that are seen along their axes, but drawn less
  std::vector<SeenArc> arcs;          ///< seen along their axes, and drawn in their middle
  std::vector<const Round*> prisms;   ///< those of Rounds::prisms that are seen along their axes
  std::vector<const Round*> holes;    ///< blind holes that are open towards the viewer
  std::vector<SeenFlats> flats;       ///< seen along their axes, and drawn at half of their faces

  MeasuredView(const DimensionedView& view, Dimensioning level) : view_(view) {
    const View& camera = view.drawing->view;
    const Projection& p = camera.projection;
    millimetres_ = camera.width / (p.right - p.left) * view.sheet->millimetres_per_pixel;
    const DrawingBounds drawn = bounds_of(*view.drawing, true);
    if (drawn.is_empty()) return;
    box = {view.sheet->on_page(drawn.low), view.sheet->on_page(drawn.high)};
    if (view.rounds == nullptr) return;
    for (const Round& prism : view.rounds->prisms)
      if (is_seen_along(prism.axis, camera)) prisms.push_back(&prism);
    const std::vector<double> lengths = drawn_lengths(*view.rounds, *view.drawing, false);
    for (std::size_t i = 0; i < lengths.size(); ++i) {
      const Round& round = view.rounds->rounds[i];
      if (round.kind == RoundKind::revolved) continue;  // its largest circle is no edge
      if (!is_seen_along(round.axis, camera)) continue;
      if (round.depth > 0 && glm::dot(round.axis, glm::dvec3(camera.forward())) > 0) holes.push_back(&round);
      if (is_drawn(round, lengths[i], camera))
        circles.push_back({&round, on_page(round.from), round.radius * millimetres_});
      else if (round.kind == RoundKind::cylinder)
        undrawn.push_back(&round);
    }
    if (level < Dimensioning::all) return;
    visible_.emplace(box);
    for (const DrawnPart& part : view.drawing->parts)
      if (part.hidden_by == 0) visible_->add(PageSegment{view.sheet->on_page(part.from), view.sheet->on_page(part.to)});
    for (const CircleArc& arc : view.rounds->arcs) {
      if (arcs.size() == most_arcs) break;
      if (!is_seen_along(arc.axis, camera)) continue;
      const glm::dvec2 middle = on_page(arc.middle), out = middle - on_page(arc.centre);
      const double near = same_place_on_paper + widest_sagitta * arc.radius * millimetres_;
      if (is_drawn_near(middle, near)) arcs.push_back({&arc, middle, out / glm::length(out)});
    }
    for (const Flats& each : view.rounds->flats)
      if (view.is_dimensioned) add_if_seen(each);
  }

  /// The extent along axis 0 (to the right) or 1 (upwards). Rounds reach farther than the corners of their polygons.
  [[nodiscard]] Extent extent(int axis) const {
    Extent all{box.low[axis], box.high[axis], 0};
    const View& camera = view_.drawing->view;
    const glm::dvec3 direction = axis == 0 ? camera.right() : camera.up();
    double low = all.low, high = all.high;
    for (const Round& round : all_rounds()) {
      const double along = glm::dot(round.axis, direction), slack = widest_sagitta * round.radius * millimetres_;
      if (round.turn < nearly_whole) continue;
      const double reach = round.radius * millimetres_ * std::sqrt(std::max(0.0, 1 - along * along));
      const double from = on_page(round.from)[axis], to = on_page(round.to)[axis];
      const double begin = std::min(from, to) - reach, end = std::max(from, to) + reach;
      const bool is_low =
          begin <= box.low[axis] + same_place_on_paper && begin >= box.low[axis] - slack - same_place_on_paper;
      const bool is_high =
          end >= box.high[axis] - same_place_on_paper && end <= box.high[axis] + slack + same_place_on_paper;
      if (is_low) low = std::min(low, begin);
      if (is_high) high = std::max(high, end);
      const bool is_larger = all.diameter == nullptr || round.radius > all.diameter->radius;
      if (is_low && is_high && std::abs(along) <= square && is_larger) all.diameter = &round;
    }
    all.low = low;
    all.high = high;
    all.size = all.diameter != nullptr ? 2 * all.diameter->radius : (high - low) / millimetres_;
    for (const Flats& each : all_flats()) {
      const double turn = glm::dot(each.side, direction), off = (high + low) / 2 - on_page(each.from)[axis];
      const bool is_across = std::abs(glm::dot(each.to - each.from, direction)) <= square * each.width;
      // A normal of a hexagon is 0 or 60 degrees from another one: cos(3 x) = 4 cos(x)^3 - 3 cos(x).
      const bool faces = std::abs(4 * turn * turn * turn - 3 * turn) >= 1 - square;
      if (each.sides == 6 && is_across && faces && std::abs(each.width - all.size) <= same_size * all.size &&
          std::abs(off) < same_place)
        all.flats = &each;
    }
    return all;
  }

  /// Where the extension line at one end of an axis begins: the position, along the other axis, of the drawn point at
  /// that end which is nearest to the dimension line. This is the lowest such point (y is down) for axis 0, the
  /// leftmost for axis 1.
  [[nodiscard]] double foot_of_end(int axis, double end) const {
    const double slack = same_place_on_paper + widest_sagitta * (box.high[axis] - box.low[axis]) / 2;
    const int other = 1 - axis;
    double nearest = std::numeric_limits<double>::infinity(), foot = axis == 0 ? box.low.y : box.high.x;
    const auto look_at = [&](const glm::dvec2& point) {
      const double off = std::abs(point[axis] - end);
      if (off > slack || off > nearest + same_place_on_paper) return;
      // Among points at one distance, the one nearest to the dimension line is taken.
      const bool is_nearer = off < nearest - same_place_on_paper;
      const double at = point[other];
      foot = is_nearer ? at : axis == 0 ? std::max(foot, at) : std::min(foot, at);
      nearest = std::min(nearest, off);
    };
    for (const DrawnPart& part : view_.drawing->parts) {
      look_at(view_.sheet->on_page(part.from));
      look_at(view_.sheet->on_page(part.to));
    }
    return foot;
  }

  /// The leaders that a cylinder may have which is seen from the side: across its visible outlines.
  [[nodiscard]] std::vector<Anchor> sides_of(const Round& cylinder) const {
    std::vector<Anchor> anchors;
    const glm::dvec2 from = on_page(cylinder.from), along = on_page(cylinder.to) - from;
    const double length = glm::length(along), radius = cylinder.radius * millimetres_;
    if (std::abs(glm::dot(cylinder.axis, view_.drawing->view.forward())) > square || length < shortest_side) return {};
    const glm::dvec2 across = glm::dvec2(-along.y, along.x) / length;
    for (const double share : {0.5, 0.25, 0.75})
      for (const glm::dvec2& out : {across, -across}) {
        const glm::dvec2 middle = from + share * along, tip = middle + radius * out;
        if (!is_drawn_near(tip, same_place_on_paper + widest_sagitta * radius, out)) continue;
        for (const double turn : {0.5, -0.5, 0.0})
          anchors.push_back(
              {tip, out * std::cos(turn) + glm::dvec2(-out.y, out.x) * std::sin(turn), middle - radius * out});
      }
    return anchors;
  }

  [[nodiscard]] std::span<const Round> all_rounds() const {
    return view_.rounds != nullptr ? std::span<const Round>(view_.rounds->rounds) : std::span<const Round>();
  }

  [[nodiscard]] std::span<const Flats> all_flats() const {
    return view_.rounds != nullptr ? std::span<const Flats>(view_.rounds->flats) : std::span<const Flats>();
  }

  /// Length in units of the scene.
  [[nodiscard]] double size_of(double on_paper) const { return on_paper / millimetres_; }

  [[nodiscard]] glm::dvec2 on_page(const glm::dvec2& pixel) const { return view_.sheet->on_page(pixel); }
  [[nodiscard]] glm::dvec2 on_page(const glm::dvec3& point) const {
    return view_.sheet->on_page(on_screen(view_.drawing->view, point));
  }

 private:
  void add_if_seen(const Flats& shape) {
    const glm::dvec3 axis = glm::normalize(shape.to - shape.from);
    if (!is_seen_along(axis, view_.drawing->view)) return;
    SeenFlats seen{&shape, {nullptr, on_page(shape.from), shape.width / 2 * millimetres_}, {}};
    for (std::uint32_t i = 0; i < shape.sides; ++i) {
      const double turn = 2 * std::numbers::pi * i / shape.sides;
      const glm::dvec3 out = shape.side * std::cos(turn) + glm::cross(axis, shape.side) * std::sin(turn);
      const glm::dvec2 middle = on_page(shape.from + out * (shape.width / 2));
      if (is_drawn_near(middle, same_place)) seen.outs.push_back(glm::normalize(middle - seen.circle.centre));
    }
    // The overall sizes state a square that bounds the view.
    const bool is_bound = glm::all(glm::lessThan(glm::abs(box.low + seen.circle.radius - seen.circle.centre) +
                                                     glm::abs(box.high - seen.circle.radius - seen.circle.centre),
                                                 glm::dvec2(same_place)));
    if (2 * seen.outs.size() >= shape.sides && !(shape.sides == 4 && is_bound)) flats.push_back(std::move(seen));
  }

  /// Whether a visible line passes within `near` of a place on the page; across a direction if that is not 0.
  [[nodiscard]] bool is_drawn_near(const glm::dvec2& place, double near, const glm::dvec2& across = {0, 0}) const {
    return visible_ && visible_->has_line({place - near, place + near}, [&](const PageSegment& line) {
      const glm::dvec2 along = line.to - line.from;
      const double length = glm::dot(along, along), off = glm::dot(along, across);
      if (off * off > straight * length) return false;
      const double t = length > 0 ? std::clamp(glm::dot(place - line.from, along) / length, 0.0, 1.0) : 0;
      return glm::distance(place, line.from + along * t) <= near;
    });
  }

  const DimensionedView& view_;
  std::optional<Obstacles> visible_;  ///< the visible lines, on the page; none below Dimensioning::all
  double millimetres_ = 1;            ///< millimetres of paper per unit of the scene
};

constexpr double extension_gap = 1;        // millimetres between the measured feature and its extension line
constexpr double extension_overshoot = 2;  // beyond the dimension line
constexpr double first_distance = 10;      // distance of a dimension line from the view
constexpr double origin_radius = 1;        // of the small circle where running dimensions begin
constexpr double text_distance = 1;        // distance of a number from its line, and from everything else

/// Registers everything drawn as obstacles.
class DimensionPen {
 public:
  DimensionPen(const DimensionOptions& options, Obstacles& obstacles)
      : options_(options), obstacles_(obstacles), texts_{"", text_pen(options.text_height)} {}

  void line(const glm::dvec2& from, const glm::dvec2& to) {
    const glm::dvec2 ends[] = {from, to};
    lines_.add(ends, false);
    obstacles_.add(PageSegment{from, to});
  }

  /// The small circle at the origin of running dimensions.
  void origin(const glm::dvec2& at) {
    constexpr int corners = 16;
    std::vector<glm::dvec2> circle;
    for (int i = 0; i < corners; ++i) {
      const double angle = 2 * std::numbers::pi * i / corners;
      circle.push_back(at + origin_radius * glm::dvec2(std::cos(angle), std::sin(angle)));
    }
    lines_.add(circle, true);
  }

  void arrow(const glm::dvec2& tip, const glm::dvec2& pointing) {
    add_arrowhead(lines_, tip, pointing, arrow_length());
  }

  /// Draws text above `at`, which is the middle or an end of the text's base line. The text is level, or upright, to be
  /// read from the right.
  void text(std::string_view text, const glm::dvec2& at, TextAlign align, bool is_upright = false) {
    const glm::dvec2 above = is_upright ? glm::dvec2(-text_distance, 0) : glm::dvec2(0, -text_distance);
    add_text(is_text() ? lines_ : texts_, text, at + above,
             {options_.text_height, is_upright ? std::numbers::pi / 2 : 0, align, TextLine::bottom},
             options_.lettering);
    if (!is_upright) return obstacles_.add(box_of(text, at, align));
    const PageBox level = box_of(text, {0, 0}, align);
    // A quarter turn maps (x, y) to (y, -x).
    obstacles_.add(PageBox{at + glm::dvec2(level.low.y, -level.high.x), at + glm::dvec2(level.high.y, -level.low.x)});
  }

  /// Begins a dimension for CAD programs; the lines that follow, and the last text, are its picture.
  void begin_dimension() { first_path_ = lines_.paths.size(); }
  void end_dimension(PageDimension dimension) {
    if (!is_text()) return;
    dimension.first_path = std::uint32_t(first_path_);
    dimension.path_count = std::uint32_t(lines_.paths.size() - first_path_);
    dimension.text = std::uint32_t(lines_.texts.size() - 1);
    lines_.dimensions.push_back(dimension);
  }

  [[nodiscard]] double width_of(std::string_view text) const { return text_width(text, options_.text_height); }
  [[nodiscard]] double arrow_length() const { return 12 * lines_.pen.width; }

  /// The box of a level text above a place, with some room around it.
  [[nodiscard]] PageBox box_of(std::string_view text, const glm::dvec2& at, TextAlign align) const {
    const double width = width_of(text);
    const double left = align == TextAlign::left ? 0 : align == TextAlign::right ? -width : -width / 2;
    return {at + glm::dvec2(left - text_distance, -options_.text_height - 2 * text_distance),
            at + glm::dvec2(left + width + text_distance, -text_distance / 2)};
  }

  [[nodiscard]] std::vector<PageGroup> take() {
    std::vector<PageGroup> groups;
    for (PageGroup* const group : {&lines_, &texts_})
      if (!group->is_empty()) groups.push_back(std::move(*group));
    return groups;
  }

 private:
  [[nodiscard]] bool is_text() const { return options_.lettering == Lettering::text; }

  const DimensionOptions& options_;
  Obstacles& obstacles_;
  PageGroup lines_{"", Pen()}, texts_;
  std::size_t first_path_ = 0;  ///< of the dimension that is being drawn
};

constexpr double least_turn = 190 * std::numbers::pi / 180;  // a round of less is an arc, and has a radius instead
constexpr double same_radius = 1e-3;                         // as a share of the radius
constexpr double same_axis = 5e-3;                           // as a share of the radius
constexpr double chamfer = 0.25;  // how much wider the rim of a chamfer may be than its wall, as a share of the radius
constexpr std::size_t most_circles = 4096;  // per view
constexpr std::size_t most_diameters = 64;
constexpr std::size_t most_tried = 12;  // circles of one size that are tried
constexpr double nearest_knee = 5, farthest_knee = 90, knee_step = 2.5;
constexpr double cost_of_crossing = 4;   // in millimetres of leader
constexpr int most_crossed = 16;         // no eye could follow a leader that crosses more
constexpr std::size_t fewest_rings = 4;  // equal rings about one axis, as of a thread, that are counted
constexpr double least_chamfer_circle = 0.8, largest_chamfer_circle = 1.16;  // about flats, in halves of their width

/// Whether two rounds have the same axis.
bool is_coaxial(const Round& a, const Round& b) {
  if (glm::length(glm::cross(a.axis, b.axis)) > same_axis) return false;
  const glm::dvec3 between = b.from - a.from;
  return glm::length(between - glm::dot(between, a.axis) * a.axis) <= same_axis * std::max(a.radius, b.radius);
}

bool is_same_radius(const Round& a, const Round& b) {
  return std::abs(a.radius - b.radius) <= same_radius * std::max(a.radius, b.radius);
}

/// Whether the circle is the rim of a chamfer at the end of a wall.
bool is_rim(const SeenCircle& circle, const std::vector<SeenCircle>& all) {
  if (circle.round->kind == RoundKind::cylinder) return false;
  return std::any_of(all.begin(), all.end(), [&](const SeenCircle& wall) {
    return wall.round->kind == RoundKind::cylinder && is_coaxial(*wall.round, *circle.round) &&
           !is_same_radius(*wall.round, *circle.round) &&
           std::abs(wall.radius - circle.radius) <= chamfer * circle.radius;
  });
}

/// Whether the circle belongs to the shape of flats, as where a chamfer meets the top of a bolt's head.
bool is_about(const SeenCircle& circle, const std::vector<SeenFlats>& all) {
  if (circle.round->kind != RoundKind::circle) return false;
  return std::any_of(all.begin(), all.end(), [&](const SeenFlats& seen) {
    const double share = circle.radius / seen.circle.radius;
    return share >= least_chamfer_circle && share <= largest_chamfer_circle &&
           glm::distance(circle.centre, seen.circle.centre) < same_place;
  });
}

const std::string diameter_sign = "\u2300", depth_sign = "\u21a7", flats_sign = "AF ";

/// A text with the number of its shapes, if that is not one: "6x...".
std::string counted(std::size_t count, const std::string& text) {
  return count > 1 ? std::to_string(count) + "\u00d7" + text : text;
}

/// Places the diameters and radii of a sheet, each once.
struct Diameters {
  /// Marks a cylinder and its continuations as dimensioned. \returns false if the cylinder was marked before. Blind
  /// holes that face each other differ.
  bool take(const Round& round) {
    const bool is_new = !is_taken(round);
    if (is_new) taken.push_back(round);
    return is_new;
  }

  [[nodiscard]] bool is_taken(const Round& round) const {
    return std::any_of(taken.begin(), taken.end(), [&](const Round& other) {
      const bool face_each_other = has_all() && other.depth > 0 && round.depth > 0 && dot(other.axis, round.axis) < 0;
      return !face_each_other && is_same_radius(other, round) && is_coaxial(other, round);
    });
  }

  [[nodiscard]] bool has_all() const { return options.level >= Dimensioning::all; }

  [[nodiscard]] std::string text_of(double size) const {
    return dimension_text(size * options.numbers_per_unit, options.number_style);
  }

  /// Marks flats as dimensioned. \returns false if flats of this width and axis were marked before.
  bool take(const Flats& flats) {
    const glm::dvec3 axis = glm::normalize(flats.to - flats.from);
    const bool is_new = std::none_of(taken_flats.begin(), taken_flats.end(), [&](const Flats* other) {
      return std::abs(other->width - flats.width) <= same_size * flats.width &&
             glm::length(glm::cross(other->from - flats.from, axis)) <= same_axis * flats.width &&
             glm::length(glm::cross(other->to - flats.from, axis)) <= same_axis * flats.width;
    });
    if (is_new) taken_flats.push_back(&flats);
    return is_new;
  }

  struct Group {
    std::string text;
    std::vector<SeenCircle> circles;  ///< at different places
    std::vector<Anchor> anchors{};
    std::size_t count = 0;  ///< of circles or arcs
    double factor = 1;      ///< as in PageDimension
  };

  /// Writes the diameters, or radii, of a view.
  void add(const std::vector<Group>& groups, Dimensions& all) {
    for (const Group& group : groups) {
      const std::string text = counted(group.count, group.text);
      std::optional<Leader> leader;
      if (placed < most_diameters) leader = best_leader(group, text);
      if (!leader) {
        ++all.left_out;
        continue;
      }
      ++placed;
      ++all.count;
      pen.begin_dimension();
      pen.line(leader->tip, leader->knee);
      pen.line(leader->knee, leader->end);
      pen.arrow(leader->tip, glm::normalize(leader->tip - leader->knee));
      const double side = leader->align == TextAlign::left ? 1 : -1;
      pen.text(text, leader->knee + glm::dvec2(side * text_distance, 0), leader->align);
      const DimensionKind kind = group.circles.empty() ? DimensionKind::radius : DimensionKind::diameter;
      pen.end_dimension({kind, leader->from, leader->tip, leader->knee, 0, group.factor});
    }
  }

  /// Counts cylinders without a diameter, because no view draws them or they are prisms. Call it after all add().
  void count_missing(const MeasuredView& view, Dimensions& all) {
    const auto count = [&](const std::vector<const Round*>& rounds, std::size_t& missing) {
      std::size_t looked_at = 0;
      for (const Round* const round : rounds)
        missing += round->turn >= least_turn && (++looked_at > most_circles || take(*round));
    };
    count(view.undrawn, all.undrawn);
    count(view.prisms, all.prisms);
  }

  /// A leader from a circle to the shelf under its number.
  struct Leader {
    glm::dvec2 from, tip, knee, end;
    TextAlign align;
    double cost;
  };

  /// The circles that this view shows and no earlier view has shown, by their diameters.
  [[nodiscard]] std::vector<Group> groups_of(const MeasuredView& view, Dimensions& all) {
    all.left_out += view.circles.size() - std::min(view.circles.size(), most_circles);
    std::vector<SeenCircle> circles = view.circles;
    circles.resize(std::min(circles.size(), most_circles));
    std::vector<Group> groups;
    for (SeenCircle& circle : circles) {
      if (circle.round->turn < least_turn || is_rim(circle, circles)) continue;
      if (has_all() && is_about(circle, view.flats)) continue;
      const Round* const hole = hole_at(*circle.round, view);
      if (!take(hole != nullptr ? *hole : *circle.round)) continue;
      circle.depth = hole != nullptr ? hole->depth : 0;
      // The walls of a hole around its grooves are no rings: they have one depth.
      const std::size_t rings = hole != nullptr ? 1 : rings_about(*circle.round, view);
      // Circles are grouped by radius and not by number, because rounding may split one size.
      auto group = std::find_if(groups.begin(), groups.end(), [&](const Group& g) {
        const double depth = g.circles[0].depth;
        return is_same_radius(*g.circles[0].round, *circle.round) &&
               std::abs(depth - circle.depth) <= same_size * std::max(depth, circle.depth);
      });
      if (group == groups.end()) {
        const std::string depth = circle.depth > 0 ? depth_sign + text_of(circle.depth) : "";
        groups.push_back({diameter_sign + text_of(2 * circle.round->radius) + depth, {circle}});
        groups.back().count = rings;
        continue;
      }
      const bool is_there = std::any_of(group->circles.begin(), group->circles.end(), [&](const SeenCircle& c) {
        return glm::distance(c.centre, circle.centre) < same_place;
      });
      if (is_there) continue;
      group->circles.push_back(circle);
      group->count += rings;
    }
    for (Group& group : groups) {
      group.anchors = anchors_of(group.circles);
      group.factor = view.size_of(options.numbers_per_unit);
    }
    // The largest circles come first, because they have the longest leaders around inner circles.
    std::stable_sort(groups.begin(), groups.end(), [](const Group& a, const Group& b) {
      return a.circles[0].round->radius > b.circles[0].round->radius;
    });
    return groups;
  }

  /// The blind hole of which a view shows the rim; null if there is none. The end of a pin in a hole is no rim.
  [[nodiscard]] const Round* hole_at(const Round& rim, const MeasuredView& view) const {
    if (!has_all()) return nullptr;
    const auto found = std::find_if(view.holes.begin(), view.holes.end(), [&](const Round* hole) {
      const double from_floor = glm::dot(hole->to - rim.from, hole->axis);
      return is_same_radius(*hole, rim) && is_coaxial(*hole, rim) &&
             from_floor <= hole->depth + same_axis * hole->radius;
    });
    return found == view.holes.end() ? nullptr : *found;
  }

  /// The number of rings about one axis, as of a modelled thread: equal cylinders apart from each other, or circles if
  /// there are no cylinders. 1 if they are few, because a shaft or bore has one diameter.
  [[nodiscard]] std::size_t rings_about(const Round& ring, const MeasuredView& view) const {
    if (!has_all()) return 1;
    std::vector<std::pair<double, double>> cylinders, circles;  // their extents along the axis
    for (const Round& other : view.all_rounds()) {
      if (other.kind == RoundKind::revolved || !is_same_radius(other, ring) || !is_coaxial(other, ring)) continue;
      const double from = glm::dot(other.from - ring.from, ring.axis), to = glm::dot(other.to - ring.from, ring.axis);
      (other.kind == RoundKind::cylinder ? cylinders : circles).emplace_back(std::min(from, to), std::max(from, to));
    }
    std::vector<std::pair<double, double>>& all = cylinders.empty() ? circles : cylinders;
    std::sort(all.begin(), all.end());
    std::size_t rings = 0;
    double reached = -std::numeric_limits<double>::infinity();
    for (const auto& extent : all) {
      rings += extent.first > reached + same_radius * ring.radius;
      reached = std::max(reached, extent.second);
    }
    return rings >= fewest_rings ? rings : 1;
  }

  /// The diameters of cylinders that this view shows from the side, and no view along their axis. At most 4096
  /// cylinders are looked at.
  [[nodiscard]] std::vector<Group> sides_of(const MeasuredView& view) {
    std::vector<Group> groups;
    std::size_t looked_at = 0;
    for (const Round& round : view.all_rounds()) {
      if (round.kind != RoundKind::cylinder || round.turn < least_turn || is_taken(round)) continue;
      if (++looked_at > most_circles) break;
      const std::vector<Anchor> anchors = view.sides_of(round);
      if (anchors.empty() || !take(round)) continue;
      auto group = std::find_if(groups.begin(), groups.end(),
                                [&](const Group& g) { return is_same_radius(*g.circles[0].round, round); });
      if (group == groups.end()) group = groups.insert(group, {diameter_sign + text_of(2 * round.radius), {}});
      group->count += rings_about(round, view);
      group->factor = view.size_of(options.numbers_per_unit);
      group->circles.push_back({&round, (anchors[0].tip + anchors[0].from) / 2.0, round.radius});
      if (group->circles.size() <= most_tried)
        group->anchors.insert(group->anchors.end(), anchors.begin(), anchors.end());
    }
    return groups;
  }

  /// The widths across flats that this view shows and no earlier view has shown.
  [[nodiscard]] std::vector<Group> flats_of(const MeasuredView& view) {
    std::vector<Group> groups;
    for (const SeenFlats& seen : view.flats) {
      if (!take(*seen.flats)) continue;
      auto group = std::find_if(groups.begin(), groups.end(), [&](const Group& g) {
        const double radius = g.circles[0].radius;
        return std::abs(radius - seen.circle.radius) <= same_size * std::max(radius, seen.circle.radius);
      });
      if (group == groups.end()) group = groups.insert(group, {flats_sign + text_of(seen.flats->width), {}});
      ++group->count;
      group->factor = view.size_of(options.numbers_per_unit);
      group->circles.push_back(seen.circle);
      if (group->count > most_tried) continue;
      for (const glm::dvec2& out : seen.outs)
        for (const double turn : {0.0, 0.5, -0.5}) {
          const glm::dvec2 across(-out.y, out.x);
          group->anchors.push_back({seen.circle.centre + seen.circle.radius * out,
                                    out * std::cos(turn) + across * std::sin(turn),
                                    seen.circle.centre - seen.circle.radius * out});
        }
    }
    return groups;
  }

  /// The arcs that this view shows and no earlier view has shown, by their radii.
  [[nodiscard]] std::vector<Group> radii_of(const MeasuredView& view) {
    std::vector<Group> groups;
    std::vector<double> radii;
    for (const SeenArc& seen : view.arcs) {
      const CircleArc& arc = *seen.arc;
      if (!take({RoundKind::circle, arc.centre, arc.centre, arc.axis, arc.radius, arc.turn})) continue;
      const auto known = std::find_if(radii.begin(), radii.end(), [&](double radius) {
        return std::abs(radius - arc.radius) <= same_radius * std::max(radius, arc.radius);
      });
      const auto number = std::size_t(known - radii.begin());
      if (known == radii.end()) {
        radii.push_back(arc.radius);
        groups.push_back({"R" + text_of(arc.radius), {}});
      }
      Group& group = groups[number];
      ++group.count;
      if (group.count > most_tried) continue;
      group.factor = view.size_of(options.numbers_per_unit);
      const glm::dvec2 centre = view.on_page(arc.centre);
      // From outside of the curve, or across its centre.
      group.anchors.push_back({seen.middle, seen.out, centre});
      group.anchors.push_back({seen.middle, -seen.out, centre});
    }
    return groups;
  }

  /// The leaders that circles may have.
  static std::vector<Anchor> anchors_of(const std::vector<SeenCircle>& circles) {
    constexpr int degrees[] = {45, 135, 315, 225, 60, 120, 300, 240, 30, 150, 330, 210};
    std::vector<Anchor> anchors;
    for (std::size_t i = 0; i < std::min(circles.size(), most_tried); ++i)
      for (const int angle : degrees) {
        const double radians = angle * std::numbers::pi / 180;
        const glm::dvec2 out(std::cos(radians), -std::sin(radians));
        const glm::dvec2 tip = circles[i].radius * out;
        anchors.push_back({circles[i].centre + tip, out, circles[i].centre - tip});
      }
    return anchors;
  }

  [[nodiscard]] std::optional<Leader> best_leader(const Group& group, std::string_view text) const {
    std::optional<Leader> best;
    const double shelf = pen.width_of(text) + 2 * text_distance;
    for (const auto& [tip, out, from] : group.anchors) {
      const double side = out.x > 0 ? 1 : -1;
      int crossed = obstacles.crossings({tip + 0.1 * out, tip + nearest_knee * out});
      for (double way = nearest_knee; way <= farthest_knee; way += knee_step) {
        const double cost = way + cost_of_crossing * crossed;
        if (crossed > most_crossed || (best && cost >= best->cost)) break;
        const glm::dvec2 knee = tip + way * out, end = knee + glm::dvec2(side * shelf, 0);
        const TextAlign align = side > 0 ? TextAlign::left : TextAlign::right;
        PageBox box = pen.box_of(text, knee + glm::dvec2(side * text_distance, 0), align);
        box.high.y += 2 * text_distance;  // the shelf, and room below it
        if (obstacles.is_free(box)) best = Leader{from, tip, knee, end, align, cost};
        crossed += obstacles.crossings({knee, knee + knee_step * out});
      }
    }
    return best;
  }

  const DimensionOptions& options;
  DimensionPen& pen;
  const Obstacles& obstacles;
  std::vector<Round> taken{};
  std::vector<const Flats*> taken_flats{};
  std::size_t placed = 0;
};

constexpr double same_direction = 0.9999;  // cosine

/// The measured direction of an axis of the page, as in PageDimension.
constexpr double angle_of(int axis) { return axis == 0 ? 0 : std::numbers::pi / 2; }

/// The line on which the dimensions of a view along an axis stand: below the view for axis 0, on its left for axis 1,
/// with x and y swapped, to be read from the right.
struct DimensionLine {
  /// `taken`: millimetres on the left of the view and below it that other marks occupy.
  DimensionLine(const MeasuredView& its_view, int its_axis, const Extent& its_extent, const glm::dvec2& taken)
      : view(its_view),
        axis(its_axis),
        extent(its_extent),
        away(axis == 0 ? 1 : -1),
        place(axis == 0 ? view.box.high.y + (first_distance + taken.y) : view.box.low.x - (first_distance + taken.x)) {}

  [[nodiscard]] bool is_level() const { return axis == 0; }
  [[nodiscard]] glm::dvec2 at(double along, double across) const {
    return is_level() ? glm::dvec2(along, across) : glm::dvec2(across, along);
  }
  /// The drawn point at an end of the view at which the extension line begins.
  [[nodiscard]] glm::dvec2 foot(double end) const { return at(end, view.foot_of_end(axis, end)); }

  const MeasuredView& view;
  int axis;
  Extent extent;
  double away;   ///< 1 or -1: across the axis, from the view to the line
  double place;  ///< across the axis
};

void draw_overall_size(DimensionPen& pen, const DimensionLine& row, const std::string& text, double numbers_per_unit) {
  const Extent& e = row.extent;
  const bool is_level = row.is_level();
  const double line = row.place, away = row.away;
  const glm::dvec2 feet[] = {row.foot(e.low), row.foot(e.high)}, out = row.at(0, away);
  pen.begin_dimension();
  pen.line(feet[0] + out * extension_gap, row.at(e.low, line + away * extension_overshoot));
  pen.line(feet[1] + out * extension_gap, row.at(e.high, line + away * extension_overshoot));
  const double length = e.high - e.low, arrow = pen.arrow_length(), width = pen.width_of(text);
  const bool is_inside = length >= 2 * arrow + 1;
  const bool is_text_inside = width + 2 * text_distance <= length;
  // Read from the right, the text of an upright number runs upwards, towards lower y.
  const double first = is_level ? e.high : e.low, forwards = is_level ? 1 : -1;
  const double tail = is_inside ? 0 : 2 * arrow;
  const double text_tail = is_text_inside ? tail : std::max(tail, arrow) + width + 2 * text_distance;
  const double last = is_level ? e.low : e.high;
  pen.line(row.at(last - forwards * tail, line), row.at(first + forwards * text_tail, line));
  const double inwards = is_inside ? -1 : 1;
  pen.arrow(row.at(e.low, line), row.at(inwards, 0));
  pen.arrow(row.at(e.high, line), row.at(-inwards, 0));
  const double middle =
      is_text_inside ? (e.low + e.high) / 2 : first + forwards * (text_tail - text_distance - width / 2);
  pen.text(text, row.at(middle, line), TextAlign::centre, !is_level);
  pen.end_dimension({DimensionKind::linear, feet[0], feet[1], row.at(e.high, line), angle_of(row.axis),
                     row.view.size_of(numbers_per_unit)});
}

constexpr double positions_room = first_distance + extension_overshoot + 14;  // numbers of five digits
constexpr double jog_room = 3.5;                                              // more, if numbers are moved aside
constexpr double least_gap = 2, most_moved = 8;                               // millimetres, of numbers moved aside

/// The end of a view from which positions are measured, and the direction in which they grow: right or up.
double datum_of(const DimensionLine& row) { return row.is_level() ? row.extent.low : row.extent.high; }
double growth_of(const DimensionLine& row) { return row.is_level() ? 1 : -1; }

/// The positions of circles and steps along an axis. `missed`: planes of steps that have no number so far.
std::vector<Position> positions_of(const DimensionLine& row, const std::vector<Diameters::Group>& groups,
                                   const std::vector<PlaneStep>& steps, std::set<std::size_t>& missed) {
  const int axis = row.axis;
  const double datum = datum_of(row), forwards = growth_of(row);
  std::vector<Position> positions;
  for (const Diameters::Group& group : groups)
    for (const SeenCircle& circle : group.circles)
      positions.push_back({(circle.centre[axis] - datum) * forwards,
                           circle.centre[1 - axis] + row.away * (circle.radius + extension_gap),
                           std::numeric_limits<double>::infinity()});
  for (const PlaneStep& step : steps) {
    if (step.is_spare && !missed.contains(step.plane)) continue;
    missed.insert(step.plane);
    const glm::dvec2 place = row.view.on_page(row.at(step.at, step.foot));
    const double distance = (place[axis] - datum) * forwards;
    // So near to an end of the view, two extension lines look like one.
    if (distance < least_gap / 2 || distance > row.extent.high - row.extent.low - least_gap / 2) continue;
    positions.push_back({distance, place[1 - axis] + row.away * extension_gap, step.length, {step.plane}});
  }
  return positions;
}

/// The room of a row's numbers. The extension lines of the overall size run beside the first and the last number.
NumberRoom number_room(const Extent& e, const DimensionOptions& options) {
  const double thickness = options.text_height + text_distance, infinity = std::numeric_limits<double>::infinity();
  if (options.level < Dimensioning::all) return {thickness, thickness, 0, -infinity, infinity};
  const double rim = (thickness + text_distance) / 2;
  return {thickness, least_gap, most_moved, rim, e.high - e.low - rim};
}

/// Draws positions as running dimensions.
void draw_positions(DimensionPen& pen, const DimensionLine& row, const std::vector<Position>& chosen,
                    const DimensionOptions& options) {
  if (chosen.empty()) return;
  const double datum = datum_of(row), forwards = growth_of(row), away = row.away, line = row.place;
  const bool has_jogs = std::any_of(chosen.begin(), chosen.end(),
                                    [](const Position& p) { return std::abs(p.place - p.distance) > same_place; });
  const double overshoot = line + away * extension_overshoot, end = overshoot + away * (has_jogs ? jog_room : 0);
  double farthest = 0;
  for (const Position& p : chosen) {
    const double along = datum + forwards * p.distance, number = datum + forwards * p.place;
    pen.begin_dimension();
    pen.line(row.at(along, p.foot), row.at(along, overshoot));
    if (has_jogs) pen.line(row.at(along, overshoot), row.at(number, end));
    // Too near to the origin, the arrowhead points back to it.
    const double arrow = pen.arrow_length();
    const bool is_near = options.level >= Dimensioning::all && p.distance < arrow + origin_radius &&
                         (&p == &chosen.back() || (&p)[1].distance > p.distance + arrow);
    pen.arrow(row.at(along, line), row.at(is_near ? -forwards : forwards, 0));
    farthest = std::max(farthest, p.distance + (is_near ? 2 * arrow : 0));
    // The number stands in line with its extension line.
    const glm::dvec2 base = row.at(number + options.text_height / 2 + text_distance, end + away);
    pen.text(dimension_text(row.view.size_of(p.distance) * options.numbers_per_unit, options.number_style), base,
             TextAlign::right, row.is_level());
    pen.end_dimension({DimensionKind::position, row.at(datum, line), row.at(along, p.foot - away * extension_gap),
                       row.at(along, overshoot), angle_of(row.axis), row.view.size_of(options.numbers_per_unit)});
  }
  pen.line(row.foot(datum) + row.at(0, away * extension_gap), row.at(datum, overshoot));
  pen.line(row.at(datum, line), row.at(datum + forwards * farthest, line));
  pen.origin(row.at(datum, line));
}

/// Millimetres that a row of the positions of a view along an axis occupies. The longest number decides.
double position_room(const MeasuredView& view, int axis, const std::vector<PlaneStep>& steps,
                     const DimensionOptions& options) {
  const Extent extent = view.extent(axis);
  const double datum = axis == 0 ? extent.low : extent.high;
  double longest = 0;
  const auto look_at = [&](const glm::dvec2& place) {
    const double number = view.size_of(std::abs(place[axis] - datum)) * options.numbers_per_unit;
    longest = std::max(longest, text_width(dimension_text(number, options.number_style), options.text_height));
  };
  for (std::size_t i = 0; i < std::min(view.circles.size(), most_circles); ++i) look_at(view.circles[i].centre);
  for (const SeenFlats& seen : view.flats) look_at(seen.circle.centre);
  for (const PlaneStep& step : steps) look_at(view.on_page(glm::dvec2(step.at)));
  const double long_room = longest + options.text_height + 5 * text_distance;
  return std::max(positions_room, long_room) + (options.level >= Dimensioning::all ? jog_room : 0);
}

struct PlannedRows {
  std::vector<glm::dvec2> rooms;  ///< as position_rooms_of()
  std::vector<ViewSteps> steps;
};

/// The views as steps_of() takes them.
std::vector<SteppedView> stepped_views(std::span<const DimensionedView> views,
                                       const std::vector<MeasuredView>& measured) {
  std::vector<SteppedView> stepped;
  for (std::size_t i = 0; i < views.size(); ++i) {
    SteppedView& view = stepped.emplace_back(SteppedView{&views[i], glm::bvec2(false), {}});
    if (!views[i].is_dimensioned || measured[i].box.is_empty()) continue;
    view.has_datum = {measured[i].extent(0).diameter == nullptr, measured[i].extent(1).diameter == nullptr};
    if (views[i].rounds == nullptr) continue;
    const auto cover = [&](const auto& shape) {
      const auto first = views[i].rounds->triangles.begin() + shape.first;
      view.covered.insert(view.covered.end(), first, first + shape.count);
    };
    for (const Round& round : views[i].rounds->rounds)
      if (round.kind != RoundKind::circle) cover(round);
    for (std::size_t k = 0; k < views.size(); ++k)
      if (views[k].rounds == views[i].rounds)
        for (const SeenFlats& seen : measured[k].flats) cover(*seen.flats);
    std::sort(view.covered.begin(), view.covered.end());
  }
  return stepped;
}

/// The rows of positions of all views, and their steps. `measured` may be empty below Dimensioning::holes.
PlannedRows plan_rows(std::span<const DimensionedView> views, const std::vector<MeasuredView>& measured,
                      const DimensionOptions& options) {
  PlannedRows planned{std::vector<glm::dvec2>(views.size(), glm::dvec2(0)), std::vector<ViewSteps>(views.size())};
  if (options.level < Dimensioning::holes) return planned;
  if (options.level >= Dimensioning::all) planned.steps = steps_of(stepped_views(views, measured));
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (!views[i].is_dimensioned || measured[i].box.is_empty()) continue;
    const MeasuredView& view = measured[i];
    const Flats* const bounds[] = {view.extent(0).flats, view.extent(1).flats};  // their positions are overall sizes
    const bool has_places = std::any_of(view.circles.begin(), view.circles.end(),
                                        [](const SeenCircle& c) { return c.round->turn >= least_turn; }) ||
                            std::any_of(view.flats.begin(), view.flats.end(), [&](const SeenFlats& seen) {
                              return seen.flats != bounds[0] && seen.flats != bounds[1];
                            });
    for (const int axis : {0, 1}) {
      const std::vector<PlaneStep>& steps = planned.steps[i][std::size_t(axis)];
      if (has_places || std::any_of(steps.begin(), steps.end(), [](const PlaneStep& step) { return !step.is_spare; }))
        planned.rooms[i][1 - axis] = position_room(view, axis, steps, options);
    }
  }
  return planned;
}

void validate(const DimensionOptions& options) {
  if (!(options.numbers_per_unit > 0 && std::isfinite(options.numbers_per_unit)))
    throw Error(ErrorCode::bad_argument, "numbers_per_unit", "must be above 0 and finite");
  if (options.number_style.most_decimals < 0 || options.number_style.most_decimals > 6)
    throw Error(ErrorCode::bad_argument, "decimals", "must be from 0 to 6");
  if (!(options.text_height >= 0.5 && options.text_height <= 100))
    throw Error(ErrorCode::bad_argument, "text_height", "must be from 0.5 to 100 millimetres");
}

/// The number as a whole number and a reduced fraction of 64ths. Empty if it is no such number, or is nearly 0.
std::string fraction_text(double size) {
  constexpr std::int64_t finest = 64;
  constexpr double tolerance = 0.0005, most = 1e12;
  if (!(size < most)) return "";
  const std::int64_t parts = std::llround(size * finest), rest = parts % finest, common = std::gcd(rest, finest);
  if (parts == 0 || std::abs(size - double(parts) / finest) > tolerance) return "";
  const std::string whole = parts >= finest ? std::to_string(parts / finest) : "";
  if (rest == 0) return whole;
  const std::string fraction = std::to_string(rest / common) + "/" + std::to_string(finest / common);
  return whole.empty() ? fraction : whole + " " + fraction;
}

}  // namespace

std::string dimension_text(double number, const NumberStyle& style) {
  const double size = std::abs(number);
  if (const std::string fraction = style.with_fractions ? fraction_text(size) : ""; !fraction.empty()) return fraction;
  int decimals = style.most_decimals;
  // Below 1, three significant digits are as precise as two decimals above 1.
  if (size > 0 && size < 1) decimals = std::max(decimals, std::min(9, 2 - int(std::floor(std::log10(size)))));
  double unit = 1;
  for (int i = 0; i < decimals; ++i) unit *= 10;
  // Noise would decide how a half is rounded, so one more digit is written.
  constexpr double noise = 2e-4;
  const double off = std::abs(size * unit - std::round(size * unit));
  if (std::abs(off - 0.5) < noise) unit *= 10;
  if (!(size * unit < 9e15)) return std::to_string(number);
  const auto whole = std::int64_t(std::llround(size * unit)), one = std::int64_t(unit);
  std::string text = std::to_string(whole / one), rest = std::to_string(whole % one + one).substr(1);
  while (!rest.empty() && rest.back() == '0') rest.pop_back();
  return rest.empty() ? text : text + "." + rest;
}

std::vector<OverallSizes> overall_sizes_of(std::span<const DimensionedView> views) {
  std::vector<OverallSizes> all(views.size());
  std::vector<glm::dvec3> known;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (!views[i].is_dimensioned) continue;
    const auto take = [&](const glm::dvec3& direction) {
      for (const glm::dvec3& other : known)
        if (std::abs(glm::dot(other, direction)) > same_direction) return false;
      known.push_back(direction);
      return true;
    };
    all[i].width = take(views[i].drawing->view.right());
    all[i].height = take(views[i].drawing->view.up());
  }
  return all;
}

std::vector<glm::dvec2> position_rooms_of(std::span<const DimensionedView> views, const DimensionOptions& options) {
  std::vector<MeasuredView> measured;
  if (options.level >= Dimensioning::holes)
    for (const DimensionedView& view : views) measured.emplace_back(view, options.level);
  return plan_rows(views, measured, options).rooms;
}

glm::dvec2 room_for(const OverallSizes& sizes, const glm::dvec2& positions, double text_height) {
  return {positions.x + (sizes.height ? first_distance + text_height + 2 * text_distance : 0),
          positions.y + (sizes.width ? first_distance + extension_overshoot + text_distance : 0)};
}

Dimensions place_dimensions(std::span<const DimensionedView> views, const PageBox& area, std::span<const PageBox> taken,
                            const DimensionOptions& options) {
  validate(options);
  Obstacles obstacles(area);
  std::vector<MeasuredView> measured;
  for (const DimensionedView& view : views) {
    measured.emplace_back(view, options.level);
    obstacles.add(*view.sheet);
  }
  for (const PageBox& box : taken) obstacles.add(box);
  const std::vector<OverallSizes> shares = overall_sizes_of(views);
  Dimensions all;
  DimensionPen pen(options, obstacles);
  Diameters diameters{options, pen, obstacles};
  const PlannedRows planned = plan_rows(views, measured, options);
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (measured[i].box.is_empty()) continue;
    for (const int axis : {0, 1}) {
      if (!(axis == 0 ? shares[i].width : shares[i].height)) continue;
      const Extent extent = measured[i].extent(axis);
      if (!(extent.size > 0)) continue;
      std::string text = dimension_text(extent.size * options.numbers_per_unit, options.number_style);
      if (extent.diameter != nullptr) {
        if (!diameters.take(*extent.diameter)) continue;
        text = counted(diameters.rings_about(*extent.diameter, measured[i]), diameter_sign + text);
      } else if (extent.flats != nullptr && options.level >= Dimensioning::all && diameters.take(*extent.flats)) {
        text = flats_sign + text;
      }
      const glm::dvec2 within = views[i].taken + planned.rooms[i];
      draw_overall_size(pen, {measured[i], axis, extent, within}, text, options.numbers_per_unit);
      ++all.count;
    }
  }
  if (options.level >= Dimensioning::diameters) {
    std::vector<std::vector<Diameters::Group>> groups(views.size());
    std::set<std::size_t> missed;
    for (std::size_t i = 0; i < views.size(); ++i) {
      if (!views[i].is_dimensioned) continue;
      groups[i] = diameters.groups_of(measured[i], all);
      if (options.level >= Dimensioning::all)
        for (Diameters::Group& flats : diameters.flats_of(measured[i])) groups[i].push_back(std::move(flats));
      for (const int axis : {0, 1}) {
        const DimensionLine row(measured[i], axis, measured[i].extent(axis), views[i].taken);
        if (!(planned.rooms[i][1 - axis] > 0) || row.extent.diameter != nullptr) continue;
        const std::vector<Position> chosen =
            chosen_positions(positions_of(row, groups[i], planned.steps[i][std::size_t(axis)], missed), row.away,
                             number_room(row.extent, options), all.left_out);
        for (const Position& position : chosen)
          for (const std::size_t plane : position.planes) missed.erase(plane);
        draw_positions(pen, row, chosen, options);
        all.count += chosen.size();
      }
    }
    all.left_out += missed.size();
    for (const std::vector<Diameters::Group>& of_view : groups) diameters.add(of_view, all);
    for (std::size_t i = 0; i < views.size() && options.level >= Dimensioning::all; ++i)
      if (views[i].is_dimensioned) diameters.add(diameters.sides_of(measured[i]), all);
    for (std::size_t i = 0; i < views.size() && options.level >= Dimensioning::all; ++i)
      if (views[i].is_dimensioned) diameters.add(diameters.radii_of(measured[i]), all);
    for (std::size_t i = 0; i < views.size(); ++i)
      if (views[i].is_dimensioned) diameters.count_missing(measured[i], all);
  }
  all.layer.groups = pen.take();
  return all;
}

}  // namespace frontmost::detail
