// SPDX-License-Identifier: Apache-2.0
// A line on the screen is a plane through the eye. A vertex' height over it is a linear function in eye space. Signs at
// the vertices tell which sides of the triangle the line crosses, even if some lie behind the eye.
//
// A vertex exactly on a line counts as above it. So a line crosses two sides of a triangle or none, and passes fans of
// triangles without a gap: both triangles at a side compute the same place, from the side's lower vertex.
#include "hatching/hatch_rows.h"

#include <algorithm>
#include <cmath>

namespace frontmost::lines_detail {
namespace {

/// Sines differ between C libraries in their last bit, but not as floats.
glm::dvec2 direction_of(double angle) {
  return glm::normalize(glm::dvec2(float(std::cos(angle)), -float(std::sin(angle))));
}

}  // namespace

HatchRows::HatchRows(const HatchSet& set, const View& view)
    : size_(view.width, view.height),
      direction_(direction_of(set.angle)),
      across_(-direction_.y, direction_.x),
      spacing_(set.spacing),
      offset_(set.offset),
      near_(view.projection.clip.near),
      is_parallel_(view.projection.orthographic) {
  const Projection& p = view.projection;
  const glm::dvec2 scale(view.width / (p.right - p.left), -view.height / (p.top - p.bottom));
  plane_ = {across_ * scale, -glm::dot(across_, scale * glm::dvec2(p.left, p.top))};
  const double heights[] = {0, across_.x * view.width, across_.y * view.height,
                            across_.x * view.width + across_.y * view.height};
  const auto [low, high] = std::minmax_element(std::begin(heights), std::end(heights));
  picture_ = {std::int32_t(std::ceil((*low - offset_) / spacing_)),
              std::int32_t(std::floor((*high - offset_) / spacing_))};
}

double HatchRows::within_picture(std::int32_t line, double along) const {
  const glm::dvec2 start = point(line, 0);
  for (int axis = 0; axis < 2; ++axis) {
    if (direction_[axis] == 0) continue;
    const double a = -start[axis] / direction_[axis], b = (size_[axis] - start[axis]) / direction_[axis];
    along = std::clamp(along, std::min(a, b), std::max(a, b));
  }
  return along;
}

HatchRows::Range HatchRows::range_of(const HatchedTriangle& triangle) const {
  double low = 1e300, high = -1e300;
  for (const glm::dvec3& corner : triangle.in_eye) {
    if (!is_parallel_ && corner.z < near_) return picture_;
    const double height = weighted_height(corner) / weight(corner);
    low = std::min(low, height);
    high = std::max(high, height);
  }
  // One more on each side, because the division rounds; the signs in segment() decide. Clamped before the conversion.
  const auto number = [&](double height) {
    return std::clamp((height - offset_) / spacing_, picture_.first - 2.0, picture_.last + 2.0);
  };
  return {std::max(picture_.first, std::int32_t(std::ceil(number(low))) - 1),
          std::min(picture_.last, std::int32_t(std::floor(number(high))) + 1)};
}

std::optional<HatchSegment> HatchRows::segment(const HatchedTriangle& triangle, std::int32_t line) const {
  double heights[3];
  for (int k = 0; k < 3; ++k)
    heights[k] = weighted_height(triangle.in_eye[k]) - height_of(line) * weight(triangle.in_eye[k]);
  HatchSegment segment;
  glm::dvec3 places[2];
  EndOn on[2];
  int count = 0;
  for (int k = 0; k < 3; ++k) {
    int p = k, q = k == 2 ? 0 : k + 1;
    if ((heights[p] >= 0) == (heights[q] >= 0)) continue;
    // Computed from the lower vertex, for both triangles.
    if (triangle.vertices[p] > triangle.vertices[q]) std::swap(p, q);
    const double from_p = std::abs(heights[p]), t = from_p / (from_p + std::abs(heights[q]));
    const glm::dvec3 &from = triangle.places[p], &to = triangle.places[q];
    places[count] = t <= 0.5 ? from + (to - from) * t : to + (from - to) * (1 - t);
    on[count] = {triangle.vertices[p], triangle.vertices[q]};
    // A place at a vertex lies in all planes of that vertex.
    if (places[count] == from) on[count][1] = on[count][0];
    if (places[count] == to) on[count][0] = on[count][1];
    (count == 0 ? segment.from : segment.to) = {p, q, t};
    ++count;
  }
  if (count < 2 || places[0] == places[1]) return std::nullopt;
  segment.edge = {places[0], places[1], on[0], on[1], {triangle.number, no_index}, slack_of(places[0], places[1])};
  return segment;
}

}  // namespace frontmost::lines_detail
