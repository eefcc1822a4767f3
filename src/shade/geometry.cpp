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
  setup.has_texcoord = has_texcoords_ && !mesh.texcoords.empty();
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

float at_least_zero(float value) { return value > 0.0f ? value : 0.0f; }  // 0 for NaN

/// Fragments of one triangle: all that belongs to the triangle is read once, and the loops over its fragments hold
/// nothing but arithmetic, so that the compiler takes several at a time.
class TriangleRun {
 public:
  TriangleRun(const TriangleSetup& triangle, int begin, int end) : t_(triangle), begin_(begin), end_(end) {}

  void find_weights(const Lane2& screen) {
    for (int i = begin_; i < end_; ++i) {
      const float dx = screen.x[i] - t_.reference.x, dy = screen.y[i] - t_.reference.y;
      const float a = at_least_zero(value(0, dx, dy)), b = at_least_zero(value(1, dx, dy));
      const float c = at_least_zero(value(2, dx, dy)), sum = a + b + c;
      const bool valid = sum > 1e-30f;
      const float scale = valid ? 1.0f / sum : 0.0f, rest = valid ? 0.0f : 1.0f / 3;
      weight_.x[i] = a * scale + rest;
      weight_.y[i] = b * scale + rest;
      weight_.z[i] = c * scale + rest;
      divisor_[i] = valid ? sum : 1.0f;
    }
  }

  void place(const ScreenRays& rays, Geometry& out) const {
    for (int k = 0; k < 3; ++k) mix(corner_values(t_.corner, k), lane(out.position, k));
    for (int k = 0; k < 3; ++k) fill(lane(out.plane_normal, k), t_.plane_normal[k]);
    if (rays.is_parallel()) {
      for (int k = 0; k < 3; ++k) fill(lane(out.to_viewer, k), float(-rays.forward()[k]));
    } else {
      const Lane3& p = out.position;
      for (int i = begin_; i < end_; ++i) {
        const float length2 = p.x[i] * p.x[i] + p.y[i] * p.y[i] + p.z[i] * p.z[i];
        const float scale = -1.0f / std::sqrt(length2 > 1e-36f ? length2 : 1e-36f);
        out.to_viewer.x[i] = p.x[i] * scale;
        out.to_viewer.y[i] = p.y[i] * scale;
        out.to_viewer.z[i] = p.z[i] * scale;
      }
    }
  }

  void find_normals(Geometry& out) const {
    for (int k = 0; k < 3; ++k) copy(lane(out.position, k), lane(out.smooth_position, k));
    if (!t_.is_smooth) {
      for (int k = 0; k < 3; ++k) fill(lane(out.normal, k), t_.plane_normal[k]);
      return;
    }
    for (int k = 0; k < 3; ++k) mix(corner_values(t_.normal, k), lane(out.normal, k));
    Lane3& n = out.normal;
    for (int i = begin_; i < end_; ++i) {
      // Of unit vectors: shorter than one, never long.
      const float length2 = n.x[i] * n.x[i] + n.y[i] * n.y[i] + n.z[i] * n.z[i];
      const bool valid = length2 > 1e-12f;
      const float scale = valid ? 1.0f / std::sqrt(length2) : 0.0f, rest = valid ? 0.0f : 1.0f;
      n.x[i] = n.x[i] * scale + t_.plane_normal.x * rest;
      n.y[i] = n.y[i] * scale + t_.plane_normal.y * rest;
      n.z[i] = n.z[i] * scale + t_.plane_normal.z * rest;
    }
    lift(0, weight_.x, out);
    lift(1, weight_.y, out);
    lift(2, weight_.z, out);
  }

  void find_texcoords(Geometry& out) const {
    if (!t_.has_texcoord) {
      for (Lane2* lanes : {&out.texcoord, &out.texcoord_dx, &out.texcoord_dy}) {
        fill(lanes->x, 0.0f);
        fill(lanes->y, 0.0f);
      }
      return;
    }
    for (int i = begin_; i < end_; ++i) {
      const Barycentric b{weight_.at(i), divisor_[i]};
      const glm::vec2 texcoord = interpolate(t_.texcoord, b.weight);
      const Gradient change = gradient(t_, t_.texcoord, texcoord, b);
      out.texcoord.set(i, texcoord);
      out.texcoord_dx.set(i, change.dx);
      out.texcoord_dy.set(i, change.dy);
    }
  }

  void find_colors(Geometry& out) const {
    Lane* lanes[4] = {&out.color.x, &out.color.y, &out.color.z, &out.alpha};
    for (int k = 0; k < 4; ++k) {
      if (t_.has_color) {
        mix(corner_values(t_.color, k), *lanes[k]);
      } else {
        fill(*lanes[k], 1.0f);
      }
    }
  }

 private:
  static Lane& lane(Lane3& lanes, int k) { return k == 0 ? lanes.x : k == 1 ? lanes.y : lanes.z; }

  [[nodiscard]] float value(std::size_t k, float dx, float dy) const {
    return t_.weight[k].at_reference + dx * t_.weight[k].step_x + dy * t_.weight[k].step_y;
  }
  template <class Vector>
  static glm::vec3 corner_values(const std::array<Vector, 3>& corner, int k) {
    return {corner[0][k], corner[1][k], corner[2][k]};
  }
  void mix(const glm::vec3& corner, Lane& out) const {
    for (int i = begin_; i < end_; ++i)
      out[i] = corner.x * weight_.x[i] + corner.y * weight_.y[i] + corner.z * weight_.z[i];
  }
  void fill(Lane& out, float value) const {
    for (int i = begin_; i < end_; ++i) out[i] = value;
  }
  void copy(const Lane& in, Lane& out) const {
    for (int i = begin_; i < end_; ++i) out[i] = in[i];
  }

  /// Towards where the point would lie on the curved surface that the corner normals suggest: the mean of its
  /// projections onto the corners' tangent planes, taken only outwards. Shadows looked up there do not show the facets
  /// along the terminator. (J. Hanika, Hacking the Shadow Terminator, in Ray Tracing Gems II, 2021.)
  void lift(std::size_t k, const Lane& weight, Geometry& out) const {
    const glm::vec3 corner = t_.corner[k], n = t_.normal[k];
    const Lane3& p = out.position;
    Lane3& lifted = out.smooth_position;
    for (int i = begin_; i < end_; ++i) {
      const float height = (p.x[i] - corner.x) * n.x + (p.y[i] - corner.y) * n.y + (p.z[i] - corner.z) * n.z;
      const float up = at_least_zero(-height) * weight[i];
      lifted.x[i] += n.x * up;
      lifted.y[i] += n.y * up;
      lifted.z[i] += n.z * up;
    }
  }

  const TriangleSetup& t_;
  int begin_, end_;
  Lane3 weight_;
  Lane divisor_;
};

}  // namespace

void interpolate_geometry(const ScreenRays& rays, const std::vector<TriangleSetup>& setups, Batch& batch) {
  const Coverage& coverage = batch.coverage;
  for (int begin = 0; begin < coverage.count;) {
    int end = begin + 1;
    while (end < coverage.count && coverage.triangle[end] == coverage.triangle[begin]) ++end;
    TriangleRun run(setups[coverage.triangle[begin]], begin, end);
    run.find_weights(coverage.screen);
    run.place(rays, batch.geometry);
    run.find_normals(batch.geometry);
    run.find_texcoords(batch.geometry);
    run.find_colors(batch.geometry);
    begin = end;
  }
}

}  // namespace frontmost::shading
