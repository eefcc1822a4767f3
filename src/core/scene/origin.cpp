// SPDX-License-Identifier: Apache-2.0
// Where the zero of a scene should lie: the bounds of all points decide, in doubles.
//
//   file's zero                                      low        high
//        |--------------- distance ------------------|- extent --|
//                                                    ^ the roundest number near here
//
// This number becomes the origin if the distance is so much greater than the extent that floats would round the
// details. The search is over as soon as one point is so near to zero, or so far from the others, that no other point
// matters.
#include "scene/origin.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace frontmost {
namespace {

constexpr double least_ratio = 4;  ///< ratio of distance to extent: below it an origin saves two bits at most
constexpr double least_distance = 1024;
constexpr double always_ratio = 128;  ///< above this ratio a model is far, however small the units are

bool is_far(double distance, double extent) {
  return distance > least_ratio * extent && (distance > least_distance || distance > always_ratio * extent);
}

/// The roundest number in [low, high]. Precondition: 0 < low <= high.
double roundest(double low, double high) {
  const double middle = low / 2 + high / 2;
  constexpr double largest = 1e9, last_place = 0x1p-52;
  double step = largest;
  // Beyond `largest`, steps are powers of two: powers of ten have more factors of five there than a float has bits.
  while (step <= high / 2) step *= 2;
  for (; step > middle * last_place; step /= step > 1 && step <= largest ? 10 : 2) {
    const double nearest = std::round(middle / step) * step;
    if (nearest >= low && nearest <= high) return nearest;
  }
  return middle;
}

}  // namespace

void OriginSearch::include_far(const glm::dvec3& point) {
  constexpr double most = std::numeric_limits<float>::max();
  for (int axis = 0; axis < 3; ++axis)
    if (!(std::abs(point[axis]) <= most)) return;
  low_ = glm::min(low_, point);
  high_ = glm::max(high_, point);
  // Further points never reduce the extent, and never increase the distances.
  const double size = extent();
  is_home_ = !is_far(distance(0), size) && !is_far(distance(1), size) && !is_far(distance(2), size);
}

double OriginSearch::distance(int axis) const { return std::max({low_[axis], -high_[axis], 0.0}); }

double OriginSearch::extent() const {
  const glm::dvec3 size = high_ - low_;
  return std::max({size.x, size.y, size.z, 0.0});
}

glm::dvec3 OriginSearch::origin() const {
  glm::dvec3 origin(0);
  const double size = extent();
  // A single point has no details to keep.
  if (is_home_ || !(size > 0)) return origin;
  for (int axis = 0; axis < 3; ++axis) {
    const double away = distance(axis);
    if (!(away > least_ratio * size)) continue;
    const double reach = std::min(least_ratio * size, away / 4);
    const double number = roundest(away - reach, away + (high_[axis] - low_[axis]) + reach);
    origin[axis] = low_[axis] > 0 ? number : -number;
  }
  return origin;
}

namespace {

/// The points of instances, relative to the file's zero.
class PlacedPoints {
 public:
  explicit PlacedPoints(const Scene& scene) : scene_(scene), bounds_(scene.meshes.size()) {}

  void include(const Instance& instance, OriginSearch& search) {
    std::optional<Box>& bounds = bounds_[instance.mesh];
    // A mesh with many instances is searched once.
    if (bounds) return include_corners(*bounds, instance.world_from_mesh, search);
    bounds.emplace();
    for (const glm::vec3& p : scene_.meshes[instance.mesh].positions) {
      search.include(placed(instance.world_from_mesh, glm::dvec3(p)));
      if (search.is_home()) return;
      if (is_finite(p)) bounds->include(p);
    }
  }

 private:
  [[nodiscard]] glm::dvec3 placed(const glm::dmat4& m, const glm::dvec3& p) const {
    return scene_.origin + glm::dvec3(m * glm::dvec4(p, 1));
  }
  void include_corners(const Box& box, const glm::dmat4& world_from_mesh, OriginSearch& search) const {
    if (box.is_empty()) return;
    for (int corner = 0; corner < 8; ++corner)
      search.include(placed(world_from_mesh,
                            {double((corner & 1 ? box.high : box.low).x), double((corner & 2 ? box.high : box.low).y),
                             double((corner & 4 ? box.high : box.low).z)}));
  }

  const Scene& scene_;
  std::vector<std::optional<Box>> bounds_;  ///< by mesh; set for meshes that were searched
};

}  // namespace

glm::dvec3 fitting_origin(const Scene& scene) {
  OriginSearch search;
  PlacedPoints points(scene);
  for (const Instance& instance : scene.instances) {
    if (search.is_home()) break;
    points.include(instance, search);
  }
  return search.origin();
}

glm::dvec3 fitting_origin(std::span<const glm::dvec3> points) {
  OriginSearch search;
  for (const glm::dvec3& point : points) search.include(point);
  return search.origin();
}

void set_origin(Scene& scene, const glm::dvec3& origin) {
  const glm::dvec4 moved(scene.origin - origin, 0);
  scene.origin = origin;
  if (moved == glm::dvec4(0)) return;
  for (Instance& instance : scene.instances) instance.world_from_mesh[3] += moved;
  for (Camera& camera : scene.cameras) camera.world_from_eye[3] += moved;
  for (Light& light : scene.lights) light.world_from_light[3] += moved;
}

}  // namespace frontmost
