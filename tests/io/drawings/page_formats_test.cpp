// SPDX-License-Identifier: Apache-2.0
// Content of each format, to the character where it matters.
#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "io/drawings/sample_page.h"

namespace frontmost::test {
namespace {

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

ErrorCode code_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.code();
  }
  ADD_FAILURE() << "nothing was thrown";
  return {};
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size())) ++n;
  return n;
}

TEST(Svg, IsInRealMillimetresAndNamesItsLayersAsInkscapeDoes) {
  const std::string svg = saved(sample_page(), PageFormat::svg);
  EXPECT_TRUE(has(svg, "width=\"100mm\" height=\"50mm\" viewBox=\"0 0 100 50\"")) << svg;
  EXPECT_TRUE(has(svg, "<title>Sample</title>"));
  EXPECT_TRUE(has(svg, "<g id=\"layer1\" inkscape:groupmode=\"layer\" inkscape:label=\"1 hidden\">"));
  EXPECT_TRUE(has(svg, "<g id=\"layer2\" inkscape:groupmode=\"layer\" inkscape:label=\"2 visible\">"));
  EXPECT_LT(svg.find("1 hidden"), svg.find("2 visible"));
  EXPECT_TRUE(has(svg, "inkscape:label=\"axle\" stroke=\"#000000\" stroke-width=\".25\""));
  EXPECT_EQ(count(svg, "stroke-dasharray=\"3 .75\""), 1u);
  for (const char* const absent : {"clip", "mask", "style", "transform"}) EXPECT_FALSE(has(svg, absent)) << absent;
}

TEST(Svg, PathsStepFromRoundedPlaceToRoundedPlace) {
  const std::string svg = saved(sample_page(), PageFormat::svg);
  EXPECT_TRUE(has(svg, "<path d=\"M10 10l10 0 .5 2.346\"/>")) << svg;
  EXPECT_TRUE(has(svg, "<path d=\"M0 0l5 0-5 5z\"/>\n<path d=\"M1 1l1 2\"/>\n")) << svg;
  EXPECT_TRUE(has(svg, "M60 20a10 10 0 0 1-10 10")) << svg;
  EXPECT_TRUE(has(svg, "M40 20a10 10 0 0 1 20 0 10 10 0 0 1-20 0z")) << svg;
  EXPECT_TRUE(has(svg, "M5 5l0 0")) << svg;
}

TEST(Svg, RoundingDoesNotAddUp) {
  Page page{1000, 10, "", {}};
  PageGroup group{"", {}};
  std::vector<glm::dvec2> points;
  for (int i = 0; i <= 9000; ++i) points.emplace_back(i * 0.10044, 5);
  group.add(points, false);
  page.layers = {{"", {group}}};
  std::istringstream path(saved(page, PageFormat::svg));
  double x = 0, dx = 0, dy = 0;
  std::string text = path.str();
  text = text.substr(text.find("M0 5l") + 5);
  std::istringstream steps(text);
  while (steps >> dx >> dy) x += dx;
  EXPECT_NEAR(x, 903.96, 0.0005);
}

TEST(Svg, FillsKeepTheirOrderAndHaveAnElementEach) {
  Page page{10, 10, "", {}};
  PageGroup group{"", {0, {}}};
  const std::vector<glm::dvec2> triangle = {{1, 1}, {9, 1}, {1, 9}};
  for (int i = 0; i < 3; ++i) group.add(triangle, true);
  group.fills = {{255, 0, 0}, {0, 255, 0, 51}, {0, 0, 255, 0}};
  page.layers = {{"", {group}}};
  const std::string svg = saved(page, PageFormat::svg);
  EXPECT_TRUE(has(svg,
                  "<path fill=\"#ff0000\" d=\"M1 1l8 0-8 8z\"/>\n"
                  "<path fill=\"#00ff00\" fill-opacity=\".2\" d=\"M1 1l8 0-8 8z\"/>\n</g>"))
      << svg;
}

