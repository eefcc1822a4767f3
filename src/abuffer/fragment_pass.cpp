// SPDX-License-Identifier: Apache-2.0
// One frame gone through several times: first to learn what is seen, then to paint it.

#include "abuffer/fragment_pass.h"

#include "abuffer/composite/composite_kernel.h"
#include "abuffer/visit_tiles.h"
#include "base/float_environment.h"

namespace frontmost::abuffer_detail {

namespace {

/// Far below what rounding leaves of a sum of floats.
constexpr float kNegligible = 0x1p-40f;

/// What composite_tile() writes of one rectangle.
class TilePicture {
 public:
  explicit TilePicture(const Rectangle& pixels)
      : rectangle_(pixels), size_(std::size_t(pixels.width) * std::size_t(pixels.height)), values_(4 * size_) {}

  [[nodiscard]] PicturePlanes planes() {
    float* const plane = values_.data();
    return {plane, plane + size_, plane + 2 * size_, plane + 3 * size_, rectangle_.width, rectangle_.x, rectangle_.y};
  }
  [[nodiscard]] std::vector<glm::vec4> pixels() const {
    std::vector<glm::vec4> result(size_);
    for (std::size_t i = 0; i < size_; ++i)
      for (int k = 0; k < 4; ++k) result[i][k] = values_[std::size_t(k) * size_ + i];
    return result;
  }

 private:
  Rectangle rectangle_;
  std::size_t size_;
  std::vector<float> values_;
};

}  // namespace

FragmentPass::FragmentPass(const Surfaces& surfaces, const View& view, const AbufferOptions& options,
                           const Execution& execution)
    : opacity_(options.opacity),
      prepared_(surfaces, view, options, execution),
      opacities_(surfaces, options.opacity, execution),
      copies_(copy_rule(opacities_)) {}

void FragmentPass::list_primitives(const Note& note, const Execution& execution) const {
  const IeeeScope ieee;
  const GatherInput frame = prepared_.input(copies_, execution);
  visit_tiles(frame, execution, [&](const GatherJob& /*job*/, GatherScratch* scratch) {
    if (scratch) note({scratch->triangles.id.data(), scratch->triangles.count});
  });
}

void FragmentPass::look(const Look& look, const Execution& execution) const {
  const IeeeScope ieee;
  const GatherInput frame = prepared_.input(copies_, execution);
  visit_tiles(frame, execution, [&](const GatherJob& job, GatherScratch* scratch) {
    if (scratch) look(job.pixels, list_fragments(frame, job, *scratch, opacities_));
  });
}

void FragmentPass::paint(const Paint& paint, const Receive& receive, const Execution& execution) const {
  const IeeeScope ieee;
  const GatherInput frame = prepared_.input(copies_, execution);
  visit_tiles(frame, execution, [&](const GatherJob& job, GatherScratch* scratch) {
    if (!scratch) return receive(job.pixels, nullptr);
    const JobLists lists = list_fragments(frame, job, *scratch, opacities_, kNegligible);
    // By number of arrival, as the compositor looks them up; fragments that were left out of the lists stay without
    // effect.
    std::vector<glm::vec4> colors(scratch->arrived.count, glm::vec4(0));
    paint(job.pixels, lists, colors);
    TilePicture picture(job.pixels);
    composite_tile(frame, job, *scratch, {colors.data(), true, opacity_}, picture.planes());
    const std::vector<glm::vec4> pixels = picture.pixels();
    receive(job.pixels, &pixels);
  });
}

}  // namespace frontmost::abuffer_detail
