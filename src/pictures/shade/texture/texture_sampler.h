// SPDX-License-Identifier: Apache-2.0
// What textures say at many places at once.
//
//   footprints          taps                  texels of two levels        values
//   u, v, du, dv  -->   1 to 8 places    -->  4 + 4 for each tap    -->   R, G, B, A
//   of fragments        and two levels        bilinear, then between       mean of the taps
//                       for each              the levels
//
// The textures of a material mostly have one size and are looked up at the same places: footprints and taps are found
// once for all of them. A footprint that is much longer than wide has several taps along it, so that surfaces seen at a
// slant stay sharp. (J. McCormack, R. Perry, K. Farkas, N. Jouppi. Feline: Fast Elliptical Lines for Anisotropic
// Texture Mapping. SIGGRAPH 1999.)
#pragma once

#include <optional>

#include "scene/texture_lookup.h"
#include "shade/batch.h"
#include "shade/texture/pyramid.h"

namespace frontmost::shading {

inline constexpr int most_taps = 8;         ///< of a fragment
inline constexpr int sampled_at_once = 64;  ///< fragments: their taps stay within a first-level cache

/// A texture as a material uses it.
struct TextureSlot {
  const Pyramid* pyramid = nullptr;  ///< null: not set
  TexcoordTransform transform{TextureUse{}};
  std::uint32_t set = 0;  ///< of texture coordinates
};

/// Where a texture of one size is looked up. Each tap has four numbers of a kind: for u and v of its finer level, and
/// of the next.
struct Taps {
  struct alignas(64) Fours {
    float values[4 * most_taps * sampled_at_once];
  };
  struct alignas(64) FourTexels {
    std::int32_t values[4 * most_taps * sampled_at_once];
  };
  int fragments = 0, taps = 0;
  std::uint8_t count[sampled_at_once];  ///< of each fragment
  std::uint8_t level[sampled_at_once];  ///< the finer one
  float blend[sampled_at_once];         ///< how much of the next
  Fours place;                          ///< texture coordinates; then how far from the first texel to the second
  Fours size;                           ///< of the levels, in texels
  FourTexels first, second;             ///< texels on either side
};

/// What taps are found from: places of the fragments [begin, begin + count), and the levels of a texture.
struct TapRequest {
  const TexcoordLanes& texcoord;
  int begin, count;
  const TexcoordTransform& transform;
  const Pyramid& pyramid;
};

/// Looks up textures for runs of fragments. Reused by one thread.
class TextureSampler {
 public:
  explicit TextureSampler(Isa isa) : isa_(isa) {}

  /// From now on the places are those of the fragments [begin, end), at most sampled_at_once, by `texcoord`, which is
  /// borrowed.
  void begin(const TexcoordLanes& texcoord, int begin, int end);
  /// Sets out[i - begin] for each fragment i to linear RGBA: bilinear in the two levels nearest to the footprint,
  /// blended. Textures marked `nearest` give the one texel, empty ones white. Bytes are taken for light by a polynomial
  /// that is right to 1/50 of a step.
  void sample(const Pyramid& pyramid, const TexcoordTransform& transform, glm::vec4* out);

 private:
  /// What decides where coordinates lead to, for textures of whatever content.
  struct Places {
    int width, height;
    Texture::Wrap wrap_u, wrap_v;
    bool nearest;
    TexcoordTransform transform;
    friend bool operator==(const Places&, const Places&) = default;
  };

  Isa isa_;
  const TexcoordLanes* texcoord_ = nullptr;
  int begin_ = 0, end_ = 0;
  std::optional<Places> places_;  ///< that the taps were found for
  Taps taps_;
};

}  // namespace frontmost::shading
