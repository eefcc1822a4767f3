// SPDX-License-Identifier: Apache-2.0
// 3MF: turns a zip archive of XML parts into a Scene. One part is the model; it may place objects of other parts.
//
//   package --> start part --> model parts, each read once --> items of the start part --> instances
//                                                              through components of components, each with a transform
//
// Base materials become materials of the scene. Colours become colours of corners, with a plain material, which blends
// if a colour is transparent.
//
// A component may name an object of another part, and a few components can stand for a million instances. So levels are
// limited, and instances are charged to a budget.
#include "io/models/threemf/threemf.h"

#include <algorithm>
#include <set>
#include <unordered_map>
#include <utility>

#include "base/parallel.h"
#include "io/models/mesh_building.h"

namespace frontmost {
namespace threemf {
namespace {

constexpr int most_component_levels = 64;

/// White materials for triangles with their own colours, made at the first request.
class PlainMaterials {
 public:
  std::uint32_t get(bool is_see_through, Scene& scene) {
    std::uint32_t& number = numbers_[is_see_through ? 1 : 0];
    if (number != no_index) return number;
    number = std::uint32_t(scene.materials.size());
    Material& material = scene.materials.emplace_back();
    material.name = is_see_through ? "colours, see-through" : "colours";
    if (is_see_through) material.alpha = Material::Alpha::blend;
    return number;
  }

 private:
  std::array<std::uint32_t, 2> numbers_{no_index, no_index};
};

/// Gives colours and materials to one mesh.
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
  /// Returns the group that a triangle's property names, or null with a warning if the part has no such group.
  const PropertyGroup* group_of(const Property& property, std::size_t triangle) {
    if (group_ == nullptr || property.group != group_number_) {
      const auto found = part_.groups.find(property.group);
      group_ = found == part_.groups.end() ? nullptr : &found->second;
      group_number_ = property.group;
    }
    if (group_ == nullptr) warn(triangle, "property group " + std::to_string(property.group) + " does not exist");
    return group_;
  }

  /// Warns once per part, because a file may hold millions of such triangles.
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

/// Gives the meshes of a part the materials and colours that its triangles refer to. Missing ones cause a warning.
void apply_properties(const ModelPart& part, PlainMaterials& plain, Scene& scene) {
  bool has_warned = false;
  for (const auto& [id, object] : part.objects)
    if (object.mesh != no_index) Painter(part, object, has_warned, plain, scene).paint();
  for (const auto& [id, group] : part.groups)
    if (group.kind == PropertyGroup::Kind::unknown)
      scene.warnings.push_back(printable(part.name) + ": group " + std::to_string(id) + ": colours of a " +
                               group.element + " are not read");
}

using ModelParts = std::map<std::string, ModelPart>;

/// Reads a part and all parts that it refers to, each once.
ModelParts read_parts(const std::string& start, Package& package, const ModelSource& source, Scene& scene) {
  ModelParts parts;
  PlainMaterials plain;
  std::vector<std::string> names{start};
  while (!names.empty()) {
    const std::string name = std::move(names.back());
    names.pop_back();
    if (parts.count(name) > 0) continue;
    ModelPart part = read_model_part(name, package, source, scene);
    scene.warnings.insert(scene.warnings.end(), part.warnings.begin(), part.warnings.end());
    apply_properties(part, plain, scene);
    for (auto& [id, object] : part.objects) {
      object.triangle_properties = {};
      for (const PlacedObject& component : object.components)
        if (!component.part.empty()) names.push_back(component.part);
    }
    for (const PlacedObject& item : part.items)
      if (!item.part.empty()) names.push_back(item.part);
    parts.emplace(name, std::move(part));
  }
  return parts;
}

/// Makes an instance of each built mesh, through all levels of components.
class ItemPlacer {
 public:
  ItemPlacer(const ModelParts& parts, const ModelPart& root, const Budget& budget, const ModelSource& source,
             Scene& scene)
      : parts_(parts), root_(root), budget_(budget), source_(source), scene_(scene) {}

