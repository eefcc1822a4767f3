// SPDX-License-Identifier: Apache-2.0
// All triangles of a scene over vertices that are shared wherever they lie at one place.
#pragma once

#include "frontmost/surfaces.h"

namespace frontmost::lines_detail {

/// Where vertices are, in world space: kept as the floats that they are, half as much to fetch from afar.
class Positions {
 public:
  Positions() = default;
  explicit Positions(Buffer<glm::vec3> places) : places_(std::move(places)) {}
  [[nodiscard]] std::size_t size() const { return places_.size(); }
  [[nodiscard]] glm::dvec3 operator[](std::size_t vertex) const { return glm::dvec3(places_[vertex]); }
  [[nodiscard]] const Buffer<glm::vec3>& places() const { return places_; }

 private:
  Buffer<glm::vec3> places_;
};

struct WeldedMesh {
  Positions positions;
  /// Three different vertices each, counter-clockwise seen from the front.
  Buffer<glm::uvec3> triangles;
  Buffer<PrimitiveId> ids;  ///< of the triangles
};

/// Leaves out triangles with a corner that is not finite, and those with two corners at one place. O(triangles).
/// Vertices are numbered in the order in which their places come.
[[nodiscard]] WeldedMesh weld(const Surfaces& surfaces, const Execution& execution);

}  // namespace frontmost::lines_detail
