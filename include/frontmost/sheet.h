// SPDX-License-Identifier: Apache-2.0
// Drawings on paper by one call: the views of a model on a sheet, at a scale, with sections, dimensions and title
// block.
//
//    +--------------------------------------+
//    |   front         left                 |     First-angle projection: what is seen from the left stands to the
//    |                                      |     right of the front view, and what is seen from above below it.
//    |   top           three-quarter        |     Third angle is the other way round.
//    |               +----------------------+
//    |               |     title block      |
//    +---------------+----------------------+
#pragma once

#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "frontmost/section.h"
#include "frontmost/sheet_view.h"

namespace frontmost {

/// A sheet of paper, before it is known how large the drawing on it is.
struct Paper {
  glm::dvec2 size{210, 297};  ///< millimetres, 1 to 100000 each
  bool may_turn = true;       ///< the sides change places where that suits the drawing better
  bool fits_drawing = false;  ///< as large as the drawing and its margins; the size does not count
};

/// The paper of a name: "a0" to "a6", "letter", "legal" or "tabloid", in small letters or capitals. With "-portrait" or
/// "-landscape" behind the name it does not turn. \throws Error bad_argument for any other name.
[[nodiscard]] Paper named_paper(std::string_view name);
/// The name of paper of that size in millimetres, whichever way it lies: "A3"; "420 x 200" where it has none.
[[nodiscard]] std::string paper_name(const glm::dvec2& size);

/// A scale as drawings write it: "1:5", "2:1", "1:3.2".
[[nodiscard]] std::string scale_text(double scale);
/// The largest scale of ISO 5455 (1, 2 and 5 times powers of ten, and their reciprocals) that is not above `most`: from
/// 5e9:1 to 1:1e10; `most` itself where that is below them.
[[nodiscard]] double standard_scale(double most);

/// Where views stand about the front one; its symbol (ISO 5456-2) stands in the title block.
enum class ProjectionMethod : std::uint8_t { none, first_angle, third_angle };

/// What the fields of a title block say, in UTF-8; empty ones stay empty. Text too long for its field at 1.8 mm is
/// written smaller.
struct TitleBlock {
  std::string title{};   ///< in up to two lines
  std::string number{};  ///< of the drawing
  std::string author{}, date{}, owner{};
  std::string scale{};  ///< as "1:2"
  std::string unit{};   ///< of what is written on the drawing, as "mm"
  std::string paper{};  ///< as "A3"
  ProjectionMethod projection = ProjectionMethod::none;
  int sheet = 1, sheets = 1;
};

/// "front", "back", ..., "three-quarter".
[[nodiscard]] std::string_view view_name(NamedView view);

/// How edges are drawn that are out of sight.
enum class HiddenLines : std::uint8_t { none, dashed, thin };

/// technical: all that is seen with one pen, as drawing standards have it (technical_pens()). figure: for people, an
/// outline heavier than contours, and those heavier than creases (figure_pens()).
enum class DrawingStyle : std::uint8_t { technical, figure };

/// What a view shows of the model cut by a plane across its sight, without what lies before the plane.
struct SectionView {
  NamedView direction = NamedView::front;  ///< of the six along the axes
  /// Where the plane is along that axis, in the coordinates of the file. None: in the middle of the model.
  std::optional<double> at = std::nullopt;
};

/// Millimetres are those of the paper.
struct SheetOptions {
  // What the sheet shows, in parallel projection at one scale. Views in line with each other stand in line.
  std::vector<NamedView> views{};  ///< each once; iso or three_quarter, which have one place
  /// Named A-A, B-B and so on in their order; at most 24. The first view that sees a plane from its edge marks it.
  std::vector<SectionView> sections{};
  ProjectionMethod projection = ProjectionMethod::first_angle;  ///< where views stand about the front one
  /// Overall sizes, and diameters, as ISO 129 has them; needs views.
  bool dimensions = false;

  // How lines are drawn.
  HiddenLines hidden = HiddenLines::none;
  /// The views that show hidden lines. None: all but those at an angle. Sections never do.
  std::optional<std::vector<NamedView>> hidden_views = std::nullopt;
  DrawingStyle style = DrawingStyle::technical;
  /// Millimetres, 0.01 to 10: of the lines that are seen; others and dashes are wider by as much. None: as `style`
  /// says.
  std::optional<double> pen = std::nullopt;
  std::optional<double> crease_angle = std::nullopt;  ///< radians, as LineOptions has it
  /// Millimetres, 0 to 10, as StrokeOptions::shortest. None: 0.5 for plotters, 0 otherwise.
  std::optional<double> shortest_stroke = std::nullopt;
  std::optional<bool> centre_lines = std::nullopt;  ///< none: on technical sheets of named views
  /// For pen plotters: long strokes whatever object they belong to, ordered to spare lifts of the pen. Dashes become
  /// lines of their own by with_real_dashes().
  bool plot = false;

