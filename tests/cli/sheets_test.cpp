// SPDX-License-Identifier: Apache-2.0
// Sheets of frontmost lines: on every paper, frame, title block and views do not overlap.
#include <gmock/gmock.h>

#include <map>

#include "cli/failure.h"
#include "program.h"
#include "support/lettering_shapes.h"

namespace frontmost::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

/// A box with a pit in its top: it has hidden edges in every view except from above.
std::string pitted_box_obj(double size = 1) {
  std::string text = "o box\n";
  const auto corners = [&](double low_x, double low_y, double low_z, double high_x, double high_y, double high_z) {
    for (int i = 0; i < 8; ++i)
      text += "v " + std::to_string(size * (i & 1 ? high_x : low_x)) + " " +
              std::to_string(size * (i & 2 ? high_y : low_y)) + " " + std::to_string(size * (i & 4 ? high_z : low_z)) +
              "\n";
  };
  corners(0, 0, 0, 40, 30, 20);
  corners(10, 10, 5, 30, 20, 20);
  text += "f 1 3 4 2\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";  // the top is left out
  text += "f 5 6 14 13\nf 6 8 16 14\nf 8 7 15 16\nf 7 5 13 15\n";     // the top is a ring around the pit
  return text + "f 9 10 12 11\nf 9 13 14 10\nf 11 12 16 15\nf 9 11 15 13\nf 10 14 16 12\n";
}

struct ViewBox {
  glm::dvec2 low{1e9}, high{-1e9};
};

class SheetsCommand : public ProgramTest {
 protected:
  SheetsCommand() { write("box.obj", pitted_box_obj()); }

  [[nodiscard]] json drawn(const std::string& options) const {
    succeed("lines " + options + " -o drawing.json");
    return json::parse(read("drawing.json"));
  }

  [[nodiscard]] static std::vector<glm::dvec2> points_of(const json& page, const std::string& layer) {
    std::vector<glm::dvec2> points;
    for (const json& one : page["layers"])
      if (one["name"] == layer)
        for (const json& group : one["groups"])
          for (const json& path : group["paths"])
            for (const json& p : path["points"]) points.emplace_back(p[0].get<double>(), p[1].get<double>());
    return points;
  }

  [[nodiscard]] static bool says(const json& page, const std::string& text, double height) {
    return holds_text(points_of(page, "8 frame"), text, height);
  }

  /// The box that each view covers, over all layers but the frame's.
  [[nodiscard]] static std::map<std::string, ViewBox> views_of(const json& page) {
    std::map<std::string, ViewBox> views;
    for (const json& layer : page["layers"])
      for (const json& group : layer["groups"]) {
        if (layer["name"] == "8 frame") continue;
        const auto name = group["name"].get<std::string>();
        ViewBox& box = views[name.substr(0, name.find(':'))];
        for (const json& path : group["paths"])
          for (const json& p : path["points"]) {
            const glm::dvec2 point(p[0].get<double>(), p[1].get<double>());
            box.low = glm::min(box.low, point);
            box.high = glm::max(box.high, point);
          }
      }
    return views;
  }

  /// Names of the groups of hidden lines.
  [[nodiscard]] static std::vector<std::string> hidden_in(const json& page) {
    std::vector<std::string> names;
    for (const json& layer : page["layers"])
      for (const json& group : layer["groups"])
        if (layer["name"] == "1 hidden") names.push_back(group["name"]);
    return names;
  }
};

TEST_F(SheetsCommand, TheViewAtAnAngleHasHiddenLinesOnlyWhereAskedFor) {
  const std::string sheet = "box.obj --up +z --views front,top,iso --hidden dashed";
  EXPECT_THAT(hidden_in(drawn(sheet)), testing::ElementsAre("front: box"));
  EXPECT_THAT(hidden_in(drawn(sheet + " --hidden-views iso")), testing::ElementsAre("iso: box"));
  EXPECT_THAT(hidden_in(drawn(sheet + " --hidden-views front,iso")), testing::ElementsAre("front: box", "iso: box"));
  // A drawing that is no sheet shows hidden lines as requested.
  EXPECT_FALSE(hidden_in(drawn("box.obj --up +z --view iso --camera-orthographic --hidden dashed")).empty());
  expect_failure("lines box.obj --views front --hidden-views front -o a.svg", 2, "--hidden-views: needs hidden lines");
  expect_failure("lines box.obj --hidden dashed --hidden-views front -o a.svg", 2, "needs --views");
  expect_failure("lines box.obj --views front --hidden dashed --hidden-views top -o a.svg", 2,
                 "--hidden-views: top is not among the views");
}

