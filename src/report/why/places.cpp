// SPDX-License-Identifier: Apache-2.0
#include "report/why/places.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace frontmost::why_detail {
namespace {

/// By material, and the default material last: whether nothing of it is opaque anywhere.
std::vector<std::uint8_t> find_clear_materials(const Scene& scene) {
  std::vector<std::uint8_t> clear(scene.materials.size() + 1, 0);
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    const Material& material = scene.materials[i];
    if (material.alpha != Material::Alpha::blend) continue;
    clear[i] = !(material.base_color.a > 0);
    if (clear[i] || !material.base_color_texture.is_set()) continue;
    const std::vector<glm::u8vec4>& texels = scene.textures[material.base_color_texture.texture].pixels;
    clear[i] = std::all_of(texels.begin(), texels.end(), [](const glm::u8vec4& texel) { return texel.a == 0; });
  }
  return clear;
}

/// The radius of a circle that surely fits into a convex polygon: area / perimeter, in a triangle twice as much.
double inner_radius(std::span<const glm::dvec2> p) {
  double doubled = 0, perimeter = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const glm::dvec2 &a = p[i], &b = p[i + 1 == p.size() ? 0 : i + 1];
    doubled += (a.x - p[0].x) * (b.y - p[0].y) - (a.y - p[0].y) * (b.x - p[0].x);
    perimeter += glm::length(b - a);
  }
  const double radius = std::abs(doubled) / (2 * perimeter);
  return perimeter > 0 ? (p.size() == 3 ? 2 * radius : radius) : 0;
}

/// The places of one range of triangles.
class PlaceFinder {
 public:
  PlaceFinder(const PlacedScene& scene, const View& view)
      : scene_(scene), frustum_(view), culling_(view.culling), clear_(find_clear_materials(*scene.scene)) {
    is_any_clear_ = std::find(clear_.begin(), clear_.end(), 1) != clear_.end();
  }

  [[nodiscard]] ObjectPlaces find(const MeshRange& range) const {
    ObjectPlaces places;
    WorldScratch scratch;
    const WorldTriangles world = world_triangles(scene_, range, scratch);
    std::vector<FrustumPoint> seen;
    seen.reserve(world.positions.size());
    for (const glm::vec3& p : world.positions) seen.push_back(frustum_.see(p));
    for (std::size_t i = 0; i < world.corners.size(); ++i) {
      std::array<glm::vec3, 3> corners = world[i];
      glm::uvec3 c = world.corners[i] - world.first_position;
      if (world.is_mirrored) std::swap(c.y, c.z);
      const glm::dvec3 a(corners[0]), normal = glm::cross(glm::dvec3(corners[1]) - a, glm::dvec3(corners[2]) - a);
      if (!is_finite(corners[0]) || !is_finite(corners[1]) || !is_finite(corners[2]) || normal == glm::dvec3(0)) {
        ++places.counts.empty;
        continue;
      }
      const FrustumPolygon triangle{{seen[c.x], seen[c.y], seen[c.z]}, 3};
      if (place(triangle, glm::length(normal) / 2, places) && is_any_clear_)
        places.clear += is_clear(range, range.begin + std::uint32_t(i));
    }
    return places;
  }

 private:
  /// \returns whether it is in view.
  [[nodiscard]] bool place(FrustumPolygon polygon, double area, ObjectPlaces& places) const {
    const FrustumPolygon whole = polygon;
    const PointAhead &a = whole.corners[0].at, &b = whole.corners[1].at, &c = whole.corners[2].at;
    TrianglePlaces& counts = places.counts;
    const auto is_culled = [&] { return is_left_out(frustum_.facing(a, b, c)); };
    if (!frustum_.is_orthographic() && a.z <= 0 && b.z <= 0 && c.z <= 0) {
      places.behind.offer({(a + b + c) / 3.0, area, is_culled()});
      ++counts.behind_eye;
    } else if (polygon.is_outside(kNear)) {
      for (const FrustumPoint& p : whole.all()) places.nearer.include(p.at.z);
      ++counts.nearer_than_near;
    } else if (polygon.is_outside(kFar)) {
      for (const FrustumPoint& p : whole.all()) places.farther.include(p.at.z);
      ++counts.beyond_far;
    } else if (std::uint64_t* const side = side_of(polygon, counts)) {
      places.outside.offer({middle_of(polygon), area, is_culled()});
      ++*side;
    } else if (is_culled()) {
      ++counts.faces_away;
    } else {
      ++counts.in_view;
      note_in_view(polygon, places);
      return true;
    }
    return false;
  }