TEST(Svg, EachLineIsAnElementAndDotsShareSome) {
  Page page{100, 100, "", {}};
  PageGroup group{"", {}};
  for (int i = 0; i < 5000; ++i) {
    group.add(std::vector<glm::dvec2>{{1, 1}, {2, 3}}, false);
    if (i == 700) group.add(std::vector<glm::dvec2>{{4, 4}}, false);
  }
  for (int i = 0; i < 5000; ++i) group.add(std::vector<glm::dvec2>{{5, 5}}, false);
  page.layers = {{"", {group}}};
  const std::string svg = saved(page, PageFormat::svg);
  EXPECT_EQ(count(svg, "<path d=\"M1 1l1 2\"/>\n"), 5000u);
  EXPECT_EQ(count(svg, "<path d=\"M4 4l0 0\"/>\n"), 1u);
  EXPECT_EQ(count(svg, "M5 5l0 0"), 5000u);
  EXPECT_EQ(count(svg, "<path"), 5000u + 1u + 2u);  // at most 4096 dots a path
  EXPECT_EQ(count(svg, "\"/>"), 5000u + 1u + 2u);
}

TEST(Dxf, EachHatchLineIsAnEntity) {
  Page page{100, 100, "", {}};
  PageGroup group{"", {}};
  for (int i = 0; i < 5000; ++i) group.add(std::vector<glm::dvec2>{{1, 1}, {2, 3}}, false);
  page.layers = {{"4 hatching", {group}}};
  EXPECT_EQ(count(saved(page, PageFormat::dxf), "0\nLINE\n"), 5000u);
}

TEST(Formats, WhatIsNotSeenIsNotDrawn) {
  Page page = sample_page();
  for (PageLayer& layer : page.layers)
    for (PageGroup& group : layer.groups) {
      if (group.name == "wheel") group.pen.width = 0;
      if (group.name != "wheel") group.pen.color.opacity = 0;
    }
  EXPECT_FALSE(has(saved(page, PageFormat::dxf), "LINE\n8\n"));
  EXPECT_EQ(count(operators_of(saved(page, PageFormat::pdf)), "S\n"), 0u);
}

/// A triangle with a triangular hole, and another beside it.
Page page_with_parts() {
  Page page{10, 10, "", {}};
  PageGroup group{"", {0, {}}};
  group.add(std::vector<glm::dvec2>{{1, 1}, {9, 1}, {1, 9}}, true);
  group.add(std::vector<glm::dvec2>{{2, 2}, {2, 4}, {4, 2}}, true, true);
  group.add(std::vector<glm::dvec2>{{9, 9}, {9, 8}, {8, 9}}, true);
  group.fills = {{255, 0, 0}, {255, 0, 0}, {0, 255, 0}};
  page.layers = {{"", {group}}};
  return page;
}

TEST(Svg, PartsAreInTheElementOfTheirPath) {
  const std::string svg = saved(page_with_parts(), PageFormat::svg);
  EXPECT_TRUE(has(svg,
                  "<path fill=\"#ff0000\" d=\"M1 1l8 0-8 8zM2 2l0 2 2-2z\"/>\n"
                  "<path fill=\"#00ff00\" d=\"M9 9l0-1-1 1z\"/>\n</g>"))
      << svg;
}

TEST(Pdf, PartsAreFilledWithTheirPath) {
  const std::string operators = operators_of(saved(page_with_parts(), PageFormat::pdf));
  EXPECT_EQ(count(operators, " m\n"), 3u) << operators;
  EXPECT_EQ(count(operators, "f\n"), 2u);
}

/// A triangle, and two overlapping ones in one blend group.
Page page_with_a_sheet() {
  Page page = page_with_parts();
  PageGroup sheet = page.layers[0].groups[0];
  sheet.opacity = 51;
  page.layers[0].groups.push_back(sheet);
  return page;
}

TEST(Svg, GroupsMayHaveAnOpacity) {
  const std::string svg = saved(page_with_a_sheet(), PageFormat::svg);
  EXPECT_EQ(count(svg, "<g opacity=\".2\">\n<path fill=\"#ff0000\" d="), 1u) << svg;
  EXPECT_EQ(count(svg, "opacity"), 1u);
}

TEST(Json, GroupsMayHaveAnOpacity) {
  const auto json = nlohmann::json::parse(saved(page_with_a_sheet(), PageFormat::json));
  EXPECT_FALSE(json["layers"][0]["groups"][0].contains("opacity"));
  EXPECT_EQ(json["layers"][0]["groups"][1]["opacity"], 51);
}

