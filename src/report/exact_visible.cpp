// SPDX-License-Identifier: Apache-2.0
// The nearest triangle at every sample, exactly: bounds in doubles decide nearly everywhere, expansions the rest.
#include <algorithm>

#include "base/float_environment.h"
#include "frontmost/precision.h"
#include "report/exact_depth.h"
#include "zbuffer/submission.h"

namespace frontmost {
namespace {

using namespace zbuffer_detail;

/// The planes being filled, and per sample the bounds of the nearest so far.
struct Field {
  const Surfaces& surfaces;
  const SampleRays rays;
  std::span<const glm::ivec2> samples;
  ExactVisible& answer;
  Buffer<DepthBounds> bounds;
};

class Contest {
 public:
  Contest(Field& field, const PixelRect& tile) : field_(field), tile_(tile) {}

  void enter(const TriangleRecord& r) {
    const View& view = field_.answer.view;
    const PixelRect touched = pixel_rect(r, view.width, view.height);
    const PixelRect rect{std::max(touched.x0, tile_.x0), std::max(touched.y0, tile_.y0), std::min(touched.x1, tile_.x1),
                         std::min(touched.y1, tile_.y1)};
    if (rect.x1 < rect.x0 || rect.y1 < rect.y0) return;
    const BoundedPlane plane(field_.surfaces.corners(r.id), field_.rays);
    for (std::size_t s = 0; s < field_.samples.size(); ++s) enter(r, plane, rect, s);
  }

 private:
  void enter(const TriangleRecord& r, const BoundedPlane& plane, const PixelRect& rect, std::size_t sample) {
    const glm::ivec2 offset = field_.samples[sample];
    std::int64_t row[3], step_x[3], step_y[3];
    for (int k = 0; k < 3; ++k) {
      const int n = k == 2 ? 0 : k + 1;
      const std::int64_t dx = r.x[n] - r.x[k], dy = r.y[n] - r.y[k];
      const bool is_top_left = dy < 0 || (dy == 0 && dx > 0);
      row[k] = dx * (rect.y0 * kSubPixels + offset.y - r.y[k]) - dy * (rect.x0 * kSubPixels + offset.x - r.x[k]) -
               (is_top_left ? 0 : 1);
      step_x[k] = -dy * kSubPixels;
      step_y[k] = dx * kSubPixels;
    }
    for (int y = rect.y0; y <= rect.y1; ++y) {
      std::int64_t e[3] = {row[0], row[1], row[2]};
      for (int x = rect.x0; x <= rect.x1; ++x) {
        if ((e[0] | e[1] | e[2]) >= 0) fragment(x, y, sample, r.id, plane);
        for (int k = 0; k < 3; ++k) e[k] += step_x[k];
      }
      for (int k = 0; k < 3; ++k) row[k] += step_y[k];
    }
  }

  void fragment(int x, int y, std::size_t sample, PrimitiveId id, const BoundedPlane& plane) {
    ExactVisible& answer = field_.answer;
    const SampleRay ray = field_.rays.at(x, y, field_.samples[sample]);
    const DepthBounds bounds = plane.at(ray);
    const std::size_t i =
        (sample * std::size_t(answer.view.height) + std::size_t(y)) * std::size_t(answer.view.width) + std::size_t(x);
    DepthBounds& best = field_.bounds[i];
    const bool first = answer.primitives[i] == no_primitive;
    if (!first && bounds.low > best.high) return;
    const int order = first || bounds.high < best.low ? -1 : compare_exactly(id, answer.primitives[i], ray);
    if (order > 0) return;
    if (order == 0) {
      answer.tied[i] = 1;
      return;  // ids come in order
    }
    answer.primitives[i] = id;
    answer.tied[i] = 0;
    best = bounds;
  }

  [[nodiscard]] int compare_exactly(PrimitiveId a, PrimitiveId b, const SampleRay& ray) const {
    return compare(ExactDepth(field_.surfaces.corners(a), field_.rays, ray),
                   ExactDepth(field_.surfaces.corners(b), field_.rays, ray));
  }

  Field& field_;
  PixelRect tile_;
};

}  // namespace

ExactVisible exact_visible(const Surfaces& surfaces, const View& view, const Execution& execution) {
  validate(view);
  const IeeeScope ieee;
  const std::size_t count = view.sample_count();
  ExactVisible answer{view, Buffer<PrimitiveId>(count, no_primitive), Buffer<std::uint8_t>(count, 0)};
  Field field{surfaces, SampleRays(view), sample_offsets(view.samples), answer, Buffer<DepthBounds>(count)};
  const TileGrid grid(view);
  submit(surfaces, view, {0, surfaces.primitive_count()}, execution, [&](std::size_t tile, const PlacedPiece& piece) {
    Contest contest(field, grid.rect(tile));
    for (const std::uint32_t item : piece.in_tile(tile)) contest.enter(piece.triangles.record(item));
  });
  return answer;
}

}  // namespace frontmost
