// SPDX-License-Identifier: Apache-2.0
// Where dots may be, and how dark it has to be for each: blue noise, the same everywhere.
//
//    row 3   .  o    .   o      Each square cell holds one place, a little off its middle so that no columns
//    row 2     .   o  .   .     show. A place has a dot (o) where it is darker than the place asks for; the
//    row 1   o   .    o   .     places ask in the order of their ranks, so dots thin out evenly.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace frontmost::lines_detail {

/// Rows of places, one to a square cell, each asking for a darkness of its own. However dark it is, those that are
/// drawn lie about equally far apart. Repeats after 64 cells, 32 times the spacing.
class DotGrid {
 public:
  static constexpr int side = 64;

  /// Pixels: between dots where it is darkest, and of the picture.
  DotGrid(double spacing, double width);
  [[nodiscard]] static double cell_of(double spacing) { return spacing / 2; }

  /// Calls visit(place along the row, brightness below which it has a dot) for the places from `low` to `high`, but for
  /// the latter, within the picture.
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
    float shift;  ///< of the dot within its cell, 0 to 1
    float below;
  };

  double cell_, width_;
  std::int32_t columns_;
  std::vector<Place> places_;
};

}  // namespace frontmost::lines_detail
