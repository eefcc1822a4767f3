// SPDX-License-Identifier: Apache-2.0
// The light alone, on fragments made by hand.
#include "shade/light/lighting.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <random>

#include "shade/light_reference.h"
#include "support/odd_numbers.h"
#include "support/seeds.h"

namespace frontmost::shading {
namespace {

using test::kNan;
using test::light_batch;
using test::lit;
using test::set;
using test::Surface;

const Environment& studio() {
  static const Environment environment = Environment::studio();
  return environment;
}

/// The default light of a camera looking along -z.
Lighting default_light(const LightOptions& options = {}) { return lighting_for(View(), Axis::y, options, studio()); }

Lighting only_studio() {
  Lighting lighting = default_light();
  lighting.key.color = glm::vec3(0);
  return lighting;
}

/// Uniform surrounding light of one colour, and no other light.
Lighting furnace(float light = 1) {
  Lighting lighting;
  Image picture{64, 32, {}};
  for (const char* name : {"R", "G", "B"}) picture.channels.push_back({name, Buffer<float>(64 * 32, light)});
  static std::vector<Environment> kept;
  kept.emplace_back(std::move(picture));
  lighting = lighting_for(View(), Axis::y, {.environment = kept.back()}, kept.back());
  EXPECT_EQ(lighting.key.color, glm::vec3(0)) << "a picture has lights of its own";
  return lighting;
}

/// Only the key light, without surroundings.
Lighting only_key() {
  Lighting lighting;
  lighting.key.color = glm::vec3(1);
  return lighting;
}

glm::vec3 tilted(float degrees) {
  const float angle = degrees * 3.14159265f / 180;
  return {std::sin(angle), 0, std::cos(angle)};
}

TEST(Lighting, KeyLightStandsUpperLeftAndBeforeTheModel) {
  View view;
  view.world_from_eye = look_at({3, 4, 5}, {0, 0, 0}, {0, 1, 0});
  const Lighting lighting = lighting_for(view, Axis::z, {}, studio());
  EXPECT_NEAR(glm::length(lighting.key.to_light), 1.0f, 1e-6f);
  EXPECT_LT(glm::dot(lighting.key.to_light, glm::vec3(view.right())), -0.3f);
  EXPECT_GT(glm::dot(lighting.key.to_light, glm::vec3(view.up())), 0.3f);
  EXPECT_LT(glm::dot(lighting.key.to_light, glm::vec3(view.forward())), -0.3f);
  EXPECT_EQ(lighting.around.world_from_environment[1], glm::vec3(0, 0, 1));
}

TEST(Lighting, MattLightFollowsTheCosine) {
  // Fresnel takes a few per cent from the matt part; a black surface shows the rest of the highlight.
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
  const float dark = lit(surface, default_light()).x;
  surface.shadow = 1;
  const float bright = lit(surface, default_light()).x;
  surface.shadow = 0.5f;
  EXPECT_GT(dark, 0.05f);
  EXPECT_NEAR(lit(surface, default_light()).x, 0.5f * (dark + bright), 1e-6f);
}

TEST(Lighting, OcclusionTakesTheSurroundingAndNothingElse) {
  Surface surface{.occlusion = 0};
  Surface rough = surface;
  rough.base = glm::vec3(0.5f);
  EXPECT_EQ(lit(rough, only_studio()).x, 0.0f);
  EXPECT_EQ(lit(surface, only_key()), lit({}, only_key()));
}

TEST(Lighting, TheStudioIsBrightAboveAndDarkerBelowByTheScenesUpAndTurnsWithTheCamera) {
  for (const Axis axis : {Axis::y, Axis::z, Axis::minus_y}) {
    const glm::dvec3 up = direction(axis), across(1, 0, 0);
    View view;
    view.world_from_eye = look_at(across * 5.0, {0, 0, 0}, up);
    Lighting around = lighting_for(view, axis, {}, studio());
    around.key.color = glm::vec3(0);
    const glm::vec3 viewer(across), above_it(up);
    const float above = lit({.normal = above_it, .to_viewer = viewer}, around).z;
    const float side = lit({.normal = viewer, .to_viewer = viewer}, around).z;
    const float below = lit({.normal = -above_it, .to_viewer = viewer}, around).z;
    EXPECT_GT(above, side);
    EXPECT_GT(side, below);
    EXPECT_GT(below, 0.05f);
    const glm::mat3& turn = around.around.world_from_environment;
    EXPECT_NEAR(glm::dot(turn[2], viewer), 1, 1e-6) << "behind the model's viewer";
    EXPECT_NEAR(glm::determinant(turn), 1, 1e-6);
  }
}

TEST(Lighting, AWhiteMattSurfaceThatFacesTheKeyLightComesToJustBelowOne) {
  const Lighting lighting = default_light();
  const glm::vec3 light = lit({.normal = lighting.key.to_light, .to_viewer = {0, 0, 1}}, lighting);
  for (int k = 0; k < 3; ++k) {
    EXPECT_GT(light[k], 0.9f);
    EXPECT_LT(light[k], 1.0f);
  }
}

TEST(Lighting, EveryKindOfEnvironmentIsTurnedByItsAngleAboutUp) {
  const Environment sky = Environment::sky();
  for (const Axis axis : {Axis::x, Axis::y, Axis::z, Axis::minus_x, Axis::minus_y, Axis::minus_z}) {
    const glm::vec3 up(direction(axis));
    const Lighting straight = lighting_for(View(), axis, {}, sky);
    const Lighting turned = lighting_for(View(), axis, {.environment_angle = 1.5707963267948966}, sky);
    const glm::mat3 &a = straight.around.world_from_environment, &b = turned.around.world_from_environment;
    EXPECT_EQ(a[1], up);
    EXPECT_EQ(b[1], up);
    // Counter-clockwise from above: the direction ahead becomes left.
    EXPECT_NEAR(glm::dot(-b[2], -a[0]), 1, 1e-6);
    EXPECT_NEAR(glm::determinant(b), 1, 1e-6);
  }
  EXPECT_EQ(lighting_for(View(), Axis::z, {}, sky).around.world_from_environment[2], glm::vec3(0, -1, 0));
  EXPECT_EQ(lighting_for(View(), Axis::y, {}, sky).around.world_from_environment[2], glm::vec3(0, 0, 1));
}

TEST(Lighting, LookingStraightDownTheStudioIsAheadWhereThePictureHasItsTop) {
  for (const double side : {1.0, -1.0}) {
    View view;
    view.world_from_eye = look_at({0, 5 * side, 0}, {0, 0, 0}, {1, 0, 0});
    const glm::mat3 turn = lighting_for(view, Axis::y, {}, studio()).around.world_from_environment;
    EXPECT_NEAR(glm::dot(turn[2], glm::vec3(view.up())), -side, 1e-6);
  }
}

TEST(Lighting, InAFurnaceEverySurfaceVanishes) {
  // White furnace: a surface that absorbs nothing reflects all incoming light, at every angle and roughness.
  const Lighting lighting = furnace(0.5f);
  for (int degrees = 0; degrees < 90; degrees += 6)
    for (float roughness = 0; roughness <= 1.0f; roughness += 0.03125f)
      for (const float metallic : {0.0f, 1.0f}) {
        const Surface white{.normal = tilted(float(degrees)), .metallic = metallic, .roughness = roughness};
        EXPECT_NEAR(lit(white, lighting).x, 0.5f, 0.01f) << degrees << " " << roughness << " " << metallic;
      }
}

TEST(Lighting, LightOptionsOutOfRangeAreRefused) {
  const auto expect_refused = [](const LightOptions& options, const std::string& reason) {
    try {
      check_light(options);
      ADD_FAILURE() << reason;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::bad_argument);
      EXPECT_EQ(std::string(error.what()), "shade: " + reason);
    }
  };
  const double inf = std::numeric_limits<double>::infinity();
  for (const double bad : {double(kNan), inf, -inf}) {
    expect_refused({.environment_angle = bad}, "environment angle: must be finite");
    expect_refused({.exposure = bad}, "exposure: must be -32 to 32 stops");
    expect_refused({.intensity = bad}, "light intensity: must be 0 to 1000000");
    expect_refused({.direction = glm::dvec3(0, bad, 1)}, "light direction: must have a length, 1e-100 to 1e100");
  }
  expect_refused({.exposure = 32.01}, "exposure: must be -32 to 32 stops");
  expect_refused({.intensity = -1e-9}, "light intensity: must be 0 to 1000000");
  expect_refused({.direction = glm::dvec3(0)}, "light direction: must have a length, 1e-100 to 1e100");
  EXPECT_NO_THROW(
      check_light({.environment_angle = -1e6, .exposure = -32, .direction = glm::dvec3(1e-90), .intensity = 1e6}));
}

TEST(Lighting, DirectionAndIntensityAreThoseOfTheOptions) {
  const Lighting lighting = default_light({.direction = glm::dvec3(0, 3, 4), .intensity = 2});
  EXPECT_EQ(lighting.key.to_light, glm::vec3(0, 0.6f, 0.8f));
  EXPECT_EQ(lighting.key.color, 2.0f * default_light().key.color);
  EXPECT_FALSE(default_light({.intensity = 0}).key.is_on());
}

TEST(Lighting, ExposureDoublesLightByTheStopBeforeAnythingIsCut) {
  const Surface dark{.base = glm::vec3(0.1f)};
  const float light = lit(dark, default_light()).x;
  EXPECT_NEAR(lit(dark, default_light({.exposure = 2})).x, 4 * light, 1e-6f);
  EXPECT_NEAR(lit(dark, default_light({.exposure = -1})).x, light / 2, 1e-6f);
  const Surface glowing{.base = glm::vec3(0), .emissive = {8, 4, 0.5f}};
  const glm::vec3 found = lit(glowing, default_light({.exposure = -4, .intensity = 0}));
  EXPECT_NEAR(found.x, 0.5f, 0.02f);
  EXPECT_NEAR(found.y, 0.25f, 0.02f);
  const Surface unlit{.base = glm::vec3(0.3f), .unlit = true};
  EXPECT_EQ(lit(unlit, default_light({.exposure = 5, .tone_mapping = ToneMapping::aces})).x, 0.3f);
}

/// Emitted light as a picture shows it.
glm::vec3 mapped(ToneMapping mapping, const glm::vec3& light) {
  Lighting lighting;
  lighting.key.color = glm::vec3(0);
  lighting.tone_mapping = mapping;
  return lit({.base = glm::vec3(0), .emissive = light}, lighting);
}

TEST(Lighting, ToneMappersAreThoseThatWerePublished) {
  // Khronos' tone mapping subtracts 0.04. Values up to 0.8 change no further, and the greatest channel never reaches 1.
  const glm::vec3 plain = mapped(ToneMapping::khronos, {0.8f, 0.5f, 0.1f});
  EXPECT_NEAR(plain.x, 0.76f, 1e-6f);
  EXPECT_NEAR(plain.y, 0.46f, 1e-6f);
  EXPECT_NEAR(plain.z, 0.06f, 1e-6f);
  const glm::vec3 dark = mapped(ToneMapping::khronos, {0.3f, 0.2f, 0.04f});
  EXPECT_NEAR(dark.z, 6.25f * 0.04f * 0.04f, 1e-6f);
  EXPECT_NEAR(dark.x, 0.27f, 1e-6f);
  const glm::vec3 bright = mapped(ToneMapping::khronos, {4.04f, 2.04f, 1.04f});  // by the published lines, computed by
                                                                                 // hand
  const float peak = 1 - 0.24f * 0.24f / (4 + 0.24f - 0.76f), faded = 1 - 1 / (0.15f * (4 - peak) + 1);
  EXPECT_NEAR(bright.x, peak, 1e-5f);
  EXPECT_NEAR(bright.y, peak / 2 + (peak - peak / 2) * faded, 1e-5f);
  EXPECT_NEAR(bright.z, peak / 4 + (peak - peak / 4) * faded, 1e-5f);
  // ACES: known values of the fit, at the exposure of 1 / 0.6.
  EXPECT_NEAR(mapped(ToneMapping::aces, glm::vec3(0)).x, 0, 1e-3f);
  EXPECT_NEAR(mapped(ToneMapping::aces, glm::vec3(0.6f)).x,
              (1 + 0.0245786 - 0.000090537) / (0.983729 + 0.432951 + 0.238081), 1e-4f);
  for (const ToneMapping mapping : {ToneMapping::none, ToneMapping::aces, ToneMapping::khronos}) {
    float before = -1;
    for (const float light : {0.0f, 0.01f, 0.05f, 0.1f, 0.3f, 0.7f, 0.79f, 0.81f, 1.0f, 2.0f, 50.0f, 1e10f, 3e38f}) {
      const float grey = mapped(mapping, glm::vec3(light)).x;
      EXPECT_GE(grey, before) << light;
      EXPECT_LE(grey, 1.0f);
      before = grey;
    }
  }
  EXPECT_EQ(mapped(ToneMapping::none, {7, 0.5f, -1}), glm::vec3(1, 0.5f, 0));
}

TEST(Lighting, HighlightIsBrightestInTheMirrorDirectionAndNarrowerOnSmootherSurfaces) {
  Lighting lighting = only_key();
  lighting.key.color = glm::vec3(0.02f);  // far from the cut-off
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
  // Light that white metal reflects to a viewer straight above, integrated over all directions of the key light: its
  // albedo, by reciprocity. Cosine-weighted quadrature of the same lobe.
  for (const float roughness : {0.3f, 0.5f, 0.8f, 1.0f}) {
    constexpr int steps = 400;
    double albedo = 0;
    for (int i = 0; i < steps; ++i) {
      const double angle = (i + 0.5) / steps * 1.5707963;
      Lighting lighting = only_key();
      lighting.key.color = glm::vec3(1e-3f);
      lighting.key.to_light = {float(std::sin(angle)), 0, float(std::cos(angle))};
      const Surface metal{.metallic = 1, .roughness = roughness};
      // In the key light's unit, the reflection of a white matt surface, the hemisphere's weight is 2 sin(angle) d
      // angle.
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
  lighting.key.color = glm::vec3(0.05f);
  const glm::vec3 gold = lit({.base = {1, 0.7f, 0.2f}, .metallic = 1, .roughness = 0.5f}, lighting);
  EXPECT_NEAR(gold.y / gold.x, 0.7f, 1e-3f);
  EXPECT_NEAR(gold.z / gold.x, 0.2f, 1e-3f);
  const glm::vec3 black = lit({.base = {0, 0, 0}, .roughness = 0.3f}, lighting);
  EXPECT_EQ(black.x, black.z);
  EXPECT_GT(black.x, 0.0f);
}

TEST(Lighting, GrazingSurfacesShimmer) {
  const Lighting around = furnace();
  const auto at = [&](float degrees) {
    return lit({.normal = tilted(degrees), .base = {0, 0, 0}, .roughness = 0.2f}, around).x;
  };
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
  for (const ToneMapping mapping : {ToneMapping::none, ToneMapping::aces, ToneMapping::khronos})
    for (const float bad : {kNan, inf, -inf, -1.0f, 1e30f}) {
      for (const Surface& s :
           {Surface{.base = glm::vec3(bad)}, Surface{.metallic = bad}, Surface{.roughness = bad},
            Surface{.occlusion = bad}, Surface{.shadow = bad}, Surface{.emissive = glm::vec3(bad)}}) {
        const glm::vec3 color = lit(s, default_light({.tone_mapping = mapping}));
        for (int k = 0; k < 3; ++k) EXPECT_TRUE(color[k] >= 0 && color[k] <= 1) << bad;
      }
      const auto batch = std::make_unique<FragmentBatch>();
      batch->coverage.count = 1;
      set(*batch, 0, {});
      batch->geometry.normal.set(0, glm::vec3(bad));
      light_batch(default_light({.tone_mapping = mapping}), *batch);
      for (int k = 0; k < 3; ++k) EXPECT_TRUE(batch->light.at(0)[k] >= 0 && batch->light.at(0)[k] <= 1) << bad;
    }
}

TEST(Lighting, AFragmentsColourDoesNotDependOnItsPlaceInTheBatchNorOnTheInstructionSet) {
  // The loop processes several fragments at a time, depending on the machine, and the rest one by one. All must round
  // alike.
  std::mt19937 random(test::noted_seed(11));
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
  for (const ToneMapping mapping : {ToneMapping::none, ToneMapping::aces, ToneMapping::khronos})
    for (const Isa isa : available_isas()) {
      const Lighting lighting = default_light({.tone_mapping = mapping});
      light_batch(lighting, *batch, isa);
      for (int i = 0; i < batch->coverage.count; ++i) {
        const glm::vec3 alone = lit(surfaces[std::size_t(i)], lighting), together = batch->light.at(i);
        EXPECT_EQ(std::memcmp(&alone, &together, sizeof alone), 0) << name(isa) << ", " << i;
      }
    }
}

TEST(Lighting, KernelsGiveWhatTheFormulasOfTheStandardGiveInDoubles) {
  std::mt19937 random(test::noted_seed(5));
  std::uniform_real_distribution<float> unit(0, 1), both(-1, 1);
  double greatest = 0;
  for (const Environment& environment : {Environment::studio(), Environment::sky()})
    for (int i = 0; i < 300; ++i) {
      Surface s{.normal = {both(random), both(random), both(random)},
                .to_viewer = {both(random), both(random), both(random)},
                .base = {unit(random), unit(random), unit(random)},
                .metallic = i % 3 == 0 ? unit(random) : float(i % 2),
                .roughness = unit(random),
                .occlusion = unit(random),
                .shadow = unit(random),
                .emissive = 0.1f * glm::vec3(unit(random), unit(random), unit(random))};
      if (glm::dot(s.normal, s.to_viewer) < 0.03f * glm::length(s.normal) * glm::length(s.to_viewer)) continue;
      const LightOptions options{.environment = environment,
                                 .environment_angle = double(both(random)) * 3,
                                 .direction = glm::dvec3(both(random), both(random), 1)};
      const Lighting lighting = lighting_for(View(), Axis::z, options, environment);
      const glm::dvec3 expected = glm::dvec3(s.emissive) + test::direct_light(s, lighting.key) +
                                  test::surrounding_light(s, environment, lighting.around.world_from_environment);
      const glm::vec3 found = lit(s, lighting);
      for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(found[k], std::min(expected[k], 1.0), 1.0 / 255) << i << " roughness " << s.roughness;
        greatest = std::max(greatest, std::abs(double(found[k]) - std::min(expected[k], 1.0)));
      }
    }
  RecordProperty("greatest_difference_of_255", std::to_string(greatest * 255));
}

}  // namespace
}  // namespace frontmost::shading
