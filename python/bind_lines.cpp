// SPDX-License-Identifier: Apache-2.0
// Hidden lines: feature edges as visible and hidden segments, with their kinds.
#include <frontmost/lines.h>

#include <shared_mutex>

#include "python/arrays.h"
#include "python/bindings.h"
#include "python/drawings.h"
#include "python/running.h"

namespace frontmost::python {
namespace {

using namespace py::literals;

constexpr const char* kind_words[] = {"boundary", "silhouette", "border", "crease", "intersection"};
static_assert(std::size(kind_words) == edge_kind_count);

/// An array with one row for each of `things`; `write` fills the row.
template <class T, class Thing, class Write>
Array<T> written(const std::vector<Thing>& things, const ArrayShape& row, const Write& write) {
  ArrayShape shape{py::ssize_t(things.size())};
  shape.insert(shape.end(), row.begin(), row.end());
  Array<T> out(shape);
  T* data = out.mutable_data();
  for (const Thing& thing : things)
    for (const auto value : write(thing)) *data++ = T(value);
  return out;
}

HeldDrawing drawn(const std::shared_ptr<HeldSurfaces>& held, const View& view,
                  const std::optional<double>& crease_angle, bool counts_hidden, const std::vector<std::string>& kinds,
                  bool ripples, bool outlines, int threads, const py::object& progress) {
  LineOptions options;
  if (crease_angle) options.crease_angle = glm::radians(*crease_angle);
  options.counts_hidden = counts_hidden;
  options.ripples = ripples;
  options.outlines = outlines;
  bool* const wanted[] = {&options.boundaries, &options.silhouettes, &options.borders, &options.creases,
                          &options.intersections};
  for (bool* const kind : wanted) *kind = false;
  for (const std::string& word : kinds) {
    const auto* const found = std::find(std::begin(kind_words), std::end(kind_words), word);
    if (found == std::end(kind_words))
      throw py::value_error("kinds: '" + word + "' is not one of boundary, silhouette, border, crease, intersection");
    *wanted[found - std::begin(kind_words)] = true;
  }
  return {held, run(threads, progress, [&](const Execution& execution) {
            const std::shared_lock lock(held->scene->reading);
            return std::make_shared<const Drawing>(draw_lines(held->surfaces, view, options, execution));
          })};
}

void bind_drawing(py::module_& m) {
  using Part = DrawnPart;
  using Edge = DrawnEdge;
  py::class_<HeldDrawing>(m, "Drawing", doc("Drawing"))
      .def_property_readonly(
          "view", [](const HeldDrawing& d) { return d.drawing->view; }, doc("Drawing.view"))
      .def_property_readonly(
          "segments",
          [](const HeldDrawing& d) {
            return written<double>(d.drawing->parts, {2, 2}, [](const Part& p) {
              return std::array{p.from.x, p.from.y, p.to.x, p.to.y};
            });
          },
          doc("Drawing.segments"))
      .def_property_readonly(
          "edge",
          [](const HeldDrawing& d) {
            return written<std::uint32_t>(d.drawing->parts, {}, [](const Part& p) { return std::array{p.edge}; });
          },
          doc("Drawing.edge"))
      .def_property_readonly(
          "kind",
          [](const HeldDrawing& d) {
            return written<std::uint8_t>(d.drawing->parts, {},
                                         [&](const Part& p) { return std::array{d.drawing->edges[p.edge].kind}; });
          },
          doc("Drawing.kind"))
      .def_property_readonly(
          "hidden_by",
          [](const HeldDrawing& d) {
            return written<std::uint32_t>(d.drawing->parts, {}, [](const Part& p) { return std::array{p.hidden_by}; });
          },
          doc("Drawing.hidden_by"))
      .def_property_readonly(
          "is_seen",
          [](const HeldDrawing& d) {
            return written<bool>(d.drawing->parts, {}, [](const Part& p) { return std::array{p.hidden_by == 0}; });
          },
          doc("Drawing.is_seen"))
      .def_property_readonly(
          "is_outline",
          [](const HeldDrawing& d) {
            return written<bool>(d.drawing->parts, {}, [](const Part& p) { return std::array{p.is_outline}; });
          },
          doc("Drawing.is_outline"))
      .def_property_readonly(
          "span",
          [](const HeldDrawing& d) {
            return written<double>(d.drawing->parts, {2}, [](const Part& p) { return std::array{p.begin, p.end}; });
          },
          doc("Drawing.span"))
      .def_property_readonly(
          "edges",
          [](const HeldDrawing& d) {
            return written<double>(d.drawing->edges, {2, 3}, [](const Edge& e) {
              return std::array{e.from.x, e.from.y, e.from.z, e.to.x, e.to.y, e.to.z};
            });
          },
          doc("Drawing.edges"))
      .def_property_readonly(
          "edge_primitives",
          [](const HeldDrawing& d) {
            return written<std::uint32_t>(d.drawing->edges, {2}, [](const Edge& e) {
              return std::array{e.left, e.right};
            });
          },
          doc("Drawing.edge_primitives"))
      .def("__len__", [](const HeldDrawing& d) { return d.drawing->parts.size(); })
      .def("__repr__", [](const HeldDrawing& d) {
        return "Drawing: " + std::to_string(d.drawing->edges.size()) + " edges in " +
               std::to_string(d.drawing->parts.size()) + " parts";
      });
}

}  // namespace

void bind_lines(py::module_& m) {
  bind_drawing(m);
  py::tuple kinds(edge_kind_count);
  for (std::size_t i = 0; i < kinds.size(); ++i) kinds[i] = kind_words[i];
  m.attr("edge_kinds") = kinds;
  py::class_<HeldSurfaces, std::shared_ptr<HeldSurfaces>>(m.attr("Surfaces"))
      .def("draw_lines", &drawn, "view"_a, py::kw_only(), "crease_angle"_a = py::none(), "counts_hidden"_a = false,
           "kinds"_a = kinds, "ripples"_a = true, "outlines"_a = false, "threads"_a = 0, "progress"_a = py::none(),
           doc("Surfaces.draw_lines"));
}

}  // namespace frontmost::python
