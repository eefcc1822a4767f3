// SPDX-License-Identifier: Apache-2.0
// Texts and dimensions of pages, as each format says them.
#include <gmock/gmock.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

#include "io/drawings/sample_page.h"

namespace frontmost::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

constexpr double upright = std::numbers::pi / 2;

/// A page of 100 x 50 mm with three texts: level from the left, centred and in its middle, and upright to the right.
Page page_of_texts() {
  Page page{100, 50, "", {{"8 frame", {{"notes", {0.35, {}}}}}}};
  PageGroup& group = page.layers[0].groups[0];
  group.texts = {{"A & B", {10, 20}, {5}},
                 {"1:2", {50, 20}, {3.5, 0, TextAlign::centre, TextLine::middle}},
                 {"6\u00d7\u230010", {90, 40}, {3.5, upright, TextAlign::right}}};
  return page;
}

/// The same texts as strokes.
Page page_of_strokes() {
  Page page = page_of_texts();
  PageGroup& group = page.layers[0].groups[0];
  for (const PlacedText& text : group.texts) add_text(group, text.text, text.at, text.style);
  group.texts.clear();
  return page;
}

/// A horizontal dimension of 40 mm on the page, stated as 80, and the line beside it.
Page page_of_a_dimension() {
  Page page{100, 50, "", {{"7 dimensions", {{"", {}}}}}};
  PageGroup& group = page.layers[0].groups[0];
  group.add(std::vector<glm::dvec2>{{1, 1}, {2, 1}}, false);
  group.add(std::vector<glm::dvec2>{{10, 30}, {10, 42}}, false);
  group.add(std::vector<glm::dvec2>{{50, 20}, {50, 42}}, false);
  group.add(std::vector<glm::dvec2>{{10, 40}, {50, 40}}, false);
  group.texts = {{"note", {1, 5}, {}}, {"80", {30, 39}, {3.5, 0, TextAlign::centre}}};
  group.dimensions = {{DimensionKind::linear, {10, 29}, {50, 19}, {50, 40}, 0, 2, 1, 3, 1}};
  return page;
}

using Codes = std::multimap<int, std::string>;

/// The entities of a DXF from the word on, by their codes; code 0 is the kind.
std::vector<Codes> entities_after(const std::string& dxf, const std::string& word) {
  std::istringstream in(dxf.substr(dxf.find("\n" + word + "\n") + word.size() + 2));
  std::vector<Codes> entities;
  std::string code, value;
  while (std::getline(in, code) && std::getline(in, value) && value != "ENDSEC" && value != "ENDBLK") {
    if (code == "0") entities.emplace_back();
    if (!entities.empty()) entities.back().emplace(std::stoi(code), value);
  }
  return entities;
}

double number(const Codes& codes, int code) { return std::stod(codes.find(code)->second); }
std::string value(const Codes& codes, int code) { return codes.find(code)->second; }

std::vector<std::string> kinds_of(const std::vector<Codes>& entities) {
  std::vector<std::string> kinds;
  for (const Codes& codes : entities) kinds.push_back(value(codes, 0));
  return kinds;
}

/// A page with only this text, at (10, 10).
Page page_of_text(const std::string& text, const TextStyle& style = {}) {
  return {100, 50, "", {{"8 frame", {{.name = "notes", .pen = {0.35, {}}, .texts = {{text, {10, 10}, style}}}}}}};
}

// Letters of fonts have blank space of about a tenth of their height at both sides.
TEST(Texts, AreElementsOfSvgAsWideAsTheirStrokes) {
  const std::string svg = saved(page_of_texts(), PageFormat::svg);
  EXPECT_THAT(svg, HasSubstr("<text x=\"9.5\" y=\"20\" font-family=\"Arial, Helvetica, sans-serif\" font-size=\"7\" "
                             "text-anchor=\"start\" textLength=\"17.2\""));
  EXPECT_THAT(svg, HasSubstr(">A &amp; B</text>"));
  // The base line is half a height below the middle.
  EXPECT_THAT(svg, HasSubstr("<text x=\"50\" y=\"21.75\""));
  EXPECT_THAT(svg, HasSubstr("text-anchor=\"middle\""));
  EXPECT_THAT(svg, HasSubstr("transform=\"rotate(-90 90 39.65)\" fill=\"#000000\" stroke=\"none\""));
  EXPECT_THAT(saved(page_of_strokes(), PageFormat::svg), Not(HasSubstr("<text")));
}

