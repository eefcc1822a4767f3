// SPDX-License-Identifier: Apache-2.0
// frontmost compare: its report, its files, its refusals.
#include <gmock/gmock.h>

#include "program.h"
#include "support/models.h"

namespace frontmost::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class Compare : public ProgramTest {
 protected:
  Compare() { write("cube.stl", cube_stl()); }
};

TEST_F(Compare, ReportsEveryMethodAsJson) {
  const json report = succeed("compare cube.stl --resolution 160,120 --runs 3 --json").json();
  EXPECT_EQ(report["triangles"], 12);
  EXPECT_EQ(report["width"], 160);
  EXPECT_EQ(report["runs"], 3);
  for (const json& method : report["methods"]) EXPECT_EQ(method["runs"], 3) << method["method"];
  ASSERT_EQ(report["methods"].size(), 5u);
  EXPECT_EQ(report["methods"][0]["method"], "zbuffer");
  EXPECT_EQ(report["methods"][1]["method"], "raycast");
  EXPECT_EQ(report["methods"][2]["method"], "abuffer");
  EXPECT_EQ(report["methods"][3]["method"], "painter");
  EXPECT_EQ(report["methods"][4]["method"], "painter-centroid");
  for (const json& method : report["methods"]) {
    SCOPED_TRACE(method["method"]);
    const json& times = method["timings_ms"];
    for (const char* stage : {"load", "surfaces"}) EXPECT_GE(times[stage].get<double>(), 0);
    EXPECT_LE(times["visible"]["min"], times["visible"]["median"]);
    EXPECT_LE(times["visible"]["median"], times["visible"]["max"]);
    EXPECT_EQ(times.contains("index"), method["method"] == "raycast");
    EXPECT_GT(method["peak_bytes"], 160 * 120 * 8) << "the answer itself";
    EXPECT_LT(method["peak_bytes"], 1 << 28);
    EXPECT_EQ(method["primitives"], 12);
    EXPECT_EQ(method["samples"], 160 * 120);
    EXPECT_GT(method["covered_samples"], 1000);
    EXPECT_EQ(method["unexplained"], 0);
    if (method["method"] == "painter-centroid") continue;  // known to be wrong
    EXPECT_EQ(method["wrong_by_design"], 0);
    EXPECT_EQ(method["differing"], method["explained"]["edge"].get<int>() + method["explained"]["depth"].get<int>() +
                                       method["explained"]["translucent"].get<int>());
  }
  EXPECT_EQ(report["methods"][0]["differing"], 0);
  EXPECT_FALSE(report.contains("advice"));
  // A pixel has the near side of the cube and the far side behind it, each twice where an edge passes.
  const json& lists = report["methods"][2];
  EXPECT_NEAR(lists["fragments"].get<double>(), 2.0 * lists["covered_samples"].get<double>(), 200);
  EXPECT_GE(lists["longest_list"], 2);
  EXPECT_FALSE(report["methods"][0].contains("fragments"));
}

TEST_F(Compare, CullsWhatIsHidden) {
  const std::string street =
      "compare builtin:city --camera-position 8,3,25 --camera-direction +x --resolution 160,120 --runs 2";
  const json culling = succeed(street + " --json").json()["occlusion_culling"];
  const auto number = [&](const char* name) { return culling[name].get<int>(); };
  EXPECT_EQ(number("objects"), number("outside") + number("hidden") + number("may_be_seen"));
  EXPECT_GT(number("outside"), 1000);
  EXPECT_GT(number("hidden"), 50);
  EXPECT_GT(number("seen"), 20);
  EXPECT_LE(number("seen"), number("may_be_seen"));
  EXPECT_EQ(number("wrong"), 0);
  EXPECT_GE(culling["timings_ms"]["cull"]["min"].get<double>(), 0);
  const std::string text = succeed("compare cube.stl --resolution 160,120 --runs 1").out;
  EXPECT_THAT(text, HasSubstr("Occlusion culling: of 1 object 0 are outside of the view, 0 certainly hidden, 1 may be "
                              "seen (1 is seen at a sample)"));
}

