// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "frontmost/files.h"
#include "frontmost/report.h"
#include "frontmost/zbuffer.h"
#include "occlusion/hidden_scene.h"
#include "report/accounting_reference.h"
#include "support/cutout_scene.h"
#include "support/effort.h"
#include "support/models.h"
#include "support/refusal.h"

namespace frontmost {
namespace {

using test::Random;

/// A view of ten by ten units from above, one unit a pixel.
View square_view(int size = 10) {
  View view;
  view.width = view.height = size;
  view.world_from_eye = look_at({0, 0, 10}, {0, 0, 0}, {0, 1, 0});
  view.projection = make_orthographic(-size / 2.0, size / 2.0, -size / 2.0, size / 2.0, {1, 20});
  return view;
}

/// Compares every field but is_cut_by_near, which the reference lacks.
void expect_same(const Accounting& a, const Accounting& b) {
  EXPECT_EQ(a.canvas, b.canvas);
  EXPECT_EQ(a.background, b.background);
  EXPECT_EQ(a.hidden_by_front, b.hidden_by_front);
  ASSERT_EQ(a.objects.size(), b.objects.size());
  for (std::size_t i = 0; i < a.objects.size(); ++i) {
    EXPECT_EQ(a.objects[i].alone, b.objects[i].alone) << i;
    EXPECT_EQ(a.objects[i].in_frame, b.objects[i].in_frame) << i;
    EXPECT_EQ(a.objects[i].visible, b.objects[i].visible) << i;
    EXPECT_EQ(a.objects[i].distance, b.objects[i].distance) << i;
    EXPECT_NEAR(a.objects[i].centroid.x, b.objects[i].centroid.x, 1e-9) << i;
    EXPECT_NEAR(a.objects[i].centroid.y, b.objects[i].centroid.y, 1e-9) << i;
  }
}

/// Checks that the accounts of one picture add up.
void expect_sums(const Accounting& accounts, const View& view) {
  std::uint64_t seen = accounts.background;
  std::vector<std::uint64_t> hidden(accounts.objects.size(), 0);
  for (const HiddenSamples& pair : accounts.hidden_by_front) hidden[pair.object] += pair.count;
  for (std::size_t i = 0; i < accounts.objects.size(); ++i) {
    const ObjectAccount& object = accounts.objects[i];
    seen += object.visible.count;
    EXPECT_EQ(object.visible.count + hidden[i], object.in_frame.count) << i;
    EXPECT_GE(object.alone.count, object.in_frame.count) << i;
    if (object.alone.count == 0) continue;
    EXPECT_NEAR(object.visible_share() + object.hidden_share() + object.cut_share(), 1, 1e-12);
  }
  EXPECT_EQ(seen, view.sample_count());
}

TEST(Accounting, CountsSquaresThatCanBeCountedByHand) {
  Scene scene;
  test::place_square(scene, "far", 3, {0, 0, 0});    // 6 x 6 pixels from (2, 2)
  test::place_square(scene, "near", 2, {4, 2, 1});   // 4 x 4 pixels from (7, 1); one column is beyond the frame
  test::place_square(scene, "away", 1, {20, 0, 0});  // beyond the canvas as well
  const Surfaces surfaces(scene);
  const Accounting accounts = account(surfaces, zbuffer(surfaces, square_view()));
  EXPECT_EQ(accounts.canvas, (PixelBox{-10, -10, 30, 30}));
  const ObjectAccount& far = accounts.objects[0];
  EXPECT_EQ(far.alone, (SampleSet{36, {2, 2, 6, 6}}));
  EXPECT_EQ(far.in_frame, far.alone);
  EXPECT_EQ(far.visible, (SampleSet{33, {2, 2, 6, 6}}));
  EXPECT_DOUBLE_EQ(far.hidden_share(), 3 / 36.0);
  EXPECT_EQ(far.distance, 10);
  const ObjectAccount& near = accounts.objects[1];
  EXPECT_EQ(near.alone, (SampleSet{16, {7, 1, 4, 4}}));
  EXPECT_EQ(near.in_frame, (SampleSet{12, {7, 1, 3, 4}}));
  EXPECT_EQ(near.visible, near.in_frame);
  EXPECT_DOUBLE_EQ(near.cut_share(), 0.25);
  EXPECT_EQ(near.distance, 9);
  EXPECT_EQ(near.centroid, glm::dvec2(8.5, 3));
  EXPECT_EQ(accounts.objects[2].alone, SampleSet{});
  EXPECT_EQ(accounts.objects[2].visible_share(), 0);
  EXPECT_EQ(accounts.hidden_by_front, (std::vector<HiddenSamples>{{0, 1, 3}}));
  EXPECT_EQ(accounts.background, 100u - 33 - 12);
}

TEST(Accounting, EqualsTheReferenceOnRandomScenes) {
  for (std::uint64_t seed = 0; seed < test::seeds(60); ++seed) {
    Random random(seed);
    const Scene scene = test::hidden_scene(3 + random.below(20), seed);
    View view = test::random_view(20 + random.below(180), 20 + random.below(120), seed);
    view.culling = Culling(random.below(4));
    view.samples = seed % 5 == 4 ? 4 : 1;
    const Surfaces surfaces(scene);
    const Visible visible = zbuffer(surfaces, view);
    const Accounting accounts = account(surfaces, visible, {.canvas = 1});
    SCOPED_TRACE(seed);
    expect_same(accounts, test::reference_account(scene, visible, {0, 0}));
    expect_sums(accounts, view);
  }
}

TEST(Accounting, EqualsTheReferenceForEveryKindOfTriangles) {
  for (const test::Kind kind : test::all_kinds)
    for (std::uint64_t seed = 0; seed < test::seeds(6); ++seed) {
      test::RandomCase made = test::random_case(kind, seed);
      // The mesh has two more instances, one mirrored and one flattened.
      made.scene.instances.push_back({"mirrored", 0, glm::dmat4(1.0)});
      made.scene.instances.back().world_from_mesh[0][0] = -0.7;
      made.scene.instances.push_back({"flat", 0, glm::dmat4(1.0)});
      made.scene.instances.back().world_from_mesh[2] = glm::dvec4(0.1, 0.2, 0, 0);
      const Surfaces surfaces(made.scene);
      const Visible visible = zbuffer(surfaces, made.view);
      SCOPED_TRACE(seed);
      expect_same(account(surfaces, visible, {.canvas = 1}), test::reference_account(made.scene, visible, {0, 0}));
    }
}

TEST(Accounting, VerticesMayStandInAnyOrder) {
  // Neighbours' vertices are far apart in the list. The mesh is placed unchanged, mirrored and flat.
  constexpr int kTriangles = 6'000;
  test::RandomCase made{test::scene_of(test::random_mesh(test::Kind::soup, kTriangles, 5)), {}};
  Random random(6);
  made.view = test::random_view(random, 90, 70);
  made.scene.instances.push_back({"mirrored", 0, glm::dmat4(1.0)});
  made.scene.instances.back().world_from_mesh[0][0] = -0.7;
  made.scene.instances.push_back({"flat", 0, glm::dmat4(1.0)});
  made.scene.instances.back().world_from_mesh[2] = glm::dvec4(0.1, 0.2, 0, 0);
  Scene strewn = made.scene;
  Mesh& mesh = strewn.meshes[0];
  const std::size_t count = mesh.positions.size();
  constexpr std::size_t kStep = 7'919;  // a prime, so that all numbers occur
  ASSERT_NE(count % kStep, 0u);
  for (std::size_t i = 0; i < count; ++i) mesh.positions[i * kStep % count] = made.scene.meshes[0].positions[i];
  for (glm::uvec3& corners : mesh.triangles)
    for (int k = 0; k < 3; ++k) corners[k] = std::uint32_t(corners[k] * kStep % count);
  const Surfaces surfaces(made.scene), strewn_surfaces(strewn);
  const Visible visible = zbuffer(surfaces, made.view);
  for (const double canvas : {1.0, 3.0}) {
    const Accounting expected = account(surfaces, visible, {.canvas = canvas});
    const Accounting found = account(strewn_surfaces, zbuffer(strewn_surfaces, made.view), {.canvas = canvas});
    expect_same(found, expected);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_GT(found.objects[i].alone.count, 100u);
      EXPECT_EQ(found.objects[i].is_cut_by_near, expected.objects[i].is_cut_by_near);
    }
  }
  const std::vector<Explanation> expected = explain_all(surfaces, visible, account(surfaces, visible)),
                                 found = explain_all(strewn_surfaces, visible, account(strewn_surfaces, visible));
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(found[i].triangles, expected[i].triangles);
}

TEST(Accounting, HolesOfMasksAreSeenThrough) {
  std::uint64_t with_holes = 0;
  for (std::uint64_t seed = 0; seed < test::seeds(12); ++seed) {
    Scene scene = test::cutout_scene(test::random_mesh(test::Kind::soup, 30, seed), test::Cut(seed % 2), 0.5f, seed);
    Random random(seed);
    for (int i = 0; i < 5; ++i) scene.instances.push_back({"", 0, test::random_placement(random, 0.5f, 1)});
    View view = test::random_view(random, 90, 70);
    view.samples = seed % 3 == 2 ? 4 : 1;
    const Surfaces surfaces(scene);
    const Visible visible = zbuffer(surfaces, view);
    const Accounting accounts = account(surfaces, visible, {.canvas = 1});
    SCOPED_TRACE(seed);
    expect_same(accounts, test::reference_account(scene, visible, {0, 0}));
    expect_sums(accounts, view);
    Scene solid = scene;
    solid.materials[1].alpha = Material::Alpha::opaque;
    const Surfaces filled(solid);
    const Accounting other = account(filled, zbuffer(filled, view), {.canvas = 1});
    for (std::size_t i = 0; i < accounts.objects.size(); ++i)
      with_holes += accounts.objects[i].in_frame.count < other.objects[i].in_frame.count;
  }
  EXPECT_GT(with_holes, test::seeds(12)) << "the scenes have no holes that matter";
}

// On a canvas, the reference is another camera. Its numbers round as the picture's do if all of them are dyadic.
TEST(Accounting, BeyondTheFrameEqualsThePictureOfTheCanvas) {
  std::uint64_t cut = 0;
  for (std::uint64_t seed = 0; seed < test::seeds(20); ++seed) {
    Random random(seed);
    const Scene scene = test::hidden_scene(12, seed);
    View view = test::random_view(64, 32, seed);
    view.projection = seed % 4 == 0 ? make_orthographic(-2, 2, -0.5, 1.5, {0.25, 32})
                                    : make_frustum(-0.125, 0.125, -0.0625, 0.0625, {0.25, 32});
    const Surfaces surfaces(scene);
    const Visible visible = zbuffer(surfaces, view);
    for (const double scale : {2.0, 3.0, 5.0}) {
      const glm::ivec2 margin(int(32 * (scale - 1)), int(16 * (scale - 1)));
      const Accounting accounts = account(surfaces, visible, {.canvas = scale});
      SCOPED_TRACE(seed);
      expect_same(accounts, test::reference_account(scene, visible, margin));
      for (const ObjectAccount& object : accounts.objects) cut += object.cut_share() > 0 && object.cut_share() < 1;
    }
  }
  EXPECT_GT(cut, 3 * test::seeds(20)) << "few objects cross the frame";
}

TEST(Accounting, IsTheSameForThreadsAndInstructionSets) {
  const Scene scene = test::hidden_scene(150, 4);
  const View view = test::random_view(333, 221, 7);
  const Surfaces surfaces(scene);
  const Visible visible = zbuffer(surfaces, view);
  const Accounting expected = account(surfaces, visible, {}, {.threads = 1, .isa = Isa::scalar});
  for (const Isa isa : available_isas())
    for (const int threads : {1, 4}) {
      const Accounting accounts = account(surfaces, visible, {}, {.threads = threads, .isa = isa});
      expect_same(accounts, expected);
      for (std::size_t i = 0; i < accounts.objects.size(); ++i)
        EXPECT_EQ(accounts.objects[i].is_cut_by_near, expected.objects[i].is_cut_by_near);
    }
}

TEST(Accounting, TellsWhatTheNearPlaneCuts) {
  Scene scene;
  test::place_square(scene, "whole", 1, {0, 0, 0});
  test::place_square(scene, "cut", 1, {0, 0, 9});  // one edge at 8, the other at 10, where the eye is
  scene.instances.back().world_from_mesh[0] = glm::dvec4(0, 0, 1, 0);
  test::place_square(scene, "behind", 1, {0, 0, 12});
  const Surfaces surfaces(scene);
  View view = square_view();
  view.projection = make_projection(1.0, 1.0, {1, 20});
  const Accounting accounts = account(surfaces, zbuffer(surfaces, view));
  EXPECT_FALSE(accounts.objects[0].is_cut_by_near);
  EXPECT_TRUE(accounts.objects[1].is_cut_by_near);
  EXPECT_FALSE(accounts.objects[2].is_cut_by_near);
}

TEST(Accounting, LargePicturesHaveTheCanvasThatFits) {
  Scene scene;
  test::place_square(scene, "square", 3, {0, 0, 0});
  const Surfaces surfaces(scene);
  View view = square_view();
  view.width = 8000;
  const Accounting accounts = account(surfaces, zbuffer(surfaces, view));
  EXPECT_EQ(accounts.canvas, (PixelBox{-4192, -10, 16384, 30}));
  EXPECT_EQ(accounts.objects[0].alone.count, 4800u * 6);
}

TEST(Accounting, AnEmptySceneIsAllBackground) {
  const Scene scene;
  const Surfaces surfaces(scene);
  const Accounting accounts = account(surfaces, zbuffer(surfaces, square_view()));
  EXPECT_TRUE(accounts.objects.empty());
  EXPECT_EQ(accounts.background, 100u);
}

TEST(Accounting, RefusesWhatIsOutOfRange) {
  Scene scene;
  test::place_square(scene, "square", 3, {0, 0, 0});
  const Surfaces surfaces(scene);
  const Visible visible = zbuffer(surfaces, square_view());
  for (const double canvas : {0.99, 16.1, -1.0, std::nan("")})
    EXPECT_EQ(test::refusal_of(ErrorCode::bad_argument, [&] { (void)account(surfaces, visible, {.canvas = canvas}); }),
              "canvas: must be 1 to 16");
  const Scene none;
  EXPECT_EQ(test::code_of([&] { (void)account(Surfaces(none), visible); }), ErrorCode::bad_argument);
}

TEST(Accounting, AllHidersEqualObjectsAloneAndScenesWithoutThem) {
  std::size_t any = 0, only = 0;
  for (std::uint64_t seed = 0; seed < test::seeds(40); ++seed) {
    Random random(seed);
    const Scene scene =
        seed % 3 == 2 ? test::cutout_scene(test::random_mesh(test::Kind::soup, 30, seed), test::Cut(1), 0.5f, seed)
                      : test::hidden_scene(3 + random.below(14), seed);
    View view = test::random_view(20 + random.below(180), 20 + random.below(120), seed);
    view.culling = Culling(random.below(4));
    view.samples = seed % 5 == 4 ? 4 : 1;
    Scene placed = scene;
    for (int i = 0; seed % 3 == 2 && i < 5; ++i)
      placed.instances.push_back({"", 0, test::random_placement(random, 0.5f, 1)});
    const Surfaces surfaces(placed);
    const Visible visible = zbuffer(surfaces, view);
    const Accounting accounts = account(surfaces, visible, {.canvas = 1, .all_hiders = true});
    EXPECT_EQ(accounts.hidden_by_any, test::reference_hidden_by_any(placed, view)) << seed;
    EXPECT_EQ(accounts.hidden_only_by, test::reference_hidden_only_by(placed, visible)) << seed;
    any += accounts.hidden_by_any.size(), only += accounts.hidden_only_by.size();
  }
  EXPECT_GT(only, 2 * test::seeds(40));
  EXPECT_GE(any, only + test::seeds(40) / 8);
}

TEST(Accounting, AllHidersAreTheSameForThreadsAndInstructionSets) {
  const Scene scene = test::hidden_scene(150, 4);
  const View view = test::random_view(333, 221, 7);
  const Surfaces surfaces(scene);
  const Visible visible = zbuffer(surfaces, view);
  const AccountingOptions options{.canvas = 1, .all_hiders = true};
  const Accounting expected = account(surfaces, visible, options, {.threads = 1, .isa = Isa::scalar});
  for (const Isa isa : available_isas())
    for (const int threads : {1, 4}) {
      const Accounting accounts = account(surfaces, visible, options, {.threads = threads, .isa = isa});
      EXPECT_EQ(accounts.hidden_by_any, expected.hidden_by_any);
      EXPECT_EQ(accounts.hidden_only_by, expected.hidden_only_by);
    }
}

TEST(Accounting, OneBehindAnotherIsHiddenByBothAndByNoneAlone) {
  Scene scene;
  for (int i = 0; i < 3; ++i) test::place_square(scene, "square", 3, {0, 0, i});  // the last one is the nearest
  test::place_square(scene, "strip", 1, {0, 4, 3});                               // in front of the upper row only
  const Surfaces surfaces(scene);
  const Accounting accounts = account(surfaces, zbuffer(surfaces, square_view()), {.all_hiders = true});
  EXPECT_EQ(accounts.hidden_by_front, (std::vector<HiddenSamples>{{0, 2, 36}, {1, 2, 36}}));
  EXPECT_EQ(accounts.hidden_by_any, (std::vector<HiddenSamples>{{0, 1, 36}, {0, 2, 36}, {1, 2, 36}}));
  EXPECT_EQ(accounts.hidden_only_by, (std::vector<HiddenSamples>{{1, 2, 36}}));
}

TEST(PixelMasks, RunLengthsAreThoseOfCoco) {
  // A mask of 3 x 4 pixels, columns from the left: 0 1 1 0, 1 1 0 0, 0 0 0 1.
  PixelMask mask;
  mask.box = {0, 0, 3, 4};
  mask.pixels = Buffer<MaskPixel>(12, MaskPixel::outside);
  for (const auto& [x, y] : {std::pair(0, 1), {0, 2}, {1, 0}, {1, 1}, {2, 3}})
    mask.pixels[std::size_t(y * 3 + x)] = MaskPixel::visible;
  EXPECT_EQ(coco_runs(mask, MaskPart::visible, {3, 4}), "12104O");  // 1 2 1 2 5 1
  mask.pixels[1] = MaskPixel::hidden;
  EXPECT_EQ(coco_runs(mask, MaskPart::visible, {3, 4}), "122O30");
  EXPECT_EQ(coco_runs(mask, MaskPart::whole, {3, 4}), "12104O");
  EXPECT_EQ(coco_runs({}, MaskPart::whole, {3, 4}), "<");
}

/// Pixels whose centres lie inside by the even-odd rule.
std::vector<int> filled(const std::vector<std::vector<int>>& polygons, int width, int height) {
  std::vector<int> counts(std::size_t(width * height), 0);
  for (const std::vector<int>& p : polygons)
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        bool is_within = false;
        for (std::size_t i = 0, k = p.size() - 2; i < p.size(); k = i, i += 2)
          is_within ^= (p[i + 1] > y) != (p[k + 1] > y) && p[i] > x;
        counts[std::size_t(y * width + x)] += is_within;
      }
  return counts;
}

