// SPDX-License-Identifier: Apache-2.0
// Turns a scene file into a scene. Models are read one after the other, each once, and a model's meshes serve all
// objects that use it:
//
//   objects   cup  plate  cup  cup in red          models   cup --> mesh 0 (twice), mesh 1 (with other materials)
//                                                           plate --> mesh 2
//
// So objects share meshes, and only one model is in memory at a time beside the result.
#include <algorithm>
#include <iterator>

#include "io/models/mesh_building.h"
#include "io/scenes/scene_file.h"
#include "scene/edges.h"

namespace frontmost {
namespace {

/// An object of the model.
struct PartOfModel {
  const Mesh& mesh;
  glm::dmat4 model_from_mesh;
  bool is_mirrored;
};

std::vector<PartOfModel> parts_of(const Scene& model) {
  std::vector<PartOfModel> parts;
  for (const Instance& instance : model.instances)
    parts.push_back({model.meshes[instance.mesh], instance.world_from_mesh,
                     glm::determinant(glm::dmat3(instance.world_from_mesh)) < 0});
  return parts;
}

void append_triangles(const std::vector<glm::uvec3>& triangles, std::uint32_t first, bool is_mirrored,
                      std::vector<glm::uvec3>& all) {
  for (const glm::uvec3& t : triangles) all.push_back(is_mirrored ? glm::uvec3(t.x, t.z, t.y) + first : t + first);
}

/// Joins one attribute of all meshes. `find(mesh)` returns a pointer to the attribute or null, and `turn(value, part)`
/// transforms a value. A mesh without the attribute gets `missing`; the result is empty if no mesh has it.
template <class T, class Find, class Turn>
Attribute<T> joined(const std::vector<PartOfModel>& parts, const Find& find, const T& missing, const Turn& turn) {
  const auto has = [&](const PartOfModel& part) { return find(part.mesh) && !find(part.mesh)->empty(); };
  const bool is_by_corner = std::any_of(parts.begin(), parts.end(), [&](const PartOfModel& part) {
    return has(part) && !find(part.mesh)->triangles.empty();
  });
  Attribute<T> all;
  if (std::none_of(parts.begin(), parts.end(), has)) return all;
  for (const PartOfModel& part : parts) {
    const auto first = std::uint32_t(all.values.size());
    const Attribute<T>* const attribute = has(part) ? find(part.mesh) : nullptr;
    const bool is_by_vertex = !attribute || attribute->triangles.empty();
    const std::size_t count = is_by_vertex ? part.mesh.positions.size() : attribute->values.size();
    for (std::size_t i = 0; i < count; ++i)
      all.values.push_back(attribute ? turn(attribute->values[i], part) : missing);
    if (is_by_corner)
      append_triangles(is_by_vertex ? part.mesh.triangles : attribute->triangles, first, part.is_mirrored,
                       all.triangles);
  }
  return all;
}

Attribute<glm::vec3> joined_normals(const std::vector<PartOfModel>& parts) {
  const auto turned = [](const glm::vec3& normal, const PartOfModel& part) {
    // The matrix of cofactors is a multiple of the inverse transpose and also exists for singular matrices.
    const glm::dmat3 m(part.model_from_mesh);
    const glm::dvec3 n = glm::dmat3(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1])) *
                         glm::dvec3(normal) * (part.is_mirrored ? -1.0 : 1.0);
    const double length = glm::length(n);
    return length > 0 ? glm::vec3(n / length) : glm::vec3(0);
  };
  return joined(
      parts, [](const Mesh& mesh) { return &mesh.normals; }, glm::vec3(0), turned);
}

Attribute<glm::vec2> joined_texcoords(const std::vector<PartOfModel>& parts, std::uint32_t set) {
  return joined(
      parts, [&](const Mesh& mesh) { return mesh.texcoord_set(set); }, glm::vec2(0),
      [](const glm::vec2& value, const PartOfModel&) { return value; });
}

/// Returns one material per triangle, or a single one if all are the same.
std::vector<std::uint32_t> joined_materials(const std::vector<PartOfModel>& parts) {
  std::vector<std::uint32_t> ids;
  for (const PartOfModel& part : parts)
    for (std::uint32_t t = 0; t < part.mesh.triangles.size(); ++t) ids.push_back(part.mesh.material_of(t));
  if (!ids.empty() && std::all_of(ids.begin(), ids.end(), [&](std::uint32_t id) { return id == ids[0]; }))
    ids.resize(1);
  return ids;
}

