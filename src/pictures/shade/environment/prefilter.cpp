// SPDX-License-Identifier: Apache-2.0
// Computes blurred maps and moments from the map of an environment. Specular light is split into two factors: arriving
// light, weighted by the lobe at normal incidence, and the surface's reflection of light that is 1 everywhere. (B.
// Karis. Real Shading in Unreal Engine 4. SIGGRAPH 2013 course.)

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "scene/turn.h"
#include "shade/environment/lobe.h"
#include "shade/environment/prefiltered.h"

namespace frontmost::shading {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// Maps that are each half as wide as the one before, down to 4 texels.
std::vector<OctahedralMap> halves_of(const OctahedralMap& map) {
  std::vector<OctahedralMap> maps{map};
  while (maps.back().size() > 4) maps.push_back(maps.back().half());
  return maps;
}

/// How a level is made: the most texels per side, the least ratio of level 0's side to it, and the directions of the
/// lobe. Texels are narrower than a quarter of the level's blur, and wide lobes need more directions.
struct LevelPlan {
  int most_texels, least_ratio, directions;
};
constexpr std::array<LevelPlan, PrefilteredEnvironment::level_count> kPlans{{{0, 1, 0},
                                                                             {256, 2, 24},
                                                                             {128, 2, 48},
                                                                             {64, 4, 48},
                                                                             {32, 4, 96},
                                                                             {32, 4, 96},
                                                                             {16, 4, 256},
                                                                             {16, 4, 256},
                                                                             {16, 4, 256}}};

IrradianceMoments moments_of(const OctahedralMap& map) {
  IrradianceMoments moments;
  double weights = 0;
  for (int y = 0; y < map.size(); ++y)
    for (int x = 0; x < map.size(); ++x) {
      const glm::vec3 point = octahedron_point(map.size(), x, y);
      const double weight = double(solid_angle(point));
      const glm::dvec3 towards = unit(glm::dvec3(point));
      glm::dmat3 square = glm::outerProduct(towards, towards) - glm::dmat3(1.0 / 3);
      weights += weight;
      for (int k = 0; k < 3; ++k) {
        IrradianceMoments::Moments& m = moments.channels[std::size_t(k)];
        const double light = weight * double(map.texel(x, y)[k]);
        m.mean += light;
        m.first += light * towards;
        m.second += light * square;
      }
    }
  for (IrradianceMoments::Moments& m : moments.channels) {
    m.mean /= weights;
    m.first /= weights;
    m.second /= weights;
  }
  return moments;
}

}  // namespace

std::vector<LobeDirection> lobe_directions(double roughness, int count, std::span<const OctahedralMap> maps) {
  const double alpha2 = roughness * roughness * roughness * roughness;
  const double size = maps.front().size(), texel = 4 * kPi / (size * size);  // solid angle, in the finest map
  std::vector<LobeDirection> lobe;
  double weights = 0;
  for (int i = 0; i < count; ++i) {
    const double u = (i + 0.5) / count, half2 = (1 - u) / (1 + (alpha2 - 1) * u);  // cosine squared of N.H
    const double cosine = 2 * half2 - 1;
    if (cosine <= 0) continue;
    const double sine = std::sqrt(1 - cosine * cosine), t = half2 * (alpha2 - 1) + 1;
    const double density = alpha2 / (kPi * t * t) / 4;
    double texels = 1 / (count * density) / texel;
    int map = 0;
    for (; texels > 4 && map + 1 < int(maps.size()); texels /= 4) ++map;
    const glm::dvec2 around = turn(std::int64_t(i) * 0x9E37, 0x10000);  // steps of about the golden ratio
    lobe.push_back({glm::vec3(sine * around.x, sine * around.y, cosine), float(cosine), map});
    weights += cosine;
  }
  for (LobeDirection& direction : lobe) direction.weight = float(double(direction.weight) / weights);
  return lobe;
}

void prefilter(PrefilteredEnvironment& environment, const Execution& execution) {
  const std::vector<OctahedralMap> maps = halves_of(environment.levels[0]);
  const int size = environment.levels[0].size();
  constexpr int moments_size = 64;
  environment.irradiance = moments_of(
      *std::find_if(maps.begin(), maps.end(), [](const OctahedralMap& map) { return map.size() <= moments_size; }));
  for (int k = 1; k < PrefilteredEnvironment::level_count; ++k) {
    const LevelPlan& plan = kPlans[std::size_t(k)];
    OctahedralMap level(std::min(plan.most_texels, size / plan.least_ratio));
    const std::vector<LobeDirection> lobe =
        lobe_directions(double(k) / (PrefilteredEnvironment::level_count - 1), plan.directions, maps);
    constexpr std::size_t rows_at_once = 4;
    parallel_for(execution, std::size_t(level.size()), rows_at_once, [&](std::size_t begin, std::size_t end) {
      for (std::size_t y = begin; y < end; ++y) blur_row(maps, lobe, int(y), level, execution.isa);
    });
    level.close_border();
    environment.levels[std::size_t(k)] = std::move(level);
  }
}

}  // namespace frontmost::shading
