// SPDX-License-Identifier: Apache-2.0
// Computes blurred maps and moments from the map of an environment. Specular light is the product of two factors: the
// arriving light, weighted by the lobe at normal incidence, and the share that the surface reflects of light that is 1
// everywhere. (B. Karis. Real Shading in Unreal Engine 4. SIGGRAPH 2013 course.)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shade/environment/prefilter_kernel.cpp"
#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "base/highway-inl.h"
#include "base/isa.h"
#include "base/parallel.h"
#include "scene/turn.h"
#include "shade/environment/prefiltered.h"
// After Highway: a block of its own.
#include "shade/environment/octahedral_lookup-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::shading {
namespace HWY_NAMESPACE {
namespace {

constexpr int kTexelsAtOnce = 64;

struct DirectionLanes {
  float x[kTexelsAtOnce], y[kTexelsAtOnce], z[kTexelsAtOnce];
};

/// The normals of consecutive texels of a row, and two directions perpendicular to each normal.
struct Frames {
  DirectionLanes normal, across, along;
  int count;
};

/// Computes the two directions that are perpendicular to each normal.
void FindFrames(Frames& frames) {
  for (int i = 0; i < frames.count; ++i) {
    const Direction n{frames.normal.x[i], frames.normal.y[i], frames.normal.z[i]};
    // Chooses an axis that is roughly perpendicular to the normal.
    const bool is_upright = std::abs(n.y) > 0.7f;
    const float x = is_upright ? 0.0f : n.z, y = is_upright ? -n.z : 0.0f, z = is_upright ? n.y : -n.x;
    const float scale = 1.0f / std::sqrt(x * x + y * y + z * z);
    const Direction a{x * scale, y * scale, z * scale};
    frames.across.x[i] = a.x;
    frames.across.y[i] = a.y;
    frames.across.z[i] = a.z;
    frames.along.x[i] = n.y * a.z - n.z * a.y;
    frames.along.y[i] = n.z * a.x - n.x * a.z;
    frames.along.z[i] = n.x * a.y - n.y * a.x;
  }
}

void FindSquares(const Frames& frames, const glm::vec3& towards, std::int32_t size,
                 TexelSquares<kTexelsAtOnce>& squares) {
  const float across = towards.x, along = towards.y, ahead = towards.z;
  for (int i = 0; i < frames.count; ++i) {
    const Direction d{across * frames.across.x[i] + along * frames.along.x[i] + ahead * frames.normal.x[i],
                      across * frames.across.y[i] + along * frames.along.y[i] + ahead * frames.normal.y[i],
                      across * frames.across.z[i] + along * frames.along.z[i] + ahead * frames.normal.z[i]};
    squares.set(i, texel_square(octahedral_place(d), size));
  }
}

}  // namespace

void BlurTexels(std::span<const OctahedralMap> maps, std::span<const LobeDirection> lobe, const glm::vec3* normals,
                int count, float* out) {
  const DTexels d;
  Frames frames;
  frames.count = count;
  for (int i = 0; i < count; ++i) {
    frames.normal.x[i] = normals[i].x;
    frames.normal.y[i] = normals[i].y;
    frames.normal.z[i] = normals[i].z;
  }
  FindFrames(frames);
  alignas(64) float sums[kTexelsAtOnce * kPairLanes] = {};
  TexelSquares<kTexelsAtOnce> squares;
  for (const LobeDirection& direction : lobe) {
    const OctahedralMap& map = maps[std::size_t(direction.map)];
    FindSquares(frames, direction.towards, map.size(), squares);
    for (int i = 0; i < count; ++i) {
      VTexels sum[kTexelParts];
      float* const place = sums + i * kPairLanes;
      for (int part = 0; part < kTexelParts; ++part) sum[part] = hn::Load(d, place + part * kTexelLanes);
      AddSquare(map.texels(), OctahedralMap::channels * map.stride(), squares.at(i), direction.weight, sum);
      for (int part = 0; part < kTexelParts; ++part) hn::Store(sum[part], d, place + part * kTexelLanes);
    }
  }
  for (int i = 0; i < count; ++i) {
    const float* const columns = sums + i * kPairLanes;
    for (int k = 0; k < OctahedralMap::channels; ++k)
      out[OctahedralMap::channels * i + k] = columns[k] + columns[k + OctahedralMap::channels];
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::shading
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace frontmost::shading {

FRONTMOST_KERNELS(BlurTexels);

namespace {

constexpr double kPi = 3.14159265358979323846;

/// Returns the map and its reductions, each half as wide as the one before, down to 4 texels.
std::vector<OctahedralMap> halves_of(const OctahedralMap& map) {
  std::vector<OctahedralMap> maps{map};
  while (maps.back().size() > 4) maps.push_back(maps.back().half());
  return maps;
}

/// How a level is made. `most_texels` limits its texels per side, `least_ratio` is the least ratio of level 0's side
/// length to that of the level, and `directions` is the number of directions of the lobe. Texels are narrower than a
/// quarter of the level's blur. Wide lobes need more directions.
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

/// Returns up to `count` directions of the GGX lobe of a roughness above 0, weighted by the cosine. They are meant for
/// look-ups in `maps`, each of which is half as wide as the one before.
std::vector<LobeDirection> lobe_directions(double roughness, int count, std::span<const OctahedralMap> maps) {
  const double alpha2 = roughness * roughness * roughness * roughness;
  const double size = maps.front().size(), texel = 4 * kPi / (size * size);  // solid angle of a texel of the finest map
  std::vector<LobeDirection> lobe;
  double weights = 0;
  for (int i = 0; i < count; ++i) {
    const double u = (i + 0.5) / count, half2 = (1 - u) / (1 + (alpha2 - 1) * u);  // half2: squared cosine N.H
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

/// Fills row y of `out`. Each texel becomes the light in `maps`, weighted by the lobe around the direction of the
/// texel.
void blur_row(std::span<const OctahedralMap> maps, std::span<const LobeDirection> lobe, int y, OctahedralMap& out,
              Isa isa) {
  constexpr int texels_at_once = 64;
  std::array<glm::vec3, texels_at_once> normals;
  for (int begin = 0; begin < out.size(); begin += texels_at_once) {
    const int count = std::min(texels_at_once, out.size() - begin);
    for (int i = 0; i < count; ++i)
      normals[std::size_t(i)] = glm::normalize(octahedron_point(out.size(), begin + i, y));
    kernel_for(BlurTexelsKernels, isa)(maps, lobe, normals.data(), count, out.texel(begin, y));
  }
}

}  // namespace

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
#endif  // HWY_ONCE
