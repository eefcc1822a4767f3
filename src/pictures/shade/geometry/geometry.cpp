// SPDX-License-Identifier: Apache-2.0
#include "shade/geometry/geometry.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/memory.h"
#include "base/parallel.h"

namespace frontmost::shading {
namespace {

/// Whether all ids are `id`. The loop has no branches, so that the compiler can vectorize it.
bool all_equal(const PrimitiveId* ids, std::size_t count, PrimitiveId id) {
  PrimitiveId different = 0;
  for (std::size_t i = 0; i < count; ++i) different |= ids[i] ^ id;
  return different == 0;
}

/// A part of a row of pixels and of the two rows above it.
struct PixelRows {
  const PrimitiveId *row, *above, *above2;

  /// Sets flags[k] to 1 if the primitive of pixel k covers three pixels in a row or around a corner, of which this one
  /// is the last. Looks at the two pixels to the left. The loop has no branches, so that compilers vectorize it.
  void find_large(int begin, int end, std::uint8_t* flags) const {
    for (int k = begin; k < end; ++k) {
      const PrimitiveId id = row[k];
      const auto is_it = [id](PrimitiveId other) { return std::uint8_t(other == id); };
      const std::uint8_t left = is_it(row[k - 1]), up = is_it(above[k]);
      flags[k] = (left & (up | is_it(row[k - 2]))) | (up & is_it(above2[k]));
    }
  }
};

/// Adds the large primitives that end in row `y` of a picture.
void add_large(const PrimitiveId* ids_of_picture, std::size_t y, int width, BitSet& large) {
  constexpr int run = 64, word = 8;
  static const auto nothing = [] {
    std::array<PrimitiveId, run> ids;
    ids.fill(no_primitive);
    return ids;
  }();
  std::uint8_t flags[run] = {};
  for (int begin = 0; begin < width; begin += run) {
    const int count = std::min(run, width - begin), edge = begin == 0 ? std::min(count, 2) : 0;
    const PrimitiveId* const ids = ids_of_picture + y * std::size_t(width) + begin;
    const PixelRows rows{ids, y > 0 ? ids - width : nothing.data(), y > 1 ? ids - 2 * width : nothing.data()};
    for (int k = 0; k < edge; ++k)  // has no two pixels to the left
      flags[k] = ids[k] == rows.above[k] && (ids[k] == rows.above2[k] || (k > 0 && ids[k] == ids[k - 1]));
    rows.find_large(edge, count, flags);
    // Of adjacent pixels with the same primitive, the last one suffices.
    for (int k = 0; k + 1 < count; ++k) flags[k] = flags[k] & std::uint8_t(1 - (flags[k + 1] & (ids[k] == ids[k + 1])));
    std::fill(flags + count, std::end(flags), std::uint8_t(0));
    for (int first = 0; first < count; first += word) {
      std::uint64_t left;
      std::memcpy(&left, flags + first, sizeof left);
      for (; left != 0; left &= left - 1) {
        const int byte = std::countr_zero(left) / 8;
        const PrimitiveId id = ids[first + (std::endian::native == std::endian::little ? byte : word - 1 - byte)];
        if (id != no_primitive) large.add(id);
      }
    }
  }
}

/// Stores the affine weights of a triangle. \returns false if a value is not finite.
bool store(const RayVolumes& v, double scale, std::array<Affine, 3>& weight) {
  bool finite = true;
  for (int k = 0; k < 3; ++k) {
    const Affine a{float(v.value[k] * scale), float(v.step_x[k] * scale), float(v.step_y[k] * scale)};
    finite = finite && std::isfinite(a.at_reference) && std::isfinite(a.step_x) && std::isfinite(a.step_y);
    weight[std::size_t(k)] = a;
  }
  return finite;
}

glm::vec3 unit_or(const glm::dvec3& v, const glm::dvec3& fallback) {
  const double length = std::sqrt(glm::dot(v, v));
  return glm::vec3(length > 1e-300 ? v / length : fallback);
}

float dot3(const glm::vec3& a, const glm::vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

/// Returns the unit vector in the direction of `v`, or zero if `v` has no direction. Very long and short vectors are
/// scaled first, so that their squares stay finite.
glm::vec3 unit_or_zero(const glm::vec3& v) {
  const float length2 = dot3(v, v);
  if (length2 > 1e-20f && length2 < 1e20f) return v * (1.0f / std::sqrt(length2));
  const float size = std::max(std::abs(v.x), std::max(std::abs(v.y), std::abs(v.z)));
  if (!(size > 0 && size < std::numeric_limits<float>::infinity())) return glm::vec3(0);
  const glm::vec3 scaled = v / size;
  const float length = std::sqrt(dot3(scaled, scaled));
  return length > 0 ? scaled / length : glm::vec3(0);  // false for NaN
}

/// Limits a colour to reflectances, which are from 0 to 1. NaN becomes 0.
glm::vec4 reflected_part(const glm::vec4& color) {
  const auto part = [](float value) { return value > 0 ? std::min(value, 1.0f) : 0.0f; };
  return {part(color.r), part(color.g), part(color.b), color.a};
}

TriangleStore::Placement placement_of(const Surfaces& surfaces, std::uint32_t number) {
  const Instance& instance = surfaces.scene().instances[number];
  const Mesh& mesh = surfaces.scene().meshes[instance.mesh];
  // The cofactors are the inverse transpose times the determinant, and exist for singular matrices too.
  const glm::dmat3 m(instance.world_from_mesh);
  const glm::dmat3 cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
  const bool is_mirrored = glm::dot(m[0], cofactors[0]) < 0;
  double size = 0;
  for (int k = 0; k < 9; ++k) size = std::max(size, std::abs(cofactors[k / 3][k % 3]));
  const double scale = (is_mirrored ? -1 : 1) / (size > 0 ? size : 1);
  return {number,        surfaces.first_primitive(number),  std::uint32_t(mesh.triangles.size()), &mesh,
          instance.mesh, ToWorld(instance.world_from_mesh), glm::mat3(cofactors * scale),         is_mirrored};
}

}  // namespace

BitSet seen_primitives(std::size_t primitive_count, std::span<const PrimitiveId> ids, const Execution& execution,
                       BitSet memory) {
  BitSet seen = std::move(memory);
  seen.clear(primitive_count);
  constexpr std::size_t samples_at_once = 1u << 16, run = 64;
  parallel_for(execution, ids.size(), samples_at_once, [&](std::size_t begin, std::size_t end) {
    PrimitiveId last = no_primitive;
    for (std::size_t first = begin; first < end; first += run) {
      const std::size_t count = std::min(run, end - first);
      if (all_equal(ids.data() + first, count, last)) continue;
      for (std::size_t i = first; i < first + count; ++i) {
        const PrimitiveId id = ids[i];
        if (id == last) continue;
        last = id;
        if (id != no_primitive) seen.add(id);
      }
    }
  });
  return seen;
}

BitSet large_primitives(std::size_t primitive_count, std::span<const PrimitiveId> ids, int width,
                        const Execution& execution, BitSet memory) {
  BitSet large = std::move(memory);
  large.clear(primitive_count);
  parallel_for(execution, ids.size() / std::size_t(width), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y) add_large(ids.data(), y, width, large);
  });
  return large;
}

