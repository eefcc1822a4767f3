// SPDX-License-Identifier: Apache-2.0
// What the key light does not reach, found as ShadeOptions::shadows says.
#pragma once

#include <optional>
#include <span>

#include "frontmost/shade.h"
#include "shade/shadow/ray_shadows.h"
#include "shade/shadow/shadow_map.h"

namespace frontmost::shading {

/// What is to be shaded.
struct ShadedPicture {
  const Surfaces& surfaces;
  const ShadeInput& input;
  const ShadeOptions& options;
  std::span<const glm::ivec2> samples;  ///< of a pixel, in 1/256
};

/// Shadows of what is opaque by its material.
class KeyShadows {
 public:
  KeyShadows(const ShadedPicture& picture, const glm::vec3& to_key, const Execution& execution);

  /// As RayShadows has it.
  void ask_at_points() {
    if (rays_) rays_->ask_at_points();
  }

  /// One of them, or none where there are no shadows.
  [[nodiscard]] const ShadowMap* map() const { return map_ ? &*map_ : nullptr; }
  [[nodiscard]] const RayShadows* rays() const { return rays_ ? &*rays_ : nullptr; }

 private:
  std::optional<ShadowMap> map_;
  std::optional<RayIndex> index_;
  std::optional<RayShadows> rays_;
};

}  // namespace frontmost::shading
