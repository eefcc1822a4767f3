// SPDX-License-Identifier: Apache-2.0
// Drawings on paper: figures (vector pictures of polygons), pages in millimetres and their files, lettering, sheets.
//
//   draw_figure() --> Figure ----+
//   draw_sheet() --> Sheet ------+--> Page --save()--> SVG, PDF, DXF, JSON
//   paths of one's own ----------+
//
// A Figure is the vector counterpart of an Image: three arrays, of which the elements name a range of the next one:
//
//   shapes   | shape 0           | shape 1 | ...    filled in this order, each with one colour
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

/// A closed path of a figure: `corner_count` elements of Figure::corners from `first_corner` on.
struct FigureRing {
  std::size_t first_corner = 0;
  std::uint32_t corner_count = 0;
};
/// A region filled with one colour by the nonzero rule: `ring_count` elements of Figure::rings from `first_ring` on.
struct FigureShape {
  glm::u8vec4 color{0};
  std::uint32_t ring_count = 0;
  std::size_t first_ring = 0;
  /// Ascending. The translucent shapes of one blend group have the same opacity. They are filled opaquely, one after
  /// the other, on a transparent ground; the result is then blended with that opacity.
  std::uint32_t blend_group = 0;
};
/// A picture of polygons: paths to be filled in order. Pixels of the view, x right, y down.
struct Figure {
  View view;
  std::string title;                    ///< title of the file, any text
  std::optional<glm::vec3> background;  ///< sRGB, 0 to 1; none: transparent
  std::vector<FigureShape> shapes;
  std::vector<FigureRing> rings;
  std::vector<glm::dvec2> corners;
};

struct FigureOptions {
  /// Shading, shadows, opacity and background are used. Layers are ignored: figures are translucent where the scene is.
  ShadeOptions shade;
  /// Steps of 8-bit sRGB, 0 to 255: greatest difference between the colour of a polygon and the surface's. Polygons are
  /// cut until they keep to this difference. 255: a triangle has the colour of its middle and is never cut.
  double tolerance = 6;
  /// True: hidden polygons are left out. False: all polygons are kept, in painting order.
  bool visible_only = true;
  /// True: adjacent polygons of one colour become one shape, if no later polygon covers any of them.
  bool merges_neighbours = false;
  /// A figure with more polygons is an error.
  std::size_t most_polygons = 2'000'000;
};

/// \returns a picture of polygons with the colours of shade() for the same view, including textures, shadows and smooth
/// normals; holes of alpha mode MASK are cut out. Polygons are in painting order, exact where surfaces pass through
/// each other. Each polygon extends up to 4 pixels under those painted over it (trapping, as printers call it), so
/// viewers show no hairlines between neighbours. `visible` has one sample a pixel. O(n log n) in the number of
/// polygons, and the pixels that they cover. The same for any number of threads. (M. Newell, R. Newell, T. Sancha. A
/// Solution to the Hidden Surface Problem. 1972.) \throws Error bad_argument for several samples a pixel or options out
/// of range; unsupported for a shown environment; limit_exceeded for more than FigureOptions::most_polygons, or too
/// many intersections or overlaps of triangles.
[[nodiscard]] Figure draw_figure(const Surfaces& surfaces, const ShadeInput& input, const FigureOptions& options = {},
                                 const Execution& execution = {});
[[nodiscard]] Figure draw_figure(const Surfaces& surfaces, const Visible& visible, const FigureOptions& options = {},
                                 const Execution& execution = {});
/// Draws a view, with any number of samples. \throws Error also as validate(view) does.
[[nodiscard]] Figure draw_figure(const Surfaces& surfaces, const View& view, const FigureOptions& options = {},
                                 const Execution& execution = {});
/// Draws a figure, reusing data that a shader has prepared for its surfaces.
[[nodiscard]] Figure draw_figure(Shader& shader, const ShadeInput& input, const FigureOptions& options = {},
                                 const Execution& execution = {});

// Edges over pictures: the strokes of a drawing, over an image of the same view.
//
//   shade() ---------------------------------> Image ----+
//   draw_lines() --chain_strokes()--> Strokes ----------+--draw_strokes()--> the image with edges

