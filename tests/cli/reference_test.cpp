// SPDX-License-Identifier: Apache-2.0
// --reference: the comparison passes, or fails with its own exit status and a picture of the differences.
#include <gmock/gmock.h>

#include "program.h"

namespace frontmost::test {
namespace {

using testing::HasSubstr;

class Reference : public ProgramTest {
 protected:
  Reference() {
    write("cube.stl", cube_stl());
    succeed("render cube.stl --resolution 48,32 -o old.png");
  }
};

TEST_F(Reference, TheSamePicturePasses) {
  const Outcome outcome = succeed("render cube.stl --resolution 48,32 -o new.png --reference old.png --json");
  EXPECT_EQ(outcome.json()["reference"]["passed"], true);
  EXPECT_EQ(outcome.json()["reference"]["differing_pixels"], 0);
  EXPECT_FALSE(exists("new.difference.png"));
  succeed("render cube.stl --resolution 48,32 --reference old.png");
}

TEST_F(Reference, AnotherPictureFailsAndShowsWhere) {
  const Outcome outcome = run({"render", "cube.stl", "--resolution", "48,32", "--view", "iso", "-o", "new.png",
                               "--reference", "old.png", "--json"});
  EXPECT_EQ(outcome.status, 3);
  EXPECT_THAT(outcome.err, HasSubstr("old.png: "));
  EXPECT_THAT(outcome.err, HasSubstr("pixels differ"));
  EXPECT_EQ(outcome.json()["reference"]["passed"], false);
  EXPECT_GT(outcome.json()["reference"]["differing_pixels"], 0);
  EXPECT_EQ(outcome.json()["reference"]["difference_file"], "new.difference.png");
  EXPECT_TRUE(exists("new.png"));
  EXPECT_TRUE(exists("new.difference.png"));
}

TEST_F(Reference, TheThresholdForgives) {
  succeed("render cube.stl --resolution 48,32 --view iso --reference old.png --reference-threshold 1");
  EXPECT_EQ(run({"render", "cube.stl", "--resolution", "48,32", "--view", "iso", "--reference", "old.png",
                 "--reference-threshold", "0.01", "--reference-difference", "d.exr"})
                .status,
            3);
  EXPECT_TRUE(exists("d.exr"));
}

TEST_F(Reference, WrongReferencesAreNamed) {
  expect_failure("render cube.stl --resolution 48,32 --reference none.png", 1, "none.png");
  expect_failure("render cube.stl --resolution 40,32 --reference old.png", 1, "old.png: ");
  write("cut.png", read("old.png").substr(0, 60));
  for (const char* name : {"none.png", "cut.png", "cube.stl"})
    expect_failure(std::string("render cube.stl --resolution 48,32 -o new.png --depth new.exr --reference ") + name, 1,
                   name);
  expect_failure("render cube.stl --resolution 40,32 -o new.png --depth new.exr --reference old.png", 1, "old.png: ");
  expect_failure("render cube.stl --camera-model fisheye --resolution 40,32 -o new.png --reference old.png", 1,
                 "old.png: ");
  EXPECT_FALSE(exists("new.png") || exists("new.exr")) << "written before the reference was read";
  expect_failure("render cube.stl -o ./old.png --reference old.png", 2, "is both the reference and an output");
  expect_failure("render cube.stl --reference old.png --reference-threshold 2", 2, "--reference-threshold");
}

// A run reads all input files, those of the last view too, before it writes any.
TEST_F(Reference, OfALaterViewIsReadBeforeAnythingIsWritten) {
  write("views.json", R"({"views": [{"name": "old"}, {"name": "late"}]})");
  const std::string line = "render cube.stl --batch views.json --resolution 48,32 -o new_{view}.png --reference ";
  for (const char* bytes : {"", "no picture"}) {
    if (*bytes) write("late.png", bytes);
    expect_failure(line + "{view}.png", 1, "late.png: ");
    EXPECT_FALSE(exists("new_old.png")) << bytes;
  }
  write("late.png", read("old.png"));
  succeed(line + "{view}.png");
  EXPECT_TRUE(exists("new_old.png") && exists("new_late.png"));
  write(
      "poses.json",
      R"({"views": [{"name": "a"}, {"name": "b", "pose": "none.txt", "pose-convention": "opengl-camera-to-world"}]})");
  expect_failure("render cube.stl --batch poses.json --resolution 48,32 -o new_{view}.png", 2, "none.txt");
  EXPECT_FALSE(exists("new_a.png"));
}

}  // namespace
}  // namespace frontmost::test