// The strokes of narrow letters are much narrower than the letters of fonts.
TEST(Texts, OfOneCharacterHaveTheWidthOfTheirFontInSvg) {
  EXPECT_THAT(saved(page_of_text("I"), PageFormat::svg), Not(HasSubstr("textLength")));
  EXPECT_THAT(saved(page_of_text("\u2300"), PageFormat::svg), Not(HasSubstr("textLength")));
  EXPECT_THAT(saved(page_of_text("II"), PageFormat::svg), HasSubstr("textLength=\"2.1\""));
}

TEST(Texts, WithoutCharactersAreNoElements) {
  EXPECT_THAT(saved(page_of_text(""), PageFormat::svg), Not(HasSubstr("<text")));
  EXPECT_THAT(entities_after(saved(page_of_text(""), PageFormat::dxf), "ENTITIES"), IsEmpty());
  EXPECT_THAT(operators_of(saved(page_of_text(""), PageFormat::pdf)), Not(HasSubstr("BT")));
}

TEST(Texts, OfJsonAreThePages) {
  const auto json = nlohmann::json::parse(saved(page_of_texts(), PageFormat::json));
  const auto& texts = json["layers"][0]["groups"][0]["texts"];
  ASSERT_EQ(texts.size(), 3u);
  EXPECT_EQ(texts[0], nlohmann::json::parse(R"({"text": "A & B", "at": [10, 20], "height": 5, "angle": 0,
                                                "align": "left", "line": "bottom"})"));
  EXPECT_EQ(texts[2]["text"], "6\u00d7\u230010");
  EXPECT_NEAR(texts[2]["angle"].get<double>(), upright, 1e-9);
  EXPECT_FALSE(
      nlohmann::json::parse(saved(page_of_strokes(), PageFormat::json))["layers"][0]["groups"][0].contains("texts"));
  const auto page = nlohmann::json::parse(saved(page_of_a_dimension(), PageFormat::json));
  EXPECT_EQ(page["layers"][0]["groups"][0]["dimensions"][0],
            nlohmann::json::parse(R"({"kind": "linear", "from": [10, 29], "to": [50, 19], "line": [50, 40], "angle": 0,
                                      "factor": 2, "first_path": 1, "path_count": 3, "text": 1})"));
}

TEST(Texts, OfDxfAreEntitiesOnTheirBaseLine) {
  const std::vector<Codes> all = entities_after(saved(page_of_texts(), PageFormat::dxf), "ENTITIES");
  ASSERT_THAT(kinds_of(all), ElementsAre("TEXT", "TEXT", "TEXT"));
  EXPECT_EQ(value(all[0], 1), "A & B");
  EXPECT_EQ(number(all[0], 40), 5);
  EXPECT_EQ(number(all[0], 10), 10);
  EXPECT_EQ(number(all[0], 20), 30);
  EXPECT_EQ(all[0].count(72), 0u);
  EXPECT_EQ(value(all[0], 370), "50");  // its own pen: the group's has 0.35 mm
  EXPECT_EQ(all[1].count(370), 0u);
  EXPECT_EQ(number(all[1], 72), 1);
  EXPECT_EQ(number(all[1], 11), 50);
  EXPECT_EQ(number(all[1], 21), 28.25);
  EXPECT_NEAR(number(all[1], 10), 50 - text_width("1:2", 3.5) / 2, 0.0006);
  EXPECT_EQ(value(all[2], 1), "6\xD7%%c10");
  EXPECT_EQ(number(all[2], 50), 90);
  EXPECT_EQ(number(all[2], 21), 10);
  EXPECT_NEAR(number(all[2], 20), 10 - text_width("6\u00d7\u230010", 3.5), 0.0006);  // its beginning is below
}

