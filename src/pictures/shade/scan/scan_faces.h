// SPDX-License-Identifier: Apache-2.0
// The rays of a scan on the faces of a cube around the eye.
//
//          +---------+        What shades a picture relies on rays that are affine over a screen. Those of a
//         /    up   /|        panorama are not, but where a ray passes the cube they are: each face is the screen of
//        +---------+ | right  a pinhole that looks along an axis of the camera. So a fragment is a place on a face,
//        |         | +        triangles are set up for the faces that show them, and everything is as exact as in a
//        |  ahead  |/         pinhole's picture.
//        +---------+
//                             A pixel's steps, from its ray to those of the next column and row, are told on the
//                             face, too: they take changes per unit of the face to changes per pixel of the scan.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "frontmost/raycast.h"
#include "shade/geometry/geometry.h"

namespace frontmost::shading {

inline constexpr int cube_faces = 6;

/// In the axes of the camera's eye, zero where there is no ray. Of any length but zero elsewhere.
class ScanDirections {
 public:
  /// Borrows the camera.
  explicit ScanDirections(const RayCamera& camera);

  [[nodiscard]] glm::dvec3 at(int x, int y, int sample) const { return samples_[std::size_t(sample)](x, y); }
  /// Between unit vectors along a ray and those of the next column and row. Zero where there are no neighbours.
  struct Steps {
    glm::dvec3 x{0}, y{0};
  };
  [[nodiscard]] Steps steps(int x, int y) const;

 private:
  using At = std::function<glm::dvec3(int, int)>;
  /// Of unit length; zero also beyond the grid.
  [[nodiscard]] glm::dvec3 middle(const glm::ivec2& at) const;
  [[nodiscard]] glm::dvec3 step_to(const glm::ivec2& from, const glm::ivec2& step) const;

  glm::ivec2 grid_;
  std::vector<At> samples_;
  At middle_;
};

class ScanFaces {
 public:
  /// Borrows `store` and `large`, as TriangleSource does.
  ScanFaces(const TriangleStore& store, const RayCamera& camera, const BitSet* large, bool has_texcoords);

  /// The face that a direction leads to.
  [[nodiscard]] static int face_of(const glm::dvec3& direction);
  [[nodiscard]] const TriangleSource& source(int face) const { return sources_[std::size_t(face)]; }
  [[nodiscard]] glm::vec2 screen(int face, const glm::dvec3& direction) const;
  /// How the place on the screen changes with the direction.
  [[nodiscard]] glm::vec2 screen_step(int face, const glm::dvec3& direction, const glm::dvec3& step) const;

 private:
  /// Of a unit vector along the face's axis: right, up and ahead.
  struct Axes {
    glm::dvec3 right, up, ahead;
  };
  [[nodiscard]] static Axes axes_of(int face);

  double half_size_;  ///< units of a face's screen from its middle to its sides
  std::vector<TriangleSource> sources_;
};

}  // namespace frontmost::shading