/// A round pen for pictures.
struct PicturePen {
  double width = 1.2;           ///< pixels, 0.1 to 1000
  glm::vec3 color{0.1f};        ///< sRGB, 0 to 1
  Blend blend = Blend::linear;  ///< how pixels that are partly ink are blended
};

/// Draws strokes over a picture, in the pixels of its view. A pixel's ink follows from the distance of its centre from
/// the nearest stroke, so rims are smooth, and strokes that meet or cross have no seams. `picture` has planes of floats
/// R, G and B, in linear light. If there is a plane A, colours are premultiplied by it. O(pixels of the picture, and of
/// each stroke), in parallel; the same to the bit for any number of threads. \throws Error bad_argument for a picture
/// without these planes, a pen out of range, strokes with arcs, and points that are not finite or beyond 1e9 pixels.
void draw_strokes(Image& picture, const Strokes& strokes, const PicturePen& pen = {}, const Execution& execution = {});

// Pages: pen lines and filled polygons in millimetres, written as SVG, PDF, DXF or JSON.
//
// A page has x to the right and y down, from its top left corner. Later elements lie over earlier ones.

/// sRGB and opacity, 0 to 255 each; not premultiplied.
struct PageColor {
  std::uint8_t red = 0, green = 0, blue = 0, opacity = 255;
  friend bool operator==(const PageColor&, const PageColor&) = default;
};

/// How lines are drawn. Ends and corners are round.
struct Pen {
  double width = 0.25;  ///< millimetres, 0 to 1000; 0 draws nothing
  PageColor color;
  /// Millimetres drawn, left out, drawn and so on; an even count. Empty: a solid line. Each path restarts the pattern.
  std::vector<double> dashes{};
};

/// The part of a text that lies at its place: its beginning, its middle or its end.
enum class TextAlign : std::uint8_t { left, centre, right };
/// The height of a text that lies at its place: the lower edge of capitals, their middle or their upper edge.
enum class TextLine : std::uint8_t { bottom, middle, top };

struct TextStyle {
  double height = 3.5;  ///< millimetres, of capitals and digits with the pen's width: 1.8, 2.5, 3.5, 5, 7, 10, 14, 20
  double angle = 0;     ///< radians by which the text is turned about its place, counter-clockwise for the reader
  TextAlign align = TextAlign::left;
  TextLine line = TextLine::bottom;
};

/// A text of a page, which programs can search. PDF shows it in the strokes of add_text(). SVG and DXF name a font, so
/// that letters depend on the program.
struct PlacedText {
  std::string text;  ///< UTF-8, any text
  glm::dvec2 at{0};  ///< millimetres
  TextStyle style;   ///< height from 0.01 to 1000 mm
};

/// linear: distance between two points along a direction. position: distance from an origin that several dimensions
/// share.
enum class DimensionKind : std::uint8_t { linear, position, diameter, radius };

/// A dimension of a drawing, for CAD programs: what it measures, and the paths and the text of its group that show it.
/// Two dimensions share no path and no text.
struct PageDimension {
  DimensionKind kind = DimensionKind::linear;
  glm::dvec2 from{0}, to{0};  ///< measured points; opposite points of a circle; centre and point of an arc
  glm::dvec2 line{0};         ///< a point of the dimension line, or the end of the leader
  double angle = 0;           ///< linear, position: radians of the measured direction, as in TextStyle; 0: horizontal
  double factor = 1;          ///< the stated number per millimetre of the page
  std::uint32_t first_path = 0, path_count = 0, text = 0;  ///< indices of PageGroup::paths and PageGroup::texts
};

/// Consecutive points of a group, joined in order. A single point is a dot.
struct PagePath {
  std::uint32_t first = 0, count = 0;
  bool is_closed = false;  ///< the last point is joined to the first one
  bool is_part = false;    ///< a hole, or another part, of the path before it, and filled together with it
};

