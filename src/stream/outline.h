// SPDX-License-Identifier: Apache-2.0
// The points of a stream that decide bounds and framing.
#pragma once

#include "frontmost/scene.h"
#include "frontmost/view.h"
#include "view/camera/extremes.h"

namespace frontmost::streaming {

class OutlineFinder {
 public:
  OutlineFinder(const View& direction, double margin);

  /// Triangles with corners that are not finite count for nothing.
  void include(const Mesh& mesh);
  void include(const OutlineFinder& other);
  [[nodiscard]] const Box& bounds() const { return bounds_; }
  /// The points as triangles without area: surfaces of it have the bounds of all, and frame() frames them alike.
  [[nodiscard]] Scene scene() const;

 private:
  /// False when no point within the box would be kept.
  [[nodiscard]] bool may_change_by(const Box& box) const;
  void include_run(const Mesh& mesh, std::size_t begin, std::size_t end);
  void include_corners(const Mesh& mesh, std::size_t begin, std::size_t end);
  void include(const glm::vec3& point);

  Extremes extremes_;
  Box bounds_;
  glm::vec3 ends_[6] = {};  ///< a point at each side of the bounds
};

}  // namespace frontmost::streaming
