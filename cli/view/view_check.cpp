// SPDX-License-Identifier: Apache-2.0
// Checks which view options exclude or need one another.
//
// A camera can be given in four ways: by a name, by places and directions, by a pose, or by a camera of the model. Two
// ways contradict each other, and a parameter of one way has no meaning for the others. So each such pair is an error
// that names both flags; there is no rule of precedence.
#include <fmt/format.h>

#include <vector>

#include "cli/failure.h"
#include "cli/view/view_options.h"

namespace frontmost::cli {
namespace {

struct Flag {
  std::string_view name;
  bool is_set;
};

void exclude(const Flag& one, std::initializer_list<Flag> others) {
  if (!one.is_set) return;
  for (const Flag& other : others) {
    if (other.is_set) throw UsageError(fmt::format("--{} and --{} exclude each other", one.name, other.name));
  }
}

/// Refuses options that only pinhole cameras have, if another camera is asked for. The rays of other cameras see both
/// sides of all surfaces, at any distance.
void check_camera_model(const ViewSettings& s) {
  const Flag model{"camera-model", s.camera_model != CameraModel::pinhole};
  exclude(model, {{"camera-orthographic", s.orthographic},
                  {"camera-view-angle", s.view_angle.has_value()},
                  {"camera-zoom-factor", s.zoom != 1},
                  {"intrinsics", s.intrinsics.has_value()},
                  {"near", s.near.has_value()},
                  {"far", s.far.has_value()},
                  {"cull", s.culling != Culling::none}});
  if (model.is_set && s.samples == 64)
    throw UsageError("--samples 64 needs a pinhole camera; with --camera-model, 16 samples are the most");
  if (model.is_set && s.depth.is_used)
    throw UsageError("--camera-model: options of a depth buffer need a pinhole camera");
  if (s.fisheye_angle && s.camera_model != CameraModel::fisheye)
    throw UsageError("--fov needs --camera-model fisheye; for a pinhole camera use --camera-view-angle");
}

void need(const Flag& one, const Flag& other) {
  if (one.is_set && !other.is_set) throw UsageError(fmt::format("--{} needs --{}", one.name, other.name));
}

}  // namespace

void check_view_settings(const ViewSettings& s) {
  const Flag position{"camera-position", s.position.has_value()},
      focal{"camera-focal-point", s.focal_point.has_value()}, direction{"camera-direction", s.direction.has_value()},
      up{"camera-view-up", s.view_up.has_value()}, angle{"camera-view-angle", s.view_angle.has_value()},
      zoom{"camera-zoom-factor", s.zoom != 1}, azimuth{"camera-azimuth-angle", s.azimuth != 0},
      elevation{"camera-elevation-angle", s.elevation != 0}, orthographic{"camera-orthographic", s.orthographic},
      index{"camera-index", s.camera_index.has_value()}, named{"view", s.named.has_value()},
      intrinsics{"intrinsics", s.intrinsics.has_value()}, pose{"pose", s.pose.has_value()},
      convention{"pose-convention", s.pose_convention.has_value()}, frame{"frame", s.framed.has_value()},
      pixel{"pixel-center", s.pixel_rule != PixelRule::centre_at_integer};
  check_camera_model(s);
  exclude(pose, {position, focal, direction, up, named, index, azimuth, elevation, frame});
  exclude(index, {position, focal, direction, up, named, orthographic, angle, intrinsics, frame});
  exclude(frame, {position});
  exclude(named, {position, direction});
  exclude(intrinsics, {angle, orthographic, zoom});
  if (position.is_set && focal.is_set) exclude(direction, {focal});
  need(pose, convention);
  need(convention, pose);
  need(pixel, intrinsics);
  if (s.near && !s.orthographic && !s.camera_index && *s.near <= 0) throw UsageError("--near: must be above 0");
  if (s.far && !s.orthographic && !s.camera_index && *s.far <= 0) throw UsageError("--far: must be above 0");
  if (s.near && s.far && !(*s.near < *s.far)) throw UsageError("--near: must be below --far");
  const glm::ivec2 size = s.resolution.value_or(glm::ivec2(1));
  if (s.samples && double(size.x) * size.y * *s.samples > double(most_samples)) {
    throw UsageError("--samples: at most " + std::to_string(most_samples) +
                     " samples in all (16384 x 16384 pixels of one sample)");
  }
}

}  // namespace frontmost::cli
