// SPDX-License-Identifier: Apache-2.0
// frontmost render: methods by name, opacity, single layers and deep files.
#include <frontmost/files.h>
#include <gmock/gmock.h>

#include <cmath>

#include "program.h"
#include "support/effort.h"

namespace frontmost::test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

class Layers : public ProgramTest {
 protected:
  Layers() { write("cube.stl", cube_stl()); }
  [[nodiscard]] Image image(const std::string& name) const { return load_image(path(name)); }
};

constexpr std::size_t beside_middle = 32 * 64 + 33;

TEST_F(Layers, AreWrittenOneByOne) {
  EXPECT_THAT(succeed(render_cube + "--opacity 0.5 --layers 3 --background transparent --samples 1 --shading flat "
                                    "-o {model}{layer}.exr --depth {model}{layer}.exr --ids primitive=p{layer}.npy")
                  .err,
              IsEmpty());
  EXPECT_THAT(files(), ElementsAre("cube.stl", "cube0.exr", "cube1.exr", "cube2.exr", "p0.npy", "p1.npy", "p2.npy"));
  EXPECT_FLOAT_EQ(image("cube0.exr").find("Z")->floats()[beside_middle], 10);
  EXPECT_FLOAT_EQ(image("cube1.exr").find("Z")->floats()[beside_middle], 11);
  EXPECT_TRUE(std::isinf(image("cube2.exr").find("Z")->floats()[beside_middle]));
  EXPECT_FLOAT_EQ(image("cube1.exr").find("A")->floats()[beside_middle], 0.5f);
  EXPECT_FLOAT_EQ(image("cube2.exr").find("A")->floats()[beside_middle], 0);
  EXPECT_NE(image("p0.npy").channels[0].integers()[beside_middle],
            image("p1.npy").channels[0].integers()[beside_middle]);
  EXPECT_EQ(image("p2.npy").channels[0].integers()[beside_middle], no_index);
}

TEST_F(Layers, EndBehindWhatIsOpaque) {
  succeed(render_cube + "--layers 2 --depth d{layer}.exr --depth nearest.exr");
  EXPECT_FLOAT_EQ(image("d0.exr").find("Z")->floats()[beside_middle], 10);
  EXPECT_TRUE(std::isinf(image("d1.exr").find("Z")->floats()[beside_middle]));
  EXPECT_EQ(read("d0.exr"), read("nearest.exr"));
}

TEST_F(Layers, OpacityLetsTheBackgroundThrough) {
  succeed(render_cube + "--opacity 0.5 --shading flat --background transparent -o o.exr");
  EXPECT_FLOAT_EQ(image("o.exr").find("A")->floats()[beside_middle], 0.75f);
  succeed(render_cube + "--opacity 0 --background red -o nothing.exr");
  EXPECT_EQ(image("nothing.exr").find("R")->floats()[beside_middle], 1);
  EXPECT_EQ(image("nothing.exr").find("G")->floats()[beside_middle], 0);
}

TEST_F(Layers, DeepFilesAreWritten) {
  const Outcome outcome = succeed(render_cube + "--opacity 0.5 --deep all.exr --json");
  EXPECT_EQ(outcome.json()["files"][0]["what"], "deep");
  EXPECT_EQ(read("all.exr").substr(0, 4), "\x76\x2f\x31\x01");
  EXPECT_GT(read("all.exr").size(), 1000u);
  // The hash does not depend on threads.
  const auto hashes = [&](const std::string& options) {
    return succeed(render_cube + "--deep h.exr --hash " + options).out;
  };
  EXPECT_EQ(hashes("--threads 1"), hashes("--threads 3"));
  EXPECT_NE(hashes("").find("deep "), std::string::npos);
}

/// An OBJ of sheets one behind the other, each filling the picture.
std::string stack_obj(int count) {
  std::string text;
  for (int i = 0; i < count; ++i)
    for (const char* corner : {"-9 -9 ", "9 -9 ", "9 9 ", "-9 9 "})
      text += "v " + std::string(corner) + std::to_string(-0.01 * i) + "\n";
  for (int i = 0; i < count; ++i)
    text += "f " + std::to_string(4 * i + 1) + " " + std::to_string(4 * i + 2) + " " + std::to_string(4 * i + 3) + " " +
            std::to_string(4 * i + 4) + "\n";
  return text;
}

