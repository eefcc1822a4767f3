// SPDX-License-Identifier: Apache-2.0
// A scene prepared for hatching: visibility of its triangles from the eye and from the light.
//
//    eye's view     visible parts of a triangle's lines     an occluder grid and a cutter, as for edges
//    light's view   lit parts of these                      the same, seen from the light
//    normals        dark parts of these by the angle        a quadratic function along each line
//
// Hatching and stippling use the same pieces, for lines of several sets at once or for rows of dots.
#pragma once

#include "frontmost/lines.h"
#include "hatching/dot_grid.h"
#include "hatching/hatch_rows.h"
#include "lines/hiding/hidden_parts.h"

namespace frontmost::lines_detail {

/// A piece of line `line` of a set, from `begin` to `end` in pixels along the line; a dot has no length.
struct HatchPiece {
  std::uint32_t set;
  std::int32_t line;
  double begin, end;
  std::uint32_t instance;

  friend bool operator<(const HatchPiece& a, const HatchPiece& b) {
    return std::tie(a.set, a.line, a.begin, a.end, a.instance) < std::tie(b.set, b.line, b.begin, b.end, b.instance);
  }
};

/// A view with its occluders.
struct Scenery {
  /// `twins` are triangles that coincide with others.
  Scenery(const WeldedMesh& mesh, const std::vector<std::uint32_t>& twins, const View& its_view,
          const Execution& execution);

  Scenery(const Scenery&) = delete;  // members refer to each other
  Scenery& operator=(const Scenery&) = delete;

  const View view;
  const Sight sight;
  const SeenMesh seen;
  const OccluderGrid grid;
  const EdgeOccluders occlusion;
};

/// Answers how dark a scene is along lines.
class TonedScene {
 public:
  /// Borrows the surfaces. \throws Error bad_argument for options out of range.
  TonedScene(const Surfaces& surfaces, const View& view, const ToneOptions& tone, const Execution& execution);

  struct Task {
    const std::vector<HatchSet>& sets;
    bool by_instance = true;
    const DotGrid* dots = nullptr;  ///< of sets[0]: then pieces are dots
    /// One bit for each set of a material; the last entry is for triangles without material. Empty: all have all sets.
    std::vector<std::uint32_t> sets_by_material{};
  };
  /// The order of pieces does not matter.
  [[nodiscard]] std::vector<HatchPiece> pieces(const Task& task, const std::vector<HatchRows>& rows,
                                               const Execution& execution) const;

  [[nodiscard]] const WeldedMesh& mesh() const { return mesh_; }

 private:
  class Hatcher;

  const Surfaces& surfaces_;
  const glm::dvec3 to_light_;
  const WeldedMesh mesh_;
  const std::vector<std::uint32_t> twins_;
  const Scenery eye_;
  std::optional<Scenery> light_;  ///< empty if shadows are off
  const CornerNormals normals_;
};

}  // namespace frontmost::lines_detail
