// SPDX-License-Identifier: Apache-2.0
// Which faces a depth buffer cannot tell apart, where, and what ends it.
//
//            the screen                      along the line of sight
//      +-----------+                            first
//      |  first    |                              \        at risk is where both faces are, and lie nearer to
//      |     +-----+-----+                     ----\----   each other than the format and what rounding adds can
//      |     |/////|     |   ///// at risk          \      tell apart: a convex area, for keys are affine over
//      +-----+-----+     |                           \     the screen
//            |    second |                          second
//            +-----------+
//
// Samples of one picture show where this picture is wrong (find_depth_fights in precision.h); the areas show where a
// picture from a little farther left would be. Every sample that is wrong or tied lies in an area.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "frontmost/precision.h"

namespace frontmost {

/// Why a depth buffer may show the wrong one of two faces, the first that holds.
enum class FightKind : std::uint8_t {
  one_plane,  ///< all corners lie in one plane, exactly: no format tells the faces apart
  fold,       ///< the faces share a corner, and come together there
  close,      ///< they pass through each other, or lie closer than the format tells apart
  clear,      ///< one face alone, which is stored as what the buffer was cleared to, so that nothing is seen
};

/// Two faces, and one area in which they are at risk. A face that is clipped by the near plane or by the guard band is
/// several triangles on the screen, and may have as many areas.
struct FightingFaces {
  PrimitiveId first = no_primitive, second = no_primitive;  ///< first < second; of `clear` there is no second
  FightKind kind = FightKind::close;
  double area = 0;  ///< in pixels squared, within the picture
  /// The share of it at whose samples nothing stands before both; of large areas, at some thousands of them.
  double visible_area = 0;
  double distance = 0;                               ///< planar depth of the area's nearest point
  std::uint32_t corner_begin = 0, corner_count = 0;  ///< in FightAreas::corners
};

/// All areas of one kind of the faces of two objects.
struct FightingObjects {
  std::uint32_t first = no_index, second = no_index;  ///< instances, first <= second; of `clear` there is no second
  FightKind kind = FightKind::close;
  std::uint64_t areas = 0;
  double area = 0;          ///< of their union, in pixels squared; measured along lines at least 1/16 pixel apart
  double visible_area = 0;  ///< likewise
  double distance = 0;      ///< planar depth of their nearest point
  double gap = 0;           ///< resolvable_gap() there: the smallest that the format tells apart
};

struct FightAreas {
  View view;
  DepthSetup setup;
  std::vector<FightingFaces> faces;      ///< by their ids
  std::vector<glm::dvec2> corners;       ///< of all areas: convex, on the screen, in pixels
  std::vector<FightingObjects> objects;  ///< the greatest visible area first; folds last

  [[nodiscard]] std::span<const glm::dvec2> polygon(const FightingFaces& fight) const {
    return std::span(corners).subspan(fight.corner_begin, fight.corner_count);
  }
};

/// The faces that a depth buffer of this format may show wrongly in the view; culling counts, holes do not. What lies
/// behind all that is seen at the samples around it is left out. O(triangles + pairs of faces whose rectangles and
/// ranges of depth overlap + samples): an area asks some thousand samples at most, but all of its own where none of
/// those sees it. The same for any number of threads. \throws Error bad_argument as validate(view) does; limit_exceeded
/// where more than 2^22 areas are found, 2^24 pairs of faces lie close to each other, 2^28 would have to be looked at,
/// or 2^30 samples of areas and 64 for each of the picture, as where thousands lie in one place.
[[nodiscard]] FightAreas find_fighting_faces(const Surfaces& surfaces, const View& view, DepthFormat format,
                                             bool reversed = false, const Execution& execution = {});

/// Another depth buffer for the same view, and what drawing with it gave.
struct FightRemedy {
  DepthSetup setup;
  std::uint64_t wrong = 0;  ///< samples: DepthFights::wrong
};

/// Draws the view with what usually helps: planes that leave out no face of the picture; 24 bits; floats reversed; the
/// last with the former's planes. \returns what was drawn that has fewer wrong samples than the setup itself. Costs up
/// to five pictures. \throws Error bad_argument when `exact` is of another view.
[[nodiscard]] std::vector<FightRemedy> try_remedies(const Surfaces& surfaces, const ExactVisible& exact,
                                                    const DepthSetup& setup, const Execution& execution = {});

/// A polygon offset for one object of a pair.
struct OffsetRemedy {
  std::uint32_t instance = no_index;  ///< the second of the pair
  PolygonOffset offset;
};

/// The least offset, in units of powers of two up to 2^16, with which the pair's second object is seen at every sample
/// of their areas where either of them is nearest; found by drawing. None where no such offset is enough, and for an
/// object beside itself or the clear value. Costs up to 17 pictures. Precondition: `exact` and `fights` are of the same
/// view, and the pair is of `fights`.
[[nodiscard]] std::optional<OffsetRemedy> find_offset(const Surfaces& surfaces, const ExactVisible& exact,
                                                      const FightAreas& fights, const FightingObjects& pair,
                                                      const Execution& execution = {});

}  // namespace frontmost
