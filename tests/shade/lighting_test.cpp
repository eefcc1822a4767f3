// SPDX-License-Identifier: Apache-2.0
// The light by itself, on fragments made by hand.
#include "shade/lighting.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <random>

#include "support/odd_numbers.h"

namespace frontmost::shading {
namespace {

using test::kNan;

struct Surface {
  glm::vec3 normal{0, 0, 1}, to_viewer{0, 0, 1};
  glm::vec3 base{1};
  float metallic = 0, roughness = 1, occlusion = 1, shadow = 1;
  glm::vec3 emissive{0};
  bool unlit = false;
};

void set(FragmentBatch& batch, int i, const Surface& s) {
  batch.geometry.normal.set(i, glm::normalize(s.normal));
  batch.geometry.to_viewer.set(i, glm::normalize(s.to_viewer));
  batch.material.base.set(i, s.base);
  batch.material.emissive.set(i, s.emissive);
  batch.material.metallic[i] = s.metallic;
  batch.material.roughness[i] = s.roughness;
  batch.material.occlusion[i] = s.occlusion;
  batch.material.unlit[i] = s.unlit ? 1.0f : 0.0f;
  batch.shadow[i] = s.shadow;
}

glm::vec3 lit(const Surface& surface, const Lighting& lighting = {}) {
  const auto batch = std::make_unique<FragmentBatch>();
  batch->coverage.count = 1;
  set(*batch, 0, surface);
  light_batch(lighting, *batch);
  return batch->light.at(0);
}

Lighting only_key() {
  Lighting lighting;
  lighting.key = glm::vec3(1);
  lighting.sky = lighting.ground = glm::vec3(0);
  lighting.box = 0;
  return lighting;
}

glm::vec3 tilted(float degrees) {
  const float angle = degrees * 3.14159265f / 180;
  return {std::sin(angle), 0, std::cos(angle)};
}

TEST(Lighting, KeyLightStandsUpperLeftAndBeforeTheModel) {
  View view;
  view.world_from_eye = look_at({3, 4, 5}, {0, 0, 0}, {0, 1, 0});
  const Lighting lighting = lighting_for(view, Axis::z);
  EXPECT_NEAR(glm::length(lighting.to_key), 1.0f, 1e-6f);
  EXPECT_LT(glm::dot(lighting.to_key, glm::vec3(view.right())), -0.3f);
  EXPECT_GT(glm::dot(lighting.to_key, glm::vec3(view.up())), 0.3f);
  EXPECT_LT(glm::dot(lighting.to_key, glm::vec3(view.forward())), -0.3f);
  EXPECT_EQ(lighting.up, glm::vec3(0, 0, 1));
}

TEST(Lighting, MattLightFollowsTheCosine) {
  // Fresnel takes a few per cent from the matt part; a black surface has what is left of the highlight.
  for (const float degrees : {0.0f, 30.0f, 60.0f, 80.0f}) {
    Surface white{.normal = tilted(degrees)}, black = white;
    black.base = glm::vec3(0);
    const float matt = lit(white, only_key()).x - lit(black, only_key()).x;
    EXPECT_NEAR(matt, 0.96f * std::cos(degrees * 3.14159265f / 180), 1e-4f) << degrees;
  }
  Surface averted{.normal = {0, 0, -1}};
  EXPECT_EQ(lit(averted, only_key()), glm::vec3(0));
}

TEST(Lighting, ShadowTakesTheKeyLightAndNothingElse) {
  Surface surface{.base = glm::vec3(0.5f)};
  surface.shadow = 0;
  EXPECT_EQ(lit(surface, only_key()), glm::vec3(0));
  const float dark = lit(surface).x;
  surface.shadow = 1;
  const float bright = lit(surface).x;
  surface.shadow = 0.5f;
  EXPECT_GT(dark, 0.05f);
  EXPECT_NEAR(lit(surface).x, 0.5f * (dark + bright), 1e-6f);
}

TEST(Lighting, OcclusionTakesTheSurroundingAndNothingElse) {
  Surface surface{.occlusion = 0};
  Lighting around;
  around.key = glm::vec3(0);
  Surface rough = surface;
  rough.base = glm::vec3(0.5f);
  EXPECT_EQ(lit(rough, around).x, 0.0f);
  EXPECT_EQ(lit(surface, only_key()), lit({}, only_key()));
}

TEST(Lighting, TheSurroundingIsBrightAboveAndDarkerBelowByTheScenesUp) {
  Lighting around;
  around.key = glm::vec3(0);
  around.to_key = {1, 0, 0};
  for (const glm::vec3 up : {glm::vec3(0, 1, 0), glm::vec3(0, 0, 1), glm::vec3(0, -1, 0)}) {
    around.up = up;
    const glm::vec3 viewer = glm::vec3(-1, 0, 0);
    const float above = lit({.normal = up, .to_viewer = viewer}, around).z;
    const float side = lit({.normal = viewer, .to_viewer = viewer}, around).z;
    const float below = lit({.normal = -up, .to_viewer = viewer}, around).z;
    EXPECT_GT(above, side);
    EXPECT_GT(side, below);
    EXPECT_GT(below, 0.05f);
  }
}

TEST(Lighting, HighlightIsBrightestInTheMirrorDirectionAndNarrowerOnSmootherSurfaces) {
  Lighting lighting = only_key();
  lighting.key = glm::vec3(0.02f);  // far from the cut-off
  Surface black{.base = glm::vec3(0)};
  const auto at = [&](float degrees, float roughness) {
    black.roughness = roughness;
    black.normal = tilted(degrees);
    return lit(black, lighting).x;
  };
  for (const float roughness : {0.2f, 0.4f, 0.7f}) {
    EXPECT_GT(at(0, roughness), at(5, roughness));
    EXPECT_GT(at(5, roughness), at(20, roughness));
  }
  EXPECT_LT(at(15, 0.2f) / at(0, 0.2f), 0.2f * at(15, 0.7f) / at(0, 0.7f));
}

TEST(Lighting, GgxSendsNoMoreLightThanItGets) {
  // The light that a white metal sends to a viewer straight above, over all directions of the key light: by
  // reciprocity its albedo. Cosine-weighted quadrature of the same lobe.
  for (const float roughness : {0.3f, 0.5f, 0.8f, 1.0f}) {
    constexpr int steps = 400;
    double albedo = 0;
    for (int i = 0; i < steps; ++i) {
      const double angle = (i + 0.5) / steps * 1.5707963;
      Lighting lighting = only_key();
      lighting.key = glm::vec3(1e-3f);
      lighting.to_key = {float(std::sin(angle)), 0, float(std::cos(angle))};
      const Surface metal{.metallic = 1, .roughness = roughness};
      // The key's unit: what a white matt surface sends back, so the sum over the hemisphere is 2 sin(angle) d angle.
      albedo += double(lit(metal, lighting).x) / 1e-3 * 2 * std::sin(angle) * 1.5707963 / steps;
    }
    EXPECT_LT(albedo, 1.02) << roughness;
    EXPECT_GT(albedo, 0.3) << roughness;
    // At roughness 1 the lobe is 0.5 / (1 + N.L), whose integral is known.
    if (roughness == 1.0f) {
      EXPECT_NEAR(albedo, 1 - std::log(2.0), 1e-4);
    }
  }
}

TEST(Lighting, MetalsColourTheirHighlightsAndDielectricsDoNot) {
  Lighting lighting = only_key();
  lighting.key = glm::vec3(0.05f);
  const glm::vec3 gold = lit({.base = {1, 0.7f, 0.2f}, .metallic = 1, .roughness = 0.5f}, lighting);
  EXPECT_NEAR(gold.y / gold.x, 0.7f, 1e-3f);
  EXPECT_NEAR(gold.z / gold.x, 0.2f, 1e-3f);
  const glm::vec3 black = lit({.base = {0, 0, 0}, .roughness = 0.3f}, lighting);
  EXPECT_EQ(black.x, black.z);
  EXPECT_GT(black.x, 0.0f);
}

TEST(Lighting, GrazingSurfacesShimmer) {
  Lighting around;
  around.key = glm::vec3(0);
  const auto at = [&](float degrees) {
    return lit({.normal = tilted(degrees), .base = {0, 0, 0}, .roughness = 0.2f}, around).x;
  };
  around.to_key = {0, 1, 0};
  EXPECT_GT(at(85), 2 * at(0));
}

TEST(Lighting, UnlitAndEmissive) {
  EXPECT_EQ(lit({.base = {0.1f, 0.2f, 0.3f}, .emissive = {1, 1, 1}, .unlit = true}), glm::vec3(0.1f, 0.2f, 0.3f));
  const glm::vec3 glow = lit({.base = {0, 0, 0}, .emissive = {0.2f, 0, 7}, .unlit = false}, only_key());
  EXPECT_GT(glow.x, 0.2f);
  EXPECT_EQ(glow.z, 1.0f);  // cut off
}

TEST(Lighting, AnyInputGivesColoursBetweenZeroAndOne) {
  const float inf = std::numeric_limits<float>::infinity();
  for (const float bad : {kNan, inf, -inf, -1.0f, 1e30f}) {
    for (const Surface& s : {Surface{.base = glm::vec3(bad)}, Surface{.metallic = bad}, Surface{.roughness = bad},
                             Surface{.occlusion = bad}, Surface{.shadow = bad}, Surface{.emissive = glm::vec3(bad)}}) {
      const glm::vec3 color = lit(s);
      for (int k = 0; k < 3; ++k) EXPECT_TRUE(color[k] >= 0 && color[k] <= 1) << bad;
    }
    const auto batch = std::make_unique<FragmentBatch>();
    batch->coverage.count = 1;
    set(*batch, 0, {});
    batch->geometry.normal.set(0, glm::vec3(bad));
    light_batch({}, *batch);
    for (int k = 0; k < 3; ++k) EXPECT_TRUE(batch->light.at(0)[k] >= 0 && batch->light.at(0)[k] <= 1) << bad;
  }
}

TEST(Lighting, AFragmentsColourDoesNotDependOnItsPlaceInTheBatchNorOnTheInstructionSet) {
  // The loop takes several at a time, how many depends on the machine, and its rest one by one: all must round alike.
  std::mt19937 random(11);
  std::uniform_real_distribution<float> unit(0, 1), both(-1, 1);
  std::vector<Surface> surfaces;
  for (int i = 0; i < 61; ++i)
    surfaces.push_back({.normal = {both(random), both(random), 1},
                        .to_viewer = {both(random), both(random), 1},
                        .base = {unit(random), unit(random), unit(random)},
                        .metallic = unit(random),
                        .roughness = unit(random),
                        .occlusion = unit(random),
                        .shadow = unit(random)});
  const auto batch = std::make_unique<FragmentBatch>();
  batch->coverage.count = int(surfaces.size());
  for (int i = 0; i < batch->coverage.count; ++i) set(*batch, i, surfaces[std::size_t(i)]);
  for (const Isa isa : available_isas()) {
    light_batch({}, *batch, isa);
    for (int i = 0; i < batch->coverage.count; ++i) {
      const glm::vec3 alone = lit(surfaces[std::size_t(i)]), together = batch->light.at(i);
      EXPECT_EQ(std::memcmp(&alone, &together, sizeof alone), 0) << name(isa) << ", " << i;
    }
  }
}

}  // namespace
}  // namespace frontmost::shading
