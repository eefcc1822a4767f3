// SPDX-License-Identifier: Apache-2.0
// Bicubic Bezier patches, with equal bits on both sides of a shared edge, and the teapot made of them.
//
//            v = 0                  v = 1
//   u = 0    p[0]   p[1]   p[2]   p[3]
//            p[4]   p[5]   p[6]   p[7]
//            p[8]   p[9]   p[10]  p[11]
//   u = 1    p[12]  p[13]  p[14]  p[15]
//
// The four corners lie on the patch; the other points pull at it. An edge depends on its own four points only, so two
// patches with the same four points have the same edge.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "frontmost/scene.h"

namespace frontmost {

/// A point of a patch, and the directions in which u and v grow there.
struct PatchPoint {
  glm::dvec3 position, along_u, along_v;
  /// Normal of unit length, outward. At a pole, where an edge of constant u is contracted to a point, the normal is the
  /// limit of the normals around it. At other degenerate points it is the normal of a nearby point, or zero if that has
  /// none either.
  glm::dvec3 normal;
};

/// A parameter as a fraction with an explicit complement, so that walking an edge from the other end uses the same
/// numbers: 1 - 9/10 is not 1/10 in binary.
struct PatchParameter {
  double value, complement;
};
[[nodiscard]] inline PatchParameter fraction(int part, int whole) {
  return {double(part) / whole, double(whole - part) / whole};
}

/// The point of a patch at (u, v). Uses only +, * and sqrt, so the bits are the same on every machine. Points on a
/// common edge of two patches are bit-equal if the control points of the edge are, in whichever direction each patch
/// runs along the edge.
[[nodiscard]] PatchPoint evaluate(const BezierPatch& patch, PatchParameter u, PatchParameter v);

/// The 32 patches of the classic teapot, y up, standing on y = 0, spout towards +x: rim, upper and lower body, knob,
/// lid and bottom in four quarters each, then two pieces of the handle and two of the spout in two halves each. On the
/// texture, u goes once around, and v goes down from the rim (handle, spout: from the first end).
[[nodiscard]] std::vector<BezierPatch> teapot_patches();

}  // namespace frontmost
