// SPDX-License-Identifier: Apache-2.0
// Visible: what every method answers, one primitive and one depth for every sample of a view.
//
//   primitives, keys   | sample 0 of all pixels          | sample 1 of all pixels          | ...
//                      | row 0       | row 1       | ... | row 0       | row 1       | ... |
//                        x = 0, 1, ...
//
// Sample 0 alone is thus a plane of its own, as maps want it. What is visible is the minimum over (depth, primitive
// id), so that parts of a scene can be answered one by one, in any order and on any machine, and merged.
#pragma once

#include "frontmost/base.h"
#include "frontmost/view.h"

namespace frontmost {

/// The front-most primitive at every sample, and how deep it is. Planes are ordered [sample][y][x], top row first.
struct Visible {
  View view;
  Buffer<PrimitiveId> primitives;  ///< no_primitive where nothing is seen
  /// The depth that was compared: near / distance in perspective, (far - distance) / (far - near) in parallel
  /// projection, as a float in [0, 1], greater is nearer; 0 where nothing is seen.
  Buffer<float> keys;

  [[nodiscard]] std::size_t index(int x, int y, int sample = 0) const {
    return (std::size_t(sample) * std::size_t(view.height) + std::size_t(y)) * std::size_t(view.width) + std::size_t(x);
  }
};

/// Planar distance along the viewing axis for a key of `view`; +inf for key 0 in perspective.
[[nodiscard]] float depth_of_key(const View& view, float key);

/// Planar depth at every sample, in the order of Visible; +inf where nothing is seen.
[[nodiscard]] Buffer<float> depths_of(const Visible& visible);

/// A Visible of `view` in which nothing is seen: what merging begins with. \throws Error as validate(view) does.
[[nodiscard]] Visible nothing_visible(const View& view);

/// Lays what another part of a scene shows over `into`: at every sample the greater key stays, at equal keys the lower
/// id. That is commutative, associative and idempotent, so parts may come in any order and from any machine, and all of
/// them merged are to the bit what the whole scene shows. `first_id` is added to the ids of `other`: the place of its
/// first triangle among those of the whole. O(samples), in parallel.
/// \throws Error bad_argument unless both have the same view; limit_exceeded where an id would reach no_primitive, and
/// then `into` is merged in part.
void merge(Visible& into, const Visible& other, PrimitiveId first_id = 0, const Execution& execution = {});

/// Every sample as one number, of which the greater is what merge() keeps: the bits of the key in the upper half, those
/// of the id inverted in the lower; 0 where nothing is seen. So whatever knows the maximum of uint64, such as MPI_MAX,
/// merges parts that lie on different machines. `first_id` is added to ids, as by merge(). O(samples), in parallel.
/// \throws Error bad_argument for planes that are not of the size of their view; limit_exceeded where an id would reach
/// no_primitive.
[[nodiscard]] Buffer<std::uint64_t> pack(const Visible& visible, PrimitiveId first_id = 0,
                                         const Execution& execution = {});
/// The way back. \throws Error bad_argument unless there is a number for every sample of the view, and every key is in
/// [0, 1]; as validate(view) does.
[[nodiscard]] Visible unpack(const View& view, std::span<const std::uint64_t> packed, const Execution& execution = {});

/// A hash of ids and depths: equal for equal answers, on every machine and for any number of threads. FNV-1a over
/// the two planes, sample by sample. O(samples), on one thread.
[[nodiscard]] std::uint64_t content_hash(const Visible& visible);

}  // namespace frontmost
