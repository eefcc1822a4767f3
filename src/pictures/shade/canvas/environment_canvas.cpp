// SPDX-License-Identifier: Apache-2.0
#include "shade/canvas/environment_canvas.h"

#include <algorithm>

#include "shade/environment/equirectangular.h"

namespace frontmost::shading {

glm::vec3 EnvironmentCanvas::radiance(int x, int y) const {
  const PrefilteredEnvironment* const environment = lighting_.around.environment;
  if (!environment) return glm::vec3(0);
  const glm::dvec3 ray = rays_.is_parallel() ? rays_.forward() : rays_.at(x + 0.5, y + 0.5);
  const glm::vec3 towards = glm::vec3(glm::normalize(ray)) * lighting_.around.world_from_environment;
  if (environment->picture.channels.empty()) return environment->levels[0].color(towards);
  return equirectangular_color(environment->picture, towards);
}

void EnvironmentCanvas::draw(const TileRectangle& tile, Work& work) const {
  const int count = tile.width * tile.height;
  work.pixels.resize(std::size_t(count));
  FragmentBatch& batch = work.batch;
  for (int begin = 0; begin < count; begin += batch_capacity) {
    batch.coverage.count = std::min(batch_capacity, count - begin);
    for (int i = 0; i < batch.coverage.count; ++i) {
      const int pixel = begin + i;
      batch.light.set(i, radiance(tile.x + pixel % tile.width, tile.y + pixel / tile.width));
      batch.material.unlit[i] = 0;
    }
    finish_light(lighting_, batch, isa_);
    for (int i = 0; i < batch.coverage.count; ++i)
      work.pixels[std::size_t(begin + i)] = glm::vec4(batch.light.at(i), 1.0f);
  }
}

void EnvironmentCanvas::write(const TileRectangle& tile, const std::vector<glm::vec4>& pixels,
                              const glm::vec4& background) {
  const auto work = works_.borrow([] { return std::make_unique<Work>(); });
  draw(tile, *work);
  for (std::size_t i = 0; i < work->pixels.size(); ++i) {
    const glm::vec4& in_front = pixels[i];
    work->pixels[i] = in_front + work->pixels[i] * (1.0f - in_front.a);
  }
  canvas_.write(tile, work->pixels, background);
}

void EnvironmentCanvas::write_tinted(const TileRectangle& tile, const abuffer_detail::PaintedPixels& pixels,
                                     const glm::vec4& background) {
  const auto work = works_.borrow([] { return std::make_unique<Work>(); });
  draw(tile, *work);
  for (std::size_t i = 0; i < work->pixels.size(); ++i) {
    const glm::vec3 behind(work->pixels[i]);
    work->pixels[i] = glm::vec4(glm::vec3(pixels.colors[i]) + behind * (1.0f - pixels.alphas[i]), 1.0f);
  }
  canvas_.write(tile, work->pixels, background);
}

void EnvironmentCanvas::fill(const TileRectangle& tile, const glm::vec4& value) {
  const auto work = works_.borrow([] { return std::make_unique<Work>(); });
  draw(tile, *work);
  canvas_.write(tile, work->pixels, value);
}

}  // namespace frontmost::shading
