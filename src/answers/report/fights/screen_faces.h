// SPDX-License-Identifier: Apache-2.0
// Triangles as a depth buffer places them, with what their keys may differ by from those of the faces in the world.
//
//    exact     /\        A corner is snapped by up to 1/512 pixel along x and y, after floats have moved it by less.
//    snapped  /_ \       So the key at a sample is off by what the face's plane changes over that way; and by the
//               `-`      roundings of keys. Two faces whose keys differ by more than both together and a step of the
//                        format are shown in their right order.
#pragma once

#include <vector>

#include "frontmost/precision.h"
#include "frontmost/view.h"
#include "zbuffer/triangle_records.h"

namespace frontmost {

/// By how much two keys must differ to be stored as different values, and in their order: constant + relative * key.
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
  zbuffer_detail::TriangleRecord record;  ///< corners from the image's top left, its area positive
  float slack;                            ///< what its keys may be off by
  float low, high;                        ///< of its keys, farther apart by `slack` and half a step

  [[nodiscard]] KeyOverScreen keys() const;
  [[nodiscard]] glm::dvec2 corner(int k) const { return glm::dvec2(record.x[k], record.y[k]) / double(kSubPixels); }
};

/// Of square blocks of pixels the farthest key that is seen at their samples.
class FarthestSeen {
 public:
  /// Nothing is hidden.
  FarthestSeen() = default;
  explicit FarthestSeen(const Visible& visible);
  /// Whether a key of `high` is behind all that is seen in these pixels and those beside them.
  [[nodiscard]] bool hides(const zbuffer_detail::PixelRect& rect, float high) const;

 private:
  int columns_ = 0, rows_ = 0;
  std::vector<float> keys_;
};

/// All that may cover a point of the picture and is not hidden, in the order of ids.
[[nodiscard]] std::vector<ScreenFace> screen_faces(const Surfaces& surfaces, const View& view, const KeyStep& step,
                                                   const FarthestSeen& seen, const Execution& execution);

}  // namespace frontmost
