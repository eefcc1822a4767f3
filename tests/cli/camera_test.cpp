// SPDX-License-Identifier: Apache-2.0
// frontmost camera and info: the output is JSON, consistent, and accepted as input.
#include <gmock/gmock.h>

#include <cmath>
#include <glm/glm.hpp>
#include <sstream>

#include "program.h"

namespace frontmost::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

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

/// A flap of two triangles, `size` long.
std::string flap_obj(double size, const std::string& name = "flap") {
  const auto number = [&](double part) { return std::to_string(part * size); };
  return "o " + name + "\nv 0 0 0\nv " + number(1) + " 0 0\nv 0 " + number(0.5) + " 0\nv 0 0 " + number(0.25) +
         "\nf 1 2 3\nf 2 1 4\n";
}

TEST_F(Info, TheSizeIsSaid) {
  write("flap.obj", flap_obj(120));
  const json info = succeed("info flap.obj --json").json();
  EXPECT_EQ(info["size"], json({120.0, 60.0, 30.0}));
  EXPECT_EQ(info["objects"][0]["size"], json({120.0, 60.0, 30.0}));
  EXPECT_THAT(succeed("info flap.obj").out, HasSubstr("  size       120 x 60 x 30\n"));
  write("none.obj", "v 0 0 0\n");
  EXPECT_EQ(succeed("info none.obj --json").json()["size"], nullptr);
}

/// A tube along z of 24 sides, with a second, lower one beside it.
std::string tubes_obj() {
  constexpr int sides = 24;
  std::ostringstream text;
  int first = 1;
  for (const double height : {3.0, 1.0}) {
    for (const double z : {0.0, height})
      for (const double radius : {2.0, 1.0})
        for (int i = 0; i < sides; ++i)
          text << "v " << 10 / height + radius * std::cos(i * 2 * 3.14159265358979 / sides) << ' '
               << radius * std::sin(i * 2 * 3.14159265358979 / sides) << ' ' << z << '\n';
    const auto quad = [&](int ring_a, int ring_b, int i) {
      const int a = first + ring_a * sides, b = first + ring_b * sides, next = (i + 1) % sides;
      text << "f " << a + i << ' ' << a + next << ' ' << b + next << ' ' << b + i << '\n';
    };
    for (int i = 0; i < sides; ++i) quad(0, 2, i), quad(3, 1, i), quad(2, 3, i), quad(1, 0, i);
    first += 4 * sides;
  }
  return text.str();
}

TEST_F(Info, CylindersAndHolesAreCounted) {
  write("tubes.obj", tubes_obj());
  const json info = succeed("info tubes.obj --json").json();
  EXPECT_EQ(info["odd"]["boundary_edges"], 0);
  EXPECT_EQ(info["cylinders"], 4);
  EXPECT_EQ(info["holes"], 2);
  EXPECT_THAT(succeed("info tubes.obj").out, HasSubstr("  cylinders  4, 2 of them holes\n"));
  write("cube.stl", cube_stl());
  EXPECT_EQ(succeed("info cube.stl --json").json()["holes"], 0);
  EXPECT_THAT(succeed("info cube.stl").out, Not(HasSubstr("cylinders")));
}

TEST_F(Info, TheUnitIsTheFilesOrAGuess) {
  const auto unit = [&](const std::string& file) { return succeed("info " + file + " --json").json()["unit"]; };
  write("part.obj", flap_obj(120));
  EXPECT_EQ(unit("part.obj"), json({{"name", "millimetre"}, {"metres", 0.001}, {"guess", true}}));
  EXPECT_THAT(succeed("info part.obj").out, HasSubstr("  unit       millimetre, a guess: 120 x 60 x 30 mm\n"));
  write("scan.obj", flap_obj(0.15));
  EXPECT_EQ(unit("scan.obj"), json({{"name", "metre"}, {"metres", 1.0}, {"guess", true}}));
  EXPECT_THAT(succeed("info scan.obj").out, HasSubstr("  unit       metre, a guess: 150 x 75 x 37.5 mm\n"));
  for (const double size : {2.0, 9000.0, 0.0001}) {
    write("any.obj", flap_obj(size));
    EXPECT_EQ(unit("any.obj"), nullptr) << size;
  }
  EXPECT_THAT(succeed("info any.obj").out, Not(HasSubstr("unit ")));
  write("m.gltf", R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":36,"uri":"data:;base64,)"
                  R"(AAAAAAAAAAAAAAAAAACAQAAAAAAAAAAAAAAAAAAAgEAAAAAA"}],"bufferViews":[{"buffer":0,"byteLength":36}],)"
                  R"("accessors":[{"bufferView":0,"count":3,"componentType":5126,"type":"VEC3"}],)"
                  R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"nodes":[{"mesh":0}]})");
  EXPECT_EQ(unit("m.gltf"), json({{"name", "metre"}, {"metres", 1.0}, {"guess", false}}));
  EXPECT_THAT(succeed("info m.gltf").out, HasSubstr("  unit       metre: 4 x 4 x 0 m\n"));
  EXPECT_EQ(unit("builtin:teapot"), nullptr);
}

TEST_F(Info, OddEdgesAreThoseOfNamedMeshes) {
  // In `fin`, three triangles share an edge; `flap` has four edges with one triangle.
  write("two.obj", flap_obj(10) + "o fin\nv 0 9 0\nv 0 9 5\nv 1 9 0\nv 2 8 0\nv 2 9 1\nf 5 6 7\nf 6 5 8\nf 5 6 9\n");
  const std::string text = succeed("info two.obj").out;
  EXPECT_THAT(text, HasSubstr("            10  boundary edges\n               6  in fin\n               4  in flap\n"));
  EXPECT_THAT(text, HasSubstr("             1  non-manifold edges\n               1  in fin\n"));
  const json meshes = succeed("info two.obj --json").json()["meshes"];
  EXPECT_EQ(meshes[0]["name"], "flap");
  EXPECT_EQ(meshes[0]["odd"]["boundary_edges"], 4);
  EXPECT_EQ(meshes[1]["odd"]["non_manifold_edges"], 1);
  std::string many;
  for (int i = 0; i < 8; ++i) many += "o flap" + std::to_string(i) + "\nf 1 2 3\nf 2 1 4\n";
  write("many.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n" + many);
  EXPECT_THAT(succeed("info many.obj").out,
              HasSubstr("4  in flap4\n                  and in 3 more; --json lists them\n"));
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
  // The component of `up` along the view is dropped, so a leaning `up` only rolls the camera.
  EXPECT_LT(difference(axes("1,0,5"), axes("1,0,0")), 1e-12);
  expect_failure(looks + "--camera-view-up up", 2, "--camera-view-up: ");
}

}  // namespace
}  // namespace frontmost::test
