// SPDX-License-Identifier: Apache-2.0
// Triangles as a depth buffer places them, the area in which two of them are at risk, and how much of it is seen.
//
//    exact     /\        Floats move a corner slightly; snapping moves it by up to 1/512 pixel along x and y. The
//    snapped  /_ \       key at a sample is therefore wrong by the change of the face's plane over that distance,
//               `-`      and by the roundings of keys. Two faces whose keys differ by more than the sum of both
//                        errors, and a step of the format, are shown in the right order.
//
// Keys are affine over the screen. The difference of two keys is affine, too, and so is the least difference with which
// format and rounding keep them apart. Keys differ by less in a strip between two straight lines:
//
//      \  first is surely shown  \//////\  second is surely shown
//       \    where it is nearer   \/////\\    where it is nearer
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <span>
#include <utility>
#include <vector>

#include "frontmost/precision.h"
#include "frontmost/view.h"
#include "view/screen_transform.h"
#include "zbuffer/triangle_records.h"

namespace frontmost {

/// The least difference with which two keys are stored as different values in their order: constant + relative * key.
struct KeyStep {
  double constant = 0, relative = 0;

  explicit KeyStep(const DepthSetup& setup);
  [[nodiscard]] double at(double key) const { return constant + relative * key; }
};

/// Keys over the screen, in pixels: k + x * gx + y * gy.
struct KeyOverScreen {
  double k, gx, gy;

  [[nodiscard]] double at(const glm::dvec2& point) const { return k + point.x * gx + point.y * gy; }
};

/// A triangle on the screen.
struct ScreenFace {
  zbuffer_detail::TriangleRecord record;  ///< corners relative to the image's top left; the area is positive
  float slack;                            ///< greatest error of its keys
  float low, high;                        ///< range of its keys, widened by `slack` and half a step

  [[nodiscard]] KeyOverScreen keys() const;
  [[nodiscard]] glm::dvec2 corner(int k) const { return glm::dvec2(record.x[k], record.y[k]) / double(kSubPixels); }
};

/// The farthest key seen at the samples of each square block of pixels.
class FarthestSeen {
 public:
  /// The default value hides nothing.
  FarthestSeen() = default;
  explicit FarthestSeen(const Visible& visible);
  /// Whether a surface with the key `high` is behind everything seen in these pixels and the adjacent ones.
  [[nodiscard]] bool hides(const zbuffer_detail::PixelRect& rect, float high) const;

 private:
  int columns_ = 0, rows_ = 0;
  std::vector<float> keys_;
};

/// All faces that may cover a point of the picture and are not hidden, in the order of ids.
[[nodiscard]] std::vector<ScreenFace> screen_faces(const Surfaces& surfaces, const View& view, const KeyStep& step,
                                                   const FarthestSeen& seen, const Execution& execution);

/// f(x, y) = constant + gradient . (x, y).
struct AffineOverScreen {
  double constant;
  glm::dvec2 gradient;

  [[nodiscard]] double at(const glm::dvec2& point) const { return constant + glm::dot(gradient, point); }
};

/// A convex polygon. Its corners are ordered as in a face on the screen: the inside is on the left of each side, with y
/// upwards.
class ConvexArea {
 public:
  /// Replaces the area by that of a face.
  void assign(const ScreenFace& face) { corners_ = {face.corner(0), face.corner(1), face.corner(2)}; }
  /// Keeps the part where `f` is not negative.
  void cut(const AffineOverScreen& f);
  [[nodiscard]] std::span<const glm::dvec2> corners() const { return corners_; }
  [[nodiscard]] bool is_empty() const { return corners_.size() < 3; }
  /// Area in square pixels.
  [[nodiscard]] double area() const;

 private:
  std::vector<glm::dvec2> corners_, before_;
};

/// The least and the greatest y of some corners.
[[nodiscard]] std::pair<double, double> rows_of(std::span<const glm::dvec2> corners);

/// The pixels [first, end) of a row of samples at `sample.y` that lie in an area, sides included. Samples are
/// `sample.x` to the right of the left sides of their pixels.
[[nodiscard]] std::pair<int, int> span_of(std::span<const glm::dvec2> corners, const glm::dvec2& sample, int width);

/// Calls visit(number, x, y, offset) for the samples of a view in an area, in every `step`-th column and row. Sample
/// numbers are those of Visible; offsets are relative to the top left corners of pixels.
template <class Visit>
void visit_samples(std::span<const glm::dvec2> corners, const View& view, int step, const Visit& visit) {
  const auto from = [&](int first) { return (first + step - 1) / step * step; };
  const auto [top, bottom] = rows_of(corners);
  const std::span<const glm::ivec2> samples = sample_offsets(view.samples);
  for (std::size_t s = 0; s < samples.size(); ++s) {
    const glm::dvec2 offset = glm::dvec2(samples[s]) / double(kSubPixels);
    for (int y = from(std::max(int(std::floor(top - offset.y)), 0)); y < view.height; y += step) {
      if (y + offset.y > bottom + 1) break;
      const auto [begin, end] = span_of(corners, {offset.x, y + offset.y}, view.width);
      const std::size_t first = (s * std::size_t(view.height) + std::size_t(y)) * std::size_t(view.width);
      for (int x = from(begin); x < end; x += step) visit(first + std::size_t(x), x, y, offset);
    }
  }
}

/// Finds one area after another and reuses its memory.
class RiskFinder {
 public:
  RiskFinder(const View& view, const DepthSetup& setup)
      : size_(view.width, view.height),
        step_(setup),
        farthest_key_(setup.orthographic ? 0 : setup.clip.near / setup.clip.far) {}

  /// The area that both faces cover and in which neither is surely shown; may be empty. Valid until the next call.
  [[nodiscard]] const ConvexArea& of_pair(const ScreenFace& a, const ScreenFace& b);
  /// The area in which a face may be stored as the clear value. Precondition: may_be_clear_value(face).
  [[nodiscard]] const ConvexArea& of_clear_value(const ScreenFace& face);
  /// False if the area of of_clear_value() is certainly empty.
  [[nodiscard]] bool may_be_clear_value(const ScreenFace& face) const { return double(face.low) <= farthest_key_; }

 private:
  void cut_by_frame();

  glm::dvec2 size_;
  KeyStep step_;
  double farthest_key_;
  ConvexArea area_;
};

/// The keys of two faces that are at risk, or of one face alone.
struct RiskKeys {
  KeyOverScreen first, second;
  double reach;  ///< the faces may be shown although another surface is nearer by up to this

  RiskKeys(const ScreenFace& a, const ScreenFace& b, const KeyStep& step);
  [[nodiscard]] double nearest_at(const glm::dvec2& point) const { return std::max(first.at(point), second.at(point)); }
};

/// Estimates, from samples, the visible share of one area after another. For one thread.
class VisibleShares {
 public:
  /// `areas` is the number of areas. About 4,096 samples of each area are examined, or fewer (at least 64) if the areas
  /// together would take more than 2^28.
  VisibleShares(const Visible& visible, std::size_t areas);

  /// The visible share of an area, estimated from the samples in the area, or, if it has none, from those of the pixel
  /// at its centre. The share is 0 only if all samples of the area were examined and none is seen.
  [[nodiscard]] double of(const ConvexArea& area, const RiskKeys& keys);
  /// Number of samples examined since the last call.
  [[nodiscard]] std::uint64_t take_looks() { return std::exchange(looks_, 0); }

 private:
  const Visible& visible_;
  double asked_;
  std::uint64_t looks_ = 0;
};

}  // namespace frontmost
