// SPDX-License-Identifier: Apache-2.0
// frontmost lines: real millimetres, aligned views, every line once, and nothing that plotters do not understand.
#include <gmock/gmock.h>

#include <cmath>
#include <map>
#include <numbers>

#include "program.h"

namespace frontmost::test {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

/// An OBJ of a box with sides x, y, z, its lower corner at the origin, with shared vertices; z is up by --up.
std::string box_obj(double x, double y, double z, const std::string& name = "box") {
  std::string text = "o " + name + "\n";
  for (int i = 0; i < 8; ++i)
    text += "v " + std::to_string(i & 1 ? x : 0) + " " + std::to_string(i & 2 ? y : 0) + " " +
            std::to_string(i & 4 ? z : 0) + "\n";
  return text + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
}

struct PathBox {
  double left = 1e9, top = 1e9, right = -1e9, bottom = -1e9;
  std::size_t paths = 0;
  void include(const json& points) {
    for (const json& p : points) {
      left = std::min(left, p[0].get<double>());
      right = std::max(right, p[0].get<double>());
      top = std::min(top, p[1].get<double>());
      bottom = std::max(bottom, p[1].get<double>());
    }
    ++paths;
  }
};

class LinesCommand : public ProgramTest {
 protected:
  LinesCommand() {
    write("box.obj", box_obj(40, 30, 20));
    write("cube.stl", cube_stl());
  }

  [[nodiscard]] json drawn(const std::string& options) const {
    succeed("lines " + options + " -o drawing.json");
    return json::parse(read("drawing.json"));
  }

  /// The box that each group covers, by the group's name.
  [[nodiscard]] static std::map<std::string, PathBox> boxes(const json& page) {
    std::map<std::string, PathBox> all;
    for (const json& layer : page["layers"])
      for (const json& group : layer["groups"])
        for (const json& path : group["paths"]) all[group["name"]].include(path["points"]);
    return all;
  }
};

TEST_F(LinesCommand, AModelBeyondAllStandardScalesStillFitsItsSheet) {
  std::string huge = box_obj(40, 30, 20);
  for (std::size_t at = 0; (at = huge.find(".000000", at)) != std::string::npos;) huge.replace(at, 7, "e20");
  write("huge.obj", huge);
  const json page = drawn("huge.obj --views front,top --page a4");
  EXPECT_EQ(page["width"], 210);
  for (const auto& [name, box] : boxes(page)) {
    EXPECT_GE(box.left, 10) << name;
    EXPECT_GE(box.top, 10) << name;
    EXPECT_LE(box.right, 200) << name;
    EXPECT_LE(box.bottom, 287) << name;
  }
}

TEST_F(LinesCommand, GltfIsInMetresHoweverItsSuffixIsWritten) {
  const std::string gltf =
      R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],)"
      R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"accessors":[{"bufferView":0,"componentType":5126,)"
      R"("count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],"bufferViews":[{"buffer":0,"byteLength":36}],"buffers":)"
      // positions (0, 0, 0), (1, 0, 0), (0, 1, 0)
      R"([{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})";
  const std::string front = " --view front --camera-orthographic --scale 1:10 --margin 0";
  for (const std::string name : {"metre.gltf", "METRE.GLTF", "metre.dat"}) {
    write(name, gltf);
    const json page = drawn(name + front);
    EXPECT_EQ(page["width"], 100) << name;
    EXPECT_EQ(page["height"], 100) << name;
  }
  // Standard input has no file name.
  const Outcome piped = run(Call{.words = {"lines", "-", "--view", "front", "--camera-orthographic", "--scale", "1:10",
                                           "--margin", "0", "--format", "json", "-o", "-"},
                                 .input = gltf});
  EXPECT_EQ(json::parse(piped.out)["width"], 100);
  write("box.dat", box_obj(40, 30, 20));
  EXPECT_EQ(drawn("box.dat --input-format obj" + front)["width"], 4);
}

TEST_F(LinesCommand, ABoxAtFullScaleHasItsSidesInMillimetres) {
  const json page = drawn("box.obj --up +z --view front --camera-orthographic --scale 1:1 --margin 5 --hidden dashed");
  EXPECT_EQ(page["width"], 50);
  EXPECT_EQ(page["height"], 30);
  // The box's back edges lie behind its front ones: one closed line, nothing hidden.
  ASSERT_EQ(page["layers"].size(), 1u);
  EXPECT_EQ(page["layers"][0]["name"], "2 visible");
  const json& path = page["layers"][0]["groups"][0]["paths"];
  ASSERT_EQ(path.size(), 1u);
  EXPECT_EQ(path[0]["closed"], true);
  ASSERT_EQ(path[0]["points"].size(), 4u);
  const PathBox box = boxes(page)["box"];
  EXPECT_EQ(box.left, 5);
  EXPECT_EQ(box.right, 45);
  EXPECT_EQ(box.top, 5);
  EXPECT_EQ(box.bottom, 25);
  succeed("lines box.obj --up +z --view front --camera-orthographic --scale 1:1 --margin 5 -o box.svg");
  EXPECT_THAT(read("box.svg"), HasSubstr("width=\"50mm\" height=\"30mm\" viewBox=\"0 0 50 30\""));
}

