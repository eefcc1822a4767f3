// SPDX-License-Identifier: Apache-2.0
// Many triangles at one place: one behind the other, around one edge, or identical copies.
#include <gtest/gtest.h>

#include "frontmost/lines.h"
#include "support/costly_meshes.h"
#include "support/effort.h"
#include "support/refusal.h"

namespace frontmost::test {
namespace {

/// The parts, with consecutive equally hidden parts joined.
std::vector<DrawnPart> without_counts(const Drawing& drawing) {
  std::vector<DrawnPart> parts;
  for (DrawnPart part : drawing.parts) {
    part.hidden_by = std::min(part.hidden_by, 1u);
    if (!parts.empty() && parts.back().edge == part.edge && parts.back().hidden_by == part.hidden_by)
      parts.back().end = part.end;
    else
      parts.push_back(part);
  }
  return parts;
}

/// Compares drawings with and without counts. Counting tests everything against everything; without it, whole hidden
/// cells are skipped.
void expect_as_counted(const Scene& scene, const View& view) {
  const Surfaces surfaces(scene);
  LineOptions options;
  options.crease_angle = 0;
  const std::vector<DrawnPart> parts = draw_lines(surfaces, view, options).parts;
  options.counts_hidden = true;
  const std::vector<DrawnPart> counted = without_counts(draw_lines(surfaces, view, options));
  ASSERT_EQ(parts.size(), counted.size());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    ASSERT_EQ(parts[i].edge, counted[i].edge);
    ASSERT_EQ(parts[i].hidden_by, counted[i].hidden_by) << i;
    ASSERT_EQ(parts[i].begin, counted[i].begin) << i;
    ASSERT_EQ(parts[i].end, counted[i].end) << i;
  }
}

TEST(Crowds, AreDrawnAsIfAllWereHeldAgainstAll) {
  for (const Crowd kind : all_crowds)
    for (std::uint64_t seed = 0; seed < seeds(2); ++seed) {
      SCOPED_TRACE(int(kind) * 10 + int(seed));
      Random random(seed);
      expect_as_counted(scene_of(crowd(kind, 600)), random_view(random, 200, 150));
    }
}

TEST(Crowds, SoAreScenesOfEveryKind) {
  for (const Kind kind : all_kinds)
    for (std::uint64_t seed = 0; seed < seeds(2); ++seed) {
      if (kind == Kind::sheets) continue;
      SCOPED_TRACE(int(kind) * 100 + int(seed));
      const RandomCase random = random_case(kind, seed);
      expect_as_counted(random.scene, random.view);
    }
}

TEST(Crowds, CopiesChangeNothing) {
  for (const Kind kind : {Kind::soup, Kind::slivers, Kind::fan, Kind::shared_grid, Kind::coplanar})
    for (std::uint64_t seed = 0; seed < seeds(6); ++seed) {
      SCOPED_TRACE(int(kind) * 100 + int(seed));
      Random random(seed);
      Mesh mesh = random_mesh(kind, 100, seed);
      const View view = random_view(random, 160, 120);
      const Scene once = scene_of(mesh);
      // Copies have other vertex orders, and some have the reverse winding.
      const std::vector<glm::uvec3> triangles = mesh.triangles;
      for (int copy = 0; copy < 3; ++copy)
        for (const glm::uvec3& t : triangles) {
          if (random.below(4) == 0) continue;
          mesh.triangles.push_back(copy == 0 ? t : copy == 1 ? glm::uvec3(t.y, t.z, t.x) : glm::uvec3(t.x, t.z, t.y));
        }
      const Scene often = scene_of(std::move(mesh));
      const Drawing one = draw_lines(Surfaces(once), view, {.outlines = true});
      const Drawing many = draw_lines(Surfaces(often), view, {.outlines = true});
      ASSERT_EQ(one.edges.size(), many.edges.size());
      for (std::size_t i = 0; i < one.edges.size(); ++i) {
        ASSERT_EQ(one.edges[i].from, many.edges[i].from);
        ASSERT_EQ(one.edges[i].to, many.edges[i].to);
        ASSERT_EQ(one.edges[i].kind, many.edges[i].kind);
      }
      ASSERT_EQ(one.parts.size(), many.parts.size());
      for (std::size_t i = 0; i < one.parts.size(); ++i) {
        ASSERT_EQ(one.parts[i].end, many.parts[i].end);
        ASSERT_EQ(one.parts[i].hidden_by, many.parts[i].hidden_by);
        ASSERT_EQ(one.parts[i].is_outline, many.parts[i].is_outline);
      }
    }
}

TEST(Crowds, OfTheSameTriangleAreOne) {
  Mesh mesh;
  for (int i = 0; i < 20000; ++i) add_triangle(mesh, {-1, -1, 0}, {1, -1, 0.3f}, {0.5f, 1, 0});
  const Scene scene = scene_of(std::move(mesh));
  const Surfaces surfaces(scene);
  const Drawing drawing = draw_lines(surfaces, frame(surfaces, 320, 240));
  EXPECT_EQ(drawing.edges.size(), 3u);
  ASSERT_EQ(drawing.parts.size(), 3u);
  for (const DrawnPart& part : drawing.parts) EXPECT_EQ(part.hidden_by, 0u);
}

/// Number of times that drawing a mesh asks whether to stop; question number `last` is answered with yes.
std::size_t questions_of(const Mesh& mesh, std::size_t last, std::size_t& edges) {
  const Scene scene = scene_of(mesh);
  const Surfaces surfaces(scene);
  const View view = frame(surfaces, 640, 480);
  const CountingWatch watch(last);
  try {
    edges = draw_lines(surfaces, view, {.crease_angle = 0}, watch.execution()).edges.size();
    EXPECT_EQ(last, CountingWatch::never) << "it went on";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::cancelled);
    EXPECT_EQ(watch.asked(), last) << "it was told to stop, and asked again";
  }
  return watch.asked();
}

