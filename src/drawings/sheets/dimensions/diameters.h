// SPDX-License-Identifier: Apache-2.0
// Diameters on leader lines: the circles that get one, each once on the sheet, and the places of the numbers.
//
// A cylinder that another shape cuts is found in several parts; parts with one axis and one radius count as one.
// Circles that only end a chamfer at a wall have no diameter.
#pragma once

#include <string>

#include "sheets/dimensions/dimension_pen.h"
#include "sheets/dimensions/measured_view.h"

namespace frontmost::detail {

inline const std::string diameter_sign = "\u2300";

/// The diameters of a sheet, each once.
class Diameters {
 public:
  Diameters(const DimensionOptions& options, DimensionPen& pen, const Obstacles& obstacles)
      : options_(options), pen_(pen), obstacles_(obstacles) {}

  /// Marks a cylinder and its continuations as dimensioned. \returns false if it was already.
  bool take(const Round& round);
  /// Adds the diameters that this view shows and no earlier view does.
  void add(const MeasuredView& view, Dimensions& all);
  /// Counts the cylinders of a view without a diameter, because no view draws them or because they are prisms. Call it
  /// after all views were added.
  void count_missing(const MeasuredView& view, Dimensions& all);

 private:
  struct Group {
    std::string text;
    std::vector<SeenCircle> circles;  ///< at different places
  };
  /// A leader from a circle to the shelf under its number.
  struct Leader {
    glm::dvec2 tip, knee, end;
    TextAlign align;
    double cost;
  };

  [[nodiscard]] std::vector<Group> groups_of(const MeasuredView& view);
  [[nodiscard]] bool is_taken(const Round& round) const;
  [[nodiscard]] std::optional<Leader> best_leader(const Group& group, std::string_view text) const;

  const DimensionOptions& options_;
  DimensionPen& pen_;
  const Obstacles& obstacles_;
  std::vector<Round> taken_;
  std::size_t placed_ = 0;
};

}  // namespace frontmost::detail
