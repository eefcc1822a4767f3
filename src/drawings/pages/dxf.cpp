// SPDX-License-Identifier: Apache-2.0
// DXF of AutoCAD 2000 (AC1015), the oldest with line widths: pairs of lines, a group code and its value.
//
//   0           a group code: the value is the kind of an entity
//   LINE
//   5           the entity's handle, a number in hexadecimal digits, and 330, the handle of its block's record
//   2A
//   100         the class whose codes follow
//   AcDbEntity
//   8           the entity's layer
//   2_VISIBLE
//
// DXF has no groups: each group is a layer, which gives its line type, colour and width. A dimension shows the block
// that holds its lines and its text; running dimensions are only lines and texts, because LibreCAD shows no ordinate
// dimensions. The y axis of a page points down and that of DXF up, so places are flipped and arcs change their
// direction.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>

#include "base/decimal.h"
#include "pages/formats.h"

namespace frontmost::detail {
namespace {

/// The name in characters that all programs allow: capitals, digits, - and _.
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
  int weight = 0;  ///< hundredths of a millimetre
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
  constexpr int class_colors[] = {7, 6, 7, 5, 8, 9, 1, 3, 4, 3};
  const bool is_numbered = !page_layer.empty() && page_layer[0] >= '0' && page_layer[0] <= '9';
  return nearest == 7 && is_numbered ? class_colors[page_layer[0] - '0'] : nearest;
}

constexpr int by_layer = 256;

/// The nearest width that AutoCAD knows, in hundredths of a millimetre.
int line_weight(double width) {
  constexpr int all[] = {0,  5,  9,  13, 15, 18,  20,  25,  30,  35,  40,  50,
                         53, 60, 70, 80, 90, 100, 106, 120, 140, 158, 200, 211};
  const double wanted = width * 100;
  return *std::min_element(std::begin(all), std::end(all),
                           [&](int a, int b) { return std::abs(a - wanted) < std::abs(b - wanted); });
}

/// The code of a sign that all fonts of CAD programs have; empty for other characters.
std::string_view sign_code(char32_t character) {
  return character == U'\u2300' ? "%%c" : character == U'\u00B0' ? "%%d" : character == U'\u00B1' ? "%%p" : "";
}

/// Whether readers could take a character as the beginning or end of a code: % before %%p, as %%% is a per cent sign,
/// and in a dimension <>, which stands for its measurement, and braces, which group formatted text.
bool is_ambiguous(char32_t character, char32_t next, bool is_of_dimension) {
  switch (character) {
    case U'\\':
    case U'^': return true;
    case U'%': return !sign_code(next).empty();
    case U'{':
    case U'}': return is_of_dimension;
    case U'<': return is_of_dimension && next == U'>';
    default: return false;
  }
}

/// A text in the file's code page, which is that of Windows for Western Europe, as in files of AutoCAD: \U+2264 for
/// other characters and ambiguous ones, and codes for signs.
std::string coded_text(std::string_view text, bool is_of_dimension = false) {
  std::string coded;
  const std::string shown = printable_text(text);
  for (std::string_view rest = shown; !rest.empty();) {
    const char32_t code = take_character(rest);
    std::string_view after = rest;
    const char32_t next = rest.empty() ? U'\0' : take_character(after);
    if (const std::string_view sign = sign_code(code); !sign.empty()) {
      coded += sign;
    } else if (code == U'%' && next == U'%') {
      coded += "%%%";
    } else if (!is_ambiguous(code, next, is_of_dimension) && (code < 0x80 || (code >= 0xA0 && code < 0x100))) {
      coded += char(code);
    } else {
      coded += "\\U+";
      append_hex(code < 0x10000 ? code : U'\u25A1', coded);
    }
  }
  return coded;
}

/// Sizes of the dimensions on sheets, for programs that draw dimensions anew: as variables of the header, and as codes
/// of dimension styles.
struct DimensionVariable {
  const char* name;
  int header_code, code;
  double value;
};
constexpr DimensionVariable dimension_variables[] = {
    {"$DIMASZ", 40, 41, 3},  {"$DIMEXO", 40, 42, 1},  {"$DIMEXE", 40, 44, 2}, {"$DIMTIH", 70, 73, 0},
    {"$DIMTOH", 70, 74, 0},  {"$DIMTAD", 70, 77, 1},  {"$DIMZIN", 70, 78, 8}, {"$DIMTXT", 40, 140, 3.5},
    {"$DIMGAP", 40, 147, 1}, {"$DIMDEC", 70, 271, 2},
};

/// Handles of objects that others name; the others are numbered from `first_free` on.
enum Handle : std::uint64_t { root = 1, groups, model_space, paper_space, text_style, first_free };

class DxfWriter {
 public:
  DxfWriter(const Page& page, OutputFile& file, const Execution& execution)
      : page_(page), out_(file), progress_(std::span(&page, 1), execution) {
    std::size_t group_count = 0;
    for (const PageLayer& layer : page.layers) group_count += layer.groups.size() + 1;
    std::set<std::string> names = {"0"};  // every drawing has this layer
    std::map<std::string, int> next;
    for (const PageLayer& layer : page.layers) {
      const std::string class_name = table_text(layer.name);
      layers_of_groups_.emplace_back();
      std::optional<std::size_t> common;
      const auto add = [&](const std::string& name, const Pen& pen) {
        // Distinct names of at most 31 characters: there is room for _ and a number below `most_layers`.
        const std::string clean = name.empty() ? "LAYER" : name.substr(0, 26);
        std::string unique = clean;
        for (int& number = next.try_emplace(clean, 2).first->second; !names.insert(unique).second; ++number)
          unique = clean + "_" + std::to_string(number);
        layers_.push_back({unique, pen, layer_color(layer.name, pen.color), line_weight(pen.width)});
        return layers_.size() - 1;
      };
      if (layer.groups.empty()) add(class_name, {});
      for (const PageGroup& group : layer.groups) {
        types_.try_emplace(type_name(group.pen), group.pen.dashes);
        const bool is_own = group_count <= most_layers && !group.name.empty();
        if (!is_own && !common) common = add(class_name, group.pen);
        // On sheets, every class with named groups fits into 11 characters, so that programs can select all of a class.
        layers_of_groups_.back().push_back(
            is_own ? add(class_name.substr(0, 11) + "-" + table_text(group.name), group.pen) : *common);
      }
    }
    for_each_group([&](const PageGroup& group) {
      entity_count_ += group.paths.size() + group.texts.size();
      for (const PageDimension& dimension : group.dimensions) {
        if (!is_entity(dimension)) continue;
        const std::string factor = general_text(dimension.factor, 9);
        ++dimension_count_;
        dimension_styles_.try_emplace(factor, "FRONTMOST_" + std::to_string(dimension_styles_.size() + 1));
      }
    });
  }

