// SPDX-License-Identifier: Apache-2.0
#include "frontmost/shade.h"

#include <algorithm>
#include <cmath>
#include <mutex>

#include "base/parallel.h"
#include "shade/canvas.h"
#include "shade/colorists.h"
#include "shade/opaque_layer.h"

namespace frontmost {
namespace {

using namespace shading;

/// A Visible and what its triangles are set up from.
struct Layer {
  const TriangleSource& source;
  const Visible& visible;
};

/// How a picture is made of its layers.
struct Painting {
  Canvas& canvas;
  const TileWork::Colorist& colorist;
  glm::vec4 background;  ///< what an empty pixel gets
  SampleUse use = SampleUse::all;
};

/// One thread's work on a row of tiles.
class TileRow {
 public:
  TileRow(const Layer& front, const Layer* behind, const Painting& painting)
      : front_(std::make_unique<TileWork>(front.source, front.visible, painting.use, painting.colorist)),
        background_(painting.background) {
    if (behind) behind_ = std::make_unique<TileWork>(behind->source, behind->visible, painting.use, painting.colorist);
  }

  void shade(const TileRectangle& tile, Canvas& canvas) {
    if (front_->shade(tile)) {
      if (behind_ && front_->is_see_through() && behind_->shade(tile)) front_->put_behind(*behind_);
      canvas.write(tile, front_->pixels(), background_);
    } else {
      canvas.fill(tile, background_);
    }
  }

 private:
  std::unique_ptr<TileWork> front_, behind_;
  glm::vec4 background_;
};

/// Shades all tiles, one row of tiles to a thread at a time. `behind` may be null.
void shade_tiles(const Layer& front, const Layer* behind, const Painting& painting, const Execution& execution) {
  const View& view = front.visible.view;
  const auto rows = std::size_t((view.height + tile_height - 1) / tile_height);
  parallel_for(execution, rows, 1, [&](std::size_t begin, std::size_t end) {
    TileRow work(front, behind, painting);
    for (std::size_t row = begin; row < end; ++row)
      for (int x = 0; x < view.width; x += tile_width) {
        const int y = int(row) * tile_height;
        work.shade({x, y, std::min(tile_width, view.width - x), std::min(tile_height, view.height - y)},
                   painting.canvas);
      }
  });
}

glm::vec4 background_color(const ShadeOptions& options) {
  if (!options.background) return glm::vec4(0);
  const glm::vec3& c = *options.background;
  return {linear_of_shown(c.x), linear_of_shown(c.y), linear_of_shown(c.z), 1.0f};
}

/// The depths between which a picture of depths goes from bright to dark.
struct DepthRange {
  float nearest = std::numeric_limits<float>::infinity(), farthest = -std::numeric_limits<float>::infinity();

  void include(const DepthRange& other) {
    nearest = std::min(nearest, other.nearest);
    farthest = std::max(farthest, other.farthest);
  }
};

DepthRange depth_range(const Visible& visible, const Execution& execution) {
  // Keys are monotonic in depth, so their extremes are enough.
  DepthRange keys;
  std::mutex mutex;
  constexpr std::size_t samples_at_once = 1u << 16;
  parallel_for(execution, visible.keys.size(), samples_at_once, [&](std::size_t begin, std::size_t end) {
    DepthRange part;
    for (std::size_t i = begin; i < end; ++i)
      if (visible.primitives[i] != no_primitive) part.include({visible.keys[i], visible.keys[i]});
    const std::lock_guard lock(mutex);
    keys.include(part);
  });
  if (!(keys.nearest <= keys.farthest)) return {0, 0};
  return {depth_of_key(visible.view, keys.farthest), depth_of_key(visible.view, keys.nearest)};
}

bool has_textures(const Scene& scene) {
  const auto uses = [](const Material& m) {
    return m.base_color_texture.is_set() || m.metallic_roughness_texture.is_set() || m.normal_texture.is_set() ||
           m.emissive_texture.is_set() || m.occlusion_texture.is_set();
  };
  return std::any_of(scene.materials.begin(), scene.materials.end(), uses);
}

bool lacks_normals(const Scene& scene) {
  return std::any_of(scene.meshes.begin(), scene.meshes.end(), [](const Mesh& m) { return m.normals.empty(); });
}

/// For every material, whether a texture of it will be looked at.
std::vector<bool> needed_materials(const Surfaces& surfaces, const Visible& visible, const Execution& execution) {
  const Scene& scene = surfaces.scene();
  if (!has_textures(scene)) return std::vector<bool>(scene.materials.size());
  return seen_materials(surfaces, seen_primitives(surfaces, visible, execution), execution);
}

/// The triangles of one layer of a picture of materials.
struct Triangles {
  std::optional<BitSet> large;
  std::optional<TriangleSource> source;

