// SPDX-License-Identifier: Apache-2.0
// Ray casting: finds visible triangles by asking, for every sample, which triangle its ray meets first. The same index
// answers single questions: what a ray meets, whether two points see each other, which points a light reaches.
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

/// A hierarchy of boxes over the triangles of Surfaces, for any number of views and queries. It copies the world-space
/// vertices, so the surfaces may be destroyed; ids remain those of the surfaces. Threads may share an index, except
/// during refit() and follow().
///
/// A leaf holds eight triangles, chosen by median splits of runs of the surfaces' spatial order. A node holds eight
/// boxes, split by the surface area heuristic (J. Goldsmith, J. Salmon. Automatic Creation of Object Hierarchies for
/// Ray Tracing. 1987; binned as in I. Wald. On fast Construction of SAH-based Bounding Volume Hierarchies. 2007).
class RayIndex {
 public:
  /// O(n log n) for n triangles, in parallel; keeps about 46 bytes a triangle. The index is the same for any number of
  /// threads.
  explicit RayIndex(const Surfaces& surfaces, const Execution& execution = {});
  ~RayIndex();
  RayIndex(RayIndex&&) noexcept;
  RayIndex& operator=(RayIndex&&) noexcept;
  RayIndex(const RayIndex&) = delete;
  RayIndex& operator=(const RayIndex&) = delete;

  /// Updates the index after vertices or instances of the scene have moved; `surfaces` are of the same scene. Answers
  /// are to the bit those of a new index. The grouping of triangles and boxes stays, so queries grow slower as old
  /// neighbours part. O(n) in parallel, about a third of the time of a new index. A new index is built instead if rays
  /// can meet other triangles than before, or if the index holds thousands of coincident triangles. After an error or a
  /// cancelled call the index is empty.
  void refit(const Surfaces& surfaces, const Execution& execution = {});

  /// Updates the index after Surfaces::move() has moved one instance; `surfaces` are those of the index, or of the same
  /// scene. Answers are to the bit those of a new index; queries grow slower as after refit(). O(triangles of the
  /// instance log n), and O(n) the first time. A new index is built where refit() would build one, and if vertices
  /// become finite.
  /// \throws Error bad_argument for a missing instance.
  void follow(const Surfaces& surfaces, std::uint32_t instance, const Execution& execution = {});

  /// Number of triangles that a ray can meet: their vertices are finite, and no two vertices of one are the same in the
  /// mesh.
  [[nodiscard]] std::uint32_t triangle_count() const;
  /// World-space bounds of these triangles; empty if there are none.
  [[nodiscard]] const Box& bounds() const;
  [[nodiscard]] std::size_t byte_count() const;

 private:
  friend const RayTree& ray_tree(const RayIndex& index);
  std::unique_ptr<RayTree> tree_;
};

/// \returns the front-most triangle at every sample, along the sample's ray from the eye (in parallel projection, along
/// the viewing axis). Vertices are not snapped: the side on which a ray passes an edge is decided exactly on the
/// vertices' floats. A ray through an edge or vertex meets every triangle that has it, so no ray leaks between
/// neighbours; at equal keys the lower id wins. Near and far are tested at every sample. The result is the same to the
/// bit for any number of threads and any instruction set. (S. Woop, C. Benthin, I. Wald. Watertight Ray/Triangle
/// Intersection. 2013. A. Reshetov, A. Soupikov, J. Hurley. Multi-Level Ray Tracing Algorithm. 2005.)
/// \throws Error as validate(view) does.
[[nodiscard]] Visible raycast(const RayIndex& index, const View& view, const Execution& execution = {});
/// Builds an index for this one view and casts with it.
[[nodiscard]] Visible raycast(const Surfaces& surfaces, const View& view, const Execution& execution = {});

/// Ray casting for repeated views, which reuses memory from cast to cast. A RayCaster may not be used by several
/// threads at once; each draw() runs on the threads it is given.
class RayCaster {
 public:
  RayCaster();
  ~RayCaster();
  RayCaster(RayCaster&&) noexcept;
  RayCaster& operator=(RayCaster&&) noexcept;
  RayCaster(const RayCaster&) = delete;
  RayCaster& operator=(const RayCaster&) = delete;

  /// \returns what raycast() returns, valid until the next draw() or take(); unspecified after an error.
  /// \throws Error as validate(view) does.
  const Visible& draw(const RayIndex& index, const View& view, const Execution& execution = {});
  /// Moves the last result out. The next draw() allocates another one.
  [[nodiscard]] Visible take();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// Rays and segments are in world space, relative to Scene::origin. Subtract the origin, in doubles, from points in
// coordinates of the file.

/// The points origin + t * direction for t > 0. The direction may have any length.
struct Ray {
  glm::vec3 origin{0}, direction{0, 0, -1};
};

/// The points between two others: from + t * (to - from) for 0 < t < 1.
struct Segment {
  glm::vec3 from{0}, to{0};
};

/// A point at which a ray or segment meets a surface.
struct RayHit {
  PrimitiveId primitive = no_primitive;  ///< no_primitive: nothing is met
  double t = std::numeric_limits<double>::infinity();
  bool is_front = false;  ///< met from the side on which the mesh's vertices run counter-clockwise; see is_mirrored()

