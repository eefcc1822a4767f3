// SPDX-License-Identifier: Apache-2.0
// An OpenGL context that draws into memory, and its picture and state read back.
#pragma once

#define GL_GLEXT_PROTOTYPES
#include <GL/osmesa.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <vector>

namespace frontmost::test {

/// A context of RGBA bytes, current until the object goes. `shares_with` may be null.
class OffScreen {
 public:
  explicit OffScreen(int width = 16, int height = 16, OSMesaContext shares_with = nullptr)
      : width_(width),
        height_(height),
        memory_(std::size_t(4 * width * height), 0),
        context_(OSMesaCreateContextExt(OSMESA_RGBA, 24, 8, 0, shares_with)) {
    EXPECT_NE(context_, nullptr);
    make_current();
  }
  OffScreen(const OffScreen&) = delete;
  OffScreen& operator=(const OffScreen&) = delete;
  ~OffScreen() { OSMesaDestroyContext(context_); }

  void make_current() { EXPECT_TRUE(OSMesaMakeCurrent(context_, memory_.data(), GL_UNSIGNED_BYTE, width_, height_)); }
  [[nodiscard]] OSMesaContext context() const { return context_; }
  /// The bytes red, green, blue and alpha of each pixel, the lowest row first.
  [[nodiscard]] const std::vector<GLubyte>& picture() const {
    glFinish();
    return memory_;
  }

 private:
  int width_, height_;
  std::vector<GLubyte> memory_;
  OSMesaContext context_;
};

/// What glReadPixels reads of a rectangle, row by row without gaps.
template <class T>
std::vector<T> read_pixels(int x, int y, int width, int height, GLenum format, GLenum type, int components = 1) {
  std::vector<T> values(std::size_t(width * height * components));
  glPushClientAttrib(GL_CLIENT_PIXEL_STORE_BIT);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  for (const GLenum none : {GL_PACK_ROW_LENGTH, GL_PACK_SKIP_ROWS, GL_PACK_SKIP_PIXELS, GL_PACK_SWAP_BYTES})
    glPixelStorei(none, 0);
  glReadPixels(x, y, width, height, format, type, values.data());
  glPopClientAttrib();
  return values;
}
inline std::vector<GLubyte> read_colors(int x, int y, int width, int height) {
  return read_pixels<GLubyte>(x, y, width, height, GL_RGBA, GL_UNSIGNED_BYTE, 4);
}
inline std::vector<GLubyte> read_stencil(int x, int y, int width, int height) {
  return read_pixels<GLubyte>(x, y, width, height, GL_STENCIL_INDEX, GL_UNSIGNED_BYTE);
}

/// The values that one of OpenGL's functions gives for names.
template <auto get, class T, class... Names>
std::vector<double> asked(std::size_t count, Names... names) {
  T values[256]{};
  get(names..., values);
  return {values, values + count};
}

}  // namespace frontmost::test
