// SPDX-License-Identifier: Apache-2.0
// Spheres and Bezier patches in their places, and where rays meet them. A sphere becomes an ellipsoid; a patch is cut
// into pieces that are nearly flat.
//
//       patch               pieces         A piece that is nearly flat has one root for a ray or none, and steps find
//     .-------.          .---.---.         it at once. So patches are cut beforehand, at most three times along each
//    /         .   ->   /    |    .        parameter, until the derivatives of a piece hardly change; what is left to
//    '---------'        '----'----'        halve while rays are traced are outlines.
#pragma once

#include <cmath>
#include <optional>
#include <vector>

#include "frontmost/scene.h"
#include "raycast/curved/box_tree.h"
#include "raycast/curved/double_ray.h"

namespace frontmost::raycast_detail {

struct PlacedSphere {
  glm::dmat3 unit_from_world;  ///< after moving the centre to the origin
  glm::dvec3 centre, reach;    ///< in world space: the middle and half the sides of the box around it
  PrimitiveId id = no_primitive;
  bool is_double_sided = false;

  [[nodiscard]] DoubleBox bounds() const;
};

/// None where nothing can be met: no positive radius, a singular transform, sizes and places that are not finite or
/// beyond 2^250 or its inverse.
[[nodiscard]] std::optional<PlacedSphere> place(const Sphere& sphere, const glm::dmat4& world_from_mesh,
                                                PrimitiveId id);

/// The nearest point of the sphere that the ray sees.
[[nodiscard]] std::optional<RayMeeting> meet(const PlacedSphere& sphere, const DoubleRay& ray);

/// Sixteen points, as in BezierPatch.
using ControlNet = std::array<glm::dvec3, 16>;

struct PatchPiece {
  BezierPatch patch;           ///< the piece alone, in world space
  glm::dvec2 low{0}, size{1};  ///< its parameters in the whole patch
  double scale = 0;            ///< the largest side of the box around the whole patch
  double outward = 1;          ///< -1 where the transform mirrors
  PrimitiveId id = no_primitive;
  bool is_double_sided = false;

  [[nodiscard]] DoubleBox bounds() const;
};

/// Appends the pieces of a patch; none where nothing can be met: control points that are not within 2^500 of the
/// origin.
void cut(const BezierPatch& patch, const glm::dmat4& world_from_mesh, PrimitiveId id, std::vector<PatchPiece>& pieces);

/// The point of the piece with the parameters `at` in it, `distance` along the ray in world units; none where it shows
/// its culled side.
[[nodiscard]] std::optional<RayMeeting> meeting_at(const PatchPiece& piece, const DoubleRay& ray, const glm::dvec2& at,
                                                   double distance);

/// The nearest point of the piece that the ray sees; one a rounding past the ray's end may be told too.
[[nodiscard]] std::optional<RayMeeting> meet(const PatchPiece& piece, const DoubleRay& ray);

/// The halves of a net, by de Casteljau; the common edge has the same bits in both.
struct NetHalves {
  ControlNet first, second;
};
[[nodiscard]] NetHalves halve(const ControlNet& net, bool along_u);
[[nodiscard]] DoubleBox bounds_of(const ControlNet& net);

// The numbers that decide where a ray meets a patch: one set for single rays and for packets, whose answers are equal.

inline constexpr double kContracting = 0.5;  ///< at most; steps then halve the distance to the root at least
inline constexpr int kMostSteps = 64;
inline constexpr double kThere = 0x1p-52;     ///< in parameters: nearer to a root steps do not come
inline constexpr double kSingular = 1e-6;     ///< of the product of its columns, a determinant that counts as none
inline constexpr double kNearEnough = 0.125;  ///< of the pad
/// A little farther than a ray reaches, so that whatever ties with its end is found in any order.
inline constexpr double kPastTheEnd = 1 + 0x1p-50;

// Parts of kFinestPart of the patch and kFinestPartOfReach of the distance are as good as points; CurvedIndex states
// it.
inline constexpr double kFinestPart = 0x1p-30, kFinestPartOfReach = 0x1p-44;
inline constexpr double kFinest = 0x1p-1000;  ///< denormal parts would round to themselves when halved, and never end
inline constexpr double kPad = 0x1p-4;  ///< of that: how far from the ray a hull counts as holding it; many roundings

/// The frame in which rays meet patches: its third axis is the ray.
struct RayFrame {
  glm::dvec3 along, across_x, across_y;  ///< of unit length, at right angles
  double length;                         ///< of the ray's direction
  double nearest, farthest;              ///< what counts along the ray, in world units

  /// (T. Duff et al. Building an Orthonormal Basis, Revisited. 2017.)
  explicit RayFrame(const DoubleRay& ray)
      : length(std::sqrt(glm::dot(ray.direction, ray.direction))),
        nearest(ray.from * length),
        farthest(ray.to * length * kPastTheEnd) {
    along = ray.direction / length;
    const double sign = std::copysign(1.0, along.z), a = -1 / (sign + along.z), b = along.x * along.y * a;
    across_x = glm::dvec3(1 + sign * along.x * along.x * a, sign * b, -sign * along.x);
    across_y = glm::dvec3(b, sign + along.y * along.y * a, -along.y);
  }
};

}  // namespace frontmost::raycast_detail
