// SPDX-License-Identifier: Apache-2.0
// Each triangle is counted at one place: behind the eye, nearer than near, beyond far, outside the picture, turned
// away, or in view. Boxes that surely lie in view are counted without looking at each of their triangles.
#include "report/why/places.h"

#include <array>
#include <cmath>
#include <span>

#include "base/parallel.h"
#include "base/pool.h"
#include "view/facing_rule.h"

namespace frontmost::why_detail {
namespace {

/// The planes of the viewing volume, used as bits. The sides come before near and far.
enum Plane : std::uint8_t { kLeft, kRight, kAbove, kBelow, kNear, kFar, kPlaneCount };

/// Distances from the planes: positive inside, and linear over space.
using PlaneDistances = std::array<double, kPlaneCount>;

struct FrustumPoint {
  PointAhead at;
  PlaneDistances inside;
};

/// A convex polygon: a triangle that was cut by up to six planes.
struct FrustumPolygon {
  std::array<FrustumPoint, 3 + kPlaneCount> corners;
  std::size_t count = 0;

  [[nodiscard]] std::span<const FrustumPoint> all() const { return std::span(corners).first(count); }
  [[nodiscard]] bool is_outside(Plane plane) const {
    return std::all_of(all().begin(), all().end(), [&](const FrustumPoint& p) { return p.inside[plane] < 0; });
  }
  /// Cuts off the part outside a plane.
  void cut(Plane plane) {
    FrustumPolygon kept;
    for (std::size_t i = 0; i < count; ++i) {
      const FrustumPoint &a = corners[i], &b = corners[i + 1 == count ? 0 : i + 1];
      const double from = a.inside[plane], to = b.inside[plane];
      if (from >= 0) kept.corners[kept.count++] = a;
      if ((from < 0) == (to < 0)) continue;
      const double t = from / (from - to);
      FrustumPoint& p = kept.corners[kept.count++];
      p.at = a.at + (b.at - a.at) * t;
      for (std::size_t k = 0; k < kPlaneCount; ++k) p.inside[k] = a.inside[k] + (b.inside[k] - a.inside[k]) * t;
      p.inside[plane] = 0;
    }
    *this = kept;
  }
};

/// The viewing volume, in doubles.
class Frustum {
 public:
  explicit Frustum(const View& view)
      : eye_(view.eye()),
        right_(view.right()),
        up_(view.up()),
        forward_(view.forward()),
        projection_(view.projection),
        pixels_across_(view.width / (projection_.right - projection_.left)),
        pixels_down_(view.height / (projection_.top - projection_.bottom)) {}

  [[nodiscard]] bool is_orthographic() const { return projection_.orthographic; }
  [[nodiscard]] FrustumPoint see(const glm::vec3& world) const {
    const glm::dvec3 p = glm::dvec3(world) - eye_;
    const PointAhead at(glm::dot(right_, p), glm::dot(up_, p), glm::dot(forward_, p));
    const Projection& f = projection_;
    const double unit = f.orthographic ? 1 : at.z;
    // Every point is inside an infinite far plane.
    const double before_far = std::isinf(f.clip.far) ? 1 : f.clip.far - at.z;
    return {at,
            {at.x - f.left * unit, f.right * unit - at.x, f.top * unit - at.y, at.y - f.bottom * unit,
             at.z - f.clip.near, before_far}};
  }

  /// Whether a box surely lies inside all planes.
  [[nodiscard]] bool surely_holds(const Box& box) const {
    if (box.is_empty()) return true;
    // Distances are linear, so the corners decide. The rounding of see() is far less than this share of the numbers
    // that it adds.
    constexpr double kRounding = 1e-12;
    for (int k = 0; k < 8; ++k) {
      const glm::vec3 corner(k & 1 ? box.high.x : box.low.x, k & 2 ? box.high.y : box.low.y,
                             k & 4 ? box.high.z : box.low.z);
      const FrustumPoint p = see(corner);
      const glm::dvec3 reach = glm::abs(glm::dvec3(corner)) + glm::abs(eye_);
      const Projection& f = projection_;
      const double across = std::max({std::abs(f.left), std::abs(f.right), std::abs(f.top), std::abs(f.bottom), 1.0});
      const double far = std::isinf(f.clip.far) ? 0 : f.clip.far;
      const double slack = kRounding * ((reach.x + reach.y + reach.z) * (1 + across) + across + f.clip.near + far);
      const bool is_inside = std::all_of(p.inside.begin(), p.inside.end(), [&](double d) { return d > slack; });
      if (!is_inside) return false;
    }
    return true;
  }

