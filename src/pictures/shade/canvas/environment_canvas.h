// SPDX-License-Identifier: Apache-2.0
// A canvas for pictures that show the environment as background.
#pragma once

#include "base/pool.h"
#include "shade/canvas/canvas.h"
#include "shade/light/lighting.h"
#include "view/ray_volumes.h"

namespace frontmost::shading {

/// Composites every tile over the environment and passes the tile to another canvas, which it borrows. The environment
/// gets the same exposure and tone mapping as surfaces.
class EnvironmentCanvas final : public TileCanvas {
 public:
  EnvironmentCanvas(TileCanvas& canvas, const View& view, const Lighting& lighting, Isa isa)
      : canvas_(canvas), rays_(view), lighting_(lighting), isa_(isa) {}
  void write(const TileRectangle& tile, const std::vector<glm::vec4>& pixels, const glm::vec4& background) override;
  void fill(const TileRectangle& tile, const glm::vec4& value) override;
  void write_tinted(const TileRectangle& tile, const abuffer_detail::PaintedPixels& pixels,
                    const glm::vec4& background) override;

 private:
  /// Used by one thread at a time.
  struct Work {
    FragmentBatch batch;
    std::vector<glm::vec4> pixels;
  };

  /// Sets work.pixels to the environment alone.
  void draw(const TileRectangle& tile, Work& work) const;
  /// The radiance seen at the middle of a pixel.
  [[nodiscard]] glm::vec3 radiance(int x, int y) const;

  TileCanvas& canvas_;
  ScreenRays rays_;
  Lighting lighting_;
  Isa isa_;
  Pool<Work> works_;
};

}  // namespace frontmost::shading