TEST(PixelMasks, PolygonsFillThemOnce) {
  for (std::uint64_t seed = 0; seed < test::seeds(100); ++seed) {
    Random random(seed);
    PixelMask mask;
    mask.box = {2, 1, 3 + int(random.below(12)), 2 + int(random.below(12))};
    const auto size = std::size_t(mask.box.width * mask.box.height);
    mask.pixels = Buffer<MaskPixel>(size, MaskPixel::outside);
    for (MaskPixel& pixel : mask.pixels) pixel = random.below(3) > 0 ? MaskPixel::visible : MaskPixel::hidden;
    const int width = mask.box.x + mask.box.width + 1, height = mask.box.y + mask.box.height + 1;
    const std::vector<std::vector<int>> polygons = coco_polygons(mask, MaskPart::visible);
    const std::vector<int> counts = filled(polygons, width, height);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        ASSERT_EQ(counts[std::size_t(y * width + x)], mask.at(x, y) == MaskPixel::visible) << seed;
    EXPECT_EQ(coco_polygons(mask, MaskPart::whole).size(), 1u);
    EXPECT_EQ(coco_polygons(mask, MaskPart::whole)[0].size(), 8u);
  }
}

TEST(PixelMasks, EqualThePictureOfTheObjectAlone) {
  std::uint64_t hidden = 0;
  for (std::uint64_t seed = 0; seed < test::seeds(20); ++seed) {
    const Scene scene = test::hidden_scene(12, seed);
    View view = test::random_view(64, 32, seed);
    view.samples = seed % 4 == 3 ? 4 : 1;
    const Surfaces surfaces(scene);
    const Visible visible = zbuffer(surfaces, view);
    PixelMasks masks(surfaces, visible);
    for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
      const PixelMask mask = masks.of(i);
      const Visible alone = test::draw_alone(scene, i, view);
      test::SampleCounter covered;
      for (int y = 0; y < view.height; ++y)
        for (int x = 0; x < view.width; ++x) {
          const std::size_t at = visible.index(x, y);
          MaskPixel expected = MaskPixel::outside;
          if (alone.primitives[at] != no_primitive) {
            covered.add(x, y, {0, 0});
            expected = surfaces.source(visible.primitives[at]).instance == i ? MaskPixel::visible : MaskPixel::hidden;
          }
          ASSERT_EQ(mask.at(x, y), expected) << seed << ": " << i << " at " << x << ", " << y;
          hidden += expected == MaskPixel::hidden;
        }
      EXPECT_EQ(mask.box, covered.set().box);
    }
  }
  EXPECT_GT(hidden, 50 * test::seeds(20));
}

