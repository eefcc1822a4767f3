// SPDX-License-Identifier: Apache-2.0
// The painter's order: polygons from back to front, and the visible parts of each.
#include <frontmost/painter.h>

#include <shared_mutex>

#include "python/arrays.h"
#include "python/bindings.h"
#include "python/held.h"
#include "python/running.h"
#include "python/words.h"

FRONTMOST_WORDS(frontmost::PaintMethod, "method",
                {{frontmost::PaintMethod::depth_sort, "depth_sort"},
                 {frontmost::PaintMethod::bsp, "bsp"},
                 {frontmost::PaintMethod::farthest, "farthest"},
                 {frontmost::PaintMethod::centroid, "centroid"}});

namespace frontmost::python {
namespace {

using namespace py::literals;

/// Python's PaintOrder and VisibleParts. They keep the surfaces.
struct HeldOrder {
  std::shared_ptr<HeldSurfaces> of;
  std::uint64_t moves;  ///< HeldSurfaces::moves at the time of the search
  std::shared_ptr<const PaintOrder> order;
};
struct HeldParts {
  std::shared_ptr<const VisibleParts> parts;
};

struct PolygonRecord {
  std::uint32_t primitive, corner_count;
  std::uint64_t first_corner;
};

HeldOrder order_of(const std::shared_ptr<HeldSurfaces>& held, const View& view, PaintMethod method,
                   std::size_t most_polygons, std::size_t most_cuts, int threads, const py::object& progress) {
  PainterOptions options;
  options.method = method;
  options.most_polygons = most_polygons;
  options.most_cuts = most_cuts;
  return {held, held->moves, run(threads, progress, [&](const Execution& execution) {
            const std::shared_lock lock(held->scene->reading);
            return std::make_shared<const PaintOrder>(painter(held->surfaces, view, options, execution));
          })};
}

HeldVisible painted(const HeldOrder& held) {
  if (held.moves != held.of->moves)
    throw Error(ErrorCode::bad_argument, "order", "objects were moved since; look at the surfaces again");
  return held_visible(held.of, run(1, py::none(), [&](const Execution&) {
                        const std::shared_lock lock(held.of->scene->reading);
                        return held.of->share(paint(held.of->surfaces, *held.order));
                      }));
}

HeldParts parts_of(const HeldOrder& held, int threads, const py::object& progress) {
  return {run(threads, progress, [&](const Execution& execution) {
    return std::make_shared<const VisibleParts>(visible_parts(*held.order, Occluders::all(), execution));
  })};
}

py::dict steps_of(const HeldOrder& held) {
  const PaintSteps& steps = held.order->steps;
  return py::dict("depths_apart"_a = steps.depths_apart, "boxes_apart"_a = steps.boxes_apart, "behind"_a = steps.behind,
                  "before"_a = steps.before, "projections_apart"_a = steps.projections_apart,
                  "compared"_a = steps.compared, "exchanges"_a = steps.exchanges, "cycles"_a = steps.cycles,
                  "largest_cycle"_a = steps.largest_cycle, "cuts"_a = steps.cuts);
}

Array<double> corners_of(const std::vector<PaintCorner>& corners) {
  Array<double> out(ArrayShape{py::ssize_t(corners.size()), 3});
  double* data = out.mutable_data();
  for (const PaintCorner& corner : corners)
    for (int axis = 0; axis < 3; ++axis) *data++ = corner.at[axis];
  return out;
}

py::array_t<bool> cuts_of(const std::vector<PaintCorner>& corners) {
  py::array_t<bool> out(py::ssize_t(corners.size()));
  std::transform(corners.begin(), corners.end(), out.mutable_data(), [](const PaintCorner& c) { return c.is_cut; });
  return out;
}

/// Binds polygons, corners, is_cut and their number. `list_of(held)` returns the object that has them.
template <class Class, class ListOf>
void bind_polygons(Class& bound, const std::string& name, const ListOf& list_of) {
  using Held = typename Class::type;
  bound
      .def_property_readonly(
          "polygons",
          [list_of](const Held& held) {
            return records_of<PolygonRecord>(list_of(held).polygons, [](const PaintPolygon& polygon) {
              return PolygonRecord{polygon.id, polygon.corner_count, polygon.first_corner};
            });
          },
          doc((name + ".polygons").c_str()))
      .def_property_readonly(
          "corners", [list_of](const Held& held) { return corners_of(list_of(held).corners); },
          doc((name + ".corners").c_str()))
      .def_property_readonly(
          "is_cut", [list_of](const Held& held) { return cuts_of(list_of(held).corners); },
          doc((name + ".is_cut").c_str()))
      .def("__len__", [list_of](const Held& held) { return list_of(held).polygons.size(); })
      .def("__repr__", [list_of, name](const Held& held) {
        return name + " of " + std::to_string(list_of(held).polygons.size()) + " polygons";
      });
}

}  // namespace

void bind_painter(py::module_& m) {
  PYBIND11_NUMPY_DTYPE(PolygonRecord, primitive, corner_count, first_corner);
  py::class_<HeldOrder> order(m, "PaintOrder", doc("PaintOrder"));
  py::class_<HeldParts> parts(m, "VisibleParts", doc("VisibleParts"));
  bind_polygons(order, "PaintOrder", [](const HeldOrder& held) -> const PaintOrder& { return *held.order; });
  bind_polygons(parts, "VisibleParts", [](const HeldParts& held) -> const VisibleParts& { return *held.parts; });
  order.def_property_readonly("steps", &steps_of, doc("PaintOrder.steps"))
      .def("paint", &painted, doc("PaintOrder.paint"))
      .def("visible_parts", &parts_of, py::kw_only(), "threads"_a = 0, "progress"_a = py::none(),
           doc("PaintOrder.visible_parts"));
  const PainterOptions usual;
  py::class_<HeldSurfaces, std::shared_ptr<HeldSurfaces>>(m.attr("Surfaces"))
      .def("painter", &order_of, "view"_a, py::kw_only(), "method"_a = PaintMethod::depth_sort,
           "most_polygons"_a = usual.most_polygons, "most_cuts"_a = usual.most_cuts, "threads"_a = 0,
           "progress"_a = py::none(), doc("Surfaces.painter"));
}

}  // namespace frontmost::python
