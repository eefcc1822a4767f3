// SPDX-License-Identifier: Apache-2.0
// frontmost lines --sections: cut views on sheets.
#include <gmock/gmock.h>

#include <map>

#include "program.h"
#include "support/lettering_shapes.h"

namespace frontmost::test {
namespace {

using nlohmann::json;

/// An OBJ of a box of 40 x 30 x 20 with its lower corner at (x, 0, 0).
std::string box_obj(const std::string& name, double x, int first) {
  std::string text = "o " + name + "\n";
  for (int i = 0; i < 8; ++i)
    text += "v " + std::to_string(x + (i & 1 ? 40 : 0)) + " " + std::to_string(i & 2 ? 30 : 0) + " " +
            std::to_string(i & 4 ? 20 : 0) + "\n";
  for (const char* const face : {"1342", "5687", "1265", "3784", "1573", "2486"}) {
    text += "f";
    for (const char* c = face; *c != 0; ++c) text += " " + std::to_string(*c - '1' + first);
    text += "\n";
  }
  return text;
}

class SectionsCommand : public ProgramTest {
 protected:
  SectionsCommand() {
    write("box.obj", box_obj("box", 0, 1));
    write("two.obj", box_obj("left", 0, 1) + box_obj("right", 40, 9));
    write("open.obj", "v 0 0 0\nv 4 0 0\nv 0 0 4\nf 1 2 3\n");
  }

  struct Bounds {
    glm::dvec2 low{1e9}, high{-1e9};
  };
  struct Sheet {
    json page, report;

    /// Bounds of a group's paths; of the whole layer if `group` is empty.
    [[nodiscard]] Bounds bounds(const std::string& layer, const std::string& group = "") const {
      Bounds box;
      for (const json& l : page["layers"])
        for (const json& g : l["groups"])
          if (l["name"] == layer && (group.empty() || g["name"] == group))
            for (const json& path : g["paths"])
              for (const json& p : path["points"]) {
                const glm::dvec2 point(p[0].get<double>(), p[1].get<double>());
                box.low = glm::min(box.low, point);
                box.high = glm::max(box.high, point);
              }
      return box;
    }
    [[nodiscard]] double drawn(const std::string& layer, const std::string& group) const {
      double sum = 0;
      for (const json& l : page["layers"])
        for (const json& g : l["groups"])
          if (l["name"] == layer && g["name"] == group)
            for (const json& path : g["paths"])
              for (std::size_t i = 1; i < path["points"].size(); ++i)
                sum += std::hypot(path["points"][i][0].get<double>() - path["points"][i - 1][0].get<double>(),
                                  path["points"][i][1].get<double>() - path["points"][i - 1][1].get<double>());
      return sum;
    }
  };

