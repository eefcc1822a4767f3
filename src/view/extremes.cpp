// SPDX-License-Identifier: Apache-2.0
#include "view/extremes.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace frontmost {
namespace {

bool comes_before(const glm::vec3& a, const glm::vec3& b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); }

}  // namespace

Extremes::Extremes(const glm::dmat4& axes, const glm::dvec2& spread)
    : right_(axes[0]), up_(axes[1]), back_(axes[2]), spread_(spread) {
  constexpr double step = 6.283185307179586 / around;
  for (int k = 0; k < around; ++k) {
    // Rounded to floats: the last bits of sine and cosine differ between C libraries.
    const bool is_axis = k % (around / 4) == 0;
    const double c = double(float(std::cos(k * step))), s = double(float(std::sin(k * step)));
    cosine_[k] = is_axis ? std::round(c) : c;
    sine_[k] = is_axis ? std::round(s) : s;
  }
  for (int plane = 0; plane < 2; ++plane) {
    const glm::dvec3& across = plane == 0 ? right_ : up_;
    for (int k = 0; k < in_plane; ++k) {
      const glm::dvec3 d = k < around ? cosine_[k] * across + sine_[k] * back_
                                      : across * ((k == around ? 1 : -1) / spread_[plane]) + back_;
      const int i = plane * in_plane + k;
      x_[i] = d.x;
      y_[i] = d.y;
      z_[i] = d.z;
    }
  }
  std::fill_n(reach_, direction_count, -std::numeric_limits<double>::infinity());
}

void Extremes::include(const glm::vec3& point) {
  const glm::dvec3 p(point);
  const double towards = glm::dot(p, back_);
  for (int plane = 0; plane < 2; ++plane) {
    const double across = glm::dot(p, plane == 0 ? right_ : up_);
    const int first = plane * in_plane;
    for (int k = 0; k < around; ++k) offer(first + k, across * cosine_[k] + towards * sine_[k], point);
    // To the bit what the fitting of a frustum computes of the point.
    offer(first + around, across / spread_[plane] + towards, point);
    offer(first + around + 1, -across / spread_[plane] + towards, point);
  }
}

void Extremes::offer(int direction, double reach, const glm::vec3& point) {
  Kept& kept = kept_[direction];
  if (kept.is_set && (reach < reach_[direction] || (reach == reach_[direction] && !comes_before(point, kept.point))))
    return;
  reach_[direction] = reach;
  kept = {point, true};
}

bool Extremes::may_change_by(const Box& box) const {
  const glm::dvec3 low(box.low), high(box.high), middle = 0.5 * (low + high), half = 0.5 * (high - low);
  // More than all rounding, so that no point is passed over that would tie.
  const glm::dvec3 size = glm::abs(middle) + half;
  const double spare = 1e-12 * (size.x + size.y + size.z);
  bool may = false;
  for (int i = 0; i < direction_count; ++i) {
    const double ax = std::abs(x_[i]), ay = std::abs(y_[i]), az = std::abs(z_[i]);
    const double reach = middle.x * x_[i] + middle.y * y_[i] + middle.z * z_[i] + half.x * ax + half.y * ay +
                         half.z * az + spare * (ax + ay + az);
    may |= reach >= reach_[i];
  }
  return may;
}

std::vector<glm::vec3> Extremes::points() const {
  std::vector<glm::vec3> points;
  for (const Kept& kept : kept_)
    if (kept.is_set) points.push_back(kept.point);
  std::sort(points.begin(), points.end(), comes_before);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return points;
}

}  // namespace frontmost
