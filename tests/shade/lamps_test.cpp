// SPDX-License-Identifier: Apache-2.0
// Light of lamps on fragments made by hand, and lights of a scene in pictures. The reference evaluates the extension's
// formulas one sample at a time, in doubles.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <memory>
#include <numbers>
#include <random>

#include "frontmost/zbuffer.h"
#include "shade/light/lighting.h"
#include "shade/support.h"
#include "support/refusal.h"
#include "support/seeds.h"

namespace frontmost::shading {
namespace {

using namespace test;

/// A light at a place that points along a direction.
Light light_at_place(Light::Kind kind, const glm::dvec3& place, const glm::dvec3& along, double intensity) {
  Light light;
  light.kind = kind;
  const glm::dvec3 up = std::abs(along.y) > 0.9 * glm::length(along) ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  light.world_from_light = look_at(place, place + along, up);
  light.intensity = intensity;
  return light;
}

/// Illuminance in lux at a point facing the light, by the extension, and the unit direction to the light.
struct Arriving {
  double lux;
  glm::dvec3 to_light;
};
Arriving arriving_at(const Light& light, const glm::dvec3& point) {
  const glm::dvec3 axis = -glm::dvec3(light.world_from_light[2]);
  if (light.kind == Light::Kind::sun) return {light.intensity, -axis};
  const glm::dvec3 to = glm::dvec3(light.world_from_light[3]) - point;
  const double distance = glm::length(to);
  double lux = light.intensity / (distance * distance);
  if (light.range) lux *= std::max(std::min(1 - std::pow(distance / *light.range, 4), 1.0), 0.0);
  if (light.kind == Light::Kind::spot) {
    const double scale = 1 / std::max(0.001, std::cos(light.inner_cone) - std::cos(light.outer_cone));
    const double cosine = glm::dot(axis, -to / distance);
    const double cone = std::clamp((cosine - std::cos(light.outer_cone)) * scale, 0.0, 1.0);
    lux *= cone * cone;
  }
  return {lux, to / distance};
}

/// The radiance towards v from glTF's metallic-roughness surface: appendix B, with Fresnel on the matt part and the
/// roughness as rendered.
glm::dvec3 sent_back(const Material& m, const glm::dvec3& n, const glm::dvec3& v, const Arriving& from) {
  const glm::dvec3 l = from.to_light, h = glm::normalize(l + v), base(m.base_color);
  const double n_l = std::max(glm::dot(n, l), 0.0), n_v = std::max(glm::dot(n, v), 1e-3), n_h = glm::dot(n, h);
  const double roughness = std::max(double(m.roughness), 0.09), a2 = std::pow(roughness, 4);
  const double d = a2 / (std::numbers::pi * std::pow(n_h * n_h * (a2 - 1) + 1, 2));
  const double visibility =
      0.5 / (n_l * std::sqrt(n_v * n_v * (1 - a2) + a2) + n_v * std::sqrt(n_l * n_l * (1 - a2) + a2));
  const double metallic = m.metallic, weight = std::pow(1 - glm::dot(v, h), 5);
  glm::dvec3 sum;
  for (int k = 0; k < 3; ++k) {
    const double f0 = 0.04 * (1 - metallic) + base[k] * metallic, fresnel = f0 + (1 - f0) * weight;
    const double matt = base[k] * (1 - metallic) / std::numbers::pi;
    sum[k] = from.lux * n_l * (matt * (1 - fresnel) + fresnel * d * visibility);
  }
  return sum;
}

/// A sun, point lights with and without a range, and spots with and without a soft edge, each with its own colour.
std::vector<Light> all_kinds() {
  std::vector<Light> lights = {light_at_place(Light::Kind::sun, {0, 0, 0}, {1, -0.5, -2}, 0.4),
                               light_at_place(Light::Kind::point, {-1.5, 1, 0.7}, {0, 0, -1}, 0.5),
                               light_at_place(Light::Kind::point, {1.2, 1.1, 0.5}, {0, 0, -1}, 0.6),
                               light_at_place(Light::Kind::spot, {1, -1, 1.5}, {-0.3, 0.1, -1}, 2),
                               light_at_place(Light::Kind::spot, {-1, -1.2, 1}, {0.2, 0.3, -1}, 1)};
  lights[2].range = 0.9;
  lights[3].inner_cone = 0.1, lights[3].outer_cone = 0.6;
  lights[4].inner_cone = lights[4].outer_cone = 0.4, lights[4].range = 3;
  for (std::size_t i = 0; i < lights.size(); ++i) lights[i].color = {1, 0.2f * float(i), 0.9f - 0.2f * float(i)};
  return lights;
}

Scene lit_floor(const std::vector<Light>& lights, const Material& material) {
  Scene scene = scene_of(square(), material);
  scene.instances[0].world_from_mesh = glm::dmat4(2.0);
  scene.instances[0].world_from_mesh[3] = {0, 0, 0, 1};
  scene.lights = lights;
  return scene;
}

Image lit_by_file(const Scene& scene, const View& view,
                  const ShadeOptions& options = {.light = {.shadows = Shadows::off}}) {
  const Surfaces surfaces(scene);
  ShadeOptions by_file = options;
  by_file.light.lights = Lights::file;
  return shade(surfaces, zbuffer(surfaces, view), by_file);
}

View slanted_view(int size) {
  View view = front_view(size);
  view.world_from_eye = look_at({1, -5, 7}, {0, 0, 0}, {0, 1, 0});
  view.projection = make_projection(0.7, 1, {1, 30});
  return view;
}

glm::dvec3 floor_point(const View& view, int x, int y) {
  const double half = view.projection.right;
  const glm::dvec3 ray = glm::dmat3(view.world_from_eye) * glm::dvec3(half * (2 * (x + 0.5) / view.width - 1),
                                                                      half * (1 - 2 * (y + 0.5) / view.height), -1);
  return view.eye() - ray * (view.eye().z / ray.z);
}

TEST(Lamps, PicturesAreTheSumOfWhatTheExtensionSaysOfEveryLight) {
  const std::vector<Light> lights = all_kinds();
  std::vector<std::vector<Light>> cases = {lights};
  for (const Light& light : lights) cases.push_back({light});
  for (const float metallic : {0.0f, 1.0f, 0.6f}) {
    Material material = colored({0.5f, 0.6f, 0.3f, 1});
    material.metallic = metallic, material.roughness = 0.55f;
    const View view = slanted_view(72);
    const Image dark = lit_by_file(lit_floor({}, material), view);
    for (const std::vector<Light>& some : cases) {
      const Image found = lit_by_file(lit_floor(some, material), view);
      double worst = 0, brightest = 0;
      for (int y = 0; y < view.height; ++y)
        for (int x = 0; x < view.width; ++x) {
          const glm::dvec3 point = floor_point(view, x, y), v = glm::normalize(view.eye() - point);
          if (std::max(std::abs(point.x), std::abs(point.y)) > 1.95) continue;
          glm::dvec3 expected(color_at(dark, x, y));
          for (const Light& light : some)
            expected += glm::dvec3(light.color) * sent_back(material, {0, 0, 1}, v, arriving_at(light, point));
          expected = glm::min(expected, glm::dvec3(1));
          const glm::dvec3 difference = glm::abs(glm::dvec3(color_at(found, x, y)) - expected);
          worst = std::max({worst, difference.x, difference.y, difference.z});
          brightest = std::max(brightest, glm::length(expected - glm::dvec3(color_at(dark, x, y))));
        }
      EXPECT_LT(worst, 2e-4) << some.size() << " lights, metallic " << metallic;
      EXPECT_GT(brightest, 0.05) << "nothing is lit";
    }
  }
}

TEST(Lamps, AWhiteMattSurfaceSendsBackLuxByPi) {
  Material white = colored({1, 1, 1, 1});
  white.roughness = 1;
  Material black = colored({0, 0, 0, 1});
  black.roughness = 1;
  // The highlight, which a black surface shows too, is subtracted; Fresnel leaves 0.96 of the matt part.
  for (const Light& light : {light_at_place(Light::Kind::sun, {0, 0, 0}, {0, 0, -1}, 2),
                             light_at_place(Light::Kind::point, {0, 0, 3}, {0, 0, -1}, 18),
                             light_at_place(Light::Kind::spot, {0, 0, 3}, {0, 0, -1}, 18)}) {
    const View view = front_view(65);
    const auto middle = [&](const std::vector<Light>& lights, const Material& material) {
      return double(color_at(lit_by_file(lit_floor(lights, material), view), 32, 32).x);
    };
    const double matt = middle({light}, white) - middle({}, white) - (middle({light}, black) - middle({}, black));
    EXPECT_NEAR(matt, 0.96 * 2 / std::numbers::pi, 1e-3) << int(light.kind);
  }
}

TEST(Lamps, KeyFileBothAndNoneAreWhatTheirNamesSay) {
  const Scene scene = lit_floor(all_kinds(), colored({0.3f, 0.3f, 0.3f, 1}));
  Scene without = scene;
  without.lights.clear();
  const View view = slanted_view(48);
  const Surfaces surfaces(scene), bare(without);
  const Visible visible = zbuffer(surfaces, view);
  const auto lit = [&](Lights lights) {
    return shade(surfaces, visible, {.light = {.shadows = Shadows::off, .lights = lights}});
  };
  const Image key = lit(Lights::key), file = lit(Lights::file), both = lit(Lights::both), none = lit(Lights::none);
  const Image bare_key = shade(bare, visible, {.light = {.shadows = Shadows::off}});
  for (int y = 0; y < view.height; ++y)
    for (int x = 0; x < view.width; ++x) {
      ASSERT_EQ(color_at(key, x, y), color_at(bare_key, x, y)) << "the file's lights count unasked";
      // The key light's box is mirrored too, so the test compares the difference that the file's lights make.
      const glm::vec4 by_file = color_at(file, x, y) - color_at(none, x, y);
      const glm::vec4 added = color_at(both, x, y) - color_at(key, x, y);
      for (int k = 0; k < 3; ++k) ASSERT_TRUE(color_at(both, x, y)[k] >= 1 || std::abs(by_file[k] - added[k]) < 1e-5f);
    }
  EXPECT_NE(color_at(key, 24, 24), color_at(none, 24, 24));
}

/// Fragments at random points about the world's origin, with the direction from the eye.
std::unique_ptr<FragmentBatch> strewn(int count, double spread, const glm::dvec3& eye, std::mt19937& random) {
  std::uniform_real_distribution<double> both(-spread, spread);
  auto batch = std::make_unique<FragmentBatch>();
  batch->coverage.count = count;
  for (int i = 0; i < count; ++i)
    batch->geometry.position.set(i, glm::dvec3(both(random), both(random), both(random)) - eye);
  return batch;
}

TEST(Lamps, WhatArrivesIsTheExtensionsFormulaOnEveryInstructionSet) {
  std::mt19937 random(test::noted_seed(7));
  const glm::dvec3 eye(3, -2, 5);
  PictureLights lights;
  const std::vector<Light> all = all_kinds();
  lights.set(nullptr, all, eye);
  ASSERT_EQ(lights.near.size(), 4u);
  ASSERT_EQ(lights.far.size(), 1u);
  for (const PictureLights::Near& near : lights.near) {
    const auto batch = strewn(201, 2, eye, random);
    const auto expected = std::make_unique<LampLight>(), found = std::make_unique<LampLight>();
    find_lamp_light(near.lamp, *batch, *expected, Isa::best);
    int lit = 0;
    for (int i = 0; i < batch->coverage.count; ++i) {
      const Arriving arriving = arriving_at(*near.source, glm::dvec3(batch->geometry.position.at(i)) + eye);
      const double part = arriving.lux / near.source->intensity;
      // A cone without a soft edge is a thousandth of a cosine wide, which floats resolve to a thousandth.
      ASSERT_NEAR(expected->part[i], part, (1e-5 + 1e-6 * double(near.lamp.cone_scale)) * (1 + part));
      ASSERT_LT(glm::distance(glm::dvec3(expected->to_lamp.at(i)), arriving.to_light), 1e-5);
      lit += part > 0;
    }
    EXPECT_GT(lit, 0);
    for (const Isa isa : available_isas()) {
      find_lamp_light(near.lamp, *batch, *found, isa);
      for (int i = 0; i < batch->coverage.count; ++i) {
        ASSERT_EQ(found->to_lamp.at(i), expected->to_lamp.at(i)) << name(isa);
        ASSERT_EQ(found->part[i], expected->part[i]) << name(isa);
      }
    }
  }
}

TEST(Lamps, ABoxThatALampDoesNotReachHoldsNoLight) {
  std::mt19937 random(test::noted_seed(5));
  std::uniform_real_distribution<double> unit(0, 1), both(-4, 4);
  int passed_over = 0, lit = 0;
  const auto arriving = std::make_unique<LampLight>();
  for (int round = 0; round < 4000; ++round) {
    Light light =
        light_at_place(unit(random) < 0.3 ? Light::Kind::point : Light::Kind::spot,
                       {both(random), both(random), both(random)}, {both(random), both(random), both(random)}, 1);
    if (unit(random) < 0.6) light.range = 3 * unit(random) + 0.01;
    light.outer_cone = std::pow(unit(random), 2) * 1.57 + 0.001;
    light.inner_cone = unit(random) * light.outer_cone;
    PictureLights lights;
    lights.set(nullptr, {&light, 1}, glm::dvec3(0));
    const auto batch = strewn(64, 0.2 + unit(random), glm::dvec3(0), random);
    const bool reaches = may_reach(lights.near[0].lamp, bounds_of(*batch));
    find_lamp_light(lights.near[0].lamp, *batch, *arriving, Isa::best);
    bool any = false;
    for (int i = 0; i < batch->coverage.count; ++i) any |= arriving->part[i] > 0;
    ASSERT_TRUE(reaches || !any) << round;
    passed_over += !reaches;
    lit += any;
  }
  EXPECT_GT(passed_over, 1500);
  EXPECT_GT(lit, 300);
}

TEST(Lamps, ARangeThatIsNextToNothingReachesNothing) {
  std::mt19937 random(test::noted_seed(3));
  Light light = light_at_place(Light::Kind::point, {0, 0, 0}, {0, 0, -1}, 1);
  light.range = 1e-60;
  PictureLights lights;
  lights.set(nullptr, {&light, 1}, glm::dvec3(0));
  const auto batch = strewn(64, 2, glm::dvec3(0), random);
  const auto arriving = std::make_unique<LampLight>();
  find_lamp_light(lights.near[0].lamp, *batch, *arriving, Isa::best);
  for (int i = 0; i < batch->coverage.count; ++i) EXPECT_EQ(arriving->part[i], 0.0f);
}

TEST(Lamps, DarkOnesDoNotCountAndTooManyAreRefused) {
  std::vector<Light> lights(4096, light_at_place(Light::Kind::point, {0, 0, 1}, {0, 0, -1}, 1));
  lights[3].intensity = 0;
  lights[5].color = glm::vec3(0);
  PictureLights counting;
  counting.set(nullptr, lights, glm::dvec3(0));
  EXPECT_EQ(counting.near.size(), 4094u);
  lights.push_back(lights[0]);
  EXPECT_EQ(refusal_of(ErrorCode::limit_exceeded, [&] { counting.set(nullptr, lights, glm::dvec3(0)); }),
            "shade: 4097 lights are more than 4096");
  // These lights are no error if only the key light counts.
  const Scene scene = lit_floor(lights, {});
  const Surfaces surfaces(scene);
  const Visible visible = zbuffer(surfaces, front_view());
  EXPECT_NO_THROW((void)shade(surfaces, visible));
  EXPECT_THROW((void)shade(surfaces, visible, {.light = {.lights = Lights::both}}), Error);
}

TEST(Lamps, AnyNumbersGiveColoursBetweenZeroAndOne) {
  for (const double intensity : {1e-300, 1e30, 1.7e308})
    for (const glm::dvec3 place : {glm::dvec3(0), glm::dvec3(0.1, 0.1, 1e-9), glm::dvec3(1e12, 0, 1e12)})
      for (const Light::Kind kind : {Light::Kind::sun, Light::Kind::point, Light::Kind::spot}) {
        Light light = light_at_place(kind, place, {0, 0, -1}, intensity);
        light.color = glm::vec3(1, 3e38f, 0);
        light.range = 1e300;
        Material smooth = colored({1, 1, 1, 1});
        smooth.roughness = 0, smooth.metallic = 1;
        for (const Shadows shadows : {Shadows::off, Shadows::map, Shadows::rays}) {
          const Image image =
              lit_by_file(lit_floor({light}, smooth), slanted_view(24), {.light = {.shadows = shadows}});
          for (const Channel& channel : image.channels)
            for (const float value : channel.floats()) ASSERT_TRUE(value >= 0 && value <= 1) << value;
        }
      }
}

TEST(Lamps, PicturesAreTheSameForAllThreadsAndInstructionSets) {
  Scene scene = builtin("gallery");
  const Surfaces bare(scene);
  const glm::dvec3 middle(bare.bounds().centre());
  scene.lights = all_kinds();
  for (Light& light : scene.lights)
    light.world_from_light[3] += glm::dvec4(middle + glm::dvec3(0, 2, 0), 0), light.intensity *= 20;
  const Surfaces surfaces(scene);
  const Visible visible = zbuffer(surfaces, frame(surfaces, 160, 120));
  for (const Shadows shadows : {Shadows::off, Shadows::map, Shadows::rays}) {
    const ShadeOptions options{.light = {.shadows = shadows, .lights = Lights::both}};
    const Image expected = shade(surfaces, visible, options, {.threads = 1});
    for (const Isa isa : available_isas())
      for (const int threads : {1, 4}) {
        const Image found = shade(surfaces, visible, options, {.threads = threads, .isa = isa});
        for (std::size_t k = 0; k < expected.channels.size(); ++k) {
          const Buffer<float>&a = expected.channels[k].floats(), &b = found.channels[k].floats();
          ASSERT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(float)), 0) << name(isa) << ", " << threads;
        }
      }
  }
}

}  // namespace
}  // namespace frontmost::shading
