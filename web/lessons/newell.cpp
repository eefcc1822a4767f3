// SPDX-License-Identifier: Apache-2.0
// The tests of Newell, Newell and Sancha for each pair of triangles, in their order, until one decides.
#include <frontmost/painter.h>
#include <frontmost/zbuffer.h>

#include <algorithm>
#include <numeric>

#include "web/lessons/lessons.h"

namespace frontmost::web {
namespace {

/// A triangle in eye coordinates, with its screen positions.
struct NewellTriangle {
  PrimitiveId id = no_primitive;
  std::array<glm::dvec3, 3> world{};
  std::array<glm::dvec2, 3> screen{};
  double near = 0, far = 0;
  glm::dvec2 low{0}, high{0};
  glm::dvec3 normal{0};  ///< towards the eye; 0 if seen edge-on

  [[nodiscard]] double side(const glm::dvec3& point) const { return glm::dot(normal, point - world[0]); }
};

NewellTriangle seen_triangle(const Surfaces& surfaces, const View& view, PrimitiveId id) {
  NewellTriangle t;
  t.id = id;
  t.near = std::numeric_limits<double>::infinity();
  t.low = glm::dvec2(t.near), t.high = -t.low;
  const std::array<glm::vec3, 3> corners = surfaces.corners(id);
  for (std::size_t i = 0; i < 3; ++i) {
    t.world[i] = glm::dvec3(corners[i]);
    t.screen[i] = pixel_of_point(view, t.world[i]);
    const double depth = from_eye(view, t.world[i]).z;
    t.near = std::min(t.near, depth), t.far = std::max(t.far, depth);
    t.low = glm::min(t.low, t.screen[i]), t.high = glm::max(t.high, t.screen[i]);
  }
  t.normal = glm::cross(t.world[1] - t.world[0], t.world[2] - t.world[0]);
  t.normal /= std::max(glm::length(t.normal), 1e-300);
  if (t.side(view.eye()) < 0) t.normal = -t.normal;
  return t;
}

/// Distance that rounding leaves for corners in a plane.
constexpr double kNothing = 1e-6;

bool is_behind(const NewellTriangle& p, const NewellTriangle& plane) {
  return std::all_of(p.world.begin(), p.world.end(), [&](const glm::dvec3& at) { return plane.side(at) <= kNothing; });
}
bool is_before(const NewellTriangle& p, const NewellTriangle& plane) {
  return std::all_of(p.world.begin(), p.world.end(), [&](const glm::dvec3& at) { return plane.side(at) >= -kNothing; });
}

/// Whether an edge of either triangle has the other one on its outer side.
bool are_apart(const NewellTriangle& p, const NewellTriangle& q) {
  for (const auto& [a, b] : {std::pair(&p, &q), std::pair(&q, &p)})
    for (std::size_t i = 0; i < 3; ++i) {
      const glm::dvec2 from = a->screen[i], along = a->screen[(i + 1) % 3] - from;
      const auto side = [&](const glm::dvec2& at) { return along.x * (at.y - from.y) - along.y * (at.x - from.x); };
      const double inside = side(a->screen[(i + 2) % 3]) > 0 ? 1 : -1;
      const double least = 1e-6 * glm::length(along);
      if (std::all_of(b->screen.begin(), b->screen.end(),
                      [&](const glm::dvec2& at) { return side(at) * inside <= least; }))
        return true;
    }
  return false;
}

struct NewellVerdict {
  std::vector<bool> tests;  ///< the five tests, then two with exchanged roles; if the last one holds, it decided
  const char* first = "cut";
};

/// Whether P, which reaches farther away, may be painted first.
NewellVerdict ask_pair(const NewellTriangle& p, const NewellTriangle& q) {
  NewellVerdict verdict;
  const auto holds = [&](bool test) {
    verdict.tests.push_back(test);
    return test;
  };
  if (holds(p.near >= q.far) ||
      holds(p.low.x >= q.high.x || q.low.x >= p.high.x || p.low.y >= q.high.y || q.low.y >= p.high.y) ||
      holds(is_behind(p, q)) || holds(is_before(q, p)) || holds(are_apart(p, q)))
    verdict.first = "p";
  else if (holds(is_behind(q, p)) || holds(is_before(p, q)))
    verdict.first = "q";
  return verdict;
}

PlainJson triangle_json(const NewellTriangle& t, const PlainJson& position) {
  return {{"triangle", t.id},
          {"near", t.near},
          {"far", t.far},
          {"corners", {to_json(t.screen[0]), to_json(t.screen[1]), to_json(t.screen[2])}},
          {"box", {t.low.x, t.low.y, t.high.x, t.high.y}},
          {"position", position}};
}

/// The library's painting position of each triangle; null if it cuts the triangle.
std::vector<PlainJson> positions_of(const Surfaces& surfaces, const View& view) {
  const PaintOrder order = painter(surfaces, view);
  std::vector<PlainJson> positions(surfaces.primitive_count());
  std::vector<int> pieces(positions.size());
  for (std::size_t i = 0; i < order.polygons.size(); ++i) {
    const PrimitiveId id = order.polygons[i].id;
    positions[id] = ++pieces[id] == 1 ? PlainJson(i) : PlainJson();
  }
  return positions;
}

}  // namespace

PlainJson newell_lesson(const PlainJson& question) {
  static Bitmap picture;
  const LessonScene& stage = lesson_scene(question);
  const View view = lesson_view(stage, question);
  constexpr std::uint32_t most_triangles = 200;
  if (stage.surfaces.primitive_count() > most_triangles)
    throw Error(ErrorCode::bad_argument, "scene", "more than 200 triangles");
  std::vector<NewellTriangle> triangles;
  for (PrimitiveId id = 0; id < stage.surfaces.primitive_count(); ++id)
    triangles.push_back(seen_triangle(stage.surfaces, view, id));
  std::stable_sort(triangles.begin(), triangles.end(),
                   [](const NewellTriangle& a, const NewellTriangle& b) { return a.far > b.far; });
  const std::vector<PlainJson> positions = positions_of(stage.surfaces, view);
  std::array<std::size_t, 5> by_test{};
  PlainJson pairs = PlainJson::array();
  for (std::size_t i = 0; i < triangles.size(); ++i)
    for (std::size_t k = i + 1; k < triangles.size(); ++k) {
      const NewellTriangle &p = triangles[i], &q = triangles[k];
      const NewellVerdict verdict = ask_pair(p, q);
      if (verdict.tests.size() <= 5 && verdict.tests.back()) ++by_test[verdict.tests.size() - 1];
      constexpr std::size_t boxes_decide = 2;
      if (verdict.tests.size() <= boxes_decide) continue;
      pairs.push_back({{"p", triangle_json(p, positions[p.id])},
                       {"q", triangle_json(q, positions[q.id])},
                       {"tests", verdict.tests},
                       {"first", verdict.first},
                       {"overlap", !are_apart(p, q)}});
    }
  picture = lesson_picture(stage, zbuffer(stage.surfaces, view));
  return {{"width", view.width},
          {"height", view.height},
          {"pixels", place_of(picture.rgba.data(), picture.rgba.size())},
          {"pairs", std::move(pairs)},
          {"by_test", by_test}};
}

}  // namespace frontmost::web
