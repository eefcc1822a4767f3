// SPDX-License-Identifier: Apache-2.0
#include "stream/kept_triangles.h"

namespace frontmost {

Excerpt::Excerpt() = default;
Excerpt::~Excerpt() = default;
Excerpt::Excerpt(Excerpt&&) noexcept = default;
Excerpt& Excerpt::operator=(Excerpt&&) noexcept = default;

const Surfaces& Excerpt::surfaces() const { return parts_->surfaces; }

Visible Excerpt::in_stream(Visible of_excerpt) const {
  for (PrimitiveId& id : of_excerpt.primitives)
    if (id != no_primitive) id = stream_ids[id];
  return of_excerpt;
}

namespace streaming {
namespace {

template <class T>
void append_corners(const Mesh& from, const Attribute<T>& attribute, std::uint32_t triangle, Attribute<T>& to) {
  if (attribute.empty()) return;
  const glm::uvec3& corners = from.corners(attribute, triangle);
  for (int k = 0; k < 3; ++k) to.values.push_back(attribute.values[corners[k]]);
}

template <class T>
void move_to(std::vector<T>& from, std::vector<T>& to) {
  to.insert(to.end(), from.begin(), from.end());
  std::vector<T>().swap(from);
}

/// Appends `part` to `whole`. Frees the memory of `part` list by list, because keeping both would take twice the
/// memory.
void move_mesh(Mesh& part, Mesh& whole) {
  const auto first = std::uint32_t(whole.positions.size());
  for (const glm::uvec3& t : part.triangles) whole.triangles.push_back(t + first);
  std::vector<glm::uvec3>().swap(part.triangles);
  move_to(part.positions, whole.positions);
  move_to(part.normals.values, whole.normals.values);
  move_to(part.texcoords.values, whole.texcoords.values);
  move_to(part.colors.values, whole.colors.values);
  move_to(part.material_ids, whole.material_ids);
}

}  // namespace

void append_triangle(const Mesh& from, std::uint32_t triangle, Mesh& to) {
  const auto first = std::uint32_t(to.positions.size());
  for (int k = 0; k < 3; ++k) to.positions.push_back(from.positions[from.triangles[triangle][k]]);
  append_corners(from, from.normals, triangle, to.normals);
  append_corners(from, from.texcoords, triangle, to.texcoords);
  append_corners(from, from.colors, triangle, to.colors);
  // One material per triangle, even where one for all would do: pieces of one mesh may differ.
  if (!from.material_ids.empty()) to.material_ids.push_back(from.material_of(triangle));
  to.triangles.emplace_back(first, first + 1, first + 2);
}

std::vector<PrimitiveId> ids_of(const KeptPieces& kept) {
  std::vector<PrimitiveId> ids;
  for (const auto& [number, piece] : kept)
    for (const std::uint32_t triangle : piece.triangles) ids.push_back(piece.place.first + triangle);
  return ids;
}

Scene scene_of(Scene frame, KeptPieces kept) {
  const auto mesh_of = [&](const Kept& piece) { return frame.instances[piece.place.object].mesh; };
  std::vector<std::size_t> counts(frame.meshes.size());
  for (const auto& [number, piece] : kept) counts[mesh_of(piece)] += piece.triangles.size();
  for (std::size_t i = 0; i < counts.size(); ++i) {
    // The frame's material ids are for whole meshes; each piece brings its own.
    frame.meshes[i].material_ids.clear();
    // Memory for all pieces is reserved, so that growing arrays are not moved.
    frame.meshes[i].positions.reserve(3 * counts[i]);
    frame.meshes[i].triangles.reserve(counts[i]);
  }
  for (auto& [number, piece] : kept) move_mesh(piece.mesh, frame.meshes[mesh_of(piece)]);
  return frame;
}

}  // namespace streaming
}  // namespace frontmost