TEST_F(SheetsCommand, FrameBlockAndViewsKeepClearOnEveryPaper) {
  const char* const sets[] = {"front",
                              "front,top",
                              "front,top,left",
                              "front,top,left,iso",
                              "front,top,left,right,bottom",
                              "front,top,left,right,bottom,back"};
  for (const std::string paper : {"a4", "a3", "a2", "a1", "a0"})
    for (const std::string lie : {"-portrait", "-landscape"})
      for (const std::string set : sets) {
        const bool third = (paper[1] + set.size()) % 2 == 1;
        const json page = drawn("box.obj --up +z --hidden dashed --frame --views " + set + " --page " + paper + lie +
                                " --projection " + (third ? "third-angle" : "first-angle"));
        const glm::dvec2 size(page["width"].get<double>(), page["height"].get<double>());
        const glm::dvec2 block = size - glm::dvec2(190, 46);
        const std::string name = paper + lie + " " + set;
        EXPECT_EQ(lie == "-portrait", size.x < size.y) << name;
        EXPECT_FALSE(points_of(page, "8 frame").empty()) << name;
        const std::map<std::string, ViewBox> views = views_of(page);
        EXPECT_EQ(views.size(), std::size_t(std::count(set.begin(), set.end(), ',')) + 1) << name;
        for (auto view = views.begin(); view != views.end(); ++view) {
          const ViewBox& box = view->second;
          EXPECT_GE(box.low.x, 30 - 0.001) << name;
          EXPECT_GE(box.low.y, 20 - 0.001) << name;
          EXPECT_LE(box.high.x, size.x - 20 + 0.001) << name;
          EXPECT_LE(box.high.y, size.y - 20 + 0.001) << name;
          EXPECT_FALSE(box.high.x > block.x - 10 + 0.001 && box.high.y > block.y - 10 + 0.001) << name << view->first;
          for (auto other = std::next(view); other != views.end(); ++other) {
            const glm::dvec2 apart = glm::max(other->second.low - box.high, box.low - other->second.high);
            EXPECT_GE(std::max(apart.x, apart.y), 15 - 0.002) << name << ' ' << view->first << ' ' << other->first;
          }
        }
        EXPECT_TRUE(says(page, third ? "A" : "B", 3.5)) << name;
      }
}

TEST_F(SheetsCommand, TheTitleBlockSaysWhatItIsTold) {
  const std::string sheet =
      "box.obj --up +z --views front,top,left --page a3 --number B-17 --author Erika "
      "--date 2026-03-01 --owner Works";
  const json page = drawn(sheet + " --title Bracket");
  EXPECT_EQ(page["title"], "Bracket");
  EXPECT_TRUE(says(page, "Bracket", 5));
  EXPECT_TRUE(says(page, "B-17", 5));
  EXPECT_TRUE(says(page, "Works", 3.5));
  for (const char* const text : {"Erika", "2026-03-01", "2:1", "mm", "A3", "1/1"})
    EXPECT_TRUE(says(page, text, 2.5)) << text;
  EXPECT_TRUE(says(drawn(sheet), "box", 5));  // the model's name
  EXPECT_TRUE(says(drawn(sheet + " --unit in --scale 1:20"), "in", 2.5));
  // Files hold no time and no path: the same bytes every time.
  succeed("lines " + sheet + " -o first.pdf -o first.svg -o first.dxf");
  succeed("lines " + sheet + " -o second.pdf -o second.svg -o second.dxf --threads 3");
  for (const std::string suffix : {".pdf", ".svg", ".dxf"}) EXPECT_EQ(read("first" + suffix), read("second" + suffix));
  EXPECT_THAT(read("first.dxf"), HasSubstr("\n8_FRAME-TITLE_BLOCK\n"));
  EXPECT_EQ(points_of(drawn("box.obj --up +z --views front,top"), "8 frame").size(), 0u);
  EXPECT_TRUE(says(drawn("box.obj --frame"), "\xE2\x80\x93", 2.5));  // a perspective view has no scale
}

