// SPDX-License-Identifier: Apache-2.0
// SVG 1.1, limited to features that software of plotters and journals knows.
//
//   <g inkscape:groupmode="layer">        a layer
//     <g stroke="#000000" ...>            a group: common properties of its paths
//       <path d="M10 20l5 0 0 5z"/>       a path: a place, and steps from there, which take half the bytes of places
//
// Steps are differences of rounded places, so errors do not add up.
#include "pages/formats.h"

namespace frontmost::detail {
namespace {

/// Dots per element: nobody edits single dots, but elements must be small enough for editors to stay quick.
constexpr std::size_t dots_per_element = 4096;

class SvgWriter {
 public:
  SvgWriter(const Page& page, OutputFile& file, const Execution& execution)
      : page_(page), out_(file), progress_(std::span(&page, 1), execution) {}

  void write() {
    out_ << "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" "
            "xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\" version=\"1.1\" width=\"";
    millimetres(page_.width) << "mm\" height=\"";
    millimetres(page_.height) << "mm\" viewBox=\"0 0 ";
    millimetres(page_.width) << ' ';
    millimetres(page_.height) << "\">\n";
    if (!page_.title.empty()) out_ << "<title>" << xml_text(page_.title) << "</title>\n";
    for (std::size_t i = 0; i < page_.layers.size(); ++i) {
      const PageLayer& layer = page_.layers[i];
      out_ << "<g id=\"layer" << (i + 1) << "\" inkscape:groupmode=\"layer\" inkscape:label=\"" << xml_text(layer.name)
           << "\">\n";
      for (const PageGroup& group : layer.groups) write_group(group);
      out_ << "</g>\n";
    }
    out_ << "</svg>\n";
    out_.flush();
  }

 private:
  PageText& millimetres(double value) { return out_.fixed(thousandths(value)); }

  void write_group(const PageGroup& group) {
    out_ << "<g";
    if (!group.name.empty()) out_ << " inkscape:label=\"" << xml_text(group.name) << '"';
    if (group.opacity < 255) {
      out_ << " opacity=\"";
      out_.fixed(thousandths(group.opacity / 255.0)) << '"';
    }
    const bool has_lines = group.pen.width > 0;
    if (has_lines) {
      color("stroke", group.pen.color);
      out_ << " stroke-width=\"";
      millimetres(group.pen.width) << "\" stroke-linecap=\"round\" stroke-linejoin=\"round\"";
      const std::vector<double>& dashes = group.pen.dashes;
      for (std::size_t i = 0; i < dashes.size(); ++i) {
        out_ << (i == 0 ? " stroke-dasharray=\"" : " ");
        millimetres(dashes[i]);
      }
      if (!dashes.empty()) out_ << '"';
    }
    if (group.fills.empty()) out_ << " fill=\"none\"";
    out_ << ">\n";
    if (group.fills.empty()) {
      if (has_lines) write_lines(group);
    } else {
      for (std::size_t i = 0; i < group.paths.size(); ++i) {
        progress_.step();
        if (!group.paths[i].is_part) write_filled(group, i);
      }
    }
    for (const PlacedText& text : group.texts) write_text(text, group.pen.color);
    out_ << "</g>\n";
  }

  /// Each line is an element, so that editors can remove or change it alone.
  void write_lines(const PageGroup& group) {
    std::size_t dots = 0;  // number of dots in the open element
    for (const PagePath& path : group.paths) {
      progress_.step();
      const bool is_dot = path.count == 1;
      if (dots > 0 && (!is_dot || dots == dots_per_element)) {
        out_ << "\"/>\n";
        dots = 0;
      }
      if (dots == 0) out_ << "<path d=\"";
      write_path(group, path);
      if (is_dot)
        ++dots;
      else
        out_ << "\"/>\n";
    }
    if (dots > 0) out_ << "\"/>\n";
  }

  void write_filled(const PageGroup& group, std::size_t i) {
    const PathPaint paint = paint_of(group, i);
    if (!paint.is_seen()) return;
    out_ << "<path";
    if (paint.fill)
      color("fill", *paint.fill);
    else
      out_ << " fill=\"none\"";
    out_ << " d=\"";
    do write_path(group, group.paths[i]);
    while (++i < group.paths.size() && group.paths[i].is_part);
    out_ << "\"/>\n";
  }

