// SPDX-License-Identifier: Apache-2.0
#include "shade/pyramid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "base/parallel.h"
#include "base/srgb.h"

namespace frontmost::shading {
namespace {

constexpr int kMostTaps = 8;  ///< along a slanted footprint

using ByteTable = std::array<float, 256>;

const float* table_of(Encoding encoding) {
  static const ByteTable srgb = [] {
    ByteTable values{};
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = linear_of_srgb8(std::uint8_t(i));
    return values;
  }();
  static const ByteTable linear = [] {
    ByteTable values{};
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = float(i) / 255.0f;
    return values;
  }();
  return encoding == Encoding::srgb ? srgb.data() : linear.data();
}

std::uint8_t linear_byte(float value) { return std::uint8_t(std::min(value, 1.0f) * 255.0f + 0.5f); }

/// Which texels of the finer level make one of the coarser, along one axis: two, or three with an odd size, so that
/// every texel counts alike.
struct Taps {
  int first, count;
  float weight[3];
};
Taps taps(int i, int fine, int coarse) {
  if (fine == 1) return {0, 1, {1, 0, 0}};
  if (fine % 2 == 0) return {2 * i, 2, {0.5f, 0.5f, 0}};
  const float total = 1.0f / float(fine);
  return {2 * i, 3, {float(coarse - i) * total, float(coarse) * total, float(i + 1) * total}};
}

/// Makes rows of the next coarser level.
struct Halving {
  Encoding encoding;
  const float* color_of_byte;
  int width, height;  ///< of the finer level
  const glm::u8vec4* texels;

  void row(int y, glm::u8vec4* out) const {
    const int coarse = std::max(1, width / 2);
    for (int x = 0; x < coarse; ++x) out[x] = is_simple(x, y) ? mean_of_four(x, y) : weighted_mean(x, y);
  }

 private:
  [[nodiscard]] const glm::u8vec4& at(int x, int y) const {
    return texels[std::size_t(y) * std::size_t(width) + std::size_t(x)];
  }
  /// Four opaque texels: nearly all there are.
  [[nodiscard]] bool is_simple(int x, int y) const {
    if (width % 2 != 0 || height % 2 != 0) return false;
    const glm::u8vec4 *upper = &at(2 * x, 2 * y), *lower = &at(2 * x, 2 * y + 1);
    return (upper[0].a & upper[1].a & lower[0].a & lower[1].a) == 0xFF;
  }
  [[nodiscard]] glm::u8vec4 mean_of_four(int x, int y) const {
    const glm::u8vec4 *upper = &at(2 * x, 2 * y), *lower = &at(2 * x, 2 * y + 1);
    glm::u8vec4 mean(0xFF);
    for (int k = 0; k < 3; ++k) {
      if (encoding == Encoding::linear) {
        mean[k] = std::uint8_t((upper[0][k] + upper[1][k] + lower[0][k] + lower[1][k] + 2) / 4);
      } else {
        mean[k] = srgb8_of_linear(0.25f * ((color_of_byte[upper[0][k]] + color_of_byte[upper[1][k]]) +
                                           (color_of_byte[lower[0][k]] + color_of_byte[lower[1][k]])));
      }
    }
    return mean;
  }
  /// Weighted by alpha, so that what a transparent texel hides does not bleed into its neighbours.
  [[nodiscard]] glm::u8vec4 weighted_mean(int x, int y) const {
    const Taps tx = taps(x, width, std::max(1, width / 2)), ty = taps(y, height, std::max(1, height / 2));
    glm::vec4 sum(0);
    glm::vec3 plain(0);
    for (int j = 0; j < ty.count; ++j)
      for (int i = 0; i < tx.count; ++i) {
        const glm::u8vec4& t = at(tx.first + i, ty.first + j);
        const glm::vec3 color(color_of_byte[t.r], color_of_byte[t.g], color_of_byte[t.b]);
        const float weight = ty.weight[j] * tx.weight[i], alpha = weight * float(t.a) / 255.0f;
        plain += color * weight;
        sum += glm::vec4(color * alpha, alpha);
      }
    const glm::vec3 color = sum.a > 0 ? glm::vec3(sum) / sum.a : plain;
    glm::u8vec4 mean;
    for (int k = 0; k < 3; ++k)
      mean[k] = encoding == Encoding::srgb ? srgb8_of_linear(color[k]) : linear_byte(color[k]);
    mean.a = linear_byte(sum.a);
    return mean;
  }
};

float length_of(const glm::vec2& v) { return std::sqrt(v.x * v.x + v.y * v.y); }

inline float mix(float a, float b, float t) { return a + (b - a) * t; }
glm::vec4 mix(const glm::vec4& a, const glm::vec4& b, float t) { return a + (b - a) * t; }

}  // namespace

float approximate_log2(float value) {
  std::uint32_t bits;
  std::memcpy(&bits, &value, sizeof bits);
  const float exponent = float(int(bits >> 23) - 127);
  bits = (bits & 0x007FFFFFu) | 0x3F800000u;
  float mantissa;
  std::memcpy(&mantissa, &bits, sizeof mantissa);
  // A parabola through the exact values at 1 and 2, so that there is no step between octaves.
  const float t = mantissa - 1.0f;
  return exponent + t * (1.3465f - 0.3465f * t);
}

Pyramid::Pyramid(const Texture& texture, Encoding encoding, const Execution& execution)
    : texture_(&texture), encoding_(encoding), color_of_byte_(table_of(encoding)) {
  if (texture.pixels.empty()) return;
  levels_.push_back({texture.width, texture.height, texture.pixels.data()});
  if (texture.nearest) return;
  while (levels_.back().width > 1 || levels_.back().height > 1) add_level(Level(levels_.back()), execution);
}

void Pyramid::add_level(const Level& from, const Execution& execution) {
  const Level to{std::max(1, from.width / 2), std::max(1, from.height / 2), nullptr};
  std::vector<glm::u8vec4> texels(std::size_t(to.width) * std::size_t(to.height));
  const Halving halving{encoding_, color_of_byte_, from.width, from.height, from.texels};
  constexpr std::size_t rows_at_once = 64;
  parallel_for(execution, std::size_t(to.height), rows_at_once, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y) halving.row(int(y), texels.data() + y * std::size_t(to.width));
  });
  storage_.push_back(std::move(texels));
  levels_.push_back({to.width, to.height, storage_.back().data()});
}