/// Paths drawn with one pen, one after the other. One group of millions of paths is faster than many groups.
struct PageGroup {
  std::string name;  ///< name of the object, any text
  Pen pen;
  std::vector<glm::dvec2> points{};  ///< millimetres
  /// Empty: all joins are straight. Otherwise one value for each point, for the join from that point to the next: the
  /// tangent of a quarter of the arc's angle, positive from +x towards +y; 0: straight, 1: a half circle.
  std::vector<double> bulges{};
  std::vector<PagePath> paths{};
  std::vector<PageColor> fills{};  ///< empty: nothing is filled; otherwise one for each path (nonzero winding rule)
  /// Opacity of the group as a whole, 0 to 255: the group is drawn on a transparent ground and then blended.
  std::uint8_t opacity = 255;
  std::vector<PlacedText> texts{};  ///< over the paths, in the colour of the pen
  std::vector<PageDimension> dimensions{};

  /// Appends a path without arcs.
  void add(std::span<const glm::dvec2> corners, bool is_closed, bool is_part = false);
  [[nodiscard]] bool is_empty() const { return paths.empty() && texts.empty(); }
};

struct PageLayer {
  std::string name;  ///< plotters choose layers by the number at the beginning of the name: "1 hidden"
  std::vector<PageGroup> groups{};
};

struct Page {
  double width = 210, height = 297;  ///< millimetres, 0.01 to 100000 (100 m)
  std::string title{};
  std::vector<PageLayer> layers{};
};

/// Turns each dash of a page into a path of its own, for plotters, which cannot draw dashes by themselves. Patterns run
/// along whole paths. Between corners of 25 degrees or more, a pattern is stretched so that both ends are drawn (ISO
/// 128-2). Fills and texts are unchanged; dimensions of dashed groups are left out. O(points + dashes). \throws Error
/// as validate() does; limit_exceeded for more than 20 million dashes.
[[nodiscard]] Page with_real_dashes(Page page, const Execution& execution = {});

enum class PageFormat : std::uint8_t { svg, pdf, dxf, json };

/// \throws Error bad_argument or limit_exceeded, naming layer and group: sizes out of range; points that are not finite
/// or more than 1000 m away; bulges beyond 10; paths of missing points; dimensions of paths or texts that are missing,
/// or that two dimensions share; lists of different lengths.
void validate(const Page& page);

/// The page format that a file's suffix names; none for other suffixes.
[[nodiscard]] std::optional<PageFormat> page_format(const std::string& path);

// How pages become files:
//
//   SVG    Sizes in millimetres, one user unit to the millimetre. Layers and groups are named as in Inkscape. No style
//          sheets, clip paths, masks or transforms, except the rotation of texts that are not level.
//   PDF    Version 1.5, compressed. Layers are optional content, groups with an opacity transparency groups. Version
//          1.6 with a scaled user unit if a side exceeds 5080 mm. Texts have a font of the strokes of add_text().
//   DXF    AutoCAD 2000, in millimetres ($INSUNITS), y up from the page's lower left corner. LINE, LWPOLYLINE, ARC,
//          CIRCLE, POINT, TEXT, and DIMENSION with a block of its lines and its text; positions are lines and texts.
//          Each group is a layer, "2_VISIBLE-WHEEL" after layer and group; from a thousand groups on, each page layer
//          is one. Names have at most 31 letters, digits and -. A layer has the pen's width, rounded to the nearest of
//          AutoCAD's, and its colour; a black pen's depends on the digit that begins the page layer's name. Line types
//          are HIDDEN, CENTER and PHANTOM for one, two and more dashes in a period, with "2" or "X2" appended if much
//          shorter or longer; pens that share a name get the first pen's dashes.
//   JSON   All of the page, unchanged.

/// Writes a page, whole or not at all. Coordinates are rounded to 0.001 mm, so paths that share a point share it in the
/// file. Names lose characters that the format does not allow. The bytes depend on the page alone (in PDF also on the
/// version of zlib). Takes constant memory beside the page. \throws Error as validate() does; bad_argument without a
/// format; unsupported for fills in DXF; file_unwritable.
void save(const Page& page, const std::string& path, std::optional<PageFormat> format = std::nullopt,
          const Execution& execution = {});

