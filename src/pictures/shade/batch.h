// SPDX-License-Identifier: Apache-2.0
// What is shaded at once: a few hundred fragments as structure of arrays, so that plain loops over them run many at a
// time. A fragment is one primitive within one pixel, and stands for all samples that it holds there.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>

namespace frontmost::shading {

inline constexpr int batch_capacity = 256;  ///< all arrays together stay within a second-level cache

inline constexpr int batch_room = batch_capacity + 16;  ///< a vector may begin at the last

struct alignas(64) Lane {
  float values[batch_room];  ///< lanes a power of two apart would share the same few sets of the cache
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

/// From each fragment's place on the screen to those of the next pixels to the right and below.
struct PixelSteps {
  Lane2 x, y;
};

/// Where the fragments are: made from a Visible. Whoever writes or reads several at a time may go on behind the last.
struct Coverage {
  int count = 0;
  std::uint32_t pixel[batch_room];          ///< within the tile
  std::uint16_t triangle[batch_room] = {};  ///< number of the set-up triangle
  std::uint64_t samples[batch_room];        ///< which of the pixel's, a bit each
  Lane weight;                              ///< their part of all
  Lane2 screen;                             ///< mean position of those samples
  const PixelSteps* steps = nullptr;        ///< null: pixels are units of the screen
};

/// A set of texture coordinates, and their change per pixel.
struct TexcoordLanes {
  Lane2 value, dx, dy;
};

/// What the geometry says of each fragment. Positions are in world axes, measured from the eye, so that scenes far
/// from the origin lose nothing.
struct Geometry {
  Lane3 position;
  Lane3 smooth_position;   ///< lifted to the curved surface that the normals suggest; what shadows are looked up at
  Lane3 normal;            ///< unit, on the viewer's side
  Lane3 plane_normal;      ///< of the flat triangle, likewise
  Lane3 to_viewer;         ///< unit
  TexcoordLanes texcoord;  ///< set 0
  Lane3 color;             ///< of the vertices
  Lane alpha;
};

/// What the material says of each fragment, all linear.
struct Reflectance {
  Lane3 base, emissive;
  Lane alpha, metallic, roughness, occlusion;
  Lane unlit;  ///< 1 or 0
};

/// What the layers of materials say of each fragment. Lanes are defined only where their layer is there, which a
/// fragment without it says too: by nothing mirrored, sent back or let through.
struct LayerLanes {
  bool has_dielectric = false;  ///< any fragment mirrors otherwise than by a reflectance of 0.04, or lets light through
  Lane is_dielectric;           ///< 1 or 0: of those
  Lane3 f0;                     ///< of what is no metal: mirrored, seen from straight ahead
  Lane f90;                     ///< at a grazing angle
  Lane transmission;            ///< part of the light below the surface that passes

  bool has_transmission = false;
  Lane3 filter;   ///< part of what passes that the base colour and a volume leave, by channel
  Lane is_shown;  ///< 0: the way out of a volume, which shows nothing by itself

  bool has_sheen = false;
  Lane3 sheen, sheen_light;  ///< colour; and what the fibres send back
  Lane sheen_roughness;

  bool has_coat = false;
  Lane coat;  ///< how much of the surface is varnished

  void clear() { has_dielectric = has_transmission = has_sheen = has_coat = false; }
};

struct FragmentBatch {
  Coverage coverage;
  Geometry geometry;
  Reflectance material;
  Lane shadow;  ///< part of the key light that arrives
  Lane3 light;  ///< the answer: linear, before alpha
  /// How much of what is behind is hidden, by channel, where the material's alpha is not all that there is to say; then
  /// this is the mean of them. Only where layers.has_transmission.
  Lane3 alphas;
  LayerLanes layers;
  /// The varnish, where layers.has_coat: the same fragments with its normal and roughness, and nothing matt below.
  std::unique_ptr<FragmentBatch> coat;
};

}  // namespace frontmost::shading
