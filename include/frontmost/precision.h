// SPDX-License-Identifier: Apache-2.0
// The precision of a depth buffer: as a function of distance, and in a picture.
//
//    near                                                          far
//     | | | |  |  |   |    |     |       |            |             |
//                                        <------------>  the gap at this distance
//
// Values of a fixed-point format lie close together near the eye, and farther apart with growing distance. Two surfaces
// closer to each other than the gap may be stored as the same value. The order of drawing then decides which surface is
// seen: the surfaces fight (z-fighting).
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

/// Everything that determines the precision of a depth buffer.
struct DepthSetup {
  ClipDistances clip;
  DepthFormat format = DepthFormat::d24;
  bool reversed = false;      ///< depth 1 at the near plane, 0 at the far one
  bool orthographic = false;  ///< depth is affine in the distance, not in the distance's reciprocal
};

/// The resolvable gap: a surface exactly at `distance` and one at least this much farther away are stored as different
/// values. The gap is one full step of the format, converted to distance. For integers it is about distance^2 (far -
/// near) / (far near (2^n - 1)), for reversed floats at most 2^-23 of the distance. Float buffers are never finer than
/// the float keys from which depths are made: 2^-24 to 2^-23 of the distance. Infinite if `distance` and infinity may
/// be stored as the same value.
/// \throws Error bad_argument unless near <= distance <= far, and for planes that make_projection() refuses.
[[nodiscard]] double resolvable_gap(const DepthSetup& setup, double distance);

/// The additional gap due to rounding of positions and transforms, for two surfaces that face the picture. Positions,
/// coordinates relative to the eye, and the transform are floats. With vertices at most `reach` away from the eye and
/// from the world's origin, each distance is wrong by up to 9 * 2^-24 * reach, and its key adds 2 * 2^-24 of the
/// distance; the gap is twice the sum. `reach` defaults to twice the distance, or, in parallel projection, twice the
/// distance of the planes. Snapping to 1/256 pixel also moves surfaces that do not face the picture: each adds the
/// change of its depth over 1/512 pixel along x and along y. \throws Error as resolvable_gap() does.
[[nodiscard]] double rounding_gap(const DepthSetup& setup, double distance, std::optional<double> reach = {});

/// The resolvable gap and the rounding gap together: two surfaces this far apart, the nearer at `distance`, are
/// resolved at every pixel of every picture. \throws Error as resolvable_gap() does.
[[nodiscard]] double certain_gap(const DepthSetup& setup, double distance, std::optional<double> reach = {});

/// \returns the share of the format's values that lie between the near plane and `distance`, 0 to 1.
[[nodiscard]] double share_of_values(const DepthSetup& setup, double distance);

/// \returns the smallest near distance with which `gap` is resolved at `distance`, for the far plane and format of
/// `setup`. 0 means that any near plane resolves the gap, and none that no near plane does. Reversed floats hardly
/// depend on the near plane, so their result is 0 or none. \throws Error as resolvable_gap() does, and for a gap that
/// is not positive.
[[nodiscard]] std::optional<double> near_for_gap(const DepthSetup& setup, double distance, double gap);

/// Distances for a table: the near plane, then 1, 2, 5, 10, 20..., then the far plane. An infinite far plane counts as
/// 10^6 times the near distance.
[[nodiscard]] std::vector<double> round_distances(const ClipDistances& clip);

/// The nearest triangle at every sample, found without rounding. Coverage is that of zbuffer(), from the same snapped
/// vertices. The depth is that of the triangle's plane in world space where the sample's ray meets it, limited to the
/// depths of the triangle's vertices. Vertices are floats, the ray's origin and direction are doubles; nothing else is
/// rounded if coordinates are 0 or between 2^-100 and 2^100.
struct ExactVisible {
  View view;
  Buffer<PrimitiveId> primitives;  ///< in the order of Visible; of equally near triangles the lowest id
  Buffer<std::uint8_t> tied;       ///< 1 if another triangle is exactly as near
};

/// Finds the nearest triangle at every sample; the result is the same on every machine. O(triangles + covered samples).
/// A sample that cannot be decided in double precision takes microseconds.
/// \throws Error as validate(view) does; limit_exceeded if more steps are needed than 2^29 + 128 per sample + 1,024 per
/// triangle. A triangle at a sample is one step, or 64 if double precision cannot decide.
[[nodiscard]] ExactVisible find_exact_visible(const Surfaces& surfaces, const View& view,
                                              const Execution& execution = {});

/// Samples at which one object is seen although another one is nearer.
struct FightingPair {
  std::uint32_t seen = no_index;    ///< an instance; no_index: nothing is seen
  std::uint32_t nearer = no_index;  ///< an instance, perhaps the same one
  std::uint64_t samples = 0;
  double farthest = 0;  ///< greatest distance of the seen surface behind the nearest one
};

