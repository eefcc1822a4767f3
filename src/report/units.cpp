// SPDX-License-Identifier: Apache-2.0
// What unit a file may mean that says none.
#include <algorithm>

#include "frontmost/report.h"

namespace frontmost {
namespace {
constexpr double millimetre = 0.001, centimetre = 0.01, inch = 0.0254, metre = 1;
}  // namespace

std::vector<double> likely_units(const Box& bounds) {
  if (bounds.is_empty()) return {};
  const glm::dvec3 size = glm::dvec3(bounds.high) - glm::dvec3(bounds.low);
  const double greatest = std::max({size.x, size.y, size.z});
  constexpr double least_part = 5, greatest_part = 2000, grain = 1, least_in_metres = 0.001;
  if (!(greatest >= least_in_metres && greatest <= greatest_part)) return {};
  if (greatest >= least_part) return {millimetre};
  if (greatest < grain) return {metre};
  return {centimetre, inch, metre};
}

}  // namespace frontmost
