// SPDX-License-Identifier: Apache-2.0
// How high a trap may be along a side, where occluders hide only a part of what is beside it.
//
//    most  ________            __________________       Above the side some parts are open (o): there a trap
//                  \          /                         would be seen. The trap stays below them, by a pixel or
//             ooo   \________/    oo                    six tenths of the way, and rises and falls by at most
//            ooooo   knot  knot   oooo                  one pixel for every pixel along the side, so that its
//    ==========================================         rim never runs along an outline.
//                      the side
#pragma once

#include <vector>

#include "painter/seen/outlines.h"
#include "painter/traps/trap.h"

namespace frontmost::painter_detail {

/// Heights above a side, on straight lines between knots. Not for several threads at once.
class TrapProfile {
 public:
  /// For a side from a place on, whose way has unit length.
  void begin(const glm::dvec2& from, const glm::dvec2& way);
  /// Parts of what is beside it that are not hidden.
  void add_open(const OutlineClipper& open);
  /// As high as is hidden, `most` at most; less towards what is open, and some way from it, so that no rim of a
  /// trap runs along an outline: viewers would blend both, and it would grow bold.
  [[nodiscard]] const std::vector<TrapKnot>& fit(double length, double most);

 private:
  struct Part {
    std::size_t first, count;
  };
  [[nodiscard]] double height_at(double along, double most) const;
  void place_knots(double length, double most);
  void leave_out(double least_gain);

  glm::dvec2 from_{0}, way_{0};
  std::vector<glm::dvec2> corners_;  ///< along the side, and above it
  std::vector<Part> parts_;
  std::vector<double> places_;
  std::vector<TrapKnot> knots_;
};

}  // namespace frontmost::painter_detail
