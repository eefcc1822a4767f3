// SPDX-License-Identifier: Apache-2.0
#include "shade/geometry.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace frontmost::shading {
namespace {

float dot3(const glm::vec3& a, const glm::vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

/// Whatever its length: scaled first, so that squares of large and small ones stay finite. Zero when it has none.
glm::vec3 unit_or_zero(const glm::vec3& v) {
  const float size = std::max(std::abs(v.x), std::max(std::abs(v.y), std::abs(v.z)));
  if (!(size > 0 && size < std::numeric_limits<float>::infinity())) return glm::vec3(0);
  const glm::vec3 scaled = v / size;
  const float length = std::sqrt(dot3(scaled, scaled));
  return length > 0 ? scaled / length : glm::vec3(0);  // false for NaN
}

bool lacks_normals(const Mesh& mesh) { return mesh.normals.empty(); }

/// Without branches, so that the compiler can compare many at a time.
bool all_equal(const PrimitiveId* ids, std::size_t count, PrimitiveId id) {
  PrimitiveId different = 0;
  for (std::size_t i = 0; i < count; ++i) different |= ids[i] ^ id;
  return different == 0;
}

bool any_seen(const BitSet& seen, PrimitiveId first, std::size_t count) {
  for (std::size_t t = 0; t < count; ++t)
    if (seen.contains(first + t)) return true;
  return false;
}

}  // namespace

BitSet seen_primitives(const Surfaces& surfaces, const Visible& visible, const Execution& execution) {
  BitSet seen(surfaces.primitive_count());
  constexpr std::size_t samples_at_once = 1u << 16, run = 64;
  parallel_for(execution, visible.primitives.size(), samples_at_once, [&](std::size_t begin, std::size_t end) {
    PrimitiveId last = no_primitive;
    for (std::size_t first = begin; first < end; first += run) {
      const std::size_t count = std::min(run, end - first);
      if (all_equal(visible.primitives.data() + first, count, last)) continue;
      for (std::size_t i = first; i < first + count; ++i) {
        const PrimitiveId id = visible.primitives[i];
        if (id == last) continue;
        last = id;
        if (id != no_primitive) seen.add(id);
      }
    }
  });
  return seen;
}

BitSet large_primitives(const Surfaces& surfaces, const Visible& visible, const Execution& execution) {
  BitSet large(surfaces.primitive_count());
  const View& view = visible.view;
  parallel_for(execution, std::size_t(view.height), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y) {
      const PrimitiveId* row = visible.primitives.data() + visible.index(0, int(y));
      const auto is_at = [&](PrimitiveId id, int x, int up) {
        return x >= 0 && std::size_t(up) <= y && row[x - up * view.width] == id;
      };
      PrimitiveId last = no_primitive;
      for (int x = 0; x < view.width; ++x) {
        const PrimitiveId id = row[x];
        if (id == no_primitive || id == last) continue;
        const bool left = is_at(id, x - 1, 0), above = is_at(id, x, 1);
        if ((left && (above || is_at(id, x - 2, 0))) || (above && is_at(id, x, 2))) {
          large.add(id);
          last = id;
        }
      }
    }
  });
  return large;
}

std::vector<bool> seen_materials(const Surfaces& surfaces, const BitSet& seen, const Execution& execution) {
  const Scene& scene = surfaces.scene();
  BitSet materials(scene.materials.size());
  const auto add = [&](std::uint32_t material) {
    if (material != no_index) materials.add(material);
  };
  parallel_for(execution, scene.instances.size(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Mesh& mesh = scene.meshes[scene.instances[i].mesh];
      const PrimitiveId first = surfaces.first_primitive(std::uint32_t(i));
      if (mesh.material_ids.size() <= 1) {
        if (!mesh.material_ids.empty() && any_seen(seen, first, mesh.triangles.size())) add(mesh.material_ids[0]);
      } else {
        for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
          if (seen.contains(first + t)) add(mesh.material_of(t));
      }
    }
  });
  std::vector<bool> result(scene.materials.size());
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = materials.contains(i);
  return result;
}