  /// Cuts the polygon by the volume. \returns the count of the side that all of it lies on; null where some of it is
  /// left. What is outside on a side is only cut by near and far.
  [[nodiscard]] static std::uint64_t* side_of(FrustumPolygon& polygon, TrianglePlaces& counts) {
    bool is_crossing[kPlaneCount] = {};
    for (const FrustumPoint& p : polygon.all())
      for (std::size_t k = 0; k < kPlaneCount; ++k) is_crossing[k] |= p.inside[k] < 0;
    for (const Plane plane : {kNear, kFar})
      if (is_crossing[plane]) polygon.cut(plane);
    std::uint64_t* const sides[] = {&counts.left, &counts.right, &counts.above, &counts.below};
    for (const Plane plane : {kLeft, kRight, kAbove, kBelow})
      if (is_crossing[plane] && polygon.is_outside(plane)) return sides[plane];
    FrustumPolygon in_view = polygon;
    for (const Plane plane : {kLeft, kRight, kAbove, kBelow})
      if (is_crossing[plane]) in_view.cut(plane);
    if (in_view.count == 0) return &counts.past_corner;
    polygon = in_view;
    return nullptr;
  }

  [[nodiscard]] static PointAhead middle_of(const FrustumPolygon& polygon) {
    PointAhead sum(0);
    for (const FrustumPoint& p : polygon.all()) sum += p.at;
    return sum / double(polygon.count);
  }

  /// What is seen edge on covers nothing, and faces away where anything does.
  [[nodiscard]] bool is_left_out(double facing) const {
    return culling_ == Culling::both || (culling_ == Culling::back && facing <= 0) ||
           (culling_ == Culling::front && facing >= 0);
  }

  void note_in_view(const FrustumPolygon& polygon, ObjectPlaces& places) const {
    std::array<glm::dvec2, 3 + kPlaneCount> pixels;
    for (std::size_t i = 0; i < polygon.count; ++i) {
      pixels[i] = frustum_.pixel_of(polygon.corners[i].at);
      places.columns.include(pixels[i].x);
      places.rows.include(pixels[i].y);
    }
    places.widest = std::max(places.widest, inner_radius(std::span(pixels).first(polygon.count)));
  }

  [[nodiscard]] bool is_clear(const MeshRange& range, std::uint32_t triangle) const {
    const Mesh& mesh = scene_.mesh(range);
    const std::uint32_t material = mesh.material_of(triangle);
    return clear_[material == no_index ? clear_.size() - 1 : material] != 0;
  }

  const PlacedScene& scene_;
  Frustum frustum_;
  Culling culling_;
  std::vector<std::uint8_t> clear_;
  bool is_any_clear_ = false;
};

}  // namespace

void ValueRange::include(double value) {
  low = std::min(low, value);
  high = std::max(high, value);
}

void ValueRange::include(const ValueRange& other) {
  low = std::min(low, other.low);
  high = std::max(high, other.high);
}

void LargestTriangle::offer(const LargestTriangle& other) {
  if (other.area < 0) return;
  if (area < 0 || (is_culled && !other.is_culled) || (is_culled == other.is_culled && other.area > area)) *this = other;
}

void ObjectPlaces::add(const ObjectPlaces& other) {
  std::uint64_t* const sums[] = {
      &counts.empty, &counts.behind_eye, &counts.nearer_than_near, &counts.beyond_far, &counts.left,   &counts.right,
      &counts.above, &counts.below,      &counts.past_corner,      &counts.faces_away, &counts.in_view};
  const TrianglePlaces& more = other.counts;
  const std::uint64_t parts[] = {
      more.empty, more.behind_eye, more.nearer_than_near, more.beyond_far, more.left,   more.right,
      more.above, more.below,      more.past_corner,      more.faces_away, more.in_view};
  for (std::size_t i = 0; i < std::size(sums); ++i) *sums[i] += parts[i];
  clear += other.clear;
  nearer.include(other.nearer);
  farther.include(other.farther);
  behind.offer(other.behind);
  outside.offer(other.outside);
  columns.include(other.columns);
  rows.include(other.rows);
  widest = std::max(widest, other.widest);
}

std::vector<ObjectPlaces> find_places(const PlacedScene& scene, const View& view, std::uint32_t object,
                                      const Execution& execution) {
  constexpr std::size_t kRangesAtOnce = 16;
  const PlaceFinder finder(scene, view);
  std::vector<ObjectPlaces> of_ranges(scene.ranges.size());
  parallel_for(execution, of_ranges.size(), kRangesAtOnce, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (object == no_index || scene.ranges[i].instance == object) of_ranges[i] = finder.find(scene.ranges[i]);
  });
  std::vector<ObjectPlaces> places(scene.instance_bounds.size());
  for (std::size_t i = 0; i < of_ranges.size(); ++i) places[scene.ranges[i].instance].add(of_ranges[i]);
  return places;
}

}  // namespace frontmost::why_detail
