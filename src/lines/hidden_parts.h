// SPDX-License-Identifier: Apache-2.0
// Where an edge goes out of sight.
#pragma once

#include "frontmost/lines.h"
#include "lines/feature_edges.h"
#include "lines/occluder_grid.h"

namespace frontmost::lines_detail {

/// What edges are held against.
struct Occluders {
  const WeldedMesh& mesh;
  const std::vector<std::int8_t>& facing;
  const Sight& sight;
  const View& view;
  const OccluderGrid& grid;
};

/// Cuts one edge after another. Not for several threads at once.
class EdgeCutter {
 public:
  EdgeCutter(const Occluders& occluders, bool counts) : o_(occluders), counts_(counts) {}

  /// Appends the parts of `edge`, whose number is `number`, that lie within the view.
  void cut(const FeatureEdge& edge, std::uint32_t number, std::vector<DrawnPart>& parts);

 private:
  struct Interval {
    double begin, end;
  };
  [[nodiscard]] Interval within_view() const;
  [[nodiscard]] Interval hidden_by(const Occluder& occluder) const;
  [[nodiscard]] Interval in_shadow_of(const Occluder& occluder, const FacePlane& plane) const;
  [[nodiscard]] Interval beyond_near(const glm::uvec3& corners, const FacePlane& plane, int facing) const;
  [[nodiscard]] glm::dvec2 on_screen(double t) const;
  bool collect(const Interval& shown, std::span<const Occluder> cell, double farthest);
  [[nodiscard]] bool is_covered(const Interval& shown);
  void emit(const Interval& shown, std::uint32_t number, std::vector<DrawnPart>& parts);

  const Occluders o_;
  const bool counts_;
  FeatureEdge edge_{};
  glm::dvec3 from_{0}, to_{0}, from_eye_{0}, to_eye_{0};
  glm::vec2 low_{0}, high_{0};  ///< of the part in the view, in cells
  std::vector<Interval> hidden_;
  std::vector<std::pair<double, int>> changes_;
  std::vector<std::uint32_t> asked_;  ///< by triangle: the edge that it was last held against
  std::uint32_t asking_ = 0;
};

}  // namespace frontmost::lines_detail
