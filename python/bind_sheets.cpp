// SPDX-License-Identifier: Apache-2.0
// Vector pictures: sheets of hidden-line drawings, and figures of polygons.
#include <frontmost/pictures.h>
#include <frontmost/sheets.h>

#include <shared_mutex>

#include "python/arrays.h"
#include "python/bindings.h"
#include "python/drawings.h"
#include "python/pictures.h"
#include "python/running.h"
#include "python/shade_words.h"
#include "python/view_words.h"

FRONTMOST_WORDS(frontmost::HiddenLines, "hidden",
                {{frontmost::HiddenLines::none, "none"},
                 {frontmost::HiddenLines::dashed, "dashed"},
                 {frontmost::HiddenLines::thin, "thin"}});
FRONTMOST_WORDS(frontmost::Dimensioning, "dimensions",
                {{frontmost::Dimensioning::none, "none"},
                 {frontmost::Dimensioning::overall, "overall"},
                 {frontmost::Dimensioning::diameters, "diameters"},
                 {frontmost::Dimensioning::holes, "holes"},
                 {frontmost::Dimensioning::all, "all"}});
FRONTMOST_WORDS(frontmost::DrawingStyle, "style",
                {{frontmost::DrawingStyle::technical, "technical"}, {frontmost::DrawingStyle::figure, "figure"}});
FRONTMOST_WORDS(frontmost::Lettering, "lettering",
                {{frontmost::Lettering::strokes, "strokes"}, {frontmost::Lettering::text, "text"}});
FRONTMOST_WORDS(frontmost::ProjectionMethod, "projection",
                {{frontmost::ProjectionMethod::none, "none"},
                 {frontmost::ProjectionMethod::first_angle, "first_angle"},
                 {frontmost::ProjectionMethod::third_angle, "third_angle"}});