std::vector<std::uint32_t> joined_faces(const std::vector<PartOfModel>& parts) {
  std::vector<std::uint32_t> ids;
  if (std::all_of(parts.begin(), parts.end(), [](const PartOfModel& part) { return part.mesh.face_ids.empty(); }))
    return ids;
  std::uint32_t first = 0, next = 0;
  for (const PartOfModel& part : parts) {
    for (std::uint32_t t = 0; t < part.mesh.triangles.size(); ++t) {
      ids.push_back(first + part.mesh.face_of(t));
      next = std::max(next, ids.back() + 1);
    }
    first = next;
  }
  return ids;
}

/// Returns the smallest rotation that turns one axis to another. A half turn is about x, or about y if both axes lie
/// along x.
glm::dmat4 turn_between(Axis from, Axis to) {
  const glm::dvec3 a = direction(from), b = direction(to), c = glm::cross(a, b);
  if (a == b) return glm::dmat4(1.0);
  if (a == -b) {
    const glm::dvec3 about = a.x == 0 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    glm::dmat4 half(1.0);
    for (int i = 0; i < 3; ++i) half[i][i] = about[i] == 0 ? -1 : 1;
    return half;
  }
  // The rotation turns a to b and b to -a, and keeps c.
  return glm::dmat4(glm::outerProduct(b, a) - glm::outerProduct(a, b) + glm::outerProduct(c, c));
}

template <class T>
std::uint64_t bytes_of(const Attribute<T>& attribute) {
  return attribute.values.size() * sizeof(T) + attribute.triangles.size() * sizeof(glm::uvec3);
}

/// Returns the memory of a copy of a mesh, with room for the corner indices that one_mesh() may add to attributes.
std::uint64_t bytes_of(const Mesh& mesh) {
  constexpr std::uint64_t corner_lists = 2 + max_texcoord_sets;
  std::uint64_t bytes = mesh.positions.size() * sizeof(glm::vec3) + bytes_of(mesh.normals) + bytes_of(mesh.texcoords) +
                        bytes_of(mesh.colors) + mesh.triangles.size() * (2 + corner_lists) * sizeof(glm::uvec3);
  for (const Attribute<glm::vec2>& set : mesh.further_texcoords) bytes += bytes_of(set);
  return bytes + (mesh.sharp_edges.size() + mesh.smooth_edges.size()) * sizeof(glm::uvec2) +
         mesh.edge_circles.size() * sizeof(EdgeCircle);
}

/// Returns the total size of the files that a model was read from.
std::uint64_t file_bytes(const SceneSource& source) {
  std::uint64_t bytes = 0;
  for (const std::filesystem::path& path : source.files) {
    std::error_code error;
    const std::uint64_t size = std::filesystem::file_size(path, error);
    if (!error) bytes += size;
  }
  return bytes;
}

/// The place of a camera or a light. A transform may stretch and shear, but cameras and lights must stay rigid. So
/// their axes are made orthonormal again: the viewing direction is kept exactly, and up is adjusted.
struct RigidPlace {
  glm::dmat4 world_from_thing;
  double growth;  ///< factor of lengths along the direction of view or of the light
};

/// Returns the place that a transform gives. Precondition: the transform is not singular.
RigidPlace rigid_place(const glm::dmat4& placed) {
  const glm::dvec3 back(placed[2]), right = glm::cross(glm::dvec3(placed[1]), back);
  const double length = glm::length(back);
  const glm::dvec3 z = back / length, x = glm::normalize(right);
  return {glm::dmat4(glm::dvec4(x, 0), glm::dvec4(glm::cross(z, x), 0), glm::dvec4(z, 0), placed[3]), length};
}

