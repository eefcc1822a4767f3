// SPDX-License-Identifier: Apache-2.0
#include "painter/outlines.h"

#include <algorithm>

namespace frontmost::painter_detail {
namespace {

/// The widest that an outline of this area and border can be is about this.
bool is_thin(std::span<const PaintCorner> outline) {
  double area = 0, border = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const glm::dvec2 p(outline[i].at), q(outline[i + 1 == outline.size() ? 0 : i + 1].at), from(outline[0].at);
    area += (p.x - from.x) * (q.y - from.y) - (q.x - from.x) * (p.y - from.y);
    border += glm::length(q - p);
  }
  return std::abs(area) < OutlineCutter::thin * border;
}

bool is_beside(std::span<const PaintCorner> a, std::span<const PaintCorner> b) {
  glm::dvec2 low_a(a[0].at), high_a = low_a, low_b(b[0].at), high_b = low_b;
  for (const PaintCorner& corner : a) {
    low_a = glm::min(low_a, glm::dvec2(corner.at));
    high_a = glm::max(high_a, glm::dvec2(corner.at));
  }
  for (const PaintCorner& corner : b) {
    low_b = glm::min(low_b, glm::dvec2(corner.at));
    high_b = glm::max(high_b, glm::dvec2(corner.at));
  }
  return low_a.x >= high_b.x || low_b.x >= high_a.x || low_a.y >= high_b.y || low_b.y >= high_a.y;
}

}  // namespace

void OutlineCutter::begin(std::span<const PaintCorner> outline) {
  left_.clear();
  left_.add(outline);
  is_changed_ = false;
}

OutlineCutter::Split OutlineCutter::split(const std::vector<PaintCorner>& outline, const Line& line) {
  const std::size_t count = outline.size();
  distances_.resize(count);
  double least = 0, greatest = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const glm::dvec2 at = glm::dvec2(outline[i].at) - line.from;
    distances_[i] = line.along.x * at.y - line.along.y * at.x;
    least = std::min(least, distances_[i]);
    greatest = std::max(greatest, distances_[i]);
  }
  if (greatest < thin) return Split::inside;
  if (least > -thin) return Split::outside;
  rest_ = outline;
  inside_.clear();
  outside_.clear();
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t next = i + 1 == count ? 0 : i + 1;
    const PaintCorner& corner = rest_[i];
    const double a = distances_[i], b = distances_[next];
    if (a <= 0) inside_.push_back(corner);
    if (a > 0) outside_.push_back(corner);
    if ((a <= 0) == (b <= 0)) continue;
    PaintCorner cut{corner.at + (rest_[next].at - corner.at) * (a / (a - b)), corner.is_cut};
    PaintCorner turn{cut.at, true};
    inside_.push_back(a <= 0 ? turn : cut);
    outside_.push_back(a <= 0 ? cut : turn);
  }
  return Split::both;
}

void OutlineCutter::subtract_from(std::span<const PaintCorner> outline, std::span<const PaintCorner> cover) {
  const std::size_t before = next_.count();
  inside_.assign(outline.begin(), outline.end());
  for (std::size_t i = 0; i < cover.size(); ++i) {
    const glm::dvec2 from(cover[i].at), way = glm::dvec2(cover[i + 1 == cover.size() ? 0 : i + 1].at) - from;
    const double length = glm::length(way);
    if (length < 1e-9) continue;
    const Split found = split(inside_, {from, way / length});
    if (found == Split::inside) continue;
    if (found == Split::outside) {
      next_.shrink(before);
      next_.add(outline);
      return;
    }
    if (!is_thin(outside_)) next_.add(outside_);
  }
  is_changed_ = true;
}

bool OutlineCutter::subtract(std::span<const PaintCorner> cover) {
  next_.clear();
  for (std::size_t i = 0; i < left_.count(); ++i) {
    if (is_beside(left_[i], cover))
      next_.add(left_[i]);
    else
      subtract_from(left_[i], cover);
  }
  std::swap(left_, next_);
  return left_.count() == 0;
}

void OutlineCutter::keep_within(const glm::dvec2& low, const glm::dvec2& high) {
  const Line sides[] = {{low, {0, 1}}, {low, {-1, 0}}, {high, {0, -1}}, {high, {1, 0}}};
  next_.clear();
  for (std::size_t i = 0; i < left_.count(); ++i) {
    inside_.assign(left_[i].begin(), left_[i].end());
    bool is_there = true;
    for (const Line& side : sides) {
      const Split found = split(inside_, side);
      is_there = is_there && found != Split::outside;
      is_changed_ = is_changed_ || found != Split::inside;
    }
    if (is_there && !is_thin(inside_)) next_.add(inside_);
  }
  std::swap(left_, next_);
}

}  // namespace frontmost::painter_detail
