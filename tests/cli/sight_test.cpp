// SPDX-License-Identifier: Apache-2.0
// frontmost sight, and render by rays.
#include <gmock/gmock.h>

#include <algorithm>

#include "cli/json.h"
#include "program.h"
#include "support/effort.h"

namespace frontmost::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class LineOfSight : public ProgramTest {
 protected:
  LineOfSight() { write("cube.stl", cube_stl()); }  // from 0 to 1
};

TEST_F(LineOfSight, SaysClearOrBlockedAndWhere) {
  EXPECT_EQ(succeed("sight cube.stl --from 2,0,0 --to 2,1,1").out, "clear\n");
  const std::string blocked = succeed("sight cube.stl --from 0.25,0.5,4 --to 0.25,0.5,-4").out;
  EXPECT_THAT(blocked, HasSubstr("blocked by object 0"));
  EXPECT_THAT(blocked, HasSubstr("at 0.25,0.5,1, distance 3"));
  const json report = succeed("sight cube.stl --from 0.25,0.5,4 --to 0.25,0.5,-4 --json").json();
  EXPECT_EQ(report["clear"], 0);
  EXPECT_EQ(report["pairs"][0]["clear"], false);
  EXPECT_EQ(report["pairs"][0]["object"], 0);
  EXPECT_EQ(report["pairs"][0]["point"], json::parse("[0.25, 0.5, 1.0]"));
  EXPECT_EQ(report["pairs"][0]["distance"], 3.0);
}

TEST_F(LineOfSight, WhatLiesAtAPointDoesNotBlock) {
  EXPECT_EQ(succeed("sight cube.stl --from 0.25,0.5,1 --to 0.25,0.5,4").out, "clear\n");
  EXPECT_EQ(succeed("sight cube.stl --from 0.25,0.5,1 --to 0.25,0.5,0").out, "clear\n");
  EXPECT_EQ(succeed("sight cube.stl --from 5,5,5 --to 5,5,5").out, "clear\n");
}

TEST_F(LineOfSight, ReadsAFileOfPairs) {
  write("pairs.txt", "# a comment\n2,0,0, 2,1,1\n\n0.25 0.5 4 0.25 0.5 -4  # through\n");
  const std::string text = succeed("sight cube.stl --pairs pairs.txt").out;
  EXPECT_EQ(text.substr(0, 14), "clear\nblocked ");
  const json report = succeed("sight cube.stl --pairs pairs.txt --json").json();
  EXPECT_EQ(report["of"], 2);
  EXPECT_EQ(report["clear"], 1);
}

TEST_F(LineOfSight, JsonIsWrittenAsItIsMade) {
  const int many = under_sanitizer ? 3'000 : 70'000;
  for (const int count : {0, 1, 3, many}) {
    std::string pairs;
    for (int i = 0; i < count; ++i) pairs += i % 3 == 0 ? "0.25 0.5 4 0.25 0.5 -4\n" : "2 0 0 2 1 1\n";
    write("pairs.txt", pairs);
    const std::string out = succeed("sight cube.stl --pairs pairs.txt --json").out;
    const cli::Json report = cli::Json::parse(out);
    EXPECT_EQ(cli::dump(report), out) << "text of the whole, " << count << " pairs";
    EXPECT_EQ(report["of"], count);
    EXPECT_EQ(report["pairs"].size(), std::size_t(count));
    const std::string lines = succeed("sight cube.stl --pairs pairs.txt").out;
    EXPECT_EQ(std::count(lines.begin(), lines.end(), '\n'), count);
  }
  if (under_sanitizer) GTEST_SKIP() << "there is nothing to limit";
  // A report of 70,000 pairs must not be held in memory, where it takes 170 MB.
  const Outcome outcome = run(Call{.words = {"sight", "cube.stl", "--pairs", "pairs.txt", "--json", "--threads", "1"},
                                   .address_space = std::size_t(120) << 20});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.json()["of"], many);
}

TEST_F(LineOfSight, NamesWhatIsWrong) {
  write("short.txt", "1 2 3\n");
  write("words.txt", "1 2 3 4 5 six\n");
  EXPECT_THAT(run({"sight", "cube.stl", "--pairs", "short.txt"}).err,
              HasSubstr("short.txt: line 1: a pair of points needs six numbers"));
  EXPECT_THAT(run({"sight", "cube.stl", "--pairs", "words.txt"}).err, HasSubstr("words.txt: line 1: "));
  EXPECT_EQ(run({"sight", "cube.stl", "--pairs", "none.txt"}).status, 1);
  EXPECT_EQ(run({"sight", "cube.stl", "--from", "1,2,3"}).status, 2);
  EXPECT_EQ(run({"sight", "cube.stl", "--from", "1,2,3", "--to", "1,2"}).status, 2);
  EXPECT_EQ(run({"sight", "cube.stl", "--from", "1,2,3", "--to", "1,2,4", "--pairs", "short.txt"}).status, 2);
}

TEST_F(LineOfSight, RenderByRaysShowsTheSamePicture) {
  succeed("render cube.stl --resolution 48,32 -o buffer.png");
  const json report = succeed(
                          "render cube.stl --resolution 48,32 --method raycast -o rays.png --reference buffer.png "
                          "--reference-threshold 0.02 --json")
                          .json();
  EXPECT_EQ(report["method"], "raycast");
  EXPECT_TRUE(report["timings_ms"].contains("index"));
  EXPECT_EQ(run({"render", "cube.stl", "--method", "raycast", "--depth-format", "D16", "-o", "a.png"}).status, 2);
  EXPECT_EQ(run({"render", "cube.stl", "--method", "magic", "-o", "a.png"}).status, 2);
}

}  // namespace
}  // namespace frontmost::test
