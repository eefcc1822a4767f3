// SPDX-License-Identifier: Apache-2.0
// Equirectangular pictures: where a direction is in one, and how bright it is there.
#pragma once

#include "frontmost/image.h"

namespace frontmost::shading {

/// 0 to 1 from left to right and from top to bottom; `towards` has any length but zero. To 1/50000 of a turn or better,
/// the same bits on every machine.
[[nodiscard]] glm::vec2 equirectangular_place(const glm::vec3& towards);

/// An equirectangular picture as bilinear look-ups want it.
class EquirectangularMap {
 public:
  /// Of the channels R, G and B; pictures wider than this are reduced to about this width. In parallel.
  EquirectangularMap(const Image& picture, int most_width, const Execution& execution);
  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] glm::vec3 color(const glm::vec3& towards) const;

 private:
  int width_, height_;
  Buffer<glm::vec3> texels_;
};

/// One pixel's worth of a background: bilinear in the picture itself.
[[nodiscard]] glm::vec3 equirectangular_color(const Image& picture, const glm::vec3& towards);

}  // namespace frontmost::shading
