// SPDX-License-Identifier: Apache-2.0
// All messages that refuse a view, a projection, a pose or a merge, next to the nearest accepted values.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "frontmost/view.h"

namespace frontmost {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();

/// "argument, limit or camera: message" of the error; "taken" if there is none.
template <class Action>
std::string outcome(Action&& action) {
  try {
    action();
    return "taken";
  } catch (const Error& error) {
    const std::string words = error.what();
    switch (error.code()) {
      case ErrorCode::bad_argument: return "argument, " + words;
      case ErrorCode::limit_exceeded: return "limit, " + words;
      case ErrorCode::singular_camera: return "camera, " + words;
      default: return "another code, " + words;
    }
  }
}

View good_view() {
  View view;
  view.width = 8;
  view.height = 4;
  view.world_from_eye = look_at({0, 0, 3}, {0, 0, 0}, {0, 1, 0});
  view.projection = make_projection(1.0, 2.0, {0.5, 10});
  return view;
}

template <class Change>
std::string changed(Change&& change) {
  View view = good_view();
  change(view);
  return outcome([&] { validate(view); });
}

TEST(RefusedViews, SizesAndSamples) {
  EXPECT_EQ(changed([](View&) {}), "taken");
  EXPECT_EQ(changed([](View& v) { v.width = 0; }), "argument, width: must be 1 to 16384");
  EXPECT_EQ(changed([](View& v) { v.width = 16384; }), "taken");
  EXPECT_EQ(changed([](View& v) { v.width = 16385; }), "limit, width: must be 1 to 16384");
  EXPECT_EQ(changed([](View& v) { v.height = -1; }), "argument, height: must be 1 to 16384");
  EXPECT_EQ(changed([](View& v) { v.height = 1 << 30; }), "limit, height: must be 1 to 16384");
  for (const int samples : {1, 2, 4, 8, 16}) EXPECT_EQ(changed([&](View& v) { v.samples = samples; }), "taken");
  for (const int samples : {-1, 0, 3, 5, 32, 64})
    EXPECT_EQ(changed([&](View& v) { v.samples = samples; }), "argument, samples: must be 1, 2, 4, 8 or 16");
  // 2^14 x 2^13 pixels of two samples reach the limit exactly.
  const auto many = [](int width, int height, int samples) {
    return changed([&](View& v) { v.width = width, v.height = height, v.samples = samples; });
  };
  EXPECT_EQ(many(16384, 8192, 2), "taken");
  EXPECT_EQ(many(16384, 8193, 2), "limit, samples: at most 268435456 in all pixels together");
  EXPECT_EQ(many(16384, 16384, 1), "taken");
}

TEST(RefusedViews, PlanesAndSidesOfTheirProjection) {
  const auto clipped = [](bool orthographic, double near, double far) {
    return changed([&](View& v) {
      v.projection.orthographic = orthographic;
      v.projection.clip = {near, far};
    });
  };
  EXPECT_EQ(clipped(false, 0, 1), "argument, near: must be greater than 0 in perspective");
  EXPECT_EQ(clipped(true, 0, 1), "taken");
  EXPECT_EQ(clipped(true, -5, 1), "taken");
  EXPECT_EQ(clipped(false, 1, infinity), "taken");
  EXPECT_EQ(clipped(true, 1, infinity), "argument, far: must be a finite number");
  EXPECT_EQ(clipped(false, 1, 1), "argument, far: must be greater than near");
  EXPECT_EQ(clipped(false, 1, nan), "argument, far: must be a number");
  EXPECT_EQ(clipped(false, nan, 5), "argument, near: must be a finite number");
  EXPECT_EQ(clipped(false, infinity, infinity), "argument, near: must be a finite number");
  EXPECT_EQ(clipped(false, -1e-300, 5), "argument, near: must be greater than 0 in perspective");
  EXPECT_EQ(clipped(false, 1e-320, 5), "limit, near: must be at least 1.2e-38");
  EXPECT_EQ(clipped(false, 1e-39, 5), "limit, near: must be at least 1.2e-38");
  EXPECT_EQ(clipped(false, 1, 1 + 1e-12), "limit, far: too close to near, or too large, for floats");
  EXPECT_EQ(clipped(true, 0, 1e39), "limit, far: must be within the range of floats, and differ from near");
  EXPECT_EQ(changed([](View& v) { v.projection.right = v.projection.left; }),
            "argument, right: must be greater than left");
  EXPECT_EQ(changed([](View& v) { std::swap(v.projection.top, v.projection.bottom); }),
            "argument, top: must be greater than bottom");
  EXPECT_EQ(changed([](View& v) { v.projection.left = nan; }), "argument, left: must be a finite number");
  EXPECT_EQ(changed([](View& v) { v.projection.right = infinity; }), "argument, right: must be a finite number");
  EXPECT_EQ(changed([](View& v) { v.projection.right = v.projection.left + 1e-40; }),
            "argument, right: must be greater than left")
      << "lost in the sum";
  EXPECT_EQ(changed([](View& v) { v.projection.left = -1e-40, v.projection.right = 1e-40; }),
            "limit, projection: its sides are too close together, or too far from the axis, for floats");
}

TEST(RefusedViews, PosesThatAreNotRigid) {
  const std::string rigid = "camera, pose: must be a rotation and a translation, last row 0 0 0 1";
  EXPECT_EQ(changed([](View& v) { v.world_from_eye[0] *= 1.001; }), rigid);
  EXPECT_EQ(changed([](View& v) { v.world_from_eye[0] *= 1.00001; }), "taken") << "text files have few digits";
  EXPECT_EQ(changed([](View& v) { v.world_from_eye[0] *= -1.0; }), rigid) << "mirrored";
  EXPECT_EQ(changed([](View& v) { v.world_from_eye[1] = v.world_from_eye[0]; }), rigid);
  EXPECT_EQ(changed([](View& v) { v.world_from_eye[0][3] = 0.5; }), rigid) << "the last row";
  EXPECT_EQ(changed([](View& v) { v.world_from_eye[3][3] = 2; }), rigid);
  EXPECT_EQ(changed([](View& v) { v.world_from_eye[3][0] = nan; }), rigid);
  EXPECT_EQ(changed([](View& v) { v.world_from_eye[2][2] = nan; }), rigid);
  EXPECT_EQ(changed([](View& v) { v.world_from_eye[3][0] = 1e39; }),
            "limit, pose: the eye is farther from the origin than floats reach");
}

TEST(RefusedProjections, FieldOfViewAspectAndIntrinsics) {
  const auto field = [](double fov, double aspect) {
    return outcome([&] { (void)make_projection(fov, aspect, {0.1, 10}); });
  };
  EXPECT_EQ(field(3.14159, 1), "taken");
  for (const double fov : {0.0, -1.0, 3.1415926536, 7.0})
    EXPECT_EQ(field(fov, 1), "argument, field of view: must be between 0 and 180 degrees");
  EXPECT_EQ(field(nan, 1), "argument, field of view: must be a finite number");
  EXPECT_EQ(field(1, 0), "argument, aspect: must be greater than 0");
  EXPECT_EQ(field(1, infinity), "argument, aspect: must be a finite number");
  const auto pinhole = [](const Intrinsics& k, int width, int height) {
    return outcome([&] { (void)make_projection(k, width, height, {0.1, 10}); });
  };
  EXPECT_EQ(pinhole({1, 1, -9, 9}, 1, 1), "taken") << "the centre may lie outside of the picture";
  EXPECT_EQ(pinhole({0, 1, 0, 0}, 1, 1), "argument, intrinsics: focal lengths must be greater than 0");
  EXPECT_EQ(pinhole({1, -1, 0, 0}, 1, 1), "argument, intrinsics: focal lengths must be greater than 0");
  EXPECT_EQ(pinhole({1, 1, nan, 0}, 1, 1), "argument, intrinsics: must be a finite number");
  EXPECT_EQ(pinhole({1, 1, 0, 0}, 0, 1), "argument, resolution: width and height must be at least 1");
  EXPECT_EQ(outcome([] {
              (void)intrinsics_of(make_orthographic(-1, 1, -1, 1, {0, 1}), 4, 4, PixelRule::centre_at_half);
            }),
            "argument, intrinsics: a parallel projection has none");
}

TEST(RefusedPoses, LookingNowhere) {
  const auto look = [](const glm::dvec3& eye, const glm::dvec3& target, const glm::dvec3& up) {
    return outcome([&] { (void)look_at(eye, target, up); });
  };
  const std::string apart = "camera, camera: eye and target must be finite and apart";
  EXPECT_EQ(look({0, 0, 0}, {0, 0, 0}, {0, 1, 0}), apart);
  EXPECT_EQ(look({infinity, 0, 0}, {0, 0, 0}, {0, 1, 0}), apart);
  EXPECT_EQ(look({0, 0, 0}, {0, nan, 0}, {0, 1, 0}), apart);
  EXPECT_EQ(look({-1e200, 0, 0}, {1e200, 0, 0}, {0, 1, 0}), apart) << "their distance is beyond doubles";
  EXPECT_EQ(look({0, 0, 0}, {0, 0, 1e-150}, {0, 1, 0}), "taken") << "however near";
  // An invalid up vector is replaced by y, the default.
  for (const glm::dvec3& up : {glm::dvec3(0), glm::dvec3(nan, 0, 0), glm::dvec3(infinity, 0, 0)})
    EXPECT_EQ(look_at({0, 0, 3}, {0, 0, 0}, up), look_at({0, 0, 3}, {0, 0, 0}, {0, 1, 0}));
}

TEST(RefusedMerges, SayWhatIsNotTheSame) {
  const View view = good_view();
  const auto merged = [&](const auto& change) {
    Visible into = nothing_visible(view);
    View other = view;
    change(other);
    return outcome([&] { merge(into, nothing_visible(other)); });
  };
  EXPECT_EQ(merged([](View&) {}), "taken");
  const std::string differ = "argument, merge: the two views are not the same";
  EXPECT_EQ(merged([](View& v) { v.culling = Culling::back; }), differ);
  EXPECT_EQ(merged([](View& v) { v.samples = 2; }), differ);
  EXPECT_EQ(merged([](View& v) { v.world_from_eye[3][0] += 1e-12; }), differ);
  EXPECT_EQ(merged([](View& v) { v.projection.clip.near = std::nextafter(v.projection.clip.near, 1); }), differ);
  EXPECT_EQ(merged([](View& v) { v.projection.left *= 2; }), differ);
  EXPECT_EQ(merged([](View& v) { v.projection = make_orthographic(-1, 1, -1, 1, {0.5, 10}); }), differ);
  Visible into = nothing_visible(view), seen = nothing_visible(view);
  seen.primitives[5] = 7;
  seen.keys[5] = 0.5f;
  EXPECT_EQ(outcome([&] { merge(into, seen, no_primitive - 8); }), "taken");
  EXPECT_EQ(into.primitives[5], no_primitive - 1);
  EXPECT_EQ(outcome([&] { merge(into, seen, no_primitive - 7); }),
            "limit, merge: more than 4294967294 triangles, the most that ids can number");
}

TEST(SampleOffsets, AreThoseOfDirect3D) {
  // D3D11_STANDARD_MULTISAMPLE_QUALITY_LEVELS, in sixteenths from the centre: the first and the last of each pattern.
  const struct {
    int samples;
    glm::ivec2 first, last;
  } known[] = {
      {1, {0, 0}, {0, 0}}, {2, {4, 4}, {-4, -4}}, {4, {-2, -6}, {2, 6}}, {8, {1, -3}, {7, -7}}, {16, {1, 1}, {-7, -8}}};
  for (const auto& pattern : known) {
    const auto offsets = sample_offsets(pattern.samples);
    ASSERT_EQ(offsets.size(), std::size_t(pattern.samples));
    EXPECT_EQ(offsets.front(), 128 + 16 * pattern.first);
    EXPECT_EQ(offsets.back(), 128 + 16 * pattern.last);
    // In an N rooks pattern, every row and every column of the N x N grid has one sample.
    if (pattern.samples == 1 || pattern.samples == 2) continue;
    std::uint32_t columns = 0, rows = 0;
    for (const glm::ivec2& at : offsets) {
      columns |= 1u << (at.x * pattern.samples / 256);
      rows |= 1u << (at.y * pattern.samples / 256);
    }
    EXPECT_EQ(columns, (1u << pattern.samples) - 1) << pattern.samples;
    EXPECT_EQ(rows, (1u << pattern.samples) - 1) << pattern.samples;
  }
}

}  // namespace
}  // namespace frontmost
