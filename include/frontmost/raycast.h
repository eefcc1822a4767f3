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
#include <vector>

#include "frontmost/surfaces.h"
#include "frontmost/view.h"
#include "frontmost/visible.h"

namespace frontmost {

struct RayTree;  // src/raycast/index/ray_tree.h

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

  [[nodiscard]] const RayTree& tree() const { return *tree_; }

 private:
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
/// once; each cast() uses the threads it is given.
class RayCaster {
 public:
  RayCaster();
  ~RayCaster();
  RayCaster(RayCaster&&) noexcept;
  RayCaster& operator=(RayCaster&&) noexcept;
  RayCaster(const RayCaster&) = delete;
  RayCaster& operator=(const RayCaster&) = delete;

  /// What raycast() gives. The result stays as it is until the next cast() or take(); after an error it is unspecified.
  /// \throws Error as validate(view) does.
  const Visible& cast(const RayIndex& index, const View& view, const Execution& execution = {});
  /// Moves the last result out; the next cast() allocates another.
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

}  // namespace frontmost
