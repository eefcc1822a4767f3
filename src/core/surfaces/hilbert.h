// SPDX-License-Identifier: Apache-2.0
// Maps the Morton code of a cell to its place on Hilbert's curve, on which consecutive cells always share a face.
// D. Hilbert. Über die stetige Abbildung einer Linie auf ein Flächenstück. 1891.
// C. Hamilton. Compact Hilbert Indices. Dalhousie University CS-2006-07. 2006: names and formulas of a step.
#pragma once

#include <array>
#include <cstdint>

namespace frontmost {
namespace hilbert_detail {

/// The curve's pose in a cell: it enters at corner `entry` and leaves along axis `direction`. There are 24 poses.
struct CellPose {
  std::uint32_t entry, direction;
  [[nodiscard]] constexpr std::uint32_t number() const { return entry * 3 + direction; }
};

/// The place on the curve of one of the eight parts of a cell, and the curve's pose in this part.
struct HilbertStep {
  std::uint32_t place;
  CellPose inside;
};

constexpr std::uint32_t rotate_left(std::uint32_t bits, std::uint32_t by) {
  by %= 3;
  return (bits << by | bits >> (3 - by)) & 7;
}
constexpr std::uint32_t gray(std::uint32_t i) { return i ^ i >> 1; }
constexpr std::uint32_t trailing_ones(std::uint32_t i) { return i & 1 ? 1 + trailing_ones(i >> 1) : 0; }

/// The step for a part of a cell; `part` has one bit an axis.
constexpr HilbertStep step(const CellPose& pose, std::uint32_t part) {
  const std::uint32_t turned = rotate_left(part ^ pose.entry, 2 - pose.direction);
  const std::uint32_t place = (turned ^ turned >> 1 ^ turned >> 2) & 7;  // gray(place) == turned
  const std::uint32_t entry = place == 0 ? 0 : gray((place - 1) & ~1u);
  const std::uint32_t direction = place == 0 ? 0 : trailing_ones(place % 2 ? place : place - 1) % 3;
  return {place, {pose.entry ^ rotate_left(entry, pose.direction + 1), (pose.direction + direction + 1) % 3}};
}

/// A table of two levels at a time. For a pose and the parts of both levels, an entry holds the next pose and, in its
/// lower six bits, the two places.
inline constexpr auto kSteps = [] {
  std::array<std::uint16_t, 24 * 64> steps{};
  for (std::uint32_t pose = 0; pose < 24; ++pose)
    for (std::uint32_t parts = 0; parts < 64; ++parts) {
      const HilbertStep outer = step({pose / 3, pose % 3}, parts >> 3), inner = step(outer.inside, parts & 7);
      steps[pose * 64 + parts] =
          static_cast<std::uint16_t>(inner.inside.number() * 64 | outer.place << 3 | inner.place);
    }
  return steps;
}();

}  // namespace hilbert_detail

/// The place of a cell on the curve through a cube of 8^levels cells. `morton` and the result have three bits a level,
/// at most 30 bits.
[[nodiscard]] inline std::uint32_t hilbert_place(std::uint32_t morton, int levels) {
  std::uint32_t pose = 0, place = 0;
  // If the number of levels is odd, one level is added on top, of which only part 0, at place 0, is used.
  for (int shift = (levels - 1) / 2 * 6; shift >= 0; shift -= 6) {
    const std::uint32_t next = hilbert_detail::kSteps[pose | (morton >> shift & 63)];
    place = place << 6 | (next & 63);
    pose = next & ~63u;
  }
  return place;
}

}  // namespace frontmost
