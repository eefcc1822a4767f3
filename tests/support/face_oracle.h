// SPDX-License-Identifier: Apache-2.0
// The visible part of every triangle by brute force: the triangle, clipped to the view, less all parts of other
// triangles in front of it.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "frontmost/scene.h"
#include "frontmost/view.h"

namespace frontmost::test {

/// The oracle computes in long doubles and cuts once for each pair.
class FaceOracle {
 public:
  using Number = long double;
  using Vector = glm::vec<3, Number, glm::defaultp>;
  struct Areas {
    Number pixels = 0, units = 0, solid_angle = 0;
  };

  FaceOracle(const Surfaces& surfaces, const View& view) : view_(view) {
    for (PrimitiveId id = 0; id < surfaces.primitive_count(); ++id) {
      const bool is_mirrored = surfaces.is_mirrored(surfaces.source(id).instance);
      if (std::optional<Face> face = clipped(surfaces.corners(id), is_mirrored)) {
        face->id = id;
        faces_.push_back(std::move(*face));
      }
    }
  }

  /// Visible areas by id, of all visible triangles.
  [[nodiscard]] std::map<PrimitiveId, Areas> visible_areas() const {
    std::map<PrimitiveId, Areas> all;
    for (const Face& face : faces_) {
      std::vector<Polygon> left{face.polygon};
      for (const Face& other : faces_)
        if (&other != &face) left = less_what_is_before(left, face, other);
      Areas areas;
      for (const Polygon& polygon : left) add(areas, polygon, face);
      if (areas.pixels > 0) all[face.id] = areas;
    }
    return all;
  }

  /// Area in pixels of the union of all triangles on the screen, regardless of depth.
  [[nodiscard]] Number covered_area() const {
    Number covered = 0;
    for (std::size_t i = 0; i < faces_.size(); ++i) {
      std::vector<Polygon> left{faces_[i].polygon};
      for (std::size_t j = 0; j < i; ++j) {
        std::vector<Polygon> rest;
        for (const Polygon& polygon : left) subtract(polygon, faces_[j].polygon, rest);
        left = std::move(rest);
      }
      for (const Polygon& polygon : left) covered += doubled_area(polygon) / 2;
    }
    return covered;
  }

 private:
  struct Point {
    Number x, y;
  };
  /// A polygon that turns right as seen.
  using Polygon = std::vector<Point>;
  struct Face {
    PrimitiveId id = no_primitive;
    Polygon polygon;
    /// The plane in eye space, with x to the right, y down and z ahead: normal . p = offset
    Vector normal;
    Number offset;
  };
  /// a x + b y + c > 0 on its right
  struct HalfPlane {
    Number a, b, c;
    [[nodiscard]] Number at(const Point& p) const { return a * p.x + b * p.y + c; }
  };

  static Number doubled_area(const Polygon& polygon) {
    Number sum = 0;
    for (std::size_t i = 2; i < polygon.size(); ++i) {
      const Point &a = polygon[0], &b = polygon[i - 1], &c = polygon[i];
      sum += (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    }
    return sum;
  }
  static Polygon cut(const Polygon& polygon, const HalfPlane& half) {
    Polygon kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Point &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
      const Number from = half.at(a), to = half.at(b);
      if (from >= 0) kept.push_back(a);
      if ((from > 0 && to < 0) || (from < 0 && to > 0)) {
        const Number t = from / (from - to);
        kept.push_back({a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t});
      }
    }
    return kept;
  }
  /// Appends the parts of a polygon outside a convex one.
  static void subtract(Polygon polygon, const Polygon& hole, std::vector<Polygon>& rest) {
    for (std::size_t i = 0; i < hole.size() && polygon.size() > 2; ++i) {
      const Point &a = hole[i], &b = hole[(i + 1) % hole.size()];
      if (std::hypot(b.x - a.x, b.y - a.y) < 1e-12L) continue;  // vertices that cuts left twice
      const HalfPlane within{-(b.y - a.y), b.x - a.x, (b.y - a.y) * a.x - (b.x - a.x) * a.y};
      Polygon outside = cut(polygon, {-within.a, -within.b, -within.c});
      if (outside.size() > 2 && doubled_area(outside) > 1e-13L) rest.push_back(std::move(outside));
      polygon = cut(polygon, within);
    }
  }

  /// Nearness at the point where a ray meets a face's plane: 1 / distance, or minus the distance in parallel
  /// projection.
  [[nodiscard]] Number nearness(const Face& face, const Point& p) const {
    const Vector place = on_image(p);
    if (view_.projection.orthographic)
      return -(face.offset - face.normal.x * place.x - face.normal.y * place.y) / face.normal.z;
    return glm::dot(face.normal, place) / face.offset;
  }
  [[nodiscard]] Vector on_image(const Point& p) const {
    const Projection& q = view_.projection;
    return {Number(q.left) + p.x * (Number(q.right) - q.left) / view_.width,
            -(Number(q.top) - p.y * (Number(q.top) - q.bottom) / view_.height), 1};
  }

