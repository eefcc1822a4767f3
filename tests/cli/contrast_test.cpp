// SPDX-License-Identifier: Apache-2.0
// A picture where nothing stands out from the background gets a message; others do not.
#include <gmock/gmock.h>

#include "cli/render/blank.h"
#include "program.h"

namespace frontmost::test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

constexpr const char* says = "warning: nothing in the picture stands out from its background";

/// A square before the camera, unlit, with this emissive colour.
std::string square(const std::string& color) {
  return R"({"asset":{"version":"2.0"},"extensionsUsed":["KHR_materials_unlit"],
    "materials":[{"pbrMetallicRoughness":{"baseColorFactor":[)" +
         color + R"(,1]},"extensions":{"KHR_materials_unlit":{}},"doubleSided":true}],
    "buffers":[{"byteLength":72,"uri":"square.bin"}],"bufferViews":[{"buffer":0,"byteLength":72}],
    "accessors":[{"bufferView":0,"componentType":5126,"count":6,"type":"VEC3"}],
    "meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0}]}],"nodes":[{"mesh":0}],"scenes":[{"nodes":[0]}]})";
}

class Contrast : public ProgramTest {
 protected:
  Contrast() {
    const float corners[6][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    write("square.bin", std::string(reinterpret_cast<const char*>(corners), sizeof corners));
    write("white.gltf", square("1,1,1"));
    write("nearly.gltf", square("0.95,0.95,0.95"));
    write("grey.gltf", square("0.5,0.5,0.5"));
  }
};

TEST_F(Contrast, WhiteOnWhiteSaysSo) {
  const std::string view = " --resolution 64,64 --view front ";
  for (const char* file : {"-o a.png", "-o a.exr", "-o a.png --bits 16", "-o a.svg -q", "-o a.png --method abuffer",
                           "-o a.png --camera-model fisheye", "-o a.png --hash"}) {
    const Outcome white = succeed("render white.gltf" + view + file);
    if (std::string(file).find("-q") == std::string::npos) {
      EXPECT_THAT(white.err, HasSubstr(says)) << file;
    }
    EXPECT_THAT(succeed("render grey.gltf" + view + file).err, Not(HasSubstr(says))) << file;
  }
  EXPECT_THAT(succeed("render white.gltf -o a.svg" + view).err, HasSubstr(says));
  EXPECT_THAT(succeed("render grey.gltf -o a.svg" + view).err, Not(HasSubstr(says)));
  EXPECT_THAT(succeed("render nearly.gltf -o a.png" + view).err, HasSubstr(says)) << "6 of 255 steps";
  EXPECT_THAT(succeed("render white.gltf -o a.png --background black" + view).err, IsEmpty());
  EXPECT_THAT(succeed("render grey.gltf -o a.png --background #bcbcbc" + view).err, HasSubstr(says));
  // Edges stand out, in pictures and in figures.
  for (const char* file : {"a.png", "a.exr", "a.svg"}) {
    EXPECT_THAT(succeed("render white.gltf --edges -o " + (file + view)).err, Not(HasSubstr(says))) << file;
  }
  EXPECT_THAT(succeed("render white.gltf --json -o a.png" + view).json()["warnings"].dump(), HasSubstr("stands out"));
}

TEST_F(Contrast, CullingByTheMaterialAsksIt) {
  const std::string both = square("0.5,0.5,0.5"), word = R"("doubleSided":true)";
  write("both.gltf", both);
  write("one.gltf", std::string(both).replace(both.find(word), word.size(), R"("doubleSided":false)"));
  const std::string view = " --resolution 64,64 --cull material -o a.png --view ";
  EXPECT_THAT(succeed("render both.gltf" + view + "back").err, IsEmpty());
  EXPECT_THAT(succeed("render one.gltf" + view + "front").err, IsEmpty());
  EXPECT_THAT(succeed("render one.gltf" + view + "back").err,
              HasSubstr("nothing is in view: all of the model faces the side that --cull leaves out"));
}

TEST_F(Contrast, WhatMaterialsHideIsSaidToBeHiddenByThem) {
  const std::string plain = square("0.5,0.5,0.5"), at = R"("doubleSided":true)";
  const auto with = [&](const std::string& alpha) {
    return std::string(plain).replace(plain.find(at), at.size(), at + alpha);
  };
  write("holes.gltf", with(R"(,"alphaMode":"MASK","alphaCutoff":1.5)"));
  EXPECT_THAT(
      succeed("render holes.gltf --view front -o a.png").err,
      HasSubstr("nothing is in view: all of the model in the picture is cut away by alpha mode MASK of its materials"));
  EXPECT_THAT(succeed("render holes.gltf --camera-position 0,0,9 --camera-direction +z -o a.png").err,
              HasSubstr("all of the model is behind the camera"));
  std::string clear = with(R"(,"alphaMode":"BLEND")");
  clear.replace(clear.find("0.5,1]"), 6, "0.5,0]");
  write("clear.gltf", clear);
  EXPECT_THAT(succeed("render clear.gltf --view front -o a.png").err,
              HasSubstr("stands out from its background: the opacity of all materials in it is 0"));
}

TEST_F(Contrast, WhatIsNoPictureOrHasNoBackgroundSaysNothing) {
  const std::string view = " --resolution 64,64 --view front ";
  for (const char* file :
       {"--depth a.png", "--ids object=a.png", "--normals a.exr", "-o a.png --background transparent",
        "-o a.png --camera-position 0,0,9 --camera-direction +z"}) {
    const std::string line = "render white.gltf --resolution 64,64 " + std::string(file);
    EXPECT_THAT(succeed(line).err, Not(HasSubstr(says))) << file;
  }
  EXPECT_THAT(succeed("render white.gltf -q -o a.png" + view).err, IsEmpty());
  EXPECT_THAT(succeed("render builtin:teapot -o a.png").err, IsEmpty());
}

TEST(NothingStandsOut, CountsThoseOfOneInAThousand) {
  Bitmap picture{100, 100, Buffer<std::uint8_t>(40000, 255)};
  std::vector<PrimitiveId> seen(10000, 7);
  const glm::vec3 white(1);
  EXPECT_TRUE(cli::nothing_stands_out(picture, seen, white));
  for (std::size_t i = 0; i < 9; ++i) picture.rgba[4 * i + 1] = 246;
  EXPECT_TRUE(cli::nothing_stands_out(picture, seen, white)) << "nine of ten thousand, by nine steps";
  picture.rgba[4 * 9000 + 1] = 247;
  EXPECT_TRUE(cli::nothing_stands_out(picture, seen, white)) << "and one by eight";
  picture.rgba[4 * 9000 + 1] = 246;
  EXPECT_FALSE(cli::nothing_stands_out(picture, seen, white)) << "and one by nine";
  seen.assign(10000, no_primitive);
  EXPECT_FALSE(cli::nothing_stands_out(picture, seen, white)) << "nothing is seen";
  seen[9000] = 0;
  EXPECT_FALSE(cli::nothing_stands_out(picture, seen, white)) << "all of one";
}

TEST(NothingStandsOut, TakesLinearColoursForWhatIsShown) {
  Image picture{2, 1, {}};
  for (const char* name : {"R", "G", "B", "A"}) picture.channels.push_back({name, Buffer<float>(2, 1.0f)});
  const std::vector<PrimitiveId> seen{1, no_primitive};
  EXPECT_TRUE(cli::nothing_stands_out(picture, seen, glm::vec3(1)));
  picture.channels[0].floats()[0] = 5;
  EXPECT_TRUE(cli::nothing_stands_out(picture, seen, glm::vec3(1))) << "brighter than white is white";
  picture.channels[0].floats()[0] = 0.5f;  // 188 of 255
  EXPECT_FALSE(cli::nothing_stands_out(picture, seen, glm::vec3(1)));
  EXPECT_TRUE(cli::nothing_stands_out(picture, seen, {188 / 255.0f, 1, 1}));
  EXPECT_TRUE(cli::nothing_stands_out(picture, seen, {181 / 255.0f, 1, 1}));
  EXPECT_FALSE(cli::nothing_stands_out(picture, seen, {179 / 255.0f, 1, 1}));
}

}  // namespace
}  // namespace frontmost::test
