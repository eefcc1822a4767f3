// SPDX-License-Identifier: Apache-2.0
// The rays of panoramas, fisheyes and laser scanners, and what they meet.
//
// Sines and cosines come from turn(), which has the same bits on every machine and is exact at quarters: a scanner's
// ray straight to the right is (1, 0, 0), not off by the rounding of pi.
//
//    panorama   columns are azimuths, rows are elevations
//    fisheye    the angle from the axis grows with the distance from the middle; beyond the rim there is no ray
//    lidar      columns are steps, rows are its rings
//    pattern    one row of directions, as they are given
//
// All of them give rays for a grid of columns and rows, in parts of a few thousand, so one scan serves them all.
#include "frontmost/ray_camera.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "base/parallel.h"
#include "raycast/queries.h"
#include "scene/turn.h"

namespace frontmost {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr int kLargestSide = 16384;

/// (cos, sin) of an angle within a few turns, taken to the nearest 2^-48 of a turn (2e-14 radians, far below floats).
glm::dvec2 turn_by(double radians) {
  constexpr double whole = double(std::int64_t(1) << 48);
  return turn(std::int64_t(std::nearbyint(radians / (2 * kPi) * whole)), std::int64_t(whole));
}

/// From the (cos, sin) of azimuth and elevation.
glm::dvec3 direction_at(const glm::dvec2& azimuth, const glm::dvec2& elevation) {
  return {azimuth.y * elevation.x, elevation.y, -azimuth.x * elevation.x};
}

glm::dvec3 direction_of(const Panorama& camera, int x, int y) {
  const std::int64_t w = camera.width, h = camera.height;
  return direction_at(turn(2 * x + 1 - w, 2 * w), turn(h - 2 * y - 1, 4 * h));
}

glm::dvec3 direction_of(const Fisheye& camera, int x, int y) {
  const double right = x + 0.5 - camera.width * 0.5, up = camera.height * 0.5 - y - 0.5;
  // Equidistant: the angle from the axis grows with the distance from the middle, up to half the field of view at the
  // rim.
  const double from_middle = std::sqrt(right * right + up * up);
  const double rim = std::min(camera.width, camera.height) * 0.5;
  if (from_middle > rim) return glm::dvec3(0);
  if (from_middle == 0) return {0, 0, -1};
  const glm::dvec2 angle = turn_by(camera.fov * 0.5 * from_middle / rim);
  return {angle.y * right / from_middle, angle.y * up / from_middle, -angle.x};
}

glm::dvec3 direction_of(const Lidar& camera, int x, int y) {
  return direction_at(turn(x, camera.steps), turn_by(camera.elevations[std::size_t(y)]));
}

glm::dvec3 direction_of(const RayPattern& camera, int x, int) { return camera.directions[std::size_t(x)]; }

/// The model with its pose taken apart once.
template <class Model>
class CameraRays {
 public:
  CameraRays(const Model& model, const glm::dmat4& world_from_eye)
      : model_(model), rotation_(world_from_eye), origin_(world_from_eye[3]) {}
  [[nodiscard]] Ray at(int x, int y) const { return {origin_, glm::vec3(rotation_ * direction_of(model_, x, y))}; }

 private:
  const Model& model_;
  glm::dmat3 rotation_;
  glm::vec3 origin_;
};

double length_of(const glm::vec3& direction) { return glm::length(glm::dvec3(direction)); }

void check_side(int side, const char* what) {
  if (side >= 1 && side <= kLargestSide) return;
  throw Error(side > kLargestSide ? ErrorCode::limit_exceeded : ErrorCode::bad_argument,
              std::string("ray camera: ") + what + ": must be 1 to 16384");
}

void check(const Panorama& camera) {
  check_side(camera.width, "width");
  check_side(camera.height, "height");
}

void check(const Fisheye& camera) {
  check_side(camera.width, "width");
  check_side(camera.height, "height");
  if (!(camera.fov > 0 && camera.fov <= 2 * kPi))
    throw Error(ErrorCode::bad_argument, "ray camera: fov: must be above 0, and a full turn at most");
}

void check_count(std::size_t columns, std::size_t rows) {
  if (columns == 0 || rows == 0) throw Error(ErrorCode::bad_argument, "ray camera: there is no ray");
  // Divided, not multiplied: the product may overflow.
  if (columns > most_samples / rows)
    throw Error(ErrorCode::limit_exceeded, "ray camera: at most " + std::to_string(most_samples) + " rays in all");
}

void check(const Lidar& camera) {
  if (camera.steps < 1) throw Error(ErrorCode::bad_argument, "ray camera: steps: must be at least 1");
  check_count(std::size_t(camera.steps), camera.elevations.size());
  for (const double elevation : camera.elevations)
    if (!(std::abs(elevation) <= kPi / 2))
      throw Error(ErrorCode::bad_argument, "ray camera: elevations: must be within 90 degrees of the horizon");
}

void check(const RayPattern& camera) { check_count(camera.directions.size(), 1); }

glm::ivec2 grid_of(const Panorama& camera) { return {camera.width, camera.height}; }
glm::ivec2 grid_of(const Fisheye& camera) { return {camera.width, camera.height}; }
glm::ivec2 grid_of(const Lidar& camera) { return {camera.steps, int(camera.elevations.size())}; }
glm::ivec2 grid_of(const RayPattern& camera) { return {int(camera.directions.size()), 1}; }

constexpr std::size_t kRaysPerPart = 4096;

/// Calls visit(first, rays) for the rays of every part of the grid, on all threads.
template <class Model, class Visit>
void for_each_part(const RangeScan& scan, const Model& model, const Execution& execution, const Visit& visit) {
  const CameraRays<Model> rays_of(model, scan.camera.world_from_eye);
  const std::size_t count = scan.ranges.size();
  parallel_for(execution, count, kRaysPerPart, [&](std::size_t begin, std::size_t end) {
    std::vector<Ray> rays;
    rays.reserve(end - begin);
    for (std::size_t i = begin; i < end; ++i)
      rays.push_back(rays_of.at(int(i % std::size_t(scan.width)), int(i / std::size_t(scan.width))));
    visit(begin, rays);
  });
}

}  // namespace

