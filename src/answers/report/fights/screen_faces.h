// SPDX-License-Identifier: Apache-2.0
// Triangles as a depth buffer places them, with the greatest difference of their keys from those of the faces in the
// world.
//
//    exact     /\        Floats move a corner slightly; snapping moves it by up to 1/512 pixel along x and y. The
//    snapped  /_ \       key at a sample is therefore wrong by the change of the face's plane over that distance,
//               `-`      and by the roundings of keys. Two faces whose keys differ by more than the sum of both
//                        errors, and a step of the format, are shown in the right order.
#pragma once

#include <vector>

#include "frontmost/precision.h"
#include "frontmost/view.h"
#include "zbuffer/triangle_records.h"

namespace frontmost {

/// The difference that two keys need to be stored as different values, in their order: constant + relative * key.
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
  /// A value with which nothing is hidden.
  FarthestSeen() = default;
  explicit FarthestSeen(const Visible& visible);
  /// Whether a key of `high` is behind everything seen in these pixels and the adjacent ones.
  [[nodiscard]] bool hides(const zbuffer_detail::PixelRect& rect, float high) const;

 private:
  int columns_ = 0, rows_ = 0;
  std::vector<float> keys_;
};

/// All faces that may cover a point of the picture and are not hidden, in the order of ids.
[[nodiscard]] std::vector<ScreenFace> screen_faces(const Surfaces& surfaces, const View& view, const KeyStep& step,
                                                   const FarthestSeen& seen, const Execution& execution);

}  // namespace frontmost
