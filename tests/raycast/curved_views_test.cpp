// SPDX-License-Identifier: Apache-2.0
// Two roads to a picture of curved surfaces: rays that meet them, and triangles as fine as is asked for in a z-buffer.
// And the pictures that are made of what rays have met.
#include <gtest/gtest.h>

#include <cmath>

#include "frontmost/curved.h"
#include "frontmost/shade.h"
#include "frontmost/tessellate.h"
#include "frontmost/zbuffer.h"
#include "raycast/curved/curved_parts.h"
#include "raycast/curved/double_ray.h"
#include "scene/shapes.h"

namespace frontmost::test {
namespace {

/// The object of an element; no_index for none.
std::uint32_t object_of(const CurvedIndex& index, PrimitiveId id) {
  return id == no_primitive ? no_index : index.source(id).instance;
}

/// Whether a ray that passes a pixel's centre within `pixels` sees another object than this, or nothing instead of it.
bool has_outline_beside(const CurvedIndex& index, const View& view, const glm::ivec2& pixel, double pixels,
                        std::uint32_t object) {
  const raycast_detail::ViewRays rays(view);
  for (int ring = 1; ring <= 4; ++ring)
    for (int k = 0; k < 32; ++k) {
      const double radius = 256 * pixels * ring / 4, angle = k * 0.19634954084936207;
      const glm::ivec2 offset(128 + int(radius * std::cos(angle)), 128 + int(radius * std::sin(angle)));
      raycast_detail::DoubleRay ray = rays.at(pixel.x, pixel.y, offset);
      if (object_of(index, index.parts().nearest(ray).primitive) != object) return true;
    }
  return false;
}

/// Pixels where one sees something and the other nothing; each is within `pixels` of the true outline of what is seen
/// there. (Not of all together: between two objects whose images just overlap, coarse triangles may leave a gap.)
std::size_t expect_outlines_near(const CurvedIndex& index, const Visible& exact, const Visible& cut, double pixels) {
  constexpr double kSnapping = 1.0 / 128;
  std::size_t differing = 0;
  const View& view = exact.view;
  for (int y = 0; y < view.height; ++y)
    for (int x = 0; x < view.width; ++x) {
      const std::size_t at = exact.index(x, y);
      if ((exact.primitives[at] == no_primitive) == (cut.primitives[at] == no_primitive)) continue;
      ++differing;
      const std::uint32_t object = object_of(index, exact.primitives[at]);
      EXPECT_TRUE(has_outline_beside(index, view, {x, y}, pixels + kSnapping, object)) << x << ", " << y;
    }
  return differing;
}

TEST(CurvedViews, OfTheZBufferHaveTheirOutlinesWithinThePixelsAskedFor) {
  for (const char* name : {"teapot", "spheres"}) {
    const Scene scene = builtin(name);
    Scene curved = scene;  // without what is flat: its edges are drawn alike
    for (Mesh& mesh : curved.meshes)
      if (!mesh.is_curved()) mesh = Mesh();
    const Surfaces surfaces(curved);
    const CurvedIndex index(curved);
    for (const bool orthographic : {false, true}) {
      FrameOptions options;
      options.orthographic = orthographic;
      const View view = frame(surfaces, 320, 240, options);
      const Visible exact = raycast(index, view).visible;
      std::size_t before = view.pixel_count(), most = 0;
      for (const double pixels : {2.0, 0.5, 0.1}) {
        SCOPED_TRACE(testing::Message() << name << ", " << pixels << " pixels");
        const Scene cut = tessellate(curved, view, pixels);
        const Surfaces triangles(cut);
        const std::size_t differing = expect_outlines_near(index, exact, zbuffer(triangles, view), pixels);
        EXPECT_LE(differing, before);
        before = differing;
        most = std::max(most, differing);
        RecordProperty(std::string(name) + (orthographic ? " parallel " : " ") + std::to_string(pixels),
                       std::to_string(differing));
      }
      EXPECT_GT(most, 100u);
      EXPECT_LT(before, most / 10);  // in proportion it would be a twentieth
    }
  }
}

/// Every ray of a view alone, among curved surfaces only, against what packets of them gave.
void expect_single_rays(const Scene& scene, const View& view, Isa isa) {
  const CurvedIndex index(scene);
  const CurvedVisible seen = raycast(index, view, {.threads = 1, .isa = isa});
  const raycast_detail::ViewRays rays(view);
  for (int y = 0; y < view.height; ++y)
    for (int x = 0; x < view.width; ++x) {
      const std::size_t at = seen.visible.index(x, y);
      raycast_detail::DoubleRay ray = rays.at(x, y, sample_offsets(1)[0]);
      const CurvedHit hit = index.parts().nearest(ray);
      ASSERT_EQ(seen.visible.primitives[at], hit.primitive) << x << ", " << y;
      if (!hit) continue;
      ASSERT_EQ(seen.visible.keys[at], rays.key(hit.t));
      ASSERT_EQ(seen.parameters[at], glm::vec2(hit.parameters));
      ASSERT_EQ(seen.normals[at], glm::vec3(hit.normal));
    }
}

TEST(CurvedViews, ByPacketsAreThoseOfSingleRaysToTheBit) {
  Scene scene = builtin("teapot");
  scene.meshes[0].spheres = {{{0.5, 3, 0.5}, 0.7}, {{0, 1, 2}, 0.5}};
  const Surfaces surfaces(scene);
  for (const Isa isa : available_isas()) {
    View view = frame(surfaces, 75, 50);  // no multiple of eight
    expect_single_rays(scene, view, isa);
    view.culling = Culling::back;
    expect_single_rays(scene, view, isa);
    view.culling = Culling::front;
    view.world_from_eye = look_at({0.1, 1.2, 0}, {1, 1.3, 0.4}, {0, 1, 0});
    expect_single_rays(scene, view, isa);
    view.projection = make_orthographic(-4, 4, -3, 3, {0.1, 20});
    view.culling = Culling::none;
    expect_single_rays(scene, view, isa);
  }
}

TEST(CurvedViews, CullByTheMaterialOfEachMesh) {
  // Seen from the middle of both: the inner one lets the rays pass unless it is double-sided.
  Scene scene;
  for (const double radius : {2.0, 3.0}) {
    Mesh& ball = scene.meshes.emplace_back();
    ball.spheres = {{{0, 0, 0}, radius}};
    ball.material_ids = {std::uint32_t(scene.instances.size())};
    scene.instances.push_back({"ball", std::uint32_t(scene.instances.size()), glm::dmat4(1.0)});
  }
  scene.materials.resize(2);
  View view = make_view(glm::radians(60.0), 16, 16);
  view.culling = Culling::material;
  const auto middle = [&](bool inner, bool outer) {
    scene.materials[0].double_sided = inner;
    scene.materials[1].double_sided = outer;
    return raycast(CurvedIndex(scene), view).visible.primitives[8 * 16 + 8];
  };
  EXPECT_EQ(middle(true, true), 0u);
  EXPECT_EQ(middle(false, true), 1u);
  EXPECT_EQ(middle(true, false), 0u);
  EXPECT_EQ(middle(false, false), no_primitive);
}

TEST(CurvedViews, ShowWhatLiesInFront) {
  // A sphere half sunk into a box: triangles and sphere hide each other.
  Scene scene;
  scene.meshes.push_back(box({-1, -1, -1}, {1, 1, 1}));
  Mesh& ball = scene.meshes.emplace_back();
  ball.spheres = {{{0, 0, 0}, 1.2}};
  scene.instances = {{"box", 0, glm::dmat4(1.0)}, {"ball", 1, glm::dmat4(1.0)}};
  View view;
  view.width = view.height = 65;
  view.world_from_eye = look_at({0, 0, 9}, {0, 0, 0}, {0, 1, 0});
  view.projection = make_orthographic(-2, 2, -2, 2, {1, 20});
  const CurvedVisible seen = raycast(CurvedIndex(scene), view);
  const std::size_t middle = seen.visible.index(32, 32), corner = seen.visible.index(18, 18);
  EXPECT_EQ(seen.visible.primitives[middle], 12u);
  EXPECT_NEAR(depth_of_key(view, seen.visible.keys[middle]), 9 - 1.2, 1e-5);
  EXPECT_LT(seen.visible.primitives[corner], 12u);
  EXPECT_NEAR(depth_of_key(view, seen.visible.keys[corner]), 8, 1e-5);
}

/// How much two pictures differ on the average, over R, G and B.
double mean_difference(const Image& a, const Image& b) {
  double sum = 0;
  for (const char* name : {"R", "G", "B"}) {
    const auto one = a.find(name)->floats();
    const auto other = b.find(name)->floats();
    for (std::size_t i = 0; i < one.size(); ++i) sum += std::abs(one[i] - other[i]);
  }
  return sum / double(3 * a.find("R")->floats().size());
}

TEST(Facets, ShadeAsAFineTessellationDoes) {
  for (const char* name : {"teapot", "spheres"}) {
    const Scene scene = builtin(name);
    const Surfaces surfaces(scene);
    View view = frame(surfaces, 160, 120);
    const CurvedIndex index(scene);
    const std::vector<CurvedVisible> seen{raycast(index, view)};
    const Facets shown = facets_of(index, scene, seen);
    const Surfaces facet_surfaces(shown.scene);
    const Scene cut = tessellate(scene, view, 0.02);
    const Surfaces cut_surfaces(cut);
    const Visible fine = zbuffer(cut_surfaces, view);
    for (const Shading shading : {Shading::normals, Shading::flat, Shading::uv, Shading::ids, Shading::depth}) {
      SCOPED_TRACE(testing::Message() << name << ", shading " << int(shading));
      const ShadeOptions options{.shading = shading, .shadows = Shadows::off};
      const Image a = shade(facet_surfaces, shown.visible[0], options), b = shade(cut_surfaces, fine, options);
      EXPECT_LT(mean_difference(a, b), 0.003);
    }
    // Objects and materials are the scene's own.
    for (std::size_t i = 0; i < view.pixel_count(); ++i) {
      const PrimitiveId facet = shown.visible[0].primitives[i], element = seen[0].visible.primitives[i];
      ASSERT_EQ(facet == no_primitive, element == no_primitive);
      if (facet == no_primitive) continue;
      EXPECT_EQ(shown.elements[facet], element);
      EXPECT_EQ(facet_surfaces.source(facet).instance, index.source(element).instance);
      EXPECT_EQ(shown.visible[0].keys[i], seen[0].visible.keys[i]);
    }
  }
}

TEST(Facets, AreSharedByTheSamplesOfAPixel) {
  const Scene scene = builtin("teapot");
  const Surfaces surfaces(scene);
  View view = frame(surfaces, 80, 60);
  const CurvedIndex index(scene);
  const std::vector<CurvedVisible> one{raycast(index, view)};
  view.samples = 8;
  const std::vector<CurvedVisible> eight{raycast(index, view)};
  const std::size_t triangles = surfaces.primitive_count();
  const std::size_t few = facets_of(index, scene, one).elements.size() - triangles;
  const std::size_t many = facets_of(index, scene, eight).elements.size() - triangles;
  EXPECT_GE(many, few);
  EXPECT_LT(many, 2 * few);
}

TEST(Facets, KeepMirroredSurfacesOutsideOut) {
  Scene scene;
  scene.meshes.push_back(sphere(16));
  glm::dmat4 mirrored(1.0);
  mirrored[0][0] = -1;
  scene.instances = {{"ball", 0, mirrored}};
  View view;
  view.width = view.height = 32;
  view.world_from_eye = look_at({0, 0, 5}, {0, 0, 0}, {0, 1, 0});
  view.projection = make_projection(glm::radians(30.0), 1, {1, 20});
  view.culling = Culling::back;
  const CurvedIndex index(scene);
  const std::vector<CurvedVisible> seen{raycast(index, view)};
  const Facets shown = facets_of(index, scene, seen);
  const Surfaces surfaces(shown.scene);
  const Image normals = normal_image(surfaces, shown.visible[0]);
  EXPECT_GT(normals.find("N.Z")->floats()[16 * 32 + 16], 0.99f);
  // The triangles beside the facets face outwards too: nothing of a closed surface is lost by culling.
  EXPECT_EQ(zbuffer(surfaces, view).primitives[16 * 32 + 16] != no_primitive, true);
}

}  // namespace
}  // namespace frontmost::test
