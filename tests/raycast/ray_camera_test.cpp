// SPDX-License-Identifier: Apache-2.0
// Panoramas, fisheyes and laser scanners: known directions, exact ranges in a box, and the answers of six pinhole
// views.
#include <gmock/gmock.h>

#include <cmath>

#include "frontmost/files.h"
#include "frontmost/raycast.h"
#include "indexed_scene.h"
#include "support/effort.h"
#include "support/odd_numbers.h"
#include "support/random_scene.h"
#include "support/refusal.h"

namespace frontmost::test {
namespace {

constexpr double pi = 3.14159265358979323846;
/// The six sides of [-r, r]^3, two triangles each: ids 0-3 at -x, +x, 4-7 at -y, +y, 8-11 at -z, +z.
Scene box_room(float r) {
  Mesh mesh;
  for (int axis = 0; axis < 3; ++axis)
    for (const float side : {-r, r}) {
      const auto corner = [&](float u, float v) {
        glm::vec3 p;
        p[axis] = side, p[(axis + 1) % 3] = u, p[(axis + 2) % 3] = v;
        return p;
      };
      add_triangle(mesh, corner(-r, -r), corner(r, -r), corner(r, r));
      add_triangle(mesh, corner(-r, -r), corner(r, r), corner(-r, r));
    }
  return scene_of(mesh);
}

template <class T>
std::vector<T> values_of(const Buffer<T>& buffer) {
  return {buffer.begin(), buffer.end()};
}

/// Distance from the middle to the box: to the side that the largest component hits.
double range_in_box(const glm::vec3& direction, double r) {
  const glm::dvec3 d(direction), a = glm::abs(d);
  return r * glm::length(d) / std::max(a.x, std::max(a.y, a.z));
}

void expect_direction(const RayCamera& camera, int x, int y, const glm::vec3& expected) {
  const glm::vec3 direction = ray_of(camera, x, y).direction;
  for (int i = 0; i < 3; ++i) EXPECT_EQ(direction[i], expected[i]) << x << "," << y << " axis " << i;
}

void expect_near(const glm::vec3& direction, const glm::dvec3& expected) {
  EXPECT_LT(glm::distance(glm::dvec3(direction), expected), 1e-7);
}

TEST(RayCamera, APanoramasMiddleLooksAheadAndItsQuartersToTheSides) {
  // With odd sizes, one pixel's centre is the middle of the picture.
  expect_direction({Panorama{5, 3}}, 2, 1, {0, 0, -1});
  const RayCamera camera{Panorama{1000, 501}};
  const double half_pixel = pi / 1000;
  // Pixel 750 lies just past a quarter turn to the right, 249 just past one to the left.
  expect_near(ray_of(camera, 750, 250).direction, {std::cos(half_pixel), 0, std::sin(half_pixel)});
  expect_near(ray_of(camera, 249, 250).direction, {-std::cos(half_pixel), 0, std::sin(half_pixel)});
  // The picture's left and right edges meet straight behind; the top row looks almost straight up.
  expect_near(ray_of(camera, 0, 250).direction, {-std::sin(half_pixel), 0, std::cos(half_pixel)});
  expect_near(ray_of(camera, 999, 250).direction, {std::sin(half_pixel), 0, std::cos(half_pixel)});
  EXPECT_EQ(ray_of(camera, 123, 0).direction.y, float(std::cos(pi / 1002)));
  EXPECT_EQ(ray_of(camera, 123, 500).direction.y, -float(std::cos(pi / 1002)));
}

TEST(RayCamera, AFisheyesAngleGrowsEvenlyFromTheMiddle) {
  const RayCamera half{Fisheye{9, 9, pi}};
  expect_direction(half, 4, 4, {0, 0, -1});
  // 3 pixels from the middle, at a radius of 4.5, is two thirds of 90 degrees.
  expect_near(ray_of(half, 7, 4).direction, {std::sin(pi / 3), 0, -std::cos(pi / 3)});
  expect_near(ray_of(half, 4, 1).direction, {0, std::sin(pi / 3), -std::cos(pi / 3)});
  expect_near(ray_of(half, 1, 4).direction, {-std::sin(pi / 3), 0, -std::cos(pi / 3)});
  EXPECT_EQ(ray_of(half, 0, 0).direction, glm::vec3(0));  // beyond the circle
  // The full fisheye looks behind at its rim; the circle touches the nearer sides.
  const RayCamera whole{Fisheye{21, 9, 2 * pi}};
  expect_near(ray_of(whole, 10, 0).direction, {0, std::sin(pi * 8 / 9), -std::cos(pi * 8 / 9)});
  EXPECT_EQ(ray_of(whole, 5, 4).direction, glm::vec3(0));
}

TEST(RayCamera, AScannerTurnsToTheRightFromStraightAheadExactlyAtQuarters) {
  const RayCamera camera{Lidar{{pi / 2, 0, -pi / 4, -pi / 2}, 8}};
  EXPECT_EQ(grid_of(camera), glm::ivec2(8, 4));
  expect_direction(camera, 3, 0, {0, 1, 0});
  expect_direction(camera, 0, 1, {0, 0, -1});
  expect_direction(camera, 2, 1, {1, 0, 0});
  expect_direction(camera, 4, 1, {0, 0, 1});
  expect_direction(camera, 6, 1, {-1, 0, 0});
  expect_direction(camera, 5, 3, {0, -1, 0});
  const float diagonal = float(std::sqrt(0.5));
  expect_direction(camera, 2, 2, {diagonal, -diagonal, 0});
}

TEST(RayCamera, ThePoseTurnsAndMovesTheRays) {
  // The camera is at (1, 2, 3) and looks along +x, z up: its right is -y.
  const RayCamera camera{Lidar{{0}, 4}, look_at({1, 2, 3}, {2, 2, 3}, {0, 0, 1})};
  EXPECT_EQ(ray_of(camera, 0, 0).origin, glm::vec3(1, 2, 3));
  expect_near(ray_of(camera, 0, 0).direction, {1, 0, 0});
  expect_near(ray_of(camera, 1, 0).direction, {0, -1, 0});
}

TEST(RayCamera, RingsAreSpreadEvenlyFromTheTop) {
  EXPECT_THAT(ring_elevations(3, -0.5, 0.25), testing::ElementsAre(0.25, -0.125, -0.5));
  EXPECT_THAT(ring_elevations(1, -0.5, 0.25), testing::ElementsAre(-0.125));
}

TEST(RangeScan, InAClosedBoxEveryRayMeetsASideAtItsDistance) {
  const Indexed room(box_room(2));
  const RayCamera cameras[] = {{Lidar{ring_elevations(33, -pi / 2, pi / 2), 360}},
                               {Panorama{96, 48}},
                               {RayPattern{{{3, 0, 0}, {0, 0.5f, 0}, {1, 1, 1}, {-0.1f, 0.2f, -0.3f}}}}};
  for (const RayCamera& camera : cameras) {
    const RangeScan result = scan(room.index, camera);
    for (int y = 0; y < result.height; ++y)
      for (int x = 0; x < result.width; ++x) {
        const std::size_t i = result.index(x, y);
        const glm::vec3 direction = ray_of(camera, x, y).direction;
        ASSERT_NE(result.primitives[i], no_primitive) << x << "," << y;
        const double range = range_in_box(direction, 2);
        ASSERT_NEAR(result.ranges[i], range, 2e-7 * range);
        const glm::dvec3 point = glm::abs(point_of(result, x, y));
        ASSERT_NEAR(std::max(point.x, std::max(point.y, point.z)), 2, 1e-6);
      }
  }
}

TEST(RangeScan, ALevelRingMeetsTheSidesExactly) {
  const Indexed room(box_room(2));
  const RangeScan ring = scan(room.index, {Lidar{{0}, 4}});
  for (int step = 0; step < 4; ++step) EXPECT_EQ(ring.ranges[std::size_t(step)], 2.0f);
  const int sides[] = {4, 1, 5, 0};  // -z, +x, +z, -x: pairs of triangles; a ray to the middle hits both
  for (int step = 0; step < 4; ++step)
    EXPECT_EQ(ring.primitives[std::size_t(step)], PrimitiveId(2 * sides[step])) << step;
}

TEST(RangeScan, BeyondAFisheyesCircleNothingIsSeen) {
  const Indexed room(box_room(1));
  const RangeScan result = scan(room.index, {Fisheye{64, 64, 2 * pi}});
  int seen = 0;
  for (std::size_t i = 0; i < result.ranges.size(); ++i) {
    EXPECT_EQ(result.primitives[i] == no_primitive, result.ranges[i] == kFloatInfinity);
    seen += result.primitives[i] != no_primitive;
  }
  EXPECT_EQ(result.primitives[result.index(0, 0)], no_primitive);
  EXPECT_NEAR(seen, pi * 32 * 32, 40);
}

TEST(RangeScan, PlanarDepthIsThatOfAPinholeAndEndsAtTheSide) {
  const Indexed room(box_room(2));
  const RayCamera camera{Panorama{64, 32}};
  const RangeScan result = scan(room.index, camera);
  const Buffer<float> depths = planar_depths(result);
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 64; ++x) {
      const glm::vec3 direction = ray_of(camera, x, y).direction;
      const std::size_t i = result.index(x, y);
      if (direction.z < 0) {
        EXPECT_NEAR(depths[i], -point_of(result, x, y).z, 1e-6);
      } else {
        EXPECT_EQ(depths[i], kFloatInfinity);
      }
    }
  // All points on the wall ahead are 2 away along the axis.
  EXPECT_NEAR(depths[result.index(36, 18)], 2, 1e-6);
}

/// A pinhole view through a face of the cube around the eye, 90 degrees wide and high.
View face_view(const glm::dvec3& eye, const glm::dvec3& forward, int size) {
  View view;
  view.width = view.height = size;
  const glm::dvec3 up = std::abs(forward.y) > 0.5 ? glm::dvec3(0, 0, 1) : glm::dvec3(0, 1, 0);
  view.world_from_eye = look_at(eye, eye + forward, up);
  view.projection = make_projection(pi / 2, 1, {1e-3, std::numeric_limits<double>::infinity()});
  return view;
}

struct CubeViews {
  CubeViews(const RayIndex& index, const glm::dvec3& eye, int size) {
    for (int axis = 0; axis < 3; ++axis)
      for (const double sign : {-1.0, 1.0}) {
        glm::dvec3 forward(0);
        forward[axis] = sign;
        faces.push_back(raycast(index, face_view(eye, forward, size)));
      }
  }
  /// Ids in the 3 x 3 pixels around the image of a direction; empty close to a face's border.
  [[nodiscard]] std::vector<PrimitiveId> around(const glm::vec3& direction) const {
    const glm::vec3 a = glm::abs(direction);
    const int axis = a.x > a.y && a.x > a.z ? 0 : a.y > a.z ? 1 : 2;
    const Visible& face = faces[std::size_t(2 * axis + (direction[axis] > 0))];
    const glm::dvec3 eye = glm::transpose(glm::dmat3(face.view.world_from_eye)) * glm::dvec3(direction);
    const int size = face.view.width;
    const int x = int((eye.x / -eye.z + 1) * 0.5 * size), y = int((1 + eye.y / eye.z) * 0.5 * size);
    std::vector<PrimitiveId> ids;
    if (x < 1 || y < 1 || x > size - 2 || y > size - 2) return ids;
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) ids.push_back(face.primitives[face.index(x + dx, y + dy)]);
    return ids;
  }
  std::vector<Visible> faces;
};

