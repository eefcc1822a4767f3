// SPDX-License-Identifier: Apache-2.0
// Equirectangular pictures: the place of a direction in a picture, and the colour there.
#pragma once

#include "frontmost/image.h"

namespace frontmost::shading {

/// The place of a direction, 0 to 1 from left to right and from top to bottom; `towards` has any length but zero. The
/// error is at most 1/50000 of a turn, and the bits are the same on every machine.
[[nodiscard]] glm::vec2 equirectangular_place(const glm::vec3& towards);

/// A copy of an equirectangular picture, prepared for bilinear look-ups.
class EquirectangularMap {
 public:
  /// Reads the channels R, G and B. Pictures wider than `most_width` are reduced to about that width. In parallel.
  EquirectangularMap(const Image& picture, int most_width, const Execution& execution);
  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] glm::vec3 color(const glm::vec3& towards) const;

 private:
  int width_, height_;
  Buffer<glm::vec3> texels_;
};

/// The colour of one background pixel: bilinear in the picture itself.
[[nodiscard]] glm::vec3 equirectangular_color(const Image& picture, const glm::vec3& towards);

}  // namespace frontmost::shading