namespace frontmost::python {
namespace {

using namespace py::literals;

/// Python's Sheet and Figure, which display themselves in notebooks.
struct HeldPage {
  Page page;
  std::optional<double> scale;
  std::size_t left_out = 0, undrawn = 0, prisms = 0;  ///< as in Sheet
  std::size_t covered = 0;                            ///< sum of Strokes::covered
};
struct HeldFigure {
  std::shared_ptr<const Figure> figure;
};

std::string path_of(const py::object& path) {
  return py::cast<std::string>(py::module_::import("os").attr("fspath")(path));
}

/// The text of the SVG file that `write` writes.
template <class Write>
py::str svg_of(const Write& write) {
  const py::object folder = py::module_::import("tempfile").attr("TemporaryDirectory")();
  const std::string file = py::cast<std::string>(folder.attr("name")) + "/page.svg";
  run(0, py::none(), [&](const Execution& execution) { write(file, execution); });
  const py::object opened = py::module_::import("pathlib").attr("Path")(file);
  py::str text = opened.attr("read_text")("encoding"_a = "utf-8");
  folder.attr("cleanup")();
  return text;
}

Paper paper_of(const py::object& given) {
  if (py::isinstance<py::str>(given)) return named_paper(py::cast<std::string>(given));
  const auto size = numbers<double>(given, "page", {2});
  return {{size.at(0), size.at(1)}, false, false};
}

std::vector<SectionView> sections_of(const py::list& given) {
  std::vector<SectionView> sections;
  for (const py::handle& one : given) {
    if (py::isinstance<py::str>(one)) {
      sections.push_back({value_of<NamedView>(py::cast<std::string>(one)), std::nullopt});
    } else {
      const auto pair = py::cast<std::pair<std::string, double>>(one);
      sections.push_back({value_of<NamedView>(pair.first), pair.second});
    }
  }
  return sections;
}

std::optional<TitleBlock> title_of(const std::optional<std::map<std::string, std::string>>& given) {
  if (!given) return std::nullopt;
  TitleBlock block;
  const std::pair<const char*, std::string*> fields[] = {{"title", &block.title},
                                                         {"number", &block.number},
                                                         {"author", &block.author},
                                                         {"date", &block.date},
                                                         {"owner", &block.owner}};
  for (const auto& [name, text] : *given) {
    bool known = false;
    for (const auto& [field, value] : fields)
      if (name == field) *value = text, known = true;
    if (!known) throw py::value_error("title_block: '" + name + "' is not one of title, number, author, date, owner");
  }
  return block;
}

HeldPage sheet_of(const std::shared_ptr<HeldSurfaces>& held, const py::object& views, const py::list& sections,
                  const std::optional<std::vector<std::string>>& uncut, ProjectionMethod projection,
                  Dimensioning dimensions, HiddenLines hidden,
                  const std::optional<std::vector<NamedView>>& hidden_views, DrawingStyle style,
                  const std::optional<double>& pen, const std::optional<double>& crease_angle,
                  const std::optional<double>& shortest_stroke, const std::optional<bool>& centre_lines, bool plot,
                  Lettering lettering, const py::object& page, double margin, const std::optional<double>& scale,
                  const std::optional<bool>& standard_scale, const std::optional<double>& millimetres_per_unit,
                  const std::optional<bool>& in_inches, bool inch_fractions,
                  const std::optional<std::map<std::string, std::string>>& title_block,
                  const std::optional<double>& hatch, const std::optional<double>& stipple, double hatch_angle,
                  const py::object& light, bool casts_shadows, bool keeps_picture, int threads,
                  const py::object& progress) {
  SheetOptions options;
  const bool is_view = py::isinstance<View>(views);
  if (!is_view) options.views = py::cast<std::vector<NamedView>>(views);
  options.sections = sections_of(sections);
  if (uncut) options.uncut = *uncut;
  options.projection = projection;
  options.dimensions = dimensions;
  options.hidden = hidden;
  options.hidden_views = hidden_views;
  options.style = style;
  options.pen = pen;
  if (crease_angle) options.crease_angle = glm::radians(*crease_angle);
  options.shortest_stroke = shortest_stroke;
  options.centre_lines = centre_lines;
  options.plot = plot;
  options.lettering = lettering;
  if (!page.is_none()) options.page = paper_of(page);
  options.margin = margin;
  options.scale = scale;
  options.standard_scale = standard_scale;
  options.millimetres_per_unit = millimetres_per_unit;
  options.in_inches = in_inches;
  options.inch_fractions = inch_fractions;
  options.title_block = title_of(title_block);
  options.hatch = hatch;
  options.stipple = stipple;
  options.hatch_angle = glm::radians(hatch_angle);
  if (!light.is_none()) options.light = point(light, "light");
  options.casts_shadows = casts_shadows;
  options.keeps_picture = keeps_picture;
  const std::optional<View> view = is_view ? std::optional(py::cast<View>(views)) : std::nullopt;
  Sheet sheet = run(threads, progress, [&](const Execution& execution) {
    const std::shared_lock lock(held->scene->reading);
    return view ? draw_view(held->surfaces, *view, options, execution) : draw_sheet(held->surfaces, options, execution);
  });
  std::size_t covered = 0;
  for (const DrawnView& drawn : sheet.views) covered += drawn.placed.strokes.covered;
  return {std::move(sheet.page), sheet.scale, sheet.left_out, sheet.undrawn, sheet.prisms, covered};
}

/// A drawing on a page of the view's size, at 96 pixels an inch.
HeldPage sheet_of_drawing(const HeldDrawing& held, HiddenLines hidden, DrawingStyle style) {
  constexpr double millimetres_per_pixel = 25.4 / 96;
  LinePens pens = style == DrawingStyle::figure ? figure_pens() : technical_pens();
  if (hidden == HiddenLines::thin) pens.hidden = thin_pen();
  StrokeOptions options;
  options.with_hidden = hidden != HiddenLines::none;
  options.by_kind = options.by_outline = style == DrawingStyle::figure;
  return {
      run(0, py::none(),
          [&](const Execution& execution) {
            const std::shared_lock lock(held.of->scene->reading);
            const Surfaces& surfaces = held.of->surfaces;
            SheetView placed;
            placed.strokes = chain_strokes(surfaces, *held.drawing, options, execution);
            placed.millimetres_per_pixel = millimetres_per_pixel;
            const View& view = held.drawing->view;
            return page_of(surfaces, {&placed, 1}, pens, millimetres_per_pixel * glm::dvec2(view.width, view.height));
          }),
      std::nullopt};
}

/// A picture in linear light with the seen edges of the drawing over it, in sRGB.
py::object drawn_over(const HeldDrawing& held, const py::object& picture, double width, const py::object& color,
                      Blend blend, int threads, const py::object& progress) {
  const View& view = held.drawing->view;
  Image image = image_of_colors(picture, "picture", {view.height, view.width, 4});
  const PicturePen pen{width, glm::vec3(point(color, "color")), blend};
  run(threads, progress, [&](const Execution& execution) {
    const std::shared_lock lock(held.of->scene->reading);
    const StrokeOptions seen{.with_hidden = false, .by_kind = false, .by_outline = false, .by_instance = false};
    draw_strokes(image, chain_strokes(held.of->surfaces, *held.drawing, seen, execution), pen, execution);
  });
  return bitmap_array(image);
}

HeldFigure figure_of(const std::shared_ptr<HeldSurfaces>& held, const View& view, double tolerance, bool visible_only,
                     bool merges_neighbours, std::size_t most_polygons, Shading shading, const py::object& background,
                     Shadows shadows, float opacity, Lights lights, const std::optional<std::string>& title,
                     int threads, const py::object& progress) {
  FigureOptions options;
  options.shade.shading = shading;
  options.shade.background.reset();
  if (!background.is_none()) options.shade.background = glm::vec3(point(background, "background"));
  options.shade.light.shadows = shadows;
  options.shade.opacity = opacity;
  options.shade.light.lights = lights;
  options.tolerance = tolerance;
  options.visible_only = visible_only;
  options.merges_neighbours = merges_neighbours;
  options.most_polygons = most_polygons;
  return {run(threads, progress, [&](const Execution& execution) {
    const std::shared_lock lock(held->scene->reading);
    auto figure = std::make_shared<Figure>(draw_figure(held->surfaces, view, options, execution));
    figure->title = title.value_or(held->scene->name);
    return std::shared_ptr<const Figure>(std::move(figure));
  })};
}

/// One list of (k, 2) arrays for each shape: its outlines.
py::list polygons_of(const HeldFigure& held) {
  py::list shapes;
  const Figure& figure = *held.figure;
  for (const FigureShape& shape : figure.shapes) {
    py::list rings;
    for (std::uint32_t i = 0; i < shape.ring_count; ++i) {
      const FigureRing& ring = figure.rings[shape.first_ring + i];
      rings.append(view_of(&figure.corners[ring.first_corner].x, {py::ssize_t(ring.corner_count), 2}, held.figure));
    }
    shapes.append(rings);
  }
  return shapes;
}

Array<std::uint8_t> colors_of_shapes(const HeldFigure& held) {
  Array<std::uint8_t> out(ArrayShape{py::ssize_t(held.figure->shapes.size()), 4});
  std::uint8_t* data = out.mutable_data();
  for (const FigureShape& shape : held.figure->shapes)
    for (int i = 0; i < 4; ++i) *data++ = shape.color[i];
  return out;
}

/// Binds save(), svg and _repr_svg_ of pages and figures.
template <class Class, class Write>
void bind_page(Class& bound, const std::string& name, const Write& write) {
  const auto svg = [write](const typename Class::type& held) {
    return svg_of([&](const std::string& file, const Execution& execution) { write(held, file, execution); });
  };
  bound
      .def(
          "save",
          [write](const typename Class::type& held, const py::object& path) {
            const std::string file = path_of(path);
            run(0, py::none(), [&](const Execution& execution) { write(held, file, execution); });
          },
          "path"_a, doc((name + ".save").c_str()))
      .def_property_readonly("svg", svg, doc((name + ".svg").c_str()))
      .def("_repr_svg_", svg);
}

}  // namespace

void bind_sheets(py::module_& m) {
  py::class_<HeldPage> sheet(m, "Sheet", doc("Sheet"));
  bind_page(sheet, "Sheet", [](const HeldPage& held, const std::string& file, const Execution& execution) {
    save(held.page, file, std::nullopt, execution);
  });
  sheet.def_readonly("scale", &HeldPage::scale, doc("Sheet.scale"))
      .def_property_readonly(
          "size", [](const HeldPage& held) { return py::make_tuple(held.page.width, held.page.height); },
          doc("Sheet.size"))
      .def_readonly("left_out", &HeldPage::left_out, doc("Sheet.left_out"))
      .def_readonly("undrawn", &HeldPage::undrawn, doc("Sheet.undrawn"))
      .def_readonly("prisms", &HeldPage::prisms, doc("Sheet.prisms"))
      .def_readonly("covered", &HeldPage::covered, doc("Sheet.covered"))
      .def("__repr__", [](const HeldPage& held) {
        return "Sheet of " + paper_name({held.page.width, held.page.height}) +
               (held.scale ? ", " + scale_text(*held.scale) : "");
      });
  py::class_<HeldDrawing>(m.attr("Drawing"))
      .def("sheet", &sheet_of_drawing, py::kw_only(), "hidden"_a = HiddenLines::none, "style"_a = DrawingStyle::figure,
           doc("Drawing.sheet"))
      .def("draw_over", &drawn_over, "picture"_a, py::kw_only(), "width"_a = 1.2,
           "color"_a = py::make_tuple(0.1, 0.1, 0.1), "blend"_a = Blend::linear, "threads"_a = 0,
           "progress"_a = py::none(), doc("Drawing.draw_over"))
      .def("_repr_svg_", [](const HeldDrawing& held) {
        return py::object(py::cast(sheet_of_drawing(held, HiddenLines::none, DrawingStyle::figure)).attr("svg"));
      });
  py::class_<HeldFigure> figure(m, "Figure", doc("Figure"));
  bind_page(figure, "Figure", [](const HeldFigure& held, const std::string& file, const Execution& execution) {
    save(*held.figure, file, std::nullopt, execution);
  });
  figure.def_property_readonly("polygons", &polygons_of, doc("Figure.polygons"))
      .def_property_readonly("colors", &colors_of_shapes, doc("Figure.colors"))
      .def("__len__", [](const HeldFigure& held) { return held.figure->shapes.size(); })
      .def("__repr__", [](const HeldFigure& held) {
        return "Figure of " + std::to_string(held.figure->shapes.size()) + " shapes";
      });
  py::class_<HeldSurfaces, std::shared_ptr<HeldSurfaces>>(m.attr("Surfaces"))
      .def("draw_sheet", &sheet_of, "views"_a = py::make_tuple("front", "top", "left"), py::kw_only(),
           "sections"_a = py::list(), "uncut"_a = py::none(), "projection"_a = ProjectionMethod::first_angle,
           "dimensions"_a = Dimensioning::none, "hidden"_a = HiddenLines::none, "hidden_views"_a = py::none(),
           "style"_a = DrawingStyle::technical, "pen"_a = py::none(), "crease_angle"_a = py::none(),
           "shortest_stroke"_a = py::none(), "centre_lines"_a = py::none(), "plot"_a = false,
           "lettering"_a = Lettering::strokes, "page"_a = py::none(), "margin"_a = 10.0, "scale"_a = py::none(),
           "standard_scale"_a = py::none(), "millimetres_per_unit"_a = py::none(), "in_inches"_a = py::none(),
           "inch_fractions"_a = false, "title_block"_a = py::none(), "hatch"_a = py::none(), "stipple"_a = py::none(),
           "hatch_angle"_a = 45.0, "light"_a = py::none(), "casts_shadows"_a = true, "keeps_picture"_a = false,
           "threads"_a = 0, "progress"_a = py::none(), doc("Surfaces.draw_sheet"))
      .def("draw_figure", &figure_of, "view"_a, py::kw_only(), "tolerance"_a = 6.0, "visible_only"_a = true,
           "merges_neighbours"_a = false, "most_polygons"_a = 2000000, "shading"_a = Shading::lit,
           "background"_a = py::make_tuple(1.0, 1.0, 1.0), "shadows"_a = Shadows::map, "opacity"_a = 1.0f,
           "lights"_a = Lights::key, "title"_a = py::none(), "threads"_a = 0, "progress"_a = py::none(),
           doc("Surfaces.draw_figure"));
}

}  // namespace frontmost::python
