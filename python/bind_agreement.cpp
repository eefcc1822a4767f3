// SPDX-License-Identifier: Apache-2.0
// Compares two answers: exact arithmetic decides at each differing sample whether both may be right.
#include <frontmost/precision.h>

#include <shared_mutex>

#include "python/arrays.h"
#include "python/bindings.h"
#include "python/held.h"
#include "python/running.h"
#include "python/words.h"

FRONTMOST_WORDS(frontmost::Difference, "difference",
                {{frontmost::Difference::none, "none"},
                 {frontmost::Difference::edge, "edge"},
                 {frontmost::Difference::depth, "depth"},
                 {frontmost::Difference::translucent, "translucent"},
                 {frontmost::Difference::unexplained, "unexplained"}});

namespace frontmost::python {
namespace {

using namespace py::literals;
using HeldAgreement = std::shared_ptr<const Agreement>;

/// Python's Agreement.
struct AgreementArrays {
  HeldAgreement found;
};

AgreementArrays agreement_of(const HeldVisible& held, const HeldVisible& other,
                             const std::optional<HeldVisible>& behind, int threads, const py::object& progress) {
  held.check_current();
  other.check_same(*held.of, "other");
  if (behind) behind->check_same(*held.of, "behind");
  return {run(threads, progress, [&](const Execution& execution) {
    const std::shared_lock lock(held.of->scene->reading);
    Agreement found = check_agreement(held.of->surfaces, *held.visible, *other.visible, execution);
    if (behind) see_through(found, held.of->surfaces, *other.visible, *behind->visible);
    return std::make_shared<const Agreement>(std::move(found));
  })};
}

py::dict counts_of_differences(const AgreementArrays& agreement) {
  py::dict counts;
  for (const auto& [difference, word] : Words<Difference>::all)
    counts[py::str(word.data(), word.size())] = agreement.found->count(difference);
  return counts;
}

py::array_t<std::uint8_t> differences_of(const AgreementArrays& agreement) {
  const View& view = agreement.found->view;
  return view_of(reinterpret_cast<const std::uint8_t*>(agreement.found->differences.data()),
                 {view.samples, view.height, view.width}, agreement.found);
}

}  // namespace

void bind_agreement(py::module_& m) {
  m.attr("difference_kinds") = words_of<Difference>();
  py::class_<AgreementArrays>(m, "Agreement", doc("Agreement"))
      .def_property_readonly("counts", &counts_of_differences, doc("Agreement.counts"))
      .def_property_readonly("differences", &differences_of, doc("Agreement.differences"))
      .def_property_readonly(
          "differing", [](const AgreementArrays& agreement) { return agreement.found->differing(); },
          doc("Agreement.differing"))
      .def("__repr__", [](const AgreementArrays& agreement) {
        return "Agreement: " + std::to_string(agreement.found->differing()) + " of " +
               std::to_string(agreement.found->differences.size()) + " samples differ, " +
               std::to_string(agreement.found->count(Difference::unexplained)) + " of them unexplained";
      });
  py::class_<HeldVisible>(m.attr("Visible"))
      .def("check_agreement", &agreement_of, "other"_a, py::kw_only(), "behind"_a = py::none(), "threads"_a = 0,
           "progress"_a = py::none(), doc("Visible.check_agreement"));
}

}  // namespace frontmost::python
