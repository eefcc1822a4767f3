// SPDX-License-Identifier: Apache-2.0
// Directions of the rays of panoramas, fisheyes and laser scanners, for one pixel or for all.
//
//    panorama   columns are azimuths, rows are elevations
//    fisheye    the angle from the axis grows with the distance from the middle; beyond the rim there is no ray
//    lidar      columns are the scanner's steps, rows are its rings
//    pattern    one row of directions, as given
//
// Sines and cosines come from turn(), which gives the same bits on every machine and is exact at quarters of a turn.
// Positions within a pixel are in 1/256 pixel, so their angles are fractions of integers, too.
#pragma once

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <vector>

#include "frontmost/raycast.h"
#include "scene/turn.h"

namespace frontmost::raycast_detail {

/// (cos, sin) of an angle within a few turns, rounded to the nearest 2^-48 of a turn (2e-14 radians, far below floats).
[[nodiscard]] inline glm::dvec2 turn_by(double radians) {
  constexpr double whole = double(std::int64_t(1) << 48);
  return turn(std::int64_t(std::nearbyint(radians / (6.28318530717958647692) * whole)), std::int64_t(whole));
}

/// Returns the direction with this (cos, sin) of azimuth and of elevation.
[[nodiscard]] inline glm::dvec3 direction_at(const glm::dvec2& azimuth, const glm::dvec2& elevation) {
  return {azimuth.y * elevation.x, elevation.y, -azimuth.x * elevation.x};
}

/// A pixel, and a position in it in 1/256 pixel.
struct PixelPlace {
  int x, y;
  glm::ivec2 offset;
};

/// Returns (cos, sin) of the azimuth of a column, or of the elevation of a row. `offset` is the position within the
/// pixel.
[[nodiscard]] inline glm::dvec2 azimuth_of(const Panorama& camera, int x, int offset) {
  const std::int64_t w = camera.width, at = std::int64_t(x) * 256 + offset;
  return turn(2 * at - 256 * w, 512 * w);
}
[[nodiscard]] inline glm::dvec2 elevation_of(const Panorama& camera, int y, int offset) {
  const std::int64_t h = camera.height, at = std::int64_t(y) * 256 + offset;
  return turn(256 * h - 2 * at, 1024 * h);
}
[[nodiscard]] inline glm::dvec2 azimuth_of(const Lidar& camera, int x, int) {
  constexpr double whole = 6.28318530717958647692;
  const double span = camera.last_azimuth - camera.first_azimuth;
  const bool is_whole = std::abs(std::abs(span) - whole) <= 1e-9;
  if (is_whole && span > 0 && camera.first_azimuth == 0) return turn(x, camera.steps);
  const int gaps = is_whole ? camera.steps : std::max(camera.steps - 1, 1);
  return turn_by(camera.first_azimuth + span * x / gaps);
}
[[nodiscard]] inline glm::dvec2 elevation_of(const Lidar& camera, int y, int) {
  return turn_by(camera.elevations[std::size_t(y)]);
}

/// The direction of a camera whose columns are azimuths and whose rows are elevations.
template <class Turned>
[[nodiscard]] glm::dvec3 direction_of(const Turned& camera, const PixelPlace& at) {
  return direction_at(azimuth_of(camera, at.x, at.offset.x), elevation_of(camera, at.y, at.offset.y));
}
[[nodiscard]] inline glm::dvec3 direction_of(const Fisheye& camera, const PixelPlace& at) {
  const double right = at.x + at.offset.x / 256.0 - camera.width * 0.5;
  const double up = camera.height * 0.5 - at.y - at.offset.y / 256.0;
  // The lens is equidistant: the angle from the axis grows with the distance from the middle, up to half the field of
  // view at the rim.
  const double from_middle = std::sqrt(right * right + up * up);
  const double rim = std::min(camera.width, camera.height) * 0.5;
  if (from_middle > rim) return glm::dvec3(0);
  if (from_middle == 0) return {0, 0, -1};
  const glm::dvec2 angle = turn_by(camera.fov * 0.5 * from_middle / rim);
  return {angle.y * right / from_middle, angle.y * up / from_middle, -angle.x};
}

[[nodiscard]] inline glm::dvec3 direction_of(const RayPattern& camera, const PixelPlace& at) {
  return camera.directions[std::size_t(at.x)];
}

/// Directions of all pixels of a grid, at one place within each pixel. Azimuths of columns and elevations of rows are
/// computed once: the same bits, in a tenth of the time. Borrows the model.
template <class Model>
class GridDirections {
 public:
  GridDirections(const Model& model, const glm::ivec2& offset) : model_(model), offset_(offset) {
    if constexpr (is_turned) {
      const glm::ivec2 grid = grid_of({model});
      for (int x = 0; x < grid.x; ++x) azimuths_.push_back(azimuth_of(model, x, offset.x));
      for (int y = 0; y < grid.y; ++y) elevations_.push_back(elevation_of(model, y, offset.y));
    }
  }
  [[nodiscard]] glm::dvec3 at(int x, int y) const {
    if constexpr (is_turned)
      return direction_at(azimuths_[std::size_t(x)], elevations_[std::size_t(y)]);
    else
      return direction_of(model_, {x, y, offset_});
  }

 private:
  static constexpr bool is_turned = std::is_same_v<Model, Panorama> || std::is_same_v<Model, Lidar>;
  const Model& model_;
  glm::ivec2 offset_;
  std::vector<glm::dvec2> azimuths_, elevations_;
};

/// A camera's pose, split into rotation and origin.
class RayPose {
 public:
  explicit RayPose(const glm::dmat4& world_from_eye) : rotation_(world_from_eye), origin_(world_from_eye[3]) {}
  [[nodiscard]] Ray place(const glm::dvec3& direction_eye) const {
    return {origin_, glm::vec3(rotation_ * direction_eye)};
  }

 private:
  glm::dmat3 rotation_;
  glm::vec3 origin_;
};

}  // namespace frontmost::raycast_detail
