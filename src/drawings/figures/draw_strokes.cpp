// SPDX-License-Identifier: Apache-2.0
// Strokes over a picture. Ink is a matter of distance, so that strokes may meet and cross without a seam:
//
//        pixel               A pixel is taken as a strip as wide as a pixel, across the nearest stroke. The share of
//     --[--o--]------        the strip that lies within half the pen's width of the stroke is ink. A pixel near
//     =====|========= pen    several strokes takes the largest share.
//
// Bands of rows are drawn at the same time. Largest shares do not depend on the order of strokes.
#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "base/srgb.h"
#include "frontmost/sheets.h"
#include "geometry/buckets.h"

namespace frontmost {
namespace {

constexpr int band_height = 16;

struct InkLine {
  glm::dvec2 from, to;
};

// Each condition is written so that NaN fails.
void check(const PicturePen& pen) {
  if (!(pen.width >= 0.1 && pen.width <= 1000))
    throw Error(ErrorCode::bad_argument, "pen", "the width must be from 0.1 to 1000 pixels");
  for (int k = 0; k < 3; ++k)
    if (!(pen.color[k] >= 0 && pen.color[k] <= 1))
      throw Error(ErrorCode::bad_argument, "pen", "each part of the colour must be from 0 to 1");
}

void check(const Strokes& strokes) {
  constexpr double farthest = 1e9;  // pixels; rows and columns of points beyond do not fit into integers
  for (const glm::dvec2& point : strokes.points)
    if (!(std::abs(point.x) <= farthest && std::abs(point.y) <= farthest))
      throw Error(ErrorCode::bad_argument, "strokes", "points must be finite, and at most 1e9 pixels from zero");
  if (std::any_of(strokes.bulges.begin(), strokes.bulges.end(), [](double bulge) { return bulge != 0; }))
    throw Error(ErrorCode::bad_argument, "strokes", "must have no arcs: leave StrokeOptions::arc_tolerance at 0");
}

/// The lines of all strokes that may leave ink on a picture of this size.
std::vector<InkLine> lines_within(const Strokes& strokes, const glm::dvec2& size, double reach) {
  std::vector<InkLine> lines;
  for (const Stroke& stroke : strokes.strokes)
    for (std::uint32_t i = 0; i + (stroke.is_closed ? 0 : 1) < stroke.count; ++i) {
      const InkLine line{strokes.points[stroke.first + i], strokes.points[stroke.first + (i + 1) % stroke.count]};
      const glm::dvec2 low = glm::min(line.from, line.to) - reach, high = glm::max(line.from, line.to) + reach;
      if (low.x < size.x && low.y < size.y && high.x > 0 && high.y > 0) lines.push_back(line);
    }
  return lines;
}

/// The shares of ink in a band of rows.
class InkBand {
 public:
  InkBand(int width, double radius) : width_(width), radius_(radius), shares_(std::size_t(width) * band_height) {}

  void clear() { std::fill(shares_.begin(), shares_.end(), 0.0f); }
  [[nodiscard]] const float* row(int y) const { return &shares_[std::size_t(y) * std::size_t(width_)]; }

  /// Draws a line into the rows from `top` to `bottom`, without `bottom`.
  void draw(const InkLine& line, int top, int bottom) {
    const double reach = radius_ + 0.5;
    const glm::dvec2 way = line.to - line.from;
    const double square = glm::dot(way, way);
    const int first = std::max(top, int(std::floor(std::max(std::min(line.from.y, line.to.y) - reach, double(top))))),
              last =
                  std::min(bottom, int(std::ceil(std::min(std::max(line.from.y, line.to.y) + reach, double(bottom)))));
    for (int y = first; y < last; ++y) {
      const double middle = y + 0.5;
      // The part of the line that lies within reach of the row.
      double begin = 0, end = 1;
      if (way.y != 0) {
        const double a = (middle - reach - line.from.y) / way.y, b = (middle + reach - line.from.y) / way.y;
        begin = std::clamp(std::min(a, b), 0.0, 1.0);
        end = std::clamp(std::max(a, b), 0.0, 1.0);
      }
      const double x0 = line.from.x + begin * way.x, x1 = line.from.x + end * way.x;
      const int left = int(std::clamp(std::floor(std::min(x0, x1) - reach), 0.0, double(width_))),
                right = int(std::clamp(std::ceil(std::max(x0, x1) + reach), 0.0, double(width_)));
      float* const shares = &shares_[std::size_t(y - top) * std::size_t(width_)];
      for (int x = left; x < right; ++x) {
        const glm::dvec2 to_pixel = glm::dvec2(x + 0.5, middle) - line.from;
        const double t = square > 0 ? std::clamp(glm::dot(to_pixel, way) / square, 0.0, 1.0) : 0;
        shares[x] = std::max(shares[x], share(glm::length(to_pixel - t * way)));
      }
    }
  }

