// SPDX-License-Identifier: Apache-2.0
// Hatch lines on known shapes, and against every triangle of random scenes, point by point.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "frontmost/lines.h"
#include "support/effort.h"
#include "support/hatch_oracle.h"
#include "support/random_scene.h"

namespace frontmost::test {
namespace {

View view_with_z_up(const glm::dvec3& eye, bool is_parallel) {
  View view;
  view.width = view.height = 200;
  view.world_from_eye = look_at(eye, glm::dvec3(0), glm::dvec3(0, 0, 1));
  view.projection = is_parallel ? make_orthographic(-2, 2, -2, 2, {0.5, 50}) : make_projection(0.6, 1, {0.5, 50});
  return view;
}

/// Adds a quad, counter-clockwise seen from its front, cut into `n` by `n` pieces.
void add_cut_quad(Mesh& mesh, const glm::vec3& corner, const glm::vec3& along, const glm::vec3& up, int n = 1) {
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      const auto at = [&](int i, int j) { return corner + along * (float(i) / float(n)) + up * (float(j) / float(n)); };
      add_triangle(mesh, at(x, y), at(x + 1, y), at(x + 1, y + 1));
      add_triangle(mesh, at(x, y), at(x + 1, y + 1), at(x, y + 1));
    }
}

/// The faces x = 1, y = 1 and z = 1 of the cube from -1 to 1.
Scene three_faces(int n = 1) {
  Mesh mesh;
  add_cut_quad(mesh, {1, -1, -1}, {0, 2, 0}, {0, 0, 2}, n);
  add_cut_quad(mesh, {1, 1, -1}, {-2, 0, 0}, {0, 0, 2}, n);
  add_cut_quad(mesh, {-1, -1, 1}, {2, 0, 0}, {0, 2, 0}, n);
  return scene_of(std::move(mesh));
}

double length_of(const std::vector<HatchLine>& lines, std::uint32_t set) {
  double sum = 0;
  for (const HatchLine& line : lines)
    if (line.set == set) sum += glm::distance(line.from, line.to);
  return sum;
}

HatchOptions options_of(std::vector<HatchSet> sets, const glm::dvec3& to_light, bool casts_shadows = true) {
  HatchOptions options;
  options.sets = std::move(sets);
  options.tone.to_light = to_light;
  options.tone.casts_shadows = casts_shadows;
  return options;
}

TEST(Hatch, TheFacesOfACubeHaveTheirTones) {
  const Scene scene = three_faces();
  const Surfaces surfaces(scene);
  // Seen along the diagonal, each face is a rhombus of 4 / sqrt(3) square units, of 2500 pixels each.
  const View view = view_with_z_up({5, 5, 5}, true);
  const double face = 4 / std::sqrt(3.0) * 2500;
  // The light (1, 2, 2), scaled to length 1, gives brightnesses of 1/3, 2/3 and 2/3.
  const std::vector<HatchSet> sets = {{0.3, 1, 0.25, 0.7}, {0.3, 1, 0.75, 0.5}, {1.2, 1, 0.5, 0.3}};
  const std::vector<HatchLine> lines = hatch(surfaces, view, options_of(sets, {1, 2, 2}));
  EXPECT_NEAR(length_of(lines, 0), 3 * face, 0.001 * face);
  EXPECT_NEAR(length_of(lines, 1), face, 0.001 * face);
  EXPECT_EQ(length_of(lines, 2), 0);
  // Set 1 hatches only the face x = 1, which is left of the middle.
  for (const HatchLine& line : lines)
    if (line.set == 1) {
      EXPECT_LE(std::max(line.from.x, line.to.x), 100 + 1e-9);
    }
}

TEST(Hatch, LinesAreTheirSpacingApart) {
  const Scene scene = scene_of(random_mesh(Kind::soup, 200, 3));
  const Surfaces surfaces(scene);
  for (const bool is_parallel : {false, true}) {
    const HatchSet set{2.1, 3.7, -1.3, 0.8};
    const glm::dvec2 across(std::sin(set.angle), std::cos(set.angle));
    const std::vector<HatchLine> lines =
        hatch(surfaces, view_with_z_up({3, 4, 2}, is_parallel), options_of({set}, {1, 1, 3}));
    EXPECT_GT(lines.size(), 100u);
    for (const HatchLine& line : lines)
      for (const glm::dvec2& end : {line.from, line.to}) {
        const double number = (glm::dot(across, end) - set.offset) / set.spacing;
        EXPECT_NEAR(number, std::round(number), 1e-5);  // the angle's sines are floats
      }
  }
}

TEST(Hatch, IsTheSameHoweverAFaceIsCut) {
  const View view = view_with_z_up({4, 3, 6}, false);
  const Scene whole = three_faces(), cut = three_faces(8);
  const HatchOptions options = options_of({{0.9, 5, 1, 0.7}, {2, 5, 2, 0.4}}, {1, 2, 2});
  const Surfaces few(whole), many(cut);
  const std::vector<HatchLine> a = hatch(few, view, options), b = hatch(many, view, options);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_LT(glm::distance(a[i].from, b[i].from), 1e-6);
    EXPECT_LT(glm::distance(a[i].to, b[i].to), 1e-6);
  }
}