/// Writes several pages, of any sizes, into one PDF. Layers of one name are switched together; the title is that of the
/// first page. \throws Error as for one page; bad_argument without a page; unsupported for several in other formats.
void save(std::span<const Page> pages, const std::string& path, std::optional<PageFormat> format = std::nullopt,
          const Execution& execution = {});

/// The way of a plotter's pen over a page, in millimetres, and the number of elements.
struct PenTravel {
  double down = 0;  ///< length of drawn lines
  double up = 0;    ///< length of moves between paths, beginning at the page's corner
  std::size_t paths = 0, points = 0, arcs = 0;
  std::size_t texts = 0;  ///< elements of PageGroup::texts, which a pen cannot draw
};
[[nodiscard]] PenTravel travel_of(const Page& page);

/// A figure as a page of its size; a pixel is 1/96 inch, as in style sheets.
[[nodiscard]] Page page_of(const Figure& figure);
/// Writes a figure, as SVG or PDF by the suffix. \throws Error as save() of pages does.
void save(const Figure& figure, const std::string& path, std::optional<PageFormat> format = std::nullopt,
          const Execution& execution = {});

// Lettering: text as strokes of one pen, the same in every format and on every machine.
//
// Fonts look different in every viewer, and plotters have none. Text therefore becomes paths of lines and arcs, by
// default. It is placed by one of nine points of the box around its capitals:
//
//   left         centre         right
//    x-------------x-------------x     top: upper edge of capitals
//    |  A  4      1 2 . 5    m m  |     middle
//    x-------------x-------------x     bottom: base line

/// strokes: paths of lines and arcs. text: PlacedText, which programs can search and edit.
enum class Lettering : std::uint8_t { strokes, text };

/// The pen for letters of this height after ISO 3098 type B: a tenth of the height.
[[nodiscard]] Pen text_pen(double height);

/// Appends `text`, in UTF-8, as paths of lines and arcs: upright letters after ISO 3098-1 type B. Small letters are
/// 7/10 as high as capitals and descend 3/10 below. `group` should have text_pen() of the same height. Available are
/// ASCII, Latin-1 with the signs for diameter, degree, plus-minus and times, letters of Central and Northern Europe,
/// quotes, dashes and some signs of drawings. Anything else, including invalid UTF-8 and control characters, is a box
/// as high as a capital. Blanks have no path. Lettering::text appends to PageGroup::texts instead. O(text).
void add_text(PageGroup& group, std::string_view text, const glm::dvec2& at, const TextStyle& style = {},
              Lettering lettering = Lettering::strokes);

/// Millimetres from the left edge of the first character to the right edge of the last, with their pen; 0 without any.
[[nodiscard]] double text_width(std::string_view text, double height = 3.5);

// Views of a sheet: strokes, hatching and centre lines at their places on a page, with the pens of drawing standards.
// draw_sheet() performs all of these steps; call them yourself to lay out pages of your own.
//
//   Drawing --chain_strokes()--> Strokes ----+
//   hatch(), stipple(), centre_lines_of() ----+--> SheetView --page_of()--> Page --save()--> file

/// Pens by the kind of line.
struct LinePens {
  Pen outline{0.5, {}};  ///< seen edges that bound the scene
  Pen seen{0.5, {}};     ///< all other seen lines
  Pen crease{0.5, {}};   ///< seen creases, if strokes were made by kind
  Pen hidden{0.25, {}, {3, 0.75}};
  Pen hatching{0.18, {}};
  Pen stippling{0.3, {}};  ///< its width is the diameter of dots
  /// Long dashes and dots. A line has an odd number of long dashes, stretched so that its beginning, its middle and its
  /// end each lie in one of them. A short line is solid.
  Pen centre{0.25, {}, {6, 1, 0.1, 1}};
};
/// Pens of ISO 128: seen lines 0.5 mm; hidden lines 0.25 mm in dashes of 3 mm with gaps of 0.75 mm; centre lines 0.25
/// mm in dashes of about 6 mm with a dot between two.
[[nodiscard]] LinePens technical_pens();
/// Pens for illustrations: outline 0.7 mm, contours within it 0.35 mm, creases 0.18 mm, hidden lines 0.13 mm.
[[nodiscard]] LinePens figure_pens();
/// A pen for hidden lines that are thin (0.13 mm) instead of dashed.
[[nodiscard]] Pen thin_pen();

