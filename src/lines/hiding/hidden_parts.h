// SPDX-License-Identifier: Apache-2.0
// Where an edge goes out of sight.
#pragma once

#include <deque>

#include "frontmost/lines.h"
#include "lines/hiding/occluder_grid.h"
#include "lines/hiding/shadow_kernel.h"
#include "lines/mesh/feature_edges.h"

namespace frontmost::lines_detail {

/// What edges are held against.
struct Occlusion {
  const WeldedMesh& mesh;
  const Sight& sight;
  const View& view;
  const OccluderGrid& grid;
  const ShadowKernels kernels;
  const bool counts;
  const bool outlines;
};

/// Cuts one edge after another. Not for several threads at once.
class EdgeCutter {
 public:
  explicit EdgeCutter(const Occlusion& occlusion) : o_(occlusion) {}

  /// Appends the parts of `edge`, whose number is `number`, that lie within the view. Its distances need not be set.
  void cut(const SightedEdge& edge, std::uint32_t number, std::vector<DrawnPart>& parts);

 private:
  struct Hidden {
    Interval interval;
    std::uint32_t triangle;
  };
  [[nodiscard]] Interval within_view() const;
  [[nodiscard]] glm::dvec2 on_screen(double t) const;
  [[nodiscard]] Interval part_in(const OccluderGrid::Visit& cell) const;
  struct InCell;
  [[nodiscard]] Interval open_part(Interval part) const;
  void pass_many(const OccluderGrid::Visit& cell);
  bool pass(const OccluderGrid::Visit& cell);
  bool ask(std::uint64_t bits, std::size_t first, const OccluderGrid::Visit& cell);
  bool flush();
  void hide(const Interval& interval, std::uint32_t triangle);
  [[nodiscard]] bool is_hidden(const Interval& part) const;
  [[nodiscard]] std::deque<Hidden>::const_iterator first_to(double t) const;
  void drop_doubles();
  void search(const Interval& span, bool for_cover);
  void split_outline(std::size_t first, std::vector<DrawnPart>& parts);
  void emit(std::uint32_t number, std::vector<DrawnPart>& parts);

  const Occlusion o_;
  SightedEdge edge_;
  glm::dvec3 from_eye_{0}, to_eye_{0};
  Interval shown_;             ///< what is searched: at first all within the view
  bool is_for_cover_ = false;  ///< what covers the outer side is searched, instead of what hides
  bool counts_ = false;
  glm::dvec2 begin_{0}, end_{0};  ///< of that, in cells
  float farthest_ = 0;
  OccluderBatch batch_;
  /// Without counts united, in order. Cells may come from its end to its beginning.
  std::deque<Hidden> hidden_;
  std::vector<std::pair<double, int>> changes_;
  std::vector<DrawnPart> split_;
  /// By the low bits of occluders' addresses: which were asked last, so that the next cell need not.
  std::array<const Occluder*, 64> asked_{};
};

}  // namespace frontmost::lines_detail