TEST(Pdf, GroupsMayHaveAnOpacity) {
  const std::string pdf = saved(page_with_a_sheet(), PageFormat::pdf);
  EXPECT_TRUE(has(operators_of(pdf), "q /F51 gs /G0 Do Q\n")) << operators_of(pdf);
  EXPECT_TRUE(has(pdf, "/F51 << /ca .2 >>"));
  const std::size_t form =
      pdf.find("/Type /XObject /Subtype /Form /BBox [1 1 9 9 ] /Group << /S /Transparency /I true >>");
  ASSERT_NE(form, std::string::npos);
  EXPECT_TRUE(has(pdf, "/XObject << /G0 8 0 R >>"));
  EXPECT_EQ(pdf.rfind("8 0 obj\n", form) + 8 + 3, form);
  EXPECT_EQ(count(operators_of(pdf.substr(form)), "f\n"), 2u);
}

TEST(Json, SaysWhatIsAPart) { EXPECT_EQ(count(saved(page_with_parts(), PageFormat::json), "\"part\": true"), 1u); }

/// Checks that each object begins where the table says. \returns the number of objects, including the table's head.
std::size_t objects_of(const std::string& pdf) {
  const std::size_t start = std::stoul(pdf.substr(pdf.rfind("startxref\n") + 10));
  std::istringstream table(pdf.substr(start));
  std::string word, zeros, kind;
  std::size_t first = 0, size = 0, place = 0;
  table >> word >> first >> size;
  EXPECT_EQ(word, "xref");
  table >> zeros >> zeros >> kind;
  for (std::size_t i = 1; i < size; ++i) {
    table >> place >> zeros >> kind;
    const std::string head = std::to_string(i) + " 0 obj\n";
    EXPECT_EQ(pdf.substr(place, head.size()), head);
  }
  return size;
}

TEST(Pdf, FindsItsObjectsAndItsSize) {
  const std::string pdf = saved(sample_page(), PageFormat::pdf);
  EXPECT_EQ(pdf.substr(0, 9), "%PDF-1.5\n");  // pdfTeX warns of any later version
  EXPECT_TRUE(has(pdf, "/MediaBox [0 0 283.464566 141.732283]"));
  EXPECT_TRUE(has(pdf, "/Type /OCG /Name <FEFF003100200068"));
  EXPECT_EQ(objects_of(pdf), 9u);  // two layers
  EXPECT_FALSE(has(pdf, "Date"));
  // The stream's length is the one that it states.
  const std::size_t begin = pdf.find("stream\n") + 7, end = pdf.find("\nendstream");
  EXPECT_TRUE(has(pdf, "5 0 obj\n" + std::to_string(end - begin) + "\nendobj"));
}

std::string saved_together(const std::vector<Page>& pages, PageFormat format) {
  const ScratchFolder folder;
  save(pages, folder.file("pages"), format);
  return read_text(folder.file("pages"));
}

TEST(Pdf, HasSeveralPagesWhoseLayersOfOneNameAreOne) {
  Page second = page_with_a_sheet(), third = sample_page();
  second.width = 6000;  // larger than viewers accept without a unit
  third.title = "Third";
  third.layers.push_back(third.layers[1]);  // two layers of the same name in one page
  const std::string pdf = saved_together({sample_page(), second, third}, PageFormat::pdf);
  EXPECT_EQ(pdf.substr(0, 9), "%PDF-1.6\n");
  EXPECT_TRUE(has(pdf, "/Type /Pages /Kids [ 3 0 R 9 0 R 15 0 R ] /Count 3 >>"));
  // The first page has two layers; the second one more, with a form; the third one more.
  EXPECT_EQ(count(pdf, "/Type /OCG "), 4u);
  EXPECT_EQ(objects_of(pdf), 1 + 6 + 2 + 3 + 1 + 2 + 3 + 1u);
  EXPECT_TRUE(has(pdf, "/OCGs [ 7 0 R 8 0 R 12 0 R 18 0 R ]"));
  EXPECT_EQ(count(pdf, "/Properties << /L0 7 0 R /L1 8 0 R >>"), 1u);
  EXPECT_EQ(count(pdf, "/Properties << /L0 7 0 R /L1 8 0 R /L2 18 0 R >>"), 1u);
  EXPECT_EQ(count(pdf, "/UserUnit 2"), 1u);
  EXPECT_EQ(count(pdf, "/MediaBox [0 0 283.464566 141.732283]"), 2u);
  EXPECT_EQ(count(pdf, "/Type /Page "), 3u);
  // A page in a joint file draws the same as in a file of its own.
  const std::string alone = saved(sample_page(), PageFormat::pdf);
  EXPECT_EQ(operators_of(pdf), operators_of(alone));
  EXPECT_EQ(saved_together({sample_page()}, PageFormat::pdf), alone);
}

