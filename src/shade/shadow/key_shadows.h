// SPDX-License-Identifier: Apache-2.0
// What the key light does not reach, found as ShadeOptions::shadows says.
#pragma once

#include <optional>
#include <span>

#include "frontmost/shade.h"
#include "frontmost/zbuffer.h"
#include "shade/shadow/ray_shadows.h"
#include "shade/shadow/shadow_map.h"

namespace frontmost::shading {

/// What is to be shaded.
struct ShadedPicture {
  const ShadeInput& input;
  const ShadeOptions& options;
  std::span<const glm::ivec2> samples;  ///< of a pixel, in 1/256
};

/// Shadows of what is opaque by its material, in one picture of the same surfaces after another. What throws them, the
/// memory of the map, and the map itself where the light sees the same again, stay from picture to picture.
class KeyShadows {
 public:
  /// Borrows the surfaces. O(1).
  explicit KeyShadows(const Surfaces& surfaces) : all_(surfaces) {}

  /// Finds those of a picture, which is borrowed.
  void find(const ShadedPicture& picture, const glm::vec3& to_key, const Execution& execution);
  /// As RayShadows has it.
  void ask_at_points() {
    if (rays_) rays_->ask_at_points();
  }

  /// One of them, or none where there are no shadows.
  [[nodiscard]] const ShadowMap* map() const { return shows_map_ ? &map_ : nullptr; }
  [[nodiscard]] const RayShadows* rays() const { return rays_ ? &*rays_ : nullptr; }

 private:
  /// The surfaces, or those of their opaque part, which the first call makes where something is see-through.
  [[nodiscard]] const Surfaces& casters(const Execution& execution);
  void draw_map(const Visible& visible, const glm::vec3& to_key, const Execution& execution);
  void aim_rays(const ShadedPicture& picture, const glm::vec3& to_key, const Execution& execution);

  const Surfaces& all_;
  Scene opaque_scene_;
  std::optional<Surfaces> opaque_;  ///< where not everything is

  ZBuffer light_;
  ShadowMap map_;
  bool has_drawn_ = false;  ///< the map is of view map_.view() of the casters
  bool shows_map_ = false;
  std::optional<RayIndex> index_;
  std::optional<RayShadows> rays_;
};

}  // namespace frontmost::shading
