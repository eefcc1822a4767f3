// SPDX-License-Identifier: Apache-2.0
// All lists of a view as one block of data, and their counts.
//
// Tiles finish in any order, and the lengths of their lists are not known before. So the lists of each tile are kept as
// they are made. The running sum of their lengths then gives the beginnings of all pixels' lists, and all threads copy
// the parts to their places.

#include "frontmost/abuffer.h"

#include <algorithm>
#include <mutex>

#include "abuffer/fragment_pass.h"
#include "abuffer/tile_parts.h"

namespace frontmost {

FragmentLists abuffer(const Surfaces& surfaces, const View& view, const AbufferOptions& options,
                      const Execution& execution) {
  using namespace abuffer_detail;
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
  using namespace abuffer_detail;
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

}  // namespace frontmost