  [[nodiscard]] explicit operator bool() const { return primitive != no_primitive; }
};

// Queries see both sides of every triangle. They are decided exactly on the floats of query and vertices, without
// tolerance. A ray or segment meets a triangle if it passes through the triangle. It does not meet a triangle that
// contains the ray's origin or an end of the segment, nor one whose plane contains the line. A line through an edge or
// vertex meets every triangle that has it, so nothing slips through a closed surface. Swapping the ends of a segment
// changes nothing, except at the rims of holes, which are looked up at the rounded point. Only t is rounded, to
// doubles; at equal t the lower id wins. Queries with non-finite coordinates, rays without direction and segments of
// length 0 meet nothing and are clear. O(log n) each in ordinary scenes.

/// The nearest surface along a ray, or along a segment from its start.
[[nodiscard]] RayHit closest_hit(const RayIndex& index, const Ray& ray);
[[nodiscard]] RayHit closest_hit(const RayIndex& index, const Segment& segment);
/// All surfaces along a ray, nearest first.
[[nodiscard]] std::vector<RayHit> all_hits(const RayIndex& index, const Ray& ray);
/// True if a segment meets no surface, so its ends see each other. Faster than closest_hit().
[[nodiscard]] bool is_clear(const RayIndex& index, const Segment& segment);

/// Finds the nearest surface of each query, on all threads. Answers do not depend on the number of threads.
/// \throws Error bad_argument unless there are as many answers as queries.
void closest_hits(const RayIndex& index, std::span<const Ray> rays, std::span<RayHit> answers,
                  const Execution& execution = {});
void closest_hits(const RayIndex& index, std::span<const Segment> segments, std::span<RayHit> answers,
                  const Execution& execution = {});
/// Sets the answer of each segment: 1 if the segment is clear, 0 if it is blocked.
/// \throws Error as closest_hits() does.
void are_clear(const RayIndex& index, std::span<const Segment> segments, std::span<std::uint8_t> answers,
               const Execution& execution = {});

/// An exact point of a triangle: the mean of the vertices with `weights`, moved by `lift`. The mean is not rounded, so
/// it lies in the triangle's plane, where a point made of floats seldom lies.
struct TrianglePoint {
  PrimitiveId primitive = no_primitive;  ///< the triangle's id, if the index holds the triangle
  std::array<glm::vec3, 3> corners{};
  glm::vec3 weights{1, 1, 1};  ///< with any sum; no weight is negative, and not all are zero
  glm::vec3 lift{0};
};

/// Finds the points that a light at infinity reaches: 1 lit, 0 in shadow. A point is in shadow if the ray from it
/// towards the light passes through a triangle, front or back. The point's own triangle, triangles with the same three
/// vertices and triangles that contain the point do not count, so no neighbour casts a false shadow. The answer is
/// exact, without tolerance. Neighbouring points are answered faster if they follow one another. Points with non-finite
/// values are lit, and so are all if the light has no direction.
/// \throws Error bad_argument unless there are as many answers as points.
void are_lit(const RayIndex& index, std::span<const TrianglePoint> points, const glm::vec3& to_light,
             std::span<std::uint8_t> answers, const Execution& execution = {});

// Cameras that only rays can serve: panoramas, fisheyes, and the patterns of laser scanners.
//
// Directions are in eye space, as for every camera: x right, y up, the eye looks down -z. The azimuth counts from
// straight ahead to the right, the elevation from the horizon upwards. Azimuth a and elevation e are the direction (sin
// a cos e, sin e, -cos a cos e). Pixel (x, y) has its ray at its centre, (x + 0.5, y + 0.5), rows from the top. With
// several samples, the rays pass through the sample positions of a View within the pixel.

/// An equirectangular picture: azimuth and elevation are affine over it. The left side is -180 degrees, straight
/// behind; a quarter of the width is the left, the middle is straight ahead; the top is straight up. Pixels are square
/// along the horizon if the picture is twice as wide as high.
struct Panorama {
  int width = 2048, height = 1024;  ///< pixels, 1 to 16384 each
};

/// An equidistant fisheye: the angle from the viewing axis is proportional to the distance from the picture's middle.
/// The angle is fov / 2 on the circle that touches the nearer sides. Pixels beyond the circle see nothing. (K.
/// Miyamoto. Fish Eye Lens. 1964.)
struct Fisheye {
  int width = 1024, height = 1024;      ///< pixels, 1 to 16384 each
  double fov = 3.14159265358979323846;  ///< radians, above 0, at most a full turn; then the rim is straight behind
};

/// A scanner that turns about its up axis. Column k of n has azimuth first + k (last - first) / (n - 1), so both ends
/// are included; a single column has azimuth `first`. A full turn (to 1e-9) does not repeat its first ray: its column k
/// has azimuth first + k (last - first) / n. The scanner turns left if `last` is below `first`. Row r is ring r.
struct Lidar {
  std::vector<double> elevations;  ///< elevation of each ring, in radians, -pi/2 to pi/2
  int steps = 1024;                ///< number of azimuths, at least 1
  /// Radians to the right of straight ahead, -2 pi to 2 pi, at most a full turn apart.
  double first_azimuth = 0, last_azimuth = 2 * 3.14159265358979323846;
};

/// Any rays from one point, in a single row: for other lenses, Risley scanners or sampling patterns.
struct RayPattern {
  std::vector<glm::vec3> directions;  ///< in eye space, of any length; zero or non-finite ones see nothing
};

/// A camera of rays from one point. The origin of the rays and their directions are rounded to floats.
struct RayCamera {
  std::variant<Panorama, Fisheye, Lidar, RayPattern> model;
  glm::dmat4 world_from_eye{1.0};  ///< a rotation and a translation, relative to Scene::origin as in a View
  int samples = 1;                 ///< panoramas and fisheyes, per pixel: 1, 2, 4, 8 or 16, as in sample_offsets()
  /// Least and greatest range, both inclusive. A surface out of range is no hit, but still hides surfaces behind it.
  double nearest = 0, farthest = std::numeric_limits<double>::infinity();
};

/// Elevations of `rings` rings, evenly spaced from `highest` down to `lowest`; a single ring gets the mean of the two.
/// \throws Error bad_argument unless rings >= 1 and lowest <= highest.
[[nodiscard]] std::vector<double> ring_elevations(int rings, double lowest, double highest);

/// \throws Error bad_argument, limit_exceeded (more than most_samples rays in all) or singular_camera.
void validate(const RayCamera& camera);

/// \returns the numbers of columns and rows of rays. Panoramas and fisheyes: width and height; scanners: steps and
/// rings; patterns: number of directions and 1.
[[nodiscard]] glm::ivec2 grid_of(const RayCamera& camera);

/// The ray of a pixel's sample, in world space, the same bits on every machine. Its direction has unit length (to
/// rounding), or the pattern's length, or is zero if the sample sees nothing. Precondition: the camera is valid, and
/// pixel and sample exist.
[[nodiscard]] Ray ray_of(const RayCamera& camera, int x, int y, int sample = 0);

/// The surfaces that the rays of a camera meet. Planes are ordered [sample][y][x], top row first.
struct RangeScan {
  RayCamera camera;
  int width = 0, height = 0;       ///< grid_of(camera)
  Buffer<PrimitiveId> primitives;  ///< no_primitive where nothing is met
  Buffer<float> ranges;            ///< distance from the eye along the ray, in scene units; +inf where nothing is met