TEST(Texts, OfDxfAreInItsCodePage) {
  const auto written = [](const std::string& text) {
    return value(entities_after(saved(page_of_text(text), PageFormat::dxf), "ENTITIES").at(0), 1);
  };
  EXPECT_EQ(written("\u00b10.1 at 20\u00b0"), "%%p0.1 at 20%%d");
  EXPECT_EQ(written("\u00e9\u2264"), "\xE9\\U+2264");
  EXPECT_EQ(written("50 %"), "50 %");
  EXPECT_EQ(written("%%d"), "%%%%d");  // %%% is a per cent sign
  EXPECT_EQ(written("10%\u00b12%"), "10\\U+0025%%p2%");
  EXPECT_EQ(written("%%\u2300%\u00b0"), "%%%\\U+0025%%c\\U+0025%%d");
  EXPECT_EQ(written("{<>}"), "{<>}");
  EXPECT_EQ(written("C:\\P^J"), "C:\\U+005CP\\U+005EJ");
  EXPECT_EQ(written("\u6f22\U0001f600"), "\\U+6F22\\U+25A1");
  EXPECT_EQ(written("a\nb").find('\n'), std::string::npos);
}

TEST(Texts, OfPdfCanBeSearchedAndHaveTheStrokesOfLetters) {
  const std::string pdf = saved(page_of_texts(), PageFormat::pdf), operators = operators_of(pdf);
  // Codes are in the order of characters: blank & 0 1 2 6 : A B x and the sign of diameters.
  EXPECT_THAT(operators, HasSubstr("BT 1 0 0 -1 10 20 Tm /T0 5 Tf <0700010008> Tj ET\n"));
  EXPECT_THAT(operators, HasSubstr("BT 0 -1 -1 0 90 "));
  EXPECT_THAT(operators, HasSubstr("/T0 3.5 Tf <05090A0302> Tj ET\n"));
  EXPECT_THAT(pdf, HasSubstr("[ <0020> <0026> <0030> <0031> <0032> <0036> <003A> <0041> <0042> <00D7> <2300> ]"));
  EXPECT_THAT(pdf, HasSubstr("/Font << /T0 "));
  // "A" is two strokes with half the pen's width around them, and 3 between the middles of strokes.
  EXPECT_THAT(pdf, HasSubstr("stream\n9 0 d0 1 w\n.5 .5 m\n3.5 9.5 l\n6.5 .5 l\n1.5 3.5 m\n5.5 3.5 l\nS\n"));
  EXPECT_THAT(saved(page_of_strokes(), PageFormat::pdf), Not(HasSubstr("/Font")));
}

// A group with an opacity is a form, with resources and a box of its own.
TEST(Texts, OfPdfAreInGroupsWithAnOpacityToo) {
  Page page = page_of_texts();
  PageGroup& group = page.layers[0].groups[0];
  group.opacity = 128;
  group.add(std::vector<glm::dvec2>{{1, 1}, {2, 1}}, false);
  const std::string pdf = saved(page, PageFormat::pdf), form = pdf.substr(pdf.find("/Subtype /Form"));
  EXPECT_THAT(form.substr(0, form.find('\n')), HasSubstr("/BBox [-.35 -.35 100.35 50.35 ]"));
  EXPECT_THAT(form.substr(0, form.find("stream")), HasSubstr("/Font << /T0 "));
  EXPECT_THAT(operators_of(form), HasSubstr("Tm /T0 5 Tf <"));
}

