// SPDX-License-Identifier: Apache-2.0
// A batch is a few hundred fragments that are shaded at once, stored as structure of arrays, so that plain loops over
// the arrays vectorize. A fragment is one primitive within one pixel and stands for all samples that it covers there.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>

namespace frontmost::shading {

inline constexpr int batch_capacity = 256;  ///< fragments; all arrays together fit into a second-level cache

inline constexpr int batch_room = batch_capacity + 32;  ///< length of the arrays; a vector may begin at the last
                                                        ///< fragment, and a strip of pixels is written whole

struct alignas(64) Lane {
  float values[batch_room];  ///< no power of two, because lanes a power of two apart would share few sets of the cache
  float& operator[](int i) { return values[i]; }
  const float& operator[](int i) const { return values[i]; }
};

struct Lane2 {
  Lane x, y;
  [[nodiscard]] glm::vec2 at(int i) const { return {x[i], y[i]}; }
  void set(int i, const glm::vec2& v) {
    x[i] = v.x;
    y[i] = v.y;
  }
};

struct Lane3 {
  Lane x, y, z;
  [[nodiscard]] glm::vec3 at(int i) const { return {x[i], y[i], z[i]}; }
  void set(int i, const glm::vec3& v) {
    x[i] = v.x;
    y[i] = v.y;
    z[i] = v.z;
  }
};

/// For each fragment, the steps on the screen to the next pixel to the right (x) and to the next one below (y).
struct PixelSteps {
  Lane2 x, y;
};

/// Where the fragments of a batch are. The arrays are longer than the batch, because loops over whole vectors read and
/// write behind the last fragment.
struct Coverage {
  int count = 0;
  std::uint32_t pixel[batch_room];          ///< number chosen by the caller, such as the pixel within the tile
  std::uint16_t triangle[batch_room] = {};  ///< number of the set-up triangle
  std::uint64_t samples[batch_room];        ///< one bit for each sample of the pixel that the fragment covers
  Lane weight;                              ///< share of the pixel's samples
  Lane2 screen;                             ///< mean position of those samples
  const PixelSteps* steps = nullptr;        ///< null if a pixel is one unit of the screen
};

/// A set of texture coordinates, and their change per pixel.
struct TexcoordLanes {
  Lane2 value, dx, dy;
};

/// Geometric data of each fragment. Positions are in world axes with the eye as origin, so that scenes far from the
/// origin keep their precision.
struct Geometry {
  Lane3 position;
  Lane3 smooth_position;   ///< lifted to the curved surface that the normals suggest; used for shadows
  Lane3 normal;            ///< unit, towards the viewer
  Lane3 plane_normal;      ///< normal of the flat triangle, unit, towards the viewer
  Lane3 to_viewer;         ///< unit
  TexcoordLanes texcoord;  ///< set 0
  Lane3 color;             ///< interpolated vertex colours
  Lane alpha;
  bool has_texcoord = true, has_color = true;  ///< false: all lanes of `texcoord` are 0, those of `color` and `alpha` 1
};

/// Material data of each fragment, all linear.
struct Reflectance {
  Lane3 base, emissive;
  Lane alpha, metallic, roughness, occlusion;
  Lane unlit;  ///< 1 for materials that lights do not change, else 0
};

/// Data of material layers for each fragment. Lanes are defined only if the batch has the layer. A fragment without the
/// layer then has the value that reflects, scatters or transmits nothing.
struct LayerLanes {
  bool has_dielectric = false;  ///< some fragment has a reflectance other than 0.04, or transmits light
  Lane is_dielectric;           ///< 1 for a fragment with such a material, else 0
  Lane3 f0;                     ///< reflectance of the non-metallic part at normal incidence
  Lane f90;                     ///< reflectance at grazing incidence
  Lane transmission;            ///< share of the light below the surface that passes through

  bool has_transmission = false;
  Lane3 filter;   ///< share of the transmitted light that is left by base colour and volume, by channel
  Lane is_shown;  ///< 0 where light leaves a volume, because that surface is invisible; else 1

  bool has_sheen = false;
  Lane3 sheen, sheen_light;  ///< colour of the fibres, and the light that they scatter back
  Lane sheen_roughness;

  bool has_coat = false;
  Lane coat;  ///< share of the surface that is varnished

  void clear() { has_dielectric = has_transmission = has_sheen = has_coat = false; }
};

struct FragmentBatch {
  Coverage coverage;
  Geometry geometry;
  Reflectance material;
  Lane shadow;  ///< share of the current light that arrives
  Lane3 light;  ///< the result: linear, before alpha
  /// Opacity of each colour channel, if one alpha is not enough. `material.alpha` is then the mean of the channels.
  /// Defined only if layers.has_transmission.
  Lane3 alphas;
  LayerLanes layers;
  /// The varnish, if layers.has_coat: the same fragments with the varnish's normal and roughness, and no diffuse part.
  std::unique_ptr<FragmentBatch> coat;
};

}  // namespace frontmost::shading
