// SPDX-License-Identifier: Apache-2.0
// An edge is compared with the nearest occluders of a cell first, until its part in the cell is hidden.
//
//   edge ----> cells that it passes ----> boxes that overlap it ----> triangles that hide it ----> intervals
//              (OccluderGrid)             (kernels, 16 at once)       (kernels, 8 at once)         (HiddenIntervals)
//
// A vertex of the triangle is in the planes through it by its number, not by arithmetic. No sign is rounded.
#include "lines/hiding/hidden_parts.h"

#include <bit>
#include <cmath>

namespace frontmost::lines_detail {
namespace {

Signed times(const Signed& value, int sign) { return {value.value * sign, value.sign * sign}; }

/// Where the line of sight to the edge meets the triangle's plane beyond the near plane. If n is the triangle's normal,
/// A a point of the triangle, and E the eye, then the line of sight to a point X meets the plane at the distance of X
/// times n.(A - E) / n.(X - E).
Interval beyond_near(const Occluder& occluder, const SightedEdge& edge, const Sight& sight, const glm::dvec3& n) {
  const glm::dvec3 a(occluder.corners[0]);
  const auto beyond = [&](const glm::dvec3& x, double distance) {
    const double value = sight.is_parallel()
                             ? (distance - sight.near()) * glm::dot(n, sight.forward()) - glm::dot(n, x - a)
                             : distance * glm::dot(n, a - sight.eye()) - sight.near() * glm::dot(n, x - sight.eye());
    return with_sign_of_value(-occluder.turn * value);
  };
  return where_positive(beyond(edge.from, edge.from_distance), beyond(edge.to, edge.to_distance), false);
}

struct OccluderCorners {
  glm::dvec3 at[3];
  const std::uint32_t (&vertices)[3];

  explicit OccluderCorners(const Occluder& o)
      : at{glm::dvec3(o.corners[0]), glm::dvec3(o.corners[1]), glm::dvec3(o.corners[2])}, vertices(o.vertices) {}
  [[nodiscard]] bool has(std::uint32_t vertex, int a, int b) const {
    return vertex == vertices[a] || vertex == vertices[b];
  }
};

/// The part of `hidden` within the planes through the eye. `along(third)`: whether an edge counts that lies in one of
/// these planes from end to end, with the corner `third` opposite.
template <class Along>
Interval in_shadow(const Occluder& occluder, const SightedEdge& edge, const Sight& sight, Interval hidden,
                   const Along& along) {
  const OccluderCorners corners(occluder);
  constexpr int sides[3][2] = {{0, 1}, {1, 2}, {0, 2}};
  for (int k = 0; k < 3 && hidden.begin < hidden.end; ++k) {
    const int a = sides[k][0], b = sides[k][1];
    const Sight::EyePlane side = sight.plane_through(corners.at[a], corners.at[b]);
    const auto turn = [&](const EndOn& on, const glm::dvec3& place) {
      if (corners.has(on[0], a, b) && corners.has(on[1], a, b)) return Signed{};
      return times(side.turn(place, edge.slack), k < 2 ? occluder.turn : -occluder.turn);
    };
    const Signed from = turn(edge.from_on, edge.from), to = turn(edge.to_on, edge.to);
    if (from.sign == 0 && to.sign == 0 && !along(corners.at[3 - a - b])) return {};
    hidden = overlap(hidden, where_positive(from, to, false));
  }
  if (occluder.is_near && hidden.begin < hidden.end) {
    const FacePlane plane(corners.at[0], corners.at[1], corners.at[2]);
    hidden = overlap(hidden, beyond_near(occluder, edge, sight, plane.normal()));
  }
  return hidden;
}

/// Whether an end of an edge lies on a side or a vertex of the occluder, by the numbers of vertices.
bool has_end(const Occluder& occluder, const EndOn& on) {
  const auto& v = occluder.vertices;
  const auto has = [&](std::uint32_t vertex) { return vertex == v[0] || vertex == v[1] || vertex == v[2]; };
  return has(on[0]) && has(on[1]);
}

/// Whether the edge has a constructed end, and an end on the occluder. The kernel computes the depth of such an end.
bool has_end_by_numbers(const Occluder& occluder, const SightedEdge& edge) {
  return edge.slack > 0 && (has_end(occluder, edge.from_on) || has_end(occluder, edge.to_on));
}

bool is_own(const Occluder& occluder, const SightedEdge& edge) {
  return occluder.triangle == edge.own[0] || occluder.triangle == edge.own[1];
}

constexpr std::size_t kMostAtOnce = 64, kBlock = 16;
/// A margin, in units of cells, below the tolerance of sides and above the rounding error of a place.
constexpr double kEndPad = 5e-6;

/// A float that is not greater than the value, in spite of rounding.
float wide_low(double value) { return float(value - 1e-6 * std::abs(value)); }
float wide_high(double value) { return -wide_low(-value); }

/// An edge and its ends in eye space, with the planar distance in place of z.
struct EdgeInEye {
  SightedEdge edge;
  glm::dvec3 from, to;

