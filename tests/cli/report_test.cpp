// SPDX-License-Identifier: Apache-2.0
// frontmost report: the table, the report, and the files that it writes.
#include <gmock/gmock.h>

#include "program.h"

namespace frontmost::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class Report : public ProgramTest {
 protected:
  /// Three squares over a picture of ten by ten pixels, one to a unit: the far one covers 6 x 6 of them, the near one 4
  /// x 4, three of them before the far one and a column of four beyond the frame; the last one is far away.
  Report() {
    write("squares.obj", square("far", {-3, -3}, 3, 0) + square("near", {2, 0}, 2, 1) + square("away", {40, 0}, 1, 0));
  }

  static constexpr const char* view =
      " --camera-position 0,0,10 --camera-focal-point 0,0,0 --camera-view-up +y --intrinsics 100,100,5,5 "
      "--pixel-center half --resolution 10,10 --near 1 --far 200 ";

 private:
  static std::string square(const std::string& name, const glm::dvec2& low, double half, double z) {
    // So far away that what is nearer is no larger.
    const double scale = (10 - z) / 100;
    std::string text = "o " + name + "\n";
    for (const glm::dvec2& corner : {glm::dvec2(0, 0), {1, 0}, {1, 1}, {0, 1}}) {
      const glm::dvec2 at = (low + 2 * half * corner) * scale;
      text += "v " + std::to_string(at.x) + " " + std::to_string(at.y) + " " + std::to_string(z) + "\n";
    }
    return text + "f -4 -3 -2 -1\n";
  }
};

TEST_F(Report, TheTableHasARowForEveryObject) {
  const std::string text = succeed(std::string("report squares.obj") + view).out;
  EXPECT_THAT(text, HasSubstr("10 x 10 pixels, on a canvas of 30 x 30: 45 see an object, 55 see none\n"
                              "3 objects: 2 seen, 0 hidden, 0 beyond the frame, 1 cover no sample\n"));
  EXPECT_THAT(
      text,
      HasSubstr("     0  far           33          36    91.7 %     8.3 %     0.0 %         10  seen, 92 % of it, "
                "the rest hidden by near 8 %\n"));
  EXPECT_THAT(
      text,
      HasSubstr("     1  near          12          16    75.0 %     0.0 %    25.0 %          9  seen, 75 % of it, "
                "25 % beyond the frame\n"));
  EXPECT_THAT(text, HasSubstr("outside: on the right of the picture: turn the camera 22"));
}

TEST_F(Report, TheReportHasAllNumbers) {
  const json report = succeed(std::string("report squares.obj --json") + view).json();
  EXPECT_EQ(report["canvas"], json({-10, -10, 30, 30}));
  EXPECT_EQ(report["background"], 55);
  const json &far = report["objects"][0], &near = report["objects"][1], &away = report["objects"][2];
  EXPECT_EQ(far["name"], "far");
  EXPECT_EQ(far["alone"], (json{{"samples", 36}, {"box", {2, 2, 6, 6}}}));
  EXPECT_EQ(far["visible"]["samples"], 33);
  EXPECT_EQ(far["hidden_by"], json::array({{{"object", 1}, {"samples", 3}}}));
  EXPECT_EQ(near["alone"]["box"], json({7, 1, 4, 4}));
  EXPECT_EQ(near["in_frame"]["box"], json({7, 1, 3, 4}));
  EXPECT_EQ(near["cut_share"], 0.25);
  EXPECT_EQ(near["centroid"], json({8.5, 3.0}));
  EXPECT_EQ(near["cut_by_near"], false);
  EXPECT_TRUE(away["alone"]["box"].is_null());
  EXPECT_TRUE(away["distance"].is_null());
  EXPECT_TRUE(away["centroid"].is_null());
  const json narrow = succeed(std::string("report squares.obj --json --canvas 1") + view).json();
  EXPECT_EQ(narrow["objects"][1]["alone"]["samples"], 12);
  EXPECT_EQ(narrow["objects"][1]["cut_share"], 0);
}

TEST_F(Report, SaysWhyObjectsAreSeenOrNot) {
  const std::string command = std::string("report squares.obj") + view;
  EXPECT_EQ(succeed(command + "--why far").out, "far is seen, 92 % of it, the rest hidden by near 8 %.\n");
  EXPECT_EQ(succeed(command + "--why 1").out, "near is seen, 75 % of it, 25 % beyond the frame.\n");
  const json away = succeed(command + "--json --why away").json()["objects"];
  ASSERT_EQ(away.size(), 1u);
  EXPECT_EQ(away[0]["object"], 2);
  const json& why = away[0]["why"];
  EXPECT_EQ(why["reason"], "outside");
  EXPECT_EQ(why["triangles"]["right"], 2);
  EXPECT_EQ(why["remedy"]["kind"], "turn");
  EXPECT_NEAR(why["remedy"]["right_degrees"].get<double>(), 22.3, 0.4);
  EXPECT_EQ(why["remedy"]["up_degrees"], 0);
  std::string far_view = view;
  far_view.replace(far_view.find("--near 1 "), 9, "--near 11 ");
  const json near = succeed("report squares.obj --json --why far" + far_view).json()["objects"][0];
  EXPECT_EQ(near["why"]["remedy"], (json{{"kind", "set_near"}, {"value", 9.9}}));
  expect_failure(command + "--why wall", 2, "--why: squares.obj has no object wall");
  expect_failure(command + "--why fat", 2, "; did you mean far?");
}

TEST_F(Report, LongTablesSayHowMuchIsLeftOut) {
  const std::string text = succeed("report builtin:city --resolution 320,180").out;
  EXPECT_THAT(text, HasSubstr(" more; --json has all\n"));
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 2 + 2 + 40 + 1);
}

TEST_F(Report, AModelWithoutAnythingIsAllBackground) {
  write("empty.obj", "v 0 0 0\n");
  EXPECT_THAT(run({"report", "empty.obj", "--resolution", "10,10"}).out, HasSubstr("0 see an object, 100 see none"));
}

TEST_F(Report, WrongOptionsAreNamed) {
  expect_failure("report squares.obj --canvas 0.5", 2, "--canvas: 0.5 is not between 1 and 16");
  expect_failure("report squares.obj --samples 4", 2, "--samples does not belong to 'frontmost report'");
  expect_failure("report", 2, "no MODEL given");
}

}  // namespace
}  // namespace frontmost::test
