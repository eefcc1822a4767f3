// SPDX-License-Identifier: Apache-2.0
// The graphic elements of dimensions, in the proportions of ISO 129:
//
//      |             |          extension lines begin 1 mm from the measured feature
//      |<---- 50 --->|          and end 2 mm beyond the dimension line
//      |             |
#pragma once

#include <string_view>

#include "frontmost/sheets.h"
#include "sheets/dimensions/obstacles.h"

namespace frontmost::detail {

inline constexpr double extension_gap = 1;        // millimetres between the measured feature and its extension line
inline constexpr double extension_overshoot = 2;  // beyond the dimension line
inline constexpr double first_distance = 10;      // of a dimension line from the view
inline constexpr double text_distance = 1;        // of a number from its line, and from everything else

/// Draws into the groups of a layer, and registers everything drawn as obstacles.
class DimensionPen {
 public:
  DimensionPen(const DimensionOptions& options, Obstacles& obstacles);

  void line(const glm::dvec2& from, const glm::dvec2& to);
  void arrow(const glm::dvec2& tip, const glm::dvec2& pointing);
  /// Draws text above `at`, which is the middle or an end of its line; level, or upright to be read from the right.
  void text(std::string_view text, const glm::dvec2& at, TextAlign align, bool is_upright = false);

  [[nodiscard]] double width_of(std::string_view text) const { return text_width(text, options_.text_height); }
  [[nodiscard]] double arrow_length() const { return 12 * options_.pen.width; }
  /// The box of a level text above a place, with some room around it.
  [[nodiscard]] PageBox box_of(std::string_view text, const glm::dvec2& at, TextAlign align) const;

  [[nodiscard]] std::vector<PageGroup> take();

 private:
  const DimensionOptions& options_;
  Obstacles& obstacles_;
  PageGroup lines_, texts_;
};

}  // namespace frontmost::detail
