// SPDX-License-Identifier: Apache-2.0
//           |                 A circle seen along its axis has a cross; a cylinder seen from the side has its axis.
//        .--+--.              Both are a little longer than the round itself. All are pieces of straight lines,
//     --(---+---)--           sorted by direction, by the line's distance from the corner of the picture, and along
//        '--+--'              the line.
//           |
// A piece is joined to the one before on the same line if a drafter would draw across the gap.
#include <algorithm>
#include <tuple>

#include "rounds/found_rounds.h"

namespace frontmost {
namespace {

constexpr double kSquare = 2e-3;  // sine of an axis' greatest angle to the line of sight, or to the picture's plane
constexpr double kSameDirection = 2e-4;  // radians
constexpr double kLeastDrawn = 0.2;      // share of a round's own length that must be drawn
constexpr double kLeastSize = 1.0 / 6;   // radius of the smallest circle, as a share of the overshoot
constexpr double kLeastOvershoot = 1.0 / 3;
constexpr double kSameLine = 1.0 / 6;    // greatest offset within one line, as a share of the overshoot: two pen widths
constexpr double kWidestGap = 10.0 / 3;  // between bores of one axis, as a share of the overshoot
constexpr double kWidestGapInRadii = 4.0;  // in radii of the smaller bore; applies if it is more

/// A piece of a straight line.
struct AxisPiece {
  glm::dvec2 direction;  ///< unit length
  double offset;         ///< distance of the line from the origin, to the left of its direction
  double begin, end;     ///< along the line
  double radius;         ///< radius of the round to which the piece belongs
};

AxisPiece piece_between(const glm::dvec2& from, const glm::dvec2& to, double radius) {
  glm::dvec2 d = glm::normalize(to - from);
  if (std::abs(d.x) < kSameDirection) d = {0, 1};
  if (std::abs(d.y) < kSameDirection) d = {1, 0};
  if (d.x < 0) d = -d;
  const glm::dvec2 left(d.y, -d.x);
  const double a = glm::dot(d, from), b = glm::dot(d, to);
  return {d, (glm::dot(left, from) + glm::dot(left, to)) / 2, std::min(a, b), std::max(a, b), radius};
}

/// Joins pieces of one line where `joins` accepts the gap; the result is sorted by direction and place.
template <class Joins>
std::vector<AxisPiece> joined_pieces(std::vector<AxisPiece> pieces, double same_line, const Joins& joins) {
  const auto angle = [](const AxisPiece& p) { return std::atan2(p.direction.y, p.direction.x); };
  std::sort(pieces.begin(), pieces.end(), [&](const AxisPiece& a, const AxisPiece& b) { return angle(a) < angle(b); });
  std::vector<AxisPiece> all;
  for (auto turned = pieces.begin(); turned != pieces.end();) {
    const auto other = std::find_if(turned, pieces.end(),
                                    [&](const AxisPiece& p) { return angle(p) - angle(*turned) > kSameDirection; });
    std::sort(turned, other, [](const AxisPiece& a, const AxisPiece& b) { return a.offset < b.offset; });
    for (auto line = turned; line != other;) {
      const auto end =
          std::find_if(line, other, [&](const AxisPiece& p) { return p.offset - line->offset > same_line; });
      std::sort(line, end, [](const AxisPiece& a, const AxisPiece& b) {
        return std::tie(a.begin, a.end, a.radius) < std::tie(b.begin, b.end, b.radius);
      });
      const std::size_t first = all.size();
      for (; line != end; ++line) {
        if (all.size() > first && joins(all.back(), *line)) {
          all.back().end = std::max(all.back().end, line->end);
          all.back().radius = std::max(all.back().radius, line->radius);
        } else {
          all.push_back(*line);
        }
      }
    }
    turned = other;
  }
  return all;
}

struct CentreLiner {
  void add(const Round& round, double drawn) {
    const double radius = round.radius * pixels, length = glm::distance(round.from, round.to) * pixels;
    if (radius < kLeastSize * overshoot) return;
    if (glm::length(glm::cross(round.axis, view.forward())) <= kSquare) {
      if (drawn >= kLeastDrawn * round.turn * radius) add_cross(on_screen(view, round.from), radius);
    } else if (std::abs(glm::dot(round.axis, view.forward())) <= kSquare && drawn >= kLeastDrawn * length) {
      // A circle that is seen from the side appears as a line. It has no length along its axis, but may lengthen the
      // axis of other rounds.
      if (drawn < kLeastDrawn * radius) return;
      const glm::dvec2 middle = on_screen(view, (round.from + round.to) * 0.5);
      const glm::dvec2 ahead = on_screen(view, (round.from + round.to) * 0.5 + round.axis) - middle;
      const glm::dvec2 half = glm::normalize(ahead) * std::max(length / 2, 1e-6);
      axes.push_back(piece_between(middle - half, middle + half, radius));
    }
  }