/// A view with its place on a page.
struct SheetView {
  std::string name;  ///< prefix of objects' names; may be empty
  Strokes strokes;
  glm::dvec2 origin{0};  ///< millimetres: place of the view's pixel (0, 0) on the page
  double millimetres_per_pixel = 1;
  std::vector<HatchLine> hatching{};
  std::vector<Stipple> stippling{};
  std::vector<CentreLine> centre_lines{};

  [[nodiscard]] glm::dvec2 on_page(const glm::dvec2& pixel) const { return origin + millimetres_per_pixel * pixel; }
};

/// A page with the layers "5 stippling", "4 hatching", "6 centre lines", "1 hidden", "2 visible" and "3 outline", in
/// this order, lowest first, without empty ones. A layer has a named group for every view and object, in the order of
/// the strokes and of the hatching. Centre lines are grouped by their dashes, without names.
[[nodiscard]] Page page_of(const Surfaces& surfaces, std::span<const SheetView> views, const LinePens& pens,
                           const glm::dvec2& size);

/// Bounds of the parts of a drawing, in pixels. Empty: `low` is greater than `high`.
struct DrawingBounds {
  glm::dvec2 low{std::numeric_limits<double>::infinity()}, high{-std::numeric_limits<double>::infinity()};
  [[nodiscard]] bool is_empty() const { return !(low.x <= high.x && low.y <= high.y); }
};
[[nodiscard]] DrawingBounds bounds_of(const Drawing& drawing, bool with_hidden);

// Sheets: the views of a model on paper by one call, at a scale, with sections, dimensions and title block.
//
//    +--------------------------------------+
//    |   front         left                 |     First-angle projection: the view from the left stands to the right
//    |                                      |     of the front view, and the view from above stands below it.
//    |   top           three-quarter        |     Third-angle projection is the other way round.
//    |               +----------------------+
//    |               |     title block      |
//    +---------------+----------------------+

/// The paper of a sheet.
struct Paper {
  glm::dvec2 size{210, 297};  ///< millimetres, 1 to 100000 each
  bool may_turn = true;       ///< true: the sides change places if that suits the drawing better
  bool fits_drawing = false;  ///< true: as large as the drawing and its margins; `size` is ignored
};

/// The paper with this name: "a0" to "a6", "letter", "legal" or "tabloid", in small letters or capitals. The suffix
/// "-portrait" or "-landscape" fixes its orientation. \throws Error bad_argument for any other name.
[[nodiscard]] Paper named_paper(std::string_view name);
/// The name of paper of that size in millimetres, in either orientation: "A3"; "420 x 200" if it has none.
[[nodiscard]] std::string paper_name(const glm::dvec2& size);

/// A scale as drawings write it: "1:5", "2:1", "1:3.2".
[[nodiscard]] std::string scale_text(double scale);
/// The largest scale of ISO 5455 (1, 2 and 5 times powers of ten, and their reciprocals) up to `most`, from 5e9:1 to
/// 1:1e10; `most` itself if that is smaller than all of them.
[[nodiscard]] double standard_scale(double most);

/// Where views stand around the front view. The title block shows the symbol of the method (ISO 5456-2).
enum class ProjectionMethod : std::uint8_t { none, first_angle, third_angle };

/// Contents of the fields of a title block, in UTF-8. Text too long for its field at 1.8 mm is written smaller.
struct TitleBlock {
  std::string title{};   ///< up to two lines
  std::string number{};  ///< number of the drawing
  std::string author{}, date{}, owner{};
  std::string scale{};  ///< for example "1:2"
  std::string unit{};   ///< unit of the numbers on the drawing, for example "mm"
  std::string paper{};  ///< for example "A3"
  ProjectionMethod projection = ProjectionMethod::none;
  int sheet = 1, sheets = 1;
};

