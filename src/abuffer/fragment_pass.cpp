// SPDX-License-Identifier: Apache-2.0
#include "abuffer/fragment_pass.h"

#include "abuffer/composite_kernel.h"
#include "abuffer/visit_tiles.h"
#include "base/float_environment.h"

namespace frontmost::abuffer_detail {

FragmentPass::FragmentPass(const Surfaces& surfaces, const View& view, const AbufferOptions& options,
                           const Execution& execution)
    : opacity_(options.opacity),
      pattern_((validate(options), sample_pattern(view, options.grid))),
      plan_(surfaces, view, execution),
      opacities_(surfaces, options.opacity, execution) {}

void FragmentPass::look(const Look& look, const Execution& execution) const {
  const IeeeScope ieee;
  const FrameInput frame{plan_, pattern_, false, execution.isa};
  visit_tiles(frame, execution, [&](const TileJob& job, TileScratch* scratch) {
    if (scratch) look(job.pixels, list_fragments(frame, job, *scratch, opacities_));
  });
}

ResolvedPicture FragmentPass::paint(const Paint& paint, const Execution& execution) const {
  const IeeeScope ieee;
  const View& view = plan_.view();
  const std::size_t pixels = view.pixel_count();
  ResolvedPicture picture{view.width,
                          view.height,
                          Buffer<float>(pixels, 0.0f),
                          Buffer<float>(pixels, 0.0f),
                          Buffer<float>(pixels, 0.0f),
                          Buffer<float>(pixels, 0.0f)};
  const PicturePlanes out{picture.red.data(), picture.green.data(), picture.blue.data(), picture.alpha.data(),
                          view.width};
  const FrameInput frame{plan_, pattern_, false, execution.isa};
  visit_tiles(frame, execution, [&](const TileJob& job, TileScratch* scratch) {
    if (!scratch) return;
    const JobLists lists = list_fragments(frame, job, *scratch, opacities_);
    std::vector<glm::vec4> colors(scratch->arrived.count, glm::vec4(0));
    paint(job.pixels, lists, colors);
    composite_tile(frame, job, *scratch, {colors.data(), true, opacity_}, out);
  });
  return picture;
}

}  // namespace frontmost::abuffer_detail
