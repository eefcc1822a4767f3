// SPDX-License-Identifier: Apache-2.0
// From camera options to views, checked against each other and against points whose image is known.
#include "cli/view/view_options.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "cli/option.h"
#include "program.h"
#include "support/seeds.h"

namespace frontmost::cli {
namespace {

using testing::HasSubstr;

/// The eight vertices of the box from (0, 0, 0) to (2, 4, 6), z up.
Scene box_scene() {
  Scene scene;
  scene.up = Axis::z;
  Mesh mesh;
  for (int i = 0; i < 8; ++i) mesh.positions.emplace_back(i & 1 ? 2 : 0, i & 2 ? 4 : 0, i & 4 ? 6 : 0);
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}, {5, 6, 7}};
  scene.meshes.push_back(mesh);
  scene.instances.push_back({"box", 0, glm::dmat4(1.0)});
  return scene;
}

class ViewOptions : public testing::Test {
 protected:
  /// Pairs of option and value, as in {{"view", "front"}}.
  using Pairs = std::vector<std::pair<std::string_view, std::string_view>>;

  static ViewSettings settings(const Pairs& pairs) {
    Settings result;
    for (const auto& [name, value] : pairs) {
      for_each_option([&, wanted = name, text = value](const Option& option) {
        if (option.name == wanted) apply(option, text, result);
      });
    }
    return result.view;
  }
  View view(const Pairs& pairs) const {
    const ViewSettings parsed = settings(pairs);
    check_view_settings(parsed);
    return resolve_view(parsed, surfaces_);
  }
  std::string complaint(const Pairs& pairs) const {
    return test::complaint([&] { return view(pairs); });
  }

  static glm::dvec3 eye_space(const View& view, const glm::dvec3& point) {
    return glm::dvec3(glm::inverse(view.world_from_eye) * glm::dvec4(point, 1));
  }
  /// Position in pixels and depth.
  static glm::dvec3 project(const View& view, const glm::dvec3& point) {
    const glm::dvec3 p = eye_space(view, point);
    const double reach = view.projection.orthographic ? 1 : -p.z;
    const Projection& sides = view.projection;
    return {(p.x / reach - sides.left) / (sides.right - sides.left) * view.width,
            (sides.top - p.y / reach) / (sides.top - sides.bottom) * view.height, -p.z};
  }
  /// Bounds of the box's vertices in the picture, as fractions of the picture's size.
  static std::pair<glm::dvec2, glm::dvec2> reach(const View& view) {
    glm::dvec2 low(1e9), high(-1e9);
    for (int i = 0; i < 8; ++i) {
      const glm::dvec3 p = project(view, {i & 1 ? 2 : 0, i & 2 ? 4 : 0, i & 4 ? 6 : 0});
      low = glm::min(low, glm::dvec2(p.x / view.width, p.y / view.height));
      high = glm::max(high, glm::dvec2(p.x / view.width, p.y / view.height));
    }
    return {low, high};
  }

  Scene scene_ = box_scene();
  Surfaces surfaces_{scene_};
};

TEST_F(ViewOptions, LengthsOfDirectionsMeanNothing) {
  std::mt19937_64 random(test::noted_seed(7));
  std::uniform_real_distribution<double> number(-10, 10);
  const auto text = [](const glm::dvec3& v) { return fmt::format("{},{},{}", v.x, v.y, v.z); };
  for (int i = 0; i < 200; ++i) {
    const auto place = [&] { return glm::dvec3(number(random), number(random), number(random)); };
    const glm::dvec3 eye = place(), direction = place(), up = place();
    std::vector<std::pair<std::string, std::string>> camera;
    if (random() % 4) camera.emplace_back("camera-position", text(eye * 3.0));
    if (random() % 2) camera.emplace_back("camera-orthographic", "true");
    if (random() % 2) camera.emplace_back("camera-azimuth-angle", "30");
    if (random() % 2) camera.emplace_back("camera-elevation-angle", "-20");
    const auto with_length = [&](double length) {
      Pairs pairs(camera.begin(), camera.end());
      const std::string ahead = text(direction * length), above = text(up * length);
      pairs.emplace_back("camera-direction", ahead);
      pairs.emplace_back("camera-view-up", above);
      return view(pairs);
    };
    const View once = with_length(1), thrice = with_length(3);
    for (int column = 0; column < 4; ++column)
      EXPECT_LT(glm::distance(once.world_from_eye[column], thrice.world_from_eye[column]), 1e-9) << i;
    EXPECT_NEAR(once.projection.top, thrice.projection.top, 1e-9) << i;
    EXPECT_NEAR(once.projection.clip.near, thrice.projection.clip.near, 1e-9) << i;
  }
}

