// SPDX-License-Identifier: Apache-2.0
// Colours of all directions on a square: the octahedron |x| + |y| + |z| = 1 seen from above, its lower faces unfolded
// to the corners. Neighbours on the square are neighbours in direction, texels are of similar size, and finding one
// takes a single division.
//
//      +-------+-------+
//      | down/ | \down |        the middle is straight up, the four corners are straight down;
//      |   /   |   \   |        x to the right, z downwards
//      +-------up------+
//      |   \   |   /   |
//      | down\ | /down |
//      +-------+-------+
//
// (E. Praun, H. Hoppe. Spherical Parametrization and Remeshing. SIGGRAPH 2003.)
#pragma once

#include "frontmost/base.h"

namespace frontmost::shading {

/// Texels are four floats (red, green, blue, unused), in rows with a border of one on each side that repeats what lies
/// beyond the fold, so that two neighbours are read at once without asking where they lie.
class OctahedralMap {
 public:
  static constexpr int channels = 4;

  OctahedralMap() = default;
  /// With undefined texels.
  explicit OctahedralMap(int size)
      : size_(size), texels_(std::size_t(size + 2) * std::size_t(size + 2) * std::size_t(channels)) {}

  [[nodiscard]] int size() const { return size_; }        ///< texels a side, without the border
  [[nodiscard]] int stride() const { return size_ + 2; }  ///< texels a row, with it
  [[nodiscard]] const float* texels() const { return texels_.data(); }
  /// x and y from -1 to size.
  [[nodiscard]] float* texel(int x, int y) { return texels_.data() + index(x, y); }
  [[nodiscard]] const float* texel(int x, int y) const { return texels_.data() + index(x, y); }
  void set(int x, int y, const glm::vec3& color) {
    float* const out = texel(x, y);
    out[0] = color.r;
    out[1] = color.g;
    out[2] = color.b;
    out[3] = 0;
  }
  [[nodiscard]] glm::vec3 color(int x, int y) const {
    const float* const in = texel(x, y);
    return {in[0], in[1], in[2]};
  }
  /// Bilinear. `towards` has any length but zero.
  [[nodiscard]] glm::vec3 color(const glm::vec3& towards) const;

  /// Copies what lies beyond the folds into the border.
  void close_border();
  /// The mean over four texels each, by solid angle, with its border. Precondition: an even size.
  [[nodiscard]] OctahedralMap half() const;

 private:
  [[nodiscard]] std::size_t index(int x, int y) const {
    return (std::size_t(y + 1) * std::size_t(stride()) + std::size_t(x + 1)) * std::size_t(channels);
  }

  int size_ = 0;
  Buffer<float> texels_;
};

/// The point of the octahedron at u, v, which are 0 to 1 over the square: a direction that is not of unit length.
[[nodiscard]] glm::vec3 octahedron_point(float u, float v);
/// The same of the middle of a texel.
[[nodiscard]] inline glm::vec3 octahedron_point(int size, int x, int y) {
  return octahedron_point((float(x) + 0.5f) / float(size), (float(y) + 0.5f) / float(size));
}
/// The solid angle of a texel there, as a multiple of its area on the square of side 2.
[[nodiscard]] float solid_angle(const glm::vec3& octahedron_point);

}  // namespace frontmost::shading
