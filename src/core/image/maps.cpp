// SPDX-License-Identifier: Apache-2.0
// Maps of a Visible's first sample: depths, ray distances, ids.
#include <cmath>

#include "frontmost/image.h"
#include "frontmost/scene.h"
#include "frontmost/view.h"
#include "view/answer.h"

namespace frontmost {
namespace {

Image one_channel(const Visible& visible, Channel channel) {
  Image image{visible.view.width, visible.view.height, {}};
  image.channels.push_back(std::move(channel));
  return image;
}

/// A map of `depth_at(x, y, planar depth)` for every pixel that sees something.
template <class DepthAt>
Image map_of_depths(const Visible& visible, const char* name, float background, DepthAt&& depth_at) {
  check_planes(visible, "depth image");
  const View& view = visible.view;
  Buffer<float> values(view.pixel_count());
  std::size_t i = 0;
  for (int y = 0; y < view.height; ++y)
    for (int x = 0; x < view.width; ++x, ++i)
      values[i] =
          visible.primitives[i] == no_primitive ? background : depth_at(x, y, depth_of_key(view, visible.keys[i]));
  return one_channel(visible, {name, std::move(values)});
}

/// Distance along the ray for a planar distance of 1, through the first sample of each pixel.
class RayLengths {
 public:
  explicit RayLengths(const View& view) : projection_(view.projection) {
    const glm::ivec2 offset = sample_offsets(view.samples)[0];
    first_ = glm::dvec2(offset) / 256.0;
    step_ = {(projection_.right - projection_.left) / view.width, (projection_.top - projection_.bottom) / view.height};
  }
  [[nodiscard]] double at(int x, int y) const {
    const double right = projection_.left + (x + first_.x) * step_.x;
    const double up = projection_.top - (y + first_.y) * step_.y;
    return std::sqrt(1 + right * right + up * up);
  }

 private:
  const Projection& projection_;
  glm::dvec2 first_{0}, step_{0};
};

std::uint32_t id_of(const Scene& scene, const PrimitiveSource& source, IdKind kind) {
  if (kind == IdKind::object) return source.instance;
  return scene.meshes[source.mesh].material_of(source.triangle);
}

const char* channel_name(IdKind kind) {
  switch (kind) {
    case IdKind::primitive: return "primitive";
    case IdKind::object: return "object";
    case IdKind::material: return "material";
  }
  return "";
}

}  // namespace

Image depth_image(const Visible& visible, float background) {
  return map_of_depths(visible, "Z", background, [](int, int, float depth) { return depth; });
}

Image ray_distance_image(const Visible& visible, float background) {
  const bool parallel = visible.view.projection.orthographic;
  const RayLengths lengths(visible.view);
  return map_of_depths(visible, "distance", background, [&](int x, int y, float depth) {
    return parallel ? depth : float(double(depth) * lengths.at(x, y));
  });
}

Image id_image(const Surfaces& surfaces, const Visible& visible, IdKind kind) {
  check_planes(visible, "id image");
  const View& view = visible.view;
  return id_image(surfaces, {view.width, view.height}, {visible.primitives.data(), view.pixel_count()}, kind);
}

Image id_image(const Surfaces& surfaces, const glm::ivec2& size, std::span<const PrimitiveId> primitives, IdKind kind) {
  if (size.x < 0 || size.y < 0 || primitives.size() != std::size_t(size.x) * std::size_t(size.y))
    throw Error(ErrorCode::bad_argument, "id image", "the size does not fit the number of ids");
  Buffer<std::uint32_t> ids(primitives.size());
  // Neighbours mostly show the same triangle, which need not be looked up again.
  PrimitiveId last_primitive = no_primitive;
  std::uint32_t last_id = no_index;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const PrimitiveId primitive = primitives[i];
    if (primitive != last_primitive) {
      last_primitive = last_id = primitive;
      if (primitive != no_primitive) {
        if (primitive >= surfaces.primitive_count())
          throw Error(ErrorCode::bad_argument, "id image", "the surfaces are not those that were seen");
        if (kind != IdKind::primitive) last_id = id_of(surfaces.scene(), surfaces.source(primitive), kind);
      }
    }
    ids[i] = last_id;
  }
  Image image{size.x, size.y, {}};
  image.channels.push_back({channel_name(kind), std::move(ids)});
  return image;
}

std::vector<std::uint64_t> count_pixels(const Image& ids, std::size_t count) {
  if (ids.channels.size() != 1 || !ids.channels[0].is_integer())
    throw Error(ErrorCode::bad_argument, "pixel counts", "the image must have one channel of integers");
  std::vector<std::uint64_t> pixels(count);
  for (const std::uint32_t id : ids.channels[0].integers())
    if (id < count) ++pixels[id];
  return pixels;
}

}  // namespace frontmost
