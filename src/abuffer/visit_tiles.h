// SPDX-License-Identifier: Apache-2.0
// Tile after tile on all threads; tiles with too many fragments in parts. This is what bounds memory.
#pragma once

#include <atomic>

#include "abuffer/gather/cut_fragments.h"
#include "abuffer/plan/crowd.h"
#include "base/parallel.h"
#include "base/pool.h"

namespace frontmost::abuffer_detail {

/// Gathers `job`, and calls visit(job, scratch or null where nothing is seen) unless it is too much. \returns whether
/// it was not.
template <class Visit>
bool visit_whole(const GatherInput& frame, const GatherJob& job, GatherScratch& scratch, const Visit& visit) {
  const Gathered gathered = gather_tile(frame, job, scratch);
  if (gathered == Gathered::too_much) return false;
  if (gathered == Gathered::something && !frame.is_flat) cut_fragments(frame, job, scratch);
  visit(job, gathered == Gathered::something ? &scratch : nullptr);
  return true;
}

/// The same for `job`, or for parts of it.
template <class Visit>
void visit_job(const GatherInput& frame, const GatherJob& job, GatherScratch& scratch, const Visit& visit) {
  if (visit_whole(frame, job, scratch, visit)) return;
  // Parts of whole groups of pixels as long as there are groups.
  const Rectangle& r = job.pixels;
  const auto half = [](int size) { return size > 4 ? (size / 2 + 3) / 4 * 4 : (size + 1) / 2; };
  const int w = half(r.width), h = half(r.height);
  for (int y = 0; y < r.height; y += h)
    for (int x = 0; x < r.width; x += w)
      visit_job(frame, {{r.x + x, r.y + y, std::min(w, r.width - x), std::min(h, r.height - y)}, job.tile}, scratch,
                visit);
}

/// The same for the whole picture, in any order, on all threads. Every pixel is in one job.
template <class Visit>
void visit_tiles(const GatherInput& frame, Pool<GatherScratch>& pool, const Execution& execution, const Visit& visit) {
  std::atomic<std::size_t> done{0};
  const std::size_t tiles = frame.plan.tile_count();
  CrowdedFrame crowded(frame.plan, frame.copies);
  parallel_for(execution, tiles, 1, [&](std::size_t begin, std::size_t end) {
    const auto scratch = pool.borrow([] { return std::make_unique<GatherScratch>(); });
    for (std::size_t tile = begin; tile < end; ++tile) {
      const GatherJob job{frame.plan.tile(tile), tile};
      if (visit_whole(frame, job, *scratch, visit)) continue;
      const FragmentPlan& thinned = crowded.thinned();
      visit_job({thinned, frame.pattern, frame.is_flat, frame.isa, frame.copies, frame.colors}, job, *scratch, visit);
    }
    report_progress(execution, "visible", double(done += end - begin) / double(tiles));
  });
}

template <class Visit>
void visit_tiles(const GatherInput& frame, const Execution& execution, const Visit& visit) {
  Pool<GatherScratch> pool;
  visit_tiles(frame, pool, execution, visit);
}

}  // namespace frontmost::abuffer_detail
