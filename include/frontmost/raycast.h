// SPDX-License-Identifier: Apache-2.0
// Ray casting: visibility by asking, for every sample, which triangle its ray meets first. The same index answers
// single questions: what is met along a ray, whether two points see each other, and what a light reaches.
//
//   RayIndex           a hierarchy of boxes             views     raycast(), RayCaster
//      [            ]  boxes of boxes                   rays      closest_hit(), all_hits()
//      [   ] [      ]  boxes of triangles               sight     is_clear(), are_clear()
//       ///   / \ //   triangles                        light     are_lit()
#pragma once

#include <array>
#include <memory>
#include <span>
#include <variant>
#include <vector>

#include "frontmost/scene.h"
#include "frontmost/view.h"

namespace frontmost {

struct RayTree;  // src/methods/raycast/index/ray_tree.h

/// A hierarchy of boxes over the triangles of `Surfaces`, for any number of views and queries. Holds world-space
/// corners of its own, so the surfaces may go; the ids are theirs. Safe to share between threads, but for refit().
///
/// Sixteen triangles a leaf, dealt out by median splits of runs of the surfaces' spatial order; sixteen boxes a node,
/// split by the surface area heuristic
/// (J. Goldsmith, J. Salmon. Automatic Creation of Object Hierarchies for Ray Tracing. 1987; binned as in I. Wald.
/// On fast Construction of SAH-based Bounding Volume Hierarchies. 2007).
class RayIndex {
 public:
  /// O(n log n) for n triangles, in parallel; about 45 bytes a triangle kept. The same for any number of threads.
  explicit RayIndex(const Surfaces& surfaces, const Execution& execution = {});
  ~RayIndex();
  RayIndex(RayIndex&&) noexcept;
  RayIndex& operator=(RayIndex&&) noexcept;
  RayIndex(const RayIndex&) = delete;
  RayIndex& operator=(const RayIndex&) = delete;

  /// Follows the triangles to where they are in `surfaces`: those of the same scene after its vertices or instances
  /// have moved. Answers are to the bit those of a new index; what is kept is the order of triangles and boxes, so that
  /// queries grow slower the less of the old neighbourhoods is left. O(n) in parallel, about a third of the time of a
  /// new index, which is made where `surfaces` has triangles to meet that this one does not hold. Ended by an error or
  /// by cancelling, the index is empty.
  void refit(const Surfaces& surfaces, const Execution& execution = {});

  /// Follows one instance to where Surfaces::move() has put it: the surfaces are those that the index was made of, or
  /// of the same scene. Answers are to the bit those of a new index, and queries grow slower as after refit().
  /// O(triangles of the instance log n), and O(n) the first time. Made anew where refit() would be, and where corners
  /// become finite. \throws Error bad_argument for an instance that is not there.
  void follow(const Surfaces& surfaces, std::uint32_t instance, const Execution& execution = {});

  /// Triangles that a ray can meet: those with finite corners, no two the same in their meshes.
  [[nodiscard]] std::uint32_t triangle_count() const;
  /// World-space bounds of these triangles; empty without any.
  [[nodiscard]] const Box& bounds() const;
  [[nodiscard]] std::size_t byte_count() const;

 private:
  friend const RayTree& ray_tree(const RayIndex& index);
  std::unique_ptr<RayTree> tree_;
};

/// The front-most triangle at every sample, by the ray from the eye through it (parallel projection: along the viewing
/// axis). Nothing is snapped: corners are where floats put them, and whether a ray passes an edge on its left or right
/// is decided exactly on those floats. A ray through an edge or corner meets every triangle that has it, so no ray
/// leaks between neighbours; at equal keys the lower id wins. Near and far are tested at every sample.
/// The result is the same to the bit for any number of threads and any instruction set.
/// (S. Woop, C. Benthin, I. Wald. Watertight Ray/Triangle Intersection. 2013. A. Reshetov, A. Soupikov, J. Hurley.
/// Multi-Level Ray Tracing Algorithm. 2005.)
/// \throws Error as validate(view) does.
[[nodiscard]] Visible raycast(const RayIndex& index, const View& view, const Execution& execution = {});
/// The same with an index made for this one view.
[[nodiscard]] Visible raycast(const Surfaces& surfaces, const View& view, const Execution& execution = {});

/// The same for repeated views: casts after the first reuse the memory of those before. Not for several threads at
/// once; each draw() uses the threads it is given.
class RayCaster {
 public:
  RayCaster();
  ~RayCaster();
  RayCaster(RayCaster&&) noexcept;
  RayCaster& operator=(RayCaster&&) noexcept;
  RayCaster(const RayCaster&) = delete;
  RayCaster& operator=(const RayCaster&) = delete;

