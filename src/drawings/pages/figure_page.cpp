// SPDX-License-Identifier: Apache-2.0
// Figures as pages: shapes are filled paths, and each blend group is a group with an opacity.
#include <span>

#include "frontmost/sheets.h"

namespace frontmost {
namespace {

/// The size of a pixel in style sheets, so that a figure is as large on a page as the picture in a browser.
constexpr double kMillimetres = 25.4 / 96;

PageColor page_color(const glm::u8vec4& color) { return {color.r, color.g, color.b, color.a}; }

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

/// The end of a blend group of several shapes; otherwise the begin of the next such group.
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
      group.fills.push_back(page_color(shape.color));
      if (is_blended) group.fills.back().opacity = 255;
    }
  return group;
}

}  // namespace

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
