// SPDX-License-Identifier: Apache-2.0
#include "abuffer/fragment_lists.h"

namespace frontmost::abuffer_detail {
namespace {

class Lister {
 public:
  Lister(const FrameInput& frame, TileScratch& scratch, const Opacities& opacities, JobLists& lists)
      : frame_(frame), s_(scratch), opacities_(opacities), lists_(lists) {}

  void add_pixel(int x, int y) {
    const std::uint32_t pixel = pixel_number(std::uint32_t(x), std::uint32_t(y));
    const std::size_t group = pixel / kGroup, length = s_.length(group);
    const std::uint64_t* words = s_.slot(group, 0) + pixel % kGroup;
    const float hidden = hidden_behind(words, length);
    for (std::size_t i = 0; i < length && words[i * kGroup] != 0; ++i) {
      const std::uint32_t number = ~std::uint32_t(words[i * kGroup]);
      if (s_.nearest_of(number) < hidden) continue;
      add(number);
      // At a single sample there is no part of a pixel: what comes first hides the rest.
      if (frame_.pattern.count == 1 && opacities_.is_opaque(id_of(number))) break;
    }
  }

 private:
  [[nodiscard]] PrimitiveId id_of(std::uint32_t number) const { return s_.triangles.id[s_.arrived.triangle[number]]; }

  /// The key behind which nothing is seen anywhere in the pixel.
  [[nodiscard]] float hidden_behind(const std::uint64_t* words, std::size_t length) const {
    float key = -1;
    if (frame_.pattern.count == 1) return key;
    for (std::size_t i = 0; i < length && words[i * kGroup] != 0; ++i) {
      const std::uint32_t number = ~std::uint32_t(words[i * kGroup]);
      if (s_.arrived.mask(number) == frame_.pattern.full() && opacities_.is_opaque(id_of(number)))
        key = std::max(key, s_.farthest_of(number));
    }
    return key;
  }

  void add(std::uint32_t number) {
    const std::size_t t = s_.arrived.triangle[number];
    Fragment f;
    f.mask = s_.arrived.mask(number);
    f.primitive = s_.triangles.id[t];
    f.key = s_.arrived.key_of(number);
    f.key_dx = s_.triangles.gx[t] * kSubPixels;
    f.key_dy = s_.triangles.gy[t] * kSubPixels;
    f.opacity = opacities_.of(f.primitive);
    lists_.fragments.push_back(f);
    lists_.numbers.push_back(number);
  }

  const FrameInput& frame_;
  TileScratch& s_;
  const Opacities& opacities_;
  JobLists& lists_;
};

}  // namespace

JobLists list_fragments(const FrameInput& frame, const TileJob& job, TileScratch& scratch, const Opacities& opacities) {
  JobLists lists;
  lists.scratch = &scratch;
  lists.fragments.reserve(scratch.arrived.count);
  lists.numbers.reserve(scratch.arrived.count);
  lists.begin.push_back(0);
  Lister lister(frame, scratch, opacities, lists);
  for (int y = 0; y < job.pixels.height; ++y)
    for (int x = 0; x < job.pixels.width; ++x) {
      lister.add_pixel(x, y);
      lists.begin.push_back(std::uint32_t(lists.fragments.size()));
    }
  return lists;
}

}  // namespace frontmost::abuffer_detail