/// Name of a view: "front", "back", ..., "three-quarter".
[[nodiscard]] std::string_view view_name(NamedView view);

/// How hidden edges are drawn.
enum class HiddenLines : std::uint8_t { none, dashed, thin };

/// technical: all seen lines with one pen, after drawing standards (technical_pens()). figure: for illustrations,
/// outlines heavier than contours, and contours heavier than creases (figure_pens()).
enum class DrawingStyle : std::uint8_t { technical, figure };

/// A view of the model cut by a plane across the viewing direction, without the part in front of the plane.
struct SectionView {
  NamedView direction = NamedView::front;  ///< one of the six along the axes
  /// Coordinate of the plane along that axis, as in the file. None: the middle of the model.
  std::optional<double> at = std::nullopt;
};

/// The dimensions on a sheet, after ISO 129. Each level has those before it.
enum class Dimensioning : std::uint8_t {
  none,
  overall,    ///< width, height and depth
  diameters,  ///< diameters of circles and cylinders that are seen along their axes
  holes,      ///< positions of these, from the lower left corner of their view
  all,        ///< radii of arcs, depths of blind holes, positions of plane faces, widths across flats
};

/// Options of sheets. Millimetres are on paper.
struct SheetOptions {
  // The views of the sheet, in parallel projection at one scale. Views are aligned with their neighbours.
  std::vector<NamedView> views{};  ///< each at most once; at most one of iso and three_quarter, which share a place
  /// At most 24 sections, named A-A, B-B and so on in their order. The first view that sees a cutting plane edge-on
  /// marks the plane.
  std::vector<SectionView> sections{};
  /// Objects that sections leave whole if the plane runs along their axis (ISO 128-44): those with one of these words,
  /// or its plural, in their names, whatever its case; and, if there are any words, those that are shafts by their
  /// shape.
  std::vector<std::string> uncut{"bolt", "screw", "nut", "washer", "rivet", "pin", "dowel", "shaft", "axle", "ball"};
  ProjectionMethod projection = ProjectionMethod::first_angle;  ///< where views stand around the front view
  Dimensioning dimensions = Dimensioning::none;                 ///< needs views

  // How lines are drawn.
  HiddenLines hidden = HiddenLines::none;
  /// Views that show hidden lines. None: all but iso and three_quarter. Sections never show them.
  std::optional<std::vector<NamedView>> hidden_views = std::nullopt;
  DrawingStyle style = DrawingStyle::technical;
  /// Millimetres, 0.01 to 10: width of seen lines; other widths and dashes scale with it. None: the pens of `style`.
  std::optional<double> pen = std::nullopt;
  std::optional<double> crease_angle = std::nullopt;  ///< radians, see LineOptions
  /// Millimetres, 0 to 10, see StrokeOptions::shortest. Hatch lines shorter than this, or than 0.2 mm, are left out.
  /// None: 0.5 for plotters, otherwise 0.
  std::optional<double> shortest_stroke = std::nullopt;
  std::optional<bool> centre_lines = std::nullopt;  ///< none: on technical sheets of named views
  /// True, for pen plotters: strokes continue from object to object and across gaps of 0.05 mm, ordered to spare lifts
  /// of the pen. Strokes in the ink of longer strokes are left out, see StrokeOptions::ink_reach and Strokes::covered.
  /// Use with_real_dashes() to make each dash a line.
  bool plot = false;
  Lettering lettering = Lettering::strokes;  ///< of dimensions, sections and frame; text: not with `plot`