TEST(Texts, OfPdfHaveTheOpacitiesOfTheirPenInGroupsWithAnOpacity) {
  Page page = page_of_texts();
  PageGroup& group = page.layers[0].groups[0];
  group.opacity = 200;
  group.pen.color.opacity = 128;
  const auto check = [&page] {
    const std::string pdf = saved(page, PageFormat::pdf), form = pdf.substr(pdf.find("/Subtype /Form"));
    EXPECT_THAT(operators_of(form), HasSubstr("/F128 gs\n/S128 gs\n"));
    EXPECT_THAT(form.substr(0, form.find("stream")),
                HasSubstr("/ExtGState << /F128 << /ca .502 >> /S128 << /CA .502 >> >>"));
  };
  check();
  group.add(std::vector<glm::dvec2>{{1, 1}, {2, 1}}, false);
  group.pen.width = 0;
  check();
}

// The dashes of an earlier group would stay, also within a form.
TEST(Texts, OfPdfAreSolidAfterDashes) {
  for (const int opacity : {255, 128}) {
    Page page = page_of_text("A");
    PageGroup dashed{"axle", {0.25, {}, {3, 0.75}}}, &letters = page.layers[0].groups[0];
    dashed.add(std::vector<glm::dvec2>{{1, 1}, {20, 1}}, false);
    letters.pen.width = 0;
    letters.opacity = std::uint8_t(opacity);
    page.layers[0].groups.insert(page.layers[0].groups.begin(), dashed);
    const std::string pdf = saved(page, PageFormat::pdf), form = pdf.substr(pdf.find("/Subtype /Form") + 1);
    const std::string operators = operators_of(opacity < 255 ? form : pdf);
    EXPECT_THAT(operators.substr(operators.rfind("d\n", operators.find("BT")) - 5), StartsWith("[] 0 d\n")) << opacity;
  }
}

// They are one letter, whichever comes last.
TEST(Texts, OfPdfCopyInvalidBytesAsReplacementCharacters) {
  for (const char* const text : {"\uFFFD\xff", "\xff\uFFFD", "\xe9"})
    EXPECT_THAT(saved(page_of_text(text), PageFormat::pdf), HasSubstr("[ <FFFD> ]"));
}

TEST(Texts, OfPdfHaveAsManyFontsAsTheirCharactersNeed) {
  Page page = page_of_texts();
  std::string all;
  for (unsigned code = 0x100; code < 0x100 + 300; ++code) all += {char(0xC0 | code >> 6), char(0x80 | (code & 0x3F))};
  page.layers[0].groups[0].texts = {{all, {1, 10}, {1}}};
  const std::string pdf = saved(page, PageFormat::pdf), operators = operators_of(pdf);
  EXPECT_THAT(operators, HasSubstr("FEFF> Tj /T1 1 Tf <000102"));
  EXPECT_THAT(pdf, HasSubstr("/LastChar 255\n"));
  EXPECT_THAT(pdf, HasSubstr("/LastChar 43\n"));
}

TEST(Texts, BelongToTheDataThatEveryFunctionOfPagesKnows) {
  const Page page = page_of_texts();
  EXPECT_EQ(travel_of(page).texts, 3u);
  EXPECT_EQ(travel_of(page).paths, 0u);
  Page dashed = page_of_a_dimension();
  dashed.layers[0].groups[0].pen.dashes = {3, 1};
  const Page real = with_real_dashes(dashed);
  EXPECT_EQ(real.layers[0].groups[0].texts.size(), 2u);
  EXPECT_NO_THROW(validate(real));
  const auto refused = [](auto&& change) {
    Page changed = page_of_a_dimension();
    change(changed.layers[0].groups[0]);
    EXPECT_THROW(validate(changed), Error);
  };
  EXPECT_NO_THROW(validate(page_of_a_dimension()));
  refused([](PageGroup& g) { g.texts[0].at.x = std::nan(""); });
  refused([](PageGroup& g) { g.texts[0].style.height = 0; });
  refused([](PageGroup& g) { g.texts[0].style.angle = std::nan(""); });
  refused([](PageGroup& g) { g.dimensions[0].to.y = 1e9; });
  refused([](PageGroup& g) { g.dimensions[0].factor = 0; });
  refused([](PageGroup& g) { g.dimensions[0].text = 2; });
  refused([](PageGroup& g) { g.dimensions[0].path_count = 4; });
  refused([](PageGroup& g) { g.dimensions[0].first_path = 5; });
  // A second dimension needs paths and a text of its own.
  const auto add_second = [](PageGroup& g, std::uint32_t path_count, std::uint32_t text) {
    g.dimensions.push_back(g.dimensions[0]);
    g.dimensions[1].first_path = 0;
    g.dimensions[1].path_count = path_count;
    g.dimensions[1].text = text;
  };
  refused([&](PageGroup& g) { add_second(g, 2, 0); });
  refused([&](PageGroup& g) { add_second(g, 1, 1); });
  Page two = page_of_a_dimension();
  add_second(two.layers[0].groups[0], 1, 0);
  EXPECT_NO_THROW(validate(two));
}