std::vector<double> ring_elevations(int rings, double lowest, double highest) {
  if (rings < 1) throw Error(ErrorCode::bad_argument, "ring elevations: rings: must be at least 1");
  if (!(lowest <= highest)) throw Error(ErrorCode::bad_argument, "ring elevations: the lowest is above the highest");
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
  const glm::dmat4 pose = world_from_eye(camera.world_from_eye, PoseConvention::opengl_camera_to_world);
  for (int i = 0; i < 3; ++i)
    if (!std::isfinite(float(pose[3][i])))
      throw Error(ErrorCode::limit_exceeded, "pose: the eye is farther from the origin than floats reach");
}

glm::ivec2 grid_of(const RayCamera& camera) {
  return std::visit([](const auto& model) { return grid_of(model); }, camera.model);
}

Ray ray_of(const RayCamera& camera, int x, int y) {
  const IeeeScope ieee;
  return std::visit([&](const auto& model) { return CameraRays(model, camera.world_from_eye).at(x, y); }, camera.model);
}

namespace raycast_detail {

RangeScan prepare_scan(const RayCamera& camera) {
  validate(camera);
  RangeScan result{camera, grid_of(camera).x, grid_of(camera).y, {}, {}};
  const std::size_t count = std::size_t(result.width) * std::size_t(result.height);
  result.primitives = Buffer<PrimitiveId>(count);
  result.ranges = Buffer<float>(count);
  return result;
}

void cast_parts(const RangeScan& scan, const Execution& execution, const CastPart& cast) {
  const auto count = double(scan.ranges.size());
  std::atomic<std::size_t> done{0};
  const auto cast_part = [&](std::size_t first, const std::vector<Ray>& rays) {
    cast(first, rays);
    report_progress(execution, "visible", double(done += rays.size()) / count);
  };
  std::visit([&](const auto& model) { for_each_part(scan, model, execution, cast_part); }, scan.camera.model);
}

}  // namespace raycast_detail

RangeScan scan(const RayIndex& index, const RayCamera& camera, const Execution& execution) {
  RangeScan result = raycast_detail::prepare_scan(camera);
  Execution within = execution;  // the parts are what is shared out
  // A part is a few thousand rays: sharing it out again would cost threads more than they save.
  within.threads = 1;
  within.watch = nullptr;
  raycast_detail::cast_parts(result, execution, [&](std::size_t first, std::span<const Ray> rays) {
    std::vector<RayHit> hits(rays.size());
    closest_hits(index, rays, hits, within);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      result.primitives[first + i] = hits[i].primitive;
      result.ranges[first + i] =
          hits[i] ? float(hits[i].t * length_of(rays[i].direction)) : std::numeric_limits<float>::infinity();
    }
  });
  return result;
}

glm::dvec3 point_of(const RangeScan& scan, int x, int y) {
  const Ray ray = ray_of(scan.camera, x, y);
  const double range = scan.ranges[scan.index(x, y)];
  return glm::dvec3(ray.origin) + range / length_of(ray.direction) * glm::dvec3(ray.direction);
}

Buffer<float> planar_depths(const RangeScan& scan, const Execution& execution) {
  Buffer<float> depths(scan.ranges.size());
  const glm::dvec3 forward = -glm::dvec3(scan.camera.world_from_eye[2]);
  const auto project = [&](std::size_t first, const std::vector<Ray>& rays) {
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const double ahead = glm::dot(glm::dvec3(rays[i].direction), forward) / length_of(rays[i].direction);
      // Also false for rays without a direction, which meet nothing.
      depths[first + i] =
          ahead > 0 ? float(double(scan.ranges[first + i]) * ahead) : std::numeric_limits<float>::infinity();
    }
  };
  std::visit([&](const auto& model) { for_each_part(scan, model, execution, project); }, scan.camera.model);
  return depths;
}

}  // namespace frontmost
