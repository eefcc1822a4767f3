// SPDX-License-Identifier: Apache-2.0
// Shadows of a scene's own lights: their places by maps and by rays, and maps that are reused as long as they fit.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "frontmost/frontmost.h"
#include "shade/shadow/shadow_map.h"
#include "shade/support.h"
#include "support/allocation_count.h"
#include "support/costly_meshes.h"
#include "support/refusal.h"

namespace frontmost::test {
namespace {

constexpr double kRoof = 0.6;  ///< height

Light light_towards(Light::Kind kind, const glm::dvec3& place, const glm::dvec3& target, double intensity) {
  Light light;
  light.kind = kind;
  const glm::dvec3 along = target - place;
  const glm::dvec3 up = std::abs(along.z) > 0.9 * glm::length(along) ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1);
  light.world_from_light = look_at(place, target, up);
  light.intensity = intensity;
  return light;
}

/// A floor of side 4, with a square of side 1 floating over its middle.
Scene floor_and_roof(const std::vector<Light>& lights) {
  Scene scene = scene_of(square(), colored({0.8f, 0.8f, 0.8f, 1}));
  scene.instances[0].world_from_mesh = glm::dmat4(2.0);
  scene.instances[0].world_from_mesh[3] = {0, 0, 0, 1};
  scene.instances.push_back({"roof", 0, glm::dmat4(0.5)});
  scene.instances[1].world_from_mesh[3] = {0, 0, kRoof, 1};
  scene.lights = lights;
  return scene;
}

Image picture(const Scene& scene, const View& view, Shadows shadows, Lights lights = Lights::file) {
  const Surfaces surfaces(scene);
  return shade(surfaces, zbuffer(surfaces, view), {.light = {.shadows = shadows, .lights = lights}});
}

/// Distance by which the line from a floor point to the light misses the roof; negative if it passes through.
double beside_roof(const Light& light, const glm::dvec2& point) {
  const glm::dvec3 at(point, 0);
  const glm::dvec3 way = light.kind == Light::Kind::sun ? glm::dvec3(light.world_from_light[2])
                                                        : glm::dvec3(light.world_from_light[3]) - at;
  const glm::dvec2 hit = point + glm::dvec2(way) * (kRoof / way.z);
  return std::max(std::abs(hit.x), std::abs(hit.y)) - 0.5;
}

// A roof whose back faces the lights throws a shadow if its material is double-sided, or if culling ignores the
// material.
TEST(LampShadows, PassThroughTheBacksOfOneSidedMaterialsWhereTheEyeDoes) {
  const Light sun = light_towards(Light::Kind::sun, {0, 0, 0}, {1, 0.5, -1.4}, 2);
  const Light spot = light_towards(Light::Kind::spot, {-1.5, 1, 2.5}, {0, 0, 0}, 12);
  const Light point = light_towards(Light::Kind::point, {1, 1, 2}, {0, 0, 0}, 8);
  for (const Light& light : {sun, spot, point})
    for (const Shadows shadows : {Shadows::map, Shadows::rays})
      for (const Lights lights : {Lights::file, Lights::key}) {
        if (light.kind == Light::Kind::point && shadows == Shadows::map) continue;
        Scene scene = floor_and_roof({light});
        scene.meshes.push_back(scene.meshes[0]);
        scene.instances[1].mesh = 1;
        for (glm::uvec3& corners : scene.meshes[1].triangles) std::swap(corners.y, corners.z);
        scene.meshes[1].material_ids = {1};
        scene.materials.push_back(scene.materials[0]);
        View view = front_view(128);
        // Mean brightness of the floor; the roof hides the same part of the floor in all pictures.
        const auto brightness = [&](Culling culling, bool is_double_sided, Shadows kind) {
          scene.materials[1].double_sided = is_double_sided;
          view.culling = culling;
          const Image image = picture(scene, view, kind, lights);
          double sum = 0;
          for (int y = 0; y < 128; ++y)
            for (int x = 0; x < 128; ++x)
              if (x < 48 || x >= 80 || y < 48 || y >= 80) sum += double(color_at(image, x, y).g);
          return sum;
        };
        const double lit = brightness(Culling::none, false, Shadows::off);
        EXPECT_EQ(brightness(Culling::material, false, shadows), lit);
        EXPECT_LT(brightness(Culling::material, true, shadows), 0.99 * lit);
        EXPECT_LT(brightness(Culling::none, false, shadows), 0.99 * lit);
        EXPECT_LT(brightness(Culling::back, false, shadows), 0.99 * lit);
      }
}

TEST(LampShadows, FallWhereTheRoofStandsBeforeTheLight) {
  Light wide = light_towards(Light::Kind::spot, {0.5, -0.4, 1.9}, {0, 0, 0}, 6);
  wide.outer_cone = 1.45;  // 83 degrees: more than its map holds
  wide.inner_cone = 1.3;
  const std::vector<Light> lights = {light_towards(Light::Kind::sun, {0, 0, 0}, {1, 0.5, -1.4}, 2),
                                     light_towards(Light::Kind::sun, {0, 0, 0}, {0, 0, -1}, 2),
                                     light_towards(Light::Kind::spot, {-1.5, 1, 2.5}, {0, 0, 0}, 12),
                                     light_towards(Light::Kind::spot, {0, 0, 3}, {0, 0, 0}, 12),
                                     wide,
                                     light_towards(Light::Kind::point, {1, 1, 2}, {0, 0, 0}, 8)};
  const int size = 640;
  for (const Light& light : lights) {
    const Scene scene = floor_and_roof({light});
    const View view = front_view(size);
    const Image off = picture(scene, view, Shadows::off), none = picture(scene, view, Shadows::off, Lights::none);
    for (const Shadows shadows : {Shadows::map, Shadows::rays}) {
      if (light.kind == Light::Kind::point && shadows == Shadows::map) continue;
      const Image found = picture(scene, view, shadows);
      int in_shadow = 0, in_light = 0;
      for (int y = 3; y < size; y += 7)
        for (int x = 3; x < size; x += 7) {
          const glm::dvec2 point = glm::dvec2(x + 0.5, size - y - 0.5) * (4.0 / size) - 2.0;
          if (std::max(std::abs(point.x), std::abs(point.y)) > 1.97) continue;
          const bool is_roof = std::max(std::abs(point.x), std::abs(point.y)) < 0.51;
          const glm::vec4 lit = color_at(off, x, y), dark = color_at(none, x, y), is = color_at(found, x, y);
          if (is_roof) {
            if (std::max(std::abs(point.x), std::abs(point.y)) < 0.48) {
              ASSERT_EQ(is, lit) << "the roof shadows itself";
            }
            continue;
          }
          const double outside = beside_roof(light, point);
          if (std::abs(outside) < 0.07) continue;  // too close to the soft edge, or within the bias
          if (lit.x - dark.x < 0.01f) continue;    // outside the cone
          ASSERT_EQ(is, outside > 0 ? lit : dark) << x << ", " << y << ", kind " << int(light.kind);
          (outside > 0 ? in_light : in_shadow) += 1;
        }
      EXPECT_GT(in_light, 500) << int(light.kind);
      if (light.world_from_light[2].x != 0) {
        EXPECT_GT(in_shadow, 60) << int(light.kind);
      }
    }
  }
}

TEST(LampShadows, OfSeveralLightsAddUp) {
  const std::vector<Light> lights = {light_towards(Light::Kind::sun, {0, 0, 0}, {1, 0.5, -1.4}, 0.5),
                                     light_towards(Light::Kind::spot, {-1.5, 1, 2.5}, {0, 0, 0}, 3),
                                     light_towards(Light::Kind::spot, {1.2, 1.3, 2}, {0, 0, 0}, 3)};
  const View view = front_view(200);
  const Image none = picture(floor_and_roof({}), view, Shadows::map);
  const Image all = picture(floor_and_roof(lights), view, Shadows::map);
  std::vector<Image> single;
  for (const Light& light : lights) single.push_back(picture(floor_and_roof({light}), view, Shadows::map));
  for (int y = 0; y < view.height; ++y)
    for (int x = 0; x < view.width; ++x) {
      glm::vec4 sum = color_at(none, x, y);
      for (const Image& image : single) sum += color_at(image, x, y) - color_at(none, x, y);
      ASSERT_NEAR(color_at(all, x, y).x, sum.x, 1e-5) << x << ", " << y;
    }
}

TEST(LampShadows, BeyondTheSixteenthAreNotThereByMapsAndThereByRays) {
  std::vector<Light> lights(16, light_towards(Light::Kind::sun, {0, 0, 0}, {0.1, 0, -1}, 1e-6));
  lights.push_back(light_towards(Light::Kind::spot, {-1.5, 0, 2.5}, {0, 0, 0}, 9));
  const View view = front_view(200);
  const auto in_shadow = [&](const Scene& scene, Shadows shadows) {
    const Image off = picture(scene, view, Shadows::off), found = picture(scene, view, shadows);
    int count = 0;
    for (int i = 0; i < 200 * 200; ++i)
      count += color_at(found, i % 200, i / 200).x < color_at(off, i % 200, i / 200).x - 0.1f;
    return count;
  };
  EXPECT_EQ(in_shadow(floor_and_roof(lights), Shadows::map), 0);
  EXPECT_GT(in_shadow(floor_and_roof(lights), Shadows::rays), 200);
  lights.erase(lights.begin());
  EXPECT_GT(in_shadow(floor_and_roof(lights), Shadows::map), 200);
}

TEST(LampShadows, NothingIsSeenAndGlassThrowsNone) {
  const std::vector<Light> lights = {light_towards(Light::Kind::sun, {0, 0, 0}, {1, 0.5, -1.4}, 1),
                                     light_towards(Light::Kind::spot, {-1.5, 1, 2.5}, {0, 0, 0}, 3)};
  View away = front_view(32);
  away.world_from_eye = look_at({0, 0, 10}, {0, 0, 20}, {0, 1, 0});
  EXPECT_EQ(color_at(picture(floor_and_roof(lights), away, Shadows::map), 4, 4), glm::vec4(1));
  Scene nothing;
  nothing.lights = lights;
  EXPECT_EQ(color_at(picture(nothing, away, Shadows::map), 4, 4), glm::vec4(1));
  Scene glass = floor_and_roof(lights);
  glass.meshes.push_back(glass.meshes[0]);
  glass.meshes[1].material_ids = {1};
  glass.materials.push_back(colored({1, 1, 1, 0}));
  glass.materials[1].alpha = Material::Alpha::blend;
  glass.instances[1].mesh = 1;
  Scene bare = glass;
  bare.instances.pop_back();
  for (const Shadows shadows : {Shadows::map, Shadows::rays}) {
    const Image found = picture(glass, front_view(64), shadows), expected = picture(bare, front_view(64), shadows);
    for (int i = 0; i < 64 * 64; ++i)
      ASSERT_NEAR(color_at(found, i % 64, i / 64).x, color_at(expected, i % 64, i / 64).x, 1e-5);
  }
}

// ---- Maps that are reused ----

struct Flight {
  Scene scene = builtin("city");
  Surfaces surfaces;

