// SPDX-License-Identifier: Apache-2.0
// Positions of the triangles of every object relative to the viewing volume; and remedies, which change a view by round
// numbers.
#pragma once

#include <algorithm>
#include <vector>

#include "frontmost/report.h"
#include "surfaces/placed_scene.h"

namespace frontmost::why_detail {

/// Coordinates right, up and ahead of the eye.
using PointAhead = glm::dvec3;

/// A range of values.
struct ValueRange {
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();

  [[nodiscard]] bool is_empty() const { return !(low <= high); }
  void include(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  void include(const ValueRange& other) {
    low = std::min(low, other.low);
    high = std::max(high, other.high);
  }
};

/// The middle of the largest triangle offered; a culled triangle counts only if there is no other.
struct LargestTriangle {
  PointAhead middle{0};
  double area = -1;  ///< in scene units squared; negative if there is none
  bool is_culled = true;

  void offer(const LargestTriangle& other) {
    if (other.area < 0) return;
    if (area < 0 || (is_culled && !other.is_culled) || (is_culled == other.is_culled && other.area > area))
      *this = other;
  }
};

struct ObjectPlaces {
  TrianglePlaces counts;
  std::uint64_t clear = 0;     ///< number of triangles in view with an opacity of 0
  ValueRange nearer, farther;  ///< distances of the triangles nearer than near, and beyond far
  LargestTriangle behind, outside;
  ValueRange columns, rows;  ///< extent of the triangles in view, in pixels
  double widest = 0;         ///< greatest radius of a circle inside a triangle in view, in pixels

  void add(const ObjectPlaces& other);
};

/// Finds the places of every object, or only of `object` if that is not no_index; the counts of other objects stay
/// zero. `columns`, `rows` and `widest` are set only for objects that cover no sample. O(triangles), in parallel.
[[nodiscard]] std::vector<ObjectPlaces> find_places(const PlacedScene& scene, const View& view,
                                                    const Accounting& accounts, std::uint32_t object,
                                                    const Execution& execution);

/// An object as it would be seen if nothing else were there: a scene of its own, without materials and therefore
/// without holes.
class LoneObject {
 public:
  LoneObject(const Scene& scene, std::uint32_t object);

  /// Whether the object would cover a sample of the picture, or of a picture with `factor` times the width and height.
  /// Precondition: the enlarged view is valid. `places` holds the object's position in the original picture.
  [[nodiscard]] bool has_sample(const View& view, const ObjectPlaces& places, int factor = 1) const;
  /// The object's area in the picture, in square pixels. `places` holds the object's position.
  [[nodiscard]] double area(const View& view, const ObjectPlaces& places) const;

 private:
  Scene scene_;
  Surfaces surfaces_;
};

/// The remedy for an object that `reason`, one of the reasons before no_sample, keeps from being seen; none if nothing
/// helps.
[[nodiscard]] Remedy remedy_for(SightReason reason, const ObjectPlaces& places, const View& view);
/// The remedy for an object that covers no sample. Some growing pictures are tried; the first in which the object
/// covers a sample is the remedy. None if no picture of up to 16384 pixels each way suffices.
[[nodiscard]] Remedy enlargement_for(const LoneObject& lone, const ObjectPlaces& places, const View& view);

}  // namespace frontmost::why_detail