/// Returns a camera of the model, placed in the scene. Lengths (planes, the height of a parallel projection) are scaled
/// by the transform's factor along the viewing direction.
Camera transformed(Camera camera, const glm::dmat4& scene_from_model) {
  const RigidPlace place = rigid_place(scene_from_model * camera.world_from_eye);
  camera.world_from_eye = place.world_from_thing;
  if (camera.near) *camera.near *= place.growth;
  if (camera.far) *camera.far *= place.growth;
  if (camera.orthographic) camera.vertical *= place.growth;
  return camera;
}

/// Returns a light of the model, placed in the scene. An object that is scaled with the light is as bright as before.
Light transformed(Light light, const glm::dmat4& scene_from_model) {
  const RigidPlace place = rigid_place(scene_from_model * light.world_from_light);
  light.world_from_light = place.world_from_thing;
  if (light.range) *light.range *= place.growth;
  // The light of a point or spot falls off with the square of the distance.
  if (light.kind != Light::Kind::sun) light.intensity *= place.growth * place.growth;
  return light;
}

/// A model as read from its file, and those of its meshes that are in the scene already.
class PlacedMeshes {
 public:
  /// Moves the model's materials and textures to the scene.
  PlacedMeshes(Scene model, std::uint64_t bytes, const ModelSource& source, Scene& scene)
      : model_(std::move(model)), source_(source), scene_(scene), budget_(bytes) {
    Scene looks;
    looks.materials = std::move(model_.materials);
    looks.textures = std::move(model_.textures);
    first_material_ = std::uint32_t(scene_.materials.size());
    for (const Material& material : looks.materials) names_.push_back(material.name);
    add(scene_, std::move(looks));
    for (Mesh& mesh : model_.meshes)
      for (std::uint32_t& id : mesh.material_ids)
        if (id != no_index) id += first_material_;
  }

  [[nodiscard]] const Scene& model() const { return model_; }

  /// The objects of the scene that one object of the scene file makes. `scene_from_model` applies to the model.
  std::vector<Instance> place(const PlacedModel& object, const glm::dmat4& scene_from_model) {
    const bool is_one = !object.has_parts && model_.instances.size() > 1;
    const std::vector<std::uint32_t>& meshes = meshes_of(object, is_one);
    budget_.charge_placed(triangle_count(model_), object.place, source_);
    const std::string name = object.name.empty() ? model_.name : object.name;
    budget_.charge(model_.source.hidden.size(), longest_name, object.place, source_);
    for (const std::string& hidden : model_.source.hidden) scene_.source.hidden.push_back(name_of(name + "/" + hidden));
    if (is_one) return {{name, meshes[0], scene_from_model, object.category}};
    budget_.charge(model_.instances.size(), sizeof(Instance) + longest_name, object.place, source_);
    std::vector<Instance> instances;
    for (const Instance& part : model_.instances) {
      const std::string own = object.has_parts ? name_of(name + "/" + part.name) : name;
      instances.push_back({own, meshes[part.mesh], scene_from_model * part.world_from_mesh, object.category});
    }
    return instances;
  }

  /// Adds the model's cameras and lights to the scene, placed with the object.
  void carry(const PlacedModel& object, const glm::dmat4& scene_from_model) {
    budget_.charge(model_.cameras.size() + model_.lights.size(), sizeof(Light) + longest_name, object.place, source_);
    for (const Camera& camera : model_.cameras) scene_.cameras.push_back(transformed(camera, scene_from_model));
    for (const Light& light : model_.lights) scene_.lights.push_back(transformed(light, scene_from_model));
  }

 private:
  /// Returns meshes by the model's own numbers, or a single one if the objects are joined.
  const std::vector<std::uint32_t>& meshes_of(const PlacedModel& object, bool is_one) {
    const auto [found, is_new] = known_.emplace(std::pair(is_one, object.replacement), std::vector<std::uint32_t>());
    if (!is_new) return found->second;
    for (const auto& [name, material] : object.replacement.named)
      if (std::find(names_.begin(), names_.end(), name) == names_.end())
        source_.fail(object.place + ".material", "the model has no material " + in_quotes(name));
    if (is_one) {
      for (const Instance& part : model_.instances) {
        const Mesh& mesh = model_.meshes[part.mesh];
        budget_.charge(1, bytes_of(mesh), object.place, source_);
        if (mesh.is_curved())
          source_.fail(object.place + ".model",
                       "has several curved objects, which cannot be one; say \"parts\": \"apart\"");
      }
      add_mesh(one_mesh(model_), object.replacement, found->second);
    } else {
      for (const Mesh& mesh : model_.meshes) {
        budget_.charge(1, bytes_of(mesh), object.place, source_);
        add_mesh(mesh, object.replacement, found->second);
      }
    }
    return found->second;
  }

