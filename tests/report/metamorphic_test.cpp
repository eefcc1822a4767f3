// SPDX-License-Identifier: Apache-2.0
// Changes of scene and view that must not change the visible surfaces, or in a known way: for every method.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "frontmost/abuffer.h"
#include "frontmost/precision.h"
#include "frontmost/raycast.h"
#include "frontmost/report.h"
#include "frontmost/zbuffer.h"
#include "support/effort.h"
#include "support/random_scene.h"
#include "support/same_visible.h"

namespace frontmost::test {
namespace {

struct Method {
  const char* name;
  Visible (*see)(const Scene& scene, const View& view);
};

Visible by_zbuffer(const Scene& scene, const View& view) { return ZBuffer().draw(Surfaces(scene), view); }
Visible by_single_picture(const Scene& scene, const View& view) { return zbuffer(Surfaces(scene), view); }
Visible by_raycast(const Scene& scene, const View& view) { return raycast(Surfaces(scene), view); }
Visible by_depth_buffer(const Scene& scene, const View& view) {
  DepthBuffer buffer(view.width, view.height, view.samples, DepthFormat::f32);
  buffer.draw(Surfaces(scene), view);
  return std::move(buffer).visible(view);
}
Visible by_layers(const Scene& scene, const View& view) {
  std::vector<Visible> layers = visible_layers(Surfaces(scene), view, 1);
  return std::move(layers[0]);
}

constexpr Method methods[] = {{"zbuffer", by_zbuffer},
                              {"single picture", by_single_picture},
                              {"raycast", by_raycast},
                              {"depth buffer", by_depth_buffer},
                              {"layers", by_layers}};

/// Coordinates in steps of 1/1024, so that sums with whole numbers are exact in floats.
glm::vec3 in_steps(const glm::vec3& p) { return glm::round(p * 1024.0f) / 1024.0f; }

struct Example {
  Scene scene;
  View view;
};

/// A random example: vertices, eye and planes in steps of 1/1024; kinds, sizes, culling and projections take turns.
Example example(std::uint64_t seed) {
  constexpr Kind kinds[] = {Kind::soup, Kind::shared_grid, Kind::coplanar, Kind::sheets, Kind::fan, Kind::through_eye};
  Random random(seed + 900);
  Mesh mesh = random_mesh(kinds[seed % 6], 40 + random.below(100), seed);
  for (glm::vec3& p : mesh.positions) p = in_steps(p);
  Example made{scene_of(mesh), random_view(random, 20 + random.below(60), 20 + random.below(60))};
  const glm::dvec3 eye(in_steps(glm::vec3(made.view.world_from_eye[3])));
  made.view.world_from_eye = look_at(eye, {0.25, 0, -0.125}, {0, 1, 0});
  made.view.culling = Culling(random.below(3));
  made.view.samples = seed % 4 == 3 ? 4 : 1;
  return made;
}

template <class Change>
void expect_unchanged(const Change& change) {
  std::size_t seen = 0;
  for (std::uint64_t seed = 0; seed < seeds(24); ++seed) {
    const Example before = example(seed), after = change(before, seed);
    for (const Method& method : methods) {
      SCOPED_TRACE(testing::Message() << method.name << ", seed " << seed);
      const Visible expected = method.see(before.scene, before.view);
      expect_same(expected, method.see(after.scene, after.view));
      seen += covered(expected);
    }
  }
  EXPECT_GT(seen, seeds(24) * 1000) << "the scenes have become empty";
}

TEST(Metamorphic, ScalingByPowersOfTwoChangesNothing) {
  // Lengths scale exactly; angles and keys (near / distance) do not change.
  expect_unchanged([](Example e, std::uint64_t seed) {
    const double by = std::ldexp(1.0, seed % 2 ? 11 : -9);
    for (glm::vec3& p : e.scene.meshes[0].positions) p *= float(by);
    e.view.world_from_eye[3] = glm::dvec4(by * glm::dvec3(e.view.world_from_eye[3]), 1);
    Projection& p = e.view.projection;
    p.clip.near *= by;
    p.clip.far *= by;
    if (p.orthographic) p.left *= by, p.right *= by, p.bottom *= by, p.top *= by;
    return e;
  });
}

TEST(Metamorphic, MovingSceneAndEyeTogetherChangesNothing) {
  expect_unchanged([](Example e, std::uint64_t seed) {
    const glm::dvec3 by(double(seed % 7) - 3, 16, -8);
    for (glm::vec3& p : e.scene.meshes[0].positions) p += glm::vec3(by);
    e.view.world_from_eye[3] += glm::dvec4(by, 0);
    return e;
  });
}

TEST(Metamorphic, OneMeshInPartsIsTheSameTriangles) {
  expect_unchanged([](Example e, std::uint64_t seed) {
    const Mesh whole = e.scene.meshes[0];
    e.scene.meshes.clear();
    e.scene.instances.clear();
    // Parts of one to fifty triangles; vertices stay in the first part, so every part has all of them.
    Random random(seed);
    for (std::size_t first = 0; first < whole.triangles.size();) {
      const std::size_t end = std::min(first + 1 + std::size_t(random.below(50)), whole.triangles.size());
      Mesh part;
      part.positions = whole.positions;
      part.triangles.assign(whole.triangles.begin() + std::ptrdiff_t(first),
                            whole.triangles.begin() + std::ptrdiff_t(end));
      e.scene.instances.push_back({"part", std::uint32_t(e.scene.meshes.size()), glm::dmat4(1)});
      e.scene.meshes.push_back(part);
      first = end;
    }
    return e;
  });
}

TEST(Metamorphic, InstancesThatAreMovedEqualVerticesThatAre) {
  expect_unchanged([](Example e, std::uint64_t) {
    const glm::dvec3 by(-2, 5, 0.5);
    for (glm::vec3& p : e.scene.meshes[0].positions) p -= glm::vec3(by);
    e.scene.instances[0].world_from_mesh[3] = glm::dvec4(by, 1);
    return e;
  });
}

TEST(Metamorphic, WhatHasNoAreaOrNoPlaceIsNotThere) {
  expect_unchanged([](Example e, std::uint64_t) {
    Mesh& mesh = e.scene.meshes[0];
    const std::size_t count = mesh.triangles.size();
    const glm::vec3 bad(std::numeric_limits<float>::quiet_NaN(), 0, std::numeric_limits<float>::infinity());
    for (std::size_t i = 0; i < count; i += 3) {
      const glm::uvec3 t = mesh.triangles[i];
      mesh.triangles.emplace_back(t.x, t.y, t.x);
      add_triangle(mesh, mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.y]);
      add_triangle(mesh, mesh.positions[t.x], mesh.positions[t.y], bad);
    }
    e.scene.meshes.push_back(Mesh{});
    e.scene.instances.push_back({"empty", 1, glm::dmat4(1)});
    return e;
  });
}

// -- known changes
// ------------------------------------------------------------------------------------------------------

/// The picture `turned`, rearranged to the untransformed one: `from(x, y)` gives each pixel's place in it.
template <class From>
Visible turned_back(const Visible& turned, const View& view, const From& from) {
  Visible back = nothing_visible(view);
  for (int y = 0; y < view.height; ++y)
    for (int x = 0; x < view.width; ++x) {
      const glm::ivec2 at = from(x, y);
      back.primitives[back.index(x, y)] = turned.primitives[turned.index(at.x, at.y)];
      back.keys[back.index(x, y)] = turned.keys[turned.index(at.x, at.y)];
    }
  return back;
}

/// Samples on an edge belong to one side of it by a rule that turns with the picture, and keys round in another order.
/// Exact arithmetic must find a reason for each difference, and differences must be few.
void expect_explained(const Scene& scene, const Visible& straight, const Visible& back, std::uint64_t& differing,
                      std::uint64_t& all) {
  const Agreement found = check_agreement(Surfaces(scene), straight, back);
  EXPECT_EQ(found.count(Difference::unexplained), 0u);
  differing += found.differing();
  all += straight.view.sample_count();
}

TEST(Metamorphic, AMirroredWorldIsAMirroredPicture) {
  std::uint64_t differing = 0, all = 0;
  for (std::uint64_t seed = 0; seed < seeds(16); ++seed) {
    Example e = example(seed);
    e.view.samples = 1;
    e.view.world_from_eye = look_at({0, 0, 3}, {0, 0, 0}, {0, 1, 0});
    Projection& p = e.view.projection;
    p.left = -p.right;
    Example mirrored = e;
    for (glm::vec3& position : mirrored.scene.meshes[0].positions) position.x = -position.x;
    // A mirror exchanges front and back faces.
    if (e.view.culling == Culling::back) mirrored.view.culling = Culling::front;
    if (e.view.culling == Culling::front) mirrored.view.culling = Culling::back;
    for (const Method& method : methods) {
      SCOPED_TRACE(testing::Message() << method.name << ", seed " << seed);
      const Visible straight = method.see(e.scene, e.view);
      const Visible seen = method.see(mirrored.scene, mirrored.view);
      const int last = e.view.width - 1;
      const Visible back = turned_back(seen, e.view, [&](int x, int y) { return glm::ivec2(last - x, y); });
      expect_explained(e.scene, straight, back, differing, all);
    }
  }
  EXPECT_LT(differing * 100, all) << differing << " of " << all;
}

/// Every triangle twice: the second copy of a double-sided one is reversed, that of any other has no area.
Scene with_backs(Scene scene) {
  for (Mesh& mesh : scene.meshes) {
    std::vector<glm::uvec3> both;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const std::uint32_t material = mesh.material_of(t);
      const glm::uvec3& c = mesh.triangles[t];
      both.push_back(c);
      both.push_back(material != no_index && scene.materials[material].double_sided ? glm::uvec3(c.x, c.z, c.y)
                                                                                    : glm::uvec3(c.x));
    }
    mesh.triangles = both;
    mesh.material_ids.clear();
  }
  return scene;
}

