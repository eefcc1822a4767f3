// SPDX-License-Identifier: Apache-2.0
// Which triangles may hold a sample of a view at all. Of a stream as long as these are for, most are smaller than what
// lies between samples, or outside of the picture: they need not be made into surfaces.
//
//      .       .       .        samples
//         /\                    holds none of them: its box lies between two columns and two rows
//      .  --   .       .
//           ____
//      .   / .  \      .        may hold one: its box does
#pragma once

#include <cstdint>
#include <vector>

#include "frontmost/scene.h"
#include "frontmost/view.h"
#include "view/screen_transform.h"

namespace frontmost::streaming {

/// Pixels from (x0, y0) to before (x1, y1).
struct PixelBounds {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;

  [[nodiscard]] bool is_empty() const { return x0 >= x1 || y0 >= y1; }
  void include(const PixelBounds& other);
};

class SampleFilter {
 public:
  explicit SampleFilter(const View& view);

  /// Sets the mark of every triangle that may hold a sample: of all that do, and of few others. By the methods' own
  /// snapping, so nothing that they would show is lost. \returns the pixels that the triangles may cover.
  PixelBounds mark(const Mesh& mesh, std::vector<std::uint8_t>& marks);

 private:
  /// A vertex on the screen, in 1/256 pixel from the picture's top left corner, to one such unit; or the planes that it
  /// is beyond.
  struct Corner {
    std::int32_t x, y;
    std::uint32_t beyond;
  };
  /// Both ends inclusive, in the same unit.
  struct Extent {
    std::int32_t x0, y0, x1, y1;
  };

  [[nodiscard]] Corner corner_of(const glm::vec3& position) const;
  [[nodiscard]] bool may_hold_sample(const Extent& extent) const;
  [[nodiscard]] PixelBounds pixels_of(const Extent& extent) const;

  ScreenTransform transform_;
  int width_, height_;
  std::vector<glm::ivec2> offsets_;  ///< of the samples within a pixel
  std::vector<Corner> corners_;      ///< of the mesh at hand
};

}  // namespace frontmost::streaming
