// SPDX-License-Identifier: Apache-2.0
// Views and scenes made to break the bounds that culling relies on: every sample still equals the oracle's, to the bit,
// on every instruction set.

#include <gtest/gtest.h>

#include <cstring>

#include "frontmost/zbuffer.h"
#include "support/effort.h"
#include "support/odd_numbers.h"
#include "support/oracle.h"
#include "support/random_scene.h"
#include "support/same_visible.h"

namespace frontmost::test {
namespace {

/// World position of the image point (u, v), 0 to 1 both ways, at a distance.
glm::vec3 in_world(const View& view, double u, double v, double distance) {
  const Projection& p = view.projection;
  const double spread = p.orthographic ? 1 : distance;
  const double x = (p.left + u * (p.right - p.left)) * spread, y = (p.top + v * (p.bottom - p.top)) * spread;
  return glm::vec3(view.eye() + x * view.right() + y * view.up() + distance * view.forward());
}

/// A random value from 10^low to 10^high, uniform in the exponent.
double magnitude(Random& random, double low, double high) {
  return std::pow(10.0, random.within(float(low), float(high)));
}

enum class Where { origin, far_away, tiny, vast };

struct Setting {
  double size = 1;  ///< size of the scene, in scene units
  glm::dvec3 centre{0};
};

Setting random_setting(Random& random) {
  switch (Where(random.below(4))) {
    case Where::origin: return {};
    case Where::far_away: return {1, glm::dvec3(random.point(3e6f))};
    case Where::tiny: return {magnitude(random, -18, -3), glm::dvec3(0)};
    case Where::vast: return {magnitude(random, 3, 18), glm::dvec3(0)};
  }
  return {};
}

Projection random_projection(Random& random, double size, double distance) {
  const double near = distance * magnitude(random, -5, -0.05);
  const ClipDistances clip{near, random.below(3) ? distance + size * random.within(-0.5f, 2) : kInfinity};
  const double right = random.within(-0.2f, 2), left = right - magnitude(random, -2, 1);
  const double top = random.within(-0.2f, 2), bottom = top - magnitude(random, -2, 1);
  switch (random.below(4)) {
    case 0:
      return make_orthographic(left * size, right * size, bottom * size, top * size, {-near, distance + 2 * size});
    case 1: return {false, left, right, bottom, top, {near, std::max(clip.far, 2 * near)}};
    case 2: return make_projection(magnitude(random, -4, 0.49), magnitude(random, -2, 2), {near, kInfinity});
    default: return make_projection(0.8, 1, {near, std::max(clip.far, 2 * near)});
  }
}

View random_hostile_view(Random& random, const Setting& setting) {
  View view;
  view.width = random.below(4) ? 1 + random.below(180) : 1;
  view.height = random.below(4) ? 1 + random.below(5000 / view.width + 20) : 1;
  const double distance = setting.size * magnitude(random, -2, 1);
  const glm::dvec3 gaze = glm::normalize(glm::dvec3(random.point(1)) + glm::dvec3(0, 0, 1e-3));
  view.world_from_eye = random.below(3)
                            ? look_at(setting.centre + gaze * distance, setting.centre, {0, 1, 0})
                            : look_at(setting.centre + glm::dvec3(0, 0, distance), setting.centre, {0, 1, 0});
  view.projection = random_projection(random, setting.size, distance);
  constexpr int kSamples[] = {1, 1, 2, 4, 8, 16};
  view.samples = kSamples[random.below(6)];
  view.culling = Culling(random.below(random.below(8) ? 3 : 4));
  return view;
}

/// A triangle made to be hard for `view`.
void add_hostile_triangle(Mesh& mesh, Random& random, const View& view, const Setting& setting) {
  const glm::vec3 centre(setting.centre);
  const float size = float(setting.size);
  const auto anywhere = [&] { return centre + random.point(size); };
  const double distance = glm::length(glm::dvec3(centre) - view.eye()) * random.within(0.02f, 2);
  switch (random.below(7)) {
    case 0: {  // a speck
      const glm::vec3 p = anywhere();
      return add_triangle(mesh, p, p + random.point(size * 1e-4f), p + random.point(size * 1e-4f));
    }
    case 1: {  // a needle across everything
      const glm::vec3 p = anywhere(), q = p + random.point(size * 100);
      return add_triangle(mesh, p, q, q + random.point(size * 1e-3f));
    }
    case 2: {  // about the picture's border, within a few parts of a pixel
      const double u = random.below(2), v = random.unit();
      const auto near_border = [&] {
        return random.below(2)
                   ? in_world(view, u + random.within(-1, 1) * 1e-3, v + random.within(-0.1f, 0.1f), distance)
                   : in_world(view, v + random.within(-0.1f, 0.1f), u + random.within(-1, 1) * 1e-3, distance);
      };
      return add_triangle(mesh, near_border(), near_border(), near_border());
    }
    case 3: {  // on the near or far plane, up to a rounding error
      const double plane = random.below(2) || std::isinf(view.projection.clip.far) ? view.projection.clip.near
                                                                                   : view.projection.clip.far;
      const auto on_plane = [&] {
        return in_world(view, random.unit(), random.unit(), plane * (1 + 1e-7 * (random.below(5) - 2)));
      };
      return add_triangle(mesh, on_plane(), on_plane(), on_plane());
    }
    case 4:  // beyond everything
      return add_triangle(mesh, centre + random.point(size * 1e4f), centre + random.point(size * 1e4f),
                          centre + random.point(size * 1e4f));
    case 5: {  // fills the picture, parallel to it: hides others, and ties
      return add_triangle(mesh, in_world(view, -0.1, -0.1, distance), in_world(view, 2.2, -0.1, distance),
                          in_world(view, -0.1, 2.2, distance));
    }
    default: {
      const glm::vec3 p = anywhere();
      return add_triangle(mesh, p, p + random.point(size * 0.3f), p + random.point(size * 0.3f));
    }
  }
}

void expect_equal_on_every_isa(const Surfaces& surfaces, const View& view, const Visible& expected) {
  for (const Isa isa : available_isas()) {
    const Visible found = draw_both_ways(surfaces, view, {.threads = 1, .isa = isa});
    for (std::size_t i = 0; i < expected.keys.size(); ++i)
      ASSERT_TRUE(expected.primitives[i] == found.primitives[i] &&
                  std::memcmp(&expected.keys[i], &found.keys[i], sizeof(float)) == 0)
          << name(isa) << ": sample " << i << ": primitive " << expected.primitives[i] << " key " << expected.keys[i]
          << " expected, " << found.primitives[i] << " key " << found.keys[i] << " found";
  }
}

TEST(Hostile, ScenesOfAnySizeAndPlaceInAnyViewEqualTheOracle) {
  std::size_t samples = 0, seen = 0, pictures = 0;
  for (std::uint64_t seed = 0; seed < seeds(400); ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed);
    const Setting setting = random_setting(random);
    const View view = random_hostile_view(random, setting);
    Mesh mesh;
    // Few triangles make isolated clusters, many make small ones.
    const int count = random.below(2) ? 1 + random.below(12) : 300 / view.samples;
    for (int i = 0; i < count; ++i) add_hostile_triangle(mesh, random, view, setting);
    const Scene scene = scene_of(mesh);
    const Surfaces surfaces(scene);
    const Visible expected = oracle(surfaces, view);
    expect_equal_on_every_isa(surfaces, view, expected);
    if (HasFatalFailure()) return;
    std::size_t here = 0;
    for (const PrimitiveId id : expected.primitives) here += id != no_primitive;
    samples += expected.primitives.size();
    seen += here;
    pictures += here > 0;
  }
  EXPECT_GT(seen, samples / 4) << "the scenes have become empty";
  EXPECT_GT(pictures, seeds(400) / 2);
}

}  // namespace
}  // namespace frontmost::test
