// SPDX-License-Identifier: Apache-2.0
// A page as JSON: all of its data under the names of the library's types, with as many digits as other formats.
//
//   {"width": ..., "layers": [{"name": ..., "groups": [{"pen": {...}, "paths": [{"points": [[x, y], ...]}, ...]}]}]}
#include "base/decimal.h"
#include "pages/formats.h"

namespace frontmost::detail {
namespace {

void write_color(PageText& out, const PageColor& color) {
  out << "[";
  for (const std::uint8_t part : {color.red, color.green, color.blue}) out << part << ", ";
  out << color.opacity << "]";
}

void write_pen(PageText& out, const Pen& pen) {
  out << "{\"width\": ";
  out.decimal(pen.width) << ", \"color\": ";
  write_color(out, pen.color);
  out << ", \"dashes\": [";
  for (std::size_t i = 0; i < pen.dashes.size(); ++i) {
    if (i > 0) out << ", ";
    out.decimal(pen.dashes[i]);
  }
  out << "]}";
}

void write_path(PageText& out, const PageGroup& group, std::size_t i) {
  const PagePath& path = group.paths[i];
  out << (i == 0 ? "\n" : ",\n") << "{\"closed\": " << (path.is_closed ? "true" : "false");
  if (path.is_part) out << ", \"part\": true";
  if (!group.fills.empty()) {
    out << ", \"fill\": ";
    write_color(out, group.fills[i]);
  }
  out << ", \"points\": [";
  bool has_arcs = false;
  for (std::uint32_t k = path.first; k < path.first + path.count; ++k) {
    out << (k == path.first ? "[" : ", [");
    out.decimal(group.points[k].x) << ", ";
    out.decimal(group.points[k].y) << "]";
    has_arcs |= !group.bulges.empty() && group.bulges[k] != 0;
  }
  out << "]";
  if (has_arcs) {
    out << ", \"bulges\": [";
    for (std::uint32_t k = path.first; k < path.first + path.count; ++k) {
      if (k != path.first) out << ", ";
      out.decimal(group.bulges[k], 9);
    }
    out << "]";
  }
  out << "}";
}

void write_point(PageText& out, const char* name, const glm::dvec2& p) {
  out << ", \"" << name << "\": [";
  out.decimal(p.x) << ", ";
  out.decimal(p.y) << "]";
}

void write_text(PageText& out, const PlacedText& text) {
  constexpr const char* aligns[] = {"left", "centre", "right"};
  constexpr const char* lines[] = {"bottom", "middle", "top"};
  out << "{\"text\": " << json_text(text.text);
  write_point(out, "at", text.at);
  out << ", \"height\": ";
  out.decimal(text.style.height) << ", \"angle\": ";
  out.decimal(text.style.angle, 9) << ", \"align\": \"" << aligns[int(text.style.align)] << "\", \"line\": \""
                                   << lines[int(text.style.line)] << "\"}";
}

void write_dimension(PageText& out, const PageDimension& dimension) {
  constexpr const char* kinds[] = {"linear", "position", "diameter", "radius"};
  out << "{\"kind\": \"" << kinds[int(dimension.kind)] << '"';
  write_point(out, "from", dimension.from);
  write_point(out, "to", dimension.to);
  write_point(out, "line", dimension.line);
  out << ", \"angle\": ";
  out.decimal(dimension.angle, 9) << ", \"factor\": " << general_text(dimension.factor, 9)
                                  << ", \"first_path\": " << dimension.first_path
                                  << ", \"path_count\": " << dimension.path_count << ", \"text\": " << dimension.text
                                  << "}";
}

/// Writes a list under its name, unless it is empty.
template <class List, class Write>
void write_list(PageText& out, const char* name, const List& list, const Write& write) {
  if (list.empty()) return;
  out << ", \"" << name << "\": [";
  for (const auto& one : list) {
    out << (&one == list.data() ? "\n" : ",\n");
    write(out, one);
  }
  out << "]";
}

}  // namespace

void save_json(const Page& page, OutputFile& file, const Execution& execution) {
  PageText out(file);
  WritingProgress progress(std::span(&page, 1), execution);
  out << "{\"unit\": \"mm\", \"width\": ";
  out.decimal(page.width) << ", \"height\": ";
  out.decimal(page.height) << ", \"title\": " << json_text(page.title) << ", \"layers\": [";
  for (const PageLayer& layer : page.layers) {
    out << (&layer == page.layers.data() ? "\n" : ",\n") << "{\"name\": " << json_text(layer.name) << ", \"groups\": [";
    for (const PageGroup& group : layer.groups) {
      out << (&group == layer.groups.data() ? "\n" : ",\n") << "{\"name\": " << json_text(group.name) << ", \"pen\": ";
      write_pen(out, group.pen);
      if (group.opacity < 255) out << ", \"opacity\": " << group.opacity;
      out << ", \"paths\": [";
      for (std::size_t i = 0; i < group.paths.size(); ++i) {
        progress.step();
        write_path(out, group, i);
      }
      out << "]";
      write_list(out, "texts", group.texts, [&progress](PageText& to, const PlacedText& text) {
        progress.step();
        write_text(to, text);
      });
      write_list(out, "dimensions", group.dimensions, write_dimension);
      out << "}";
    }
    out << "]}";
  }
  out << "]}\n";
  out.flush();
}

}  // namespace frontmost::detail