/// The samples at which an answer does not show the nearest surface.
struct DepthFights {
  View view;
  std::uint64_t covered = 0;        ///< samples with a surface
  std::uint64_t wrong = 0;          ///< samples that show a strictly farther surface, or nothing
  std::uint64_t tied = 0;           ///< samples with several exactly nearest surfaces, any of which is right
  std::vector<FightingPair> pairs;  ///< most samples first
  /// By sample: distance of the seen surface behind the nearest one, divided by the nearest distance. 0 if the answer
  /// is right, +inf if nothing is seen.
  Buffer<float> errors;
};

/// Compares an answer, such as a DepthBuffer's, with the exact one. O(samples).
/// \throws Error bad_argument if the two are of different views.
[[nodiscard]] DepthFights find_depth_fights(const Surfaces& surfaces, const ExactVisible& exact, const Visible& answer,
                                            const Execution& execution = {});

/// \returns a picture of the fights, with channels R, G, B, A, over a dimmed grey `backdrop`. Colours go from violet
/// (an error of a millionth of the distance) over red to yellow (a tenth); light blue: nothing is seen. Shows the first
/// sample of each pixel. \throws Error bad_argument if the backdrop has another size or lacks R, G, B.
[[nodiscard]] Image fight_image(const DepthFights& fights, const Image& backdrop);

// Areas at risk: which faces a depth buffer cannot tell apart, where, and what prevents it.
//
//            the screen                      along the line of sight
//      +-----------+                            first
//      |  first    |                              \        The area at risk holds the points where both faces are,
//      |     +-----+-----+                     ----\----   and are closer to each other than the format and rounding
//      |     |/////|     |   ///// at risk          \      can tell apart. The area is convex, since keys are affine
//      +-----+-----+     |                           \     over the screen.
//            |    second |                          second
//            +-----------+
//
// The samples of find_depth_fights() show where one picture is wrong. The areas also show where a picture from a
// slightly different eye would be wrong. Every wrong or tied sample lies in an area.

/// Why a depth buffer may show the wrong one of two faces: the first reason that holds.
enum class FightKind : std::uint8_t {
  one_plane,  ///< all vertices lie exactly in one plane: no format can tell the faces apart
  fold,       ///< the faces share a vertex, and approach each other there
  close,      ///< the faces intersect, or lie closer than the format can resolve
  clear,      ///< a single face, stored as the clear value: nothing is seen
};

/// Two faces and one area in which they are at risk. A face that the near plane or the guard band clips becomes several
/// triangles on the screen, and may have several areas.
struct FightingFaces {
  PrimitiveId first = no_primitive, second = no_primitive;  ///< first < second; `clear` has no second
  FightKind kind = FightKind::close;
  double area = 0;  ///< square pixels, within the picture
  /// The part of `area` in which no other surface is seen in front of both faces. The part is estimated from thousands
  /// of samples if the area is large.
  double visible_area = 0;
  double distance = 0;                               ///< planar depth of the nearest point of the area
  std::uint32_t corner_begin = 0, corner_count = 0;  ///< range of FightAreas::corners
};

/// All areas of one kind between the faces of two objects.
struct FightingObjects {
  std::uint32_t first = no_index, second = no_index;  ///< instances, first <= second; `clear` has no second
  FightKind kind = FightKind::close;
  std::uint64_t areas = 0;
  double area = 0;          ///< area of the union, in square pixels; measured along lines at least 1/16 pixel apart
  double visible_area = 0;  ///< visible area of the union, in square pixels: see FightingFaces
  double distance = 0;      ///< planar depth of the nearest point
  double gap = 0;           ///< resolvable_gap() at that depth
};

struct FightAreas {
  View view;
  DepthSetup setup;
  std::vector<FightingFaces> faces;      ///< in the order of their ids
  std::vector<glm::dvec2> corners;       ///< corners of all areas, which are convex polygons; pixels of the screen
  std::vector<FightingObjects> objects;  ///< the greatest visible area first; folds last

  [[nodiscard]] std::span<const glm::dvec2> polygon(const FightingFaces& fight) const {
    return std::span(corners).subspan(fight.corner_begin, fight.corner_count);
  }
};

/// Finds the faces that a depth buffer of this format may show wrongly in the view. Culling is considered, holes are
/// not. Faces that lie behind everything seen at the samples around them are left out. The result is the same for any
/// number of threads. O(triangles + pairs of faces whose rectangles and depth ranges overlap + samples). Some thousand
/// samples of an area tell how much of it is seen, or all of its samples if none of the thousand sees it.
/// \throws Error bad_argument as validate(view) does; limit_exceeded for more than 2^22 areas, 2^24 pairs of faces
/// close to each other, 2^28 pairs to be examined, or 2^30 samples of areas and 64 for each sample of the picture.
[[nodiscard]] FightAreas find_fighting_faces(const Surfaces& surfaces, const View& view, DepthFormat format,
                                             bool reversed = false, const Execution& execution = {});