/// Two meshes; the first has a second, mirrored instance.
Example example_with_sides(std::uint64_t seed) {
  Example made = example(seed);
  made.scene.meshes.push_back(random_mesh(Kind::soup, 30, seed + 50));
  made.scene.instances.push_back({"other", 1, glm::dmat4(1.0)});
  made.scene.instances.push_back({"mirrored", 0, glm::dmat4(1.0)});
  made.scene.instances[2].world_from_mesh[0][0] = -1;
  add_random_sides(made.scene, seed);
  made.view.culling = Culling::material;
  return made;
}

TEST(Metamorphic, CullingByMaterialIsThatOfBacksWhereDoubleSidedTrianglesHaveTwoFronts) {
  std::size_t seen = 0, other = 0;
  for (std::uint64_t seed = 0; seed < seeds(32); ++seed) {
    const Example e = example_with_sides(seed);
    View backs = e.view;
    backs.culling = Culling::back;
    for (const Method& method : methods) {
      SCOPED_TRACE(testing::Message() << method.name << ", seed " << seed);
      Visible expected = method.see(with_backs(e.scene), backs);
      expected.view = e.view;
      for (PrimitiveId& id : expected.primitives)
        if (id != no_primitive) id /= 2;
      expect_same(expected, method.see(e.scene, e.view));
      seen += covered(expected);
      other += covered(expected) != covered(method.see(e.scene, backs));
    }
  }
  EXPECT_GT(seen, seeds(32) * 1000);
  EXPECT_GT(other, seeds(32)) << "culling backs alone shows as much";
}