TEST_F(LinesCommand, ScalesAndUnits) {
  const std::string front = "cube.stl --view front --camera-orthographic --margin 0 ";
  EXPECT_EQ(drawn(front + "--scale 20:1")["width"], 20);
  EXPECT_EQ(drawn(front + "--scale 0.5 --unit m")["width"], 500);
  EXPECT_EQ(drawn(front + "--scale 1:1 --unit in")["width"], 25.4);
  EXPECT_EQ(drawn(front + "--scale 1:5 --unit cm")["height"], 2);
  const json fitted = drawn(front + "--page 100,50");
  EXPECT_EQ(boxes(fitted).begin()->second.bottom - boxes(fitted).begin()->second.top, 50);
  const json standard = succeed("lines cube.stl --view front --camera-orthographic --scale standard --json").json();
  EXPECT_EQ(standard["scale"], 100);  // for 190 mm
  EXPECT_EQ(standard["scale_text"], "100:1");
}

/// A closed tube of 36 sides about z, as OBJ.
std::string peg_obj(double radius, double height, int sides = 36) {
  std::string text = "o peg\n";
  for (const double z : {0.0, height})
    for (int i = 0; i < sides; ++i)
      text += "v " + std::to_string(radius * std::cos(i * 2 * std::numbers::pi / sides)) + " " +
              std::to_string(radius * std::sin(i * 2 * std::numbers::pi / sides)) + " " + std::to_string(z) + "\n";
  std::string foot = "f", head = "f";
  for (int i = 1; i <= sides; ++i) {
    const int next = i % sides + 1;
    text += "f " + std::to_string(i) + " " + std::to_string(next) + " " + std::to_string(sides + next) + " " +
            std::to_string(sides + i) + "\n";
    foot += " " + std::to_string(sides + 1 - i);
    head += " " + std::to_string(sides + i);
  }
  return text + foot + "\n" + head + "\n";
}

const json* layer_named(const json& page, const std::string& name) {
  for (const json& layer : page["layers"])
    if (layer["name"] == name) return &layer;
  return nullptr;
}

std::size_t path_count(const json& layer) {
  std::size_t count = 0;
  for (const json& group : layer["groups"]) count += group["paths"].size();
  return count;
}

TEST_F(LinesCommand, SheetsHaveCentreLines) {
  write("peg.obj", peg_obj(10, 40));
  const std::string sheet = "peg.obj --up +z --views front,top,iso --page a3 --scale 1:1 ";
  const json page = drawn(sheet);
  const json* const centres = layer_named(page, "6 centre lines");
  ASSERT_NE(centres, nullptr);
  EXPECT_EQ(path_count(*centres), 3u);  // an axis and a cross
  double longest = 0;
  for (const json& group : (*centres)["groups"])
    for (const json& path : group["paths"])
      longest = std::max(longest, std::abs(path["points"][0][1].get<double>() - path["points"][1][1].get<double>()));
  EXPECT_NEAR(longest, 40 + 2 * 3, 0.0011);
  EXPECT_EQ(layer_named(drawn(sheet + "--centre-lines no"), "6 centre lines"), nullptr);
  EXPECT_EQ(layer_named(drawn(sheet + "--style figure"), "6 centre lines"), nullptr);
  EXPECT_NE(layer_named(drawn(sheet + "--style figure --centre-lines yes"), "6 centre lines"), nullptr);
  const std::string single = "peg.obj --up +z --view front --camera-orthographic ";
  EXPECT_EQ(layer_named(drawn(single), "6 centre lines"), nullptr);
  EXPECT_NE(layer_named(drawn(single + "--centre-lines yes"), "6 centre lines"), nullptr);
  EXPECT_EQ(layer_named(drawn("box.obj --up +z --views front,top"), "6 centre lines"), nullptr);
  succeed("lines " + sheet + " -o peg.svg -o peg.dxf -o peg.pdf");
  EXPECT_THAT(read("peg.svg"), HasSubstr("inkscape:label=\"6 centre lines\""));
  EXPECT_THAT(read("peg.dxf"), HasSubstr("\n6_CENTRE_LINES\n70\n0\n62\n1\n6\nCENTER\n"));
  EXPECT_THAT(read("peg.pdf"), HasSubstr("<FEFF0036002000630065006E007400720065"));  // "6 centre", in UTF-16
  expect_failure("lines peg.obj -o a.svg --centre-lines yes", 2, "--centre-lines: a perspective drawing has none");
}

