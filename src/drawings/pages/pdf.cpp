// SPDX-License-Identifier: Apache-2.0
// PDF 1.5, or 1.6 if a page needs its own unit. Each page is one compressed stream of drawing operators, with layers as
// optional content, and groups with an opacity as forms that are transparency groups.
//
//   content of a page      /OC /L0 BDC                layer 0 begins
//                            0.5 w [] 0 d             a group: its pen
//                            10 20 m 30 40 l S        a path: move, line, stroke
//                            q /F128 gs /G0 Do Q      a group with an opacity: form 0, composited as a whole
//                            BT ... Tm /T0 5 Tf <00> Tj ET    a text in font 0, whose glyphs are those of add_text()
//
// There is no date and no file identifier, so a page always gives the same bytes.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <new>

#include "pages/formats.h"

#ifdef FRONTMOST_DEFLATE
#include <zlib.h>
#endif

namespace frontmost::detail {
namespace {

constexpr std::size_t points_per_stroke = 4096;  // viewers hold whole paths in memory
constexpr double points_per_millimetre = 72 / 25.4;

#ifdef FRONTMOST_DEFLATE
constexpr std::string_view stream_filter = "/Filter /FlateDecode ";

/// A stream of operators, compressed by zlib.
class PdfStream {
 public:
  explicit PdfStream(PageText& out) : out_(out), packed_(std::size_t(1) << 16, '\0') {
    constexpr int level = 4;  // 350,000 polygons: 0.6 s and 11.7 MB; level 6 takes 2.1 s for 11.1 MB
    if (::deflateInit(&stream_, level) != Z_OK) throw std::bad_alloc();
  }
  ~PdfStream() { ::deflateEnd(&stream_); }
  PdfStream(const PdfStream&) = delete;
  PdfStream& operator=(const PdfStream&) = delete;

  void write(std::string_view bytes) { run(bytes, Z_NO_FLUSH); }
  /// Ends the stream; nothing may be written after it.
  void finish() { run({}, Z_FINISH); }

 private:
  void run(std::string_view bytes, int flush) {
    stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));  // zlib does not write there
    stream_.avail_in = uInt(bytes.size());
    do {
      stream_.next_out = reinterpret_cast<Bytef*>(packed_.data());
      stream_.avail_out = uInt(packed_.size());
      ::deflate(&stream_, flush);
      out_ << std::string_view(packed_.data(), packed_.size() - stream_.avail_out);
    } while (stream_.avail_out == 0);
  }

  PageText& out_;
  std::string packed_;
  z_stream stream_{};
};
#else
constexpr std::string_view stream_filter;

/// Builds without zlib do not compress streams.
struct PdfStream {
  PageText& out;
  void write(std::string_view bytes) { out << bytes; }
  void finish() {}
};
#endif

/// The characters of all texts of a file. A font holds 256 of them, so the number is 256 * font + code.
struct PdfLetter {
  std::string utf8;
  std::size_t number = 0;
};
using PdfLetters = std::map<char32_t, PdfLetter>;
constexpr std::size_t letters_per_font = 256;

PdfLetters letters_of(std::span<const Page> pages) {
  PdfLetters letters;
  for (const Page& page : pages)
    for (const PageLayer& layer : page.layers)
      for (const PageGroup& group : layer.groups)
        for (const PlacedText& text : group.texts)
          for (std::string_view rest = text.text; !rest.empty();) {
            const std::string_view before = rest;
            const char32_t code = take_character(rest);
            // Invalid bytes and U+FFFD are one letter.
            letters[code].utf8 = code == U'\uFFFD' ? "\uFFFD" : before.substr(0, before.size() - rest.size());
          }
  std::size_t number = 0;
  for (auto& [code, letter] : letters) letter.number = number++;
  return letters;
}

/// Writes the operators that draw all layers.
class PdfContent {
 public:
  PdfContent(const Page& page, PageText& out, double scale, WritingProgress& progress, const PdfLetters& letters)
      : page_(page), out_(out), scale_(scale), progress_(progress), letters_(letters) {}

