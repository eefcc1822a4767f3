// SPDX-License-Identifier: Apache-2.0
// What a depth buffer can tell apart: as a function of distance, and in a picture.
//
//    near                                                          far
//     | | | |  |  |   |    |     |       |            |             |
//                                        <------------>  the gap at this distance
//
// The values of a fixed-point format lie close together before the eye, and ever farther apart behind.
// Two surfaces that are nearer to each other than the gap may be stored as one value; then the order of drawing decides
// which is seen, and they are said to fight.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "frontmost/image.h"
#include "frontmost/scene.h"
#include "frontmost/view.h"
#include "frontmost/zbuffer.h"

namespace frontmost {

/// All that the precision of a depth buffer depends on.
struct DepthSetup {
  ClipDistances clip;
  DepthFormat format = DepthFormat::d24;
  bool reversed = false;      ///< depth 1 at the near plane, 0 at the far one
  bool orthographic = false;  ///< depth is affine in distance, not in its reciprocal
};

/// The smallest gap that the format resolves: of what lies exactly at `distance`, a surface at least so much farther
/// away is stored as another value. One full step of the format, carried back to distances: about distance^2 (far -
/// near) / (far near (2^n - 1)) for integers, at most 2^-23 of the distance for reversed floats. Infinite where nothing
/// beyond is told apart from infinity. Float buffers are never finer than the float keys from which depths are made:
/// 2^-24 to 2^-23 of the distance. \throws Error bad_argument unless near <= distance <= far, and for planes that
/// make_projection() refuses.
[[nodiscard]] double resolvable_gap(const DepthSetup& setup, double distance);

/// What positions and transforms add to it, of surfaces that face the picture. World positions are floats, and so are
/// those relative to the eye, the rows of the transform and what is made of them: of corners at most `reach` away from
/// the eye and from the world's origin, every distance is off by up to 9 * 2^-24 * reach, and by 2 * 2^-24 of itself as
/// a key; that of both surfaces. Without `reach` it is twice the distance, or in parallel projection twice the planes'.
/// Surfaces that do not face the picture are snapped to 1/256 pixel besides: each of two adds what its depth changes
/// over 1/512 pixel along x and along y. \throws as above.
[[nodiscard]] double rounding_gap(const DepthSetup& setup, double distance, std::optional<double> reach = {});

/// Both together: the gap behind `distance` that every picture resolves at every pixel. \throws as above.
[[nodiscard]] double certain_gap(const DepthSetup& setup, double distance, std::optional<double> reach = {});

/// How much of the format's values lie between the near plane and `distance`, 0 to 1.
[[nodiscard]] double share_of_values(const DepthSetup& setup, double distance);

/// The smallest near distance with which `gap` is resolved at `distance`, other planes and format as in `setup`;
/// 0: any near plane does. None: none does. Reversed floats hardly depend on the near plane, so there the answer is 0
/// or none. \throws as above, and for a gap that is not positive.
[[nodiscard]] std::optional<double> near_for_gap(const DepthSetup& setup, double distance, double gap);

/// Distances for a table: the planes, and 1, 2, 5, 10, 20... between them; for an infinite far plane up to 10^6 times
/// the near distance.
[[nodiscard]] std::vector<double> round_distances(const ClipDistances& clip);

/// What is nearest at every sample, decided without rounding. Covered by the same triangles as zbuffer(), from the same
/// snapped corners; but the depth of a triangle is that of the plane through its corners in world space, where the
/// sample's ray meets it, limited to the depths of its corners. The corners are floats, the ray's origin and direction
/// doubles; from there on nothing is rounded, as long as coordinates are 0 or between 2^-100 and 2^100.
struct ExactVisible {
  View view;
  Buffer<PrimitiveId> primitives;  ///< the lowest id of the nearest, in the order of Visible
  Buffer<std::uint8_t> tied;       ///< 1 where another triangle is exactly as near
};

/// O(triangles + covered samples); samples where doubles cannot decide cost microseconds each. The same on every
/// machine. \throws Error as validate(view) does, and limit_exceeded for more than 2^29 steps, 128 more for each
/// sample and 1,024 for each triangle; a triangle at a sample is one step, or 64 where doubles cannot decide.
[[nodiscard]] ExactVisible find_exact_visible(const Surfaces& surfaces, const View& view,
                                              const Execution& execution = {});

/// Two objects of which one is seen where the other is nearer.
struct FightingPair {
  std::uint32_t seen = no_index;    ///< instance; no_index: nothing is seen there
  std::uint32_t nearer = no_index;  ///< instance; may be the same
  std::uint64_t samples = 0;
  double farthest = 0;  ///< the most that what is seen lies behind what is nearer
};

/// Where an answer shows a surface that is not the nearest.
struct DepthFights {
  View view;
  std::uint64_t covered = 0;        ///< samples where there is something to see
  std::uint64_t wrong = 0;          ///< where something strictly farther, or nothing, is seen
  std::uint64_t tied = 0;           ///< where several surfaces are exactly nearest, and no answer is wrong
  std::vector<FightingPair> pairs;  ///< most samples first
  /// By sample: how far what is seen lies behind the nearest, as a share of the nearest's distance; 0 where the answer
  /// is right, +inf where nothing is seen.
  Buffer<float> errors;
};

/// Compares an answer, such as a DepthBuffer's, with the exact one. O(samples).
/// \throws Error bad_argument when the two are of different views.
[[nodiscard]] DepthFights find_depth_fights(const Surfaces& surfaces, const ExactVisible& exact, const Visible& answer,
                                            const Execution& execution = {});

/// The fights in colour, from violet (a millionth of the distance) over red to yellow (a tenth), light blue where
/// nothing is seen, over `backdrop` in dim grey: R, G, B, A. First samples only.
/// \throws Error bad_argument when the backdrop has another size or no R, G, B.
[[nodiscard]] Image fight_image(const DepthFights& fights, const Image& backdrop);

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
// Samples of one picture show where this picture is wrong (find_depth_fights); the areas show where a
// picture from a little farther left would be. Every sample that is wrong or tied lies in an area.

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

// Why two methods see different things at a sample, and whether both may be right.
//
// The z-buffer snaps corners to 1/256 pixel, rays snap nothing, and the A-buffer answers in layers. So along edges and
// where surfaces nearly coincide their answers differ, and an exact comparison of pictures would prove nothing. Here
// every sample that differs is put to exact arithmetic: either it is shown why both answers are possible, or one of
// them is wrong.

/// Why two answers part at a sample.
enum class Difference : std::uint8_t {
  none,         ///< they do not
  edge,         ///< an edge of a triangle passes within 1/128 pixel
  depth,        ///< all that is shown covers the sample surely, at depths closer than can be told apart
  translucent,  ///< one shows what lies behind a translucent triangle that the other shows
  unexplained,  ///< one of the answers is wrong
};
/// "edge", "depth" and so on.
[[nodiscard]] std::string_view name(Difference difference);

/// How far two answers agree.
struct Agreement {
  View view;
  /// Samples by Difference; `none` counts those where both show the same, at a right depth.
  std::array<std::uint64_t, 5> counts{};
  Buffer<Difference> differences;  ///< in the order of Visible

