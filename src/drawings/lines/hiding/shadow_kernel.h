// SPDX-License-Identifier: Apache-2.0
// Tests of many occluders at once: which of them may meet an edge, and which part of it they hide.
//
// The kernels compute in floats or doubles, with bounds on their errors. Cases that they leave open are decided by
// hidden_by() or covered_by(), which are exact. So a drawing has the same lines with every instruction set.
#pragma once

#include "lines/hiding/occluder.h"

namespace frontmost::lines_detail {

/// Boxes on the screen, in cells, each with the least distance of its content.
struct ScreenBoxes {
  const float *low_x, *low_y, *high_x, *high_y, *nearest;
};

/// A box around a part of an edge on the screen, in cells, and the part's greatest distance.
struct ScreenPart {
  glm::vec2 low, high;
  float farthest;
};

/// CellDepth::Side of triangles: the three sides, and the plane.
struct ScreenSides {
  static constexpr int count = 4;
  const float *a[count], *b[count], *c[count];
};

/// A segment on the screen, in cells from a cell's corner, and the nearness() of its ends.
struct ScreenSegment {
  glm::vec2 from, to;
  float from_nearness, to_nearness;
};

/// Occluders side by side, as doubles.
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
  std::uint32_t hides = 0;  ///< these hide the edge from begin to end
  std::uint32_t open = 0;   ///< rounding leaves these open: hidden_by() decides
};

/// The functions of one instruction set.
struct ShadowKernels {
  /// Bit i: box i of the first `count`, at most 64, overlaps the part and is not wholly beyond it. Reads up to 64
  /// boxes.
  std::uint64_t (*overlapping)(const ScreenBoxes& boxes, std::size_t count, const ScreenPart& part);
  /// Bit i: triangle i of the first `count`, at most 64, has the segment neither outside of one of its sides nor before
  /// its plane. Reads up to 64 of each.
  std::uint64_t (*within_sides)(const ScreenSides& sides, std::size_t count, const ScreenSegment& segment);
  /// hidden_by() of every occluder of the batch, to the bit, except for those left open.
  void (*hide)(const OccluderBatch& batch, const SightedEdge& edge, const Sight& sight, HiddenBatch& hidden);
  /// covered_by() of every occluder of the batch, in the same form.
  void (*cover)(const OccluderBatch& batch, const SightedEdge& edge, const Sight& sight, HiddenBatch& hidden);
};
[[nodiscard]] ShadowKernels shadow_kernels(Isa isa);

}  // namespace frontmost::lines_detail
