// SPDX-License-Identifier: Apache-2.0
// The side of a point is computed with ever costlier numbers until the answer is certain: doubles with a bound on their
// error, which nearly always suffice; numbers of twice the length (Twice), for points where three planes meet; and
// expansions, which are never rounded, for points in the plane or next to it.
//
// A plane is n.x = d with n = u x v, where u and v are differences of given points: n has degree 2 in the input. The
// meeting point of three planes is a quotient by Cramer's rule, of degree 7 above and 6 below. Its side of a fourth
// plane is the sign of a polynomial of degree 9. All coordinates are relative to a point of the first plane, so its d
// is 0.
#include "painter/cutting/plane.h"

#include <algorithm>

namespace frontmost::painter_detail {

int Plane::side_by_hand(const glm::dvec3& x) const {
  // Rounding hardly ever leaves the side open, except for vertices that triangles share.
  if (x == anchor_ || (x == u_.to && u_.from == anchor_) || (x == v_.to && v_.from == anchor_)) return 0;
  return sign_of_determinant(u_, v_, {x, anchor_});
}

Bounded Plane::height(const glm::dvec3& x, double error) const {
  Bounded height = bounded_dot(normal_.value, normal_.error, x - anchor_);
  const glm::dvec3 slope = glm::abs(normal_.value) + normal_.error;
  height.error += error * (slope.x + slope.y + slope.z);
  return height;
}

Bounded Plane::least_height(const glm::dvec3& centre, const std::array<glm::dvec3, 3>& halves, double error) const {
  Bounded least = height(centre, error);
  const glm::dvec3 doubt = normal_.error + kRounding * glm::abs(normal_.value);
  for (const glm::dvec3& half : halves) {
    least.value -= std::abs(glm::dot(normal_.value, half));
    least.error += glm::dot(doubt, glm::abs(half));
  }
  return least;
}

/// Applies Cramer's rule relative to a point of the first plane. The same sums, taken of absolute values, bound the
/// rounding: three normals and a distance, each wrong by at most kRounding of its own terms, and a dozen roundings
/// more.
Approximate Plane::meeting(const std::array<const Plane*, 3>& planes) {
  const Plane &a = *planes[0], &b = *planes[1], &c = *planes[2];
  const auto size = [](const Plane& plane) { return plane.normal_.error / kRounding; };
  const auto cross_size = [](const glm::dvec3& p, const glm::dvec3& q) {
    return glm::dvec3(p.y * q.z + p.z * q.y, p.z * q.x + p.x * q.z, p.x * q.y + p.y * q.x);
  };
  const auto distance = [&](const Plane& plane) { return glm::dot(plane.normal_.value, plane.anchor_ - a.anchor_); };
  const auto distance_size = [&](const Plane& plane) {
    return glm::dot(size(plane), glm::abs(plane.anchor_ - a.anchor_));
  };
  const glm::dvec3 bc = glm::cross(b.normal_.value, c.normal_.value), ca = glm::cross(c.normal_.value, a.normal_.value),
                   ab = glm::cross(a.normal_.value, b.normal_.value);
  const double determinant = glm::dot(a.normal_.value, bc);
  const double doubt = 8 * kRounding * glm::dot(size(a), cross_size(size(b), size(c)));
  if (!(std::abs(determinant) > 2 * doubt)) return {};
  const glm::dvec3 from_a = (distance(b) * ca + distance(c) * ab) / determinant;
  const glm::dvec3 error =
      8 * kRounding *
      (distance_size(b) * cross_size(size(c), size(a)) + distance_size(c) * cross_size(size(a), size(b)));
  const glm::dvec3 bound = 2.0 * (error + doubt * glm::abs(from_a)) / std::abs(determinant) +
                           kRounding * (glm::abs(from_a) + glm::abs(a.anchor_));
  return {a.anchor_ + from_a, bound.x + bound.y + bound.z};
}

namespace {

int sign_of(const Twice& number) { return number.certain_sign(); }
int sign_of(const Expansion& number) { return number.sign(); }
Bounded bounded_of(const Twice& number) { return number.bounded(); }
Bounded bounded_of(const Expansion& number) { return {number.rounded(), 0}; }

/// The meeting point of three planes by Cramer's rule: `times` / determinant, relative to a point of the first plane,
/// whose d is 0.
template <class Number>
struct Meeting {
  LongVector<Number> times;
  Number determinant;

  explicit Meeting(const std::array<LongPlane<Number>, 3>& planes) {
    const auto& [a, b, c] = planes;
    const LongVector<Number> bc = cross_of(b.n, c.n), ca = cross_of(c.n, a.n), ab = cross_of(a.n, b.n);
    determinant = dot_of(a.n, bc);
    for (std::size_t axis = 0; axis < 3; ++axis) times[axis] = b.d * ca[axis] + c.d * ab[axis];
  }
};

/// Returns a quotient of rounded numbers, with an error bound, which is infinite if the sign of the denominator is
/// open.
Bounded quotient(const Bounded& above, const Bounded& below) {
  const double least = std::abs(below.value) - below.error, value = above.value / below.value;
  if (!(least > 0)) return {0, std::numeric_limits<double>::infinity()};
  return {value, (above.error + std::abs(value) * below.error) / least + kRounding * std::abs(value)};
}

}  // namespace

template <class Number>
LongPlane<Number> Plane::in_full(const glm::dvec3& centre) const {
  LongPlane<Number> plane{cross_of(difference_of<Number>(u_.to, u_.from), difference_of<Number>(v_.to, v_.from)), {}};
  plane.d = dot_of(plane.n, difference_of<Number>(anchor_, centre));
  return plane;
}

template <class Number>
int Plane::sign_of_meeting(const std::array<const Plane*, 3>& planes) const {
  const glm::dvec3& centre = planes[0]->anchor_;
  const Meeting<Number> meeting(
      {planes[0]->in_full<Number>(centre), planes[1]->in_full<Number>(centre), planes[2]->in_full<Number>(centre)});
  const LongPlane<Number> asked = in_full<Number>(centre);
  const int height = sign_of(dot_of(asked.n, meeting.times) - asked.d * meeting.determinant),
            determinant = sign_of(meeting.determinant);
  return height == 2 || determinant == 2 ? 2 : height * determinant;
}

int Plane::side_of_meeting(const std::array<const Plane*, 3>& planes) const {
  if (std::any_of(planes.begin(), planes.end(), [&](const Plane* plane) { return is_same(*plane); })) return 0;
  const int twice = sign_of_meeting<Twice>(planes);
  return twice != 2 ? twice : sign_of_meeting<Expansion>(planes);
}

template <class Number>
Approximate Plane::long_meeting(const std::array<const Plane*, 3>& planes) {
  const glm::dvec3& centre = planes[0]->anchor_;
  const Meeting<Number> meeting(
      {planes[0]->in_full<Number>(centre), planes[1]->in_full<Number>(centre), planes[2]->in_full<Number>(centre)});
  Approximate point{centre, 0};
  for (int axis = 0; axis < 3; ++axis) {
    const Bounded from_centre = quotient(bounded_of(meeting.times[std::size_t(axis)]), bounded_of(meeting.determinant));
    point.at[axis] += from_centre.value;
    point.error += from_centre.error + kRounding * std::abs(point.at[axis]);
  }
  return point;
}

Approximate Plane::closest_meeting(const std::array<const Plane*, 3>& planes, double error) {
  const Approximate twice = long_meeting<Twice>(planes);
  return twice.error <= error ? twice : long_meeting<Expansion>(planes);
}

}  // namespace frontmost::painter_detail
