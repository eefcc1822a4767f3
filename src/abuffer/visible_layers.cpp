// SPDX-License-Identifier: Apache-2.0
// Layers: at every sample the nearest primitive, the second, and so on.

#include <algorithm>

#include "abuffer/prepared_frame.h"
#include "abuffer/visit_tiles.h"
#include "base/float_environment.h"

namespace frontmost {
namespace {

using namespace abuffer_detail;

struct SeenSample {
  float key;
  PrimitiveId id;
};

/// What one sample of a pixel sees, nearest first.
class SampleLists {
 public:
  /// `most`: how many are wanted.
  SampleLists(const GatherInput& frame, GatherScratch& scratch, std::size_t most)
      : frame_(frame), s_(scratch), most_(most) {}

  const std::vector<SeenSample>& at(int x, int y, std::size_t sample) {
    const std::uint32_t pixel = pixel_number(std::uint32_t(x), std::uint32_t(y));
    const std::size_t group = pixel / kGroup, length = s_.length(group);
    const std::uint64_t* words = s_.slot(group, 0) + pixel % kGroup;
    const std::int32_t sx = x * kSubPixels + frame_.pattern.x[sample] * SamplePattern::unit;
    const std::int32_t sy = y * kSubPixels + frame_.pattern.y[sample] * SamplePattern::unit;
    seen_.clear();
    for (std::size_t i = 0; i < length && words[i * kGroup] != 0; ++i) {
      const std::uint32_t number = ~std::uint32_t(words[i * kGroup]);
      if (!(s_.arrived.mask(number) >> sample & 1)) continue;
      const std::size_t t = s_.arrived.triangle[number];
      seen_.push_back({s_.triangles.key_at(t, sx, sy), s_.triangles.id[t]});
      // At a single sample the order is that of the lists.
      if (frame_.pattern.count == 1 && seen_.size() == most_) return seen_;
    }
    // Lists are sorted by the key at one place of the pixel; at other samples triangles that cross there change places.
    if (frame_.pattern.count > 1)
      std::sort(seen_.begin(), seen_.end(),
                [](const SeenSample& a, const SeenSample& b) { return a.key != b.key ? a.key > b.key : a.id < b.id; });
    return seen_;
  }

 private:
  const GatherInput& frame_;
  GatherScratch& s_;
  const std::size_t most_;
  std::vector<SeenSample> seen_;
};

}  // namespace

std::vector<Visible> visible_layers(const Surfaces& surfaces, const View& view, int count,
                                    const AbufferOptions& options, const Execution& execution) {
  if (count < 1 || count > 1024) throw Error(ErrorCode::bad_argument, "abuffer: layers: must be 1 to 1024");
  const IeeeScope ieee;
  // Layers are Visibles, whose samples are the view's; a grid of the A-buffer's own would have no place in them.
  const PreparedFrame prepared(surfaces, view, {0, options.opacity}, execution);
  const Opacities opacities(surfaces, options.opacity, execution);
  CopyRule copies = copy_rule(opacities);
  // Of triangles at one place, those with as many before them everywhere are in no layer.
  copies.most = std::size_t(count);
  const GatherInput frame = prepared.input(copies, execution);
  std::vector<Visible> layers;
  for (int k = 0; k < count; ++k) layers.push_back(nothing_visible(view));
  visit_tiles(frame, execution, [&](const GatherJob& job, GatherScratch* scratch) {
    if (!scratch) return;
    SampleLists lists(frame, *scratch, layers.size());
    for (std::size_t sample = 0; sample < std::size_t(prepared.pattern.count); ++sample)
      for (int y = 0; y < job.pixels.height; ++y)
        for (int x = 0; x < job.pixels.width; ++x) {
          const std::size_t at = layers[0].index(job.pixels.x + x, job.pixels.y + y, int(sample));
          std::size_t k = 0;
          for (const SeenSample& seen : lists.at(x, y, sample)) {
            if (k == layers.size()) break;
            layers[k].primitives[at] = seen.id;
            layers[k++].keys[at] = seen.key;
            // Nothing behind it is a layer: nobody can see it.
            if (opacities.is_opaque(seen.id)) break;
          }
        }
  });
  return layers;
}

}  // namespace frontmost