  void add_mesh(Mesh mesh, const Replacement& replacement, std::vector<std::uint32_t>& numbers) {
    if (replacement.of_all != no_index) {
      mesh.material_ids = {replacement.of_all};
      mesh.colors = {};  // they would tint the material
    }
    for (std::uint32_t& id : mesh.material_ids) {
      if (id == no_index || replacement.named.empty()) continue;
      const auto found = replacement.named.find(names_[id - first_material_]);
      if (found != replacement.named.end()) id = found->second;
    }
    numbers.push_back(std::uint32_t(scene_.meshes.size()));
    scene_.meshes.push_back(std::move(mesh));
  }

  Scene model_;
  const ModelSource& source_;
  Scene& scene_;
  Budget budget_;
  std::uint32_t first_material_ = 0;
  std::vector<std::string> names_;  ///< names of the model's materials
  std::map<std::pair<bool, Replacement>, std::vector<std::uint32_t>> known_;
};

class SceneReader {
 public:
  SceneReader(Bytes bytes, const ModelSource& source)
      : file_(parse_scene_file(text_of(bytes), source)), source_(source), text_bytes_(bytes.size()) {}

  Scene read() {
    scene_.categories = std::move(file_.categories);
    scene_.materials = std::move(file_.materials);
    find_models();
    std::vector<std::vector<Instance>> instances(file_.objects.size());
    for (const std::vector<std::size_t>& objects : objects_of_models_) place_model(objects, instances);
    for (std::vector<Instance>& list : instances)
      for (Instance& instance : list) scene_.instances.push_back(std::move(instance));
    scene_.source.metres_per_unit = file_.metres_per_unit ? file_.metres_per_unit : unit_;
    return std::move(scene_);
  }

 private:
  /// Groups the objects by the path of their model's file. Models are in the order of their first objects.
  void find_models() {
    std::map<std::string, std::size_t> by_reference, by_path;
    for (std::size_t i = 0; i < file_.objects.size(); ++i) {
      const PlacedModel& object = file_.objects[i];
      const auto [known, is_new] = by_reference.emplace(object.model, 0);
      if (is_new) {
        const auto [model, is_first] = by_path.emplace(path_of(object), objects_of_models_.size());
        if (is_first) objects_of_models_.emplace_back();
        known->second = model->second;
      }
      objects_of_models_[known->second].push_back(i);
    }
  }

  [[nodiscard]] std::string path_of(const PlacedModel& object) const {
    if (object.model.starts_with("builtin:")) return object.model;
    return at_model(object, [&] { return source_.path_of(object.model).string(); });
  }

  /// Returns read(), or throws its error with the place of the object that uses the model.
  template <class Read>
  auto at_model(const PlacedModel& object, const Read& read) const -> decltype(read()) {
    try {
      return read();
    } catch (const Error& error) {
      if (error.code() == ErrorCode::cancelled) throw;
      throw(error.file() == source_.name() ? Error(error.code(), error.place(), error.reason()) : error)
          .within(source_.name(), object.place + ".model");
    }
  }

  void place_model(const std::vector<std::size_t>& objects, std::vector<std::vector<Instance>>& instances) {
    const PlacedModel& first = file_.objects[objects[0]];
    Scene model = at_model(first, [&] { return load_named(first.model, source_); });
    tell_of(model, first);
    const std::uint64_t bytes = text_bytes_ + file_bytes(model.source);
    PlacedMeshes meshes(std::move(model), bytes, source_, scene_);
    for (const std::size_t i : objects) {
      const PlacedModel& object = file_.objects[i];
      const glm::dmat4 scene_from_model = place_of(object, meshes.model());
      instances[i] = meshes.place(object, scene_from_model);
      object_count_ += instances[i].size();
      if (object_count_ > max_objects)
        source_.fail_limit(object.place, "more than " + std::to_string(max_objects) + " objects");
      meshes.carry(object, scene_from_model);
    }
  }