  [[nodiscard]] std::uint64_t count(Difference difference) const { return counts[std::size_t(difference)]; }
  [[nodiscard]] std::uint64_t differing() const;
};

/// Compares two answers, and puts every sample where they part to exact arithmetic. Methods place corners on the screen
/// in their own way, all within 1/128 pixel of the truth, so about a sample lies the square of +-1/128 pixel in which
/// they may be looking. An answer is possible when
/// - what it shows meets that square, or it shows nothing;
/// - no triangle of the scene that contains the whole square, and is not left out by View::culling, is surely nearer
///   (for nothing: none contains it). Surely nearer: its least key over the square exceeds the other's greatest by more
///   than float arithmetic makes of them: 20 roundings, 2^-24 each, of the key itself, and 6 times as many as the
///   corner farthest aside is farther from the eye than deep (beside the guard band nothing counts; in parallel
///   projection 20 roundings of the greatest key, and 6 of the distance from the eye to the farthest corner).
/// Two possible answers part for the reason `depth` where both triangles contain the square, otherwise for `edge` (the
/// rim that the near and far plane cut counts as one). Any other difference is `unexplained`; and so is a key, of
/// either answer and at any sample, that its triangle does not have in the square, with the same allowance.
///
/// Corners are the floats of Surfaces::corners(), rays the doubles of the view; from there on signs are exact, as long
/// as coordinates are 0 or between 2^-100 and 2^100.
/// O(samples + triangles + differing samples * triangles over them), in parallel.
/// \throws Error bad_argument when the two are of different views.
[[nodiscard]] Agreement check_agreement(const Surfaces& surfaces, const Visible& a, const Visible& b,
                                        const Execution& execution = {});

/// Adds what shows through, for methods that answer in layers: of the samples that agree, those where `behind` shows
/// something become `translucent` where the material of what `front` shows lets light through (alpha mode blend), and
/// `unexplained` where it is opaque. O(samples).
/// \throws Error bad_argument when they are of different views.
void see_through(Agreement& agreement, const Surfaces& surfaces, const Visible& front, const Visible& behind);

}  // namespace frontmost
