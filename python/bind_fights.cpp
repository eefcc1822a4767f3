// SPDX-License-Identifier: Apache-2.0
// Faces that a depth buffer cannot tell apart, their places, and remedies.
#include <frontmost/precision.h>

#include <shared_mutex>

#include "python/arrays.h"
#include "python/bindings.h"
#include "python/depth_fights.h"
#include "python/depth_words.h"
#include "python/running.h"

FRONTMOST_WORDS(frontmost::FightKind, "kind",
                {{frontmost::FightKind::one_plane, "one_plane"},
                 {frontmost::FightKind::fold, "fold"},
                 {frontmost::FightKind::close, "close"},
                 {frontmost::FightKind::clear, "clear"}});

namespace frontmost::python {
namespace {

using namespace py::literals;

struct FightingFacesRecord {
  std::uint32_t first, second;
  std::uint8_t kind;
  double area, visible_area, distance;
};
struct FightingObjectsRecord {
  std::uint32_t first, second;
  std::uint8_t kind;
  std::uint64_t areas;
  double area, visible_area, distance, gap;
};

/// Python's FightAreas.
struct HeldFightAreas {
  std::shared_ptr<HeldSurfaces> of;
  std::shared_ptr<const FightAreas> found;
  std::uint64_t moves = 0;  ///< HeldSurfaces::moves at the time of the search
};

HeldFightAreas areas_of(const std::shared_ptr<HeldSurfaces>& held, const View& view, DepthFormat format, bool reversed,
                        int threads, const py::object& progress) {
  return {held,
          run(threads, progress,
              [&](const Execution& execution) {
                const std::shared_lock lock(held->scene->reading);
                return std::make_shared<const FightAreas>(
                    find_fighting_faces(held->surfaces, view, format, reversed, execution));
              }),
          held->moves};
}

py::list polygons_of_areas(const HeldFightAreas& areas) {
  py::list polygons;
  for (const FightingFaces& fight : areas.found->faces) {
    const std::span<const glm::dvec2> corners = areas.found->polygon(fight);
    polygons.append(view_of(&corners.data()->x, {py::ssize_t(corners.size()), 2}, areas.found));
  }
  return polygons;
}

// Remedies.

py::list remedies_of(const HeldExact& exact, const DepthSetup& setup, int threads, const py::object& progress) {
  exact.check_current();
  const auto remedies = run(threads, progress, [&](const Execution& execution) {
    const std::shared_lock lock(exact.of->scene->reading);
    return try_remedies(exact.of->surfaces, *exact.exact, setup, execution);
  });
  py::list list;
  for (const FightRemedy& remedy : remedies) list.append(py::make_tuple(remedy.setup, remedy.wrong));
  return list;
}

/// The offset (object, factor, units), or None.
py::object offset_of_pair(const HeldFightAreas& areas, const HeldExact& exact, std::size_t pair, int threads,
                          const py::object& progress) {
  const FightAreas& found = *areas.found;
  if (pair >= found.objects.size())
    throw py::value_error("pair: there is no row " + std::to_string(pair) + " of " +
                          std::to_string(found.objects.size()));
  if (exact.of != areas.of || exact.moves != areas.moves)
    throw Error(ErrorCode::bad_argument, "exact", "is of other surfaces");
  if (!py::cast(exact.exact->view).equal(py::cast(found.view)))
    throw Error(ErrorCode::bad_argument, "exact", "was made for another view; both must have the same view");
  exact.check_current();
  const auto remedy = run(threads, progress, [&](const Execution& execution) {
    const std::shared_lock lock(exact.of->scene->reading);
    return find_offset(exact.of->surfaces, *exact.exact, found, found.objects[pair], execution);
  });
  if (!remedy) return py::none();
  return py::make_tuple(remedy->instance, remedy->offset.factor, remedy->offset.units);
}

}  // namespace

void bind_fights(py::module_& m) {
  PYBIND11_NUMPY_DTYPE(FightingFacesRecord, first, second, kind, area, visible_area, distance);
  PYBIND11_NUMPY_DTYPE(FightingObjectsRecord, first, second, kind, areas, area, visible_area, distance, gap);
  m.attr("fight_kinds") = words_of<FightKind>();
  py::class_<HeldFightAreas>(m, "FightAreas", doc("FightAreas"))
      .def_property_readonly(
          "view", [](const HeldFightAreas& a) { return a.found->view; }, doc("FightAreas.view"))
      .def_property_readonly(
          "setup", [](const HeldFightAreas& a) { return a.found->setup; }, doc("FightAreas.setup"))
      .def_property_readonly(
          "faces",
          [](const HeldFightAreas& a) {
            return records_of<FightingFacesRecord>(a.found->faces, [](const FightingFaces& f) {
              return FightingFacesRecord{f.first, f.second, std::uint8_t(f.kind), f.area, f.visible_area, f.distance};
            });
          },
          doc("FightAreas.faces"))
      .def_property_readonly("polygons", &polygons_of_areas, doc("FightAreas.polygons"))
      .def_property_readonly(
          "objects",
          [](const HeldFightAreas& a) {
            return records_of<FightingObjectsRecord>(a.found->objects, [](const FightingObjects& f) {
              return FightingObjectsRecord{f.first, f.second,       std::uint8_t(f.kind), f.areas,
                                           f.area,  f.visible_area, f.distance,           f.gap};
            });
          },
          doc("FightAreas.objects"))
      .def("find_offset", &offset_of_pair, "exact"_a, "pair"_a, py::kw_only(), "threads"_a = 0,
           "progress"_a = py::none(), doc("FightAreas.find_offset"))
      .def("__len__", [](const HeldFightAreas& a) { return a.found->faces.size(); })
      .def("__repr__", [](const HeldFightAreas& a) {
        return "FightAreas: " + std::to_string(a.found->faces.size()) + " areas of " +
               std::to_string(a.found->objects.size()) + " pairs of objects";
      });
  py::class_<HeldExact>(m.attr("ExactVisible"))
      .def("try_remedies", &remedies_of, "setup"_a, py::kw_only(), "threads"_a = 0, "progress"_a = py::none(),
           doc("ExactVisible.try_remedies"));
  py::class_<HeldSurfaces, std::shared_ptr<HeldSurfaces>>(m.attr("Surfaces"))
      .def("find_fighting_faces", &areas_of, "view"_a, "format"_a = DepthFormat::d24, py::kw_only(),
           "reversed"_a = false, "threads"_a = 0, "progress"_a = py::none(), doc("Surfaces.find_fighting_faces"));
}

}  // namespace frontmost::python
