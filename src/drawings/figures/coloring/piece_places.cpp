// SPDX-License-Identifier: Apache-2.0
// These numbers were chosen by eye: the number of samples for the area and length of a piece, and the size below which
// its middle gives its colour. Two samples per pixel find the details of a picture of the same size. Large pieces take
// fewer, because their cuts sample again where colours differ.
#include "figures/coloring/piece_places.h"

#include <algorithm>
#include <cmath>

namespace frontmost::shading {
namespace {

/// Square pixels, and pixels from end to end: smaller pieces have the colour of their middle.
constexpr double kLeastArea = 1.5, kLeastLength = 2;
/// Square pixels per sample, for usual and for large pieces. Pixels per sample, for slivers. The least number of
/// samples of a piece, and the number of samples from which a piece counts as large.
constexpr double kAreaPerSample = 2, kMostAreaPerSample = 9, kLengthPerSample = 1;
constexpr double kFewSamples = 4, kManySamples = 64;

}  // namespace

PieceSize::PieceSize(std::span<const glm::dvec2> corners) {
  const glm::dvec2 from = corners[0];
  glm::dvec2 sum(0), before(0);
  for (const glm::dvec2& corner : corners) {
    const glm::dvec2 way = corner - from;
    area += before.x * way.y - before.y * way.x;
    length = std::max(length, glm::length(way));
    sum += way;
    before = way;
  }
  area = std::abs(area) * 0.5;
  middle = from + sum / double(corners.size());
}

bool PieceSize::is_small() const { return area < kLeastArea && length < kLeastLength; }

double PieceSize::sample_count() const {
  const double wanted = std::max(area / kAreaPerSample, length / kLengthPerSample);
  return std::max(std::clamp(wanted, kFewSamples, kManySamples), area / kMostAreaPerSample);
}

glm::dvec2 middle_across(std::span<const glm::dvec2> corners, const glm::dvec2& at, const glm::dvec2& along) {
  glm::dvec2 sum(0);
  int count = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec2 &p = corners[i], &q = corners[i + 1 == corners.size() ? 0 : i + 1];
    const double a = glm::dot(p - at, along), b = glm::dot(q - at, along);
    if ((a > 0) == (b > 0)) continue;
    sum += p + (q - p) * (a / (a - b));
    ++count;
  }
  return count > 0 ? sum / double(count) : at;
}

CutOutline cut_outline(std::span<const glm::dvec2> corners, const ScreenLine& line) {
  CutOutline sides;
  const std::size_t count = corners.size();
  for (std::size_t i = 0; i < count; ++i) {
    const glm::dvec2 &from = corners[i], &to = corners[i + 1 == count ? 0 : i + 1];
    const double a = line.distance(from), b = line.distance(to);
    (a > 0 ? sides.above : sides.below).push_back(from);
    if ((a > 0) == (b > 0)) continue;
    const glm::dvec2 at = from + (to - from) * (a / (a - b));
    sides.below.push_back(at);
    sides.above.push_back(at);
  }
  return sides;
}

}  // namespace frontmost::shading
