// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <functional>
#include <optional>
#include <span>

#include "frontmost/pictures.h"
#include "shade/canvas/canvas.h"
#include "shade/colorists.h"
#include "shade/layers/layers.h"
#include "shade/prepared_scene.h"
#include "shade/scan/scan.h"
#include "view/answer.h"

namespace frontmost {
namespace {

using namespace shading;
using abuffer_detail::Rectangle;

using PictureRequest = RequestFor<ShadeInput>;

bool wants_layers(const PictureRequest& request) {
  if (request.options.layers.see_through != SeeThrough::where_needed)
    return request.options.layers.see_through == SeeThrough::always;
  return has_see_through(request.scene.surfaces.scene()) || request.options.opacity < 1.0f;
}

/// Whether `is_so` holds for the primitives of samples 1 and up of all mixed pixels in row `y` of a tile.
template <class IsSo>
bool all_of_mixed(const VisiblePixels& pixels, const Rectangle& tile, int y, const IsSo& is_so) {
  constexpr int run = VisiblePixels::run;
  static_assert(abuffer_detail::kTileSize % run == 0);
  const std::size_t first = std::size_t(y) * pixels.runs_across() + std::size_t(tile.x / run);
  for (std::size_t k = 0; k < std::size_t((tile.width + run - 1) / run); ++k) {
    const auto mixed = std::size_t(std::popcount(pixels.mixed[first + k]));
    if (mixed == 0) continue;
    const PrimitiveId* const others = pixels.others.data() + pixels.places[first + k];
    if (!std::all_of(others, others + mixed * std::size_t(pixels.view.samples - 1), is_so)) return false;
  }
  return true;
}

/// Whether `is_so` holds for the primitives of all samples of a tile.
template <class IsSo>
bool all_of_tile(const ShadeInput& input, const Rectangle& tile, const IsSo& is_so) {
  const Visible& visible = input.first();
  for (int y = tile.y; y < tile.y + tile.height; ++y) {
    for (int s = 0; s < visible.view.samples; ++s) {
      const PrimitiveId* const ids = visible.primitives.data() + visible.index(tile.x, y, s);
      if (!std::all_of(ids, ids + tile.width, is_so)) return false;
    }
    if (input.pixels && !all_of_mixed(*input.pixels, tile, y, is_so)) return false;
  }
  return true;
}

/// The input of a picture of materials: a Visible and, if materials are see-through, all layers.
class ShownMaterials {
 public:
  /// Prepares materials, normals and layers, if the picture needs them. Borrows the request.
  explicit ShownMaterials(const PictureRequest& request)
      : request_(request), input_(request.input), scene_(request.scene) {
    const bool wants_normals = request.options.shading != Shading::flat && lacks_normals(scene_.surfaces.scene());
    wants_layers(request) ? find_layers(wants_normals) : find_front(wants_normals);
    if (wants_normals) scene_.triangles.smooth(scene_.large, request.execution);
    source_.emplace(scene_.triangles, input_.view(), wants_normals ? &scene_.large : nullptr,
                    scene_.materials.has_textures());
  }

  /// Returns the positions of samples within a pixel, in 1/256.
  [[nodiscard]] std::span<const glm::ivec2> samples() const {
    return layers_ ? std::span(layer_samples_) : sample_offsets(input_.view().samples);
  }

  /// Returns every fragment with its colour. Precondition: the layers were found.
  [[nodiscard]] DeepImage deep(const FragmentShader::Colorist& colorist) const {
    return deep_layers(scene_.surfaces, input_.view(), *source_, *layers_, colorist, request_.execution);
  }

  void paint(const Painting& painting) const {
    const Execution& execution = request_.execution;
    const ShadedLayer front{*source_, input_.first(), SampleUse::all, input_.pixels};
    if (!layers_) return shade_tiles(front, painting, scene_.works, execution);
    const auto paint_opaque = [&](const Rectangle& tile) {
      if (!shows_front_alone(tile)) return false;
      shade_part({tile.x, tile.y, tile.width, tile.height}, front, painting, scene_.works, execution.isa);
      return true;
    };
    shade_layers(*source_, *layers_, paint_opaque, painting, execution);
  }