  // Paper and scale.
  /// None: A4; with `scale`, as large as the drawing, or the smallest of A4 to A0 with room for a title block as well.
  std::optional<Paper> page = std::nullopt;
  double margin = 10;  ///< millimetres, 0 to 1000, at each side
  /// Length on paper divided by that of the model, 1e-12 to 1e12. None: the largest that fits the page.
  std::optional<double> scale = std::nullopt;
  /// True: if `scale` is none, the scale is one of ISO 5455. None: true on sheets of named views.
  std::optional<bool> standard_scale = std::nullopt;
  /// The unit of the model's numbers, in place of the file's. None: SceneSource::metres_per_unit, or else 1.
  std::optional<double> millimetres_per_unit = std::nullopt;
  /// Unit of dimensions and title block: inches with three decimals, or millimetres with two. None: as the model's.
  std::optional<bool> in_inches = std::nullopt;
  /// True: dimensions in inches within 0.0005 of a multiple of 1/64 are fractions, "1 7/8". Ignored in millimetres.
  bool inch_fractions = false;
  /// A frame with this title block. Scale, unit, paper and projection are filled in.
  std::optional<TitleBlock> title_block = std::nullopt;

  // Dark surfaces, by hatch() and stipple(); not together with sections.
  std::optional<double> hatch = std::nullopt;      ///< millimetres between lines, 0.2 to 50
  std::optional<double> stipple = std::nullopt;    ///< millimetres between dots, 0.2 to 10
  double hatch_angle = std::numbers::pi / 4;       ///< radians, counter-clockwise from horizontal
  std::optional<glm::dvec3> light = std::nullopt;  ///< direction towards the light: right, up, towards the viewer
  bool casts_shadows = true;

  // The camera.
  /// Pixels of a view, 0.001 to 1000: greatest distance of triangles from curved surfaces. None: 0.2, or what is quick.
  std::optional<double> tessellation_error = std::nullopt;
  /// For named views: clipping planes in place of those that enclose the model.
  std::optional<double> near = std::nullopt, far = std::nullopt;
  /// For a given view. True: the page shows the view's whole picture. False: the page fits the lines.
  bool keeps_picture = false;
};

/// A drawn view of a sheet.
struct DrawnView {
  std::string name;  ///< for example "front"; "A-A" for a section; empty if the view was given
  /// The surfaces of `drawing`: the caller's, which must still exist, or those made for a view of curved or cut ones.
  std::shared_ptr<const Surfaces> surfaces;
  std::shared_ptr<const Section> section;  ///< null if nothing was cut
  Drawing drawing;
  bool shows_hidden = false;
  SheetView placed;  ///< the lines at their places on the page
};

struct Sheet {
  Page page;
  std::optional<double> scale;   ///< none in perspective
  std::vector<DrawnView> views;  ///< whole views, then sections, in their order
  bool is_empty = false;         ///< no line of the model is on the sheet
  std::size_t left_out = 0;      ///< number of diameters, radii, widths across flats, positions and steps without room
  /// Number of cylinders without a diameter: no view along the cylinder's axis shows the cylinder, and no view from the
  /// side states its diameter.
  std::size_t undrawn = 0;
  std::size_t prisms = 0;  ///< number of diameters of cylinders of 7 to 17 sides, which count as polygons
};

/// \throws Error bad_argument, with the field, for values out of range, and options that exclude or need each other.
void validate(const SheetOptions& options);

/// Draws the named views and sections of `options` on one page. Layers are those of page_of(), then "9 sections", "7
/// dimensions" and "8 frame". A watch sees the stages "views", "rounds", "layout", "tones" and "page", and those of the
/// functions called. The bytes are the same for any number of threads.
/// \throws Error as validate(), draw_lines(), hatch(), stipple() and tessellate() do; bad_argument for options without
/// a view, and for a plane that misses the model; limit_exceeded if the page is too small, with what would fit.
[[nodiscard]] Sheet draw_sheet(const Surfaces& surfaces, const SheetOptions& options, const Execution& execution = {});

/// Draws one view on a page of its own. Lines are as fine as its pixels: 3840 x 2160 suffice for all paper. \throws
/// Error as draw_sheet() does; bad_argument for options of named views, and for a scale or centre lines in perspective.
[[nodiscard]] Sheet draw_view(const Surfaces& surfaces, const View& view, const SheetOptions& options = {},
                              const Execution& execution = {});

}  // namespace frontmost
