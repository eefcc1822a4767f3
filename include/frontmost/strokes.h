// SPDX-License-Identifier: Apache-2.0
// Strokes: the parts of a drawing put together to long lines, as a pen draws them.
//
// A drawing has a part for every side of a triangle that is drawn, cut wherever something hides it. A pen that drew
// them one by one would be lifted at the end of each, and dashes would begin anew at every corner:
//
//   parts     o--o--o--o--o       o--o
//             |                   |
//             o--o--o             o--o--o
//   strokes   .-----------        .---            two lines, each drawn without a lift of the pen
//             '-----              '-----
#pragma once

#include <vector>

#include "frontmost/lines.h"

namespace frontmost {

struct StrokeOptions {
  bool with_hidden = true;  ///< false: hidden parts are left out
  /// Radians, 0 to pi/2: hidden intersections of surfaces that pass through each other at less are left out. Where one
  /// lies on another of nearly its own shape, as a bolt in a bore, they are many, and nothing but the triangles' own.
  double grazing_angle = 0;
  bool by_kind = true;      ///< false: edges of all kinds may share a stroke
  bool by_outline = true;   ///< false: outlines and other lines may share a stroke
  bool by_instance = true;  ///< false: edges of several objects may share a stroke
  /// Pixels, 0.002 to 1: lines that are less apart count as one, and are drawn once; strokes that stay within this of
  /// where they begin count as points.
  double apart = 0.002;
  double tolerance = 0.01;  ///< pixels, 0.0001 to 1: strokes leave their parts by at most this
  /// Pixels, 0 to 100. Above 0: runs of at least four parts whose corners lie within this of one circle, with at most
  /// 20 degrees between two, become arcs. A polygon of up to 17 sides stays one. Arcs stay within this of their parts,
  /// too, but beside those of which two among the three before and the three after are at least half as long.
  double arc_tolerance = 0;
  /// Pixels, 0 to 10000: shorter strokes are joined to others that they touch, or left out where they end in the air or
  /// lie between lines that go on without them. Pieces of silhouettes and boundaries that close an outline stay.
  double shortest = 0;
  /// Each stroke begins as near as possible to the end of the one before, and goes on with it where they touch: for
  /// plotters. False: strokes come in the order of their parts.
  bool nearest_first = false;
};

/// A line from point to point, without a lift of the pen.
struct Stroke {
  EdgeKind kind = EdgeKind::boundary;  ///< of all its parts, or, without by_kind, of its first one
  bool is_hidden = false;
  bool is_outline = false;            ///< of all its parts; false without by_outline
  std::uint32_t instance = no_index;  ///< of all its parts, or, without by_instance, of its first one
  std::uint32_t first = 0, count = 0;
  bool is_closed = false;  ///< the last point is joined to the first
};

struct Strokes {
  std::vector<glm::dvec2> points;  ///< in pixels, as DrawnPart's
  /// One for each point, of the join that begins there: the tangent of a quarter of the angle that an arc turns
  /// through, positive from +x towards +y; 0: straight. At most about 1. Empty without arcs.
  std::vector<double> bulges;
  /// Hidden ones first; then by outline, kind and instance.
  std::vector<Stroke> strokes;
};

/// Parts of one class (seen or hidden, outline, kind, instance) that meet end to end, where no third one does, become
/// one stroke. Every line is drawn once: of parts that lie on each other, as an edge behind another in parallel
/// projection, one is kept, the seen one before the hidden one. What is seen as a point is left out. Near-linear in the
/// parts; where thousands crowd within a pixel and no grid parts them, with more than that.
/// \throws Error bad_argument for tolerances out of range.
[[nodiscard]] Strokes chain_strokes(const Surfaces& surfaces, const Drawing& drawing, const StrokeOptions& options = {},
                                    const Execution& execution = {});

}  // namespace frontmost