  void place() {
    for (const PlacedObject& item : root_.items) place(root_, item, {glm::dmat4(1.0), "", 0});
    if (root_.items.empty()) place_unused();
  }

 private:
  /// State of the objects above the current one.
  struct Above {
    glm::dmat4 world_from_outer;
    std::string name;  ///< name of the nearest object with a name
    int level;
  };

  /// Places an object. `above` describes the object of `from` that holds `placed`.
  void place(const ModelPart& from, const PlacedObject& placed, const Above& above) {
    check_cancelled(source_.execution());
    const std::string place = printable(from.name) + ": line " + std::to_string(placed.line);
    if (above.level > most_component_levels)
      source_.fail_limit(place, "components within more than " + std::to_string(most_component_levels) +
                                    " others, or within themselves");
    // Objects of two components each, thirty levels deep, would make a thousand million instances.
    if (++visits_ > 4 * max_objects) source_.fail_limit(place, "too many components");
    const ModelPart& part = placed.part.empty() ? from : parts_.at(placed.part);
    const auto found = part.objects.find(placed.object);
    if (found == part.objects.end())
      source_.fail(place, "object " + std::to_string(placed.object) + " does not exist" +
                              (placed.part.empty() ? "" : " in " + printable(part.name)));
    const Object& object = found->second;
    Above here{above.world_from_outer * placed.outer_from_object, object.name.empty() ? above.name : object.name,
               above.level + 1};
    if (object.mesh != no_index) add_instance(*found, part.metres_per_unit, here, place);
    for (const PlacedObject& component : object.components) this->place(part, component, here);
  }

  void add_instance(const std::pair<const std::uint32_t, Object>& numbered, double metres_per_unit, const Above& here,
                    const std::string& place) {
    const auto& [id, object] = numbered;
    if (scene_.instances.size() >= max_objects) source_.fail_limit(place, "too many objects are built");
    budget_.charge_placed(scene_.meshes[object.mesh].triangles.size(), place, source_);
    budget_.charge(1, sizeof(Instance) + here.name.size(), place, source_);
    const double scale = metres_per_unit / root_.metres_per_unit;
    glm::dmat4 world_from_mesh = here.world_from_outer;
    if (scale != 1)
      for (int axis = 0; axis < 3; ++axis) world_from_mesh[axis] *= scale;
    world_from_mesh[3] = world_from_mesh * glm::dvec4(scene_.meshes[object.mesh].origin, 1);
    scene_.instances.push_back(
        {here.name.empty() ? "object " + std::to_string(id) : here.name, object.mesh, world_from_mesh});
  }

  /// Shows all objects that no other object holds, because the file builds nothing.
  void place_unused() {
    std::set<std::uint32_t> used;
    for (const auto& [id, object] : root_.objects)
      for (const PlacedObject& component : object.components)
        if (component.part.empty()) used.insert(component.object);
    for (const auto& [id, object] : root_.objects)
      if (used.count(id) == 0) place(root_, {"", id, glm::dmat4(1.0), object.line}, {glm::dmat4(1.0), "", 0});
    if (!root_.objects.empty())
      scene_.warnings.push_back(printable(root_.name) + ": the build list is empty, so all objects are shown");
  }

  const ModelParts& parts_;
  const ModelPart& root_;
  Budget budget_;
  const ModelSource& source_;
  Scene& scene_;
  std::uint64_t visits_ = 0;
};

}  // namespace
}  // namespace threemf

Scene read_3mf(Bytes bytes, const ModelSource& source) {
  threemf::Package package(bytes, source);
  Scene scene;
  const std::string start = threemf::find_start_part(package, source);
  const threemf::ModelParts parts = threemf::read_parts(start, package, source, scene);
  const threemf::ModelPart& root = parts.at(start);
  threemf::ItemPlacer(parts, root, Budget(bytes.size()), source, scene).place();
  scene.source.metres_per_unit = root.metres_per_unit;
  return scene;
}

}  // namespace frontmost