  /// What raycast() gives. The result stays as it is until the next draw() or take(); after an error it is unspecified.
  /// \throws Error as validate(view) does.
  const Visible& draw(const RayIndex& index, const View& view, const Execution& execution = {});
  /// Moves the last result out; the next draw() allocates another.
  [[nodiscard]] Visible take();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// Rays and segments are in world space, which is about Scene::origin: points in the coordinates of a file that lies far
// from zero have it taken off first, in doubles.

/// Points origin + t * direction for t > 0; the direction has any length.
struct Ray {
  glm::vec3 origin{0}, direction{0, 0, -1};
};

/// The points between two: from + t * (to - from) for 0 < t < 1.
struct Segment {
  glm::vec3 from{0}, to{0};
};

/// Where a surface is met.
struct RayHit {
  PrimitiveId primitive = no_primitive;  ///< no_primitive: nothing is met
  double t = std::numeric_limits<double>::infinity();
  bool is_front = false;  ///< met from the side that the mesh's corners run counter-clockwise on; see is_mirrored()

  [[nodiscard]] explicit operator bool() const { return primitive != no_primitive; }
};

// Queries see both sides of every triangle, and are decided exactly on the floats of the query and of the corners,
// without any tolerance. A surface is met where it is passed through: a triangle that contains an end of the segment
// or the origin of the ray is not met there, nor is one that lies along the line. A line through an edge or a corner
// meets every triangle that has it, so nothing slips through a closed surface. What lies between two points does not
// depend on which is asked from, but for the rims of holes, which are looked up at the rounded place. Only t is
// rounded, to doubles; at equal t the lower id wins.
// Queries with a coordinate that is not finite, rays without a direction and segments from a point to itself meet
// nothing, and are clear. O(log n) each in ordinary scenes.

/// The nearest surface along a ray; between two points, the nearest to `from`.
[[nodiscard]] RayHit closest_hit(const RayIndex& index, const Ray& ray);
[[nodiscard]] RayHit closest_hit(const RayIndex& index, const Segment& segment);
/// Every surface along a ray, nearest first.
[[nodiscard]] std::vector<RayHit> all_hits(const RayIndex& index, const Ray& ray);
/// True when no surface is met between two points: the line of sight. Quicker than closest_hit().
[[nodiscard]] bool is_clear(const RayIndex& index, const Segment& segment);

/// The same for many, on all threads; the answers do not depend on how many.
/// \throws Error bad_argument when there are not as many answers as queries.
void closest_hits(const RayIndex& index, std::span<const Ray> rays, std::span<RayHit> answers,
                  const Execution& execution = {});
void closest_hits(const RayIndex& index, std::span<const Segment> segments, std::span<RayHit> answers,
                  const Execution& execution = {});
/// 1 where the segment is clear, 0 where it is blocked.
void are_clear(const RayIndex& index, std::span<const Segment> segments, std::span<std::uint8_t> answers,
               const Execution& execution = {});

/// A point of a triangle, without rounding: the mean of its corners by weights, moved by `lift`. The number that this
/// stands for lies in the triangle's plane, which a point of floats seldom does.
struct TrianglePoint {
  PrimitiveId primitive = no_primitive;  ///< its triangle, where the index holds it
  std::array<glm::vec3, 3> corners{};
  glm::vec3 weights{1, 1, 1};  ///< of any sum; none negative, and not all zero
  glm::vec3 lift{0};
};

/// Which points of surfaces a light at infinity reaches: 1 lit, 0 in shadow. Decided exactly and without tolerance: a
/// point is in shadow when the ray from it towards the light passes through a triangle, front or back, other than its
/// own and those with the same three corners. Triangles that contain the point are not passed through, so none of those
/// that meet in an edge or corner throws a shadow on itself by rounding. Points near each other, in the order given,
/// are asked together, and quicker for it. Values that are not finite, and a light without direction: lit.
/// \throws Error bad_argument when there are not as many answers as points.
void are_lit(const RayIndex& index, std::span<const TrianglePoint> points, const glm::vec3& to_light,
             std::span<std::uint8_t> answers, const Execution& execution = {});

// Cameras that only rays can serve: all around in one picture, and the patterns of laser scanners.
//
// Directions are those of eye space, as for every camera: the eye looks down -z, y up, x right. An azimuth is counted
// from straight ahead to the right, an elevation from the horizon upwards: azimuth a and elevation e are the direction
// (sin a cos e, sin e, -cos a cos e). Pixel (x, y) asks at its centre, (x + 0.5, y + 0.5), rows from the top; with more
// samples at their places within the pixel, which are those of a View.

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