std::vector<bool> seen_materials(const Surfaces& surfaces, const BitSet& seen, const BitSet& known) {
  const Scene& scene = surfaces.scene();
  std::vector<bool> result(scene.materials.size());
  std::uint32_t instance = 0;
  seen.visit_new(known, [&](std::size_t id) {
    const auto triangle_count = [&] { return scene.meshes[scene.instances[instance].mesh].triangles.size(); };
    while (id >= surfaces.first_primitive(instance) + triangle_count()) ++instance;
    const Mesh& mesh = scene.meshes[scene.instances[instance].mesh];
    const std::uint32_t material = mesh.material_of(std::uint32_t(id - surfaces.first_primitive(instance)));
    if (material < result.size()) result[material] = true;
  });
  return result;
}

void set_up_plane(TriangleSetup& setup, const ScreenRays& rays, const std::array<glm::vec3, 3>& corners_world,
                  const glm::vec2& reference) {
  setup.corner_world = corners_world;
  std::array<glm::dvec3, 3> c;
  for (std::size_t k = 0; k < 3; ++k) {
    c[k] = glm::dvec3(corners_world[k]) - rays.eye();
    setup.corner[k] = glm::vec3(c[k]);
  }
  setup.reference = reference;
  const RayVolumes v = ray_volumes(rays, c, double(reference.x), double(reference.y));
  const double sum = v.value.x + v.value.y + v.value.z;
  const glm::dvec3 normal = glm::cross(c[1] - c[0], c[2] - c[0]);
  const double away = glm::dot(normal, rays.is_parallel() ? rays.forward() : c[0]);
  setup.is_backside = away > 0;
  setup.plane_normal = unit_or(away > 0 ? -normal : normal, -rays.forward());
  // At the reference, inside the triangle, the sum has the sign of `away`, so the quotients are positive.
  const bool valid = sum * away > 0 && store(v, 1 / sum, setup.weight);
  if (!valid) setup.weight.fill(Affine{1.0f / 3, 0, 0});
}