void expect_agreement(const Indexed& of, const glm::dvec3& eye, const RayCamera& camera) {
  const RangeScan around = scan(of.index, camera);
  const CubeViews cube(of.index, eye, 512);
  int compared = 0, all = 0;
  for (int y = 0; y < around.height; ++y)
    for (int x = 0; x < around.width; ++x) {
      const glm::vec3 direction = ray_of(camera, x, y).direction;
      if (direction == glm::vec3(0)) continue;
      const std::vector<PrimitiveId> ids = cube.around(direction);
      ++all;
      // Away from edges the cube's pixels agree with each other, so the ray between them must agree too.
      if (ids.empty() || std::count(ids.begin(), ids.end(), ids[0]) != 9) continue;
      ++compared;
      ASSERT_EQ(around.primitives[around.index(x, y)], ids[0]) << x << "," << y;
    }
  EXPECT_GT(compared, all / 2);
}

TEST(RangeScan, AgreesWithSixPinholesAwayFromEdges) {
  const Indexed gallery(builtin("gallery"));
  const Box& box = gallery.surfaces.bounds();
  for (const float along : {0.07f, -0.21f}) {
    const auto eye = glm::dvec3(glm::vec3(box.centre() + along * (box.high - box.low)));
    const glm::dmat4 pose = look_at(eye, eye + glm::dvec3(1, 0.3, -0.2), {0, 1, 0});
    expect_agreement(gallery, eye, {Panorama{256, 128}, pose});
    expect_agreement(gallery, eye, {Fisheye{160, 160, 1.9 * pi}, pose});
    expect_agreement(gallery, eye, {Lidar{ring_elevations(40, -1.2, 1.3), 200}, pose});
  }
}

