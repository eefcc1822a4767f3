// SPDX-License-Identifier: Apache-2.0
// The depth buffer with OpenGL's state: triangles are drawn in the order of their numbers, and depths are stored as in
// the buffer's format.
#include <frontmost/zbuffer.h>

#include <mutex>
#include <optional>
#include <shared_mutex>

#include "python/arrays.h"
#include "python/bindings.h"
#include "python/depth_words.h"
#include "python/held.h"
#include "python/running.h"

FRONTMOST_WORDS(frontmost::DepthFunc, "func",
                {{frontmost::DepthFunc::never, "never"},
                 {frontmost::DepthFunc::less, "less"},
                 {frontmost::DepthFunc::equal, "equal"},
                 {frontmost::DepthFunc::less_equal, "less_equal"},
                 {frontmost::DepthFunc::greater, "greater"},
                 {frontmost::DepthFunc::not_equal, "not_equal"},
                 {frontmost::DepthFunc::greater_equal, "greater_equal"},
                 {frontmost::DepthFunc::always, "always"}});

namespace frontmost::python {
namespace {

using namespace py::literals;

/// Python's DepthBuffer. Its ids belong to one Surfaces, which it keeps.
struct HeldDepthBuffer {
  HeldDepthBuffer(int width, int height, int samples, DepthFormat format)
      : shape{samples, height, width}, buffer(width, height, samples, format) {}

  ArrayShape shape;
  DepthBuffer buffer;
  std::shared_ptr<HeldSurfaces> of;
  std::uint64_t moves = 0;  ///< HeldSurfaces::moves at the last draw
  std::optional<View> view;
  std::mutex drawing;  ///< never waited for while holding the interpreter's lock
};

/// Calls `work` with exclusive access to the buffer.
template <class Work>
auto with(HeldDepthBuffer& held, int threads, const py::object& progress, const Work& work) {
  return run(threads, progress, [&](const Execution& execution) {
    const std::scoped_lock lock(held.drawing);
    return work(held.buffer, execution);
  });
}

void draw_into(HeldDepthBuffer& held, const std::shared_ptr<HeldSurfaces>& surfaces, const View& view, DepthFunc func,
               bool mask, const std::pair<double, double>& range, bool nearer_is_greater,
               const std::pair<double, double>& polygon_offset, double offset_clamp, std::uint32_t begin,
               std::uint32_t end, int threads, const py::object& progress) {
  if (held.of && held.of != surfaces)
    throw Error(ErrorCode::bad_argument, "surfaces", "this buffer shows others; clear() forgets them");
  DepthDraw call;
  call.state = {func,
                mask,
                range.first,
                range.second,
                nearer_is_greater,
                {polygon_offset.first, polygon_offset.second, offset_clamp}};
  call.begin = begin;
  call.end = end;
  with(held, threads, progress, [&](DepthBuffer& buffer, const Execution& execution) {
    const std::shared_lock lock(surfaces->scene->reading);
    buffer.draw(surfaces->surfaces, view, call, execution);
  });
  held.of = surfaces;
  held.moves = surfaces->moves;
  held.view = view;
}

HeldVisible visible_of(HeldDepthBuffer& held) {
  if (!held.of) throw Error(ErrorCode::bad_argument, "buffer", "nothing was drawn yet");
  auto visible = with(held, 1, py::none(), [&](const DepthBuffer& buffer, const Execution&) {
    return held.of->share(buffer.visible(*held.view));
  });
  return {held.of, std::move(visible), held.moves};
}

}  // namespace

void bind_depth_buffer(py::module_& m) {
  py::class_<HeldDepthBuffer>(m, "DepthBuffer", doc("DepthBuffer"))
      .def(py::init<int, int, int, DepthFormat>(), "width"_a, "height"_a, py::kw_only(), "samples"_a = 1,
           "format"_a = DepthFormat::d24)
      .def(
          "clear",
          [](HeldDepthBuffer& held, double depth) {
            with(held, 1, py::none(), [&](DepthBuffer& buffer, const Execution&) { buffer.clear(depth); });
            held.of = nullptr;
          },
          "depth"_a = 1.0, doc("DepthBuffer.clear"))
      .def("draw", &draw_into, "surfaces"_a, "view"_a, py::kw_only(), "func"_a = DepthFunc::less, "mask"_a = true,
           "range"_a = py::make_tuple(0.0, 1.0), "nearer_is_greater"_a = false,
           "polygon_offset"_a = py::make_tuple(0.0, 0.0), "offset_clamp"_a = 0.0, "begin"_a = 0u,
           "end"_a = no_primitive, "threads"_a = 0, "progress"_a = py::none(), doc("DepthBuffer.draw"))
      .def_property_readonly(
          "stored",
          [](HeldDepthBuffer& held) {
            Buffer<std::uint32_t> copy = with(held, 1, py::none(), [](const DepthBuffer& buffer, const Execution&) {
              return Buffer<std::uint32_t>(buffer.stored());
            });
            return owned(std::move(copy), held.shape);
          },
          doc("DepthBuffer.stored"))
      .def_property_readonly(
          "depths",
          [](HeldDepthBuffer& held) {
            Buffer<float> depths =
                with(held, 1, py::none(), [](const DepthBuffer& buffer, const Execution&) { return buffer.depths(); });
            return owned(std::move(depths), held.shape);
          },
          doc("DepthBuffer.depths"))
      .def("visible", &visible_of, doc("DepthBuffer.visible"))
      .def("__repr__", [](const HeldDepthBuffer& held) {
        return "DepthBuffer of " + std::to_string(held.shape[2]) + "x" + std::to_string(held.shape[1]) + " pixels, " +
               word_of(held.buffer.format());
      });
}

}  // namespace frontmost::python