TEST_F(LinesCommand, SheetsHaveDimensionsWhereTheyAreAskedFor) {
  write("peg.obj", peg_obj(10, 40));
  const std::string sheet = "peg.obj --up +z --views front,top,iso --page a3 --scale 1:1 ";
  EXPECT_EQ(layer_named(drawn(sheet), "7 dimensions"), nullptr);
  const json page = drawn(sheet + "--dimensions diameters");
  const json* const sizes = layer_named(page, "7 dimensions");
  ASSERT_NE(sizes, nullptr);
  ASSERT_EQ((*sizes)["groups"].size(), 2u);
  // The height and the diameter have two extension lines, a dimension line and two arrowheads each.
  EXPECT_EQ((*sizes)["groups"][0]["paths"].size(), 10u);
  for (const json& group : (*sizes)["groups"])
    for (const json& path : group["paths"])
      for (const json& point : path["points"]) {
        EXPECT_GE(point[0].get<double>(), 5);
        EXPECT_GE(point[1].get<double>(), 5);
      }
  const json box = drawn("box.obj --up +z --views front,top,left --page a3 --scale 1:1 --dimensions diameters");
  ASSERT_NE(layer_named(box, "7 dimensions"), nullptr);
  EXPECT_EQ((*layer_named(box, "7 dimensions"))["groups"][0]["paths"].size(), 15u);
  succeed("lines " + sheet + "--dimensions diameters -o peg.dxf --plot");
  EXPECT_THAT(read("peg.dxf"), HasSubstr("7_DIMENSIONS"));
  expect_failure("lines peg.obj -o a.svg --dimensions diameters", 2, "--dimensions needs --views");
  EXPECT_EQ(succeed("lines " + sheet + "--dimensions diameters -o text.svg --json").json()["texts"], 0);
  EXPECT_EQ(succeed("lines " + sheet + "--dimensions diameters --lettering text -o text.svg --json").json()["texts"],
            2);
  EXPECT_THAT(read("text.svg"), HasSubstr(">40</text>"));
  expect_failure("lines " + sheet + "--lettering text --plot -o a.svg", 2, "--lettering: plotters have no fonts");
  // One peg hides another.
  write("core.obj", peg_obj(5, 20));
  write("pegs.json",
        R"({"up": "z", "objects": [{"model": "peg.obj"}, {"model": "core.obj", "translation": [0, 0, 9]}]})");
  const std::string pegs = "lines pegs.json --views front,top --dimensions diameters -o a.svg";
  for (const char* const hidden : {"", " --hidden dashed"})
    EXPECT_THAT(succeed(pegs + hidden).err,
                HasSubstr("warning: cylinders without a diameter, because no view along their axis shows them, "
                          "and none from the side states it: 1\n"));
  write("low.obj", peg_obj(5, 20, 12));
  EXPECT_THAT(succeed("lines low.obj --up +z --views front,top --dimensions diameters -o a.svg").err,
              HasSubstr("warning: cylinders of 7 to 17 sides count as prisms and get no diameter: 1\n"));
}

TEST_F(LinesCommand, ViewsStandInLine) {
  const std::string sheet = "box.obj --up +z --views front,top,left,right,bottom,back --page a3 --scale 1:1 ";
  for (const bool third : {false, true}) {
    const std::map<std::string, PathBox> all =
        boxes(drawn(sheet + "--projection " + (third ? "third-angle" : "first-angle")));
    ASSERT_EQ(all.size(), 6u);
    const auto of = [&](const char* view) { return all.at(std::string(view) + ": box"); };
    const PathBox front = of("front"), top = of("top"), left = of("left"), right = of("right"), bottom = of("bottom");
    const auto expect_size = [](const PathBox& box, double width, double height) {
      EXPECT_NEAR(box.right - box.left, width, 0.0011);
      EXPECT_NEAR(box.bottom - box.top, height, 0.0011);
      EXPECT_EQ(box.paths, 1u);
    };
    expect_size(front, 40, 20);
    expect_size(of("back"), 40, 20);
    expect_size(top, 40, 30);
    expect_size(bottom, 40, 30);
    expect_size(left, 30, 20);
    expect_size(right, 30, 20);
    for (const PathBox& beside : {left, right, of("back")}) {
      EXPECT_EQ(beside.top, front.top);
      EXPECT_EQ(beside.bottom, front.bottom);
    }
    for (const PathBox& in_column : {top, bottom}) {
      EXPECT_EQ(in_column.left, front.left);
      EXPECT_EQ(in_column.right, front.right);
    }
    EXPECT_EQ(top.bottom < front.top, third);
    EXPECT_EQ(bottom.bottom < front.top, !third);
    EXPECT_EQ(left.right < front.left, third);
    EXPECT_EQ(right.right < front.left, !third);
  }
}