  Triangles(const Surfaces& surfaces, const Visible& visible, const Execution& execution) {
    if (lacks_normals(surfaces.scene())) large = large_primitives(surfaces.primitive_count(), visible, execution);
    source.emplace(surfaces, visible.view, large ? &*large : nullptr, execution);
    if (!has_textures(surfaces.scene())) source->leave_out_texcoords();
  }
};

/// What pictures of materials need.
class Materials {
 public:
  Materials(const Surfaces& surfaces, const Visible& visible, const Execution& execution)
      : visible_(visible), front_(surfaces, visible, execution) {
    std::vector<bool> is_needed = needed_materials(surfaces, visible, execution);
    if (has_see_through(surfaces.scene())) {
      opaque_.emplace(surfaces, visible, execution);
      behind_.emplace(opaque_->surfaces(), opaque_->visible(), execution);
      const std::vector<bool> more = needed_materials(opaque_->surfaces(), opaque_->visible(), execution);
      for (std::size_t i = 0; i < more.size(); ++i) is_needed[i] = is_needed[i] || more[i];
    }
    table_.emplace(surfaces.scene(), is_needed, execution);
  }

  [[nodiscard]] const MaterialTable& table() const { return *table_; }
  /// What throws shadows: glass does not, and of leaves only the outline of the card they are drawn on is known.
  [[nodiscard]] const Surfaces& casters(const Surfaces& all) const { return opaque_ ? opaque_->surfaces() : all; }

  void paint(const Painting& painting, const Execution& execution) const {
    const Layer front{*front_.source, visible_};
    if (!opaque_) return shade_tiles(front, nullptr, painting, execution);
    const Layer behind{*behind_->source, opaque_->visible()};
    shade_tiles(front, &behind, painting, execution);
  }

 private:
  const Visible& visible_;
  Triangles front_;
  std::optional<OpaqueLayer> opaque_;
  std::optional<Triangles> behind_;
  std::optional<MaterialTable> table_;
};

/// All that a picture is made from.
struct Request {
  const Surfaces& surfaces;
  const Visible& visible;
  const ShadeOptions& options;
  const Execution& execution;
};

bool shows_materials(Shading shading) {
  return shading == Shading::lit || shading == Shading::flat || shading == Shading::normals;
}

void paint_materials(const Request& request, Canvas& canvas) {
  const Surfaces& surfaces = request.surfaces;
  const Visible& visible = request.visible;
  const ShadeOptions& options = request.options;
  const Execution& execution = request.execution;
  const Materials materials(surfaces, visible, execution);
  const auto paint = [&](const TileWork::Colorist& colorist) {
    materials.paint({canvas, colorist, background_color(options)}, execution);
  };
  if (options.shading == Shading::flat) return paint(Flat{materials.table()});
  if (options.shading == Shading::normals) return paint(Normals{materials.table()});
  const Lighting lighting = lighting_for(visible.view, surfaces.scene().up);
  std::optional<ShadowMap> shadow;
  if (options.shadows && options.seen_by_light)
    shadow.emplace(*options.seen_by_light, visible.view.eye(), execution);
  else if (options.shadows)
    shadow.emplace(materials.casters(surfaces), visible, glm::dvec3(lighting.to_key), execution);
  paint(Lit{materials.table(), lighting, shadow ? &*shadow : nullptr, execution.isa});
}

void paint_map(const Request& request, Canvas& canvas) {
  const Visible& visible = request.visible;
  const ShadeOptions& options = request.options;
  const TriangleSource source(request.surfaces, visible.view, nullptr, request.execution);
  const auto paint = [&](const TileWork::Colorist& colorist) {
    shade_tiles({source, visible}, nullptr, {canvas, colorist, background_color(options)}, request.execution);
  };
  if (options.shading == Shading::ids) return paint(Ids{});
  if (options.shading == Shading::uv) return paint(Texcoords{});
  const DepthRange range = depth_range(visible, request.execution);
  paint(Depths{glm::vec3(visible.view.forward()), range.nearest, range.farthest});
}

void paint(const Request& request, Canvas& canvas) {
  shows_materials(request.options.shading) ? paint_materials(request, canvas) : paint_map(request, canvas);
}

}  // namespace

Image shade(const Surfaces& surfaces, const Visible& visible, const ShadeOptions& options, const Execution& execution) {
  PlanesCanvas canvas(visible.view, {"R", "G", "B", "A"});
  paint({surfaces, visible, options, execution}, canvas);
  return canvas.take();
}

Bitmap shade_bitmap(const Surfaces& surfaces, const Visible& visible, const ShadeOptions& options,
                    const Execution& execution) {
  BitmapCanvas canvas(visible.view);
  paint({surfaces, visible, options, execution}, canvas);
  return canvas.take();
}

std::optional<View> key_light_view(const Visible& visible, const Box& bounds, Axis up, const Execution& execution) {
  return view_of_light(visible, bounds, glm::dvec3(lighting_for(visible.view, up).to_key), execution);
}

Image normal_image(const Surfaces& surfaces, const Visible& visible, const Execution& execution) {
  const MaterialTable table(surfaces.scene(), needed_materials(surfaces, visible, execution), execution);
  const Triangles triangles(surfaces, visible, execution);
  const TileWork::Colorist colorist = RawNormals{table};
  PlanesCanvas canvas(visible.view, {"N.X", "N.Y", "N.Z"});
  shade_tiles({*triangles.source, visible}, nullptr, {canvas, colorist, glm::vec4(0), SampleUse::first}, execution);
  return canvas.take();
}

}  // namespace frontmost
