// SPDX-License-Identifier: Apache-2.0
// An object as it would be seen if nothing else were there.
#pragma once

#include "report/why/places.h"

namespace frontmost::why_detail {

/// A scene of its own, without materials, so that nothing of it has holes.
class LoneObject {
 public:
  LoneObject(const Scene& scene, std::uint32_t object);

  /// Whether it would cover a sample of the picture, or of one with `factor` times the pixels each way, which is a
  /// valid view. `places`: where it is in the picture.
  [[nodiscard]] bool has_sample(const View& view, const ObjectPlaces& places, int factor = 1) const;
  /// Its area in the picture, in square pixels. `places`: where it is.
  [[nodiscard]] double area(const View& view, const ObjectPlaces& places) const;

 private:
  Scene scene_;
  Surfaces surfaces_;
};

}  // namespace frontmost::why_detail
