// SPDX-License-Identifier: Apache-2.0
#include "painter/order/piece_grid.h"

#include <algorithm>
#include <cmath>

namespace frontmost::painter_detail {
namespace {

/// Finer cells hold fewer pieces that do not overlap, and list each piece more often: at most so many times on average.
constexpr double kEntriesPerPiece = 4;
constexpr double kPiecesPerCell = 2;
constexpr std::size_t kFewPieces = 16;
constexpr double kMostColumns = 4096;

}  // namespace

PieceGrid::PieceGrid(const std::vector<PolygonExtent>& extents) {
  choose_cells(extents);
  first_.assign(std::size_t(columns_.x) * std::size_t(columns_.y) + 1, 0);
  const auto for_each = [&](const auto& visit) {
    for (std::uint32_t i = 0; i < extents.size(); ++i) {
      const Range r = range(extents[i]);
      for (int y = r.first_y; y <= r.last_y; ++y)
        for (int x = r.first_x; x <= r.last_x; ++x) visit(number(x, y), i);
    }
  };
  for_each([&](std::size_t cell, std::uint32_t) { ++first_[cell + 1]; });
  for (std::size_t i = 0; i + 1 < first_.size(); ++i) first_[i + 1] += first_[i];
  entries_.resize(first_.back());
  std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
  for_each([&](std::size_t cell, std::uint32_t i) { entries_[next[cell]++] = i; });
}

/// Square cells, as small as the number of pieces asks for and the size of their boxes allows: a box of w x h pixels
/// touches about (1 + w s) (1 + h s) cells of size 1 / s.
void PieceGrid::choose_cells(const std::vector<PolygonExtent>& extents) {
  if (extents.size() <= kFewPieces) return;
  glm::vec2 low(std::numeric_limits<float>::infinity()), high(-low);
  // Pieces may reach far beyond the picture; the grid covers where the middle of most is.
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

}  // namespace frontmost::painter_detail
