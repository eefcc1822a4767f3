// SPDX-License-Identifier: Apache-2.0
// 3MF: turns a zip archive of XML parts into a Scene. One part is the model; it may place objects of other parts.
//
//   package --> start part --> model parts, each read once --> items of the start part --> instances
//                                                              through components of components, each with a transform
//
// A component may name an object of another part, and a few components can stand for a million instances. So levels are
// limited, and instances are charged to a budget.
#include <set>

#include "base/parallel.h"
#include "io/models/budget.h"
#include "io/models/mesh_building.h"
#include "io/models/model_source.h"
#include "io/models/reader.h"
#include "io/models/threemf/model.h"
#include "io/models/threemf/package.h"

namespace frontmost {
namespace threemf {
namespace {

constexpr int most_component_levels = 64;

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
    std::string name;  ///< of the nearest object with a name
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
    // Triangles are charged although they take no memory here: code that transforms them to world space needs ten times
    // as much.
    constexpr std::uint64_t least_cost = 4;
    budget_.charge(scene_.meshes[object.mesh].triangles.size(), least_cost, place, source_);
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
      scene_.warnings.push_back(printable(root_.name) + ": nothing is built, all objects are shown");
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
