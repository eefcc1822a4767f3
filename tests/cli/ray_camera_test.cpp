// SPDX-License-Identifier: Apache-2.0
// frontmost render through panoramas and fisheyes, and frontmost lidar.
#include <frontmost/files.h>
#include <gmock/gmock.h>

#include <cstring>

#include "program.h"

namespace frontmost::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

class RayCameras : public ProgramTest {
 protected:
  RayCameras() { write("cube.stl", cube_stl()); }  // from 0 to 1, z up
};

TEST_F(RayCameras, APanoramaInsideACubeSeesItAllAround) {
  const json report = succeed(
                          "render cube.stl --camera-model panorama --resolution 64,32 --camera-position 0.5,0.5,0.5 "
                          "--camera-direction +y --depth depth.npy --ray-distance far.exr --ids object=ids.exr "
                          "--ids primitive=triangles.png -o picture.png --json")
                          .json();
  EXPECT_EQ(report["seen"]["covered_pixels"], 64 * 32);
  EXPECT_EQ(report["method"], "raycast");
  EXPECT_EQ(report["view"]["projection"], "panorama");
  EXPECT_FALSE(report["view"].contains("intrinsics"));
  const Image depth = load_image(path("depth.npy"));
  float nearest = 9, farthest = 0;
  for (const float range : depth.channels[0].floats()) {
    nearest = std::min(nearest, range);
    farthest = std::max(farthest, range);
  }
  EXPECT_NEAR(nearest, 0.5, 0.003);    // the middle of a side
  EXPECT_NEAR(farthest, 0.866, 0.03);  // near a corner
  EXPECT_EQ(load_image(path("far.exr")).find("distance")->floats()[777], depth.channels[0].floats()[777]);
  const Image ids = load_image(path("ids.exr"));
  for (const std::uint32_t id : ids.find("object")->integers()) EXPECT_EQ(id, 0u);
  EXPECT_EQ(load_image(path("picture.png")).width, 64);
}

TEST_F(RayCameras, AFisheyesMiddleSeesWhatThePinholesDoes) {
  const std::string from = " --camera-position 0.5,-3,0.5 --camera-direction +y --resolution 33,33 ";
  succeed("render cube.stl --camera-model fisheye --fov 90" + from + "--depth round.npy --ids primitive=round.exr");
  succeed("render cube.stl" + from + "--depth flat.npy --ids primitive=flat.exr");
  const std::size_t middle = 16 * 33 + 16;
  EXPECT_NEAR(load_image(path("round.npy")).channels[0].floats()[middle], 3, 1e-6);
  EXPECT_NEAR(load_image(path("flat.npy")).channels[0].floats()[middle], 3, 1e-6);
  EXPECT_EQ(load_image(path("round.exr")).find("primitive")->integers()[middle],
            load_image(path("flat.exr")).find("primitive")->integers()[middle]);
  // Pixels beyond the circle show nothing.
  EXPECT_EQ(load_image(path("round.npy")).channels[0].floats()[0], std::numeric_limits<float>::infinity());
}

TEST_F(RayCameras, EveryShadingMakesAPictureThatThreadsDoNotChange) {
  for (const std::string shading : {"lit", "flat", "normals", "depth", "ids"}) {
    const std::string line = "render builtin:gallery --camera-model fisheye --resolution 48,40 --shading " + shading;
    succeed(line + " --threads 1 -o one.png");
    succeed(line + " --threads 3 -o three.png --reference one.png");
  }
}

TEST_F(RayCameras, SamplesAndShadowsCountAndMapsHaveOneRayAPixel) {
  const std::string line =
      "render cube.stl --camera-model fisheye --fov 60 --resolution 40,40 --camera-position 0.5,-3,2.5 "
      "--camera-focal-point 0.5,0.5,0.5 ";
  succeed(line + "--samples 1 -o one.png --depth one.npy");
  succeed(line + "-o four.png --depth four.npy");
  succeed(line + "--samples 4 --shadows off -o unshadowed.png");
  EXPECT_NE(read("one.png"), read("four.png"));
  EXPECT_EQ(read("one.npy"), read("four.npy"));
  for (const std::string more : {"--samples 16", "--shadows rays", "--shading uv", "--opacity 0.5"})
    succeed(line + more + " -o other.png");
}

