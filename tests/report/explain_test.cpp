// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

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

/// A view from the origin along -z, 60 degrees wide and high.
View level_view() {
  View view;
  view.width = view.height = 100;
  view.projection = make_projection(1.0471975511965976, 1.0, {0.5, 100});
  return view;
}

View parallel_view() {
  View view = level_view();
  view.projection = make_orthographic(-5, 5, -5, 5, {0.5, 100});
  return view;
}

Scene panel_at(const glm::dvec3& at, float half = 1) {
  Scene scene;
  test::place_square(scene, "panel", half, at);
  return scene;
}

Explanation explanation_of(const Scene& scene, const View& view, std::uint32_t object = 0) {
  const Surfaces surfaces(scene);
  return explain(surfaces, view, object);
}

/// The explanation after its remedy was applied.
Explanation after_remedy(const Scene& scene, const View& view, const Explanation& why) {
  Scene changed = scene;
  std::uint32_t object = why.object;
  if (why.remedy.kind == RemedyKind::make_opaque)
    for (Material& material : changed.materials) material.alpha = Material::Alpha::opaque;
  for (auto away = why.remedy.objects.rbegin(); away != why.remedy.objects.rend(); ++away) {
    changed.instances.erase(changed.instances.begin() + std::ptrdiff_t(*away));
    object -= *away < why.object;
  }
  return explanation_of(changed, remedied(view, why.remedy), object);
}

void expect_seen_after_remedy(const Scene& scene, const View& view, const Explanation& why) {
  EXPECT_EQ(after_remedy(scene, view, why).reason, SightReason::seen) << sentence(why, scene);
}

TEST(Explain, SaysThatWhatIsSeenIsSeen) {
  Scene scene = panel_at({0, 0, -10});
  EXPECT_EQ(sentence(explanation_of(scene, level_view()), scene), "panel is seen, all of it.");
  test::place_square(scene, "post", 0.5, {-0.5, 0, -9});
  const Explanation why = explanation_of(scene, level_view());
  EXPECT_EQ(why.reason, SightReason::seen);
  EXPECT_EQ(why.triangles, (TrianglePlaces{.in_view = 2}));
  ASSERT_EQ(why.hiders.size(), 1u);
  EXPECT_EQ(why.hiders[0].object, 1u);
  EXPECT_EQ(why.remedy.kind, RemedyKind::none);
  EXPECT_EQ(sentence(why, scene), "panel is seen, 72 % of it, the rest hidden by post 28 %.");
}

TEST(Explain, TellsShareBeyondTheFrame) {
  const Scene scene = panel_at({5, 0, -10});
  EXPECT_EQ(sentence(explanation_of(scene, parallel_view()), scene),
            "panel is seen, 50 % of it, 50 % beyond the frame.");
  Scene cut = scene;
  test::place_square(cut, "post", 1, {5.5, 0, -9});  // hides half of what is in the frame
  EXPECT_EQ(sentence(explanation_of(cut, parallel_view()), cut),
            "panel is seen, 25 % of it, 50 % beyond the frame, the rest hidden by post 25 %.");
}

TEST(Explain, ObjectsWithoutAreaAreEmpty) {
  Scene scene;
  scene.meshes.resize(3);
  scene.meshes[1].positions = {{0, 0, -5}, {1, 1, -5}, {2, 2, -5}};
  scene.meshes[1].triangles = {{0, 1, 2}};
  scene.meshes[2].positions = {{0, 0, -5}, {1, 1, -5}, {2, std::nanf(""), -5}};
  scene.meshes[2].triangles = {{0, 1, 2}, {0, 1, 1}};
  for (std::uint32_t i = 0; i < 3; ++i) scene.instances.push_back({"", i, glm::dmat4(1.0)});
  const char* const expected[] = {"object 0 is empty: it has no triangles.",
                                  "object 1 is empty: its triangle has no area.",
                                  "object 2 is empty: none of its 2 triangles has an area."};
  for (std::uint32_t i = 0; i < 3; ++i) {
    const Explanation why = explanation_of(scene, level_view(), i);
    EXPECT_EQ(why.reason, SightReason::empty);
    EXPECT_EQ(why.remedy.kind, RemedyKind::none);
    EXPECT_EQ(sentence(why, scene), expected[i]);
  }
}

