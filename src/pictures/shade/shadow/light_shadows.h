// SPDX-License-Identifier: Apache-2.0
// The shadows of a picture's lights, by the method in LightOptions::shadows.
//
//   maps   for the key light, and the first sixteen suns and spots of the file: at most 8 MiB each. Points have none.
//          A map is drawn again only if the light's view has changed since the picture before.
//   rays   for all lights, through one index
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

/// The visible points of a view or a scan, and data that callers may have computed already.
struct ShadedInput {
  ShadedInput(const ShadeInput& from) : visible(from.first()), seen_by_light(from.seen_by_light), index(from.index) {}
  ShadedInput(const ScanInput& from) : visible(*from.scan), index(from.index) {}

  SeenPoints visible;
  const Visible* seen_by_light = nullptr;
  const RayIndex* index;
};

/// The picture that is shaded.
struct ShadedPicture {
  ShadedInput input;
  const ShadeOptions& options;
  std::span<const glm::ivec2> samples;  ///< of a pixel, in 1/256
};

/// Shadows of opaque materials, for successive pictures of the same surfaces. The casters, the memory of the maps, and
/// maps whose view is unchanged are kept from picture to picture.
class LightShadows {
 public:
  /// Borrows the surfaces. O(1).
  explicit LightShadows(const Surfaces& surfaces) : all_(surfaces) {}

  /// Updates an instance that has moved.
  void follow(std::uint32_t instance, const Execution& execution);

  /// Finds the shadows of a picture and its lights, which it borrows.
  void find(const ShadedPicture& picture, const PictureLights& lights, const Execution& execution);
  /// Calls RayShadows::ask_at_points(), for shadows by rays.
  void ask_at_points() {
    if (rays_) rays_->ask_at_points();
  }

  /// Whether a light of the picture casts shadows, by its index in lights.far or lights.near.
  [[nodiscard]] bool has_far(std::size_t light) const { return rays_ || far_maps_[light]; }
  [[nodiscard]] bool has_near(std::size_t light) const { return rays_ || near_maps_[light]; }
  /// Fill batch.shadow of the asked fragments: the share of the light that arrives. Precondition: the light has
  /// shadows.
  void find_far(std::size_t light, const AskedFragments& asked, Isa isa) const;
  void find_near(std::size_t light, const AskedFragments& asked, Isa isa) const;

  /// The surfaces, or their opaque part. The first call makes the opaque part if some material is see-through.
  [[nodiscard]] const Surfaces& casters(const Execution& execution);
  /// What a view sees of the casters; reuses `planes`, of any size.
  [[nodiscard]] Visible draw_casters(const View& view, Visible&& planes, const Execution& execution);

 private:
  /// The map of one light; its address does not change.
  struct DrawnMap {
    ShadowMap map;
    Visible planes;          ///< of view map.view(), if drawn here
    bool has_drawn = false;  ///< the map shows the casters
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
  std::optional<Surfaces> opaque_;  ///< empty if everything is opaque

  const PictureLights* lights_ = nullptr;
  ZBuffer drawer_;
  int drawn_directly_ = 0;                              ///< pictures of casters without clusters
  std::vector<DrawnMap> maps_;                          ///< the key light's first, then those of the file
  std::vector<const ShadowMap*> far_maps_, near_maps_;  ///< by light of the picture; null: no shadows
  std::optional<RayIndex> index_;
  std::optional<RayShadows> rays_;
};

}  // namespace frontmost::shading