/// A floor, and a plate of half its size above it.
Scene plate_over_floor(float height) {
  Mesh floor, plate;
  add_cut_quad(floor, {-1, -1, 0}, {2, 0, 0}, {0, 2, 0});
  add_cut_quad(plate, {-0.5f, -0.5f, height}, {1, 0, 0}, {0, 1, 0});
  Scene scene = scene_of(std::move(floor));
  scene.meshes.push_back(std::move(plate));
  scene.instances.push_back({"plate", 1, glm::dmat4(1.0)});
  return scene;
}

TEST(Hatch, CopiesOfTrianglesChangeNothingAndCostNothing) {
  constexpr std::size_t triangles_per_question = 16, lines_per_question = 256;
  const Scene once = three_faces();
  Mesh mesh = once.meshes[0];
  const std::vector<glm::uvec3> triangles = mesh.triangles;
  // The copies have all vertex orders, and so both windings.
  for (int copy = 0; copy < (tries_little ? 12 : 300); ++copy)
    for (const glm::uvec3& t : triangles)
      mesh.triangles.push_back(copy % 3 == 0   ? t
                               : copy % 3 == 1 ? glm::uvec3(t.y, t.z, t.x)
                                               : glm::uvec3(t.x, t.z, t.y));
  const Scene often = scene_of(std::move(mesh));
  const View view = view_with_z_up({5, 4, 3}, false);
  const HatchOptions options = options_of({{0.3, 1, 0.25, 0.7}, {1.2, 1, 0.5, 0.5}}, {1, 2, 2});
  // Hatching asks whether to stop after a number of triangles, and after a number of their lines.
  CountingWatch watch;
  const std::vector<HatchLine> lines = hatch(Surfaces(once), view, options, watch.execution());
  const std::size_t asked_once = watch.asked();
  watch.restart();
  const Surfaces copies(often);
  const std::vector<HatchLine> same = hatch(copies, view, options, watch.execution());
  const std::size_t most = asked_once + 2 * copies.primitive_count() / triangles_per_question;
  EXPECT_LT(watch.asked(), most);
  if (!tries_little) {
    // If the copies were hatched too, hatching would ask more often.
    EXPECT_GT(copies.primitive_count() / triangles.size() * lines.size() / lines_per_question, most);
  }
  ASSERT_EQ(same.size(), lines.size());
  EXPECT_GT(lines.size(), 100u);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    EXPECT_EQ(same[i].from, lines[i].from);
    EXPECT_EQ(same[i].to, lines[i].to);
  }
}

