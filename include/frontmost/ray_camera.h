// SPDX-License-Identifier: Apache-2.0
// Cameras that only rays can serve: all around in one picture, and the patterns of laser scanners.
//
// Directions are those of eye space, as for every camera: the eye looks down -z, y up, x right. An azimuth is counted
// from straight ahead to the right, an elevation from the horizon upwards: azimuth a and elevation e are the direction
// (sin a cos e, sin e, -cos a cos e). Pixel (x, y) asks at its centre, (x + 0.5, y + 0.5), rows from the top; with more
// samples at their places within the pixel, which are those of a View.
#pragma once

#include <variant>
#include <vector>

#include "frontmost/raycast.h"

namespace frontmost {

/// Equirectangular: azimuth and elevation are affine over the picture. The left side is -180 degrees, straight behind;
/// a quarter of the width is the left, the middle straight ahead; the top is straight up. Twice as wide as high gives
/// pixels that are square along the horizon.
struct Panorama {
  int width = 2048, height = 1024;  ///< pixels, 1 to 16384 each
};

/// Equidistant: the angle from the viewing axis is proportional to the distance from the picture's middle, and is
/// fov / 2 where the circle touches the nearer sides. Pixels beyond the circle see nothing.
/// (K. Miyamoto. Fish Eye Lens. 1964.)
struct Fisheye {
  int width = 1024, height = 1024;      ///< pixels, 1 to 16384 each
  double fov = 3.14159265358979323846;  ///< radians, above 0; at most a full turn, where the rim is straight behind
};

/// A scanner that turns about its up axis: column k of n looks at azimuth first + k (last - first) / (n - 1), so that
/// both ends are looked at, and at the first alone where n is 1. A full turn (to 1e-9) does not repeat its first ray:
/// there column k is at first + k (last - first) / n. Where `last` is below `first` it turns to the left. Row r is ring
/// r.
struct Lidar {
  std::vector<double> elevations;  ///< of each ring, in radians, -pi/2 to pi/2
  int steps = 1024;                ///< azimuths, at least 1
  /// Radians to the right of ahead, -2 pi to 2 pi, at most a full turn apart.
  double first_azimuth = 0, last_azimuth = 2 * 3.14159265358979323846;
};

/// Any rays from one point, as a single row: other lenses, risley scanners, sampling patterns.
struct RayPattern {
  std::vector<glm::vec3> directions;  ///< in eye space, of any length; zero or not finite sees nothing
};

/// Where the rays start, and how they spread. The eye and the rays' directions are rounded to floats.
struct RayCamera {
  std::variant<Panorama, Fisheye, Lidar, RayPattern> model;
  glm::dmat4 world_from_eye{1.0};  ///< a rotation and a translation, about Scene::origin as a View's is
  int samples = 1;                 ///< of panoramas and fisheyes, per pixel: 1, 2, 4, 8 or 16, as sample_offsets()
  /// Least and greatest range, both allowed. What is met elsewhere counts as nothing, and still hides what is behind
  /// it.
  double nearest = 0, farthest = std::numeric_limits<double>::infinity();
};

/// Elevations of `rings` rings, evenly from `highest` down to `lowest`; the middle of both for a single ring.
/// \throws Error bad_argument unless rings >= 1 and lowest <= highest.
[[nodiscard]] std::vector<double> ring_elevations(int rings, double lowest, double highest);

/// \throws Error bad_argument, limit_exceeded (more than most_samples rays in all) or singular_camera.
void validate(const RayCamera& camera);

/// Columns and rows of the rays: pixels; steps and rings; the length of the pattern and 1.
[[nodiscard]] glm::ivec2 grid_of(const RayCamera& camera);

/// The ray of a pixel's sample, in world space; of unit length (to rounding), or zero where it sees nothing; a
/// pattern's directions keep their length. The same bits on every machine. Precondition: the camera is valid, the pixel
/// in its grid, and the sample one of its.
[[nodiscard]] Ray ray_of(const RayCamera& camera, int x, int y, int sample = 0);

/// What the rays of a camera meet. Planes are ordered [sample][y][x], top row first.
struct RangeScan {
  RayCamera camera;
  int width = 0, height = 0;       ///< as grid_of(camera)
  Buffer<PrimitiveId> primitives;  ///< no_primitive where nothing is met
  Buffer<float> ranges;            ///< distance from the eye along the ray, in scene units; +inf where nothing is met

  [[nodiscard]] std::size_t index(int x, int y, int sample = 0) const {
    return (std::size_t(sample) * std::size_t(height) + std::size_t(y)) * std::size_t(width) + std::size_t(x);
  }
};

/// The nearest surface along every ray, as closest_hits() answers, where its range is one that the camera allows: both
/// sides of every triangle are seen. The same bits for any number of threads and any instruction set. O(log n) a ray.
/// Neighbours on the grid are cast together where they look nearly the same way, five to fifteen times as fast as one
/// by one. (I. Wald, P. Slusallek, C. Benthin, M. Wagner. Interactive Rendering with Coherent Ray Tracing. 2001.)
/// \throws Error as validate(camera) does.
[[nodiscard]] RangeScan scan(const RayIndex& index, const RayCamera& camera, const Execution& execution = {});

/// Where the ray of a pixel's sample meets the surface, in world space. Precondition: something is met there.
[[nodiscard]] glm::dvec3 point_of(const RangeScan& scan, int x, int y, int sample = 0);

/// Of every sample, in their order: distances along the viewing axis, as a pinhole camera in that pose would give them;
/// +inf where nothing is met, and for rays that do not lead ahead, at 90 degrees from the axis and more, for which
/// there is no such distance.
[[nodiscard]] Buffer<float> planar_depths(const RangeScan& scan, const Execution& execution = {});

/// Of every sample, in their order: the angle between its ray and the normal of the triangle that it meets, in degrees:
/// 0 head-on, nearly 90 where it grazes; from either side. NaN where nothing is met. Precondition: the scan is one of
/// these surfaces, as they still are.
[[nodiscard]] Buffer<float> incidence_angles(const RangeScan& scan, const Surfaces& surfaces,
                                             const Execution& execution = {});

}  // namespace frontmost
