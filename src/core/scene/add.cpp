// SPDX-License-Identifier: Apache-2.0
// Adds meshes and scenes to a scene: all numbers are counted on from the existing ones.
//
//   scene   meshes 0 1 2      materials 0 1          part   meshes 0 1 -> 3 4      materials 0 -> 2
//           instances name meshes, meshes name materials, materials name textures: all by the new numbers
#include <algorithm>
#include <iterator>

#include "frontmost/scene.h"

namespace frontmost {
namespace {

void shift(std::uint32_t& number, std::size_t by) {
  if (number != no_index) number += std::uint32_t(by);
}

template <class T>
void move_all(std::vector<T>& from, std::vector<T>& to) {
  to.insert(to.end(), std::make_move_iterator(from.begin()), std::make_move_iterator(from.end()));
}

/// The number of a category in the scene; adds the category if it is new.
std::uint32_t number_of(const Category& category, std::vector<Category>& categories) {
  const auto found = std::find_if(categories.begin(), categories.end(), [&](const Category& there) {
    return there.name == category.name && there.number == category.number;
  });
  const auto number = std::uint32_t(found - categories.begin());
  if (found == categories.end()) categories.push_back(category);
  return number;
}

void merge_categories(Scene& part, std::vector<Category>& categories) {
  std::vector<std::uint32_t> numbers;
  for (const Category& category : part.categories) numbers.push_back(number_of(category, categories));
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