TEST(HidingOrder, RanksWhatHasAnOrderAndListsWhatHasNone) {
  // 0 hides 1; 1, 2 and 3 hide each other in a ring; 3 hides 4; nothing is known about 5.
  const std::vector<HiddenSamples> pairs = {{1, 0, 5}, {2, 1, 5}, {3, 2, 5}, {1, 3, 5}, {4, 3, 5}};
  const HidingOrder order = find_hiding_order(6, pairs);
  EXPECT_EQ(order.ranks, (std::vector<std::uint32_t>{0, 1, 1, 1, 2, 0}));
  EXPECT_EQ(order.cycles, (std::vector<std::vector<std::uint32_t>>{{1, 2, 3}}));
  EXPECT_TRUE(find_hiding_order(0, {}).ranks.empty());
  for (const HiddenSamples& wrong : {HiddenSamples{6, 0, 1}, HiddenSamples{0, 6, 1}, HiddenSamples{2, 2, 1}})
    EXPECT_EQ(test::code_of([&] { (void)find_hiding_order(6, std::span(&wrong, 1)); }), ErrorCode::bad_argument);
}

TEST(HidingOrder, EqualsWhatReachesWhat) {
  for (std::uint64_t seed = 0; seed < test::seeds(200); ++seed) {
    Random random(seed);
    const std::uint32_t count = 2 + random.below(12);
    std::vector<std::vector<bool>> reaches(count, std::vector<bool>(count, false));
    std::vector<HiddenSamples> pairs;
    for (std::uint32_t k = random.below(2 * count); k > 0; --k) {
      const std::uint32_t object = random.below(count), hider = random.below(count);
      if (object == hider) continue;
      pairs.push_back({object, hider, 1});
      reaches[hider][object] = true;
    }
    for (std::uint32_t k = 0; k < count; ++k)
      for (std::uint32_t i = 0; i < count; ++i)
        for (std::uint32_t j = 0; j < count; ++j)
          if (reaches[i][k] && reaches[k][j]) reaches[i][j] = true;
    const HidingOrder order = find_hiding_order(count, pairs);
    SCOPED_TRACE(seed);
    std::vector<std::vector<std::uint32_t>> cycles;
    for (std::uint32_t i = 0; i < count; ++i) {
      if (!reaches[i][i]) continue;
      std::vector<std::uint32_t> cycle;
      for (std::uint32_t j = 0; j < count; ++j)
        if (reaches[i][j] && reaches[j][i]) cycle.push_back(j);
      if (cycle[0] == i) cycles.push_back(cycle);
    }
    EXPECT_EQ(order.cycles, cycles);
    for (std::uint32_t i = 0; i < count; ++i) {
      // The rank is one more than the greatest among the objects outside that hide any member of its cycle.
      std::uint32_t rank = 0;
      for (std::uint32_t j = 0; j < count; ++j)
        if (reaches[j][i] && !reaches[i][j]) rank = std::max(rank, order.ranks[j] + 1);
      EXPECT_EQ(order.ranks[i], rank) << i;
    }
  }
}

