// SPDX-License-Identifier: Apache-2.0
// Visible triangles and their visible areas: against every triangle less all in front of it, and against areas computed
// by hand.
#include <gmock/gmock.h>

#include <glm/gtc/constants.hpp>
#include <numeric>

#include "frontmost/frontmost.h"
#include "support/effort.h"
#include "support/face_oracle.h"
#include "support/meshes.h"
#include "support/random_scene.h"

namespace frontmost::test {
namespace {

double sum_of_pixels(const VisibleFaces& seen) {
  double sum = 0;
  for (const VisibleFace& face : seen.faces) sum += face.pixels;
  return sum;
}

/// Visible areas of each face by the answer and by the reference; 0 for a face that one of them lacks.
struct BothAreas {
  double pixels[2]{}, units[2]{}, solid_angle[2]{};
};

std::map<PrimitiveId, BothAreas> both_areas(const VisibleFaces& seen, const FaceOracle& oracle) {
  std::map<PrimitiveId, BothAreas> both;
  for (const VisibleFace& face : seen.faces) {
    BothAreas& areas = both[face.id];
    areas.pixels[0] = face.pixels;
    areas.units[0] = face.area;
    areas.solid_angle[0] = face.solid_angle;
  }
  for (const auto& [id, found] : oracle.visible_areas()) {
    BothAreas& areas = both[id];
    areas.pixels[1] = double(found.pixels);
    areas.units[1] = double(found.units);
    areas.solid_angle[1] = double(found.solid_angle);
  }
  return both;
}

/// Small scenes of every kind, so that every triangle can be compared with all others.
RandomCase small_case(Kind kind, std::uint64_t seed) {
  Random random(seed + 7000);
  const int most = seed % 20 == 0 ? 150 : 40;  // some have enough for divided cells
  RandomCase made{scene_of(random_mesh(kind, 5 + random.below(most), seed)), {}};
  const int width = 1 + random.below(150), height = 1 + random.below(150);
  made.view = random_view(random, width, height);
  made.view.culling = Culling(random.below(3));
  return made;
}

class VisibleFacesOfKind : public testing::TestWithParam<Kind> {};

TEST_P(VisibleFacesOfKind, AreWhatIsLeftOfEveryTriangle) {
  for (std::uint64_t seed = 0; seed < seeds(40); ++seed) {
    SCOPED_TRACE(seed);
    const RandomCase made = small_case(GetParam(), seed);
    const Surfaces surfaces(made.scene);
    const VisibleFaces seen = visible_faces(surfaces, made.view);
    const FaceOracle oracle(surfaces, made.view);
    const double picture = double(made.view.pixel_count());
    for (const auto& [id, areas] : both_areas(seen, oracle)) {
      EXPECT_NEAR(areas.pixels[0], areas.pixels[1], 1e-9 * picture) << id;
      if (std::max(areas.pixels[0], areas.pixels[1]) < 1e-9 * picture) continue;  // has a vertex a million units away
      // Where sheets cross at an angle of 2^-24, doubles locate the line to 2^-29 of its length.
      const double crossing = GetParam() == Kind::sheets ? std::ldexp(1.0, std::max(0, int(seed % 25) - 16)) : 1;
      EXPECT_NEAR(areas.units[0], areas.units[1], 1e-9 * (areas.units[1] + 1) * crossing) << id;
      EXPECT_NEAR(areas.solid_angle[0], areas.solid_angle[1], 1e-9) << id;
    }
    EXPECT_NEAR(sum_of_pixels(seen), double(oracle.covered_area()), 1e-9 * picture);
  }
}

INSTANTIATE_TEST_SUITE_P(All, VisibleFacesOfKind, testing::ValuesIn(all_kinds));

/// A view of 64 x 64 pixels, 16 pixels a unit, from above: z points to the eye.
View view_from_above() {
  View view;
  view.width = view.height = 64;
  view.world_from_eye = look_at({0, 0, 10}, {0, 0, 0}, {0, 1, 0});
  view.projection = make_orthographic(-2, 2, -2, 2, {1, 20});
  return view;
}

MATCHER_P2(IsFace, id, pixels, "") { return arg.id == PrimitiveId(id) && std::abs(arg.pixels - pixels) < 1e-9; }

TEST(VisibleFaces, WhatAnotherCoversIsTakenOff) {
  Mesh mesh;
  add_triangle(mesh, {-1, -1, 0}, {1, -1, 0}, {-1, 1, 0});        // 2 square units, 512 square pixels
  add_triangle(mesh, {-1.5f, 0, 1}, {1.5f, 0, 1}, {1.5f, 3, 1});  // extends beyond the picture: 256 * 2.25 / 2
  add_triangle(mesh, {-0.5f, -0.75f, -1}, {0, -0.75f, -1}, {-0.5f, -0.25f, -1});  // below
  const Scene scene = scene_of(mesh);
  const VisibleFaces seen = visible_faces(Surfaces(scene), view_from_above());
  // The part of the first triangle above y = 0 and below y = x + 1.5 is hidden: half a unit less a corner of 1/16.
  const double hidden = 256 * (0.5 - 0.0625);
  const double second = 256 * (4.5 - 0.5);  // less the corner above y = 2
  EXPECT_THAT(seen.faces, testing::ElementsAre(IsFace(0, 512 - hidden), IsFace(1, second)));
  EXPECT_NEAR(seen.faces[0].area, 2 - hidden / 256, 1e-12);
  EXPECT_EQ(seen.faces[0].solid_angle, 0);
}

TEST(VisibleFaces, TheSmallestTriangleIsFound) {
  Mesh mesh;
  add_square(mesh, 3, 0);
  const float size = 1e-6f;  // 16 millionths of a pixel
  add_triangle(mesh, {0.3f, 0.3f, 1}, {0.3f + size, 0.3f, 1}, {0.3f, 0.3f + size, 1});
  const Scene scene = scene_of(mesh);
  const Surfaces surfaces(scene);
  const VisibleFaces seen = visible_faces(surfaces, view_from_above());
  const auto corners = surfaces.corners(2);
  const double expected =
      128 * (double(corners[1].x) - double(corners[0].x)) * (double(corners[2].y) - double(corners[0].y));
  ASSERT_EQ(seen.faces.size(), 3u);
  EXPECT_NEAR(seen.faces[2].pixels, expected, 1e-6 * expected);
  EXPECT_NEAR(sum_of_pixels(seen), 64 * 64, 1e-9 * 64 * 64);
}

TEST(VisibleFaces, OfOnePlaneTheLowerIdIsSeen) {
  // Two squares in a plane oblique to all axes, each cut along another diagonal, and a copy of the first triangle.
  const glm::vec3 a(-1, -1, -0.5f), b(1, -1, 0.25f), c(1, 1, 0.5f), d(-1, 1, -0.25f);
  Mesh mesh;
  add_triangle(mesh, a, b, c);
  add_triangle(mesh, b, c, d);
  add_triangle(mesh, c, a, b);
  add_triangle(mesh, a, c, d);
  add_triangle(mesh, d, a, b);
  const Scene scene = scene_of(mesh);
  // a + c = b + d, so all are exactly coplanar. The second triangle keeps what the first leaves, and so on.
  EXPECT_THAT(visible_faces(Surfaces(scene), view_from_above()).faces,
              testing::ElementsAre(IsFace(0, 512), IsFace(1, 256), IsFace(3, 256)));
}

TEST(VisibleFaces, ASideOfACubeAroundTheEyeIsASixthOfTheSphere) {
  Mesh mesh;
  add_quad(mesh, {-100, -100, -7}, {100, -100, -7}, {100, 100, -7}, {-100, 100, -7});
  const Scene scene = scene_of(mesh);
  View view = make_view(glm::radians(90.0), 50, 50).between(0.1, 100);
  const VisibleFaces seen = visible_faces(Surfaces(scene), view);
  double solid_angle = 0, area = 0;
  for (const VisibleFace& face : seen.faces) solid_angle += face.solid_angle, area += face.area;
  EXPECT_NEAR(solid_angle, 2 * glm::pi<double>() / 3, 1e-13);
  EXPECT_NEAR(area, 14 * 14, 1e-10);
  EXPECT_NEAR(sum_of_pixels(seen), 2500, 1e-9);
}

TEST(VisibleFaces, CullingLeavesOutWhatTurnsAwayAlsoWhereInstancesMirror) {
  Scene scene = scene_of([] {
    Mesh mesh;
    add_square(mesh, 1, 0);
    return mesh;
  }());
  View view = view_from_above();
  view.culling = Culling::back;
  EXPECT_NEAR(sum_of_pixels(visible_faces(Surfaces(scene), view)), 1024, 1e-9);
  scene.instances[0].world_from_mesh[0][0] = -1;  // its front stays where it was, and its outside stays outside
  EXPECT_NEAR(sum_of_pixels(visible_faces(Surfaces(scene), view)), 1024, 1e-9);
  view.culling = Culling::front;
  EXPECT_THAT(visible_faces(Surfaces(scene), view).faces, testing::IsEmpty());
  scene.instances[0].world_from_mesh = glm::dmat4(1.0);
  scene.instances[0].world_from_mesh[0][0] = scene.instances[0].world_from_mesh[2][2] = -1;  // turned around
  EXPECT_NEAR(sum_of_pixels(visible_faces(Surfaces(scene), view)), 1024, 1e-9);
}

TEST(VisibleFaces, OfManyBeforeAWallFillThePicture) {
  for (std::uint64_t seed = 0; seed < seeds(12); ++seed) {
    SCOPED_TRACE(seed);
    // Intersecting meshes in cells that are divided repeatedly; no part of the wall is lost or counted twice.
    Scene scene = scene_of(bumpy_ball(20 + 10 * int(seed % 3), seed % 5 == 0 ? 0.0f : 0.3f, seed));
    scene.meshes.push_back(random_mesh(seed % 2 == 0 ? Kind::tiny : Kind::slivers, 300, seed));
    Mesh wall;
    add_square(wall, 4, -3);
    add_quad(wall, {-9, -8, -3}, {8, -9, 3}, {9, 8, 2}, {-8, 9, -2});  // across the picture, through the balls
    scene.meshes.push_back(wall);
    scene.instances.push_back({"again", 0, glm::dmat4(0.9)});
    scene.instances[1].world_from_mesh[3] = {0.3, 0.2, 0.1, 1};
    scene.instances.push_back({"others", 1, glm::dmat4(1.0)});
    scene.instances.push_back({"wall", 2, glm::dmat4(1.0)});
    View view = view_from_above();
    view.width = view.height = 64 << seed % 4;
    const double picture = double(view.pixel_count());
    EXPECT_NEAR(sum_of_pixels(visible_faces(Surfaces(scene), view)), picture, 1e-9 * picture);
  }
}

TEST(VisibleFaces, AreTheSameForAnyNumberOfThreads) {
  Scene scene = scene_of(bumpy_ball(40, 0.2f, 5));
  scene.meshes.push_back(random_mesh(Kind::soup, 300, 4));
  scene.instances.push_back({"soup", 1, glm::dmat4(1.0)});
  const Surfaces surfaces(scene);
  Random random(3);
  const View view = random_view(random, 300, 200);
  Execution one, four;
  one.threads = 1;
  four.threads = 4;
  const VisibleFaces a = visible_faces(surfaces, view, one), b = visible_faces(surfaces, view, four);
  ASSERT_EQ(a.faces.size(), b.faces.size());
  ASSERT_GT(a.faces.size(), 100u);
  for (std::size_t i = 0; i < a.faces.size(); ++i) {
    EXPECT_EQ(a.faces[i].id, b.faces[i].id);
    EXPECT_EQ(a.faces[i].pixels, b.faces[i].pixels);
    EXPECT_EQ(a.faces[i].area, b.faces[i].area);
    EXPECT_EQ(a.faces[i].solid_angle, b.faces[i].solid_angle);
  }
}

TEST(FacesEverSeen, AreThoseOfAllViewsWithTheirLargestShare) {
  Mesh mesh;
  add_square(mesh, 1, 0);
  add_quad(mesh, {0, -1, 1}, {1, -1, 1}, {1, 1, 1}, {0, 1, 1});                           // over its right half
  add_triangle(mesh, {-0.5f, -0.5f, -1}, {0.5f, -0.5f, -1}, {-0.5f, 0.5f, -1});           // below
  add_triangle(mesh, {-0.1f, -0.1f, -0.5f}, {0.1f, -0.1f, -0.5f}, {-0.1f, 0.1f, -0.5f});  // between: never seen
  add_quad(mesh, {-1, -1, -0.75f}, {1, -1, -0.75f}, {1, 1, -0.75f}, {-1, 1, -0.75f});
  const Scene scene = scene_of(mesh);
  const View above = view_from_above();
  View below = above;
  below.world_from_eye = look_at({0, 0, -10}, {0, 0, 0}, {0, 1, 0});
  const View views[] = {above, below, above};
  const std::vector<SeenFace> seen = faces_ever_seen(Surfaces(scene), views);
  std::vector<PrimitiveId> ids;
  for (const SeenFace& face : seen) ids.push_back(face.id);
  EXPECT_THAT(ids, testing::ElementsAre(0, 1, 2, 3, 4, 6, 7));
  EXPECT_EQ(seen[0].view_count, 2u);
  EXPECT_EQ(seen[0].best_view, 0u);
  EXPECT_NEAR(seen[0].largest_share + seen[1].largest_share, 1, 1e-12);  // a quarter of one and three quarters of the
                                                                         // other
  EXPECT_EQ(seen[4].view_count, 1u);
  EXPECT_EQ(seen[4].best_view, 1u);
  EXPECT_NEAR(seen[4].largest_share, 1, 1e-12);
  EXPECT_NEAR(seen[4].largest_pixels, 128, 1e-9);
  EXPECT_THAT(faces_ever_seen(Surfaces(scene), {}), testing::IsEmpty());
}

TEST(KeptFaces, AreASceneOfTheirOwnThatLooksTheSame) {
  Scene scene = scene_of(bumpy_ball(20, 0.2f, 5));
  scene.meshes[0].texcoords.values.assign(scene.meshes[0].positions.size(), glm::vec2(0.25f));
  scene.instances.push_back({"hidden", 0, glm::dmat4(0.1)});
  scene.instances[1].world_from_mesh[3][3] = 1;
  scene.instances.push_back({"moved", 0, glm::dmat4(1.0)});
  scene.instances[2].world_from_mesh[3] = {0.8, 0.3, 0, 1};
  const Surfaces surfaces(scene);
  const VisibleFaces seen = visible_faces(surfaces, view_from_above());
  std::vector<PrimitiveId> ids;
  for (const VisibleFace& face : seen.faces) ids.push_back(face.id);
  const Scene kept = keep_faces(scene, ids);
  EXPECT_EQ(triangle_count(kept), ids.size());
  ASSERT_EQ(kept.instances.size(), 2u);
  EXPECT_EQ(kept.instances[1].name, "moved");
  EXPECT_LT(kept.meshes[0].positions.size(), scene.meshes[0].positions.size());
  EXPECT_EQ(kept.meshes[0].texcoords.values.size(), kept.meshes[0].positions.size());
  const Surfaces kept_surfaces(kept);
  const VisibleFaces again = visible_faces(kept_surfaces, view_from_above());
  ASSERT_EQ(again.faces.size(), ids.size());
  for (std::size_t i = 0; i < ids.size(); ++i) {
    EXPECT_EQ(again.faces[i].id, i);
    EXPECT_EQ(kept_surfaces.corners(PrimitiveId(i)), surfaces.corners(ids[i]));
    EXPECT_EQ(
        kept.meshes[kept_surfaces.source(PrimitiveId(i)).mesh].face_of(kept_surfaces.source(PrimitiveId(i)).triangle),
        surfaces.source(ids[i]).triangle);
    EXPECT_NEAR(again.faces[i].pixels, seen.faces[i].pixels, 1e-9);
  }
}

TEST(KeptFaces, KeepTheirStatedEdges) {
  Scene scene = scene_of(bumpy_ball(4, 0, 1));
  Mesh& mesh = scene.meshes[0];
  const glm::uvec3 first = mesh.triangles[0], other = mesh.triangles[5];
  mesh.sharp_edges = {{other.x, other.y}, {first.x, first.y}, {first.y, first.z}};
  mesh.smooth_edges = {{first.z, first.x}};
  mesh.edge_circles = {{{0, 0, 0}, {0, 0, 1}, 1, 0, 1}, {{0, 0, 0}, {0, 0, 1}, 2, 2, 1}};
  const PrimitiveId ids[] = {0};
  const Scene kept = keep_faces(scene, ids);
  validate(kept);
  const Mesh& left = kept.meshes[0];
  const glm::uvec3 own = left.triangles[0];
  EXPECT_THAT(left.sharp_edges, testing::ElementsAre(glm::uvec2(own.x, own.y), glm::uvec2(own.y, own.z)));
  EXPECT_THAT(left.smooth_edges, testing::ElementsAre(glm::uvec2(own.z, own.x)));
  ASSERT_EQ(left.edge_circles.size(), 1u);
  EXPECT_EQ(left.edge_circles[0].radius, 2);
  EXPECT_EQ(left.edge_circles[0].first, 1u);
}

TEST(KeptFaces, OfAMeshThatStatesSmoothSidesAreNotJudgedByAngles) {
  // The ball's sides meet at angles. Its faces have vertices of their own, as those of CAD files.
  const Mesh ball = bumpy_ball(8, 0.3, 1);
  Mesh mesh;
  for (const glm::uvec3& t : ball.triangles)
    add_triangle(mesh, ball.positions[t.x], ball.positions[t.y], ball.positions[t.z]);
  const auto creases = [](const Scene& scene) {
    const Surfaces surfaces(scene);
    const Drawing drawing = draw_lines(surfaces, frame(surfaces, 200, 200));
    return std::count_if(drawing.edges.begin(), drawing.edges.end(),
                         [](const DrawnEdge& edge) { return edge.kind == EdgeKind::crease; });
  };
  std::vector<PrimitiveId> ids(mesh.triangles.size() - 1);
  std::iota(ids.begin(), ids.end(), PrimitiveId(1));
  EXPECT_GT(creases(keep_faces(scene_of(mesh), ids)), 0);
  const glm::uvec3 first = mesh.triangles[0];
  mesh.smooth_edges = {{first.x, first.y}};
  EXPECT_EQ(creases(scene_of(mesh)), 0);
  const Scene kept = keep_faces(scene_of(mesh), ids);
  validate(kept);
  EXPECT_EQ(creases(kept), 0);
  EXPECT_EQ(kept.meshes[0].smooth_edges.size(), 1u);
  // A sharp edge stays one.
  const glm::uvec3 last = mesh.triangles.back();
  mesh.sharp_edges = {{last.x, last.y}};
  EXPECT_EQ(creases(keep_faces(scene_of(mesh), ids)), creases(scene_of(mesh)));
  // A smooth edge that is no side covers nothing, before and after.
  mesh.smooth_edges = {{first.x, last.x}};
  EXPECT_GT(creases(keep_faces(scene_of(mesh), ids)), 1);
}

TEST(KeptFaces, ThatAreNotOrTwiceAreRefused) {
  const Scene scene = scene_of(bumpy_ball(4, 0, 1));
  const auto count = PrimitiveId(triangle_count(scene));
  for (const std::vector<PrimitiveId>& ids : {std::vector<PrimitiveId>{count}, {1, 1}, {2, 1}})
    EXPECT_THROW((void)keep_faces(scene, ids), Error);
  EXPECT_TRUE(keep_faces(scene, {}).instances.empty());
}

TEST(VisibleFaces, OfNothingThereAreNone) {
  const Scene scene;
  EXPECT_THAT(visible_faces(Surfaces(scene), view_from_above()).faces, testing::IsEmpty());
  Mesh mesh;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  add_triangle(mesh, {nan, 0, 0}, {1, 0, 0}, {0, 1, 0});
  add_triangle(mesh, {0, 0, 0}, {1, 0, 0}, {0.5f, 0, 0});   // without area
  add_triangle(mesh, {0, 0, 0}, {1, 0, 0}, {0.5f, 0, -1});  // seen edge-on
  add_triangle(mesh, {0, 0, 30}, {1, 0, 30}, {0, 1, 30});   // behind the eye
  const Scene odd = scene_of(mesh);
  EXPECT_THAT(visible_faces(Surfaces(odd), view_from_above()).faces, testing::IsEmpty());
  View bad = view_from_above();
  bad.width = 0;
  EXPECT_THROW((void)visible_faces(Surfaces(odd), bad), Error);
}

}  // namespace
}  // namespace frontmost::test