TriangleStore::TriangleStore(const Surfaces& surfaces)
    : scene_(surfaces.scene()),
      firsts_(scene_.meshes.size()),
      smooth_(scene_.meshes.size()),
      smoothed_(surfaces.primitive_count()) {
  for (std::uint32_t i = 0; i < scene_.instances.size(); ++i) {
    placements_.push_back(placement_of(surfaces, i));
    firsts_[scene_.instances[i].mesh].push_back(surfaces.first_primitive(i));
  }
  // Meshes with normals need no smoothing.
  for (const Placement& placement : placements_)
    if (!placement.mesh->normals.empty())
      for (std::uint32_t t = 0; t < placement.count; ++t) smoothed_.add(placement.first + t);
}

void TriangleStore::smooth(const BitSet& large, const Execution& execution) {
  if (smoothed_.holds(large)) return;
  for (std::uint32_t m = 0; m < scene_.meshes.size(); ++m)
    if (scene_.meshes[m].normals.empty() && !firsts_[m].empty()) smooth_mesh(m, large, execution);
}

void TriangleStore::smooth_mesh(std::uint32_t mesh, const BitSet& large, const Execution& execution) {
  const std::vector<PrimitiveId>& firsts = firsts_[mesh];
  const auto count = std::uint32_t(scene_.meshes[mesh].triangles.size());
  const auto is_large = [&](std::uint32_t triangle) {
    return std::any_of(firsts.begin(), firsts.end(),
                       [&](PrimitiveId first) { return large.contains(first + triangle); });
  };
  const auto is_smoothed = [&](std::uint32_t triangle) { return smoothed_.contains(firsts.front() + triangle); };
  bool has_new = false;
  for (std::uint32_t t = 0; t < count && !has_new; ++t) has_new = is_large(t) && !is_smoothed(t);
  if (!has_new) return;
  const bool is_first_time = smooth_[mesh].empty();
  const auto is_wanted = [&](std::uint32_t triangle) { return !is_first_time || is_large(triangle); };
  smooth_[mesh] = smooth_normals(scene_.meshes[mesh], is_wanted, execution);
  for (std::uint32_t t = 0; t < count; ++t)
    if (is_wanted(t))
      for (const PrimitiveId first : firsts) smoothed_.add(first + t);
}

void TriangleStore::follow(const Surfaces& surfaces, std::uint32_t instance) {
  placements_[instance] = placement_of(surfaces, instance);
}

const TriangleStore::Placement& TriangleStore::placement_with(PrimitiveId id, const Placement& guess) const {
  if (guess.holds(id)) return guess;
  const auto starts_after = [](PrimitiveId wanted, const Placement& p) { return wanted < p.first; };
  return *(std::upper_bound(placements_.begin(), placements_.end(), id, starts_after) - 1);
}