TEST(Hatch, ShadowsHaveTheirExactPlaces) {
  const Scene scene = plate_over_floor(0.25f);
  const Surfaces surfaces(scene);
  // The first view is from below, where only the floor's dark side is seen; the next ones are from above.
  View view;
  view.width = view.height = 200;
  view.world_from_eye = look_at({0, 0, 10}, glm::dvec3(0), glm::dvec3(0, 1, 0));
  view.projection = make_orthographic(-2, 2, -2, 2, {0.5, 50});
  // Light along (1, 0, -1): the plate's shadow is shifted 0.25 to +x, and the plate covers the rest of it.
  const std::vector<HatchLine> lines = hatch(surfaces, view, options_of({{0, 2, 0.5, 0.1}}, {-1, 0, 1}));
  ASSERT_EQ(lines.size(), 25u);
  for (const HatchLine& line : lines) {
    EXPECT_NEAR(line.from.x, 125, 1e-6);
    EXPECT_NEAR(line.to.x, 137.5, 1e-6);
    EXPECT_EQ(line.instance, 0u);
  }
  EXPECT_TRUE(hatch(surfaces, view, options_of({{0, 2, 0.5, 0.1}}, {-1, 0, 1}, false)).empty());
  // The other sides of both are all dark, and only the floor is seen.
  view.world_from_eye = look_at({0, 0, -10}, glm::dvec3(0), glm::dvec3(0, 1, 0));
  EXPECT_NEAR(length_of(hatch(surfaces, view, options_of({{0, 2, 0.5, 0.1}}, {-1, 0, 1})), 0), 50 * 100, 1e-6);
}

/// A sphere of radius 1 about the origin: rings of quads.
Scene ball_scene(int rings) {
  Mesh mesh;
  const auto at = [&](int i, int j) {
    const double a = std::numbers::pi * i / rings, b = std::numbers::pi * j / rings;
    return glm::vec3(std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a));
  };
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < 2 * rings; ++j) {
      if (i > 0) add_triangle(mesh, at(i, j), at(i + 1, j), at(i, j + 1));
      if (i + 1 < rings) add_triangle(mesh, at(i, j + 1), at(i + 1, j), at(i + 1, j + 1));
    }
  return scene_of(std::move(mesh));
}

TEST(Hatch, EndsOnASphereWhereItIsAsBrightAsThat) {
  const Scene scene = ball_scene(tries_little ? 24 : 48);
  const Surfaces surfaces(scene);
  const View view = view_with_z_up({0, -8, 0}, true);
  const glm::dvec3 light = glm::normalize(glm::dvec3(-1, -1, 1));
  const std::vector<HatchLine> lines = hatch(surfaces, view, options_of({{0.7, 2, 0, 0.4}}, light));
  std::size_t within = 0;
  double worst = 0;
  for (const HatchLine& line : lines)
    for (const glm::dvec2& end : {line.from, line.to}) {
      const glm::dvec2 p = (end - 100.0) / 50.0;
      if (glm::length(p) > 0.95) continue;  // at the rim, where the sphere itself ends
      ++within;
      const glm::dvec3 normal(p.x, -std::sqrt(1 - glm::dot(p, p)), -p.y);
      worst = std::max(worst, std::abs(glm::dot(normal, light) - 0.4));
    }
  EXPECT_GT(within, 15u);
  // Flat shading would be off by half a facet, 2 degrees, or 0.03.
  EXPECT_LT(worst, tries_little ? 0.04 : 0.01);
}

class EveryKindHatched : public testing::TestWithParam<Kind> {};

