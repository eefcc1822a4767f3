// SPDX-License-Identifier: Apache-2.0
#include "shade/scan/scan.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "raycast/camera_rays.h"
#include "shade/canvas/canvas.h"
#include "shade/colorists.h"
#include "shade/prepared_scene.h"
#include "view/answer.h"

namespace frontmost::shading {
namespace {

/// Returns the side length of a face in units of its screen. It follows the scan's resolution, so that steps are about
/// 1.
int face_size(const RayCamera& camera) {
  const glm::ivec2 grid = grid_of(camera);
  return std::clamp(std::max(grid.x, grid.y) / 4, 64, 16384);
}

/// The axes of a face as unit vectors.
struct FaceAxes {
  glm::dvec3 right, up, ahead;
};

FaceAxes axes_of(int face) {
  glm::dvec3 ahead(0);
  ahead[face / 2] = face % 2 == 0 ? -1 : 1;
  const glm::dvec3 up = face / 2 == 1 ? glm::dvec3(0, 0, 1) : glm::dvec3(0, 1, 0);
  return {glm::cross(ahead, up), up, ahead};
}

template <class Model>
std::function<glm::dvec3(int, int)> directions_at(const Model& model, const glm::ivec2& offset) {
  const auto directions = std::make_shared<const raycast_detail::GridDirections<Model>>(model, offset);
  return [directions](int x, int y) { return directions->at(x, y); };
}

/// Returns the range of the distances of all hits, or 0 and 0 if nothing is hit.
DepthRange distance_range(const RangeScan& scan) {
  DepthRange range;
  for (std::size_t i = 0; i < scan.ranges.size(); ++i)
    if (scan.primitives[i] != no_primitive) range.include({scan.ranges[i], scan.ranges[i]});
  return range.nearest <= range.farthest ? range : DepthRange{0, 0};
}

class ScanPicture {
 public:
  explicit ScanPicture(const ScanRequest& request)
      : request_(request), scan_(*request.input.scan), directions_(scan_.camera) {}

  void paint(TileCanvas& canvas, const glm::vec4& background) {
    PreparedScene& scene = request_.scene;
    const Shading shading = request_.options.shading;
    const bool shows = shows_materials(shading);
    const bool wants_normals = shows && shading != Shading::flat && lacks_normals(scene.surfaces.scene());
    if (shows) make_ready(wants_normals);
    const bool has_texcoords = !shows || scene.materials.has_textures();
    faces_.emplace(scene.triangles, scan_.camera, wants_normals ? &scene.large : nullptr, has_texcoords);
    if (shading != Shading::lit)
      return paint_tiles({canvas,
                          shading == Shading::depth ? distance_colorist(distance_range(scan_))
                                                    : unlit_colorist(shading, scene.materials, request_.execution.isa),
                          background});
    // The key light is that of a pinhole in the same pose.
    static constexpr glm::ivec2 at_ray[] = {{0, 0}};  // each ray is tested for shadow at its own point
    const ShadedPicture picture{request_.input, request_.options, at_ray};
    const LightOptions& options = request_.options.light;
    const Lighting lighting = lighting_for(picture.input.visible.view, scene.surfaces.scene().up, options,
                                           scene.environment(options, request_.execution));
    const Lit lit = lit_by(lighting, picture, scene, request_.execution);
    scene.shadows.ask_at_points();
    paint_tiles({canvas, std::cref(lit), background});
  }

