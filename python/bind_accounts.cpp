// SPDX-License-Identifier: Apache-2.0
// For each object, how much is visible and why the rest is not; masks.
#include <frontmost/report.h>

#include <shared_mutex>

#include "python/arrays.h"
#include "python/bindings.h"
#include "python/held.h"
#include "python/running.h"
#include "python/words.h"

FRONTMOST_WORDS(frontmost::MaskPart, "part",
                {{frontmost::MaskPart::visible, "visible"}, {frontmost::MaskPart::whole, "whole"}});

namespace frontmost::python {
namespace {

using namespace py::literals;

/// An array with one element for each object.
template <class T, class ValueOf>
Array<T> by_object(const Accounting& accounts, const ValueOf& value_of_account) {
  Array<T> out(py::ssize_t(accounts.objects.size()));
  for (std::size_t i = 0; i < accounts.objects.size(); ++i)
    out.mutable_data()[i] = value_of_account(accounts.objects[i]);
  return out;
}

template <SampleSet ObjectAccount::*part>
Array<std::uint64_t> counts_of(const Accounting& accounts) {
  return by_object<std::uint64_t>(accounts, [](const ObjectAccount& a) { return (a.*part).count; });
}

template <SampleSet ObjectAccount::*part>
Array<std::int32_t> boxes_of(const Accounting& accounts) {
  Array<std::int32_t> out(ArrayShape{py::ssize_t(accounts.objects.size()), 4});
  std::int32_t* data = out.mutable_data();
  for (const ObjectAccount& account : accounts.objects)
    for (const int value :
         {(account.*part).box.x, (account.*part).box.y, (account.*part).box.width, (account.*part).box.height})
      *data++ = value;
  return out;
}

Array<std::uint64_t> pairs_of(const std::vector<HiddenSamples>& pairs) {
  Array<std::uint64_t> out(ArrayShape{py::ssize_t(pairs.size()), 3});
  std::uint64_t* data = out.mutable_data();
  for (const HiddenSamples& pair : pairs)
    for (const std::uint64_t value : {std::uint64_t(pair.object), std::uint64_t(pair.hider), pair.count})
      *data++ = value;
  return out;
}

std::shared_ptr<const Accounting> account_of(const HeldVisible& held, double canvas, bool all_hiders, int threads,
                                             const py::object& progress) {
  held.check_current();
  AccountingOptions options;
  options.canvas = canvas;
  options.all_hiders = all_hiders;
  return run(threads, progress, [&](const Execution& execution) {
    const std::shared_lock lock(held.of->scene->reading);
    return std::make_shared<const Accounting>(account(held.of->surfaces, *held.visible, options, execution));
  });
}

// Explanations.

/// Python's Explanation. Keeps the scene for its texts.
struct HeldExplanation {
  std::shared_ptr<const KeptScene> scene;
  Explanation said;
};

HeldExplanation explain_one(const HeldVisible& held, const py::object& object, int threads,
                            const py::object& progress) {
  held.check_current();
  const std::uint32_t number = object_of(*held.of->scene, object);
  return {held.of->scene, run(threads, progress, [&](const Execution& execution) {
            const std::shared_lock lock(held.of->scene->reading);
            return explain(held.of->surfaces, held.visible->view, number, execution);
          })};
}

py::list report_of(const HeldVisible& held, int threads, const py::object& progress) {
  held.check_current();
  const auto said = run(threads, progress, [&](const Execution& execution) {
    const std::shared_lock lock(held.of->scene->reading);
    const Accounting accounts = account(held.of->surfaces, *held.visible, {}, execution);
    return explain_all(held.of->surfaces, *held.visible, accounts, execution);
  });
  py::list list;
  for (const Explanation& one : said) list.append(HeldExplanation{held.of->scene, one});
  return list;
}

py::list hiders_of(const HeldExplanation& e) {
  py::list list;
  for (const HiderShare& hider : e.said.hiders) list.append(py::make_tuple(hider.object, hider.share));
  return list;
}

// Masks.

PixelMask mask_of_object(const HeldVisible& held, const py::object& object) {
  held.check_current();
  const std::uint32_t number = object_of(*held.of->scene, object);
  return run(0, py::none(), [&](const Execution& execution) {
    const std::shared_lock lock(held.of->scene->reading);
    return PixelMasks(held.of->surfaces, *held.visible, execution).of(number);
  });
}

py::array_t<bool> mask_array(const HeldVisible& held, const py::object& object, MaskPart part) {
  const PixelMask mask = mask_of_object(held, object);
  const View& view = held.visible->view;
  py::array_t<bool> out(ArrayShape{view.height, view.width});
  bool* const data = out.mutable_data();
  std::fill(data, data + out.size(), false);
  for (int y = 0; y < mask.box.height; ++y)
    for (int x = 0; x < mask.box.width; ++x) {
      const MaskPixel pixel = mask.pixels[std::size_t(y) * std::size_t(mask.box.width) + std::size_t(x)];
      data[py::ssize_t(y + mask.box.y) * view.width + x + mask.box.x] =
          pixel == MaskPixel::visible || (part == MaskPart::whole && pixel == MaskPixel::hidden);
    }
  return out;
}

void bind_accounting(py::module_& m) {
  py::class_<Accounting, std::shared_ptr<Accounting>>(m, "Accounting", doc("Accounting"))
      .def_property_readonly("alone", &counts_of<&ObjectAccount::alone>, doc("Accounting.alone"))
      .def_property_readonly("in_frame", &counts_of<&ObjectAccount::in_frame>, doc("Accounting.in_frame"))
      .def_property_readonly("visible", &counts_of<&ObjectAccount::visible>, doc("Accounting.visible"))
      .def_property_readonly("alone_boxes", &boxes_of<&ObjectAccount::alone>, doc("Accounting.alone_boxes"))
      .def_property_readonly("in_frame_boxes", &boxes_of<&ObjectAccount::in_frame>, doc("Accounting.in_frame_boxes"))
      .def_property_readonly("visible_boxes", &boxes_of<&ObjectAccount::visible>, doc("Accounting.visible_boxes"))
      .def_property_readonly(
          "visible_share",
          [](const Accounting& a) {
            return by_object<double>(a, [](const ObjectAccount& o) { return o.visible_share(); });
          },
          doc("Accounting.visible_share"))
      .def_property_readonly(
          "hidden_share",
          [](const Accounting& a) {
            return by_object<double>(a, [](const ObjectAccount& o) { return o.hidden_share(); });
          },
          doc("Accounting.hidden_share"))
      .def_property_readonly(
          "cut_share",
          [](const Accounting& a) {
            return by_object<double>(a, [](const ObjectAccount& o) { return o.cut_share(); });
          },
          doc("Accounting.cut_share"))
      .def_property_readonly(
          "distance",
          [](const Accounting& a) { return by_object<float>(a, [](const ObjectAccount& o) { return o.distance; }); },
          doc("Accounting.distance"))
      .def_property_readonly(
          "is_cut_by_near",
          [](const Accounting& a) {
            return by_object<bool>(a, [](const ObjectAccount& o) { return o.is_cut_by_near; });
          },
          doc("Accounting.is_cut_by_near"))
      .def_readonly("background", &Accounting::background, doc("Accounting.background"))
      .def_property_readonly(
          "hidden_by_front", [](const Accounting& a) { return pairs_of(a.hidden_by_front); },
          doc("Accounting.hidden_by_front"))
      .def_property_readonly(
          "hidden_by_any", [](const Accounting& a) { return pairs_of(a.hidden_by_any); },
          doc("Accounting.hidden_by_any"))
      .def_property_readonly(
          "hidden_only_by", [](const Accounting& a) { return pairs_of(a.hidden_only_by); },
          doc("Accounting.hidden_only_by"))
      .def("__len__", [](const Accounting& a) { return a.objects.size(); })
      .def("__repr__", [](const Accounting& a) {
        std::size_t seen = 0;
        for (const ObjectAccount& object : a.objects) seen += object.visible.count > 0;
        return "Accounting: " + std::to_string(seen) + " of " + std::to_string(a.objects.size()) + " objects are seen";
      });
}

void bind_explanations(py::module_& m) {
  py::class_<HeldExplanation>(m, "Explanation", doc("Explanation"))
      .def_property_readonly(
          "object", [](const HeldExplanation& e) { return e.said.object; }, doc("Explanation.object"))
      .def_property_readonly(
          "reason", [](const HeldExplanation& e) { return std::string(name(e.said.reason)); },
          doc("Explanation.reason"))
      .def_property_readonly(
          "visible_share", [](const HeldExplanation& e) { return e.said.visible_share; },
          doc("Explanation.visible_share"))
      .def_property_readonly(
          "hidden_share", [](const HeldExplanation& e) { return e.said.hidden_share; }, doc("Explanation.hidden_share"))
      .def_property_readonly(
          "cut_share", [](const HeldExplanation& e) { return e.said.cut_share; }, doc("Explanation.cut_share"))
      .def_property_readonly("hiders", &hiders_of, doc("Explanation.hiders"))
      .def_property_readonly(
          "remedy", [](const HeldExplanation& e) { return utf8_text(remedy_text(e.said, *e.scene)); },
          doc("Explanation.remedy"))
      .def(
          "remedied", [](const HeldExplanation& e, const View& view) { return remedied(view, e.said.remedy); },
          "view"_a, doc("Explanation.remedied"))
      .def("__str__", [](const HeldExplanation& e) { return utf8_text(sentence(e.said, *e.scene)); })
      .def("__repr__", [](const HeldExplanation& e) { return utf8_text(sentence(e.said, *e.scene)); });
}

}  // namespace

void bind_accounts(py::module_& m) {
  bind_accounting(m);
  bind_explanations(m);
  py::class_<HeldVisible>(m.attr("Visible"))
      .def("account", &account_of, py::kw_only(), "canvas"_a = 3.0, "all_hiders"_a = false, "threads"_a = 0,
           "progress"_a = py::none(), doc("Visible.account"))
      .def("report", &report_of, py::kw_only(), "threads"_a = 0, "progress"_a = py::none(), doc("Visible.report"))
      .def("explain", &explain_one, "object"_a, py::kw_only(), "threads"_a = 0, "progress"_a = py::none(),
           doc("Visible.explain"))
      .def("mask", &mask_array, "object"_a, py::kw_only(), "part"_a = MaskPart::visible, doc("Visible.mask"))
      .def(
          "coco_runs",
          [](const HeldVisible& held, const py::object& object, MaskPart part) {
            const View& view = held.visible->view;
            return coco_runs(mask_of_object(held, object), part, {view.width, view.height});
          },
          "object"_a, py::kw_only(), "part"_a = MaskPart::visible, doc("Visible.coco_runs"))
      .def(
          "coco_polygons",
          [](const HeldVisible& held, const py::object& object, MaskPart part) {
            return coco_polygons(mask_of_object(held, object), part);
          },
          "object"_a, py::kw_only(), "part"_a = MaskPart::visible, doc("Visible.coco_polygons"));
}

}  // namespace frontmost::python
