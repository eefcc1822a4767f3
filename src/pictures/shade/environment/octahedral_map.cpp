// SPDX-License-Identifier: Apache-2.0
// Octahedral maps, and how they are drawn from equirectangular pictures.
#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "shade/environment/prefiltered.h"

namespace frontmost::shading {
namespace {

float signed_as(float value, float sign) { return sign < 0 ? -value : value; }

constexpr float kHalfTurn = 3.14159265f;

/// Returns the arc tangent of a number from 0 to 1, to about 2e-6. Functions of C libraries would differ in the last
/// bit. (C. Hastings. Approximations for Digital Computers. 1955.)
float arc_tangent(float t) {
  const float t2 = t * t;
  const float high = 0.05265332f - 0.01172120f * t2;
  return t * (0.99997726f + t2 * (-0.33262347f + t2 * (0.19354346f + t2 * (-0.11643287f + t2 * high))));
}

/// Returns the angle of (x, y) from the x axis towards the y axis, -pi to pi, or 0 for (0, 0).
float angle_of(float x, float y) {
  const float ax = std::abs(x), ay = std::abs(y), longer = std::max(ax, ay);
  if (!(longer > 0)) return 0;
  const float first = arc_tangent(std::min(ax, ay) / longer);
  const float steep = ay > ax ? 0.5f * kHalfTurn - first : first;
  const float half = x < 0 ? kHalfTurn - steep : steep;
  return y < 0 ? -half : half;
}

/// The colour planes of a picture.
struct Planes {
  explicit Planes(const Image& picture)
      : r(picture.find("R")->floats().data()),
        g(picture.find("G")->floats().data()),
        b(picture.find("B")->floats().data()) {}
  [[nodiscard]] glm::vec3 at(std::size_t i) const { return {r[i], g[i], b[i]}; }
  const float *r, *g, *b;
};

/// Returns where a direction is in an equirectangular picture, 0 to 1 from left to right and from top to bottom.
/// `towards` has any length but zero. The error is at most 1/50000 of a turn. The bits are the same on every machine.
glm::vec2 equirectangular_place(const glm::vec3& towards) {
  const float azimuth = angle_of(-towards.z, towards.x);
  const float elevation = angle_of(std::sqrt(towards.x * towards.x + towards.z * towards.z), towards.y);
  return {0.5f + azimuth * (0.5f / kHalfTurn), 0.5f - elevation * (1 / kHalfTurn)};
}

/// Returns the colour of an equirectangular picture in a direction, by bilinear interpolation of color_at(x, y).
/// Columns wrap around.
template <class ColorAt>
glm::vec3 interpolated(const glm::vec3& towards, int width, int height, const ColorAt& color_at) {
  const glm::vec2 at = equirectangular_place(towards) * glm::vec2(float(width), float(height)) - 0.5f;
  const glm::vec2 first = glm::floor(at), part = at - first;
  const int x = std::clamp(int(first.x), -1, width - 1), y = std::clamp(int(first.y), -1, height - 1);
  const int left = x < 0 ? width - 1 : x, right = x + 1 < width ? x + 1 : 0;
  const int upper_row = std::max(y, 0), lower_row = std::min(y + 1, height - 1);
  const glm::vec3 a = color_at(left, upper_row), b = color_at(right, upper_row);
  const glm::vec3 c = color_at(left, lower_row), d = color_at(right, lower_row);
  const glm::vec3 upper = a + (b - a) * part.x, lower = c + (d - c) * part.x;
  return upper + (lower - upper) * part.y;
}

/// A copy of an equirectangular picture, prepared for bilinear look-ups.
class EquirectangularMap {
 public:
  /// Reads the channels R, G and B. Pictures wider than `most_width` are reduced to about that width. In parallel.
  EquirectangularMap(const Image& picture, int most_width, const Execution& execution)
      : width_(std::min(picture.width, most_width)), height_(std::min(picture.height, most_width / 2)) {
    texels_ = Buffer<glm::vec3>(std::size_t(width_) * std::size_t(height_));
    const Planes planes(picture);
    // Each texel is the mean of a block of whole pixels. If the width is not a multiple of the texels, some blocks are
    // a pixel wider.
    const auto begin_of = [](int i, int blocks, int pixels) { return std::size_t(std::int64_t(i) * pixels / blocks); };
    constexpr std::size_t rows_at_once = 8;
    parallel_for(execution, std::size_t(height_), rows_at_once, [&](std::size_t first_row, std::size_t last_row) {
      for (int y = int(first_row); y < int(last_row); ++y)
        for (int x = 0; x < width_; ++x) {
          const std::size_t left = begin_of(x, width_, picture.width), right = begin_of(x + 1, width_, picture.width);
          const std::size_t top = begin_of(y, height_, picture.height);
          const std::size_t bottom = begin_of(y + 1, height_, picture.height);
          glm::vec3 sum(0);
          for (std::size_t row = top; row < bottom; ++row)
            for (std::size_t column = left; column < right; ++column)
              sum += planes.at(row * std::size_t(picture.width) + column);
          texels_[std::size_t(y) * std::size_t(width_) + std::size_t(x)] = sum / float((right - left) * (bottom - top));
        }
    });
  }

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] glm::vec3 color(const glm::vec3& towards) const {
    return interpolated(towards, width_, height_,
                        [&](int x, int y) { return texels_[std::size_t(y) * std::size_t(width_) + std::size_t(x)]; });
  }