  void write() {
    out_ << "999\nmillimetres\n";
    write_header();
    section("CLASSES");
    end_section();
    write_tables();
    write_blocks();
    section("ENTITIES");
    owner_ = model_space;
    std::size_t number = 0;
    for_each_group([&](const PageGroup& group) { write_group(group, number); });
    end_section();
    write_objects();
    text(0, "EOF");
    out_.flush();
  }

 private:
  // A group code is one short line, its value another.
  void text(int code, std::string_view value) { out_ << code << '\n' << value << '\n'; }
  void integer(int code, int value) { out_ << code << '\n' << value << '\n'; }
  void handle(int code, std::uint64_t value) {
    char digits[16];
    char* first = std::end(digits);
    do *--first = "0123456789ABCDEF"[value & 15];
    while (value >>= 4);
    text(code, std::string_view(first, std::size_t(std::end(digits) - first)));
  }
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
    text(1, "AC1015");
    text(9, "$DWGCODEPAGE");
    text(3, "ANSI_1252");
    // No handle of the file is as large. A dimension has up to five handles beside those of its lines and its text.
    text(9, "$HANDSEED");
    handle(5, 0x1000 + layers_.size() + entity_count_ + 5 * dimension_count_);
    text(9, "$INSUNITS");
    integer(70, 4);
    text(9, "$LWDISPLAY");
    integer(290, 1);
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
    for (const DimensionVariable& one : dimension_variables) {
      text(9, one.name);
      number(one.header_code, one.value);
    }
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

