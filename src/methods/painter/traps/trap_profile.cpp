// SPDX-License-Identifier: Apache-2.0
// The height of a trap is computed at the few places where it can change: at the corners of open parts, and where lines
// of the steepest slope from these corners reach the full height. Between such places the highest trap is never lower
// than the straight line, so knots there suffice. Knots that gain little area are then left out, because every knot is
// two numbers in the file.
#include "painter/traps/trap_profile.h"

#include <algorithm>
#include <cmath>

namespace frontmost::painter_detail {
namespace {

/// Heights change by at most this much for every pixel along a side.
constexpr double kSteepest = 1;
/// A trap ends this many pixels before open parts above it, or this share of the way to them.
constexpr double kProfileMargin = 1, kProfileMarginPart = 0.6;
/// The least area that a knot must gain, relative to the square of the greatest height.
constexpr double kLeastGain = 1.0 / 16;

}  // namespace

void TrapProfile::begin(const glm::dvec2& from, const glm::dvec2& way) {
  from_ = from;
  way_ = way;
  corners_.clear();
  parts_.clear();
}

void TrapProfile::add_open(const OutlineClipper& open) {
  for (std::size_t i = 0; i < open.count(); ++i) {
    parts_.push_back({corners_.size(), open[i].size()});
    for (const PaintCorner& corner : open[i]) {
      const glm::dvec2 at = glm::dvec2(corner.at) - from_;
      const double height = std::max(0.0, way_.x * at.y - way_.y * at.x);
      corners_.push_back({glm::dot(way_, at), height - std::min(kProfileMargin, kProfileMarginPart * height)});
    }
  }
}

const std::vector<TrapKnot>& TrapProfile::fit(double length, double most) {
  place_knots(length, most);
  knots_.clear();
  for (const double along : places_) knots_.push_back({along, height_at(along, most)});
  leave_out(kLeastGain * most * most);
  return knots_;
}

/// Places knots. Between places the height is nowhere below the straight line.
void TrapProfile::place_knots(double length, double most) {
  places_.assign({0, length});
  const auto add = [&](double along) {
    if (along > 0 && along < length) places_.push_back(along);
  };
  for (const glm::dvec2& corner : corners_) {
    if (corner.y >= most) continue;
    add(corner.x);
    add(corner.x - (most - corner.y) / kSteepest);
    add(corner.x + (most - corner.y) / kSteepest);
  }
  for (const Part& part : parts_)
    for (std::size_t i = 0; i < part.count; ++i) {
      const glm::dvec2 &a = corners_[part.first + i], &b = corners_[part.first + (i + 1 == part.count ? 0 : i + 1)];
      if ((a.y < most) != (b.y < most)) add(a.x + (b.x - a.x) * ((most - a.y) / (b.y - a.y)));
    }
  std::sort(places_.begin(), places_.end());
  const auto is_same = [](double a, double b) { return b - a < OutlineClipper::thin; };
  places_.erase(std::unique(places_.begin(), places_.end() - 1, is_same), places_.end() - 1);
}

double TrapProfile::height_at(double along, double most) const {
  double least = most;
  for (const glm::dvec2& corner : corners_) least = std::min(least, corner.y + kSteepest * std::abs(along - corner.x));
  for (const Part& part : parts_)
    for (std::size_t i = 0; i < part.count; ++i) {
      const glm::dvec2 &a = corners_[part.first + i], &b = corners_[part.first + (i + 1 == part.count ? 0 : i + 1)];
      if ((a.x < along) == (b.x < along)) continue;
      least = std::min(least, a.y + (b.y - a.y) * ((along - a.x) / (b.x - a.x)));
    }
  return std::max(least, 0.0);
}

/// Leaves out knots, the one of the least gain first, as long as the line past a knot is nowhere higher.
void TrapProfile::leave_out(double least_gain) {
  while (knots_.size() > 2) {
    std::size_t best = 0;
    double least = least_gain;
    for (std::size_t i = 1; i + 1 < knots_.size(); ++i) {
      const TrapKnot &a = knots_[i - 1], &b = knots_[i], &c = knots_[i + 1];
      const double part = (b.along - a.along) / (c.along - a.along);
      const double above = b.height - (a.height + (c.height - a.height) * part);
      const double gain = 0.5 * above * (c.along - a.along);
      if (above < -1e-9 || gain >= least) continue;
      least = gain;
      best = i;
    }
    if (best == 0) return;
    knots_.erase(knots_.begin() + std::ptrdiff_t(best));
  }
}

}  // namespace frontmost::painter_detail
