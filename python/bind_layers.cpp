// SPDX-License-Identifier: Apache-2.0
// All surfaces of a pixel: layers in the order of depth, and fragments as data.
#include <frontmost/abuffer.h>

#include <shared_mutex>

#include "python/arrays.h"
#include "python/bindings.h"
#include "python/held.h"
#include "python/running.h"

namespace frontmost::python {
namespace {

using namespace py::literals;

py::list layers_of(const HeldVisible& held, int count, float opacity, int threads, const py::object& progress) {
  held.check_current();
  AbufferOptions options;
  options.opacity = opacity;
  std::vector<Visible> layers = run(threads, progress, [&](const Execution& execution) {
    const std::shared_lock lock(held.of->scene->reading);
    return visible_layers(held.of->surfaces, held.visible->view, count, options, execution);
  });
  py::list list;
  for (Visible& layer : layers) list.append(held_visible(held.of, held.of->share(std::move(layer))));
  return list;
}

using HeldFragments = std::shared_ptr<const FragmentLists>;

/// Python's Fragments.
struct FragmentArrays {
  HeldFragments lists;
  [[nodiscard]] py::array rows() const {
    return view_of(lists->fragments.data(), {py::ssize_t(lists->fragments.size())}, lists);
  }
};

FragmentArrays fragments_of(const std::shared_ptr<HeldSurfaces>& held, const View& view, int grid, float opacity,
                            int threads, const py::object& progress) {
  return {run(threads, progress, [&](const Execution& execution) {
    const std::shared_lock lock(held->scene->reading);
    return std::make_shared<const FragmentLists>(abuffer(held->surfaces, view, {grid, opacity}, execution));
  })};
}

py::array_t<std::int32_t> sub_samples_of(const FragmentArrays& fragments) {
  const std::vector<glm::ivec2>& samples = fragments.lists->samples;
  return view_of(&samples.data()->x, {py::ssize_t(samples.size()), 2}, fragments.lists);
}

}  // namespace

void bind_layers(py::module_& m) {
  PYBIND11_NUMPY_DTYPE(Fragment, mask, primitive, key, key_dx, key_dy, opacity);
  py::class_<FragmentArrays>(m, "Fragments", doc("Fragments"))
      .def_property_readonly("rows", &FragmentArrays::rows, doc("Fragments.rows"))
      .def_property_readonly(
          "first",
          [](const FragmentArrays& f) {
            return view_of(f.lists->first.data(), {py::ssize_t(f.lists->first.size())}, f.lists);
          },
          doc("Fragments.first"))
      .def_property_readonly("samples", &sub_samples_of, doc("Fragments.samples"))
      .def(
          "at",
          [](const FragmentArrays& f, int x, int y) -> py::array {
            const View& view = f.lists->view;
            if (x < 0 || y < 0 || x >= view.width || y >= view.height)
              throw py::value_error("x, y: there is no pixel " + std::to_string(x) + ", " + std::to_string(y));
            const std::span<const Fragment> rows = f.lists->at(x, y);
            return view_of(rows.data(), {py::ssize_t(rows.size())}, f.lists);
          },
          "x"_a, "y"_a, doc("Fragments.at"))
      .def("__len__", [](const FragmentArrays& f) { return f.lists->fragments.size(); })
      .def("__repr__", [](const FragmentArrays& f) {
        return "Fragments: " + std::to_string(f.lists->fragments.size()) + " in " +
               std::to_string(f.lists->view.width) + "x" + std::to_string(f.lists->view.height) + " pixels";
      });
  py::class_<HeldSurfaces, std::shared_ptr<HeldSurfaces>>(m.attr("Surfaces"))
      .def("abuffer", &fragments_of, "view"_a, py::kw_only(), "grid"_a = 0, "opacity"_a = 1.0f, "threads"_a = 0,
           "progress"_a = py::none(), doc("Surfaces.abuffer"));
  py::class_<HeldVisible>(m.attr("Visible"))
      .def("layers", &layers_of, "count"_a, py::kw_only(), "opacity"_a = 1.0f, "threads"_a = 0,
           "progress"_a = py::none(), doc("Visible.layers"));
}

}  // namespace frontmost::python
