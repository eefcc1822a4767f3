// SPDX-License-Identifier: Apache-2.0
// Opening and drawing of models.
#include "web/workbench.h"

#include <frontmost/lines.h>
#include <frontmost/report.h>

#include <chrono>
#include <cstdio>

#include "web/camera.h"

namespace frontmost::web {
namespace {

class Clock {
 public:
  /// Milliseconds since the construction or the last call.
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const double passed = std::chrono::duration<double, std::milli>(now - start_).count();
    start_ = now;
    return passed;
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

std::string hash_text(std::uint64_t hash) {
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
  return text;
}

/// Colours that differ for neighbouring numbers: bytes of a multiplicative hash, none of them dark.
std::uint32_t color_of_id(std::uint32_t id) {
  std::uint32_t h = (id + 1) * 2654435761u;
  h ^= h >> 15;
  h *= 2246822519u;
  h ^= h >> 13;
  const auto channel = [&](int shift) { return 70 + (h >> shift & 255) * 170 / 255; };
  return channel(0) | channel(8) << 8 | channel(16) << 16 | 0xFF000000u;
}

NamedView named_view(const std::string& name) {
  constexpr const char* names[] = {"front", "back", "left", "right", "top", "bottom", "iso", "three-quarter"};
  for (std::size_t i = 0; i < std::size(names); ++i)
    if (name == names[i]) return NamedView(i);
  throw Error(ErrorCode::bad_argument, "view", "there is no '" + name + "'");
}

Shading shading_of(const std::string& show) {
  if (show == "picture" || show == "layer") return Shading::lit;
  if (show == "flat") return Shading::flat;
  if (show == "depth") return Shading::depth;
  if (show == "objects") return Shading::ids;
  if (show == "normals") return Shading::normals;
  throw Error(ErrorCode::bad_argument, "show", "there is no '" + show + "'");
}

}  // namespace

Workbench::Model& Workbench::model() const {
  if (!model_) throw Error(ErrorCode::bad_argument, "no model is open");
  return *model_;
}

const Visible& Workbench::seen() {
  if (!is_current_) throw Error(ErrorCode::bad_argument, "no view has been drawn");
  return visible_;
}

PlainJson Workbench::open_builtin(const PlainJson& question) {
  return take(builtin(question.at("name").get<std::string>()));
}

PlainJson Workbench::take(Scene&& scene) {
  model_ = std::make_unique<Model>(std::move(scene));
  is_current_ = false;
  const Scene& taken = model_->scene;
  PlainJson objects = PlainJson::array(), warnings = PlainJson::array(), materials = PlainJson::array();
  constexpr std::size_t most_listed = 10000;
  for (std::size_t i = 0; i < std::min(taken.instances.size(), most_listed); ++i)
    objects.push_back(utf8_text(taken.instances[i].name));
  for (const Material& material : taken.materials) materials.push_back(utf8_text(material.name));
  for (const std::string& warning : taken.warnings) warnings.push_back(utf8_text(warning));
  const Box& box = model_->surfaces.bounds();
  PlainJson answer = {{"name", utf8_text(taken.name)},          {"triangles", model_->surfaces.primitive_count()},
                      {"object_count", taken.instances.size()}, {"objects", std::move(objects)},
                      {"materials", std::move(materials)},      {"warnings", std::move(warnings)},
                      {"up", to_json(direction(taken.up))},     {"origin", to_json(taken.origin)}};
  if (!box.is_empty()) answer["bounds"] = {to_json(box.low), to_json(box.high)};
  return answer;
}

PlainJson Workbench::frame(const PlainJson& question) {
  FrameOptions options;
  options.direction = named_view(question.value("view", "three-quarter"));
  options.orthographic = question.value("orthographic", false);
  if (question.contains("forward")) options.forward = vector_of(question["forward"]);
  const Surfaces& surfaces = model().surfaces;
  const View view = frontmost::frame(surfaces, question.at("width"), question.at("height"), options);
  const Box box = find_subject(surfaces).bounds;
  return camera_json(view, box.is_empty() ? glm::dvec3(0) : glm::dvec3(box.centre()));
}

PlainJson Workbench::pixels_of(const Bitmap& bitmap) {
  return {
      {"width", bitmap.width}, {"height", bitmap.height}, {"pixels", place_of(bitmap.rgba.data(), bitmap.rgba.size())}};
}

void Workbench::color_ids(const Visible& visible, IdKind kind) {
  const Image ids = id_image(model().surfaces, visible, kind);
  const Buffer<std::uint32_t>& values = ids.channels.front().integers();
  bitmap_.width = ids.width, bitmap_.height = ids.height;
  if (bitmap_.rgba.size() != 4 * values.size()) bitmap_.rgba = Buffer<std::uint8_t>(4 * values.size());
  auto* pixels = reinterpret_cast<std::uint32_t*>(bitmap_.rgba.data());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const bool is_seen = visible.primitives[i] != no_primitive;
    pixels[i] = is_seen ? color_of_id(values[i]) : 0;  // without material: the colour of id none
  }
}

PlainJson Workbench::draw(const PlainJson& question) {
  Model& now = model();
  Clock clock;
  view_ = view_of(question.at("camera"), now.surfaces.bounds());
  is_current_ = false;
  const std::string show = question.value("show", "picture");
  PlainJson answer;
  View one = view_;
  one.samples = 1;
  zbuffer_.give_back(std::move(visible_));
  zbuffer_.draw(now.surfaces, one);
  visible_ = zbuffer_.take();
  is_current_ = true;
  ++view_number_;
  const double see = clock.lap();
  if (question.value("hash", false)) answer["hash"] = hash_text(content_hash(visible_));
  clock.lap();
  ShadeOptions options;
  options.background.reset();
  options.light.shadows = question.value("shadows", true) ? Shadows::map : Shadows::off;
  options.pixels.rate = question.value("coarse", false) ? ShadingRate::each_2x2 : ShadingRate::each_pixel;
  if (show == "primitives" || show == "materials") {
    color_ids(visible_, show == "primitives" ? IdKind::primitive : IdKind::material);
    answer.update(pixels_of(bitmap_));
  } else {
    options.shading = shading_of(show);
    Visible other;
    if (show == "layer") {
      const int layer = question.value("layer", 1);
      other = std::move(visible_layers(now.surfaces, one, layer, {0, 0.5f}).back());
      options.layers.see_through = SeeThrough::never;
      options.light.shadows = Shadows::off;
    } else if (view_.samples > 1) {
      other = zbuffer_.draw(now.surfaces, view_);
    }
    const Visible& shown = other.primitives.empty() ? visible_ : other;
    answer.update(pixels_of(now.shader.shade_bitmap({.visible = &shown}, options)));
  }
  answer["milliseconds"] = {{"see", see}, {"shade", clock.lap()}};
  answer["near"] = view_.projection.clip.near;
  answer["far"] = finite_or_null(view_.projection.clip.far);
  return answer;
}

PlainJson Workbench::edges(const PlainJson&) {
  (void)seen();
  View one = view_;
  one.samples = 1;
  const Drawing drawing = draw_lines(model().surfaces, one, {.ripples = false});
  segments_.clear();
  for (const DrawnPart& part : drawing.parts)
    for (const double value : {part.from.x, part.from.y, part.to.x, part.to.y, part.hidden_by ? 1.0 : 0.0})
      segments_.push_back(float(value));
  return {{"segments", place_of(segments_.data(), segments_.size())}};
}

PlainJson Workbench::conventions(const PlainJson&) {
  (void)seen();
  return conventions_json(view_, model().scene.origin);
}

}  // namespace frontmost::web
