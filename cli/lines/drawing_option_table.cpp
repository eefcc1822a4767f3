// SPDX-License-Identifier: Apache-2.0
// Options of frontmost lines only.
#include <fmt/format.h>

#include <algorithm>

#include "cli/failure.h"
#include "cli/lines/sheet_settings.h"
#include "cli/option.h"

namespace frontmost::cli {
namespace {

constexpr std::string_view view_choices = "front|back|left|right|top|bottom|iso";

std::vector<NamedView> views_from(std::string_view text) {
  std::vector<NamedView> views;
  for (const std::string_view word : split(text, ',')) views.push_back(NamedView(parse_choice(word, view_choices)));
  return views;
}

/// Parses sections such as "front" or "front=12.5", separated by commas.
std::vector<SectionView> sections_from(std::string_view text) {
  std::vector<SectionView> sections;
  for (const std::string_view word : split(text, ',')) {
    const std::size_t sign = word.find('=');
    SectionView& section = sections.emplace_back();
    section.direction = NamedView(parse_choice(word.substr(0, sign), "front|back|left|right|top|bottom"));
    if (sign != std::string_view::npos) section.at = parse_number(word.substr(sign + 1), any_number);
  }
  return sections;
}

/// Parses a name of paper, "210,297" or "210x297" in millimetres, or "fit".
Paper paper_from(std::string_view text) {
  std::string small(text);
  for (char& c : small) c = c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c;
  if (small == "fit") return {.fits_drawing = true};
  if (!small.empty() && small[0] >= '0' && small[0] <= '9') {
    std::replace(small.begin(), small.end(), 'x', ',');
    const std::vector<double> sides = parse_numbers(small, 2, {1, 1e5});
    return {{sides[0], sides[1]}, false, false};
  }
  try {
    return named_paper(text);
  } catch (const Error& error) {
    throw UsageError(fmt::format("{}; or give W,H in millimetres, or the word fit", error.what()));
  }
}

/// Parses a scale such as "1:5", "2:1" or "0.2".
double scale_from(std::string_view text) {
  constexpr NumberLimits range{1e-6, 1e6};
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos) return parse_number(text, range);
  const double paper = parse_number(text.substr(0, colon), range), model = parse_number(text.substr(colon + 1), range);
  return paper / model;
}

void set_scale(Settings& s, const Given& g) {
  SheetOptions& sheet = s.drawing.sheet;
  sheet.scale.reset();
  sheet.standard_scale = g.text == "standard";
  if (g.text != "fit" && g.text != "standard") sheet.scale = scale_from(g.text);
}

glm::dvec3 light_from(std::string_view text) {
  const std::vector<double> parts = parse_numbers(text, 3, {-1e6, 1e6});
  const glm::dvec3 light(parts[0], parts[1], parts[2]);
  if (!(glm::length(light) > 1e-6)) throw UsageError("the direction of the light must not be 0,0,0");
  return light;
}

/// Returns a text of the title block. \throws UsageError if it has more characters than fit into its field legibly.
std::string field_text(const Given& given, std::size_t most) {
  const auto is_first = [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; };
  const auto count = std::size_t(std::count_if(given.text.begin(), given.text.end(), is_first));
  if (count > most) throw UsageError(fmt::format("the text has {} characters; at most {} fit", count, most));
  return given.string();
}

constexpr Option drawing_options[] = {
    {"hidden", 0, "none|dashed|thin", "Style of hidden edges; none, the default, leaves them out.", Group::drawing,
     for_lines, [](Settings& s, const Given& g) { s.drawing.sheet.hidden = g.choice<HiddenLines>(); }},
    {"hidden-views", 0, "V,V,...", "Views of the sheet that show hidden edges; all except iso by default.",
     Group::drawing, for_lines, [](Settings& s, const Given& g) { s.drawing.sheet.hidden_views = views_from(g.text); }},
    {"style", 0, "technical|figure",
     "Line widths. technical, the default: widths of drawing standards, 0.5 mm. figure: heavy outlines, lighter "
     "contours, light creases.",
     Group::drawing, for_lines, [](Settings& s, const Given& g) { s.drawing.sheet.style = g.choice<DrawingStyle>(); }},
    {"pen", 0, "MM",
     "Width of visible lines, 0.01 to 10; 0.5 by default, 0.35 with --style figure. Other widths and dashes scale with "
     "it.",
     Group::drawing, for_lines, [](Settings& s, const Given& g) { s.drawing.sheet.pen = g.number(); }},
    {"crease-angle", 0, "DEGREES",
     "Draw the edges whose two faces meet at more than this angle, 0 to 180. By default the edges that the file "
     "states, as STEP does; else the curvature of the surfaces on both sides decides.",
     Group::drawing, for_lines,
     [](Settings& s, const Given& g) {
       s.drawing.sheet.crease_angle = glm::radians(g.number({0, 180}));
     }},
    {"shortest-stroke", 0, "MM",
     "Leave out strokes and hatch lines shorter than this, 0 to 10, except pieces of outlines and strokes that connect "
     "others; 0.5 by default with --plot, 0 otherwise. Hatch lines below 0.2 are always left out.",
     Group::drawing, for_lines, [](Settings& s, const Given& g) { s.drawing.sheet.shortest_stroke = g.number(); }},
    {"hatch", 0, "MM",
     "Hatch dark surfaces with lines this far apart, 0.2 to 50. Darker surfaces have twice as many lines; other lines "
     "cross them in shadow.",
     Group::drawing, for_lines, [](Settings& s, const Given& g) { s.drawing.sheet.hatch = g.number(); }},
    {"hatch-angle", 0, "DEGREES", "Angle of hatch lines, counter-clockwise from horizontal; 45 by default.",
     Group::drawing, for_lines,
     [](Settings& s, const Given& g) {
       s.drawing.hatch_angle = glm::radians(g.number({-360, 360}));
     }},
    {"stipple", 0, "MM", "Stipple dark surfaces with dots at least about this far apart, 0.2 to 10.", Group::drawing,
     for_lines, [](Settings& s, const Given& g) { s.drawing.sheet.stipple = g.number(); }},
    {"light", 0, "X,Y,Z",
     "Direction towards the light of --hatch and --stipple, in the viewer's axes: X to the right, Y upwards, Z towards "
     "the viewer; -0.48,0.68,0.72 by default.",
     Group::drawing, for_lines, [](Settings& s, const Given& g) { s.drawing.light = light_from(g.text); }},
    {"cast-shadows", 0, "yes|no", "Whether objects cast shadows in the light of --hatch and --stipple; yes by default.",
     Group::drawing, for_lines, [](Settings& s, const Given& g) { s.drawing.casts_shadows = g.choice<int>() == 0; }},
    {"page", 0, "PAPER",
     "Paper: a0 to a6, letter, legal or tabloid, optionally with -portrait or -landscape; W,H in millimetres; or fit, "
     "as large as the drawing. a4 by default; fit if --scale is a number or a ratio.",
     Group::drawing, for_lines, [](Settings& s, const Given& g) { s.drawing.sheet.page = paper_from(g.text); }},
    {"margin", 0, "MM", "Empty space at each side of the page, 0 to 1000; 10 by default.", Group::drawing, for_lines,
     [](Settings& s, const Given& g) { s.drawing.sheet.margin = g.number(); }},
    {"scale", 0, "A:B",
     "Length on paper : length of the model, such as 1:5 or 0.2; fit: as large as the page allows; standard: the "
     "largest scale of ISO 5455 that fits. Needs parallel projection, except fit. standard by default with --views, "
     "fit otherwise.",
     Group::drawing, for_lines, set_scale},
    {"unit", 0, "mm|cm|m|in",
     "Length unit of the model's coordinates; by default that of the file, m for glTF, mm where the file states none.",
     Group::drawing, for_lines,
     [](Settings& s, const Given& g) {
       s.drawing.sheet.millimetres_per_unit = length_units[g.choice<int>()].millimetres;
     }},
    {"dimension-unit", 0, "mm|in|in-fractions",
     "Unit of the dimensions on the sheet; by default in for models in inches, mm for others. in-fractions: inches as "
     "fractions down to 1/64, such as 1 7/8, or with decimals if more than 0.0005 inches off.",
     Group::drawing, for_lines,
     [](Settings& s, const Given& g) {
       const int unit = g.choice<int>();
       s.drawing.sheet.in_inches = unit != 0;
       s.drawing.sheet.inch_fractions = unit == 2;
     }},
    {"views", 0, "V,V,...",
     "Draw several views on one sheet, in parallel projection, aligned and at one scale: front, back, left, right, "
     "top, bottom, iso.",
     Group::drawing, for_lines, [](Settings& s, const Given& g) { s.drawing.sheet.views = views_from(g.text); }},
    {"sections", 0, "V,V=C,...",
     "Draw sections, such as front,left=12.5: a view (front, back, left, right, top or bottom) of the part of the "
     "model behind a cutting plane, through the middle or at coordinate C. Cut faces are hatched, planes marked A-A, "
     "B-B.",
     Group::drawing, for_lines, [](Settings& s, const Given& g) { s.drawing.sheet.sections = sections_from(g.text); }},
    {"uncut", 0, "WORD,WORD,...",
     "Objects that --sections leave whole if the plane runs along their axis: those with one of these words in their "
     "names, and shafts; none: cut all. By default bolt,screw,nut,washer,rivet,pin,dowel,shaft,axle,ball.",
     Group::drawing, for_lines,
     [](Settings& s, const Given& g) {
       std::vector<std::string>& words = s.drawing.sheet.uncut;
       words.clear();
       if (g.text == "none") return;
       for (const std::string_view word : split(g.text, ',')) words.emplace_back(word);
     }},
    {"projection", 0, "first-angle|third-angle",
     "Arrangement of views around the front view. first-angle, the default: the top view lies below it. third-angle: "
     "above it.",
     Group::drawing, for_lines,
     [](Settings& s, const Given& g) { s.drawing.projection = ProjectionMethod(1 + g.choice<int>()); }},
    {"centre-lines", 0, "yes|no",
     "Draw long-dashed dotted lines through the centres of circles and along the axes of cylinders, in parallel "
     "projection; yes by default with --views, unless --style figure is given.",
     Group::drawing, for_lines,
     [](Settings& s, const Given& g) { s.drawing.sheet.centre_lines = g.choice<int>() == 0; }},
    {"dimensions", 0, "overall|diameters|holes|all",
     "Write dimensions on a sheet of --views, each once, in the --dimension-unit. overall: width, height and depth. "
     "diameters: also those of circles. holes: also the positions of circles, from the lower left corner of the view. "
     "all: also the radii of fillets, depths of blind holes, positions of steps and widths across flats.",
     Group::drawing, for_lines,
     [](Settings& s, const Given& g) { s.drawing.sheet.dimensions = Dimensioning(1 + g.choice<int>()); }},
    {"lettering", 0, "strokes|text",
     "How texts of sheets are written. strokes, the default: as lines of a pen, the same in every program. text: as "
     "text that programs can search and edit; in DXF also dimensions that can be edited.",
     Group::drawing, for_lines, [](Settings& s, const Given& g) { s.drawing.sheet.lettering = g.choice<Lettering>(); }},
    {"plot", 0, "",
     "Prepare the drawing for pen plotters: strokes are joined across objects and ordered for few lifts of the pen; "
     "strokes in the ink of longer strokes are left out; every dash is a line of its own.",
     Group::drawing, for_lines, [](Settings& s, const Given&) { s.drawing.sheet.plot = true; }},
    {"frame", 0, "",
     "Draw a frame and a title block (ISO 5457, ISO 7200); each of the five texts below implies it. The page must be "
     "at least 210 x 100 mm; with a numeric --scale and no --page it is the smallest of a4 to a0 that fits.",
     Group::drawing, for_lines, [](Settings& s, const Given&) { s.drawing.frame = true; }},
    {"title", 0, "TEXT", "Title of the drawing, up to 80 characters; the model's name by default.", Group::drawing,
     for_lines, [](Settings& s, const Given& g) { s.drawing.texts.title = field_text(g, 80); }},
    {"number", 0, "TEXT", "Number of the drawing, up to 30 characters.", Group::drawing, for_lines,
     [](Settings& s, const Given& g) { s.drawing.texts.number = field_text(g, 30); }},
    {"author", 0, "TEXT", "Author of the drawing, up to 40 characters.", Group::drawing, for_lines,
     [](Settings& s, const Given& g) { s.drawing.texts.author = field_text(g, 40); }},
    {"date", 0, "TEXT", "Date of issue, written as given, up to 20 characters; empty by default.", Group::drawing,
     for_lines, [](Settings& s, const Given& g) { s.drawing.texts.date = field_text(g, 20); }},
    {"owner", 0, "TEXT", "Legal owner, up to 80 characters.", Group::drawing, for_lines,
     [](Settings& s, const Given& g) { s.drawing.texts.owner = field_text(g, 80); }},
    {"output", 'o', "FILE", "Write the drawing as .svg, .pdf, .dxf or .json; - is standard output and needs --format.",
     Group::output, for_lines | may_repeat,
     [](Settings& s, const Given& g) { s.drawing.outputs.push_back(g.file_name()); }},
    {"format", 0, "svg|pdf|dxf|json", "Format of output files without a known suffix, such as -.", Group::output,
     for_lines, [](Settings& s, const Given& g) { s.drawing.format = g.choice<PageFormat>(); }},
};

}  // namespace

std::span<const Option> drawing_option_table() { return drawing_options; }

}  // namespace frontmost::cli