  void write_page() {
    std::size_t form = 0;
    // Sets millimetres with y down, as on the page, and round ends and joins.
    out_.fixed(std::llround(scale_ * 1e9), 9) << " 0 0 ";
    out_.fixed(-std::llround(scale_ * 1e9), 9) << " 0 ";
    out_.fixed(std::llround(page_.height * scale_ * 1e6), 6) << " cm 1 J 1 j\n";
    for (std::size_t i = 0; i < page_.layers.size(); ++i) {
      out_ << "/OC /L" << i << " BDC\n";
      for (const PageGroup& group : page_.layers[i].groups) {
        if (group.opacity == 255) {
          write_group(group);
          continue;
        }
        states_.fills[group.opacity] = true;
        out_ << "q /F" << group.opacity << " gs /G" << form++ << " Do Q\n";
      }
      out_ << "EMC\n";
    }
  }

  /// Writes the operators of a form, which begins with the page's default colours.
  void write_form(const PageGroup& group) {
    out_ << "0 0 0 rg 0 0 0 RG\n";
    write_group(group);
  }

  /// Writes a glyph of letters ten units high, y up. Glyphs inherit the colour of the text.
  void write_glyph(const std::string& utf8) {
    PageGroup glyph;
    add_text(glyph, utf8, {0, 0}, {10});
    for (glm::dvec2& p : glyph.points) p.y = -p.y;
    for (double& bulge : glyph.bulges) bulge = -bulge;
    out_.fixed(thousandths(advance_of(utf8))) << " 0 d0 1 w\n";
    for (const PagePath& path : glyph.paths) write_path(glyph, path);
    if (!glyph.paths.empty()) out_ << "S\n";
  }
  /// The way to the next letter, in tenths of the height: the letter, and the gap of add_text() beside its pen.
  [[nodiscard]] static double advance_of(const std::string& utf8) { return text_width(utf8, 10) + 2; }

  using Opacities = std::array<bool, 256>;
  /// The opacities that a stream uses.
  struct States {
    Opacities fills{}, lines{};
  };
  [[nodiscard]] const States& states() const { return states_; }

 private:
  void write_group(const PageGroup& group) {
    if (group.pen.width > 0) {
      out_.fixed(thousandths(group.pen.width)) << " w [";
      for (const double dash : group.pen.dashes) out_.fixed(thousandths(dash)) << ' ';
      out_ << "] 0 d\n";
    }
    std::size_t points = 0;
    for (std::size_t i = 0; i < group.paths.size(); ++i) {
      progress_.step();
      if (group.paths[i].is_part && !group.fills.empty()) continue;  // drawn with the path before it
      const PathPaint paint = paint_of(group, i);
      if (!paint.is_seen()) continue;
      set(paint);
      write_path(group, group.paths[i]);
      points += group.paths[i].count;
      for (std::size_t k = i + 1; paint.fill && k < group.paths.size() && group.paths[k].is_part; ++k)
        write_path(group, group.paths[k]);
      // Lines share a painting operator. Fills do not, because the later of two overlapping fills is above the other.
      if (paint.fill) {
        out_ << (paint.line ? "B\n" : "f\n");
        points = 0;
      } else if (!group.fills.empty() || points >= points_per_stroke) {
        out_ << "S\n";
        points = 0;
      }
    }
    if (points > 0) out_ << "S\n";
    if (group.texts.empty() || group.pen.color.opacity == 0) return;
    set({group.pen.color, group.pen.color});  // viewers disagree which of the two glyphs inherit
    // Glyphs inherit the dashes of this group or, if it draws no lines, of an earlier one.
    if (group.pen.width == 0 || !group.pen.dashes.empty()) out_ << "[] 0 d\n";
    for (const PlacedText& text : group.texts) write_text(text);
  }