/// Another depth buffer for the same view, and its number of wrong samples.
struct FightRemedy {
  DepthSetup setup;
  std::uint64_t wrong = 0;  ///< DepthFights::wrong
};

/// Draws the view with the usual remedies: near and far planes that fit tightly around the visible faces; 24-bit
/// depths; reversed floats; reversed floats with the tight planes. \returns the remedies that leave fewer wrong samples
/// than `setup`. Costs up to five pictures. \throws Error bad_argument if `exact` is of another view.
[[nodiscard]] std::vector<FightRemedy> try_remedies(const Surfaces& surfaces, const ExactVisible& exact,
                                                    const DepthSetup& setup, const Execution& execution = {});

/// A polygon offset for the second object of a pair.
struct OffsetRemedy {
  std::uint32_t instance = no_index;  ///< the second object of the pair
  PolygonOffset offset;
};

/// The least offset, in units of powers of two up to 2^16, that makes the second object seen at every sample of the
/// pair's areas at which one of the two objects is nearest. The offset is found by drawing up to 17 pictures. None if
/// no such offset suffices, and for an object with itself or with the clear value. Precondition: `exact` and `fights`
/// are of the same view, and `pair` is one of `fights`.
[[nodiscard]] std::optional<OffsetRemedy> find_offset(const Surfaces& surfaces, const ExactVisible& exact,
                                                      const FightAreas& fights, const FightingObjects& pair,
                                                      const Execution& execution = {});

// Agreement: why two methods see different things at a sample, and whether both may be right.
//
// The z-buffer snaps vertices to 1/256 pixel, ray casting snaps nothing, and the A-buffer answers in layers. Their
// answers therefore differ along edges and where surfaces nearly coincide, and comparing pictures exactly would prove
// nothing. Exact arithmetic decides each sample that differs: either both answers are possible, or one of them is
// wrong.
//
// All methods place vertices within 1/128 pixel of the truth, so a sample stands for the square of +-1/128 pixel around
// it. An answer is possible if
// - the triangle that it shows meets the square, or it shows nothing; and
// - no triangle that contains the square, and is not culled, is surely nearer. (Where an answer shows nothing, no
//   triangle may contain the square.)
// A triangle is surely nearer if its least key over the square exceeds the other's greatest key by more than float
// rounding. The rounding is 20 * 2^-24 of the key, plus 6 * 2^-24 of the key times the greatest ratio of distance to
// depth of a vertex within the guard band. In parallel projection it is 20 * 2^-24 of the greatest key, plus 6 * 2^-24
// of the distance from the eye to the farthest vertex.
//
// Two possible answers differ by `depth` if both triangles contain the square, else by `edge`; the cuts of the near and
// far planes count as edges. Any other difference is `unexplained`. A sample is `unexplained`, too, if a key is one
// that its triangle does not have anywhere in the square, up to rounding.

/// Why two answers differ at a sample.
enum class Difference : std::uint8_t {
  none,         ///< the answers agree
  edge,         ///< an edge of a triangle passes within 1/128 pixel
  depth,        ///< both triangles surely cover the sample, at depths too close to be told apart
  translucent,  ///< one answer shows a surface behind a translucent triangle that the other one shows
  unexplained,  ///< one of the answers is wrong
};
/// "edge", "depth" and so on.
[[nodiscard]] std::string_view name(Difference difference);

/// How far two answers agree.
struct Agreement {
  View view;
  /// Number of samples by Difference. `none` counts the samples at which both answers show the same triangle at a right
  /// depth.
  std::array<std::uint64_t, 5> counts{};
  Buffer<Difference> differences;  ///< in the order of Visible

  [[nodiscard]] std::uint64_t count(Difference difference) const { return counts[std::size_t(difference)]; }
  [[nodiscard]] std::uint64_t differing() const;
};

/// Compares two answers, and decides each sample at which they differ by exact arithmetic. \returns the reason for each
/// sample; `unexplained` means that an answer is wrong. Vertices are the floats of Surfaces::corners(), rays the
/// doubles of the view. Signs are exact if coordinates are 0 or between 2^-100 and 2^100.
/// O(samples + triangles + differing samples * triangles over them), in parallel.
/// \throws Error bad_argument if the two are of different views.
[[nodiscard]] Agreement check_agreement(const Surfaces& surfaces, const Visible& a, const Visible& b,
                                        const Execution& execution = {});

/// Adds the reason `translucent`, for methods that answer in layers. A sample at which the answers agree, but `behind`
/// shows something, becomes `translucent` if Material::is_see_through() holds for the surface that `front` shows, else
/// `unexplained`. O(samples). \throws Error bad_argument if the layers were made for different views; all must have the
/// same view.
void see_through(Agreement& agreement, const Surfaces& surfaces, const Visible& front, const Visible& behind);

}  // namespace frontmost
