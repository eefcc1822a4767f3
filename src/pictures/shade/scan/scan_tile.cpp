// SPDX-License-Identifier: Apache-2.0
#include "shade/scan/scan_tile.h"

#include <algorithm>

namespace frontmost::shading {

void ScanTileWork::begin(const ScanLayer& layer, const FragmentShader::Colorist& colorist, Isa isa) {
  layer_ = &layer;
  colorist_ = &colorist;
  isa_ = isa;
}

bool ScanTileWork::shade(const TileRectangle& tile) {
  find_fragments(tile);
  if (fragments_.empty()) return false;
  std::fill(pixels_.begin(), pixels_.end(), glm::vec4(0));
  for (int face = 0; face < cube_faces; ++face) shade_face(face);
  return true;
}

void ScanTileWork::find_fragments(const TileRectangle& tile) {
  fragments_.clear();
  // In blocks: fragments of a batch then lie close together on the surface.
  constexpr int block = 16;
  for (int left = 0; left < tile.width; left += block)
    for (int y = 0; y < tile.height; ++y)
      for (int x = left; x < std::min(left + block, tile.width); ++x)
        add_pixel({tile.x + x, tile.y + y}, std::uint32_t(y * tile.width + x));
}

void ScanTileWork::add_pixel(const glm::ivec2& at, std::uint32_t pixel) {
  const RangeScan& scan = layer_->scan;
  const int samples = scan.camera.samples;
  PrimitiveId ids[16];
  bool is_empty = true;
  for (int s = 0; s < samples; ++s) {
    ids[s] = scan.primitives[scan.index(at.x, at.y, s)];
    is_empty = is_empty && ids[s] == no_primitive;
  }
  if (is_empty) return;
  if (layer_->has_textures) steps_ = layer_->directions.steps(at.x, at.y);
  for (int s = 0; s < samples; ++s) {
    if (ids[s] == no_primitive) continue;
    if (!layer_->merges || is_seen_through(ids[s])) {
      add_ray(at, s, pixel);
      continue;
    }
    const PrimitiveId id = ids[s];
    const glm::dvec3 first = layer_->directions.at(at.x, at.y, s);
    glm::dvec3 sum = first;
    int count = 1;
    for (int other = s + 1; other < samples; ++other) {
      if (ids[other] != id) continue;
      sum += layer_->directions.at(at.x, at.y, other);
      ids[other] = no_primitive;
      ++count;
    }
    // Opposite rays, in a picture of a few pixels, have no mean direction.
    add(id, pixel, glm::dot(sum, first) > 0 ? sum : first, float(count) / float(samples));
  }
}

/// Adds the hits of one ray, up to the first opaque one.
void ScanTileWork::add_ray(const glm::ivec2& at, int sample, std::uint32_t pixel) {
  const RangeScan& scan = layer_->scan;
  const glm::dvec3 direction = layer_->directions.at(at.x, at.y, sample);
  const float weight = 1.0f / float(scan.camera.samples);
  const PrimitiveId front = scan.primitives[scan.index(at.x, at.y, sample)];
  add(front, pixel, direction, weight);
  if (!is_seen_through(front)) return;
  for (const RayHit& hit : all_hits(*layer_->through, ray_of(scan.camera, at.x, at.y, sample))) {
    if (hit.primitive == front) continue;
    add(hit.primitive, pixel, direction, weight);
    fragments_.back().begins_ray = false;
    if (!is_seen_through(hit.primitive)) return;
  }
}

void ScanTileWork::add(PrimitiveId id, std::uint32_t pixel, const glm::dvec3& direction, float weight) {
  const ScanFaces& faces = layer_->faces;
  const int face = ScanFaces::face_of(direction);
  // Steps are differences of unit vectors.
  const glm::dvec3 unit = glm::normalize(direction);
  fragments_.push_back({id, pixel, true, face, weight, faces.screen(face, unit),
                        faces.screen_step(face, unit, steps_.x), faces.screen_step(face, unit, steps_.y)});
}

bool ScanTileWork::is_seen_through(PrimitiveId id) const {
  if (!layer_->through) return false;
  if (layer_->opacity < 1.0f) return true;
  const Scene& scene = layer_->surfaces.scene();
  const PrimitiveSource source = layer_->surfaces.source(id);
  const std::uint32_t material = scene.meshes[source.mesh].material_of(source.triangle);
  return material < scene.materials.size() && scene.materials[material].is_see_through();
}

void ScanTileWork::shade_face(int face) {
  const auto is_here = [face](const Fragment& f) { return f.face == face; };
  if (std::none_of(fragments_.begin(), fragments_.end(), is_here)) return;
  shader_.begin(layer_->faces.source(face), *colorist_, isa_, &pixel_steps_);
  for (std::size_t i = 0; i < fragments_.size(); ++i) {
    const Fragment& f = fragments_[i];
    if (!is_here(f)) continue;
    if (shader_.is_full()) flush();
    pixel_steps_.x.set(shader_.count(), f.step_x);
    pixel_steps_.y.set(shader_.count(), f.step_y);
    shader_.add(f.id, std::uint32_t(i), f.screen, 1, f.weight);
  }
  flush();
}

void ScanTileWork::flush() {
  shader_.hand_out([this](const FragmentShader::Shaded& s) {
    const Fragment& f = fragments_[s.number];
    if (f.begins_ray) arriving_ = glm::vec3(1);
    // Tinted surfaces hide a different share of each channel.
    const glm::vec3 hides = s.alphas * layer_->opacity, hidden = s.weight * arriving_ * hides;
    const bool is_grey = hidden == glm::vec3(hidden.x);
    const glm::vec3 color = s.light * (s.weight * arriving_ * (s.alpha * layer_->opacity));
    pixels_[f.pixel] += glm::vec4(color, is_grey ? hidden.x : (hidden.x + hidden.y + hidden.z) / 3);
    arriving_ *= 1.0f - hides;
  });
}

}  // namespace frontmost::shading
