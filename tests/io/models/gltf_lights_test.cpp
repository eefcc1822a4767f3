// SPDX-License-Identifier: Apache-2.0
// KHR_lights_punctual: defaults of lights, their poses by nodes, and the handling of invalid ones.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "gltf_maker.h"
#include "support/refusal.h"

namespace frontmost {
namespace {

using test::GltfMaker;
using test::load_glb;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double quarter_turn = 0.5 * std::numbers::pi;

/// Loads a file of a triangle, these lights, and a node for each light that begins with the members in `node`.
Scene load_lights(const std::vector<std::string>& lights, const std::string& node = "") {
  GltfMaker maker;
  std::string list;
  for (std::size_t i = 0; i < lights.size(); ++i) {
    list += (i == 0 ? "" : ",") + lights[i];
    maker.add("nodes", "{" + node + R"("extensions":{"KHR_lights_punctual":{"light":)" + std::to_string(i) + "}}}");
  }
  maker.floats({0, 0, 0, 1, 0, 0, 0, 1, 0});
  maker.add("meshes", R"({"primitives":[{"attributes":{"POSITION":0}}]})");
  maker.add("nodes", R"({"mesh":0})");
  maker.set("extensions", R"({"KHR_lights_punctual":{"lights":[)" + list + "]}}");
  maker.set("extensionsRequired", R"(["KHR_lights_punctual"])");
  return load_glb(maker);
}

TEST(GltfLights, HaveTheDefaultsOfTheExtension) {
  const Scene scene = load_lights({R"({"type":"directional"})", R"({"type":"point"})", R"({"type":"spot"})"});
  EXPECT_THAT(scene.warnings, IsEmpty());
  ASSERT_EQ(scene.lights.size(), 3u);
  EXPECT_EQ(scene.lights[0].kind, Light::Kind::sun);
  EXPECT_EQ(scene.lights[1].kind, Light::Kind::point);
  EXPECT_EQ(scene.lights[2].kind, Light::Kind::spot);
  for (const Light& light : scene.lights) {
    EXPECT_EQ(light.intensity, 1);
    EXPECT_EQ(light.color, glm::vec3(1));
    EXPECT_FALSE(light.range.has_value());
    EXPECT_EQ(light.world_from_light[2], glm::dvec4(0, 0, 1, 0)) << "down -z";
    EXPECT_EQ(light.world_from_light[3], glm::dvec4(0, 0, 0, 1));
  }
  EXPECT_EQ(scene.lights[2].inner_cone, 0);
  EXPECT_EQ(scene.lights[2].outer_cone, 0.5 * quarter_turn);
  EXPECT_NO_THROW(validate(scene));
}

TEST(GltfLights, KeepWhatTheFileSays) {
  const Scene scene = load_lights({R"({"type":"spot","name":"lamp","color":[1,0.5,0.25],"intensity":54.5,"range":7,
                                      "spot":{"innerConeAngle":0.25,"outerConeAngle":0.75}})"});
  ASSERT_EQ(scene.lights.size(), 1u);
  const Light& lamp = scene.lights[0];
  EXPECT_EQ(lamp.name, "lamp");
  EXPECT_EQ(lamp.color, glm::vec3(1, 0.5f, 0.25f));
  EXPECT_EQ(lamp.intensity, 54.5);
  EXPECT_EQ(lamp.range, 7);
  EXPECT_EQ(lamp.inner_cone, 0.25);
  EXPECT_EQ(lamp.outer_cone, 0.75);
}

TEST(GltfLights, StandWhereTheirNodesAreWhateverTheScale) {
  const std::string spot = R"({"type":"spot","range":2,"spot":{"outerConeAngle":0.5}})";
  // A quarter turn about x takes -z to +y.
  const std::string turned =
      R"("name":"n","translation":[1,2,3],"rotation":[0.70710678118654757,0,0,0.70710678118654757],)";
  for (const std::string scale : {R"()", R"("scale":[5,6,7],)", R"("scale":[0,0,2],)", R"("scale":[-1,1,1],)"}) {
    const Scene scene = load_lights({spot}, turned + scale);
    ASSERT_EQ(scene.lights.size(), 1u) << scale;
    const Light& light = scene.lights[0];
    EXPECT_EQ(light.name, "n");
    EXPECT_EQ(light.world_from_light[3], glm::dvec4(1, 2, 3, 1));
    EXPECT_LT(glm::distance(-light.world_from_light[2], glm::dvec4(0, 1, 0, 0)), 1e-12) << scale;
    EXPECT_EQ(light.range, 2) << "is not scaled";
    EXPECT_EQ(light.outer_cone, 0.5);
    EXPECT_NO_THROW(validate(scene));
  }
}

TEST(GltfLights, WithoutADirectionAreLeftOutUnlessTheyNeedNone) {
  const Scene scene = load_lights({R"({"type":"directional"})", R"({"type":"point"})", R"({"type":"spot"})"},
                                  R"("scale":[1,1,0],"translation":[4,5,6],)");
  ASSERT_EQ(scene.lights.size(), 1u);
  EXPECT_EQ(scene.lights[0].kind, Light::Kind::point);
  EXPECT_EQ(scene.lights[0].world_from_light[3], glm::dvec4(4, 5, 6, 1));
  ASSERT_EQ(scene.warnings.size(), 2u);
  EXPECT_THAT(scene.warnings[0], HasSubstr("nodes[0]: a light that shines in no direction is left out"));
  EXPECT_NO_THROW(validate(scene));
}

TEST(GltfLights, BelowOneNodeShineFromEachPlaceThatIsShown) {
  GltfMaker maker;
  maker.set("extensions", R"({"KHR_lights_punctual":{"lights":[{"type":"point"},{"type":"point"}]}})");
  for (const char* place : {"1", "2", "3"})
    maker.add("nodes", std::string(R"({"translation":[)") + place +
                           R"(,0,0],"extensions":{"KHR_lights_punctual":{"light":0}}})");
  maker.add("scenes", R"({"nodes":[0,2]})");
  const Scene scene = load_glb(maker);
  ASSERT_EQ(scene.lights.size(), 2u);
  EXPECT_EQ(scene.lights[1].world_from_light[3].x, 3);
}

struct OddLight {
  const char* json;
  const char* warning;
  bool is_kept;
};

TEST(GltfLights, ThatAreWrongAreToldAndMadeSenseOf) {
  const OddLight odd[] = {
      {R"({"type":"area"})", "lights[0]: lights of the type area are unknown, the light is left out", false},
      {R"({"type":"point","intensity":-2})", "lights[0]: its intensity is negative, the light is left out", false},
      {R"({"type":"point","color":[1,-1,1]})", "lights[0]: its colour is out of range, the light is left out", false},
      {R"({"type":"point","color":[1,1e300,1]})", "its colour is out of range, the light is left out", false},
      {R"({"type":"point","range":0})", "lights[0].range: is not positive; the light reaches everywhere", true},
      {R"({"type":"spot","spot":{"innerConeAngle":1,"outerConeAngle":0.5}})",
       "lights[0].spot.innerConeAngle: is not between 0 and outerConeAngle; the nearest such angle is used", true},
      {R"({"type":"spot","spot":{"outerConeAngle":3}})",
       "lights[0].spot.outerConeAngle: is not between 0 and 90 degrees; the nearest such angle is used", true},
      {R"({"type":"spot","spot":{"outerConeAngle":-1}})", "outerConeAngle: is not between 0 and 90 degrees", true}};
  for (const OddLight& one : odd) {
    const Scene scene = load_lights({one.json});
    ASSERT_FALSE(scene.warnings.empty()) << one.json;
    EXPECT_THAT(scene.warnings[0], HasSubstr(one.warning));
    EXPECT_EQ(scene.lights.size(), one.is_kept ? 1u : 0u) << one.json;
    EXPECT_NO_THROW(validate(scene));
  }
}

TEST(GltfLights, ConesAsExportersRoundThemAreFine) {
  const Scene scene =
      load_lights({R"({"type":"spot","spot":{"innerConeAngle":1.5707964,"outerConeAngle":1.5707964}})"});
  EXPECT_THAT(scene.warnings, IsEmpty());
  EXPECT_EQ(scene.lights.at(0).outer_cone, quarter_turn);
  EXPECT_EQ(scene.lights.at(0).inner_cone, quarter_turn);
}

TEST(GltfLights, ThatCannotBeReadAreErrorsOfTheirPlace) {
  const auto refusal = [](const std::string& light) {
    return test::refusal_of(ErrorCode::file_malformed, [&] { (void)load_lights({light}); });
  };
  EXPECT_THAT(refusal("{}"), HasSubstr("extensions.KHR_lights_punctual.lights[0]: 'type' is missing"));
  EXPECT_THAT(refusal(R"({"type":"point","intensity":"bright"})"),
              HasSubstr("lights[0].intensity: a number is expected"));
  EXPECT_THAT(refusal(R"({"type":"point","intensity":1e999})"), HasSubstr("JSON"));
  EXPECT_THAT(refusal(R"({"type":"point","color":[1,1]})"), HasSubstr("lights[0].color: 3 numbers are expected"));
  GltfMaker maker;
  maker.add("nodes", R"({"extensions":{"KHR_lights_punctual":{"light":0}}})");
  const auto load_it = [&] { (void)load_glb(maker); };
  EXPECT_THAT(test::refusal_of(ErrorCode::file_malformed, load_it),
              HasSubstr("nodes[0].extensions.KHR_lights_punctual.light: 0 does not exist, there are 0"));
}

TEST(GltfLights, BeyondAMillionAreRefusedAndBelowItAreRead) {
  constexpr std::size_t most = std::size_t(1) << 20;
  const auto file_of = [](std::size_t count) {
    std::string text = R"({"asset":{"version":"2.0"},"extensions":{"KHR_lights_punctual":{"lights":[)";
    for (std::size_t i = 0; i < count; ++i) text += i == 0 ? R"({"type":"point"})" : R"(,{"type":"point"})";
    return GltfMaker::glb_of(text + "]}}}", {});
  };
  const auto load_of = [&](std::size_t count) { return load(file_of(count), "t.glb"); };
  EXPECT_THAT(load_of(most).lights, IsEmpty()) << "no node has any";
  EXPECT_THAT(test::refusal_of(ErrorCode::limit_exceeded, [&] { (void)load_of(most + 1); }),
              HasSubstr("extensions.KHR_lights_punctual.lights: 1048577 are more than 1048576"));
}

}  // namespace
}  // namespace frontmost