  void add_cross(const glm::dvec2& centre, double radius) {
    if (radius < kLeastSize * overshoot) return;
    const double reach = radius + beyond(radius);
    for (const glm::dvec2 arm : {glm::dvec2(reach, 0), glm::dvec2(0, reach)})
      crosses.push_back(piece_between(centre - arm, centre + arm, radius));
  }

  [[nodiscard]] std::vector<CentreLine> run() const {
    const double same_line = kSameLine * overshoot;
    std::vector<AxisPiece> pieces = joined_pieces(axes, same_line, [&](const AxisPiece& a, const AxisPiece& b) {
      return b.begin - a.end <= std::max(kWidestGap * overshoot, kWidestGapInRadii * std::min(a.radius, b.radius));
    });
    std::erase_if(pieces, [](const AxisPiece& p) { return p.end - p.begin < 1e-3; });
    for (AxisPiece& piece : pieces) {
      piece.begin -= beyond(piece.radius);
      piece.end += beyond(piece.radius);
    }
    pieces.insert(pieces.end(), crosses.begin(), crosses.end());
    pieces = joined_pieces(std::move(pieces), same_line,
                           [](const AxisPiece& a, const AxisPiece& b) { return b.begin <= a.end; });
    std::vector<CentreLine> lines;
    for (const AxisPiece& p : pieces) {
      const glm::dvec2 foot = p.offset * glm::dvec2(p.direction.y, -p.direction.x);
      lines.push_back({foot + p.begin * p.direction, foot + p.end * p.direction});
    }
    return lines;
  }

  [[nodiscard]] double beyond(double radius) const {
    return std::clamp(radius, kLeastOvershoot * overshoot, overshoot);
  }

  const View& view;
  const double overshoot;
  const double pixels = view.width / (view.projection.right - view.projection.left);  ///< per unit of the scene
  std::vector<AxisPiece> axes{}, crosses{};
};

}  // namespace

std::vector<double> drawn_lengths(const Rounds& all, const Drawing& drawing, bool with_hidden) {
  std::vector<std::pair<PrimitiveId, std::uint32_t>> owners;
  for (std::uint32_t r = 0; r < all.rounds.size(); ++r)
    for (std::uint32_t i = 0; i < all.rounds[r].count; ++i)
      owners.emplace_back(all.triangles[all.rounds[r].first + i], r);
  std::sort(owners.begin(), owners.end());
  std::vector<double> lengths(all.rounds.size());
  const auto is_on = [](const Round& round, const glm::dvec3& point) {
    if (round.kind == RoundKind::revolved) return true;
    const glm::dvec3 u = point - round.from;
    const double height = glm::dot(u, round.axis), off = glm::length(u - height * round.axis) - round.radius;
    return std::abs(off) <= 0.02 * round.radius &&
           (round.kind == RoundKind::cylinder || std::abs(height) <= 0.02 * round.radius);
  };
  for (const DrawnPart& part : drawing.parts) {
    if (part.hidden_by != 0 && !with_hidden) continue;
    const DrawnEdge& edge = drawing.edges[part.edge];
    std::uint32_t last = no_index;
    for (const PrimitiveId id : {edge.left, edge.right}) {
      for (auto o = std::lower_bound(owners.begin(), owners.end(), std::pair(id, 0u));
           o != owners.end() && o->first == id; ++o) {
        const Round& round = all.rounds[o->second];
        if (o->second == last || !is_on(round, edge.from) || !is_on(round, edge.to)) continue;
        last = o->second;
        lengths[last] += glm::distance(part.from, part.to);
      }
    }
  }
  return lengths;
}

glm::dvec2 on_screen(const View& view, const glm::dvec3& point) {
  const glm::dvec3 offset = point - view.eye();
  const Projection& p = view.projection;
  return {(glm::dot(offset, view.right()) - p.left) / (p.right - p.left) * view.width,
          (p.top - glm::dot(offset, view.up())) / (p.top - p.bottom) * view.height};
}

std::vector<CentreLine> centre_lines_of(const Rounds& rounds, const Drawing& drawing, const Strokes& strokes,
                                        const CentreLineOptions& options) {
  if (!(options.overshoot > 0 && options.overshoot <= 1e6))
    throw Error(ErrorCode::bad_argument, "overshoot", "must be above 0, and at most a million pixels");
  if (!drawing.view.projection.orthographic) return {};
  CentreLiner liner{drawing.view, options.overshoot};
  const std::vector<double> lengths = drawn_lengths(rounds, drawing, options.with_hidden);
  for (std::size_t i = 0; i < lengths.size(); ++i) liner.add(rounds.rounds[i], lengths[i]);
  for (const Stroke& stroke : strokes.strokes) {
    if (!stroke.is_closed || stroke.count != 2 || strokes.bulges.empty()) continue;
    if (stroke.is_hidden && !options.with_hidden) continue;
    if (std::abs(std::abs(strokes.bulges[stroke.first]) - 1) > 1e-6) continue;
    const glm::dvec2 a = strokes.points[stroke.first], b = strokes.points[stroke.first + 1];
    liner.add_cross((a + b) * 0.5, glm::distance(a, b) / 2);
  }
  return liner.run();
}

}  // namespace frontmost