glm::vec4 Pyramid::texel(const Level& level, int x, int y) const {
  const glm::u8vec4 t = level.texels[std::size_t(y) * std::size_t(level.width) + std::size_t(x)];
  return {color_of_byte_[t.r], color_of_byte_[t.g], color_of_byte_[t.b], table_of(Encoding::linear)[t.a]};
}

glm::vec4 Pyramid::nearest(const glm::vec2& texcoord) const {
  const Level& level = levels_[0];
  return texel(level, texel_of(texcoord.x, level.width, texture_->wrap_u),
               texel_of(texcoord.y, level.height, texture_->wrap_v));
}

glm::vec4 Pyramid::bilinear(const Level& level, const glm::vec2& texcoord) const {
  const TexelPair x = texel_pair(texcoord.x, level.width, texture_->wrap_u);
  const TexelPair y = texel_pair(texcoord.y, level.height, texture_->wrap_v);
  const glm::u8vec4* upper = level.texels + std::size_t(y.first) * std::size_t(level.width);
  const glm::u8vec4* lower = level.texels + std::size_t(y.second) * std::size_t(level.width);
  const glm::u8vec4 a = upper[x.first], b = upper[x.second], c = lower[x.first], d = lower[x.second];
  const float fx = x.fraction, fy = y.fraction;
  // Channel by channel: the compiler keeps four scalars in registers where it would spill vectors.
  const auto channel = [&](const float* table, int k) {
    const float above = mix(table[a[k]], table[b[k]], fx), below = mix(table[c[k]], table[d[k]], fx);
    return mix(above, below, fy);
  };
  const float* colors = color_of_byte_;
  return {channel(colors, 0), channel(colors, 1), channel(colors, 2), channel(table_of(Encoding::linear), 3)};
}

glm::vec4 Pyramid::trilinear(const glm::vec2& texcoord, float level) const {
  const int last = level_count() - 1;
  if (!(level > 0)) return bilinear(levels_[0], texcoord);
  if (level >= float(last)) return bilinear(levels_[std::size_t(last)], texcoord);
  const int finer = int(level);
  return mix(bilinear(levels_[std::size_t(finer)], texcoord), bilinear(levels_[std::size_t(finer + 1)], texcoord),
             level - float(finer));
}

glm::vec4 Pyramid::sample(const TextureFootprint& footprint) const {
  if (levels_.empty()) return glm::vec4(1);
  if (texture_->nearest) return nearest(footprint.texcoord);
  const glm::vec2 size(float(levels_[0].width), float(levels_[0].height));
  const float along_x = length_of(footprint.dx * size), along_y = length_of(footprint.dy * size);
  const float longer = std::max(along_x, along_y), shorter = std::max(std::min(along_x, along_y), 1.0f);
  if (!(longer > 1.0f)) return bilinear(levels_[0], footprint.texcoord);
  if (!(longer < 1e30f)) return average();
  const float ratio = longer / shorter;
  const int count = ratio < float(kMostTaps) ? int(ratio + 0.999f) : kMostTaps;
  const float level = approximate_log2(std::max(shorter, longer / float(kMostTaps)));
  if (count <= 1) return trilinear(footprint.texcoord, level);
  const glm::vec2 axis = along_x > along_y ? footprint.dx : footprint.dy;
  glm::vec4 sum(0);
  for (int i = 0; i < count; ++i)
    sum += trilinear(footprint.texcoord + axis * ((float(i) + 0.5f) / float(count) - 0.5f), level);
  return sum * (1.0f / float(count));
}

glm::vec4 Pyramid::average() const { return levels_.empty() ? glm::vec4(1) : texel(levels_.back(), 0, 0); }

}  // namespace frontmost::shading