TEST(Metamorphic, CullingByMaterialIsTheSameForAllInstructionSets) {
  for (std::uint64_t seed = 2; seed < seeds(16); ++seed) {
    const Example e = example_with_sides(seed);
    const Surfaces surfaces(e.scene);
    for (const Isa isa : available_isas()) {
      SCOPED_TRACE(testing::Message() << name(isa) << ", seed " << seed);
      const Execution execution{.threads = 1, .isa = isa};
      expect_same(zbuffer(surfaces, e.view), draw_both_ways(surfaces, e.view, execution));
      expect_same(raycast(surfaces, e.view), raycast(surfaces, e.view, execution));
      expect_same(visible_layers(surfaces, e.view, 1)[0], visible_layers(surfaces, e.view, 1, {}, execution)[0]);
    }
  }
}

// Exact methods also find equal answers for the two scenes.
TEST(Metamorphic, FacesAndAccountsCullByMaterialAsThePictureDoes) {
  for (std::uint64_t seed = 0; seed < seeds(16); ++seed) {
    SCOPED_TRACE(seed);
    const Example e = example_with_sides(seed);
    const Scene doubled = with_backs(e.scene);
    View backs = e.view;
    backs.culling = Culling::back;
    const Surfaces surfaces(e.scene), of_doubled(doubled);
    const Visible visible = zbuffer(surfaces, e.view);
    EXPECT_EQ(check_agreement(surfaces, visible, raycast(surfaces, e.view)).count(Difference::unexplained), 0u);
    const ExactVisible exact = find_exact_visible(surfaces, e.view), by_backs = find_exact_visible(of_doubled, backs);
    for (std::size_t i = 0; i < exact.primitives.size(); ++i)
      ASSERT_EQ(exact.primitives[i],
                by_backs.primitives[i] == no_primitive ? no_primitive : by_backs.primitives[i] / 2);
    const Accounting found = account(surfaces, visible), expected = account(of_doubled, zbuffer(of_doubled, backs));
    for (std::size_t i = 0; i < found.objects.size(); ++i) {
      EXPECT_EQ(found.objects[i].alone.count, expected.objects[i].alone.count);
      EXPECT_EQ(found.objects[i].visible.count, expected.objects[i].visible.count);
    }
    std::map<PrimitiveId, double> areas;
    for (const VisibleFace& face : visible_faces(surfaces, e.view).faces) areas[face.id] += face.pixels;
    for (const VisibleFace& face : visible_faces(of_doubled, backs).faces) areas[face.id / 2] -= face.pixels;
    for (const auto& [id, difference] : areas) EXPECT_NEAR(difference, 0, 1e-6) << id;
    const std::vector<Explanation> reasons = explain_all(surfaces, visible, found);
    for (const Explanation& reason : reasons)
      EXPECT_EQ(reason.reason == SightReason::seen, found.objects[reason.object].visible.count > 0);
  }
}

