// SPDX-License-Identifier: Apache-2.0
// Hidden lines: which edges are drawn and why, and where each edge is hidden, by one surface or by two.
#include <frontmost/lines.h>
#include <frontmost/zbuffer.h>

#include <algorithm>

#include "web/lessons/lessons.h"

namespace frontmost::web {
namespace {

/// The part of an edge that one triangle hides.
struct HiddenSpan {
  PrimitiveId id = no_primitive;
  double begin = 0, end = 1;
};

/// Restricts an interval to the part where a value is positive. The value is linear between the ends of the edge.
void keep_positive(HiddenSpan& interval, double at_from, double at_to) {
  if (at_from <= 0 && at_to <= 0) {
    interval.end = interval.begin;
    return;
  }
  const double border = at_from / (at_from - at_to);
  if (at_from <= 0) interval.begin = std::max(interval.begin, border);
  if (at_to <= 0) interval.end = std::min(interval.end, border);
}

/// The part of an edge behind a triangle. The space behind it is bounded by three planes through the eye and the
/// triangle's plane.
HiddenSpan hidden_interval(const glm::dvec3& eye, const std::array<glm::vec3, 3>& corners, const DrawnEdge& edge) {
  HiddenSpan interval;
  const std::array<glm::dvec3, 3> p{glm::dvec3(corners[0]), glm::dvec3(corners[1]), glm::dvec3(corners[2])};
  // Keeps the side of a plane on which a point lies, or the other side.
  const auto keep = [&](const glm::dvec3& on_plane, const glm::dvec3& normal, const glm::dvec3& point, bool same_side) {
    const double side = glm::dot(normal, point - on_plane), sign = (side > 0) == same_side ? 1 : -1;
    const double from = glm::dot(normal, edge.from - on_plane) * sign;
    const double to = glm::dot(normal, edge.to - on_plane) * sign;
    // An edge in the plane, such as one of a neighbouring triangle, does not count as behind it, in spite of rounding.
    const double least = 1e-6 * std::abs(side);
    keep_positive(interval, std::abs(from) < least ? 0 : from, std::abs(to) < least ? 0 : to);
  };
  for (std::size_t i = 0; i < 3; ++i) keep(eye, glm::cross(p[i] - eye, p[(i + 1) % 3] - eye), p[(i + 2) % 3], true);
  keep(p[0], glm::cross(p[1] - p[0], p[2] - p[0]), eye, false);
  return interval;
}

PlainJson intervals_json(const Surfaces& surfaces, const View& view, const DrawnEdge& edge) {
  PlainJson json = PlainJson::array();
  for (PrimitiveId id = 0; id < surfaces.primitive_count(); ++id) {
    const HiddenSpan interval = hidden_interval(view.eye(), surfaces.corners(id), edge);
    constexpr double least = 1e-6;
    if (interval.end - interval.begin < least) continue;
    json.push_back({{"triangle", id},
                    {"begin", interval.begin},
                    {"end", interval.end},
                    {"lines", lines_json(view, sides_of(surfaces.corners(id)))}});
  }
  return json;
}

}  // namespace

PlainJson lines_lesson(const PlainJson& question) {
  static Bitmap picture;
  static std::vector<float> parts;
  const LessonScene& stage = lesson_scene(question);
  const View view = lesson_view(stage, question);
  LineOptions options;
  options.counts_hidden = true;
  const Drawing drawing = draw_lines(stage.surfaces, view, options);
  picture = lesson_picture(stage, zbuffer(stage.surfaces, view));
  std::array<std::size_t, edge_kind_count> kinds{};
  for (const DrawnEdge& edge : drawing.edges) ++kinds[std::size_t(edge.kind)];
  parts.clear();
  for (const DrawnPart& part : drawing.parts)
    for (const double value : {double(part.edge), double(drawing.edges[part.edge].kind), double(part.hidden_by),
                               part.from.x, part.from.y, part.to.x, part.to.y, part.begin, part.end})
      parts.push_back(float(value));
  PlainJson answer = {{"width", view.width},
                      {"height", view.height},
                      {"pixels", place_of(picture.rgba.data(), picture.rgba.size())},
                      {"parts", place_of(parts.data(), parts.size())},
                      {"edges", drawing.edges.size()},
                      {"boundaries", kinds[std::size_t(EdgeKind::boundary)]},
                      {"silhouettes", kinds[std::size_t(EdgeKind::silhouette)]},
                      {"borders", kinds[std::size_t(EdgeKind::border)]},
                      {"creases", kinds[std::size_t(EdgeKind::crease)]},
                      {"intersections", kinds[std::size_t(EdgeKind::intersection)]}};
  const std::size_t edge = question.value("edge", drawing.edges.size());
  if (edge < drawing.edges.size()) answer["intervals"] = intervals_json(stage.surfaces, view, drawing.edges[edge]);
  return answer;
}

}  // namespace frontmost::web
