// SPDX-License-Identifier: Apache-2.0
// Frames with more fragments than a tile holds: what is there again is left out, and what would take hours is refused.
//
// This is asked for only when a tile holds more than there is room for. Then it is made once, by the first thread that
// needs it, and others wait for it.
#pragma once

#include <exception>
#include <functional>
#include <mutex>
#include <optional>

#include "abuffer/plan/frame_plan.h"

namespace frontmost::abuffer_detail {

/// How many are wanted of triangles with the same corners on the screen. At every sample their order is that of the
/// ids.
struct CopyRule {
  /// Nothing is seen through it anywhere, so that copies of higher ids are hidden by it; none: of no triangle.
  std::function<bool(PrimitiveId)> is_opaque;
  std::size_t most = std::size_t(-1);  ///< never more than these, opaque or not
};

/// How many fragments a function goes through at most, as `most_fragments` says.
[[nodiscard]] std::uint64_t most_gathered_fragments(const View& view, std::uint64_t triangles);

/// A frame some tile of which holds too much.
class CrowdedFrame {
 public:
  CrowdedFrame(const FragmentPlan& plan, const CopyRule& rule) : plan_(plan), rule_(rule) {}

  /// The plan without copies that nobody sees, which may be the plan itself; made at the first call, so that frames
  /// without such tiles pay nothing. May be called by several threads at once. O(n log n) for n triangles of the frame.
  /// \throws Error limit_exceeded for more fragments than most_gathered_fragments().
  const FragmentPlan& thinned();

 private:
  void make();

  const FragmentPlan& plan_;
  const CopyRule& rule_;
  std::mutex mutex_;
  const FragmentPlan* thinned_ = nullptr;
  std::optional<FragmentPlan> made_;
  std::exception_ptr error_;
};

}  // namespace frontmost::abuffer_detail