  /// Viewers stretch texts of several characters to the width of their strokes, whatever their font.
  void write_text(const PlacedText& text, const PageColor& ink) {
    progress_.step();
    if (text.text.empty()) return;
    constexpr double font_size = 1.4;  // of Arial and Helvetica, for capitals of height 1
    constexpr double bearing = 0.1;    // blank space on either side of a letter, which textLength includes
    constexpr const char* anchors[] = {"start", "middle", "end"};
    const double height = text.style.height, angle = text.style.angle;
    const double beyond = (2 * share_before(text.style.align) - 1) * bearing * height;
    const glm::dvec2 at = base_of(text) + beyond * glm::dvec2(std::cos(angle), -std::sin(angle));
    out_ << "<text x=\"";
    millimetres(at.x) << "\" y=\"";
    millimetres(at.y) << "\" font-family=\"Arial, Helvetica, sans-serif\" font-size=\"";
    millimetres(font_size * height) << "\" text-anchor=\"" << anchors[int(text.style.align)] << '"';
    std::string_view rest = text.text;
    (void)take_character(rest);
    if (!rest.empty()) {
      out_ << " textLength=\"";
      millimetres(text_width(text.text, height) + 2 * bearing * height) << "\" lengthAdjust=\"spacingAndGlyphs\"";
    }
    if (angle != 0) {
      out_ << " transform=\"rotate(";
      millimetres(glm::degrees(-angle)) << ' ';
      millimetres(at.x) << ' ';
      millimetres(at.y) << ")\"";
    }
    color("fill", ink);
    out_ << " stroke=\"none\" xml:space=\"preserve\">" << xml_text(text.text) << "</text>\n";
  }

  void color(std::string_view what, const PageColor& color) {
    out_ << ' ' << what << "=\"#";
    constexpr char digits[] = "0123456789abcdef";
    for (const std::uint8_t part : {color.red, color.green, color.blue}) out_ << digits[part >> 4] << digits[part & 15];
    out_ << '"';
    if (color.opacity == 255) return;
    out_ << ' ' << what << "-opacity=\"";
    out_.fixed(thousandths(color.opacity / 255.0)) << '"';
  }

  void write_path(const PageGroup& group, const PagePath& path) {
    command_ = 'M';
    out_ << 'M';
    separate_ = false;
    glm::i64vec2 at = thousandths(group.points[path.first]);
    number(at.x);
    number(at.y);
    if (path.count == 1) step({0, 0});  // a dot: the pen's round ends
    const std::uint32_t joins = join_count(path);
    for (std::uint32_t i = 0; i < joins; ++i) {
      const Join join = join_of(group, path, i);
      const std::optional<Arc> arc = arc_between(join.from, join.to, join.bulge);
      if (path.is_closed && i + 1 == joins && !arc) break;  // z draws this join
      const glm::i64vec2 to = thousandths(join.to);
      arc ? turn(*arc, to - at) : step(to - at);
      at = to;
    }
    if (path.is_closed) out_ << 'z';
  }

  void step(const glm::i64vec2& by) {
    command('l');
    number(by.x);
    number(by.y);
  }

  void turn(const Arc& arc, const glm::i64vec2& by) {
    command('a');
    number(thousandths(arc.radius));
    number(thousandths(arc.radius));
    number(0);
    number(std::abs(arc.turn) > 3.1415926535897932 ? 1000 : 0);
    number(arc.turn > 0 ? 1000 : 0);
    number(by.x);
    number(by.y);
  }

  /// Writes a command, unless it repeats the last one.
  void command(char letter) {
    if (command_ == letter) return;
    command_ = letter;
    out_ << letter;
    separate_ = false;
  }

  void number(std::int64_t value) {
    if (separate_ && value >= 0) out_ << ' ';
    out_.fixed(value);
    separate_ = true;
  }

  const Page& page_;
  PageText out_;
  WritingProgress progress_;
  char command_ = 0;
  bool separate_ = false;
};

}  // namespace

void save_svg(const Page& page, OutputFile& file, const Execution& execution) {
  SvgWriter(page, file, execution).write();
}

}  // namespace frontmost::detail
