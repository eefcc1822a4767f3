// SPDX-License-Identifier: Apache-2.0
#include "shade/figure/coloring/piece_places.h"

#include <algorithm>
#include <cmath>

#include "painter/hem_shape.h"

namespace frontmost::shading {
namespace {

/// Square pixels, and pixels from end to end: smaller pieces have the colour of their middle.
constexpr double kLeastArea = 1.5, kLeastLength = 2;
/// Square pixels a sample, of pieces of some size and of large ones; pixels, of slivers; and the fewest.
constexpr double kAreaPerSample = 2, kMostAreaPerSample = 9, kLengthPerSample = 1;
constexpr double kFewSamples = 4, kManySamples = 64;

constexpr painter_detail::HemShape kHemShapes[] = {{1, 0.5},
                                                   {1, 2},
                                                   {0.5, 0.5},
                                                   {0.5, 2},
                                                   {0.25, 0.5},
                                                   {0.25, 2},
                                                   {1, 0, 0.45, 0.45},
                                                   {1, 0.5, 0, 0.85},
                                                   {1, 0.5, 0.85},
                                                   {0.25, 0, 0.45, 0.45},
                                                   {0.25, 0.5, 0, 0.85},
                                                   {0.25, 0.5, 0.85},
                                                   {0.0625, 1},
                                                   {0.0625, 4}};
/// Pixels that hems stay away from the other sides of where they lie: rims that meet are blended twice.
constexpr double kMargin = 0.5;

}  // namespace

PieceSize::PieceSize(std::span<const PieceCorner> corners) {
  const glm::dvec2 from(corners[0].at);
  glm::dvec2 sum(0), before(0);
  for (const PieceCorner& corner : corners) {
    const glm::dvec2 way = glm::dvec2(corner.at) - from;
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

glm::dvec2 middle_across(std::span<const PieceCorner> corners, const glm::dvec2& at, const glm::dvec2& along) {
  glm::dvec2 sum(0);
  int count = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec2 p(corners[i].at), q(corners[i + 1 == corners.size() ? 0 : i + 1].at);
    const double a = glm::dot(p - at, along), b = glm::dot(q - at, along);
    if ((a > 0) == (b > 0)) continue;
    sum += p + (q - p) * (a / (a - b));
    ++count;
  }
  return count > 0 ? sum / double(count) : at;
}

CutOutline cut_outline(std::span<const PieceCorner> corners, const ScreenLine& line, std::uint32_t cut) {
  CutOutline sides;
  const std::size_t count = corners.size();
  for (std::size_t i = 0; i < count; ++i) {
    const PieceCorner &from = corners[i], &to = corners[i + 1 == count ? 0 : i + 1];
    const double a = line.distance(glm::dvec2(from.at)), b = line.distance(glm::dvec2(to.at));
    std::vector<PieceCorner>&here = a > 0 ? sides.above : sides.below, &there = a > 0 ? sides.below : sides.above;
    here.push_back(from);
    if ((a > 0) == (b > 0)) continue;
    const glm::dvec3 at = from.at + (to.at - from.at) * (a / (a - b));
    here.push_back({{at, true}, cut});               // from here along the cut
    there.push_back({{at, from.is_cut}, from.cut});  // from here along what was there
  }
  return sides;
}

std::optional<std::array<PaintCorner, 2>> hem_within(const PaintCorner& from, const PaintCorner& to,
                                                     std::span<const ScreenLine> room, double width) {
  const glm::dvec3 way = to.at - from.at;
  const double length = glm::length(glm::dvec2(way));
  if (!(length > 1e-6)) return std::nullopt;
  const glm::dvec3 along = way / length, out(-along.y, along.x, 0);
  const auto is_within = [&](const glm::dvec3& at, double margin) {
    return std::all_of(room.begin(), room.end(),
                       [&](const ScreenLine& line) { return line.distance(glm::dvec2(at)) >= margin; });
  };
  for (const painter_detail::HemShape& shape : kHemShapes) {
    const double reach = width * shape.part, margin = std::min(kMargin, reach * 0.5);
    const auto [from_inset, to_inset] = shape.insets(reach, length);
    const std::array<PaintCorner, 2> hem{PaintCorner{from.at + along * from_inset + out * reach, true},
                                         PaintCorner{to.at - along * to_inset + out * reach, true}};
    if (is_within(hem[0].at, margin) && is_within(hem[1].at, margin)) return hem;
  }
  return std::nullopt;
}

void append_sides(std::span<const PaintCorner> outline, std::vector<ScreenLine>& lines) {
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const glm::dvec2 p(outline[i].at), way = glm::dvec2(outline[i + 1 == outline.size() ? 0 : i + 1].at) - p;
    const double length = glm::length(way);
    if (!(length > 0)) continue;
    const glm::dvec2 within = glm::dvec2(way.y, -way.x) / length;
    lines.push_back({within, glm::dot(within, p)});
  }
}

}  // namespace frontmost::shading