// Progress is reported, and cancelling noticed, after 4096 steps.
TEST(Texts, AreStepsOfProgress) {
  Page page = page_of_text("A");
  page.layers[0].groups[0].texts.resize(5000, page.layers[0].groups[0].texts[0]);
  for (const PageFormat format : {PageFormat::svg, PageFormat::pdf, PageFormat::dxf, PageFormat::json}) {
    double last = 0;
    Watch watch;
    watch.progress = [&last](std::string_view, double share) { last = share; };
    (void)saved(page, format, {.watch = &watch});
    EXPECT_DOUBLE_EQ(last, 4096.0 / 5000) << int(format);
  }
}

TEST(PageDimensions, AreEntitiesThatShowTheBlockOfTheirLines) {
  const std::string dxf = saved(page_of_a_dimension(), PageFormat::dxf);
  const std::vector<Codes> all = entities_after(dxf, "ENTITIES");
  ASSERT_THAT(kinds_of(all), ElementsAre("LINE", "TEXT", "DIMENSION"));
  const Codes& dimension = all[2];
  EXPECT_EQ(value(dimension, 2), "*D1");
  EXPECT_EQ(value(dimension, 1), "80");
  EXPECT_EQ(number(dimension, 42), 80);
  EXPECT_EQ(number(dimension, 70), 32 + 128);
  // The measured points, the dimension line's place at the second of them, and the middle of the text; y is up.
  const std::pair<int, glm::dvec2> places[] = {{13, {10, 21}}, {14, {50, 31}}, {10, {50, 10}}, {11, {30, 12.75}}};
  for (const auto& [code, place] : places) {
    EXPECT_EQ(number(dimension, code), place.x) << code;
    EXPECT_EQ(number(dimension, code + 10), place.y) << code;
  }
  EXPECT_THAT(kinds_of(entities_after(dxf.substr(dxf.find("\n*D1\n70\n1\n10\n")), "1")),
              ElementsAre("LINE", "LINE", "LINE", "TEXT"));
  // The style multiplies lengths of the page.
  EXPECT_THAT(dxf, HasSubstr("\n2\n" + value(dimension, 3) + "\n"));
  EXPECT_THAT(dxf, HasSubstr("\n144\n2\n"));
}

TEST(PageDimensions, OfEachKindHaveTheirPoints) {
  Page page = page_of_a_dimension();
  PageGroup& group = page.layers[0].groups[0];
  group.texts.resize(3);
  group.dimensions.assign(3, {DimensionKind::linear, {10, 29}, {50, 19}, {50, 40}, 0, 2});
  for (std::uint32_t i = 0; i < 3; ++i) group.dimensions[i].text = i;
  group.dimensions[0].angle = upright;
  group.dimensions[1].kind = DimensionKind::diameter;
  group.dimensions[2].kind = DimensionKind::radius;
  const std::string dxf = saved(page, PageFormat::dxf);
  std::vector<Codes> all = entities_after(dxf, "ENTITIES");
  ASSERT_EQ(all.size(), 7u);
  all.erase(all.begin(), all.begin() + 4);  // lines
  EXPECT_EQ(number(all[0], 50), 90);
  EXPECT_EQ(number(all[0], 42), 20);  // 10 mm upwards
  EXPECT_EQ(number(all[0], 10), 50);  // the line is upright, and ends at the height of the second point
  EXPECT_EQ(number(all[0], 20), 31);
  EXPECT_EQ(number(all[1], 70), 3 + 32 + 128);
  EXPECT_NEAR(number(all[1], 42), 2 * std::hypot(40, 10), 1e-9);
  EXPECT_EQ(number(all[2], 70), 4 + 32 + 128);
  EXPECT_EQ(number(all[2], 15), 50);
  EXPECT_EQ(number(all[2], 40), 21);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(value(all[i], 2), "*D" + std::to_string(i + 1));
}