TEST_F(RayCameras, ABatchMayMixCameras) {
  write("views.json", R"({"outputs": {"output": "{view}.png"}, "views": [
    {"name": "flat", "resolution": [32, 16]},
    {"name": "round", "resolution": [32, 16], "camera-model": "fisheye", "fov": 300}]})");
  const json report = succeed("render cube.stl --batch views.json --json").json();
  EXPECT_EQ(report["views"][0]["view"]["projection"], "perspective");
  EXPECT_EQ(report["views"][1]["view"]["projection"], "fisheye");
  EXPECT_EQ(report["views"][1]["view"]["field_of_view_degrees"], 300.0);
  EXPECT_TRUE(exists("round.png"));
}

TEST_F(RayCameras, RefusesWhatNeedsAPinhole) {
  for (const std::string other : {"--camera-orthographic", "--camera-view-angle 20", "--near 1", "--cull back",
                                  "--stream", "--intrinsics 9,9,1,1", "--normals n.exr", "--depth-func LESS"})
    expect_failure("render cube.stl --camera-model panorama -o a.png " + other, 2, "camera-model");
  expect_failure("render cube.stl --fov 90 -o a.png", 2, "--fov needs --camera-model fisheye");
  expect_failure("render cube.stl --camera-model fisheye --fov 361 -o a.png", 2, "--fov");
  expect_failure("render cube.stl --camera-model fisheye --samples 64 --method abuffer -o a.png", 2, "--samples 64");
}

