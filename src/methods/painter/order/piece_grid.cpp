// SPDX-License-Identifier: Apache-2.0
// Cells are chosen so that a piece is listed about four times and a cell lists about two pieces. Large boxes make that
// impossible; cells then grow until the lists fit, as more entries would cost more than they save.
#include "painter/order/piece_grid.h"

#include <algorithm>
#include <cmath>

namespace frontmost::painter_detail {
namespace {

/// Finer cells cause fewer tests of pieces that do not overlap, but list each piece more often: at most this often on
/// average.
constexpr double kEntriesPerPiece = 4;
constexpr double kPiecesPerCell = 2;
constexpr std::size_t kFewPieces = 16;
constexpr double kMostColumns = 4096;

constexpr std::size_t kFanout = 64;
/// Relative margin of coordinates, which is greater than their rounding.
constexpr double kBoxMargin = 1e-12;

/// Returns three orthogonal directions, the first along a triangle's normal.
std::array<glm::dvec3, 3> axes_of(const Face& face) {
  const glm::dvec3 a(face.corners[0]), b(face.corners[1]), c(face.corners[2]);
  const glm::dvec3 normal = glm::cross(b - a, c - a), along = b - a;
  const double length = glm::length(normal), reach = glm::length(along);
  const std::array<glm::dvec3, 3> axes{glm::dvec3(1, 0, 0), {0, 1, 0}, {0, 0, 1}};
  if (!(length > 0 && reach > 0 && length < 1e150)) return axes;
  // Rounding may give the normal of a needle any direction, even one that is not orthogonal to its side.
  const glm::dvec3 first = normal / length, side = along / reach, across = side - first * glm::dot(first, side);
  if (glm::length(across) < 0.5) return axes;
  const glm::dvec3 second = glm::normalize(across);
  return {first, second, glm::cross(first, second)};
}

}  // namespace

PieceGrid::PieceGrid(const std::vector<PolygonExtent>& extents) {
  choose_cells(extents);
  const auto list = [&](std::size_t i, const auto& add) {
    const Range r = range(extents[i]);
    for (int y = r.first_y; y <= r.last_y; ++y)
      for (int x = r.first_x; x <= r.last_x; ++x) add(number(x, y), std::uint32_t(i));
  };
  cells_ = {std::size_t(columns_.x) * std::size_t(columns_.y), extents.size(), list, {.threads = 1}};
}

/// Chooses square cells, as small as the number of pieces suggests and the size of their boxes allows: a box of w x h
/// pixels touches about (1 + w s) (1 + h s) cells of size 1 / s.
void PieceGrid::choose_cells(const std::vector<PolygonExtent>& extents) {
  if (extents.size() <= kFewPieces) return;
  glm::vec2 low(std::numeric_limits<float>::infinity()), high(-low);
  // Pieces may reach far beyond the picture, so the grid covers the middles of their boxes.
  for (const PolygonExtent& e : extents) {
    const glm::vec2 middle = (e.low + e.high) * 0.5f;
    if (!(middle.x - middle.x == 0 && middle.y - middle.y == 0)) continue;
    low = glm::min(low, middle);
    high = glm::max(high, middle);
  }
  if (!(low.x < high.x && low.y < high.y)) return;
  const double width = double(high.x) - low.x, height = double(high.y) - low.y, count = double(extents.size());
  double sides = 0, areas = 0;
  for (const PolygonExtent& e : extents) {
    const double w = std::clamp(double(e.high.x) - e.low.x, 0.0, width);
    const double h = std::clamp(double(e.high.y) - e.low.y, 0.0, height);
    sides += w + h;
    areas += w * h;
  }
  double scale = std::sqrt(count / kPiecesPerCell / (width * height));
  scale = std::min({scale, kMostColumns / width, kMostColumns / height});
  while (scale * std::max(width, height) > 1 && sides * scale + areas * scale * scale > (kEntriesPerPiece - 1) * count)
    scale *= 0.75;
  low_ = low;
  scale_ = glm::vec2(float(scale));
  columns_ = {std::max(1, int(std::ceil(width * scale))), std::max(1, int(std::ceil(height * scale)))};
}

PieceBoxes::PieceBoxes(const Pieces& all, const std::vector<std::uint32_t>& members,
                       std::span<const std::uint32_t> pieces)
    : count_(pieces.size()) {
  for (std::size_t size = kFanout; size <= count_; size *= kFanout) {
    std::vector<Box>& boxes = levels_.emplace_back();
    for (std::size_t first = 0; first < count_; first += size)
      boxes.push_back(box_of(all, members, pieces.subspan(first, std::min(size, count_ - first))));
  }
}

PieceBoxes::Box PieceBoxes::box_of(const Pieces& all, const std::vector<std::uint32_t>& members,
                                   std::span<const std::uint32_t> pieces) {
  const std::array<glm::dvec3, 3> axes = axes_of(all.face(members[pieces[pieces.size() / 2]]));
  glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
  double farthest = 0;
  for (const std::uint32_t piece : pieces)
    for (const glm::vec3& corner : all.face(members[piece]).corners) {
      const glm::dvec3 at(corner), along(glm::dot(axes[0], at), glm::dot(axes[1], at), glm::dot(axes[2], at));
      low = glm::min(low, along);
      high = glm::max(high, along);
      farthest = std::max(farthest, std::abs(at.x) + std::abs(at.y) + std::abs(at.z));
    }
  Box box{glm::dvec3(0), {}, kBoxMargin * farthest};
  for (std::size_t k = 0; k < 3; ++k) {
    const int axis = int(k);
    box.centre += axes[k] * (0.5 * (low[axis] + high[axis]));
    box.halves[k] = axes[k] * (0.5 * (high[axis] - low[axis]));
  }
  return box;
}

std::size_t PieceBoxes::count_before(std::size_t first, const Plane& plane) const {
  std::size_t size = kFanout, count = 0;
  for (const std::vector<Box>& boxes : levels_) {
    if (first % size != 0 || first >= count_) break;
    const Box& box = boxes[first / size];
    const Bounded height = plane.least_height(box.centre, box.halves, box.slack);
    if (!(height.value > height.error)) break;
    count = std::min(size, count_ - first);
    size *= kFanout;
  }
  return count;
}

}  // namespace frontmost::painter_detail