TEST_F(LinesCommand, SheetsTakeAStandardScaleAndCentreTheirViews) {
  const json report = succeed("lines box.obj --up +z --views front,top,left,iso -o sheet.json --json").json();
  EXPECT_EQ(report["scale"], 2);
  const json page = json::parse(read("sheet.json"));
  EXPECT_EQ(page["width"], 297);  // landscape, as it fits better
  const std::map<std::string, PathBox> all = boxes(page);
  PathBox whole;
  for (const auto& [name, box] : all) {
    whole.left = std::min(whole.left, box.left);
    whole.right = std::max(whole.right, box.right);
  }
  EXPECT_NEAR(whole.left, 297 - whole.right, 0.002);
  EXPECT_EQ(all.size(), 4u);
}

TEST_F(LinesCommand, ViewsStandApartAndTheOneAtAnAngleBeyondTheCorner) {
  for (const bool third : {false, true}) {
    const auto sheet = [&](const std::string& views) {
      return boxes(drawn("box.obj --up +z --page a3-landscape --scale 1:1 --views " + views +
                         (third ? " --projection third-angle" : " --projection first-angle")));
    };
    std::map<std::string, PathBox> all = sheet("front,top,left,back");
    const PathBox front = all["front: box"], top = all["top: box"], left = all["left: box"], back = all["back: box"];
    EXPECT_NEAR(third ? front.top - top.bottom : top.top - front.bottom, 15, 0.0011);
    EXPECT_NEAR(third ? front.left - left.right : left.left - front.right, 15, 0.0011);
    // The view from behind is to the right of all others.
    EXPECT_NEAR(back.left - (third ? front.right : left.right), 15, 0.0011);
    all = sheet("front,left,iso");
    const PathBox iso = all["iso: box"];
    EXPECT_GT(iso.left, all["front: box"].right);
    EXPECT_EQ(iso.top > all["front: box"].bottom, !third);
    EXPECT_EQ(iso.bottom < all["front: box"].top, third);
  }
}

TEST_F(LinesCommand, PapersHaveTheirSizesAndLieAsAsked) {
  const std::tuple<const char*, double, double> papers[] = {
      {"a0", 841, 1189},       {"A1", 594, 841},         {"a2", 420, 594}, {"a3", 297, 420},
      {"a4", 210, 297},        {"a5", 148, 210},         {"a6", 105, 148}, {"letter", 215.9, 279.4},
      {"Legal", 215.9, 355.6}, {"tabloid", 279.4, 431.8}};
  // The drawing is twice as wide as high, so without --page it is landscape.
  const std::string front = "box.obj --up +z --view front --camera-orthographic --page ";
  for (const auto& [name, narrow, wide] : papers) {
    const json upright = drawn(front + name + "-portrait"), lying = drawn(front + name + "-landscape"),
               free = drawn(front + name);
    EXPECT_EQ(upright["width"], narrow) << name;
    EXPECT_EQ(upright["height"], wide) << name;
    EXPECT_EQ(lying["width"], wide) << name;
    EXPECT_EQ(lying["height"], narrow) << name;
    EXPECT_EQ(free["width"], wide) << name;
  }
  EXPECT_EQ(drawn(front + "120x60")["width"], 120);
}

TEST_F(LinesCommand, WhatTheCameraLeavesRoundTheModelIsLeftOnThePage) {
  const auto width_of = [&](const std::string& options) {
    const PathBox box =
        boxes(drawn("box.obj --up +z --view front --camera-orthographic --page a4 " + options)).at("box");
    return box.right - box.left;
  };
  EXPECT_NEAR(width_of(""), 277, 0.01);
  EXPECT_LT(width_of("--camera-zoom-factor 0.5"), 160);
  EXPECT_LT(width_of("--resolution 100,100"), 190);
}

TEST_F(LinesCommand, CastShadowsAreHatchedUnlessToldOtherwise) {
  // A small box stands on a large one, lit from the side.
  write(
      "step.obj", box_obj(40, 40, 10, "floor") + "o post\n" + [] {
        std::string text;
        for (int i = 0; i < 8; ++i)
          text += "v " + std::to_string(i & 1 ? 24 : 16) + " " + std::to_string(i & 2 ? 24 : 16) + " " +
                  std::to_string(i & 4 ? 30 : 10) + "\n";
        return text + "f 9 11 12 10\nf 13 14 16 15\nf 9 10 14 13\nf 11 15 16 12\nf 9 13 15 11\nf 10 12 16 14\n";
      }());
  const auto hatched = [&](const std::string& options) {
    return succeed("lines step.obj --up +z --view top --camera-orthographic --light 1,0,1.2 --hatch 1 --json" + options)
        .json()["layers"][0];
  };
  EXPECT_EQ(hatched("")["name"], "4 hatching");
  EXPECT_GT(hatched("")["drawn_mm"].get<double>(), 100);
  EXPECT_EQ(hatched(" --cast-shadows no")["name"], "2 visible");
}

TEST_F(LinesCommand, PlottersTakeHatchLinesInTheirOrder) {
  const std::string hatched = "lines builtin:cubes --hatch 2 --page a4 --json";
  const double moved = succeed(hatched).json()["moved_mm"], plotted = succeed(hatched + " --plot").json()["moved_mm"];
  EXPECT_LT(plotted, moved / 3);
}

