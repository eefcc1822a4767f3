// SPDX-License-Identifier: Apache-2.0
// Scenes: made of arrays, and inspected.
#include <frontmost/image.h>
#include <frontmost/scene.h>

#include <cstring>
#include <shared_mutex>

#include "python/arrays.h"
#include "python/bindings.h"
#include "python/held.h"
#include "python/running.h"
#include "python/scene_words.h"

namespace frontmost::python {
namespace {

using namespace py::literals;

/// An object or a mesh of a scene, read only. Keeps the scene.
struct HeldObject {
  std::shared_ptr<const KeptScene> scene;
  std::uint32_t number;
  [[nodiscard]] const Instance& get() const { return scene->instances[number]; }
};
struct HeldMesh {
  std::shared_ptr<const KeptScene> scene;
  std::uint32_t number;
  [[nodiscard]] const Mesh& get() const { return scene->meshes[number]; }
};

/// The object's pose, in the coordinates of the file.
Array<double> pose_of_object(const HeldObject& object) {
  return array_of(run(1, py::none(), [&](const Execution&) {
    const std::shared_lock lock(object.scene->reading);
    return pose_of_instance(*object.scene, object.get());
  }));
}

/// Arguments that make an object of arrays.
struct ObjectArrays {
  py::object vertices, faces, name, pose, color, vertex_colors, face_colors, normals, texcoords, texture;
};

// Colours.

/// Rows of linear RGBA from integers (sRGB, 0 to 255) or floats (linear) in three or four channels.
std::vector<glm::vec4> colors_of(const py::handle& given, const std::string& name, py::ssize_t rows) {
  const py::array array = py::array::ensure(given);
  const bool is_bytes = array && (array.dtype().kind() == 'u' || array.dtype().kind() == 'i');
  const bool has_alpha = array && array.ndim() == 2 && array.shape(1) == 4;
  const auto values = numbers<float>(given, name, {rows, has_alpha ? 4 : 3});
  std::vector<glm::vec4> colors(std::size_t(values.shape(0)), glm::vec4(1));
  for (py::ssize_t row = 0; row < values.shape(0); ++row)
    for (int i = 0; i < (has_alpha ? 4 : 3); ++i) {
      const float value = *values.data(row, i);
      if (!(value >= 0 && value <= (is_bytes ? 255.0f : 1.0f)))
        throw py::value_error(name + ": row " + std::to_string(row) + " is not within " +
                              (is_bytes ? "0 to 255" : "0 to 1, as floats are"));
      colors[std::size_t(row)][i] = !is_bytes ? value : i == 3 ? value / 255 : linear_of_srgb(std::uint8_t(value));
    }
  return colors;
}

glm::vec4 color_of(const py::handle& given) {
  return colors_of(py::module_::import("numpy").attr("atleast_2d")(given), "color", 1)[0];
}

Texture texture_of(const py::handle& given) {
  const py::array array = py::array::ensure(given);
  if (!array || array.ndim() != 3 || (array.shape(2) != 3 && array.shape(2) != 4) || array.dtype().kind() != 'u' ||
      array.itemsize() != 1 || array.size() == 0)
    throw py::value_error("texture: must be of uint8 with the shape (height, width, 3 or 4)");
  if (array.shape(0) > 16384 || array.shape(1) > 16384)
    throw py::value_error("texture: has more than 16384 pixels a side");
  const auto pixels = Array<std::uint8_t>::ensure(array);
  Texture texture;
  texture.height = int(array.shape(0));
  texture.width = int(array.shape(1));
  texture.pixels.assign(std::size_t(texture.width) * std::size_t(texture.height), glm::u8vec4(255));
  const int channels = int(array.shape(2));
  for (std::size_t i = 0; i < texture.pixels.size(); ++i)
    for (int c = 0; c < channels; ++c) texture.pixels[i][c] = pixels.data()[i * std::size_t(channels) + std::size_t(c)];
  return texture;
}

// Objects.

/// Sets the positions. Floats are copied unchanged; doubles far from zero get an origin.
void set_positions(Mesh& mesh, const py::handle& given) {
  const py::array array = py::array::ensure(given);
  const bool is_double = array && (array.dtype().kind() != 'f' || array.itemsize() > 4);
  if (!is_double) {
    const auto values = numbers<float>(given, "vertices", {-1, 3});
    mesh.positions.resize(std::size_t(values.shape(0)));
    if (values.size() > 0) std::memcpy(mesh.positions.data(), values.data(), std::size_t(values.nbytes()));
    return;
  }
  const auto values = numbers<double>(given, "vertices", {-1, 3});
  // numbers() gives contiguous rows.
  const std::span points(reinterpret_cast<const glm::dvec3*>(values.data()), std::size_t(values.shape(0)));
  mesh.origin = fitting_origin(points);
  mesh.positions.reserve(points.size());
  for (const glm::dvec3& point : points) mesh.positions.emplace_back(point - mesh.origin);
}

template <class T>
void set_triples(std::vector<T>& out, const py::array& values) {
  out.resize(std::size_t(values.shape(0)));
  if (!out.empty()) std::memcpy(out.data(), values.data(), std::size_t(values.nbytes()));
}

void set_attributes(Mesh& mesh, const ObjectArrays& given) {
  const auto vertices = py::ssize_t(mesh.positions.size()), triangles = py::ssize_t(mesh.triangles.size());
  if (!given.normals.is_none())
    set_triples(mesh.normals.values, numbers<float>(given.normals, "normals", {vertices, 3}));
  if (!given.texcoords.is_none())
    set_triples(mesh.texcoords.values, numbers<float>(given.texcoords, "texcoords", {vertices, 2}));
  if (!given.vertex_colors.is_none() && !given.face_colors.is_none())
    throw py::value_error("face_colors: cannot be given beside vertex_colors");
  if (!given.vertex_colors.is_none()) mesh.colors.values = colors_of(given.vertex_colors, "vertex_colors", vertices);
  if (given.face_colors.is_none()) return;
  mesh.colors.values = colors_of(given.face_colors, "face_colors", triangles);
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) mesh.colors.triangles.emplace_back(i);
}

/// Adds an object, with a material if needed. Changes nothing if an argument is refused.
std::uint32_t add_object(HeldScene& held, const ObjectArrays& given) {
  Mesh mesh;
  set_positions(mesh, given.vertices);
  const py::array faces = integers(given.faces, "faces", {-1, 3});
  mesh.triangles.resize(std::size_t(faces.shape(0)));
  if (faces.size() > 0) copy_indices(faces, "faces", mesh.positions.size(), &mesh.triangles[0].x);
  set_attributes(mesh, given);
  const std::size_t number = held.scene->instances.size();
  mesh.name = given.name.is_none() ? "object " + std::to_string(number) : py::cast<std::string>(given.name);
  const glm::dmat4 pose = given.pose.is_none() ? glm::dmat4(1.0) : matrix(given.pose, "pose");
  const glm::dmat4 placed = placed_by(pose, *held.scene, mesh);

  std::optional<Material> material;
  if (!given.color.is_none()) material.emplace().base_color = color_of(given.color);
  if (material && material->base_color.a < 1) material->alpha = Material::Alpha::blend;
  std::optional<Texture> texture;
  if (!given.texture.is_none()) {
    if (mesh.texcoords.empty()) throw py::value_error("texture: needs texcoords");
    texture = texture_of(given.texture);
    if (!material) material.emplace();
  }
  Scene& scene = held.writable();
  if (texture) {
    material->base_color_texture.texture = std::uint32_t(scene.textures.size());
    scene.textures.push_back(std::move(*texture));
  }
  if (material) {
    material->name = mesh.name;
    mesh.material_ids = {std::uint32_t(scene.materials.size())};
    scene.materials.push_back(std::move(*material));
  }
  return add(scene, std::move(mesh), placed);
}

HeldScene scene_of_arrays(const ObjectArrays& given) {
  HeldScene held;
  add_object(held, given);
  held.scene->name = held.scene->instances[0].name;
  set_origin(*held.scene, fitting_origin(*held.scene));
  return held;
}

std::uint32_t place(HeldScene& held, const py::object& mesh, const py::object& pose, const py::object& name) {
  if (!PyIndex_Check(mesh.ptr())) throw py::type_error("mesh: must be a number");
  const Py_ssize_t number = PyNumber_AsSsize_t(mesh.ptr(), nullptr);
  if (number < 0 || std::size_t(number) >= held.scene->meshes.size())
    throw py::value_error("mesh: there is no mesh " + std::to_string(number) + " of " +
                          std::to_string(held.scene->meshes.size()));
  const glm::dmat4 given = pose.is_none() ? glm::dmat4(1.0) : matrix(pose, "pose");
  Scene& scene = held.writable();
  Instance instance;
  instance.name = name.is_none() ? scene.meshes[std::size_t(number)].name : py::cast<std::string>(name);
  instance.mesh = std::uint32_t(number);
  instance.world_from_mesh = placed_by(given, scene, scene.meshes[instance.mesh]);
  scene.instances.push_back(std::move(instance));
  return std::uint32_t(scene.instances.size() - 1);
}

std::string described(const Scene& scene) {
  return "Scene '" + printable_text(scene.name) + "': " + std::to_string(scene.instances.size()) + " objects, " +
         std::to_string(triangle_count(scene)) + " triangles";
}

/// An attribute of a mesh as an array that keeps the scene; None if the mesh lacks the attribute.
template <class T, class Element>
py::object rows_of(const HeldMesh& mesh, const std::vector<Element>& values) {
  if (values.empty()) return py::none();
  const auto across = py::ssize_t(sizeof(Element) / sizeof(T));
  ArrayShape shape{py::ssize_t(values.size())};
  if (across > 1) shape.push_back(across);
  return view_of(reinterpret_cast<const T*>(values.data()), shape, mesh.scene);
}

void bind_parts(py::module_& m) {
  py::class_<HeldObject>(m, "Object", doc("Object"))
      .def_property_readonly(
          "number", [](const HeldObject& o) { return o.number; }, doc("Object.number"))
      .def_property_readonly(
          "name", [](const HeldObject& o) { return utf8_text(o.get().name); }, doc("Object.name"))
      .def_property_readonly(
          "mesh", [](const HeldObject& o) { return o.get().mesh; }, doc("Object.mesh"))
      .def_property_readonly("pose", &pose_of_object, doc("Object.pose"))
      .def_property_readonly(
          "category",
          [](const HeldObject& o) -> py::object {
            if (o.get().category == no_index) return py::none();
            return py::str(utf8_text(o.scene->categories[o.get().category].name));
          },
          doc("Object.category"))
      .def("__repr__", [](const HeldObject& o) {
        return "Object " + std::to_string(o.number) + " '" + printable_text(o.get().name) + "'";
      });
  py::class_<HeldMesh>(m, "Mesh", doc("Mesh"))
      .def_property_readonly(
          "name", [](const HeldMesh& h) { return utf8_text(h.get().name); }, doc("Mesh.name"))
      .def_property_readonly(
          "origin", [](const HeldMesh& h) { return array_of(h.get().origin); }, doc("Mesh.origin"))
      .def_property_readonly(
          "vertices",
          [](const HeldMesh& h) {
            const std::vector<glm::vec3>& values = h.get().positions;
            return view_of(&values.data()->x, {py::ssize_t(values.size()), 3}, h.scene);
          },
          doc("Mesh.vertices"))
      .def_property_readonly(
          "faces",
          [](const HeldMesh& h) {
            const std::vector<glm::uvec3>& values = h.get().triangles;
            return view_of(&values.data()->x, {py::ssize_t(values.size()), 3}, h.scene);
          },
          doc("Mesh.faces"))
      .def_property_readonly(
          "normals", [](const HeldMesh& h) { return rows_of<float>(h, h.get().normals.values); }, doc("Mesh.normals"))
      .def_property_readonly(
          "texcoords", [](const HeldMesh& h) { return rows_of<float>(h, h.get().texcoords.values); },
          doc("Mesh.texcoords"))
      .def_property_readonly(
          "colors", [](const HeldMesh& h) { return rows_of<float>(h, h.get().colors.values); }, doc("Mesh.colors"))
      .def_property_readonly(
          "face_ids", [](const HeldMesh& h) { return rows_of<std::uint32_t>(h, h.get().face_ids); },
          doc("Mesh.face_ids"))
      .def("__repr__", [](const HeldMesh& h) {
        return "Mesh '" + printable_text(h.get().name) + "': " + std::to_string(h.get().positions.size()) +
               " vertices, " + std::to_string(h.get().triangles.size()) + " triangles";
      });
}

template <class Held>
py::list listed(const HeldScene& held, std::size_t count) {
  py::list list;
  for (std::uint32_t i = 0; i < count; ++i) list.append(Held{held.scene, i});
  return list;
}

void bind_making(py::class_<HeldScene>& scene) {
  scene.def(py::init<>())
      .def_static(
          "from_arrays",
          [](py::object vertices, py::object faces, py::object name, py::object pose, py::object color,
             py::object vertex_colors, py::object face_colors, py::object normals, py::object texcoords,
             py::object texture) {
            return scene_of_arrays(
                {vertices, faces, name, pose, color, vertex_colors, face_colors, normals, texcoords, texture});
          },
          "vertices"_a, "faces"_a, py::kw_only(), "name"_a = py::none(), "pose"_a = py::none(), "color"_a = py::none(),
          "vertex_colors"_a = py::none(), "face_colors"_a = py::none(), "normals"_a = py::none(),
          "texcoords"_a = py::none(), "texture"_a = py::none(), doc("Scene.from_arrays"))
      .def(
          "add",
          [](HeldScene& held, py::object vertices, py::object faces, py::object name, py::object pose, py::object color,
             py::object vertex_colors, py::object face_colors, py::object normals, py::object texcoords,
             py::object texture) {
            return add_object(
                held, {vertices, faces, name, pose, color, vertex_colors, face_colors, normals, texcoords, texture});
          },
          "vertices"_a, "faces"_a, py::kw_only(), "name"_a = py::none(), "pose"_a = py::none(), "color"_a = py::none(),
          "vertex_colors"_a = py::none(), "face_colors"_a = py::none(), "normals"_a = py::none(),
          "texcoords"_a = py::none(), "texture"_a = py::none(), doc("Scene.add"))
      .def("place", &place, "mesh"_a, "pose"_a = py::none(), py::kw_only(), "name"_a = py::none(), doc("Scene.place"))
      .def(
          "add_scene", [](HeldScene& held, const HeldScene& part) { add(held.writable(), Scene(*part.scene)); },
          "part"_a, doc("Scene.add_scene"))
      .def(
          "copy", [](const HeldScene& held) { return HeldScene(Scene(*held.scene)); }, doc("Scene.copy"));
}

}  // namespace