  /// The position in pixels from the picture's top left corner. Precondition: the point is in front of the eye.
  [[nodiscard]] glm::dvec2 pixel_of(const PointAhead& p) const {
    const double unit = projection_.orthographic ? 1 : p.z;
    return {(p.x / unit - projection_.left) * pixels_across_, (projection_.top - p.y / unit) * pixels_down_};
  }

  /// Winding of a triangle on the screen: positive if its front is seen, 0 if it is edge-on. Parts may lie behind the
  /// eye.
  [[nodiscard]] double facing(const PointAhead& a, const PointAhead& b, const PointAhead& c) const {
    if (projection_.orthographic) return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    return glm::dot(a, glm::cross(b, c));
  }

 private:
  glm::dvec3 eye_, right_, up_, forward_;
  Projection projection_;
  double pixels_across_, pixels_down_;  ///< pixels per unit of the projection's rectangle
};

/// Number of triangles that have no area or a non-finite corner.
std::uint64_t count_flat(const WorldTriangles& triangles) {
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < triangles.corners.size(); ++i) {
    const std::array<glm::vec3, 3> p = triangles[i];
    const glm::dvec3 a(p[0]), normal = glm::cross(glm::dvec3(p[1]) - a, glm::dvec3(p[2]) - a);
    const double size = std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z);
    count += !(size > 0 && std::isfinite(size));
  }
  return count;
}

/// By material, the default material last: 1 if the material has no opaque place.
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

/// The radius of a circle that surely fits into a convex polygon: area / perimeter, and twice that for a triangle.
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

/// Memory of one thread that finds places.
struct FrustumScratch {
  WorldScratch world;
  std::vector<FrustumPoint> seen;     // by vertex, set when the vertex is first used
  std::vector<std::uint8_t> outside;  // by vertex: a bit for each plane, and further bits
};

/// Finds the places of one range of triangles.
class PlaceFinder {
 public:
  PlaceFinder(const PlacedScene& scene, const View& view, Isa isa)
      : scene_(scene),
        frustum_(view),
        facing_(view.culling, scene.sides.get()),
        isa_(isa),
        clear_(find_clear_materials(*scene.scene)) {
    is_any_clear_ = std::find(clear_.begin(), clear_.end(), 1) != clear_.end();
  }

  /// `needs_area`: whether the positions of the triangles on the screen are needed.
  [[nodiscard]] ObjectPlaces find(const MeshRange& range, bool needs_area, FrustumScratch& scratch) const {
    ObjectPlaces places;
    const WorldTriangles world = world_triangles(scene_, range, isa_, scratch.world);
    if (scratch.seen.size() < world.positions.size()) scratch.seen.resize(world.positions.size());
    scratch.outside.assign(world.positions.size(), kNotSeen);
    for (std::uint32_t k = 0; k < range.box_count(); ++k) {
      const std::size_t first = std::size_t(k) * MeshRange::triangles_in_box;
      WorldTriangles part = world;
      part.first_id += PrimitiveId(first);
      part.corners = world.corners.subspan(
          first, std::min<std::size_t>(MeshRange::triangles_in_box, world.corners.size() - first));
      if (!needs_area && is_surely_in_view(scene_.boxes[range.first_box + k])) {
        const std::uint64_t empty = count_flat(part);
        places.counts.empty += empty;
        places.counts.in_view += part.corners.size() - empty;
        continue;
      }
      for (std::size_t i = 0; i < part.corners.size(); ++i)
        if (find_triangle(part, i, needs_area, scratch, places) && is_any_clear_)
          places.clear += is_clear(range, range.begin + std::uint32_t(first + i));
    }
    return places;
  }