 private:
  /// Prepares the textures and normals of the visible primitives. If primitives are see-through, also prepares the
  /// index for rays that go on behind them.
  void make_ready(bool wants_normals) {
    PreparedScene& scene = request_.scene;
    const Execution& execution = request_.execution;
    const std::size_t count = scene.surfaces.primitive_count(), pixels = scan_.index(0, scan_.height);
    const std::span<const PrimitiveId> ids(scan_.primitives.data(), scan_.primitives.size());
    if (request_.options.layers.see_through != SeeThrough::never &&
        (has_see_through(scene.surfaces.scene()) || request_.options.opacity < 1.0f))
      through_ = index_of_all();
    if (wants_normals) {
      scene.large = large_primitives(count, ids.first(pixels), scan_.width, execution, std::move(scene.large));
      scene.triangles.smooth(scene.large, execution);
    }
    if (scene.materials.is_ready()) return;
    if (through_) {  // primitives behind glass are not known yet
      scene.seen.clear(count);
      for (std::size_t id = 0; id < count; ++id) scene.seen.add(id);
    } else {
      scene.seen = seen_primitives(count, ids, execution, std::move(scene.seen));
    }
    scene.make_materials_ready(scene.seen, execution);
  }

  const RayIndex* index_of_all() {
    if (request_.input.index) return request_.input.index;
    std::optional<RayIndex>& index = request_.scene.index;
    if (!index) index.emplace(request_.scene.surfaces, request_.execution);
    return &*index;
  }

  /// Paints one row of tiles per thread at a time.
  void paint_tiles(const Painting& painting) {
    const bool shows = shows_materials(request_.options.shading);
    const bool asks_rays = request_.options.shading == Shading::lit && request_.options.light.shadows == Shadows::rays;
    const ScanLayer layer{*faces_,
                          directions_,
                          scan_,
                          shows && request_.scene.materials.has_textures(),
                          !asks_rays,
                          through_,
                          request_.scene.surfaces,
                          shows ? request_.options.opacity : 1.0f};
    const auto rows = std::size_t((scan_.height + tile_height - 1) / tile_height);
    parallel_for(request_.execution, rows, 1, [&](std::size_t begin, std::size_t end) {
      const auto work = request_.scene.scan_works.borrow([] { return std::make_unique<ScanTileWork>(); });
      work->begin(layer, painting.colorist, request_.execution.isa);
      for (std::size_t row = begin; row < end; ++row)
        for (int x = 0; x < scan_.width; x += tile_width) {
          const int y = int(row) * tile_height;
          const TileRectangle tile{x, y, std::min(tile_width, scan_.width - x),
                                   std::min(tile_height, scan_.height - y)};
          if (work->shade(tile))
            painting.canvas.write(tile, work->pixels(), painting.background);
          else
            painting.canvas.fill(tile, painting.background);
        }
    });
  }

