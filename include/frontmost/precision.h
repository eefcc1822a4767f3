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

#include <optional>
#include <vector>

#include "frontmost/depth_buffer.h"
#include "frontmost/image.h"

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

}  // namespace frontmost
