// SPDX-License-Identifier: Apache-2.0
// The z-buffer: plan the frame, then draw its tiles on all threads.

#include "frontmost/zbuffer.h"

#include <atomic>
#include <memory>
#include <mutex>
#include <vector>

#include "base/float_environment.h"
#include "base/parallel.h"
#include "zbuffer/frame_plan.h"

namespace frontmost {
namespace {

using namespace zbuffer_detail;

/// Lends a scratch to whoever draws a tile, and keeps it for the next.
class ScratchPool {
 public:
  explicit ScratchPool(std::size_t sample_count) : sample_count_(sample_count) {}

  std::unique_ptr<TileScratch> take() {
    {
      const std::lock_guard lock(mutex_);
      if (!free_.empty()) {
        std::unique_ptr<TileScratch> scratch = std::move(free_.back());
        free_.pop_back();
        return scratch;
      }
    }
    return std::make_unique<TileScratch>(sample_count_);
  }
  void give_back(std::unique_ptr<TileScratch> scratch) {
    const std::lock_guard lock(mutex_);
    free_.push_back(std::move(scratch));
  }

 private:
  std::size_t sample_count_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<TileScratch>> free_;
};

}  // namespace

Visible zbuffer(const Surfaces& surfaces, const View& view, const Execution& execution) {
  validate(view);
  const IeeeScope ieee;
  const ClusterSet& set = surfaces.clusters();
  const ScreenTransform transform(view);
  const FramePlan plan = plan_frame(set, transform, view, execution);

  Visible visible{view, Buffer<PrimitiveId>(view.sample_count()), Buffer<float>(view.sample_count())};
  // Measured on planes that are touched for the first time: at 16 MiB streaming costs 20 %, at 66 MiB it saves 15 %.
  constexpr std::size_t kStreamFrom = std::size_t(32) << 20;
  const bool streams = view.sample_count() * (sizeof(PrimitiveId) + sizeof(float)) >= kStreamFrom;
  const FrameInput frame{set,
                         transform,
                         view,
                         plan.culled,
                         plan.records,
                         sample_offsets(view.samples),
                         visible.primitives.data(),
                         visible.keys.data(),
                         streams};
  ScratchPool pool(frame.samples.size());
  std::atomic<std::size_t> drawn{0};
  for (const TileRange& round : plan.rounds) {
    const TileLists record_lists = plan.record_lists(round, view);
    parallel_for(execution, round.end - round.begin, 1, [&](std::size_t begin, std::size_t end) {
      std::unique_ptr<TileScratch> scratch = pool.take();
      for (std::size_t i = begin; i < end; ++i)
        draw_tile(frame, plan.job(round.begin + i, view, record_lists), *scratch, execution.isa);
      pool.give_back(std::move(scratch));
      report_progress(execution, "visible", double(drawn += end - begin) / double(plan.tile_count()));
    });
  }
  return visible;
}

}  // namespace frontmost
