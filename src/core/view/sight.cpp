// SPDX-License-Identifier: Apache-2.0
// J. Shewchuk. Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates. 1997: doubles with a
// bound on their rounding come first, then expansions if the bound leaves the sign open.
#include "view/sight.h"

#include <cmath>

namespace frontmost {
namespace {

/// The sign of n.v. Calls `exact_sign` if rounding matters.
template <class ExactSign>
Signed with_certain_sign(const BoundedNormal& n, const glm::dvec3& v, double slack, const ExactSign& exact_sign) {
  Bounded rounded = bounded_dot(n.value, n.error, v);
  if (slack > 0) rounded.error += slack * (std::abs(n.value.x) + std::abs(n.value.y) + std::abs(n.value.z));
  const int sign = certain_sign(rounded);
  if (sign != 2) return {rounded.value, sign};
  // An exact sign would be meaningless for a point that is known only within its slack.
  if (slack > 0) return {};
  return {rounded.value, exact_sign()};
}

}  // namespace

Sight::Sight(const View& view)
    : eye_(view.eye()),
      forward_(view.forward()),
      right_(view.right()),
      up_(view.up()),
      near_(view.projection.clip.near),
      far_(view.projection.clip.far),
      is_parallel_(view.projection.orthographic) {
  const Projection& p = view.projection;
  scale_ = {view.width / (p.right - p.left), -view.height / (p.top - p.bottom)};
  offset_ = {-p.left * scale_.x, -p.top * scale_.y};
}

Sight::EyePlane Sight::plane_through(const glm::dvec3& p, const glm::dvec3& q) const {
  EyePlane plane;
  plane.sight_ = this;
  plane.p_ = p;
  plane.q_ = q;
  plane.normal_ = BoundedNormal(is_parallel_ ? forward_ : p - eye_, q - p);
  return plane;
}

/// Vectors start at p, so the error bound is small for points near p and q, however far away the eye is. With vectors
/// from the eye to all three points, every seventh sign of a finely divided sphere would stay open.
Signed Sight::EyePlane::turn(const glm::dvec3& x, double slack) const {
  const Signed against = with_certain_sign(normal_, x - p_, slack, [&] {
    const Leg along = sight_->is_parallel_ ? Leg{sight_->forward_} : Leg{p_, sight_->eye_};
    return sign_of_determinant(along, {q_, p_}, {x, p_});
  });
  return {-against.value, -against.sign};
}

glm::dvec3 Sight::in_eye(const glm::dvec3& position) const {
  const glm::dvec3 from_eye = position - eye_;
  return {glm::dot(from_eye, right_), glm::dot(from_eye, up_), glm::dot(from_eye, forward_)};
}

glm::dvec3 Sight::to_screen(const glm::dvec3& in_eye) const {
  const double w = is_parallel_ ? 1 : in_eye.z;
  return {in_eye.x / w * scale_.x + offset_.x, in_eye.y / w * scale_.y + offset_.y, in_eye.z};
}

Signed FacePlane::height(const glm::dvec3& x, double slack) const {
  return with_certain_sign(normal_, x - a_, slack, [&] { return sign_of_determinant({b_, a_}, {c_, a_}, {x, a_}); });
}

}  // namespace frontmost