TEST(Pages, ThatAreSeveralNeedPdf) {
  const ScratchFolder folder;
  const std::vector<Page> two{sample_page(), sample_page()};
  for (const char* const name : {"a.svg", "a.dxf", "a.json"}) {
    EXPECT_EQ(code_of([&] { save(two, folder.file(name)); }), ErrorCode::unsupported);
    EXPECT_FALSE(std::filesystem::exists(folder.file(name)));
  }
  EXPECT_EQ(code_of([&] { save(std::vector<Page>(), folder.file("a.pdf")); }), ErrorCode::bad_argument);
  EXPECT_EQ(saved_together({sample_page()}, PageFormat::svg), saved(sample_page(), PageFormat::svg));
}

TEST(Pdf, DrawsMillimetresWithYDown) {
  const std::string operators = operators_of(saved(sample_page(), PageFormat::pdf));
  EXPECT_EQ(operators.substr(0, operators.find('\n')), "2.834645669 0 0 -2.834645669 0 141.732283 cm 1 J 1 j");
  EXPECT_TRUE(has(operators, ".25 w [3 .75 ] 0 d\n10 10 m\n20 10 l\n20.5 12.346 l\nS\n")) << operators;
  EXPECT_TRUE(has(operators, "1 0 0 RG\n0 0 m\n5 0 l\n0 5 l\nh\n1 1 m\n2 3 l\nS\n")) << operators;
  EXPECT_EQ(count(operators, " c\n"), 10u);  // 2 for the quarter, 4 for each half
  EXPECT_EQ(count(operators, "BDC\n"), 2u);
  EXPECT_EQ(count(operators, "EMC\n"), 2u);
}

TEST(Pdf, CurvesKeepToTheirCircle) {
  Page page{100, 100, "", {}};
  PageGroup group{"", {}};
  group.points = {{10, 50}, {90, 50}};
  group.bulges = {1, 0};
  group.paths = {{0, 2, false}};
  page.layers = {{"", {group}}};
  std::string operators = operators_of(saved(page, PageFormat::pdf));
  std::istringstream in(operators.substr(operators.find("10 50 m\n") + 8));
  glm::dvec2 at(10, 50), a, b, c;
  std::string command;
  std::size_t curves = 0;
  while (in >> a.x >> a.y >> b.x >> b.y >> c.x >> c.y >> command && command == "c") {
    ++curves;
    for (double t = 0; t <= 1; t += 0.125) {
      const double s = 1 - t;
      const glm::dvec2 p = s * s * s * at + 3 * s * s * t * a + 3 * s * t * t * b + t * t * t * c;
      EXPECT_NEAR(glm::distance(p, {50, 50}), 40, 0.001);
      EXPECT_LE(p.y, 50.001);  // from -x by -y to +x: the direction from +x towards +y
    }
    at = c;
  }
  EXPECT_EQ(curves, 4u);
  EXPECT_EQ(at, glm::dvec2(90, 50));
}

TEST(Pdf, OpacityAndColourAreSaidOnceWhileTheyLast) {
  Page page{10, 10, "", {}};
  PageGroup group{"", {0, {}}};
  const std::vector<glm::dvec2> triangle = {{1, 1}, {9, 1}, {1, 9}};
  for (int i = 0; i < 4; ++i) group.add(triangle, true);
  group.fills = {{255, 0, 0, 51}, {255, 0, 0, 51}, {0, 0, 255, 51}, {0, 0, 255, 255}};
  page.layers = {{"", {group}}};
  const std::string pdf = saved(page, PageFormat::pdf), operators = operators_of(pdf);
  EXPECT_EQ(count(operators, "rg\n"), 2u);
  EXPECT_EQ(count(operators, " gs\n"), 2u);
  EXPECT_EQ(count(operators, "f\n"), 4u);
  EXPECT_TRUE(has(pdf, "/F51 << /ca .2 >>"));
  EXPECT_FALSE(has(operators, "RG"));
}

TEST(Pdf, PagesBeyondWhatViewersTakeHaveALargerUnit) {
  Page page = sample_page();
  page.width = 12000;
  const std::string pdf = saved(page, PageFormat::pdf);
  EXPECT_EQ(pdf.substr(0, 9), "%PDF-1.6\n");
  EXPECT_TRUE(has(pdf, "/UserUnit 3"));
  EXPECT_TRUE(has(pdf, "/MediaBox [0 0 11338.582677 47.244094]"));
}

