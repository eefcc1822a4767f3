// SPDX-License-Identifier: Apache-2.0
// The public result: rounds that cover most of their circumference, each with the ids of its triangles. Less than 160
// degrees of a circle is a fillet or a corner and gets no diameter.
#include <algorithm>
#include <numbers>

#include "base/parallel.h"
#include "frontmost/lines.h"
#include "rounds/found_rounds.h"

namespace frontmost {
namespace {

using namespace lines_detail;

constexpr double kLeastTurn = 160 * std::numbers::pi / 180;

/// Appends a round with these triangles of the mesh.
void append(Round round, const std::vector<std::uint32_t>& triangles, const WeldedMesh& mesh, Rounds& all) {
  std::vector<PrimitiveId> ids;
  for (const std::uint32_t t : triangles) ids.push_back(mesh.ids[t]);
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  round.first = std::uint32_t(all.triangles.size());
  round.count = std::uint32_t(ids.size());
  all.triangles.insert(all.triangles.end(), ids.begin(), ids.end());
  all.rounds.push_back(round);
}

}  // namespace

Rounds find_rounds(const Surfaces& surfaces, const Execution& execution) {
  const IeeeScope ieee;
  const SmoothMesh mesh = smooth_mesh(surfaces, execution);
  Rounds all;
  const std::vector<FoundCircle> circles = find_circles(mesh, execution);
  for (const FoundCircle& found : circles) {
    const double turn = covered(found);
    if (turn < kLeastTurn) continue;
    const Circle3& circle = found.circle;
    append({RoundKind::circle, circle.centre, circle.centre, circle.axis, circle.radius, turn}, found.triangles,
           mesh.mesh, all);
  }
  for (const FoundWall& wall : find_walls(mesh, circles, execution)) {
    if (wall.turn < kLeastTurn) continue;
    append({RoundKind::cylinder, wall.from, wall.to, wall.axis, wall.radius, wall.turn, wall.is_hollow}, wall.triangles,
           mesh.mesh, all);
  }
  for (const FoundRevolved& found : find_revolved(mesh, execution))
    append({RoundKind::revolved, found.from, found.to, found.axis, found.radius, 2 * std::numbers::pi}, found.triangles,
           mesh.mesh, all);
  for (const FoundPrism& found : find_prisms(mesh, execution)) {
    const Circle3& rim = found.rim;
    all.prisms.push_back(
        {RoundKind::cylinder, rim.centre, found.other_end, rim.axis, rim.radius, 2 * std::numbers::pi});
  }
  return all;
}

}  // namespace frontmost
