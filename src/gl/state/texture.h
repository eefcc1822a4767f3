// SPDX-License-Identifier: Apache-2.0
// Texture objects: levels of texels that batches share with the context, and the parameters of sampling.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "state/enums.h"

namespace frontmost::gl_detail {

inline constexpr int kTextureLevels = 13;  ///< from 4096 texels to 1

/// One level. `texels` has (width + 2 border) x (height + 2 border) texels, row by row from the bottom, each red |
/// green << 8 | blue << 16 | alpha << 24. Luminance and intensity are repeated in red, green and blue; components that
/// the base format lacks are 0, alpha 255.
struct TextureLevel {
  int width = 0, height = 0, border = 0;  ///< width and height without the border; 0 if the level is not there
  GLenum internal_format = 1;             ///< as given to glTexImage
  GLenum base_format = GL_RGBA;  ///< GL_ALPHA, GL_LUMINANCE, GL_LUMINANCE_ALPHA, GL_INTENSITY, GL_RGB or GL_RGBA
  /// Never changed while others share it: batches keep the texels that they draw with.
  std::shared_ptr<std::vector<std::uint32_t>> texels;
};

struct PackedTexture;

struct TextureObject {
  GLuint name = 0;
  GLenum target = 0;  ///< GL_TEXTURE_1D or GL_TEXTURE_2D; 0 before it is bound
  std::array<TextureLevel, kTextureLevels> levels;
  GLenum min_filter = GL_NEAREST_MIPMAP_LINEAR, mag_filter = GL_LINEAR;
  GLenum wrap_s = GL_REPEAT, wrap_t = GL_REPEAT, wrap_r = GL_REPEAT;
  glm::vec4 border_color{0};
  float priority = 1, min_lod = -1000, max_lod = 1000, lod_bias = 0;
  int base_level = 0, max_level = 1000;
  bool generate_mipmap = false;
  std::shared_ptr<const PackedTexture> packed;  ///< made when the texture is first drawn with its present levels
};

}  // namespace frontmost::gl_detail