TriangleSource::TriangleSource(const Surfaces& surfaces, const View& view, const BitSet* large,
                               const Execution& execution)
    : surfaces_(surfaces), rays_(view), large_(large), smooth_(surfaces.scene().meshes.size()) {
  const Scene& scene = surfaces.scene();
  std::vector<std::vector<PrimitiveId>> first_of_mesh(scene.meshes.size());
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    placements_.push_back(placement_of(scene.instances[i].world_from_mesh));
    first_of_mesh[scene.instances[i].mesh].push_back(surfaces.first_primitive(i));
  }
  if (!large) return;
  for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
    if (!lacks_normals(scene.meshes[m]) || first_of_mesh[m].empty()) continue;
    const auto is_large = [&](std::uint32_t triangle) {
      for (const PrimitiveId first : first_of_mesh[m])
        if (large->contains(first + triangle)) return true;
      return false;
    };
    smooth_[m] = smooth_normals(scene.meshes[m], is_large, execution);
  }
}

TriangleSource::Placement TriangleSource::placement_of(const glm::dmat4& world_from_mesh) {
  // The cofactors are the inverse transpose times the determinant, and exist for singular matrices too.
  const glm::dmat3 m(world_from_mesh);
  const glm::dmat3 cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
  const bool is_mirrored = glm::dot(m[0], cofactors[0]) < 0;
  double size = 0;
  for (int k = 0; k < 9; ++k) size = std::max(size, std::abs(cofactors[k / 3][k % 3]));
  const double scale = (is_mirrored ? -1 : 1) / (size > 0 ? size : 1);
  return {glm::mat3(cofactors * scale), is_mirrored};
}

void TriangleSource::set_up(PrimitiveId id, const glm::vec2& reference, TriangleSetup& setup) const {
  const PrimitiveSource source = surfaces_.source(id);
  setup.instance = source.instance;
  setup.mesh = source.mesh;
  setup.triangle = source.triangle;
  setup.material = surfaces_.scene().meshes[source.mesh].material_of(source.triangle);
  set_up_plane(setup, rays_, surfaces_.corners(id), reference);
  if (placements_[source.instance].is_mirrored) setup.is_backside = !setup.is_backside;
  set_normals(id, setup);
  set_attributes(setup);
}

void TriangleSource::set_normals(PrimitiveId id, TriangleSetup& setup) const {
  const Mesh& mesh = surfaces_.scene().meshes[setup.mesh];
  if (lacks_normals(mesh) && !(large_ && large_->contains(id))) {
    setup.normal.fill(setup.plane_normal);
    setup.is_smooth = false;
    return;
  }
  const glm::mat3& normal_matrix = placements_[setup.instance].normal_matrix;
  glm::vec3 sum(0);
  for (std::size_t k = 0; k < 3; ++k) {
    const glm::vec3 own = lacks_normals(mesh) ? unpack(smooth_[setup.mesh][setup.triangle][k])
                                              : mesh.normals.values[mesh.corners(mesh.normals, setup.triangle)[int(k)]];
    setup.normal[k] = unit_or_zero(normal_matrix * own);
    sum += setup.normal[k];
  }
  // All three are turned together to the side that is seen, whatever the winding says; a single one may lean away.
  const bool turned = dot3(sum, setup.plane_normal) < 0;
  setup.is_smooth = false;
  for (glm::vec3& n : setup.normal) {
    if (turned) n = -n;
    if (n == glm::vec3(0)) n = setup.plane_normal;
    setup.is_smooth = setup.is_smooth || dot3(n, setup.plane_normal) < 0.99999f;
  }
}