TEST_F(ViewOptions, AParallelCameraThatIsPlacedSeesAsFarAheadAsTheModelIs) {
  // The middle of the box, (1, 2, 3), is 12 ahead of the eye.
  const View v =
      view({{"camera-position", "15,-10,5"}, {"camera-direction", "0,9,0"}, {"camera-orthographic", "true"}});
  EXPECT_NEAR(v.projection.top, 12 * std::tan(glm::radians(15.0)), 1e-12);
  EXPECT_FALSE(depends_on_model(
      settings({{"camera-position", "15,-10,5"}, {"camera-direction", "y"}, {"near", "1"}, {"far", "9"}})));
  EXPECT_TRUE(depends_on_model(settings({{"camera-position", "15,-10,5"},
                                         {"camera-direction", "y"},
                                         {"near", "1"},
                                         {"far", "9"},
                                         {"camera-orthographic", "true"}})));
}

TEST_F(ViewOptions, PositionFocalPointAndUpMakeTheCamera) {
  const View v = view({{"camera-position", "1,-10,3"},
                       {"camera-focal-point", "1,2,3"},
                       {"camera-view-up", "z"},
                       {"camera-view-angle", "90"},
                       {"resolution", "200,100"}});
  EXPECT_EQ(v.eye(), glm::dvec3(1, -10, 3));
  EXPECT_NEAR(v.forward().y, 1, 1e-12);
  EXPECT_NEAR(v.up().z, 1, 1e-12);
  // At 12 ahead and 45 degrees upwards, the top of the picture is 12 higher.
  EXPECT_NEAR(project(v, {1, 2, 15}).y, 0, 1e-9);
  EXPECT_NEAR(project(v, {1, 2, 3}).x, 100, 1e-9);
  EXPECT_NEAR(project(v, {25, 2, 3}).x, 200, 1e-9);
  EXPECT_NEAR(project(v, {1, 2, 3}).z, 12, 1e-12);
}

TEST_F(ViewOptions, TheDefaultFocalPointIsTheMiddle) {
  const View v = view({{"camera-position", "1,-10,3"}});
  EXPECT_NEAR(glm::distance(v.forward(), {0, 1, 0}), 0, 1e-12);
  EXPECT_EQ(focal_point_of({}, v, surfaces_), glm::dvec3(1, 2, 3));
}

TEST_F(ViewOptions, EverythingFitsFromAnyDirection) {
  const std::vector<Pairs> cases = {{},
                                    {{"view", "iso"}},
                                    {{"camera-direction", "-1,2,-0.5"}},
                                    {{"camera-direction", "0,0,-1"}},
                                    {{"camera-azimuth-angle", "70"}, {"camera-elevation-angle", "-40"}},
                                    {{"camera-orthographic", ""}, {"camera-direction", "1,1,1"}},
                                    {{"view", "left"}, {"camera-azimuth-angle", "10"}, {"camera-orthographic", ""}},
                                    {{"camera-focal-point", "0,0,0"}, {"view", "right"}},
                                    {{"intrinsics", "300,310,10,60"}, {"pixel-center", "half"}},
                                    {{"camera-view-angle", "100"}, {"camera-view-up", "x"}}};
  for (const Pairs& pairs : cases) {
    for (const char* size : {"200,100", "60,180"}) {
      Pairs all = pairs;
      all.emplace_back("resolution", size);
      const auto [low, high] = reach(view(all));
      SCOPED_TRACE(testing::Message() << (pairs.empty() ? "default" : pairs[0].first) << " at " << size);
      EXPECT_GE(std::min(low.x, low.y), 0.049);
      EXPECT_LE(std::max(high.x, high.y), 0.951);
      // The camera is no farther than needed: the box reaches a margin somewhere.
      EXPECT_LT(std::min({low.x, low.y, 1 - high.x, 1 - high.y}), 0.051);
    }
  }
}

