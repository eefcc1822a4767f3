// SPDX-License-Identifier: Apache-2.0
// Look-ups of textures at many places at once.
//
//   footprints          taps                  texels of two levels        values
//   u, v, du, dv  -->   1 to 8 places    -->  4 + 4 for each tap    -->   R, G, B, A
//   of fragments        and two levels        bilinear, then between       mean of the taps
//                       for each              the levels
//
// Most textures of a material have one size and are looked up at the same places, so footprints and taps are computed
// once for all of them. A footprint much longer than wide has several taps along it, so that slanted surfaces stay
// sharp. (J. McCormack, R. Perry, K. Farkas, N. Jouppi. Feline: Fast Elliptical Lines for Anisotropic Texture Mapping.
// SIGGRAPH 1999.)
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "frontmost/scene.h"
#include "scene/texture_lookup.h"
#include "shade/batch.h"

namespace frontmost::shading {

/// The encoding of the stored bytes. Colours of both encodings are averaged as light.
enum class Encoding : std::uint8_t { srgb, linear };

/// A texture with its mip levels: each is half as wide and high as the one before, down to a single texel.
/// (L. Williams. Pyramidal Parametrics. SIGGRAPH 1983.)
class Pyramid {
 public:
  struct Level {
    int width = 0, height = 0;
    const glm::u8vec4* texels = nullptr;
  };

  /// Borrows `texture`, which is the first level. Textures marked `nearest` have only that level, empty ones have none.
  /// O(texels), in parallel.
  Pyramid(const Texture& texture, Encoding encoding, const Execution& execution = {});
  Pyramid(const Pyramid&) = delete;  // its levels point into its storage

  [[nodiscard]] const Texture& texture() const { return *texture_; }
  [[nodiscard]] Encoding encoding() const { return encoding_; }
  [[nodiscard]] const std::vector<Level>& levels() const { return levels_; }
  /// Returns width and height of a level and of the next one (or again this one), as floats to multiply coordinates
  /// with.
  [[nodiscard]] const std::array<float, 4>& sizes_from(int level) const { return sizes_[std::size_t(level)]; }

 private:
  void add_level(const Level& from, const Execution& execution);

  const Texture* texture_;
  Encoding encoding_;
  std::vector<Level> levels_;
  std::vector<std::array<float, 4>> sizes_;   ///< by level
  std::vector<Buffer<glm::u8vec4>> storage_;  ///< texels of levels 1 and up
};

inline constexpr int most_taps = 8;         ///< per fragment
inline constexpr int sampled_at_once = 64;  ///< fragments; their taps stay within a first-level cache

/// A texture in the way that a material uses it.
struct TextureSlot {
  const Pyramid* pyramid = nullptr;  ///< null: not set
  TexcoordTransform transform{TextureUse{}};
  std::uint32_t set = 0;  ///< set of texture coordinates
};

/// The taps in textures of one size. `place` and `size` hold four numbers for a tap: for u and v of its finer level,
/// and for u and v of the next level. `upper`, `lower` and `beside` hold two, one for each level.
struct Taps {
  static constexpr int most = most_taps * sampled_at_once;
  struct alignas(64) Fours {
    float values[4 * most];
  };
  int fragments = 0, taps = 0;
  std::uint8_t count[sampled_at_once];  ///< number of taps of each fragment
  std::uint8_t level[sampled_at_once];  ///< number of the finer level of each fragment
  float blend[sampled_at_once];         ///< weight of the next level
  Fours place;                          ///< first the texture coordinates, later the fraction between the first and the
                                        ///< second texel
  Fours size;                           ///< size of the levels, in texels
  std::uint32_t upper[2 * most];        ///< offset of the upper left texel from the level's first one
  std::uint32_t lower[2 * most];        ///< offset of the texel below it
  std::int32_t beside[2 * most];        ///< offset from both to the texels at their right: 1 but at wrapped edges
};

/// Input for taps: the fragments [begin, begin + count), and the levels of a texture.
struct TapRequest {
  const TexcoordLanes& texcoord;
  int begin, count;
  const TexcoordTransform& transform;
  const Pyramid& pyramid;
};

/// Looks up textures for runs of fragments. Used by one thread.
class TextureSampler {
 public:
  explicit TextureSampler(Isa isa) : isa_(isa) {}

  /// Sets the places of later look-ups: those of the fragments [begin, end), at most sampled_at_once. Borrows
  /// `texcoord`.
  void begin(const TexcoordLanes& texcoord, int begin, int end);
  /// Sets out[i - begin] for each fragment i to linear RGBA, blended from bilinear values in the two levels nearest to
  /// the footprint. Textures marked `nearest` give one texel, and empty ones white. Bytes become light by a polynomial
  /// with an error of 1/50 step.
  void sample(const Pyramid& pyramid, const TexcoordTransform& transform, glm::vec4* out);

 private:
  /// The values that determine the taps for given coordinates. The texture's content does not.
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
  std::optional<Places> places_;  ///< the request for which the taps were computed
  Taps taps_;
};

}  // namespace frontmost::shading
