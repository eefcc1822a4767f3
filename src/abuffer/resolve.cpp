// SPDX-License-Identifier: Apache-2.0
#include "abuffer/composite_kernel.h"
#include "abuffer/options.h"
#include "abuffer/visit_tiles.h"
#include "base/float_environment.h"

namespace frontmost {
namespace {

using namespace abuffer_detail;

// Colours are looked up by 32-bit offsets.
constexpr std::size_t kMostColors = (std::size_t(1) << 29) - 1;

void check_colors(const Surfaces& surfaces, std::span<const glm::vec4> colors) {
  if (colors.size() != surfaces.primitive_count())
    throw Error(ErrorCode::bad_argument, "resolve: colors: " + std::to_string(colors.size()) + " for " +
                                             std::to_string(surfaces.primitive_count()) + " primitives");
  if (colors.size() > kMostColors) throw Error(ErrorCode::limit_exceeded, "resolve: colors: more than 2^29 - 1");
}

void clear(const Rectangle& r, const PicturePlanes& out) {
  for (float* plane : {out.red, out.green, out.blue, out.alpha})
    for (int y = r.y; y < r.y + r.height; ++y)
      std::fill_n(plane + std::size_t(y) * std::size_t(out.width) + std::size_t(r.x), r.width, 0.0f);
}

}  // namespace

ResolvedPicture resolve(const Surfaces& surfaces, const View& view, std::span<const glm::vec4> colors,
                        const AbufferOptions& options, const Execution& execution) {
  validate(view);
  validate(options);
  check_colors(surfaces, colors);
  const IeeeScope ieee;
  const SamplePattern pattern = sample_pattern(view, options.grid);
  const FramePlan plan(surfaces, view, execution);
  const FrameInput frame{plan, pattern, pattern.count == 1, execution.isa};
  const std::size_t pixels = view.pixel_count();
  ResolvedPicture picture{
      view.width,           view.height, Buffer<float>(pixels), Buffer<float>(pixels), Buffer<float>(pixels),
      Buffer<float>(pixels)};
  const PicturePlanes out{picture.red.data(), picture.green.data(), picture.blue.data(), picture.alpha.data(),
                          view.width};
  const FragmentColors paint{colors.data(), false, options.opacity};
  visit_tiles(frame, execution, [&](const TileJob& job, TileScratch* scratch) {
    if (scratch)
      composite_tile(frame, job, *scratch, paint, out);
    else
      clear(job.pixels, out);
  });
  return picture;
}

}  // namespace frontmost
