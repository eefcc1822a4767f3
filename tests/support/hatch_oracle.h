// SPDX-License-Identifier: Apache-2.0
// Whether a hatch line is drawn at a point: tests every triangle for visibility and for shadow.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "frontmost/lines.h"
#include "support/random_scene.h"

namespace frontmost::test {

/// Reference for one hatch set, without smooth normals.
class HatchOracle {
 public:
  HatchOracle(const Surfaces& surfaces, const View& view, const HatchOptions& options)
      : view_(view), set_(options.sets.at(0)), to_light_(glm::normalize(*options.tone.to_light)) {
    casts_shadows_ = options.tone.casts_shadows;
    for (PrimitiveId id = 0; id < surfaces.primitive_count(); ++id) {
      Triangle t;
      for (int k = 0; k < 3; ++k) t.at[k] = glm::dvec3(surfaces.corners(id)[std::size_t(k)]);
      t.normal = glm::cross(t.at[1] - t.at[0], t.at[2] - t.at[0]);
      if (glm::length(t.normal) > 0) triangles_.push_back(t);
    }
  }

  struct Place {
    glm::dvec2 at{0}, direction{0};
  };
  [[nodiscard]] Place random_place(Random& random) const {
    const glm::dvec2 direction(std::cos(set_.angle), -std::sin(set_.angle)), across(-direction.y, direction.x);
    const double x = random.within(0, float(view_.width)), y = random.within(0, float(view_.height));
    const double height = glm::dot(across, {x, y});
    const double line = set_.offset + std::round((height - set_.offset) / set_.spacing) * set_.spacing;
    return {glm::dvec2(x, y) + across * (line - height), direction};
  }

  struct Answer {
    bool is_certain = false, is_dark = false;
  };
  [[nodiscard]] Answer ask(const Place& place) const {
    const Projection& p = view_.projection;
    if (place.at.x < 1e-3 || place.at.y < 1e-3 || place.at.x > view_.width - 1e-3 || place.at.y > view_.height - 1e-3)
      return {};
    // Points slightly to the sides are tested too: if all agree, rounding does not matter.
    Answer all;
    for (int i = 0; i < 5; ++i) {
      const glm::dvec2 at = place.at + 2e-3 * glm::dvec2(i == 1 ? 1 : i == 2 ? -1 : 0, i == 3 ? 1 : i == 4 ? -1 : 0);
      const double x = p.left + at.x / view_.width * (p.right - p.left),
                   y = p.top - at.y / view_.height * (p.top - p.bottom);
      const glm::dvec3 aside = view_.right() * x + view_.up() * y;
      const Answer one = p.orthographic ? along({view_.eye() + aside, view_.forward()})
                                        : along({view_.eye(), view_.forward() + aside});
      if (!one.is_certain || (i > 0 && one.is_dark != all.is_dark)) return {};
      all = one;
    }
    return all;
  }

  [[nodiscard]] static bool is_hatched(const std::vector<HatchLine>& lines, const Place& place) {
    return std::any_of(lines.begin(), lines.end(), [&](const HatchLine& line) {
      const glm::dvec2 from = line.from - place.at, to = line.to - place.at;
      const double off = std::abs(from.x * place.direction.y - from.y * place.direction.x);
      return off < 1e-3 && glm::dot(from, place.direction) * glm::dot(to, place.direction) <= 0;
    });
  }

 private:
  struct Triangle {
    glm::dvec3 at[3], normal;
  };
  struct Ray {
    glm::dvec3 from, along;
  };

  /// The distance in units of ray.along; infinite if the ray misses.
  static double hit(const Triangle& t, const Ray& ray) {
    const double towards = glm::dot(t.normal, ray.along);
    constexpr double never = std::numeric_limits<double>::infinity();
    if (towards == 0) return never;
    const double distance = glm::dot(t.normal, t.at[0] - ray.from) / towards;
    const glm::dvec3 point = ray.from + ray.along * distance;
    for (int k = 0; k < 3; ++k) {
      const glm::dvec3 &a = t.at[k], &b = t.at[k == 2 ? 0 : k + 1];
      if (!(glm::dot(glm::cross(b - a, point - a), t.normal) >= 0)) return never;
    }
    return distance;
  }

  [[nodiscard]] Answer along(const Ray& ray) const {
    double nearest = std::numeric_limits<double>::infinity(), second = nearest;
    const Triangle* seen = nullptr;
    for (const Triangle& t : triangles_) {
      const double distance = hit(t, ray);
      if (!(distance >= view_.projection.clip.near && distance <= view_.projection.clip.far)) continue;
      if (distance < nearest) {
        second = std::exchange(nearest, distance);
        seen = &t;
      } else {
        second = std::min(second, distance);
      }
    }
    if (seen == nullptr) return {true, false};
    if (second - nearest < 1e-4 * nearest) return {};
    glm::dvec3 normal = glm::normalize(seen->normal);
    if (glm::dot(normal, ray.along) > 0) normal = -normal;
    const double brightness = glm::dot(normal, to_light_);
    if (std::abs(brightness - set_.below) < 1e-4 || std::abs(brightness) < 1e-4) return {};
    if (brightness < set_.below) return {true, true};
    return {true, casts_shadows_ && is_in_shadow(ray.from + ray.along * nearest, seen)};
  }

  [[nodiscard]] bool is_in_shadow(const glm::dvec3& point, const Triangle* own) const {
    return std::any_of(triangles_.begin(), triangles_.end(), [&](const Triangle& t) {
      const double distance = hit(t, {point, to_light_});
      return &t != own && distance > 0 && distance < std::numeric_limits<double>::infinity();
    });
  }

  const View view_;
  const HatchSet set_;
  const glm::dvec3 to_light_;
  bool casts_shadows_ = true;
  std::vector<Triangle> triangles_;
};

}  // namespace frontmost::test
