// SPDX-License-Identifier: Apache-2.0
// The visible primitive at every sample, by a plain search in doubles over all triangles. Also eyes that are hard for
// any search: at vertices, on edges, in triangles and in their planes.
#pragma once

#include <cmath>

#include "base/exact_vector.h"
#include "frontmost/scene.h"
#include "frontmost/view.h"
#include "support/random_scene.h"
#include "view/screen_transform.h"

namespace frontmost::test {

/// Keys are rounded once; triangles that exact signs find edge-on are not hit. Near edges the oracle and a method may
/// differ.
class EyeOracle {
 public:
  EyeOracle(const Surfaces& surfaces, const View& view) : surfaces_(surfaces), view_(view), transform_(view) {}

  [[nodiscard]] Visible look() {
    Visible visible{view_, Buffer<PrimitiveId>(view_.sample_count(), no_primitive),
                    Buffer<float>(view_.sample_count(), 0.0f)};
    for (PrimitiveId id = 0; id < surfaces_.primitive_count(); ++id) {
      const std::array<glm::vec3, 3> c = surfaces_.corners(id);
      const std::array<glm::dvec3, 3> corners{c[0], c[1], c[2]};
      if (facing_of(corners) != 0) meet(id, corners, visible);
    }
    return visible;
  }

 private:
  [[nodiscard]] int facing_of(const std::array<glm::dvec3, 3>& c) const {
    if (view_.projection.orthographic) return sign_of_determinant({c[1], c[0]}, {c[2], c[0]}, {view_.forward()});
    const glm::dvec3 eye = view_.eye();
    return sign_of_determinant({c[0], eye}, {c[1], eye}, {c[2], eye});
  }

  void meet(PrimitiveId id, const std::array<glm::dvec3, 3>& c, Visible& visible) const {
    const Projection& p = view_.projection;
    const glm::dvec3 normal = glm::cross(c[1] - c[0], c[2] - c[0]);
    for (int y = 0; y < view_.height; ++y)
      for (int x = 0; x < view_.width; ++x) {
        const glm::dvec3 aside = (p.left + (x + 0.5) / view_.width * (p.right - p.left)) * view_.right() +
                                 (p.top - (y + 0.5) / view_.height * (p.top - p.bottom)) * view_.up();
        const glm::dvec3 origin = p.orthographic ? view_.eye() + aside : view_.eye();
        const glm::dvec3 along = p.orthographic ? view_.forward() : view_.forward() + aside;
        const double depth = glm::dot(normal, c[0] - origin) / glm::dot(normal, along);
        if (!(depth >= double(transform_.near) && depth <= double(transform_.far))) continue;
        if (!is_inside(c, origin, along)) continue;
        const double range = p.clip.far - p.clip.near;
        const auto key = float(p.orthographic ? (p.clip.far - depth) / range : double(transform_.near) / depth);
        const std::size_t at = visible.index(x, y);
        if (key < visible.keys[at] || (key == visible.keys[at] && id > visible.primitives[at])) continue;
        visible.keys[at] = key;
        visible.primitives[at] = id;
      }
  }

  static bool is_inside(const std::array<glm::dvec3, 3>& c, const glm::dvec3& origin, const glm::dvec3& along) {
    int least = 1, most = -1;
    for (std::size_t k = 0; k < 3; ++k) {
      const double turn = glm::dot(along, glm::cross(c[k] - origin, c[(k + 1) % 3] - origin));
      const int sign = int(turn > 0) - int(turn < 0);
      least = std::min(least, sign);
      most = std::max(most, sign);
    }
    return least >= 0 || most <= 0;
  }

  const Surfaces& surfaces_;
  const View& view_;
  ScreenTransform transform_;
};

/// Place of the eye relative to one triangle.
enum class EyePlace { corner, edge, inside, plane };
inline constexpr EyePlace all_eye_places[] = {EyePlace::corner, EyePlace::edge, EyePlace::inside, EyePlace::plane};

/// An eye at a weighted mean of the three vertices; the weights are exact or all rounded, so that the eye lies in the
/// plane exactly or up to rounding.
inline glm::dvec3 eye_beside(Random& random, const std::array<glm::vec3, 3>& corners, EyePlace place) {
  // Weights in eighths: for vertices on a grid, such eyes lie in the plane to the last bit.
  const auto eighths = [&](int most) { return (1 + random.below(most)) / 8.0; };
  glm::dvec3 weights(0);
  const int first = random.below(3);
  if (place == EyePlace::edge) weights[(first + 1) % 3] = eighths(7);
  if (place == EyePlace::inside) {
    weights[(first + 1) % 3] = eighths(4);
    weights[(first + 2) % 3] = eighths(3);
  }
  if (place == EyePlace::plane) {
    weights[(first + 1) % 3] = -eighths(16);
    weights[(first + 2) % 3] = eighths(16) - 1;
  }
  weights[first] = 1 - weights[(first + 1) % 3] - weights[(first + 2) % 3];
  const glm::dvec3 eye =
      weights.x * glm::dvec3(corners[0]) + weights.y * glm::dvec3(corners[1]) + weights.z * glm::dvec3(corners[2]);
  // Half of the eyes are doubles, as poses are, half are floats, as models are.
  return random.below(2) ? glm::dvec3(glm::vec3(eye)) : eye;
}

}  // namespace frontmost::test