TEST(RangeScan, TheForwardPixelMeetsWhatThePinholesCentreMeets) {
  const Scene scene = builtin("teapot");
  const Surfaces surfaces(scene);
  const RayIndex index(surfaces);
  const View view = frame(surfaces, 65, 65);
  const Visible pinhole = raycast(index, view);
  const std::size_t centre = pinhole.index(32, 32);
  ASSERT_NE(pinhole.primitives[centre], no_primitive);
  const float depth = depths_of(pinhole)[centre];
  const RayCamera cameras[] = {{Panorama{65, 33}, view.world_from_eye},
                               {Fisheye{65, 65, 1.0}, view.world_from_eye},
                               {Lidar{{0}, 7}, view.world_from_eye}};
  for (const RayCamera& camera : cameras) {
    const RangeScan around = scan(index, camera);
    const bool is_lidar = std::holds_alternative<Lidar>(camera.model);
    const std::size_t ahead = is_lidar ? 0 : around.index(around.width / 2, around.height / 2);
    EXPECT_EQ(around.primitives[ahead], pinhole.primitives[centre]);
    EXPECT_NEAR(around.ranges[ahead], depth, 1e-5 * depth);
  }
}

TEST(RangeScan, ThreadsAndInstructionSetsChangeNoBit) {
  const Indexed of(scene_of(random_mesh(Kind::soup, 500, 9)));
  const Panorama around = tries_little ? Panorama{83, 39} : Panorama{333, 77};
  const RayCamera camera{around, look_at({0.1, 0.2, 0.3}, {1, 1, 0}, {0, 1, 0})};
  const RangeScan first = scan(of.index, camera, {.threads = 1, .isa = Isa::scalar});
  for (const Isa isa : available_isas())
    for (const int threads : {1, 2, 5}) {
      const RangeScan other = scan(of.index, camera, {.threads = threads, .isa = isa});
      EXPECT_EQ(values_of(other.primitives), values_of(first.primitives));
      EXPECT_EQ(values_of(other.ranges), values_of(first.ranges));
    }
}