  /// Returns the transform from the model's world space, which is relative to its origin, to the coordinates of the
  /// scene file.
  [[nodiscard]] glm::dmat4 place_of(const PlacedModel& object, const Scene& model) const {
    glm::dmat4 from_origin(1.0), scaled(1.0);
    from_origin[3] = glm::dvec4(model.origin, 1);
    const std::optional<double> unit = object.metres_per_unit ? object.metres_per_unit : model.source.metres_per_unit;
    if (file_.metres_per_unit && unit)
      for (int axis = 0; axis < 3; ++axis) scaled[axis][axis] = *unit / *file_.metres_per_unit;
    const glm::dmat4 turned = object.up ? turn_between(*object.up, *file_.up) : glm::dmat4(1.0);
    return object.scene_from_model * turned * scaled * from_origin;
  }

  /// Adds the model's warnings and files to the scene. If the file states no up axis or unit, those of the first model
  /// hold.
  void tell_of(Scene& model, const PlacedModel& object) {
    std::move(model.warnings.begin(), model.warnings.end(), std::back_inserter(scene_.warnings));
    std::copy(model.source.files.begin(), model.source.files.end(), std::back_inserter(scene_.source.files));
    const std::optional<double> unit = model.source.metres_per_unit;
    if (is_first_) {
      scene_.up = file_.up.value_or(model.up);
      unit_ = unit;
    } else if (!file_.metres_per_unit && unit != unit_ && !has_told_of_units_) {
      scene_.warnings.push_back(object.place +
                                ".model: its unit is not that of the first model, and nothing is scaled unless "
                                "metres_per_unit says the scene's");
      has_told_of_units_ = true;
    }
    is_first_ = false;
  }

  SceneFile file_;
  const ModelSource& source_;
  std::uint64_t text_bytes_;
  Scene scene_;
  std::vector<std::vector<std::size_t>> objects_of_models_;
  std::optional<double> unit_;  ///< unit of the first model
  std::size_t object_count_ = 0;
  bool is_first_ = true, has_told_of_units_ = false;
};

}  // namespace

// Each object adds its transformed vertices, and its triangles with shifted indices:
//
//   positions   a b c d | e f g          triangles   0 1 2, 0 2 3 | 4 5 6
//
// Normals, colours and texture coordinates are joined likewise. Attributes stay indexed by vertex unless a mesh indexes
// them by corner. A mirrored object swaps the last two corners of its triangles, to keep their outer side.
Mesh one_mesh(const Scene& model) {
  const std::vector<PartOfModel> parts = parts_of(model);
  Mesh all;
  all.name = model.name;
  all.origin = model.origin;
  for (const PartOfModel& part : parts) {
    const auto shift = std::uint32_t(all.positions.size());
    const auto shifted = [&](const glm::uvec2& edge) { return std::optional(edge + shift); };
    append_edges(part.mesh, part.model_from_mesh, shifted, all);
    append_triangles(part.mesh.triangles, shift, part.is_mirrored, all.triangles);
    for (const glm::vec3& p : part.mesh.positions)
      all.positions.emplace_back(part.model_from_mesh * glm::dvec4(glm::dvec3(p), 1));
  }
  all.normals = joined_normals(parts);
  all.texcoords = joined_texcoords(parts, 0);
  for (std::uint32_t set = 1; set < max_texcoord_sets; ++set)
    if (Attribute<glm::vec2> further = joined_texcoords(parts, set); !further.empty()) {
      all.further_texcoords.resize(set);
      all.further_texcoords[set - 1] = std::move(further);
    }
  all.colors = joined(
      parts, [](const Mesh& mesh) { return &mesh.colors; }, glm::vec4(1),
      [](const glm::vec4& value, const PartOfModel&) { return value; });
  all.material_ids = joined_materials(parts);
  all.face_ids = joined_faces(parts);
  return all;
}

Scene read_scene_file(Bytes bytes, const ModelSource& source) {
  constexpr std::uint64_t most_bytes = std::uint64_t(1) << 26;
  if (bytes.size() > most_bytes) source.fail_limit("JSON", "longer than 64 MiB");
  return SceneReader(bytes, source).read();
}

}  // namespace frontmost
