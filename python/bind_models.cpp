// SPDX-License-Identifier: Apache-2.0
// Reading and writing of model files; scenes made by code.
#include <frontmost/files.h>

#include <shared_mutex>

#include "python/arrays.h"
#include "python/bindings.h"
#include "python/held.h"
#include "python/running.h"
#include "python/scene_words.h"

FRONTMOST_WORDS(frontmost::ModelFormat, "format",
                {{frontmost::ModelFormat::stl, "stl"},
                 {frontmost::ModelFormat::ply, "ply"},
                 {frontmost::ModelFormat::obj, "obj"},
                 {frontmost::ModelFormat::off, "off"},
                 {frontmost::ModelFormat::gltf, "gltf"},
                 {frontmost::ModelFormat::threemf, "3mf"},
                 {frontmost::ModelFormat::scene, "scene"},
                 {frontmost::ModelFormat::step, "step"},
                 {frontmost::ModelFormat::iges, "iges"},
                 {frontmost::ModelFormat::brep, "brep"},
                 {frontmost::ModelFormat::foreign, "foreign"}});

namespace frontmost::python {
namespace {

using namespace py::literals;

std::string path_text(const py::object& path) {
  return py::cast<std::string>(py::module_::import("os").attr("fspath")(path));
}

HeldScene load_scene(const py::object& source, const std::string& name, const std::optional<Axis>& up,
                     const std::optional<ModelFormat>& format, const std::vector<py::object>& allow_outside,
                     double mesh_tolerance, double mesh_angle, double import_seconds, bool cache, int threads,
                     const py::object& progress) {
  LoadOptions options;
  options.import.tolerance = mesh_tolerance;
  options.import.angle = glm::radians(mesh_angle);
  options.import.seconds = import_seconds;
  options.import.cache = cache;
  for (const py::object& folder : allow_outside) options.allow_outside.push_back(path_text(folder));
  options.up = up;
  options.format = format;
  if (py::isinstance<py::bytes>(source)) {
    const std::string_view bytes = py::cast<std::string_view>(source);
    return HeldScene(run(threads, progress, [&](const Execution& execution) {
      return load(std::as_bytes(std::span(bytes)), name, options, execution);
    }));
  }
  const std::string path = path_text(source);
  return HeldScene(run(threads, progress, [&](const Execution& execution) { return load(path, options, execution); }));
}

template <class T>
std::vector<T> column_of(const Array<T>& values) {
  return {values.data(), values.data() + values.size()};
}

/// A property of all triangles: bytes and bools become bytes, other integers 32 bits, floats doubles.
TableColumn column_from(const std::string& name, const py::handle& given, py::ssize_t rows) {
  const std::string argument = "of_triangles: " + name;
  const py::array array = py::array::ensure(given);
  const char kind = array ? array.dtype().kind() : 'O';
  if (kind == 'f') return {name, column_of(numbers<double>(given, argument, {rows}))};
  const py::object integers = kind == 'b' ? array.attr("astype")("u1") : py::reinterpret_borrow<py::object>(given);
  const auto values = indices(integers, argument, {rows}, std::uint64_t(1) << 32);
  if (kind != 'b' && !(kind == 'u' && array.itemsize() == 1)) return {name, column_of(values)};
  return {name, std::vector<std::uint8_t>(values.data(), values.data() + values.size())};
}

void save_scene(const HeldScene& held, const py::object& path, const py::dict& of_triangles) {
  const std::string file = path_text(path);
  Table table;
  for (const auto& [name, values] : of_triangles)
    table.columns.push_back(column_from(py::cast<std::string>(name), values, py::ssize_t(triangle_count(*held.scene))));
  const std::shared_ptr<const KeptScene> kept = held.scene;
  run(0, py::none(), [&](const Execution&) {
    const std::shared_lock lock(kept->reading);
    save(*kept, file, table);
  });
}

}  // namespace

void bind_models(py::module_& m) {
  py::class_<HeldScene>(m.attr("Scene"))
      .def("save", &save_scene, "path"_a, py::kw_only(), "of_triangles"_a = py::dict(), doc("Scene.save"));
  m.def("load", &load_scene, "source"_a, py::kw_only(), "name"_a = "memory", "up"_a = py::none(),
        "format"_a = py::none(), "allow_outside"_a = std::vector<py::object>(), "mesh_tolerance"_a = 0.0,
        "mesh_angle"_a = 12.0, "import_seconds"_a = 600.0, "cache"_a = true, "threads"_a = 0, "progress"_a = py::none(),
        doc("load"));
  m.def(
      "builtin", [](const std::string& name) { return HeldScene(builtin(name)); }, "name"_a, doc("builtin"));
  m.def(
      "builtin_names",
      [] {
        py::list names;
        for (const std::string_view name : builtin_names()) names.append(py::str(name.data(), name.size()));
        return names;
      },
      doc("builtin_names"));
}

}  // namespace frontmost::python