TEST(RangeScan, NothingIsMetInAnEmptySceneOrWithoutADirection) {
  const Indexed empty{Scene{}}, room(box_room(1));
  const RangeScan none = scan(empty.index, {Panorama{8, 4}});
  EXPECT_THAT(values_of(none.primitives), testing::Each(no_primitive));
  EXPECT_THAT(values_of(none.ranges), testing::Each(kFloatInfinity));
  const RangeScan nonsense = scan(room.index, {RayPattern{{{0, 0, 0}, {kNan, 0, 1}, {kFloatInfinity, 0, 0}}}});
  EXPECT_THAT(values_of(nonsense.primitives), testing::Each(no_primitive));
  EXPECT_THAT(values_of(planar_depths(nonsense)), testing::Each(kFloatInfinity));
}

ErrorCode refusal(const RayCamera& camera) {
  return code_of([&] { validate(camera); });
}

TEST(RayCamera, RefusesWhatIsOutOfRange) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto bad = ErrorCode::bad_argument, large = ErrorCode::limit_exceeded;
  EXPECT_EQ(refusal({Panorama{0, 4}}), bad);
  EXPECT_EQ(refusal({Panorama{4, 16385}}), large);
  for (const double fov : {0.0, -1.0, 7.0, nan}) EXPECT_EQ(refusal({Fisheye{4, 4, fov}}), bad);
  EXPECT_EQ(refusal({Fisheye{4, 0, 1}}), bad);
  EXPECT_EQ(refusal({Lidar{{}, 4}}), bad);
  EXPECT_EQ(refusal({Lidar{{0}, 0}}), bad);
  for (const double elevation : {2.0, -2.0, nan}) EXPECT_EQ(refusal({Lidar{{elevation}, 4}}), bad);
  EXPECT_EQ(refusal({Lidar{std::vector<double>(3, 0.0), 1 << 28}}), large);
  EXPECT_EQ(refusal({RayPattern{}}), bad);
  EXPECT_EQ(refusal({Panorama{}, glm::dmat4(1.0), 3}), bad);
  EXPECT_EQ(refusal({Fisheye{}, glm::dmat4(1.0), 0}), bad);
  EXPECT_EQ(refusal({Lidar{{0}, 4}, glm::dmat4(1.0), 4}), bad);
  EXPECT_EQ(refusal({Panorama{16384, 8192}, glm::dmat4(1.0), 4}), large);
  EXPECT_EQ(refusal({Panorama{}, glm::dmat4(2.0)}), ErrorCode::singular_camera);
  glm::dmat4 far_away(1.0);
  far_away[3].x = 1e300;
  EXPECT_EQ(refusal({Panorama{}, far_away}), large);
  EXPECT_THROW((void)ring_elevations(0, 0, 1), Error);
  EXPECT_THROW((void)ring_elevations(3, 1, 0), Error);
}

