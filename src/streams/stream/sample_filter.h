// SPDX-License-Identifier: Apache-2.0
// Finds the triangles that may cover a sample of a view. In long streams most triangles lie between samples or outside
// of the picture. No surfaces have to be made from them.
//
//      .       .       .        samples
//         /\                    covers no sample: its box lies between two columns and two rows
//      .  --   .       .
//           ____
//      .   / .  \      .        may cover one: its box does
#pragma once

#include <cstdint>
#include <vector>

#include "frontmost/scene.h"
#include "frontmost/view.h"
#include "view/screen_transform.h"

namespace frontmost::streaming {

/// Pixels from (x0, y0) up to, but without, (x1, y1).
struct PixelBounds {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;

  [[nodiscard]] bool is_empty() const { return x0 >= x1 || y0 >= y1; }
  void include(const PixelBounds& other);
};

class SampleFilter {
 public:
  explicit SampleFilter(const View& view);

  /// Marks every triangle that may cover a sample: all that do, and few others. It allows for the snapping of the
  /// methods, so no triangle that they would show is lost. \returns the pixels that marked triangles may cover.
  PixelBounds mark(const Mesh& mesh, std::vector<std::uint8_t>& marks);

 private:
  /// A vertex on the screen, in 1/256 pixel from the picture's top left corner, accurate to one unit; or the planes
  /// that it is beyond.
  struct Corner {
    std::int32_t x, y;
    std::uint32_t beyond;
  };
  /// A range of screen coordinates in 1/256 pixel, both ends inclusive.
  struct Extent {
    std::int32_t x0, y0, x1, y1;
  };

  [[nodiscard]] Corner corner_of(const glm::vec3& position) const;
  [[nodiscard]] bool may_hold_sample(const Extent& extent) const;
  [[nodiscard]] PixelBounds pixels_of(const Extent& extent) const;

  ScreenTransform transform_;
  int width_, height_;
  std::vector<glm::ivec2> offsets_;  ///< sample positions within a pixel
  std::vector<Corner> corners_;      ///< vertices of the current mesh
};

}  // namespace frontmost::streaming
