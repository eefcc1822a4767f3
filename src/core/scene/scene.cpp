// SPDX-License-Identifier: Apache-2.0
// Checks the guarantees of a valid scene: lists match each other, and numbers refer to things that exist. Also adds to
// scenes; the numbers of the added things continue the existing ones.
//
// validate() stands between readers (and callers who make scenes by hand) and all other code. Errors name the mesh and
// the triangle, as a file may have millions of triangles.
#include "frontmost/scene.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "scene/validate.h"

namespace frontmost {
std::string place_in(const Scene& scene) { return scene.name.empty() ? "" : scene.name + ": "; }

namespace {

[[noreturn]] void fail(const Scene& scene, const std::string& what, const std::string& reason) {
  throw Error(ErrorCode::file_malformed, place_in(scene) + what, reason);
}

/// "mesh 3 (lid)".
std::string numbered(const char* kind, std::size_t number, const std::string& name) {
  return std::string(kind) + " " + std::to_string(number) + (name.empty() ? "" : " (" + name + ")");
}

[[noreturn]] void fail(const Scene& scene, std::size_t mesh, const std::string& reason) {
  fail(scene, numbered("mesh", mesh, scene.meshes[mesh].name), reason);
}

void check_corners(const Scene& scene, std::size_t mesh, const std::vector<glm::uvec3>& triangles, std::size_t count,
                   const char* what) {
  // One pass without branches finds whether there is an error; a second pass finds where.
  if (triangles.empty()) return;
  std::uint32_t greatest = 0;
  const std::uint32_t* numbers = &triangles.front().x;
  for (std::size_t i = 0; i < 3 * triangles.size(); ++i) greatest = std::max(greatest, numbers[i]);
  if (greatest < count) return;
  for (std::size_t i = 0; i < triangles.size(); ++i)
    for (int k = 0; k < 3; ++k)
      if (triangles[i][k] >= count)
        fail(scene, mesh,
             "triangle " + std::to_string(i) + ": " + what + " " + std::to_string(triangles[i][k]) +
                 " is out of range, there are " + std::to_string(count));
}

template <class T>
void check_attribute(const Scene& scene, std::size_t m, const Attribute<T>& attribute, const char* what) {
  if (attribute.empty()) return;
  const Mesh& mesh = scene.meshes[m];
  if (attribute.triangles.empty()) {
    if (attribute.values.size() < mesh.positions.size())
      fail(scene, m, std::string("fewer ") + what + "s than positions");
  } else {
    if (attribute.triangles.size() != mesh.triangles.size())
      fail(scene, m, std::string("corners of ") + what + "s do not match the triangles");
    check_corners(scene, m, attribute.triangles, attribute.values.size(), what);
  }
}

void check_edges(const Scene& scene, std::size_t m) {
  const Mesh& mesh = scene.meshes[m];
  for (const std::vector<glm::uvec2>* edges : {&mesh.sharp_edges, &mesh.smooth_edges})
    for (std::size_t i = 0; i < edges->size(); ++i)
      if (const glm::uvec2& edge = (*edges)[i]; std::max(edge.x, edge.y) >= mesh.positions.size())
        fail(scene, m,
             "edge " + std::to_string(i) + ": vertex " + std::to_string(std::max(edge.x, edge.y)) +
                 " is out of range, there are " + std::to_string(mesh.positions.size()));
  std::size_t end = 0;  // of the ranges so far
  for (std::size_t i = 0; i < mesh.edge_circles.size(); ++i) {
    const EdgeCircle& circle = mesh.edge_circles[i];
    const double length = glm::length(circle.axis);
    if (!is_finite(circle.centre) || !(std::abs(length - 1) < 1e-6) || !std::isfinite(circle.radius) ||
        circle.radius <= 0)
      fail(scene, m, "circle " + std::to_string(i) + " has no place, no radius or no axis of unit length");
    if (circle.first > mesh.sharp_edges.size() || circle.count > mesh.sharp_edges.size() - circle.first)
      fail(scene, m, "circle " + std::to_string(i) + " names edges that do not exist");
    if (circle.first < end) fail(scene, m, "circle " + std::to_string(i) + " names edges of an earlier circle");
    end = std::size_t(circle.first) + circle.count;
  }
}

void check_mesh(const Scene& scene, std::size_t m) {
  const Mesh& mesh = scene.meshes[m];
  check_attribute(scene, m, mesh.normals, "normal");
  check_attribute(scene, m, mesh.texcoords, "texture coordinate");
  for (const Attribute<glm::vec2>& set : mesh.further_texcoords)
    check_attribute(scene, m, set, "further texture coordinate");
  if (mesh.further_texcoords.size() >= max_texcoord_sets)
    fail(scene, m, "more than " + std::to_string(max_texcoord_sets) + " sets of texture coordinates");
  check_attribute(scene, m, mesh.colors, "colour");
  if (mesh.material_ids.size() > 1 && mesh.material_ids.size() != mesh.triangles.size())
    fail(scene, m, "material ids do not match the triangles");
  for (const std::uint32_t id : mesh.material_ids)
    if (id != no_index && id >= scene.materials.size())
      fail(scene, m, "material " + std::to_string(id) + " does not exist");
  if (!mesh.face_ids.empty() && mesh.face_ids.size() != mesh.triangles.size())
    fail(scene, m, "face ids do not match the triangles");
  check_edges(scene, m);
  if (mesh.is_curved() && mesh.material_ids.size() > 1) fail(scene, m, "a curved mesh has more than one material");
}

void check_use(const Scene& scene, const Material& material, const TextureUse& use) {
  if (!use.is_set()) return;
  const std::string who = "material " + material.name;
  if (use.texture >= scene.textures.size())
    fail(scene, who, "texture " + std::to_string(use.texture) + " does not exist");
  if (use.set >= max_texcoord_sets)
    fail(scene, who,
         "texture coordinates " + std::to_string(use.set) + ", there are at most " + std::to_string(max_texcoord_sets) +
             " sets");
}

void check_instances(const Scene& scene) {
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const auto refuse = [&](const char* what, std::uint32_t number) {
      fail(scene, numbered("instance", i, ""), std::string(what) + " " + std::to_string(number) + " does not exist");
    };
    const Instance& instance = scene.instances[i];
    if (instance.mesh >= scene.meshes.size()) refuse("mesh", instance.mesh);
    if (instance.category != no_index && instance.category >= scene.categories.size())
      refuse("category", instance.category);
  }
}

bool is_positive_and_finite(double value) { return value > 0 && std::isfinite(value); }

/// Whether the matrix only rotates and translates.
bool is_rigid(const glm::dmat4& m) {
  constexpr double tolerance = 1e-6;
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k)
      if (!(std::abs(glm::dot(glm::dvec3(m[i]), glm::dvec3(m[k])) - (i == k ? 1 : 0)) < tolerance)) return false;
  return std::isfinite(m[3].x) && std::isfinite(m[3].y) && std::isfinite(m[3].z);
}