TEST(Explain, BehindTheEyeTheCameraTurns) {
  const Scene scene = panel_at({-10, 0, 6});
  const Explanation why = explanation_of(scene, level_view());
  EXPECT_EQ(why.reason, SightReason::behind_eye);
  EXPECT_EQ(sentence(why, scene), "panel is behind the eye: turn the camera 122 degrees to the left.");
  expect_seen_after_remedy(scene, level_view(), why);
  const Scene above = panel_at({0, 12, 0.5});
  const Explanation up = explanation_of(above, level_view());
  EXPECT_EQ(up.reason, SightReason::behind_eye);
  EXPECT_GT(up.remedy.up, 0);
  // The panel is seen edge-on from every point of its plane.
  EXPECT_EQ(after_remedy(above, level_view(), up).reason, SightReason::seen);
}

TEST(Explain, NearerThanNearComesIntoViewWithALesserNear) {
  const Scene scene = panel_at({0, 0, -0.21}, 0.05f);
  const Explanation why = explanation_of(scene, level_view());
  EXPECT_EQ(why.reason, SightReason::nearer_than_near);
  EXPECT_EQ(sentence(why, scene), "panel is nearer than near: set near to 0.2.");
  expect_seen_after_remedy(scene, level_view(), why);
  // In parallel projection, an object behind the eye gets the same explanation.
  const Scene behind = panel_at({0, 0, 3});
  const Explanation parallel = explanation_of(behind, parallel_view());
  EXPECT_EQ(parallel.reason, SightReason::nearer_than_near);
  EXPECT_EQ(remedy_text(parallel, behind), "set near to -3.1");
  expect_seen_after_remedy(behind, parallel_view(), parallel);
}

TEST(Explain, WhatReachesToTheEyeIsShownInPart) {
  Scene scene = panel_at({0.05, 0, 0}, 0.4f);
  scene.instances[0].world_from_mesh[0] = glm::dvec4(0.1, 0, 1, 0);  // from in front of the eye to behind it
  const Explanation why = explanation_of(scene, level_view());
  EXPECT_EQ(why.reason, SightReason::nearer_than_near);
  EXPECT_EQ(why.remedy.value, 0.2);
  expect_seen_after_remedy(scene, level_view(), why);
}

TEST(Explain, BeyondFarComesIntoViewWithAGreaterFar) {
  for (const View& view : {level_view(), parallel_view()}) {
    const Scene scene = panel_at({0, 0, -163}, 4);
    const Explanation why = explanation_of(scene, view);
    EXPECT_EQ(why.reason, SightReason::beyond_far);
    EXPECT_EQ(sentence(why, scene), "panel is beyond far: set far to 170.");
    expect_seen_after_remedy(scene, view, why);
  }
}

TEST(Explain, OutsideTheCameraTurnsOrMoves) {
  struct Case {
    glm::dvec3 at;
    const char *turned, *moved;
  };
  for (const Case& c : {Case{{-20, 0, -20},
                             "on the left of the picture: turn the camera 45 degrees to the left.",
                             "on the left of the picture: move the camera 20 to the left."},
                        Case{{20, 0, -20},
                             "on the right of the picture: turn the camera 45 degrees to the right.",
                             "on the right of the picture: move the camera 20 to the right."},
                        Case{{0, 20, -20},
                             "above of the picture: turn the camera 45 degrees up.",
                             "above of the picture: move the camera 20 up."},
                        Case{{0, -20, -20},
                             "below of the picture: turn the camera 45 degrees down.",
                             "below of the picture: move the camera 20 down."},
                        Case{{-20, 20, -20},
                             "on the left of the picture: turn the camera 45 degrees to the left and 35 degrees up.",
                             "on the left of the picture: move the camera 20 to the left and 20 up."}}) {
    const Scene scene = panel_at(c.at);
    const Explanation turned = explanation_of(scene, level_view()), moved = explanation_of(scene, parallel_view());
    EXPECT_EQ(turned.reason, SightReason::outside);
    EXPECT_EQ(sentence(turned, scene), std::string("panel is outside: ") + c.turned);
    EXPECT_EQ(sentence(moved, scene), std::string("panel is outside: ") + c.moved);
    expect_seen_after_remedy(scene, level_view(), turned);
    expect_seen_after_remedy(scene, parallel_view(), moved);
  }
}

