// SPDX-License-Identifier: Apache-2.0
// Curved surfaces met by rays as they are: spheres and Bezier patches beside triangles, without tessellating anything.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "frontmost/ray_camera.h"

namespace frontmost {

struct CurvedParts;  // src/raycast/curved/curved_parts.h

/// A scene for rays: hierarchies of boxes over the spheres and patches of its curved meshes, and over the triangles of
/// the others. Ids are those of its elements: the running number over all instances in scene order, where a curved mesh
/// counts its curved primitives and any other mesh its triangles. Immutable, and safe to share between threads.
///
/// Where a ray meets a curved primitive is stated to a bound. Write s for the largest side of the box around a patch
/// (or a sphere's diameter) and d for the distance of the ray's origin from its farthest control point (or from the far
/// side of the sphere), both in world space. The point found lies within 2^-30 s + 2^-44 d of the ray, on the surface;
/// a ray that passes through the surface meets it; one that is told to, but does not, passes it within that bound: it
/// grazes an outline or a rim. No nearer point of the surface lies on the ray. For patches this holds by construction:
/// a part of one is left out only when the hull of its control points is clear of the ray, and a root is looked for
/// only where a bound on the derivatives leaves at most one. (T. Sederberg, T. Nishita. Curve Intersection Using Bezier
/// Clipping. 1990; T. Nishita, T. Sederberg, M. Kakimoto. Ray Tracing Trimmed Rational Surface Patches. 1990; for the
/// root R. Krawczyk. Newton-Algorithmen zur Bestimmung von Nullstellen mit Fehlerschranken. 1969.) Under a transform
/// that is not rigid, spheres are ellipsoids, and the bound grows by the ratio of their longest to their shortest axis;
/// one that is singular leaves nothing to be met of a sphere.
/// Spheres with sizes or places beyond 2^250, and patches beyond 2^500, are never met.
class CurvedIndex {
 public:
  /// Copies what it needs of `scene`. O(n log n) for n elements; about 30 kB a patch, 150 bytes a sphere.
  /// \throws Error as Surfaces(scene) does.
  explicit CurvedIndex(const Scene& scene, const Execution& execution = {});
  ~CurvedIndex();
  CurvedIndex(CurvedIndex&&) noexcept;
  CurvedIndex& operator=(CurvedIndex&&) noexcept;
  CurvedIndex(const CurvedIndex&) = delete;
  CurvedIndex& operator=(const CurvedIndex&) = delete;

  /// Elements of the scene, those that are never met included.
  [[nodiscard]] std::uint32_t element_count() const;
  /// Of an element: instance, mesh, and the triangle's or curved primitive's number there. O(log instances).
  /// Precondition: id < element_count().
  [[nodiscard]] PrimitiveSource source(PrimitiveId id) const;
  [[nodiscard]] std::size_t byte_count() const;

  [[nodiscard]] const CurvedParts& parts() const { return *parts_; }

 private:
  std::unique_ptr<const CurvedParts> parts_;
};

/// Where a ray meets an element.
struct CurvedHit {
  PrimitiveId primitive = no_primitive;  ///< no_primitive: nothing is met
  double t = std::numeric_limits<double>::infinity();
  bool is_front = false;
  glm::dvec2 parameters{0};  ///< (u, v) on a curved primitive; zero on triangles
  glm::dvec3 normal{0};      ///< in world space, unit length, outwards; zero on triangles

  [[nodiscard]] explicit operator bool() const { return primitive != no_primitive; }
};

/// The nearest surface along a ray, both sides of all; at equal t the lower id. Triangles as closest_hit() of a
/// RayIndex decides. Rays that are not finite or have no direction meet nothing.
[[nodiscard]] CurvedHit closest_hit(const CurvedIndex& index, const Ray& ray);
/// Between two points the nearest to `from`. A curved surface that passes one of them within the bound may be met or
/// not; all else is as for rays.
[[nodiscard]] CurvedHit closest_hit(const CurvedIndex& index, const Segment& segment);

/// The same for many, on all threads; the answers do not depend on how many.
/// \throws Error bad_argument when there are not as many answers as queries.
void closest_hits(const CurvedIndex& index, std::span<const Segment> segments, std::span<CurvedHit> answers,
                  const Execution& execution = {});

/// What the rays of a camera meet, and from which side.
struct CurvedScan {
  RangeScan scan;  ///< ids are those of the index's elements
  /// By ray: of unit length, outwards, of triangles that of their plane; anything where nothing is met.
  Buffer<glm::vec3> normals;
};

/// As scan() of a RayIndex. \throws Error as validate(camera) does.
[[nodiscard]] CurvedScan scan(const CurvedIndex& index, const RayCamera& camera, const Execution& execution = {});

/// As incidence_angles() of a RangeScan, to the surfaces' own normals.
[[nodiscard]] Buffer<float> incidence_angles(const CurvedScan& scan, const Execution& execution = {});

/// What the rays of a view meet, and where on the curved primitives.
struct CurvedVisible {
  Visible visible;  ///< ids are those of the index's elements
  /// (u, v) and outward normal, in the order of Visible; anything where no curved primitive is seen.
  Buffer<glm::vec2> parameters;
  Buffer<glm::vec3> normals;
};

/// The front-most element at every sample, as raycast() of a RayIndex gives it for triangles: greater keys are nearer,
/// at equal keys the lower id wins, near and far are tested at every sample, View::culling decides by the side that is
/// met. The bits do not depend on threads. \throws Error as validate(view) does.
[[nodiscard]] CurvedVisible raycast(const CurvedIndex& index, const View& view, const Execution& execution = {});

/// A scene of triangles that shows what rays have met, for all that is made of triangles: shade(), maps, reports.
struct Facets {
  Scene scene;
  std::vector<Visible> visible;       ///< of each view, with ids of Surfaces(scene)
  std::vector<PrimitiveId> elements;  ///< by those ids, the element of the index
};

/// Gives every pixel a facet for each curved element that is seen there: a triangle a few pixels wide in the tangent
/// plane, with the normal and about it the texture coordinates of the surface. (R. Cook, L. Carpenter, E. Catmull. The
/// Reyes Image Rendering Architecture. 1987: micropolygons, here made only where they are seen.) Instances, materials
/// and triangles that are not curved are those of `scene`; curved meshes also keep the triangles that they have, which
/// are not seen from here, but throw shadows where nothing better is given (ShadeInput::seen_by_light). Not for
/// scenes that are seen through: shade() looks for what lies behind among triangles, which tessellate() makes.
/// O(samples + size of the scene); about 130 bytes a facet. Precondition: the index is of this scene, the views of it.
[[nodiscard]] Facets facets_of(const CurvedIndex& index, const Scene& scene, std::span<const CurvedVisible> views);

}  // namespace frontmost
