// SPDX-License-Identifier: Apache-2.0
#include "shade/shadow/light_shadows.h"

#include <algorithm>

#include "view/answer.h"

namespace frontmost::shading {
namespace {

bool is_see_through(const Scene& scene, std::uint32_t material) {
  return material < scene.materials.size() && scene.materials[material].is_see_through();
}

/// Returns the values of the given triangles.
template <class T>
std::vector<T> kept(const std::vector<T>& values, const std::vector<std::uint32_t>& triangles) {
  std::vector<T> result;
  result.reserve(triangles.size());
  for (const std::uint32_t t : triangles) result.push_back(values[t]);
  return result;
}

template <class T>
Attribute<T> kept(const Attribute<T>& attribute, const std::vector<std::uint32_t>& triangles) {
  if (attribute.triangles.empty()) return attribute;
  return {attribute.values, kept(attribute.triangles, triangles)};
}

Mesh opaque_part(const Scene& scene, const Mesh& mesh) {
  std::vector<std::uint32_t> triangles;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    if (!is_see_through(scene, mesh.material_of(t))) triangles.push_back(t);
  Mesh part;
  if (triangles.empty()) return part;
  part.positions = mesh.positions;
  part.triangles = kept(mesh.triangles, triangles);
  part.normals = kept(mesh.normals, triangles);
  part.texcoords = kept(mesh.texcoords, triangles);
  for (const Attribute<glm::vec2>& set : mesh.further_texcoords) part.further_texcoords.push_back(kept(set, triangles));
  part.colors = kept(mesh.colors, triangles);
  part.material_ids = mesh.material_ids.size() > 1 ? kept(mesh.material_ids, triangles) : mesh.material_ids;
  return part;
}

/// Whether two views of lights, which are square, are equal.
bool are_equal(const View& a, const View& b) {
  const Projection &p = a.projection, &q = b.projection;
  return a.width == b.width && a.culling == b.culling && a.world_from_eye == b.world_from_eye && p.left == q.left &&
         p.right == q.right && p.bottom == q.bottom && p.top == q.top && p.clip.near == q.clip.near &&
         p.clip.far == q.clip.far;
}

/// Checks the picture that callers made for key_light_view(). \throws Error bad_argument.
void check_light(const Visible& seen_by_light) {
  constexpr const char* who = "shade: seen_by_light";
  check_planes(seen_by_light, who);
  const View& view = seen_by_light.view;
  if (view.width == view.height && view.width >= 4 * ShadowGrid::block && view.width % ShadowGrid::block == 0 &&
      view.samples == 1 && view.projection.orthographic)
    return;
  throw Error(ErrorCode::bad_argument, std::string(who), "must be of a view that key_light_view() gave");
}

ShadowPoints points_of(const FragmentBatch& batch) {
  const Lane3 &at = batch.geometry.smooth_position, &normal = batch.geometry.plane_normal;
  return {at.x.values,     at.y.values,     at.z.values,         normal.x.values,
          normal.y.values, normal.z.values, batch.coverage.count};
}

}  // namespace

bool has_see_through(const Scene& scene) {
  return std::any_of(scene.materials.begin(), scene.materials.end(),
                     [](const Material& m) { return m.is_see_through(); });
}

Scene opaque_part(const Scene& scene) {
  Scene part;
  part.name = scene.name;
  for (const Mesh& mesh : scene.meshes) part.meshes.push_back(opaque_part(scene, mesh));
  part.instances = scene.instances;
  part.materials = scene.materials;
  part.textures.resize(scene.textures.size());  // the numbers must exist; most pixels are not copied
  for (const Material& m : scene.materials) {
    const std::uint32_t texture = m.base_color_texture.texture;
    if (m.alpha == Material::Alpha::mask && m.base_color_texture.is_set())
      part.textures[texture] = scene.textures[texture];
  }
  part.up = scene.up;
  return part;
}

void LightShadows::find(const ShadedPicture& picture, const PictureLights& lights, const Execution& execution) {
  lights_ = &lights;
  light_maps_.assign(lights.far.size() + lights.near.size(), nullptr);
  rays_.reset();
  if (picture.options.light.shadows == Shadows::off) return;
  if (picture.options.light.shadows == Shadows::rays) return aim_rays(picture, execution);
  draw_maps(picture, execution);
}

void LightShadows::follow(std::uint32_t instance, const Execution& execution) {
  rays_.reset();
  for (DrawnMap& drawn : maps_) drawn.has_drawn = false;
  if (opaque_) opaque_->move(opaque_scene_, instance, all_.scene().instances[instance].world_from_mesh, execution);
  if (index_) index_->follow(opaque_ ? *opaque_ : all_, instance, execution);
}

void LightShadows::find_arriving(std::size_t light, const AskedFragments& asked, Isa isa) const {
  if (!rays_)
    return light_maps_[light]->find_light(points_of(asked.batch), asked.is_asked, asked.batch.shadow.values, isa);
  const std::size_t far_count = lights_->far.size();
  light < far_count ? rays_->find_light(lights_->far[light].light, asked)
                    : rays_->find_light(lights_->near[light - far_count].lamp, asked);
}

const Surfaces& LightShadows::casters(const Execution& execution) {
  if (!opaque_ && has_see_through(all_.scene())) {
    opaque_scene_ = opaque_part(all_.scene());
    opaque_.emplace(opaque_scene_, execution);
  }
  return opaque_ ? *opaque_ : all_;
}

std::optional<std::size_t> LightShadows::map_number(const Light& source) const {
  std::size_t number = 1;  // after the key light's
  for (const Light& light : all_.scene().lights) {
    if (number > most_mapped_lights) break;
    if (&light == &source) return number;
    number += light.kind != Light::Kind::point;
  }
  return std::nullopt;
}

void LightShadows::draw_maps(const ShadedPicture& picture, const Execution& execution) {
  const SeenPoints& visible = picture.input.visible;
  if (maps_.empty()) maps_.resize(1 + most_mapped_lights);  // addresses of maps never change
  const auto bounds = [&] { return casters(execution).bounds(); };
  for (std::size_t i = 0; i < lights_->far.size(); ++i) {
    const PictureLights::Far& far = lights_->far[i];
    if (!far.source && picture.input.seen_by_light) {
      check_light(*picture.input.seen_by_light);
      maps_[0].has_drawn = false;
      maps_[0].map.draw(*picture.input.seen_by_light, execution);
      maps_[0].map.measure_from(visible.view.eye());
      light_maps_[i] = &maps_[0].map;
    } else if (!far.source) {
      const glm::dvec3 to_light(far.light.to_light);
      light_maps_[i] = draw_map(0, view_of_light(visible, bounds(), to_light, execution), picture, execution);
    } else if (const auto number = map_number(*far.source)) {
      light_maps_[i] = draw_map(*number, view_of_sun(visible, bounds(), *far.source, execution), picture, execution);
    }
  }
  for (std::size_t i = 0; i < lights_->near.size(); ++i) {
    const Light& source = *lights_->near[i].source;
    if (source.kind != Light::Kind::spot) continue;
    if (const auto number = map_number(source))
      light_maps_[lights_->far.size() + i] =
          draw_map(*number, view_of_spot(visible.view, bounds(), source), picture, execution);
  }
}

Visible LightShadows::draw_casters(const View& view, Visible&& planes, const Execution& execution) {
  // The first two pictures are drawn sooner without clusters. They may be a shadow map and the occlusion of one
  // picture.
  constexpr int kDirectly = 2;
  const Surfaces& surfaces = casters(execution);
  if (!made_cluster_set(surfaces) && drawn_directly_ < kDirectly) {
    ++drawn_directly_;
    return zbuffer(surfaces, view, execution);
  }
  drawer_.give_back(std::move(planes));
  drawer_.draw(surfaces, view, execution);
  return drawer_.take();
}

const ShadowMap* LightShadows::draw_map(std::size_t number, const std::optional<View>& light,
                                        const ShadedPicture& picture, const Execution& execution) {
  DrawnMap& drawn = maps_[number];
  drawn.has_drawn = drawn.has_drawn && light && are_equal(drawn.map.view(), *light);
  if (!light) {
    drawn.map.clear();
    return &drawn.map;
  }
  if (!drawn.has_drawn) {
    drawn.planes = draw_casters(*light, std::move(drawn.planes), execution);
    drawn.map.draw(drawn.planes, execution);
    drawn.has_drawn = true;
  }
  drawn.map.measure_from(picture.input.visible.view.eye());
  return &drawn.map;
}

void LightShadows::aim_rays(const ShadedPicture& picture, const Execution& execution) {
  const Surfaces& surfaces = casters(execution);
  const RayIndex* index = picture.input.index;
  if (opaque_ || !index) {
    if (!index_) index_.emplace(surfaces, execution);
    index = &*index_;
  }
  const View& view = picture.input.visible.view;
  // A ray takes about a hundred nanoseconds. A picture of 1920 x 1080 pixels of four samples has 2^23 rays per light.
  constexpr std::uint64_t kMostRays = std::uint64_t(1) << 27, kMostRaysOfSample = 8;
  const std::uint64_t most = kMostRays + kMostRaysOfSample * view.pixel_count() * picture.samples.size();
  rays_.emplace(*index, !opaque_, picture.samples, view, execution,
                RayShadows::Limit{most, "shadows of " + std::to_string(lights_->far.size() + lights_->near.size()) +
                                            " lights by rays are more than " + std::to_string(most) +
                                            " rays; ask for shadows by maps, for fewer lights or samples, or for a "
                                            "smaller picture"});
}

}  // namespace frontmost::shading