TEST_F(ViewOptions, TurningByNothingChangesNothing) {
  const View still = view({{"view", "iso"}}), turned = view({{"view", "iso"}, {"camera-azimuth-angle", "1e-9"}});
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(glm::distance(still.world_from_eye[i], turned.world_from_eye[i]), 0, 1e-6) << i;
  }
}

TEST_F(ViewOptions, AzimuthGoesRightAndElevationUp) {
  const View front = view({{"view", "front"}});
  const View right = view({{"view", "front"}, {"camera-azimuth-angle", "90"}});
  const View above = view({{"view", "front"}, {"camera-elevation-angle", "30"}});
  EXPECT_NEAR(glm::distance(right.forward(), -front.right()), 0, 1e-12);
  EXPECT_GT(above.eye().z, front.eye().z);
  EXPECT_NEAR(above.forward().z, -0.5, 1e-12);
}

TEST_F(ViewOptions, ZoomDividesTheAngleOrTheHeight) {
  const Pairs base = {{"camera-position", "1,-30,3"}, {"camera-view-angle", "40"}};
  Pairs zoomed = base;
  zoomed.emplace_back("camera-zoom-factor", "2");
  EXPECT_NEAR(std::atan(view(zoomed).projection.top) * 2 * 57.29577951308232, 20, 1e-9);
  Pairs parallel = base;
  parallel.emplace_back("camera-orthographic", "");
  const double height = view(parallel).projection.top;
  EXPECT_NEAR(height, 32 * std::tan(20 / 57.29577951308232), 1e-9);
  parallel.emplace_back("camera-zoom-factor", "4");
  EXPECT_NEAR(view(parallel).projection.top, height / 4, 1e-12);
  EXPECT_THAT(complaint({{"camera-zoom-factor", "0.1"}}), HasSubstr("zoom"));
}

TEST_F(ViewOptions, IntrinsicsAndPoseAreTheVisionCamera) {
  // x right, y down, z forward; the world lies 10 before the camera, turned by a half turn about x.
  const Pairs pairs = {{"intrinsics", "100,200,31.5,23.5"},
                       {"resolution", "64,48"},
                       {"pose", "1,0,0,0, 0,-1,0,0, 0,0,-1,10, 0,0,0,1"},
                       {"pose-convention", "opencv-world-to-camera"}};
  const View v = view(pairs);
  // A point at camera (1, 2, 8): u = 100 * 1 / 8 + 31.5, with pixel centres at whole numbers.
  const glm::dvec3 screen = project(v, {1, -2, 2});
  EXPECT_NEAR(screen.x, 100.0 / 8 + 31.5 + 0.5, 1e-9);
  EXPECT_NEAR(screen.y, 200.0 * 2 / 8 + 23.5 + 0.5, 1e-9);
  EXPECT_NEAR(screen.z, 8, 1e-12);
  Pairs half = pairs;
  half.emplace_back("pixel-center", "half");
  EXPECT_NEAR(project(view(half), {1, -2, 2}).x, 100.0 / 8 + 31.5, 1e-9);
}

TEST_F(ViewOptions, TheFourPoseConventionsAgree) {
  const View v = view({{"camera-position", "5,6,7"}});
  constexpr std::string_view names[] = {"opengl-camera-to-world", "opengl-world-to-camera", "opencv-camera-to-world",
                                        "opencv-world-to-camera"};
  for (int i = 0; i < 4; ++i) {
    ViewSettings s = settings({{"pose-convention", names[i]}});
    s.pose = pose_of(v.world_from_eye, PoseConvention(i));
    const View again = resolve_view(s, surfaces_);
    for (int column = 0; column < 4; ++column) {
      EXPECT_NEAR(glm::distance(again.world_from_eye[column], v.world_from_eye[column]), 0, 1e-9) << names[i];
    }
  }
}

