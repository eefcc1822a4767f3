// SPDX-License-Identifier: Apache-2.0
// The area in which two faces are at risk, and how much of it is seen.
//
// Keys are affine over the screen; so are the difference of two keys, and the difference that format and rounding need
// to tell them apart. The difference is too small in a strip between two straight lines:
//
//      \  first is surely shown  \//////\  second is surely shown
//       \    where it is nearer   \/////\\    where it is nearer
#pragma once

#include <utility>

#include "frontmost/precision.h"
#include "report/fights/convex_area.h"
#include "report/fights/screen_faces.h"

namespace frontmost {

/// Finds one area after another and reuses its memory.
class RiskFinder {
 public:
  RiskFinder(const View& view, const DepthSetup& setup);

  /// The area where both faces are and neither is surely shown; may be empty. Valid until the next call.
  [[nodiscard]] const ConvexArea& of_pair(const ScreenFace& a, const ScreenFace& b);
  /// The area where a face may be stored as the clear value.
  [[nodiscard]] const ConvexArea& of_clear_value(const ScreenFace& face);
  /// False if that area is certainly empty.
  [[nodiscard]] bool may_be_clear_value(const ScreenFace& face) const { return double(face.low) <= farthest_key_; }

 private:
  void cut_by_frame();

  glm::dvec2 size_;
  KeyStep step_;
  double farthest_key_;
  ConvexArea area_;
};

/// The keys of two faces that are at risk, or of one face alone.
struct RiskKeys {
  KeyOverScreen first, second;
  double reach;  ///< the seen surface may be nearer by this much while they are still at risk

  RiskKeys(const ScreenFace& a, const ScreenFace& b, const KeyStep& step);
  [[nodiscard]] double nearest_at(const glm::dvec2& point) const { return std::max(first.at(point), second.at(point)); }
};

/// Estimates from samples the visible share of one area after another. For one thread.
class VisibleShares {
 public:
  /// `areas` is the number of areas. About 4,096 samples of each are examined, or fewer (at least 64) if all areas
  /// together would take more than 2^28.
  VisibleShares(const Visible& visible, std::size_t areas);

  /// The visible share, by the samples in the area, or, if there are none, by those of the pixel at its centre. 0 only
  /// if no sample is seen, which takes all samples of the area.
  [[nodiscard]] double of(const ConvexArea& area, const RiskKeys& keys);
  /// Number of samples examined since the last call.
  [[nodiscard]] std::uint64_t take_looks() { return std::exchange(looks_, 0); }

 private:
  const Visible& visible_;
  double asked_;
  std::uint64_t looks_ = 0;
};

}  // namespace frontmost