 private:
  [[nodiscard]] float share(double distance) const {
    return float(std::max(std::min(radius_, distance + 0.5) - std::max(-radius_, distance - 0.5), 0.0));
  }

  int width_;
  double radius_;
  std::vector<float> shares_;
};

/// Blends the ink into one pixel, in linear light or in sRGB. `alpha` is null for opaque pictures.
struct InkBlend {
  explicit InkBlend(const PicturePen& pen) : in_srgb(pen.blend == Blend::srgb) {
    for (int k = 0; k < 3; ++k) {
      srgb[k] = pen.color[k];
      linear[k] = linear_of_srgb(srgb[k]);
    }
  }

  void operator()(float share, float* const (&color)[3], float* alpha) const {
    const float before = alpha ? *alpha : 1, after = share + before * (1 - share);
    for (int k = 0; k < 3; ++k) {
      float& value = *color[k];
      if (in_srgb && before > 0) {
        const float old = float(srgb16_of_linear(value / before)) / 65535;
        const float mixed = (srgb[k] * share + old * before * (1 - share)) / after;
        value = linear_of_srgb(mixed) * after;
      } else {
        value = linear[k] * share + value * (1 - share);
      }
    }
    if (alpha) *alpha = after;
  }

  bool in_srgb;
  float srgb[3], linear[3];
};

/// The planes R, G, B and A of a picture; A is null if there is none.
struct PaintedPlanes {
  explicit PaintedPlanes(Image& picture) {
    const char* const names[] = {"R", "G", "B", "A"};
    for (int k = 0; k < 4; ++k) {
      Channel* const channel = picture.find(names[k]);
      if (!channel && k == 3) continue;
      if (!channel || channel->is_integer())
        throw Error(ErrorCode::bad_argument, "picture", "needs planes of floats R, G and B to draw strokes over");
      planes[k] = channel->floats().data();
    }
  }
  float* planes[4] = {};
};

}  // namespace

void draw_strokes(Image& picture, const Strokes& strokes, const PicturePen& pen, const Execution& execution) {
  validate(picture);
  check(pen);
  check(strokes);
  const PaintedPlanes planes(picture);
  const InkBlend blend(pen);
  const double radius = pen.width / 2, reach = radius + 0.5;
  const std::vector<InkLine> lines = lines_within(strokes, {picture.width, picture.height}, reach);
  const int bands = (picture.height + band_height - 1) / band_height;
  const auto band_of = [&](double y) { return int(std::clamp(std::floor(y / band_height), 0.0, bands - 1.0)); };
  const auto list = [&](std::size_t i, const auto& add) {
    const int last = band_of(std::max(lines[i].from.y, lines[i].to.y) + reach);
    for (int band = band_of(std::min(lines[i].from.y, lines[i].to.y) - reach); band <= last; ++band)
      add(std::size_t(band), std::uint32_t(i));
  };
  const Buckets<std::uint32_t> by_band(std::size_t(bands), lines.size(), list, execution);
  parallel_for(execution, std::size_t(bands), 4, [&](std::size_t begin, std::size_t end) {
    InkBand ink(picture.width, radius);
    for (std::size_t band = begin; band < end; ++band) {
      if (by_band[band].empty()) continue;
      check_cancelled(execution);
      const int top = int(band) * band_height, bottom = std::min(top + band_height, picture.height);
      ink.clear();
      for (const std::uint32_t number : by_band[band]) ink.draw(lines[number], top, bottom);
      for (int y = top; y < bottom; ++y) {
        const float* const shares = ink.row(y - top);
        for (int x = 0; x < picture.width; ++x) {
          if (shares[x] == 0) continue;
          const std::size_t at = std::size_t(y) * std::size_t(picture.width) + std::size_t(x);
          float* const color[3] = {planes.planes[0] + at, planes.planes[1] + at, planes.planes[2] + at};
          blend(shares[x], color, planes.planes[3] ? planes.planes[3] + at : nullptr);
        }
      }
    }
  });
}

}  // namespace frontmost
