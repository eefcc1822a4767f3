// SPDX-License-Identifier: Apache-2.0
// Statistics and oddities of a scene, as dicts of numbers.
#include <frontmost/report.h>

#include <shared_mutex>

#include "python/arrays.h"
#include "python/bindings.h"
#include "python/held.h"
#include "python/running.h"
#include "python/scene_words.h"

namespace frontmost::python {
namespace {

using namespace py::literals;

py::dict dict_of(const Oddities& odd) {
  return py::dict("non_finite_triangles"_a = odd.non_finite_triangles,
                  "degenerate_triangles"_a = odd.degenerate_triangles,
                  "duplicate_triangles"_a = odd.duplicate_triangles, "boundary_edges"_a = odd.boundary_edges,
                  "non_manifold_edges"_a = odd.non_manifold_edges, "inconsistent_edges"_a = odd.inconsistent_edges);
}

py::dict dict_of(const MeshReport& mesh) {
  return py::dict("name"_a = utf8_text(mesh.name), "triangles"_a = mesh.triangles, "vertices"_a = mesh.vertices,
                  "positions"_a = mesh.positions, "faces"_a = mesh.faces, "odd"_a = dict_of(mesh.odd),
                  "pieces"_a = mesh.pieces, "shells"_a = mesh.shells, "closed"_a = mesh.closed,
                  "genus"_a = mesh.genus ? py::object(py::int_(*mesh.genus)) : py::none());
}

py::dict dict_of(const MaterialReport& material) {
  constexpr const char* alphas[] = {"opaque", "mask", "blend"};
  return py::dict("name"_a = utf8_text(material.name), "triangles"_a = material.triangles,
                  "textures"_a = material.textures, "alpha"_a = alphas[int(material.alpha)],
                  "double_sided"_a = material.double_sided);
}

py::dict dict_of(const CameraReport& camera, const glm::dvec3& origin) {
  return py::dict("name"_a = utf8_text(camera.name), "position"_a = array_of(camera.position + origin),
                  "direction"_a = array_of(camera.direction), "up"_a = array_of(camera.up),
                  "orthographic"_a = camera.orthographic,
                  "vertical"_a = camera.orthographic ? camera.vertical : glm::degrees(camera.vertical));
}

template <class Things, class DictOf>
py::list dicts_of(const Things& things, const DictOf& dict_of_thing) {
  py::list list;
  for (const auto& thing : things) list.append(dict_of_thing(thing));
  return list;
}

py::dict inspected(const HeldScene& held, int threads, const py::object& progress) {
  const std::shared_ptr<const KeptScene> scene = held.scene;
  const SceneReport report = run(threads, progress, [&](const Execution& execution) {
    const std::shared_lock lock(scene->reading);
    return inspect(*scene, execution);
  });
  Array<double> bounds(ArrayShape{2, 3});
  for (int axis = 0; axis < 3; ++axis) {
    bounds.mutable_at(0, axis) = double(report.bounds.low[axis]) + report.origin[axis];
    bounds.mutable_at(1, axis) = double(report.bounds.high[axis]) + report.origin[axis];
  }
  return py::dict(
      "name"_a = utf8_text(report.name), "up"_a = report.up, "triangles"_a = report.triangles,
      "stored_triangles"_a = report.stored_triangles, "vertices"_a = report.vertices,
      "origin"_a = array_of(report.origin), "bounds"_a = bounds, "rounding"_a = report.rounding, "area"_a = report.area,
      "volume"_a = report.volume, "odd"_a = dict_of(report.odd),
      "meshes"_a = dicts_of(report.meshes, [](const MeshReport& mesh) { return dict_of(mesh); }),
      "materials"_a = dicts_of(report.materials, [](const MaterialReport& material) { return dict_of(material); }),
      "cameras"_a =
          dicts_of(report.cameras, [&](const CameraReport& camera) { return dict_of(camera, report.origin); }));
}

}  // namespace

void bind_inspect(py::module_& m) {
  py::class_<HeldScene>(m.attr("Scene"))
      .def("inspect", &inspected, py::kw_only(), "threads"_a = 0, "progress"_a = py::none(), doc("Scene.inspect"));
}

}  // namespace frontmost::python
