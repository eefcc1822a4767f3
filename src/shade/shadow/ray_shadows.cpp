// SPDX-License-Identifier: Apache-2.0
#include "shade/shadow/ray_shadows.h"

#include <array>
#include <bit>
#include <cmath>

#include "raycast/queries.h"

namespace frontmost::shading {

/// Points that wait to be asked about together, and the fragments that they are of.
class RayShadows::Questions {
 public:
  Questions(const RayShadows& shadows, FragmentBatch& batch) : shadows_(shadows), batch_(batch) {}

  void add(const TrianglePoint& point, int fragment) {
    points_[count_] = point;
    fragments_[count_] = fragment;
    if (++count_ == points_.size()) ask();
  }

  /// Answers come in whole samples, which floats add exactly.
  void ask() {
    std::array<std::uint8_t, kAtOnce> is_lit;
    raycast_detail::find_lit(shadows_.index_.tree(), {points_.data(), count_}, shadows_.to_key_,
                             {is_lit.data(), count_}, shadows_.isa_);
    for (std::size_t k = 0; k < count_; ++k) batch_.shadow[fragments_[k]] += is_lit[k];
    count_ = 0;
  }

 private:
  static constexpr std::size_t kAtOnce = 4 * raycast_detail::kLightRays;

  const RayShadows& shadows_;
  FragmentBatch& batch_;
  std::size_t count_ = 0;
  std::array<TrianglePoint, kAtOnce> points_;
  std::array<int, kAtOnce> fragments_;
};

void RayShadows::find_light(const std::vector<TriangleSetup>& setups, const bool* is_asked,
                            FragmentBatch& batch) const {
  const Coverage& coverage = batch.coverage;
  const Geometry& g = batch.geometry;
  Questions questions(*this, batch);
  for (int i = 0; i < coverage.count; ++i) {
    if (!is_asked[i]) continue;
    batch.shadow[i] = 0;
    const TriangleSetup& setup = setups[coverage.triangle[i]];
    if (!setup.is_smooth && !(glm::dot(g.plane_normal.at(i), to_key_) > 0)) continue;
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
    if (is_asked[i]) batch.shadow[i] /= float(std::popcount(coverage.samples[i]));
}

}  // namespace frontmost::shading
