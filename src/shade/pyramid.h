// SPDX-License-Identifier: Apache-2.0
// A texture with its mip levels, and how to look into it.
#pragma once

#include <vector>

#include "scene/texture_lookup.h"

namespace frontmost::shading {

/// What the stored bytes mean. Colours are averaged as light, whichever way they are stored.
enum class Encoding : std::uint8_t { srgb, linear };

/// Where a fragment looks, and how far that moves from pixel to pixel, in texture coordinates.
struct TextureFootprint {
  glm::vec2 texcoord{0}, dx{0}, dy{0};
};

[[nodiscard]] inline TextureFootprint transformed(const TexcoordTransform& t, const TextureFootprint& f) {
  return {t.place(f.texcoord), t.step(f.dx), t.step(f.dy)};
}

class Pyramid {
 public:
  /// Borrows `texture`. An empty one gives white everywhere. O(texels), in parallel.
  Pyramid(const Texture& texture, Encoding encoding, const Execution& execution = {});
  Pyramid(Pyramid&&) = default;
  Pyramid& operator=(Pyramid&&) = default;
  Pyramid(const Pyramid&) = delete;
  Pyramid& operator=(const Pyramid&) = delete;

  /// Linear RGBA: bilinear in the two nearest levels, blended; several such along a footprint that is much longer
  /// than wide, so that surfaces seen at a slant stay sharp. Textures marked `nearest` give the one texel.
  [[nodiscard]] glm::vec4 sample(const TextureFootprint& footprint) const;
  /// The average of all texels, as the smallest level has it.
  [[nodiscard]] glm::vec4 average() const;
  [[nodiscard]] int level_count() const { return int(levels_.size()); }

 private:
  struct Level {
    int width = 0, height = 0;
    const glm::u8vec4* texels = nullptr;
  };

  void add_level(const Level& from, const Execution& execution);
  [[nodiscard]] glm::vec4 texel(const Level& level, int x, int y) const;
  [[nodiscard]] glm::vec4 nearest(const glm::vec2& texcoord) const;
  [[nodiscard]] glm::vec4 bilinear(const Level& level, const glm::vec2& texcoord) const;
  [[nodiscard]] glm::vec4 trilinear(const glm::vec2& texcoord, float level) const;

  const Texture* texture_;
  Encoding encoding_;
  const float* color_of_byte_;  ///< 256 entries
  std::vector<Level> levels_;
  std::vector<std::vector<glm::u8vec4>> storage_;  ///< of levels 1 and up
};

/// log2 of a positive number to within 0.01, by operations that every machine rounds alike.
[[nodiscard]] float approximate_log2(float value);

}  // namespace frontmost::shading
