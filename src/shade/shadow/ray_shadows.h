// SPDX-License-Identifier: Apache-2.0
// Shadows of the key light by rays: exact, and as sharp as the samples are dense.
//
// The rule at the terminator. A flat triangle that faces away from the light is in its own shadow, whatever its
// material's normals say. A triangle between smooth normals never shadows itself, and its points start where the curved
// surface would be that the normals suggest, so that its facets do not show.
#pragma once

#include <span>
#include <vector>

#include "frontmost/raycast.h"
#include "shade/batch.h"
#include "shade/geometry/triangle_setup.h"

namespace frontmost::shading {

class RayShadows {
 public:
  /// Borrows both. The index holds what throws shadows; `samples` of a pixel are in 1/256 of it.
  RayShadows(const RayIndex& index, std::span<const glm::ivec2> samples, const glm::vec3& to_key, Isa isa)
      : index_(index), to_key_(to_key), isa_(isa), samples_(samples) {}

  /// The ids of the index are not those of what is shaded. Slower: a triangle is then known by its corners.
  void forget_ids() { knows_ids_ = false; }

  /// Fragments are single points where they are, not pixels.
  void ask_at_points() { at_points_ = true; }

  /// Fills batch.shadow where `is_asked`: the part of each fragment's samples that the light reaches.
  void find_light(const std::vector<TriangleSetup>& setups, const bool* is_asked, FragmentBatch& batch) const;

 private:
  class Questions;

  const RayIndex& index_;
  glm::vec3 to_key_;
  Isa isa_;
  bool knows_ids_ = true, at_points_ = false;
  std::span<const glm::ivec2> samples_;
};

}  // namespace frontmost::shading
