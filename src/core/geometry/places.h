// SPDX-License-Identifier: Apache-2.0
// Welding: vertices are the same where their positions are equal, whatever their numbers.
#pragma once

#include <span>

#include "frontmost/base.h"

namespace frontmost {

/// For each position the number of the first one that is equal, coordinate by coordinate; +0 and -0 are equal. A
/// position that is not finite is equal to none but itself. Precondition: fewer than 2^31 positions. O(n) on all
/// threads; the same for any number of them.
[[nodiscard]] Buffer<std::uint32_t> first_at_place(std::span<const glm::vec3> positions, const Execution& execution);

namespace detail {
/// Computes first_at_place() by sorting. No choice of positions makes sorting take quadratic time.
[[nodiscard]] Buffer<std::uint32_t> first_at_place_by_sorting(std::span<const glm::vec3> positions);
}  // namespace detail

}  // namespace frontmost
