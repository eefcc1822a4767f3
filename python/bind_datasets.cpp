// SPDX-License-Identifier: Apache-2.0
// Data sets, as frontmost report writes them: COCO, BOP and masks, of one view or many; categories.
#include <frontmost/files.h>
#include <frontmost/report.h>

#include <set>
#include <shared_mutex>

#include "python/arrays.h"
#include "python/bindings.h"
#include "python/held.h"
#include "python/running.h"
#include "python/words.h"

FRONTMOST_WORDS(frontmost::BopVisible, "visible",
                {{frontmost::BopVisible::exact, "exact"}, {frontmost::BopVisible::bop19, "bop19"}});

namespace frontmost::python {
namespace {

using namespace py::literals;

std::string path_of(const py::object& path) {
  return py::cast<std::string>(py::module_::import("os").attr("fspath")(path));
}

/// Options of counting and running.
struct Counting {
  double canvas;
  int threads;
  py::object progress;
};

/// Writes one Visible, or all that an iterable yields. `names` yields the pictures' names, or is None.
std::vector<std::string> write_views(DatasetOptions options, const py::object& seen, const py::object& names,
                                     const Counting& counting) {
  const bool is_one = py::isinstance<HeldVisible>(seen);
  options.are_masks_numbered = !is_one;
  DatasetWriter writer(options);
  py::iterator name;
  if (!names.is_none()) name = py::iter(names);
  std::size_t number = 0;
  const py::list alone = is_one ? py::list(py::make_tuple(seen)) : py::list();
  for (const py::handle one : is_one ? py::iter(alone) : py::iter(seen)) {
    const HeldVisible held = py::cast<HeldVisible>(one);
    held.check_current();
    std::string picture = held.of->scene->name + (is_one ? "" : "_" + std::to_string(number)) + ".png";
    if (!names.is_none()) {
      if (name == py::iterator::sentinel()) throw py::value_error("names: fewer than there are views");
      picture = py::cast<std::string>(*name);
      ++name;
    }
    run(counting.threads, counting.progress, [&](const Execution& execution) {
      const std::shared_lock lock(held.of->scene->reading);
      const Accounting accounts = account(held.of->surfaces, *held.visible, {.canvas = counting.canvas}, execution);
      writer.add({held.of->surfaces, *held.visible, accounts}, picture, execution);
    });
    ++number;
  }
  if (!names.is_none() && name != py::iterator::sentinel()) throw py::value_error("names: more than there are views");
  return writer.finish();
}

std::vector<std::string> write_coco(const py::object& path, const py::object& seen, const py::object& names,
                                    bool polygons, const std::vector<std::string>& leave_out, double canvas,
                                    int threads, const py::object& progress) {
  DatasetOptions options;
  options.coco = path_of(path);
  options.coco_polygons = polygons;
  options.leave_out = leave_out;
  return write_views(options, seen, names, {canvas, threads, progress});
}

std::vector<std::string> write_bop(const py::object& folder, const py::object& seen, BopVisible visible,
                                   const std::vector<std::string>& leave_out, double canvas, int threads,
                                   const py::object& progress) {
  DatasetOptions options;
  options.bop = path_of(folder);
  options.bop_visible = visible;
  options.leave_out = leave_out;
  return write_views(options, seen, py::none(), {canvas, threads, progress});
}

std::vector<std::string> write_masks(const py::object& folder, const py::object& seen,
                                     const std::vector<std::string>& leave_out, int threads,
                                     const py::object& progress) {
  DatasetOptions options;
  options.masks = path_of(folder);
  options.leave_out = leave_out;
  return write_views(options, seen, py::none(), {1, threads, progress});
}

/// Sets categories by making the text of a category file, so that the same rules apply.
void set_categories(HeldScene& held, const py::dict& of_objects) {
  py::dict objects;
  py::list categories, known;
  bool has_numbers = false;
  std::set<std::string_view> names;
  for (const Instance& instance : held.scene->instances) names.insert(instance.name);
  for (const auto& [object, category] : of_objects) {
    if (!py::isinstance<py::str>(object)) throw py::type_error("categories: keys must be names of objects");
    if (const auto wanted = py::cast<std::string>(object); !names.contains(wanted))
      throw py::value_error("categories: none is called '" + printable_text(wanted) + "'");
    py::object name = py::reinterpret_borrow<py::object>(category), number = py::none();
    if (py::isinstance<py::tuple>(category) && py::len(category) == 2) {
      number = name[py::int_(0)];
      name = name[py::int_(1)];
    } else if (PyIndex_Check(category.ptr()) != 0) {
      number = py::reinterpret_steal<py::object>(PyNumber_Index(category.ptr()));
      name = py::str(number);
    }
    if (!py::isinstance<py::str>(name) || !(number.is_none() || PyIndex_Check(number.ptr()) != 0))
      throw py::type_error("categories: values must be names, numbers, or (number, name)");
    objects[object] = name;
    has_numbers |= !number.is_none();
    const py::object entry = number.is_none() ? name : py::dict("name"_a = name, "number"_a = number);
    if (!known.contains(entry)) known.append(entry);
  }
  py::dict said("objects"_a = objects);
  if (has_numbers) said["categories"] = known;
  const auto text = py::cast<std::string>(py::module_::import("json").attr("dumps")(said));
  load_categories(std::as_bytes(std::span(text)), "categories", held.writable());
}

}  // namespace

void bind_datasets(py::module_& m) {
  const std::vector<std::string> nothing;
  m.def("write_coco", &write_coco, "path"_a, "seen"_a, py::kw_only(), "names"_a = py::none(), "polygons"_a = false,
        "leave_out"_a = nothing, "canvas"_a = 3.0, "threads"_a = 0, "progress"_a = py::none(), doc("write_coco"));
  m.def("write_bop", &write_bop, "folder"_a, "seen"_a, py::kw_only(), "visible"_a = BopVisible::exact,
        "leave_out"_a = nothing, "canvas"_a = 3.0, "threads"_a = 0, "progress"_a = py::none(), doc("write_bop"));
  m.def("write_masks", &write_masks, "folder"_a, "seen"_a, py::kw_only(), "leave_out"_a = nothing, "threads"_a = 0,
        "progress"_a = py::none(), doc("write_masks"));
  py::class_<HeldScene>(m.attr("Scene"))
      .def("set_categories", &set_categories, "categories"_a, doc("Scene.set_categories"));
}

}  // namespace frontmost::python