TEST_F(LinesCommand, PlottersDrawNothingTwiceInTheInkOfTheirPen) {
  // Two plates of 0.2 mm in a pile: of the three long edges, the middle one is 0.2 mm from both others.
  std::string text;
  for (int i = 0; i < 12; ++i)
    text += "v " + std::string(i & 1 ? "40 " : "0 ") + (i & 2 ? "30 " : "0 ") + std::to_string(i / 4 * 0.2) + "\n";
  write("pile.obj", text + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\no upper\n" +
                        "f 5 7 8 6\nf 9 10 12 11\nf 5 6 10 9\nf 7 11 12 8\nf 5 9 11 7\nf 6 8 12 10\n");
  const std::string pile = "lines pile.obj --up +z --view front --camera-orthographic --scale 1:1 --plot --json ";
  const Outcome covered = succeed(pile), fine = succeed(pile + "--pen 0.38");
  EXPECT_THAT(covered.err,
              HasSubstr("warning: 1 stroke is left out, in the ink of longer strokes; a smaller --pen draws it\n"));
  EXPECT_EQ(covered.json()["views"][0]["covered_strokes"], 1);
  EXPECT_EQ(covered.json()["paths"], 1);
  EXPECT_NEAR(covered.json()["drawn_mm"].get<double>(), 2 * 40.4, 0.01);
  EXPECT_EQ(fine.err, "");
  EXPECT_EQ(fine.json()["views"][0]["covered_strokes"], 0);
  EXPECT_NEAR(fine.json()["drawn_mm"].get<double>(), 2 * 40.4 + 40, 0.01);
}

TEST_F(LinesCommand, HatchLinesAreAsLongAsStrokes) {
  const std::string hatched = "lines builtin:teapot --hatch 2 --page a4 --cast-shadows no --quiet -o hatched.json";
  const auto shortest = [&](const std::string& options) {
    succeed(hatched + options);
    double least = 1e9;
    const json page = json::parse(read("hatched.json"));
    for (const json& layer : page["layers"])
      if (layer["name"] == "4 hatching")
        for (const json& group : layer["groups"])
          for (const json& path : group["paths"]) {
            const json& points = path["points"];
            least = std::min(least, std::hypot(points[0][0].get<double>() - points[1][0].get<double>(),
                                               points[0][1].get<double>() - points[1][1].get<double>()));
          }
    return least;
  };
  EXPECT_LT(shortest(""), 0.5);
  EXPECT_GE(shortest(" --plot"), 0.499);
  EXPECT_GE(shortest(" --shortest-stroke 1"), 0.999);
  EXPECT_LT(shortest(" --plot --shortest-stroke 0"), 0.5);
}

TEST_F(LinesCommand, HiddenEdgesAsAsked) {
  const std::string iso = "lines cube.stl --view iso --camera-orthographic -o drawing.svg --hidden ";
  succeed(iso + "none");
  EXPECT_THAT(read("drawing.svg"), Not(HasSubstr("hidden")));
  succeed(iso + "dashed");
  const std::string dashed = read("drawing.svg");
  EXPECT_THAT(dashed, HasSubstr("stroke-width=\".25\" stroke-linecap=\"round\" stroke-linejoin=\"round\" "
                                "stroke-dasharray=\"3 .75\""));
  EXPECT_THAT(dashed, HasSubstr("stroke-width=\".5\""));
  EXPECT_LT(dashed.find("inkscape:label=\"1 hidden\""), dashed.find("inkscape:label=\"2 visible\""));
  succeed(iso + "thin");
  EXPECT_THAT(read("drawing.svg"), HasSubstr("stroke-width=\".13\""));
  EXPECT_THAT(read("drawing.svg"), Not(HasSubstr("dash")));
  for (const char* const absent : {"clip", "mask", "#ffffff", "rect"}) EXPECT_THAT(dashed, Not(HasSubstr(absent)));
}

