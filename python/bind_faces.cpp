// SPDX-License-Identifier: Apache-2.0
// Visible faces as records: all triangles that are visible at least in part, from one place or from many.
#include <frontmost/report.h>

#include <shared_mutex>

#include "python/arrays.h"
#include "python/bindings.h"
#include "python/held.h"
#include "python/running.h"

namespace frontmost::python {
namespace {

using namespace py::literals;

// Records are packed like those of tables in files.
#pragma pack(push, 1)
struct VisibleFaceRecord {
  std::uint32_t primitive, object, triangle;
  double pixels, area, solid_angle;
};
struct SeenFaceRecord {
  std::uint32_t primitive, object, triangle, views, best_view;
  double largest_share, largest_pixels;
};
#pragma pack(pop)

py::array visible_faces_of(const std::shared_ptr<HeldSurfaces>& held, const View& view, int threads,
                           const py::object& progress) {
  const VisibleFaces found = run(threads, progress, [&](const Execution& execution) {
    const std::shared_lock lock(held->scene->reading);
    return visible_faces(held->surfaces, view, execution);
  });
  return records_of<VisibleFaceRecord>(found.faces, [&](const VisibleFace& face) {
    const PrimitiveSource source = held->surfaces.source(face.id);
    return VisibleFaceRecord{face.id, source.instance, source.triangle, face.pixels, face.area, face.solid_angle};
  });
}

py::array faces_ever_seen_of(const std::shared_ptr<HeldSurfaces>& held, const std::vector<View>& views, int threads,
                             const py::object& progress) {
  const std::vector<SeenFace> found = run(threads, progress, [&](const Execution& execution) {
    const std::shared_lock lock(held->scene->reading);
    return faces_ever_seen(held->surfaces, views, execution);
  });
  return records_of<SeenFaceRecord>(found, [&](const SeenFace& face) {
    const PrimitiveSource source = held->surfaces.source(face.id);
    return SeenFaceRecord{face.id,        source.instance,    source.triangle,    face.view_count,
                          face.best_view, face.largest_share, face.largest_pixels};
  });
}

HeldScene kept_faces(const HeldScene& held, const py::object& primitives) {
  const auto ids = indices(primitives, "primitives", {-1}, triangle_count(*held.scene));
  const std::span<const PrimitiveId> kept(ids.data(), std::size_t(ids.size()));
  for (std::size_t i = 1; i < kept.size(); ++i)
    if (kept[i] <= kept[i - 1])
      throw py::value_error("primitives: must ascend, and row " + std::to_string(i) + " does not");
  const std::shared_ptr<const KeptScene> scene = held.scene;
  return HeldScene(run(1, py::none(), [&](const Execution&) {
    const std::shared_lock lock(scene->reading);
    return keep_faces(*scene, kept);
  }));
}

}  // namespace

void bind_faces(py::module_& m) {
  PYBIND11_NUMPY_DTYPE(VisibleFaceRecord, primitive, object, triangle, pixels, area, solid_angle);
  PYBIND11_NUMPY_DTYPE(SeenFaceRecord, primitive, object, triangle, views, best_view, largest_share, largest_pixels);
  py::class_<HeldSurfaces, std::shared_ptr<HeldSurfaces>>(m.attr("Surfaces"))
      .def("visible_faces", &visible_faces_of, "view"_a, py::kw_only(), "threads"_a = 0, "progress"_a = py::none(),
           doc("Surfaces.visible_faces"))
      .def("faces_ever_seen", &faces_ever_seen_of, "views"_a, py::kw_only(), "threads"_a = 0, "progress"_a = py::none(),
           doc("Surfaces.faces_ever_seen"));
  py::class_<HeldScene>(m.attr("Scene")).def("keep_faces", &kept_faces, "primitives"_a, doc("Scene.keep_faces"));
}

}  // namespace frontmost::python
