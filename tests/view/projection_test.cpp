// SPDX-License-Identifier: Apache-2.0
// Projections against each other, and against the cube that they map the frustum to.

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "frontmost/view.h"
#include "support/odd_numbers.h"

namespace frontmost::test {
namespace {

constexpr DepthConvention kDepthConventions[] = {gortler_depth, opengl_depth, zero_to_one_depth, reversed_depth};

glm::dvec3 divide(const glm::dvec4& clip) { return glm::dvec3(clip) / clip.w; }

void expect_near(const glm::dmat4& a, const glm::dmat4& b, double tolerance = 1e-12) {
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) EXPECT_NEAR(a[i][j], b[i][j], tolerance) << "column " << i << " row " << j;
}

TEST(Projection, FrustumCornersLandOnTheCubesCorners) {
  const Projection frustum = make_frustum(-0.3, 0.5, -0.2, 0.4, {0.5, 40});
  const Projection parallel = make_orthographic(-3, 5, -2, 4, {-1, 40});
  for (const Projection& p : {frustum, parallel})
    for (const DepthConvention& depth : kDepthConventions)
      for (const bool at_far : {false, true})
        for (int corner = 0; corner < 4; ++corner) {
          const double distance = at_far ? p.clip.far : p.clip.near, spread = p.orthographic ? 1 : distance;
          const glm::dvec4 eye((corner & 1 ? p.right : p.left) * spread, (corner & 2 ? p.top : p.bottom) * spread,
                               -distance, 1);
          const glm::dvec3 ndc = divide(clip_from_eye(p, depth) * eye);
          EXPECT_NEAR(ndc.x, corner & 1 ? 1 : -1, 1e-12);
          EXPECT_NEAR(ndc.y, corner & 2 ? 1 : -1, 1e-12);
          EXPECT_NEAR(ndc.z, at_far ? depth.at_far : depth.at_near, 1e-12);
        }
}

// Gortler, Foundations of 3D Computer Graphics, equation 11.2, with -2n/(r-l) and -2n/(t-b) on the diagonal; n and f
// are negative there.
TEST(Projection, EqualsGortlersMatrices) {
  const double l = -0.3, r = 0.5, b = -0.2, t = 0.4, n = -0.5, f = -40;
  glm::dmat4 expected(0.0);
  expected[0][0] = -2 * n / (r - l);
  expected[1][1] = -2 * n / (t - b);
  expected[2][0] = (r + l) / (r - l);
  expected[2][1] = (t + b) / (t - b);
  expected[2][2] = (f + n) / (f - n);
  expected[3][2] = -2 * f * n / (f - n);
  expected[2][3] = -1;
  expect_near(clip_from_eye(make_frustum(l, r, b, t, ClipDistances::at_z(n, f)), gortler_depth), expected);
}

TEST(Projection, EqualsOpenGLsFrustum) {
  const double l = -0.3, r = 0.5, b = -0.2, t = 0.4, n = 0.5, f = 40;
  glm::dmat4 expected(0.0);
  expected[0][0] = 2 * n / (r - l);
  expected[1][1] = 2 * n / (t - b);
  expected[2][0] = (r + l) / (r - l);
  expected[2][1] = (t + b) / (t - b);
  expected[2][2] = -(f + n) / (f - n);
  expected[3][2] = -2 * f * n / (f - n);
  expected[2][3] = -1;
  expect_near(clip_from_eye(make_frustum(l, r, b, t, {n, f}), opengl_depth), expected);
}

TEST(Projection, SmallerFieldOfViewIsTheSmallerOne) {
  const double fov = 0.7, side = std::tan(fov / 2);
  const Projection wide = make_projection(fov, 2.0, {1, 2}), tall = make_projection(fov, 0.5, {1, 2});
  EXPECT_DOUBLE_EQ(wide.top, side);
  EXPECT_DOUBLE_EQ(wide.right, 2 * side);
  EXPECT_DOUBLE_EQ(tall.right, side);
  EXPECT_DOUBLE_EQ(tall.top, 2 * side);
  expect_near(clip_from_eye(wide), clip_from_eye(make_frustum(-2 * side, 2 * side, -side, side, {1, 2})));
}

TEST(Projection, InfiniteFarIsTheLimitOfFarPlanes) {
  for (const DepthConvention& depth : kDepthConventions)
    expect_near(clip_from_eye(make_projection(1, 1.5, {0.1, kInfinity}), depth),
                clip_from_eye(make_projection(1, 1.5, {0.1, 1e12}), depth), 1e-11);
}

TEST(Projection, DistanceUndoesDepth) {
  const Projection projections[] = {make_projection(1, 1, {0.1, 50}), make_projection(1, 1, {0.1, kInfinity}),
                                    make_orthographic(-1, 1, -1, 1, {-2, 50})};
  for (const Projection& p : projections)
    for (const DepthConvention& depth : kDepthConventions)
      for (const double distance : {0.1, 0.5, 3.0, 49.0}) {
        const glm::dvec3 ndc = divide(clip_from_eye(p, depth) * glm::dvec4(0, 0, -distance, 1));
        EXPECT_NEAR(distance_of_depth(p, depth, ndc.z), distance, 1e-9 * distance / 0.01);
      }
  EXPECT_EQ(distance_of_depth(projections[1], reversed_depth, 0), kInfinity);
}

TEST(Projection, IntrinsicsProjectAsAPinholeCameraDoes) {
  const Intrinsics k{600, 610, 300.25, 250.75, PixelRule::centre_at_integer};
  const Projection p = make_projection(k, 640, 480, {0.1, 100});
  // x right, y down, z forward; OpenCV counts from the first pixel's centre.
  const glm::dvec3 point(0.3, -0.2, 2.0);
  const double u = k.fx * point.x / point.z + k.cx, v = k.fy * point.y / point.z + k.cy;
  const glm::dvec3 ndc = divide(clip_from_eye(p) * glm::dvec4(point.x, -point.y, -point.z, 1));
  EXPECT_NEAR((ndc.x + 1) / 2 * 640, u + 0.5, 1e-9);
  EXPECT_NEAR((1 - ndc.y) / 2 * 480, v + 0.5, 1e-9);

  const Intrinsics back = intrinsics_of(p, 640, 480, PixelRule::centre_at_integer);
  EXPECT_NEAR(back.fx, k.fx, 1e-9);
  EXPECT_NEAR(back.cy, k.cy, 1e-9);
  const Intrinsics half = intrinsics_of(p, 640, 480, PixelRule::centre_at_half);
  EXPECT_NEAR(half.cx, k.cx + 0.5, 1e-9);
}

TEST(Projection, RefusesWhatMakesNoSense) {
  EXPECT_THROW((void)make_projection(0, 1, {1, 2}), Error);
  EXPECT_THROW((void)make_projection(3.2, 1, {1, 2}), Error);
  EXPECT_THROW((void)make_projection(1, 0, {1, 2}), Error);
  EXPECT_THROW((void)make_projection(1, 1, {0, 2}), Error);
  EXPECT_THROW((void)make_projection(1, 1, {2, 1}), Error);
  EXPECT_THROW((void)make_projection(std::nan(""), 1, {1, 2}), Error);
  EXPECT_THROW((void)make_frustum(1, 1, 0, 1, {1, 2}), Error);
  EXPECT_THROW((void)make_orthographic(0, 1, 0, 1, {1, kInfinity}), Error);
  EXPECT_THROW((void)make_projection(Intrinsics{0, 1, 0, 0}, 4, 4, {1, 2}), Error);
  EXPECT_THROW((void)intrinsics_of(make_orthographic(0, 1, 0, 1, {1, 2}), 4, 4, PixelRule::centre_at_half), Error);
}

/// The message that refuses a view; "" if the view is valid.
std::string refusal(const Projection& projection, const glm::dvec3& eye = {0, 0, 0}) {
  View view{64, 48, 1, glm::dmat4(1.0), projection, {}};
  view.world_from_eye[3] = glm::dvec4(eye, 1);
  try {
    validate(view);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::limit_exceeded);
    return error.what();
  }
  return "";
}