TEST_F(Compare, SetsEveryMethodInAColumnOfItsOwn) {
  const std::string table = succeed("compare cube.stl --resolution 160,120 --runs 1").out;
  std::istringstream lines(table.substr(table.find("\n\n") + 2));
  std::string heads;
  std::getline(lines, heads);
  EXPECT_THAT(heads, testing::ContainsRegex("zbuffer +raycast +abuffer +painter +painter-centroid$"));
  for (std::string line; std::getline(lines, line) && !line.empty();) EXPECT_EQ(line.size(), heads.size()) << line;
}

TEST_F(Compare, AsksEveryMethodAtManySamples) {
  const json one = succeed("compare cube.stl --resolution 160,120 --runs 1 --json").json();
  const json report = succeed("compare cube.stl --resolution 160,120 --runs 1 --samples 4 --json -o page").json();
  EXPECT_EQ(one["samples"], 1);
  EXPECT_EQ(report["samples"], 4);
  for (std::size_t i = 0; i < 5; ++i) {
    const json& method = report["methods"][i];
    EXPECT_EQ(method["samples"], 4 * 160 * 120);
    EXPECT_NEAR(method["covered_samples"].get<double>(), 4 * one["methods"][i]["covered_samples"].get<double>(), 200);
    if (method["method"] == "painter-centroid") continue;
    EXPECT_EQ(method["unexplained"], 0);
  }
  EXPECT_THAT(read("page/index.html"), HasSubstr("4 samples each"));
  EXPECT_THAT(succeed("compare cube.stl --resolution 64,48 --runs 1 --samples 2").out,
              HasSubstr("samples that differ"));
}

TEST_F(Compare, CountsTheMistakesOfNaiveOrders) {
  const json report = succeed("compare builtin:cycle --resolution 160,120 --runs 1 --json --explain").json();
  EXPECT_EQ(report["methods"][3]["unexplained"], 0);
  EXPECT_EQ(report["methods"][3]["wrong_by_design"], 0);
  EXPECT_GT(report["methods"][4]["wrong_by_design"], 100);
  EXPECT_EQ(report["methods"][4]["unexplained"], 0) << "what it is meant to get wrong";
  EXPECT_THAT(report["advice"].back(), testing::ContainsRegex("by centroids: wrong in .*, by design"));
  EXPECT_THAT(report["advice"][5], testing::Not(HasSubstr("mistake")));
}

TEST_F(Compare, SaysInTableAndPageWhatIsWrongByDesign) {
  const std::string text = succeed("compare builtin:cycle --resolution 160,120 --runs 1 -o page").out;
  EXPECT_THAT(text, testing::ContainsRegex("\n  wrong by design +0 +0 +0 +0 +[1-9][0-9,]+\n"));
  EXPECT_THAT(text, testing::ContainsRegex("\n  unexplained +0 +0 +0 +0 +0\n"));
  const std::string page = read("page/index.html");
  EXPECT_THAT(page, HasSubstr("</span>wrong by design</th>"));
  EXPECT_THAT(page, HasSubstr("</i>wrong by design</span>"));
}

TEST_F(Compare, PrintsATable) {
  const std::string text = succeed("compare cube.stl --resolution 64,48 --runs 1").out;
  for (const char* part : {"12 triangles, 64 x 48 pixels", "zbuffer", "raycast", "abuffer", "index, ms", "visible, ms",
                           "memory", "unexplained"})
    EXPECT_THAT(text, HasSubstr(part));
  EXPECT_THAT(text, testing::Not(HasSubstr("One view")));
}

TEST_F(Compare, ExplainsInWords) {
  const std::string text = succeed("compare cube.stl --resolution 64,48 --runs 1 --explain").out;
  EXPECT_THAT(text, HasSubstr("One view: "));
  EXPECT_THAT(text, HasSubstr("Many views of the same model: "));
  EXPECT_THAT(text, HasSubstr("Memory beside the model: "));
  const json report = succeed("compare cube.stl --resolution 64,48 --runs 1 --explain --json").json();
  EXPECT_EQ(report["advice"].size(), 7u);
}