  void begin_table(std::string_view name, std::size_t entries) {
    table_ = next_++;
    text(0, "TABLE");
    text(2, name);
    handle(5, table_);
    handle(330, 0);
    text(100, "AcDbSymbolTable");
    integer(70, int(entries));
  }
  void end_table() { text(0, "ENDTAB"); }
  /// Begins an entry of the table. `own` is its handle; 0: the next one.
  void entry(std::string_view kind, std::string_view subclass, std::string_view name, std::uint64_t own = 0) {
    text(0, kind);
    handle(kind == "DIMSTYLE" ? 105 : 5, own != 0 ? own : next_++);
    handle(330, table_);
    text(100, "AcDbSymbolTableRecord");
    text(100, subclass);
    text(2, name);
    integer(70, 0);
  }

  /// The window shows the page from above.
  void write_window() {
    begin_table("VPORT", 1);
    entry("VPORT", "AcDbViewportTableRecord", "*ACTIVE");
    out_ << "10\n0\n20\n0\n11\n1\n21\n1\n";
    number(12, page_.width / 2);
    number(22, page_.height / 2);
    out_ << "13\n0\n23\n0\n14\n10\n24\n10\n15\n10\n25\n10\n16\n0\n26\n0\n36\n1\n17\n0\n27\n0\n37\n0\n";
    number(40, page_.height);
    number(41, page_.width / page_.height);
    out_ << "42\n50\n43\n0\n44\n0\n50\n0\n51\n0\n71\n0\n72\n1000\n73\n1\n74\n3\n75\n0\n76\n0\n77\n0\n78\n0\n";
    end_table();
  }

  void write_line_types() {
    begin_table("LTYPE", types_.size() + 2);
    for (const char* const name : {"ByBlock", "ByLayer"}) {
      entry("LTYPE", "AcDbLinetypeTableRecord", name);
      out_ << "3\n\n72\n65\n73\n0\n40\n0\n";
    }
    for (const auto& [name, dashes] : types_) {
      entry("LTYPE", "AcDbLinetypeTableRecord", name);
      text(3, dashes.empty() ? "Solid line" : "Dashed, in millimetres");
      integer(72, 'A');
      integer(73, int(dashes.size()));
      number(40, period_of(dashes));
      for (std::size_t i = 0; i < dashes.size(); ++i) {
        number(49, i % 2 == 0 ? dashes[i] : -dashes[i]);
        integer(74, 0);
      }
    }
    end_table();
  }

  void write_tables() {
    section("TABLES");
    write_window();
    write_line_types();
    begin_table("LAYER", layers_.size() + 1);
    write_layer("0", 7, "CONTINUOUS", -3);  // -3: the default width
    for (const Layer& layer : layers_) write_layer(layer.name, layer.color, type_name(layer.pen), layer.weight);
    end_table();
    begin_table("STYLE", 2);
    write_style("STANDARD", "txt", 0);
    write_style("ISO3098", "isocp.shx", text_style);
    end_table();
    for (const char* const name : {"VIEW", "UCS"}) {
      begin_table(name, 0);
      end_table();
    }
    begin_table("APPID", 1);
    entry("APPID", "AcDbRegAppTableRecord", "ACAD");
    end_table();
    begin_table("DIMSTYLE", dimension_styles_.size() + 1);
    text(100, "AcDbDimStyleTable");
    integer(71, int(dimension_styles_.size() + 1));
    write_dimension_style("STANDARD", "1");
    for (const auto& [factor, name] : dimension_styles_) write_dimension_style(name, factor);
    end_table();
    begin_table("BLOCK_RECORD", dimension_count_ + 2);
    entry("BLOCK_RECORD", "AcDbBlockTableRecord", "*Model_Space", model_space);
    entry("BLOCK_RECORD", "AcDbBlockTableRecord", "*Paper_Space", paper_space);
    first_block_ = next_;
    for (std::size_t i = 0; i < dimension_count_; ++i) entry("BLOCK_RECORD", "AcDbBlockTableRecord", block_name(i));
    end_table();
    end_section();
  }