TEST_F(SheetsCommand, AFrameAsksForAPageWithRoom) {
  expect_failure("lines box.obj --frame --views front --page a5-portrait -o a.svg", 2,
                 "--page: 148 x 210 mm have no room for a frame and its title block, which need 210 x 100");
  succeed("lines box.obj --frame --views front --page a5 -o a.svg");  // landscape
  expect_failure("lines box.obj --frame --views front --page fit --scale 1:1 -o a.svg", 2, "--page: a frame needs");
  expect_failure("lines box.obj --frame --views front --margin 90 -o a.svg", 2, "--margin: 90 mm at each side leave");
  expect_failure("lines box.obj --views front --title " + std::string(81, 'x') + " -o a.svg", 2,
                 "--title: the text has 81 characters; at most 80 fit");
  expect_failure("lines box.obj --up +z --views front --frame --scale 50:1 --page a4 -o a.svg", 2,
                 "; 5:1 would fit, or take a larger page\n");
}

TEST_F(SheetsCommand, AScaleOfNumbersTakesTheSmallestPaper) {
  const auto paper_at = [&](const std::string& scale) {
    const json page = drawn("box.obj --up +z --views front,top,left --title Box --scale " + scale);
    return std::min(page["width"].get<double>(), page["height"].get<double>());
  };
  EXPECT_EQ(paper_at("1:1"), 210);
  EXPECT_EQ(paper_at("3:1"), 297);
  EXPECT_EQ(paper_at("5:1"), 420);
  EXPECT_EQ(paper_at("10:1"), 594);
  EXPECT_EQ(paper_at("15:1"), 841);
  expect_failure("lines box.obj --views front,top --title Box --scale 100:1 -o a.svg", 2, "would fit");
}

TEST_F(SheetsCommand, SeveralModelsAreSheetsWithNumbers) {
  write("second.obj", pitted_box_obj(2));
  write("third.obj", pitted_box_obj(3));
  const std::string sheets = "lines box.obj second.obj third.obj --views front,top --title Boxes --page a4";
  const json report = succeed(sheets + " -o {model}.json --json").json();
  ASSERT_EQ(report["sheets"].size(), 3u);
  EXPECT_EQ(report["sheets"][1]["model"], "second.obj");
  int number = 0;
  for (const std::string model : {"box", "second", "third"}) {
    const json page = json::parse(read(model + ".json"));
    EXPECT_TRUE(says(page, std::to_string(++number) + "/3", 2.5)) << model;
    EXPECT_EQ(views_of(page).size(), 2u);
  }
  expect_failure(sheets + " -o all.svg", 2,
                 "-o all.svg: every model has a sheet of its own; put {model} into the name");
  expect_failure("lines box.obj box.obj --frame -o {model}.pdf", 2, "would be written twice");
  EXPECT_FALSE(exists("all.svg"));
  succeed("lines box.obj -o {model}_{view}.svg");
  EXPECT_TRUE(exists("box_three-quarter.svg"));
}

TEST_F(SheetsCommand, SeveralModelsArePagesOfOnePdf) {
  write("second.obj", pitted_box_obj(2));
  const std::string sheets = "lines box.obj second.obj --up +z --views front,top --title Boxes --page a4";
  const json report = succeed(sheets + " -o {view}s.pdf -o {model}.pdf --json").json();
  EXPECT_EQ(report["outputs"], json({"sheets.pdf"}));
  EXPECT_EQ(report["sheets"][1]["outputs"], json({"second.pdf"}));
  const std::string pdf = read("sheets.pdf");
  EXPECT_THAT(pdf, HasSubstr("/Count 2 >>"));
  // In a joint PDF, a page has the bytes of its model's own file, except for object numbers.
  for (const std::string model : {"box", "second"}) {
    const std::string alone = read(model + ".pdf");
    const std::size_t begin = alone.find("stream\n"), end = alone.find("\nendstream");
    EXPECT_THAT(pdf, HasSubstr(alone.substr(begin, end - begin))) << model;
  }
  // Several models share a file if the name has no {model}; likewise on standard output.
  EXPECT_THAT(succeed("lines box.obj second.obj -o - --format pdf").out, HasSubstr("/Count 2 >>"));
  expect_failure("lines box.obj second.obj -o - --format svg", 2, "write a .pdf");
  expect_failure("lines box.obj second.obj -o box.pdf -o {model}.pdf", 2, "would be written twice");
  expect_failure("lines box.obj missing.obj -o none.pdf", 1, "missing.obj");
  EXPECT_FALSE(exists("none.pdf"));
}