/// Random points of random hatch lines are hatched exactly where the visible surface is dark.
TEST_P(EveryKindHatched, WhereItIsSeenAndDark) {
  std::size_t asked = 0, certain = 0, dark = 0;
  for (std::uint64_t seed = 0; seed < seeds(8); ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed + 300);
    const Scene scene = scene_of(random_mesh(GetParam(), GetParam() == Kind::sheets ? 30 : 120, seed));
    const View view = random_view(random, 160, 120);
    HatchOptions options = options_of({{0.8, 6, 1, 0.5}}, glm::dvec3(random.point(1)) + 0.01, seed % 2 == 0);
    options.tone.crease_angle = 0;
    const Surfaces surfaces(scene);
    const std::vector<HatchLine> lines = hatch(surfaces, view, options);
    const HatchOracle oracle(surfaces, view, options);
    for (int i = 0; i < 500; ++i) {
      const HatchOracle::Place place = oracle.random_place(random);
      const HatchOracle::Answer answer = oracle.ask(place);
      ++asked;
      if (!answer.is_certain) continue;
      ++certain;
      dark += answer.is_dark;
      EXPECT_EQ(HatchOracle::is_hatched(lines, place), answer.is_dark) << place.at.x << " " << place.at.y;
    }
  }
  EXPECT_GT(double(certain), GetParam() == Kind::coplanar ? 0 : 0.8 * double(asked));
  RecordProperty("asked", int(asked));
  RecordProperty("left_out", int(asked - certain));
  EXPECT_GT(dark + (GetParam() == Kind::tiny || GetParam() == Kind::slivers), 0u);
}

INSTANTIATE_TEST_SUITE_P(Hatch, EveryKindHatched, testing::ValuesIn(all_kinds));

bool are_same(const std::vector<HatchLine>& a, const std::vector<HatchLine>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const HatchLine& x, const HatchLine& y) {
    return x.from == y.from && x.to == y.to && x.set == y.set && x.instance == y.instance;
  });
}

TEST(Hatch, ThreadsAndInstructionSetsChangeNothing) {
  const Scene scene = scene_of(random_mesh(Kind::soup, 2000, 9));
  const Surfaces surfaces(scene);
  const View view = frame(surfaces, 300, 200);
  HatchOptions options;
  options.sets = hatch_sets(5, 0.7);
  const std::vector<HatchLine> one = hatch(surfaces, view, options, {.threads = 1});
  EXPECT_GT(one.size(), 500u);
  EXPECT_TRUE(are_same(hatch(surfaces, view, options, {.threads = 5}), one));
  for (const Isa isa : available_isas()) EXPECT_TRUE(are_same(hatch(surfaces, view, options, {.isa = isa}), one));
}

TEST(Hatch, ForPlottersOrderedAndOtherwiseTheSame) {
  const Scene scene = plate_over_floor(0.25f);
  const Surfaces surfaces(scene);
  const View view = view_with_z_up({3, 4, 5}, false);
  HatchOptions options = options_of(hatch_sets(4, 0.7), {-1, 0.2, 0.3});
  const std::vector<HatchLine> apart = hatch(surfaces, view, options);
  options.by_instance = false;
  const std::vector<HatchLine> sorted = hatch(surfaces, view, options);
  options.nearest_first = true;
  const std::vector<HatchLine> ordered = hatch(surfaces, view, options);
  const auto travel = [](const std::vector<HatchLine>& lines) {
    double sum = 0;
    for (std::size_t i = 1; i < lines.size(); ++i) sum += glm::distance(lines[i - 1].to, lines[i].from);
    return sum;
  };
  ASSERT_EQ(ordered.size(), sorted.size());
  EXPECT_LT(2 * travel(ordered), travel(sorted));
  for (std::uint32_t set = 0; set < 3; ++set) {
    EXPECT_NEAR(length_of(ordered, set), length_of(sorted, set), 1e-6);
    EXPECT_NEAR(length_of(apart, set), length_of(sorted, set), 1e-6);
  }
  for (const HatchLine& line : ordered) EXPECT_EQ(line.instance, no_index);
}

TEST(Hatch, StaysWithinThePictureOnWhatReachesFarBeyond) {
  View view = view_with_z_up({0, -1, 0.1}, false);
  view.projection.clip.far = std::numeric_limits<double>::infinity();
  for (const float reach : {1e6f, 1e12f, 1e20f, 1e30f}) {
    Mesh floor;
    add_triangle(floor, {-reach, -reach, -1}, {reach, -reach, -1}, {0, reach, -1});
    const Scene scene = scene_of(std::move(floor));
    const Surfaces surfaces(scene);
    const std::vector<HatchLine> lines =
        hatch(surfaces, view, options_of({{0.7, 5, 0, 1}, {0, 5, 0, 1}, {1.57, 5, 0, 1}}, {0.2, 0, 1}, false));
    EXPECT_FALSE(lines.empty());
    for (const HatchLine& line : lines)
      for (const glm::dvec2& end : {line.from, line.to})
        EXPECT_TRUE(end.x > -1e-3 && end.y > -1e-3 && end.x < 200.001 && end.y < 200.001) << end.x << " " << end.y;
  }
}

