// SPDX-License-Identifier: Apache-2.0
// Contents of one model part of a 3MF file: objects, their colours, and the items to build.
//
//   build      item ----> object 7 (components)
//                            component ----> object 3 (mesh)      each with a transform
//                            component ----> object 3 again
//              item ----> object 3
//
//   triangle   property of a group, or the object's own            a material, or a colour for each corner
#pragma once

#include <array>
#include <map>
#include <optional>

#include "frontmost/scene.h"
#include "io/models/threemf/package.h"

namespace frontmost::threemf {

/// Colours or materials. Triangles refer to them by the group's number and an index in the group.
struct PropertyGroup {
  enum class Kind : std::uint8_t { materials, colors, unknown };
  Kind kind = Kind::unknown;
  std::string element;               ///< element name of unknown groups
  std::uint32_t first_material = 0;  ///< number in the scene, for groups of materials
  std::uint32_t count = 0;
  std::vector<glm::vec4> colors;  ///< linear, for groups of colours
};

/// Indices in a group: one for all corners, or one for each. no_index: none.
struct Property {
  std::uint32_t group = no_index;
  std::array<std::uint32_t, 3> corners{no_index, no_index, no_index};
};

/// An object with a transform: a component of another object, or an item to build.
struct PlacedObject {
  std::string part;  ///< empty: this part
  std::uint32_t object = 0;
  glm::dmat4 outer_from_object{1.0};
  std::size_t line = 0;
};

struct Object {
  std::string name;
  std::size_t line = 0;
  std::uint32_t mesh = no_index;              ///< number in the scene; none for objects of components
  Property property;                          ///< for triangles without one of their own
  std::vector<Property> triangle_properties;  ///< one a triangle, or none
  std::vector<PlacedObject> components;
};

struct ModelPart {
  std::string name;
  double metres_per_unit = 0.001;
  std::map<std::uint32_t, Object> objects;
  std::map<std::uint32_t, PropertyGroup> groups;
  std::vector<PlacedObject> items;
  std::vector<std::string> warnings;
};

/// Reads a model part. Adds its meshes, without their colours, and its materials to `scene`.
[[nodiscard]] ModelPart read_model_part(const std::string& name, Package& package, const ModelSource& source,
                                        Scene& scene);

/// White materials for triangles with their own colours, made at the first request.
class PlainMaterials {
 public:
  std::uint32_t get(bool is_see_through, Scene& scene);

 private:
  std::array<std::uint32_t, 2> numbers_{no_index, no_index};
};

/// Gives the meshes of a part the materials and colours that its triangles refer to. Missing ones cause a warning.
void apply_properties(const ModelPart& part, PlainMaterials& plain, Scene& scene);

}  // namespace frontmost::threemf
