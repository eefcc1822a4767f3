// SPDX-License-Identifier: Apache-2.0
// Drawings on paper: figures (pictures of polygons), pages in millimetres and their files, lettering, and whole sheets.
//
//   draw_figure() --> Figure ----+
//   draw_sheet() --> Sheet ------+--> Page --save()--> SVG, PDF, DXF, JSON
//   paths of one's own ----------+
//
// A Figure is for vector files what an Image is for files of pixels.
//
// A million polygons are three arrays, each of which names a run of the next:
//
//   shapes   | shape 0           | shape 1 | ...    filled one after the other, each with one colour
//   rings    | ring 0  | ring 1  | ring 2  | ...    the outlines of a shape: its rim, its holes, its other parts
//   corners  | a b c d | e f g   | h i j k | ...    the corners of a ring, which closes by itself
#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "frontmost/base.h"
#include "frontmost/lines.h"
#include "frontmost/pictures.h"
#include "frontmost/view.h"

namespace frontmost {

/// A closed path of a figure: `corner_count` of Figure::corners from `first_corner` on.
struct FigureRing {
  std::size_t first_corner = 0;
  std::uint32_t corner_count = 0;
};
/// What is filled with one colour by the nonzero rule: `ring_count` of Figure::rings from `first_ring` on.
struct FigureShape {
  glm::u8vec4 color{0};
  std::uint32_t ring_count = 0;
  std::size_t first_ring = 0;
  /// Rising. Translucent shapes with the same number are filled without their opacity, which they share, one after the
  /// other on clear ground; the whole is then laid on with it.
  std::uint32_t sheet = 0;
};
/// A picture of polygons: paths to be filled one after the other. Pixels of the view, x right, y down.
struct Figure {
  View view;
  std::string title;                    ///< what files call it; any text
  std::optional<glm::vec3> background;  ///< sRGB, 0 to 1; none: transparent
  std::vector<FigureShape> shapes;
  std::vector<FigureRing> rings;
  std::vector<glm::dvec2> corners;
};

struct FigureOptions {
  /// Shading, shadows, opacity and the background count; see-through does not: figures are translucent where the scene
  /// is.
  ShadeOptions shade;
  /// Steps of 8-bit sRGB, 0 to 255, by which the colour of a polygon may differ from what is seen there. Where it
  /// varies by more it is cut. 255: a triangle has the colour of its middle, and is never cut for it.
  double tolerance = 6;
  /// True: what is hidden is left out. False: all polygons are there in the order of painting, one over the other.
  bool visible_only = true;
  /// Neighbours of one colour become one shape, where no later polygon covers any of them.
  bool merges_neighbours = false;
  /// More polygons are an error.
  std::size_t most_polygons = 2'000'000;
};

/// A picture of polygons, with the colours that shade() gives the same view, textures, shadows and smooth normals
/// included; of alpha mode MASK holes are left out. The order is the painter's, exact where surfaces pass through each
/// other. Against the hairlines that viewers leave between neighbours, polygons reach up to 4 pixels under what is
/// painted over them (the print trade's trapping). What is visible has one sample a pixel.
/// O(n log n) in the number of polygons, and the pixels that they cover. The same for any number of threads.
/// (M. Newell, R. Newell, T. Sancha. A Solution to the Hidden Surface Problem. 1972.)
/// \throws Error bad_argument for a Visible of more samples, options out of range; unsupported for an environment that
/// is to be shown; limit_exceeded for more polygons than FigureOptions::most_polygons, or triangles that pass through
/// each other, or overlap, too often.
[[nodiscard]] Figure draw_figure(const Surfaces& surfaces, const ShadeInput& input, const FigureOptions& options = {},
                                 const Execution& execution = {});
[[nodiscard]] Figure draw_figure(const Surfaces& surfaces, const Visible& visible, const FigureOptions& options = {},
                                 const Execution& execution = {});
/// The same of a view, which need not have one sample. \throws Error as validate(view) does, too.
[[nodiscard]] Figure draw_figure(const Surfaces& surfaces, const View& view, const FigureOptions& options = {},
                                 const Execution& execution = {});
/// The same with what a shader has made ready of its surfaces.
[[nodiscard]] Figure draw_figure(Shader& shader, const ShadeInput& input, const FigureOptions& options = {},
                                 const Execution& execution = {});

// Pages: pen lines and filled polygons in millimetres, written as SVG, PDF, DXF or JSON.
//
// A page has x to the right and y down, from its top left corner. What comes first lies below what comes later. Colours
// are sRGB, as those files have them.

/// sRGB and opacity, 0 to 255 each; not premultiplied.
struct PageColor {
  std::uint8_t red = 0, green = 0, blue = 0, opacity = 255;
  friend bool operator==(const PageColor&, const PageColor&) = default;
};

/// How lines are drawn: with round ends and corners.
struct Pen {
  double width = 0.25;  ///< millimetres, 0 to 1000; 0 draws nothing
  PageColor color;
  /// Millimetres that are drawn, left out, drawn and so on; an even count, empty: no gaps. Every path begins anew.
  std::vector<double> dashes{};
};

/// Consecutive points of a group, joined in their order. One point alone is a dot.
struct PagePath {
  std::uint32_t first = 0, count = 0;
  bool is_closed = false;  ///< the last point is joined to the first
  /// Belongs to the path before it, of the same group, and is filled as it is: one of its holes, or more of it.
  bool is_part = false;
};

/// Paths that are drawn with one pen, one after the other. Millions of paths are better in one group than in many.
struct PageGroup {
  std::string name;  ///< of the object, any text
  Pen pen;
  std::vector<glm::dvec2> points{};  ///< millimetres
  /// Empty: all joins are straight. Otherwise one for each point, of the join that begins there: the tangent of a
  /// quarter of the angle that an arc turns through, positive from +x towards +y; 0 straight, 1 a half circle.
  std::vector<double> bulges{};
  std::vector<PagePath> paths{};
  std::vector<PageColor> fills{};  ///< empty: nothing is filled; otherwise one for each path (nonzero winding rule)
  /// Of all of the group together, 0 to 255: it is drawn on clear ground, and then laid on with it.
  std::uint8_t opacity = 255;

