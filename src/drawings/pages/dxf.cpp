// SPDX-License-Identifier: Apache-2.0
// DXF of AutoCAD release 12 (AC1009), which all programs read: pairs of lines, a group code and its value.
//
//   0           a group code: the value is the kind of an entity
//   LINE
//   8           the entity's layer
//   2_VISIBLE
//
// Release 12 has neither groups nor line widths: each group is a layer, which gives its line type and colour. The y
// axis of a page points down and that of DXF up, so places are flipped and arcs change their direction.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>

#include "pages/formats.h"

namespace frontmost::detail {
namespace {

/// The name in characters that release 12 allows: capitals, digits, $, - and _.
std::string table_text(const std::string& name) {
  std::string clean;
  for (const char c : name) {
    const char capital = c >= 'a' && c <= 'z' ? char(c - 'a' + 'A') : c;
    const bool is_fine = (capital >= 'A' && capital <= 'Z') || (c >= '0' && c <= '9') || c == '-';
    if (is_fine || clean.empty() || clean.back() != '_') clean += is_fine ? capital : '_';
  }
  return clean;
}

/// With more layers, each layer of the page is only one DXF layer, because a longer list helps nobody.
constexpr std::size_t most_layers = 1000;

struct Layer {
  std::string name;
  Pen pen;
  int color = 7;
};

/// The colour of a layer's lines: the nearest of those with a standard number. Black lines get a colour by the digit at
/// which the page layer's name begins, so that programs and lasers can distinguish classes.
int layer_color(const std::string& page_layer, const PageColor& color) {
  // Number, red, green, blue. Colour 7 is black on white paper and white on a black screen.
  constexpr int all[][4] = {{7, 0, 0, 0},   {1, 255, 0, 0},   {2, 255, 255, 0},   {3, 0, 255, 0},    {4, 0, 255, 255},
                            {5, 0, 0, 255}, {6, 255, 0, 255}, {8, 128, 128, 128}, {9, 192, 192, 192}};
  int nearest = 7, least = std::numeric_limits<int>::max();
  for (const auto& [number, red, green, blue] : all) {
    const int r = red - color.red, g = green - color.green, b = blue - color.blue;
    if (const int distance = r * r + g * g + b * b; distance < least) nearest = number, least = distance;
  }
  // From 1: hidden, visible, outline, hatching, stippling, centre lines, dimensions, frame, sections.
  constexpr int of_classes[] = {7, 6, 7, 5, 8, 9, 1, 3, 4, 3};
  const bool is_numbered = !page_layer.empty() && page_layer[0] >= '0' && page_layer[0] <= '9';
  return nearest == 7 && is_numbered ? of_classes[page_layer[0] - '0'] : nearest;
}

constexpr int by_layer = 256;

class DxfWriter {
 public:
  DxfWriter(const Page& page, OutputFile& file, const Execution& execution)
      : page_(page), out_(file), progress_(std::span(&page, 1), execution) {
    std::size_t groups = 0;
    for (const PageLayer& layer : page.layers) groups += layer.groups.size() + 1;
    std::set<std::string> names = {"0"};  // every drawing has this layer
    std::map<std::string, int> next;
    for (const PageLayer& layer : page.layers) {
      const std::string of_class = table_text(layer.name);
      layers_of_groups_.emplace_back();
      std::optional<std::size_t> common;
      const auto add = [&](const std::string& name, const Pen& pen) {
        // Distinct names of at most 31 characters: there is room for _ and a number below `most_layers`.
        const std::string clean = name.empty() ? "LAYER" : name.substr(0, 26);
        std::string unique = clean;
        for (int& number = next.try_emplace(clean, 2).first->second; !names.insert(unique).second; ++number)
          unique = clean + "_" + std::to_string(number);
        layers_.push_back({unique, pen, layer_color(layer.name, pen.color)});
        return layers_.size() - 1;
      };
      if (layer.groups.empty()) add(of_class, {});
      for (const PageGroup& group : layer.groups) {
        types_.try_emplace(type_name(group.pen), group.pen.dashes);
        const bool is_own = groups <= most_layers && !group.name.empty();
        if (!is_own && !common) common = add(of_class, group.pen);
        // On sheets, every class with named groups fits into 11 characters, so that programs can select all of a class.
        layers_of_groups_.back().push_back(
            is_own ? add(of_class.substr(0, 11) + "-" + table_text(group.name), group.pen) : *common);
      }
    }
  }

