// SPDX-License-Identifier: Apache-2.0
// All faces of an OBJ file share the file's lists, but a mesh must own its values. Indices are those of the file during
// reading, and are renumbered at the end, in the order of first use, mesh by mesh. The table of new numbers is cleared
// only at used entries, because a file may have as many groups as faces.
#include "io/models/obj/obj_meshes.h"

namespace frontmost {
namespace {

/// Appends corner indices for the newest triangles. The list starts with the first face that has any.
template <class T>
void add_corners(Attribute<T>& attribute, std::span<const glm::uvec3> triangles,
                 const std::vector<std::uint32_t>& corners, std::size_t triangles_before) {
  if (attribute.triangles.empty()) {
    bool any = false;
    for (const std::uint32_t corner : corners) any |= corner != no_index;
    if (!any) return;
    attribute.triangles.resize(triangles_before, glm::uvec3(no_index));
  }
  for (const glm::uvec3& t : triangles) attribute.triangles.emplace_back(corners[t.x], corners[t.y], corners[t.z]);
}

/// Renumbers indices in the order of first use.
class Renumbering {
 public:
  explicit Renumbering(std::size_t count) : numbers_(count, no_index) {}

  /// Renumbers all corners except missing ones. \returns the old numbers in the new order, valid until the next call.
  const std::vector<std::uint32_t>& apply(std::vector<glm::uvec3>& triangles) {
    // Only used entries are cleared, because a file may have as many groups as faces.
    for (const std::uint32_t old : used_) numbers_[old] = no_index;
    used_.clear();
    for (glm::uvec3& t : triangles)
      for (int k = 0; k < 3; ++k)
        if (t[k] != no_index) t[k] = renumber(t[k]);
    return used_;
  }

 private:
  std::uint32_t renumber(std::uint32_t old) {
    if (numbers_[old] == no_index) {
      numbers_[old] = std::uint32_t(used_.size());
      used_.push_back(old);
    }
    return numbers_[old];
  }

  std::vector<std::uint32_t> numbers_, used_;
};

template <class T>
std::vector<T> gather(const std::vector<T>& pool, const std::vector<std::uint32_t>& numbers) {
  std::vector<T> values;
  values.reserve(numbers.size());
  for (const std::uint32_t number : numbers) values.push_back(pool[number]);
  return values;
}

/// Corners without a value get one that counts as missing. Indices that equal those of the positions need no list.
template <class T>
void complete(Attribute<T>& attribute, const Mesh& mesh) {
  if (attribute.triangles.empty()) {
    attribute.values = std::vector<T>();
    return;
  }
  const auto missing = std::uint32_t(attribute.values.size());
  bool any = false;
  for (glm::uvec3& t : attribute.triangles)
    for (int k = 0; k < 3; ++k)
      if (t[k] == no_index) t[k] = missing, any = true;
  if (any) attribute.values.push_back(T(0));
  if (attribute.values.size() >= mesh.positions.size() && attribute.triangles == mesh.triangles)
    attribute.triangles = std::vector<glm::uvec3>();
}

}  // namespace

void ObjMeshes::add(Mesh& mesh, const ObjFace& face) {
  const std::size_t before = mesh.triangles.size() - face.triangles.size();
  add_corners(mesh.texcoords, face.triangles, face.texcoords, before);
  add_corners(mesh.normals, face.triangles, face.normals, before);
  if (!face.triangles.empty()) add_material(mesh, before, face.material);
}

void ObjMeshes::add_material(Mesh& mesh, std::size_t before, std::uint32_t material) {
  if (before == 0) {
    mesh.material_ids.assign(1, material);
  } else if (!is_mixed_ && mesh.material_ids[0] != material) {
    mesh.material_ids.resize(before, mesh.material_ids[0]);
    is_mixed_ = true;
  }
  if (is_mixed_) mesh.material_ids.resize(mesh.triangles.size(), material);
}

void ObjMeshes::finish(Scene& scene, ObjPool pool) {
  // A single mesh keeps the file's own numbering, with unused vertices, so that vertex numbers are those of the file.
  if (scene.meshes.size() == 1) {
    Mesh& mesh = scene.meshes[0];
    mesh.positions = std::move(pool.positions);
    mesh.colors.values = std::move(pool.colors);
    mesh.texcoords.values = std::move(pool.texcoords);
    mesh.normals.values = std::move(pool.normals);
  } else {
    Renumbering positions(pool.positions.size()), texcoords(pool.texcoords.size()), normals(pool.normals.size());
    for (Mesh& mesh : scene.meshes) {
      const auto& used = positions.apply(mesh.triangles);
      mesh.positions = gather(pool.positions, used);
      if (!pool.colors.empty()) mesh.colors.values = gather(pool.colors, used);
      mesh.texcoords.values = gather(pool.texcoords, texcoords.apply(mesh.texcoords.triangles));
      mesh.normals.values = gather(pool.normals, normals.apply(mesh.normals.triangles));
    }
  }
  for (Mesh& mesh : scene.meshes) {
    // This step needs the final positions: their number decides whether a list of corners is needed.
    complete(mesh.texcoords, mesh);
    complete(mesh.normals, mesh);
    if (mesh.material_ids.size() == 1 && mesh.material_ids[0] == no_index) mesh.material_ids.clear();
  }
}

}  // namespace frontmost
