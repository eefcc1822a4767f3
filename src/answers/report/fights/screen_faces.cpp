// SPDX-License-Identifier: Apache-2.0
// Placing the faces, and bounding the errors that positions and floats add to their keys.
#include "report/fights/screen_faces.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/parallel.h"
#include "zbuffer/place/submission.h"

namespace frontmost {
namespace {

using namespace zbuffer_detail;

constexpr int kBlock = 8;          // pixels
constexpr double kUnit = 0x1p-24;  // unit roundoff of a float

/// The errors of positions in a view.
class PlaceErrors {
 public:
  PlaceErrors(const ScreenTransform& t, const View& view)
      : orthographic_(t.orthographic), centre_(t.centre_x, t.centre_y) {
    const auto row = [](const std::array<float, 3>& r) { return glm::dvec3(r[0], r[1], r[2]); };
    const glm::dvec3 forward = glm::normalize(row(t.d_row));
    const glm::dvec3 rows[] = {row(t.x_row), row(t.y_row)};
    for (int axis = 0; axis < 2; ++axis) {
      shift_[axis] = orthographic_ ? 0 : std::abs(glm::dot(rows[axis], forward));
      scale_[axis] = glm::length(rows[axis] - forward * glm::dot(rows[axis], forward));
    }
    const double reach = std::abs(view.projection.clip.far);
    range_ = orthographic_ ? view.projection.clip.far - view.projection.clip.near : 0;
    reach_ = orthographic_ && std::isfinite(reach) ? 2 * std::max(reach, std::abs(view.projection.clip.near)) : 0;
  }

  /// Greatest distance of a face's corners from their true positions, in 1/256 pixel along each axis.
  [[nodiscard]] double of_place(const TriangleRecord& r) const {
    const glm::dvec2 off = farthest(r) + shift_;
    const double scale = std::max(scale_.x, scale_.y);
    // Rounded are a corner's differences to the eye, its products with the row, and their sums: 9 roundings in all, of
    // x and of the distance by which x is divided.
    if (orthographic_) return 0.5 + 9 * kUnit * (scale * reach_ + off.x + off.y);
    return 0.5 + 9 * kUnit * slant(off) * (scale + std::max(off.x, off.y));
  }
  /// Greatest change of a corner's key by rounding.
  [[nodiscard]] double of_key(const TriangleRecord& r) const {
    const double made = 2 * double(r.nearest());
    if (orthographic_) return kUnit * (9 * reach_ / range_ + made);
    return kUnit * (made + 9 * slant(farthest(r) + shift_) * double(r.nearest()));
  }

 private:
  /// Greatest distance of a corner from the middle of the picture, along each axis.
  [[nodiscard]] glm::dvec2 farthest(const TriangleRecord& r) const {
    glm::ivec2 most(0);
    for (int k = 0; k < 3; ++k) most = glm::max(most, glm::abs(glm::ivec2(r.x[k], r.y[k]) - centre_));
    return glm::dvec2(most);
  }
  /// Upper bound of the distance from the eye divided by the planar depth.
  [[nodiscard]] double slant(const glm::dvec2& off) const { return 1 + off.x / scale_.x + off.y / scale_.y; }

  bool orthographic_;
  glm::ivec2 centre_;
  glm::dvec2 shift_, scale_;  // in 1/256 pixel at depth 1
  double reach_, range_;
};

/// The slopes of a triangle's key, its size, and the effect of moved corners.
struct KeySlopes {
  double range, area, around;
  double x, y;  // slopes times the area, per 1/256 pixel

