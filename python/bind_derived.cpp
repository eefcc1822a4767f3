// SPDX-License-Identifier: Apache-2.0
// Scenes derived from others: cut by a plane, or with curved meshes tessellated for a view.
#include <frontmost/lines.h>
#include <frontmost/view.h>

#include <shared_mutex>

#include "python/arrays.h"
#include "python/bindings.h"
#include "python/held.h"
#include "python/running.h"
#include "python/scene_words.h"

namespace frontmost::python {
namespace {

using namespace py::literals;

struct CutFaceRecord {
  std::uint32_t object, material;
  double area;
  std::uint64_t open_count;
};

/// Python's Section.
struct HeldSection {
  HeldScene scene;
  std::shared_ptr<const std::vector<CutFace>> faces;
};

HeldSection section_of(const std::shared_ptr<HeldSurfaces>& held, Axis towards, double at, int threads,
                       const py::object& progress) {
  Section section = run(threads, progress, [&](const Execution& execution) {
    const std::shared_lock lock(held->scene->reading);
    return cut(held->surfaces, {towards, at}, execution);
  });
  return {HeldScene(std::move(section.scene)), std::make_shared<const std::vector<CutFace>>(std::move(section.faces))};
}

/// One list of (k, 3) arrays for each face.
py::list outlines_of(const HeldSection& section) {
  py::list faces;
  for (const CutFace& face : *section.faces) {
    py::list outlines;
    for (const std::vector<glm::vec3>& outline : face.outlines)
      outlines.append(view_of(&outline.data()->x, {py::ssize_t(outline.size()), 3}, section.faces));
    faces.append(outlines);
  }
  return faces;
}

HeldScene tessellated(const HeldScene& held, const View& view, double pixels) {
  const std::shared_ptr<const KeptScene> scene = held.scene;
  return HeldScene(run(1, py::none(), [&](const Execution&) {
    const std::shared_lock lock(scene->reading);
    return tessellate(*scene, view, pixels);
  }));
}

}  // namespace

void bind_derived(py::module_& m) {
  PYBIND11_NUMPY_DTYPE(CutFaceRecord, object, material, area, open_count);
  py::class_<HeldSection>(m, "Section", doc("Section"))
      .def_property_readonly(
          "scene", [](const HeldSection& s) { return s.scene; }, doc("Section.scene"))
      .def_property_readonly(
          "faces",
          [](const HeldSection& s) {
            return records_of<CutFaceRecord>(*s.faces, [](const CutFace& face) {
              return CutFaceRecord{face.instance, face.material, face.area, face.open_count};
            });
          },
          doc("Section.faces"))
      .def_property_readonly("outlines", &outlines_of, doc("Section.outlines"))
      .def("__repr__", [](const HeldSection& s) {
        return "Section of " + std::to_string(s.scene.scene->instances.size()) + " objects, of which " +
               std::to_string(s.faces->size()) + " are cut";
      });
  py::class_<HeldSurfaces, std::shared_ptr<HeldSurfaces>>(m.attr("Surfaces"))
      .def("cut", &section_of, "towards"_a, "at"_a = 0.0, py::kw_only(), "threads"_a = 0, "progress"_a = py::none(),
           doc("Surfaces.cut"));
  py::class_<HeldScene>(m.attr("Scene")).def("tessellate", &tessellated, "view"_a, "pixels"_a, doc("Scene.tessellate"));
}

}  // namespace frontmost::python