 private:
  int width_, height_;
  Buffer<glm::vec3> texels_;
};

}  // namespace

glm::vec3 octahedron_point(float u, float v) {
  const float x = 2 * u - 1, z = 2 * v - 1, y = 1 - std::abs(x) - std::abs(z);
  if (y >= 0) return {x, y, z};
  return {signed_as(1 - std::abs(z), x), y, signed_as(1 - std::abs(x), z)};
}

float solid_angle(const glm::vec3& octahedron_point) {
  // All faces have the same distance from the centre and the same angle to the square, so only 1 / length^3 varies.
  const float squared = glm::dot(octahedron_point, octahedron_point);
  return 1.0f / (squared * std::sqrt(squared));
}

glm::vec3 OctahedralMap::color(const glm::vec3& towards) const {
  const float scale = 1.0f / (std::abs(towards.x) + std::abs(towards.y) + std::abs(towards.z));
  glm::vec2 at(towards.x * scale, towards.z * scale);
  if (towards.y < 0) at = {signed_as(1 - std::abs(at.y), towards.x), signed_as(1 - std::abs(at.x), towards.z)};
  const glm::vec2 place = (at * 0.5f + 0.5f) * float(size_) - 0.5f;
  // NaN is looked up in the first texel.
  const glm::vec2 first = glm::min(glm::max(glm::vec2(-1), glm::floor(place)), glm::vec2(float(size_ - 1)));
  const glm::vec2 part = place - first;
  const int x = int(first.x), y = int(first.y);
  const glm::vec3 upper = color(x, y) + (color(x + 1, y) - color(x, y)) * part.x;
  const glm::vec3 lower = color(x, y + 1) + (color(x + 1, y + 1) - color(x, y + 1)) * part.x;
  return upper + (lower - upper) * part.y;
}

void OctahedralMap::close_border() {
  const int last = size_ - 1;
  for (int i = 0; i < size_; ++i) {
    set(i, -1, color(last - i, 0));
    set(i, size_, color(last - i, last));
    set(-1, i, color(0, last - i));
    set(size_, i, color(last, last - i));
  }
  for (const int x : {-1, size_})
    for (const int y : {-1, size_}) set(x, y, color(x < 0 ? last : 0, y < 0 ? last : 0));
}

OctahedralMap OctahedralMap::half() const {
  OctahedralMap coarse(size_ / 2);
  for (int y = 0; y < coarse.size_; ++y)
    for (int x = 0; x < coarse.size_; ++x) {
      glm::vec3 sum(0);
      float weights = 0;
      for (int k = 0; k < 4; ++k) {
        const int fine_x = 2 * x + k % 2, fine_y = 2 * y + k / 2;
        const float weight = solid_angle(octahedron_point(size_, fine_x, fine_y));
        sum += weight * color(fine_x, fine_y);
        weights += weight;
      }
      coarse.set(x, y, sum / weights);
    }
  coarse.close_border();
  return coarse;
}

glm::vec3 equirectangular_color(const Image& picture, const glm::vec3& towards) {
  const Planes planes(picture);
  return interpolated(towards, picture.width, picture.height, [&](int x, int y) {
    return planes.at(std::size_t(y) * std::size_t(picture.width) + std::size_t(x));
  });
}

OctahedralMap draw_map(const Image& equirectangular, const Execution& execution) {
  constexpr int most_width = 2048, least_size = 64, per_side = 3;  // samples along a texel side, closer than pixels
  const EquirectangularMap source(equirectangular, most_width, execution);
  int size = least_size;
  while (size < source.width() / 4) size *= 2;
  OctahedralMap map(size);
  parallel_for(execution, std::size_t(size), 4, [&](std::size_t begin, std::size_t end) {
    for (int y = int(begin); y < int(end); ++y)
      for (int x = 0; x < size; ++x) {
        glm::vec3 sum(0);
        float weights = 0;
        for (int k = 0; k < per_side * per_side; ++k) {
          const glm::vec2 within((float(k % per_side) + 0.5f) / per_side, (float(k / per_side) + 0.5f) / per_side);
          const glm::vec3 point =
              octahedron_point((float(x) + within.x) / float(size), (float(y) + within.y) / float(size));
          const float weight = solid_angle(point);
          sum += weight * source.color(point);
          weights += weight;
        }
        map.set(x, y, sum / weights);
      }
  });
  map.close_border();
  return map;
}

}  // namespace frontmost::shading