  // Paper and scale.
  /// None: A4; with a scale as large as the drawing, or the smallest of A4 to A0 that has room for it and a title
  /// block.
  std::optional<Paper> page = std::nullopt;
  double margin = 10;  ///< millimetres, 0 to 1000, at each side
  /// Length on paper to that of the model, 1e-12 to 1e12. None: the largest that the page has room for.
  std::optional<double> scale = std::nullopt;
  /// That largest scale is one of ISO 5455. None: on sheets of named views.
  std::optional<bool> standard_scale = std::nullopt;
  /// What the model's numbers are, in place of what its file says. None: as SceneSource says, else 1.
  std::optional<double> millimetres_per_unit = std::nullopt;
  /// What dimensions and the title block say: inches with three decimals, or millimetres with two. None: inches where
  /// the model's numbers are inches.
  std::optional<bool> in_inches = std::nullopt;
  /// A frame with this title block. Scale, unit, paper and projection are filled in.
  std::optional<TitleBlock> title_block = std::nullopt;

  // What is dark, as hatch() and stipple() find it; not together with sections.
  std::optional<double> hatch = std::nullopt;      ///< millimetres from line to line, 0.2 to 50
  std::optional<double> stipple = std::nullopt;    ///< millimetres from dot to dot, 0.2 to 10
  double hatch_angle = std::numbers::pi / 4;       ///< radians, counter-clockwise from level
  std::optional<glm::dvec3> light = std::nullopt;  ///< towards it: to the right, upwards and to the viewer
  bool casts_shadows = true;

  // The camera.
  /// Pixels of a view, 0.001 to 1000: how far triangles of curved surfaces may be from them. None: 0.2, or more where
  /// that would take millions of triangles.
  std::optional<double> tessellation_error = std::nullopt;
  /// Of named views: planes in place of those that enclose the model.
  std::optional<double> near = std::nullopt, far = std::nullopt;
  /// Of a given view: its whole picture is fitted to the page, and not what it shows.
  bool keeps_picture = false;
};

/// A view with what was drawn of it.
struct DrawnView {
  std::string name;  ///< "front"; of a section "A-A"; empty where the view was given
  /// What the numbers of triangles in `drawing` mean: the surfaces that were given, which must still be there, or
  /// others that were made for a view of curved or cut ones.
  std::shared_ptr<const Surfaces> surfaces;
  std::shared_ptr<const Section> section;  ///< null where nothing was cut
  Drawing drawing;
  bool shows_hidden = false;
  SheetView placed;  ///< its lines, in their places on the page
};

struct Sheet {
  Page page;
  std::optional<double> scale;   ///< none in perspective
  std::vector<DrawnView> views;  ///< whole ones, then sections, in their order
  bool is_empty = false;         ///< no line of the model is on it
  std::size_t left_out = 0;      ///< diameters for which there was no room
  std::size_t undrawn = 0;       ///< diameters of cylinders that are seen along their axes, but not drawn: hidden
  std::size_t prisms = 0;        ///< diameters of cylinders of 7 to 17 sides, which count as polygons
};

/// \throws Error bad_argument for values out of range and what excludes or needs another; the message begins with the
/// name of the field.
void validate(const SheetOptions& options);

/// Draws the named views and sections of `options` on one page. Layers are those of page_of(), then "9 sections",
/// "7 dimensions" and "8 frame". Tells a watch its steps: "views", "rounds", "layout", "tones" and "page", beside those
/// of what it calls. The same bytes for any number of threads.
/// \throws Error as validate() does, and for options without a view; bad_argument for a plane that misses the model;
/// limit_exceeded for what has no room on the page, saying what would; and as draw_lines(), hatch(), stipple() and
/// tessellate() do.
[[nodiscard]] Sheet draw_sheet(const Surfaces& surfaces, const SheetOptions& options, const Execution& execution = {});

/// Draws one view on a page of its own, also in perspective, where nothing has a scale. Lines are as fine as the pixels
/// of the view: 3840 x 2160 of them suffice for all paper.
/// \throws Error as draw_sheet() does; bad_argument for what named views alone have, and for a scale or centre lines in
/// perspective.
[[nodiscard]] Sheet draw_view(const Surfaces& surfaces, const View& view, const SheetOptions& options = {},
                              const Execution& execution = {});

}  // namespace frontmost
