// SPDX-License-Identifier: Apache-2.0
// Translucent scenes made ready, and one picture of them.
#pragma once

#include "harness/options.h"
#include "harness/stage.h"

namespace frontmost::bench {

/// Sub-samples along a pixel's side, those that are asked for.
[[nodiscard]] inline std::vector<int> grids(const Options& options) {
  return options.grid < 0 ? std::vector<int>{0, 4, 8} : std::vector<int>{options.grid};
}
[[nodiscard]] inline int samples_of(int grid) { return grid == 0 ? 1 : grid * grid; }

/// Draws one view again and again, in the same memory. Everything has opacity 0.4 and the colour that one light at the
/// camera's upper left gives it, worked out for every picture, as the shaders of depth peeling do.
class Pictures {
 public:
  explicit Pictures(const Stage& stage) : stage_(stage) {}
  const ResolvedPicture& draw(int grid, const Execution& execution);
  /// With the colours of the last draw(): the A-buffer alone, as lighting is done by one thread.
  const ResolvedPicture& draw_unlit(int grid, const Execution& execution);

 private:
  void light();

  const Stage& stage_;
  std::vector<glm::vec4> colors_;
  Resolver resolver_;
};

/// `count` sheets that fill the picture, one behind the other.
[[nodiscard]] Stage make_sheets(int count, int width, int height);

}  // namespace frontmost::bench
