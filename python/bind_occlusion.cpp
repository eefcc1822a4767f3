// SPDX-License-Identifier: Apache-2.0
// Occlusion culling: objects and boxes that are certainly hidden in a view.
#include <frontmost/occlusion.h>

#include <mutex>
#include <shared_mutex>

#include "python/arrays.h"
#include "python/bindings.h"
#include "python/held.h"
#include "python/running.h"
#include "python/words.h"

FRONTMOST_WORDS(frontmost::ObjectUnit, "unit",
                {{frontmost::ObjectUnit::instances, "instances"},
                 {frontmost::ObjectUnit::parts, "parts"},
                 {frontmost::ObjectUnit::clusters, "clusters"}});
FRONTMOST_WORDS(frontmost::ObjectSight, "sight",
                {{frontmost::ObjectSight::outside, "outside"},
                 {frontmost::ObjectSight::hidden, "hidden"},
                 {frontmost::ObjectSight::may_be_seen, "may_be_seen"}});

namespace frontmost::python {
namespace {

using namespace py::literals;

/// Python's Occlusion. Keeps the surfaces, and serves one thread at a time.
struct HeldOcclusion {
  HeldOcclusion(std::shared_ptr<HeldSurfaces> surfaces, ObjectUnit unit, const Execution& execution)
      : of(std::move(surfaces)), occlusion(of->surfaces, unit, execution) {}

  const std::shared_ptr<HeldSurfaces> of;
  Occlusion occlusion;
  std::mutex asking;  ///< never waited for while holding the interpreter's lock
};

std::unique_ptr<HeldOcclusion> occlusion_of(const std::shared_ptr<HeldSurfaces>& of, ObjectUnit unit, int threads,
                                            const py::object& progress) {
  return run(threads, progress, [&](const Execution& execution) {
    const std::shared_lock lock(of->scene->reading);
    return std::make_unique<HeldOcclusion>(of, unit, execution);
  });
}

py::object sights_of(HeldOcclusion& held, const View& view, int cell, int threads, const py::object& progress) {
  Buffer<std::uint8_t> sights = run(threads, progress, [&](const Execution& execution) {
    const std::scoped_lock asking(held.asking);
    const std::shared_lock lock(held.of->scene->reading);
    const std::span<const ObjectSight> found = held.occlusion.cull(view, {cell}, execution);
    Buffer<std::uint8_t> copy(found.size());
    std::transform(found.begin(), found.end(), copy.begin(), [](ObjectSight sight) { return std::uint8_t(sight); });
    return copy;
  });
  const auto size = py::ssize_t(sights.size());
  return owned(std::move(sights), {size});
}

std::vector<Box> boxes_from(const py::handle& given) {
  const auto values = numbers<float>(given, "boxes", {-1, 2, 3});
  std::vector<Box> boxes(static_cast<std::size_t>(values.shape(0)));
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const float* const v = values.data() + 6 * i;
    boxes[i] = {{v[0], v[1], v[2]}, {v[3], v[4], v[5]}};
    if (std::any_of(v, v + 6, [](float value) { return std::isnan(value); }))
      throw py::value_error("boxes: box " + std::to_string(i) + " holds NaN");
  }
  return boxes;
}

py::array_t<bool> are_hidden(HeldOcclusion& held, const py::object& given) {
  const std::vector<Box> boxes = boxes_from(given);
  std::vector<ObjectSight> sights(boxes.size());
  run(1, py::none(), [&](const Execution&) {
    const std::scoped_lock asking(held.asking);
    held.occlusion.find_sights(boxes, sights);
  });
  py::array_t<bool> out(py::ssize_t(sights.size()));
  std::transform(sights.begin(), sights.end(), out.mutable_data(),
                 [](ObjectSight sight) { return sight != ObjectSight::may_be_seen; });
  return out;
}

/// An array with one number for each object.
template <class NumberOf>
Array<std::uint32_t> numbers_of_objects(const Occlusion& occlusion, const NumberOf& number_of) {
  Array<std::uint32_t> out(py::ssize_t(occlusion.object_count()));
  for (std::size_t i = 0; i < occlusion.object_count(); ++i) out.mutable_data()[i] = number_of(occlusion.object(i));
  return out;
}

Array<std::uint32_t> triangles_of(const HeldOcclusion& held, std::size_t number) {
  const std::size_t count = held.occlusion.object_count();
  if (number >= count)
    throw py::value_error("number: there is no object " + std::to_string(number) + " of " + std::to_string(count));
  const std::span<const std::uint32_t> triangles = held.occlusion.triangles(number);
  return Array<std::uint32_t>(py::ssize_t(triangles.size()), triangles.data());
}

}  // namespace

void bind_occlusion(py::module_& m) {
  m.attr("object_sights") = words_of<ObjectSight>();
  py::class_<HeldOcclusion>(m, "Occlusion", doc("Occlusion"))
      .def(py::init(&occlusion_of), "surfaces"_a, py::kw_only(), "unit"_a = ObjectUnit::instances, "threads"_a = 0,
           "progress"_a = py::none())
      .def("cull", &sights_of, "view"_a, py::kw_only(), "cell"_a = 2, "threads"_a = 0, "progress"_a = py::none(),
           doc("Occlusion.cull"))
      .def("is_hidden", &are_hidden, "boxes"_a, doc("Occlusion.is_hidden"))
      .def_property_readonly(
          "object",
          [](const HeldOcclusion& held) {
            return numbers_of_objects(held.occlusion, [](const CulledObject& object) { return object.instance; });
          },
          doc("Occlusion.object"))
      .def_property_readonly(
          "part",
          [](const HeldOcclusion& held) {
            return numbers_of_objects(held.occlusion, [](const CulledObject& object) { return object.part; });
          },
          doc("Occlusion.part"))
      .def("triangles", &triangles_of, "number"_a, doc("Occlusion.triangles"))
      .def_property_readonly(
          "surfaces", [](const HeldOcclusion& held) { return held.of; }, doc("Occlusion.surfaces"))
      .def("__len__", [](const HeldOcclusion& held) { return held.occlusion.object_count(); })
      .def("__repr__", [](const HeldOcclusion& held) {
        return "Occlusion of " + std::to_string(held.occlusion.object_count()) + " objects";
      });
}

}  // namespace frontmost::python
