// SPDX-License-Identifier: Apache-2.0
// The contents of a scene file before any model is read. The file is JSON that places models:
//
//   {"up": "z", "metres_per_unit": 0.001,
//    "objects": [{"model": "cup.ply", "name": "left cup", "category": "cup", "pose": [16 numbers], "material": "red"},
//                {"model": "cup.ply", "translation": [80, 0, 0]}, ...],
//    "materials": {"red": {"color": "#c02010"}}}
//
// docs/formats.md documents all keys.
#pragma once

#include <map>

#include "io/models/reader.h"

namespace frontmost {

/// Replaces materials of a model by materials of SceneFile::materials.
struct Replacement {
  std::uint32_t of_all = no_index;             ///< replaces all materials; no_index: only those in `named` are replaced
  std::map<std::string, std::uint32_t> named;  ///< by the names of the model's materials
  // Compared without <=>, which std::map lacks in some standard libraries (WebAssembly).
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
  bool has_parts = false;  ///< whether the model's objects stay separate
};

struct SceneFile {
  std::optional<Axis> up;
  std::optional<double> metres_per_unit;
  std::vector<Category> categories;
  std::vector<Material> materials;
  std::vector<PlacedModel> objects;
};

/// Parses the text of a scene file. \throws Error file_malformed or limit_exceeded: "name: place: reason".
[[nodiscard]] SceneFile parse_scene_file(std::string_view text, const ModelSource& source);

/// Returns all objects of a model as one mesh, in their order, in the model's space: relative to its origin, rounded to
/// floats. If some meshes have normals, colours or texture coordinates, the others get the values that count as
/// missing. Preconditions: the model is valid and has no curved meshes. O(triangles).
[[nodiscard]] Mesh one_mesh(const Scene& model);

}  // namespace frontmost