TEST_F(SheetsCommand, DxfLayersAreNamedByTheFileAndNotByTheHeaderOfAnStl) {
  std::string stl = cube_stl();
  const std::string header = "exported by Some Program 4.1 on Tuesday";
  stl.replace(0, header.size(), header);
  write("knob.stl", stl);
  succeed("lines knob.stl --view front --camera-orthographic -o knob.dxf -o knob.svg");
  EXPECT_THAT(read("knob.dxf"), HasSubstr("\n2_VISIBLE-KNOB\n"));
  EXPECT_THAT(read("knob.dxf"), Not(HasSubstr("EXPORTED")));
  EXPECT_THAT(read("knob.svg"), HasSubstr("inkscape:label=\"knob\""));
}

TEST_F(SheetsCommand, WhatTheFilesNumbersAreIsNotWhatTheSheetStates) {
  const auto placed = [](const std::string& metres) {
    return R"({"up": "z", "metres_per_unit": )" + metres + R"(, "objects": [{"model": "box.obj"}]})";
  };
  write("metres.json", placed("1"));
  write("inches.json", placed("0.0254"));
  write("fractions.json", placed("0.001190625"));  // 3/64 inches
  struct Case {
    const char *options, *unit, *width;  // for a box that is 40 wide
    bool overrules = false;
  };
  const Case cases[] = {{"box.obj", "mm", "40"},
                        {"box.obj --dimension-unit in", "in", "1.575"},
                        {"box.obj --dimension-unit in-fractions", "in", "1.575"},
                        {"box.obj --unit in --dimension-unit in-fractions", "in", "40"},
                        {"fractions.json --dimension-unit in-fractions", "in", "1 7/8"},
                        {"box.obj --unit in", "in", "40"},
                        {"box.obj --unit in --dimension-unit mm", "mm", "1016"},
                        {"metres.json", "mm", "40000"},
                        {"metres.json --dimension-unit in", "in", "1574.803"},
                        {"metres.json --unit m", "mm", "40000"},
                        {"metres.json --unit mm", "mm", "40", true},
                        {"inches.json", "in", "40"},
                        {"inches.json --unit in --dimension-unit mm", "mm", "1016"},
                        {"inches.json --unit mm", "mm", "40", true}};
  for (const Case& c : cases) {
    const std::string said = succeed(std::string("lines ") + c.options +
                                     " --up +z --views front --dimensions diameters --frame -o drawing.json")
                                 .err;
    const json page = json::parse(read("drawing.json"));
    EXPECT_TRUE(says(page, c.unit, 2.5)) << c.options;
    EXPECT_TRUE(holds_text(points_of(page, "7 dimensions"), c.width, 3.5)) << c.options;
    if (c.overrules)
      EXPECT_THAT(said, HasSubstr("warning: --unit overrides the unit of the file, ")) << c.options;
    else
      EXPECT_EQ(said, "") << c.options;
  }
}

TEST_F(SheetsCommand, AnAbsurdScaleNamesTheUnitsThatWouldMakeSense) {
  write("metres.obj", pitted_box_obj(0.001));
  const std::string sheet = "lines metres.obj --up +z --views front,top,left ";
  EXPECT_THAT(
      succeed(sheet + "-o a.svg").err,
      HasSubstr("warning: the scale is 2000:1: the file says no unit, and millimetres were taken; --unit m (2:1) "
                "would make sense"));
  for (const char* const quiet : {"--unit m", "--unit mm", "--scale 1000:1 --page a0", "--scale fit --quiet"})
    EXPECT_EQ(succeed(sheet + quiet + " -o a.svg").err, "") << quiet;
  write("inches.obj", pitted_box_obj(1 / 25.4));
  EXPECT_THAT(
      succeed("lines inches.obj --up +z --frame --view front --camera-orthographic --scale standard -o a.svg").err,
      HasSubstr("--unit cm (10:1) or --unit m (1:10) or --unit in (2:1) would make sense"));
  // A model of nearly one unit is taken for metres, as `info` does.
  write("guess.obj", pitted_box_obj(0.0155));
  EXPECT_EQ(succeed("info guess.obj --json").json()["unit"]["name"], "metre");
  const std::string hint = succeed("lines guess.obj --up +z --views front,top,left -o a.svg").err;
  EXPECT_THAT(hint, testing::AllOf(HasSubstr("--unit m (1:5) would make sense"), Not(HasSubstr("--unit in"))));
  EXPECT_EQ(succeed("lines box.obj --up +z --views front,top,left -o a.svg").err, "");
  // A single drawing is as large as its page, at any scale, and gets no hint.
  EXPECT_EQ(succeed("lines metres.obj --view top --camera-orthographic -o a.svg").err, "");
}

}  // namespace
}  // namespace frontmost::test
