// SPDX-License-Identifier: Apache-2.0
// No output overwrites a file that the run reads, whatever the name.
#include <gmock/gmock.h>

#include <filesystem>

#include "program.h"

namespace frontmost::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class Inputs : public ProgramTest {
 protected:
  Inputs() {
    write("cube.stl", cube_stl());
    write("quad.obj",
          "mtllib quad.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl m\n"
          "f 1/1 2/2 3/3 4/4\n");
    write("quad.mtl", "newmtl m\nmap_Kd skin.png\n");
    succeed("render cube.stl -o skin.png --resolution 8,8");
    write("buffer.bin", std::string(36, '\0'));
    write("mesh.gltf", R"({"asset":{"version":"2.0"},"buffers":[{"uri":"buffer.bin","byteLength":36}],
      "bufferViews":[{"buffer":0,"byteLength":36}],
      "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],
      "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"nodes":[{"mesh":0}],"scenes":[{"nodes":[0]}]})");
    write("views.json", R"({"views":[{"view":"front"}]})");
    write("pose.txt", "1 0 0 0\n0 1 0 0\n0 0 1 9\n");
    write("pairs.txt", "0 0 0 1 1 1\n");
    write("directions.txt", "0 0 -1\n");
  }

  /// Checks that the call is refused with these words, and that no file changes.
  void expect_kept(const std::string& line, const std::string& words) const {
    std::vector<std::string> before;
    for (const std::string& name : files())
      if (fs::is_regular_file(path(name))) before.push_back(name + read(name));
    expect_failure(line, 2, words);
    std::vector<std::string> after;
    for (const std::string& name : files())
      if (fs::is_regular_file(path(name))) after.push_back(name + read(name));
    EXPECT_EQ(before, after) << line;
  }
};

TEST_F(Inputs, OfEveryKindAreKept) {
  const std::string pose = " --pose pose.txt --pose-convention opengl-camera-to-world";
  expect_kept("render cube.stl --format png -o cube.stl", "cube.stl: is the model itself");
  expect_kept("render quad.obj cube.stl --format png -o cube.stl", "cube.stl: is the model itself");
  expect_kept("render cube.stl --batch views.json --format png -o views.json", "views.json: is the batch file itself");
  expect_kept("render cube.stl --format png -o pose.txt" + pose, "pose.txt: is the pose file itself");
  expect_kept("lines cube.stl --format svg -o pose.txt" + pose, "pose.txt: is the pose file itself");
  expect_kept("precision cube.stl --plot pose.txt" + pose, "pose.txt: is the pose file itself");
  expect_kept("render cube.stl --reference skin.png -o skin.png", "skin.png: is both the reference and an output");
  expect_kept("render cube.stl --reference skin.png -o a.png --reference-difference skin.png",
              "skin.png: is both the reference and an output");
}

TEST_F(Inputs, WhatAModelUsesIsKept) {
  expect_kept("render quad.obj -o skin.png", "skin.png: is a file that the model uses");
  expect_kept("render quad.obj -o a.png --depth ./skin.png", "skin.png: is a file that the model uses");
  expect_kept("render cube.stl quad.obj -o skin.png", "skin.png: is a file that the model uses");
  expect_kept("render quad.obj --format png -o quad.mtl", "quad.mtl: is a file that the model uses");
  expect_kept("render mesh.gltf --format png -o buffer.bin", "buffer.bin: is a file that the model uses");
  expect_kept("lines quad.obj --format svg -o quad.mtl", "quad.mtl: is a file that the model uses");
  expect_kept("precision quad.obj --plot quad.mtl", "quad.mtl: is a file that the model uses");
  fs::copy(path("directions.txt"), path("rays.ply"));
  expect_kept("lidar cube.stl --from 0,0,9 --directions rays.ply -o rays.ply",
              "rays.ply: is the file of directions itself");
}

TEST_F(Inputs, LinksLeadToTheSameFile) {
  fs::create_symlink("skin.png", path("soft.png"));
  fs::create_hard_link(path("skin.png"), path("hard.png"));
  fs::create_hard_link(path("cube.stl"), path("cube.png"));
  fs::create_hard_link(path("views.json"), path("views.png"));
  for (const char* name : {"soft.png", "hard.png"}) {
    expect_kept(std::string("render quad.obj -o ") + name, std::string(name) + ": is a file that the model uses");
    expect_kept(std::string("render cube.stl --reference skin.png -o ") + name, "is both the reference and an output");
  }
  expect_kept("render cube.stl -o cube.png", "cube.png: is the model itself");
  expect_kept("render cube.stl --batch views.json -o views.png", "views.png: is the batch file itself");
}

TEST_F(Inputs, ViewsOfABatchKeepEachOthersPoses) {
  write(
      "b.json",
      R"({"views":[{"outputs":{"output":"pose.png"}},{"pose":"pose.png","pose-convention":"opengl-camera-to-world"}]})");
  fs::copy(path("pose.txt"), path("pose.png"));
  expect_kept("render cube.stl --batch b.json --hash", "pose.png: is the pose file itself");
}

TEST_F(Inputs, APageKeepsAModelThatLiesInItsFolder) {
  fs::create_directory(path("page"));
  fs::copy(path("cube.stl"), path("page/index.html"));
  fs::copy(path("cube.stl"), path("page/raycast.png"));
  for (const char* name : {"page/index.html", "page/raycast.png"}) {
    expect_failure(std::string("compare --input-format stl -o page ") + name, 2,
                   std::string(name) + ": is the model itself");
    EXPECT_EQ(read(name), cube_stl());
  }
  fs::copy(path("quad.obj"), path("page/quad.obj"));
  fs::copy(path("quad.mtl"), path("page/quad.mtl"));
  write("page/quad.mtl", "newmtl m\nmap_Kd zbuffer.png\n");
  fs::copy(path("skin.png"), path("page/zbuffer.png"));
  expect_failure("compare page/quad.obj -o page --runs 1 --resolution 16,16", 2,
                 "page/zbuffer.png: is a file that the model uses");
  EXPECT_EQ(read("page/zbuffer.png"), read("skin.png"));
}

TEST_F(Inputs, WhatIsNoFileMayBeBoth) {
  const Outcome outcome =
      run(Call{.words = {"render", "-", "-o", "-", "--format", "png", "--resolution", "8,8"}, .input = cube_stl()});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("PNG"));
}

}  // namespace
}  // namespace frontmost::test
