// SPDX-License-Identifier: Apache-2.0
// frontmost camera and info: what they print is JSON, agrees with itself, and can be fed back.
#include <gmock/gmock.h>

#include <cmath>
#include <glm/glm.hpp>

#include "program.h"

namespace frontmost::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class Camera : public ProgramTest {
 protected:
  Camera() { write("cube.stl", cube_stl()); }
};

glm::dmat4 matrix(const json& rows) {
  glm::dmat4 result;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) result[column][row] = rows.at(std::size_t(row)).at(std::size_t(column));
  }
  return result;
}

glm::dvec3 vector(const json& list) { return {list.at(0), list.at(1), list.at(2)}; }

double difference(const glm::dmat4& a, const glm::dmat4& b) {
  double largest = 0;
  for (int i = 0; i < 4; ++i) largest = std::max(largest, glm::length(a[i] - b[i]));
  return largest;
}

TEST_F(Camera, EveryConventionIsTheSameCamera) {
  const json camera = succeed("camera cube.stl --json --camera-position 4,-3,2 --resolution 320,200").json();
  const glm::dmat4 world_from_gl = matrix(camera["poses"]["opengl"]["world_from_camera"]);
  const glm::dmat4 world_from_cv = matrix(camera["poses"]["opencv"]["world_from_camera"]);
  EXPECT_LT(difference(world_from_gl * matrix(camera["poses"]["opengl"]["camera_from_world"]), glm::dmat4(1.0)), 1e-9);
  EXPECT_LT(difference(world_from_cv * matrix(camera["poses"]["opencv"]["camera_from_world"]), glm::dmat4(1.0)), 1e-9);
  EXPECT_LT(glm::length(glm::dvec3(world_from_gl[3]) - glm::dvec3(4, -3, 2)), 1e-12);
  EXPECT_LT(glm::length(world_from_gl[2] + world_from_cv[2]), 1e-12);
  EXPECT_LT(glm::length(world_from_gl[1] + world_from_cv[1]), 1e-12);

  // The middle of the cube, through K and through the projection matrix.
  const glm::dvec4 cv = glm::inverse(world_from_cv) * glm::dvec4(0.3, 0.6, 0.9, 1);
  const json& k = camera["intrinsics"]["pixel_center_half"];
  const glm::dvec2 pixel = {k["fx"].get<double>() * cv.x / cv.z + k["cx"].get<double>(),
                            k["fy"].get<double>() * cv.y / cv.z + k["cy"].get<double>()};
  for (const auto& [name, projection] : camera["projection_matrices"].items()) {
    const glm::dvec4 clip =
        matrix(projection["clip_from_eye"]) * glm::inverse(world_from_gl) * glm::dvec4(0.3, 0.6, 0.9, 1);
    EXPECT_NEAR((clip.x / clip.w + 1) * 160, pixel.x, 1e-9) << name;
    EXPECT_NEAR((1 - clip.y / clip.w) * 100, pixel.y, 1e-9) << name;
    const glm::dvec4 nearest = matrix(projection["clip_from_eye"]) * glm::dvec4(0, 0, -double(camera["near"]), 1);
    EXPECT_NEAR(nearest.z / nearest.w, double(projection["ndc_at_near"]), 1e-9) << name;
  }
  EXPECT_EQ(camera["projection_matrices"].size(), 4u);
  const json& integer = camera["intrinsics"]["pixel_center_integer"];
  EXPECT_EQ(double(integer["cx"]) + 0.5, double(k["cx"]));
  EXPECT_EQ(double(integer["K"][1][2]) + 0.5, double(k["K"][1][2]));
}

TEST_F(Camera, ItsFlagsMakeTheSameCameraAgain) {
  for (const char* words : {"", "--view iso", "--view top --camera-orthographic", "--intrinsics 300,310,99,55",
                            "--camera-azimuth-angle 20 --camera-zoom-factor 3 --far inf"}) {
    const std::string line = std::string("camera cube.stl --json --resolution 200,120 ") + words;
    const json first = succeed(line).json();
    const json again = succeed("camera cube.stl --json " + first["flags"].get<std::string>()).json();
    EXPECT_LT(difference(matrix(first["poses"]["opengl"]["world_from_camera"]),
                         matrix(again["poses"]["opengl"]["world_from_camera"])),
              1e-9)
        << words;
    EXPECT_LT(difference(matrix(first["projection_matrices"]["opengl"]["clip_from_eye"]),
                         matrix(again["projection_matrices"]["opengl"]["clip_from_eye"])),
              1e-6)
        << words;
    EXPECT_EQ(first["resolution"], again["resolution"]);
  }
}

