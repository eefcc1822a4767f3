// SPDX-License-Identifier: Apache-2.0
// Pages: pen lines and filled polygons in millimetres, written as SVG, PDF, DXF or JSON.
//
// A page has x to the right and y down, from its top left corner. What comes first lies below what comes later. Colours
// are sRGB, as those files have them.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "frontmost/base.h"
#include "frontmost/figure.h"

namespace frontmost {

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

}  // namespace frontmost