/// The fault of a light, or null.
const char* fault_of(const Light& light) {
  if (!(light.intensity >= 0 && std::isfinite(light.intensity))) return "its intensity is not a number of at least 0";
  for (int k = 0; k < 3; ++k)
    if (!(light.color[k] >= 0 && std::isfinite(light.color[k]))) return "its colour is not three numbers of at least 0";
  if (light.range && !is_positive_and_finite(*light.range)) return "its range is not a positive number";
  if (!(light.inner_cone >= 0 && light.inner_cone <= light.outer_cone && light.outer_cone > 0 &&
        light.outer_cone <= 0.5 * std::numbers::pi))
    return "its cone angles are not between 0 and 90 degrees, or the inner one is greater than the outer one";
  if (!is_rigid(light.world_from_light)) return "its placement is not rigid";
  return nullptr;
}

void check_lights(const Scene& scene) {
  for (std::size_t i = 0; i < scene.lights.size(); ++i)
    if (const char* fault = fault_of(scene.lights[i])) fail(scene, numbered("light", i, scene.lights[i].name), fault);
}

}  // namespace

glm::dvec3 direction(Axis axis) {
  switch (axis) {
    case Axis::x: return {1, 0, 0};
    case Axis::y: return {0, 1, 0};
    case Axis::z: return {0, 0, 1};
    case Axis::minus_x: return {-1, 0, 0};
    case Axis::minus_y: return {0, -1, 0};
    case Axis::minus_z: return {0, 0, -1};
  }
  return {0, 1, 0};
}

