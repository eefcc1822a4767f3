// SPDX-License-Identifier: Apache-2.0
// Rays in doubles, those of a view among them, and where they meet a curved primitive.
//
// Curved primitives are met in doubles throughout. Rays of a view have no unit length; their t is the planar distance,
// as everything that is compared with the keys of triangles needs.
#pragma once

#include <algorithm>

#include "view/screen_transform.h"

namespace frontmost::raycast_detail {

/// Points origin + t * direction, of which those with from <= t <= to count.
struct DoubleRay {
  glm::dvec3 origin{0}, direction{0, 0, -1};
  double from = 0, to = std::numeric_limits<double>::infinity();
  Culling culling = Culling::none;

  /// Whether a surface with this outward normal is looked at. Edge-on counts as front.
  [[nodiscard]] bool keeps(const glm::dvec3& normal, bool is_double_sided) const {
    const bool is_front = glm::dot(normal, direction) <= 0;
    const Culling rule = culling != Culling::material ? culling : is_double_sided ? Culling::none : Culling::back;
    return rule == Culling::none || (rule == Culling::back && is_front) || (rule == Culling::front && !is_front);
  }
};

struct RayMeeting {
  double t = 0;
  glm::dvec2 parameters{0};
  glm::dvec3 normal{0};  ///< world space, unit length, outwards
};

/// The rays of a view. Along them t is the planar distance. Borrows the view, which is valid.
class ViewRays {
 public:
  explicit ViewRays(const View& view)
      : view_(view),
        axes_(view.world_from_eye),
        step_{(view.projection.right - view.projection.left) / view.width,
              (view.projection.top - view.projection.bottom) / view.height},
        near_(view.projection.clip.near),
        far_(std::min(view.projection.clip.far, double(ScreenTransform::farthest))) {}

  /// Through a sample of a pixel, `offset` in 1/256 pixel.
  [[nodiscard]] DoubleRay at(int x, int y, const glm::ivec2& offset) const {
    const Projection& p = view_.projection;
    const double right = p.left + (x + offset.x / 256.0) * step_.x, up = p.top - (y + offset.y / 256.0) * step_.y;
    const glm::dvec3 across = axes_[0] * right + axes_[1] * up;
    if (p.orthographic) return {view_.eye() + across, -axes_[2], near_, far_, view_.culling};
    return {view_.eye(), across - axes_[2], near_, far_, view_.culling};
  }

  [[nodiscard]] float key(double distance) const {
    const double key = view_.projection.orthographic ? (far_ - distance) / (far_ - near_) : near_ / distance;
    return float(std::min(std::max(key, 0.0), 1.0));
  }
  [[nodiscard]] double distance(float key) const {
    return view_.projection.orthographic ? far_ - double(key) * (far_ - near_) : near_ / double(key);
  }
  /// Farther than any distance that this key may come from.
  [[nodiscard]] double beyond(float key) const {
    constexpr double kRoundings = 0x1p-20;
    const double beyond =
        view_.projection.orthographic ? distance(key) + (far_ - near_) * kRoundings : distance(key) * (1 + kRoundings);
    return std::min(beyond, far_);
  }
  /// The larger side of a pixel at a distance, in world units.
  [[nodiscard]] double pixel_size(double distance) const {
    return std::max(std::abs(step_.x), std::abs(step_.y)) * (view_.projection.orthographic ? 1 : distance);
  }

 private:
  const View& view_;
  glm::dmat3 axes_;
  glm::dvec2 step_;
  double near_, far_;
};

}  // namespace frontmost::raycast_detail
