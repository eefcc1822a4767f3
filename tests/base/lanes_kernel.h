// SPDX-License-Identifier: Apache-2.0
// Base's building blocks of kernels, callable with plain types for every instruction set.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "frontmost/base.h"

namespace frontmost::test {

inline constexpr std::size_t most_lanes = 16;

/// One vector of the widest kind, and room for a store behind it.
struct PackedVector {
  std::size_t lanes = 0, count = 0, count_into = 0;
  std::uint64_t bits = 0;
  std::array<float, 2 * most_lanes> floats{}, into{};
  std::array<std::uint32_t, 2 * most_lanes> numbers{};
  std::vector<std::size_t> visited;
};

/// Packs the lanes in `set` (lane i in bit i) of `values` and of the numbers 100, 101, ... Other entries keep `rest`.
[[nodiscard]] PackedVector pack(std::uint32_t set, const std::array<float, most_lanes>& values, float rest, Isa isa);

/// All lanes of CountFrom(first).
[[nodiscard]] std::vector<std::int32_t> count_from(std::int32_t first, Isa isa);

}  // namespace frontmost::test
