// SPDX-License-Identifier: Apache-2.0
// Makes a View of the camera settings: first the direction, then the view angle, then the distance, then the clip
// planes.
#include "cli/view/view_options.h"

#include <fmt/format.h>

#include <cmath>

#include "cli/failure.h"
#include "cli/values.h"
#include "cli/view/camera_report.h"

namespace frontmost::cli {
namespace {

constexpr glm::ivec2 default_resolution{1920, 1080};

/// The eye's axes, its centre of rotation, and whether its distance is still to be fitted.
struct Aim {
  glm::dmat4 world_from_eye{1.0};
  glm::dvec3 target{0.0};
  bool fitted = false;
};

glm::dvec3 axis(const glm::dmat4& world_from_eye, int column) { return glm::dvec3(world_from_eye[column]); }

glm::dmat4 looking(const glm::dvec3& eye, const glm::dvec3& forward, const glm::dvec3& up) {
  return look_at(eye, eye + glm::normalize(forward), up);
}

const Camera& model_camera(const ViewSettings& settings, const Scene& scene) {
  const std::size_t index = std::size_t(*settings.camera_index);
  if (index < scene.cameras.size()) return scene.cameras[index];
  throw UsageError(
      fmt::format("--camera-index: there is no camera {1}; cameras in the model: {0}", scene.cameras.size(), index));
}

/// Returns the pose, rotated about an axis through `pivot`, anticlockwise as seen from the axis' tip. Rodrigues'
/// formula.
glm::dmat4 turned(const glm::dmat4& pose, const glm::dvec3& pivot, const glm::dvec3& about, double degrees) {
  const glm::dvec3 k = glm::normalize(about);
  const double c = std::cos(degrees * radians_per_degree), s = std::sin(degrees * radians_per_degree);
  const auto turn = [&](const glm::dvec3& v) { return v * c + glm::cross(k, v) * s + k * glm::dot(k, v) * (1 - c); };
  glm::dmat4 result(1.0);
  for (int i = 0; i < 3; ++i) result[i] = glm::dvec4(turn(axis(pose, i)), 0);
  result[3] = glm::dvec4(pivot + turn(axis(pose, 3) - pivot), 1);
  return result;
}

/// Turns the camera by azimuth and elevation, as VTK and f3d do: about the camera's own up, then about its own right.
void turn(Aim& aim, const ViewSettings& settings) {
  if (settings.azimuth != 0) {
    aim.world_from_eye = turned(aim.world_from_eye, aim.target, axis(aim.world_from_eye, 1), settings.azimuth);
  }
  if (settings.elevation != 0) {
    aim.world_from_eye = turned(aim.world_from_eye, aim.target, axis(aim.world_from_eye, 0), -settings.elevation);
  }
}

Box or_unit_box(const Box& box) { return box.is_empty() ? Box{glm::vec3(-0.5f), glm::vec3(0.5f)} : box; }

glm::dvec3 middle_of(const Box& box) {
  const glm::dvec3 low(box.low), high(box.high);
  return low + (high - low) * 0.5;
}

Subject subject_of(const ViewSettings& settings, const Surfaces& surfaces) {
  const FramedObjects objects = settings.framed.value_or(FramedObjects::subject);
  return objects == FramedObjects::all ? Subject{surfaces.bounds(), {}} : find_subject(surfaces);
}

/// Returns the bounds of the framed objects.
Box subject_box(const ViewSettings& settings, const Surfaces& surfaces) {
  return or_unit_box(subject_of(settings, surfaces).bounds);
}

/// Returns the centre of the framed objects, projected onto the viewing axis.
glm::dvec3 ahead_of(const ViewSettings& settings, const View& view, const Surfaces& surfaces) {
  const Box box = subject_box(settings, surfaces);
  const double along = glm::dot(middle_of(box) - view.eye(), view.forward());
  return view.eye() + view.forward() * (along > 0 ? along : std::max(double(box.diagonal()), 1e-6));
}

/// Returns the aim of a camera. `base` is the library's default view, which provides all that the settings omit.
Aim aim_of(const ViewSettings& settings, const Surfaces& surfaces, const View& base) {
  const glm::dvec3& origin = surfaces.scene().origin;
  const glm::dvec3 target =
      settings.focal_point ? *settings.focal_point - origin : middle_of(subject_box(settings, surfaces));
  Aim aim{base.world_from_eye, target, true};
  const auto looking_ahead = [&](const glm::dmat4& world_from_eye) {
    View view;
    view.world_from_eye = world_from_eye;
    return Aim{world_from_eye, ahead_of(settings, view, surfaces), false};
  };
  if (settings.pose) return looking_ahead(in_scene(world_from_eye(*settings.pose, *settings.pose_convention), origin));
  if (settings.camera_index) return looking_ahead(model_camera(settings, surfaces.scene()).world_from_eye);
  const glm::dvec3 up =
      settings.view_up.value_or(settings.position || settings.direction ? direction(surfaces.scene().up) : base.up());
  if (settings.position) {
    const glm::dvec3 eye = *settings.position - origin;
    if (settings.direction) return looking_ahead(looking(eye, *settings.direction, up));
    if (aim.target == eye)
      throw UsageError("--camera-position is the point that the camera looks at; give --camera-direction as well");
    return {looking(eye, aim.target - eye, up), aim.target, false};
  }
  // The rotation is about the origin, so that the axes do not depend on the model's place, not even in their last bits.
  aim.world_from_eye = looking(glm::dvec3(0), settings.direction.value_or(base.forward()), up);
  aim.world_from_eye[3] = glm::dvec4(aim.target, 1);
  return aim;
}

std::optional<Intrinsics> intrinsics_of(const ViewSettings& settings) {
  if (!settings.intrinsics) return std::nullopt;
  const auto& [fx, fy, cx, cy] = *settings.intrinsics;
  return Intrinsics{fx, fy, cx, cy, settings.pixel_rule};
}

/// Returns the projection with its sides at unit distance. place() scales the sides of a parallel projection to what a
/// perspective camera would see at the focal point.
Projection shape_of(const ViewSettings& settings, const glm::ivec2& size, const View& base) {
  const double aspect = double(size.x) / size.y;
  if (const auto intrinsics = intrinsics_of(settings))
    return make_projection(*intrinsics, size.x, size.y, base.projection.clip);
  Projection projection;
  projection.orthographic = settings.orthographic;
  const double min_half = std::tan(15 * radians_per_degree);  // FrameOptions::min_fov
  projection.top = settings.view_angle ? std::tan(*settings.view_angle * 0.5 * radians_per_degree)
                                       : (aspect >= 1 ? min_half : min_half / aspect);
  projection.bottom = -projection.top;
  projection.right = projection.top * aspect;
  projection.left = -projection.right;
  return projection;
}

Projection shape_of(const Camera& camera, const glm::ivec2& size) {
  Projection projection;
  projection.orthographic = camera.orthographic;
  projection.top = camera.orthographic ? camera.vertical * 0.5 : std::tan(camera.vertical * 0.5);
  projection.bottom = -projection.top;
  projection.right = projection.top * size.x / size.y;
  projection.left = -projection.right;
  return projection;
}

void scale(Projection& projection, double factor) {
  for (double* const side : {&projection.left, &projection.right, &projection.bottom, &projection.top}) *side *= factor;
}

/// Zooms as VTK and f3d do: divides the view angle, or the height of a parallel projection.
void zoom(Projection& projection, double factor) {
  if (factor == 1) return;
  if (projection.orthographic) return scale(projection, 1 / factor);
  const double half_angle = std::atan(projection.top) / factor;
  if (half_angle > 89.5 * radians_per_degree)
    throw UsageError("--camera-zoom-factor: the view angle becomes larger than 179 degrees");
  scale(projection, std::tan(half_angle) / projection.top);
}

/// Returns the clip planes: the user's, or else the model camera's, or else fitted ones. `fitted` is the result of
/// framing.
ClipDistances clip_of(const ViewSettings& settings, const Surfaces& surfaces, const View& view,
                      const std::optional<ClipDistances>& fitted) {
  const Box box = framed_box(surfaces);
  const bool orthographic = view.projection.orthographic;
  ClipDistances clip = fitted.value_or(fit_clip(box, view.world_from_eye, orthographic));
  std::optional<double> near = settings.near, far = settings.far;
  if (settings.camera_index) {
    const Camera& camera = model_camera(settings, surfaces.scene());
    if (!near) near = camera.near;
    if (!far) far = camera.far;
  }
  const double depth = std::max(double(box.diagonal()), 1.0);
  if (near) clip.near = *near;
  if (far) clip.far = *far;
  // Only one plane was given, and it lies beyond the other, fitted one.
  if (clip.far <= clip.near && !far)
    clip.far = orthographic ? clip.near + depth : std::numeric_limits<double>::infinity();
  if (clip.far <= clip.near && !near) clip.near = orthographic ? clip.far - depth : clip.far / 10000;
  return clip;
}

/// Returns the library's framing. `aim`, if given, replaces the named direction. A given focal point becomes the
/// centre.
View framed(const ViewSettings& settings, const Surfaces& surfaces, const glm::ivec2& size, const Aim* aim = nullptr) {
  FrameOptions options;
  if (aim) {
    options.forward = -axis(aim->world_from_eye, 2);
    options.up = axis(aim->world_from_eye, 1);
    if (settings.focal_point) options.target = aim->target;
    options.intrinsics = intrinsics_of(settings);
  }
  options.direction = settings.named.value_or(NamedView::three_quarter);
  options.orthographic = settings.orthographic;
  options.objects = settings.framed.value_or(FramedObjects::subject);
  if (settings.view_angle) {
    // The library's field of view spans the smaller side of the picture; that of the flag and of f3d, its height.
    const double half = std::tan(*settings.view_angle * 0.5 * radians_per_degree);
    options.min_fov = 2 * std::atan(half * std::min(1.0, double(size.x) / size.y));
  }
  return frame(surfaces, size.x, size.y, options);
}

/// Places a camera whose eye is given.
void place(View& view, const Aim& aim, const ViewSettings& settings, const Surfaces& surfaces) {
  const glm::ivec2 size(view.width, view.height);
  view.world_from_eye = aim.world_from_eye;
  view.projection =
      settings.camera_index ? shape_of(model_camera(settings, surfaces.scene()), size) : shape_of(settings, size, view);
  if (view.projection.orthographic && !settings.camera_index)
    scale(view.projection, glm::distance(aim.target, view.eye()));
}

/// Whether the library's own framing is all that is needed.
bool is_plain(const ViewSettings& s) {
  return !s.position && !s.focal_point && !s.direction && !s.view_up && !s.pose && !s.camera_index && !s.intrinsics &&
         s.azimuth == 0 && s.elevation == 0;
}

}  // namespace

Box framed_box(const Surfaces& surfaces) { return or_unit_box(surfaces.bounds()); }

bool is_fitted_to_subject(const ViewSettings& settings) {
  const bool is_fitted = !settings.position && !settings.pose && !settings.camera_index;
  return is_fitted && settings.framed.value_or(FramedObjects::subject) == FramedObjects::subject;
}

std::optional<std::string> framing_warning(const ViewSettings& settings, const Surfaces& surfaces) {
  if (!is_fitted_to_subject(settings)) return std::nullopt;
  const std::vector<std::uint32_t> left_out = find_subject(surfaces).left_out;
  if (left_out.empty()) return std::nullopt;
  constexpr std::size_t most_names = 3;
  const std::vector<Instance>& objects = surfaces.scene().instances;
  std::string names;
  for (std::size_t i = 0; i < std::min(left_out.size(), most_names); ++i)
    names += fmt::format("{}'{}'", i ? ", " : "", printable_text(objects[left_out[i]].name));
  if (left_out.size() > most_names) names += fmt::format(" and {} more", left_out.size() - most_names);
  return fmt::format(
      "{} of {} objects reach far beyond the others and out of the picture: {}; --frame all fits all objects",
      left_out.size(), objects.size(), names);
}

glm::dvec3 focal_point_of(const ViewSettings& settings, const View& view, const Surfaces& surfaces) {
  return settings.focal_point ? *settings.focal_point - surfaces.scene().origin : ahead_of(settings, view, surfaces);
}

bool depends_on_model(const ViewSettings& s) {
  const bool is_turned = s.azimuth != 0 || s.elevation != 0;
  // A parallel projection, and the centre of rotation, depend on the model's distance.
  const bool is_ahead = (s.pose || (s.position && s.direction)) && !s.orthographic && !is_turned;
  const bool is_placed = is_ahead || (s.position && s.focal_point);
  return !is_placed || !s.near || !s.far;
}

View resolve_view(const ViewSettings& settings, const Surfaces& surfaces) {
  const glm::ivec2 size = settings.resolution.value_or(default_resolution);
  View view = framed(settings, surfaces, size);
  std::optional<ClipDistances> fitted = view.projection.clip;
  if (!is_plain(settings)) {
    Aim aim = aim_of(settings, surfaces, view);
    turn(aim, settings);
    if (aim.fitted)
      view = framed(settings, surfaces, size, &aim);
    else
      place(view, aim, settings, surfaces);
    fitted = aim.fitted ? std::optional(view.projection.clip) : std::nullopt;
  }
  zoom(view.projection, settings.zoom);
  view.projection.clip = clip_of(settings, surfaces, view, fitted);
  view.culling = settings.culling;
  validate(view);
  return view;
}

std::string view_name(const ViewSettings& settings) {
  if (!settings.name.empty()) return settings.name;
  if (settings.named) return std::string(view_name(*settings.named));
  if (settings.camera_index) return fmt::format("camera{}", *settings.camera_index);
  return is_plain(settings) ? "three-quarter" : "camera";
}

}  // namespace frontmost::cli