/// Pairs of a DXF: entity kinds with their group codes.
struct Entity {
  std::string kind;
  std::multimap<int, std::string> codes;
  [[nodiscard]] double number(int code) const { return std::stod(codes.find(code)->second); }
  [[nodiscard]] std::string text(int code) const { return codes.find(code)->second; }
  [[nodiscard]] std::string last(int code) const { return std::prev(codes.upper_bound(code))->second; }
};

std::vector<Entity> entities_of(const std::string& dxf) {
  std::istringstream in(dxf.substr(dxf.find("ENTITIES\n") + 9));
  std::vector<Entity> entities;
  std::string code, value;
  while (std::getline(in, code) && std::getline(in, value)) {
    if (code == "0") {
      entities.push_back({value, {}});
    } else {
      entities.back().codes.emplace(std::stoi(code), value);
    }
  }
  return entities;
}

TEST(Dxf, HoldsLinesArcsAndCirclesWithYUp) {
  const std::string dxf = saved(sample_page(), PageFormat::dxf);
  EXPECT_TRUE(has(dxf, "9\n$ACADVER\n1\nAC1015\n"));
  const std::vector<Entity> all = entities_of(dxf);
  std::string kinds;
  for (const Entity& entity : all) kinds += entity.kind + " ";
  EXPECT_EQ(kinds, "LWPOLYLINE LWPOLYLINE LINE ARC CIRCLE POINT ENDSEC SECTION DICTIONARY DICTIONARY ENDSEC EOF ");
  EXPECT_EQ(all[0].text(8), "1_HIDDEN-AXLE");
  EXPECT_EQ(all[1].text(8), "2_VISIBLE-WHEEL");
  EXPECT_EQ(all[4].text(8), "2_VISIBLE-RING");
  EXPECT_EQ(all[0].text(70), "0");
  EXPECT_EQ(all[0].text(90), "3");
  EXPECT_EQ(all[0].last(10), "20.5");
  EXPECT_EQ(all[0].last(20), "37.654");
  EXPECT_EQ(all[1].text(70), "1");
  EXPECT_EQ(all[2].number(11), 2);
  EXPECT_EQ(all[2].number(21), 47);
  const Entity &arc = all[3], &circle = all[4];
  // The arc from (60, 30) clockwise to (50, 20), with y up, is the quarter from 270 to 360 degrees.
  EXPECT_EQ(arc.number(10), 50);
  EXPECT_EQ(arc.number(20), 30);
  EXPECT_EQ(arc.number(40), 10);
  EXPECT_EQ(arc.number(50), 270);
  EXPECT_EQ(std::fmod(arc.number(51), 360), 0);
  EXPECT_EQ(circle.number(10), 50);
  EXPECT_EQ(circle.number(40), 10);
}

TEST(Dxf, SaysItsUnitAndLeavesColoursAndLineTypesToLayers) {
  Page page = sample_page();
  const std::string dxf = saved(page, PageFormat::dxf);
  EXPECT_TRUE(has(dxf, "9\n$INSUNITS\n70\n4\n"));
  EXPECT_TRUE(has(dxf, "\n2\n1_HIDDEN-AXLE\n70\n0\n62\n6\n6\nHIDDEN\n370\n25\n"));        // black, as hidden lines
  EXPECT_TRUE(has(dxf, "\n2\n2_VISIBLE-WHEEL\n70\n0\n62\n1\n6\nCONTINUOUS\n370\n50\n"));  // red, as its pen
  EXPECT_TRUE(has(dxf, "\n2\n2_VISIBLE-RING\n70\n0\n62\n7\n6\nCONTINUOUS\n370\n13\n"));
  for (const Entity& entity : entities_of(dxf)) {
    EXPECT_EQ(entity.codes.count(6), 0u) << entity.kind;
    EXPECT_EQ(entity.codes.count(62), 0u) << entity.kind;
    EXPECT_EQ(entity.codes.count(370), 0u) << entity.kind;
  }
  // Groups without names share a layer; entities state what differs from it.
  for (PageGroup& group : page.layers[1].groups) group.name.clear();
  page.layers[1].groups[1].pen.dashes = {1, 1};
  const std::vector<Entity> all = entities_of(saved(page, PageFormat::dxf));
  EXPECT_EQ(all[1].text(8), "2_VISIBLE");
  EXPECT_EQ(all[1].codes.count(62), 0u);
  EXPECT_EQ(all[1].codes.count(370), 0u);
  EXPECT_EQ(all[3].text(8), "2_VISIBLE");
  EXPECT_EQ(all[3].text(62), "7");
  EXPECT_EQ(all[3].text(6), "HIDDEN2");
  EXPECT_EQ(all[3].text(370), "13");
}