 private:
  // Further bits, after those of the planes.
  static constexpr std::uint8_t kBehindEye = 1 << kPlaneCount, kNowhere = 1 << (kPlaneCount + 1);
  static constexpr std::uint8_t kNotSeen = 0xFF;  // no vertex has this value, because kNowhere excludes all other bits

  struct ViewedTriangle {
    const FrustumPoint* corners[3];
    glm::dvec3 normal;                      ///< its length is twice the area
    std::uint8_t any_outside, all_outside;  ///< planes outside of which any corner, or every corner, lies
    PrimitiveId id;

    [[nodiscard]] const PointAhead& at(int k) const { return corners[k]->at; }
    [[nodiscard]] FrustumPolygon polygon() const { return {{*corners[0], *corners[1], *corners[2]}, 3}; }
  };

  /// Whether all non-empty triangles in a box are in view, and none needs to be counted as clear.
  [[nodiscard]] bool is_surely_in_view(const Box& box) const {
    return facing_.culling() == Culling::none && !is_any_clear_ && frustum_.surely_holds(box);
  }

  /// Finds the place of one triangle. \returns whether the triangle is in view.
  [[nodiscard]] bool find_triangle(const WorldTriangles& world, std::size_t i, bool needs_area, FrustumScratch& scratch,
                                   ObjectPlaces& places) const {
    glm::uvec3 c = world.corners[i] - world.first_position;
    if (world.is_mirrored) std::swap(c.y, c.z);
    std::uint8_t all = 0xFF, any = 0;
    for (int k = 0; k < 3; ++k) {
      std::uint8_t& outside = scratch.outside[c[k]];
      if (outside == kNotSeen) {
        scratch.seen[c[k]] = frustum_.see(world.positions[c[k]]);
        outside = outside_of(scratch.seen[c[k]], world.positions[c[k]]);
      }
      all &= outside;
      any |= outside;
    }
    const glm::dvec3 a(world.positions[c.x]), b(world.positions[c.y]), d(world.positions[c.z]);
    const glm::dvec3 normal = glm::cross(b - a, d - a);
    if ((any & kNowhere) != 0 || normal == glm::dvec3(0)) {
      ++places.counts.empty;
      return false;
    }
    return place({{&scratch.seen[c.x], &scratch.seen[c.y], &scratch.seen[c.z]},
                  normal,
                  any,
                  all,
                  world.first_id + PrimitiveId(i)},
                 needs_area, places);
  }

  [[nodiscard]] std::uint8_t outside_of(const FrustumPoint& p, const glm::vec3& world) const {
    if (!is_finite(world)) return kNowhere;
    std::uint8_t bits = !frustum_.is_orthographic() && p.at.z <= 0 ? kBehindEye : 0;
    for (std::size_t k = 0; k < kPlaneCount; ++k) bits = std::uint8_t(bits | (p.inside[k] < 0) << k);
    return bits;
  }

  /// Whether culling leaves out a triangle. An edge-on triangle covers nothing and counts as turned away.
  [[nodiscard]] bool is_culled(const ViewedTriangle& t) const {
    if (facing_.culling() == Culling::none) return false;
    const double facing = frustum_.facing(t.at(0), t.at(1), t.at(2));
    return !(facing > 0 && facing_.keeps(t.id, true)) && !(facing < 0 && facing_.keeps(t.id, false));
  }

  /// Finds the place of a triangle that has an area. \returns whether the triangle is in view.
  [[nodiscard]] bool place(const ViewedTriangle& t, bool needs_area, ObjectPlaces& places) const {
    TrianglePlaces& counts = places.counts;
    if ((t.all_outside & kBehindEye) != 0) {
      places.behind.offer({(t.at(0) + t.at(1) + t.at(2)) / 3.0, glm::length(t.normal) / 2, is_culled(t)});
      ++counts.behind_eye;
    } else if ((t.all_outside & 1 << kNear) != 0) {
      for (const FrustumPoint* const p : t.corners) places.nearer.include(p->at.z);
      ++counts.nearer_than_near;
    } else if ((t.all_outside & 1 << kFar) != 0) {
      for (const FrustumPoint* const p : t.corners) places.farther.include(p->at.z);
      ++counts.beyond_far;
    } else if (t.any_outside == 0 && !needs_area) {
      ++(is_culled(t) ? counts.faces_away : counts.in_view);
      return !is_culled(t);
    } else {
      return place_clipped(t, needs_area, places);
    }
    return false;
  }

