// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstring>

#include "base/parallel.h"
#include "base/srgb.h"
#include "shade/texture/texture_sampler.h"

namespace frontmost::shading {
namespace {

/// Returns the linear light of each byte.
const float* table_of(Encoding encoding) {
  static const auto tables = [] {
    std::array<std::array<float, 256>, 2> values{};
    for (std::size_t i = 0; i < 256; ++i) {
      values[0][i] = linear_of_srgb8(std::uint8_t(i));
      values[1][i] = float(i) / 255.0f;
    }
    return values;
  }();
  return tables[encoding == Encoding::srgb ? 0 : 1].data();
}

std::uint8_t linear_byte(float value) { return std::uint8_t(std::min(value, 1.0f) * 255.0f + 0.5f); }

/// The texels of the finer level that form a texel of the coarser level, along one axis. There are two, or three if the
/// finer size is odd. Over all coarser texels, every finer one has the same weight.
struct FinerTexels {
  int first, count;
  float weight[3];
};
FinerTexels finer_texels(int i, int fine, int coarse) {
  if (fine == 1) return {0, 1, {1, 0, 0}};
  if (fine % 2 == 0) return {2 * i, 2, {0.5f, 0.5f, 0}};
  const float total = 1.0f / float(fine);
  return {2 * i, 3, {float(coarse - i) * total, float(coarse) * total, float(i + 1) * total}};
}

/// Returns two adjacent texels in memory order.
std::uint64_t pair_at(const glm::u8vec4* texels) {
  std::uint64_t pair;
  std::memcpy(&pair, texels, sizeof pair);
  return pair;
}

/// Computes rows of the next coarser level.
struct Halving {
  Encoding encoding;
  const float* color_of_byte;
  int width, height;  ///< size of the finer level
  const glm::u8vec4* texels;

  void row(int y, glm::u8vec4* out) const {
    const int coarse = std::max(1, width / 2);
    const bool is_halved = width % 2 == 0 && height % 2 == 0;
    if (is_halved && is_opaque(0, coarse, y)) return average_opaque(0, coarse, y, out);
    for (int x = 0; x < coarse; ++x) {
      if (is_halved && is_opaque(x, x + 1, y))
        average_opaque(x, x + 1, y, out);
      else
        out[x] = weighted_mean(x, y);
    }
  }

 private:
  [[nodiscard]] const glm::u8vec4& at(int x, int y) const {
    return texels[std::size_t(y) * std::size_t(width) + std::size_t(x)];
  }
  // The functions below are for texels [begin, end) of a row, each of which is formed by four texels of the finer
  // level.

  /// Whether all of the finer texels are opaque. This is so in most textures.
  [[nodiscard]] bool is_opaque(int begin, int end, int y) const {
    const glm::u8vec4 *upper = &at(0, 2 * y), *lower = &at(0, 2 * y + 1);
    std::uint8_t all = 0xFF;
    for (int i = 2 * begin; i < 2 * end; ++i) all = std::uint8_t(all & upper[i].a & lower[i].a);
    return all == 0xFF;
  }
  void average_opaque(int begin, int end, int y, glm::u8vec4* out) const {
    encoding == Encoding::linear ? average_bytes(begin, end, y, out) : average_light(begin, end, y, out);
  }
  /// Averages both texels of a row at once, with every other byte in a 16-bit field.
  void average_bytes(int begin, int end, int y, glm::u8vec4* out) const {
    constexpr std::uint64_t even = 0x00FF00FF00FF00FFu, half = 0x0002000200020002u;
    const glm::u8vec4 *upper = &at(0, 2 * y), *lower = &at(0, 2 * y + 1);
    for (int x = begin; x < end; ++x) {
      const std::uint64_t u = pair_at(upper + 2 * x), l = pair_at(lower + 2 * x);
      const auto mean = [&](std::uint64_t sums) { return (sums + (sums >> 32) + half) >> 2 & even; };
      const std::uint64_t evens = mean((u & even) + (l & even)), odds = mean((u >> 8 & even) + (l >> 8 & even));
      const auto texel = std::uint32_t(evens | odds << 8);
      std::memcpy(out + x, &texel, sizeof texel);
    }
  }
  /// Averages sRGB colours as linear light.
  void average_light(int begin, int end, int y, glm::u8vec4* out) const {
    for (int x = begin; x < end; ++x) {
      const glm::u8vec4 *upper = &at(2 * x, 2 * y), *lower = &at(2 * x, 2 * y + 1);
      const auto mean = [&](int k) {
        return srgb8_of_linear(0.25f * ((color_of_byte[upper[0][k]] + color_of_byte[upper[1][k]]) +
                                        (color_of_byte[lower[0][k]] + color_of_byte[lower[1][k]])));
      };
      out[x] = {mean(0), mean(1), mean(2), 0xFF};
    }
  }
  /// Returns a mean weighted by alpha, so that colours of transparent texels do not bleed into their neighbours.
  [[nodiscard]] glm::u8vec4 weighted_mean(int x, int y) const {
    const FinerTexels tx = finer_texels(x, width, std::max(1, width / 2)),
                      ty = finer_texels(y, height, std::max(1, height / 2));
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

}  // namespace

Pyramid::Pyramid(const Texture& texture, Encoding encoding, const Execution& execution)
    : texture_(&texture), encoding_(encoding) {
  if (texture.pixels.empty()) return;
  levels_.push_back({texture.width, texture.height, texture.pixels.data()});
  while (!texture.nearest && (levels_.back().width > 1 || levels_.back().height > 1))
    add_level(Level(levels_.back()), execution);
  for (std::size_t l = 0; l < levels_.size(); ++l) {
    const Level &fine = levels_[l], &coarse = levels_[std::min(l + 1, levels_.size() - 1)];
    sizes_.push_back({float(fine.width), float(fine.height), float(coarse.width), float(coarse.height)});
  }
}

void Pyramid::add_level(const Level& from, const Execution& execution) {
  const Level to{std::max(1, from.width / 2), std::max(1, from.height / 2), nullptr};
  Buffer<glm::u8vec4> texels(std::size_t(to.width) * std::size_t(to.height));
  const Halving halving{encoding_, table_of(encoding_), from.width, from.height, from.texels};
  constexpr std::size_t rows_at_once = 64;
  parallel_for(execution, std::size_t(to.height), rows_at_once, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y) halving.row(int(y), texels.data() + y * std::size_t(to.width));
  });
  storage_.push_back(std::move(texels));
  levels_.push_back({to.width, to.height, storage_.back().data()});
}

}  // namespace frontmost::shading