TEST(Explain, PastACornerIsOutside) {
  Scene scene;
  scene.meshes.resize(1);
  scene.meshes[0].positions = {{-9, 2, -20}, {-2, 9, -20}, {-9, 9, -20}};  // across the corner at (-5, 5)
  scene.meshes[0].triangles = {{0, 2, 1}};
  scene.instances.push_back({"triangle", 0, glm::dmat4(1.0)});
  const Explanation why = explanation_of(scene, parallel_view());
  EXPECT_EQ(why.triangles, (TrianglePlaces{.past_corner = 1}));
  EXPECT_EQ(reason_text(why, scene), "outside: past a corner of the picture");
  expect_seen_after_remedy(scene, parallel_view(), why);
}

TEST(Explain, CountsTrianglesOfMixtures) {
  Scene scene;
  Mesh mesh;
  test::add_quad(mesh, {-30, -1, -10}, {-28, -1, -10}, {-28, 1, -10}, {-30, 1, -10});
  test::add_quad(mesh, {30, -1, -10}, {28, -1, -10}, {28, 1, -10}, {30, 1, -10});
  test::add_quad(mesh, {-1, -1, 5}, {1, -1, 5}, {1, 1, 5}, {-1, 1, 5});
  test::add_quad(mesh, {-1, -1, -500}, {1, -1, -500}, {1, 1, -500}, {-1, 1, -500});
  scene.meshes.push_back(std::move(mesh));
  scene.instances.push_back({"swarm", 0, glm::dmat4(1.0)});
  const Explanation why = explanation_of(scene, level_view());
  EXPECT_EQ(why.triangles, (TrianglePlaces{.behind_eye = 2, .beyond_far = 2, .left = 2, .right = 2}));
  EXPECT_EQ(
      reason_text(why, scene),
      "outside of the picture; of its 8 triangles 2 behind the eye, 2 beyond far, 2 on the left and 2 on the right");
  expect_seen_after_remedy(scene, level_view(), why);
}

TEST(Explain, CountsWhatIsWhollyInViewByItsAreas) {
  // Triangles within the picture; many have no area, and one has a vertex that is not finite.
  test::Random random(11);
  const auto corner = [&] { return random.point(1) - glm::vec3(0, 0, 8); };
  Mesh mesh;
  std::uint64_t empty = 1;
  for (int i = 0; i < 1'237; ++i) {
    const glm::vec3 a = corner(), b = corner(), c = i % 8 == 0 ? a : i % 8 == 4 ? (a + b) * 0.5f : corner();
    test::add_triangle(mesh, a, b, c);
    empty += glm::cross(glm::dvec3(b) - glm::dvec3(a), glm::dvec3(c) - glm::dvec3(a)) == glm::dvec3(0);
  }
  mesh.positions[15].y = std::numeric_limits<float>::quiet_NaN();
  const std::size_t count = mesh.triangles.size();
  EXPECT_GT(empty, count / 9);
  EXPECT_LT(empty, count / 3);
  const Scene scene = test::scene_of(std::move(mesh));
  const Surfaces surfaces(scene);
  for (const Isa isa : available_isas()) {
    const Explanation why = explain(surfaces, level_view(), 0, {.threads = 1, .isa = isa});
    EXPECT_EQ(why.triangles.empty, empty) << name(isa);
    EXPECT_EQ(why.triangles.in_view, count - empty) << name(isa);
    EXPECT_EQ(why.reason, SightReason::seen);
  }
}