 private:
  void find_front(bool wants_normals) {
    const PrimitiveId count = scene_.surfaces.primitive_count();
    if (wants_normals)
      scene_.large = large_primitives(count, input_.first(), request_.execution, std::move(scene_.large));
    scene_.make_materials_ready(input_, request_.execution);
  }

  void find_layers(bool wants_normals) {
    const auto& layers = request_.options.layers;
    layers_.emplace(scene_.surfaces, input_.view(), AbufferOptions{layers.grid, request_.options.opacity},
                    request_.execution);
    layer_samples_ = layers_->samples();
    takes_front_ = layers.see_through == SeeThrough::where_needed && layers.grid == 0;
    if (!wants_normals && scene_.materials.is_ready()) return;
    if (takes_front_)
      scene_.large = seen_primitives(scene_.surfaces, input_, request_.execution, std::move(scene_.large));
    else
      scene_.large.clear(scene_.surfaces.primitive_count());
    const auto is_opaque = [&](const Rectangle& tile) { return shows_front_alone(tile); };
    const auto note = [&](std::span<const PrimitiveId> primitives) {
      for (const PrimitiveId id : primitives) scene_.large.add(id);
    };
    layers_->list_primitives(note, is_opaque, request_.execution);
    scene_.make_materials_ready(scene_.large, request_.execution);
  }

  /// Whether every visible surface in a tile is opaque, so that nothing behind the front counts.
  [[nodiscard]] bool shows_front_alone(const Rectangle& tile) const {
    if (!takes_front_) return false;
    PrimitiveId last = no_primitive;
    return all_of_tile(input_, tile, [&](PrimitiveId id) {
      if (id == last || id == no_primitive) return true;
      last = id;
      return layers_->is_opaque(id);
    });
  }

  const PictureRequest& request_;
  const ShadeInput& input_;
  PreparedScene& scene_;
  std::optional<abuffer_detail::FragmentPass> layers_;
  std::vector<glm::ivec2> layer_samples_;
  bool takes_front_ = false;  ///< whether tiles without see-through parts are painted from the Visible, whose samples
                              ///< are those of the layers
  std::optional<TriangleSource> source_;
};

glm::vec4 background_color(const ShadeOptions& options) {
  if (!options.background) return glm::vec4(0);
  return {linear_of_shown(*options.background), 1.0f};
}

Lighting lighting_of(const PictureRequest& request) {
  const LightOptions& options = request.options.light;
  return lighting_for(request.input.view(), request.scene.surfaces.scene().up, options,
                      request.scene.environment(options, request.execution));
}

/// Calls use(colorist) with the colorist that the options name. Precondition: shows_materials().
template <class Use>
void with_colorist(const PictureRequest& request, const ShownMaterials& shown, const Use& use) {
  const ShadeOptions& options = request.options;
  if (options.shading != Shading::lit)
    return use(unlit_colorist(options.shading, request.scene.materials, request.execution.isa));
  const Lighting lighting = lighting_of(request);
  Lit lit = lit_by(lighting, {request.input, options, shown.samples()}, request.scene, request.execution);
  lit.occlusion = request.scene.find_occlusion(request.input, options, request.execution);
  use(FragmentShader::Colorist(std::cref(lit)));
}

void check(const PictureRequest& request) {
  check_opacity(request.options);
  check_ambient_occlusion(request.options);
  check_light(request.options.light);
  if (request.options.light.shows_environment && request.options.pixels.blend != Blend::linear)
    throw Error(ErrorCode::unsupported, "shade", "an environment as background needs linear blending");
  const ShadeInput& input = request.input;
  check_given(input, "shade");
  const PrimitiveId count = request.scene.surfaces.primitive_count();
  if (!input.pixels) return check_answer(*input.visible, count, "shade", request.execution);
  check_answer(*input.pixels, count, "shade", request.execution);
  if (request.options.shading == Shading::depth)
    throw Error(ErrorCode::unsupported, "shade", "pictures of depths need the planes of a Visible");
}

void paint_materials(const PictureRequest& request, TileCanvas& canvas) {
  const ShownMaterials shown(request);
  const ShadeOptions& options = request.options;
  with_colorist(request, shown, [&](const FragmentShader::Colorist& colorist) {
    if (options.pixels.blend == Blend::linear)
      return shown.paint({canvas, colorist, background_color(options), options.opacity, options.pixels.rate});
    LinearCanvas in_srgb(canvas);
    const FragmentShader::Colorist srgb = srgb_colorist(colorist);
    const glm::vec4 background = options.background ? glm::vec4(*options.background, 1) : glm::vec4(0);
    shown.paint({in_srgb, srgb, background, options.opacity, options.pixels.rate});
  });
}

void paint_map(const PictureRequest& request, TileCanvas& canvas) {
  const Visible& visible = request.input.first();
  const ShadeOptions& options = request.options;
  const TriangleSource source(request.scene.triangles, visible.view, nullptr);
  const auto paint = [&](const TileWork::Colorist& colorist) {
    shade_tiles({source, visible, SampleUse::all, request.input.pixels}, {canvas, colorist, background_color(options)},
                request.scene.works, request.execution);
  };
  if (options.shading != Shading::depth)
    return paint(unlit_colorist(options.shading, request.scene.materials, request.execution.isa));
  paint(depth_colorist(depth_range(visible, request.execution), glm::vec3(visible.view.forward())));
}

/// Paints a picture. Precondition: check() has accepted the request.
void paint(const PictureRequest& request, TileCanvas& canvas) {
  const auto paint_surfaces = shows_materials(request.options.shading) ? paint_materials : paint_map;
  if (!request.options.light.shows_environment) return paint_surfaces(request, canvas);
  EnvironmentCanvas surrounded(canvas, request.input.view(), lighting_of(request), request.execution.isa);
  paint_surfaces(request, surrounded);
}

}  // namespace

struct Shader::State {
  explicit State(const Surfaces& surfaces) : scene(surfaces) {}