void TriangleSource::set_up(std::span<const NewTriangle> triangles, std::vector<TriangleSetup>& setups) const {
  if (triangles.empty()) return;
  // Neighbours on the screen are often far apart in memory, so all data is prefetched: first the corner numbers, then
  // the positions.
  const Placement* placement = &store_.first_placement();
  for (const NewTriangle& t : triangles) {
    placement = &store_.placement_with(t.id, *placement);
    prefetch_line(&placement->mesh->triangles[t.id - placement->first]);
    const PackedCornerNormals& smooth = store_.smooth_normals_of(placement->mesh_number);
    if (!smooth.empty()) prefetch_line(&smooth[t.id - placement->first]);
  }
  for (const NewTriangle& t : triangles) {
    placement = &store_.placement_with(t.id, *placement);
    const glm::uvec3& corners = placement->mesh->triangles[t.id - placement->first];
    for (int k = 0; k < 3; ++k) prefetch_line(&placement->mesh->positions[corners[k]]);
  }
  for (const NewTriangle& t : triangles) {
    placement = &store_.placement_with(t.id, *placement);
    set_up(t, *placement, setups[t.number]);
  }
}

void TriangleSource::set_up(const NewTriangle& triangle, const Placement& placement, TriangleSetup& setup) const {
  const Mesh& mesh = *placement.mesh;
  setup.id = triangle.id;
  setup.instance = placement.instance;
  setup.mesh = placement.mesh_number;
  setup.triangle = triangle.id - placement.first;
  setup.material = mesh.material_of(setup.triangle);
  const glm::uvec3& c = mesh.triangles[setup.triangle];
  const std::array<glm::vec3, 3> corners{placement.world(mesh.positions[c.x]), placement.world(mesh.positions[c.y]),
                                         placement.world(mesh.positions[c.z])};
  set_up_plane(setup, rays_, corners, triangle.reference);
  if (placement.is_mirrored) setup.is_backside = !setup.is_backside;
  set_normals(triangle.id, placement, setup);
  set_attributes(mesh, setup);
}

void TriangleSource::set_normals(PrimitiveId id, const Placement& placement, TriangleSetup& setup) const {
  const Mesh& mesh = *placement.mesh;
  if (mesh.normals.empty() && !(large_ && large_->contains(id))) {
    setup.normal.fill(setup.plane_normal);
    setup.is_smooth = false;
    return;
  }
  const glm::mat3& normal_matrix = placement.normal_matrix;
  glm::vec3 sum(0);
  for (std::size_t k = 0; k < 3; ++k) {
    const glm::vec3 own = mesh.normals.empty()
                              ? unpack(store_.smooth_normals_of(setup.mesh)[setup.triangle][k])
                              : mesh.normals.values[mesh.corners(mesh.normals, setup.triangle)[int(k)]];
    setup.normal[k] = unit_or_zero(normal_matrix * own);
    sum += setup.normal[k];
  }
  // All three normals are flipped together to the visible side, whatever the winding; a single one may lean away.
  const bool turned = dot3(sum, setup.plane_normal) < 0;
  setup.is_smooth = false;
  for (glm::vec3& n : setup.normal) {
    if (turned) n = -n;
    if (n == glm::vec3(0)) n = setup.plane_normal;
    setup.is_smooth = setup.is_smooth || dot3(n, setup.plane_normal) < 0.99999f;
  }
}

void TriangleSource::set_attributes(const Mesh& mesh, TriangleSetup& setup) const {
  setup.has_color = !mesh.colors.empty();
  setup.color.fill(glm::vec4(1));
  if (setup.has_color) {
    const glm::uvec3& corners = mesh.corners(mesh.colors, setup.triangle);
    for (std::size_t k = 0; k < 3; ++k) setup.color[k] = reflected_part(mesh.colors.values[corners[int(k)]]);
  }
  setup.has_texcoord = {};
  setup.texcoord = {};
  for (std::uint32_t set = 0; has_texcoords_ && set <= mesh.further_texcoords.size(); ++set) {
    const Attribute<glm::vec2>* const texcoords = mesh.texcoord_set(set);
    if (!texcoords) continue;
    setup.has_texcoord[set] = true;
    const glm::uvec3& corners = mesh.corners(*texcoords, setup.triangle);
    for (std::size_t k = 0; k < 3; ++k) setup.texcoord[set][k] = texcoords->values[corners[int(k)]];
  }
}

}  // namespace frontmost::shading
