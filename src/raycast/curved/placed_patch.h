// SPDX-License-Identifier: Apache-2.0
// A Bezier patch in its place, cut into pieces that are nearly flat.
#pragma once

#include <optional>
#include <vector>

#include "frontmost/scene.h"
#include "raycast/curved/box_tree.h"
#include "raycast/curved/double_ray.h"

namespace frontmost::raycast_detail {

/// Sixteen points, as in BezierPatch.
using ControlNet = std::array<glm::dvec3, 16>;

struct PatchPiece {
  BezierPatch patch;           ///< the piece alone, in world space
  glm::dvec2 low{0}, size{1};  ///< its parameters in the whole patch
  double scale = 0;            ///< the largest side of the box around the whole patch
  double outward = 1;          ///< -1 where the transform mirrors
  PrimitiveId id = no_primitive;

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

}  // namespace frontmost::raycast_detail
