// SPDX-License-Identifier: Apache-2.0
#include "frontmost/shade.h"

#include <algorithm>
#include <cmath>
#include <mutex>

#include "base/parallel.h"
#include "shade/colorists.h"

namespace frontmost {
namespace {

using namespace shading;

/// The four planes of a picture while tiles are written into them.
struct Planes {
  int width, height;
  Buffer<float> values[4];

  Planes(int w, int h) : width(w), height(h) {
    for (Buffer<float>& plane : values) plane = Buffer<float>(std::size_t(w) * std::size_t(h));
  }
  [[nodiscard]] std::size_t row(const TileRectangle& tile, int y) const {
    return std::size_t(tile.y + y) * std::size_t(width) + std::size_t(tile.x);
  }
  void fill(const TileRectangle& tile, const glm::vec4& value) {
    for (int k = 0; k < 4; ++k)
      for (int y = 0; y < tile.height; ++y) std::fill_n(values[k].data() + row(tile, y), tile.width, value[k]);
  }
  /// `pixels` are premultiplied.
  void write(const TileRectangle& tile, const std::vector<glm::vec4>& pixels, const glm::vec4& background) {
    for (int k = 0; k < 4; ++k)
      for (int y = 0; y < tile.height; ++y) {
        const glm::vec4* in = pixels.data() + y * tile.width;
        float* out = values[k].data() + row(tile, y);
        for (int x = 0; x < tile.width; ++x) out[x] = in[x][k] + background[k] * (1.0f - in[x].a);
      }
  }
};

/// Shades all tiles, one row of tiles to a thread at a time. `background` is what an empty pixel gets.
Planes shade_tiles(const TriangleSource& source, const Visible& visible, SampleUse use,
                   const TileWork::Colorist& colorist, const glm::vec4& background, const Execution& execution) {
  const View& view = visible.view;
  Planes planes(view.width, view.height);
  const auto rows = std::size_t((view.height + tile_height - 1) / tile_height);
  parallel_for(execution, rows, 1, [&](std::size_t begin, std::size_t end) {
    const auto work = std::make_unique<TileWork>(source, visible, use, colorist);
    for (std::size_t row = begin; row < end; ++row)
      for (int x = 0; x < view.width; x += tile_width) {
        const int y = int(row) * tile_height;
        const TileRectangle tile{x, y, std::min(tile_width, view.width - x), std::min(tile_height, view.height - y)};
        if (work->shade(tile)) {
          planes.write(tile, work->pixels(), background);
        } else {
          planes.fill(tile, background);
        }
      }
  });
  return planes;
}

Image image_of(Planes planes, std::initializer_list<const char*> names) {
  Image image{planes.width, planes.height, {}};
  int k = 0;
  for (const char* name : names) image.channels.push_back({name, std::move(planes.values[k++])});
  return image;
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

/// What all pictures of materials need.
struct Prepared {
  BitSet seen;
  MaterialTable materials;
  TriangleSource source;

  Prepared(const Surfaces& surfaces, const Visible& visible, const Execution& execution)
      : seen(seen_primitives(surfaces, visible, execution)),
        materials(surfaces.scene(), seen_materials(surfaces, seen, execution), execution),
        source(surfaces, visible.view, seen, execution) {}
};

}  // namespace

Image shade(const Surfaces& surfaces, const Visible& visible, const ShadeOptions& options, const Execution& execution) {
  const Prepared prepared(surfaces, visible, execution);
  const Lighting lighting = lighting_for(visible.view, surfaces.scene().up);
  const glm::vec4 background = background_color(options);
  const auto paint = [&](const TileWork::Colorist& colorist) {
    return image_of(shade_tiles(prepared.source, visible, SampleUse::all, colorist, background, execution),
                    {"R", "G", "B", "A"});
  };
  switch (options.shading) {
    case Shading::lit: {
      std::optional<ShadowMap> shadow;
      if (options.shadows) shadow.emplace(surfaces, visible, glm::dvec3(lighting.to_key), execution);
      return paint(Lit{prepared.materials, lighting, shadow ? &*shadow : nullptr});
    }
    case Shading::flat: return paint(Flat{prepared.materials});
    case Shading::normals: return paint(Normals{prepared.materials});
    case Shading::depth: {
      const DepthRange range = depth_range(visible, execution);
      return paint(Depths{glm::vec3(visible.view.forward()), range.nearest, range.farthest});
    }
    case Shading::ids: return paint(Ids{});
    case Shading::uv: return paint(Texcoords{});
  }
  throw Error(ErrorCode::bad_argument, "shading: unknown value");
}

Image normal_image(const Surfaces& surfaces, const Visible& visible, const Execution& execution) {
  const Prepared prepared(surfaces, visible, execution);
  return image_of(
      shade_tiles(prepared.source, visible, SampleUse::first, RawNormals{prepared.materials}, glm::vec4(0), execution),
      {"N.X", "N.Y", "N.Z"});
}

}  // namespace frontmost
