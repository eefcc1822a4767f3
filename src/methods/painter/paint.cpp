// SPDX-License-Identifier: Apache-2.0
// Paints an order. Coverage and keys are those of the z-buffer: from vertices snapped to 1/256 pixel, by the top-left
// rule. So a correct order gives the picture of the z-buffer, apart from samples at the rims of cuts.
//
// A polygon that was cut is filled like its triangle, but only with samples on the polygon's side of every cut. So the
// pieces of a triangle together cover its samples, each once, except on the cuts themselves, where both pieces have the
// same id.
#include <algorithm>
#include <cmath>
#include <optional>

#include "base/parallel.h"
#include "frontmost/painter.h"
#include "surfaces/cluster_set.h"
#include "view/clip.h"
#include "view/screen_cutout.h"
#include "view/triangle_keys.h"

namespace frontmost {
namespace {

/// Lengths in pixels: how far snapping may move a corner, how far beyond a cut a sample still counts as on the cut, and
/// the length of the shortest cut that counts. Corners where planes meet at small angles are so inaccurate that a cut
/// between two near corners has no direction.
constexpr double kSnapping = 1.0 / 128, kOnCut = 1e-9, kShortest = 1.0 / 1024;

/// Vertices in 1/256 pixel from the image's top left, clockwise with y down.
struct SnappedTriangle {
  std::array<std::int32_t, 3> x, y;
  std::array<float, 3> key;

  SnappedTriangle(const ScreenTransform& t, const std::array<ScreenVertex, 3>& corners) {
    for (std::size_t i = 0; i < 3; ++i) {
      x[i] = corners[i].x + t.centre_x;
      y[i] = corners[i].y + t.centre_y;
      key[i] = corners[i].key;
    }
    if (area() >= 0) return;
    std::swap(x[1], x[2]);
    std::swap(y[1], y[2]);
    std::swap(key[1], key[2]);
  }
  [[nodiscard]] std::int64_t area() const { return doubled_area(*this); }

  /// Precondition: area() > 0.
  [[nodiscard]] bool covers(std::int64_t px, std::int64_t py) const {
    for (std::size_t a = 0; a < 3; ++a) {
      const std::size_t b = a == 2 ? 0 : a + 1;
      const std::int64_t dx = x[b] - x[a], dy = y[b] - y[a];
      const std::int64_t edge = dx * (py - y[a]) - dy * (px - x[a]);
      const bool is_left_or_top = dy < 0 || (dy == 0 && dx > 0);
      if (edge < 0 || (edge == 0 && !is_left_or_top)) return false;
    }
    return true;
  }
};

/// The part of a polygon's triangle that cuts leave.
class CutTriangle {
 public:
  explicit CutTriangle(std::span<const PaintCorner> corners) {
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const glm::dvec2 p(corners[i].at), q(corners[i + 1 == corners.size() ? 0 : i + 1].at);
      low_ = glm::min(low_, p);
      high_ = glm::max(high_, p);
      const double length = glm::length(q - p);
      if (corners[i].is_cut && length > kShortest) cuts_.push_back({p, (q - p) / length});
    }
  }
  [[nodiscard]] glm::dvec2 low() const { return low_ - kSnapping; }
  [[nodiscard]] glm::dvec2 high() const { return high_ + kSnapping; }
  /// Returns whether the cuts leave the point (x, y). A sliver whose cuts are all too short to count holds all of its
  /// box.
  [[nodiscard]] bool holds(double x, double y) const {
    if (x < low().x || y < low().y || x > high().x || y > high().y) return false;
    return std::all_of(cuts_.begin(), cuts_.end(), [&](const Cut& cut) {
      return cut.along.x * (y - cut.from.y) - cut.along.y * (x - cut.from.x) <= kOnCut;
    });
  }

 private:
  struct Cut {
    glm::dvec2 from, along;
  };
  std::vector<Cut> cuts_;
  glm::dvec2 low_{std::numeric_limits<double>::infinity()}, high_{-std::numeric_limits<double>::infinity()};
};

class Canvas {
 public:
  Canvas(const Surfaces& surfaces, const PaintOrder& order)
      : surfaces_(surfaces),
        order_(order),
        transform_(order.view),
        rays_(order.view),
        samples_(sample_offsets(order.view.samples)),
        picture_(nothing_visible(order.view)) {}

  void paint(const PaintPolygon& polygon) {
    const CutTriangle outline({order_.corners.data() + polygon.first_corner, polygon.corner_count});
    const ClippedPolygon clipped = clip_triangle(transform_, surfaces_.corners(polygon.id));
    const Cutouts* const cutouts = placed_scene(surfaces_).cutouts.get();
    std::optional<ScreenCutout> holes;
    if (cutouts && cutouts->has(polygon.id)) holes.emplace((*cutouts)[polygon.id], rays_);
    for (std::size_t k = 2; k < std::size_t(clipped.count); ++k) {
      const SnappedTriangle triangle(transform_, {clipped.corners[0], clipped.corners[k - 1], clipped.corners[k]});
      if (triangle.area() != 0) fill(triangle, outline, holes, polygon.id);
    }
  }
  [[nodiscard]] Visible take() { return std::move(picture_); }

 private:
  /// The pixels of one axis that lie within an interval in 1/256 pixel and an interval in pixels.
  struct Run {
    int first, last;
  };
  static Run run(const std::array<std::int32_t, 3>& at, double low, double high, int count) {
    const auto [least, greatest] = std::minmax({at[0], at[1], at[2]});
    low = std::max({low, double(least) / kSubPixels, 0.0});
    high = std::min({high, double(greatest) / kSubPixels, count - 0.5});
    return {int(std::min(low, double(count))), int(std::max(high, -1.0))};
  }

  void fill(const SnappedTriangle& triangle, const CutTriangle& outline, const std::optional<ScreenCutout>& holes,
            PrimitiveId id) {
    const TriangleKeys keys(triangle);
    const Run columns = run(triangle.x, outline.low().x, outline.high().x, order_.view.width);
    const Run rows = run(triangle.y, outline.low().y, outline.high().y, order_.view.height);
    for (std::size_t s = 0; s < samples_.size(); ++s)
      for (int y = rows.first; y <= rows.last; ++y)
        for (int x = columns.first; x <= columns.last; ++x) {
          const int px = x * kSubPixels + samples_[s].x, py = y * kSubPixels + samples_[s].y;
          if (!triangle.covers(px, py) || !outline.holds(double(px) / kSubPixels, double(py) / kSubPixels)) continue;
          if (holes && holes->is_hole(px, py)) continue;
          const std::size_t i = picture_.index(x, y, int(s));
          picture_.primitives[i] = id;
          picture_.keys[i] = keys.at(px, py);
        }
  }

  const Surfaces& surfaces_;
  const PaintOrder& order_;
  const ScreenTransform transform_;
  const ScreenRays rays_;
  const std::span<const glm::ivec2> samples_;
  Visible picture_;
};

void check(const Surfaces& surfaces, const PaintOrder& order) {
  for (const PaintPolygon& polygon : order.polygons)
    if (polygon.id >= surfaces.primitive_count() || polygon.first_corner > order.corners.size() ||
        polygon.corner_count > order.corners.size() - polygon.first_corner)
      throw Error(ErrorCode::bad_argument, "paint", "the order was made for other surfaces");
}

}  // namespace

Visible paint(const Surfaces& surfaces, const PaintOrder& order) {
  const IeeeScope ieee;
  check(surfaces, order);
  Canvas canvas(surfaces, order);
  for (const PaintPolygon& polygon : order.polygons) canvas.paint(polygon);
  return canvas.take();
}

}  // namespace frontmost
