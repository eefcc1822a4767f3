// SPDX-License-Identifier: Apache-2.0
// Material layers against their formulas, one fragment at a time in doubles: KHR_materials_ior, _specular, _sheen and
// _clearcoat over glTF 2.0's metallic-roughness (appendix B), under one directional light.
#include <gtest/gtest.h>

#include <cmath>

#include "frontmost/pictures.h"
#include "frontmost/zbuffer.h"
#include "shade/light/albedo.h"
#include "shade/light/lighting.h"
#include "shade/material/materials.h"
#include "shade/support.h"

namespace frontmost::shading {
namespace {

using namespace test;

constexpr double kPi = 3.14159265358979323846;

/// One fragment and its material parameters.
struct Sample {
  glm::dvec3 normal, coat_normal, to_viewer, to_light, base;
  double metallic, roughness;
  double ior, specular;
  glm::dvec3 specular_color;
  double coat, coat_roughness;
  glm::dvec3 sheen;
  double sheen_roughness;
};

double positive(double v) { return std::max(v, 0.0); }
double fifth(double c) { return std::pow(1 - std::clamp(c, 0.0, 1.0), 5); }

/// Trowbridge-Reitz distribution times visibility, with Smith's correlated masking.
double ggx(const glm::dvec3& n, const glm::dvec3& v, const glm::dvec3& l, double roughness) {
  const glm::dvec3 h = glm::normalize(v + l);
  const double a2 = std::pow(roughness, 4), nh = positive(glm::dot(n, h));
  const double nl = positive(glm::dot(n, l)), nv = positive(glm::dot(n, v));
  const double d = a2 / (kPi * std::pow(nh * nh * (a2 - 1) + 1, 2));
  return d * 0.5 / (nl * std::sqrt(nv * nv * (1 - a2) + a2) + nv * std::sqrt(nl * nl * (1 - a2) + a2));
}

double sheen_lobe(double nl, double nv, double nh, double roughness) {
  const double a = roughness * roughness;
  const double d = (2 + 1 / a) * std::pow(1 - nh * nh, 0.5 / a) / (2 * kPi);
  return d / (4 * (nl + nv - nl * nv));
}

/// Albedo of the sheen by a sum over light directions.
double sheen_albedo_of(double nv, double roughness) {
  constexpr int steps = 120;
  const double across = std::sqrt(1 - nv * nv);
  double sum = 0;
  for (int i = 0; i < steps; ++i)
    for (int k = 0; k < steps; ++k) {
      const double nl = (i + 0.5) / steps, angle = (k + 0.5) / steps * kPi, out = std::sqrt(1 - nl * nl);
      const glm::dvec3 h = glm::normalize(glm::dvec3(across + out * std::cos(angle), out * std::sin(angle), nv + nl));
      sum += sheen_lobe(nl, nv, h.z, roughness) * nl * 2 * kPi;
    }
  return std::min(sum / (steps * steps), 1.0);
}

/// Reflected radiance for a light that a white matt surface reflects as 1.
glm::dvec3 sent_back(const Sample& s) {
  const glm::dvec3 h = glm::normalize(s.to_viewer + s.to_light);
  const double vh = glm::dot(s.to_viewer, h), nl = positive(glm::dot(s.normal, s.to_light));
  const double nv = glm::dot(s.normal, s.to_viewer);
  const double straight = std::pow((s.ior - 1) / (s.ior + 1), 2);
  glm::dvec3 fresnel;
  for (int c = 0; c < 3; ++c) {
    const double dielectric = std::min(straight * s.specular_color[c], 1.0) * s.specular;
    const double f0 = dielectric + (s.base[c] - dielectric) * s.metallic;
    const double f90 = s.specular + (1 - s.specular) * s.metallic;
    fresnel[c] = f0 + (f90 - f0) * fifth(vh);
  }
  const double most = std::max({fresnel.x, fresnel.y, fresnel.z});
  const glm::dvec3 matt = s.base * (1 - s.metallic) * (1 - most) / kPi;
  glm::dvec3 sum = kPi * nl * (matt + fresnel * ggx(s.normal, s.to_viewer, s.to_light, s.roughness));
  const double nh = glm::dot(s.normal, h);
  sum *= 1 - std::max({s.sheen.x, s.sheen.y, s.sheen.z}) * sheen_albedo_of(nv, s.sheen_roughness);
  if (nl > 0) sum += kPi * nl * s.sheen * sheen_lobe(nl, nv, nh, s.sheen_roughness);
  const double coat_nl = positive(glm::dot(s.coat_normal, s.to_light));
  const double coat_nv = glm::dot(s.coat_normal, s.to_viewer);
  sum *= 1 - s.coat * (0.04 + 0.96 * fifth(coat_nv));
  const double varnish = (0.04 + 0.96 * fifth(vh)) * ggx(s.coat_normal, s.to_viewer, s.to_light, s.coat_roughness);
  return sum + kPi * coat_nl * s.coat * varnish;
}

glm::dvec3 random_direction(Random& random, double least_z) {
  for (;;) {
    const glm::dvec3 p(random.point(1));
    const double length = glm::length(p);
    if (length < 1 && length > 0.1 && p.z / length > least_z) return p / length;
  }
}

glm::dvec3 random_color(Random& random) { return glm::abs(glm::dvec3(random.point(1))); }

/// A random sample; the bits of `kind` select its layers.
Sample random_sample(Random& random, int kind) {
  Sample s{};
  s.normal = {0, 0, 1};
  s.to_viewer = random_direction(random, 0.35);
  s.to_light = random_direction(random, -0.2);
  s.base = random_color(random);
  s.metallic = random.below(3) == 0 ? double(random.unit()) : double(random.below(2));
  s.roughness = double(random.within(0.3f, 1));
  s.ior = 1.5;
  s.specular = 1;
  s.specular_color = glm::dvec3(1);
  s.coat_normal = s.normal;
  s.coat_roughness = 1;
  s.sheen_roughness = 1;
  if (kind & 1) {
    s.ior = double(random.within(1, 3));
    s.specular = double(random.unit());
    s.specular_color = 2.0 * random_color(random);
  }
  if (kind & 2) {
    s.coat = double(random.unit());
    s.coat_roughness = double(random.within(0.3f, 1));
    s.coat_normal = glm::normalize(glm::dvec3(0, 0, 1) + 0.2 * glm::dvec3(random.point(1)));
  }
  if (kind & 4) {
    s.sheen = random_color(random);
    s.sheen_roughness = double(random.within(0.25f, 1));
  }
  return s;
}

/// Set-up of a single triangle in front of the eye, to which all fragments belong.
const std::vector<TriangleSetup> one_setup(1);

/// Parameter value that yields this rendered roughness.
float as_given(double roughness) { return float(roughness); }

/// Fills a fragment through the interface that pictures use.
void fill(const Sample& s, int i, FragmentBatch& batch) {
  batch.geometry.normal.set(i, glm::vec3(s.normal));
  batch.geometry.to_viewer.set(i, glm::vec3(s.to_viewer));
  batch.material.base.set(i, glm::vec3(s.base));
  batch.material.emissive.set(i, glm::vec3(0));
  batch.material.metallic[i] = float(s.metallic);
  batch.material.roughness[i] = as_given(s.roughness);
  batch.material.occlusion[i] = 1;
  batch.material.unlit[i] = 0;
  batch.material.alpha[i] = 1;
  batch.shadow[i] = 1;
  Material m;
  m.ior = float(s.ior);
  m.specular.factor = float(s.specular);
  m.specular.color = glm::vec3(s.specular_color);
  m.clearcoat.factor = float(s.coat);
  m.clearcoat.roughness = as_given(s.coat_roughness);
  m.sheen.color = glm::vec3(s.sheen);
  m.sheen.roughness = float(s.sheen_roughness);
  const std::unique_ptr<LayerRow> row = layers_of(m);
  if (!row) return;
  const std::vector<float> scales{1};
  LayerRun run(m, *row, {one_setup, scales}, batch);
  run.fill_factors(i, i + 1);
  if (row->has_coat) batch.coat->geometry.normal.set(i, glm::vec3(s.coat_normal));
  run.settle(i, i + 1);
}

void light_once(const glm::dvec3& to_light, FragmentBatch& batch, Isa isa) {
  begin_light(batch);
  add_direct_light({.to_light = glm::vec3(to_light), .color = glm::vec3(1)}, batch, isa);
  lay_layers_over(batch);
}

TEST(MaterialLayers, AreTheFormulasOfTheirExtensions) {
  for (int kind = 0; kind < 8; ++kind) {
    Random random(std::uint64_t(kind) + 1);
    double worst = 0;
    for (int repeat = 0; repeat < 150; ++repeat) {
      const Sample s = random_sample(random, kind);
      const auto batch = std::make_unique<FragmentBatch>();
      batch->coverage.count = 1;
      fill(s, 0, *batch);
      light_once(s.to_light, *batch, Isa::best);
      // Materials without layers keep the formula of appendix B, which subtracts the mirrored part of every channel;
      // partly metallic ones are skipped.
      if (kind % 2 == 0 && s.metallic > 0 && s.metallic < 1) continue;
      const glm::dvec3 wanted = sent_back(s), found(batch->light.at(0));
      // Values are compared up to 1, the brightest that a picture can show.
      for (int c = 0; c < 3; ++c) worst = std::max(worst, std::abs(std::min(wanted[c], 1.0) - std::min(found[c], 1.0)));
    }
    EXPECT_LT(worst, 1.0 / 255) << kind;
  }
}

// White furnace: surfaces that absorb nothing reflect all incoming light. The varnish is smooth, so its loss depends on
// the view direction alone; for a rough one it would be a mean over directions.
TEST(MaterialLayers, InAFurnaceEverySurfaceVanishes) {
  Image picture{64, 32, {}};
  for (const char* name : {"R", "G", "B"}) picture.channels.push_back({name, Buffer<float>(64 * 32, 0.5f)});
  const Environment environment(std::move(picture));
  const Lighting lighting = lighting_for(View(), Axis::y, {.environment = environment}, environment);
  Random random(5);
  for (int repeat = 0; repeat < 300; ++repeat) {
    Sample s = random_sample(random, repeat % 8);
    s.base = glm::dvec3(1);
    s.metallic = 0;
    s.sheen = glm::dvec3(s.sheen.x);
    s.specular_color = glm::dvec3(s.specular_color.x);
    s.coat_normal = s.normal;
    s.coat_roughness = 0.1;
    const auto batch = std::make_unique<FragmentBatch>();
    batch->coverage.count = 1;
    fill(s, 0, *batch);
    begin_light(*batch);
    add_surroundings(lighting.around, *batch, Isa::best);
    lay_layers_over(*batch);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(batch->light.at(0)[c], 0.5f, 0.01f) << repeat;
  }
}

// Layers of one fragment in a batch do not change the others, to the bit.
TEST(MaterialLayers, OthersInTheBatchStayWhatTheyAre) {
  Random random(77);
  const auto mixed = std::make_unique<FragmentBatch>(), plain = std::make_unique<FragmentBatch>();
  mixed->coverage.count = plain->coverage.count = batch_capacity;
  for (int i = 0; i < batch_capacity; ++i) {
    const Sample s = random_sample(random, 0);
    fill(s, i, *plain);
    fill(i % 3 == 0 ? random_sample(random, 1 + i % 7) : s, i, *mixed);
  }
  for (const Isa isa : available_isas()) {
    const glm::dvec3 to_light = glm::normalize(glm::dvec3(1, 2, 3));
    light_once(to_light, *mixed, isa);
    light_once(to_light, *plain, isa);
    for (int i = 0; i < batch_capacity; ++i)
      if (i % 3 != 0) {
        ASSERT_EQ(mixed->light.at(i), plain->light.at(i)) << name(isa) << ", " << i;
      }
  }
}

TEST(MaterialLayers, EveryInstructionSetComputesTheSame) {
  Random random(78);
  const auto batch = std::make_unique<FragmentBatch>();
  batch->coverage.count = batch_capacity;
  for (int i = 0; i < batch_capacity; ++i) fill(random_sample(random, i % 8), i, *batch);
  std::vector<glm::vec3> first;
  for (const Isa isa : available_isas()) {
    light_once(glm::normalize(glm::dvec3(-1, 1, 3)), *batch, isa);
    std::vector<glm::vec3> light;
    for (int i = 0; i < batch_capacity; ++i) light.push_back(batch->light.at(i));
    if (first.empty()) first = light;
    EXPECT_EQ(light, first) << name(isa);
  }
}

TEST(MaterialLayers, TheTableOfSheenIsTheSumOverDirections) {
  Random random(3);
  for (int i = 0; i < 60; ++i) {
    const float n_v = random.within(0.01f, 1), roughness = random.within(least_sheen_roughness, 1);
    const double wanted = sheen_albedo_of(double(n_v), double(roughness));
    EXPECT_NEAR(sheen_albedo().at(n_v, roughness), wanted, roughness > 0.2f ? 0.006 : 0.015)
        << n_v << ", " << roughness;
  }
}

/// The middle pixel of a picture of a square with the material.
glm::vec4 shown(const Material& material, std::vector<Texture> textures = {}) {
  Scene scene = scene_of(square(), material);
  scene.textures = std::move(textures);
  const Surfaces surfaces(scene);
  return color_at(shade(surfaces, zbuffer(surfaces, front_view()), {.light = {.shadows = Shadows::off}}), 30, 35);
}

TEST(MaterialLayers, TexturesMultiplyTheirFactors) {
  const std::vector<Texture> textures{texture_of(1, 1, {{51, 102, 153, 204}})};  // 0.2, 0.4, 0.6, 0.8
  const TextureUse use{.texture = 0};
  Material plain = colored({0.3f, 0.4f, 0.5f, 1});
  plain.roughness = 0.4f;
  const auto expect_same = [&](const Material& with_texture, const Material& with_factor) {
    const glm::vec4 a = shown(with_texture, textures), b = shown(with_factor);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], 1e-5f);
    EXPECT_NE(a, shown(plain));
  };
  Material a = plain, b = plain;
  a.ior = b.ior = 2;
  a.specular.color = b.specular.color = glm::vec3(2, 1, 1);
  a.specular.factor = 0.5f;
  a.specular.factor_texture = use;
  b.specular.factor = 0.4f;
  expect_same(a, b);
  a = b = plain;
  a.clearcoat.factor = 1;
  a.clearcoat.roughness = 0.5f;
  a.clearcoat.factor_texture = a.clearcoat.roughness_texture = use;
  b.clearcoat.factor = b.clearcoat.roughness = 0.2f;
  expect_same(a, b);
  a = b = plain;
  a.sheen.color = b.sheen.color = glm::vec3(1);
  a.sheen.roughness = 0.5f;
  a.sheen.roughness_texture = use;
  b.sheen.roughness = 0.4f;
  expect_same(a, b);
}

