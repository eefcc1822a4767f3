// SPDX-License-Identifier: Apache-2.0
// Visible: what every method answers, one primitive and one depth for every sample of a view.
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
[[nodiscard]] Buffer<float> depths(const Visible& visible);

/// A hash of ids and depths: equal for equal answers, on every machine and for any number of threads. FNV-1a over
/// the two planes, sample by sample. O(samples), on one thread.
[[nodiscard]] std::uint64_t content_hash(const Visible& visible);

}  // namespace frontmost
