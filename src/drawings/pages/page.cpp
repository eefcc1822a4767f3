// SPDX-License-Identifier: Apache-2.0
// Pages are validated here, so that their writers have no error paths. A page is refused if a format could not write
// it: for numbers that are not finite or have too many digits, for lists of different lengths, and for paths with
// missing points. The shapes of a figure become filled paths of a page, and each of its blend groups becomes a group
// with an opacity.
#include <cmath>
#include <filesystem>
#include <span>

#include "base/parallel.h"
#include "frontmost/sheets.h"
#include "pages/formats.h"

namespace frontmost {
namespace {

constexpr double least_side = 0.01, most_side = 1e5, farthest = 1e6, most_width = 1000, most_bulge = 10,
                 most_angle = 1000;

[[noreturn]] void refuse(const std::string& where, const char* reason) {
  throw Error(ErrorCode::bad_argument, where, reason);
}

// Conditions are written so that NaN fails, here and below.
void check_place(const glm::dvec2& p, const std::string& where) {
  if (!(std::abs(p.x) <= farthest && std::abs(p.y) <= farthest))
    refuse(where, "a point is not finite, or farther than 1000 m from the page");
}

void check_group(const PageGroup& group, const std::string& where) {
  const Pen& pen = group.pen;
  if (!(pen.width >= 0 && pen.width <= most_width)) refuse(where, "the pen's width must be from 0 to 1000 mm");
  if (pen.dashes.size() % 2 != 0) refuse(where, "dashes and gaps must come in pairs");
  for (const double dash : pen.dashes)
    if (!(dash >= 0.001 && dash <= most_side)) refuse(where, "dashes and gaps must be from 0.001 to 100000 mm");
  if (group.points.size() > 0xFFFFFFFFu) throw Error(ErrorCode::limit_exceeded, where, "over 2^32 points");
  for (const glm::dvec2& p : group.points) check_place(p, where);
  if (!group.bulges.empty() && group.bulges.size() != group.points.size())
    refuse(where, "bulges and points differ in number");
  for (const double bulge : group.bulges)
    if (!(std::abs(bulge) <= most_bulge)) refuse(where, "a bulge is beyond 10");
  if (!group.fills.empty() && group.fills.size() != group.paths.size())
    refuse(where, "fills and paths differ in number");
  for (const PagePath& path : group.paths)
    if (path.count == 0 || path.first >= group.points.size() || path.count > group.points.size() - path.first)
      refuse(where, "a path has no points, or points beyond the last one of the page");
  if (!group.paths.empty() && group.paths[0].is_part)
    refuse(where, "the first path is part of a path, but there is none before it");
  for (const PlacedText& text : group.texts) {
    check_place(text.at, where);
    if (!(text.style.height >= least_side && text.style.height <= most_width &&
          std::abs(text.style.angle) <= most_angle))
      refuse(where, "a text's height must be from 0.01 to 1000 mm, its angle at most 1000 radians");
  }
  std::vector<bool> is_path_taken(group.dimensions.empty() ? 0 : group.paths.size());
  std::vector<bool> is_text_taken(group.dimensions.empty() ? 0 : group.texts.size());
  const auto take = [&where](std::vector<bool>& is_taken, std::size_t i) {
    if (is_taken[i]) refuse(where, "two dimensions share a path or a text");
    is_taken[i] = true;
  };
  for (const PageDimension& dimension : group.dimensions) {
    for (const glm::dvec2& p : {dimension.from, dimension.to, dimension.line}) check_place(p, where);
    if (!(std::abs(dimension.angle) <= most_angle && dimension.factor >= 1e-15 && dimension.factor <= 1e15))
      refuse(where, "a dimension's angle must be at most 1000 radians, its factor from 1e-15 to 1e15");
    if (dimension.first_path > group.paths.size() || dimension.path_count > group.paths.size() - dimension.first_path ||
        dimension.text >= group.texts.size())
      refuse(where, "a dimension has paths or a text beyond the last one of its group");
    for (std::size_t i = 0; i < dimension.path_count; ++i) take(is_path_taken, dimension.first_path + i);
    take(is_text_taken, dimension.text);
  }
}

/// Millimetres per pixel, as in style sheets, so that a figure is as large on a page as the picture in a browser.
constexpr double kMillimetres = 25.4 / 96;

PageGroup backdrop(const glm::vec3& color, const Page& page) {
  PageGroup group{"background", Pen{}};
  group.pen.width = 0;
  group.add(std::array{glm::dvec2(0), glm::dvec2(page.width, 0), glm::dvec2(page.width, page.height),
                       glm::dvec2(0, page.height)},
            true);
  const auto part = [](float value) { return std::uint8_t(value * 255.0f + 0.5f); };
  group.fills.push_back({part(color.r), part(color.g), part(color.b)});
  return group;
}

/// The end of the shapes from `begin` on that become one page group: a blend group of several shapes, or all shapes
/// before the next such blend group.
std::size_t end_of_group(std::span<const FigureShape> shapes, std::size_t begin) {
  const auto goes_on = [&](std::size_t i) {
    return i + 1 < shapes.size() && shapes[i + 1].blend_group == shapes[i].blend_group;
  };
  std::size_t end = begin;
  if (goes_on(begin)) {
    while (goes_on(end)) ++end;
    return end + 1;
  }
  while (end < shapes.size() && !goes_on(end)) ++end;
  return end;
}

/// The page group of these shapes. A blend group has one opacity for all of its shapes.
PageGroup group_of(const Figure& figure, std::span<const FigureShape> shapes) {
  PageGroup group{"surfaces", Pen{}};
  group.pen.width = 0;
  const bool is_blended = shapes.size() > 1 && shapes[0].blend_group == shapes[1].blend_group;
  if (is_blended) group.opacity = shapes[0].color.a;
  const FigureShape& last = shapes.back();
  const std::size_t ring_count = last.first_ring + last.ring_count - shapes[0].first_ring;
  group.paths.reserve(ring_count);
  group.fills.reserve(ring_count);
  std::vector<glm::dvec2> outline;
  for (const FigureShape& shape : shapes)
    for (std::uint32_t i = 0; i < shape.ring_count; ++i) {
      const FigureRing& ring = figure.rings[shape.first_ring + i];
      outline.clear();
      for (std::size_t k = 0; k < ring.corner_count; ++k)
        outline.push_back(figure.corners[ring.first_corner + k] * kMillimetres);
      group.add(outline, true, i > 0);
      const glm::u8vec4& color = shape.color;
      group.fills.push_back({color.r, color.g, color.b, is_blended ? std::uint8_t(255) : color.a});
    }
  return group;
}

}  // namespace

void PageGroup::add(std::span<const glm::dvec2> corners, bool is_closed, bool is_part) {
  paths.push_back({std::uint32_t(points.size()), std::uint32_t(corners.size()), is_closed, is_part});
  points.insert(points.end(), corners.begin(), corners.end());
}

void validate(const Page& page) {
  for (const double side : {page.width, page.height})
    if (!(side >= least_side && side <= most_side)) refuse("page", "its sides must be from 0.01 to 100000 mm");
  for (std::size_t i = 0; i < page.layers.size(); ++i)
    for (std::size_t j = 0; j < page.layers[i].groups.size(); ++j)
      check_group(page.layers[i].groups[j], "page: layer " + std::to_string(i) + ": group " + std::to_string(j));
}

std::optional<PageFormat> page_format(const std::string& path) {
  std::string suffix = std::filesystem::path(path).extension().string();
  for (char& c : suffix) c = c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c;
  if (suffix == ".svg") return PageFormat::svg;
  if (suffix == ".pdf") return PageFormat::pdf;
  if (suffix == ".dxf") return PageFormat::dxf;
  if (suffix == ".json") return PageFormat::json;
  return std::nullopt;
}

void save(const Page& page, const std::string& path, std::optional<PageFormat> format, const Execution& execution) {
  save(std::span(&page, 1), path, format, execution);
}

void save(std::span<const Page> pages, const std::string& path, std::optional<PageFormat> format,
          const Execution& execution) {
  if (pages.empty()) throw Error(ErrorCode::bad_argument, path, "", "no pages");
  for (const Page& page : pages) validate(page);
  if (!format) format = page_format(path);
  if (!format)
    throw Error(ErrorCode::bad_argument, path, "", "the suffix names no format; use .svg, .pdf, .dxf or .json");
  if (pages.size() > 1 && *format != PageFormat::pdf)
    throw Error(ErrorCode::unsupported, path, "", "only PDF files can have several pages");
  const Page& page = pages[0];
  OutputFile file(path);
  switch (*format) {
    case PageFormat::svg: detail::save_svg(page, file, execution); break;
    case PageFormat::pdf: detail::save_pdf(pages, file, execution); break;
    case PageFormat::dxf: detail::save_dxf(page, file, execution); break;
    case PageFormat::json: detail::save_json(page, file, execution); break;
  }
  check_cancelled(execution);
  file.commit();
}

PenTravel travel_of(const Page& page) {
  PenTravel sum;
  glm::dvec2 pen(0);
  for (const PageLayer& layer : page.layers)
    for (const PageGroup& group : layer.groups) {
      sum.texts += group.texts.size();
      for (const PagePath& path : group.paths) {
        sum.up += glm::distance(pen, group.points[path.first]);
        ++sum.paths;
        sum.points += path.count;
        for (std::uint32_t i = 0; i < detail::join_count(path); ++i) {
          const detail::Join join = detail::join_of(group, path, i);
          const std::optional<detail::Arc> arc = detail::arc_between(join.from, join.to, join.bulge);
          sum.arcs += arc.has_value();
          sum.down += arc ? arc->radius * std::abs(arc->turn) : glm::distance(join.from, join.to);
        }
        pen = group.points[path.is_closed ? path.first : path.first + path.count - 1];
      }
    }
  return sum;
}

Page page_of(const Figure& figure) {
  Page page{figure.view.width * kMillimetres, figure.view.height * kMillimetres, figure.title};
  PageLayer& layer = page.layers.emplace_back(PageLayer{"figure"});
  if (figure.background) layer.groups.push_back(backdrop(*figure.background, page));
  const std::span<const FigureShape> shapes(figure.shapes);
  for (std::size_t begin = 0, end; begin < shapes.size(); begin = end) {
    end = end_of_group(shapes, begin);
    layer.groups.push_back(group_of(figure, shapes.subspan(begin, end - begin)));
  }
  return page;
}

void save(const Figure& figure, const std::string& path, std::optional<PageFormat> format, const Execution& execution) {
  save(page_of(figure), path, format, execution);
}

}  // namespace frontmost
