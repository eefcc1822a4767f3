// SPDX-License-Identifier: Apache-2.0
// Environments: data derived from a picture of all directions, against sums over all directions.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <limits>

#include "frontmost/pictures.h"
#include "shade/environment/prefiltered.h"
#include "support/odd_numbers.h"

namespace frontmost::test {
namespace {

constexpr double kPi = 3.14159265358979323846;

Image picture_of(int width, const std::function<glm::vec3(const glm::dvec3&)>& light) {
  Image picture{width, width / 2, {}};
  const auto count = std::size_t(width) * std::size_t(width / 2);
  for (const char* name : {"R", "G", "B"}) picture.channels.push_back({name, Buffer<float>(count)});
  for (int y = 0; y < width / 2; ++y)
    for (int x = 0; x < width; ++x) {
      const double azimuth = ((x + 0.5) / width - 0.5) * 2 * kPi, elevation = (0.5 - (y + 0.5) / (width / 2)) * kPi;
      const glm::vec3 color = light(
          {std::sin(azimuth) * std::cos(elevation), std::sin(elevation), -std::cos(azimuth) * std::cos(elevation)});
      for (std::size_t k = 0; k < 3; ++k) picture.channels[k].floats()[std::size_t(y * width + x)] = color[int(k)];
    }
  return picture;
}

/// A dim surrounding with a bright lamp some degrees wide, and a floor of another colour.
glm::vec3 lamp(const glm::dvec3& d) {
  const double c = glm::dot(d, glm::normalize(glm::dvec3(0.6, 0.5, -0.7)));
  const glm::vec3 around = d.y < 0 ? glm::vec3(0.3f, 0.2f, 0.1f) : glm::vec3(0.2f, 0.3f, 0.5f);
  return around + glm::vec3(float(8 / (1 + std::exp((0.93 - c) * 200))));
}

std::vector<glm::dvec3> directions(int count) {
  std::vector<glm::dvec3> all;
  for (int i = 0; i < count; ++i) {
    const double y = 1 - (2 * i + 1.0) / count, r = std::sqrt(1 - y * y), phi = i * kPi * (3 - std::sqrt(5.0));
    all.push_back({r * std::cos(phi), y, r * std::sin(phi)});
  }
  return all;
}

/// The definition of Environment::radiance(), by a sum over evenly spread directions.
glm::dvec3 mirrored(const std::function<glm::vec3(const glm::dvec3&)>& light, const glm::dvec3& towards,
                    double roughness) {
  static const std::vector<glm::dvec3> all = directions(60'000);
  const double a2 = std::pow(roughness, 4);
  glm::dvec3 sum(0);
  double weights = 0;
  for (const glm::dvec3& d : all) {
    const double cosine = glm::dot(d, towards);
    if (cosine <= 0) continue;
    const double t = (1 + cosine) / 2 * (a2 - 1) + 1, weight = a2 / (t * t) * cosine;
    sum += weight * glm::dvec3(light(d));
    weights += weight;
  }
  return sum / weights;
}

TEST(Environment, OneLightFromEverywhereStaysWhatItIs) {
  const Environment environment(picture_of(256, [](const glm::dvec3&) { return glm::vec3(1, 0.5f, 0.25f); }));
  for (const glm::dvec3& d : directions(50)) {
    for (float roughness = 0; roughness <= 1; roughness += 0.0625f)
      EXPECT_NEAR(environment.radiance(glm::vec3(d), roughness).x, 1, 1e-5) << roughness;
    EXPECT_NEAR(environment.radiance(glm::vec3(d), 0.3f).z, 0.25, 1e-5);
    EXPECT_NEAR(environment.irradiance(glm::vec3(d)).y, 0.5, 2e-4);  // moments are sums over texels
  }
}

TEST(Environment, DirectionsHaveAnyLengthAndRoughnessesAreLimited) {
  const Environment studio = Environment::studio();
  const glm::vec3 towards(-0.48f, 0.68f, 0.72f), light = studio.radiance(towards, 0.3f);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const float length : {1e-36f, 1e-10f, 7.0f, 3e38f})
    EXPECT_NEAR(studio.radiance(towards * length, 0.3f).x, light.x, 1e-5f) << length;
  for (const float roughness : {nan, -1.0f}) EXPECT_EQ(studio.radiance(towards, roughness), studio.radiance(towards));
  EXPECT_EQ(studio.radiance(towards, 1e30f), studio.radiance(towards, 1));
  // A direction that is not finite violates the contract, but must not read out of bounds.
  (void)studio.radiance({nan, 0, 0}, 0.3f);
  (void)studio.radiance(glm::vec3(0), 0.3f);
}

TEST(Environment, DirectionsAreThoseOfAPanorama) {
  const glm::dvec3 axes[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  for (const glm::dvec3& axis : axes) {
    const Environment environment(
        picture_of(128, [&](const glm::dvec3& d) { return glm::vec3(glm::dot(d, axis) > 0.8 ? 1.0f : 0.0f); }));
    for (const glm::dvec3& other : axes) {
      EXPECT_NEAR(environment.radiance(glm::vec3(other)).x, other == axis ? 1 : 0, 1e-5);
      EXPECT_LT(environment.irradiance(glm::vec3(other)).x, other == axis ? 1 : 0.2);
    }
    EXPECT_GT(environment.irradiance(glm::vec3(axis)).x, 0.25);
  }
}

TEST(Environment, RoughSurfacesMirrorTheMeanOverTheirLobe) {
  const Environment environment(picture_of(1024, lamp));
  double greatest = 0;
  for (int level = 2; level <= 8; ++level) {
    const float roughness = float(level) / 8;
    for (const glm::dvec3& d : directions(40)) {
      const glm::dvec3 expected = mirrored(lamp, d, double(roughness));
      const glm::vec3 found = environment.radiance(glm::vec3(d), roughness);
      for (int k = 0; k < 3; ++k) {
        greatest = std::max(greatest, std::abs(double(found[k]) - expected[k]));
        EXPECT_NEAR(found[k], expected[k], 0.04 + 0.04 * expected[k]) << roughness << " " << k;
      }
    }
  }
  RecordProperty("greatest_difference", std::to_string(greatest));
}

TEST(Environment, MattSurfacesSendBackTheSumOverTheCosine) {
  const Environment environment(picture_of(512, lamp));
  const std::vector<glm::dvec3> all = directions(100'000);
  for (const glm::dvec3& n : directions(40)) {
    glm::dvec3 sum(0);
    for (const glm::dvec3& d : all) sum += std::max(0.0, glm::dot(n, d)) * glm::dvec3(lamp(d));
    const glm::dvec3 expected = sum * (4.0 / double(all.size()));
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(environment.irradiance(glm::vec3(n))[k], expected[k], 0.08) << k;
  }
}

/// Total light of a map, weighted by solid angle.
double whole_light(const shading::OctahedralMap& map) {
  double sum = 0;
  for (int y = 0; y < map.size(); ++y)
    for (int x = 0; x < map.size(); ++x)
      sum += double(map.color(x, y).x) * double(shading::solid_angle(shading::octahedron_point(map.size(), x, y)));
  return sum * 4 / map.size() / map.size();
}

TEST(Environment, ASunOfOnePixelIsInEveryLevel) {
  for (const int width : {256, 1000, 2048}) {
    Image picture = picture_of(width, [](const glm::dvec3&) { return glm::vec3(0); });
    const glm::ivec2 at(int(width * 0.44), int(width * 0.19));
    const double elevation = (0.5 - (at.y + 0.5) / (width / 2)) * kPi;
    const double angle = 2 * kPi * kPi / width / (width / 2) * std::cos(elevation);
    for (Channel& channel : picture.channels) channel.floats()[std::size_t(at.y * width + at.x)] = 1e6f;
    const Environment environment(std::move(picture));
    for (const shading::OctahedralMap& level : shading::prefiltered(environment).levels)
      EXPECT_NEAR(whole_light(level) / (1e6 * angle), 1, 0.1) << width << " " << level.size();
  }
}

TEST(Environment, NothingIsLostAcrossTheFoldsOfTheOctahedron) {
  // Neighbouring directions have similar colours, in all levels, wherever the square is folded or cut.
  const Environment environment(picture_of(256, [](const glm::dvec3& d) { return glm::vec3(d * 0.5 + 0.5); }));
  for (const glm::dvec3& d : directions(3000))
    for (const float roughness : {0.0f, 0.3f, 1.0f}) {
      const glm::vec3 here = environment.radiance(glm::vec3(d), roughness);
      const glm::vec3 there = environment.radiance(glm::vec3(d + glm::dvec3(1e-3, -1e-3, 1e-3)), roughness);
      for (int k = 0; k < 3; ++k) ASSERT_NEAR(here[k], there[k], 2e-3) << roughness;
    }
}

TEST(Environment, SameBitsOnEveryInstructionSetAndForAnyNumberOfThreads) {
  const Image picture = picture_of(300, lamp);
  const Environment expected(picture, {.threads = 1});
  const auto expect_same = [&](const Execution& execution) {
    const Environment found(picture, execution);
    for (std::size_t k = 0; k < shading::prefiltered(expected).levels.size(); ++k) {
      const shading::OctahedralMap &a = shading::prefiltered(expected).levels[k],
                                   &b = shading::prefiltered(found).levels[k];
      ASSERT_EQ(a.size(), b.size());
      const std::size_t bytes = std::size_t(a.stride() * a.stride() * shading::OctahedralMap::channels) * sizeof(float);
      EXPECT_EQ(std::memcmp(a.texels(), b.texels(), bytes), 0) << name(execution.isa) << " " << k;
    }
    EXPECT_EQ(expected.irradiance({0, 0, 1}), found.irradiance({0, 0, 1}));
  };
  for (const Isa isa : available_isas()) expect_same({.threads = 1, .isa = isa});
  for (const int threads : {2, 3, 8}) expect_same({.threads = threads});
}

TEST(Environment, TheStudioIsAsBrightAsItSaysAndHasNoColour) {
  const Environment studio = Environment::studio();
  EXPECT_TRUE(studio.turns_with_camera());
  EXPECT_EQ(studio.picture(), nullptr);
  EXPECT_NEAR(studio.irradiance({0, 1, 0}).x, 0.36, 0.02);
  EXPECT_NEAR(studio.irradiance({0, -1, 0}).x, 0.15, 0.02);
  for (const glm::dvec3& d : directions(100)) {
    const glm::vec3 light = studio.radiance(glm::vec3(d), 0.2f);
    EXPECT_EQ(light.r, light.g);
    EXPECT_EQ(light.g, light.b);
  }
  EXPECT_GT(studio.radiance({-0.48f, 0.68f, 0.72f}).x, 1.0f) << "the box beside the key light";
}

TEST(Environment, TheSkyIsBlueAboveAndDullBelowAndStaysWhereItIs) {
  const Environment sky = Environment::sky();
  EXPECT_FALSE(sky.turns_with_camera());
  const glm::vec3 above = sky.radiance({0, 1, 0}), below = sky.radiance({0, -1, 0});
  EXPECT_GT(above.b, 1.5f * above.r);
  EXPECT_LT(below.b, below.r);
}

TEST(Environment, NoneIsDark) {
  const Environment none = Environment::none();
  EXPECT_EQ(none.radiance({0, 1, 0}, 0.5f), glm::vec3(0));
  EXPECT_EQ(none.irradiance({0, 1, 0}), glm::vec3(0));
}

TEST(Environment, RefusesWhatIsNoEnvironment) {
  const auto expect_refused = [](Image picture, ErrorCode code, const std::string& reason) {
    try {
      const Environment environment(std::move(picture));
      ADD_FAILURE() << reason;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), code);
      EXPECT_EQ(std::string(error.what()), reason);
    }
  };
  const Image good = picture_of(16, lamp);
  Image square = good;
  square.width = 8;
  square.height = 16;
  expect_refused(square, ErrorCode::bad_argument,
                 "environment: must be twice as wide as high (equirectangular), not 8 x 16");
  Image grey = good;
  grey.channels.resize(1);
  expect_refused(grey, ErrorCode::bad_argument, "environment: needs a channel G of floats");
  Image ids = good;
  ids.channels[2].values = Buffer<std::uint32_t>(16 * 8, 1u);
  expect_refused(ids, ErrorCode::bad_argument, "environment: needs a channel B of floats");
  const float inf = std::numeric_limits<float>::infinity();
  for (const float bad : {kNan, inf, -inf, -1.0f, 2 * max_environment_value}) {
    Image hostile = good;
    hostile.channels[1].floats()[5] = bad;
    expect_refused(hostile, ErrorCode::bad_argument, "environment: channel G: values must be 0 to 16777216");
  }
  Image empty;
  EXPECT_THROW(Environment{empty}, Error);
  // The dimmest and the brightest valid values.
  Image least{2, 1, {}};
  for (const char* name : {"R", "G", "B"}) least.channels.push_back({name, Buffer<float>(2, max_environment_value)});
  const Environment environment(std::move(least));
  EXPECT_NEAR(environment.radiance({0, 1, 0}, 0.7f).x / max_environment_value, 1, 1e-5);
  EXPECT_EQ(environment.picture()->width, 2);
}

}  // namespace
}  // namespace frontmost::test
