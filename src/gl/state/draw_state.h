// SPDX-License-Identifier: Apache-2.0
// A snapshot of the state, in the form that kernels read. A batch shares it with the batches that were submitted in the
// same state.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <tuple>
#include <vector>

#include "frontmost/view.h"
#include "state/frame.h"
#include "state/state.h"

namespace frontmost::gl_detail {

/// Numbers of the floats that are interpolated between vertices, after the columns of clip space and the window.
enum Varying : int {
  kOutRed,
  kOutGreen,
  kOutBlue,
  kOutAlpha,
  kOutRed2,
  kOutGreen2,
  kOutBlue2,
  kOutBack,  ///< the seven colors of back faces
  kOutFog = kOutBack + 7,
  kOutTexCoord,                                 ///< s, t, q of each unit
  kOutClip = kOutTexCoord + 3 * kTextureUnits,  ///< distances from the user's clip planes
  kVaryings = kOutClip + kClipPlanes
};

/// A function such as GL_LESS, as the relations that pass.
struct TestFunction {
  bool less, equal, greater;

  explicit TestFunction(GLenum func)
      : less((func & 1) != 0), equal((func & 2) != 0), greater((func & 4) != 0) {}  // GL_NEVER is 0x200
  [[nodiscard]] bool always() const { return less && equal && greater; }
};

struct DrawBounds {
  int x0 = 0, y0 = 0, x1 = -1, y1 = -1;  ///< both ends included

  [[nodiscard]] bool is_empty() const { return x1 < x0 || y1 < y0; }
};

/// The levels that sampling reads, one after another. Each has a frame of one texel, filled by the modes of wrapping.
struct PackedTexture {
  std::vector<std::uint32_t> texels;
  /// The place of texel (0, 0), and sizes without the frame. A row is width + 2 texels.
  std::int32_t first[kTextureLevels], width[kTextureLevels], height[kTextureLevels];
  // A texture is packed again only if one of these has changed.
  std::vector<std::shared_ptr<std::vector<std::uint32_t>>> sources;  ///< the texels of each level
  std::tuple<GLenum, GLenum, std::uint32_t> key;  ///< the modes of wrapping, and the border's color as a texel
};

/// A complete texture of an enabled unit.
struct BoundTexture {
  TextureObject texture;
  std::shared_ptr<const PackedTexture> packed;
  GLenum base_format;
  float lod_bias;  ///< of the unit
  int unit;
  bool is_1d;
  int levels;  ///< from the base level on; 1 if no mip-maps are used
  bool minifies_by_levels, is_linear_min, is_linear_between, is_linear_mag;
};

struct DrawState {
  State state;

  // Vertices.
  glm::mat4 clip_from_object, eye_from_object;
  glm::mat3 normal_matrix;  ///< inverse transpose of eye_from_object, rescaled if GL_RESCALE_NORMAL says so
  std::array<glm::mat4, kTextureUnits> texture_matrix;
  std::array<bool, kTextureUnits> has_texture_matrix;
  glm::vec4 window_scale, window_offset;  ///< x and y in 1/256 pixel and z, from normalized device coordinates
  std::array<glm::vec4, 4> guard;         ///< planes of clip space around the frame
  bool needs_eye, needs_normal, is_lit, is_two_sided, has_secondary, has_fog;
  std::vector<int> inputs;    ///< attributes that vertices must have, beside the position
  std::vector<int> varyings;  ///< numbers of the varyings in use, without those of back faces and clip planes
  int clip_planes;            ///< bit i: plane i is enabled

  // Fragments.
  DrawBounds scissor;   ///< of the frame
  DrawBounds viewport;  ///< of the frame and the scissor: no triangle reaches farther
  std::vector<BoundTexture> textures;
  Culling culling;  ///< by Frontmost's rule, whose front is clockwise in a window whose rows go up
  bool culls_all;
  std::uint32_t color_mask;  ///< bits of the frame's words that may be written
  bool tests_depth, writes_depth, tests_stencil, tests_alpha, blends, adds_secondary;
  View grid;  ///< the frame as a grid of pixels
};

/// The state as kernels read it.
[[nodiscard]] std::shared_ptr<const DrawState> snapshot(const DrawInput& input);

}  // namespace frontmost::gl_detail
