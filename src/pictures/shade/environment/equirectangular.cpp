// SPDX-License-Identifier: Apache-2.0
#include "shade/environment/equirectangular.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "shade/environment/prefiltered.h"

namespace frontmost::shading {
namespace {

constexpr float kHalfTurn = 3.14159265f;

/// The arc tangent of numbers from 0 to 1, to about 2e-6. C libraries are not used, as they differ in the last bit. (C.
/// Hastings. Approximations for Digital Computers. 1955.)
float arc_tangent(float t) {
  const float t2 = t * t;
  const float high = 0.05265332f - 0.01172120f * t2;
  return t * (0.99997726f + t2 * (-0.33262347f + t2 * (0.19354346f + t2 * (-0.11643287f + t2 * high))));
}

/// The angle of (x, y) from the x axis towards the y axis, -pi to pi; 0 for (0, 0).
float angle_of(float x, float y) {
  const float ax = std::abs(x), ay = std::abs(y), longer = std::max(ax, ay);
  if (!(longer > 0)) return 0;
  const float first = arc_tangent(std::min(ax, ay) / longer);
  const float steep = ay > ax ? 0.5f * kHalfTurn - first : first;
  const float half = x < 0 ? kHalfTurn - steep : steep;
  return y < 0 ? -half : half;
}

/// The four texels around a place, and its offset from the first; columns wrap around.
struct TexelsAround {
  int left, right, upper, lower;
  glm::vec2 part;
};

TexelsAround texels_around(const glm::vec2& place, int width, int height) {
  const glm::vec2 at = place * glm::vec2(float(width), float(height)) - 0.5f, first = glm::floor(at);
  const int x = std::clamp(int(first.x), -1, width - 1), y = std::clamp(int(first.y), -1, height - 1);
  return {x < 0 ? width - 1 : x, x + 1 < width ? x + 1 : 0, std::max(y, 0), std::min(y + 1, height - 1), at - first};
}

/// Bilinear interpolation; `color_at` gives the colour of a pixel.
template <class ColorAt>
glm::vec3 interpolated(const TexelsAround& n, const ColorAt& color_at) {
  const glm::vec3 a = color_at(n.left, n.upper), b = color_at(n.right, n.upper);
  const glm::vec3 c = color_at(n.left, n.lower), d = color_at(n.right, n.lower);
  const glm::vec3 upper = a + (b - a) * n.part.x, lower = c + (d - c) * n.part.x;
  return upper + (lower - upper) * n.part.y;
}

/// The three planes of a picture.
struct Planes {
  explicit Planes(const Image& picture)
      : r(picture.find("R")->floats().data()),
        g(picture.find("G")->floats().data()),
        b(picture.find("B")->floats().data()) {}
  [[nodiscard]] glm::vec3 at(std::size_t i) const { return {r[i], g[i], b[i]}; }
  const float *r, *g, *b;
};

}  // namespace

glm::vec2 equirectangular_place(const glm::vec3& towards) {
  const float azimuth = angle_of(-towards.z, towards.x);
  const float elevation = angle_of(std::sqrt(towards.x * towards.x + towards.z * towards.z), towards.y);
  return {0.5f + azimuth * (0.5f / kHalfTurn), 0.5f - elevation * (1 / kHalfTurn)};
}

EquirectangularMap::EquirectangularMap(const Image& picture, int most_width, const Execution& execution)
    : width_(std::min(picture.width, most_width)), height_(std::min(picture.height, most_width / 2)) {
  texels_ = Buffer<glm::vec3>(std::size_t(width_) * std::size_t(height_));
  const Planes planes(picture);
  // Blocks hold whole pixels: if the width is no multiple, some are a pixel wider than others.
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

glm::vec3 EquirectangularMap::color(const glm::vec3& towards) const {
  return interpolated(texels_around(equirectangular_place(towards), width_, height_),
                      [&](int x, int y) { return texels_[std::size_t(y) * std::size_t(width_) + std::size_t(x)]; });
}

glm::vec3 equirectangular_color(const Image& picture, const glm::vec3& towards) {
  const Planes planes(picture);
  return interpolated(texels_around(equirectangular_place(towards), picture.width, picture.height), [&](int x, int y) {
    return planes.at(std::size_t(y) * std::size_t(picture.width) + std::size_t(x));
  });
}

OctahedralMap draw_map(const Image& equirectangular, const Execution& execution) {
  constexpr int most_width = 2048, least_size = 64, per_side = 3;  // sampled places per texel side, closer than pixels
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