  [[nodiscard]] std::vector<Polygon> less_what_is_before(const std::vector<Polygon>& parts, const Face& face,
                                                         const Face& other) const {
    const Polygon before = part_before(face, other);
    if (before.size() < 3 || doubled_area(before) < 1e-12L) return parts;
    std::vector<Polygon> rest;
    for (const Polygon& part : parts) subtract(part, before, rest);
    return rest;
  }
  /// The part of `other` in front of `face` where both overlap.
  [[nodiscard]] Polygon part_before(const Face& face, const Face& other) const {
    Polygon common = other.polygon;
    for (std::size_t i = 0; i < face.polygon.size() && common.size() > 2; ++i) {
      const Point &a = face.polygon[i], &b = face.polygon[(i + 1) % face.polygon.size()];
      common = cut(common, {-(b.y - a.y), b.x - a.x, (b.y - a.y) * a.x - (b.x - a.x) * a.y});
    }
    if (common.size() < 3 || doubled_area(common) < 1e-12L) return {};
    bool is_one_plane = true;
    std::vector<Number> before;
    for (const Point& p : common) {
      const Number own = nearness(face, p);
      before.push_back(nearness(other, p) - own);
      is_one_plane = is_one_plane && std::abs(before.back()) <= 1e-13L * std::abs(own);
    }
    if (is_one_plane) return other.id < face.id ? common : Polygon{};
    Polygon kept;  // nearness is affine on the screen
    for (std::size_t i = 0; i < common.size(); ++i) {
      const std::size_t j = (i + 1) % common.size();
      if (before[i] >= 0) kept.push_back(common[i]);
      if ((before[i] > 0 && before[j] < 0) || (before[i] < 0 && before[j] > 0)) {
        const Number t = before[i] / (before[i] - before[j]);
        kept.push_back({common[i].x + (common[j].x - common[i].x) * t, common[i].y + (common[j].y - common[i].y) * t});
      }
    }
    return kept;
  }

  [[nodiscard]] std::optional<Face> clipped(const std::array<glm::vec3, 3>& world, bool is_mirrored) const {
    std::vector<Vector> p;
    for (const glm::vec3& corner : world) {
      const Vector d = Vector(corner) - Vector(view_.eye());
      p.push_back(
          {glm::dot(Vector(view_.right()), d), -glm::dot(Vector(view_.up()), d), glm::dot(Vector(view_.forward()), d)});
    }
    Face face;
    face.normal = glm::cross(p[1] - p[0], p[2] - p[0]);
    face.offset = glm::dot(face.normal, p[0]);
    const Projection& q = view_.projection;
    const Number unit = q.orthographic ? 0 : 1, rest = 1 - unit;
    cut(p, {0, 0, 1}, -Number(q.clip.near));
    if (std::isfinite(q.clip.far)) cut(p, {0, 0, -1}, q.clip.far);
    cut(p, {1, 0, -q.left * unit}, -q.left * rest);
    cut(p, {-1, 0, q.right * unit}, q.right * rest);
    cut(p, {0, 1, q.top * unit}, q.top * rest);
    cut(p, {0, -1, -q.bottom * unit}, -q.bottom * rest);
    for (const Vector& at : p) {
      const Number z = q.orthographic ? 1 : at.z;
      face.polygon.push_back({(at.x / z - q.left) * view_.width / (Number(q.right) - q.left),
                              (at.y / z + q.top) * view_.height / (Number(q.top) - q.bottom)});
    }
    const Number area = doubled_area(face.polygon);
    if (p.size() < 3 || area == 0) return std::nullopt;
    const bool is_front = (area < 0) != is_mirrored;  // y points down
    if (view_.culling == Culling::both || (view_.culling == Culling::front && is_front) ||
        (view_.culling == Culling::back && !is_front))
      return std::nullopt;
    if (area < 0) std::reverse(face.polygon.begin(), face.polygon.end());
    return face;
  }
  static void cut(std::vector<Vector>& polygon, const Vector& normal, Number offset) {
    std::vector<Vector> kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vector &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
      const Number from = glm::dot(normal, a) + offset, to = glm::dot(normal, b) + offset;
      if (from >= 0) kept.push_back(a);
      if ((from > 0 && to < 0) || (from < 0 && to > 0)) kept.push_back(a + (b - a) * (from / (from - to)));
    }
    polygon = std::move(kept);
  }

  /// The solid angle is the excess of the angles between the planes through the eye and the edges over half a turn.
  void add(Areas& areas, const Polygon& polygon, const Face& face) const {
    areas.pixels += doubled_area(polygon) / 2;
    for (std::size_t i = 2; i < polygon.size(); ++i) {
      Vector way[3], at[3];
      for (std::size_t k = 0; k < 3; ++k) {
        const Point& p = polygon[k == 0 ? 0 : i + k - 2];
        way[k] = on_image(p);
        at[k] =
            view_.projection.orthographic ? Vector(way[k].x, way[k].y, -nearness(face, p)) : way[k] / nearness(face, p);
      }
      areas.units += glm::length(glm::cross(at[1] - at[0], at[2] - at[0])) / 2;
      // Cuts leave vertices twice, where angles are arbitrary.
      const bool is_flat = doubled_area({polygon[0], polygon[i - 1], polygon[i]}) < 1e-11L;
      if (view_.projection.orthographic || is_flat) continue;
      Number excess = -std::acos(Number(-1));
      for (std::size_t k = 0; k < 3; ++k) {
        const Vector u = glm::cross(way[k], way[(k + 1) % 3]), v = glm::cross(way[k], way[(k + 2) % 3]);
        excess += std::atan2(glm::length(glm::cross(u, v)), glm::dot(u, v));
      }
      areas.solid_angle += excess;
    }
  }

  View view_;
  std::vector<Face> faces_;
};

}  // namespace frontmost::test
