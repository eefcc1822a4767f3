// SPDX-License-Identifier: Apache-2.0
// What the lights of a picture do not reach, found as LightOptions::shadows says.
//
//   maps   of the key light, and of the first sixteen suns and spots of the file: 8 MiB each at most. Points have none.
//          A map is drawn again only where the light's view is another than in the picture before.
//   rays   of all lights, through one index
#pragma once

#include <optional>
#include <span>

#include "frontmost/pictures.h"
#include "frontmost/zbuffer.h"
#include "shade/light/lamps.h"
#include "shade/seen_points.h"
#include "shade/shadow/ray_shadows.h"
#include "shade/shadow/shadow_map.h"

namespace frontmost::shading {

/// What a view or a scan shows, and what callers may have found already.
struct ShadedInput {
  ShadedInput(const ShadeInput& from) : visible(from.first()), seen_by_light(from.seen_by_light), index(from.index) {}
  ShadedInput(const ScanInput& from) : visible(*from.scan), index(from.index) {}

  SeenPoints visible;
  const Visible* seen_by_light = nullptr;
  const RayIndex* index;
};

/// What is to be shaded.
struct ShadedPicture {
  ShadedInput input;
  const ShadeOptions& options;
  std::span<const glm::ivec2> samples;  ///< of a pixel, in 1/256
};

/// Shadows of what is opaque by its material, in one picture of the same surfaces after another. What throws them, the
/// memory of the maps, and each map where its light sees the same again, stay from picture to picture.
class LightShadows {
 public:
  /// Borrows the surfaces. O(1).
  explicit LightShadows(const Surfaces& surfaces) : all_(surfaces) {}

  /// Follows an instance to where it is now.
  void follow(std::uint32_t instance, const Execution& execution);

  /// Finds those of a picture and its lights, which are borrowed.
  void find(const ShadedPicture& picture, const PictureLights& lights, const Execution& execution);
  /// As RayShadows has it.
  void ask_at_points() {
    if (rays_) rays_->ask_at_points();
  }

  /// Whether such a light of the picture throws shadows, by its place among lights.far or lights.near.
  [[nodiscard]] bool has_far(std::size_t light) const { return rays_ || far_maps_[light]; }
  [[nodiscard]] bool has_near(std::size_t light) const { return rays_ || near_maps_[light]; }
  /// Fill batch.shadow where it is asked for: the part of the light that arrives. Precondition: the light has shadows.
  void find_far(std::size_t light, const AskedFragments& asked, Isa isa) const;
  void find_near(std::size_t light, const AskedFragments& asked, Isa isa) const;

  /// The surfaces, or those of their opaque part, which the first call makes where something is see-through.
  [[nodiscard]] const Surfaces& casters(const Execution& execution);

 private:
  /// The map of one light, which stays where it is.
  struct DrawnMap {
    ShadowMap map;
    Visible planes;          ///< of view map.view(), where it was drawn here
    bool has_drawn = false;  ///< the map is that of the casters
  };

  void draw_maps(const ShadedPicture& picture, const Execution& execution);
  void take_map(const Visible& seen_by_light, const Execution& execution);
  /// The number of the map of a light of the file, by its place in the scene; none beyond the first sixteen.
  [[nodiscard]] std::optional<std::size_t> map_number(const Light& source) const;
  const ShadowMap* draw_map(std::size_t number, const std::optional<View>& light, const ShadedPicture& picture,
                            const Execution& execution);
  void aim_rays(const ShadedPicture& picture, const Execution& execution);

  const Surfaces& all_;
  Scene opaque_scene_;
  std::optional<Surfaces> opaque_;  ///< where not everything is

  const PictureLights* lights_ = nullptr;
  ZBuffer drawer_;
  std::vector<DrawnMap> maps_;                          ///< the key light's first, then those of the file
  std::vector<const ShadowMap*> far_maps_, near_maps_;  ///< of the picture's lights; null: no shadows
  std::optional<RayIndex> index_;
  std::optional<RayShadows> rays_;
};

}  // namespace frontmost::shading
