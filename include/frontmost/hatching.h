// SPDX-License-Identifier: Apache-2.0
// Hatching and stippling: how dark surfaces are, in pen lines and dots on what is seen of them.
//
//    bright      half dark      darker        in shadow
//                /   /   /    / / / / / /     X X X X X X
//                  /   /   /  / / / / / /     X X X X X X
//                /   /   /    / / / / / /     X X X X X X
//
// The lines of a HatchSet come where the brightness falls below its threshold, and stay where it is darker still.
#pragma once

#include <numbers>
#include <optional>
#include <vector>

#include "frontmost/surfaces.h"
#include "frontmost/view.h"

namespace frontmost {

/// How bright surfaces are: the cosine of the angle between their normal and the light, 0 in shadow and where they are
/// turned away.
///
/// Normals are the mean of those of all triangles of an object at a vertex that differ from the triangle's own by at
/// most the crease angle, so that brightness changes smoothly wherever no crease is drawn; normals of the model's file
/// do not count. Both sides of a surface are lit.
struct ToneOptions {
  /// Towards the light, in world space, of any length but zero. None: from the upper left and before the picture, as
  /// the key light of shade().
  std::optional<glm::dvec3> to_light = std::nullopt;
  bool casts_shadows = true;                   ///< false: nothing stands in the light
  double crease_angle = std::numbers::pi / 6;  ///< radians, 0 to pi
};

/// Parallel lines over the picture, drawn where surfaces are dark.
struct HatchSet {
  double angle = std::numbers::pi / 4;  ///< radians, from +x counter-clockwise as it is seen
  double spacing = 10;                  ///< pixels from line to line, 0.5 to 100000
  double offset = 0;                    ///< pixels, of one of the lines from the picture's upper left corner
  double below = 0.5;                   ///< where the brightness is less than this, -1 to 1
  /// On triangles of these materials alone, by their numbers in the scene; empty: on all.
  std::vector<std::uint32_t> materials{};
};

/// Four tones of three sets: paper; lines `spacing` apart where it is half dark; as many between them; and crossed by
/// others in shadow.
[[nodiscard]] std::vector<HatchSet> hatch_sets(double spacing, double angle);

struct HatchOptions {
  std::vector<HatchSet> sets;  ///< at most 16
  ToneOptions tone{};
  double shortest = 0;      ///< pixels, 0 to 1000: shorter lines are left out
  bool by_instance = true;  ///< false: lines go on from object to object
  /// Within a set (and instance) each line begins as near as possible to the end of the one before: for plotters.
  bool nearest_first = false;
};

/// A piece of a hatch line that lies on one object.
struct HatchLine {
  glm::dvec2 from{0}, to{0};          ///< in pixels of the view, as DrawnPart's
  std::uint32_t set = 0;              ///< of HatchOptions::sets
  std::uint32_t instance = no_index;  ///< none without by_instance
};

/// The parts of hatch lines that lie on what is seen of `surfaces`, and is dark there.
///
/// Each line of a set stands for a plane through the eye. It meets every triangle that it passes in a segment, which is
/// cut where it goes out of sight as the edges of draw_lines() are, by the same signs; and where it comes into shadow
/// likewise, in the view of the light. Where the brightness crosses HatchSet::below within a triangle is the root of a
/// quadratic equation. So nothing is sampled. Pieces that meet are joined; all lie on their line to the rounding of
/// doubles. By set, then by line, from one end to the other.
/// (G. Winkenbach, D. Salesin. Computer-Generated Pen-and-Ink Illustration. 1994; E. Praun, H. Hoppe, M. Webb,
/// A. Finkelstein. Real-Time Hatching. 2001: sets that stay where darker ones come.)
/// O(segments) beside the grids of occluders that draw_lines() makes too; a triangle has a segment for every line over
/// it. The result is the same to the bit for any number of threads and every instruction set. \throws Error as
/// validate(view) does, bad_argument for options out of range, and limit_exceeded for more than 2^26 pieces, before
/// they are joined, and where lines are held against more than 2^33 boxes and 16,384 for each triangle.
[[nodiscard]] std::vector<HatchLine> hatch(const Surfaces& surfaces, const View& view, const HatchOptions& options,
                                           const Execution& execution = {});

struct StippleOptions {
  double spacing = 4;  ///< pixels between dots where it is darkest, 0.5 to 1000
  ToneOptions tone{};
  bool by_instance = true;     ///< false: dots belong to no object
  bool nearest_first = false;  ///< for plotters, as HatchOptions
};

/// A dot on an object.
struct Stipple {
  glm::dvec2 at{0};                   ///< in pixels of the view, as DrawnPart's
  std::uint32_t instance = no_index;  ///< none without by_instance
};

/// Dots on what is seen of `surfaces`, the more of them the darker it is: none where the brightness is over 0.95, one
/// to a square of `spacing` in shadow. They lie as far from each other as their number allows, in a pattern that
/// depends on the picture alone. Each is seen and in shadow or not by the same signs as hatch(). By row, from the left.
/// (R. Ulichney. The Void-and-Cluster Method for Dither Array Generation. 1993.)
/// Cost, threads and errors as for hatch(); limit_exceeded where the picture has room for more than 20 million dots.
[[nodiscard]] std::vector<Stipple> stipple(const Surfaces& surfaces, const View& view, const StippleOptions& options,
                                           const Execution& execution = {});

}  // namespace frontmost