// The 7 million fragments would take 250 MB as lists, and as much again during their construction.
TEST_F(Layers, FiveHundredFitIntoTheMemoryOfFew) {
  if (under_sanitizer) GTEST_SKIP() << "the sanitizer takes all addresses";
  write("stack.obj", stack_obj(500));
  const auto call = [&](const std::vector<std::string>& output) {
    Call one{.words = {"render", "stack.obj", "--opacity", "0.01", "--camera-position", "0,0,5", "--camera-direction",
                       "0,0,-1", "--resolution", "160,90", "--samples", "1", "--threads", "1"}};
    one.words.insert(one.words.end(), output.begin(), output.end());
    one.address_space = std::size_t(256) << 20;
    return one;
  };
  const Outcome picture = run(call({"--background", "transparent", "-o", "stack.exr"}));
  EXPECT_EQ(picture.status, 0) << picture.err;
  EXPECT_NEAR(image("stack.exr").find("A")->floats()[45 * 160 + 80], 1 - std::pow(0.99, 500), 1e-5);
  EXPECT_EQ(run(call({"--deep", "deep.exr"})).status, 1);
}

TEST_F(Layers, TheMethodIsNamed) {
  const auto method = [&](const std::string& options) {
    return succeed(render_cube + "-o m.png --json " + options).json()["method"].get<std::string>();
  };
  EXPECT_EQ(method(""), "zbuffer");
  EXPECT_EQ(method("--opacity 0.5"), "abuffer");
  EXPECT_EQ(method("--method abuffer"), "abuffer");
  EXPECT_EQ(method("--method raycast"), "raycast");
}

TEST_F(Layers, EveryMethodSeesTheSameSolid) {
  const auto hash = [&](const std::string& method) { return succeed(render_cube + "--hash --method " + method).out; };
  EXPECT_EQ(hash("abuffer"), hash("zbuffer"));
  succeed(render_cube + "-o z.png --samples 16");
  succeed(render_cube + "-o a.png --samples 16 --method abuffer --reference z.png --reference-threshold 0.02");
  succeed(render_cube + "-o fine.png --samples 64 --method abuffer --reference z.png --reference-threshold 0.2");
}

TEST_F(Layers, ContradictionsAreRefused) {
  expect_failure(render_cube + "-o a.png --method zbuffer --opacity 0.5", 2, "need the A-buffer");
  expect_failure(render_cube + "-o a.png --depth-format D16 --opacity 0.5", 2, "need the A-buffer");
  expect_failure(render_cube + "--deep a.exr --method raycast", 2, "need the A-buffer");
  expect_failure(render_cube + "-o a.png --samples 64", 2, "needs --method abuffer");
  expect_failure(render_cube + "-o a.png --layers 2", 2, "no output has {layer}");
  expect_failure(render_cube + "-o a{layer}.png", 2, "{layer} with --layers");
  expect_failure(render_cube + "--deep a{layer}.exr --layers 2", 2, "one file for all layers");
  expect_failure(render_cube + "--deep a.png", 2, "a deep file must be .exr");
  expect_failure(render_cube + "--deep a.exr --depth a.exr", 2, "two outputs have this name");
  expect_failure(render_cube + "-o a{layer}.png --layers 0", 2, "layers");
  expect_failure(render_cube + "-o a.png --stream --opacity 0.5", 2, "--stream keeps only the nearest surface");
  expect_failure("render cube.stl --camera-model panorama --deep a.exr", 2, "--camera-model excludes");
  expect_failure("render cube.stl -o a{layer}.png --layers 1024 --resolution 4096,4096", 1, "2^30 samples");
  EXPECT_THAT(files(), ElementsAre("cube.stl"));
}

}  // namespace
}  // namespace frontmost::test
