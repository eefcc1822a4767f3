// SPDX-License-Identifier: Apache-2.0
// The part of an edge that a triangle hides: the part in the triangle's shadow, as if the eye were a lamp.
//
//            ____        The shadow is bounded by the triangle's own plane and by three planes through the eye, one
//   eye  .--|    |.....  along each side. Each plane is a linear function along the edge. Its signs at both ends, and
//        '--|____|.....  its root between them, say where the edge is inside.
//
// Kernels test many occluders at once. Cases that rounding leaves open are decided by hidden_by() or covered_by(),
// which are exact. So a drawing has the same lines with every instruction set.
#pragma once

#include <algorithm>
#include <array>

#include "frontmost/base.h"
#include "view/sight.h"

namespace frontmost::lines_detail {

/// A triangle that may hide edges. One cache line.
struct alignas(64) Occluder {
  glm::vec3 corners[3];       ///< world space, in the order of `vertices`
  std::uint32_t vertices[3];  ///< ascending, so that neighbours compute their common plane with the same bits
  std::int32_t turn;          ///< orientation of the corners as they are seen: 1 left, -1 right
  std::uint32_t triangle;
  bool is_near;  ///< a part of the triangle may lie before the near plane
};

/// Where an end of a segment lies: either on an edge, given by its two vertices, or at a vertex, which is given twice.
using EndOn = std::array<std::uint32_t, 2>;

/// A segment that is compared with occluders, from t = 0 to 1.
struct SightedEdge {
  glm::dvec3 from{0}, to{0};  ///< world space
  EndOn from_on{}, to_on{};
  std::array<std::uint32_t, 2> own{no_index, no_index};  ///< triangles that contain the segment
  /// Bound on the rounding error of constructed ends, for each axis; 0: both ends are vertices.
  double slack = 0;
  int outer = 0;  ///< side, as for Sight's turns, on which none of its own triangles are seen; 0: there is no such side
  double from_distance = 0, to_distance = 0;  ///< planar distances of the ends
};

/// SightedEdge::slack of a segment whose ends were constructed: several rounding errors of the greatest coordinate.
[[nodiscard]] inline double slack_of(const glm::dvec3& from, const glm::dvec3& to) {
  const glm::dvec3 size = glm::max(glm::abs(from), glm::abs(to));
  return 8.0 / 9007199254740992.0 * std::max({size.x, size.y, size.z, 1e-100});
}

/// Empty unless begin < end.
struct Interval {
  double begin = 1, end = 0;
};

/// The intersection of both intervals; it is empty if its end is not after its beginning.
inline Interval overlap(const Interval& a, const Interval& b) {
  return {std::max(a.begin, b.begin), std::min(a.end, b.end)};
}

/// Where a linear function from 0 to 1 with these values at its ends is not negative; if `is_strict`, positive.
[[nodiscard]] Interval where_positive(const Signed& at_0, const Signed& at_1, bool is_strict);

/// Where `occluder` hides the edge: within its three planes through the eye (boundary included), and beyond its own
/// plane (boundary excluded). A constructed end counts as within every plane for which rounding leaves its side open.
[[nodiscard]] Interval hidden_by(const Occluder& occluder, const SightedEdge& edge, const Sight& sight);

/// Where `occluder` is seen directly beside `edge`, on the outer side of `edge`, whether it is nearer or farther away.
/// If an edge of the occluder is seen exactly along `edge`, this counts if the occluder lies on the outer side.
[[nodiscard]] Interval covered_by(const Occluder& occluder, const SightedEdge& edge, const Sight& sight);

/// Boxes on the screen, in units of cells, each with the least distance of the triangle in it.
struct ScreenBoxes {
  const float *low_x, *low_y, *high_x, *high_y, *nearest;
};

/// A box around a part of an edge on the screen, in units of cells, and the part's greatest distance.
struct ScreenPart {
  glm::vec2 low, high;
  float farthest;
};

/// CellDepth::Side of triangles: 0 to 2 are a triangle's sides, 3 is its plane.
struct ScreenSides {
  static constexpr int count = 4;
  const float *a[count], *b[count], *c[count];
};

/// A segment on the screen, in units of cells relative to a cell's corner, and the nearness() of its ends.
struct ScreenSegment {
  glm::vec2 from, to;
  float from_nearness, to_nearness;
};

/// Arrays of doubles for up to eight occluders, one lane for each.
struct OccluderBatch {
  static constexpr std::size_t most = 8;
  alignas(64) double corners[9][most] = {};
  alignas(64) double vertices[3][most] = {};
  alignas(64) double turn[most] = {};
  const Occluder* occluders[most] = {};
  std::size_t count = 0;

  void add(const Occluder& occluder) {
    for (int k = 0; k < 3; ++k) {
      for (int axis = 0; axis < 3; ++axis) corners[3 * k + axis][count] = double(occluder.corners[k][axis]);
      vertices[k][count] = occluder.vertices[k];
    }
    turn[count] = occluder.turn;
    occluders[count++] = &occluder;
  }
};

/// Bit i of a mask stands for lane i.
struct HiddenBatch {
  alignas(64) double begin[OccluderBatch::most], end[OccluderBatch::most];
  std::uint32_t hides = 0;  ///< lanes whose occluders hide the edge from `begin` to `end`
  std::uint32_t open = 0;   ///< lanes that rounding leaves open: hidden_by() decides
};

/// The functions of one instruction set.
struct ShadowKernels {
  /// Bit i: box i of the first `count` overlaps the part and is not wholly beyond it. At most 64; reads up to 64.
  std::uint64_t (*overlapping)(const ScreenBoxes& boxes, std::size_t count, const ScreenPart& part);
  /// Likewise: triangle i has the segment neither outside of one of its sides nor before its plane.
  std::uint64_t (*within_sides)(const ScreenSides& sides, std::size_t count, const ScreenSegment& segment);
  /// Computes hidden_by() of every occluder in the batch, to the bit, except for occluders that are left open.
  void (*hide)(const OccluderBatch& batch, const SightedEdge& edge, const Sight& sight, HiddenBatch& hidden);
  /// Computes covered_by() of every occluder in the batch, in the same way.
  void (*cover)(const OccluderBatch& batch, const SightedEdge& edge, const Sight& sight, HiddenBatch& hidden);
};
[[nodiscard]] ShadowKernels shadow_kernels(Isa isa);

}  // namespace frontmost::lines_detail