TEST(PageDimensions, HaveMeasurementsOfEveryFactor) {
  for (const double factor : {1e15, 1.0 / 3, 1e-15}) {
    Page page = page_of_a_dimension();
    page.layers[0].groups[0].dimensions[0].factor = factor;
    const std::vector<Codes> all = entities_after(saved(page, PageFormat::dxf), "ENTITIES");
    EXPECT_NEAR(number(all.at(2), 42), 40 * factor, 1e-10 * factor);
  }
}

// The text of a dimension is formatted text, in which "<>", and no text at all, are the measurement.
TEST(PageDimensions, HaveTextsThatAreNoCodes) {
  const auto written = [](const std::string& text) {
    Page page = page_of_a_dimension();
    page.layers[0].groups[0].texts[1].text = text;
    return saved(page, PageFormat::dxf);
  };
  const auto shown = [&](const std::string& text) { return value(entities_after(written(text), "ENTITIES").at(2), 1); };
  EXPECT_EQ(shown("<>"), "\\U+003C>");
  EXPECT_EQ(shown("1 < 2 > 1"), "1 < 2 > 1");
  EXPECT_EQ(shown("{5}"), "\\U+007B5\\U+007D");
  EXPECT_EQ(shown("\\P%\u00b1"), "\\U+005CP\\U+0025%%p");
  EXPECT_EQ(shown(""), " ");
  // The block of the dimension has no text then.
  EXPECT_THAT(kinds_of(entities_after(written("").substr(written("").find("\n*D1\n70\n1\n10\n")), "1")),
              ElementsAre("LINE", "LINE", "LINE"));
}

// LibreCAD shows no ordinate dimensions, so their lines and texts are entities of the drawing.
TEST(PageDimensions, ThatArePositionsAreLinesAndTextsInDxf) {
  Page page = page_of_a_dimension();
  page.layers[0].groups[0].dimensions[0].kind = DimensionKind::position;
  const std::string dxf = saved(page, PageFormat::dxf);
  EXPECT_THAT(kinds_of(entities_after(dxf, "ENTITIES")), ElementsAre("LINE", "LINE", "LINE", "LINE", "TEXT", "TEXT"));
  EXPECT_THAT(dxf, Not(HasSubstr("*D1")));
}

/// No two objects of a DXF share a handle, and the next free one is above all.
TEST(PageDimensions, HaveHandlesOfTheirOwn) {
  Page page = page_of_a_dimension();
  page.layers.push_back(sample_page().layers[1]);
  std::istringstream in(saved(page, PageFormat::dxf));
  std::map<unsigned long, int> handles;
  std::string code, value, name;
  unsigned long seed = 0;
  while (std::getline(in, code) && std::getline(in, value)) {
    if (code == "9") name = value;
    if (code == "5" && name == "$HANDSEED" && seed == 0)
      seed = std::stoul(value, nullptr, 16);
    else if (code == "5" || code == "105")
      ++handles[std::stoul(value, nullptr, 16)];
  }
  EXPECT_GT(handles.size(), 30u);
  for (const auto& [handle, count] : handles) EXPECT_EQ(count, 1) << handle;
  EXPECT_GT(seed, handles.rbegin()->first);
}

}  // namespace
}  // namespace frontmost::test