/// Between two questions, at most sixteen edges are cut, and at most some thousand triangles are examined.
TEST(Crowds, AskOftenWhetherToStop) {
  Mesh crossing;
  Random random(9);
  for (int i = 0; i < 400; ++i) {
    const glm::vec3 a = random.point(1), b = random.point(1), aside = random.point(0.3f);
    add_triangle(crossing, a, b, (a + b) * 0.5f + aside);
  }
  std::vector<Mesh> meshes = {crossing};
  for (const Crowd kind : all_crowds) meshes.push_back(crowd(kind, 1000));
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    SCOPED_TRACE(i);
    std::size_t edges = 0;
    const std::size_t asked = questions_of(meshes[i], CountingWatch::never, edges);
    ASSERT_GT(edges, 500u);
    EXPECT_GT(asked, edges / 16);
    for (const std::size_t last : {std::size_t(1), asked / 3, asked / 2, asked - 1, asked})
      (void)questions_of(meshes[i], last, edges);
  }
}

/// Error message of drawing a mesh from above.
std::string refusal_from_above(const Mesh& mesh, int threads) {
  const Scene scene = scene_of(mesh);
  View view;
  view.width = view.height = 640;
  view.world_from_eye = look_at({0, 0, 10}, {0, 0, 0}, {0, 1, 0});
  view.projection = make_orthographic(-2, 2, -2, 2, {1, 20});
  return refusal_of(ErrorCode::limit_exceeded,
                    [&] { (void)draw_lines(Surfaces(scene), view, {}, {.threads = threads}); });
}

/// Needles that all pass through each other have more segments than the limit; the error names the place.
TEST(Crowds, OfMoreSegmentsThanAreKeptAreRefused) {
  const Mesh mesh = slivers_through_point(1600);
  const std::string refusal = refusal_from_above(mesh, 1);
  EXPECT_EQ(refusal.find("lines: more than 1074176 segments in which triangles intersect: most of them, 1600, "
                         "in one place, among them face "),
            0u)
      << refusal;
  EXPECT_EQ(refusal_from_above(mesh, 4), refusal);
}

}  // namespace
}  // namespace frontmost::test
