// SPDX-License-Identifier: Apache-2.0
// Contents of a scene file before any model is read. The file is JSON that places models:
//
//   {"up": "z", "metres_per_unit": 0.001,
//    "objects": [{"model": "cup.ply", "name": "left cup", "category": "cup", "pose": [16 numbers], "material": "red"},
//                {"model": "cup.ply", "translation": [80, 0, 0]}, ...],
//    "materials": {"red": {"color": "#c02010"}}}
//
// docs/formats.md documents all keys.
#pragma once

#include <map>

#include "io/models/gltf/json.h"
#include "io/models/reader.h"

namespace frontmost {

/// Replaces materials of a model by materials of SceneFile::materials.
struct Replacement {
  std::uint32_t of_all = no_index;             ///< no_index: only the materials in `named` are replaced
  std::map<std::string, std::uint32_t> named;  ///< by the names of the model's materials
  [[nodiscard]] bool is_none() const { return of_all == no_index && named.empty(); }
  // Compared without <=>, which std::map lacks in some standard libraries (WebAssembly).
  friend bool operator==(const Replacement& a, const Replacement& b) {
    return a.of_all == b.of_all && a.named == b.named;
  }
  friend bool operator<(const Replacement& a, const Replacement& b) {
    return a.of_all != b.of_all ? a.of_all < b.of_all : a.named < b.named;
  }
};

/// One of the objects of a scene file.
struct PlacedModel {
  std::string place;  ///< place in the file, for messages: "objects[3]"
  std::string model;  ///< as the file names it
  std::string name;   ///< empty: the model's own name
  std::uint32_t category = no_index;
  glm::dmat4 scene_from_model{1.0};
  std::optional<Axis> up;                 ///< up axis of the model, which is turned to that of the scene
  std::optional<double> metres_per_unit;  ///< unit of the model; overrides the model's file
  Replacement replacement;
  bool has_parts = false;  ///< the model's objects stay separate
};

struct SceneFile {
  std::optional<Axis> up;
  std::optional<double> metres_per_unit;
  std::vector<Category> categories;
  std::vector<Material> materials;
  std::vector<PlacedModel> objects;
};

/// \throws Error file_malformed or limit_exceeded: "name: place: reason".
[[nodiscard]] SceneFile parse_scene_file(std::string_view text, const ModelSource& source);

// Parsers for parts of a scene file.

/// The pose of an object by "pose", or by "translation", "rotation" and "scale"; the identity if all are absent.
[[nodiscard]] glm::dmat4 read_pose(const gltf::JsonValue& object);
[[nodiscard]] Material read_look(const gltf::JsonValue& material, const std::string& name);

/// Refuses objects with a repeated key, of which a JSON library silently keeps only the last value.
void refuse_repeated_keys(std::string_view text, const ModelSource& source);
/// Refuses unknown keys.
void check_keys(const gltf::JsonValue& object, std::initializer_list<std::string_view> known);
[[nodiscard]] bool has(const gltf::JsonValue& object, const char* key);

}  // namespace frontmost
