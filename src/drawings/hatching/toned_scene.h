// SPDX-License-Identifier: Apache-2.0
// A scene as hatching sees it: what the eye sees of its triangles, and what the light does.
//
//    eye's view     what is seen of a triangle's lines      an occluder grid and a cutter, as for edges
//    light's view   what of that is lit                     the same, seen from where the light is
//    normals        what of that is dark by its angle       a quadratic function along each line
//
// Hatching and stippling ask for the same pieces, for lines of several sets at once or for rows of dots.
#pragma once

#include "frontmost/lines.h"
#include "hatching/dot_grid.h"
#include "hatching/hatch_rows.h"
#include "lines/hiding/hidden_parts.h"

namespace frontmost::lines_detail {

/// A piece of line `line` of a set, in pixels along it; a dot where it has no length.
struct HatchPiece {
  std::uint32_t set;
  std::int32_t line;
  double begin, end;
  std::uint32_t instance;

  friend bool operator<(const HatchPiece& a, const HatchPiece& b) {
    return std::tie(a.set, a.line, a.begin, a.end, a.instance) < std::tie(b.set, b.line, b.begin, b.end, b.instance);
  }
};

/// A view, and what hides in it.
struct Scenery {
  /// `twins` are triangles at the place of others.
  Scenery(const WeldedMesh& mesh, const std::vector<std::uint32_t>& twins, const View& its_view,
          const Execution& execution);

  Scenery(const Scenery&) = delete;  // it looks at itself
  Scenery& operator=(const Scenery&) = delete;

  const View view;
  const Sight sight;
  const SeenMesh seen;
  const OccluderGrid grid;
  const EdgeOccluders occlusion;
};

/// Everything that answers how dark a scene is along lines.
class TonedScene {
 public:
  /// Borrows the surfaces. \throws Error bad_argument for options out of range.
  TonedScene(const Surfaces& surfaces, const View& view, const ToneOptions& tone, const Execution& execution);

  struct Task {
    const std::vector<HatchSet>& sets;
    bool by_instance = true;
    const DotGrid* dots = nullptr;  ///< of sets[0]: pieces are its dots
    /// A bit for each set that a material has, and last those of what has none. Empty: all have all.
    std::vector<std::uint32_t> sets_by_material{};
  };
  /// In no order that matters.
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
  std::optional<Scenery> light_;  ///< none: nothing stands in it
  const CornerNormals normals_;
};

}  // namespace frontmost::lines_detail