TEST(HidingOrder, ThreeObjectsInARingHideEachOther) {
  // Three planks; each lies above the next at one end and below the previous one at the other.
  Scene scene;
  for (int k = 0; k < 3; ++k) {
    const double angle = glm::radians(120.0 * k);
    const glm::dvec2 along(std::cos(angle), std::sin(angle)), across(-along.y, along.x);
    const glm::dvec2 middle = -12.0 * across;
    Mesh mesh;
    for (const glm::dvec2& end : {glm::dvec2(-32, -4), {32, -4}, {32, 4}, {-32, 4}}) {
      const glm::dvec2 at = middle + end.x * along + end.y * across;
      mesh.positions.push_back(glm::vec3(at.x, at.y, end.x / 32));
    }
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    scene.instances.push_back({"plank", std::uint32_t(k), glm::dmat4(1.0)});
    scene.meshes.push_back(std::move(mesh));
  }
  const Surfaces surfaces(scene);
  const Accounting accounts = account(surfaces, zbuffer(surfaces, square_view(100)));
  ASSERT_EQ(accounts.hidden_by_front.size(), 3u);
  const HidingOrder order = find_hiding_order(3, accounts.hidden_by_front);
  EXPECT_EQ(order.cycles, (std::vector<std::vector<std::uint32_t>>{{0, 1, 2}}));
  EXPECT_EQ(order.ranks, (std::vector<std::uint32_t>{0, 0, 0}));
}

TEST(Accounting, CountsTheObjectsOfModels) {
  FRONTMOST_NEEDS_MODELS();
  for (const char* file : {"scenes/warehouse.glb", "scenes/home-theater.glb", "cad/cycloidal-drive.ply"}) {
    Scene scene = load(test::model(file));
    const Surfaces surfaces(scene);
    const View view = frame(surfaces, 160, 120);
    const Visible visible = zbuffer(surfaces, view);
    const Accounting accounts = account(surfaces, visible, {.canvas = 1});
    SCOPED_TRACE(file);
    expect_sums(accounts, view);
    // Each object needs a scene of its own, so of large scenes only some objects are tested.
    const std::size_t step = 1 + scene.instances.size() / 20;
    for (std::size_t i = 0; i < scene.instances.size(); i += step) {
      const Visible alone = test::draw_alone(scene, std::uint32_t(i), view);
      std::uint64_t count = 0;
      for (const PrimitiveId id : alone.primitives) count += id != no_primitive;
      EXPECT_EQ(accounts.objects[i].in_frame.count, count) << i;
    }
  }
}

}  // namespace
}  // namespace frontmost