void bind_scene(py::module_& m) {
  bind_parts(m);
  py::class_<HeldScene> scene(m, "Scene", doc("Scene"));
  bind_making(scene);
  scene
      .def_property(
          "name", [](const HeldScene& held) { return utf8_text(held.scene->name); },
          [](HeldScene& held, std::string name) { held.writable().name = std::move(name); }, doc("Scene.name"))
      .def_property(
          "up", [](const HeldScene& held) { return held.scene->up; },
          [](HeldScene& held, Axis up) { held.writable().up = up; }, doc("Scene.up"))
      .def_property_readonly(
          "origin", [](const HeldScene& held) { return array_of(held.scene->origin); }, doc("Scene.origin"))
      .def_property_readonly(
          "objects", [](const HeldScene& held) { return listed<HeldObject>(held, held.scene->instances.size()); },
          doc("Scene.objects"))
      .def_property_readonly(
          "meshes", [](const HeldScene& held) { return listed<HeldMesh>(held, held.scene->meshes.size()); },
          doc("Scene.meshes"))
      .def_property_readonly(
          "triangle_count", [](const HeldScene& held) { return triangle_count(*held.scene); },
          doc("Scene.triangle_count"))
      .def_property_readonly(
          "warnings",
          [](const HeldScene& held) {
            py::list list;
            for (const std::string& warning : held.scene->warnings) list.append(utf8_text(warning));
            return list;
          },
          doc("Scene.warnings"))
      .def_property_readonly(
          "hidden_by_file",
          [](const HeldScene& held) {
            py::list list;
            for (const std::string& name : held.scene->source.hidden) list.append(utf8_text(name));
            return list;
          },
          doc("Scene.hidden_by_file"))
      .def(
          "find", [](const HeldScene& held, const py::object& name) { return object_of(*held.scene, name); }, "name"_a,
          doc("Scene.find"))
      .def("__repr__", [](const HeldScene& held) { return described(*held.scene); });
}

}  // namespace frontmost::python