TEST(Hatch, ShortLinesAreLeftOutWhereAskedFor) {
  const Scene scene = scene_of(random_mesh(Kind::soup, 300, 4));
  const Surfaces surfaces(scene);
  const View view = frame(surfaces, 300, 200);
  HatchOptions options = options_of({{0, 3, 0, 1}}, {0, 0, 1});
  const std::vector<HatchLine> all = hatch(surfaces, view, options);
  options.shortest = 5;
  const std::vector<HatchLine> some = hatch(surfaces, view, options);
  EXPECT_LT(some.size(), all.size());
  EXPECT_GT(some.size(), 10u);
  for (const HatchLine& line : some) EXPECT_GE(glm::distance(line.from, line.to), 4.999);
}

TEST(Hatch, RefusesWhatMakesNoSense) {
  const Scene scene = three_faces();
  const Surfaces surfaces(scene);
  const View view = view_with_z_up({4, 3, 6}, false);
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const auto expect_refused = [&](const HatchOptions& options) {
    EXPECT_THROW((void)hatch(surfaces, view, options), Error);
  };
  for (const double bad : {nan, 0.0, -1.0, 0.4, 1e6}) expect_refused(options_of({{0, bad, 0, 0.5}}, {0, 0, 1}));
  for (const double bad : {nan, 1.1, -2.0}) expect_refused(options_of({{0, 5, 0, bad}}, {0, 0, 1}));
  for (const double bad : {nan, 1e9}) {
    expect_refused(options_of({{bad, 5, 0, 0.5}}, {0, 0, 1}));
    expect_refused(options_of({{0, 5, bad, 0.5}}, {0, 0, 1}));
    expect_refused(options_of({{0, 5, 0, 0.5}}, {bad * 1e200, 0, 0}));
  }
  expect_refused(options_of({{0, 5, 0, 0.5}}, {0, 0, 0}));
  expect_refused(options_of(std::vector<HatchSet>(17), {0, 0, 1}));
  HatchOptions options = options_of({{}}, {0, 0, 1});
  options.shortest = nan;
  expect_refused(options);
  options.shortest = 0;
  options.tone.crease_angle = 4;
  expect_refused(options);
}

TEST(Hatch, NothingAndNonsenseGiveNoLines) {
  Mesh mesh;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  add_triangle(mesh, {nan, 0, 0}, {1, 0, 0}, {0, 1, 0});
  add_triangle(mesh, {1, 1, 1}, {1, 1, 1}, {0, 1, 0});
  const Scene bad = scene_of(std::move(mesh)), none = scene_of({});
  HatchOptions options;
  options.sets = hatch_sets(5, 0.7);
  for (const Scene* const scene : {&bad, &none}) {
    const Surfaces surfaces(*scene);
    EXPECT_TRUE(hatch(surfaces, frame(surfaces, 100, 100), options).empty());
  }
  const Scene faces = three_faces();
  const Surfaces surfaces(faces);
  EXPECT_TRUE(hatch(surfaces, frame(surfaces, 100, 100), {}).empty());
}

TEST(Hatch, StopsWhenAsked) {
  const Scene scene = scene_of(random_mesh(Kind::soup, 3000, 5));
  const Surfaces surfaces(scene);
  HatchOptions options;
  options.sets = hatch_sets(5, 0.7);
  const CountingWatch watch(6);
  EXPECT_THROW((void)hatch(surfaces, frame(surfaces, 320, 240), options, watch.execution(0)), Error);
}

}  // namespace
}  // namespace frontmost::test
