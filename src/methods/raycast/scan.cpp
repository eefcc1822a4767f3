// SPDX-License-Identifier: Apache-2.0
// Ray cameras, for views that only rays can serve. A scan casts the rays of such a camera in packets of neighbours.
//
//     wide grid, rows close together      The columns and rows of a packet make it look as nearly square as possible,
//     +----------------+                  so that its rays spread as little as possible: a scanner whose rings lie far
//     | 16 x 4         |                  apart is cast in flat blocks.
//     +----------------+
#include <algorithm>
#include <atomic>
#include <cmath>

#include "base/parallel.h"
#include "raycast/camera_rays.h"
#include "raycast/packet/scan_packet.h"
#include "raycast/query/queries.h"

namespace frontmost {
namespace {

using namespace raycast_detail;

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

constexpr std::size_t kRaysPerPart = 4096;

/// Calls visit(index of the first ray, rays) for the rays of every part of the grid, sample by sample, on all threads.
template <class Model, class Visit>
void for_each_part(const RangeScan& scan, const Model& model, const Execution& execution, const Visit& visit) {
  const RayPose pose(scan.camera.world_from_eye);
  const std::size_t count = std::size_t(scan.width) * std::size_t(scan.height);
  std::size_t plane = 0;
  for (const glm::ivec2& offset : sample_offsets(scan.camera.samples)) {
    const GridDirections<Model> directions(model, offset);
    parallel_for(execution, count, kRaysPerPart, [&](std::size_t begin, std::size_t end) {
      std::vector<Ray> rays;
      rays.reserve(end - begin);
      for (std::size_t i = begin; i < end; ++i)
        rays.push_back(pose.place(directions.at(int(i % std::size_t(scan.width)), int(i / std::size_t(scan.width)))));
      visit(plane + begin, rays);
    });
    plane += count;
  }
}

/// Returns the columns and rows of the packet that looks most nearly square in the middle of the grid.
template <class Model>
glm::ivec2 packet_shape(const RangeScan& scan, const GridDirections<Model>& directions) {
  const int x = scan.width / 2, y = scan.height / 2;
  const glm::dvec3 middle = directions.at(x, y);
  const double across = x > 0 ? glm::distance(middle, directions.at(x - 1, y)) : 0;
  const double down = y > 0 ? glm::distance(middle, directions.at(x, y - 1)) : 0;
  const auto spread = [&](const glm::ivec2& shape) { return std::max(shape.x * across, shape.y * down); };
  glm::ivec2 best(int(kScanRays), 1);
  for (int rows = 2; rows <= int(kScanRays) && rows < 2 * scan.height; rows *= 2) {
    const glm::ivec2 next(int(kScanRays) / rows, rows);
    if (spread(next) < spread(best)) best = next;
  }
  return best;
}

/// Casts one sample of every pixel.
template <class Model>
class ScanCaster {
 public:
  ScanCaster(const RayTree& tree, const Model& model, int sample, RangeScan& scan)
      : tree_(tree),
        scan_(scan),
        sample_(sample),
        directions_(model, sample_offsets(scan.camera.samples)[std::size_t(sample)]),
        pose_(scan.camera.world_from_eye),
        shape_(packet_shape(scan, directions_)),
        across_((scan.width + shape_.x - 1) / shape_.x) {}

  void cast(const Execution& execution) const {
    const std::size_t packets = std::size_t(across_) * std::size_t((scan_.height + shape_.y - 1) / shape_.y);
    std::atomic<std::size_t> done{0};
    parallel_for(execution, packets, kPacketsPerPart, [&](std::size_t begin, std::size_t end) {
      ScanScratch scratch(tree_);
      ScanPacket packet;
      for (std::size_t i = begin; i < end; ++i) cast_block(i, packet, scratch, execution.isa);
      const double part = double(done += end - begin) / double(packets);
      report_progress(execution, "visible", (sample_ + part) / scan_.camera.samples);
    });
  }

 private:
  static constexpr std::size_t kPacketsPerPart = 64;

  void cast_block(std::size_t number, ScanPacket& packet, ScanScratch& scratch, Isa isa) const {
    const glm::ivec2 begin = shape_ * glm::ivec2(int(number) % across_, int(number) / across_);
    const glm::ivec2 end = glm::min(begin + shape_, glm::ivec2(scan_.width, scan_.height));
    packet.count = 0;
    for (int y = begin.y; y < end.y; ++y)
      for (int x = begin.x; x < end.x; ++x) {
        const Ray ray = pose_.place(directions_.at(x, y));
        packet.origin = ray.origin;
        for (int axis = 0; axis < 3; ++axis) packet.direction[axis][packet.count] = ray.direction[axis];
        ++packet.count;
      }
    cast_scan(tree_, packet, scratch, isa);
    const std::size_t columns = std::size_t(end.x - begin.x);
    for (int y = begin.y; y < end.y; ++y) {
      const std::size_t from = std::size_t(y - begin.y) * columns, to = scan_.index(begin.x, y, sample_);
      std::copy_n(packet.primitive + from, columns, scan_.primitives.data() + to);
      std::copy_n(packet.range + from, columns, scan_.ranges.data() + to);
    }
  }

