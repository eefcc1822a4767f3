// SPDX-License-Identifier: Apache-2.0
// A view made ready for gathering, and gone through tile by tile; what materials say of primitives.
//
// Opacities are those of materials, before any texture: what can be seen through may be opaque where its texture says
// so, but nothing may be left out because of it. Most scenes have one opacity for all, and then no number is kept for
// any primitive.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "abuffer/gather/gather_kernel.h"
#include "abuffer/plan/crowd.h"
#include "frontmost/abuffer.h"

namespace frontmost::abuffer_detail {

/// By primitive, how far it hides what is behind.
class Opacities {
 public:
  Opacities(const Surfaces& surfaces, float opacity, const Execution& execution);

  [[nodiscard]] float of(PrimitiveId id) const { return values_.empty() ? all_ : std::abs(values_[id]); }
  /// What it hides at least, whatever its texture says.
  [[nodiscard]] float least(PrimitiveId id) const { return std::max(values_.empty() ? all_ : values_[id], 0.0f); }
  /// Nothing is seen through it, whatever its texture says.
  [[nodiscard]] bool is_opaque(PrimitiveId id) const { return (values_.empty() ? all_ : values_[id]) >= 1.0f; }

 private:
  float all_;
  std::vector<float> values_;  // none: all the same. Negative: 1, but a texture may cut holes into it
};

/// Of triangles at one place those in front of an opaque one, and it. As long as the opacities are where they are.
[[nodiscard]] inline CopyRule copy_rule(const Opacities& opacities) {
  return {[&opacities](PrimitiveId id) { return opacities.is_opaque(id); }};
}

class PreparedFrame {
 public:
  /// \throws Error for a view or options out of range.
  PreparedFrame(const Surfaces& surfaces, const View& view, const AbufferOptions& options, const Execution& execution);

  [[nodiscard]] const SamplePattern& pattern() const { return pattern_; }

  /// Takes a rectangle of the picture and its fragments; null where nothing is seen.
  using Visit = std::function<void(const Rectangle& pixels, GatherScratch* fragments)>;
  /// Whether a tile is not to be visited; null: all are.
  using LeaveOut = std::function<bool(const Rectangle& tile)>;
  /// Calls `visit` for rectangles that make up the picture, in any order, from several threads at once. They are the
  /// tiles that are not left out, and parts of those that have too many fragments: this is what bounds memory. `copies`
  /// says what may be left out of such tiles. Fragments are in the order of arrival, and holes count as covered.
  void visit_tiles(const CopyRule& copies, const Visit& visit, const LeaveOut& leave_out,
                   const Execution& execution) const;
  /// The same with fragments in sorted lists, without their holes.
  void visit_lists(const CopyRule& copies, const Visit& visit, const LeaveOut& leave_out,
                   const Execution& execution) const;

 private:
  SamplePattern pattern_;
  FragmentPlan plan_;
};

}  // namespace frontmost::abuffer_detail