  Flight() : surfaces(lit(scene)) {}
  /// A step forward and a small turn for every picture.
  [[nodiscard]] View view(int i) const {
    View view = frame(surfaces, 160, 120);
    view.world_from_eye = look_at(glm::dvec3(8 + 0.15 * i, 3, 25), {60 + 0.1 * i, 10, 5}, {0, 1, 0});
    return view.enclosing(surfaces.bounds());
  }

 private:
  static const Scene& lit(Scene& scene) {
    scene.lights = {light_towards(Light::Kind::sun, {0, 0, 0}, {1, -2, -0.5}, 2),
                    light_towards(Light::Kind::spot, {20, 30, 15}, {30, 0, 10}, 900)};
    return scene;
  }
};

TEST(LampShadows, MapsOfAFlightAreDrawnOnlyWhenTheSunsWindowNoLongerFits) {
  const Flight flight;
  Shader shader(flight.surfaces);
  std::size_t drawn = 0;
  const Watch watch{[&](std::string_view stage, double fraction) { drawn += stage == "visible" && fraction == 1; }, {}};
  const auto maps_for = [&](int i) {
    const Visible visible = zbuffer(flight.surfaces, flight.view(i));
    drawn = 0;
    shader.shade({.visible = &visible}, {.light = {.lights = Lights::file}}, {.threads = 1, .watch = &watch});
    return drawn;
  };
  EXPECT_EQ(maps_for(0), 2u) << "the sun's and the spot's";
  EXPECT_EQ(maps_for(0), 0u);
  std::size_t sum = 0;
  for (int i = 1; i < 40; ++i) sum += maps_for(i);
  EXPECT_LT(sum, 20u) << "of 39 pictures";
}

TEST(LampShadows, ASunsWindowHoldsWhatIsSeenAndIsOneOfFew) {
  const Flight flight;
  const Light& sun = flight.scene.lights[0];
  const glm::dmat3 light_from_world = glm::transpose(glm::dmat3(sun.world_from_light));
  for (int i = 0; i < 200; i += 13) {
    const Visible visible = zbuffer(flight.surfaces, flight.view(i));
    const std::optional<View> light = shading::view_of_sun(visible, flight.surfaces.bounds(), sun, {});
    ASSERT_TRUE(light);
    const ScreenRays rays(visible.view);
    for (int y = 0; y < visible.view.height; y += 4)
      for (int x = 0; x < visible.view.width; x += 4) {
        const std::size_t k = visible.index(x, y);
        if (visible.primitives[k] == no_primitive) continue;
        const double depth = double(depth_of_key(visible.view, visible.keys[k]));
        const glm::dvec3 world = visible.view.eye() + rays.point(x + 0.5, y + 0.5, depth);
        const glm::dvec3 at = light_from_world * (world - light->eye());
        ASSERT_TRUE(at.x > light->projection.left && at.x < light->projection.right);
        ASSERT_TRUE(at.y > light->projection.bottom && at.y < light->projection.top);
        ASSERT_LT(at.z, 0);
      }
  }
}

TEST(LampShadows, PicturesOneAfterAnotherAreThoseOfTheFunctionAndAllocateNothing) {
  const Flight flight;
  Shader shader(flight.surfaces);
  ZBuffer buffer;
  const void* planes = nullptr;
  const auto fly = [&](bool compares) {
    std::size_t count = 0;
    for (int i = 0; i < 60; i += 9) {
      const Visible& visible = buffer.draw(flight.surfaces, flight.view(i), {.threads = 1});
      const ShadeOptions options{.light = {.lights = Lights::both}};
      const std::size_t before = allocation_count();
      const Bitmap& bitmap = shader.shade_bitmap({.visible = &visible}, options, {.threads = 1});
      count += allocation_count() - before + (planes && bitmap.rgba.data() != planes);
      planes = bitmap.rgba.data();
      if (!compares) continue;
      const Bitmap expected = shade_bitmap(flight.surfaces, visible, options);
      EXPECT_EQ(std::memcmp(expected.rgba.data(), bitmap.rgba.data(), expected.rgba.size()), 0) << i;
    }
    return count;
  };
  fly(true);
  EXPECT_EQ(fly(false), 0u);
}

TEST(TooMuch, RaysOfFourThousandLights) {
  const std::vector<Light> lights(4000, light_towards(Light::Kind::sun, {0, 0, 0}, {0.1, 0, -1}, 1e-6));
  EXPECT_EQ(refusal_of(ErrorCode::limit_exceeded,
                       [&] { (void)picture(floor_and_roof(lights), front_view(512), Shadows::rays); }),
            "shade: shadows of 4000 lights by rays are more than 136314880 rays; ask for shadows by maps, for fewer "
            "lights or samples, or for a smaller picture");
}

TEST(TooMuch, TrianglesInThePlaneOfEveryRaysStart) {
  const Scene scene = scene_of(nested_sheets(5000));
  EXPECT_EQ(
      refusal_of(ErrorCode::limit_exceeded, [&] { (void)picture(scene, front_view(512), Shadows::rays, Lights::key); }),
      "shade: too many of 10000 triangles lie over each other for shadows by rays; ask for shadows by maps");
}

}  // namespace
}  // namespace frontmost::test