  const RayTree& tree_;
  RangeScan& scan_;
  int sample_;
  GridDirections<Model> directions_;
  RayPose pose_;
  glm::ivec2 shape_;
  int across_;  ///< packets side by side
};

/// A scan with room for the answers. \throws Error as validate(camera) does.
RangeScan prepare_scan(const RayCamera& camera) {
  validate(camera);
  RangeScan result{camera, grid_of(camera).x, grid_of(camera).y, {}, {}};
  const std::size_t count = result.index(0, 0, camera.samples);
  result.primitives = Buffer<PrimitiveId>(count);
  result.ranges = Buffer<float>(count);
  return result;
}

/// Removes hits beyond the camera's limits of range.
void keep_in_range(RangeScan& scan, const Execution& execution) {
  const double nearest = scan.camera.nearest, farthest = scan.camera.farthest;
  constexpr float nowhere = std::numeric_limits<float>::infinity();
  if (nearest == 0 && farthest == double(nowhere)) return;
  parallel_for(execution, scan.ranges.size(), kRaysPerPart, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (scan.ranges[i] >= nearest && scan.ranges[i] <= farthest) continue;
      scan.primitives[i] = no_primitive;
      scan.ranges[i] = nowhere;
    }
  });
}

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
    throw Error(ErrorCode::bad_argument, "ray camera: ranges", "the least range must be from 0 to the greatest range");
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
  const RayPose pose(camera.world_from_eye);
  const PixelPlace at{x, y, sample_offsets(camera.samples)[std::size_t(sample)]};
  return std::visit([&](const auto& model) { return pose.place(direction_of(model, at)); }, camera.model);
}

RangeScan scan(const RayIndex& index, const RayCamera& camera, const Execution& execution) {
  RangeScan result = prepare_scan(camera);
  const auto cast = [&](const auto& model) {
    for (int sample = 0; sample < camera.samples; ++sample)
      ScanCaster(ray_tree(index), model, sample, result).cast(execution);
  };
  std::visit(cast, camera.model);
  keep_in_range(result, execution);
  return result;
}

Buffer<float> incidence_angles(const RangeScan& scan, const Surfaces& surfaces, const Execution& execution) {
  Buffer<float> angles(scan.ranges.size());
  const auto measure = [&](std::size_t first, const std::vector<Ray>& rays) {
    for (std::size_t i = first; i < first + rays.size(); ++i) {
      angles[i] = std::numeric_limits<float>::quiet_NaN();
      if (scan.primitives[i] == no_primitive) continue;
      const std::array<glm::vec3, 3> corners = surfaces.corners(scan.primitives[i]);
      const glm::dvec3 a(corners[0]), ray(rays[i - first].direction);
      const glm::dvec3 normal = glm::cross(glm::dvec3(corners[1]) - a, glm::dvec3(corners[2]) - a);
      // The angle comes from atan2, as the cosine is inaccurate near 0 degrees.
      angles[i] =
          float(glm::degrees(std::atan2(glm::length(glm::cross(ray, normal)), std::abs(glm::dot(ray, normal)))));
    }
  };
  std::visit([&](const auto& model) { for_each_part(scan, model, execution, measure); }, scan.camera.model);
  return angles;
}

glm::dvec3 point_of(const RangeScan& scan, int x, int y, int sample) {
  const Ray ray = ray_of(scan.camera, x, y, sample);
  const double range = scan.ranges[scan.index(x, y, sample)];
  return glm::dvec3(ray.origin) + range / glm::length(glm::dvec3(ray.direction)) * glm::dvec3(ray.direction);
}

Buffer<float> planar_depths(const RangeScan& scan, const Execution& execution) {
  Buffer<float> depths(scan.ranges.size());
  const glm::dvec3 forward = -glm::dvec3(scan.camera.world_from_eye[2]);
  const auto project = [&](std::size_t first, const std::vector<Ray>& rays) {
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const double ahead =
          glm::dot(glm::dvec3(rays[i].direction), forward) / glm::length(glm::dvec3(rays[i].direction));
      // Also false for rays without a direction, which meet nothing.
      depths[first + i] =
          ahead > 0 ? float(double(scan.ranges[first + i]) * ahead) : std::numeric_limits<float>::infinity();
    }
  };
  std::visit([&](const auto& model) { for_each_part(scan, model, execution, project); }, scan.camera.model);
  return depths;
}

}  // namespace frontmost
