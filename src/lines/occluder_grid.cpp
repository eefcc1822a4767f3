// SPDX-License-Identifier: Apache-2.0
#include "lines/occluder_grid.h"

#include <cmath>
#include <limits>

namespace frontmost::lines_detail {
namespace {

/// One cell for so many triangles: from 1 to 16 the times hardly differ.
constexpr double kTrianglesPerCell = 4;
constexpr double kMostCells = 1 << 22;

/// Grows by what rounding may have moved a corner, also one far outside of the picture.
double widened(double value, double direction) { return value + direction * 1e-9 * (1 + std::abs(value)); }

float rounded_down(double value) {
  const float nearest = float(value);
  return double(nearest) <= value ? nearest : std::nextafter(nearest, -std::numeric_limits<float>::infinity());
}
float rounded_up(double value) { return -rounded_down(-value); }

}  // namespace

OccluderGrid::Outline OccluderGrid::outline_of(const WeldedMesh& mesh, const Sight& sight,
                                               std::uint32_t triangle) const {
  const glm::uvec3& corners = mesh.triangles[triangle];
  glm::dvec3 in_eye[3];
  for (int k = 0; k < 3; ++k) in_eye[k] = sight.in_eye(mesh.positions[corners[k]]);
  Outline outline;
  outline.nearest = std::numeric_limits<double>::infinity();
  const auto add = [&](const glm::dvec3& p) {
    outline.corners[std::size_t(outline.count++)] = glm::dvec2(sight.to_screen(p)) * scale_;
    outline.nearest = std::min(outline.nearest, widened(p.z, -1));
  };
  for (int k = 0; k < 3; ++k) {
    const glm::dvec3 &p = in_eye[k], &q = in_eye[(k + 1) % 3];
    if (p.z >= sight.near()) add(p);
    if ((p.z < sight.near()) == (q.z < sight.near())) continue;
    glm::dvec3 cut = p + (q - p) * ((sight.near() - p.z) / (q.z - p.z));
    cut.z = sight.near();
    add(cut);
  }
  return outline;
}

template <class Visit>
void OccluderGrid::cover(const Outline& outline, const Visit& visit) const {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  glm::dvec2 low(infinite), high(-infinite);
  for (int i = 0; i < outline.count; ++i) {
    low = glm::min(low, outline.corners[std::size_t(i)]);
    high = glm::max(high, outline.corners[std::size_t(i)]);
  }
  low = {widened(low.x, -1), widened(low.y, -1)};
  high = {widened(high.x, 1), widened(high.y, 1)};
  if (!(low.x <= columns_ && low.y <= rows_ && high.x >= 0 && high.y >= 0)) return;
  const int first_row = row(low.y - kPad), last_row = row(high.y + kPad);
  const bool is_small = last_row - first_row < 2;
  for (int y = first_row; y <= last_row; ++y) {
    double left = low.x, right = high.x;
    if (!is_small) {
      // Of the outline between the row's two sides alone.
      left = infinite, right = -infinite;
      const double top = y - kPad, bottom = y + 1 + kPad;
      for (int i = 0; i < outline.count; ++i) {
        const glm::dvec2 &p = outline.corners[std::size_t(i)],
                         &q = outline.corners[std::size_t(i + 1 == outline.count ? 0 : i + 1)];
        if (std::min(p.y, q.y) > bottom || std::max(p.y, q.y) < top) continue;
        for (const double side : {std::clamp(p.y, top, bottom), std::clamp(q.y, top, bottom)}) {
          const double x = p.y == q.y ? p.x : p.x + (q.x - p.x) * ((side - p.y) / (q.y - p.y));
          left = std::min({left, x, p.y == q.y ? q.x : x});
          right = std::max({right, x, p.y == q.y ? q.x : x});
        }
      }
      left = std::max(low.x, widened(left, -1));
      right = std::min(high.x, widened(right, 1));
    }
    const int last_column = column(right + kPad);
    for (int x = column(left - kPad); x <= last_column; ++x) visit(number(x, y), low, high);
  }
}

OccluderGrid::OccluderGrid(const WeldedMesh& mesh, const std::vector<std::int8_t>& facing, const Sight& sight,
                           const View& view) {
  const double pixels = double(view.width) * view.height;
  const double cells = std::clamp(double(mesh.triangles.size()) / kTrianglesPerCell, 1.0, kMostCells);
  const double size = std::sqrt(pixels / cells);
  columns_ = std::max(1, int(std::ceil(view.width / size)));
  rows_ = std::max(1, int(std::ceil(view.height / size)));
  scale_ = glm::dvec2(1 / size);

  first_.assign(std::size_t(columns_) * std::size_t(rows_) + 1, 0);
  const auto for_each = [&](const auto& visit) {
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      if (facing[t] == 0) continue;
      const Outline outline = outline_of(mesh, sight, t);
      if (outline.count == 0 || outline.nearest > sight.far()) continue;
      cover(outline, [&](std::size_t cell, const glm::dvec2& low, const glm::dvec2& high) {
        visit(cell, t, outline.nearest, low, high);
      });
    }
  };
  for_each([&](std::size_t cell, auto&&...) { ++first_[cell + 1]; });
  for (std::size_t i = 0; i + 1 < first_.size(); ++i) first_[i + 1] += first_[i];
  occluders_.resize(first_.back());
  std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
  for_each([&](std::size_t cell, std::uint32_t t, double nearest, const glm::dvec2& low, const glm::dvec2& high) {
    occluders_[next[cell]++] = {
        {rounded_down(low.x), rounded_down(low.y)}, {rounded_up(high.x), rounded_up(high.y)}, rounded_down(nearest), t};
  });
  for (std::size_t i = 0; i + 1 < first_.size(); ++i)
    std::sort(occluders_.begin() + std::ptrdiff_t(first_[i]), occluders_.begin() + std::ptrdiff_t(first_[i + 1]),
              [](const Occluder& a, const Occluder& b) {
                return a.nearest != b.nearest ? a.nearest < b.nearest : a.triangle < b.triangle;
              });
}

}  // namespace frontmost::lines_detail