  void write_text(const PlacedText& text) {
    progress_.step();
    if (text.text.empty()) return;
    const glm::dvec2 along(std::cos(text.style.angle), -std::sin(text.style.angle));
    out_ << "BT ";
    for (const double value : {along.x, along.y, along.y, -along.x}) out_.fixed(std::llround(value * 1e9), 9) << ' ';
    point(begin_of(text));
    out_ << "Tm";
    std::string_view rest = text.text;
    while (!rest.empty()) {
      const std::size_t font = number_of(rest) / letters_per_font;
      std::string codes;
      for (; !rest.empty() && number_of(rest) / letters_per_font == font; (void)take_character(rest))
        append_hex(unsigned(number_of(rest) % letters_per_font), codes, 2);
      out_ << " /T" << font << ' ';
      out_.fixed(thousandths(text.style.height)) << " Tf <" << codes << "> Tj";
    }
    out_ << " ET\n";
  }

  /// The number of the first letter of a text.
  [[nodiscard]] std::size_t number_of(std::string_view text) const { return letters_.at(take_character(text)).number; }

  /// Writes only the colours that change.
  void set(const PathPaint& paint) {
    if (paint.fill) set(*paint.fill, fill_, "rg\n", "/F", states_.fills);
    if (paint.line) set(*paint.line, line_, "RG\n", "/S", states_.lines);
  }

  void set(const PageColor& color, PageColor& now, const char* command, const char* state, Opacities& used) {
    if (color.red != now.red || color.green != now.green || color.blue != now.blue) {
      for (const std::uint8_t part : {color.red, color.green, color.blue}) out_.fixed(thousandths(part / 255.0)) << ' ';
      out_ << command;
    }
    if (color.opacity != now.opacity) {
      used[color.opacity] = true;
      out_ << state << color.opacity << " gs\n";
    }
    now = color;
  }

  void point(const glm::dvec2& p) {
    const glm::i64vec2 rounded = thousandths(p);
    out_.fixed(rounded.x) << ' ';
    out_.fixed(rounded.y) << ' ';
  }

  void write_path(const PageGroup& group, const PagePath& path) {
    point(group.points[path.first]);
    out_ << "m\n";
    if (path.count == 1) {
      point(group.points[path.first]);
      out_ << "l\n";
    }
    for (std::uint32_t i = 0; i < join_count(path); ++i) {
      const Join join = join_of(group, path, i);
      if (const std::optional<Arc> arc = arc_between(join.from, join.to, join.bulge)) {
        turn(*arc, join.to);
      } else if (i + 1 < path.count) {  // h draws the last join of a closed path
        point(join.to);
        out_ << "l\n";
      }
    }
    if (path.is_closed) out_ << "h\n";
  }

  /// Writes cubic curves of at most 45 degrees, which deviate from the circle by less than 5e-6 of its radius.
  void turn(const Arc& arc, const glm::dvec2& to) {
    const int pieces = int(std::ceil(std::abs(arc.turn) / 0.7854));
    const double by = arc.turn / pieces, handle = arc.radius * 4 / 3 * std::tan(by / 4);
    const auto at = [&](double angle) {
      return arc.centre + arc.radius * glm::dvec2(std::cos(angle), std::sin(angle));
    };
    const auto along = [&](double angle) { return handle * glm::dvec2(-std::sin(angle), std::cos(angle)); };
    for (int i = 0; i < pieces; ++i) {
      const double begin = arc.begin + i * by, end = begin + by;
      point(at(begin) + along(begin));
      point(at(end) - along(end));
      point(i + 1 == pieces ? to : at(end));
      out_ << "c\n";
    }
  }

  const Page& page_;
  PageText& out_;
  const double scale_;
  WritingProgress& progress_;
  const PdfLetters& letters_;
  PageColor fill_, line_;  ///< black and opaque at the begin of a page or a form
  States states_;
};

/// A page of a file, with the numbers of its objects.
struct PdfPage {
  struct Form {
    const PageGroup* group;
    std::size_t object;  ///< the object of its length is the next one
  };