TEST(Metamorphic, ACopyThatIsSeenFromBothSidesIsNoCopyOfAOneSidedTriangle) {
  // Thousands of copies of two triangles, seen from behind; the second one's material is double-sided.
  Mesh mesh;
  for (int i = 0; i < 5000; ++i)
    for (int k = 0; k < 2; ++k) add_triangle(mesh, {-9, -9, 0}, {0, 9, 0}, {9, -9, 0.1f});
  Scene scene = scene_of(std::move(mesh));
  scene.materials.resize(2);
  scene.materials[1].double_sided = true;
  for (std::uint32_t i = 0; i < 10000; ++i) scene.meshes[0].material_ids.push_back(i % 2);
  View view;
  view.width = view.height = 64;
  view.world_from_eye = look_at({0, 0, 2}, {0, 0, 0}, {0, 1, 0});
  view.projection = make_projection(0.9, 1, {0.1, 10});
  view.culling = Culling::material;
  for (const Method& method : methods) EXPECT_EQ(method.see(scene, view).primitives[32 * 64 + 32], 1u) << method.name;
}

TEST(Metamorphic, ARolledCameraIsATurnedPicture) {
  std::uint64_t differing = 0, all = 0;
  for (std::uint64_t seed = 0; seed < seeds(16); ++seed) {
    Example e = example(seed);
    e.view.samples = 1;
    e.view.height = e.view.width;
    if (e.view.projection.orthographic) e.view.projection = make_orthographic(-1.25, 1.25, -1.25, 1.25, {0.5, 6});
    if (!e.view.projection.orthographic) e.view.projection = make_projection(0.9, 1, e.view.projection.clip);
    // The camera rolls a quarter to the left: its right becomes its up.
    View rolled = e.view;
    rolled.world_from_eye[0] = e.view.world_from_eye[1];
    rolled.world_from_eye[1] = -e.view.world_from_eye[0];
    for (const Method& method : methods) {
      SCOPED_TRACE(testing::Message() << method.name << ", seed " << seed);
      const Visible straight = method.see(e.scene, e.view);
      const Visible seen = method.see(e.scene, rolled);
      const int last = e.view.width - 1;
      // Right in the new picture is up in the old one: x grows as y falls.
      const Visible back = turned_back(seen, e.view, [&](int x, int y) { return glm::ivec2(last - y, x); });
      expect_explained(e.scene, straight, back, differing, all);
    }
  }
  EXPECT_LT(differing * 100, all) << differing << " of " << all;
}

}  // namespace
}  // namespace frontmost::test