TEST_F(Camera, PosesGoRoundInEveryConvention) {
  const json first = succeed("camera cube.stl --json --view iso").json();
  for (const char* axes : {"opengl", "opencv"}) {
    for (const bool inverse : {false, true}) {
      const json& rows = first["poses"][axes][inverse ? "camera_from_world" : "world_from_camera"];
      write("pose.txt", rows.dump());
      const json again = succeed(std::string("camera cube.stl --json --pose pose.txt --pose-convention ") + axes +
                                 (inverse ? "-world-to-camera" : "-camera-to-world"))
                             .json();
      EXPECT_LT(glm::length(vector(first["look_at"]["eye"]) - vector(again["look_at"]["eye"])), 1e-9) << axes;
    }
  }
}

TEST_F(Camera, UpTurnsTheModelsOwnViews) {
  const json z_up = succeed("camera cube.stl --json --view top").json();
  const json x_up = succeed("camera cube.stl --json --view top --up +x").json();
  EXPECT_GT(double(z_up["look_at"]["eye"][2]), 2);
  EXPECT_GT(double(x_up["look_at"]["eye"][0]), 2);
}

TEST_F(Camera, TheTextIsForPeople) {
  const std::string text = succeed("camera cube.stl --view front").out;
  EXPECT_THAT(text, HasSubstr("view angle  "));
  EXPECT_THAT(text, HasSubstr("--camera-position 0.5,-"));
}

class Info : public ProgramTest {};

TEST_F(Info, CountsAreRight) {
  write("cube.stl", cube_stl());
  const json info = succeed("info cube.stl --json").json();
  EXPECT_EQ(info["triangles"], 12);
  EXPECT_EQ(info["up"], "+z");
  EXPECT_EQ(info["bounds"]["high"], json({1.0, 1.0, 1.0}));
  EXPECT_EQ(info["meshes"][0]["closed"], true);
  EXPECT_EQ(info["meshes"][0]["genus"], 0);
  EXPECT_EQ(info["odd"]["boundary_edges"], 0);
  EXPECT_EQ(info["objects"].size(), 1u);
  EXPECT_THAT(succeed("info cube.stl").out, HasSubstr("nothing odd"));
}

TEST_F(Info, OddThingsAreSaid) {
  write("flap.stl", triangle_stl());
  EXPECT_EQ(succeed("info flap.stl --json").json()["odd"]["boundary_edges"], 3);
  EXPECT_THAT(succeed("info flap.stl").out, HasSubstr("3  boundary edges"));
}

TEST_F(Info, ModelsMayComeFromStandardInput) {
  const Outcome outcome = run(Call{.words = {"info", "-", "--json"}, .input = cube_stl()});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.json()["triangles"], 12);
}

TEST_F(Camera, UpIsWhereThePictureSaysUp) {
  const std::string looks = "camera cube.stl --camera-position 0.5,0.5,9 --camera-focal-point 0.5,0.5,0.5 --json ";
  const auto axes = [&](const std::string& up) {
    return matrix(succeed(looks + "--camera-view-up " + up).json()["poses"]["opengl"]["world_from_camera"]);
  };
  // Right is up x back, and back is +z.
  EXPECT_LT(glm::length(glm::dvec3(axes("1,0,0")[0]) - glm::dvec3(0, -1, 0)), 1e-12);
  EXPECT_LT(glm::length(glm::dvec3(axes("1,0,0")[1]) - glm::dvec3(1, 0, 0)), 1e-12);
  EXPECT_LT(glm::length(glm::dvec3(axes("0,-3,0")[0]) - glm::dvec3(-1, 0, 0)), 1e-12);
  EXPECT_LT(difference(axes("x"), axes("1,0,0")), 1e-12);
  EXPECT_LT(difference(axes("-y"), axes("0,-3,0")), 1e-12);
  // Leaning up only rolls: what of it points along the view is left out.
  EXPECT_LT(difference(axes("1,0,5"), axes("1,0,0")), 1e-12);
  expect_failure(looks + "--camera-view-up up", 2, "--camera-view-up: ");
}

}  // namespace
}  // namespace frontmost::test