  void write() {
    out_ << "999\nmillimetres\n";
    write_header();
    write_tables();
    section("BLOCKS");
    end_section();
    section("ENTITIES");
    for (std::size_t i = 0; i < page_.layers.size(); ++i)
      for (std::size_t k = 0; k < page_.layers[i].groups.size(); ++k)
        write_group(page_.layers[i], page_.layers[i].groups[k], layers_[layers_of_groups_[i][k]]);
    end_section();
    text(0, "EOF");
    out_.flush();
  }

 private:
  // A group code is one short line, its value another.
  void text(int code, std::string_view value) { out_ << code << '\n' << value << '\n'; }
  void integer(int code, int value) { out_ << code << '\n' << value << '\n'; }
  void number(int code, double value, int digits = 3) {
    out_ << code << '\n';
    out_.decimal(value, digits) << '\n';
  }
  void section(std::string_view name) {
    text(0, "SECTION");
    text(2, name);
  }
  void end_section() { text(0, "ENDSEC"); }
  /// Writes a point, with y flipped from down to up.
  void point(const glm::dvec2& p, int code = 10) {
    number(code, p.x);
    number(code + 10, page_.height - p.y);
    number(code + 20, 0);
  }

  void write_header() {
    section("HEADER");
    text(9, "$ACADVER");
    text(1, "AC1009");
    // $INSUNITS is later than release 12, whose readers skip it: 4 is millimetres.
    text(9, "$INSUNITS");
    integer(70, 4);
    text(9, "$MEASUREMENT");
    integer(70, 1);
    text(9, "$EXTMIN");
    point({0, page_.height});
    text(9, "$EXTMAX");
    point({page_.width, 0});
    text(9, "$LIMMIN");
    number(10, 0);
    number(20, 0);
    text(9, "$LIMMAX");
    number(10, page_.width);
    number(20, page_.height);
    end_section();
  }

  /// The line type of a pen, by the number of dashes in a period. Some readers draw all but standard names solid. The
  /// suffix "2" or "X2" means a period about half or twice as long as that of the first such pen.
  [[nodiscard]] std::string type_name(const Pen& pen) const {
    constexpr const char* names[] = {"CONTINUOUS", "HIDDEN", "CENTER", "PHANTOM"};
    const std::string name = names[std::min(pen.dashes.size() / 2, std::size(names) - 1)];
    const auto first = types_.find(name);
    if (first == types_.end() || pen.dashes.empty()) return name;
    const double ratio = period_of(pen.dashes) / period_of(first->second);
    return ratio < 0.7 ? name + "2" : ratio > 1.4 ? name + "X2" : name;
  }
  [[nodiscard]] static double period_of(const std::vector<double>& dashes) {
    return std::accumulate(dashes.begin(), dashes.end(), 0.0);
  }

  void table(std::string_view name, std::size_t entries) {
    text(0, "TABLE");
    text(2, name);
    integer(70, int(entries));
  }

  void write_tables() {
    section("TABLES");
    table("LTYPE", types_.size());
    for (const auto& [name, dashes] : types_) {
      text(0, "LTYPE");
      text(2, name);
      integer(70, 0);
      text(3, dashes.empty() ? "Solid line" : "Dashed, in millimetres");
      integer(72, 'A');
      integer(73, int(dashes.size()));
      number(40, period_of(dashes));
      for (std::size_t i = 0; i < dashes.size(); ++i) number(49, i % 2 == 0 ? dashes[i] : -dashes[i]);
    }
    text(0, "ENDTAB");
    table("LAYER", layers_.size());
    for (const Layer& layer : layers_) {
      text(0, "LAYER");
      text(2, layer.name);
      integer(70, 0);
      integer(62, layer.color);
      text(6, type_name(layer.pen));
    }
    text(0, "ENDTAB");
    end_section();
  }

