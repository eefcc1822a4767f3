// SPDX-License-Identifier: Apache-2.0
// The lesson on the z-buffer: a DepthBuffer after each triangle, and the effect of each triangle on each sample.
#include <frontmost/zbuffer.h>

#include "web/lessons/lessons.h"

namespace frontmost::web {
namespace {

/// A parallel view of 8 x 8 pixels of one unit, with depths from 0 to 255, which 8 bits store unchanged.
View eight_by_eight() {
  View view;
  view.width = view.height = 8;
  view.world_from_eye = look_at({0, 0, 0}, {0, 0, -1}, {0, 1, 0});
  view.projection = make_orthographic(0, 8, 0, 8, {0, 255});
  return view;
}

/// The two triangles of the classic example, at the given depths.
Scene table_scene(float first, float second) {
  Scene scene;
  Mesh mesh;
  mesh.positions = {{0, 8, -first},  {0, 0.6f, -first},  {7.4f, 8, -first},
                    {0, 0, -second}, {5.4f, 0, -second}, {0.6f, 4.8f, -second}};
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
  add(scene, std::move(mesh));
  return scene;
}

DepthState state_of(const PlainJson& question) {
  DepthState state;
  state.nearer_is_greater = question.value("greater", false);
  state.func =
      DepthFunc(question.value("func", int(state.nearer_is_greater ? DepthFunc::greater : DepthFunc::less)) & 7);
  return state;
}

double clear_of(const DepthState& state) { return state.nearer_is_greater ? 0 : 1; }

PlainJson table(const PlainJson& question) {
  const DepthState state = state_of(question);
  const Scene scene = table_scene(question.value("first", 64.0f), question.value("second", 127.0f));
  const Surfaces surfaces(scene);
  const View view = eight_by_eight();
  DepthBuffer buffer(8, 8, 1, DepthFormat::d8);
  buffer.clear(clear_of(state));
  DepthState always = state;
  always.func = DepthFunc::always;
  PlainJson triangles = PlainJson::array();
  for (PrimitiveId id = 0; id < 2; ++id) {
    DepthBuffer alone(8, 8, 1, DepthFormat::d8);
    alone.draw(surfaces, view, {always, id, id + 1});
    const Visible covered = alone.visible(view);
    const std::vector<std::uint32_t> before(buffer.stored().begin(), buffer.stored().end());
    buffer.draw(surfaces, view, {state, id, id + 1});
    const Visible after = buffer.visible(view);
    PlainJson cells = PlainJson::array();
    for (std::size_t i = 0; i < 64; ++i)
      if (covered.primitives[i] != no_primitive)
        cells.push_back({{"x", i % 8},
                         {"y", i / 8},
                         {"depth", alone.stored()[i]},
                         {"before", before[i]},
                         {"after", buffer.stored()[i]},
                         {"passes", after.primitives[i] == id}});
    triangles.push_back(std::move(cells));
  }
  return {{"clear", stored_depth(DepthFormat::d8, clear_of(state))}, {"triangles", std::move(triangles)}};
}

/// For each triangle that covers a pixel: its depth, the stored depth, and the result of the comparison.
PlainJson comparisons(const LessonScene& stage, const View& view, const DepthState& state, const PlainJson& question) {
  constexpr PrimitiveId most_triangles = 400;
  const int x = question["pixel"].at(0), y = question["pixel"].at(1);
  const std::size_t i = std::size_t(y) * std::size_t(view.width) + std::size_t(x);
  DepthBuffer buffer(view.width, view.height), alone(view.width, view.height);
  buffer.clear(clear_of(state));
  DepthState always = state;
  always.func = DepthFunc::always;
  PlainJson list = PlainJson::array();
  const PrimitiveId end =
      std::min({stage.surfaces.primitive_count(), question.at("step").get<PrimitiveId>(), most_triangles});
  for (PrimitiveId id = 0; id < end; ++id) {
    alone.clear();
    alone.draw(stage.surfaces, view, {always, id, id + 1});
    const float before = buffer.depths()[i];
    buffer.draw(stage.surfaces, view, {state, id, id + 1});
    if (alone.visible(view).primitives[i] == no_primitive) continue;
    list.push_back({{"triangle", id},
                    {"depth", alone.depths()[i]},
                    {"before", before},
                    {"passes", buffer.visible(view).primitives[i] == id}});
  }
  return list;
}

PlainJson picture(const PlainJson& question) {
  static std::vector<std::uint8_t> colors, greys;
  const LessonScene& stage = lesson_scene(question);
  const View view = lesson_view(stage, question);
  const DepthState state = state_of(question);
  const PrimitiveId count = stage.surfaces.primitive_count(),
                    step = std::min(question.at("step").get<PrimitiveId>(), count);
  DepthBuffer buffer(view.width, view.height);
  buffer.clear(clear_of(state));
  if (step > 0) buffer.draw(stage.surfaces, view, {state, 0, step});
  const Visible visible = buffer.visible(view);
  colors = triangle_colors(visible);
  greys.assign(colors.size(), 255);
  const Buffer<float> depths = buffer.depths();
  float low = 1, high = 0;
  for (std::size_t i = 0; i < depths.size(); ++i)
    if (visible.primitives[i] != no_primitive) low = std::min(low, depths[i]), high = std::max(high, depths[i]);
  for (std::size_t i = 0; i < depths.size(); ++i) {
    const float share = high > low ? (depths[i] - low) / (high - low) : 0;
    const float grey =
        visible.primitives[i] == no_primitive ? float(clear_of(state)) : 0.1f + 0.7f * std::clamp(share, 0.0f, 1.0f);
    for (std::size_t c = 0; c < 3; ++c) greys[4 * i + c] = std::uint8_t(grey * 255);
  }
  PlainJson answer = {{"width", view.width},
                      {"height", view.height},
                      {"triangles", count},
                      {"pixels", place_of(colors.data(), colors.size())},
                      {"depths", place_of(greys.data(), greys.size())}};
  if (question.contains("pixel")) answer["comparisons"] = comparisons(stage, view, state, question);
  return answer;
}

}  // namespace

PlainJson zbuffer_lesson(const PlainJson& question) {
  return question.value("example", "table") == "table" ? table(question) : picture(question);
}

}  // namespace frontmost::web
