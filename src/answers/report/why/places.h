// SPDX-License-Identifier: Apache-2.0
// Where the triangles of every object are, and what of them remedies have to know.
#pragma once

#include <vector>

#include "frontmost/report.h"
#include "report/why/frustum.h"
#include "surfaces/placed_scene.h"

namespace frontmost::why_detail {

/// Least and greatest.
struct ValueRange {
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();

  [[nodiscard]] bool is_empty() const { return !(low <= high); }
  void include(double value);
  void include(const ValueRange& other);
};

/// The middle of the largest of some triangles; such as culling leaves out only where there is no other.
struct LargestTriangle {
  PointAhead middle{0};
  double area = -1;  ///< in scene units; less than 0 where there is none
  bool is_culled = true;

  void offer(const LargestTriangle& other);
};

struct ObjectPlaces {
  TrianglePlaces counts;
  std::uint64_t clear = 0;     ///< of those in view, how many have an opacity of 0
  ValueRange nearer, farther;  ///< distances of what is nearer than near, and of what is beyond far
  LargestTriangle behind, outside;
  ValueRange columns, rows;  ///< of what is in view, in pixels
  double widest = 0;         ///< the radius of a circle that fits into a triangle in view, in pixels

  void add(const ObjectPlaces& other);
};

/// Of every object, or of one where it is not no_index; the others are all zeros. Columns, rows and the widest are
/// those of objects that cover no sample. O(triangles), in parallel.
[[nodiscard]] std::vector<ObjectPlaces> find_places(const PlacedScene& scene, const View& view,
                                                    const Accounting& accounts, std::uint32_t object,
                                                    const Execution& execution);

/// How many have an area of 0 or a corner that is not finite.
[[nodiscard]] std::uint64_t count_flat(const WorldTriangles& triangles, Isa isa);

}  // namespace frontmost::why_detail