  void write_group(const PageLayer& of_page, const PageGroup& group, const Layer& layer) {
    if (group.pen.width == 0 || group.pen.color.opacity == 0) return;
    own_type_ = type_name(group.pen);
    if (own_type_ == type_name(layer.pen)) own_type_.clear();
    own_color_ = layer_color(of_page.name, group.pen.color);
    if (own_color_ == layer.color) own_color_ = by_layer;
    for (const PagePath& path : group.paths) {
      progress_.step();
      write_path(group, path, layer.name);
    }
  }

  /// Begins an entity. Properties that are not written are those of the layer, and change with the layer.
  void entity(std::string_view kind, const std::string& layer) {
    text(0, kind);
    text(8, layer);
    if (!own_type_.empty()) text(6, own_type_);
    if (own_color_ != by_layer) integer(62, own_color_);
  }

  void write_path(const PageGroup& group, const PagePath& path, const std::string& layer) {
    if (path.count == 1) {
      entity("POINT", layer);
      point(group.points[path.first]);
    } else if (const std::optional<Arc> arc = whole_arc(group, path)) {
      write_arc(*arc, path.is_closed, layer);
    } else if (path.count == 2) {
      entity("LINE", layer);
      point(group.points[path.first]);
      point(group.points[path.first + 1], 11);
    } else {
      write_polyline(group, path, layer);
    }
  }

  /// DXF angles are degrees anticlockwise with y up, so the direction is reversed. Some readers draw nothing for an ARC
  /// between two equal angles, so a whole turn is a CIRCLE, whether its path is closed or not.
  void write_arc(const Arc& arc, bool is_closed, const std::string& layer) {
    constexpr double whole = 6.28318529;  // short of a whole turn by less than the last digit of an angle
    const bool is_whole = is_closed || std::abs(arc.turn) > whole;
    entity(is_whole ? "CIRCLE" : "ARC", layer);
    point(arc.centre);
    number(40, arc.radius);
    if (is_whole) return;
    const double low = arc.turn > 0 ? arc.begin : arc.begin + arc.turn, high = low + std::abs(arc.turn);
    const auto degrees = [](double angle) {
      const double turned = std::fmod(-angle * 57.295779513082321, 360);
      return turned < 0 ? turned + 360 : turned;
    };
    number(50, degrees(high), 6);
    number(51, degrees(low), 6);
  }

  void write_polyline(const PageGroup& group, const PagePath& path, const std::string& layer) {
    entity("POLYLINE", layer);
    integer(66, 1);
    point({0, page_.height});
    integer(70, path.is_closed ? 1 : 0);
    for (std::uint32_t i = 0; i < path.count; ++i) {
      text(0, "VERTEX");
      text(8, layer);
      point(group.points[path.first + i]);
      const double bulge = group.bulges.empty() ? 0 : group.bulges[path.first + i];
      if (bulge != 0) number(42, -bulge, 9);
    }
    text(0, "SEQEND");
    text(8, layer);
  }

  const Page& page_;
  std::vector<Layer> layers_;
  std::vector<std::vector<std::size_t>> layers_of_groups_;  ///< by layer and group of the page: indices of layers_
  PageText out_;
  WritingProgress progress_;
  std::map<std::string, std::vector<double>> types_{{"CONTINUOUS", {}}};  ///< line types: the dashes of each name
  /// Properties of the current group where they differ from its layer; else empty or by_layer.
  std::string own_type_;
  int own_color_ = by_layer;
};

}  // namespace

void save_dxf(const Page& page, OutputFile& file, const Execution& execution) {
  for (const PageLayer& layer : page.layers)
    for (const PageGroup& group : layer.groups)
      if (!group.fills.empty())
        throw Error(ErrorCode::unsupported, file.name(), "", "DXF holds only lines, and this page has filled polygons");
  DxfWriter(page, file, execution).write();
}

}  // namespace frontmost::detail