  EdgeInEye(const SightedEdge& its_edge, const Sight& sight)
      : edge(its_edge), from(sight.in_eye(edge.from)), to(sight.in_eye(edge.to)) {
    edge.from_distance = from.z;
    edge.to_distance = to.z;
  }
  [[nodiscard]] double distance(double t) const { return from.z + (to.z - from.z) * t; }
};

Interval within_view(const EdgeInEye& edge, const Projection& p) {
  Interval shown{0, 1};
  const auto keep = [&](double at_0, double at_1) {
    shown = overlap(shown, where_positive(with_sign_of_value(at_0), with_sign_of_value(at_1), false));
  };
  const double w0 = p.orthographic ? 1 : edge.from.z, w1 = p.orthographic ? 1 : edge.to.z;
  keep(edge.from.z - p.clip.near, edge.to.z - p.clip.near);
  if (p.clip.far < std::numeric_limits<double>::infinity()) keep(p.clip.far - edge.from.z, p.clip.far - edge.to.z);
  keep(edge.from.x - p.left * w0, edge.to.x - p.left * w1);
  keep(p.right * w0 - edge.from.x, p.right * w1 - edge.to.x);
  keep(edge.from.y - p.bottom * w0, edge.to.y - p.bottom * w1);
  keep(p.top * w0 - edge.from.y, p.top * w1 - edge.to.y);
  return shown;
}

/// The edge's point at t, in pixels. Precondition: the point is within the view.
glm::dvec2 on_screen(const EdgeInEye& edge, double t, const EdgeOccluders& o) {
  glm::dvec3 p = place_between(edge.from, edge.to, t);
  // Rounding may put the point outside of the view, if the edge is very much longer than its part in the view.
  p.z = std::max(p.z, o.sight.near());
  return glm::clamp(glm::dvec2(o.sight.to_screen(p)), glm::dvec2(0), glm::dvec2(o.view.width, o.view.height));
}

enum class Asked { what_hides, what_covers_the_outer_side };

/// A query about a span of an edge.
struct EdgeQuestion {
  const EdgeOccluders& o;
  const EdgeInEye& edge;
  const Interval span;
  const Asked asked;
  const glm::dvec2 begin, end;  ///< ends of the span, in cells
  const float farthest;         ///< greatest distance of the edge, beyond which no occluder matters

  EdgeQuestion(const EdgeOccluders& occlusion, const EdgeInEye& its_edge, const Interval& its_span, Asked what)
      : o(occlusion),
        edge(its_edge),
        span(its_span),
        asked(what),
        begin(on_screen(edge, span.begin, o) * o.grid.scale()),
        end(on_screen(edge, span.end, o) * o.grid.scale()),
        farthest(hides() ? wide_high(std::max(edge.from.z, edge.to.z)) : std::numeric_limits<float>::infinity()) {}