TEST_F(LinesCommand, HatchingIsInMillimetresAndLiesBelow) {
  const json page = drawn(
      "cube.stl --view iso --camera-orthographic --scale 50:1 --hatch 2 --hatch-angle 0 --light 1,1,3 --cast-shadows "
      "no");
  ASSERT_EQ(page["layers"].size(), 2u);
  EXPECT_EQ(page["layers"][0]["name"], "4 hatching");
  EXPECT_EQ(page["layers"][1]["name"], "2 visible");
  // Brightnesses are 0.77 on top, 0.61 right, 0.19 left: level lines every second millimetre, and every millimetre.
  std::map<double, int> heights;
  for (const json& path : page["layers"][0]["groups"][0]["paths"]) {
    ASSERT_EQ(path["points"].size(), 2u);
    EXPECT_EQ(path["points"][0][1], path["points"][1][1]);
    ++heights[path["points"][0][1].get<double>()];
  }
  ASSERT_GT(heights.size(), 20u);
  const double first = heights.begin()->first;
  for (const auto& [height, count] : heights) EXPECT_NEAR(std::remainder(height - first, 1), 0, 0.0011);
  succeed("lines cube.stl --view iso --camera-orthographic --hatch 2 --plot --hidden dashed -o drawing.svg");
  EXPECT_THAT(read("drawing.svg"), HasSubstr("inkscape:label=\"4 hatching\""));
  for (const char* const needs : {"--light 1,1,1", "--hatch-angle 3", "--cast-shadows no"})
    expect_failure(std::string("lines cube.stl -o a.svg ") + needs, 2, "needs --hatch");
  expect_failure("lines cube.stl -o a.svg --hatch-angle 3 --stipple 1", 2, "needs --hatch");
  expect_failure("lines cube.stl -o a.svg --hatch 0.1", 2, "--hatch");
  expect_failure("lines cube.stl -o a.svg --hatch 1 --light 0,0,0", 2,
                 "--light: the direction of the light must not be 0,0,0");
  expect_failure("lines cube.stl -o a.svg --hatch 1 --cast-shadows maybe", 2, "--cast-shadows");
  expect_failure("lines cube.stl -o a.svg --hatch 1 --resolution 20,20", 2, "take 9.5 or more");
  expect_failure("lines cube.stl -o a.svg --views front --hatch 0.3 --scale 20000:1", 2,
                 "take 10.3 or more, or a smaller page or scale");
}

TEST_F(LinesCommand, StippledOnlyWhereAskedFor) {
  const std::string iso = "lines cube.stl --view iso --camera-orthographic --style figure --light 1,1,3 ";
  const json report =
      succeed(iso + "--stipple 0.8 --plot -o dots.svg -o dots.pdf -o dots.json -o dots.dxf --json").json();
  EXPECT_EQ(report["layers"][0]["name"], "5 stippling");
  const json page = json::parse(read("dots.json"));
  const json& dots = page["layers"][0]["groups"][0]["paths"];
  EXPECT_EQ(dots.size(), report["layers"][0]["paths"].get<std::size_t>());
  ASSERT_GT(dots.size(), 1000u);
  for (const json& dot : dots) EXPECT_EQ(dot["points"].size(), 1u);
  EXPECT_THAT(read("dots.svg"), HasSubstr("stroke-width=\".25\""));
  EXPECT_THAT(read("dots.dxf"), HasSubstr("\nPOINT\n"));
  succeed("lines cube.stl --style figure -o none.svg");
  EXPECT_THAT(read("none.svg"), Not(HasSubstr("stippling")));
  expect_failure("lines cube.stl -o a.svg --stipple 20", 2, "--stipple");
  expect_failure("lines cube.stl -o a.svg --stipple 1 --resolution 20,20", 2, "take 9.5 or more");
  // 20 million dots would fit, but not one pixel for each.
  expect_failure("lines cube.stl -o a.svg --stipple 0.2 --resolution 16384,16384 --page 2000,2000", 2,
                 "--stipple: 0.2 mm would");
  expect_failure("lines cube.stl -o a.svg -o a.svg", 2, "a.svg: would be written twice; give every output a name");
}

TEST_F(LinesCommand, PlottersGetDashesAsLines) {
  const std::string iso = "lines cube.stl --view iso --camera-orthographic --hidden dashed --plot --scale 50:1 -o ";
  succeed(iso + "plot.svg -o plot.json -o plot.dxf");
  EXPECT_THAT(read("plot.svg"), Not(HasSubstr("dasharray")));
  const json page = json::parse(read("plot.json"));
  EXPECT_EQ(page["layers"][0]["name"], "1 hidden");
  const json& group = page["layers"][0]["groups"][0];
  EXPECT_FALSE(group["pen"].contains("dashes") && !group["pen"]["dashes"].empty());
  // Three edges of 40.82 mm meet at the hidden vertex: eleven dashes each, where those at the vertex may be one.
  EXPECT_GE(group["paths"].size(), 31u);
  EXPECT_LE(group["paths"].size(), 33u);
  // DXF readers know line types.
  EXPECT_THAT(read("plot.dxf"), HasSubstr("\nHIDDEN\n"));
}

TEST_F(LinesCommand, EachEdgeOfACubeOnce) {
  const json report =
      succeed("lines cube.stl --view iso --camera-orthographic --hidden dashed --page a4 --scale 50:1 --json").json();
  EXPECT_EQ(report["views"][0]["edges"], 12);
  // Isometric edges have the square root of two thirds of their length. Hidden ones end at the vertex in front of them.
  const double edge = 50 * std::sqrt(2.0 / 3);
  EXPECT_NEAR(report["layers"][1]["drawn_mm"].get<double>(), 9 * edge, 0.01);
  EXPECT_NEAR(report["layers"][0]["drawn_mm"].get<double>(), 3 * edge, 0.01);
  const json plot =
      succeed("lines cube.stl --view iso --camera-orthographic --page a4 --scale 50:1 --plot --json").json();
  EXPECT_NEAR(plot["drawn_mm"].get<double>(), 9 * edge, 0.01);
  EXPECT_LT(plot["paths"].get<int>(), report["layers"][1]["paths"].get<int>());
}

