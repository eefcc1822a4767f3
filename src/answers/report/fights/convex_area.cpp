// SPDX-License-Identifier: Apache-2.0
// Cutting follows I. Sutherland, G. Hodgman. Reentrant Polygon Clipping. 1974.
#include "report/fights/convex_area.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace frontmost {
namespace {

constexpr double kNoArea = 1e-12;  // square pixels: area that rounding may give to a line

constexpr double kRim = 1e-6;  // pixels: a sample on a side belongs to both areas beside it

/// The part of a horizontal line within an area.
struct Chord {
  std::int64_t line;
  double begin, end;

  friend bool operator<(const Chord& a, const Chord& b) {
    return a.line != b.line ? a.line < b.line : a.begin < b.begin;
  }
};

struct VerticalReach {
  double top, bottom;

  explicit VerticalReach(std::span<const glm::dvec2> corners) : top(corners[0].y), bottom(top) {
    for (const glm::dvec2& corner : corners) {
      top = std::min(top, corner.y);
      bottom = std::max(bottom, corner.y);
    }
  }
};

/// Appends the chords of an area with the lines at (n + 0.5) * spacing.
void append_chords(std::span<const glm::dvec2> corners, double spacing, std::vector<Chord>& chords) {
  const VerticalReach height(corners);
  auto line = std::int64_t(std::ceil(height.top / spacing - 0.5));
  for (; (double(line) + 0.5) * spacing < height.bottom; ++line) {
    const double y = (double(line) + 0.5) * spacing;
    Chord chord{line, std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const glm::dvec2 &a = corners[i], &b = corners[i + 1 == corners.size() ? 0 : i + 1];
      if ((a.y <= y) == (b.y <= y)) continue;
      const double x = a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y));
      chord.begin = std::min(chord.begin, x);
      chord.end = std::max(chord.end, x);
    }
    if (chord.begin < chord.end) chords.push_back(chord);
  }
}

}  // namespace

void ConvexArea::cut(const AffineOverScreen& f) {
  const auto is_inside = [&](const glm::dvec2& corner) { return f.at(corner) >= 0; };
  if (std::all_of(corners_.begin(), corners_.end(), is_inside)) return;
  std::swap(corners_, before_);
  corners_.clear();
  double last = f.at(before_.back());
  glm::dvec2 from = before_.back();
  for (const glm::dvec2& to : before_) {
    const double next = f.at(to);
    if ((last < 0) != (next < 0)) corners_.push_back(from + (to - from) * (last / (last - next)));
    if (next >= 0) corners_.push_back(to);
    last = next;
    from = to;
  }
  if (area() <= kNoArea) corners_.clear();
}

double ConvexArea::area() const {
  double doubled = 0;
  for (std::size_t i = 2; i < corners_.size(); ++i) {
    const glm::dvec2 a = corners_[i - 1] - corners_[0], b = corners_[i] - corners_[0];
    doubled += a.x * b.y - b.x * a.y;
  }
  return 0.5 * doubled;
}

glm::dvec2 ConvexArea::centre() const {
  glm::dvec2 sum(0);
  for (const glm::dvec2& corner : corners_) sum += corner;
  return sum / double(corners_.size());
}

AffineOverScreen inside_of_side(const glm::dvec2& from, const glm::dvec2& to) {
  const glm::dvec2 normal(from.y - to.y, to.x - from.x);
  return {-glm::dot(normal, from), normal};
}

RowSpan span_of(std::span<const glm::dvec2> corners, const glm::dvec2& sample, int width) {
  double low = -1, high = width;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const AffineOverScreen f = inside_of_side(corners[i], corners[i + 1 == corners.size() ? 0 : i + 1]);
    const double rest = f.constant + f.gradient.y * sample.y, slope = f.gradient.x;
    if (slope > 0) low = std::max(low, -rest / slope - sample.x - kRim);
    if (slope < 0) high = std::min(high, -rest / slope - sample.x + kRim);
    if (slope == 0 && rest < -kRim * std::abs(f.gradient.y)) return {0, 0};
  }
  // Bounds far beside the row would not fit an int.
  low = std::min(low, double(width));
  high = std::max(high, -1.0);
  const int first = std::max(int(std::ceil(low)), 0), end = std::min(int(std::floor(high)) + 1, width);
  return {first, std::max(first, end)};
}

double UnionShare::find() const {
  if (areas_.size() == 1) return 1;
  constexpr double kMostChords = 1 << 16;
  double heights = 0;
  for (const std::span<const glm::dvec2> corners : areas_) {
    const VerticalReach height(corners);
    heights += height.bottom - height.top;
  }
  const double spacing = std::max(1.0 / 16, heights / kMostChords);
  std::vector<Chord> chords;
  for (const std::span<const glm::dvec2> corners : areas_) append_chords(corners, spacing, chords);
  std::sort(chords.begin(), chords.end());
  double all = 0, united = 0, reached = 0;
  for (std::size_t i = 0; i < chords.size(); ++i) {
    const Chord& chord = chords[i];
    if (i == 0 || chord.line != chords[i - 1].line) reached = chord.begin;
    all += chord.end - chord.begin;
    united += std::max(chord.end - std::max(chord.begin, reached), 0.0);
    reached = std::max(reached, chord.end);
  }
  return all > 0 ? united / all : 1;
}

}  // namespace frontmost
