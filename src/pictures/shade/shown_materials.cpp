// SPDX-License-Identifier: Apache-2.0
#include "shade/shown_materials.h"

#include <algorithm>
#include <bit>

#include "shade/layers/opaque_part.h"
#include "shade/picture_parts.h"
#include "shade/shade_tiles.h"

namespace frontmost::shading {

using abuffer_detail::Rectangle;

namespace {

bool wants_layers(const PictureRequest& request) {
  if (request.options.layers.see_through != SeeThrough::where_needed)
    return request.options.layers.see_through == SeeThrough::always;
  return has_see_through(request.scene.surfaces.scene()) || request.options.opacity < 1.0f;
}

/// Whether `is_so` holds for all ids of a list.
template <class IsSo>
bool all_of(const PrimitiveId* ids, std::size_t count, const IsSo& is_so) {
  return std::all_of(ids, ids + count, is_so);
}

/// Whether `is_so` holds for the primitives of samples 1 and up in a row of a tile, for pixels whose samples differ.
template <class IsSo>
bool all_of_mixed(const VisiblePixels& pixels, const Rectangle& tile, int y, const IsSo& is_so) {
  constexpr int run = VisiblePixels::run;
  static_assert(abuffer_detail::kTileSize % run == 0);
  const std::size_t first = std::size_t(y) * pixels.runs_across() + std::size_t(tile.x / run);
  for (std::size_t k = 0; k < std::size_t((tile.width + run - 1) / run); ++k) {
    const auto mixed = std::size_t(std::popcount(pixels.mixed[first + k]));
    if (mixed == 0) continue;
    const PrimitiveId* const others = pixels.others.data() + pixels.places[first + k];
    if (!all_of(others, mixed * std::size_t(pixels.view.samples - 1), is_so)) return false;
  }
  return true;
}

/// Whether `is_so` holds for the primitives of all samples of a tile.
template <class IsSo>
bool all_of_tile(const ShadeInput& input, const Rectangle& tile, const IsSo& is_so) {
  const Visible& visible = input.first();
  for (int y = tile.y; y < tile.y + tile.height; ++y) {
    for (int s = 0; s < visible.view.samples; ++s)
      if (!all_of(visible.primitives.data() + visible.index(tile.x, y, s), std::size_t(tile.width), is_so))
        return false;
    if (input.pixels && !all_of_mixed(*input.pixels, tile, y, is_so)) return false;
  }
  return true;
}

}  // namespace

ShownMaterials::ShownMaterials(const PictureRequest& request)
    : input_(request.input), scene_(request.scene), large_(std::move(scene_.large)) {
  const bool wants_normals = request.options.shading != Shading::flat && lacks_normals(request.scene.surfaces.scene());
  wants_layers(request) ? find_layers(request, wants_normals) : find_front(request, wants_normals);
  if (wants_normals) scene_.triangles.smooth(large_, request.execution);
  source_.emplace(scene_.triangles, input_.view(), wants_normals ? &large_ : nullptr);
  if (!scene_.materials.has_textures()) source_->leave_out_texcoords();
}

DeepImage ShownMaterials::deep(const Surfaces& surfaces, const FragmentShader::Colorist& colorist,
                               const Execution& execution) const {
  const LayerShader shader(*source_, *layers_, colorist, ShadingRate::each_pixel, execution.isa);
  return deep_layers(surfaces, input_.view(), *layers_, shader, execution);
}

void ShownMaterials::paint(const Painting& painting, const Execution& execution) const {
  const ShadedLayer front{*source_, input_.first(), SampleUse::all, input_.pixels};
  if (!layers_) return shade_tiles(front, painting, scene_.works, execution);
  const auto paint_opaque = [&](const Rectangle& tile) {
    if (!shows_front_alone(tile)) return false;
    shade_part({tile.x, tile.y, tile.width, tile.height}, front, painting, scene_.works, execution.isa);
    return true;
  };
  shade_layers(*source_, *layers_, paint_opaque, painting, execution);
}

void ShownMaterials::find_front(const PictureRequest& request, bool wants_normals) {
  const Surfaces& surfaces = request.scene.surfaces;
  if (wants_normals)
    large_ = large_primitives(surfaces.primitive_count(), input_.first(), request.execution, std::move(large_));
  request.scene.make_materials_ready(input_, request.execution);
}

void ShownMaterials::find_layers(const PictureRequest& request, bool wants_normals) {
  const Surfaces& surfaces = request.scene.surfaces;
  layers_.emplace(surfaces, input_.view(), AbufferOptions{request.options.layers.grid, request.options.opacity},
                  request.execution);
  layer_samples_ = layers_->samples();
  takes_front_ = request.options.layers.see_through == SeeThrough::where_needed && request.options.layers.grid == 0;
  if (!wants_normals && scene_.materials.is_ready()) return;
  if (takes_front_)
    large_ = seen_primitives(surfaces, input_, request.execution, std::move(large_));
  else
    large_.clear(surfaces.primitive_count());
  const auto is_opaque = [&](const Rectangle& tile) { return shows_front_alone(tile); };
  add_seen_primitives(*layers_, is_opaque, large_, request.execution);
  request.scene.make_materials_ready(large_, request.execution);
}

bool ShownMaterials::shows_front_alone(const Rectangle& tile) const {
  if (!takes_front_) return false;
  PrimitiveId last = no_primitive;
  return all_of_tile(input_, tile, [&](PrimitiveId id) {
    if (id == last || id == no_primitive) return true;
    last = id;
    return layers_->is_opaque(id);
  });
}

}  // namespace frontmost::shading