TEST_F(LinesCommand, ThePicturesFrameIsThePageWhereTheCameraIsPlaced) {
  const json page = drawn("cube.stl --camera-position 0.5,-4,0.5 --resolution 200,100 --page 200,100 --margin 0");
  // The cube is straight ahead, the view 30 degrees high; the near face is 1 wide at a distance of 4.
  const double half = 50 * 0.5 / (4 * std::tan(0.26179938779914943));
  const PathBox box = boxes(page).begin()->second;
  EXPECT_NEAR(box.left, 100 - half, 0.01);
  EXPECT_NEAR(box.right, 100 + half, 0.01);
  EXPECT_NEAR(box.top, 50 - half, 0.01);
}

// Two edges of 1 m and one of the square root of 2 m, before a camera whose picture is 3 m high.
TEST_F(LinesCommand, AModelsOwnParallelCameraHasAScale) {
  write("own.gltf", R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0,1]}],
    "nodes":[{"mesh":0},{"camera":0,"translation":[0.5,0.5,9]}],
    "cameras":[{"type":"orthographic","orthographic":{"xmag":2,"ymag":1.5,"znear":1,"zfar":20}}],
    "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
    "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],
    "bufferViews":[{"buffer":0,"byteLength":36}],
    "buffers":[{"byteLength":36,"uri":"data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]})");
  const json fitted = succeed("lines own.gltf --camera-index 0 --resolution 400,300 --json -o a.svg").json();
  // The picture of 3 m fits between the margins of a landscape A4.
  EXPECT_NEAR(fitted["scale"].get<double>(), 190.0 / 3000, 1e-9);
  const json given =
      succeed("lines own.gltf --camera-index 0 --resolution 400,300 --scale 1:50 --json -o b.svg").json();
  EXPECT_EQ(given["scale_text"], "1:50");
  EXPECT_NEAR(given["page_mm"][0].get<double>(), 4000.0 / 50 + 20, 1e-6);
  EXPECT_NEAR(given["page_mm"][1].get<double>(), 3000.0 / 50 + 20, 1e-6);
  EXPECT_NEAR(given["layers"][0]["drawn_mm"].get<double>(), (2 + std::sqrt(2.0)) * 1000 / 50, 1e-3);
  const Outcome refused = run({"lines", "cube.stl", "--scale", "1:50", "-o", "c.svg"});
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.err, HasSubstr("a perspective drawing has no scale"));
}

TEST_F(LinesCommand, CurvedModelsAreDrawnFromWithin) {
  const json page = drawn("builtin:teapot --camera-position 0,1.5,0 --camera-direction +x");
  EXPECT_FALSE(boxes(page).empty());
  // A tessellation error that the user sets is not coarsened.
  const Outcome refused = run({"lines", "builtin:teapot", "--camera-position", "0,1.5,0", "--camera-direction", "+x",
                               "--tessellation-error", "0.001", "-o", "refused.svg"});
  EXPECT_EQ(refused.status, 1);
  EXPECT_THAT(refused.err, HasSubstr("this tessellation error needs more than"));
}

TEST_F(LinesCommand, TheSameBytesForAnyNumberOfThreads) {
  const std::string drawing = "lines builtin:teapot --plot --hidden dashed --threads ";
  succeed(drawing + "1 -o a.svg -o a.pdf -o a.dxf -o a.json");
  succeed(drawing + "3 -o b.svg -o b.pdf -o b.dxf -o b.json");
  for (const std::string format : {"svg", "pdf", "dxf", "json"}) {
    EXPECT_EQ(read("a." + format), read("b." + format));
    succeed("lines cube.stl --plot --format " + format + " -o -");
  }
}

TEST_F(LinesCommand, PensAndTheirDashesGoTogether) {
  succeed("lines cube.stl --view iso --camera-orthographic --hidden dashed --pen 1 -o drawing.svg");
  EXPECT_THAT(read("drawing.svg"), HasSubstr("stroke-width=\".5\" stroke-linecap=\"round\" stroke-linejoin=\"round\" "
                                             "stroke-dasharray=\"6 1.5\""));
  EXPECT_THAT(read("drawing.svg"), HasSubstr("stroke-width=\"1\""));
  succeed("lines cube.stl --view iso --camera-orthographic --hatch 2 --stipple 2 --pen 1 -o drawing.svg");
  EXPECT_NE(
      read("drawing.svg").find("5 stippling\">\n<g inkscape:label=\"cube\" stroke=\"#000000\" stroke-width=\".6\""),
      std::string::npos);
  expect_failure("lines cube.stl --pen 0 -o drawing.svg", 2, "--pen");
}

