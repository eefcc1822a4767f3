// SPDX-License-Identifier: Apache-2.0
// Positions of the triangles of every object, and the data that remedies need.
#pragma once

#include <vector>

#include "frontmost/report.h"
#include "report/why/frustum.h"
#include "surfaces/placed_scene.h"

namespace frontmost::why_detail {

/// A range of values.
struct ValueRange {
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();

  [[nodiscard]] bool is_empty() const { return !(low <= high); }
  void include(double value);
  void include(const ValueRange& other);
};

/// The middle of the largest triangle offered; a culled triangle counts only if there is no other.
struct LargestTriangle {
  PointAhead middle{0};
  double area = -1;  ///< in scene units squared; negative if there is none
  bool is_culled = true;

  void offer(const LargestTriangle& other);
};

struct ObjectPlaces {
  TrianglePlaces counts;
  std::uint64_t clear = 0;     ///< number of triangles in view with an opacity of 0
  ValueRange nearer, farther;  ///< distances of the triangles nearer than near, and beyond far
  LargestTriangle behind, outside;
  ValueRange columns, rows;  ///< of the triangles in view, in pixels
  double widest = 0;         ///< greatest radius of a circle inside a triangle in view, in pixels

  void add(const ObjectPlaces& other);
};

/// Finds the places of every object, or only of `object` if it is not no_index; the others stay zero. `columns`, `rows`
/// and `widest` are set only for objects that cover no sample. O(triangles), in parallel.
[[nodiscard]] std::vector<ObjectPlaces> find_places(const PlacedScene& scene, const View& view,
                                                    const Accounting& accounts, std::uint32_t object,
                                                    const Execution& execution);

/// Number of triangles with area 0 or a non-finite corner.
[[nodiscard]] std::uint64_t count_flat(const WorldTriangles& triangles, Isa isa);

}  // namespace frontmost::why_detail
