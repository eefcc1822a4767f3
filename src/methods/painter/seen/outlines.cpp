// SPDX-License-Identifier: Apache-2.0
// In nearly all pairs of outlines, one lies beside or within the other. These cases are found first, mostly without a
// root or a copy; only the remaining pairs are cut.
//
//     ____________________     A part that a cover meets is split along the lines of the cover's sides, one after the
//    |      kept 1        |    other. The piece outside of a line becomes a part of its own; the piece inside goes on
//    |--------------------|    to the next line. The piece inside of all lines is hidden. Convex parts stay convex, so
//    | kept 2 |  hidden   |    a part needs no structure but its corners.
//    |________|___________|
#include "painter/seen/outlines.h"

#include <algorithm>

namespace frontmost::painter_detail {
namespace {

constexpr std::size_t kMostParts = 48;

std::size_t next(std::size_t i, std::size_t count) { return i + 1 == count ? 0 : i + 1; }

}  // namespace

bool is_narrow(Outline outline, double width) {
  double area = 0, most_border = 0, border = 0;
  const glm::dvec2 from(outline[0].at);
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const glm::dvec2 p(outline[i].at), q(outline[next(i, outline.size())].at), way = q - p;
    area += turn(p - from, q - from);
    most_border += std::abs(way.x) + std::abs(way.y);
  }
  // Most outlines are so wide that their border needs no roots.
  if (constexpr double spare = 1.001; std::abs(area) > spare * width * most_border) return false;
  for (std::size_t i = 0; i < outline.size(); ++i)
    border += glm::length(glm::dvec2(outline[next(i, outline.size())].at) - glm::dvec2(outline[i].at));
  return !(std::abs(area) > width * border);
}

void OutlineClipper::add(Outline outline) {
  Part part{corners_.size(), outline.size(), glm::dvec2(outline[0].at), glm::dvec2(outline[0].at)};
  for (const PaintCorner& corner : outline) {
    part.low = glm::min(part.low, glm::dvec2(corner.at));
    part.high = glm::max(part.high, glm::dvec2(corner.at));
  }
  corners_.insert(corners_.end(), outline.begin(), outline.end());
  parts_.push_back(part);
}

OutlineClipper::Place OutlineClipper::place(Outline outline, const glm::dvec2& p, const glm::dvec2& q, Line& line) {
  const glm::dvec2 way = q - p;
  double least = std::numeric_limits<double>::infinity(), greatest = -least;
  for (const PaintCorner& corner : outline) {
    const double distance = turn(way, glm::dvec2(corner.at) - p);
    least = std::min(least, distance);
    greatest = std::max(greatest, distance);
  }
  if (greatest <= 0) return Place::inside;
  if (least >= 0) return Place::outside;
  const double length = glm::length(way), allowed = thin * length;
  if (length < shortest_side || greatest < allowed) return Place::inside;
  if (least > -allowed) return Place::outside;
  line = {p, way / length};
  return Place::both;
}

bool OutlineClipper::parts(Outline a, Outline b) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    const glm::dvec2 p(a[i].at), way = glm::dvec2(a[next(i, a.size())].at) - p;
    bool is_beyond = glm::dot(way, way) > thin * thin;  // cuts leave a corner twice, and such a side separates nothing
    for (std::size_t k = 0; is_beyond && k < b.size(); ++k) is_beyond = turn(way, glm::dvec2(b[k].at) - p) >= 0;
    if (is_beyond) return true;
  }
  return false;
}

OutlineClipper::Place OutlineClipper::split(Outline outline, const Line& line, bool keeps_inside) {
  const std::size_t count = outline.size();
  if (distances_.size() < count) distances_.resize(count);
  double* const distances = distances_.data();
  double least = 0, greatest = 0;
  for (std::size_t i = 0; i < count; ++i) {
    distances[i] = turn(line.along, glm::dvec2(outline[i].at) - line.from);
    least = std::min(least, distances[i]);
    greatest = std::max(greatest, distances[i]);
  }
  if (greatest < thin) return Place::inside;
  if (least > -thin) return Place::outside;
  inside_.begin(2 * count);
  outside_.begin(2 * count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t after = next(i, count);
    const PaintCorner& corner = outline[i];
    const double a = distances[i], b = distances[after];
    const bool is_inside = a <= 0;
    if (!is_inside) outside_.add(corner);
    if (is_inside && keeps_inside) inside_.add(corner);
    if (is_inside == (b <= 0)) continue;
    const PaintCorner cut{corner.at + (outline[after].at - corner.at) * (a / (a - b)), corner.is_cut};
    const PaintCorner bend{cut.at, true};
    outside_.add(is_inside ? cut : bend);
    if (keeps_inside) inside_.add(is_inside ? bend : cut);
  }
  return Place::both;
}

/// \returns true if the part is to be removed; what remains of it was added.
bool OutlineClipper::subtract_from(std::size_t part, Outline cover, bool may_split) {
  Outline outline = (*this)[part];
  lines_.clear();
  for (std::size_t i = 0; i < cover.size(); ++i) {
    Line line{};
    const Place found = place(outline, glm::dvec2(cover[i].at), glm::dvec2(cover[next(i, cover.size())].at), line);
    if (found == Place::outside) return false;
    if (found == Place::both) lines_.push_back(line);
  }
  if (lines_.empty()) return true;
  if (!may_split || parts(outline, cover)) return false;
  const std::size_t parts_before = parts_.size(), corners_before = corners_.size();
  for (const Line& line : lines_) {
    const Place found = split(outline, line, &line != &lines_.back());
    if (found == Place::outside) {
      parts_.resize(parts_before);
      corners_.resize(corners_before);
      return false;
    }
    if (found == Place::inside) continue;
    if (!is_narrow(outside_.outline(), thin)) add(outside_.outline());
    std::swap(rest_, inside_);
    outline = rest_.outline();
  }
  return true;
}

bool OutlineClipper::subtract(const Cover& cover) {
  const std::size_t count = parts_.size();
  const bool may_split = count <= kMostParts;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (!is_apart(parts_[i], cover) && subtract_from(i, cover.outline, may_split)) continue;
    if (kept != i) parts_[kept] = parts_[i];
    ++kept;
  }
  if (kept == count) return count == 0;
  parts_.erase(parts_.begin() + std::ptrdiff_t(kept), parts_.begin() + std::ptrdiff_t(count));
  is_changed_ = true;
  return parts_.empty();
}

void OutlineClipper::keep_within(const glm::dvec2& low, const glm::dvec2& high) {
  const Line sides[] = {{low, {0, 1}}, {low, {-1, 0}}, {high, {0, -1}}, {high, {1, 0}}};
  const std::vector<Part> before = parts_;
  parts_.clear();
  for (const Part& part : before) {
    if (part.low.x >= low.x && part.low.y >= low.y && part.high.x <= high.x && part.high.y <= high.y) {
      parts_.push_back(part);
      continue;
    }
    is_changed_ = true;
    rest_.begin(part.count);
    for (std::size_t i = 0; i < part.count; ++i) rest_.add(corners_[part.first + i]);
    const bool is_left = std::all_of(std::begin(sides), std::end(sides), [&](const Line& side) {
      const Place found = split(rest_.outline(), side, true);
      if (found == Place::both) std::swap(rest_, inside_);
      return found != Place::outside;
    });
    if (is_left && !is_narrow(rest_.outline(), thin)) add(rest_.outline());
  }
}

}  // namespace frontmost::painter_detail
