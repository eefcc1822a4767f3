// SPDX-License-Identifier: Apache-2.0
// Decides the hit of a ray or segment, and what stands between a point and a light, exactly on the floats of the query,
// of the point and of the vertices. Also defines the public queries, which are answered in parts of 256, each by one
// kernel call. A single query is a part of one, so it gets the same answer.
//
// A point of a triangle with weights w and vertices c is (sum of w c) / (sum of w) + lift, a fraction that floats
// cannot hold. A vertex q of another triangle lies at (sum of w (q - c - lift)) / (sum of w) from the point. The
// division is left out, because it does not change signs of determinants; only sums of products remain. So rounding
// never darkens a point of a triangle that lies in the plane of its neighbour.

#include "raycast/query/queries.h"

#include <algorithm>
#include <cmath>

#include "base/exact_vector.h"
#include "base/parallel.h"

namespace frontmost {
namespace raycast_detail {
namespace {

/// Returns the sums as numbers that are never rounded.
ExactVector unrounded(const HighLowVector& v) {
  ExactVector sums;
  for (std::size_t axis = 0; axis < 3; ++axis) sums[axis] = Expansion(v.low[axis]) + Expansion(v.high[axis]);
  return sums;
}

/// Returns the t at which the ray meets the plane of vertices `c`, which are relative to the origin. Along every axis,
/// t is kept between the vertices: for slivers, or triangles tiny compared with their distance, rounding leaves no
/// better bound. The signs are certain, so the rounded t must not contradict them.
double place_along(const Query& q, const glm::dvec3& along, const std::array<glm::dvec3, 3>& c) {
  double nearest = std::numeric_limits<double>::denorm_min();
  double farthest = q.is_segment ? 1.0 : std::numeric_limits<double>::max();
  for (int axis = 0; axis < 3; ++axis) {
    if (along[axis] == 0) continue;
    const double low = std::min({c[0][axis], c[1][axis], c[2][axis]}) / along[axis];
    const double high = std::max({c[0][axis], c[1][axis], c[2][axis]}) / along[axis];
    nearest = std::max(nearest, std::min(low, high));
    farthest = std::min(farthest, std::max(low, high));
  }
  const glm::dvec3 n = glm::cross(c[1] - c[0], c[2] - c[0]);
  const double t = glm::dot(n, c[0]) / glm::dot(n, along);
  // t is NaN after underflow. Rounding may make the range empty; t is then still positive.
  return std::max(std::min(std::isnan(t) ? nearest : std::max(t, nearest), farthest),
                  std::numeric_limits<double>::denorm_min());
}

float dot3(const glm::vec3& a, const glm::vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

/// Coordinates with an error bound: at most 16 half units in the last place of `size`.
struct Rounded {
  glm::dvec3 value{0}, size{0};
};

Rounded rounded_from(const TrianglePoint& point, const glm::vec3& corner) {
  Rounded result;
  const glm::dvec3 lift(point.lift);
  for (int i = 0; i < 3; ++i) {
    const double weight = point.weights[i];
    const glm::dvec3 side = glm::dvec3(corner) - glm::dvec3(point.corners[std::size_t(i)]);
    result.value += weight * (side - lift);
    result.size += weight * (glm::abs(side) + glm::abs(lift));
  }
  return result;
}

ExactVector exact_from(const TrianglePoint& point, const glm::vec3& corner) {
  ExactVector result;
  for (int i = 0; i < 3; ++i)
    for (int axis = 0; axis < 3; ++axis) {
      Expansion side = Expansion::difference(corner[axis], point.corners[std::size_t(i)][axis]);
      side = side - Expansion(point.lift[axis]);
      result[std::size_t(axis)] = result[std::size_t(axis)] + Expansion(point.weights[i]) * side;
    }
  return result;
}

/// Returns the sign of the determinant, or 2 if rounding leaves it open.
int likely_sign(const Rounded& a, const Rounded& b, const Rounded& c) {
  const double det = glm::dot(a.value, glm::cross(b.value, c.value));
  const glm::dvec3 &p = b.size, &q = c.size;
  const glm::dvec3 minors(p.y * q.z + p.z * q.y, p.z * q.x + p.x * q.z, p.x * q.y + p.y * q.x);
  // Three coordinates of 16 half units each, and five more roundings.
  if (std::abs(det) > glm::dot(a.size, minors) * (64 * 0x1p-53)) return det > 0 ? 1 : -1;
  return 2;
}

/// The vertices of a triangle, relative to the point, and the direction of the light.
class LitTriangle {
 public:
  LitTriangle(const CornerPositions& corners, const TrianglePoint& point, const glm::vec3& to_light)
      : corners_(corners), point_(point), light_(to_light) {
    for (std::size_t k = 0; k < 3; ++k) rounded_[k] = rounded_from(point, corners[k]);
    rounded_light_ = {glm::dvec3(to_light), glm::abs(glm::dvec3(to_light))};
  }

  /// Returns how the light's ray turns about the edge from vertex i to vertex j.
  [[nodiscard]] int turn(std::size_t i, std::size_t j) const {
    const int likely = likely_sign(rounded_light_, rounded_[i], rounded_[j]);
    if (likely != 2) return likely;
    return dot(exact(light_), cross(exact_corner(i), exact_corner(j))).sign();
  }

  /// Returns the point's side of the triangle's plane, or 0 if the point is on the plane.
  [[nodiscard]] int side() const {
    const int likely = likely_sign(rounded_[0], rounded_[1], rounded_[2]);
    if (likely != 2) return likely;
    return dot(exact_corner(0), cross(exact_corner(1), exact_corner(2))).sign();
  }

 private:
  [[nodiscard]] ExactVector exact_corner(std::size_t k) const { return exact_from(point_, corners_[k]); }

  const CornerPositions& corners_;
  const TrianglePoint& point_;
  const glm::vec3& light_;
  std::array<Rounded, 3> rounded_;
  Rounded rounded_light_;
};

}  // namespace

HighLowVector high_low(const glm::vec3& v) { return {{v.x, v.y, v.z}, {}}; }

HighLowVector high_low_difference(const glm::vec3& b, const glm::vec3& a) {
  HighLowVector d;
  for (int i = 0; i < 3; ++i) {
    const double to = b[i], from = a[i], difference = to - from, from_to = difference - to;
    d.high[std::size_t(i)] = difference;
    d.low[std::size_t(i)] = (to - (difference - from_to)) - (from + from_to);
  }
  return d;
}

int determinant_sign(const HighLowVector& a, const HighLowVector& b, const HighLowVector& c) {
  const std::array<double, 3>&x = a.high, &y = b.high, &z = c.high;
  double det = 0, size = 0;
  for (int i = 0; i < 3; ++i) {
    const std::size_t j = std::size_t(i + 1) % 3, k = std::size_t(i + 2) % 3;
    const double p = y[j] * z[k], q = y[k] * z[j];
    det += x[std::size_t(i)] * (p - q);
    size += std::abs(x[std::size_t(i)]) * (std::abs(p) + std::abs(q));
  }
  // Each product in `det` has three rounded coordinates, and five more roundings follow. So the error of `det` is less
  // than 16 half units in the last place of `size`.
  if (std::abs(det) > size * 0x1p-49) return det > 0 ? 1 : -1;
  return dot(unrounded(a), cross(unrounded(b), unrounded(c))).sign();
}

bool is_valid(const Query& q) {
  const glm::vec3& other = q.is_segment ? q.end : q.direction;
  // The sum is zero, or NaN if a value is not finite.
  if (dot3(q.origin, glm::vec3(0)) + dot3(other, glm::vec3(0)) != 0) return false;
  return other != (q.is_segment ? q.origin : glm::vec3(0));
}

RayHit meet(const Query& q, const std::array<glm::vec3, 3>& corners, PrimitiveId id) {
  const HighLowVector along = q.is_segment ? high_low_difference(q.end, q.origin) : high_low(q.direction);
  std::array<HighLowVector, 3> c;
  for (std::size_t k = 0; k < 3; ++k) c[k] = high_low_difference(corners[k], q.origin);
  // The signs say how the line turns about each edge. If they are negative, the vertices are counter-clockwise as seen
  // by the ray, so it meets the front.
  const int u = determinant_sign(along, c[1], c[2]), v = determinant_sign(along, c[2], c[0]),
            w = determinant_sign(along, c[0], c[1]);
  const int least = std::min({u, v, w}), most = std::max({u, v, w});
  const int facing = least >= 0 ? most : most <= 0 ? least : 0;
  if (facing == 0) return {};
  // The triangle lies ahead if the origin is on the matching side of its plane. A surface through the origin is not
  // met.
  if (determinant_sign(c[0], c[1], c[2]) != facing) return {};
  if (q.is_segment) {
    std::array<HighLowVector, 3> e;
    for (std::size_t k = 0; k < 3; ++k) e[k] = high_low_difference(corners[k], q.end);
    if (determinant_sign(e[0], e[1], e[2]) != -facing) return {};
  }
  return certain_hit(q, corners, id, facing < 0);
}

RayHit certain_hit(const Query& q, const std::array<glm::vec3, 3>& corners, PrimitiveId id, bool is_front) {
  const glm::dvec3 from(q.origin), along = q.is_segment ? glm::dvec3(q.end) - from : glm::dvec3(q.direction);
  const auto relative = [&](std::size_t k) { return glm::dvec3(corners[k]) - from; };
  return {id, place_along(q, along, {relative(0), relative(1), relative(2)}), is_front};
}

bool is_valid(const TrianglePoint& point) {
  // The sum is zero, or NaN if a value is not finite.
  float nothing = dot3(point.lift, glm::vec3(0)) + dot3(point.weights, glm::vec3(0));
  for (const glm::vec3& corner : point.corners) nothing += dot3(corner, glm::vec3(0));
  const glm::vec3& w = point.weights;
  return nothing == 0 && w.x >= 0 && w.y >= 0 && w.z >= 0 && (w.x > 0 || w.y > 0 || w.z > 0);
}

bool is_own(const CornerPositions& corners, const TrianglePoint& point) {
  // Positions are compared, not ids, because a triangle that is in a file twice would darken itself.
  return std::is_permutation(corners.begin(), corners.end(), point.corners.begin());
}

bool stands_before(const CornerPositions& corners, const TrianglePoint& point, const glm::vec3& to_light) {
  if (is_own(corners, point)) return false;
  const LitTriangle sight(corners, point, to_light);
  // The rule is that of meet(): all turns have one sign or are 0, and the plane lies ahead.
  const int u = sight.turn(1, 2), v = sight.turn(2, 0), w = sight.turn(0, 1);
  const int least = std::min({u, v, w}), most = std::max({u, v, w});
  const int facing = least >= 0 ? most : most <= 0 ? least : 0;
  return facing != 0 && sight.side() == facing;
}

glm::dvec3 position_of(const TrianglePoint& point) {
  glm::dvec3 sum(0);
  for (int i = 0; i < 3; ++i) sum += double(point.weights[i]) * glm::dvec3(point.corners[std::size_t(i)]);
  return sum / (double(point.weights.x) + double(point.weights.y) + double(point.weights.z)) + glm::dvec3(point.lift);
}

glm::dvec3 passed_point(const CornerPositions& corners, const TrianglePoint& point, const glm::vec3& to_light) {
  const glm::dvec3 a(corners[0]), light(to_light), from = position_of(point);
  const glm::dvec3 normal = glm::cross(glm::dvec3(corners[1]) - a, glm::dvec3(corners[2]) - a);
  return from + glm::dot(normal, a - from) / glm::dot(normal, light) * light;
}

}  // namespace raycast_detail

namespace {

using namespace raycast_detail;

/// Queries and answers of a part take 20 KiB, so they fit the stack and the first-level cache.
constexpr std::size_t kQueriesPerPart = 256;

Query query_of(const Ray& ray) { return {ray.origin, ray.origin, ray.direction, false}; }

/// The rounded direction may overflow if the ends are as far apart as floats reach; the walk then leaves no box out.
Query query_of(const Segment& segment) { return {segment.from, segment.to, segment.to - segment.from, true}; }

template <class Question>
RayHit first_of(const RayIndex& index, const Question& question, Want want) {
  const IeeeScope ieee;
  const Query query = query_of(question);
  RayHit hit;
  walk_batch(ray_tree(index), {&query, 1}, want, {&hit, 1}, Isa::best);
  return hit;
}

void check_sizes(std::size_t queries, std::size_t answers) {
  if (queries != answers)
    throw Error(ErrorCode::bad_argument, "answers",
                "there are " + std::to_string(answers) + " places for " + std::to_string(queries) + " queries");
}

/// Calls take(begin, hits) for the answers to consecutive questions, the first of which has the index `begin`. Answers
/// are stored by index, so they do not depend on threads.
template <class Question, class Take>
void ask(const RayIndex& index, std::span<const Question> questions, Want want, const Execution& execution,
         const Take& take) {
  parallel_for(execution, questions.size(), kQueriesPerPart, [&](std::size_t begin, std::size_t end) {
    std::array<Query, kQueriesPerPart> queries;
    std::array<RayHit, kQueriesPerPart> hits;
    const std::size_t count = end - begin;
    for (std::size_t i = 0; i < count; ++i) queries[i] = query_of(questions[begin + i]);
    walk_batch(ray_tree(index), {queries.data(), count}, want, {hits.data(), count}, execution.isa);
    take(begin, std::span<const RayHit>(hits.data(), count));
  });
}

template <class Question>
void ask_closest(const RayIndex& index, std::span<const Question> questions, std::span<RayHit> answers,
                 const Execution& execution) {
  check_sizes(questions.size(), answers.size());
  ask(index, questions, Want::closest, execution, [&](std::size_t begin, std::span<const RayHit> hits) {
    std::copy(hits.begin(), hits.end(), answers.begin() + std::ptrdiff_t(begin));
  });
}

}  // namespace

RayHit closest_hit(const RayIndex& index, const Ray& ray) { return first_of(index, ray, Want::closest); }

RayHit closest_hit(const RayIndex& index, const Segment& segment) { return first_of(index, segment, Want::closest); }

std::vector<RayHit> all_hits(const RayIndex& index, const Ray& ray) {
  const IeeeScope ieee;
  std::vector<RayHit> hits;
  const Query query = query_of(ray);
  if (!is_valid(query)) return hits;
  walk(ray_tree(index), query, Want::all, hits, Isa::best);
  if (ray_tree(index).copies) walk(*ray_tree(index).copies, query, Want::all, hits, Isa::best);
  std::sort(hits.begin(), hits.end(),
            [](const RayHit& a, const RayHit& b) { return a.t != b.t ? a.t < b.t : a.primitive < b.primitive; });
  return hits;
}

bool is_clear(const RayIndex& index, const Segment& segment) {
  return first_of(index, segment, Want::any).primitive == no_primitive;
}

void closest_hits(const RayIndex& index, std::span<const Ray> rays, std::span<RayHit> answers,
                  const Execution& execution) {
  ask_closest(index, rays, answers, execution);
}

void closest_hits(const RayIndex& index, std::span<const Segment> segments, std::span<RayHit> answers,
                  const Execution& execution) {
  ask_closest(index, segments, answers, execution);
}

void are_clear(const RayIndex& index, std::span<const Segment> segments, std::span<std::uint8_t> answers,
               const Execution& execution) {
  check_sizes(segments.size(), answers.size());
  ask(index, segments, Want::any, execution, [&](std::size_t begin, std::span<const RayHit> hits) {
    for (std::size_t i = 0; i < hits.size(); ++i) answers[begin + i] = hits[i].primitive == no_primitive;
  });
}

void are_lit(const RayIndex& index, std::span<const TrianglePoint> points, const glm::vec3& to_light,
             std::span<std::uint8_t> answers, const Execution& execution) {
  check_sizes(points.size(), answers.size());
  parallel_for(execution, points.size(), kQueriesPerPart, [&](std::size_t begin, std::size_t end) {
    find_lit(ray_tree(index), points.subspan(begin, end - begin), {to_light}, answers.subspan(begin, end - begin),
             execution.isa);
  });
}

}  // namespace frontmost