  const Page* page;
  std::size_t object, contents, length;
  std::vector<std::size_t> layers;  ///< by layer of the page: its index among all layers
  std::vector<Form> forms;
  double unit;   ///< points per unit, because viewers refuse pages of more than 14400 units
  double scale;  ///< units per millimetre
};

/// Writes the objects of a file at once, and records their offsets for the table at its end.
class PdfWriter {
 public:
  PdfWriter(std::span<const Page> pages, OutputFile& file, const Execution& execution)
      : out_(file), progress_(pages, execution), letters_(letters_of(pages)) {
    for (const Page& page : pages) number(page);
    for (std::size_t first = 0; first < letters_.size(); first += letters_per_font) fonts_.push_back(take(2));
    if (!letters_.empty()) glyphs_ = take(letters_.size());
  }

  void write() {
    // Optional content needs 1.5, the unit 1.6. pdfTeX warns about versions above 1.5.
    const bool has_unit = std::any_of(pages_.begin(), pages_.end(), [](const PdfPage& p) { return p.unit > 1; });
    out_ << (has_unit ? "%PDF-1.6" : "%PDF-1.5") << "\n%\xE2\xE3\xCF\xD3\n";
    for (const PdfPage& page : pages_) {
      begin(page.contents) << "<< ";
      write_page(page, write_stream(page, nullptr, page.length));
      for (const PdfPage::Form& form : page.forms) write_form(page, form);
    }
    for (std::size_t i = 0; i < fonts_.size(); ++i) write_font(i);
    for (const Layer& layer : layers_)
      begin(layer.object) << "<< /Type /OCG /Name " << pdf_text(*layer.name) << " >>\nendobj\n";
    write_end();
    out_.flush();
  }

 private:
  enum Object : std::size_t { none, catalog, page_tree, first_page, info = first_page + 3, first_free };
  using States = PdfContent::States;
  /// A layer that viewers switch on and off; layers of one name on several pages are one.
  struct Layer {
    const std::string* name;
    std::size_t object;
  };

  /// Takes the next numbers for objects. \returns the first one.
  std::size_t take(std::size_t count) {
    places_.resize(places_.size() + count);
    return places_.size() - count;
  }

  void number(const Page& page) {
    const std::size_t object = pages_.empty() ? std::size_t(first_page) : take(3);
    const double unit = std::max(1.0, std::ceil(std::max(page.width, page.height) * points_per_millimetre / 14400));
    PdfPage& sheet =
        pages_.emplace_back(PdfPage{&page, object, object + 1, object + 2, {}, {}, unit, points_per_millimetre / unit});
    std::vector<bool> is_taken(layers_.size());  // a page may have several layers of one name
    for (const PageLayer& layer : page.layers) {
      std::size_t at = 0;
      while (at < is_taken.size() && (is_taken[at] || *layers_[at].name != layer.name)) ++at;
      if (at == layers_.size()) {
        layers_.push_back({&layer.name, take(1)});
        is_taken.push_back(true);
      }
      is_taken[at] = true;
      sheet.layers.push_back(at);
    }
    for (const PageLayer& layer : page.layers)
      for (const PageGroup& group : layer.groups)
        if (group.opacity < 255) sheet.forms.push_back({&group, take(2)});
  }

  PageText& begin(std::size_t object) {
    places_[object] = out_.size();
    return out_ << object << " 0 obj\n";
  }
  PageText& reference(std::size_t object) { return out_ << object << " 0 R "; }

  /// Writes the end of a stream's dictionary, the stream of a form or else of the page, and its length as an object.
  States write_stream(const PdfPage& page, const PageGroup* form, std::size_t length_object) {
    out_ << "/Length " << length_object << " 0 R " << stream_filter << ">>\nstream\n";
    const std::uint64_t start = out_.size();
    PdfStream stream{out_};
    PageText operators([&stream](std::string_view bytes) { stream.write(bytes); });
    PdfContent content(*page.page, operators, page.scale, progress_, letters_);
    form ? content.write_form(*form) : content.write_page();
    operators.flush();
    stream.finish();
    const std::uint64_t end = out_.size();
    out_ << "\nendstream\nendobj\n";
    begin(length_object) << (end - start) << "\nendobj\n";
    return content.states();
  }

