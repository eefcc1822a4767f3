// SPDX-License-Identifier: Apache-2.0
// Triangles in the order of a space-filling curve, under a tree of boxes sixteen wide.
//
// Each group of sixteen triangles is compared with itself and with all later groups whose boxes touch its own, so every
// pair of groups meets once. The walk through the tree and the comparison of two groups take sixteen boxes or triangles
// at a time.
//
//            level 2        [ 16 boxes ]
//                           /     |    .
//            level 1   [16 boxes] ...  [16 boxes]
//                       /    .
//            level 0  [16]  [16] ...                 one box for a group of sixteen triangles
#pragma once

#include <algorithm>
#include <bit>
#include <vector>

#include "lines/crossings/space_lanes.h"
#include "lines/mesh/feature_edges.h"

namespace frontmost::lines_detail {

class BoxTree {
 public:
  /// O(triangles). Triangles of similar size are grouped, so that large ones do not widen the boxes of small ones.
  /// Twins (Features::twins) are left out.
  BoxTree(const WeldedMesh& mesh, const Features& features, const Execution& execution);

  /// The number of groups of up to sixteen triangles.
  [[nodiscard]] std::size_t group_count() const { return triangles_.numbers.size() / kSpaceLanes; }

  /// Calls visit(a, b) for every pair that SpaceKernels::crossing leaves open, with one triangle of this group and the
  /// other of this group or a later one. Each pair is visited once.
  template <class Visitor>
  void visit_pairs(std::size_t group, const Visitor& visit) const {
    const std::size_t begin = group * kSpaceLanes;
    SpaceProbes probes;
    kernels_.set_probes(triangles_, begin, probes);
    visit_groups(group, [&](std::size_t other, const Box& other_box) {
      const std::size_t first = other * kSpaceLanes;
      SpaceMasks masks;
      std::uint32_t found = kernels_.crossing(triangles_, first, other_box, probes, masks);
      for (; found != 0; found &= found - 1) {
        const auto i = std::size_t(std::countr_zero(found));
        if (begin + i >= triangles_.count) break;
        std::uint32_t bits = masks[i];
        if (other == group) bits &= 0xFFFEu << i;
        for (; bits != 0; bits &= bits - 1) {
          const std::size_t j = first + std::size_t(std::countr_zero(bits));
          if (j < triangles_.count) visit(triangles_.numbers[begin + i], triangles_.numbers[j]);
        }
      }
    });
  }

 private:
  /// Calls visit(other, its box) for every group from `group` on whose box touches that of `group`.
  template <class Visitor>
  void visit_groups(std::size_t group, const Visitor& visit) const {
    const Box box = levels_[0].get(group);
    struct Step {
      std::size_t level, group;
    };
    Step open[kSpaceLanes * kMostLevels];
    std::size_t count = 0;
    open[count++] = {levels_.size() - 1, 0};
    while (count > 0) {
      const Step step = open[--count];
      const std::size_t first = step.group * kSpaceLanes;
      for (std::uint32_t bits = kernels_.touching(levels_[step.level], first, box); bits != 0; bits &= bits - 1) {
        const std::size_t child = first + std::size_t(std::countr_zero(bits));
        if (step.level > 0)
          open[count++] = {step.level - 1, child};
        else if (child >= group)
          visit(child, levels_[0].get(child));
      }
    }
  }

  static constexpr std::size_t kMostLevels = 9;  ///< 16^8 is more than there are numbers for triangles
  SpaceKernels kernels_;
  SpaceTriangles triangles_;
  std::vector<SpaceBoxes> levels_;  ///< boxes of groups of sixteen triangles, then of groups of such groups; the last
                                    ///< level is one group
};

}  // namespace frontmost::lines_detail
