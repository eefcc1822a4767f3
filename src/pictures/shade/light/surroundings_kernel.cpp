// SPDX-License-Identifier: Apache-2.0
// Mirrored light comes from two maps of the environment, whose roughnesses are next to the surface's own. One map is
// enough if it has exactly that roughness. Maps are read fragment by fragment; all else is plain loops over lanes.

#include "shade/light/lighting.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "shade/light/surroundings_kernel.cpp"
#include "base/highway-inl.h"
#include "base/isa.h"
#include "shade/light/albedo.h"
// After Highway: a block of its own.
#include "shade/environment/octahedral_lookup-inl.h"

HWY_BEFORE_NAMESPACE();
namespace frontmost::shading {
namespace HWY_NAMESPACE {
namespace {

constexpr int kLastLevel = PrefilteredEnvironment::level_count - 1;

/// The texels to read for each fragment: the light that it mirrors, and the share of that light.
struct MirroredPlaces {
  TexelSquares<batch_capacity> smoother, rougher;  ///< in the maps of the two roughnesses
  std::int32_t level[batch_capacity];              ///< level of the smoother map
  float blend[batch_capacity];                     ///< weight of the rougher map
  TexelSquares<batch_capacity> parts;              ///< in MirroredParts
};

/// Returns the square of MirroredParts' entries around a place.
HWY_INLINE TexelSquare parts_square(float column, float row) {
  constexpr std::int32_t last = MirroredParts::size - 2;
  const auto x = std::int32_t(column), y = std::int32_t(row);
  const std::int32_t left = x < last ? x : last, top = y < last ? y : last;
  return {MirroredParts::channels * (top * MirroredParts::size + left), column - float(left), row - float(top)};
}

/// For each fragment, the mirrored view direction as a place in the maps, the level, and the place in MirroredParts.
struct MirroredViews {
  float u[batch_capacity], v[batch_capacity], level[batch_capacity];
  float column[batch_capacity], row[batch_capacity];  ///< position in MirroredParts
};

void FindViews(const Surroundings& around, const FragmentBatch& batch, MirroredViews& out) {
  const Direction across = direction_of(around.world_from_environment[0]);
  const Direction up = direction_of(around.world_from_environment[1]);
  const Direction behind = direction_of(around.world_from_environment[2]);
  constexpr auto last = float(MirroredParts::size - 1);
  for (int i = 0; i < batch.coverage.count; ++i) {
    const Direction n = direction_of(batch.geometry.normal, i), v = direction_of(batch.geometry.to_viewer, i);
    const float twice = 2.0f * dot(n, v), roughness = clamp01(batch.material.roughness[i]);
    const Direction mirrored{twice * n.x - v.x, twice * n.y - v.y, twice * n.z - v.z};
    const OctahedralPlace place = octahedral_place({dot(mirrored, across), dot(mirrored, up), dot(mirrored, behind)});
    out.u[i] = place.u;
    out.v[i] = place.v;
    out.level[i] = roughness * float(kLastLevel);
    out.column[i] = std::sqrt(at_most(towards_viewer(n, v), 1.0f)) * last;
    out.row[i] = roughness * last;
  }
}

/// Finds the texels of all views. This loop is separate, because compilers do not vectorize it together with the one
/// above.
void FindPlaces(const PrefilteredEnvironment& environment, const MirroredViews& views, int count, MirroredPlaces& out) {
  std::int32_t sizes[kLastLevel + 2];
  for (std::size_t k = 0; k <= kLastLevel; ++k) sizes[k] = environment.levels[k].size();
  sizes[kLastLevel + 1] = sizes[kLastLevel];
  for (int i = 0; i < count; ++i) {
    const OctahedralPlace place{views.u[i], views.v[i]};
    const auto level = std::int32_t(views.level[i]);
    out.smoother.set(i, texel_square(place, sizes[level]));
    out.rougher.set(i, texel_square(place, sizes[level + 1]));
    out.level[i] = level;
    out.blend[i] = views.level[i] - float(level);
    out.parts.set(i, parts_square(views.column[i], views.row[i]));
  }
}

/// The values that were read, four channels per fragment.
struct MirroredLight {
  alignas(64) float colors[4 * batch_capacity];
  alignas(64) float parts[4 * batch_capacity];
};

void ReadMaps(const PrefilteredEnvironment& environment, const MirroredPlaces& places, int count, MirroredLight& out) {
  const float* const parts = mirrored_parts().values.data();
  for (int i = 0; i < count; ++i) {
    VTexels light[kTexelParts], part[kTexelParts];
    for (int k = 0; k < kTexelParts; ++k) light[k] = part[k] = hn::Zero(DTexels());
    const float blend = places.blend[i];
    const OctahedralMap* const map = environment.levels.data() + places.level[i];
    AddSquare(map[0].texels(), OctahedralMap::channels * map[0].stride(), places.smoother.at(i), 1.0f - blend, light);
    if (blend > 0)  // never in the last level
      AddSquare(map[1].texels(), OctahedralMap::channels * map[1].stride(), places.rougher.at(i), blend, light);
    StoreSum(light, out.colors + 4 * i);
    AddSquare(parts, MirroredParts::channels * MirroredParts::size, places.parts.at(i), 1.0f, part);
    StoreSum(part, out.parts + 4 * i);
  }
}

/// The monomials of a normal that IrradiancePolynomial multiplies by its coefficients.
struct Monomials {
  float x, y, z, xx, yy, zz, xy, yz, zx;
};
inline Monomials monomials_of(const Direction& n) {
  return {n.x, n.y, n.z, n.x * n.x, n.y * n.y, n.z * n.z, n.x * n.y, n.y * n.z, n.z * n.x};
}
inline float matt_light(const IrradiancePolynomial& p, const Monomials& m, int channel) {
  const float linear = p.x[channel] * m.x + p.y[channel] * m.y + p.z[channel] * m.z;
  const float squares = p.xx[channel] * m.xx + p.yy[channel] * m.yy + p.zz[channel] * m.zz;
  const float products = p.xy[channel] * m.xy + p.yz[channel] * m.yz + p.zx[channel] * m.zx;
  return at_least(p.constant[channel] + linear + (squares + products), 0.0f);
}

/// For light that is 1 everywhere and a surface that mirrors everything: the mirrored share, and that share weighted by
/// Schlick's (1 - V.H)^5.
struct MirroredTerms {
  float part, grazing;
};

/// For one colour channel, the reflected share of light that is 1 everywhere: mirrored once, and mirrored again between
/// the facets of a rough surface. C. Fdez-Aguera. A Multiple-Scattering Microfacet Model for Real-Time Image-based
/// Lighting. Journal of Computer Graphics Techniques 2019.
struct MirroredShares {
  float once, again;
  [[nodiscard]] inline float left() const { return 1.0f - once - again; }
};

inline MirroredShares mirrored_shares(const MirroredTerms& t, const Reflection& m) {
  const float once = m.f0 * (t.part - t.grazing) + m.f90 * t.grazing;
  const float left = 1.0f - t.part, mean_fresnel = m.f0 + (m.f90 - m.f0) * (1.0f / 21);
  return {once, once * mean_fresnel * left / (1.0f - mean_fresnel * left)};
}

template <class Surface>
void AddToSurface(const Surroundings& around, const MirroredLight& mirrored, FragmentBatch& batch) {
  const IrradiancePolynomial irradiance = around.irradiance;  // a copy, which writes below cannot alias
  for (int i = 0; i < batch.coverage.count; ++i) {
    const float* const light = mirrored.colors + 4 * i;
    const MirroredTerms t{mirrored.parts[4 * i], mirrored.parts[4 * i + 1]};
    const Monomials monomials = monomials_of(direction_of(batch.geometry.normal, i));
    const Reflections m = Surface::at(batch, i);
    const MirroredShares red = mirrored_shares(t, m.red), green = mirrored_shares(t, m.green),
                         blue = mirrored_shares(t, m.blue);
    const float least = at_most(at_most(red.left(), green.left()), blue.left());
    const float below_red = red.again + m.red.matt * Surface::below(batch, i, red.left(), least);
    const float below_green = green.again + m.green.matt * Surface::below(batch, i, green.left(), least);
    const float below_blue = blue.again + m.blue.matt * Surface::below(batch, i, blue.left(), least);
    const float occlusion = batch.material.occlusion[i];
    batch.light.x[i] += occlusion * (red.once * light[0] + below_red * matt_light(irradiance, monomials, 0));
    batch.light.y[i] += occlusion * (green.once * light[1] + below_green * matt_light(irradiance, monomials, 1));
    batch.light.z[i] += occlusion * (blue.once * light[2] + below_blue * matt_light(irradiance, monomials, 2));
  }
}

/// Approximates the light that fibres scatter from all around by that of a diffuse surface times their albedo.
void AddSheenAround(const Surroundings& around, FragmentBatch& batch) {
  LayerLanes& layers = batch.layers;
  const SheenAlbedo& albedo = sheen_albedo();
  for (int i = 0; i < batch.coverage.count; ++i) {
    const Direction n = direction_of(batch.geometry.normal, i), v = direction_of(batch.geometry.to_viewer, i);
    const Monomials monomials = monomials_of(n);
    const float part = albedo.at(towards_viewer(n, v), shown_sheen_roughness(layers.sheen_roughness[i]));
    const float arrives = batch.material.occlusion[i] * part;
    layers.sheen_light.x[i] += arrives * layers.sheen.x[i] * matt_light(around.irradiance, monomials, 0);
    layers.sheen_light.y[i] += arrives * layers.sheen.y[i] * matt_light(around.irradiance, monomials, 1);
    layers.sheen_light.z[i] += arrives * layers.sheen.z[i] * matt_light(around.irradiance, monomials, 2);
  }
}

}  // namespace

void AddSurroundings(const Surroundings& around, FragmentBatch& batch) {
  MirroredViews views;
  MirroredPlaces places;
  MirroredLight mirrored;
  FindViews(around, batch, views);
  FindPlaces(*around.environment, views, batch.coverage.count, places);
  ReadMaps(*around.environment, places, batch.coverage.count, mirrored);
  batch.layers.has_dielectric ? AddToSurface<LayeredSurface>(around, mirrored, batch)
                              : AddToSurface<PlainSurface>(around, mirrored, batch);
  if (batch.layers.has_sheen) AddSheenAround(around, batch);
  if (!batch.layers.has_coat) return;
  batch.coat->material.occlusion = batch.material.occlusion;
  AddSurroundings(around, *batch.coat);
}

}  // namespace HWY_NAMESPACE
}  // namespace frontmost::shading
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace frontmost::shading {

FRONTMOST_KERNELS(AddSurroundings);

void add_surroundings(const Surroundings& around, FragmentBatch& batch, Isa isa) {
  if (around.environment) kernel_for(AddSurroundingsKernels, isa)(around, batch);
}

}  // namespace frontmost::shading
#endif  // HWY_ONCE