TEST(Dxf, LineTypesHaveTheirDashesAndGaps) {
  // The pattern is 3.75 long: dashes are positive, gaps negative.
  EXPECT_TRUE(
      has(saved(sample_page(), PageFormat::dxf),
          "2\nHIDDEN\n70\n0\n3\nDashed, in millimetres\n72\n65\n73\n2\n40\n3.75\n49\n3\n74\n0\n49\n-0.75\n74\n0\n"))
      << saved(sample_page(), PageFormat::dxf);
}

// Some readers draw line types with unknown names as solid.
TEST(Dxf, LineTypesHaveStandardNames) {
  Page page{100, 100, "", {{"6 centre lines", {}}}};
  const std::vector<std::vector<double>> patterns = {
      {6, 1, 0.1, 1}, {6.2, 1, 0.1, 1}, {3, 1, 0.1, 1}, {20, 1, 0.1, 1}, {3, 0.75}, {9, 1, 3, 1, 3, 1}, {},
      {3.1, 0.75}};
  for (const std::vector<double>& dashes : patterns) {
    page.layers[0].groups.push_back({"", {0.25, {}, dashes}});
    page.layers[0].groups.back().add(std::vector<glm::dvec2>{{1, 1}, {90, 1}}, false);
  }
  std::vector<std::string> names;
  const std::string dxf = saved(page, PageFormat::dxf);
  for (const Entity& entity : entities_of(dxf))
    if (entity.kind == "LINE") names.push_back(entity.codes.count(6) > 0 ? entity.text(6) : "BYLAYER");
  EXPECT_THAT(names, testing::ElementsAre("BYLAYER", "BYLAYER", "CENTER2", "CENTERX2", "HIDDEN", "PHANTOM",
                                          "CONTINUOUS", "HIDDEN"));
  EXPECT_TRUE(has(dxf, "\n2\n6_CENTRE_LINES\n70\n0\n62\n1\n6\nCENTER\n"));
  EXPECT_EQ(count(dxf, "0\nLTYPE\n"), 8u);  // with ByBlock and ByLayer
}

// The circle of a diameter sign is a path of two consecutive half circles that is not closed.
TEST(Dxf, AWholeTurnIsACircle) {
  Page page{100, 100, "", {{"7 dimensions", {{"", {}}}}}};
  PageGroup& sign = page.layers[0].groups[0];
  sign.points = {{60, 30}, {40, 30}, {60, 30}};
  sign.bulges = {1, 1, 0};
  for (const double direction : {1.0, -1.0}) {
    sign.bulges[0] = sign.bulges[1] = direction;
    sign.paths = {{0, 3, false}};
    const std::vector<Entity> all = entities_of(saved(page, PageFormat::dxf));
    EXPECT_EQ(all[0].kind, "CIRCLE");
    EXPECT_EQ(all[0].number(10), 50);
    EXPECT_EQ(all[0].number(40), 10);
    EXPECT_EQ(all[0].codes.count(50), 0u);
    sign.paths = {{0, 2, false}};
    EXPECT_EQ(entities_of(saved(page, PageFormat::dxf))[0].kind, "ARC");
  }
}

TEST(Dxf, BulgesTurnTheOtherWayRound) {
  Page page{100, 100, "", {}};
  PageGroup slot{"", {}};
  slot.points = {{10, 10}, {30, 10}, {30, 20}, {10, 20}};
  slot.bulges = {0, 1, 0, 1};
  slot.paths = {{0, 4, true}};
  page.layers = {{"slot \xC3\xA9 with a rather long name", {slot}}, {"", {}}, {"SLOT __ WITH A RATHER LONG", {slot}}};
  const std::string dxf = saved(page, PageFormat::dxf);
  const std::vector<Entity> all = entities_of(dxf);
  EXPECT_EQ(all[0].codes.count(42), 2u);
  EXPECT_EQ(all[0].number(42), -1);
  // The bulges follow the second and the fourth point.
  EXPECT_TRUE(has(dxf, "10\n30\n20\n90\n42\n-1\n10\n30\n20\n80\n10\n10\n20\n80\n42\n-1\n"));
  // Layers whose names would be equal are told apart.
  EXPECT_TRUE(has(dxf, "2\nSLOT_WITH_A_RATHER_LONG_NA\n"));
  EXPECT_TRUE(has(dxf, "2\nSLOT_WITH_A_RATHER_LONG\n"));
  EXPECT_TRUE(has(dxf, "2\nLAYER\n"));
}