TEST(Explain, WhatIsTurnedAwayIsSeenWithoutCulling) {
  const Scene scene = panel_at({0, 0, -10});
  for (const Culling culling : {Culling::front, Culling::both}) {
    View view = level_view();
    view.culling = culling;
    const Explanation why = explanation_of(scene, view);
    EXPECT_EQ(why.triangles, (TrianglePlaces{.faces_away = 2}));
    EXPECT_EQ(sentence(why, scene), "panel is turned away, and culled: cull nothing.");
    expect_seen_after_remedy(scene, view, why);
    view.projection = parallel_view().projection;
    EXPECT_EQ(explanation_of(scene, view).reason, SightReason::faces_away);
  }
  View view = level_view();
  view.culling = Culling::back;
  EXPECT_EQ(explanation_of(scene, view).reason, SightReason::seen);
  // The front of a mirrored object is still its front.
  Scene mirrored = scene;
  mirrored.instances[0].world_from_mesh[0].x = -1;
  EXPECT_EQ(explanation_of(mirrored, view).reason, SightReason::seen);
}

TEST(Explain, OpacityZeroIsTransparent) {
  Scene scene = panel_at({0, 0, -10});
  scene.meshes[0].material_ids = {0};
  scene.materials.resize(1);
  scene.materials[0].alpha = Material::Alpha::blend;
  EXPECT_EQ(explanation_of(scene, level_view()).reason, SightReason::seen);
  scene.materials[0].base_color.a = 0;
  const Explanation why = explanation_of(scene, level_view());
  EXPECT_EQ(sentence(why, scene), "panel is transparent: its opacity is 0: make its material opaque.");
  expect_seen_after_remedy(scene, level_view(), why);
  scene.materials[0].base_color.a = 1;
  scene.textures.push_back({.name = "", .width = 1, .height = 2, .pixels = {{9, 9, 9, 0}, {9, 9, 9, 0}}});
  scene.materials[0].base_color_texture.texture = 0;
  EXPECT_EQ(explanation_of(scene, level_view()).reason, SightReason::transparent);
  scene.textures[0].pixels[1].a = 1;
  EXPECT_EQ(explanation_of(scene, level_view()).reason, SightReason::seen);
}

TEST(Explain, NothingButHolesIsTransparent) {
  Scene scene = panel_at({0, 0, -10});
  scene.meshes[0].material_ids = {0};
  scene.materials.resize(1);
  scene.materials[0].alpha = Material::Alpha::mask;
  scene.materials[0].base_color.a = 0.4f;
  const Explanation why = explanation_of(scene, level_view());
  EXPECT_TRUE(why.is_all_holes);
  EXPECT_EQ(sentence(why, scene), "panel is transparent: every sample of it is a hole: make its material opaque.");
  expect_seen_after_remedy(scene, level_view(), why);
  scene.materials[0].base_color.a = 0.6f;
  EXPECT_EQ(explanation_of(scene, level_view()).reason, SightReason::seen);
  // The object is too small for a sample, so its holes do not matter.
  scene.materials[0].base_color.a = 0.4f;
  scene.instances[0].world_from_mesh = panel_at({0.1, 0.05, -99}, 1).instances[0].world_from_mesh;
  scene.instances[0].world_from_mesh[0].x = scene.instances[0].world_from_mesh[1].y = 0.01;
  EXPECT_EQ(explanation_of(scene, level_view()).reason, SightReason::no_sample);
}

