// SPDX-License-Identifier: Apache-2.0
// The data of an Environment: octahedral maps for nine roughnesses, and the moments of its irradiance.
#pragma once

#include <array>

#include "frontmost/image.h"
#include "frontmost/pictures.h"

namespace frontmost::shading {

/// A map from all directions to colours, stored on a square. The octahedron |x| + |y| + |z| = 1 is seen from above,
/// with its lower faces unfolded to the corners. Neighbours on the square are neighbours in direction, texels have
/// similar sizes, and a look-up takes a single division.
///
///      +-------+-------+
///      | down/ | \down |        the middle is straight up, the four corners are straight down;
///      |   /   |   \   |        x to the right, z downwards
///      +-------up------+
///      |   \   |   /   |
///      | down\ | /down |
///      +-------+-------+
///
/// (E. Praun, H. Hoppe. Spherical Parametrization and Remeshing. SIGGRAPH 2003.)
///
/// A texel is four floats: red, green, blue and one that is unused. A border of one texel repeats the texels beyond the
/// fold, so that two neighbours can be read at once anywhere.
class OctahedralMap {
 public:
  static constexpr int channels = 4;

  OctahedralMap() = default;
  /// Makes a map whose texels are undefined.
  explicit OctahedralMap(int size)
      : size_(size), texels_(std::size_t(size + 2) * std::size_t(size + 2) * std::size_t(channels)) {}

  [[nodiscard]] int size() const { return size_; }        ///< texels per side, without the border
  [[nodiscard]] int stride() const { return size_ + 2; }  ///< texels per row, with the border
  [[nodiscard]] const float* texels() const { return texels_.data(); }
  /// Returns the address of a texel. x and y are -1 to size.
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
  /// Returns the colour in a direction, by a bilinear look-up. `towards` has any length but zero.
  [[nodiscard]] glm::vec3 color(const glm::vec3& towards) const;

  /// Copies the texels beyond the folds into the border.
  void close_border();
  /// Returns a map of half the size, with a border. Each texel is the mean of four, weighted by solid angle.
  /// Precondition: the size is even.
  [[nodiscard]] OctahedralMap half() const;

 private:
  [[nodiscard]] std::size_t index(int x, int y) const {
    return (std::size_t(y + 1) * std::size_t(stride()) + std::size_t(x + 1)) * std::size_t(channels);
  }

  int size_ = 0;
  Buffer<float> texels_;
};

/// Returns the point of the octahedron at (u, v), each 0 to 1 across the square. As a direction, it is not of unit
/// length.
[[nodiscard]] glm::vec3 octahedron_point(float u, float v);
/// Returns the point of the octahedron at the middle of a texel.
[[nodiscard]] inline glm::vec3 octahedron_point(int size, int x, int y) {
  return octahedron_point((float(x) + 0.5f) / float(size), (float(y) + 0.5f) / float(size));
}
/// Returns the solid angle of a texel at this point, divided by the texel's area on the square of side length 2.
[[nodiscard]] float solid_angle(const glm::vec3& octahedron_point);

/// The light reflected by a white diffuse surface is a polynomial of its normal: mean + 2 first . n + 15/8 n . second
/// n. These are spherical harmonics up to order 2, in a form that is easy to rotate.
struct IrradianceMoments {
  /// Means over all directions d, for one colour channel: of the light, of light * d, and of light * (d d^T - 1/3).
  struct Moments {
    double mean = 0;
    glm::dvec3 first{0};
    glm::dmat3 second{0};
  };
  std::array<Moments, 3> channels;
};

struct PrefilteredEnvironment {
  static constexpr int level_count = 9;

  /// Level k is the environment mirrored at normal incidence by surfaces of roughness k / 8. Level 0 is the environment
  /// itself.
  std::array<OctahedralMap, level_count> levels;
  IrradianceMoments irradiance;
  bool turns_with_camera = false;
  bool is_dark = false;  ///< the environment has no light at all, and no levels
  Image picture;         ///< equirectangular; empty if the environment was made by code
};

/// One of the few dozen directions that stand for the specular lobe of a rough surface at normal incidence. A direction
/// for a wider part of the lobe is looked up in a coarser map, so that no light between directions is lost. (J.
/// Krivanek, M. Colbert. Real-Time Shading with Filtered Importance Sampling. Eurographics Symposium on Rendering
/// 2008.)
struct LobeDirection {
  glm::vec3 towards{0};  ///< unit length; the z axis is the normal
  float weight = 0;      ///< all weights sum to 1
  int map = 0;           ///< index of the map for the look-up
};

/// Returns the data of an environment, for shading.
[[nodiscard]] const PrefilteredEnvironment& prefiltered(const Environment& environment);

/// Computes levels 1 and up, and the moments, from level 0. The size of level 0 is a power of two, at least 64. The
/// bits are the same on every machine.
void prefilter(PrefilteredEnvironment& environment, const Execution& execution);

/// Makes level 0 from an equirectangular picture: each texel is the mean of the picture across it. In parallel.
[[nodiscard]] OctahedralMap draw_map(const Image& equirectangular, const Execution& execution);
/// Returns the colour of one background pixel, interpolated bilinearly in the equirectangular picture itself.
[[nodiscard]] glm::vec3 equirectangular_color(const Image& picture, const glm::vec3& towards);

}  // namespace frontmost::shading
