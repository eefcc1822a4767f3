// SPDX-License-Identifier: Apache-2.0
// Resolution of a depth buffer: as a function of distance, and compared with the exact answer in a picture.
#include <frontmost/pictures.h>
#include <frontmost/precision.h>
#include <frontmost/zbuffer.h>

#include <shared_mutex>

#include "python/arrays.h"
#include "python/bindings.h"
#include "python/depth_fights.h"
#include "python/depth_words.h"
#include "python/pictures.h"
#include "python/running.h"

namespace frontmost::python {
namespace {

using namespace py::literals;

// Resolution as a function of distance.

/// A function of a setup and an array of distances. The result has the array's shape.
template <class Function>
auto of_distances(const Function& function) {
  return [function](const DepthSetup& setup, const py::array_t<double>& distance) {
    return py::vectorize([&](double at) { return function(setup, at); })(distance);
  };
}

template <double (*gap)(const DepthSetup&, double, std::optional<double>)>
py::object gaps_with_reach(const DepthSetup& setup, const py::array_t<double>& distance,
                           const std::optional<double>& reach) {
  return py::vectorize([&](double at) { return gap(setup, at, reach); })(distance);
}

std::string described_setup(const DepthSetup& setup) {
  char text[160];
  std::snprintf(text, sizeof text, "DepthSetup: %s%s%s, %g to %g", word_of(setup.format),
                setup.reversed ? ", reversed" : "", setup.orthographic ? ", orthographic" : "", setup.clip.near,
                setup.clip.far);
  return text;
}

void bind_setup(py::module_& m) {
  py::class_<DepthSetup>(m, "DepthSetup", doc("DepthSetup"))
      .def(py::init([](double near, double far, DepthFormat format, bool reversed, bool orthographic) {
             const DepthSetup setup{{near, far}, format, reversed, orthographic};
             (void)resolvable_gap(setup, near);  // throws for planes out of range
             return setup;
           }),
           "near"_a, "far"_a, py::kw_only(), "format"_a = DepthFormat::d24, "reversed"_a = false,
           "orthographic"_a = false)
      .def_property_readonly(
          "near", [](const DepthSetup& s) { return s.clip.near; }, doc("DepthSetup.near"))
      .def_property_readonly(
          "far", [](const DepthSetup& s) { return s.clip.far; }, doc("DepthSetup.far"))
      .def_readonly("format", &DepthSetup::format, doc("DepthSetup.format"))
      .def_readonly("reversed", &DepthSetup::reversed, doc("DepthSetup.reversed"))
      .def_readonly("orthographic", &DepthSetup::orthographic, doc("DepthSetup.orthographic"))
      .def("resolvable_gap", of_distances(&resolvable_gap), "distance"_a, doc("DepthSetup.resolvable_gap"))
      .def("rounding_gap", &gaps_with_reach<&rounding_gap>, "distance"_a, "reach"_a = py::none(),
           doc("DepthSetup.rounding_gap"))
      .def("certain_gap", &gaps_with_reach<&certain_gap>, "distance"_a, "reach"_a = py::none(),
           doc("DepthSetup.certain_gap"))
      .def("share_of_values", of_distances(&share_of_values), "distance"_a, doc("DepthSetup.share_of_values"))
      .def("near_for_gap", &near_for_gap, "distance"_a, "gap"_a, doc("DepthSetup.near_for_gap"))
      .def(
          "round_distances",
          [](const DepthSetup& s) {
            const std::vector<double> distances = round_distances(s.clip);
            return Array<double>(py::ssize_t(distances.size()), distances.data());
          },
          doc("DepthSetup.round_distances"))
      .def("__repr__", &described_setup);
}

// Resolution in a picture.

struct FightingPairRecord {
  std::uint32_t seen, nearer;
  std::uint64_t samples;
  double farthest;
};

/// Python's DepthFights.
struct HeldDepthFights {
  HeldExact by;
  std::shared_ptr<const DepthFights> found;
};

ArrayShape samples_of(const View& view) { return {view.samples, view.height, view.width}; }

HeldExact exact_of(const std::shared_ptr<HeldSurfaces>& held, const View& view, int threads,
                   const py::object& progress) {
  return {held,
          run(threads, progress,
              [&](const Execution& execution) {
                const std::shared_lock lock(held->scene->reading);
                return std::make_shared<const ExactVisible>(find_exact_visible(held->surfaces, view, execution));
              }),
          held->moves};
}

HeldDepthFights fights_of(const HeldExact& exact, const HeldVisible& answer, int threads, const py::object& progress) {
  answer.check_same(*exact.of, "answer");
  exact.check_current();
  return {exact, run(threads, progress, [&](const Execution& execution) {
            const std::shared_lock lock(exact.of->scene->reading);
            return std::make_shared<const DepthFights>(
                find_depth_fights(exact.of->surfaces, *exact.exact, *answer.visible, execution));
          })};
}

/// The heat map over the lit model, on black.
py::object heat_map(const HeldDepthFights& fights, int threads, const py::object& progress) {
  fights.by.check_current();
  return bitmap_array(run(threads, progress, [&](const Execution& execution) {
    const std::shared_lock lock(fights.by.of->scene->reading);
    const Surfaces& surfaces = fights.by.of->surfaces;
    ShadeOptions options;
    options.background = glm::vec3(0);
    const Visible visible = zbuffer(surfaces, fights.found->view, execution);
    return fight_image(*fights.found, shade(surfaces, visible, options, execution));
  }));
}

void bind_exact(py::module_& m) {
  py::class_<HeldExact>(m, "ExactVisible", doc("ExactVisible"))
      .def_property_readonly(
          "view", [](const HeldExact& e) { return e.exact->view; }, doc("ExactVisible.view"))
      .def_property_readonly(
          "primitives",
          [](const HeldExact& e) { return view_of(e.exact->primitives.data(), samples_of(e.exact->view), e.exact); },
          doc("ExactVisible.primitives"))
      .def_property_readonly(
          "tied",
          [](const HeldExact& e) {
            return view_of(e.exact->tied.data(), samples_of(e.exact->view), e.exact).attr("view")("bool");
          },
          doc("ExactVisible.tied"))
      .def("find_depth_fights", &fights_of, "answer"_a, py::kw_only(), "threads"_a = 0, "progress"_a = py::none(),
           doc("ExactVisible.find_depth_fights"))
      .def("__repr__", [](const HeldExact& e) {
        return "ExactVisible: " + std::to_string(e.exact->view.width) + "x" + std::to_string(e.exact->view.height) +
               " pixels";
      });
}

void bind_fights_of_picture(py::module_& m) {
  PYBIND11_NUMPY_DTYPE(FightingPairRecord, seen, nearer, samples, farthest);
  py::class_<HeldDepthFights>(m, "DepthFights", doc("DepthFights"))
      .def_property_readonly(
          "view", [](const HeldDepthFights& f) { return f.found->view; }, doc("DepthFights.view"))
      .def_property_readonly(
          "covered", [](const HeldDepthFights& f) { return f.found->covered; }, doc("DepthFights.covered"))
      .def_property_readonly(
          "wrong", [](const HeldDepthFights& f) { return f.found->wrong; }, doc("DepthFights.wrong"))
      .def_property_readonly(
          "tied", [](const HeldDepthFights& f) { return f.found->tied; }, doc("DepthFights.tied"))
      .def_property_readonly(
          "pairs",
          [](const HeldDepthFights& f) {
            return records_of<FightingPairRecord>(f.found->pairs, [](const FightingPair& pair) {
              return FightingPairRecord{pair.seen, pair.nearer, pair.samples, pair.farthest};
            });
          },
          doc("DepthFights.pairs"))
      .def_property_readonly(
          "errors",
          [](const HeldDepthFights& f) { return view_of(f.found->errors.data(), samples_of(f.found->view), f.found); },
          doc("DepthFights.errors"))
      .def("image", &heat_map, py::kw_only(), "threads"_a = 0, "progress"_a = py::none(), doc("DepthFights.image"))
      .def("__repr__", [](const HeldDepthFights& f) {
        return "DepthFights: " + std::to_string(f.found->wrong) + " of " + std::to_string(f.found->covered) +
               " samples are wrong";
      });
}

}  // namespace

void bind_precision(py::module_& m) {
  bind_setup(m);
  bind_fights_of_picture(m);
  bind_exact(m);
  py::class_<HeldSurfaces, std::shared_ptr<HeldSurfaces>>(m.attr("Surfaces"))
      .def("find_exact_visible", &exact_of, "view"_a, py::kw_only(), "threads"_a = 0, "progress"_a = py::none(),
           doc("Surfaces.find_exact_visible"));
}

}  // namespace frontmost::python