// A metal of colour 3 would reflect more light than arrives, repeatedly, and come out black.
TEST(MaterialLayers, NumbersOutOfRangeCountAsTheNearestInRange) {
  const std::vector<Texture> textures{texture_of(1, 1, {{102, 102, 102, 255}})};
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const float odd : {2.0f, 3.0f, 1e30f}) {
    Material m = colored({odd, 0.5f, -odd, 1}), wanted = colored({1, 0.5f, 0, 1});
    m.metallic = odd, wanted.metallic = 1;
    m.roughness = odd, wanted.roughness = 1;
    m.occlusion_strength = odd, wanted.occlusion_strength = 1;
    m.occlusion_texture.texture = wanted.occlusion_texture.texture = 0;
    m.emissive = {0, 0, -odd};
    EXPECT_EQ(shown(m, textures), shown(wanted, textures)) << odd;
  }
  Material m = colored({nan, 0.5f, 1, 1});
  m.metallic = m.roughness = m.occlusion_strength = m.emissive.x = nan;
  EXPECT_EQ(shown(m), shown(colored({1, 0.5f, 1, 1})));
}

// In glTF 2.0, vertex colours are 0 to 1.
TEST(MaterialLayers, ColoursOfVerticesAreZeroToOne) {
  const auto shown_with = [](const glm::vec4& color) {
    Material metal = colored(glm::vec4(1));
    metal.metallic = metal.roughness = 1;
    Scene scene = scene_of(square(), metal);
    scene.meshes[0].colors.values.assign(scene.meshes[0].positions.size(), color);
    const Surfaces surfaces(scene);
    return color_at(shade(surfaces, zbuffer(surfaces, front_view()), {.light = {.shadows = Shadows::off}}), 30, 35);
  };
  EXPECT_EQ(shown_with({3, 0.5f, -2, 1}), shown_with({1, 0.5f, 0, 1}));
  EXPECT_EQ(shown_with({std::numeric_limits<float>::quiet_NaN(), 0.5f, 1e38f, 1}), shown_with({0, 0.5f, 1, 1}));
}

