// SPDX-License-Identifier: Apache-2.0
// Where two faces are at risk, and how much of that is seen.
//
// Keys are affine over the screen, and so is their difference, and what the format and rounding need to tell them
// apart. So where the difference is less than that is a strip between two straight lines:
//
//      \  first is surely shown  \//////\  second is surely shown
//       \    where it is nearer   \/////\\    where it is nearer
#pragma once

#include <utility>

#include "frontmost/precision.h"
#include "report/fights/convex_area.h"
#include "report/fights/screen_faces.h"

namespace frontmost {

/// Finds areas one after another, in memory that is kept.
class RiskFinder {
 public:
  RiskFinder(const View& view, const DepthSetup& setup);

  /// Where both faces are, and neither is surely shown; empty where there is no such place. Stays until the next call.
  [[nodiscard]] const ConvexArea& of_pair(const ScreenFace& a, const ScreenFace& b);
  /// Where a face may be stored as what the buffer was cleared to.
  [[nodiscard]] const ConvexArea& of_clear_value(const ScreenFace& face);
  /// False where that area is empty for certain.
  [[nodiscard]] bool may_be_clear_value(const ScreenFace& face) const { return double(face.low) <= farthest_key_; }

 private:
  void cut_by_frame();

  glm::dvec2 size_;
  KeyStep step_;
  double farthest_key_;
  ConvexArea area_;
};

/// One of two faces that are at risk, or the only one.
struct RiskKeys {
  KeyOverScreen first, second;
  double reach;  ///< what is seen may be so much nearer, and they are still at risk

  RiskKeys(const ScreenFace& a, const ScreenFace& b, const KeyStep& step);
  [[nodiscard]] double nearest_at(const glm::dvec2& point) const { return std::max(first.at(point), second.at(point)); }
};

/// Tells which share of one area after another is seen, by samples. One thread's.
class VisibleShares {
 public:
  /// For so many areas: of each it looks at about 4,096 samples, or at fewer, 64 at least, where that would be more
  /// than 2^28 of all.
  VisibleShares(const Visible& visible, std::size_t areas);

  /// By the samples in the area; where there is none, by those of the pixel at its centre. 0 only where no sample is
  /// seen, and then it looks at all of them.
  [[nodiscard]] double of(const ConvexArea& area, const RiskKeys& keys);
  /// How many samples it has looked at since the last call.
  [[nodiscard]] std::uint64_t take_looks() { return std::exchange(looks_, 0); }

 private:
  const Visible& visible_;
  double asked_;
  std::uint64_t looks_ = 0;
};

}  // namespace frontmost