TEST(View, HasALimitOfSamplesInAll) {
  View view{16384, 16384, 1, glm::dmat4(1.0), make_projection(1, 1, {1, 2}), {}};
  EXPECT_NO_THROW(validate(view));
  view.samples = 2;
  try {
    validate(view);
    FAIL() << "4 GiB of planes";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::limit_exceeded);
    EXPECT_EQ(std::string(error.what()).rfind("samples:", 0), 0u);
  }
}

TEST(View, OutOfTheRangeOfFloatsIsRefusedByTheFieldsName) {
  EXPECT_EQ(refusal(make_projection(1, 1, {1e-37, kInfinity})), "");
  EXPECT_EQ(refusal(make_projection(1, 1, {1e-3, 1e300})), "");  // as good as infinite
  EXPECT_EQ(refusal(make_projection(1, 1, {1e-39, 1})).rfind("near:", 0), 0u);
  EXPECT_EQ(refusal(make_projection(1, 1, {1e39, kInfinity})).rfind("far:", 0), 0u);
  EXPECT_EQ(refusal(make_projection(1, 1, {1, 1 + 1e-12})).rfind("far:", 0), 0u);
  EXPECT_EQ(refusal(make_orthographic(-1, 1, -1, 1, {0, 1e39})).rfind("far:", 0), 0u);
  EXPECT_EQ(refusal(make_orthographic(-1, 1, -1, 1, {0, 1e-40})).rfind("far:", 0), 0u);
  EXPECT_EQ(refusal(make_projection(1e-40, 1, {1, 2})).rfind("projection:", 0), 0u);
  EXPECT_EQ(refusal(make_projection(1, 1, {1, 2}), {0, 1e39, 0}).rfind("pose:", 0), 0u);
}

TEST(Samples, LieInThePixelAndAreAllDifferent) {
  for (const int count : {1, 2, 4, 8, 16}) {
    const auto offsets = sample_offsets(count);
    ASSERT_EQ(offsets.size(), std::size_t(count));
    for (std::size_t i = 0; i < offsets.size(); ++i) {
      EXPECT_TRUE(offsets[i].x >= 0 && offsets[i].x < 256 && offsets[i].y >= 0 && offsets[i].y < 256);
      // Rotated grids: no two samples share a row or column, so level and upright edges are smooth too.
      for (std::size_t j = 0; j < i; ++j)
        EXPECT_TRUE(offsets[i].x != offsets[j].x && offsets[i].y != offsets[j].y) << count << " samples";
    }
  }
  EXPECT_THROW((void)sample_offsets(3), Error);
}

}  // namespace
}  // namespace frontmost::test