  void write_layer(std::string_view name, int color, std::string_view type, int weight) {
    entry("LAYER", "AcDbLayerTableRecord", name);
    integer(62, color);
    text(6, type);
    integer(370, weight);
    handle(390, 0);  // no plot style
  }

  void write_style(std::string_view name, std::string_view font, std::uint64_t own) {
    entry("STYLE", "AcDbTextStyleTableRecord", name, own);
    out_ << "40\n0\n41\n1\n50\n0\n71\n0\n42\n3.5\n";
    text(3, font);
    text(4, "");
  }

  void write_dimension_style(std::string_view name, std::string_view factor) {
    entry("DIMSTYLE", "AcDbDimStyleTableRecord", name);
    for (const DimensionVariable& one : dimension_variables) number(one.code, one.value);
    text(144, factor);
    integer(278, '.');
    handle(340, text_style);
  }

  static bool is_entity(const PageDimension& dimension) { return dimension.kind != DimensionKind::position; }
  static std::string block_name(std::size_t dimension) { return "*D" + std::to_string(dimension + 1); }

  void write_blocks() {
    section("BLOCKS");
    for (const Handle space : {model_space, paper_space}) {
      owner_ = space;
      begin_block(space == model_space ? "*Model_Space" : "*Paper_Space", 0);
      end_block();
    }
    std::size_t number = 0;
    for_each_group([&](const PageGroup& group) {
      for (const PageDimension& dimension : group.dimensions) {
        if (!is_entity(dimension)) continue;
        owner_ = first_block_ + number;
        begin_block(block_name(number++), 1);
        for (std::size_t i = 0; i < dimension.path_count; ++i) write_path(group, group.paths[dimension.first_path + i]);
        write_text(group.texts[dimension.text]);
        end_block();
      }
    });
    end_section();
  }

  /// `flags`: 1 for a block without a name of its own.
  void begin_block(std::string_view name, int flags) {
    write_block_part("BLOCK", "AcDbBlockBegin");
    text(2, name);
    integer(70, flags);
    point({0, page_.height});
    text(3, name);
    text(1, "");
  }
  void end_block() { write_block_part("ENDBLK", "AcDbBlockEnd"); }
  void write_block_part(std::string_view kind, std::string_view subclass) {
    text(0, kind);
    handle(5, next_++);
    handle(330, owner_);
    text(100, "AcDbEntity");
    text(8, "0");
    text(100, subclass);
  }

  /// The root of all objects, with an empty list of groups.
  void write_objects() {
    section("OBJECTS");
    const auto begin_dictionary = [&](std::uint64_t own, std::uint64_t owner) {
      text(0, "DICTIONARY");
      handle(5, own);
      handle(330, owner);
      text(100, "AcDbDictionary");
      integer(281, 1);
    };
    begin_dictionary(root, 0);
    text(3, "ACAD_GROUP");
    handle(350, groups);
    begin_dictionary(groups, root);
    end_section();
  }

