// SPDX-License-Identifier: Apache-2.0
// Returns all fragment lists of a view as one block of data, counts fragments, and finds layers: at every sample the
// nearest primitive, the second nearest, and so on.
//
// Tiles finish in any order, and the lengths of their lists are not known beforehand. So the lists of each tile are
// kept as they are made. The running sum of all lengths then gives the beginning of each pixel's list, and all threads
// copy the lists to their places.

#include "frontmost/abuffer.h"

#include <algorithm>
#include <mutex>

#include "abuffer/fragment_pass.h"
#include "abuffer/tile_parts.h"

namespace frontmost {
namespace {

using namespace abuffer_detail;

struct SeenSample {
  float key;
  PrimitiveId id;
};

/// The primitives that one sample of a pixel sees, nearest first.
class SampleLists {
 public:
  /// `most` is the number of layers.
  SampleLists(const SamplePattern& pattern, const GatherScratch& scratch, std::size_t most)
      : pattern_(pattern), s_(scratch), most_(most) {}

  const std::vector<SeenSample>& at(int x, int y, std::size_t sample) {
    const std::uint32_t pixel = pixel_number(std::uint32_t(x), std::uint32_t(y));
    const std::size_t group = pixel / kGroup, length = s_.length(group);
    const std::uint64_t* words = s_.slot(group, 0) + pixel % kGroup;
    const std::int32_t sx = x * kSubPixels + pattern_.x[sample] * SamplePattern::unit;
    const std::int32_t sy = y * kSubPixels + pattern_.y[sample] * SamplePattern::unit;
    seen_.clear();
    for (std::size_t i = 0; i < length && words[i * kGroup] != 0; ++i) {
      const std::uint32_t number = ~std::uint32_t(words[i * kGroup]);
      if (!(s_.arrived.mask(number) >> sample & 1)) continue;
      const std::size_t t = s_.arrived.triangle[number];
      seen_.push_back({s_.triangles.key_at(t, sx, sy), s_.triangles.id[t]});
      // At a single sample the order is that of the lists.
      if (pattern_.count == 1 && seen_.size() == most_) return seen_;
    }
    // Lists are sorted by the key at the pixel's centre. Triangles that cross in the pixel have another order at some
    // samples.
    if (pattern_.count > 1)
      std::sort(seen_.begin(), seen_.end(),
                [](const SeenSample& a, const SeenSample& b) { return a.key != b.key ? a.key > b.key : a.id < b.id; });
    return seen_;
  }

 private:
  const SamplePattern& pattern_;
  const GatherScratch& s_;
  const std::size_t most_;
  std::vector<SeenSample> seen_;
};

}  // namespace

FragmentLists abuffer(const Surfaces& surfaces, const View& view, const AbufferOptions& options,
                      const Execution& execution) {
  const FragmentPass pass(surfaces, view, options, execution);
  TileParts<Fragment> parts(view, most_fragments, "abuffer", "more than 2^30 fragments");
  const auto look = [&](const Rectangle& pixels, PixelLists lists) {
    parts.add({pixels, std::move(lists.begin), std::move(lists.fragments)});
  };
  pass.look(look, execution);
  FragmentLists lists{view, pass.samples(), parts.beginnings(), {}};
  lists.fragments.resize(lists.first[view.pixel_count()]);
  parts.place(
      lists.first, [&](std::uint64_t at, const Fragment& f) { lists.fragments[at] = f; }, execution);
  return lists;
}

FragmentCounts count_fragments(const Surfaces& surfaces, const View& view, const AbufferOptions& options,
                               const Execution& execution) {
  const PreparedFrame frame(surfaces, view, options, execution);
  std::mutex mutex;
  FragmentCounts counts;
  const auto visit = [&](const Rectangle& /*pixels*/, const GatherScratch* fragments) {
    if (!fragments) return;
    const std::uint32_t longest = *std::max_element(fragments->counts.begin(), fragments->counts.end());
    const std::lock_guard lock(mutex);
    counts.fragments += fragments->arrived.count - Arrived::first;
    counts.longest = std::max(counts.longest, longest);
  };
  const CopyRule all;
  frame.visit_tiles(all, visit, nullptr, execution);
  return counts;
}

std::vector<Visible> visible_layers(const Surfaces& surfaces, const View& view, int count,
                                    const AbufferOptions& options, const Execution& execution) {
  if (count < 1 || count > 1024) throw Error(ErrorCode::bad_argument, "abuffer: layers", "must be 1 to 1024");
  // Layers are Visibles, which have the view's samples, so the options' grid is left out.
  const PreparedFrame frame(surfaces, view, {0, options.opacity}, execution);
  const Opacities opacities(surfaces, options.opacity, execution);
  CopyRule copies = copy_rule(opacities);
  // A triangle behind `count` coincident copies is in no layer.
  copies.most = std::size_t(count);
  std::vector<Visible> layers;
  for (int k = 0; k < count; ++k) layers.push_back(nothing_visible(view));
  const auto visit = [&](const Rectangle& pixels, const GatherScratch* fragments) {
    if (!fragments) return;
    SampleLists lists(frame.pattern(), *fragments, layers.size());
    for (std::size_t sample = 0; sample < std::size_t(frame.pattern().count); ++sample)
      for (int y = 0; y < pixels.height; ++y)
        for (int x = 0; x < pixels.width; ++x) {
          const std::size_t at = layers[0].index(pixels.x + x, pixels.y + y, int(sample));
          std::size_t k = 0;
          for (const SeenSample& seen : lists.at(x, y, sample)) {
            if (k == layers.size()) break;
            layers[k].primitives[at] = seen.id;
            layers[k++].keys[at] = seen.key;
            // Nobody sees anything behind an opaque primitive, so no layer follows.
            if (opacities.is_opaque(seen.id)) break;
          }
        }
  };
  frame.visit_lists(copies, visit, nullptr, execution);
  return layers;
}

}  // namespace frontmost