  [[nodiscard]] bool place_clipped(const ViewedTriangle& t, bool needs_area, ObjectPlaces& places) const {
    FrustumPolygon polygon = t.polygon();
    if (std::uint64_t* const side = side_of(polygon, t.any_outside, places.counts)) {
      places.outside.offer({middle_of(polygon), glm::length(t.normal) / 2, is_culled(t)});
      ++*side;
      return false;
    }
    if (is_culled(t)) {
      ++places.counts.faces_away;
      return false;
    }
    ++places.counts.in_view;
    if (needs_area) note_in_view(polygon, places);
    return true;
  }

  /// Clips the polygon by the viewing volume. \returns the count of the side on which all of the polygon lies; null if
  /// a part is in view. A polygon that lies outside on one side is clipped only by near and far.
  [[nodiscard]] static std::uint64_t* side_of(FrustumPolygon& polygon, std::uint8_t any_outside,
                                              TrianglePlaces& counts) {
    const auto is_crossing = [&](Plane plane) { return (any_outside >> plane & 1) != 0; };
    for (const Plane plane : {kNear, kFar})
      if (is_crossing(plane)) polygon.cut(plane);
    std::uint64_t* const sides[] = {&counts.left, &counts.right, &counts.above, &counts.below};
    for (const Plane plane : {kLeft, kRight, kAbove, kBelow})
      if (is_crossing(plane) && polygon.is_outside(plane)) return sides[plane];
    FrustumPolygon in_view = polygon;
    for (const Plane plane : {kLeft, kRight, kAbove, kBelow})
      if (is_crossing(plane)) in_view.cut(plane);
    if (in_view.count == 0) return &counts.past_corner;
    polygon = in_view;
    return nullptr;
  }

  [[nodiscard]] static PointAhead middle_of(const FrustumPolygon& polygon) {
    PointAhead sum(0);
    for (const FrustumPoint& p : polygon.all()) sum += p.at;
    return sum / double(polygon.count);
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
  FacingRule facing_;
  Isa isa_;
  std::vector<std::uint8_t> clear_;
  bool is_any_clear_ = false;
};

}  // namespace

void ObjectPlaces::add(const ObjectPlaces& other) {
  using T = TrianglePlaces;
  for (std::uint64_t T::*const count : {&T::empty, &T::behind_eye, &T::nearer_than_near, &T::beyond_far, &T::left,
                                        &T::right, &T::above, &T::below, &T::past_corner, &T::faces_away, &T::in_view})
    counts.*count += other.counts.*count;
  clear += other.clear;
  nearer.include(other.nearer);
  farther.include(other.farther);
  behind.offer(other.behind);
  outside.offer(other.outside);
  columns.include(other.columns);
  rows.include(other.rows);
  widest = std::max(widest, other.widest);
}

std::vector<ObjectPlaces> find_places(const PlacedScene& scene, const View& view, const Accounting& accounts,
                                      std::uint32_t object, const Execution& execution) {
  constexpr std::size_t kRangesAtOnce = 16;
  const PlaceFinder finder(scene, view, execution.isa);
  std::vector<ObjectPlaces> of_ranges(scene.ranges.size());
  Pool<FrustumScratch> scratches;
  parallel_for(execution, of_ranges.size(), kRangesAtOnce, [&](std::size_t begin, std::size_t end) {
    const auto scratch = scratches.borrow([] { return std::make_unique<FrustumScratch>(); });
    for (std::size_t i = begin; i < end; ++i) {
      const MeshRange& range = scene.ranges[i];
      if (object != no_index && range.instance != object) continue;
      of_ranges[i] = finder.find(range, accounts.objects[range.instance].in_frame.count == 0, *scratch);
    }
  });
  std::vector<ObjectPlaces> places(scene.instance_bounds.size());
  for (std::size_t i = 0; i < of_ranges.size(); ++i) places[scene.ranges[i].instance].add(of_ranges[i]);
  return places;
}

}  // namespace frontmost::why_detail
