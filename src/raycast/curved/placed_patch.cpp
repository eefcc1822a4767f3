// SPDX-License-Identifier: Apache-2.0
// A patch is placed by its control points, because what is affine may be applied to these: rays then need no transform.
// It is halved by de Casteljau's construction, whose middle points are the same to the bit for both halves, so
// neighbouring pieces leave no crack between them.
//
// How much a piece bends along a parameter is the largest difference of its derivatives from their mean, as a share of
// the shorter of both means. The parameter that bends is halved; where both do, the one that was halved less often.
#include <cmath>

#include "raycast/curved/placed_curves.h"

namespace frontmost::raycast_detail {
namespace {

constexpr double kFarthest = 0x1p500;  ///< squares stay finite
constexpr int kMostHalvings = 3;       ///< of each parameter
constexpr double kMostBending = 0.15;  ///< of the mean derivative, by which derivatives of a piece may differ

/// How far the derivatives along one parameter depart from their mean, which is `mean`.
double spread(const ControlNet& net, bool along_u, const glm::dvec3& mean) {
  const std::size_t step = along_u ? 4 : 1, across = along_u ? 1 : 4;
  double most = 0;
  for (std::size_t line = 0; line < 4; ++line)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t at = line * across + k * step;
      most = std::max(most, glm::length((net[at + step] - net[at]) * 3.0 - mean));
    }
  return most;
}

glm::dvec3 mean_derivative(const ControlNet& net, bool along_u) {
  const std::size_t far = along_u ? 12 : 3, across = along_u ? 1 : 4;
  glm::dvec3 sum(0);
  for (std::size_t line = 0; line < 4; ++line) sum += net[line * across + far] - net[line * across];
  return sum * 0.25;
}

bool bends(const ControlNet& net, bool along_u) {
  const glm::dvec3 u = mean_derivative(net, true), v = mean_derivative(net, false);
  const double shorter = std::min(glm::length(u), glm::length(v));
  return spread(net, along_u, along_u ? u : v) > kMostBending * shorter;
}

struct Cutter {
  std::vector<PatchPiece>& pieces;

  void cut(const PatchPiece& piece, int u_halvings, int v_halvings) {
    const bool u = u_halvings < kMostHalvings && bends(piece.patch.points, true);
    const bool v = v_halvings < kMostHalvings && bends(piece.patch.points, false);
    if (!u && !v) return pieces.push_back(piece);
    // Both are to be halved: the one that was halved less often comes first.
    const bool along_u = u && (!v || u_halvings <= v_halvings);
    const int axis = along_u ? 0 : 1;
    const NetHalves halves = halve(piece.patch.points, along_u);
    PatchPiece half = piece;
    half.size[axis] *= 0.5;
    half.patch.points = halves.first;
    cut(half, u_halvings + (along_u ? 1 : 0), v_halvings + (along_u ? 0 : 1));
    half.low[axis] += half.size[axis];
    half.patch.points = halves.second;
    cut(half, u_halvings + (along_u ? 1 : 0), v_halvings + (along_u ? 0 : 1));
  }
};

}  // namespace

DoubleBox bounds_of(const ControlNet& net) {
  DoubleBox box;
  for (const glm::dvec3& p : net) box.include(p);
  return box;
}

/// Wider than the hull by what a ray may pass it and still count as meeting it, as far as that depends on the patch;
/// what depends on the ray's distance is in BoxTree's roundings.
DoubleBox PatchPiece::bounds() const {
  DoubleBox box = bounds_of(patch.points);
  const glm::dvec3 farthest = glm::max(glm::abs(box.low), glm::abs(box.high));
  const glm::dvec3 pad = farthest * 0x1p-44 + scale * 0x1p-30;
  return {box.low - pad, box.high + pad};
}

NetHalves halve(const ControlNet& net, bool along_u) {
  const std::size_t step = along_u ? 4 : 1, across = along_u ? 1 : 4;
  NetHalves halves;
  for (std::size_t line = 0; line < 4; ++line) {
    const std::size_t at = line * across;
    const glm::dvec3 &a = net[at], &b = net[at + step], &c = net[at + 2 * step], &d = net[at + 3 * step];
    const glm::dvec3 ab = (a + b) * 0.5, bc = (b + c) * 0.5, cd = (c + d) * 0.5;
    const glm::dvec3 abc = (ab + bc) * 0.5, bcd = (bc + cd) * 0.5, middle = (abc + bcd) * 0.5;
    halves.first[at] = a, halves.first[at + step] = ab, halves.first[at + 2 * step] = abc;
    halves.first[at + 3 * step] = halves.second[at] = middle;
    halves.second[at + step] = bcd, halves.second[at + 2 * step] = cd, halves.second[at + 3 * step] = d;
  }
  return halves;
}

void cut(const BezierPatch& patch, const glm::dmat4& world_from_mesh, PrimitiveId id, std::vector<PatchPiece>& pieces) {
  PatchPiece whole;
  whole.id = id;
  whole.outward = glm::determinant(glm::dmat3(world_from_mesh)) < 0 ? -1 : 1;
  bool is_usable = true;
  for (std::size_t i = 0; i < patch.points.size(); ++i) {
    const glm::dvec3 p(world_from_mesh * glm::dvec4(patch.points[i], 1));
    whole.patch.points[i] = p;
    is_usable = is_usable && std::abs(p.x) <= kFarthest && std::abs(p.y) <= kFarthest && std::abs(p.z) <= kFarthest;
  }
  whole.scale = bounds_of(whole.patch.points).largest_side();
  if (is_usable) Cutter{pieces}.cut(whole, 0, 0);
}

}  // namespace frontmost::raycast_detail