  const ScanRequest& request_;
  const RangeScan& scan_;
  ScanDirections directions_;
  std::optional<ScanFaces> faces_;
  const RayIndex* through_ = nullptr;
};

}  // namespace

ScanDirections::ScanDirections(const RayCamera& camera) : grid_(grid_of(camera)) {
  const auto set = [&](const auto& model) {
    for (const glm::ivec2& offset : sample_offsets(camera.samples)) samples_.push_back(directions_at(model, offset));
    middle_ = directions_at(model, sample_offsets(1)[0]);
  };
  std::visit(set, camera.model);
}

glm::dvec3 ScanDirections::middle(const glm::ivec2& at) const {
  if (at.x < 0 || at.y < 0 || at.x >= grid_.x || at.y >= grid_.y) return glm::dvec3(0);
  const glm::dvec3 direction = middle_(at.x, at.y);
  return is_finite(direction) && direction != glm::dvec3(0) ? glm::normalize(direction) : glm::dvec3(0);
}

/// Returns the step to the next pixel in the direction of `step`, or else the step from the pixel on the opposite side.
glm::dvec3 ScanDirections::step_to(const glm::ivec2& from, const glm::ivec2& step) const {
  const glm::dvec3 here = middle(from), next = middle(from + step);
  if (next != glm::dvec3(0)) return next - here;
  const glm::dvec3 last = middle(from - step);
  return last != glm::dvec3(0) ? here - last : glm::dvec3(0);
}

ScanDirections::Steps ScanDirections::steps(int x, int y) const {
  glm::ivec2 at(x, y);
  // The middle of a border pixel may have no ray although one of its samples has; then the next pixel inwards is used.
  if (middle(at) == glm::dvec3(0)) at += glm::ivec2(x < grid_.x / 2 ? 1 : -1, y < grid_.y / 2 ? 1 : -1);
  if (middle(at) == glm::dvec3(0)) return {};
  return {step_to(at, {1, 0}), step_to(at, {0, 1})};
}

int ScanFaces::face_of(const glm::dvec3& direction) {
  const glm::dvec3 size = glm::abs(direction);
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  return 2 * axis + (direction[axis] > 0);
}

ScanFaces::ScanFaces(const TriangleStore& store, const RayCamera& camera, const BitSet* large, bool has_texcoords)
    : half_size_(face_size(camera) * 0.5) {
  for (int face = 0; face < cube_faces; ++face) {
    const FaceAxes axes = axes_of(face);
    View view;
    view.width = view.height = face_size(camera);
    const glm::dmat3 eye_from_face(axes.right, axes.up, -axes.ahead);
    view.world_from_eye = glm::dmat4(glm::dmat3(camera.world_from_eye) * eye_from_face);
    view.world_from_eye[3] = camera.world_from_eye[3];
    view.projection.left = view.projection.bottom = -1;
    view.projection.right = view.projection.top = 1;
    sources_.emplace_back(store, view, large, has_texcoords);
  }
}

glm::vec2 ScanFaces::screen(int face, const glm::dvec3& direction) const {
  const FaceAxes axes = axes_of(face);
  const glm::dvec2 tangent =
      glm::dvec2(glm::dot(direction, axes.right), -glm::dot(direction, axes.up)) / glm::dot(direction, axes.ahead);
  return glm::vec2(half_size_ * (tangent + 1.0));
}

glm::vec2 ScanFaces::screen_step(int face, const glm::dvec3& direction, const glm::dvec3& step) const {
  const FaceAxes axes = axes_of(face);
  const double ahead = glm::dot(direction, axes.ahead);
  // This is the derivative of the quotient in screen(). The component of the step along the ray has no effect.
  const glm::dvec3 across = step - direction * (glm::dot(step, axes.ahead) / ahead);
  return glm::vec2(half_size_ / ahead * glm::dvec2(glm::dot(across, axes.right), -glm::dot(across, axes.up)));
}

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
  // Pixels are visited block by block, so that the fragments of a batch lie close together on the surface.
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
    // In a picture of a few pixels, rays may be opposite and have no mean direction.
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
  // Steps are differences of unit vectors, so the direction must be one, too.
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

void check_scan(const ScanRequest& request) {
  check_opacity(request.options);
  if (request.options.light.ambient_occlusion || request.options.pixels.blend != Blend::linear)
    throw Error(ErrorCode::unsupported, "shade",
                "pictures of scans need linear blending, and have no ambient occlusion");
  check_light(request.options.light);
  if (request.options.light.shows_environment)
    throw Error(ErrorCode::unsupported, "shade", "pictures of scans cannot show an environment as background");
  if (!request.input.scan) throw Error(ErrorCode::bad_argument, "shade", "no scan is given");
  const RangeScan& scan = *request.input.scan;
  validate(scan.camera);
  const std::size_t count = scan.index(0, 0, scan.camera.samples);
  if (glm::ivec2(scan.width, scan.height) != grid_of(scan.camera) || scan.primitives.size() != count ||
      scan.ranges.size() != count)
    throw Error(ErrorCode::bad_argument, "shade", "the scan does not have a value for every sample of its camera");
  check_ids({scan.primitives.data(), count}, request.scene.surfaces.primitive_count(), "shade", request.execution);
}

void paint_scan(const ScanRequest& request, TileCanvas& canvas, const glm::vec4& background) {
  ScanPicture(request).paint(canvas, background);
}

}  // namespace frontmost::shading
