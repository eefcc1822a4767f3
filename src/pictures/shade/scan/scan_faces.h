// SPDX-License-Identifier: Apache-2.0
// The rays of a scan on the faces of a cube around the eye.
//
//          +---------+        Shading needs rays that are affine over a screen. The rays of a panorama are not, but
//         /    up   /|        their intersections with a cube are: each face is the screen of a pinhole that looks
//        +---------+ | right  along an axis of the camera. So a fragment is a place on a face, triangles are set up
//        |         | +        for the faces that show them, and results are as exact as in a pinhole's picture.
//        |  ahead  |/
//        +---------+
//                             The steps from a pixel's ray to those of the next column and row are also expressed on
//                             the face. They convert changes per unit of the face to changes per pixel of the scan.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "frontmost/raycast.h"
#include "shade/geometry/geometry.h"

namespace frontmost::shading {

inline constexpr int cube_faces = 6;

/// Ray directions in the axes of the camera's eye, not normalized; zero if there is no ray.
class ScanDirections {
 public:
  /// Borrows the camera.
  explicit ScanDirections(const RayCamera& camera);

  [[nodiscard]] glm::dvec3 at(int x, int y, int sample) const { return samples_[std::size_t(sample)](x, y); }
  /// Differences between the unit vector along a ray and those of the next column and row; zero without neighbours.
  struct Steps {
    glm::dvec3 x{0}, y{0};
  };
  [[nodiscard]] Steps steps(int x, int y) const;

 private:
  using At = std::function<glm::dvec3(int, int)>;
  /// The unit vector through the middle of a pixel; zero beyond the grid.
  [[nodiscard]] glm::dvec3 middle(const glm::ivec2& at) const;
  [[nodiscard]] glm::dvec3 step_to(const glm::ivec2& from, const glm::ivec2& step) const;

  glm::ivec2 grid_;
  std::vector<At> samples_;
  At middle_;
};

class ScanFaces {
 public:
  /// Borrows `store` and `large`, like TriangleSource.
  ScanFaces(const TriangleStore& store, const RayCamera& camera, const BitSet* large, bool has_texcoords);

  /// The face on which a direction lies.
  [[nodiscard]] static int face_of(const glm::dvec3& direction);
  [[nodiscard]] const TriangleSource& source(int face) const { return sources_[std::size_t(face)]; }
  [[nodiscard]] glm::vec2 screen(int face, const glm::dvec3& direction) const;
  /// The change of the place on the screen for a change of the direction.
  [[nodiscard]] glm::vec2 screen_step(int face, const glm::dvec3& direction, const glm::dvec3& step) const;

 private:
  /// The axes of a face as unit vectors.
  struct Axes {
    glm::dvec3 right, up, ahead;
  };
  [[nodiscard]] static Axes axes_of(int face);

  double half_size_;  ///< units of a face's screen from its middle to its sides
  std::vector<TriangleSource> sources_;
};

}  // namespace frontmost::shading