std::uint64_t triangle_count(const Scene& scene) {
  std::uint64_t count = 0;
  for (const Instance& instance : scene.instances)
    if (instance.mesh < scene.meshes.size()) count += scene.meshes[instance.mesh].triangles.size();
  return count;
}

void validate(const Scene& scene) {
  for (std::size_t m = 0; m < scene.meshes.size(); ++m)
    check_corners(scene, m, scene.meshes[m].triangles, scene.meshes[m].positions.size(), "vertex");
  validate_besides_vertices(scene);
}

void validate_besides_vertices(const Scene& scene) {
  for (std::size_t m = 0; m < scene.meshes.size(); ++m) check_mesh(scene, m);
  for (const Material& material : scene.materials)
    for (const TextureUse* use : texture_uses_of(material)) check_use(scene, material, *use);
  for (const Texture& texture : scene.textures)
    if (texture.width < 0 || texture.height < 0 ||
        texture.pixels.size() != std::size_t(texture.width) * std::size_t(texture.height))
      fail(scene, "texture " + texture.name, "pixels do not match its size");
  check_instances(scene);
  check_lights(scene);
  // The greatest id stands for "nothing seen", so there is one id fewer than there are numbers.
  if (triangle_count(scene) > no_primitive - 1)
    throw Error(ErrorCode::limit_exceeded, scene.name, "more than 4294967294 triangles over all instances");
}

namespace {

void shift(std::uint32_t& number, std::size_t by) {
  if (number != no_index) number += std::uint32_t(by);
}

template <class T>
void move_all(std::vector<T>& from, std::vector<T>& to) {
  to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
}

/// Adds the categories that are new, and numbers those of the part's instances by the whole list.
void merge_categories(Scene& part, std::vector<Category>& categories) {
  std::vector<std::uint32_t> numbers;
  for (const Category& category : part.categories) {
    const auto found = std::find_if(categories.begin(), categories.end(), [&](const Category& there) {
      return there.name == category.name && there.number == category.number;
    });
    numbers.push_back(std::uint32_t(found - categories.begin()));
    if (found == categories.end()) categories.push_back(category);
  }
  for (Instance& instance : part.instances)
    if (instance.category < numbers.size()) instance.category = numbers[instance.category];
}

}  // namespace

std::uint32_t add(Scene& scene, Mesh mesh, const glm::dmat4& world_from_mesh) {
  scene.instances.push_back({mesh.name, std::uint32_t(scene.meshes.size()), world_from_mesh});
  scene.meshes.push_back(std::move(mesh));
  return std::uint32_t(scene.instances.size() - 1);
}

void add(Scene& scene, Scene part) {
  if (scene.instances.empty() && scene.cameras.empty() && scene.lights.empty()) {
    scene.origin = part.origin;
    scene.source.format = part.source.format;
    scene.source.metres_per_unit = part.source.metres_per_unit;
  }
  set_origin(part, scene.origin);
  // Everything is renumbered before anything is moved: the current counts are the offsets.
  for (Mesh& mesh : part.meshes)
    for (std::uint32_t& material : mesh.material_ids) shift(material, scene.materials.size());
  for (Instance& instance : part.instances) instance.mesh += std::uint32_t(scene.meshes.size());
  for (Material& m : part.materials)
    for (TextureUse* use : texture_uses_of(m)) shift(use->texture, scene.textures.size());
  merge_categories(part, scene.categories);
  move_all(part.meshes, scene.meshes);
  move_all(part.instances, scene.instances);
  move_all(part.materials, scene.materials);
  move_all(part.textures, scene.textures);
  move_all(part.cameras, scene.cameras);
  move_all(part.lights, scene.lights);
  move_all(part.warnings, scene.warnings);
  move_all(part.source.files, scene.source.files);
  move_all(part.source.hidden, scene.source.hidden);
}

}  // namespace frontmost