void TriangleSource::set_attributes(TriangleSetup& setup) const {
  const Mesh& mesh = surfaces_.scene().meshes[setup.mesh];
  setup.has_texcoord = !mesh.texcoords.empty();
  setup.has_color = !mesh.colors.empty();
  for (int k = 0; k < 3; ++k) {
    const auto corner = std::size_t(k);
    setup.texcoord[corner] =
        setup.has_texcoord ? mesh.texcoords.values[mesh.corners(mesh.texcoords, setup.triangle)[k]] : glm::vec2(0);
    setup.color[corner] =
        setup.has_color ? mesh.colors.values[mesh.corners(mesh.colors, setup.triangle)[k]] : glm::vec4(1);
  }
}

namespace {

/// Where the point would lie on the curved surface that the corner normals suggest: the mean of its projections onto
/// the corners' tangent planes, taken only outwards. Shadows looked up there do not show the facets along the
/// terminator. (J. Hanika, Hacking the Shadow Terminator, in Ray Tracing Gems II, 2021.)
glm::vec3 lifted(const TriangleSetup& t, const glm::vec3& point, const glm::vec3& weight) {
  glm::vec3 lift(0);
  for (int k = 0; k < 3; ++k) {
    const auto corner = std::size_t(k);
    const float height = dot3(point - t.corner[corner], t.normal[corner]);
    if (height < 0) lift -= t.normal[corner] * (height * weight[k]);
  }
  return point + lift;
}

glm::vec3 towards_viewer(const ScreenRays& rays, const glm::vec3& point) {
  if (rays.is_parallel()) return glm::vec3(-rays.forward());
  const float length2 = dot3(point, point);
  return length2 > 1e-36f && length2 < 1e36f ? point * (-1.0f / std::sqrt(length2)) : unit_or_zero(-point);
}

void interpolate_texcoord(const TriangleSetup& t, const Barycentric& b, int i, Geometry& out) {
  const glm::vec2 texcoord = interpolate(t.texcoord, b.weight);
  const Gradient change = gradient(t, t.texcoord, texcoord, b);
  out.texcoord.set(i, texcoord);
  out.texcoord_dx.set(i, change.dx);
  out.texcoord_dy.set(i, change.dy);
}

void interpolate_one(const ScreenRays& rays, const TriangleSetup& t, const glm::vec2& screen, int i, Geometry& out) {
  const Barycentric b = barycentric(t, screen.x, screen.y);
  const glm::vec3 point = interpolate(t.corner, b.weight);
  out.position.set(i, point);
  out.plane_normal.set(i, t.plane_normal);
  out.to_viewer.set(i, towards_viewer(rays, point));
  if (t.is_smooth) {
    const glm::vec3 normal = interpolate(t.normal, b.weight);  // of unit vectors: shorter than one, never long
    const float length2 = dot3(normal, normal);
    out.normal.set(i, length2 > 1e-12f ? normal * (1.0f / std::sqrt(length2)) : t.plane_normal);
    out.smooth_position.set(i, lifted(t, point, b.weight));
  } else {
    out.normal.set(i, t.plane_normal);
    out.smooth_position.set(i, point);
  }
  if (t.has_texcoord) {
    interpolate_texcoord(t, b, i, out);
  } else {
    for (Lane2* lane : {&out.texcoord, &out.texcoord_dx, &out.texcoord_dy}) lane->set(i, glm::vec2(0));
  }
  const glm::vec4 color = t.has_color ? interpolate(t.color, b.weight) : glm::vec4(1);
  out.color.set(i, glm::vec3(color));
  out.alpha[i] = color.a;
}

}  // namespace

void interpolate_geometry(const ScreenRays& rays, const std::vector<TriangleSetup>& setups, Batch& batch) {
  const Coverage& coverage = batch.coverage;
  for (int i = 0; i < coverage.count; ++i)
    interpolate_one(rays, setups[coverage.triangle[i]], coverage.screen.at(i), i, batch.geometry);
}

}  // namespace frontmost::shading