TEST_F(ViewOptions, ModelCamerasAreTakenByNumber) {
  Camera camera;
  camera.world_from_eye = look_at({1, -20, 3}, {1, 2, 3}, {0, 0, 1});
  camera.vertical = 0.5;
  camera.near = 2;
  scene_.cameras.push_back(camera);
  const View v = view({{"camera-index", "0"}});
  EXPECT_EQ(v.eye(), glm::dvec3(1, -20, 3));
  EXPECT_NEAR(v.projection.top, std::tan(0.25), 1e-12);
  EXPECT_EQ(v.projection.clip.near, 2);
  EXPECT_THAT(complaint({{"camera-index", "1"}}), HasSubstr("there is no camera 1; cameras in the model: 1"));
}

TEST_F(ViewOptions, PlanesAreFittedUnlessGiven) {
  const View fitted = view({{"camera-position", "1,-10,3"}});
  EXPECT_GT(fitted.projection.clip.near, 9);
  EXPECT_LE(fitted.projection.clip.near, 10);
  EXPECT_GE(fitted.projection.clip.far, 14);
  const View given = view({{"camera-position", "1,-10,3"}, {"near", "0.5"}, {"far", "inf"}});
  EXPECT_EQ(given.projection.clip.near, 0.5);
  EXPECT_TRUE(std::isinf(given.projection.clip.far));
  // A requested near plane beyond the model is kept; the far plane moves.
  EXPECT_EQ(view({{"camera-position", "1,-10,3"}, {"near", "100"}}).projection.clip.near, 100);
  EXPECT_EQ(view({{"camera-position", "1,-10,3"}, {"far", "1"}}).projection.clip.far, 1);
}

TEST_F(ViewOptions, ContradictionsAreNamed) {
  const std::vector<std::pair<Pairs, std::string>> cases = {
      {{{"pose", "1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1"}}, "--pose needs --pose-convention"},
      {{{"pose-convention", "opencv-world-to-camera"}}, "--pose-convention needs --pose"},
      {{{"pixel-center", "half"}}, "--pixel-center needs --intrinsics"},
      {{{"view", "front"}, {"camera-position", "1,2,3"}}, "--view and --camera-position exclude"},
      {{{"camera-index", "0"}, {"view", "front"}}, "--camera-index and --view exclude"},
      {{{"intrinsics", "1,1,0,0"}, {"camera-view-angle", "30"}}, "--intrinsics and --camera-view-angle exclude"},
      {{{"camera-position", "1,2,3"}, {"camera-focal-point", "0,0,0"}, {"camera-direction", "x"}}, "exclude"},
      {{{"near", "5"}, {"far", "4"}}, "--near: must be below --far"},
      {{{"near", "-1"}}, "--near: must be above 0"},
      {{{"camera-position", "1,2,3"}}, "give --camera-direction"},
      {{{"samples", "16"}, {"resolution", "16384,16384"}}, "--samples"},
  };
  for (const auto& [pairs, message] : cases) EXPECT_THAT(complaint(pairs), HasSubstr(message)) << pairs[0].first;
}

TEST_F(ViewOptions, EmptyAndFlatModelsHaveAView) {
  Scene empty;
  const Surfaces nothing(empty);
  EXPECT_NO_THROW((void)resolve_view({}, nothing));
  ViewSettings turned;
  turned.azimuth = 30;
  EXPECT_NO_THROW((void)resolve_view(turned, nothing));
  Scene point = box_scene();
  for (glm::vec3& position : point.meshes[0].positions) position = {1e6f, 0, 0};
  const Surfaces dot(point);
  EXPECT_NO_THROW((void)resolve_view(turned, dot));
}

TEST_F(ViewOptions, ViewsHaveNames) {
  EXPECT_EQ(view_name(settings({})), "three-quarter");
  EXPECT_EQ(view_name(settings({{"view", "top"}})), "top");
  EXPECT_EQ(view_name(settings({{"camera-index", "2"}})), "camera2");
  EXPECT_EQ(view_name(settings({{"camera-direction", "x"}})), "camera");
}

}  // namespace
}  // namespace frontmost::cli
