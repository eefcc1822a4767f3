// SPDX-License-Identifier: Apache-2.0
// Ray casting: one ray through boxes and triangles, the ray from its hit to the light, and the savings of each level of
// a tree of boxes.
#include <frontmost/raycast.h>
#include <frontmost/zbuffer.h>

#include <algorithm>

#include "web/lessons/lessons.h"
#include "web/lessons/plain_tree.h"

namespace frontmost::web {
namespace {

const glm::vec3 kToLight(0.55f, 0.75f, 0.4f);

const char* name_of(PlainStep::Verdict verdict) {
  constexpr const char* names[] = {"met", "missed", "farther"};
  return names[std::size_t(verdict)];
}

PlainJson step_json(const Surfaces& surfaces, const PlainTree& tree, const View& beside, const PlainStep& step) {
  PlainJson json = {{"kind", step.is_box ? "box" : "triangle"},
                    {"number", step.number},
                    {"verdict", name_of(step.verdict)},
                    {"t", step.t}};
  if (step.is_box) {
    const PlainNode& node = tree.nodes()[step.number];
    json["level"] = node.level;
    json["triangles"] = node.count;
    json["lines"] = lines_json(beside, sides_of(node.box));
  } else {
    json["lines"] = lines_json(beside, sides_of(surfaces.corners(step.number)));
  }
  return json;
}

/// Whether the light reaches the end of a ray, and the obstacle if not.
PlainJson light_json(const Surfaces& surfaces, const RayIndex& index, const View& beside, const SightLine& sight,
                     const PlainHit& hit) {
  const TrianglePoint point{hit.id, surfaces.corners(hit.id), glm::vec3(hit.weights)};
  std::uint8_t is_lit = 0;
  are_lit(index, {&point, 1}, kToLight, {&is_lit, 1});
  const glm::dvec3 from = sight.origin + sight.direction * hit.t, way(kToLight);
  const double length = double(surfaces.bounds().diagonal());
  const RayHit blocker = closest_hit(index, Ray{glm::vec3(from + way * (length * 1e-4)), kToLight});
  const double reach = !is_lit && blocker ? blocker.t + length * 1e-4 : length;
  const WorldLine line = {from, from + way * reach};
  PlainJson json = {{"is_lit", is_lit != 0}, {"lines", lines_json(beside, {&line, 1})}};
  if (!is_lit && blocker) json["blocker"] = blocker.primitive;
  return json;
}

/// One ray of a picture, step by step, seen from the side.
PlainJson walk(const PlainJson& question) {
  static Bitmap picture, aside;
  const LessonScene& stage = lesson_scene(question);
  const View view = lesson_view(stage, question);
  const View beside = view_of(question.at("beside"), stage.surfaces.bounds());
  const int x = std::clamp(question.at("x").get<int>(), 0, view.width - 1);
  const int y = std::clamp(question.at("y").get<int>(), 0, view.height - 1);
  const RayIndex index(stage.surfaces);
  const Visible visible = raycast(index, view);
  picture = lesson_picture(stage, visible);
  aside = lesson_picture(stage, zbuffer(stage.surfaces, beside));
  const PlainTree tree(stage.surfaces);
  const SightLine sight = sight_through(view, x, y);
  std::vector<PlainStep> steps;
  PlainWork work;
  const PlainHit hit = tree.nearest(sight, tree.depth() + 1, work, &steps);
  PlainJson told = PlainJson::array();
  for (const PlainStep& step : steps) told.push_back(step_json(stage.surfaces, tree, beside, step));
  const double reach = hit.id == no_primitive ? 1e3 * double(stage.surfaces.bounds().diagonal()) : hit.t;
  const WorldLine line = {sight.origin, sight.origin + sight.direction * reach};
  PlainJson answer = {{"width", view.width},
                      {"height", view.height},
                      {"pixels", place_of(picture.rgba.data(), picture.rgba.size())},
                      {"beside", place_of(aside.rgba.data(), aside.rgba.size())},
                      {"ray", lines_json(beside, {&line, 1})},
                      {"eye", to_json(pixel_of_point(beside, view.eye()))},
                      {"steps", std::move(told)},
                      {"boxes", work.boxes},
                      {"asked", work.triangles},
                      {"triangles", stage.surfaces.primitive_count()},
                      {"library", visible.primitives[visible.index(x, y)]}};
  if (hit.id != no_primitive) {
    answer["hit"] = {{"triangle", hit.id}, {"depth", hit.t}};
    answer["light"] = light_json(stage.surfaces, index, beside, sight, hit);
  }
  return answer;
}

/// A colour from dark to light for a share of work on a logarithmic scale.
void color_work(double share, std::uint8_t* rgba) {
  constexpr double stops[4][3] = {{24, 30, 60}, {47, 111, 159}, {240, 160, 106}, {255, 246, 220}};
  const double at = std::clamp(share, 0.0, 1.0) * 3;
  const auto first = std::min<std::size_t>(std::size_t(at), 2);
  for (std::size_t c = 0; c < 3; ++c)
    rgba[c] = std::uint8_t(stops[first][c] + (stops[first + 1][c] - stops[first][c]) * (at - double(first)));
  rgba[3] = 255;
}

/// The cost of all rays of a picture, for a tree that is opened down to a level.
PlainJson levels(const PlainJson& question) {
  static Bitmap picture;
  static std::vector<std::uint8_t> heat;
  const LessonScene& stage = lesson_scene(question);
  const View view = lesson_view(stage, question);
  const PlainTree tree(stage.surfaces);
  const int level = std::clamp(question.at("level").get<int>(), 0, tree.depth());
  const Visible visible = raycast(stage.surfaces, view);
  picture = lesson_picture(stage, visible);
  heat.assign(4 * view.pixel_count(), 0);
  const double most = std::log2(2.0 + stage.surfaces.primitive_count());
  PlainWork sum;
  std::size_t differing = 0;
  for (int y = 0; y < view.height; ++y)
    for (int x = 0; x < view.width; ++x) {
      PlainWork work;
      const PlainHit hit = tree.nearest(sight_through(view, x, y), level, work);
      const std::size_t i = visible.index(x, y);
      differing += hit.id != visible.primitives[i];
      color_work(std::log2(double(work.boxes + work.triangles)) / most, &heat[4 * i]);
      sum.boxes += work.boxes, sum.triangles += work.triangles;
    }
  std::vector<WorldLine> lines;
  std::size_t boxes = 0;
  for (const PlainNode& node : tree.nodes()) {
    if (node.level != level && !(node.is_leaf() && node.level < level)) continue;
    ++boxes;
    for (const WorldLine& line : sides_of(node.box)) lines.push_back(line);
  }
  return {{"width", view.width},
          {"height", view.height},
          {"pixels", place_of(picture.rgba.data(), picture.rgba.size())},
          {"heat", place_of(heat.data(), heat.size())},
          {"lines", lines_json(view, lines)},
          {"level", level},
          {"depth", tree.depth()},
          {"boxes", boxes},
          {"boxes_asked", sum.boxes},
          {"triangles_asked", sum.triangles},
          {"without", std::uint64_t(view.pixel_count()) * stage.surfaces.primitive_count()},
          {"differing", differing}};
}

}  // namespace

PlainJson rays_lesson(const PlainJson& question) {
  return question.value("example", "walk") == "walk" ? walk(question) : levels(question);
}

}  // namespace frontmost::web
