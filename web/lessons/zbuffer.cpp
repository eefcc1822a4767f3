// SPDX-License-Identifier: Apache-2.0
// The lesson on the z-buffer: a DepthBuffer after each triangle, the effect of each triangle on each sample, and two
// surfaces in one plane.
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

/// For each triangle that covers the pixel: its depth, the stored depth, and the result of the comparison. `buffer` is
/// cleared; `calls` draw at most 400 triangles.
PlainJson comparisons(const Surfaces& surfaces, const View& view, DepthBuffer buffer, std::span<const DepthDraw> calls,
                      const PlainJson& pixel) {
  constexpr PrimitiveId most_triangles = 400;
  const int x = pixel.at(0), y = pixel.at(1);
  const std::size_t i = std::size_t(y) * std::size_t(view.width) + std::size_t(x);
  DepthBuffer alone(view.width, view.height, 1, buffer.format());
  PlainJson list = PlainJson::array();
  for (const DepthDraw& call : calls)
    for (PrimitiveId id = call.begin; id < std::min(call.end, most_triangles); ++id) {
      DepthState always = call.state;
      always.func = DepthFunc::always;
      alone.clear();
      alone.draw(surfaces, view, {always, id, id + 1});
      const float before = buffer.depths()[i];
      const std::uint32_t stored_before = buffer.stored()[i];
      buffer.draw(surfaces, view, {call.state, id, id + 1});
      if (alone.visible(view).primitives[i] == no_primitive) continue;
      list.push_back({{"triangle", id},
                      {"depth", alone.depths()[i]},
                      {"before", before},
                      {"stored", alone.stored()[i]},
                      {"stored_before", stored_before},
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
  const DepthBuffer cleared = buffer;
  const DepthDraw call = {state, 0, step};
  if (step > 0) buffer.draw(stage.surfaces, view, call);
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
  if (question.contains("pixel"))
    answer["comparisons"] = comparisons(stage.surfaces, view, cleared, {&call, 1}, question["pixel"]);
  return answer;
}

/// A board, which is triangles 0 and 1, and a label in its plane, which is triangles 2 to 5.
Scene board_and_label() {
  constexpr double corners[][2] = {{-1.7, -1.2}, {1.7, -1.2}, {1.7, 1.2}, {-1.7, 1.2}, {0.37, -0.21},
                                   {-1.2, -0.8}, {1.1, -0.8}, {1.1, 0.7}, {-1.2, 0.7}};
  Scene scene;
  Mesh mesh;
  for (const auto& [x, y] : corners) mesh.positions.emplace_back(x, y, -5 + 0.4 * x + 0.3 * y);
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}, {4, 7, 8}, {4, 8, 5}};
  add(scene, std::move(mesh));
  return scene;
}

/// A colour for a label that is `steps` farther than the board: grey if equal, blue if nearer, orange if farther.
glm::u8vec3 color_of_steps(std::int64_t steps) {
  const glm::vec3 grey(176), end = steps < 0 ? glm::vec3(28, 84, 158) : glm::vec3(206, 92, 22);
  const float share = steps == 0 ? 0 : std::min(0.4f + 0.1f * float(std::abs(steps)), 1.0f);
  return glm::u8vec3(glm::mix(grey, end, share));
}

/// A board and a label in one plane, and the board's polygon offset. The answer has the draw that each pixel shows, and
/// the steps of the depth format from the board's stored depth to the label's.
PlainJson coplanar(const PlainJson& question) {
  static std::vector<std::uint8_t> colors, steps;
  const Scene scene = board_and_label();
  const Surfaces surfaces(scene);
  const double turn = glm::radians(question.value("turn", 0.0));
  View view;
  view.width = 320, view.height = 240;
  view.world_from_eye = look_at({5 * std::sin(turn), 0, 5 * std::cos(turn) - 5}, {0, 0, -5}, {0, 1, 0});
  view.projection = make_frustum(-0.4, 0.4, -0.3, 0.3, {1, 100});
  view.projection.clip.near = question.value("near", 0.15);
  std::array<DepthDraw, 2> calls = {{{{}, 0, 2}, {{}, 2, 6}}};
  calls[0].state.offset = {question.value("factor", 0.0), question.value("units", 0.0)};
  const DepthBuffer cleared(view.width, view.height, 1,
                            DepthFormat(question.value("format", int(DepthFormat::d24)) & 3));
  DepthBuffer buffer = cleared, label = cleared;
  buffer.draw(surfaces, view, calls[0]);
  label.draw(surfaces, view, calls[1]);
  const Buffer<std::uint32_t> board = buffer.stored();
  buffer.draw(surfaces, view, calls[1]);
  const Visible covered = label.visible(view);
  Visible visible = buffer.visible(view);
  std::size_t shown = 0, all = 0;
  steps.assign(4 * board.size(), 255);
  for (std::size_t i = 0; i < board.size(); ++i) {
    PrimitiveId& id = visible.primitives[i];
    if (id != no_primitive) id = id < 2 ? 0 : 1;
    const bool is_label = covered.primitives[i] != no_primitive;
    all += is_label;
    shown += is_label && id == 1;
    const glm::u8vec3 color =
        is_label ? color_of_steps(std::int64_t(label.stored()[i]) - std::int64_t(board[i])) : glm::u8vec3(64);
    for (std::size_t c = 0; c < 3; ++c) steps[4 * i + c] = color[int(c)];
  }
  colors = triangle_colors(visible);
  std::vector<WorldLine> sides;
  for (PrimitiveId id = 0; id < surfaces.primitive_count(); ++id)
    for (const WorldLine& side : sides_of(surfaces.corners(id))) sides.push_back(side);
  return {{"width", view.width},
          {"height", view.height},
          {"pixels", place_of(colors.data(), colors.size())},
          {"steps", place_of(steps.data(), steps.size())},
          {"sides", lines_json(view, sides)},
          {"shown", shown},
          {"all", all},
          {"comparisons", comparisons(surfaces, view, cleared, calls, question.at("pixel"))}};
}

}  // namespace

PlainJson zbuffer_lesson(const PlainJson& question) {
  const std::string example = question.value("example", "table");
  return example == "table" ? table(question) : example == "picture" ? picture(question) : coplanar(question);
}

}  // namespace frontmost::web
