// SPDX-License-Identifier: Apache-2.0
// Frames with more fragments than a tile holds: invisible copies are left out, and frames that would take hours are
// refused.
//
// A thinned plan is needed only if a tile holds too many fragments. The first thread that needs it makes it once, and
// other threads wait for it.
#pragma once

#include <exception>
#include <functional>
#include <mutex>
#include <optional>

#include "abuffer/plan/frame_plan.h"

namespace frontmost::abuffer_detail {

/// The number of copies to keep among triangles with the same vertices on the screen. At every sample their order is
/// that of the ids.
struct CopyRule {
  /// Whether nothing is seen through the primitive anywhere, so that it hides copies of higher ids. Empty: true of
  /// none.
  std::function<bool(PrimitiveId)> is_opaque;
  std::size_t most = std::size_t(-1);  ///< never keep more than these, opaque or not
};

/// The most fragments that a function goes through, as `most_fragments` says.
[[nodiscard]] std::uint64_t most_gathered_fragments(const View& view, std::uint64_t triangles);

/// A frame with a tile that holds too many fragments.
class CrowdedFrame {
 public:
  CrowdedFrame(const FragmentPlan& plan, const CopyRule& rule) : plan_(plan), rule_(rule) {}

  /// The plan without invisible copies, which may be the plan itself. It is made at the first call, so frames without
  /// such tiles pay nothing. May be called by several threads at once. O(n log n) for n triangles of the frame. \throws
  /// Error limit_exceeded for more fragments than most_gathered_fragments().
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