TEST(Explain, BetweenTheSamplesItsAreaIsTold) {
  // A unit is ten pixels: the panel is half a pixel wide, from a quarter of a pixel past a sample.
  const Scene scene = panel_at({0.1, 0.1, -10}, 0.025f);
  const Explanation why = explanation_of(scene, parallel_view());
  EXPECT_EQ(why.reason, SightReason::no_sample);
  EXPECT_NEAR(why.pixels, 0.25, 1e-6);
  EXPECT_EQ(sentence(why, scene),
            "panel is between the samples: its 0.25 square pixels contain no sample: draw 2 times as "
            "many pixels each way.");
  expect_seen_after_remedy(scene, parallel_view(), why);
  // A box's visible area is at most its silhouette.
  Scene box;
  test::add_quad(box.meshes.emplace_back(), {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
  box.meshes[0] = test::tessellated_box({0.025f, 0.025f, 0.025f}, 3, 0);
  box.instances = scene.instances;
  EXPECT_NEAR(explanation_of(box, parallel_view()).pixels, 0.25, 1e-6);
}

// No triangle of a fine mesh contains a circle that surely holds a sample; together they soon do.
TEST(Explain, AFineMeshIsEnlargedUntilItCoversASample) {
  std::size_t told = 0;
  for (std::uint64_t seed = 0; seed < test::seeds(40); ++seed) {
    Random random(seed);
    Scene scene;
    const float size = 0.002f + 0.05f * float(random.below(1000)) / 1000;
    scene.meshes = {test::tessellated_box(glm::vec3(size), 12, 0)};
    scene.instances = panel_at(glm::dvec3(0, 0, -10) + glm::dvec3(random.point(2))).instances;
    const Explanation why = explanation_of(scene, parallel_view());
    if (why.reason != SightReason::no_sample) continue;
    ++told;
    SCOPED_TRACE(sentence(why, scene));
    ASSERT_EQ(why.remedy.kind, RemedyKind::enlarge);
    // A unit is ten pixels.
    EXPECT_LE(why.remedy.value, 3 / (10 * size));
    if (why.remedy.value <= 20) expect_seen_after_remedy(scene, parallel_view(), why);
  }
  EXPECT_GE(told, test::seeds(40) / 4);
}

TEST(Explain, EdgeOnThereIsNoArea) {
  Scene scene = panel_at({0, 0, -10});
  scene.instances[0].world_from_mesh[0] = glm::dvec4(0, 0, 1, 0);
  const Explanation why = explanation_of(scene, parallel_view());
  EXPECT_EQ(why.reason, SightReason::no_sample);
  EXPECT_EQ(why.pixels, 0);
  EXPECT_EQ(sentence(why, scene), "panel is seen edge on, so that it has no area.");
}

TEST(Explain, WhatHidesIsTakenAway) {
  Scene scene = panel_at({0, 0, -10});
  test::place_square(scene, "wall", 6, {-5.75, 0, -9});
  test::place_square(scene, "lamp", 6, {6.25, 0, -8});
  const Explanation why = explanation_of(scene, parallel_view());
  EXPECT_EQ(why.reason, SightReason::hidden);
  EXPECT_EQ(why.hidden_share, 1);
  EXPECT_EQ(sentence(why, scene), "panel is hidden by wall 60 % and lamp 40 %: take wall away.");
  scene.instances[2].name = "wall";
  EXPECT_EQ(sentence(why, scene), "panel is hidden by wall #1 60 % and wall #2 40 %: take wall #1 away.");
  scene.instances[2].name = "";
  EXPECT_EQ(sentence(why, scene), "panel is hidden by wall 60 % and object 2 40 %: take wall away.");
  expect_seen_after_remedy(scene, parallel_view(), why);
}

TEST(Explain, WhatStandsBehindTheFirstIsTakenAwayToo) {
  Scene scene = panel_at({0, 0, -10});
  for (int i = 0; i < 4; ++i) test::place_square(scene, "", 2, {0, 0, -9 + i});
  const Explanation why = explanation_of(scene, parallel_view());
  EXPECT_EQ(why.remedy.objects, (std::vector<std::uint32_t>{1, 2, 3, 4}));
  EXPECT_EQ(sentence(why, scene),
            "panel is hidden by object 4 100 %: take object 1, object 2, object 3 and object 4 away.");
  expect_seen_after_remedy(scene, parallel_view(), why);
  for (int i = 4; i < 9; ++i) test::place_square(scene, "", 2, {0, 0, -9 + i});
  EXPECT_EQ(remedy_text(explanation_of(scene, parallel_view()), scene),
            "take object 1, object 2, object 3 and 6 other objects away");
}

TEST(Explain, ACopyBehindItsFirstIsHidden) {
  Scene scene = panel_at({0, 0, -10});
  scene.instances.push_back(scene.instances[0]);
  const Explanation why = explanation_of(scene, level_view(), 1);
  EXPECT_EQ(why.remedy.objects, (std::vector<std::uint32_t>{0}));
  expect_seen_after_remedy(scene, level_view(), why);
}

/// Follows remedies until none is left.
SightReason reason_in_the_end(const Scene& scene, View view, const Explanation& first) {
  const Surfaces surfaces(scene);
  Explanation why = first;
  for (int step = 0; step < 8; ++step) {
    const RemedyKind kind = why.remedy.kind;
    if (kind == RemedyKind::none || kind == RemedyKind::take_away || kind == RemedyKind::make_opaque) break;
    if (kind == RemedyKind::enlarge && why.remedy.value * view.width > 2000) break;  // takes long
    view = remedied(view, why.remedy);
    why = explain(surfaces, view, why.object);
  }
  return why.reason;
}

TEST(Explain, RemediesOfRandomScenesHelp) {
  std::size_t taken = 0, counts[10] = {};
  for (std::uint64_t seed = 0; seed < test::seeds(40); ++seed) {
    Random random(seed);
    const Scene scene = test::hidden_scene(6 + random.below(20), seed);
    View view = test::random_view(20 + random.below(80), 20 + random.below(60), seed);
    view.culling = seed % 3 == 0 ? Culling::back : Culling::none;
    view.samples = seed % 5 == 4 ? 4 : 1;
    if (random.below(2) == 0) view.projection.clip = {1.5, 4};
    if (random.below(3) == 0) view.projection.right += 0.3 * (view.projection.right - view.projection.left);
    const Surfaces surfaces(scene);
    const Visible visible = zbuffer(surfaces, view);
    const Accounting accounts = account(surfaces, visible);
    SCOPED_TRACE(seed);
    for (const Explanation& why : explain_all(surfaces, visible, accounts)) {
      const ObjectAccount& object = accounts.objects[why.object];
      SCOPED_TRACE(sentence(why, scene));
      ++counts[std::size_t(why.reason)];
      EXPECT_EQ(why.reason == SightReason::seen, object.visible.count > 0);
      EXPECT_EQ(why.reason == SightReason::hidden, object.in_frame.count > 0 && object.visible.count == 0);
      if (why.reason == SightReason::hidden) {
        EXPECT_EQ(why.remedy.kind, RemedyKind::take_away);
        if (++taken % 4 == 0) expect_seen_after_remedy(scene, view, why);
      } else if (why.remedy.kind != RemedyKind::none && random.below(3) == 0) {
        const SightReason end = reason_in_the_end(scene, view, why);
        EXPECT_TRUE(end == SightReason::seen || end == SightReason::hidden || end == SightReason::no_sample)
            << name(end);
      }
    }
  }
  EXPECT_GT(taken, test::seeds(40));
  for (const SightReason reason : {SightReason::behind_eye, SightReason::nearer_than_near, SightReason::beyond_far,
                                   SightReason::outside, SightReason::faces_away, SightReason::no_sample})
    EXPECT_GE(counts[std::size_t(reason)], test::seeds(40) / 10) << name(reason);
}

/// Whether a point is within the volume, by the matrix to clip space.
bool is_within(const View& view, const glm::dvec3& p) {
  const glm::dvec4 c = clip_from_eye(view.projection) * glm::inverse(view.world_from_eye) * glm::dvec4(p, 1);
  return c.w > 0 && std::abs(c.x) <= c.w && std::abs(c.y) <= c.w && std::abs(c.z) <= c.w;
}

// The plain reference tests points of a triangle one by one.
TEST(Explain, PlacesOfTrianglesEqualThoseOfTheirPoints) {
  std::size_t in_view = 0, elsewhere = 0;
  for (std::uint64_t seed = 0; seed < test::seeds(400); ++seed) {
    Random random(seed);
    Scene scene;
    scene.meshes.resize(1);
    scene.meshes[0].positions = {random.point(4), random.point(4), random.point(4)};
    scene.meshes[0].triangles = {{0, 1, 2}};
    scene.instances.push_back({"", 0, glm::dmat4(1.0)});
    View view = test::random_view(64, 48, seed);
    view.projection.clip = {0.2, 5};
    const Explanation why = explanation_of(scene, view);
    EXPECT_EQ(why.triangles.total(), 1u);
    const auto& p = scene.meshes[0].positions;
    bool is_any_within = false;
    constexpr int steps = 60;
    for (int i = 0; i <= steps; ++i)
      for (int j = 0; i + j <= steps; ++j) {
        const double u = double(i) / steps, v = double(j) / steps;
        const glm::dvec3 point = glm::dvec3(p[0]) * (1 - u - v) + glm::dvec3(p[1]) * u + glm::dvec3(p[2]) * v;
        is_any_within = is_any_within || is_within(view, point);
      }
    SCOPED_TRACE(seed);
    // Steps may miss a sliver, but nothing that covers samples.
    if (is_any_within || why.reason == SightReason::seen) {
      EXPECT_EQ(why.triangles.in_view, 1u);
    }
    in_view += is_any_within;
    elsewhere += why.triangles.in_view == 0;
  }
  EXPECT_GT(in_view, test::seeds(400) / 8);
  EXPECT_GT(elsewhere, test::seeds(400) / 20);
}

TEST(Explain, IsTheSameForThreadsAndInstructionSets) {
  const Scene scene = test::hidden_scene(150, 4);
  const View view = test::random_view(333, 221, 7);
  const Surfaces surfaces(scene);
  const Visible visible = zbuffer(surfaces, view);
  const Accounting accounts = account(surfaces, visible);
  const std::vector<Explanation> expected =
      explain_all(surfaces, visible, accounts, {.threads = 1, .isa = Isa::scalar});
  for (const Isa isa : available_isas())
    for (const int threads : {1, 4}) {
      const Execution execution{.threads = threads, .isa = isa};
      const std::vector<Explanation> all = explain_all(surfaces, visible, accounts, execution);
      ASSERT_EQ(all.size(), expected.size());
      for (std::uint32_t i = 0; i < all.size(); ++i) {
        EXPECT_EQ(sentence(all[i], scene), sentence(expected[i], scene));
        EXPECT_EQ(all[i].triangles, expected[i].triangles);
        EXPECT_EQ(all[i].remedy.objects, expected[i].remedy.objects);
        if (i % 30 != 0) continue;
        const Explanation lone = explain(surfaces, view, i, execution);
        EXPECT_EQ(sentence(lone, scene), sentence(expected[i], scene));
        EXPECT_EQ(lone.triangles, expected[i].triangles);
      }
    }
}

TEST(Explain, RefusesWhatDoesNotBelongTogether) {
  const Scene scene = panel_at({0, 0, -10});
  const Surfaces surfaces(scene);
  EXPECT_EQ(test::refusal_of(ErrorCode::bad_argument, [&] { (void)explain(surfaces, level_view(), 1); }),
            "explain: there is no object 1");
  EXPECT_EQ(test::code_of([&] { (void)explain(surfaces, View{}, 0); }), ErrorCode::bad_argument);
  EXPECT_EQ(test::refusal_of(ErrorCode::bad_argument,
                             [&] { (void)explain_all(surfaces, zbuffer(surfaces, level_view()), {}); }),
            "explanations: the accounts were made for other objects");
  EXPECT_EQ(test::code_of([&] {
              (void)remedied(level_view(), {RemedyKind::enlarge, 1000, 0, 0, {}});
            }),
            ErrorCode::limit_exceeded);
}

TEST(Explain, ObjectsOfModelsAreExplained) {
  FRONTMOST_NEEDS_MODELS();
  for (const char* file : {"scenes/warehouse.glb", "scenes/home-theater.glb", "cad/cycloidal-drive.ply"}) {
    const Scene scene = load(test::model(file));
    const Surfaces surfaces(scene);
    const View view = frame(surfaces, 160, 120);
    const Visible visible = zbuffer(surfaces, view);
    const std::vector<Explanation> all = explain_all(surfaces, visible, account(surfaces, visible));
    SCOPED_TRACE(file);
    const std::size_t step = 1 + all.size() / 12;
    for (std::size_t i = 0; i < all.size(); i += step)
      if (all[i].reason == SightReason::hidden) expect_seen_after_remedy(scene, view, all[i]);
  }
}

}  // namespace
}  // namespace frontmost
