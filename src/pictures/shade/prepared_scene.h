// SPDX-License-Identifier: Apache-2.0
// Data that all pictures of the same surfaces share. It is computed when it is first needed.
#pragma once

#include <algorithm>

#include "base/pool.h"
#include "frontmost/pictures.h"
#include "shade/material/materials.h"
#include "shade/occlusion/depth_occlusion.h"
#include "shade/scan/scan.h"
#include "shade/shadow/light_shadows.h"

namespace frontmost::shading {

/// Whether any mesh of the scene lacks normals.
[[nodiscard]] inline bool lacks_normals(const Scene& scene) {
  return std::any_of(scene.meshes.begin(), scene.meshes.end(), [](const Mesh& m) { return m.normals.empty(); });
}
/// Whether this kind of shading takes colours or normals from materials.
[[nodiscard]] inline bool shows_materials(Shading shading) {
  return shading == Shading::lit || shading == Shading::flat || shading == Shading::normals;
}
/// Checks the input of a picture. \throws Error bad_argument unless exactly one of the two inputs is given.
inline void check_given(const ShadeInput& input, const char* who) {
  if (!input.visible == !input.pixels)
    throw Error(ErrorCode::bad_argument, who, "give either a Visible or VisiblePixels");
}
/// Checks the opacity. \throws Error bad_argument if it is not from 0 to 1.
inline void check_opacity(const ShadeOptions& options) {
  if (!(options.opacity >= 0.0f && options.opacity <= 1.0f))
    throw Error(ErrorCode::bad_argument, "shade: opacity", "must be 0 to 1");
}

/// Returns the set of primitives that are seen in at least one sample.
[[nodiscard]] inline BitSet seen_primitives(const Surfaces& surfaces, const ShadeInput& input,
                                            const Execution& execution, BitSet memory) {
  BitSet seen = seen_primitives(surfaces.primitive_count(), input.first().primitives, execution, std::move(memory));
  for (std::size_t i = 0; input.pixels && i < input.pixels->other_count; ++i)
    if (input.pixels->others[i] != no_primitive) seen.add(input.pixels->others[i]);
  return seen;
}

struct PreparedScene {
  /// Borrows the surfaces and their scene. O(instances + materials).
  explicit PreparedScene(const Surfaces& from)
      : surfaces(from),
        moves(placed_scene(from).moves.count()),
        triangles(from),
        materials(from.scene()),
        shadows(from),
        looked_at(from.primitive_count()) {}

  /// Applies the moves that Surfaces::move() has made since the last picture.
  void follow_moves(const Execution& execution) {
    const MoveLog& log = placed_scene(surfaces).moves;
    if (log.count() == moves) return;
    log.visit_since(moves, surfaces.scene().instances.size(), [&](std::uint32_t instance) {
      triangles.follow(surfaces, instance);
      materials.follow(instance);
      if (index) index->follow(surfaces, instance, execution);
      shadows.follow(instance, execution);
    });
    occlusion_radius.reset();
  }

  /// Prepares the textures of the materials that these primitives have.
  void make_materials_ready(const BitSet& primitives, const Execution& execution) {
    if (materials.is_ready() || looked_at.holds(primitives)) return;
    materials.make_ready(seen_materials(surfaces, primitives, looked_at), execution);
    looked_at.add_all(primitives);  // not reached if preparing has thrown
  }
  /// Prepares the textures of all visible primitives. If all textures are ready, nothing is searched.
  void make_materials_ready(const ShadeInput& input, const Execution& execution) {
    if (materials.is_ready()) return;
    seen = seen_primitives(surfaces, input, execution, std::move(seen));
    make_materials_ready(seen, execution);
  }

  /// Returns the ambient occlusion of a picture, or null if the options ask for none. Borrows the picture.
  const DepthOcclusion* find_occlusion(const ShadeInput& input, const ShadeOptions& options,
                                       const Execution& execution) {
    if (!options.light.ambient_occlusion) return nullptr;
    if (!occlusion_radius) occlusion_radius = default_occlusion_radius(surfaces);
    const auto [strength, radius] = *options.light.ambient_occlusion;
    const OcclusionReach reach{radius.value_or(*occlusion_radius), strength};
    const Surfaces& opaque = shadows.casters(execution);
    if (&opaque == &surfaces) {
      occlusion.find(input.first(), input.view().samples, reach);
    } else {
      View view = input.view();
      view.samples = 1;
      occlusion.find(shadows.draw_casters(view, {}, execution), 1, reach);
    }
    return &occlusion;
  }

  /// Returns the environment in the options. If they have none, it is the studio, which the first call makes.
  [[nodiscard]] const Environment& environment(const LightOptions& options, const Execution& execution) {
    if (options.environment) return *options.environment;
    if (!studio) studio = Environment::studio(execution);
    return *studio;
  }

  const Surfaces& surfaces;
  std::uint64_t moves;  ///< number of moves of the surfaces that were applied here
  TriangleStore triangles;
  MaterialTable materials;
  LightShadows shadows;
  DepthOcclusion occlusion;
  std::optional<double> occlusion_radius;  ///< the default radius, computed when first needed
  BitSet looked_at;                        ///< primitives whose materials are ready
  std::optional<Environment> studio;

  // Memory that is reused from picture to picture.
  PictureLights lights;
  Pool<TileWork> works;
  Pool<ScanTileWork> scan_works;
  std::optional<RayIndex> index;  ///< index for scans that see through surfaces and bring no index of their own
  BitSet seen, large;
};

}  // namespace frontmost::shading