  /// Appends a path without arcs.
  void add(std::span<const glm::dvec2> corners, bool is_closed, bool is_part = false);
};

struct PageLayer {
  std::string name;  ///< plotters choose layers by the number that a name begins with: "1 hidden"
  std::vector<PageGroup> groups{};
};

struct Page {
  double width = 210, height = 297;  ///< millimetres, 0.01 to 100000 (100 m)
  std::string title{};
  std::vector<PageLayer> layers{};
};

/// The same page with every dash of its pens as a path, for plotters, which follow paths and know no dashes. Patterns
/// run along whole paths; from corner to corner, of 25 degrees and more, they are stretched so that both ends are drawn
/// (ISO 128-2). What is filled stays. O(points + dashes).
/// \throws Error as validate() does, limit_exceeded for more than 20 million dashes, and cancelled.
[[nodiscard]] Page with_real_dashes(Page page, const Execution& execution = {});

enum class PageFormat : std::uint8_t { svg, pdf, dxf, json };

/// \throws Error bad_argument or limit_exceeded, naming layer and group: sizes out of range; points that are not
/// finite or further than 1000 m away; bulges beyond 10; paths of points that are not there; lists that do not match.
void validate(const Page& page);

/// The format that a file's suffix names; none where it names no format of pages.
[[nodiscard]] std::optional<PageFormat> page_format(const std::string& path);

/// Writes a page; whole or not at all, as images. Coordinates are rounded to 0.001 mm, so that paths that share a point
/// share it in the file. The bytes depend on the page alone (PDF: and the version of zlib).
///
/// SVG: size in millimetres, one user unit to the millimetre; layers and groups are named as Inkscape does it, paths of
/// one pen share elements; without style sheets, clip paths, masks or transforms. PDF 1.5: layers as optional content,
/// groups with an opacity as transparency groups, compressed; 1.6 where a side is over 5080 mm, scaled by a user unit.
/// DXF (AutoCAD release 12), lines only: LINE, POLYLINE, ARC, CIRCLE and POINT with line types, y up from the page's
/// lower left corner; it has no widths, and no groups: each is a layer named by layer and group, "2_VISIBLE-WHEEL", or
/// all of a layer are one where there are a thousand or more. Line types and colours are those of layers: that of the
/// pen, and where it is black one by the digit that the page's layer begins its name with. Line types are HIDDEN,
/// CENTER and PHANTOM for one, two and more dashes in a period, with "2" or "X2" behind the name of much shorter or
/// longer ones; pens that share a name have the dashes of the first. $INSUNITS says millimetres. Such names keep
/// letters, digits and - alone, 31 at most. JSON: all of the page, as it is. Characters that a format does not allow
/// are replaced in names. Memory is constant beside the page's own. \throws Error as validate() does; bad_argument
/// without a format; unsupported for fills in DXF; file_unwritable.
void save(const Page& page, const std::string& path, std::optional<PageFormat> format = std::nullopt,
          const Execution& execution = {});

/// Several pages in one file, which may differ in size. Layers of one name are switched on and off together; the file's
/// title is that of the first page. \throws Error as the other save(); bad_argument without a page; unsupported for
/// several in another format than PDF.
void save(std::span<const Page> pages, const std::string& path, std::optional<PageFormat> format = std::nullopt,
          const Execution& execution = {});

/// How a plotter would draw a page, in millimetres and numbers.
struct PenTravel {
  double down = 0;  ///< drawn
  double up = 0;    ///< moved between paths, from the page's corner on
  std::size_t paths = 0, points = 0, arcs = 0;
};
[[nodiscard]] PenTravel travel_of(const Page& page);

/// A figure as a page of its size, where a pixel is 1/96 inch, as style sheets have it.
[[nodiscard]] Page page_of(const Figure& figure);
/// Writes a figure, as SVG or PDF by the name. \throws Error as save() of pages does.
void save(const Figure& figure, const std::string& path, std::optional<PageFormat> format = std::nullopt,
          const Execution& execution = {});

// Lettering: text as strokes of one pen, the same in every format and on every machine.
//
// Formats of pages have fonts of their own, which look otherwise in every viewer, and plotters have none. So a text
// becomes paths of lines and arcs, and is placed by one of nine points of the box around its capitals:
//
//   left         centre         right
//    x-------------x-------------x     top: the upper edge of capitals
//    |  A  4      1 2 . 5    m m  |     middle
//    x-------------x-------------x     bottom: the line on which letters stand

/// Which part of a text lies at its place: its beginning, its middle or its end.
enum class TextAlign : std::uint8_t { left, centre, right };
/// Likewise of its height: the lower edge of capitals, their middle or their upper edge.
enum class TextLine : std::uint8_t { bottom, middle, top };

struct TextStyle {
  double height = 3.5;  ///< millimetres, of capitals and figures with their pen: 1.8, 2.5, 3.5, 5, 7, 10, 14 or 20
  double angle = 0;     ///< radians that the text is turned about its place, counter-clockwise for who reads the page
  TextAlign align = TextAlign::left;
  TextLine line = TextLine::bottom;
};

/// What ISO 3098 type B letters are drawn with: a tenth of their height.
[[nodiscard]] Pen text_pen(double height);

/// Appends `text`, in UTF-8, as paths of lines and arcs: upright letters after ISO 3098-1 type B, small ones 7/10 as
/// high as capitals, descending 3/10 below. `group` should have text_pen() of the same height. There are ASCII, Latin-1
/// with its signs of diameter, degree, plus-minus and times, the letters of Central and Northern Europe, quotes, dashes
/// and a few signs of drawings; all else, bytes that are not UTF-8 and control characters too, is a box as high as a
/// capital. Blanks have no path. O(text).
void add_text(PageGroup& group, std::string_view text, const glm::dvec2& at, const TextStyle& style = {});

/// Millimetres from the left edge of the first character to the right edge of the last, with their pen; 0 without any.
[[nodiscard]] double text_width(std::string_view text, double height = 3.5);

// Views of a sheet: strokes, hatching and centre lines in their places on a page, with pens as drawing standards have
// them.
//
//   Drawing --chain_strokes()--> Strokes ----+
//   hatch(), stipple(), centre_lines_of() ----+--> SheetView --page_of()--> Page --save()--> file
//                                                  a place and a scale
//
// draw_sheet() does all of it; these are the steps, for those who lay out pages of their own.

/// Pens by what they draw.
struct LinePens {
  Pen outline{0.5, {}};  ///< where the scene ends, seen
  Pen seen{0.5, {}};     ///< all other lines that are seen
  Pen crease{0.5, {}};   ///< of those, creases; by themselves where strokes were made by kind
  Pen hidden{0.25, {}, {3, 0.75}};
  Pen hatching{0.18, {}};
  Pen stippling{0.3, {}};  ///< its width is that of the dots
  /// Long dashes and dots. Each line has an odd number of dashes, made longer or shorter so that it begins, ends and
  /// has its middle in one; a short one is whole.
  Pen centre{0.25, {}, {6, 1, 0.1, 1}};
};
/// ISO 128: what is seen 0.5 mm, hidden lines 0.25 mm in dashes of 3 mm with gaps of 0.75 mm, centre lines 0.25 mm in
/// dashes of about 6 mm with a dot between two.
[[nodiscard]] LinePens technical_pens();
/// For people: an outline of 0.7 mm, contours within it of 0.35 mm, creases of 0.18 mm, hidden lines of 0.13 mm.
[[nodiscard]] LinePens figure_pens();
/// Hidden lines that are thin (0.13 mm) instead of dashed.
[[nodiscard]] Pen thin_pen();

/// One view of a sheet.
struct SheetView {
  std::string name;  ///< in front of objects' names; may be empty
  Strokes strokes;
  glm::dvec2 origin{0};  ///< millimetres: where the view's pixel (0, 0) begins
  double millimetres_per_pixel = 1;
  std::vector<HatchLine> hatching{};
  std::vector<Stipple> stippling{};
  std::vector<CentreLine> centre_lines{};

  [[nodiscard]] glm::dvec2 on_page(const glm::dvec2& pixel) const { return origin + millimetres_per_pixel * pixel; }
};

/// A page with the layers "5 stippling", "4 hatching", "6 centre lines", "1 hidden", "2 visible" and "3 outline", those
/// that have lines, the lowest first. Each has a group for every view and object, named as they are; in the order of
/// the strokes and of the hatching. Centre lines have groups by their dashes, without names.
[[nodiscard]] Page page_of(const Surfaces& surfaces, std::span<const SheetView> views, const LinePens& pens,
                           const glm::dvec2& size);

/// What the parts of a drawing cover, hidden ones only where asked for: low and high corner, in pixels. Low is greater
/// than high where there is nothing.
struct DrawingBounds {
  glm::dvec2 low{std::numeric_limits<double>::infinity()}, high{-std::numeric_limits<double>::infinity()};
  [[nodiscard]] bool is_empty() const { return !(low.x <= high.x && low.y <= high.y); }
};
[[nodiscard]] DrawingBounds bounds_of(const Drawing& drawing, bool with_hidden);

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
