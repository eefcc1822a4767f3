// SPDX-License-Identifier: Apache-2.0
// What hems look like.
#pragma once

#include <algorithm>
#include <array>

namespace frontmost::painter_detail {

/// Hems that are tried: part of the width, and how far from the ends they have it, in their width or, where that is
/// set, in the side's length: what they lie under may be a wedge, with room at one end alone.
struct HemShape {
  double part, inset, from_part = 0, to_part = 0;
  /// Pixels from either end, of a side of some length.
  [[nodiscard]] std::array<double, 2> insets(double width, double length) const {
    const auto inset_of = [&](double own_part, double other_part) {
      return own_part > 0 ? own_part * length : std::min(inset * width, (other_part > 0 ? 0.1 : 0.45) * length);
    };
    return {inset_of(from_part, to_part), inset_of(to_part, from_part)};
  }
};

}  // namespace frontmost::painter_detail
