// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "raycast/index/ray_tree.h"
#include "raycast/query/queries.h"
#include "shade/shadow/light_shadows.h"
#include "view/facing_rule.h"

namespace frontmost::shading {
namespace {

/// Whether light passes through some triangles from behind.
bool lets_light_through(const View& view, const RayIndex& index) {
  return view.culling == Culling::material &&
         FacingRule(view.culling, ray_tree(index).sides.get()).culling() != Culling::none;
}

}  // namespace

RayShadows::RayShadows(const RayIndex& index, bool knows_ids, std::span<const glm::ivec2> samples, const View& view,
                       const Execution& execution, Limit limit)
    : index_(index),
      eye_(view.eye()),
      is_one_way_(lets_light_through(view, index)),
      isa_(execution.isa),
      knows_ids_(knows_ids),
      samples_(samples),
      rays_(execution, limit.most, "shade"),
      crowd_(execution, kMostOfCrowd + kMostOfTriangle * index.triangle_count(), "shade"),
      too_many_(std::move(limit.error)) {}

/// Points whose rays to a far light are traced together, and their fragments.
class RayShadows::LightQuestions {
 public:
  LightQuestions(const RayShadows& shadows, const glm::vec3& to_light, FragmentBatch& batch)
      : shadows_(shadows), to_light_(to_light), batch_(batch) {}

  void add(const TrianglePoint& point, int fragment) {
    points_[count_] = point;
    fragments_[count_] = fragment;
    if (++count_ == points_.size()) ask();
  }

  /// Traces the rays, and adds the number of lit points to each fragment. Floats add whole numbers exactly.
  void ask() {
    shadows_.count(count_);
    std::array<std::uint8_t, kAtOnce> is_lit;
    const std::uint64_t decided =
        raycast_detail::find_lit(ray_tree(shadows_.index_), {points_.data(), count_}, {to_light_, shadows_.is_one_way_},
                                 {is_lit.data(), count_}, shadows_.isa_);
    shadows_.count_decided(decided, count_);
    for (std::size_t k = 0; k < count_; ++k) batch_.shadow[fragments_[k]] += is_lit[k];
    count_ = 0;
  }

 private:
  static constexpr std::size_t kAtOnce = 4 * raycast_detail::kLightRays;

  const RayShadows& shadows_;
  glm::vec3 to_light_;
  FragmentBatch& batch_;
  std::size_t count_ = 0;
  std::array<TrianglePoint, kAtOnce> points_;
  std::array<int, kAtOnce> fragments_;
};

/// Points whose segments from a lamp are traced together. A point is lit if its segment first hits the point's own
/// triangle, or nothing.
class RayShadows::LampQuestions {
 public:
  LampQuestions(const RayShadows& shadows, const Lamp& lamp, FragmentBatch& batch)
      : shadows_(shadows), batch_(batch), lamp_(glm::vec3(glm::dvec3(lamp.position) + shadows.eye_)) {}

  void add(const TrianglePoint& point, int fragment) {
    raycast_detail::Query& query = queries_[count_];
    query.origin = lamp_;
    query.end = beside(raycast_detail::position_of(point), batch_.geometry.plane_normal.at(fragment));
    query.direction = query.end - query.origin;
    query.is_segment = true;
    query.is_one_way = shadows_.is_one_way_;
    ids_[count_] = point.primitive;
    fragments_[count_] = fragment;
    if (++count_ == queries_.size()) ask();
  }

  void ask() {
    shadows_.count(count_);
    std::array<RayHit, kAtOnce> hits;
    const std::uint64_t steps =
        raycast_detail::walk_batch(ray_tree(shadows_.index_), {queries_.data(), count_}, raycast_detail::Want::closest,
                                   {hits.data(), count_}, shadows_.isa_);
    shadows_.count_decided(steps / kStepsOfTriangle, count_);
    for (std::size_t k = 0; k < count_; ++k)
      batch_.shadow[fragments_[k]] += hits[k].primitive == no_primitive || hits[k].primitive == ids_[k] ? 1.0f : 0.0f;
    count_ = 0;
  }

 private:
  static constexpr std::size_t kAtOnce = 256;
  static constexpr std::uint64_t kStepsOfTriangle = 64;  ///< number of steps of single rays that take as long as one
                                                         ///< exact decision

  [[nodiscard]] glm::vec3 beside(const glm::dvec3& place, const glm::dvec3& normal) const {
    const glm::dvec3 to_lamp = glm::dvec3(lamp_) - place, size = glm::max(glm::abs(place), glm::abs(glm::dvec3(lamp_)));
    constexpr double of_length = 1e-5, rounding = 0x1p-21;
    const double step = of_length * glm::length(to_lamp) + rounding * std::max({size.x, size.y, size.z});
    return glm::vec3(place + normal * (glm::dot(normal, to_lamp) < 0 ? -step : step));
  }

  const RayShadows& shadows_;
  FragmentBatch& batch_;
  glm::vec3 lamp_;
  std::size_t count_ = 0;
  std::array<raycast_detail::Query, kAtOnce> queries_;
  std::array<PrimitiveId, kAtOnce> ids_;
  std::array<int, kAtOnce> fragments_;
};

template <class Questions, class MayFace>
void RayShadows::ask(Questions& questions, const MayFace& may_face, const AskedFragments& asked) const {
  FragmentBatch& batch = asked.batch;
  const Coverage& coverage = batch.coverage;
  const Geometry& g = batch.geometry;
  for (int i = 0; i < coverage.count; ++i) {
    if (!asked.is_asked[i]) continue;
    batch.shadow[i] = 0;
    const TriangleSetup& setup = asked.setups[coverage.triangle[i]];
    if (!setup.is_smooth && !may_face(i)) continue;
    TrianglePoint point;
    if (knows_ids_) point.primitive = setup.id;
    point.corners = setup.corner_world;
    if (setup.is_smooth) point.lift = g.smooth_position.at(i) - g.position.at(i);
    const glm::vec2 corner = at_points_ ? coverage.screen.at(i) : glm::floor(coverage.screen.at(i));
    for (std::uint64_t left = coverage.samples[i]; left != 0; left &= left - 1) {
      const glm::vec2 sample = corner + glm::vec2(samples_[std::size_t(std::countr_zero(left))]) / 256.0f;
      point.weights = barycentric(setup, sample.x, sample.y).weight;
      questions.add(point, i);
    }
  }
  questions.ask();
  for (int i = 0; i < coverage.count; ++i)
    if (asked.is_asked[i]) batch.shadow[i] /= float(std::popcount(coverage.samples[i]));
}

void RayShadows::find_light(const DirectLight& light, const AskedFragments& asked) const {
  LightQuestions questions(*this, light.to_light, asked.batch);
  const Lane3& normal = asked.batch.geometry.plane_normal;
  ask(
      questions, [&](int i) { return glm::dot(normal.at(i), light.to_light) > 0; }, asked);
}

void RayShadows::find_light(const Lamp& lamp, const AskedFragments& asked) const {
  LampQuestions questions(*this, lamp, asked.batch);
  const Geometry& g = asked.batch.geometry;
  ask(
      questions, [&](int i) { return glm::dot(g.plane_normal.at(i), lamp.position - g.position.at(i)) > 0; }, asked);
}

}  // namespace frontmost::shading