/// A page of `count` groups with one name.
Page crowded_page(std::size_t count) {
  Page page{100, 100, "", {{"2 visible", {}}}};
  PageGroup group{"a wheel that turns about its axle", {}};
  group.add(std::vector<glm::dvec2>{{1, 1}, {2, 3}}, false);
  page.layers[0].groups.assign(count, group);
  return page;
}

TEST(Dxf, EveryObjectHasItsLayerUnlessThereAreVeryMany) {
  for (const std::size_t many : {std::size_t(3), std::size_t(999), std::size_t(1000)}) {
    const std::string dxf = saved(crowded_page(many), PageFormat::dxf);
    std::set<std::string> names;
    for (const Entity& entity : entities_of(dxf))
      if (entity.kind == "LINE") names.insert(entity.text(8));
    EXPECT_EQ(names.size(), many < 1000 ? many : 1);
    for (const std::string& name : names) {
      EXPECT_TRUE(has(dxf, "AcDbLayerTableRecord\n2\n" + name + "\n")) << name;
      EXPECT_EQ(name.rfind("2_VISIBLE", 0), 0u) << name;
      EXPECT_LE(name.size(), 31u);
    }
    EXPECT_EQ(count(dxf, "0\nLAYER\n"), names.size() + 1);  // with layer 0
  }
}

TEST(Json, HoldsThePageAsItIs) {
  const nlohmann::json json = nlohmann::json::parse(saved(sample_page(), PageFormat::json));
  EXPECT_EQ(json["unit"], "mm");
  EXPECT_EQ(json["width"], 100);
  ASSERT_EQ(json["layers"].size(), 2u);
  const nlohmann::json& dashed = json["layers"][0]["groups"][0];
  EXPECT_EQ(dashed["name"], "axle");
  EXPECT_EQ(dashed["pen"]["dashes"], nlohmann::json({3, 0.75}));
  EXPECT_EQ(dashed["paths"][0]["points"][2], nlohmann::json({20.5, 12.346}));
  const nlohmann::json& round = json["layers"][1]["groups"][1];
  EXPECT_EQ(round["paths"][0]["bulges"][0], 0.414213562);
  EXPECT_EQ(round["paths"][1]["closed"], true);
  EXPECT_FALSE(round["paths"][2].contains("bulges"));
}

TEST(Formats, NamesDoNoHarmAnywhere) {
  Page page = sample_page();
  const std::string hostile = std::string("a<b>&\"'\x01\x1b[31m\n\xff\xc3(\xed\xa0\x80 \xf0\x9f\x9a\x80 ]]>--") + '\0';
  page.title = page.layers[0].name = page.layers[1].groups[0].name = hostile;
  const std::string svg = saved(page, PageFormat::svg);
  EXPECT_EQ(count(svg, R"(a&lt;b&gt;&amp;&quot;'\x01\x1B[31m\x0A\xFF\xC3()"), 3u) << svg;
  EXPECT_EQ(svg.find('\x1b'), std::string::npos);
  EXPECT_EQ(svg.find('\0'), std::string::npos);
  EXPECT_TRUE(has(svg, "\xF0\x9F\x9A\x80"));
  const nlohmann::json json = nlohmann::json::parse(saved(page, PageFormat::json));
  EXPECT_EQ(json["title"].get<std::string>().substr(0, 7), "a<b>&\"'");
  const std::string pdf = saved(page, PageFormat::pdf);
  EXPECT_TRUE(has(pdf, "D83DDE80"));  // surrogates
  const std::string dxf = saved(page, PageFormat::dxf);
  EXPECT_EQ(dxf.find('\x1b'), std::string::npos);
  EXPECT_EQ(std::count(dxf.begin(), dxf.end(), '\n') % 2, 0);
}

}  // namespace
}  // namespace frontmost::test
