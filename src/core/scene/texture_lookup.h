// SPDX-License-Identifier: Apache-2.0
// The texels of a texture coordinate: rules of wrapping and turning that all texture readers share.
//
//    u:     0                               1
//           |   0   |   1   |   2   |   3   |
//                     ^first    ^second
//
// Texel i covers [i, i + 1) / size, and its middle is at (i + 0.5) / size. So a coordinate lies between the middles of
// two texels: texel_pair() returns both, and the share of the second.
#pragma once

#include <algorithm>
#include <cmath>

#include "frontmost/scene.h"

namespace frontmost {

[[nodiscard]] inline int floor_of(float value) {
  const int truncated = int(value);
  return truncated - int(float(truncated) > value);
}

/// A texture coordinate brought into [0, 1] by its wrap rule. Values that are not finite, or of 1e6 and more, become 0.
[[nodiscard]] inline float wrapped(float t, Texture::Wrap wrap) {
  // Larger floats have four bits or fewer for the fraction, and floor_of() would soon exceed the range of int.
  if (!(std::abs(t) < 1e6f)) return 0.0f;
  switch (wrap) {
    case Texture::Wrap::clamp: return std::clamp(t, 0.0f, 1.0f);
    case Texture::Wrap::repeat: return t - float(floor_of(t));
    case Texture::Wrap::mirror: {
      const float twice = t - 2.0f * float(floor_of(t * 0.5f));
      return twice > 1.0f ? 2.0f - twice : twice;
    }
  }
  return 0.0f;
}

/// Maps a texel number that is one past an end: to the other end if the texture repeats, else back to the last texel.
[[nodiscard]] inline int neighbour(int i, int size, Texture::Wrap wrap) {
  if (i < 0) return wrap == Texture::Wrap::repeat ? size - 1 : 0;
  if (i >= size) return wrap == Texture::Wrap::repeat ? 0 : size - 1;
  return i;
}

/// The two texels on either side of a coordinate, along one axis. `fraction` is the coordinate's distance from the
/// middle of the first texel, in texels.
struct TexelPair {
  int first, second;
  float fraction;
};
[[nodiscard]] inline TexelPair texel_pair(float t, int size, Texture::Wrap wrap) {
  const float at = wrapped(t, wrap) * float(size) - 0.5f;
  const int low = floor_of(at);
  return {neighbour(low, size, wrap), neighbour(low + 1, size, wrap), at - float(low)};
}

/// The texel that holds a coordinate.
[[nodiscard]] inline int texel_of(float t, int size, Texture::Wrap wrap) {
  return std::min(int(wrapped(t, wrap) * float(size)), size - 1);
}

/// KHR_texture_transform, with sine and cosine computed once.
class TexcoordTransform {
 public:
  explicit TexcoordTransform(const TextureUse& use) : offset_(use.offset) {
    const bool is_turned = use.rotation != 0;
    const float c = is_turned ? float(std::cos(double(use.rotation))) : 1.0f;
    const float s = is_turned ? float(std::sin(double(use.rotation))) : 0.0f;
    across_ = glm::vec2(c, -s) * use.scale.x;
    down_ = glm::vec2(s, c) * use.scale.y;
  }
  /// place() transforms a coordinate; step() transforms the difference of two coordinates.
  [[nodiscard]] glm::vec2 place(const glm::vec2& uv) const { return step(uv) + offset_; }
  [[nodiscard]] glm::vec2 step(const glm::vec2& v) const { return across_ * v.x + down_ * v.y; }

  // For kernels, which transform many coordinates at once.
  [[nodiscard]] const glm::vec2& across() const { return across_; }
  [[nodiscard]] const glm::vec2& down() const { return down_; }
  [[nodiscard]] const glm::vec2& offset() const { return offset_; }

  friend bool operator==(const TexcoordTransform& a, const TexcoordTransform& b) {
    return a.across_ == b.across_ && a.down_ == b.down_ && a.offset_ == b.offset_;
  }

 private:
  glm::vec2 across_, down_;  ///< images of one step in u, and in v
  glm::vec2 offset_;
};

}  // namespace frontmost
