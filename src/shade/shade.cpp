// SPDX-License-Identifier: Apache-2.0
#include "frontmost/shade.h"

#include <algorithm>
#include <cmath>
#include <mutex>

#include "base/parallel.h"
#include "base/srgb.h"
#include "shade/canvas.h"
#include "shade/colorists.h"
#include "shade/deep_layers.h"
#include "shade/opaque_part.h"
#include "shade/shadow/key_shadows.h"

namespace frontmost {
namespace {

using namespace shading;

/// A Visible and what its triangles are set up from.
struct Layer {
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
void shade_tiles(const Layer& layer, const Painting& painting, const Execution& execution) {
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

/// For every material, whether a texture of it will be looked at. `seen()` gives the primitives that are.
template <class Seen>
std::vector<bool> needed_materials(const Surfaces& surfaces, const Seen& seen, const Execution& execution) {
  const Scene& scene = surfaces.scene();
  if (!has_textures(scene)) return std::vector<bool>(scene.materials.size());
  return seen_materials(surfaces, seen(), execution);
}

/// The triangles of a picture of materials.
struct Triangles {
  std::optional<BitSet> large;
  std::optional<TriangleSource> source;

  /// `find_large()` gives those worth a smooth normal where the model has none.
  template <class FindLarge>
  Triangles(const Surfaces& surfaces, const View& view, const FindLarge& find_large, const Execution& execution) {
    if (lacks_normals(surfaces.scene())) large = find_large();
    source.emplace(surfaces, view, large ? &*large : nullptr, execution);
    if (!has_textures(surfaces.scene())) source->leave_out_texcoords();
  }
};

/// What pictures of materials need: of the primitives that a Visible shows, or, where materials can be seen through, of
/// all layers.
class Materials {
 public:
  Materials(const Surfaces& surfaces, const Visible& visible, const ShadeOptions& options, const Execution& execution)
      : visible_(visible) {
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
    const auto large = [&] { return large_primitives(surfaces.primitive_count(), visible_, execution); };
    const auto seen = [&] { return seen_primitives(surfaces, visible_, execution); };
    triangles_.emplace(surfaces, visible_.view, large, execution);
    table_.emplace(surfaces.scene(), needed_materials(surfaces, seen, execution), execution);
  }

  void make_layers(const Surfaces& surfaces, const ShadeOptions& options, const Execution& execution) {
    layers_.emplace(surfaces, visible_.view, AbufferOptions{options.grid, options.opacity}, execution);
    const auto seen = [&] { return seen_primitives(surfaces, *layers_, execution); };
    triangles_.emplace(surfaces, visible_.view, seen, execution);
    table_.emplace(surfaces.scene(), needed_materials(surfaces, seen, execution), execution);
  }

  const Visible& visible_;
  std::optional<abuffer_detail::FragmentPass> layers_;
  std::optional<Triangles> triangles_;
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

/// Calls use(colorist) with what colours fragments as the options say. Precondition: shows_materials().
template <class Use>
void with_colorist(const Request& request, const Materials& materials, const Use& use) {
  const ShadeOptions& options = request.options;
  if (options.shading == Shading::flat) return use(FragmentShader::Colorist(Flat{materials.table()}));
  if (options.shading == Shading::normals) return use(FragmentShader::Colorist(Normals{materials.table()}));
  const Lighting lighting = lighting_for(request.visible.view, request.surfaces.scene().up);
  const std::vector<glm::ivec2> samples = materials.samples();
  const KeyShadows shadows({request.surfaces, request.visible, options, samples}, lighting.to_key, request.execution);
  use(FragmentShader::Colorist(Lit{materials.table(), lighting, shadows.map(), shadows.rays(), request.execution.isa}));
}

void paint_materials(const Request& request, Canvas& canvas) {
  const Materials materials(request.surfaces, request.visible, request.options, request.execution);
  with_colorist(request, materials, [&](const FragmentShader::Colorist& colorist) {
    materials.paint({canvas, colorist, background_color(request.options), request.options.opacity}, request.execution);
  });
}

void paint_map(const Request& request, Canvas& canvas) {
  const Visible& visible = request.visible;
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

void check_opacity(const ShadeOptions& options) {
  if (!(options.opacity >= 0.0f && options.opacity <= 1.0f))
    throw Error(ErrorCode::bad_argument, "shade: opacity: must be 0 to 1");
}

void paint(const Request& request, Canvas& canvas) {
  check_opacity(request.options);
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

DeepImage shade_deep(const Surfaces& surfaces, const Visible& visible, const ShadeOptions& options,
                     const Execution& execution) {
  check_opacity(options);
  if (!shows_materials(options.shading))
    throw Error(ErrorCode::unsupported, "shade: deep images are lit, flat, or of normals");
  ShadeOptions in_layers = options;
  in_layers.see_through = SeeThrough::always;
  const Request request{surfaces, visible, in_layers, execution};
  const Materials materials(surfaces, visible, in_layers, execution);
  DeepImage image;
  with_colorist(request, materials, [&](const FragmentShader::Colorist& colorist) {
    image = materials.deep(surfaces, colorist, execution);
  });
  return image;
}

namespace {

/// Calls receive(number, light, alpha) for every point.
template <class Receive>
void shade_all(const TriangleSource& source, const FragmentShader::Colorist& colorist,
               std::span<const ShadePoint> points, const Execution& execution, const Receive& receive) {
  constexpr std::size_t points_at_once = 1u << 13;
  parallel_for(execution, points.size(), points_at_once, [&](std::size_t begin, std::size_t end) {
    FragmentShader shader(source, colorist);
    const auto hand_out = [&] {
      shader.hand_out(
          [&](std::uint32_t number, float, const glm::vec3& light, float alpha) { receive(number, light, alpha); });
    };
    for (std::size_t i = begin; i < end; ++i) {
      if (shader.is_full()) hand_out();
      shader.add(points[i].id, std::uint32_t(i), points[i].screen, 1, 1.0f);
    }
    hand_out();
  });
}

}  // namespace

std::optional<View> key_light_view(const Visible& visible, const Box& bounds, Axis up, const Execution& execution) {
  return view_of_light(visible, bounds, glm::dvec3(lighting_for(visible.view, up).to_key), execution);
}

std::vector<glm::u8vec4> shade_points(const Surfaces& surfaces, const View& view, std::span<const ShadePoint> points,
                                      const ShadeOptions& options, const Execution& execution) {
  validate(view);
  check_opacity(options);
  if (!shows_materials(options.shading) && options.shading != Shading::ids)
    throw Error(ErrorCode::unsupported, "shade: points are lit, flat, of normals or of ids");
  BitSet seen(surfaces.primitive_count());
  for (const ShadePoint& point : points) {
    if (point.id >= surfaces.primitive_count())
      throw Error(ErrorCode::bad_argument, "shade: a point's triangle is not of these surfaces");
    seen.add(point.id);
  }
  const TriangleSource source(surfaces, view, nullptr, execution);
  const MaterialTable table(surfaces.scene(),
                            needed_materials(
                                surfaces, [&]() -> const BitSet& { return seen; }, execution),
                            execution);
  const Lighting lighting = lighting_for(view, surfaces.scene().up);
  FragmentShader::Colorist colorist = Lit{table, lighting, nullptr, nullptr, execution.isa};
  if (options.shading == Shading::flat) colorist = Flat{table};
  if (options.shading == Shading::normals) colorist = Normals{table};
  if (options.shading == Shading::ids) colorist = Ids{};
  std::vector<glm::u8vec4> colors(points.size());
  shade_all(source, colorist, points, execution, [&](std::uint32_t i, const glm::vec3& light, float alpha) {
    const float opacity = std::clamp(alpha * options.opacity, 0.0f, 1.0f);
    colors[i] = {srgb8_of_linear(light.x), srgb8_of_linear(light.y), srgb8_of_linear(light.z),
                 std::uint8_t(opacity * 255.0f + 0.5f)};
  });
  return colors;
}

Image normal_image(const Surfaces& surfaces, const Visible& visible, const Execution& execution) {
  const auto large = [&] { return large_primitives(surfaces.primitive_count(), visible, execution); };
  const auto seen = [&] { return seen_primitives(surfaces, visible, execution); };
  const MaterialTable table(surfaces.scene(), needed_materials(surfaces, seen, execution), execution);
  const Triangles triangles(surfaces, visible.view, large, execution);
  const TileWork::Colorist colorist = RawNormals{table};
  PlanesCanvas canvas(visible.view, {"N.X", "N.Y", "N.Z"});
  shade_tiles({*triangles.source, visible, SampleUse::first}, {canvas, colorist, glm::vec4(0)}, execution);
  return canvas.take();
}

}  // namespace frontmost
