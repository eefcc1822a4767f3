// SPDX-License-Identifier: Apache-2.0
// Projection and depth: depth along a segment on the screen, resolution of depth formats, and pictures beyond that
// resolution.
#include <frontmost/pictures.h>
#include <frontmost/precision.h>
#include <frontmost/zbuffer.h>

#include "web/camera.h"
#include "web/lessons/lessons.h"

namespace frontmost::web {
namespace {

DepthSetup setup_of(const PlainJson& question, DepthFormat format, bool reversed) {
  return {{question.value("near", 0.1), question.value("far", 100.0)}, format, reversed, false};
}

/// Depths of a wall between two points of the plan, (x, distance) each, along the middle row of a picture.
PlainJson segment(const PlainJson& question) {
  constexpr int width = 401;  // odd: a pixel's centre on the axis
  const glm::vec2 a(question.value("x0", -4.0f), question.value("d0", 2.0f));
  const glm::vec2 b(question.value("x1", 2.0f), question.value("d1", 5.0f));
  Scene scene;
  Mesh mesh;
  mesh.positions = {{a.x, -1, -a.y}, {b.x, -1, -b.y}, {b.x, 1, -b.y}, {a.x, 1, -a.y}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  add(scene, std::move(mesh));
  const Surfaces surfaces(scene);
  View view;
  view.width = width, view.height = 1;
  const double half = 2.2;
  view.projection = make_frustum(-half, half, -0.001, 0.001, {1, 100});
  view.projection.clip = {0.1, 100};
  const Visible visible = zbuffer(surfaces, view);
  const Buffer<float> found = depths_of(visible);
  PlainJson depths = PlainJson::array(), linear = PlainJson::array(), screen = PlainJson::array();
  // Positions of the ends on the screen, at unit distance.
  const double from = double(a.x) / a.y, to = double(b.x) / b.y;
  for (int x = 0; x < width; ++x) {
    const double place = -half + 2 * half * (x + 0.5) / width, t = (place - from) / (to - from);
    screen.push_back(place);
    depths.push_back(finite_or_null(found[std::size_t(x)]));
    linear.push_back(t >= 0 && t <= 1 ? PlainJson(a.y + t * (b.y - a.y)) : PlainJson(nullptr));
  }
  return {{"screen", std::move(screen)}, {"depth", std::move(depths)}, {"linear", std::move(linear)}, {"half", half}};
}

PlainJson gaps(const PlainJson& question) {
  struct Named {
    const char* name;
    DepthFormat format;
    bool reversed;
  };
  constexpr Named formats[] = {{"D16", DepthFormat::d16, false},
                               {"D24", DepthFormat::d24, false},
                               {"F32", DepthFormat::f32, false},
                               {"F32 reversed", DepthFormat::f32, true}};
  const double near = question.value("near", 0.1), far = question.value("far", 100.0);
  constexpr int count = 48;
  PlainJson distances = PlainJson::array(), lists;
  for (int i = 0; i <= count; ++i) distances.push_back(near * std::pow(far / near, double(i) / count));
  for (const Named& named : formats) {
    PlainJson list = PlainJson::array();
    for (const PlainJson& distance : distances)
      list.push_back(finite_or_null(
          resolvable_gap(setup_of(question, named.format, named.reversed), std::min(distance.get<double>(), far))));
    lists[named.name] = std::move(list);
  }
  const DepthSetup d16 = setup_of(question, DepthFormat::d16, false);
  return {{"distances", std::move(distances)},
          {"gaps", std::move(lists)},
          {"share_of_first_tenth", share_of_values(d16, near + (far - near) / 10)}};
}

/// A road to the horizon, with stripes at a gap above it.
PlainJson fight(const PlainJson& question) {
  static std::vector<std::uint8_t> rgba;
  const float gap = question.value("gap", 0.01f);
  Scene scene;
  Mesh road, stripe;
  road.positions = {{-4, 0, 0}, {4, 0, 0}, {4, 0, -90}, {-4, 0, -90}};
  stripe.positions = {{-1.2f, gap, 0}, {1.2f, gap, 0}, {1.2f, gap, -90}, {-1.2f, gap, -90}};
  road.triangles = stripe.triangles = {{0, 1, 2}, {0, 2, 3}};
  add(scene, std::move(road));
  add(scene, std::move(stripe));
  const Surfaces surfaces(scene);
  View view;
  view.width = question.value("width", 480), view.height = question.value("height", 270);
  view.world_from_eye = look_at({0, 1.6, 0}, {0, 0.9, -6}, {0, 1, 0});
  view.projection = make_projection(0.9, double(view.width) / view.height,
                                    {question.value("near", 0.1), question.value("far", 100.0)});
  constexpr DepthFormat formats[] = {DepthFormat::d8, DepthFormat::d16, DepthFormat::d24, DepthFormat::f32};
  DepthBuffer buffer(view.width, view.height, 1, formats[question.value("format", 1) & 3]);
  DepthDraw call;
  call.state.nearer_is_greater = question.value("reversed", false);
  call.state.func = call.state.nearer_is_greater ? DepthFunc::greater : DepthFunc::less;
  buffer.clear(call.state.nearer_is_greater ? 0 : 1);
  buffer.draw(surfaces, view, call);
  const Visible visible = buffer.visible(view);
  const DepthFights fights = find_depth_fights(surfaces, find_exact_visible(surfaces, view), visible);
  rgba.assign(4 * visible.primitives.size(), 0);
  for (std::size_t i = 0; i < visible.primitives.size(); ++i) {
    const PrimitiveId id = visible.primitives[i];
    if (id == no_primitive) continue;
    const glm::u8vec3 color = id < 2 ? glm::u8vec3(92, 98, 110) : glm::u8vec3(230, 126, 60);
    for (std::size_t c = 0; c < 3; ++c) rgba[4 * i + c] = color[int(c)];
    rgba[4 * i + 3] = 255;
  }
  return {{"width", view.width},
          {"height", view.height},
          {"pixels", place_of(rgba.data(), rgba.size())},
          {"wrong", fights.wrong},
          {"covered", fights.covered}};
}

/// A viewing volume that the user changes: its picture, and the volume with the scene from the side.
PlainJson frustum(const PlainJson& question) {
  static Bitmap picture, aside;
  const LessonScene& stage = lesson_scene(question);
  const View view = lesson_view(stage, question);
  const View beside = view_of(question.at("beside"), stage.surfaces.bounds());
  picture = lesson_picture(stage, zbuffer(stage.surfaces, view));
  aside = lesson_picture(stage, zbuffer(stage.surfaces, beside));
  const std::vector<WorldLine> volume = sides_of_volume(view);
  const Projection& p = view.projection;
  return {{"width", view.width},
          {"height", view.height},
          {"pixels", place_of(picture.rgba.data(), picture.rgba.size())},
          {"beside", place_of(aside.rgba.data(), aside.rgba.size())},
          {"volume", lines_json(beside, volume)},
          {"eye", to_json(pixel_of_point(beside, view.eye()))},
          {"sides", {p.left, p.right, p.bottom, p.top}},
          {"matrix", to_json(clip_from_eye(p))}};
}

}  // namespace

PlainJson projection_lesson(const PlainJson& question) {
  const std::string example = question.value("example", "segment");
  if (example == "segment") return segment(question);
  if (example == "frustum") return frustum(question);
  if (example == "gaps") return gaps(question);
  return fight(question);
}

}  // namespace frontmost::web
