// SPDX-License-Identifier: Apache-2.0
// A view prepared for gathering and for visits tile by tile, and the opacities that materials give to primitives.
//
// Opacities come from materials, before any texture. A material that can be seen through may be opaque where its
// texture says so, but nothing may be left out because of that. Most scenes have one opacity for all primitives, and
// then no number is kept for any primitive.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "abuffer/gather/gather_kernel.h"
#include "abuffer/plan/crowd.h"
#include "frontmost/abuffer.h"

namespace frontmost::abuffer_detail {

/// How much each primitive hides of the background.
class Opacities {
 public:
  Opacities(const Surfaces& surfaces, float opacity, const Execution& execution);

  [[nodiscard]] float of(PrimitiveId id) const { return values_.empty() ? all_ : std::abs(values_[id]); }
  /// The least opacity of the primitive, whatever its texture says.
  [[nodiscard]] float least(PrimitiveId id) const { return std::max(values_.empty() ? all_ : values_[id], 0.0f); }
  /// Whether nothing is seen through the primitive, whatever its texture says.
  [[nodiscard]] bool is_opaque(PrimitiveId id) const { return (values_.empty() ? all_ : values_[id]) >= 1.0f; }

 private:
  float all_;
  std::vector<float> values_;  // empty: all have all_. Negative: opacity 1, but a texture may cut holes
};

/// A rule that keeps, of coincident triangles, those up to the first opaque one. Refers to the opacities.
[[nodiscard]] inline CopyRule copy_rule(const Opacities& opacities) {
  return {[&opacities](PrimitiveId id) { return opacities.is_opaque(id); }};
}

class PreparedFrame {
 public:
  /// \throws Error for a view or options out of range.
  PreparedFrame(const Surfaces& surfaces, const View& view, const AbufferOptions& options, const Execution& execution);

  [[nodiscard]] const SamplePattern& pattern() const { return pattern_; }

  /// Takes a rectangle of the picture and its fragments; null if nothing is seen.
  using Visit = std::function<void(const Rectangle& pixels, GatherScratch* fragments)>;
  /// Whether a tile is to be skipped; null: no tile is.
  using LeaveOut = std::function<bool(const Rectangle& tile)>;
  /// Calls `visit` for rectangles that make up the picture, in any order, from several threads at once: tiles that are
  /// not left out, and, to bound memory, parts of tiles with too many fragments. `copies` says what may be left out of
  /// such tiles. Fragments are in the order of arrival, and holes count as covered.
  void visit_tiles(const CopyRule& copies, const Visit& visit, const LeaveOut& leave_out,
                   const Execution& execution) const;
  /// visit_tiles() with fragments in sorted lists, without their holes.
  void visit_lists(const CopyRule& copies, const Visit& visit, const LeaveOut& leave_out,
                   const Execution& execution) const;

 private:
  SamplePattern pattern_;
  FragmentPlan plan_;
};

}  // namespace frontmost::abuffer_detail
