// SPDX-License-Identifier: Apache-2.0
// The places of dots, with the darkness at which each appears: blue noise, the same on every machine.
//
//    row 3   .  o    .   o      Each square cell holds one place, a little off its middle so that no columns
//    row 2     .   o  .   .     show. A place has a dot (o) where the picture is darker than the place's limit;
//    row 1   o   .    o   .     limits are spread so that dots thin out evenly.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace frontmost::lines_detail {

/// Rows of places, one per square cell, each with its own limit of darkness. At every darkness the drawn dots are about
/// equally far apart. The pattern repeats after 64 cells, 32 times the spacing.
class DotGrid {
 public:
  static constexpr int side = 64;

  /// `spacing` is the distance of dots where it is darkest, `width` the width of the picture, both in pixels.
  DotGrid(double spacing, double width);
  [[nodiscard]] static double cell_of(double spacing) { return spacing / 2; }

  /// Calls visit(place along the row, brightness below which it has a dot) for the picture's places in [low, high).
  template <class Visit>
  void for_each(std::int32_t row, double low, double high, const Visit& visit) const {
    const double first = std::clamp(low / cell_ - 2, 0.0, double(columns_)),
                 last = std::clamp(high / cell_ + 2, 0.0, double(columns_));
    for (auto column = std::int32_t(first); column < std::int32_t(last); ++column) {
      const Place& place = places_[std::size_t((row & (side - 1)) * side + (column & (side - 1)))];
      const double along = (column + double(place.shift)) * cell_;
      if (place.below > 0 && along >= low && along < high && along < width_) visit(along, double(place.below));
    }
  }

 private:
  struct Place {
    float shift;  ///< place of the dot within its cell, 0 to 1
    float below;
  };

  double cell_, width_;
  std::int32_t columns_;
  std::vector<Place> places_;
};

}  // namespace frontmost::lines_detail
