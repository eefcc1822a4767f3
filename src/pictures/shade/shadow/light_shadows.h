// SPDX-License-Identifier: Apache-2.0
// The shadows of a picture's lights, by the method in LightOptions::shadows.
//
//   maps   for the key light, and the first sixteen suns and spots of the file: at most 8 MiB each. Point lights have
//          none. A map is drawn again only if the light's view has changed since the last picture.
//   rays   for all lights, through one index
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/work_limit.h"
#include "frontmost/pictures.h"
#include "frontmost/raycast.h"
#include "frontmost/zbuffer.h"
#include "shade/geometry/geometry.h"
#include "shade/light/lighting.h"
#include "shade/shadow/shadow_map.h"

namespace frontmost::shading {

/// Whether any material of the scene is see-through.
[[nodiscard]] bool has_see_through(const Scene& scene);

/// Returns the scene without see-through triangles. Copies the meshes that have opaque triangles, and the textures that
/// cut holes. Materials keep their numbers. O(triangles).
[[nodiscard]] Scene opaque_part(const Scene& scene);

/// The fragments whose shadow is asked for.
struct AskedFragments {
  const std::vector<TriangleSetup>& setups;
  const bool* is_asked;
  FragmentBatch& batch;  ///< its `shadow` is filled
};

/// Shadows by rays: as sharp as the samples are dense, and exact for lights at infinite distance.
///
/// The rule at the terminator: a flat triangle that faces away from the light is in its own shadow, whatever its
/// material's normals say. A triangle with smooth normals never shadows itself, and its points start on the curved
/// surface that the normals suggest, so that facets do not show.
///
/// A segment from a lamp ends a little off the surface, on the lamp's side, so that no surface casts a shadow on its
/// own points. The distance is a hundred-thousandth of the segment's length plus the rounding error of floats.
class RayShadows {
 public:
  /// The greatest number of rays of a picture, and the message of the error if there are more.
  struct Limit {
    std::uint64_t most;
    std::string error;
  };

  /// Borrows all but the limit. The index is that of the casters. `knows_ids` says that its ids are those of the shaded
  /// surfaces; otherwise triangles are identified by their corners, which is slower. `samples` are positions in a
  /// pixel, in 1/256 pixel. `view` is that of the picture, or a pinhole if the picture is a scan.
  RayShadows(const RayIndex& index, bool knows_ids, std::span<const glm::ivec2> samples, const View& view,
             const Execution& execution, Limit limit);

  /// Makes find_light() ask at a single point for each fragment, instead of at the samples of its pixel.
  void ask_at_points() { at_points_ = true; }

  /// Fills batch.shadow of the asked fragments: the share of each fragment's samples that the light reaches.
  /// \throws Error limit_exceeded.
  void find_light(const DirectLight& light, const AskedFragments& asked) const;
  void find_light(const Lamp& lamp, const AskedFragments& asked) const;

 private:
  class LightQuestions;
  class LampQuestions;

  /// Calls questions.add(point, fragment) for every sample of each asked fragment, unless the fragment's triangle is
  /// flat and may_face(fragment) is false.
  template <class Questions, class MayFace>
  void ask(Questions& questions, const MayFace& may_face, const AskedFragments& asked) const;

  void count(std::size_t rays) const {
    rays_.add(rays, [this] { return too_many_; });
  }
  /// Counts triangles that needed exact decisions. A few for each ray are usual and do not count.
  void count_decided(std::uint64_t triangles, std::size_t rays) const {
    const std::uint64_t usual = kUsualOfRay * rays;
    if (triangles <= usual) return;
    crowd_.add(triangles - usual, [this] {
      return "too many of " + std::to_string(index_.triangle_count()) +
             " triangles lie over each other for shadows by rays; ask for shadows by maps";
    });
  }

  const RayIndex& index_;
  glm::dvec3 eye_;
  bool is_one_way_;  ///< one-sided triangles let light through from behind
  Isa isa_;
  bool knows_ids_, at_points_ = false;
  std::span<const glm::ivec2> samples_;
  static constexpr std::uint64_t kMostOfCrowd = std::uint64_t(1) << 24, kMostOfTriangle = 64, kUsualOfRay = 4;
  mutable WorkLimit rays_, crowd_;
  std::string too_many_;
};

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
  std::span<const glm::ivec2> samples;  ///< samples of a pixel, in 1/256 pixel
};

/// Shadows of opaque materials, for successive pictures of the same surfaces. The casters, the memory of the maps, and
/// maps whose view is unchanged are kept from picture to picture.
class LightShadows {
 public:
  /// Borrows the surfaces. O(1).
  explicit LightShadows(const Surfaces& surfaces) : all_(surfaces) {}

  /// Updates an instance that has moved.
  void follow(std::uint32_t instance, const Execution& execution);

  /// Prepares the shadows of a picture by its lights. Borrows both.
  void find(const ShadedPicture& picture, const PictureLights& lights, const Execution& execution);
  /// Calls RayShadows::ask_at_points(), for shadows by rays.
  void ask_at_points() {
    if (rays_) rays_->ask_at_points();
  }

  /// Whether a light of the picture casts shadows. Lights are numbered: those in lights.far, then those in lights.near.
  [[nodiscard]] bool has_shadows(std::size_t light) const { return rays_ || light_maps_[light]; }
  /// Fills batch.shadow of the asked fragments: the share of the light that arrives. Precondition: has_shadows().
  void find_arriving(std::size_t light, const AskedFragments& asked, Isa isa) const;

  /// Returns the surfaces, or their opaque part. The first call makes the opaque part if some material is see-through.
  [[nodiscard]] const Surfaces& casters(const Execution& execution);
  /// Draws the casters in a view. Reuses the memory of `planes`, whatever its size.
  [[nodiscard]] Visible draw_casters(const View& view, Visible&& planes, const Execution& execution);

 private:
  /// The map of one light. Its address does not change.
  struct DrawnMap {
    ShadowMap map;
    Visible planes;          ///< planes of map.view(), if drawn here
    bool has_drawn = false;  ///< the map shows the casters
  };

  void draw_maps(const ShadedPicture& picture, const Execution& execution);
  /// Returns the number of the map of a light of the file, or none beyond the first sixteen lights with maps. The
  /// number depends on the light's place in the scene only.
  [[nodiscard]] std::optional<std::size_t> map_number(const Light& source) const;
  const ShadowMap* draw_map(std::size_t number, const std::optional<View>& light, const ShadedPicture& picture,
                            const Execution& execution);
  void aim_rays(const ShadedPicture& picture, const Execution& execution);

  const Surfaces& all_;
  Scene opaque_scene_;
  std::optional<Surfaces> opaque_;  ///< empty if everything is opaque

  const PictureLights* lights_ = nullptr;
  ZBuffer drawer_;
  int drawn_directly_ = 0;                    ///< number of pictures of casters that were drawn without clusters
  std::vector<DrawnMap> maps_;                ///< the key light's first, then those of the file
  std::vector<const ShadowMap*> light_maps_;  ///< by light of the picture; null: no shadows
  std::optional<RayIndex> index_;
  std::optional<RayShadows> rays_;
};

}  // namespace frontmost::shading