TEST_F(LinesCommand, CurvedModelsAreCutAsFinelyAsPaperShows) {
  const json fine = succeed("lines builtin:teapot --json").json(),
             coarse = succeed("lines builtin:teapot --tessellation-error 50 --json").json();
  EXPECT_GT(fine["views"][0]["parts"].get<int>(), 3 * coarse["views"][0]["parts"].get<int>());
}

TEST_F(LinesCommand, NamesOfObjectsDoNoHarm) {
  write("odd.obj", box_obj(1, 1, 1, "<a>&\"\x01\xff]]>"));
  succeed("lines odd.obj -o odd.svg");
  EXPECT_THAT(read("odd.svg"), HasSubstr("&lt;a&gt;&amp;&quot;"));
  EXPECT_THAT(read("odd.svg"), Not(HasSubstr("\x01")));
}

TEST_F(LinesCommand, AnEmptyDrawingIsAFileWithAWarning) {
  const Outcome outcome =
      run({"lines", "cube.stl", "--camera-position", "0,-5,0", "--camera-direction", "-y", "-o", "a.svg"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.err, HasSubstr("nothing of the model is in view"));
  EXPECT_THAT(read("a.svg"), HasSubstr("</svg>"));
}

TEST_F(LinesCommand, FormatIsOfTheFileWithoutASuffix) {
  const std::string drawn = succeed("lines cube.stl -o b.svg -o - --format dxf").out;
  EXPECT_THAT(read("b.svg"), HasSubstr("</svg>"));
  EXPECT_THAT(drawn, HasSubstr("AC1015"));
}

TEST_F(LinesCommand, WhatCannotBeMeantIsRefused) {
  expect_failure("lines cube.stl", 2, "nothing to do");
  expect_failure("lines cube.stl -o a.png", 2, "names no format");
  expect_failure("lines cube.stl -o -", 2, "needs --format");
  expect_failure("lines cube.stl -o a.svg --scale 1:5", 2, "--camera-orthographic");
  expect_failure("lines cube.stl -o a.svg --camera-orthographic --scale 1:0", 2, "--scale");
  expect_failure("lines cube.stl -o a.svg --camera-orthographic --scale big", 2, "--scale: 'big'");
  expect_failure("lines cube.stl -o a.svg --page a9", 2, "--page: 'a9' is no paper");
  expect_failure("lines cube.stl -o a.svg --page 10,0", 2, "--page");
  expect_failure("lines cube.stl -o a.svg --page fit", 2, "needs a scale");
  expect_failure("lines cube.stl -o a.svg --margin 200", 2,
                 "--margin: 200 mm at each side leave nothing of a page of 210 x 297 mm");
  expect_failure("lines cube.stl -o a.svg --views front,top,left --page 25,25 --margin 5", 2, "--page: 25 x 25 mm");
  expect_failure("lines cube.stl -o a.svg --format dxf", 2, "a.svg: --format differs from the suffix");
  expect_failure("lines cube.stl -o a.svg --views front,front", 2, "'front' is there twice");
  expect_failure("lines cube.stl -o a.svg --views front,up", 2, "--views: 'up'");
  expect_failure("lines cube.stl -o a.svg --views front --view top", 2, "exclude each other");
  expect_failure("lines cube.stl -o a.svg --projection third-angle", 2, "needs --views");
  expect_failure("lines cube.stl -o a.svg --crease-angle 181", 2, "--crease-angle");
  expect_failure("lines cube.stl -o a.svg --shortest-stroke 11", 2, "--shortest-stroke");
  expect_failure("lines cube.stl -o a.svg --hidden dotted", 2, "--hidden");
  expect_failure("lines cube.stl -o - --format svg --json", 2, "both write to standard output");
  expect_failure("lines cube.stl -o a.svg --samples 4", 2, "is not an option of");
  EXPECT_THAT(files(), ElementsAre("box.obj", "cube.stl"));
}

TEST_F(LinesCommand, TooLargeADrawingSaysWhatWouldFit) {
  expect_failure("lines box.obj --camera-orthographic --view front --scale 50:1 --page a4 -o a.svg", 2,
                 "; 5:1 would fit");
  expect_failure("lines box.obj --camera-orthographic --view front --scale 1000000:1 -o a.svg", 2, "100 m a side");
  // Tiny and huge scales are possible.
  succeed("lines box.obj --camera-orthographic --view front --scale 1:1000000 -o a.svg");
  succeed("lines box.obj --camera-orthographic --view front --scale 2000:1 -o a.pdf");
  EXPECT_THAT(read("a.pdf"), HasSubstr("/UserUnit 16"));
}

TEST_F(LinesCommand, StopsWhenItsTimeIsOver) {
  const Outcome outcome = run({"lines", "builtin:city", "--timeout", "0.001", "-o", "a.svg"});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_FALSE(exists("a.svg"));
}

}  // namespace
}  // namespace frontmost::test
