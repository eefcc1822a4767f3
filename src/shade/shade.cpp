// SPDX-License-Identifier: Apache-2.0
#include "frontmost/shade.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "base/srgb.h"
#include "shade/canvas.h"
#include "shade/colorists.h"
#include "shade/layers/layers.h"
#include "shade/layers/opaque_part.h"
#include "shade/picture_parts.h"
#include "shade/shadow/key_shadows.h"
#include "view/answer.h"

namespace frontmost {
namespace {

using namespace shading;

/// A Visible and what its triangles are set up from.
struct ShadedLayer {
  const TriangleSource& source;
  const Visible& visible;
  SampleUse use = SampleUse::all;
};

void shade_tile(const TileRectangle& tile, TileWork& work, const Painting& painting) {
  if (work.shade(tile)) {
    if (painting.opacity != 1.0f) work.fade(painting.opacity);
    painting.canvas.write(tile, work.pixels(), painting.background);
  } else {
    painting.canvas.fill(tile, painting.background);
  }
}

/// Shades all tiles, one row of tiles to a thread at a time.
void shade_tiles(const ShadedLayer& layer, const Painting& painting, const Execution& execution) {
  const View& view = layer.visible.view;
  const auto rows = std::size_t((view.height + tile_height - 1) / tile_height);
  parallel_for(execution, rows, 1, [&](std::size_t begin, std::size_t end) {
    TileWork work(layer.source, layer.visible, layer.use, painting.colorist);
    for (std::size_t row = begin; row < end; ++row)
      for (int x = 0; x < view.width; x += tile_width) {
        const int y = int(row) * tile_height;
        shade_tile({x, y, std::min(tile_width, view.width - x), std::min(tile_height, view.height - y)}, work,
                   painting);
      }
  });
}

glm::vec4 background_color(const ShadeOptions& options) {
  if (!options.background) return glm::vec4(0);
  const glm::vec3& c = *options.background;
  return {linear_of_shown(c.x), linear_of_shown(c.y), linear_of_shown(c.z), 1.0f};
}

/// The triangles of a picture of materials.
struct Triangles {
  std::optional<BitSet> large;
  std::optional<TriangleSource> source;

  /// `worth_smoothing`: those worth a smooth normal where the model has none; none where no normal is looked at.
  Triangles(const Surfaces& surfaces, const View& view, std::optional<BitSet> worth_smoothing,
            const Execution& execution)
      : large(std::move(worth_smoothing)) {
    source.emplace(surfaces, view, large ? &*large : nullptr, execution);
    if (!has_textures(surfaces.scene())) source->leave_out_texcoords();
  }
};

/// What pictures of materials need: of the primitives that a Visible shows, or, where materials can be seen through, of
/// all layers.
class LayerMaterials {
 public:
  LayerMaterials(const Surfaces& surfaces, const Visible& visible, const ShadeOptions& options,
                 const Execution& execution)
      : visible_(visible), wants_normals_(options.shading != Shading::flat && lacks_normals(surfaces.scene())) {
    if (wants_layers(surfaces.scene(), options))
      make_layers(surfaces, options, execution);
    else
      make_front(surfaces, execution);
  }

  [[nodiscard]] const MaterialTable& table() const { return *table_; }
  /// Where a fragment's samples lie within its pixel, in 1/256.
  [[nodiscard]] std::vector<glm::ivec2> samples() const {
    if (layers_) return layers_->samples();
    const auto offsets = sample_offsets(visible_.view.samples);
    return {offsets.begin(), offsets.end()};
  }

  /// Precondition: with layers.
  [[nodiscard]] DeepImage deep(const Surfaces& surfaces, const FragmentShader::Colorist& colorist,
                               const Execution& execution) const {
    const LayerShader shader(*triangles_->source, *layers_, colorist);
    return deep_layers(surfaces, visible_.view, *layers_, shader, execution);
  }

  void paint(const Painting& painting, const Execution& execution) const {
    if (layers_)
      shade_layers(*triangles_->source, *layers_, painting, execution);
    else
      shade_tiles({*triangles_->source, visible_}, painting, execution);
  }

 private:
  static bool wants_layers(const Scene& scene, const ShadeOptions& options) {
    if (options.see_through != SeeThrough::where_needed) return options.see_through == SeeThrough::always;
    return has_see_through(scene) || options.opacity < 1.0f;
  }

  void make_front(const Surfaces& surfaces, const Execution& execution) {
    std::optional<BitSet> large;
    if (wants_normals_) large = large_primitives(surfaces.primitive_count(), visible_, execution);
    const auto seen = [&] { return seen_primitives(surfaces, visible_, execution); };
    triangles_.emplace(surfaces, visible_.view, std::move(large), execution);
    table_.emplace(surfaces.scene(), needed_materials(surfaces, seen, execution), execution);
  }

  void make_layers(const Surfaces& surfaces, const ShadeOptions& options, const Execution& execution) {
    layers_.emplace(surfaces, visible_.view, AbufferOptions{options.grid, options.opacity}, execution);
    std::optional<BitSet> found;
    const auto seen = [&]() -> const BitSet& {
      if (!found) found = seen_primitives(surfaces, *layers_, execution);
      return *found;
    };
    table_.emplace(surfaces.scene(), needed_materials(surfaces, seen, execution), execution);
    if (wants_normals_)
      (void)seen();
    else
      found.reset();
    triangles_.emplace(surfaces, visible_.view, std::move(found), execution);
  }

