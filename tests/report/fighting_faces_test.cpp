// SPDX-License-Identifier: Apache-2.0
// Areas at risk against pictures of depth buffers, and against all pairs examined one by one.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "frontmost/precision.h"
#include "frontmost/zbuffer.h"
#include "report/fights/faces_at_risk.h"
#include "support/costly_meshes.h"
#include "support/effort.h"
#include "support/random_scene.h"
#include "support/refusal.h"

namespace frontmost::test {
namespace {

struct BufferKind {
  DepthFormat format;
  bool reversed;
};
constexpr BufferKind buffers[] = {{DepthFormat::d8, false},
                                  {DepthFormat::d16, true},
                                  {DepthFormat::d24, false},
                                  {DepthFormat::f32, false},
                                  {DepthFormat::f32, true}};

Visible drawn(const Surfaces& surfaces, const View& view, const BufferKind& kind) {
  DepthBuffer buffer(view.width, view.height, view.samples, kind.format);
  buffer.clear(kind.reversed ? 0 : 1);
  DepthDraw call;
  call.state.func = kind.reversed ? DepthFunc::greater : DepthFunc::less;
  call.state.nearer_is_greater = kind.reversed;
  buffer.draw(surfaces, view, call);
  return buffer.visible(view);
}

/// Looks up areas by pair of faces, or by one face.
class AreaLookup {
 public:
  explicit AreaLookup(const FightAreas& fights) : fights_(fights) {
    for (std::size_t i = 0; i < fights.faces.size(); ++i) {
      const FightingFaces& f = fights.faces[i];
      by_pair_[{f.first, f.second}].push_back(i);
      by_face_[f.first].push_back(i);
      if (f.second != no_primitive) by_face_[f.second].push_back(i);
    }
  }
  [[nodiscard]] bool holds(PrimitiveId a, PrimitiveId b, const glm::dvec2& point) const {
    const auto found = by_pair_.find(std::minmax(a, b));
    return found != by_pair_.end() && any_holds(found->second, point);
  }
  [[nodiscard]] bool holds(PrimitiveId face, const glm::dvec2& point) const {
    const auto found = by_face_.find(face);
    return found != by_face_.end() && any_holds(found->second, point);
  }

 private:
  [[nodiscard]] bool any_holds(const std::vector<std::size_t>& areas, const glm::dvec2& point) const {
    return std::any_of(areas.begin(), areas.end(), [&](std::size_t i) {
      const std::span<const glm::dvec2> corners = fights_.polygon(fights_.faces[i]);
      for (std::size_t k = 0; k < corners.size(); ++k) {
        const glm::dvec2 from = corners[k], to = corners[k + 1 == corners.size() ? 0 : k + 1];
        const glm::dvec2 side = to - from, off = point - from;
        if (side.x * off.y - side.y * off.x < -1e-6 * (glm::length(side) + 1e-6)) return false;
      }
      return true;
    });
  }