  /// Calls visit(group) for every group that is seen, after its layer and its properties have been set.
  template <class Visit>
  void for_each_group(const Visit& visit) {
    for (std::size_t i = 0; i < page_.layers.size(); ++i)
      for (std::size_t k = 0; k < page_.layers[i].groups.size(); ++k) {
        const PageGroup& group = page_.layers[i].groups[k];
        if (group.pen.color.opacity == 0) continue;
        layer_ = &layers_[layers_of_groups_[i][k]];
        own_type_ = type_name(group.pen);
        if (own_type_ == type_name(layer_->pen)) own_type_.clear();
        own_color_ = layer_color(page_.layers[i].name, group.pen.color);
        if (own_color_ == layer_->color) own_color_ = by_layer;
        weight_ = line_weight(group.pen.width);
        visit(group);
      }
  }

  /// Writes the paths and texts of no dimension, and then the dimensions, of which `number` is the first.
  void write_group(const PageGroup& group, std::size_t& number) {
    std::vector<bool> has_path(group.paths.size()), has_text(group.texts.size());
    for (const PageDimension& dimension : group.dimensions) {
      if (!is_entity(dimension)) continue;
      std::fill_n(has_path.begin() + dimension.first_path, dimension.path_count, true);
      has_text[dimension.text] = true;
    }
    for (std::size_t i = 0; i < group.paths.size(); ++i)
      if (!has_path[i]) write_path(group, group.paths[i]);
    for (std::size_t i = 0; i < group.texts.size(); ++i)
      if (!has_text[i]) write_text(group.texts[i]);
    for (const PageDimension& dimension : group.dimensions)
      if (is_entity(dimension)) write_dimension(dimension, group.texts[dimension.text], number++);
  }

  /// Begins an entity. Properties that are not written are those of the layer, and change with the layer.
  void entity(std::string_view kind, std::string_view subclass, int weight) {
    text(0, kind);
    handle(5, next_++);
    handle(330, owner_);
    text(100, "AcDbEntity");
    text(8, layer_->name);
    if (!own_type_.empty()) text(6, own_type_);
    if (own_color_ != by_layer) integer(62, own_color_);
    if (weight != layer_->weight) integer(370, weight);
    text(100, subclass);
  }

  void write_path(const PageGroup& group, const PagePath& path) {
    progress_.step();
    if (group.pen.width == 0) return;
    if (path.count == 1) {
      entity("POINT", "AcDbPoint", weight_);
      point(group.points[path.first]);
    } else if (const std::optional<Arc> arc = whole_arc(group, path)) {
      write_arc(*arc, path.is_closed);
    } else if (path.count == 2) {
      entity("LINE", "AcDbLine", weight_);
      point(group.points[path.first]);
      point(group.points[path.first + 1], 11);
    } else {
      write_polyline(group, path);
    }
  }

  /// Alignments other than to the left have a second point, the place of the text. Vertically, all places are on the
  /// base line, which programs agree about.
  void write_text(const PlacedText& placed) {
    progress_.step();
    if (placed.text.empty()) return;
    const TextStyle& style = placed.style;
    entity("TEXT", "AcDbText", line_weight(text_pen(style.height).width));
    point(begin_of(placed));
    number(40, style.height);
    text(1, coded_text(placed.text));
    if (style.angle != 0) number(50, glm::degrees(style.angle), 6);
    text(7, "ISO3098");
    if (style.align != TextAlign::left) {
      integer(72, int(style.align));
      point(base_of(placed), 11);
    }
    text(100, "AcDbText");
  }

