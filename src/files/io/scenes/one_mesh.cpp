// SPDX-License-Identifier: Apache-2.0
// Joins the objects of a model. Each object adds its transformed vertices, and its triangles with shifted indices:
//
//   positions   a b c d | e f g          triangles   0 1 2, 0 2 3 | 4 5 6
//
// Normals, colours and texture coordinates are joined likewise. Attributes stay indexed by vertex unless a mesh indexes
// them by corner. A mirrored object swaps the last two corners of its triangles, as elsewhere, to keep their outer
// side.
#include "io/scenes/one_mesh.h"

#include <algorithm>

namespace frontmost {
namespace {

/// An object of the model.
struct PartOfModel {
  const Mesh& mesh;
  glm::dmat4 model_from_mesh;
  bool is_mirrored;
};

std::vector<PartOfModel> parts_of(const Scene& model) {
  std::vector<PartOfModel> parts;
  for (const Instance& instance : model.instances)
    parts.push_back({model.meshes[instance.mesh], instance.world_from_mesh,
                     glm::determinant(glm::dmat3(instance.world_from_mesh)) < 0});
  return parts;
}

void append_triangles(const std::vector<glm::uvec3>& triangles, std::uint32_t first, bool is_mirrored,
                      std::vector<glm::uvec3>& all) {
  for (const glm::uvec3& t : triangles) all.push_back(is_mirrored ? glm::uvec3(t.x, t.z, t.y) + first : t + first);
}

/// Joins one attribute of all meshes. `find(mesh)` returns a pointer to the attribute or null, and `turn(value, part)`
/// transforms a value. A mesh without the attribute gets `missing`; the result is empty if no mesh has it.
template <class T, class Find, class Turn>
Attribute<T> joined(const std::vector<PartOfModel>& parts, const Find& find, const T& missing, const Turn& turn) {
  const auto has = [&](const PartOfModel& part) { return find(part.mesh) && !find(part.mesh)->empty(); };
  const bool is_by_corner = std::any_of(parts.begin(), parts.end(), [&](const PartOfModel& part) {
    return has(part) && !find(part.mesh)->triangles.empty();
  });
  Attribute<T> all;
  if (std::none_of(parts.begin(), parts.end(), has)) return all;
  for (const PartOfModel& part : parts) {
    const auto first = std::uint32_t(all.values.size());
    const Attribute<T>* const attribute = has(part) ? find(part.mesh) : nullptr;
    const bool is_by_vertex = !attribute || attribute->triangles.empty();
    const std::size_t count = is_by_vertex ? part.mesh.positions.size() : attribute->values.size();
    for (std::size_t i = 0; i < count; ++i)
      all.values.push_back(attribute ? turn(attribute->values[i], part) : missing);
    if (is_by_corner)
      append_triangles(is_by_vertex ? part.mesh.triangles : attribute->triangles, first, part.is_mirrored,
                       all.triangles);
  }
  return all;
}

Attribute<glm::vec3> joined_normals(const std::vector<PartOfModel>& parts) {
  const auto turned = [](const glm::vec3& normal, const PartOfModel& part) {
    // The matrix of cofactors is a multiple of the inverse transpose and also exists for singular matrices.
    const glm::dmat3 m(part.model_from_mesh);
    const glm::dvec3 n = glm::dmat3(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1])) *
                         glm::dvec3(normal) * (part.is_mirrored ? -1.0 : 1.0);
    const double length = glm::length(n);
    return length > 0 ? glm::vec3(n / length) : glm::vec3(0);
  };
  return joined(
      parts, [](const Mesh& mesh) { return &mesh.normals; }, glm::vec3(0), turned);
}

Attribute<glm::vec2> joined_texcoords(const std::vector<PartOfModel>& parts, std::uint32_t set) {
  return joined(
      parts, [&](const Mesh& mesh) { return mesh.texcoord_set(set); }, glm::vec2(0),
      [](const glm::vec2& value, const PartOfModel&) { return value; });
}

/// One material a triangle, or a single one if all are the same.
std::vector<std::uint32_t> joined_materials(const std::vector<PartOfModel>& parts) {
  std::vector<std::uint32_t> ids;
  for (const PartOfModel& part : parts)
    for (std::uint32_t t = 0; t < part.mesh.triangles.size(); ++t) ids.push_back(part.mesh.material_of(t));
  if (!ids.empty() && std::all_of(ids.begin(), ids.end(), [&](std::uint32_t id) { return id == ids[0]; }))
    ids.resize(1);
  return ids;
}

std::vector<std::uint32_t> joined_faces(const std::vector<PartOfModel>& parts) {
  std::vector<std::uint32_t> ids;
  if (std::all_of(parts.begin(), parts.end(), [](const PartOfModel& part) { return part.mesh.face_ids.empty(); }))
    return ids;
  std::uint32_t first = 0, next = 0;
  for (const PartOfModel& part : parts) {
    for (std::uint32_t t = 0; t < part.mesh.triangles.size(); ++t) {
      ids.push_back(first + part.mesh.face_of(t));
      next = std::max(next, ids.back() + 1);
    }
    first = next;
  }
  return ids;
}

}  // namespace

Mesh one_mesh(const Scene& model) {
  const std::vector<PartOfModel> parts = parts_of(model);
  Mesh all;
  all.name = model.name;
  all.origin = model.origin;
  for (const PartOfModel& part : parts) {
    append_triangles(part.mesh.triangles, std::uint32_t(all.positions.size()), part.is_mirrored, all.triangles);
    for (const glm::vec3& p : part.mesh.positions)
      all.positions.emplace_back(part.model_from_mesh * glm::dvec4(glm::dvec3(p), 1));
  }
  all.normals = joined_normals(parts);
  all.texcoords = joined_texcoords(parts, 0);
  for (std::uint32_t set = 1; set < max_texcoord_sets; ++set)
    if (Attribute<glm::vec2> further = joined_texcoords(parts, set); !further.empty()) {
      all.further_texcoords.resize(set);
      all.further_texcoords[set - 1] = std::move(further);
    }
  all.colors = joined(
      parts, [](const Mesh& mesh) { return &mesh.colors; }, glm::vec4(1),
      [](const glm::vec4& value, const PartOfModel&) { return value; });
  all.material_ids = joined_materials(parts);
  all.face_ids = joined_faces(parts);
  return all;
}

}  // namespace frontmost