  const FightAreas& fights_;
  std::map<std::pair<PrimitiveId, PrimitiveId>, std::vector<std::size_t>> by_pair_;
  std::map<PrimitiveId, std::vector<std::size_t>> by_face_;
};

class FightsOfEveryKind : public testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(FightingFaces, FightsOfEveryKind, testing::ValuesIn(all_kinds));

// Areas at risk contain every sample that a depth buffer gets wrong, or right only by the order of ids.
TEST_P(FightsOfEveryKind, HoldEverySampleThatIsWrongOrTied) {
  std::uint64_t wrong = 0, tied = 0;
  for (std::uint64_t seed = 0; seed < seeds(4); ++seed) {
    Random random(seed + 70);
    const Scene scene = scene_of(random_mesh(GetParam(), 80, seed + 5));
    const Surfaces surfaces(scene);
    View view = random_view(random, 90, 70);
    view.samples = seed % 2 == 0 ? 1 : 4;
    const ExactVisible exact = find_exact_visible(surfaces, view);
    for (const BufferKind& kind : buffers) {
      const Visible answer = drawn(surfaces, view, kind);
      const DepthFights fights = find_depth_fights(surfaces, exact, answer);
      const FightAreas areas = find_fighting_faces(surfaces, view, kind.format, kind.reversed);
      const AreaLookup lookup(areas);
      wrong += fights.wrong;
      tied += fights.tied;
      for (std::size_t i = 0; i < answer.primitives.size(); ++i) {
        if (fights.errors[i] == 0 && exact.tied[i] == 0) continue;
        const std::size_t pixel = i % view.pixel_count();
        const glm::dvec2 offset = glm::dvec2(sample_offsets(view.samples)[i / view.pixel_count()]) / 256.0;
        const glm::dvec2 point = glm::dvec2(pixel % std::size_t(view.width), pixel / std::size_t(view.width)) + offset;
        if (fights.errors[i] != 0)
          ASSERT_TRUE(lookup.holds(answer.primitives[i], exact.primitives[i], point))
              << "seed " << seed << ", " << int(kind.format) << (kind.reversed ? " reversed" : "") << ": "
              << answer.primitives[i] << " for " << exact.primitives[i] << " at " << point.x << ", " << point.y;
        else
          ASSERT_TRUE(lookup.holds(exact.primitives[i], point)) << "seed " << seed << ", tied " << exact.primitives[i];
      }
    }
  }
  RecordProperty("wrong", int(wrong));
  RecordProperty("tied", int(tied));
  if (GetParam() == Kind::coplanar || GetParam() == Kind::sheets) {
    EXPECT_GT(wrong + tied, 100u);
  }
}

// The grid and the exact overlap tests miss no pair of faces.
TEST_P(FightsOfEveryKind, AreThoseOfAllPairs) {
  for (std::uint64_t seed = 0; seed < seeds(6); ++seed) {
    Random random(seed + 170);
    const Scene scene = scene_of(random_mesh(GetParam(), 60, seed + 50));
    const Surfaces surfaces(scene);
    const View view = random_view(random, 120, 90);
    const FightAreas fights = find_fighting_faces(surfaces, view, DepthFormat::d16);
    const KeyStep step(fights.setup);
    const Visible visible = zbuffer(surfaces, view);
    const std::vector<ScreenFace> faces = screen_faces(surfaces, view, step, {}, {});
    RiskFinder finder(view, fights.setup);
    double area = 0, found = 0;
    VisibleShares shares(visible, 1);
    for (std::size_t a = 0; a < faces.size(); ++a)
      for (std::size_t b = a + 1; b < faces.size(); ++b) {
        if (faces[a].record.id == faces[b].record.id) continue;
        const ConvexArea& at_risk = finder.of_pair(faces[a], faces[b]);
        if (at_risk.is_empty()) continue;
        area += at_risk.area() * shares.of(at_risk, RiskKeys(faces[a], faces[b], step));
      }
    for (const FightingFaces& fight : fights.faces) found += fight.kind == FightKind::clear ? 0 : fight.visible_area;
    EXPECT_NEAR(found, area, 1e-6 * (1 + area)) << "seed " << seed;
  }
}

/// A square of side 2 before the eye, in the plane z = -distance, with its middle at (x, y).
void add_square(Scene& scene, float distance, float x, float y) {
  Mesh mesh;
  for (const glm::vec2& c : {glm::vec2(-1, -1), glm::vec2(1, -1), glm::vec2(1, 1), glm::vec2(-1, 1)})
    mesh.positions.push_back({c.x + x, c.y + y, -distance});
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  scene.instances.push_back({"square", std::uint32_t(scene.meshes.size()), glm::dmat4(1)});
  scene.meshes.push_back(std::move(mesh));
}

/// A view whose pixels are 1/32 of a unit wide.
View flat_view() {
  View view;
  view.width = view.height = 128;
  view.projection = make_orthographic(-2, 2, -2, 2, {1, 101});
  return view;
}

TEST(FightingFaces, ShareWhatIsBeforeBoth) {
  Scene scene;
  add_square(scene, 10, 0, 0);
  add_square(scene, 10, 0.5f, 0.25f);
  const Surfaces surfaces(scene);
  const FightAreas fights = find_fighting_faces(surfaces, flat_view(), DepthFormat::d24);
  ASSERT_EQ(fights.objects.size(), 1u);
  const FightingObjects& pair = fights.objects[0];
  EXPECT_EQ(pair.first, 0u);
  EXPECT_EQ(pair.second, 1u);
  EXPECT_EQ(pair.kind, FightKind::one_plane);
  EXPECT_NEAR(pair.area, 48 * 56, 1e-9);
  EXPECT_NEAR(pair.visible_area, 48 * 56, 1e-9);
  EXPECT_NEAR(pair.distance, 10, 1e-5);
  EXPECT_NEAR(pair.gap, 100 / 16777215.0, 1e-9);
}

TEST(FightingFaces, OfThreeInOnePlaceAreCountedOnce) {
  Scene scene;
  for (int i = 0; i < 3; ++i) add_square(scene, 10, 0, 0);
  // All three squares form one object.
  Scene joined = scene;
  for (int i = 1; i < 3; ++i) {
    const auto first = std::uint32_t(joined.meshes[0].positions.size());
    for (const glm::vec3& p : scene.meshes[0].positions) joined.meshes[0].positions.push_back(p);
    for (const glm::uvec3& t : scene.meshes[0].triangles) joined.meshes[0].triangles.push_back(t + first);
  }
  joined.instances.resize(1);
  joined.meshes.resize(1);
  const Surfaces surfaces(joined);
  const FightAreas fights = find_fighting_faces(surfaces, flat_view(), DepthFormat::d16);
  ASSERT_EQ(fights.objects.size(), 1u);
  EXPECT_NEAR(fights.objects[0].area, 64 * 64, 1e-8);
  EXPECT_EQ(fights.objects[0].areas, 6u);
}

TEST(FightingFaces, AreLeftOutBehindWhatHidesThem) {
  Scene scene;
  add_square(scene, 20, 0, 0);
  add_square(scene, 20, 0, 0);
  add_square(scene, 10, 1, 0);
  const Surfaces half(scene);
  const FightAreas fights = find_fighting_faces(half, flat_view(), DepthFormat::d24);
  ASSERT_EQ(fights.objects.size(), 1u);
  EXPECT_NEAR(fights.objects[0].area, 64 * 64, 1e-8);
  EXPECT_NEAR(fights.objects[0].visible_area, 32 * 64, 64);
  add_square(scene, 9, -1, 0);
  const Surfaces whole(scene);
  EXPECT_TRUE(find_fighting_faces(whole, flat_view(), DepthFormat::d24).objects.empty());
}

TEST(FightingFaces, EndWhereTheGapIsResolved) {
  const View view = flat_view();
  for (const DepthFormat format : {DepthFormat::d8, DepthFormat::d16, DepthFormat::d24}) {
    const DepthSetup setup{view.projection.clip, format, false, true};
    Scene apart, close;
    add_square(apart, 20, 0, 0);
    add_square(apart, 20 + float(1.01 * certain_gap(setup, 20)), 0, 0);
    add_square(close, 20, 0, 0);
    add_square(close, 20 + float(0.9 * resolvable_gap(setup, 20)), 0, 0);
    const Surfaces far_surfaces(apart), close_surfaces(close);
    const FightAreas none = find_fighting_faces(far_surfaces, view, format);
    EXPECT_TRUE(none.objects.empty()) << int(format);
    const FightAreas some = find_fighting_faces(close_surfaces, view, format);
    ASSERT_EQ(some.objects.size(), 1u) << int(format);
    EXPECT_EQ(some.objects[0].kind, FightKind::close);
    EXPECT_NEAR(some.objects[0].area, 64 * 64, 1e-8);
  }
}

TEST(FightingFaces, AtAFoldStandApartAndLast) {
  Scene scene;
  add_square(scene, 20, -1, 0);
  add_square(scene, 20, -1, 0);
  Mesh fold;
  fold.positions = {{0, 0, -10}, {1.5f, 0.5f, -40}, {1.5f, -0.5f, -40}, {1.5f, 0, -60}};
  fold.triangles = {{0, 1, 2}, {0, 3, 1}};
  scene.instances.push_back({"fold", 2, glm::dmat4(1)});
  scene.meshes.push_back(fold);
  const Surfaces surfaces(scene);
  const FightAreas fights = find_fighting_faces(surfaces, flat_view(), DepthFormat::d8);
  ASSERT_EQ(fights.objects.size(), 2u);
  EXPECT_EQ(fights.objects[0].kind, FightKind::one_plane);
  EXPECT_EQ(fights.objects[1].kind, FightKind::fold);
  EXPECT_EQ(fights.objects[1].first, 2u);
  EXPECT_EQ(fights.objects[1].second, 2u);
}

TEST(FightingFaces, WithTheClearValueAreNotSeen) {
  Scene scene;
  add_square(scene, 100.9f, 0, 0);
  const Surfaces surfaces(scene);
  const FightAreas fights = find_fighting_faces(surfaces, flat_view(), DepthFormat::d8);
  ASSERT_EQ(fights.objects.size(), 1u);
  EXPECT_EQ(fights.objects[0].kind, FightKind::clear);
  EXPECT_EQ(fights.objects[0].second, no_index);
  EXPECT_TRUE(find_fighting_faces(surfaces, flat_view(), DepthFormat::d16).objects.empty());
}

TEST(FightingFaces, EndWithTheRemediesThatAreGiven) {
  // Two squares 1 unit apart at 60, in a buffer whose near plane lies at the eye: 16 bits do not tell them apart.
  Scene scene;
  add_square(scene, 61, 0, 0);
  add_square(scene, 60, 0, 0);
  const Surfaces surfaces(scene);
  View view;
  view.width = view.height = 64;
  view.projection = make_projection(0.05, 1, {0.01, 1000});
  const ExactVisible exact = find_exact_visible(surfaces, view);
  const DepthSetup setup{view.projection.clip, DepthFormat::d16};
  const std::vector<FightRemedy> remedies = try_remedies(surfaces, exact, setup);
  ASSERT_EQ(remedies.size(), 4u) << "the planes alone, 24 bits, reversed floats, these with the planes";
  for (const FightRemedy& remedy : remedies) EXPECT_EQ(remedy.wrong, 0u);
  EXPECT_EQ(remedies[1].setup.format, DepthFormat::d24);
  EXPECT_TRUE(remedies[2].setup.reversed && remedies[2].setup.format == DepthFormat::f32);
  EXPECT_EQ(remedies[0].setup.format, DepthFormat::d16);
  EXPECT_NEAR(remedies[0].setup.clip.near, 59.94, 1e-3);
  EXPECT_NEAR(remedies[0].setup.clip.far, 61.061, 1e-3);

  const FightAreas fights = find_fighting_faces(surfaces, view, DepthFormat::d16);
  ASSERT_EQ(fights.objects.size(), 1u);
  const std::optional<OffsetRemedy> offset = find_offset(surfaces, exact, fights, fights.objects[0]);
  ASSERT_TRUE(offset);
  EXPECT_EQ(offset->instance, 1u);
  EXPECT_EQ(offset->offset.units, -1);
}

TEST(FightingFaces, ThatLieBehindComeForwardByAnOffset) {
  // The second square lies half a step of the format behind the first.
  Scene scene;
  add_square(scene, 20, 0, 0);
  const View view = flat_view();
  const DepthSetup setup{view.projection.clip, DepthFormat::d16, false, true};
  const float gap = float(resolvable_gap(setup, 20));
  add_square(scene, 20 + 0.5f * gap, 0, 0);
  const Surfaces surfaces(scene);
  const ExactVisible exact = find_exact_visible(surfaces, view);
  const FightAreas fights = find_fighting_faces(surfaces, view, DepthFormat::d16);
  ASSERT_EQ(fights.objects.size(), 1u);
  const std::optional<OffsetRemedy> offset = find_offset(surfaces, exact, fights, fights.objects[0]);
  ASSERT_TRUE(offset);
  EXPECT_LE(offset->offset.units, -1);
  EXPECT_GE(offset->offset.units, -2);
}

TEST(FightingFaces, WithThemselvesHaveNoOffset) {
  Scene scene;
  add_square(scene, 10, 0, 0);
  scene.meshes[0].triangles.push_back({0, 1, 2});
  const Surfaces surfaces(scene);
  const ExactVisible exact = find_exact_visible(surfaces, flat_view());
  const FightAreas fights = find_fighting_faces(surfaces, flat_view(), DepthFormat::d24);
  ASSERT_EQ(fights.objects.size(), 1u);
  EXPECT_FALSE(find_offset(surfaces, exact, fights, fights.objects[0]));
  EXPECT_TRUE(try_remedies(surfaces, exact, fights.setup).empty());
}

TEST(FightingFaces, AreTheSameForAnyNumberOfThreads) {
  const Scene scene = scene_of(random_mesh(Kind::sheets, 300, 9));
  const Surfaces surfaces(scene);
  Random random(3);
  const View view = random_view(random, 200, 150);
  const auto areas = [&](int threads) {
    const FightAreas fights = find_fighting_faces(surfaces, view, DepthFormat::d16, false, {.threads = threads});
    std::vector<double> numbers;
    for (const FightingFaces& f : fights.faces)
      numbers.insert(numbers.end(), {double(f.first), double(f.second), f.area, f.visible_area, f.distance});
    for (const FightingObjects& pair : fights.objects) numbers.insert(numbers.end(), {pair.area, pair.visible_area});
    return numbers;
  };
  const std::vector<double> once = areas(1);
  EXPECT_GT(once.size(), 20u);
  EXPECT_EQ(areas(5), once);
}

TEST(FightingFaces, OfThousandsInOnePlaceAreRefused) {
  Scene scene;
  add_square(scene, 10, 0, 0);
  for (int i = 0; i < 5000; ++i) scene.instances.push_back(scene.instances[0]);
  const Surfaces surfaces(scene);
  EXPECT_THROW((void)find_fighting_faces(surfaces, flat_view(), DepthFormat::d24), Error);
}

TEST(TooMuch, PairsBehindAShieldAsLargeAsTheyAre) {
  Mesh mesh = turned_triangles(400);
  for (int i = 0; i < 400; ++i) {  // a disc in front, which hides all but the corners of their rectangles
    const auto rim = [&](int k) {
      const double turn = 6.283185307179586 * k / 400;
      return glm::vec3(1.01 * std::cos(turn), 1.01 * std::sin(turn), 0.5);
    };
    add_triangle(mesh, glm::vec3(0, 0, 0.5f), rim(i), rim(i + 1));
  }
  const Scene scene = scene_of(mesh);
  const Surfaces surfaces(scene);
  View view;
  view.width = view.height = 400;
  view.world_from_eye = look_at({0, 0, 5}, {0, 0, 0}, {0, 1, 0});
  view.projection = make_orthographic(-1.2, 1.2, -1.2, 1.2, {1, 10});
  EXPECT_EQ(refusal_of(ErrorCode::limit_exceeded, [&] { (void)find_fighting_faces(surfaces, view, DepthFormat::d24); }),
            "fighting faces: too many pairs of faces lie over each other: most faces, 800, are in the pixels from 0,0 "
            "to 256,256; leave out faces that lie there many times");
}

}  // namespace
}  // namespace frontmost::test
