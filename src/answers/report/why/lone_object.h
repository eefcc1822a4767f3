// SPDX-License-Identifier: Apache-2.0
// An object as it would be seen if nothing else were there.
#pragma once

#include "report/why/places.h"

namespace frontmost::why_detail {

/// A scene with a single object, without materials and therefore without holes.
class LoneObject {
 public:
  LoneObject(const Scene& scene, std::uint32_t object);

  /// Whether the object would cover a sample of the picture, or of one with `factor` times the width and height.
  /// Precondition: the enlarged view is valid. `places` holds the object's position in the picture.
  [[nodiscard]] bool has_sample(const View& view, const ObjectPlaces& places, int factor = 1) const;
  /// The object's area in the picture, in square pixels. `places` holds the object's position.
  [[nodiscard]] double area(const View& view, const ObjectPlaces& places) const;

 private:
  Scene scene_;
  Surfaces surfaces_;
};

}  // namespace frontmost::why_detail