  explicit KeySlopes(const TriangleRecord& r) : area(double(doubled_area(r))), around(0), x(0), y(0) {
    const auto [low, high] = std::minmax({r.key[0], r.key[1], r.key[2]});
    range = double(high) - double(low);
    for (int k = 0; k < 3; ++k) {
      const int n = k == 2 ? 0 : k + 1, p = k == 0 ? 2 : k - 1;
      around += std::abs(double(r.x[n]) - r.x[k]) + std::abs(double(r.y[n]) - r.y[k]);
      x += double(r.key[k]) * (double(r.y[n]) - r.y[p]);
      y += double(r.key[k]) * (double(r.x[p]) - r.x[n]);
    }
  }
  /// Greatest difference, at any sample, between the face's plane in the world and its plane on the screen.
  [[nodiscard]] double of_moved_corners(double moved) const {
    const double lost = 2 * moved * around;
    // If little of the area remains, the plane may be any through the corners' keys.
    if (lost > 0.5 * area) return range;
    return std::min(range, (std::abs(x) + std::abs(y)) * moved / (area - lost));
  }
  /// Greatest effect of roundings between the corners (view/triangle_keys.h): at most sixteen roundings, and none if
  /// keys are equal.
  [[nodiscard]] double of_rounding(double nearest) const {
    if (range == 0) return 0;
    // No side is longer along x or y than half of the perimeter.
    const double across = 0.5 * around * (std::abs(x) + std::abs(y)) / area;
    return kUnit * std::min(16 * nearest, 2 * nearest + 4 * across);
  }
};

/// A float that is not less than a value.
float rounded_up(double value) { return std::nextafter(float(value), std::numeric_limits<float>::max()); }

}  // namespace

KeyStep::KeyStep(const DepthSetup& setup) {
  // Range of the keys between the planes; depths range from 0 to 1.
  const double span = setup.orthographic ? 1 : 1 - setup.clip.near / setup.clip.far;
  const int bits = integer_bits(setup.format);
  if (bits > 0)
    constant = span / double((std::uint32_t(1) << bits) - 1);
  else if (setup.reversed)
    relative = 2 * kUnit;
  else
    constant = span * kUnit;
}

KeyOverScreen ScreenFace::keys() const {
  const glm::dvec2 a = corner(0), b = corner(1) - a, c = corner(2) - a;
  const double scale = 1 / (b.x * c.y - c.x * b.y);
  const double kb = double(record.key[1]) - double(record.key[0]), kc = double(record.key[2]) - double(record.key[0]);
  const double gx = (kb * c.y - kc * b.y) * scale, gy = (b.x * kc - c.x * kb) * scale;
  return {double(record.key[0]) - a.x * gx - a.y * gy, gx, gy};
}

FarthestSeen::FarthestSeen(const Visible& visible)
    : columns_((visible.view.width + kBlock - 1) / kBlock),
      rows_((visible.view.height + kBlock - 1) / kBlock),
      keys_(std::size_t(columns_) * std::size_t(rows_), 2.0f) {
  const auto width = std::size_t(visible.view.width), height = std::size_t(visible.view.height);
  for (std::size_t row = 0; row * width < visible.keys.size(); ++row) {
    const float* const keys = visible.keys.data() + row * width;
    float* const blocks = keys_.data() + row % height / kBlock * std::size_t(columns_);
    const std::size_t whole = width / kBlock;
    for (std::size_t block = 0; block < whole; ++block) {
      float least = blocks[block];
      for (std::size_t x = 0; x < kBlock; ++x) least = std::min(least, keys[block * kBlock + x]);
      blocks[block] = least;
    }
    for (std::size_t x = whole * kBlock; x < width; ++x) blocks[whole] = std::min(blocks[whole], keys[x]);
  }
}

bool FarthestSeen::hides(const PixelRect& rect, float high) const {
  if (keys_.empty()) return false;
  const int x0 = std::max(rect.x0 - 1, 0) / kBlock, x1 = std::min((rect.x1 + 1) / kBlock, columns_ - 1);
  const int y0 = std::max(rect.y0 - 1, 0) / kBlock, y1 = std::min((rect.y1 + 1) / kBlock, rows_ - 1);
  for (int y = y0; y <= y1; ++y)
    for (int x = x0; x <= x1; ++x)
      if (high >= keys_[std::size_t(y) * std::size_t(columns_) + std::size_t(x)]) return false;
  return true;
}

std::vector<ScreenFace> screen_faces(const Surfaces& surfaces, const View& view, const KeyStep& step,
                                     const FarthestSeen& seen, const Execution& execution) {
  const ScreenTransform transform(view);
  const PlacedScene& placed = placed_scene(surfaces);
  const PlaceTarget target(transform, view, placed.sides.get(), execution.isa);
  const PlaceErrors errors(transform, view);
  const glm::ivec2 size(view.width * kSubPixels, view.height * kSubPixels);
  const auto finish = [&](const TriangleRecord& r, std::vector<ScreenFace>& faces) {
    const auto [x0, x1] = std::minmax({r.x[0], r.x[1], r.x[2]});
    const auto [y0, y1] = std::minmax({r.y[0], r.y[1], r.y[2]});
    if (x1 <= 0 || y1 <= 0 || x0 >= size.x || y0 >= size.y) return;
    const auto [low, high] = std::minmax({r.key[0], r.key[1], r.key[2]});
    const KeySlopes slopes(r);
    const double slack =
        slopes.of_moved_corners(errors.of_place(r)) + slopes.of_rounding(double(high)) + errors.of_key(r);
    const double margin = slack + 0.5 * step.at(high);
    const float reach = rounded_up(double(high) + margin);
    if (seen.hides(pixel_rect(r, view.width, view.height), reach)) return;
    faces.push_back({r, rounded_up(slack), -rounded_up(margin - double(low)), reach});
  };

  std::vector<std::vector<ScreenFace>> parts(placed.ranges.size());
  Pool<PlaceScratch> scratches;
  parallel_for(execution, parts.size(), 1, [&](std::size_t begin, std::size_t end) {
    const auto scratch = scratches.borrow([] { return std::make_unique<PlaceScratch>(); });
    std::vector<TriangleRecord> records;
    for (std::size_t i = begin; i < end; ++i) {
      const WorldTriangles triangles = world_triangles(placed, placed.ranges[i], execution.isa, *scratch);
      snap_vertices(target, triangles.positions, scratch->vertices);
      for (std::size_t k = 0; k < triangles.corners.size(); ++k) {
        const ClippedPolygon polygon = polygon_of(target, triangles, scratch->vertices, k);
        if (polygon.count == 0) continue;
        records.clear();
        append_polygon(target, polygon, PrimitiveId(triangles.first_id + k), records);
        for (const TriangleRecord& record : records) finish(record, parts[i]);
      }
    }
  });
  std::vector<ScreenFace> faces;
  faces.reserve(std::transform_reduce(parts.begin(), parts.end(), std::size_t(0), std::plus<>(),
                                      [](const std::vector<ScreenFace>& part) { return part.size(); }));
  for (const std::vector<ScreenFace>& part : parts) faces.insert(faces.end(), part.begin(), part.end());
  return faces;
}

}  // namespace frontmost