  [[nodiscard]] std::size_t index(int x, int y, int sample = 0) const {
    return (std::size_t(sample) * std::size_t(height) + std::size_t(y)) * std::size_t(width) + std::size_t(x);
  }
};

/// \returns the nearest surface along every ray, as closest_hits() finds it, if the camera allows the surface's range.
/// Both sides of every triangle are seen. The result is the same to the bit for any number of threads and any
/// instruction set. O(log n) a ray. Neighbours on the grid with nearly the same direction are cast together, five to
/// fifteen times as fast as one by one. (I. Wald, P. Slusallek, C. Benthin, M. Wagner. Interactive Rendering with
/// Coherent Ray Tracing. 2001.)
/// \throws Error as validate(camera) does.
[[nodiscard]] RangeScan scan(const RayIndex& index, const RayCamera& camera, const Execution& execution = {});

/// The point where a sample's ray meets the surface, in world space. Precondition: the ray meets a surface.
[[nodiscard]] glm::dvec3 point_of(const RangeScan& scan, int x, int y, int sample = 0);

/// \returns the planar depth of every sample, in the scan's order, as a pinhole camera in that pose would find it. The
/// depth is +inf where nothing is met, and for rays at 90 degrees or more from the viewing axis, for which no planar
/// depth is defined.
[[nodiscard]] Buffer<float> planar_depths(const RangeScan& scan, const Execution& execution = {});

/// \returns the angle of incidence of every sample, in the scan's order: degrees between the sample's ray and the
/// normal of the triangle that the ray meets. The angle is 0 head-on and nearly 90 if the ray grazes the triangle, from
/// either side; NaN where nothing is met. Precondition: the scan is of these surfaces, unchanged since.
[[nodiscard]] Buffer<float> incidence_angles(const RangeScan& scan, const Surfaces& surfaces,
                                             const Execution& execution = {});

}  // namespace frontmost