TEST(MaterialLayers, AVarnishIsSmoothOverBumpsUnlessItHasItsOwn) {
  // The normal map turns the normal far to the left.
  const std::vector<Texture> bumps{texture_of(1, 1, {{38, 128, 218, 255}})};
  Material bumpy = colored({0, 0, 0, 1});
  bumpy.roughness = 1;
  bumpy.specular.factor = 0;
  bumpy.clearcoat.factor = 1;
  bumpy.clearcoat.roughness = 0.5f;
  Material smooth = bumpy;
  bumpy.normal_texture.texture = 0;
  const glm::vec4 of_smooth = shown(smooth);
  EXPECT_EQ(shown(bumpy, bumps), of_smooth);
  bumpy.clearcoat.normal_texture.texture = 0;
  EXPECT_NE(shown(bumpy, bumps), of_smooth);
  bumpy.clearcoat.normal_scale = 0;
  const glm::vec4 without_height = shown(bumpy, bumps);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(without_height[c], of_smooth[c], 1e-5f);
}

TEST(MaterialLayers, UnlitMaterialsHaveNone) {
  Material material = colored({0.5f, 0.25f, 1, 1});
  material.unlit = true;
  const glm::vec4 plain = shown(material);
  material.clearcoat.factor = 1;
  material.sheen.color = glm::vec3(1);
  material.transmission.factor = 1;
  material.ior = 3;
  EXPECT_EQ(shown(material), plain);
}

}  // namespace
}  // namespace frontmost::shading
