// SPDX-License-Identifier: Apache-2.0
// frontmost render -o FILE.svg and .pdf: polygons in painter's order.
#include <gmock/gmock.h>

#include "program.h"

namespace frontmost::test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

class Figures : public ProgramTest {
 protected:
  Figures() { write("cube.stl", cube_stl()); }
  [[nodiscard]] std::size_t count(const std::string& file, const std::string& word) const {
    const std::string text = read(file);
    std::size_t found = 0;
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++found;
    return found;
  }
};

TEST_F(Figures, HoldVisiblePolygonsAlone) {
  EXPECT_THAT(succeed("render cube.stl -o cube.svg --resolution 320,240").err,
              HasSubstr("cube.svg: 6 shapes, about 0.0 MB"));
  EXPECT_EQ(count("cube.svg", "<path"), 7u);  // includes the background
  EXPECT_THAT(read("cube.svg"), HasSubstr("width=\"84.667mm\" height=\"63.5mm\""));
  succeed("render cube.stl -o all.svg --shading flat --visible-only no --background transparent --quiet");
  EXPECT_EQ(count("all.svg", "<path"), 12u);
}

TEST_F(Figures, HaveNoHash) {
  const std::string lines = succeed("render cube.stl -o cube.svg -o cube.png --hash --quiet").out;
  EXPECT_THAT(lines, testing::Not(HasSubstr("figure")));
  EXPECT_THAT(lines, HasSubstr(" cube.png"));
}

TEST_F(Figures, KeepWhatShowsThrough) {
  EXPECT_THAT(succeed("render cube.stl -o glass.svg --shading flat --opacity 0.5 --quiet").err, IsEmpty());
  EXPECT_EQ(count("glass.svg", "<path"), 13u);                                            // includes the background
  EXPECT_EQ(count("glass.svg", "<g inkscape:label=\"surfaces\" opacity=\".502\">"), 2u);  // the far sides and the near
                                                                                          // ones
  EXPECT_EQ(count("glass.svg", "fill-opacity"), 0u);
}

TEST_F(Figures, StandBesidePixels) {
  const Outcome outcome = succeed("render cube.stl -o {model}.svg -o {model}.pdf -o {model}.png --json --quiet");
  EXPECT_THAT(files(), testing::ElementsAre("cube.pdf", "cube.png", "cube.stl", "cube.svg"));
  EXPECT_THAT(read("cube.pdf"), StartsWith("%PDF"));
  EXPECT_EQ(outcome.json()["files"].size(), 3u);
  EXPECT_EQ(outcome.json()["method"], "zbuffer");  // the method of the pixels
  EXPECT_EQ(outcome.json()["files"][2]["method"], "painter");
  EXPECT_EQ(succeed("render cube.stl -o {model}.svg --json --quiet").json()["method"], "painter");
}

TEST_F(Figures, ShowColoursOfTheirShading) {
  succeed("render cube.stl -o ids.svg --shading ids --background red --quiet");
  EXPECT_THAT(read("ids.svg"), HasSubstr("#ff0000"));
  EXPECT_EQ(count("ids.svg", "<path"), 7u);
}

TEST_F(Figures, AreCutWhereColoursVary) {
  succeed("render builtin:gallery --resolution 96,54 -o coarse.svg --shading flat --color-tolerance 255 --quiet");
  succeed("render builtin:gallery --resolution 96,54 -o fine.svg --shading flat --quiet");
  EXPECT_GT(count("fine.svg", "<path"), count("coarse.svg", "<path") + 200);
  succeed("render cube.stl -o depths.svg --shading depth --quiet");
  EXPECT_GT(count("depths.svg", "<path"), 10u);
}

TEST_F(Figures, MergeNeighboursOnRequest) {
  succeed("render builtin:teapot -o apart.svg --shading ids --resolution 96,54 --quiet");
  succeed(
      "render builtin:teapot -o joined.svg -o joined.pdf --shading ids --resolution 96,54 --merge-neighbours "
      "--quiet");
  EXPECT_LT(3 * count("joined.svg", "<path"), count("apart.svg", "<path"));
  EXPECT_LT(2 * read("joined.svg").size(), read("apart.svg").size());
  EXPECT_THAT(read("joined.pdf"), StartsWith("%PDF"));
}

TEST_F(Figures, AreTheSameForAnyNumberOfThreads) {
  succeed("render builtin:teapot --resolution 96,54 -o one.svg --threads 1 --quiet");
  succeed("render builtin:teapot --resolution 96,54 -o three.svg --threads 3 --quiet");
  EXPECT_EQ(read("one.svg"), read("three.svg"));
}

TEST_F(Figures, StandBesideFilesWhoseFormatIsGiven) {
  succeed("render cube.stl -o a.svg -o b.exr --depth - --format npy --quiet");
  EXPECT_THAT(files(), testing::ElementsAre("a.svg", "b.exr", "cube.stl"));
}

TEST_F(Figures, RefuseWhatTheyCannotBe) {
  expect_failure("render cube.stl -o a.svg --most-polygons 5", 1,
                 "a.svg: 6 polygons, more than 5; see --most-polygons");
  expect_failure("render cube.stl -o a.svg --method abuffer", 2, "without --method");
  expect_failure("render cube.stl -o a.svg --stream", 2, "whole model");
  expect_failure("render cube.stl -o a.svg --camera-model panorama", 2, "pinhole");
  expect_failure("render cube.stl -o a.svg --color-tolerance 256", 2, "--color-tolerance");
  expect_failure("render cube.stl -o a.svg -o a.svg", 2, "written twice");
  expect_failure("render cube.stl -o a.svg --format png", 2, "a.svg: --format differs from the suffix");
  expect_failure("render cube.stl -o a.png --depth b.exr --format png", 2, "b.exr: --format differs from the suffix");
  EXPECT_THAT(files(), testing::ElementsAre("cube.stl"));
}

}  // namespace
}  // namespace frontmost::test
