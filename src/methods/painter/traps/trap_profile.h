// SPDX-License-Identifier: Apache-2.0
// The height of a trap along a side whose surroundings are only partly hidden.
//
//    most  ________            __________________       Above the side some parts are open (o): a trap would be
//                  \          /                         visible there. The trap stays below them, by a pixel or
//             ooo   \________/    oo                    six tenths of the way, and rises and falls by at most
//            ooooo   knot  knot   oooo                  one pixel for every pixel along the side, so that its
//    ==========================================         rim never runs along an outline.
//                      the side
#pragma once

#include <vector>

#include "painter/seen/outlines.h"
#include "painter/traps/trap.h"

namespace frontmost::painter_detail {

/// Heights above a side, linear between knots. Not for several threads at once.
class TrapProfile {
 public:
  /// Begins a side at `from` with the direction `way`, of unit length.
  void begin(const glm::dvec2& from, const glm::dvec2& way);
  /// Adds parts beside the side that are not hidden.
  void add_open(const OutlineClipper& open);
  /// The hidden height, at most `most`, reduced towards open parts and some way from them. So no rim of a trap runs
  /// along an outline: viewers would blend both, and the outline would grow bold.
  [[nodiscard]] const std::vector<TrapKnot>& fit(double length, double most);

 private:
  struct Part {
    std::size_t first, count;
  };
  [[nodiscard]] double height_at(double along, double most) const;
  void place_knots(double length, double most);
  void leave_out(double least_gain);

  glm::dvec2 from_{0}, way_{0};
  std::vector<glm::dvec2> corners_;  ///< (along the side, above it)
  std::vector<Part> parts_;
  std::vector<double> places_;
  std::vector<TrapKnot> knots_;
};

}  // namespace frontmost::painter_detail
