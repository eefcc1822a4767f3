// SPDX-License-Identifier: Apache-2.0
#include "shade/scan/scan_picture.h"

#include <algorithm>

#include "base/parallel.h"
#include "shade/colorists.h"
#include "shade/layers/opaque_part.h"
#include "view/answer.h"

namespace frontmost::shading {
namespace {

/// Each ray is tested for shadow at its own point.
constexpr glm::ivec2 kAtRay[] = {{0, 0}};

class ScanPicture {
 public:
  explicit ScanPicture(const ScanRequest& request)
      : request_(request), scan_(*request.input.scan), directions_(scan_.camera) {}

  void paint(TileCanvas& canvas, const glm::vec4& background) {
    PreparedScene& scene = request_.scene;
    const bool shows = shows_materials(request_.options.shading);
    const bool wants_normals =
        shows && request_.options.shading != Shading::flat && lacks_normals(scene.surfaces.scene());
    if (shows) make_ready(wants_normals);
    const bool has_texcoords = !shows || scene.materials.has_textures();
    faces_.emplace(scene.triangles, scan_.camera, wants_normals ? &scene.large : nullptr, has_texcoords);
    with_colorist([&](const FragmentShader::Colorist& colorist) { paint_tiles({canvas, colorist, background}); });
  }

 private:
  /// Prepares textures and normals for the visible primitives, and the index for see-through ones.
  void make_ready(bool wants_normals) {
    PreparedScene& scene = request_.scene;
    const Execution& execution = request_.execution;
    const std::size_t count = scene.surfaces.primitive_count(), pixels = scan_.index(0, scan_.height);
    const std::span<const PrimitiveId> ids(scan_.primitives.data(), scan_.primitives.size());
    if (request_.options.layers.see_through != SeeThrough::never &&
        (has_see_through(scene.surfaces.scene()) || request_.options.opacity < 1.0f))
      through_ = index_of_all();
    if (wants_normals) {
      scene.large = large_primitives(count, ids.first(pixels), scan_.width, execution, std::move(scene.large));
      scene.triangles.smooth(scene.large, execution);
    }
    if (scene.materials.is_ready()) return;
    // Primitives behind glass are not known yet.
    if (through_) return make_all_materials_ready();
    scene.seen = seen_primitives(count, ids, execution, std::move(scene.seen));
    scene.make_materials_ready(scene.seen, execution);
  }

  void make_all_materials_ready() {
    BitSet all;
    all.clear(request_.scene.surfaces.primitive_count());
    for (PrimitiveId id = 0; id < request_.scene.surfaces.primitive_count(); ++id) all.add(id);
    request_.scene.make_materials_ready(all, request_.execution);
  }

  const RayIndex* index_of_all() {
    if (request_.input.index) return request_.input.index;
    std::optional<RayIndex>& index = request_.scene.index;
    if (!index) index.emplace(request_.scene.surfaces, request_.execution);
    return &*index;
  }

  template <class Use>
  void with_colorist(const Use& use) {
    const MaterialTable& materials = request_.scene.materials;
    const Isa isa = request_.execution.isa;
    switch (request_.options.shading) {
      case Shading::lit: return with_light(use);
      case Shading::flat: return use(Flat{materials, isa});
      case Shading::normals: return use(Normals{materials, isa});
      case Shading::ids: return use(Ids{});
      case Shading::uv: return use(Texcoords{});
      case Shading::depth: {
        const DepthRange limits = depth_range(scan_);
        return use(Ranges{limits.nearest, limits.farthest});
      }
    }
  }

  /// The key light is that of a pinhole in the same pose.
  template <class Use>
  void with_light(const Use& use) {
    PreparedScene& scene = request_.scene;
    const ShadedPicture picture{request_.input, request_.options, kAtRay};
    const LightOptions& options = request_.options.light;
    const Lighting lighting = lighting_for(picture.input.visible.view, scene.surfaces.scene().up, options,
                                           scene.environment(options, request_.execution));
    const Lit lit = lit_by(lighting, picture, scene, request_.execution);
    scene.shadows.ask_at_points();
    use(lit);
  }

  /// Paints one row of tiles per thread at a time.
  void paint_tiles(const Painting& painting) {
    const bool shows = shows_materials(request_.options.shading);
    const bool asks_rays = request_.options.shading == Shading::lit && request_.options.light.shadows == Shadows::rays;
    const ScanLayer layer{*faces_,
                          directions_,
                          scan_,
                          shows && request_.scene.materials.has_textures(),
                          !asks_rays,
                          through_,
                          request_.scene.surfaces,
                          shows ? request_.options.opacity : 1.0f};
    const auto rows = std::size_t((scan_.height + tile_height - 1) / tile_height);
    parallel_for(request_.execution, rows, 1, [&](std::size_t begin, std::size_t end) {
      const auto work = request_.scene.scan_works.borrow([] { return std::make_unique<ScanTileWork>(); });
      work->begin(layer, painting.colorist, request_.execution.isa);
      for (std::size_t row = begin; row < end; ++row)
        for (int x = 0; x < scan_.width; x += tile_width) {
          const int y = int(row) * tile_height;
          const TileRectangle tile{x, y, std::min(tile_width, scan_.width - x),
                                   std::min(tile_height, scan_.height - y)};
          if (work->shade(tile))
            painting.canvas.write(tile, work->pixels(), painting.background);
          else
            painting.canvas.fill(tile, painting.background);
        }
    });
  }

  const ScanRequest& request_;
  const RangeScan& scan_;
  ScanDirections directions_;
  std::optional<ScanFaces> faces_;
  const RayIndex* through_ = nullptr;
};

}  // namespace

DepthRange depth_range(const RangeScan& scan) {
  DepthRange range;
  for (std::size_t i = 0; i < scan.ranges.size(); ++i)
    if (scan.primitives[i] != no_primitive) range.include({scan.ranges[i], scan.ranges[i]});
  return range.nearest <= range.farthest ? range : DepthRange{0, 0};
}

void check_scan(const ScanRequest& request) {
  check_opacity(request.options);
  if (request.options.light.ambient_occlusion || request.options.pixels.blend != Blend::linear)
    throw Error(ErrorCode::unsupported, "shade", "scans have neither ambient occlusion nor another blend than linear");
  check_light(request.options.light);
  if (request.options.light.shows_environment)
    throw Error(ErrorCode::unsupported, "shade", "pictures of scans cannot show an environment as background");
  if (!request.input.scan) throw Error(ErrorCode::bad_argument, "shade", "no scan is given");
  const RangeScan& scan = *request.input.scan;
  validate(scan.camera);
  const std::size_t count = scan.index(0, 0, scan.camera.samples);
  if (glm::ivec2(scan.width, scan.height) != grid_of(scan.camera) || scan.primitives.size() != count ||
      scan.ranges.size() != count)
    throw Error(ErrorCode::bad_argument, "shade", "the scan does not have a value for every sample of its camera");
  check_ids({scan.primitives.data(), count}, request.scene.surfaces.primitive_count(), "shade", request.execution);
}

void paint_scan(const ScanRequest& request, TileCanvas& canvas, const glm::vec4& background) {
  ScanPicture(request).paint(canvas, background);
}

}  // namespace frontmost::shading
