// SPDX-License-Identifier: Apache-2.0
// Cameras that only rays can serve: their limits, their grids, and the ray of one pixel.
#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "frontmost/raycast.h"
#include "raycast/camera_rays.h"

namespace frontmost {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr int kLargestSide = 16384;

void check_side(int side, const char* what) {
  if (side >= 1 && side <= kLargestSide) return;
  throw Error(side > kLargestSide ? ErrorCode::limit_exceeded : ErrorCode::bad_argument,
              std::string("ray camera: ") + what, "must be 1 to 16384");
}

void check(const Panorama& camera) {
  check_side(camera.width, "width");
  check_side(camera.height, "height");
}

void check(const Fisheye& camera) {
  check_side(camera.width, "width");
  check_side(camera.height, "height");
  if (!(camera.fov > 0 && camera.fov <= 2 * kPi))
    throw Error(ErrorCode::bad_argument, "ray camera: fov", "must be above 0, and a full turn at most");
}

void check_count(std::size_t columns, std::size_t rows) {
  if (columns == 0 || rows == 0) throw Error(ErrorCode::bad_argument, "ray camera", "there is no ray");
  // Division avoids the overflow of a product.
  if (columns > most_samples / rows)
    throw Error(ErrorCode::limit_exceeded, "ray camera", "at most " + std::to_string(most_samples) + " rays in all");
}

void check(const Lidar& camera) {
  if (camera.steps < 1) throw Error(ErrorCode::bad_argument, "ray camera: steps", "must be at least 1");
  check_count(std::size_t(camera.steps), camera.elevations.size());
  for (const double elevation : camera.elevations)
    if (!(std::abs(elevation) <= kPi / 2))
      throw Error(ErrorCode::bad_argument, "ray camera: elevations", "must be within 90 degrees of the horizon");
  const double ends[] = {camera.first_azimuth, camera.last_azimuth, camera.last_azimuth - camera.first_azimuth};
  for (const double angle : ends)
    if (!(std::abs(angle) <= 2 * kPi + 1e-9))
      throw Error(ErrorCode::bad_argument, "ray camera: azimuths",
                  "must be within 360 degrees of ahead, and of each other");
}

void check(const RayPattern& camera) { check_count(camera.directions.size(), 1); }

void check_samples(const RayCamera& camera) {
  const bool has_pixels =
      std::holds_alternative<Panorama>(camera.model) || std::holds_alternative<Fisheye>(camera.model);
  const int n = camera.samples;
  if (!(n == 1 || (has_pixels && (n == 2 || n == 4 || n == 8 || n == 16))))
    throw Error(ErrorCode::bad_argument, "ray camera: samples", has_pixels ? "must be 1, 2, 4, 8 or 16" : "must be 1");
  const glm::ivec2 grid = grid_of(camera);
  check_count(std::size_t(grid.x) * std::size_t(n), std::size_t(grid.y));
}

glm::ivec2 grid_of(const Panorama& camera) { return {camera.width, camera.height}; }
glm::ivec2 grid_of(const Fisheye& camera) { return {camera.width, camera.height}; }
glm::ivec2 grid_of(const Lidar& camera) { return {camera.steps, int(camera.elevations.size())}; }
glm::ivec2 grid_of(const RayPattern& camera) { return {int(camera.directions.size()), 1}; }

}  // namespace

std::vector<double> ring_elevations(int rings, double lowest, double highest) {
  if (rings < 1) throw Error(ErrorCode::bad_argument, "ring elevations: rings", "must be at least 1");
  if (!(lowest <= highest)) throw Error(ErrorCode::bad_argument, "ring elevations", "the lowest is above the highest");
  if (rings == 1) return {(lowest + highest) * 0.5};
  std::vector<double> elevations;
  elevations.reserve(std::size_t(rings));
  for (int ring = 0; ring < rings; ++ring) {
    const double down = double(ring) / (rings - 1);
    elevations.push_back(highest * (1 - down) + lowest * down);
  }
  return elevations;
}

void validate(const RayCamera& camera) {
  std::visit([](const auto& model) { check(model); }, camera.model);
  check_samples(camera);
  if (!(camera.nearest >= 0 && camera.nearest <= camera.farthest))
    throw Error(ErrorCode::bad_argument, "ray camera: ranges", "the least must be from 0 to the greatest");
  const glm::dmat4 pose = world_from_eye(camera.world_from_eye, PoseConvention::opengl_camera_to_world);
  for (int i = 0; i < 3; ++i)
    if (!std::isfinite(float(pose[3][i])))
      throw Error(ErrorCode::limit_exceeded, "pose", "the eye is farther from the origin than floats reach");
}

glm::ivec2 grid_of(const RayCamera& camera) {
  return std::visit([](const auto& model) { return grid_of(model); }, camera.model);
}

Ray ray_of(const RayCamera& camera, int x, int y, int sample) {
  const IeeeScope ieee;
  const raycast_detail::RayPose pose(camera.world_from_eye);
  const raycast_detail::PixelPlace at{x, y, sample_offsets(camera.samples)[std::size_t(sample)]};
  return std::visit([&](const auto& model) { return pose.place(raycast_detail::direction_of(model, at)); },
                    camera.model);
}

}  // namespace frontmost