TEST_F(Compare, WritesAPageThatHoldsItsPictures) {
  const json report = succeed("compare cube.stl --resolution 64,48 --runs 1 -o new/page --json").json();
  EXPECT_EQ(report["files"].size(), 10u);
  for (const json& file : report["files"]) EXPECT_TRUE(exists(file)) << file;
  const std::string page = read("new/page/index.html");
  EXPECT_THAT(page, HasSubstr("<!doctype html>"));
  EXPECT_THAT(page, HasSubstr("data:image/png;base64,iVBORw0KGgo"));
  EXPECT_THAT(page, testing::Not(HasSubstr("src=\"http"))) << "it must stand alone";
  EXPECT_THAT(page, HasSubstr("Ray casting"));
  EXPECT_THAT(page, HasSubstr("Occlusion culling: of 1 object"));
}

TEST_F(Compare, ShowsWhatEachMethodSees) {
  const std::string view = " builtin:gallery --resolution 96,64 ";
  succeed("compare" + view + "--runs 1 -q -o page");
  succeed("render" + view + "--method zbuffer --samples 1 --background transparent -q -o alone.png");
  EXPECT_TRUE(read("page/zbuffer.png") == read("alone.png")) << "glass hides what is behind it";
  EXPECT_FALSE(read("page/abuffer.png") == read("page/zbuffer.png")) << "glass is seen through";
  EXPECT_FALSE(read("page/painter-centroid.png") == read("page/zbuffer.png")) << "a wrong order is shown as it is";
}

TEST_F(Compare, NamesInThePageAreText) {
  write("a<b>&.stl", cube_stl());
  ASSERT_EQ(run({"compare", "a<b>&.stl", "--resolution", "32,24", "--runs", "1", "-o", "page"}).status, 0);
  const std::string page = read("page/index.html");
  EXPECT_THAT(page, HasSubstr("a&lt;b&gt;&amp;.stl"));
  EXPECT_THAT(page, testing::Not(HasSubstr("<b>")));
}

TEST_F(Compare, SaysWhatIsSeenThroughGlass) {
  FRONTMOST_NEEDS_MODELS();
  const Outcome outcome = run({"compare", model("transparency/glass-table.glb"), "--resolution", "320,240", "--runs",
                               "1", "--json", "--explain", "-q"});
  const json methods = outcome.json()["methods"];
  EXPECT_GT(methods[2]["explained"]["translucent"], 1000);
  EXPECT_EQ(methods[1]["explained"]["translucent"], 0);
  EXPECT_EQ(methods[2]["unexplained"], 0);
  EXPECT_THAT(outcome.out, HasSubstr("only the A-buffer shows what lies behind"));
}

TEST_F(Compare, NothingToSeeIsNoTrouble) {
  write("empty.ply",
        "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 0\nproperty list uchar int vertex_indices\nend_header\n");
  const json report = succeed("compare empty.ply --resolution 32,24 --runs 1 --json -o page").json();
  for (const json& method : report["methods"]) {
    EXPECT_EQ(method["covered_samples"], 0);
    EXPECT_EQ(method["differing"], 0);
  }
}

TEST_F(Compare, RefusesWhatItCannotDo) {
  expect_failure("compare none.stl", 1, "frontmost: none.stl: cannot open");
  expect_failure("compare cube.stl --pose 1,0,0,1e39,0,1,0,0,0,0,1,0 --pose-convention opengl-camera-to-world", 1,
                 "frontmost: --pose: pose: the eye");
  expect_failure("compare -", 2, "give a file");
  expect_failure("compare cube.stl --runs 0", 2, "--runs");
  expect_failure("compare cube.stl --samples 64", 2, "--samples");
  expect_failure("compare cube.stl --camera-index 3", 2, "camera");
  expect_failure("compare cube.stl --near 5 --far 1", 2, "--near");
  write("file", "");
  expect_failure("compare cube.stl -o file/page", 1, "file/page");
  expect_failure("compare", 2, "no MODEL given");
}

}  // namespace
}  // namespace frontmost::test
