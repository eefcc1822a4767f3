// SPDX-License-Identifier: Apache-2.0
// Pictures through glass: glass tints the surfaces behind by channel, in depth order, and adds its reflection.
#include <gtest/gtest.h>

#include <cmath>

#include "frontmost/pictures.h"
#include "frontmost/zbuffer.h"
#include "shade/shadow/light_shadows.h"
#include "shade/support.h"

namespace frontmost {
namespace {

using namespace test;

/// Reflected share at normal incidence, for an index of refraction of 1.5.
constexpr float kMirrored = 0.04f;

Material unlit(const glm::vec3& color) {
  Material material = colored(glm::vec4(color, 1));
  material.unlit = true;
  return material;
}

Material glass(const glm::vec3& tint, float transmission = 1) {
  Material material = colored(glm::vec4(tint, 1));
  material.roughness = 0.5f;
  material.transmission.factor = transmission;
  return material;
}

/// Squares of these materials one behind the other, the first one nearest.
Scene panes(const std::vector<Material>& materials) {
  Scene scene;
  scene.name = "panes";
  scene.up = Axis::y;
  for (const Material& material : materials) {
    const auto i = std::uint32_t(scene.meshes.size());
    Mesh mesh = square();
    mesh.material_ids = {i};
    const std::uint32_t object = add(scene, std::move(mesh));
    scene.instances[object].world_from_mesh[3] = {0, 0, -double(i), 1};
    scene.materials.push_back(material);
  }
  return scene;
}

glm::vec4 middle_of(const Scene& scene, const ShadeOptions& options) {
  const Surfaces surfaces(scene);
  return color_at(shade(surfaces, zbuffer(surfaces, front_view()), options), 30, 35);
}

const ShadeOptions flat{.shading = Shading::flat};
const ShadeOptions unshadowed{.light = {.shadows = Shadows::off}};

void expect_near(const glm::vec4& color, const glm::vec3& wanted, float tolerance, const char* what = "") {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(color[c], wanted[c], tolerance) << what << ", channel " << c;
}

TEST(Glass, TintsWhatIsBehindByItsBaseColour) {
  const glm::vec3 tint{0.9f, 0.5f, 0.1f}, behind{0.2f, 0.6f, 0.8f};
  expect_near(middle_of(panes({glass(tint), unlit(behind)}), flat), tint * behind, 1e-5f);
  // Half of the light is scattered back as by matt paint.
  expect_near(middle_of(panes({glass(tint, 0.5f), unlit(behind)}), flat), 0.5f * tint * behind + 0.5f * tint, 1e-5f);
  // Metal lets nothing through.
  Material metal = glass(tint);
  metal.metallic = 1;
  expect_near(middle_of(panes({metal, unlit(behind)}), flat), glm::vec3(0), 1e-5f);
}

TEST(Glass, TwoPanesTintTwiceInWhateverOrder) {
  const glm::vec3 first{0.9f, 0.5f, 0.25f}, second{0.5f, 1, 0.75f}, behind{0.8f};
  expect_near(middle_of(panes({glass(first), glass(second), unlit(behind)}), flat), first * second * behind, 1e-5f);
  // A surface between two panes is tinted by the first pane only.
  Material half = colored({0, 1, 0, 0.5f});
  half.alpha = Material::Alpha::blend;
  half.unlit = true;
  const glm::vec3 between = first * (0.5f * glm::vec3(0, 1, 0) + 0.5f * second * behind);
  expect_near(middle_of(panes({glass(first), half, glass(second), unlit(behind)}), flat), between, 1e-5f);
}

// Whatever light falls on the glass, a change behind it shows through by the share that is not reflected.
TEST(Glass, LitGlassLetsThroughWhatItDoesNotMirror) {
  const glm::vec3 tint{0.9f, 0.5f, 0.1f};
  const glm::vec4 dark = middle_of(panes({glass(tint), unlit(glm::vec3(0))}), unshadowed);
  const glm::vec4 bright = middle_of(panes({glass(tint), unlit(glm::vec3(0.5f))}), unshadowed);
  expect_near(bright - dark, 0.5f * (1 - kMirrored) * tint, 1e-5f);
  EXPECT_GT(dark.x, 0.0f) << "it mirrors";
}

TEST(Glass, HighlightsAreThoseOfABlackSurface) {
  const Material clear = glass(glm::vec3(1));
  Material black = colored({0, 0, 0, 1});
  black.roughness = clear.roughness;
  const glm::vec4 of_black = middle_of(panes({black}), unshadowed);
  EXPECT_GT(of_black.x, 0.005f);
  expect_near(middle_of(panes({clear, unlit(glm::vec3(0))}), unshadowed), glm::vec3(of_black), 2e-5f);
  // Highlights are visible without anything behind, and a transparent picture keeps them.
  ShadeOptions over_nothing = unshadowed;
  over_nothing.background = std::nullopt;
  const glm::vec4 alone = middle_of(panes({clear}), over_nothing);
  expect_near(alone, glm::vec3(of_black), 2e-5f);
  EXPECT_NEAR(alone.a, kMirrored, 1e-5f);
}

// An environment of one colour gives the same picture as a background of that colour.
TEST(Glass, TintsAShownEnvironmentAsItTintsABackground) {
  const float grey = 0.5f, radiance = std::pow((grey + 0.055f) / 1.055f, 2.4f);
  Image picture{4, 2, {}};
  for (const char* name : {"R", "G", "B"}) picture.channels.push_back({name, Buffer<float>(8, radiance)});
  ShadeOptions options = unshadowed;
  options.light.environment = Environment(picture);
  options.background = glm::vec3(grey);
  const Scene scene = panes({glass({0.9f, 0.5f, 0.1f}), glass({0.2f, 0.6f, 0.8f})});
  const Surfaces surfaces(scene);
  const Visible seen = zbuffer(surfaces, front_view());
  const Image expected = shade(surfaces, seen, options);
  options.light.shows_environment = true;
  for (const std::optional<glm::vec3> background : {std::optional(glm::vec3(1)), std::optional<glm::vec3>()}) {
    options.background = background;
    const Image shown = shade(surfaces, seen, options);
    for (std::size_t k = 0; k < 4; ++k)
      for (std::size_t i = 0; i < seen.view.pixel_count(); ++i)
        ASSERT_NEAR(shown.channels[k].floats()[i], expected.channels[k].floats()[i], 2e-5f) << k << ' ' << i;
  }
}

TEST(Glass, TintsTheBackgroundToo) {
  const glm::vec3 tint{0.9f, 0.5f, 0.1f};
  expect_near(middle_of(panes({glass(tint)}), flat), tint, 1e-5f);
  ShadeOptions over_nothing = flat;
  over_nothing.background = std::nullopt;
  const glm::vec4 color = middle_of(panes({glass(tint)}), over_nothing);
  expect_near(color, glm::vec3(0), 1e-5f);
  EXPECT_NEAR(color.a, 0.5f, 1e-5f) << "the mean of the channels";
}

TEST(Glass, AVolumeTakesLightByBeersLaw) {
  Material amber = glass({1, 1, 1});
  amber.volume.thickness = 0.5f;
  amber.volume.attenuation_distance = 2;
  amber.volume.attenuation_color = {0.81f, 0.25f, 0.0001f};
  Scene scene = panes({amber, unlit(glm::vec3(0.7f))});
  const auto left = [&](float way) {
    const auto power = [&](float color) { return std::pow(color, way / 2); };
    return 0.7f * glm::vec3(power(0.81f), power(0.25f), power(0.0001f));
  };
  expect_near(middle_of(scene, flat), left(0.5f), 1e-5f);
  // A larger instance is thicker.
  scene.instances[0].world_from_mesh = glm::dmat4(3);
  scene.instances[0].world_from_mesh[3] = {0, 0, 0, 1};
  expect_near(middle_of(scene, flat), left(1.5f), 1e-5f);
  // The thickness texture uses the green channel.
  scene.textures.push_back(texture_of(1, 1, {{0, 51, 255, 0}}));
  scene.materials[0].volume.thickness_texture.texture = 0;
  expect_near(middle_of(scene, flat), left(0.3f), 1e-5f);
}

TEST(Glass, OutOfAVolumeLightComesAsItIs) {
  Material jade = glass({0.5f, 0.9f, 0.5f});
  jade.volume.thickness = 1;
  Scene scene = panes({jade, jade, unlit(glm::vec3(1))});
  // The second pane is reversed, so that it is the back of the volume.
  scene.instances[1].world_from_mesh[0][0] = -1;
  scene.meshes[1].triangles = {{0, 2, 1}, {0, 3, 2}};
  scene.instances[1].world_from_mesh[0][0] = 1;
  expect_near(middle_of(scene, flat), glm::vec3(0.5f, 0.9f, 0.5f), 1e-5f);
  const glm::vec4 with_back = middle_of(scene, unshadowed);
  scene.instances.erase(scene.instances.begin() + 1);
  expect_near(with_back, glm::vec3(middle_of(scene, unshadowed)), 1e-6f, "it mirrors nothing");
  // A thin wall tints on both sides.
  Scene thin = panes({glass({0.5f, 0.9f, 0.5f}), unlit(glm::vec3(1))});
  thin.meshes[0].triangles = {{0, 2, 1}, {0, 3, 2}};
  expect_near(middle_of(thin, flat), glm::vec3(0.5f, 0.9f, 0.5f), 1e-5f);
}

TEST(Glass, ATextureSaysWhereItIs) {
  Scene scene = panes({glass(glm::vec3(1)), unlit({1, 0, 0})});
  scene.textures.push_back(texture_of(2, 1, {{255, 0, 0, 255}, {0, 255, 255, 255}}));
  scene.textures[0].nearest = true;
  scene.materials[0].transmission.factor_texture.texture = 0;
  const Surfaces surfaces(scene);
  const Image image = shade(surfaces, zbuffer(surfaces, front_view()), flat);
  expect_near(color_at(image, 20, 32), {1, 0, 0}, 1e-5f);
  expect_near(color_at(image, 44, 32), {1, 1, 1}, 1e-5f);
}

TEST(Glass, ThrowsNoShadow) {
  for (const bool is_glass : {true, false}) {
    const Scene scene = panes({is_glass ? glass(glm::vec3(1)) : colored(glm::vec4(1)), colored(glm::vec4(1))});
    EXPECT_EQ(shading::has_see_through(scene), is_glass);
    EXPECT_EQ(triangle_count(shading::opaque_part(scene)), is_glass ? 2u : 4u);
  }
  Material unlit_glass = glass(glm::vec3(1));
  unlit_glass.unlit = true;
  EXPECT_FALSE(shading::has_see_through(panes({unlit_glass})));
}

TEST(Glass, SamplesInstructionSetsAndThreadsAgree) {
  const Scene scene = panes({glass({0.9f, 0.5f, 0.1f}), glass({0.5f, 0.9f, 1}), colored({0.2f, 0.6f, 0.8f, 1})});
  const Surfaces surfaces(scene);
  const Visible visible = zbuffer(surfaces, front_view(50, 4));
  const std::uint64_t hash = content_hash(shade(surfaces, visible));
  for (const Isa isa : available_isas())
    EXPECT_EQ(content_hash(shade(surfaces, visible, {}, {.threads = 3, .isa = isa})), hash) << name(isa);
}

// Invalid numbers still give a picture.
TEST(Glass, HostileNumbersMakeAPicture) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), huge = 1e38f;
  for (const float odd : {nan, -huge, -1.0f, 0.0f, huge, std::numeric_limits<float>::infinity()}) {
    Material m = glass({1, odd, 0.5f});
    m.ior = odd;
    m.metallic = odd;
    for (float* number : {&m.specular.factor, &m.clearcoat.factor, &m.clearcoat.roughness, &m.sheen.roughness,
                          &m.volume.thickness, &m.volume.attenuation_distance})
      *number = odd;
    m.specular.color = m.sheen.color = m.volume.attenuation_color = glm::vec3(odd);
    for (const float transmission : {1.0f, odd}) {
      m.transmission.factor = transmission;
      Scene scene = panes({m, colored(glm::vec4(0.5f))});
      scene.instances[0].world_from_mesh = glm::dmat4(0.5);
      scene.instances[0].world_from_mesh[3] = {0, 0, 0, 1};
      for (const ShadeOptions& options : {flat, unshadowed}) {
        const glm::vec4 color = middle_of(scene, options);
        for (int c = 0; c < 4; ++c) EXPECT_TRUE(color[c] >= 0 && color[c] <= 1.0001f) << odd << ": " << color[c];
      }
    }
  }
}

}  // namespace
}  // namespace frontmost