  [[nodiscard]] bool hides() const { return asked == Asked::what_hides; }
};

/// An interval that contains the part of the edge in a cell, with a margin.
Interval part_in(const PassedCell& cell, const EdgeQuestion& question) {
  const Interval& span = question.span;
  const glm::dvec2 along = question.end - question.begin;
  const int axis = std::abs(along.y) > std::abs(along.x);
  if (std::abs(along[axis]) < 1e-3) return span;
  const EdgeInEye& edge = question.edge;
  const auto at = [&](double coordinate, double margin) {
    const double s =
        std::clamp((coordinate - question.begin[axis]) / along[axis] + margin / std::abs(along[axis]), 0.0, 1.0);
    const double w0 = question.o.sight.to_weight(edge.from, edge.to, span.begin),
                 w1 = question.o.sight.to_weight(edge.from, edge.to, span.end);
    const double share = s * w0 / (s * w0 + (1 - s) * w1);
    return span.begin + share * (span.end - span.begin);
  };
  const bool is_forward = along[axis] > 0;
  return overlap(span, {at(is_forward ? cell.low[axis] : cell.high[axis], -2e-6) - 1e-12,
                        at(is_forward ? cell.high[axis] : cell.low[axis], 2e-6) + 1e-12});
}

/// A part of the edge, as it appears in a cell.
struct PartInCell {
  ScreenPart box;
  ScreenSegment segment;
};

PartInCell seen_in(const PassedCell& cell, const Interval& part, const EdgeQuestion& question) {
  const double scale = question.o.grid.scale();
  const glm::dvec2 a = on_screen(question.edge, part.begin, question.o) * scale,
                   b = on_screen(question.edge, part.end, question.o) * scale;
  const glm::dvec2 low = glm::min(a, b) - kEndPad, high = glm::max(a, b) + kEndPad;
  const glm::dvec2 corner(cell.square.x, cell.square.y);
  const double from = question.edge.distance(part.begin), to = question.edge.distance(part.end);
  float farthest = question.farthest;
  // An occluder that covers the outer side may lie behind the edge.
  float from_nearness = -std::numeric_limits<float>::infinity(), to_nearness = from_nearness;
  if (question.hides()) {
    farthest = std::min(farthest, wide_high(std::max(from, to)));
    from_nearness = float(nearness(from, question.o.sight.is_parallel()));
    to_nearness = float(nearness(to, question.o.sight.is_parallel()));
  }
  return {{{wide_low(low.x), wide_low(low.y)}, {wide_high(high.x), wide_high(high.y)}, farthest},
          {glm::vec2(a - corner), glm::vec2(b - corner), from_nearness, to_nearness}};
}

/// Compares the occluders of the batch with the edge. \returns whether more may be hidden than before.
bool hold_against_batch(const EdgeQuestion& question, EdgeSearch& search) {
  const SightedEdge& edge = question.edge.edge;
  HiddenBatch found;
  search.work += 256;
  (question.hides() ? question.o.kernels.hide : question.o.kernels.cover)(search.batch, edge, question.o.sight, found);
  for (std::uint32_t bits = found.hides | found.open; bits != 0; bits &= bits - 1) {
    const auto i = std::size_t(std::countr_zero(bits));
    const Occluder& occluder = *search.batch.occluders[i];
    Interval interval{found.begin[i], found.end[i]};
    if ((found.open >> i & 1) || occluder.is_near || is_own(occluder, edge) || has_end_by_numbers(occluder, edge))
      interval = (question.hides() ? hidden_by : covered_by)(occluder, edge, question.o.sight);
    search.hidden.add(overlap(interval, question.span), occluder.triangle);
  }
  search.batch.count = 0;
  return (found.hides | found.open) != 0;
}

/// Adds the entries whose bits are set, counted from `first`, to the batch, and compares each full batch. \returns
/// false when nothing is left to hide in this cell.
bool ask_entries(std::uint64_t bits, std::size_t first, const PassedCell& cell, const EdgeQuestion& question,
                 EdgeSearch& search) {
  for (; bits != 0; bits &= bits - 1) {
    const Occluder& occluder = question.o.grid.occluder(first + std::size_t(std::countr_zero(bits)));
    const std::uintptr_t place = reinterpret_cast<std::uintptr_t>(&occluder) / sizeof(Occluder);
    if (std::exchange(search.asked[place % search.asked.size()], &occluder) == &occluder) continue;
    search.batch.add(occluder);
    if (search.batch.count == OccluderBatch::most && hold_against_batch(question, search) &&
        search.hidden.cover(part_in(cell, question)))
      return false;
  }
  return true;
}

/// For cells of many entries: asks the nearest first, then those just before the edge, until nothing in the cell is
/// open. In a stack of triangles, those between hide less and less.
void ask_many(const OccluderGrid::Visit& cell, const EdgeQuestion& question, EdgeSearch& search) {
  const OccluderGrid& grid = question.o.grid;
  Interval open = search.hidden.open_part(part_in(cell, question));
  if (!(open.begin < open.end)) return;
  PartInCell in = seen_in(cell, open, question);
  const float* nearest = grid.boxes(cell.first).nearest;
  const auto before =
      std::size_t(std::upper_bound(nearest, nearest + (cell.last - cell.first), in.box.farthest) - nearest);
  const std::size_t blocks = (before + kBlock - 1) / kBlock;
  for (std::size_t i = 0; i < blocks; ++i) {
    const std::size_t offset = (i == 0 ? 0 : blocks - i) * kBlock, count = std::min(kBlock, before - offset);
    search.work += count;
    std::uint64_t bits = question.o.kernels.overlapping(grid.boxes(cell.first + offset), count, in.box);
    if (bits != 0) bits &= question.o.kernels.within_sides(grid.sides(cell.cell, offset), count, in.segment);
    if (bits == 0) continue;
    if (!ask_entries(bits, cell.first + offset, cell, question, search)) return;
    if (search.batch.count == 0 || !hold_against_batch(question, search)) continue;
    open = search.hidden.open_part(open);
    if (!(open.begin < open.end)) return;
    in = seen_in(cell, open, question);
  }
}

/// For cells of few entries: compares the edge with each entry, in order.
void ask_few(const OccluderGrid::Visit& cell, const EdgeQuestion& question, EdgeSearch& search) {
  const glm::dvec2 low = cell.low - kCellPad, high = cell.high + kCellPad;
  const ScreenPart part{{wide_low(low.x), wide_low(low.y)}, {wide_high(high.x), wide_high(high.y)}, question.farthest};
  for (std::size_t first = cell.first; first < cell.last; first += kMostAtOnce) {
    const ScreenBoxes boxes = question.o.grid.boxes(first);
    if (*boxes.nearest > question.farthest) return;
    const std::size_t count = std::min(kMostAtOnce, cell.last - first);
    search.work += count;
    if (!ask_entries(question.o.kernels.overlapping(boxes, count, part), first, cell, question, search)) return;
  }
}

/// Finds all hidden, or covered, intervals of the question's span.
void answer(const EdgeQuestion& question, EdgeSearch& search) {
  search.hidden.restart(question.o.counts && question.hides());
  search.asked.fill(nullptr);
  search.batch.count = 0;
  question.o.grid.visit_cells(question.begin, question.end, [&](const OccluderGrid::Visit& cell) {
    question.o.grid.has_sides(cell.cell) ? ask_many(cell, question, search) : ask_few(cell, question, search);
    return !search.hidden.cover(question.span);
  });
  if (search.batch.count > 0) (void)hold_against_batch(question, search);
}

/// Appends the parts of a span, cut where intervals begin and end.
void append_parts(const EdgeQuestion& question, EdgeSearch& search, std::uint32_t number,
                  std::vector<DrawnPart>& parts) {
  std::vector<std::pair<double, int>>& changes = search.changes;
  changes.clear();
  for (const HiddenIntervals::Hidden& one : search.hidden.intervals()) {
    changes.emplace_back(one.interval.begin, 1);
    changes.emplace_back(one.interval.end, -1);
  }
  changes.emplace_back(question.span.end, 0);
  std::sort(changes.begin(), changes.end());
  const std::size_t first = parts.size();
  double begin = question.span.begin;
  int depth = 0;
  for (const auto& [t, change] : changes) {
    if (t > begin) {
      const auto hidden_by = std::uint32_t(question.o.counts ? depth : std::min(depth, 1));
      if (parts.size() > first && parts.back().hidden_by == hidden_by)
        parts.back().end = t;
      else
        parts.push_back({number, begin, t, {}, {}, hidden_by});
      begin = t;
    }
    depth += change;
  }
  for (std::size_t i = first; i < parts.size(); ++i) {
    parts[i].from = i == first ? on_screen(question.edge, parts[i].begin, question.o) : parts[i - 1].to;
    parts[i].to = on_screen(question.edge, parts[i].end, question.o);
  }
}

/// Appends the pieces of a visible part, cut where triangles begin and end to cover its outer side.
void append_outline(DrawnPart part, const EdgeQuestion& question, HiddenIntervals& covered,
                    std::vector<DrawnPart>& pieces) {
  const DrawnPart whole = part;
  const auto cut_at = [&](double t, bool is_outline) {
    if (!(part.begin < t)) return;
    DrawnPart piece = part;
    piece.is_outline = is_outline;
    piece.end = t;
    piece.to = t < whole.end ? on_screen(question.edge, t, question.o) : whole.to;
    part.begin = t;
    part.from = piece.to;
    pieces.push_back(piece);
  };
  for (const HiddenIntervals::Hidden& one : covered.intervals()) {
    cut_at(one.interval.begin, true);
    cut_at(one.interval.end, false);
  }
  cut_at(whole.end, true);
}

}  // namespace

Interval where_positive(const Signed& at_0, const Signed& at_1, bool is_strict) {
  if (at_0.sign <= 0 && at_1.sign <= 0 && (is_strict || at_0.sign + at_1.sign < 0)) return {1, 0};
  if (at_0.sign >= 0 && at_1.sign >= 0) return {0, 1};
  const double root = root_between(at_0, at_1);
  return at_0.sign < 0 ? Interval{root, 1} : Interval{0, root};
}

Interval hidden_by(const Occluder& occluder, const SightedEdge& edge, const Sight& sight) {
  if (is_own(occluder, edge)) return {};
  const OccluderCorners corners(occluder);
  const FacePlane plane(corners.at[0], corners.at[1], corners.at[2]);
  const auto depth = [&](const EndOn& on, const glm::dvec3& place) {
    if (has_end(occluder, on)) return Signed{};
    return times(plane.height(place, edge.slack), -occluder.turn);
  };
  const Interval beyond = where_positive(depth(edge.from_on, edge.from), depth(edge.to_on, edge.to), true);
  return in_shadow(occluder, edge, sight, beyond, [](const glm::dvec3&) { return true; });
}

Interval covered_by(const Occluder& occluder, const SightedEdge& edge, const Sight& sight) {
  if (is_own(occluder, edge)) return {};
  return in_shadow(occluder, edge, sight, {0, 1}, [&](const glm::dvec3& third) {
    return sight.plane_through(edge.from, edge.to).turn(third).sign == edge.outer;
  });
}

void EdgeCutter::cut(const SightedEdge& sighted, std::uint32_t number, std::vector<DrawnPart>& parts) {
  const EdgeInEye edge(sighted, o_.sight);
  const Interval shown = within_view(edge, o_.view.projection);
  if (!(shown.begin < shown.end)) return;
  const EdgeQuestion hiding(o_, edge, shown, Asked::what_hides);
  answer(hiding, search_);
  const std::size_t first = parts.size();
  append_parts(hiding, search_, number, parts);
  if (!o_.outlines || sighted.outer == 0) return;
  std::vector<DrawnPart> pieces;
  for (std::size_t i = first; i < parts.size(); ++i) {
    if (parts[i].hidden_by == 0) {
      const EdgeQuestion covering(o_, edge, {parts[i].begin, parts[i].end}, Asked::what_covers_the_outer_side);
      answer(covering, search_);
      append_outline(parts[i], covering, search_.hidden, pieces);
    } else {
      pieces.push_back(parts[i]);
    }
  }
  parts.resize(first);
  parts.insert(parts.end(), pieces.begin(), pieces.end());
}

}  // namespace frontmost::lines_detail
