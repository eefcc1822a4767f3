// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "support/random_scene.h"
#include "view/screen_transform.h"

namespace frontmost::test {
namespace {

constexpr NamedView kViews[] = {NamedView::front, NamedView::back,   NamedView::left, NamedView::right,
                                NamedView::top,   NamedView::bottom, NamedView::iso,  NamedView::three_quarter};

Scene box_scene(const glm::vec3& low, const glm::vec3& high, Axis up) {
  Mesh mesh;
  add_triangle(mesh, low, {high.x, low.y, low.z}, {low.x, high.y, low.z});
  add_triangle(mesh, high, {low.x, high.y, high.z}, {high.x, low.y, high.z});
  Scene scene = scene_of(mesh);
  scene.up = up;
  return scene;
}

/// Checks that every vertex is inside the picture and between the planes, and that the model reasonably fills the
/// picture.
void expect_fits(const Surfaces& surfaces, const View& view) {
  const ScreenTransform t(view);
  double widest = 0;
  for (const glm::vec3& corner : surfaces.scene().meshes[0].positions) {
    const HomogeneousVertex v = transform(t, corner);
    ASSERT_TRUE(is_plain(t, v));
    const ScreenVertex s = snap(t, v);
    const double x = std::abs(double(s.x)) / t.centre_x, y = std::abs(double(s.y)) / t.centre_y;
    EXPECT_LE(std::max(x, y), 1.0);
    widest = std::max({widest, x, y});
  }
  EXPECT_GT(widest, 0.5);
}

// The model fills the picture up to the margin in the tighter direction, and is centred.
TEST(Frame, FitsTheModelNotItsBox) {
  Mesh ring;  // a disc seen edge-on: its box has corners far outside of it
  for (int i = 0; i < 720; ++i) {
    const double a = i * 3.14159265358979 / 360, b = (i + 1) * 3.14159265358979 / 360;
    add_triangle(ring, {0.1f, 0, 0}, {float(std::cos(a)), 0, float(std::sin(a))},
                 {float(std::cos(b)), 0, float(std::sin(b))});
  }
  const Scene scene = scene_of(ring);
  const Surfaces surfaces(scene);
  for (const bool orthographic : {false, true}) {
    FrameOptions options;
    options.orthographic = orthographic;
    const View view = frame(surfaces, 400, 300, options);
    const ScreenTransform t(view);
    double low_x = 1e9, high_x = -1e9, low_y = 1e9, high_y = -1e9;
    for (const glm::vec3& p : ring.positions) {
      const ScreenVertex v = snap(t, transform(t, p));
      low_x = std::min(low_x, v.x / 51200.0), high_x = std::max(high_x, v.x / 51200.0);
      low_y = std::min(low_y, v.y / 38400.0), high_y = std::max(high_y, v.y / 38400.0);
    }
    const double filled = std::max(high_x - low_x, high_y - low_y) / 2;
    EXPECT_NEAR(filled, 0.9, 0.002);
    EXPECT_NEAR(low_x + high_x, 0, 0.002);
    EXPECT_NEAR(low_y + high_y, 0, 0.002);
  }
}

/// Position of a point in the picture, in doubles without snapping: 0 is the middle, -1 and 1 are the picture's edges.
glm::dvec2 place_in_picture(const View& view, const glm::dvec3& point) {
  const glm::dvec3 d = point - view.eye();
  const Projection& p = view.projection;
  const double reach = p.orthographic ? 1 : glm::dot(d, view.forward());
  const glm::dvec2 at(glm::dot(d, view.right()) / reach, glm::dot(d, view.up()) / reach);
  return (at - glm::dvec2(p.right + p.left, p.top + p.bottom) / 2.0) /
         (glm::dvec2(p.right - p.left, p.top - p.bottom) / 2.0);
}

/// The least and the greatest position of a mesh's vertices in the picture.
std::pair<glm::dvec2, glm::dvec2> extent_in_picture(const View& view, const Mesh& mesh) {
  glm::dvec2 low(1e9), high(-1e9);
  for (const glm::vec3& p : mesh.positions) {
    const glm::dvec2 at = place_in_picture(view, glm::dvec3(p));
    low = glm::min(low, at);
    high = glm::max(high, at);
  }
  return {low, high};
}

// Principal points in the middle of the picture, off it, and outside of the picture.
constexpr Intrinsics kCameras[] = {{300, 300, 99.5, 49.5}, {300, 310, 10, 60}, {250, 400, 260, -30}};

TEST(Frame, ATargetIsInTheMiddleAndTheModelReachesTheMargin) {
  const Scene scene = scene_of(random_mesh(Kind::soup, 300, 11));
  const Surfaces surfaces(scene);
  for (const glm::dvec3& target : {glm::dvec3(0.3, -0.2, 0.1), glm::dvec3(4, 0, 0), glm::dvec3(-1, 2, 30)})
    for (int camera = -2; camera < 3; ++camera) {
      SCOPED_TRACE(testing::Message() << "camera " << camera << ", target " << target.x);
      FrameOptions options{.orthographic = camera == -2, .target = target};
      if (camera >= 0) options.intrinsics = kCameras[camera];
      const View view = frame(surfaces, 200, 100, options);
      EXPECT_LT(glm::length(place_in_picture(view, target)), 1e-9);
      const auto [low, high] = extent_in_picture(view, scene.meshes[0]);
      const double reach = std::max({-low.x, -low.y, high.x, high.y});
      EXPECT_LE(reach, 0.9 + 1e-9);
      // The view is as tight as the margin allows, unless the target is in front of the model: the eye must be behind
      // it.
      if (target.z < 30) {
        EXPECT_NEAR(reach, 0.9, 1e-9);
      }
      EXPECT_GT(glm::dot(target - view.eye(), view.forward()), 0);
    }
}

TEST(Frame, ACameraWhoseImageLiesOffItsAxisIsFilled) {
  const Scene scene = scene_of(random_mesh(Kind::soup, 300, 12));
  const Surfaces surfaces(scene);
  for (const Intrinsics& camera : kCameras) {
    const View view = frame(surfaces, 200, 100, {.intrinsics = camera});
    EXPECT_NEAR(intrinsics_of(view.projection, 200, 100, camera.rule).cx, camera.cx, 1e-9);
    const auto [low, high] = extent_in_picture(view, scene.meshes[0]);
    EXPECT_NEAR(std::max(high.x - low.x, high.y - low.y) / 2, 0.9, 2e-3);
    EXPECT_LE(std::max({-low.x, -low.y, high.x, high.y}), 0.9 + 2e-3);
    EXPECT_NEAR(glm::length(low + high), 0, 2e-3);
  }
}

TEST(Frame, RefusesWhatExcludesAnother) {
  const Scene scene = box_scene(glm::vec3(-1), glm::vec3(1), Axis::y);
  const Surfaces surfaces(scene);
  const auto refused = [&](const FrameOptions& options) -> std::string {
    try {
      (void)frame(surfaces, 10, 10, options);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(refused({.orthographic = true, .intrinsics = kCameras[0]}), "intrinsics: a parallel projection has none");
  EXPECT_EQ(refused({.target = glm::dvec3(0, std::nan(""), 0)}), "target: must be finite numbers");
  EXPECT_EQ(refused({.intrinsics = Intrinsics{0, 1, 2, 3}}), "intrinsics: focal lengths must be greater than 0");
}

TEST(Frame, ShowsTheWholeModelFromEverySide) {
  for (const Axis up : {Axis::y, Axis::z, Axis::x, Axis::minus_z})
    for (const glm::ivec2& size : {glm::ivec2(640, 480), glm::ivec2(100, 900)})
      for (const NamedView direction : kViews)
        for (const bool orthographic : {false, true}) {
          const Scene scene = box_scene({100, -3, 7}, {104, 5, 9}, up);
          const Surfaces surfaces(scene);
          FrameOptions options;
          options.direction = direction;
          options.orthographic = orthographic;
          expect_fits(surfaces, frame(surfaces, size.x, size.y, options));
        }
}

TEST(Frame, TinyAndHugeModelsFitAlike) {
  for (const float scale : {1e-6f, 1e6f}) {
    const Scene scene = box_scene(glm::vec3(-scale), glm::vec3(scale), Axis::y);
    const Surfaces surfaces(scene);
    expect_fits(surfaces, frame(surfaces, 200, 100));
  }
}

TEST(Frame, FrontOfAYUpModelLooksAlongMinusZAndOfAZUpModelAlongY) {
  FrameOptions options;
  options.direction = NamedView::front;
  const Scene y_up = box_scene(glm::vec3(-1), glm::vec3(1), Axis::y),
              z_up = box_scene(glm::vec3(-1), glm::vec3(1), Axis::z);
  const Surfaces a(y_up), b(z_up);
  EXPECT_NEAR(frame(a, 10, 10, options).forward().z, -1, 1e-12);
  EXPECT_NEAR(frame(b, 10, 10, options).forward().y, 1, 1e-12);
  EXPECT_NEAR(frame(b, 10, 10, options).up().z, 1, 1e-12);
}

TEST(Frame, EmptyAndFlatAndSinglePointModelsHaveAView) {
  const Scene empty;
  const Surfaces nothing(empty);
  EXPECT_NO_THROW((void)frame(nothing, 10, 10));
  const Scene flat = box_scene({-1, -1, 3}, {1, 1, 3}, Axis::z);
  const Surfaces sheet(flat);
  for (const NamedView direction : kViews) {
    FrameOptions options;
    options.direction = direction;
    EXPECT_NO_THROW((void)frame(sheet, 10, 10, options));
  }
  const Scene point = box_scene({5, 5, 5}, {5, 5, 5}, Axis::y);
  const Surfaces dot(point);
  EXPECT_NO_THROW((void)frame(dot, 10, 10));
}

TEST(Frame, OfABoxIsThatOfAModelWithItsCorners) {
  for (const Axis up : {Axis::y, Axis::z}) {
    Mesh mesh;  // all eight corners of the box
    add_triangle(mesh, {-1, -2, -3}, {4, -2, -3}, {-1, 5, -3});
    add_triangle(mesh, {4, 5, -3}, {4, 5, 6}, {-1, 5, 6});
    add_triangle(mesh, {4, -2, 6}, {-1, -2, 6}, {-1, -2, -3});
    Scene scene = scene_of(mesh);
    scene.up = up;
    const Surfaces corners(scene);
    for (const bool orthographic : {false, true}) {
      FrameOptions options;
      options.orthographic = orthographic;
      options.samples = 4;
      const View of_box = frame({{-1, -2, -3}, {4, 5, 6}}, up, 64, 48, options),
                 whole = frame(corners, 64, 48, options);
      EXPECT_EQ(of_box.world_from_eye, whole.world_from_eye);
      EXPECT_EQ(of_box.projection.left, whole.projection.left);
      EXPECT_EQ(of_box.projection.clip.near, whole.projection.clip.near);
      EXPECT_EQ(of_box.projection.clip.far, whole.projection.clip.far);
      EXPECT_EQ(of_box.samples, 4);
    }
  }
  const Scene empty;
  EXPECT_EQ(frame(Box(), Axis::y, 10, 10).world_from_eye, frame(Surfaces(empty), 10, 10).world_from_eye);
  EXPECT_THROW((void)frame(Box(), Axis::y, 0, 10), Error);
}

TEST(FitClip, EnclosesWhatIsBeforeTheEye) {
  const Box box{glm::vec3(-1), glm::vec3(1)};
  const ClipDistances outside = fit_clip(box, look_at({0, 0, 5}, {0, 0, 0}, {0, 1, 0}), false);
  EXPECT_LT(outside.near, 4);
  EXPECT_GT(outside.near, 3.9);
  EXPECT_GT(outside.far, 6);
  const ClipDistances inside = fit_clip(box, look_at({0, 0, 0}, {0, 0, -1}, {0, 1, 0}), false);
  EXPECT_GT(inside.near, 0);
  EXPECT_LE(inside.near, 1.1e-4);
  const ClipDistances behind = fit_clip(box, look_at({0, 0, 5}, {0, 0, 9}, {0, 1, 0}), false);
  EXPECT_TRUE(behind.near > 0 && behind.near < behind.far);
}

}  // namespace
}  // namespace frontmost::test