  [[nodiscard]] Sheet drawn(const std::string& options) const {
    Sheet sheet;
    sheet.report = json::parse(succeed("lines " + options + " -o drawing.json --json").out);
    sheet.page = json::parse(read("drawing.json"));
    return sheet;
  }
};

TEST_F(SectionsCommand, ASectionStandsWhereItsViewWouldAndIsHatched) {
  const Sheet sheet = drawn("box.obj --up +z --scale 1:1 --views front --sections left");
  const Bounds front = sheet.bounds("2 visible", "front: box"), section = sheet.bounds("2 visible", "A-A: box");
  // First-angle: the view from the left stands to the right of the front view, in line with it.
  EXPECT_GT(section.low.x, front.high.x + 15 - 1e-6);
  EXPECT_NEAR(section.low.y, front.low.y, 1e-3);
  EXPECT_NEAR(section.high.x - section.low.x, 30, 1e-3);
  EXPECT_NEAR(section.high.y - section.low.y, 20, 1e-3);
  // Only the cut face is hatched: the lines lie in it and cover its area.
  const Bounds hatched = sheet.bounds("4 hatching");
  EXPECT_GE(hatched.low.x, section.low.x - 1e-3);
  EXPECT_LE(hatched.high.y, section.high.y + 1e-3);
  const double spacing = std::max(1.2, 0.03 * std::hypot(30, 20));
  EXPECT_NEAR(sheet.drawn("4 hatching", "A-A: box") * spacing, 600, 30);
  EXPECT_EQ(sheet.report["views"][1]["name"], "A-A");
  // The cutting line runs upright through the middle of the front view, beyond both ends.
  const Bounds marks = sheet.bounds("9 sections");
  EXPECT_LT(marks.low.y, front.low.y - 8);
  EXPECT_GT(marks.high.y, front.high.y + 8);
}

TEST_F(SectionsCommand, PlanesStandAtCoordinatesOfTheFile) {
  // Coordinates are those of the model, even if the model lies far away.
  write("far.obj", box_obj("box", 1e6, 1));
  for (const auto& [file, at] : {std::pair("box.obj", 10.0), std::pair("far.obj", 1e6 + 10)}) {
    const Sheet sheet =
        drawn(std::string(file) + " --up +z --scale 1:1 --views front,top --sections left=" + std::to_string(at));
    const Bounds front = sheet.bounds("2 visible", "front: box");
    for (const json& layer : sheet.page["layers"]) {
      if (layer["name"] != "9 sections") continue;
      const json& line = layer["groups"][0]["paths"][0]["points"];
      EXPECT_NEAR(line[0][0].get<double>(), front.low.x + 10, 2e-3);
      EXPECT_NEAR(line[1][0].get<double>(), front.low.x + 10, 2e-3);
    }
  }
  expect_failure("lines box.obj --up +z --sections left=50 -o a.svg", 2,
                 "--sections left=50: the plane misses the model, which lies from x = 0 to 40");
  expect_failure("lines box.obj --up +z --sections top=-1e20 -o a.svg", 2, "misses the model");
  expect_failure("lines box.obj --up +z --sections top=-1e300 -o a.svg", 2, "not a usable number");
}

TEST_F(SectionsCommand, PartsAreHatchedApart) {
  const Sheet sheet = drawn("two.obj --up +z --scale 1:1 --sections front");
  std::map<std::string, double> slopes;
  for (const json& layer : sheet.page["layers"])
    for (const json& group : layer["groups"]) {
      if (layer["name"] != "4 hatching") continue;
      const json& p = group["paths"][group["paths"].size() / 2]["points"];
      slopes[group["name"]] =
          (p[1][1].get<double>() - p[0][1].get<double>()) / (p[1][0].get<double>() - p[0][0].get<double>());
    }
  ASSERT_EQ(slopes.size(), 2u);
  EXPECT_NEAR(slopes["A-A: left"] * slopes["A-A: right"], -1, 1e-3);
  EXPECT_NEAR(std::abs(slopes["A-A: left"]), 1, 1e-3);
}

TEST_F(SectionsCommand, NamesAreWrittenAboveAndLettersAtBothEnds) {
  const json page = drawn("box.obj --up +z --views front,top --sections left,front=5 --page a3").page;
  std::vector<glm::dvec2> points;
  for (const json& layer : page["layers"])
    if (layer["name"] == "9 sections")
      for (const json& group : layer["groups"])
        for (const json& path : group["paths"])
          for (const json& p : path["points"]) points.emplace_back(p[0].get<double>(), p[1].get<double>());
  for (const char* const name : {"A-A", "B-B"}) EXPECT_EQ(count_texts(points, name, 5), 1) << name;
  // Each letter appears twice in the name and once at each end.
  for (const char* const letter : {"A", "B"}) EXPECT_EQ(count_texts(points, letter, 5), 4) << letter;
}

TEST_F(SectionsCommand, EverySheetKeepsItsViewsApart) {
  const char* const sets[] = {"--sections left", "--sections front,top,left",
                              "--views front,top,left,iso --sections front,left",
                              "--views front --sections front,front=4,left,left=30 --dimensions diameters",
                              "--views front,top --sections left=38,top=2 --dimensions diameters --frame"};
  for (const std::string set : sets)
    for (const std::string angle : {" --projection first-angle", " --projection third-angle"}) {
      const json page = drawn("two.obj --up +z --page a2 " + set + angle).page;
      std::map<std::string, Bounds> views;
      for (const json& layer : page["layers"])
        for (const json& group : layer["groups"]) {
          const std::string name = group["name"];
          if (layer["name"] != "2 visible" || name.find(": ") == std::string::npos) continue;
          Bounds& box = views[name.substr(0, name.find(": "))];
          for (const json& path : group["paths"])
            for (const json& p : path["points"]) {
              const glm::dvec2 point(p[0].get<double>(), p[1].get<double>());
              box.low = glm::min(box.low, point);
              box.high = glm::max(box.high, point);
            }
        }
      for (const auto& [name, box] : views) {
        EXPECT_GE(box.low.x, 10);
        EXPECT_LE(box.high.x, page["width"].get<double>() - 10);
        for (const auto& [other, its] : views) {
          if (name >= other) continue;
          const bool is_apart = box.high.x + 10 < its.low.x || its.high.x + 10 < box.low.x ||
                                box.high.y + 10 < its.low.y || its.high.y + 10 < box.low.y;
          EXPECT_TRUE(is_apart) << set << angle << ": " << name << " and " << other;
        }
      }
    }
}

TEST_F(SectionsCommand, WhatCannotBeMeantIsRefused) {
  expect_failure("lines box.obj --sections '' -o a.svg", 2, "--sections");
  expect_failure("lines box.obj --sections iso -o a.svg", 2, "--sections");
  expect_failure("lines box.obj --sections front= -o a.svg", 2, "--sections");
  expect_failure("lines box.obj --sections front=nan -o a.svg", 2, "--sections");
  expect_failure("lines box.obj --sections front=1x -o a.svg", 2, "--sections");
  expect_failure("lines box.obj --sections front,front -o a.svg", 2, "'front' is there twice");
  expect_failure("lines box.obj --sections front --view top -o a.svg", 2, "--sections and --view exclude each other");
  expect_failure("lines box.obj --sections front --hatch 1 -o a.svg", 2, "leave out hatch");
  expect_failure("lines box.obj --sections front --style figure -o a.svg", 2, "figures");
  EXPECT_THAT(succeed("lines open.obj --sections front=1,left=1 --up +y -o a.svg").err,
              testing::HasSubstr("outlines are not closed"));
  // Curved models are cut as tessellated for drawing.
  succeed("lines builtin:spheres --views front --sections top --page a2 -o spheres.svg");
}

}  // namespace
}  // namespace frontmost::test
