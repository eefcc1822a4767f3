// SPDX-License-Identifier: Apache-2.0
// The numbers of a row of running dimensions: which of them have room, and where they stand.
#pragma once

#include <cstddef>
#include <vector>

namespace frontmost::detail {

inline constexpr double same_place = 0.05;  // millimetres of paper
inline constexpr double same_size = 1e-3;   // as a share of the size

/// A running dimension; all but `length` in millimetres on the page.
struct Position {
  double distance;                    ///< from the datum
  double foot;                        ///< where the extension line begins, along the other axis
  double length;                      ///< of a step's lines, in pixels; infinite for a circle
  std::vector<std::size_t> planes{};  ///< of the steps at this distance
  double place = 0;                   ///< of the number, from the datum
};

/// The room for the numbers of a row, in millimetres.
struct NumberRoom {
  double thickness;          ///< of a number with its distance to the next one
  double least_gap;          ///< between extension lines
  double most_moved;         ///< from an extension line to its number
  double low = 0, high = 0;  ///< between these the numbers lie, from the datum
};

/// The positions of a row whose numbers have room: circles first, then the longest steps. Each distance comes once.
/// `away` is the direction from the view to the row. At most 16 steps are in a row. Steps of equal length, if there are
/// 5 or more, as of a modelled thread, are stated all or not at all. Adds the number of circles without room to
/// `left_out`. Quadratic in the numbers that have room.
[[nodiscard]] std::vector<Position> chosen_positions(std::vector<Position> positions, double away,
                                                     const NumberRoom& room, std::size_t& left_out);

}  // namespace frontmost::detail
