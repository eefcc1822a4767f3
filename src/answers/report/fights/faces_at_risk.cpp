// SPDX-License-Identifier: Apache-2.0
// Places the faces, bounds the errors that positions and floats add to their keys, and clips the common area of two
// faces by two more lines. Clipping follows I. Sutherland, G. Hodgman. Reentrant Polygon Clipping. 1974.
#include "report/fights/faces_at_risk.h"

#include <array>
#include <limits>

#include "base/parallel.h"
#include "zbuffer/place/submission.h"

namespace frontmost {
namespace {

using namespace zbuffer_detail;

constexpr int kBlock = 8;          // pixels
constexpr double kUnit = 0x1p-24;  // unit roundoff of a float

/// The errors that rounding and snapping cause in the positions of a view.
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
    // These numbers are rounded: a corner's differences to the eye, their products with the row, and the sums of the
    // products. That makes 9 roundings at most for x, and as many for the distance by which x is divided.
    if (orthographic_) return 0.5 + 9 * kUnit * (scale * reach_ + off.x + off.y);
    return 0.5 + 9 * kUnit * slant(off) * (scale + std::max(off.x, off.y));
  }
  /// Greatest error of a corner's key by rounding.
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

/// The slopes of a triangle's key, the triangle's size, and the effect of moved corners on the key.
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
  /// Greatest difference at any sample between the keys of the face's plane in the world and of its plane on the
  /// screen.
  [[nodiscard]] double of_moved_corners(double moved) const {
    const double lost = 2 * moved * around;
    // If little of the area remains, the plane may be any plane through the corners' keys.
    if (lost > 0.5 * area) return range;
    return std::min(range, (std::abs(x) + std::abs(y)) * moved / (area - lost));
  }
  /// Greatest effect of roundings between the corners (view/triangle_keys.h): at most sixteen; none if keys are equal.
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
        records.clear();
        append_polygon(target, polygon_of(target, triangles, scratch->vertices, k), PrimitiveId(triangles.first_id + k),
                       records);
        for (const TriangleRecord& record : records) finish(record, parts[i]);
      }
    }
  });
  std::vector<ScreenFace> faces;
  std::size_t count = 0;
  for (const std::vector<ScreenFace>& part : parts) count += part.size();
  faces.reserve(count);
  for (const std::vector<ScreenFace>& part : parts) faces.insert(faces.end(), part.begin(), part.end());
  return faces;
}