  void write_dimension(const PageDimension& dimension, const PlacedText& placed, std::size_t number_of_block) {
    const auto& [kind, from, to, line, angle, factor, first_path, path_count, text_index] = dimension;
    const glm::dvec2 along(std::cos(angle), -std::sin(angle)), way = to - from;
    const bool is_linear = kind == DimensionKind::linear;
    const double length = is_linear ? std::abs(glm::dot(way, along)) : glm::length(way);
    entity("DIMENSION", "AcDbDimension", weight_);
    text(2, block_name(number_of_block));
    point(is_linear ? line + along * glm::dot(to - line, along) : from);
    const double right = (0.5 - share_before(placed.style.align)) * text_width(placed.text, placed.style.height);
    const glm::dvec2 reading(std::cos(placed.style.angle), -std::sin(placed.style.angle));
    point(base_of(placed) + right * reading + placed.style.height / 2 * glm::dvec2(reading.y, -reading.x), 11);
    constexpr int own_block = 32, text_is_placed = 128;
    integer(70, (is_linear ? 0 : kind == DimensionKind::diameter ? 3 : 4) + own_block + text_is_placed);
    integer(71, 5);  // the point of the text is its middle
    // Readers show the measurement in place of an empty text.
    text(1, placed.text.empty() ? " " : coded_text(placed.text, true));
    text(42, general_text(length * factor, 12));
    text(3, dimension_styles_.at(general_text(factor, 9)));
    if (is_linear) {
      text(100, "AcDbAlignedDimension");
      point(from, 13);
      point(to, 14);
      number(50, glm::degrees(angle), 6);
      text(100, "AcDbRotatedDimension");
    } else {
      text(100, kind == DimensionKind::diameter ? "AcDbDiametricDimension" : "AcDbRadialDimension");
      point(to, 15);
      number(40, glm::distance(to, line));
    }
  }

  /// DXF angles are degrees anticlockwise with y up, so the direction is reversed. Some readers draw nothing for an ARC
  /// between two equal angles, so a whole turn is a CIRCLE, whether its path is closed or not.
  void write_arc(const Arc& arc, bool is_closed) {
    constexpr double whole = 6.28318529;  // short of a whole turn by less than the last digit of an angle
    const bool is_whole = is_closed || std::abs(arc.turn) > whole;
    entity(is_whole ? "CIRCLE" : "ARC", "AcDbCircle", weight_);
    point(arc.centre);
    number(40, arc.radius);
    if (is_whole) return;
    const double low = arc.turn > 0 ? arc.begin : arc.begin + arc.turn, high = low + std::abs(arc.turn);
    const auto degrees = [](double angle) {
      const double turned = std::fmod(-angle * 57.295779513082321, 360);
      return turned < 0 ? turned + 360 : turned;
    };
    text(100, "AcDbArc");
    number(50, degrees(high), 6);
    number(51, degrees(low), 6);
  }

  void write_polyline(const PageGroup& group, const PagePath& path) {
    entity("LWPOLYLINE", "AcDbPolyline", weight_);
    integer(90, int(path.count));
    integer(70, path.is_closed ? 1 : 0);
    for (std::uint32_t i = 0; i < path.count; ++i) {
      const glm::dvec2& p = group.points[path.first + i];
      number(10, p.x);
      number(20, page_.height - p.y);
      const double bulge = group.bulges.empty() ? 0 : group.bulges[path.first + i];
      if (bulge != 0) number(42, -bulge, 9);
    }
  }

  const Page& page_;
  std::vector<Layer> layers_;
  std::vector<std::vector<std::size_t>> layers_of_groups_;  ///< by layer and group of the page: indices of layers_
  PageText out_;
  WritingProgress progress_;
  std::map<std::string, std::vector<double>> types_{{"CONTINUOUS", {}}};  ///< line types: the dashes of each name
  std::map<std::string, std::string> dimension_styles_;  ///< names by PageDimension::factor, nine digits of it
  std::size_t entity_count_ = 0, dimension_count_ = 0;
  std::uint64_t next_ = first_free;    ///< handle of the next object
  std::uint64_t table_ = 0;            ///< handle of the table that is being written
  std::uint64_t owner_ = model_space;  ///< handle of the block record that owns the entities being written
  std::uint64_t first_block_ = 0;      ///< handle of the first dimension's block record
  const Layer* layer_ = nullptr;       ///< layer of the current group
  /// Properties of the current group where they differ from its layer; else empty or by_layer.
  std::string own_type_;
  int own_color_ = by_layer;
  int weight_ = 0;  ///< line weight of the current group, hundredths of a millimetre
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
