// SPDX-License-Identifier: Apache-2.0
// Why two methods see different triangles at a sample, decided on the triangles' exact screen positions in doubles,
// which err by less than a millionth of a pixel here, against margins of 1/128.
//
// What is certain at a sample: a triangle that contains all of the square of +-1/128 pixel about it is met by every
// method, one that contains none of it by none. Of two that are met, one is certainly nearer when its farthest depth
// over the square is less than the other's nearest, by more than keys resolve.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "frontmost/visible.h"

namespace frontmost::test {

struct Explained {
  std::size_t differing = 0, edge = 0, depth = 0, unexplained = 0, first_unexplained = 0;
};

class Explainer {
 public:
  Explainer(const Surfaces& surfaces, const View& view) : surfaces_(surfaces), view_(view) {
    eye_from_world_ = glm::inverse(view.world_from_eye);
  }

  [[nodiscard]] Explained compare(const Visible& a, const Visible& b) const {
    Explained result;
    const auto samples = sample_offsets(view_.samples);
    for (std::size_t i = 0; i < a.primitives.size(); ++i) {
      if (a.primitives[i] == b.primitives[i]) continue;
      ++result.differing;
      const std::size_t pixel = i % view_.pixel_count(), s = i / view_.pixel_count();
      const glm::dvec2 at(double(pixel % std::size_t(view_.width)) + samples[s].x / 256.0,
                          double(pixel / std::size_t(view_.width)) + samples[s].y / 256.0);
      const Reason reason = explain(a.primitives[i], b.primitives[i], at);
      result.edge += reason == Reason::edge;
      result.depth += reason == Reason::depth;
      if (reason == Reason::none && result.unexplained++ == 0) result.first_unexplained = i;
    }
    return result;
  }

 private:
  static constexpr double kMargin = 1.0 / 128;  // pixels
  enum class Reason { none, edge, depth };

  /// What a triangle is over the square about a sample.
  struct Met {
    bool surely = false, maybe = false;
    double nearest = 0, farthest = 0;  // keys: greatest and least over the square
    double greatest = 0;               // of the corners
  };

  [[nodiscard]] Reason explain(PrimitiveId a, PrimitiveId b, const glm::dvec2& at) const {
    const Met first = met(a, at), second = met(b, at);
    if ((a != no_primitive && !first.maybe) || (b != no_primitive && !second.maybe)) return Reason::none;
    if ((a != no_primitive && !first.surely) || (b != no_primitive && !second.surely)) return Reason::edge;
    if (a == no_primitive || b == no_primitive) return Reason::none;
    // Keys are floats of a plane that may start at any corner: 16 units in the last place of the greatest corner's
    // key, which is 1 where a triangle reaches the near plane.
    const double resolution = 16 * 0x1p-24 * std::max(first.greatest, second.greatest);
    const bool apart = first.farthest > second.nearest + resolution || second.farthest > first.nearest + resolution;
    return apart ? Reason::none : Reason::depth;
  }

  /// The key of the plane through three corners in eye space at a point of the screen.
  [[nodiscard]] double key_at(const std::array<glm::dvec3, 3>& c, const glm::dvec2& at) const {
    const Projection& p = view_.projection;
    const double x = p.left + (p.right - p.left) * at.x / view_.width;
    const double y = p.top - (p.top - p.bottom) * at.y / view_.height;
    const glm::dvec3 n = glm::cross(c[1] - c[0], c[2] - c[0]);
    if (p.orthographic) {
      const double z = c[0].z - (n.x * (x - c[0].x) + n.y * (y - c[0].y)) / n.z;
      return (p.clip.far + z) / (p.clip.far - p.clip.near);
    }
    return p.clip.near * glm::dot(n, glm::dvec3(x, y, -1)) / glm::dot(n, c[0]);
  }

  [[nodiscard]] double corner_key(const glm::dvec3& c) const {
    const ClipDistances& clip = view_.projection.clip;
    if (-c.z <= clip.near) return 1;
    return view_.projection.orthographic ? 1 : clip.near / -c.z;
  }

  /// Twice the signed area that the edge from a to b spans with a point of the image plane, homogeneous.
  [[nodiscard]] double edge(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec2& at) const {
    const Projection& p = view_.projection;
    const double x = p.left + (p.right - p.left) * at.x / view_.width;
    const double y = p.top - (p.top - p.bottom) * at.y / view_.height;
    if (p.orthographic) return (a.x - x) * (b.y - y) - (a.y - y) * (b.x - x);
    return glm::dot(glm::cross(a, b), glm::dvec3(x, y, -1));
  }

  [[nodiscard]] Met met(PrimitiveId id, const glm::dvec2& at) const {
    Met result;
    if (id == no_primitive) return result;
    std::array<glm::dvec3, 3> c;
    const std::array<glm::vec3, 3> world = surfaces_.corners(id);
    for (std::size_t k = 0; k < 3; ++k) c[k] = glm::dvec3(eye_from_world_ * glm::dvec4(world[k], 1));
    for (const glm::dvec3& corner : c) result.greatest = std::max(result.greatest, corner_key(corner));
    result.nearest = -std::numeric_limits<double>::infinity();
    result.farthest = std::numeric_limits<double>::infinity();
    bool all_in = true;
    std::array<bool, 3> positive_anywhere{}, negative_anywhere{};
    bool near_anywhere = false;
    for (int corner = 0; corner < 4; ++corner) {
      const glm::dvec2 here = at + kMargin * glm::dvec2(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1);
      std::array<double, 3> e;
      for (std::size_t k = 0; k < 3; ++k) {
        e[k] = edge(c[k], c[(k + 1) % 3], here);
        positive_anywhere[k] = positive_anywhere[k] || e[k] >= 0;
        negative_anywhere[k] = negative_anywhere[k] || e[k] <= 0;
      }
      const bool inside = (e[0] > 0 && e[1] > 0 && e[2] > 0) || (e[0] < 0 && e[1] < 0 && e[2] < 0);
      const double key = key_at(c, here);
      const double least = view_.projection.orthographic ? 0 : view_.projection.clip.near / view_.projection.clip.far;
      const bool between = key <= 1 && key >= least;
      near_anywhere = near_anywhere || between || !std::isfinite(key);
      all_in = all_in && inside && between;
      result.nearest = std::max(result.nearest, key);
      result.farthest = std::min(result.farthest, key);
    }
    result.surely = all_in;
    // None of the square is inside if it lies wholly beyond one edge, for either way of facing.
    const bool may_face = positive_anywhere[0] && positive_anywhere[1] && positive_anywhere[2];
    const bool may_back = negative_anywhere[0] && negative_anywhere[1] && negative_anywhere[2];
    const double rim = 16 * 0x1p-24;
    const bool near_planes = near_anywhere || (result.nearest >= -rim && result.farthest <= 1 + rim);
    result.maybe = (may_face || may_back) && near_planes;
    return result;
  }

  const Surfaces& surfaces_;
  const View& view_;
  glm::dmat4 eye_from_world_;
};

}  // namespace frontmost::test