  /// Writes a form. Its resources are written before it is known which of them the form uses, so all opacities of its
  /// group are listed.
  void write_form(const PdfPage& page, const PdfPage::Form& form) {
    const PageGroup& group = *form.group;
    glm::dvec2 low(0), high(page.page->width, page.page->height);
    if (group.bulges.empty() && group.texts.empty() && !group.points.empty()) {
      low = high = group.points[0];
      for (const glm::dvec2& p : group.points) {
        low = glm::min(low, p);
        high = glm::max(high, p);
      }
    }
    States states;
    for (std::size_t i = 0; i < group.paths.size(); ++i) {
      const PathPaint paint = paint_of(group, i);
      if (paint.fill) states.fills[paint.fill->opacity] = true;
      if (paint.line) states.lines[paint.line->opacity] = true;
    }
    if (!group.texts.empty()) states.fills[group.pen.color.opacity] = states.lines[group.pen.color.opacity] = true;
    begin(form.object) << "<< /Type /XObject /Subtype /Form /BBox [";
    for (const double side :
         {low.x - group.pen.width, low.y - group.pen.width, high.x + group.pen.width, high.y + group.pen.width})
      out_.fixed(thousandths(side)) << ' ';
    out_ << "] /Group << /S /Transparency /I true >> /Resources << ";
    write_all_states(states);
    write_font_references();
    out_ << ">> ";
    (void)write_stream(page, &group, form.object + 1);
  }

  PageText& write_all_states(const States& states) {
    out_ << "/ExtGState << ";
    write_states(states.fills, "/F", "/ca");
    write_states(states.lines, "/S", "/CA");
    return out_ << ">> ";
  }

  void write_font_references() {
    for (std::size_t i = 0; i < fonts_.size(); ++i) {
      out_ << (i == 0 ? "/Font << /T" : "/T") << i << ' ';
      reference(fonts_[i]);
    }
    if (!fonts_.empty()) out_ << ">> ";
  }

  /// Writes a font, its characters, by which programs search and copy text, and its glyphs.
  void write_font(std::size_t font) {
    std::vector<const PdfLetter*> letters;
    for (const auto& [code, letter] : letters_)
      if (letter.number / letters_per_font == font) letters.push_back(&letter);
    begin(fonts_[font]) << "<< /Type /Font /Subtype /Type3 /FontBBox [0 -3 10 13] /FontMatrix [.1 0 0 .1 0 0] "
                           "/FirstChar 0 /LastChar "
                        << letters.size() - 1 << "\n/Widths [ ";
    for (const PdfLetter* const letter : letters) out_.fixed(thousandths(PdfContent::advance_of(letter->utf8))) << ' ';
    out_ << "]\n/Encoding << /Type /Encoding /Differences [ 0 ";
    for (std::size_t i = 0; i < letters.size(); ++i) out_ << "/c" << i << ' ';
    out_ << "] >>\n/CharProcs << ";
    for (std::size_t i = 0; i < letters.size(); ++i) {
      out_ << "/c" << i << ' ';
      reference(glyphs_ + letters[i]->number);
    }
    out_ << ">>\n/Resources << >> /ToUnicode ";
    reference(fonts_[font] + 1) << ">>\nendobj\n";
    std::string last;
    append_hex(unsigned(letters.size() - 1), last, 2);
    write_small_stream(fonts_[font] + 1, [&](PageText& out) {
      out << "/CIDInit /ProcSet findresource begin 12 dict begin begincmap /CMapName /Letters def /CMapType 2 def\n"
             "1 begincodespacerange <00> <FF> endcodespacerange\n1 beginbfrange <00> <"
          << last << "> [";
      for (const PdfLetter* const letter : letters) out << " <" << pdf_text(letter->utf8).substr(5);
      out << " ] endbfrange\nendcmap CMapName currentdict /CMap defineresource pop end end";
    });
    for (const PdfLetter* const letter : letters)
      write_small_stream(glyphs_ + letter->number, [&](PageText& out) {
        PdfContent(*pages_[0].page, out, 1, progress_, letters_).write_glyph(letter->utf8);
      });
  }

