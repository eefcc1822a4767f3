// SPDX-License-Identifier: Apache-2.0
// Models with spheres and patches: all methods see triangles as fine as requested.
#include <frontmost/files.h>
#include <gmock/gmock.h>

#include <cmath>

#include "program.h"

namespace frontmost::test {
namespace {

using nlohmann::json;

class Curved : public ProgramTest {
 protected:
  [[nodiscard]] Image image(const std::string& name) const { return load_image(path(name)); }
  [[nodiscard]] json report(const std::string& line) const { return succeed(line + " --json").json(); }
};

/// Mean difference over three channels.
double mean_difference(const Image& a, const Image& b) {
  double sum = 0;
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < a.channels[c].floats().size(); ++i)
      sum += std::abs(a.channels[c].floats()[i] - b.channels[c].floats()[i]);
  return sum / (3.0 * double(a.channels[0].floats().size()));
}

const std::string small = " --resolution 160,120 ";

TEST_F(Curved, TrianglesComeToTheSamePixelsAsTheyBecomeFiner) {
  const auto cut = [&](const std::string& options) -> double {
    return report("render builtin:teapot " + options + small)["seen"]["covered_pixels"];
  };
  const double fine = cut("--tessellation-error 0.002");
  EXPECT_NEAR(cut("--tessellation-error 0.02"), fine, 3);
  EXPECT_GT(std::abs(cut("--tessellation-error 20") - fine), std::abs(cut("--tessellation-error 0.02") - fine));
}

// Rays meet the z-buffer's triangles, so both see the same.
TEST_F(Curved, RaysMeetTheTrianglesThatAreAskedFor) {
  for (const std::string error : {"", "--tessellation-error 0.5 "}) {
    const json by_rays = report("render builtin:teapot --method raycast " + error + small)["seen"];
    const json by_zbuffer = report("render builtin:teapot " + error + small)["seen"];
    EXPECT_NEAR(double(by_rays["covered_pixels"]), double(by_zbuffer["covered_pixels"]), 3) << error;
  }
}

// The knob's top is 3.15 above the ground.
TEST_F(Curved, SightMeetsTriangles) {
  EXPECT_THAT(
      succeed("sight builtin:teapot --from 0,9,0 --to 0,-9,0").out,
      ::testing::ContainsRegex("blocked by object 0 \\(teapot\\), triangle [0-9]+, at 0,3.15,0, distance 5.85"));
}

// The camera depends on the model's own triangles, whichever are drawn.
TEST_F(Curved, TheCameraIsTheSameForBoth) {
  const json a = report("render builtin:spheres --method raycast" + small),
             b = report("render builtin:spheres --tessellation-error 1" + small),
             c = report("render builtin:spheres" + small);
  EXPECT_EQ(a["view"], c["view"]);
  EXPECT_EQ(b["view"], c["view"]);
}

TEST_F(Curved, ShadowsByRaysFallWhereThoseOfTheMapDo) {
  succeed("render builtin:spheres --method raycast --tessellation-error 0.1" + small + "-o map.exr");
  succeed("render builtin:spheres --method raycast --tessellation-error 0.1 --shadows rays" + small + "-o rays.exr");
  succeed("render builtin:spheres --method raycast --tessellation-error 0.1 --shadows off" + small + "-o off.exr");
  EXPECT_LT(mean_difference(image("map.exr"), image("rays.exr")), 0.006);
  EXPECT_GT(mean_difference(image("off.exr"), image("rays.exr")), 0.009);
}

TEST_F(Curved, CompareExplainsEveryPixelOnFineTriangles) {
  const json found = report("compare builtin:teapot --tessellation-error 0.5 --runs 1" + small);
  const json coarse = report("compare builtin:teapot --tessellation-error 5 --runs 1" + small);
  for (const json& method : found["methods"]) {
    if (method["method"] == "painter-centroid") continue;  // wrong by design
    EXPECT_EQ(method["unexplained"], 0) << method["method"];
  }
  EXPECT_GT(found["methods"][0]["primitives"], coarse["methods"][0]["primitives"]);
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
