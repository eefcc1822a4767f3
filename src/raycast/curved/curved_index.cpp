// SPDX-License-Identifier: Apache-2.0
// The index of a scene with curved meshes: curved primitives in world space, each a leaf or several; and triangles.
//
//    ids       instance 0: 0 ... 11 | instance 1: 12 ... 2059 | ...     elements count over all instances in order
//    items     spheres in their places, then pieces of patches          the tree's numbers; pieces share ids
//
// Meshes without curves go into an index of triangles by themselves, and its answers are taken from triangle to
// element. So triangles are met by the kernels for triangles, and only what is curved pays for being curved.
#include <algorithm>
#include <tuple>

#include "base/parallel.h"
#include "raycast/curved/curved_parts.h"
#include "surfaces/material_sides.h"

namespace frontmost {

using namespace raycast_detail;

namespace {

Scene flat_part(const Scene& scene) {
  validate(scene);
  Scene flat;
  flat.name = scene.name;
  flat.instances = scene.instances;
  flat.meshes.resize(scene.meshes.size());
  flat.materials.resize(scene.materials.size());  // of which the sides alone count
  for (std::size_t i = 0; i < scene.materials.size(); ++i)
    flat.materials[i].double_sided = scene.materials[i].double_sided;
  for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
    if (scene.meshes[m].is_curved()) continue;
    flat.meshes[m].positions = scene.meshes[m].positions;
    flat.meshes[m].triangles = scene.meshes[m].triangles;
    flat.meshes[m].material_ids = scene.meshes[m].material_ids;
  }
  return flat;
}

std::uint64_t element_count_of(const Mesh& mesh) {
  return mesh.is_curved() ? mesh.curved_count() : mesh.triangles.size();
}

}  // namespace

CurvedParts::CurvedParts(const Scene& scene, const Execution& execution)
    : flat(flat_part(scene)), surfaces(flat, execution), triangles(surfaces, execution) {
  const IeeeScope ieee;
  place_all(scene);
  std::vector<DoubleBox> boxes;
  boxes.reserve(spheres.size() + pieces.size());
  for (const PlacedSphere& sphere : spheres) boxes.push_back(sphere.bounds());
  for (const PatchPiece& piece : pieces) boxes.push_back(piece.bounds());
  tree = DoubleBoxTree(boxes);
}

void CurvedParts::place_all(const Scene& scene) {
  std::uint64_t next = 0;
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    first_elements.push_back(PrimitiveId(next));
    meshes.push_back(instance.mesh);
    auto id = PrimitiveId(next);
    next += element_count_of(mesh);
    if (next > no_primitive - 1)
      throw Error(ErrorCode::limit_exceeded, scene.name + ": more than 4294967294 elements over all instances");
    const std::size_t first_sphere = spheres.size(), first_piece = pieces.size();
    for (const Sphere& sphere : mesh.spheres)
      if (auto placed = place(sphere, instance.world_from_mesh, id++)) spheres.push_back(*placed);
    for (const BezierPatch& patch : mesh.patches) cut(patch, instance.world_from_mesh, id++, pieces);
    const bool is_double = is_double_sided(scene, mesh.material_of(0));
    for (std::size_t i = first_sphere; i < spheres.size(); ++i) spheres[i].is_double_sided = is_double;
    for (std::size_t i = first_piece; i < pieces.size(); ++i) pieces[i].is_double_sided = is_double;
  }
  first_elements.push_back(PrimitiveId(next));
}

PrimitiveId CurvedParts::element_of(PrimitiveId triangle) const {
  const PrimitiveSource source = surfaces.source(triangle);
  return first_elements[source.instance] + source.triangle;
}

PrimitiveSource CurvedParts::source(PrimitiveId element) const {
  const auto after = std::upper_bound(first_elements.begin(), first_elements.end(), element);
  const auto instance = std::uint32_t(after - first_elements.begin() - 1);
  return {instance, meshes[instance], element - first_elements[instance]};
}

std::array<glm::vec3, 3> CurvedParts::corners_of(PrimitiveId element) const {
  const PrimitiveSource from = source(element);
  return surfaces.corners(surfaces.first_primitive(from.instance) + from.triangle);
}

bool NearestHit::keep(const RayMeeting& met, PrimitiveId id, std::uint32_t from_item, DoubleRay& ray) {
  if (met.t > ray.to) return false;
  if (hit && met.t == hit.t && std::tie(id, from_item) > std::tie(hit.primitive, item)) return false;
  hit = {id, met.t, glm::dot(met.normal, ray.direction) <= 0, met.parameters, met.normal};
  item = from_item;
  ray.to = met.t;
  return true;
}

std::optional<RayMeeting> CurvedParts::meet_item(std::uint32_t item, const DoubleRay& ray) const {
  return item < spheres.size() ? meet(spheres[item], ray) : meet(pieces[item - spheres.size()], ray);
}

CurvedHit CurvedParts::nearest(DoubleRay& ray) const {
  NearestHit best;
  if (ray.culling == Culling::both) return best.hit;
  tree.walk(ray, [&](std::uint32_t item) {
    if (const std::optional<RayMeeting> met = meet_item(item, ray)) best.keep(*met, id_of(item), item, ray);
  });
  return best.hit;
}

CurvedIndex::CurvedIndex(const Scene& scene, const Execution& execution)
    : parts_(std::make_unique<CurvedParts>(scene, execution)) {}
CurvedIndex::~CurvedIndex() = default;
CurvedIndex::CurvedIndex(CurvedIndex&&) noexcept = default;
CurvedIndex& CurvedIndex::operator=(CurvedIndex&&) noexcept = default;

std::uint32_t CurvedIndex::element_count() const { return parts_->first_elements.back(); }

PrimitiveSource CurvedIndex::source(PrimitiveId id) const { return parts_->source(id); }

std::size_t CurvedIndex::byte_count() const {
  const CurvedParts& p = *parts_;
  std::size_t flat = 0;
  for (const Mesh& mesh : p.flat.meshes)
    flat += mesh.positions.size() * sizeof(glm::vec3) + mesh.triangles.size() * sizeof(glm::uvec3);
  return flat + p.surfaces.byte_count() + p.triangles.byte_count() + p.tree.byte_count() +
         p.spheres.size() * sizeof(PlacedSphere) + p.pieces.size() * sizeof(PatchPiece) +
         p.first_elements.size() * (sizeof(PrimitiveId) + sizeof(std::uint32_t));
}

}  // namespace frontmost
