// SPDX-License-Identifier: Apache-2.0
// Boxes and triangles in space, sixteen side by side: plain data for the kernel of crossings. Arrays are padded to
// whole groups of sixteen: boxes with boxes that touch nothing, triangles with copies of the last one.
#pragma once

#include <array>
#include <limits>

#include "frontmost/base.h"

namespace frontmost::lines_detail {

inline constexpr std::size_t kSpaceLanes = 16;
[[nodiscard]] inline std::size_t padded_to_lanes(std::size_t count) {
  return (count + kSpaceLanes - 1) / kSpaceLanes * kSpaceLanes;
}

struct SpaceBoxes {
  Buffer<float> low[3], high[3];

  explicit SpaceBoxes(std::size_t count) {
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = Buffer<float>(padded_to_lanes(count));
      high[axis] = Buffer<float>(padded_to_lanes(count));
    }
    // A padding box of NaN touches nothing; an empty box would still touch an infinite box.
    constexpr float none = std::numeric_limits<float>::quiet_NaN();
    for (std::size_t i = count; i < low[0].size(); ++i) set(i, {glm::vec3(none), glm::vec3(none)});
  }
  [[nodiscard]] std::size_t group_count() const { return low[0].size() / kSpaceLanes; }
  void set(std::size_t i, const Box& box) {
    for (int axis = 0; axis < 3; ++axis) {
      low[axis][i] = box.low[axis];
      high[axis][i] = box.high[axis];
    }
  }
  [[nodiscard]] Box get(std::size_t i) const {
    return {{low[0][i], low[1][i], low[2][i]}, {high[0][i], high[1][i], high[2][i]}};
  }
};

/// Flag in a vertex number: the triangles of this vertex are not known to lie side by side around it.
inline constexpr std::uint32_t kNotSpread = 0x80000000u;

struct SpaceTriangles {
  std::size_t count = 0;
  Buffer<float> corners[9];           ///< coordinates at a common scale
  Buffer<std::uint32_t> vertices[3];  ///< vertex numbers with kNotSpread
  Buffer<std::uint32_t> numbers;

  explicit SpaceTriangles(std::size_t size) : count(size), numbers(padded_to_lanes(size)) {
    for (Buffer<float>& c : corners) c = Buffer<float>(padded_to_lanes(size));
    for (Buffer<std::uint32_t>& v : vertices) v = Buffer<std::uint32_t>(padded_to_lanes(size));
  }
};

/// Added to the size of a normal, because products of floats may lose that much by underflow.
inline constexpr float kLeastSize = 1e-32f;
/// Sixteen triangles, from number `first` on, with which other triangles are compared.
struct SpaceProbes {
  std::size_t first;
  alignas(64) std::uint32_t spread[3][kSpaceLanes];  ///< the vertices; no_index in place of vertices with kNotSpread
  alignas(64) float low[3][kSpaceLanes], high[3][kSpaceLanes];  ///< the boxes
  alignas(64) float normal[3][kSpaceLanes];  ///< normal of any length; a component's error is at most 2^-22 of `size`
  alignas(64) float size[3][kSpaceLanes];    ///< at least the sum of absolute values of the terms of `normal`
};

/// One mask for each probe, in which bit i stands for triangle i of sixteen.
using SpaceMasks = std::array<std::uint16_t, kSpaceLanes>;

/// The functions of one instruction set. Each works on sixteen items from `first` on, a multiple of 16.
struct SpaceKernels {
  /// Bit i: box first + i has a point in common with `box`.
  std::uint32_t (*touching)(const SpaceBoxes& boxes, std::size_t first, const Box& box);
  void (*set_probes)(const SpaceTriangles& triangles, std::size_t first, SpaceProbes& probes);
  /// Finds triangles that may cross a probe: their boxes touch, they share no vertex unless it has kNotSpread, each may
  /// have corners on both sides of the other's plane, and they may overlap along the planes' common line. `box`
  /// encloses the sixteen triangles. Sets the masks of probes that may be crossed, and returns these probes as bits.
  std::uint32_t (*crossing)(const SpaceTriangles& triangles, std::size_t first, const Box& box,
                            const SpaceProbes& probes, SpaceMasks& masks);
};
[[nodiscard]] SpaceKernels space_kernels(Isa isa);

}  // namespace frontmost::lines_detail
