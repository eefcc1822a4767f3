// SPDX-License-Identifier: Apache-2.0
#include <functional>

#include "base/srgb.h"
#include "frontmost/pictures.h"
#include "shade/canvas/canvas.h"
#include "shade/canvas/environment_canvas.h"
#include "shade/canvas/srgb_blend.h"
#include "shade/colorists.h"
#include "shade/picture_parts.h"
#include "shade/scan/scan_picture.h"
#include "shade/shade_tiles.h"
#include "shade/shadow/light_view.h"
#include "shade/shown_materials.h"
#include "view/answer.h"

namespace frontmost {
namespace {

using namespace shading;

glm::vec4 background_color(const ShadeOptions& options) {
  if (!options.background) return glm::vec4(0);
  const glm::vec3& c = *options.background;
  return {linear_of_shown(c.x), linear_of_shown(c.y), linear_of_shown(c.z), 1.0f};
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
  const MaterialTable& materials = request.scene.materials;
  const auto use_it = [&](const auto& colorist) { use(FragmentShader::Colorist(std::cref(colorist))); };
  if (options.shading == Shading::flat) return use_it(Flat{materials, request.execution.isa});
  if (options.shading == Shading::normals) return use_it(Normals{materials, request.execution.isa});
  const Lighting lighting = lighting_of(request);
  Lit lit = lit_by(lighting, {request.input, options, shown.samples()}, request.scene, request.execution);
  lit.occlusion = request.scene.find_occlusion(request.input, options, request.execution);
  use_it(lit);
}

void check(const PictureRequest& request) {
  check_opacity(request.options);
  check_ambient_occlusion(request.options);
  check_light(request.options.light);
  if (request.options.light.shows_environment && request.options.pixels.blend != Blend::linear)
    throw Error(ErrorCode::unsupported, "shade", "an environment is shown as background by the blend linear alone");
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
      return shown.paint({canvas, colorist, background_color(options), options.opacity, options.pixels.rate},
                         request.execution);
    LinearCanvas in_srgb(canvas);
    const FragmentShader::Colorist srgb = SrgbColorist{colorist};
    const glm::vec4 background = options.background ? glm::vec4(*options.background, 1) : glm::vec4(0);
    shown.paint({in_srgb, srgb, background, options.opacity, options.pixels.rate}, request.execution);
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
  if (options.shading == Shading::ids) return paint(Ids{});
  if (options.shading == Shading::uv) return paint(Texcoords{});
  const DepthRange range = depth_range(visible, request.execution);
  const Depths depths{glm::vec3(visible.view.forward()), range.nearest, range.farthest};
  paint(std::cref(depths));
}

/// Precondition: check().
void paint_surfaces(const PictureRequest& request, TileCanvas& canvas) {
  shows_materials(request.options.shading) ? paint_materials(request, canvas) : paint_map(request, canvas);
}

/// Precondition: check().
void paint(const PictureRequest& request, TileCanvas& canvas) {
  if (!request.options.light.shows_environment) return paint_surfaces(request, canvas);
  EnvironmentCanvas surrounded(canvas, request.input.view(), lighting_of(request), request.execution.isa);
  paint_surfaces(request, surrounded);
}

DeepImage deep_image(const PictureRequest& request) {
  check(request);
  const ShownMaterials shown(request);
  DeepImage image;
  with_colorist(request, shown, [&](const FragmentShader::Colorist& colorist) {
    image = shown.deep(request.scene.surfaces, colorist, request.execution);
  });
  return image;
}

void paint_normals(PreparedScene& scene, const Visible& visible, const Execution& execution, TileCanvas& canvas) {
  std::optional<BitSet> large;
  if (lacks_normals(scene.surfaces.scene())) {
    large = large_primitives(scene.surfaces.primitive_count(), visible, execution);
    scene.triangles.smooth(*large, execution);
  }
  scene.make_materials_ready(ShadeInput{.visible = &visible}, execution);
  TriangleSource source(scene.triangles, visible.view, large ? &*large : nullptr);
  if (!scene.materials.has_textures()) source.leave_out_texcoords();
  const TileWork::Colorist colorist = RawNormals{scene.materials, execution.isa};
  shade_tiles({source, visible, SampleUse::first}, {canvas, colorist, glm::vec4(0)}, scene.works, execution);
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
    throw Error(ErrorCode::unsupported, "shade", "deep images are lit, flat, or of normals");
  ShadeOptions in_layers = options;
  in_layers.layers.see_through = SeeThrough::always;
  return deep_image({state_->now(execution), input, in_layers, execution});
}

Image Shader::normal_image(const Visible& visible, const Execution& execution) {
  check_answer(visible, state_->scene.surfaces.primitive_count(), "normal image", execution);
  PlanesCanvas canvas(visible.view, {"N.X", "N.Y", "N.Z"});
  paint_normals(state_->now(execution), visible, execution, canvas);
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
