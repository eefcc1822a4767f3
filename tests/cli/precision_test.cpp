// SPDX-License-Identifier: Apache-2.0
// frontmost precision: tables, reports, plots, and faces that fight on models.
#include <frontmost/files.h>
#include <gmock/gmock.h>

#include <cmath>

#include "program.h"
#include "support/effort.h"

namespace frontmost::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

class Precision : public ProgramTest {};

/// Two squares at these z, as OBJ objects in that order.
std::string two_squares(const std::string& first, const std::string& second) {
  std::string text;
  int corner = 1;
  for (const std::string& z : {first, second}) {
    text += "o at" + z + "\n";
    for (const char* xy : {"-9 -9", "9 -9", "9 9", "-9 9"}) text += "v " + std::string(xy) + " " + z + "\n";
    text += "f " + std::to_string(corner) + " " + std::to_string(corner + 1) + " " + std::to_string(corner + 2) + " " +
            std::to_string(corner + 3) + "\n";
    corner += 4;
  }
  return text;
}

TEST_F(Precision, TheTableHasARowForEveryDistance) {
  const std::string text = succeed("precision --near 1 --far 100 --format D8").out;
  EXPECT_THAT(text, StartsWith("D8, near 1, far 100\n"));
  EXPECT_THAT(text,
              HasSubstr("\n          10         0.404      2.38e-05         0.404         4.0e-02      90.91 %\n"));
  EXPECT_THAT(text, Not(HasSubstr("model")));
  const std::string all = succeed("precision --near 0.1 --infinite").out;
  EXPECT_THAT(all, HasSubstr("    distance  of positions           D16           D24           F32  F32 reversed\n"));
  EXPECT_THAT(all, HasSubstr("far infinite"));
}

TEST_F(Precision, TheReportHasTheSameNumbers) {
  const json report = succeed("precision --near 1 --far 100 --format D8 --gap 0.5,10 --json").json();
  EXPECT_EQ(report["near"], 1);
  EXPECT_EQ(report["far"], 100);
  const json& buffer = report["buffers"][0];
  EXPECT_EQ(buffer["format"], "D8");
  EXPECT_EQ(buffer["distances"][3]["distance"], 10);
  EXPECT_NEAR(buffer["distances"][3]["format_gap"].get<double>(), 0.40392, 1e-5);
  EXPECT_NEAR(buffer["distances"][3]["positions_gap"].get<double>(), 40 * std::ldexp(10, -24), 1e-9);
  EXPECT_NEAR(buffer["distances"][3]["gap"].get<double>(), 0.40392 + 40 * std::ldexp(10, -24), 1e-5);
  EXPECT_EQ(buffer["distances"].size(), 7u);
  // 1/n = 0.5 / (10 * 10.5) * 255 + 1/100, and a little more for the error of positions.
  const double near = 1 / (0.5 / 105 * 255 + 0.01);
  EXPECT_GE(buffer["near_for_gap"], near);
  EXPECT_LE(buffer["near_for_gap"], near * 1.0001);
  const json reversed = succeed("precision --near 0.1 --infinite --format F32 --reversed --gap 1e-9,10 --json").json();
  EXPECT_TRUE(reversed["far"].is_null());
  EXPECT_TRUE(reversed["buffers"][0]["near_for_gap"].is_null());
  EXPECT_EQ(succeed("precision --near 1 --far 9 --json").json()["buffers"].size(), 4u);
}

TEST_F(Precision, AWantedGapNamesTheNearPlane) {
  const std::string text = succeed("precision --near 0.01 --far 1000 --gap 0.01,100").out;
  EXPECT_THAT(text, HasSubstr("to tell 0.01 apart at 100\n"));
  EXPECT_THAT(text, HasSubstr("D24           near 0.0610"));
  EXPECT_THAT(text, HasSubstr("F32 reversed  any near plane resolves it\n"));
  EXPECT_THAT(succeed("precision --near 1 --far 1000 --gap 0.01,100 --format D24").out, HasSubstr("or farther: it is"));
}