  template <class Write>
  void write_small_stream(std::size_t object, const Write& write) {
    std::string bytes;
    PageText text([&bytes](std::string_view more) { bytes += more; });
    write(text);
    text.flush();
    begin(object) << "<< /Length " << bytes.size() << " >>\nstream\n" << bytes << "\nendstream\nendobj\n";
  }

  PageText& layer_references() {
    for (const Layer& layer : layers_) reference(layer.object);
    return out_;
  }

  void write_states(const PdfContent::Opacities& used, const char* name, const char* key) {
    for (std::size_t i = 0; i < used.size(); ++i) {
      if (!used[i]) continue;
      out_ << name << i << " << " << key << ' ';
      out_.fixed(thousandths(double(i) / 255)) << " >> ";
    }
  }

  void write_page(const PdfPage& page, const States& states) {
    begin(page.object) << "<< /Type /Page /Parent 2 0 R /Contents ";
    reference(page.contents) << "/MediaBox [0 0 ";
    // The size is rounded down, because rasterizers round up.
    out_.fixed(std::int64_t(page.page->width * page.scale * 1e6), 6) << ' ';
    out_.fixed(std::int64_t(page.page->height * page.scale * 1e6), 6) << "]";
    if (page.unit > 1) out_ << " /UserUnit " << std::int64_t(page.unit);
    out_ << "\n/Resources << ";
    write_all_states(states);
    if (!page.forms.empty()) {
      out_ << "/XObject << ";
      for (std::size_t i = 0; i < page.forms.size(); ++i) {
        out_ << "/G" << i << ' ';
        reference(page.forms[i].object);
      }
      out_ << ">> ";
    }
    write_font_references();
    out_ << "/Properties << ";
    for (std::size_t i = 0; i < page.layers.size(); ++i) {
      out_ << "/L" << i << ' ';
      reference(layers_[page.layers[i]].object);
    }
    out_ << ">> >> >>\nendobj\n";
  }

  void write_end() {
    begin(page_tree) << "<< /Type /Pages /Kids [ ";
    for (const PdfPage& page : pages_) reference(page.object);
    out_ << "] /Count " << pages_.size() << " >>\nendobj\n";
    begin(info) << "<< /Producer (Frontmost) /Title " << pdf_text(pages_[0].page->title) << " >>\nendobj\n";
    begin(catalog) << "<< /Type /Catalog /Pages 2 0 R /OCProperties << /OCGs [ ";
    layer_references() << "] /D << /Order [ ";
    layer_references() << "] >> >> >>\nendobj\n";
    const std::uint64_t table = out_.size();
    out_ << "xref\n0 " << places_.size() << "\n0000000000 65535 f \n";
    for (std::size_t i = 1; i < places_.size(); ++i) {
      const std::string digits = std::to_string(places_[i]);
      out_ << std::string(10 - std::min<std::size_t>(digits.size(), 10), '0') << digits << " 00000 n \n";
    }
    out_ << "trailer\n<< /Size " << places_.size() << " /Root 1 0 R /Info 6 0 R >>\nstartxref\n"
         << table << "\n%%EOF\n";
  }

  PageText out_;
  WritingProgress progress_;
  const PdfLetters letters_;
  std::vector<std::size_t> fonts_;  ///< the object of each font; the next one is of its characters
  std::size_t glyphs_ = 0;          ///< the object of the first letter; others follow by their numbers
  std::vector<PdfPage> pages_;
  std::vector<Layer> layers_;
  std::vector<std::uint64_t> places_ = std::vector<std::uint64_t>(first_free);
};

}  // namespace

void save_pdf(std::span<const Page> pages, OutputFile& file, const Execution& execution) {
  PdfWriter(pages, file, execution).write();
}

}  // namespace frontmost::detail