  PreparedScene& now(const Execution& execution) {
    scene.follow_moves(execution);
    return scene;
  }

  PreparedScene scene;
  Image image;
  Bitmap bitmap;
};

Shader::Shader(const Surfaces& surfaces) : state_(std::make_unique<State>(surfaces)) {}
Shader::~Shader() = default;
Shader::Shader(Shader&&) noexcept = default;
Shader& Shader::operator=(Shader&&) noexcept = default;

const Image& Shader::shade(const ShadeInput& input, const ShadeOptions& options, const Execution& execution) {
  const PictureRequest request{state_->now(execution), input, options, execution};
  check(request);
  PlanesCanvas canvas(input.view(), {"R", "G", "B", "A"}, take());
  paint(request, canvas);
  return state_->image = canvas.take();
}

const Bitmap& Shader::shade_bitmap(const ShadeInput& input, const ShadeOptions& options, const Execution& execution) {
  const PictureRequest request{state_->now(execution), input, options, execution};
  check(request);
  BitmapCanvas canvas(input.view(), take_bitmap(), execution.isa);
  paint(request, canvas);
  return state_->bitmap = canvas.take();
}

const Image& Shader::shade(const ScanInput& input, const ShadeOptions& options, const Execution& execution) {
  const ScanRequest request{state_->now(execution), input, options, execution};
  check_scan(request);
  PlanesCanvas canvas(SeenPoints(*input.scan).view, {"R", "G", "B", "A"}, take());
  paint_scan(request, canvas, background_color(options));
  return state_->image = canvas.take();
}

DeepImage Shader::shade_deep(const ShadeInput& input, const ShadeOptions& options, const Execution& execution) {
  if (!shows_materials(options.shading))
    throw Error(ErrorCode::unsupported, "shade", "deep images need shading lit, flat or normals");
  ShadeOptions in_layers = options;
  in_layers.layers.see_through = SeeThrough::always;
  const PictureRequest request{state_->now(execution), input, in_layers, execution};
  check(request);
  const ShownMaterials shown(request);
  DeepImage image;
  with_colorist(request, shown, [&](const FragmentShader::Colorist& colorist) { image = shown.deep(colorist); });
  return image;
}

Image Shader::normal_image(const Visible& visible, const Execution& execution) {
  check_answer(visible, state_->scene.surfaces.primitive_count(), "normal image", execution);
  PreparedScene& scene = state_->now(execution);
  const bool wants_normals = lacks_normals(scene.surfaces.scene());
  if (wants_normals) {
    scene.large = large_primitives(scene.surfaces.primitive_count(), visible, execution, std::move(scene.large));
    scene.triangles.smooth(scene.large, execution);
  }
  scene.make_materials_ready(ShadeInput{.visible = &visible}, execution);
  const TriangleSource source(scene.triangles, visible.view, wants_normals ? &scene.large : nullptr,
                              scene.materials.has_textures());
  const FragmentShader::Colorist colorist = normal_colorist(scene.materials, execution.isa);
  PlanesCanvas canvas(visible.view, {"N.X", "N.Y", "N.Z"});
  shade_tiles({source, visible, SampleUse::first}, {canvas, colorist, glm::vec4(0)}, scene.works, execution);
  return canvas.take();
}

shading::PreparedScene& shading::prepared(Shader& shader, const Execution& execution) {
  return shader.state_->now(execution);
}

Image Shader::take() { return std::exchange(state_->image, {}); }
Bitmap Shader::take_bitmap() { return std::exchange(state_->bitmap, {}); }

Image shade(const Surfaces& surfaces, const ShadeInput& input, const ShadeOptions& options,
            const Execution& execution) {
  Shader shader(surfaces);
  shader.shade(input, options, execution);
  return shader.take();
}

Image shade(const Surfaces& surfaces, const Visible& visible, const ShadeOptions& options, const Execution& execution) {
  return shade(surfaces, ShadeInput{.visible = &visible}, options, execution);
}

Image shade(const Surfaces& surfaces, const VisiblePixels& pixels, const ShadeOptions& options,
            const Execution& execution) {
  return shade(surfaces, ShadeInput{.pixels = &pixels}, options, execution);
}

Image shade(const Surfaces& surfaces, const RangeScan& scan, const ShadeOptions& options, const Execution& execution) {
  return shade(surfaces, ScanInput{.scan = &scan}, options, execution);
}

Image shade(const Surfaces& surfaces, const ScanInput& input, const ShadeOptions& options, const Execution& execution) {
  Shader shader(surfaces);
  shader.shade(input, options, execution);
  return shader.take();
}

Bitmap shade_bitmap(const Surfaces& surfaces, const ShadeInput& input, const ShadeOptions& options,
                    const Execution& execution) {
  Shader shader(surfaces);
  shader.shade_bitmap(input, options, execution);
  return shader.take_bitmap();
}

Bitmap shade_bitmap(const Surfaces& surfaces, const Visible& visible, const ShadeOptions& options,
                    const Execution& execution) {
  return shade_bitmap(surfaces, ShadeInput{.visible = &visible}, options, execution);
}

Bitmap shade_bitmap(const Surfaces& surfaces, const VisiblePixels& pixels, const ShadeOptions& options,
                    const Execution& execution) {
  return shade_bitmap(surfaces, ShadeInput{.pixels = &pixels}, options, execution);
}

DeepImage shade_deep(const Surfaces& surfaces, const Visible& visible, const ShadeOptions& options,
                     const Execution& execution) {
  return shade_deep(surfaces, ShadeInput{.visible = &visible}, options, execution);
}

DeepImage shade_deep(const Surfaces& surfaces, const ShadeInput& input, const ShadeOptions& options,
                     const Execution& execution) {
  return Shader(surfaces).shade_deep(input, options, execution);
}

Image normal_image(const Surfaces& surfaces, const Visible& visible, const Execution& execution) {
  return Shader(surfaces).normal_image(visible, execution);
}

std::optional<View> key_light_view(const Visible& visible, const Box& bounds, const LightOptions& light,
                                   const Execution& execution) {
  check_planes(visible, "light");
  check_light(light);
  if (key_intensity(light) == 0) return std::nullopt;
  return view_of_light(visible, bounds, glm::dvec3(direction_to_key(visible.view, light)), execution);
}

}  // namespace frontmost
