// SPDX-License-Identifier: Apache-2.0
// A texture with its mip levels: each is half as wide and high as the one before, down to a single texel.
// (L. Williams. Pyramidal Parametrics. SIGGRAPH 1983.)
#pragma once

#include <array>
#include <vector>

#include "frontmost/scene.h"

namespace frontmost::shading {

/// The encoding of the stored bytes. Colours of both encodings are averaged as light.
enum class Encoding : std::uint8_t { srgb, linear };

class Pyramid {
 public:
  struct Level {
    int width = 0, height = 0;
    const glm::u8vec4* texels = nullptr;
  };

  /// Borrows `texture`, which is the first level. Textures marked `nearest` have only that level, empty ones have none.
  /// O(texels), in parallel.
  Pyramid(const Texture& texture, Encoding encoding, const Execution& execution = {});
  Pyramid(Pyramid&&) = default;
  Pyramid& operator=(Pyramid&&) = default;
  Pyramid(const Pyramid&) = delete;
  Pyramid& operator=(const Pyramid&) = delete;

  [[nodiscard]] const Texture& texture() const { return *texture_; }
  [[nodiscard]] Encoding encoding() const { return encoding_; }
  [[nodiscard]] const std::vector<Level>& levels() const { return levels_; }
  /// Width and height of a level and of the next one (or again this one), as floats to multiply coordinates with.
  [[nodiscard]] const std::array<float, 4>& sizes_from(int level) const { return sizes_[std::size_t(level)]; }

 private:
  void add_level(const Level& from, const Execution& execution);

  const Texture* texture_;
  Encoding encoding_;
  std::vector<Level> levels_;
  std::vector<std::array<float, 4>> sizes_;        ///< by level
  std::vector<std::vector<glm::u8vec4>> storage_;  ///< of levels 1 and up
};

}  // namespace frontmost::shading