namespace {

constexpr double kNoArea = 1e-12;    // square pixels: area that rounding may give to a line
constexpr double kSampleRim = 1e-6;  // pixels: a sample on a common side belongs to both areas
constexpr double kMostAsked = 4096, kLeastAsked = 64, kAskedOfAll = 1 << 28;

/// A function that is not negative on the inner side of the line from one point to the next.
AffineOverScreen inside_of_side(const glm::dvec2& from, const glm::dvec2& to) {
  const glm::dvec2 normal(from.y - to.y, to.x - from.x);
  return {-glm::dot(normal, from), normal};
}

/// Returns a function that is not negative where `nearer` is not surely shown: constant + relative * nearer - (nearer -
/// other).
AffineOverScreen is_not_shown(const KeyOverScreen& nearer, const KeyOverScreen& other, const KeyStep& step,
                              double slack) {
  const double share = step.relative - 1;
  return {step.constant + slack + share * nearer.k + other.k,
          {share * nearer.gx + other.gx, share * nearer.gy + other.gy}};
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

std::pair<double, double> rows_of(std::span<const glm::dvec2> corners) {
  const auto is_above = [](const glm::dvec2& a, const glm::dvec2& b) { return a.y < b.y; };
  const auto [top, bottom] = std::minmax_element(corners.begin(), corners.end(), is_above);
  return {top->y, bottom->y};
}

std::pair<int, int> span_of(std::span<const glm::dvec2> corners, const glm::dvec2& sample, int width) {
  double low = -1, high = width;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const AffineOverScreen f = inside_of_side(corners[i], corners[i + 1 == corners.size() ? 0 : i + 1]);
    const double rest = f.constant + f.gradient.y * sample.y, slope = f.gradient.x;
    if (slope > 0) low = std::max(low, -rest / slope - sample.x - kSampleRim);
    if (slope < 0) high = std::min(high, -rest / slope - sample.x + kSampleRim);
    if (slope == 0 && rest < -kSampleRim * std::abs(f.gradient.y)) return {0, 0};
  }
  // Bounds far outside of the row would not fit into an int.
  low = std::min(low, double(width));
  high = std::max(high, -1.0);
  const int first = std::max(int(std::ceil(low)), 0), end = std::min(int(std::floor(high)) + 1, width);
  return {first, std::max(first, end)};
}

void RiskFinder::cut_by_frame() {
  for (int axis = 0; axis < 2; ++axis) {
    glm::dvec2 along(0);
    along[axis] = 1;
    area_.cut({0, along});
    area_.cut({size_[axis], -along});
  }
}

const ConvexArea& RiskFinder::of_pair(const ScreenFace& a, const ScreenFace& b) {
  const KeyOverScreen first = a.keys(), second = b.keys();
  const double slack = double(a.slack) + double(b.slack);
  area_.assign(a);
  area_.cut(is_not_shown(first, second, step_, slack));
  if (!area_.is_empty()) area_.cut(is_not_shown(second, first, step_, slack));
  for (int k = 0; k < 3 && !area_.is_empty(); ++k) area_.cut(inside_of_side(b.corner(k), b.corner(k == 2 ? 0 : k + 1)));
  if (!area_.is_empty()) cut_by_frame();
  return area_;
}

const ConvexArea& RiskFinder::of_clear_value(const ScreenFace& face) {
  const KeyOverScreen keys = face.keys();
  area_.assign(face);
  cut_by_frame();
  area_.cut({farthest_key_ + 0.5 * step_.constant + double(face.slack) - keys.k, {-keys.gx, -keys.gy}});
  return area_;
}

RiskKeys::RiskKeys(const ScreenFace& a, const ScreenFace& b, const KeyStep& step)
    : first(a.keys()),
      second(b.keys()),
      reach(double(a.slack) + double(b.slack) + step.at(std::max(a.record.nearest(), b.record.nearest()))) {}

VisibleShares::VisibleShares(const Visible& visible, std::size_t areas)
    : visible_(visible), asked_(std::clamp(kAskedOfAll / double(areas), kLeastAsked, kMostAsked)) {}

double VisibleShares::of(const ConvexArea& area, const RiskKeys& keys) {
  const View& view = visible_.view;
  const auto is_seen = [&](std::size_t sample, const glm::dvec2& point) {
    return keys.nearest_at(point) + keys.reach >= double(visible_.keys[sample]);
  };
  std::uint64_t all = 0, seen = 0;
  const auto look = [&](int step) {
    all = seen = 0;
    visit_samples(area.corners(), view, step, [&](std::size_t i, int x, int y, const glm::dvec2& offset) {
      ++all;
      seen += is_seen(i, glm::dvec2(x, y) + offset);
    });
    looks_ += all;
  };
  // Some samples suffice to estimate the share. To tell whether anything is seen at all, all samples are needed.
  const int step = int(std::sqrt(area.area() * view.samples / asked_));
  if (step > 1) look(step);
  if (seen == 0) look(1);
  if (all > 0) return double(seen) / double(all);
  glm::dvec2 sum(0);
  for (const glm::dvec2& corner : area.corners()) sum += corner;
  const glm::dvec2 centre = sum / double(area.corners().size());
  const glm::ivec2 last(view.width - 1, view.height - 1);
  const glm::ivec2 pixel = glm::clamp(glm::ivec2(centre), glm::ivec2(0), last);
  const std::size_t number = std::size_t(pixel.y) * std::size_t(view.width) + std::size_t(pixel.x);
  for (std::size_t s = 0; s < std::size_t(view.samples); ++s) seen += is_seen(s * view.pixel_count() + number, centre);
  return double(seen) / double(view.samples);
}

}  // namespace frontmost