float float_at(const std::string& bytes, std::size_t at) {
  float value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

std::uint32_t word_at(const std::string& bytes, std::size_t at) {
  std::uint32_t value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

TEST_F(RayCameras, ALidarInsideACubeMeetsItWithEveryRay) {
  const json report =
      succeed("lidar cube.stl --from 0.5,0.5,0.25 --rings 3 --elevations -90,90 --steps 4 -o points.ply --json").json();
  EXPECT_EQ(report["rays"], 12);
  EXPECT_EQ(report["points"], 12);
  EXPECT_EQ(report["nearest"], 0.25);
  EXPECT_EQ(report["farthest"], 0.75);
  EXPECT_EQ(report["objects"][0]["points"], 12);
  const std::string ply = read("points.ply");
  EXPECT_THAT(ply, HasSubstr("element vertex 12\n"));
  const std::size_t first = ply.find("end_header\n") + 11;
  ASSERT_EQ(ply.size(), first + 12 * 36);
  // The middle ring looks ahead (+y for z-up models), right (+x), behind and left.
  const glm::vec3 expected[] = {{0.5f, 1, 0.25f}, {1, 0.5f, 0.25f}, {0.5f, 0, 0.25f}, {0, 0.5f, 0.25f}};
  for (std::size_t step = 0; step < 4; ++step) {
    const std::size_t at = first + (4 + step) * 36;
    for (int axis = 0; axis < 3; ++axis) EXPECT_EQ(float_at(ply, at + 4 * std::size_t(axis)), expected[step][axis]);
    EXPECT_EQ(float_at(ply, at + 12), 0.5f);
    EXPECT_EQ(word_at(ply, at + 16), 0u);
    EXPECT_LT(word_at(ply, at + 20), 12u);
    EXPECT_EQ(word_at(ply, at + 24), 1u);
    EXPECT_EQ(word_at(ply, at + 28), step);
    EXPECT_EQ(float_at(ply, at + 32), 0.0f) << "incidence";
  }
}

TEST_F(RayCameras, ALidarWritesRangeImagesAndTakesDirections) {
  succeed("lidar cube.stl --from 0.5,-4,0.5 --rings 8 --steps 32 -o ranges.npy -o ranges.exr");
  const Image ranges = load_image(path("ranges.npy")), all = load_image(path("ranges.exr"));
  EXPECT_EQ(ranges.width, 32);
  EXPECT_EQ(ranges.height, 8);
  EXPECT_NE(all.find("object"), nullptr);
  EXPECT_NE(all.find("primitive"), nullptr);
  // Ahead is +y: the cube's near side is four away at the horizon.
  write("ahead.txt", "# two rays\n0 0 -1\n0, 0, 5  # behind\n");
  const json report = succeed("lidar cube.stl --from 0.5,-4,0.5 --directions ahead.txt --json").json();
  EXPECT_EQ(report["rays"], 2);
  EXPECT_EQ(report["points"], 1);
  EXPECT_EQ(report["nearest"], 4.0);
  const json behind = succeed("lidar cube.stl --from 0.5,-4,0.5 --forward -y --directions ahead.txt --json").json();
  EXPECT_EQ(behind["points"], 1);
}

// The scanner stands a quarter above the floor of a cube, half from its walls. It looks left, ahead and right, level
// and 45 degrees down.
TEST_F(RayCameras, ALidarHasAPartOfATurnAListOfRingsAndRobotsAxes) {
  succeed(
      "lidar cube.stl --from 0.5,0.5,0.25 --ring-elevations 0,-45 --azimuths -90,90 --steps 3 --robot-axes "
      "-o points.ply -o ranges.exr");
  const std::string ply = read("points.ply");
  EXPECT_THAT(ply, HasSubstr("element vertex 6\n"));
  EXPECT_THAT(ply, HasSubstr("property float incidence\n"));
  const std::size_t first = ply.find("end_header\n") + 11;
  const float h = 0.5f, q = 0.25f, slant = std::sqrt(0.125f);
  const float expected[6][5] = {{0, h, 0, h, 0},       {h, 0, 0, h, 0},       {0, -h, 0, h, 0},
                                {0, q, -q, slant, 45}, {q, 0, -q, slant, 45}, {0, -q, -q, slant, 45}};
  const Image image = load_image(path("ranges.exr"));
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(float_at(ply, first + 36 * i + 4 * k), expected[i][k], 1e-6) << i;
    EXPECT_NEAR(float_at(ply, first + 36 * i + 32), expected[i][4], 1e-4) << i;
    EXPECT_NEAR(image.find("distance")->floats()[i], expected[i][3], 1e-6) << i;
    EXPECT_NEAR(image.find("incidence")->floats()[i], expected[i][4], 1e-4) << i;
  }
  // The floor is nearer than half a unit, so its rays return nothing.
  EXPECT_EQ(succeed("lidar cube.stl --from 0.5,0.5,0.25 --ring-elevations 0,-45 --azimuths -90,90 --steps 3 "
                    "--range 0.5,2 --json")
                .json()["points"],
            3);
  write("robot.txt", "1 0 0  # ahead\n0 1 0  # left\n0 0 1\n");
  succeed("lidar cube.stl --from 0.5,0.25,0.75 --directions robot.txt --robot-axes -o ranges.npy");
  const Image ranges = load_image(path("ranges.npy"));
  const auto& values = ranges.channels[0].floats();
  EXPECT_EQ(std::vector<float>(values.begin(), values.end()), (std::vector<float>{0.75f, 0.5f, 0.25f}));
}

TEST_F(RayCameras, ALidarNamesWhatIsWrong) {
  write("short.txt", "1 2\n");
  write("empty.txt", "# nothing\n");
  expect_failure("lidar cube.stl -o a.ply", 2, "--from");
  expect_failure("lidar cube.stl --from 0,0,0", 2, "nothing to do");
  expect_failure("lidar cube.stl --from 0,0,0 -o a.txt", 2, "suffix");
  expect_failure("lidar cube.stl --from 0,0,0 --rings 0 -o a.ply", 2, "--rings");
  expect_failure("lidar cube.stl --from 0,0,0 --elevations 10,-10 -o a.ply", 2, "--elevations");
  expect_failure("lidar cube.stl --from 0,0,0 --directions short.txt --steps 4 -o a.ply", 2, "excludes --");
  expect_failure("lidar cube.stl --from 0,0,0 --directions short.txt -o a.ply", 1,
                 "short.txt: line 1: a direction needs three numbers");
  expect_failure("lidar cube.stl --from 0,0,0 --ring-elevations 0,91 -o a.ply", 2, "--ring-elevations");
  expect_failure("lidar cube.stl --from 0,0,0 --ring-elevations 0 --rings 2 -o a.ply", 2, "excludes --");
  expect_failure("lidar cube.stl --from 0,0,0 --azimuths -200,200 -o a.ply", 2, "more than a whole turn");
  expect_failure("lidar cube.stl --from 0,0,0 --range 2,1 -o a.ply", 2, "the least comes first");
  expect_failure("lidar cube.stl --from 0,0,0 --directions short.txt --azimuths 0,90 -o a.ply", 2, "excludes --");
  write("still.txt", "0 0 -1\n0 0 0\n");
  expect_failure("lidar cube.stl --from 0,0,0 --directions still.txt -o a.npy", 1,
                 "still.txt: direction 2 has length 0");
  write("far.txt", "0 0 1e300\n");
  expect_failure("lidar cube.stl --from 0,0,0 --directions far.txt -o a.npy", 1,
                 "far.txt: line 1: 1e300 is not between");
  expect_failure("lidar cube.stl --from 0,0,0 --directions empty.txt -o a.ply", 1, "no direction");
}

}  // namespace
}  // namespace frontmost::test