TEST(RangeScan, SamplesLieWhereThoseOfAViewDo) {
  // The middle pixel of a fisheye looks ahead; the 10 pixels from the middle to the rim span 60 degrees.
  const RayCamera camera{Fisheye{21, 21, 2.1 * pi / 3}, glm::dmat4(1.0), 4};
  const std::span<const glm::ivec2> offsets = sample_offsets(4);
  for (int s = 0; s < 4; ++s) {
    const glm::dvec2 at = glm::dvec2(offsets[std::size_t(s)]) / 256.0 - 0.5;
    const double angle = glm::length(at) * glm::radians(6.0);
    expect_near(ray_of(camera, 10, 10, s).direction, {std::sin(angle) * at.x / glm::length(at),
                                                      -std::sin(angle) * at.y / glm::length(at), -std::cos(angle)});
  }
  const RayCamera around{Panorama{12, 6}, glm::dmat4(1.0), 16};
  for (int s = 0; s < 16; ++s) {
    const double azimuth = sample_offsets(16)[std::size_t(s)].x / 256.0 * pi / 6;
    const double elevation = (3 - 2 - sample_offsets(16)[std::size_t(s)].y / 256.0) * pi / 6;
    expect_near(ray_of(around, 6, 2, s).direction, {std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
                                                    -std::cos(azimuth) * std::cos(elevation)});
  }
}

TEST(RangeScan, EverySampleMeetsWhatItsRayMeets) {
  const Indexed of(scene_of(random_mesh(Kind::soup, 300, 4)));
  for (const RayCamera& camera :
       {RayCamera{Panorama{30, 17}, glm::dmat4(1.0), 8}, RayCamera{Fisheye{20, 25, 4}, glm::dmat4(1.0), 2}}) {
    const RangeScan result = scan(of.index, camera);
    ASSERT_EQ(result.ranges.size(), std::size_t(result.width * result.height * camera.samples));
    for (int s = 0; s < camera.samples; ++s)
      for (int y = 0; y < result.height; ++y)
        for (int x = 0; x < result.width; ++x) {
          const RayHit hit = closest_hit(of.index, ray_of(camera, x, y, s));
          ASSERT_EQ(result.primitives[result.index(x, y, s)], hit.primitive);
        }
    EXPECT_EQ(planar_depths(result).size(), result.ranges.size());
  }
}

TEST(RangeScan, CanBeCancelled) {
  const Indexed room(box_room(1));
  Watch watch;
  watch.cancelled = [] { return true; };
  EXPECT_THROW((void)scan(room.index, {Panorama{64, 32}}, {.watch = &watch}), Error);
}

}  // namespace
}  // namespace frontmost::test
