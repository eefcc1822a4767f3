// SPDX-License-Identifier: Apache-2.0
// Materials and colours of triangles. Base materials become materials of the scene; colours become colours of corners,
// with a plain material.
//
// A triangle names a group and one property for all corners, or one for each. A triangle without any has its object's.
// If a colour is transparent, the plain material blends.
#include <algorithm>
#include <unordered_map>
#include <utility>

#include "io/models/model_source.h"
#include "io/models/threemf/model.h"

namespace frontmost::threemf {
namespace {

/// Colours one mesh.
class Painter {
 public:
  Painter(const ModelPart& part, const Object& object, bool& has_warned, PlainMaterials& plain, Scene& scene)
      : part_(part),
        object_(object),
        has_warned_(has_warned),
        plain_(plain),
        scene_(scene),
        mesh_(scene.meshes[object.mesh]) {}

  void paint() {
    const std::size_t count = mesh_.triangles.size();
    for (std::size_t t = 0; t < count; ++t) {
      const Property& property =
          object_.triangle_properties.empty() ? object_.property : object_.triangle_properties[t];
      if (property.group == no_index) continue;
      const PropertyGroup* const group = group_of(property, t);
      if (group == nullptr || group->kind == PropertyGroup::Kind::unknown || property.corners[0] == no_index) continue;
      if (const std::uint32_t most = *std::max_element(property.corners.begin(), property.corners.end());
          most >= group->count)
        warn(t, "property " + std::to_string(most) + " does not exist, group " + std::to_string(property.group) +
                    " has " + std::to_string(group->count));
      else if (group->kind == PropertyGroup::Kind::materials)
        set_material(t, group->first_material + property.corners[0]);
      else
        set_colors(t, property, *group);
    }
  }

 private:
  /// \returns null if the part has no such group.
  const PropertyGroup* group_of(const Property& property, std::size_t triangle) {
    if (group_ == nullptr || property.group != group_number_) {
      const auto found = part_.groups.find(property.group);
      group_ = found == part_.groups.end() ? nullptr : &found->second;
      group_number_ = property.group;
    }
    if (group_ == nullptr) warn(triangle, "property group " + std::to_string(property.group) + " does not exist");
    return group_;
  }

  /// Warns once a part, because a file may hold millions of such triangles.
  void warn(std::size_t triangle, const std::string& reason) {
    if (std::exchange(has_warned_, true)) return;
    scene_.warnings.push_back(printable(part_.name) + ": line " + std::to_string(object_.line) + ": triangle " +
                              std::to_string(triangle) + " of the object: " + reason);
  }

  void set_material(std::size_t triangle, std::uint32_t material) {
    if (mesh_.material_ids.empty()) mesh_.material_ids.resize(mesh_.triangles.size(), no_index);
    mesh_.material_ids[triangle] = material;
  }

  void set_colors(std::size_t triangle, const Property& property, const PropertyGroup& group) {
    if (mesh_.colors.empty()) {
      mesh_.colors.values = {glm::vec4(1)};
      mesh_.colors.triangles.resize(mesh_.triangles.size(), glm::uvec3(0));
    }
    bool is_see_through = false;
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t number = property.corners[std::size_t(k)];
      is_see_through = is_see_through || group.colors[number].a < 1;
      // Many meshes may share a large group, so each mesh stores only the colours that it uses.
      const std::uint64_t key = std::uint64_t(property.group) << 32 | number;
      const auto [value, is_new] = values_.try_emplace(key, std::uint32_t(mesh_.colors.values.size()));
      if (is_new) mesh_.colors.values.push_back(group.colors[number]);
      mesh_.colors.triangles[triangle][k] = value->second;
    }
    set_material(triangle, plain_.get(is_see_through, scene_));
  }

  const ModelPart& part_;
  const Object& object_;
  bool& has_warned_;
  PlainMaterials& plain_;
  Scene& scene_;
  Mesh& mesh_;
  const PropertyGroup* group_ = nullptr;  ///< the group of the last look-up
  std::uint32_t group_number_ = no_index;
  std::unordered_map<std::uint64_t, std::uint32_t> values_;  ///< numbers of the mesh's colours, by group and index
};

}  // namespace

std::uint32_t PlainMaterials::get(bool is_see_through, Scene& scene) {
  std::uint32_t& number = numbers_[is_see_through ? 1 : 0];
  if (number != no_index) return number;
  number = std::uint32_t(scene.materials.size());
  Material& material = scene.materials.emplace_back();
  material.name = is_see_through ? "colours, see-through" : "colours";
  if (is_see_through) material.alpha = Material::Alpha::blend;
  return number;
}

void apply_properties(const ModelPart& part, PlainMaterials& plain, Scene& scene) {
  bool has_warned = false;
  for (const auto& [id, object] : part.objects)
    if (object.mesh != no_index) Painter(part, object, has_warned, plain, scene).paint();
  for (const auto& [id, group] : part.groups)
    if (group.kind == PropertyGroup::Kind::unknown)
      scene.warnings.push_back(printable(part.name) + ": group " + std::to_string(id) + ": colours of a " +
                               group.element + " are not read");
}

}  // namespace frontmost::threemf