  const Visible& visible_;
  const bool wants_normals_;  ///< and the model does not have them
  std::optional<abuffer_detail::FragmentPass> layers_;
  std::optional<Triangles> triangles_;
  std::optional<MaterialTable> table_;
};

/// All that a picture is made from.
struct Request {
  const Surfaces& surfaces;
  const ShadeInput& input;
  const ShadeOptions& options;
  const Execution& execution;
};

/// Calls use(colorist) with what colours fragments as the options say. Precondition: shows_materials().
template <class Use>
void with_colorist(const Request& request, const LayerMaterials& materials, const Use& use) {
  const ShadeOptions& options = request.options;
  if (options.shading == Shading::flat) return use(FragmentShader::Colorist(Flat{materials.table()}));
  if (options.shading == Shading::normals) return use(FragmentShader::Colorist(Normals{materials.table()}));
  const Lighting lighting = lighting_for(request.input.visible.view, request.surfaces.scene().up);
  const std::vector<glm::ivec2> samples = materials.samples();
  const KeyShadows shadows({request.surfaces, request.input, options, samples}, lighting.to_key, request.execution);
  use(FragmentShader::Colorist(Lit{materials.table(), lighting, shadows.map(), shadows.rays(), request.execution.isa}));
}

void paint_materials(const Request& request, TileCanvas& canvas) {
  const LayerMaterials materials(request.surfaces, request.input.visible, request.options, request.execution);
  with_colorist(request, materials, [&](const FragmentShader::Colorist& colorist) {
    materials.paint({canvas, colorist, background_color(request.options), request.options.opacity}, request.execution);
  });
}

void paint_map(const Request& request, TileCanvas& canvas) {
  const Visible& visible = request.input.visible;
  const ShadeOptions& options = request.options;
  const TriangleSource source(request.surfaces, visible.view, nullptr, request.execution);
  const auto paint = [&](const TileWork::Colorist& colorist) {
    shade_tiles({source, visible}, {canvas, colorist, background_color(options)}, request.execution);
  };
  if (options.shading == Shading::ids) return paint(Ids{});
  if (options.shading == Shading::uv) return paint(Texcoords{});
  const DepthRange range = depth_range(visible, request.execution);
  paint(Depths{glm::vec3(visible.view.forward()), range.nearest, range.farthest});
}

void check(const Request& request) {
  check_opacity(request.options);
  check_answer(request.input.visible, request.surfaces.primitive_count(), "shade", request.execution);
}

void paint(const Request& request, TileCanvas& canvas) {
  check(request);
  shows_materials(request.options.shading) ? paint_materials(request, canvas) : paint_map(request, canvas);
}

}  // namespace

Image shade(const Surfaces& surfaces, const ShadeInput& input, const ShadeOptions& options,
            const Execution& execution) {
  PlanesCanvas canvas(input.visible.view, {"R", "G", "B", "A"});
  paint({surfaces, input, options, execution}, canvas);
  return canvas.take();
}

Bitmap shade_bitmap(const Surfaces& surfaces, const ShadeInput& input, const ShadeOptions& options,
                    const Execution& execution) {
  BitmapCanvas canvas(input.visible.view);
  paint({surfaces, input, options, execution}, canvas);
  return canvas.take();
}

DeepImage shade_deep(const Surfaces& surfaces, const ShadeInput& input, const ShadeOptions& options,
                     const Execution& execution) {
  if (!shows_materials(options.shading))
    throw Error(ErrorCode::unsupported, "shade: deep images are lit, flat, or of normals");
  ShadeOptions in_layers = options;
  in_layers.see_through = SeeThrough::always;
  const Request request{surfaces, input, in_layers, execution};
  check(request);
  const LayerMaterials materials(surfaces, input.visible, in_layers, execution);
  DeepImage image;
  with_colorist(request, materials, [&](const FragmentShader::Colorist& colorist) {
    image = materials.deep(surfaces, colorist, execution);
  });
  return image;
}

std::optional<View> key_light_view(const Visible& visible, const Box& bounds, Axis up, const Execution& execution) {
  check_planes(visible, "light");
  return view_of_light(visible, bounds, glm::dvec3(lighting_for(visible.view, up).to_key), execution);
}

Image normal_image(const Surfaces& surfaces, const Visible& visible, const Execution& execution) {
  check_answer(visible, surfaces.primitive_count(), "normal image", execution);
  std::optional<BitSet> large;
  if (lacks_normals(surfaces.scene())) large = large_primitives(surfaces.primitive_count(), visible, execution);
  const auto seen = [&] { return seen_primitives(surfaces, visible, execution); };
  const MaterialTable table(surfaces.scene(), needed_materials(surfaces, seen, execution), execution);
  const Triangles triangles(surfaces, visible.view, std::move(large), execution);
  const TileWork::Colorist colorist = RawNormals{table};
  PlanesCanvas canvas(visible.view, {"N.X", "N.Y", "N.Z"});
  shade_tiles({*triangles.source, visible, SampleUse::first}, {canvas, colorist, glm::vec4(0)}, execution);
  return canvas.take();
}

}  // namespace frontmost
