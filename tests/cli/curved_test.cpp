// SPDX-License-Identifier: Apache-2.0
// Models with spheres and patches: rays that meet them, and triangles as fine as is asked for.
#include <frontmost/io.h>
#include <gmock/gmock.h>

#include <cmath>
#include <set>

#include "program.h"

namespace frontmost::test {
namespace {

using nlohmann::json;

class Curved : public ProgramTest {
 protected:
  [[nodiscard]] Image image(const std::string& name) const { return load_image(path(name)); }
  [[nodiscard]] json report(const std::string& line) const { return succeed(line + " --json").json(); }
};

/// Of three channels.
double mean_difference(const Image& a, const Image& b) {
  double sum = 0;
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < a.channels[c].floats().size(); ++i)
      sum += std::abs(a.channels[c].floats()[i] - b.channels[c].floats()[i]);
  return sum / (3.0 * double(a.channels[0].floats().size()));
}

const std::string small = " --resolution 160,120 ";

TEST_F(Curved, RaysMeetThePatchesThemselves) {
  const json seen = report("render builtin:teapot --method raycast" + small + "--ids primitive=ids.exr -o a.png");
  EXPECT_EQ(seen["method"], "raycast");
  const Image shown = image("ids.exr");
  const auto& all = shown.channels.front().integers();
  const std::set<std::uint32_t> ids(all.begin(), all.end());
  EXPECT_GT(ids.size(), 20u);
  EXPECT_EQ(*ids.rbegin(), 0xFFFFFFFFu);
  EXPECT_LT(*++ids.rbegin(), 32u);  // patches, of which there are 32
}

TEST_F(Curved, TrianglesComeToTheSamePixelsAsTheyBecomeFiner) {
  const double exact = report("render builtin:teapot --method raycast" + small)["seen"]["covered_pixels"];
  const auto cut = [&](const std::string& options) -> double {
    return report("render builtin:teapot " + options + small)["seen"]["covered_pixels"];
  };
  EXPECT_NEAR(cut("--tessellation-error 0.02"), exact, 3);
  EXPECT_NEAR(cut("--tessellation-error 0.02 --method raycast"), exact, 3);
  EXPECT_GT(std::abs(cut("--tessellation-error 20") - exact), std::abs(cut("--tessellation-error 0.02") - exact));
}

// The camera goes by the model's own triangles, whichever are drawn.
TEST_F(Curved, TheCameraIsTheSameForBoth) {
  const json a = report("render builtin:spheres --method raycast" + small),
             b = report("render builtin:spheres --tessellation-error 1" + small),
             c = report("render builtin:spheres" + small);
  EXPECT_EQ(a["view"], c["view"]);
  EXPECT_EQ(b["view"], c["view"]);
}

TEST_F(Curved, PicturesByBothRoadsAreAlike) {
  succeed("render builtin:spheres --method raycast" + small + "-o exact.exr --normals exact-n.exr");
  succeed("render builtin:spheres --tessellation-error 0.02" + small + "-o fine.exr --normals fine-n.exr");
  for (const auto& [exact, fine] : {std::pair("exact.exr", "fine.exr"), std::pair("exact-n.exr", "fine-n.exr")}) {
    EXPECT_LT(mean_difference(image(exact), image(fine)), 0.004) << exact;
  }
}

TEST_F(Curved, ShadowsByRaysFallWhereThoseOfTheMapDo) {
  succeed("render builtin:spheres --method raycast" + small + "-o map.exr");
  succeed("render builtin:spheres --method raycast --shadows rays" + small + "-o rays.exr");
  succeed("render builtin:spheres --method raycast --shadows off" + small + "-o off.exr");
  EXPECT_LT(mean_difference(image("map.exr"), image("rays.exr")), 0.006);
  EXPECT_GT(mean_difference(image("off.exr"), image("rays.exr")), 0.012);
}

TEST_F(Curved, CompareExplainsEveryPixelOnFineTriangles) {
  const json found = report("compare builtin:teapot --tessellation-error 0.5 --runs 1" + small);
  const json coarse = report("compare builtin:teapot --tessellation-error 5 --runs 1" + small);
  for (const json& method : found["methods"]) {
    if (method["method"] == "painter-centroid") continue;  // wrong by its nature
    EXPECT_EQ(method["unexplained"], 0) << method["method"];
  }
  EXPECT_GT(found["methods"][0]["primitives"], coarse["methods"][0]["primitives"]);
}

// The knob's top is 3.15 above the ground.
TEST_F(Curved, SightMeetsPatches) {
  EXPECT_THAT(succeed("sight builtin:teapot --from 0,9,0 --to 0,-9,0").out,
              ::testing::ContainsRegex("blocked by object 0 \\(teapot\\), patch [0-9]+, at 0,3.15,0, distance 5.85"));
  const json seen = report("sight builtin:spheres --from 0,9,0.1 --to 0.3,-9,0.2");
  EXPECT_EQ(seen["clear"], 0);
  EXPECT_TRUE(seen["pairs"][0].contains("triangle")) << "the stage is no sphere";
}

TEST_F(Curved, ALidarMeetsPatchesAndCountsThem) {
  const json seen = report("lidar builtin:teapot --from 0,9,0 --forward -y --rings 9 --steps 90 -o a.exr -o a.ply");
  EXPECT_GT(seen["points"], 10);
  EXPECT_NEAR(double(seen["nearest"]), 5.85, 1e-5);
  const Image met = image("a.exr");
  for (const std::uint32_t id : met.find("primitive")->integers()) EXPECT_TRUE(id < 32 || id == 0xFFFFFFFFu);
}

TEST_F(Curved, PanoramasMeetSpheresThemselves) {
  const std::string around =
      "render builtin:spheres --camera-model panorama --camera-position 0,3,0 --resolution 128,64 ";
  const json seen = report(around + "--ids primitive=ids.exr --shading normals -o a.png");
  succeed(
      "render builtin:spheres --camera-model panorama --camera-position 0,3,0 --resolution 128,64 "
      "--method raycast --ids primitive=same.exr");
  const Image ids = image("ids.exr"), same = image("same.exr");
  std::set<std::uint32_t> all(ids.channels[0].integers().begin(), ids.channels[0].integers().end());
  EXPECT_TRUE(std::equal(ids.channels[0].integers().begin(), ids.channels[0].integers().end(),
                         same.channels[0].integers().begin()));
  EXPECT_GT(all.size(), 20u);
  EXPECT_GT(seen["seen"]["objects"].size(), 20u);
}

TEST_F(Curved, OtherModelsAreNotTouched) {
  write("cube.stl", cube_stl());
  EXPECT_EQ(succeed("render cube.stl --hash" + small).out,
            succeed("render cube.stl --tessellation-error 0.1 --hash" + small).out);
}

TEST_F(Curved, ErrorsHaveTheirLimits) {
  expect_failure("render builtin:teapot --tessellation-error 0 -o a.png", 2, "--tessellation-error");
  expect_failure("render builtin:teapot --tessellation-error x -o a.png", 2, "--tessellation-error");
}

}  // namespace
}  // namespace frontmost::test