TEST_F(Precision, WhatPositionsAddIsSaid) {
  const std::string line = "precision --near 100 --far 101 --format D24";
  const json at_far = succeed(line + " --json").json()["buffers"][0]["distances"].back();
  EXPECT_LT(at_far["format_gap"], 1e-7);
  EXPECT_GT(at_far["gap"], 1e-4) << "floats are 7.6e-6 apart there";
  EXPECT_THAT(succeed(line).out, HasSubstr("the rounding of positions and transforms"));
  EXPECT_THAT(succeed(line + " --gap 1e-6,100.5").out,
              HasSubstr("no format resolves it: rounding of positions alone adds 0.00024"));
  EXPECT_TRUE(succeed(line + " --gap 1e-6,100.5 --json").json()["buffers"][0]["near_for_gap"].is_null());
  // Far from the eye, positions are coarser.
  write("far.obj", "v 0 0 0\nv 1e4 0 0\nv 0 1 0\nf 1 2 3\n");
  write("near.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const std::string camera = " --resolution 8,8 --view front --near 1 --far 9 --format D24 --json";
  const auto added = [&](const char* model) {
    const json report = succeed(std::string("precision ") + model + camera).json();
    return report["buffers"][0]["distances"][0]["positions_gap"].get<double>();
  };
  EXPECT_GT(added("far.obj"), 100 * added("near.obj"));
}

TEST_F(Precision, ThePlotIsADrawing) {
  succeed("precision --near 0.1 --far 1000 --gap 0.05,800 --plot a.svg");
  const std::string svg = read("a.svg");
  EXPECT_THAT(svg, StartsWith("<svg xmlns="));
  EXPECT_THAT(svg, HasSubstr(">F32 reversed</text>"));
  EXPECT_THAT(svg, HasSubstr("wanted: 0.05 at 800"));
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
  EXPECT_THAT(svg, Not(HasSubstr("inf\"")));
  succeed("precision --near 1e-20 --infinite --format D8 --reversed --plot b.svg");
  EXPECT_THAT(read("b.svg"), HasSubstr("D8 reversed"));
  succeed("precision --near 0 --far 10 --camera-orthographic --plot c.svg");
  EXPECT_EQ(run({"precision", "--near", "1", "--far", "9", "--plot", "-"}).out.substr(0, 4), "<svg");
}

// From 10 away, near 0.01: 16 bits resolve 0.15, so the square 0.01 behind, drawn first, hides the other.
TEST_F(Precision, SquaresThatFightAreFoundOnTheModel) {
  write("fight.obj", two_squares("-0.01", "0"));
  const std::string camera =
      "precision fight.obj --camera-position 0,0,10 --camera-direction -z --resolution 40,30 --near 0.01 --far "
      "100";
  const json fights = succeed(camera + " --format D16 --json").json()["buffers"][0]["fights"];
  EXPECT_EQ(fights["pixels"], 1200);
  EXPECT_EQ(fights["covered_pixels"], 1200);
  ASSERT_EQ(fights["wrong_pixels"], 1200);
  EXPECT_EQ(fights["pairs"][0]["seen"]["name"], "at-0.01");
  EXPECT_EQ(fights["pairs"][0]["nearer"]["name"], "at0");
  EXPECT_NEAR(fights["pairs"][0]["farthest"].get<double>(), 0.01, 1e-6);
  const std::string text = succeed(camera + " --format D16 --heat-map h.png").out;
  EXPECT_THAT(text, HasSubstr("1200 pixels   100.000 %"));
  EXPECT_THAT(text, HasSubstr("at-0.01"));
  EXPECT_EQ(load_image(path("h.png")).width, 40);
  EXPECT_EQ(succeed(camera + " --format D24 --json").json()["buffers"][0]["fights"]["wrong_pixels"], 0);
  const json all = succeed(camera + " --json").json()["buffers"];
  EXPECT_EQ(all[0]["fights"]["wrong_pixels"], 1200);
  EXPECT_EQ(all[3]["fights"]["wrong_pixels"], 0);
}

// Areas at risk are listed with their remedies; both squares fill the picture of 40 x 30.
TEST_F(Precision, AreasAtRiskAreListedWithTheirRemedies) {
  write("fight.obj", two_squares("-0.01", "0"));
  const std::string camera =
      "precision fight.obj --camera-position 0,0,10 --camera-direction -z --resolution 40,30 --near 0.01 --far 100";
  const json buffer = succeed(camera + " --format D16 --json").json()["buffers"][0];
  const json pair = buffer["at_risk"]["pairs"][0];
  EXPECT_EQ(pair["kind"], "close");
  EXPECT_EQ(pair["first"]["name"], "at-0.01");
  EXPECT_EQ(pair["second"]["name"], "at0");
  EXPECT_NEAR(pair["visible_area"].get<double>(), 1200, 1e-3);
  EXPECT_NEAR(pair["gap"].get<double>(), 0.15494, 0.00001);
  EXPECT_EQ(pair["offset"]["object"]["name"], "at0");
  EXPECT_EQ(pair["offset"]["units"], -1);
  ASSERT_EQ(buffer["at_risk"]["faces"].size(), buffer["at_risk"]["areas"]);
  double by_faces = 0;
  for (const json& faces : buffer["at_risk"]["faces"]) by_faces += faces["visible_area"].get<double>();
  EXPECT_NEAR(by_faces, 1200, 1e-3);
  EXPECT_EQ(buffer["at_risk"]["faces"][0]["kind"], "close");
  ASSERT_EQ(buffer["remedies"].size(), 4u) << "planes, 24 bits, reversed floats, these with the planes";
  for (const json& remedy : buffer["remedies"]) EXPECT_EQ(remedy["wrong_pixels"], 0);
  EXPECT_TRUE(buffer["remedies"][2]["reversed"].get<bool>());
  const double near = buffer["remedies"][0]["near"].get<double>(), far = buffer["remedies"][0]["far"].get<double>();
  EXPECT_NEAR(near, 9.99, 0.001);
  const std::string planes = " --near " + std::to_string(near) + " --far " + std::to_string(far);
  const json better = succeed("precision fight.obj --camera-position 0,0,10 --camera-direction -z --resolution 40,30" +
                              planes + " --format D16 --json")
                          .json()["buffers"][0];
  EXPECT_EQ(better["fights"]["wrong_pixels"], 0);
  EXPECT_TRUE(better["at_risk"]["pairs"].empty());
  const std::string text = succeed(camera + " --format D16").out;
  EXPECT_THAT(text, HasSubstr("at-0.01, at0  offset -1,-1 of at0 ends it"));
  EXPECT_THAT(text, HasSubstr("0 pixels are wrong"));
  EXPECT_THAT(succeed(camera).out, HasSubstr("F32 reversed"));
}

TEST_F(Precision, MoreAreasAtRiskThanCanBeListedLeaveTheRestOfTheReport) {
  // With a near plane this close, every face of the city fights with every face behind it.
  const std::string line = "precision builtin:city --near 1e-5 --format D16 --resolution 320,200";
  const json buffer = succeed(line + " --json").json()["buffers"][0];
  EXPECT_THAT(buffer["at_risk"]["refused"].get<std::string>(), HasSubstr("fighting faces: "));
  EXPECT_GT(buffer["fights"]["wrong_pixels"], 0);
  ASSERT_FALSE(buffer["remedies"].empty());
  EXPECT_LT(buffer["remedies"].back()["wrong_pixels"], buffer["fights"]["wrong_pixels"]);
  if (test::under_sanitizer) return;
  EXPECT_THAT(succeed(line).out, HasSubstr("too many to count (fighting faces: "));
}

TEST_F(Precision, OneSurfaceInTwoPlacesIsTied) {
  write("same.obj", two_squares("0", "0"));
  const json fights =
      succeed(
          "precision same.obj --camera-position 0,0,10 --camera-direction -z --resolution 40,30 --format D24 "
          "--json")
          .json()["buffers"][0]["fights"];
  EXPECT_EQ(fights["wrong_pixels"], 0);
  EXPECT_EQ(fights["tied_pixels"], 1200);
}

TEST_F(Precision, WrongUsageIsNamed) {
  write("cube.stl", cube_stl());
  expect_failure("precision", 2, "give --near, or a MODEL");
  expect_failure("precision --near 1", 2, "give --far or --infinite");
  expect_failure("precision --near 1 --far 2 --infinite", 2, "--infinite and --far exclude each other");
  expect_failure("precision --near 0.1 --far 1000 --gap 0.05,2000", 2,
                 "--gap: the distance 2000 must lie between the near plane at 0.1 and the far one at 1000");
  expect_failure("precision --near 0.1 --far 1000 --gap 0.05,0.05", 2, "--gap: the distance 0.05 must lie between");
  expect_failure("precision builtin:teapot --gap 0.05,1e6", 2, "--gap: the distance 1e+06 must lie between");
  expect_failure("precision --near 2 --far 1", 2, "--near: must be below --far");
  expect_failure("precision --near 1 --far 2 --format D32", 2, "--format: 'D32' is not one of D8, D16, D24, F32");
  expect_failure("precision --near 1 --far 2 --gap 1", 2, "--gap: '1' has 1 values, 2 are needed");
  expect_failure("precision --near 1 --far 2 --heat-map a.png --format D24", 2,
                 "--heat-map needs a MODEL and --format");
  expect_failure("precision cube.stl cube.stl", 2, "one model at a time");
  expect_failure("precision --near 1 --far 2 --plot none/a.svg", 1, "does not exist");
  expect_failure("precision --near 1 --far 2 --json --plot -", 2, "both write to standard output");
  expect_failure("precision cube.stl --plot cube.stl", 2, "is the model itself");
  expect_failure("render cube.stl --gap 1,2", 2, "--gap is not an option of 'frontmost render'");
}

}  // namespace
}  // namespace frontmost::test
