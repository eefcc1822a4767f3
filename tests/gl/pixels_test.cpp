// SPDX-License-Identifier: Apache-2.0
// Rectangles of pixels: every format and type, where rows lie in memory, and what becomes of them. The values that are
// expected are computed here, by the OpenGL 1.5 specification.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

#include "off_screen.h"

namespace frontmost::test::pixels_test {
namespace {

// clang-format off
struct Format { GLenum name; int components; int channels[4]; };  // 0 to 3: red to alpha, 4: luminance
const Format kFormats[] = {{GL_RGBA, 4, {0, 1, 2, 3}}, {GL_BGRA, 4, {2, 1, 0, 3}}, {GL_RGB, 3, {0, 1, 2}},
    {GL_BGR, 3, {2, 1, 0}}, {GL_RED, 1, {0}}, {GL_GREEN, 1, {1}}, {GL_BLUE, 1, {2}}, {GL_ALPHA, 1, {3}},
    {GL_LUMINANCE, 1, {4}}, {GL_LUMINANCE_ALPHA, 2, {4, 3}}};

struct Type { GLenum name; int bytes; int fields = 0; int bits[4] = {}; bool is_reversed = false; };
const Type kTypes[] = {{GL_UNSIGNED_BYTE, 1}, {GL_BYTE, 1}, {GL_UNSIGNED_SHORT, 2}, {GL_SHORT, 2},
    {GL_UNSIGNED_INT, 4}, {GL_INT, 4}, {GL_FLOAT, 4}, {GL_UNSIGNED_BYTE_3_3_2, 1, 3, {3, 3, 2}},
    {GL_UNSIGNED_BYTE_2_3_3_REV, 1, 3, {3, 3, 2}, true}, {GL_UNSIGNED_SHORT_5_6_5, 2, 3, {5, 6, 5}},
    {GL_UNSIGNED_SHORT_5_6_5_REV, 2, 3, {5, 6, 5}, true}, {GL_UNSIGNED_SHORT_4_4_4_4, 2, 4, {4, 4, 4, 4}},
    {GL_UNSIGNED_SHORT_4_4_4_4_REV, 2, 4, {4, 4, 4, 4}, true}, {GL_UNSIGNED_SHORT_5_5_5_1, 2, 4, {5, 5, 5, 1}},
    {GL_UNSIGNED_SHORT_1_5_5_5_REV, 2, 4, {5, 5, 5, 1}, true}, {GL_UNSIGNED_INT_8_8_8_8, 4, 4, {8, 8, 8, 8}},
    {GL_UNSIGNED_INT_8_8_8_8_REV, 4, 4, {8, 8, 8, 8}, true}, {GL_UNSIGNED_INT_10_10_10_2, 4, 4, {10, 10, 10, 2}},
    {GL_UNSIGNED_INT_2_10_10_10_REV, 4, 4, {10, 10, 10, 2}, true}};
// clang-format on

/// What glPixelStore sets.
struct Store {
  int alignment = 4, row_length = 0, skip_rows = 0, skip_pixels = 0, is_swapped = 0, is_lsb_first = 0;

  void set() const {
    for (const GLenum pack : {0u, GLenum(GL_PACK_ALIGNMENT - GL_UNPACK_ALIGNMENT)}) {
      glPixelStorei(GL_UNPACK_ALIGNMENT + pack, alignment), glPixelStorei(GL_UNPACK_ROW_LENGTH + pack, row_length);
      glPixelStorei(GL_UNPACK_SKIP_ROWS + pack, skip_rows), glPixelStorei(GL_UNPACK_SKIP_PIXELS + pack, skip_pixels);
      glPixelStorei(GL_UNPACK_SWAP_BYTES + pack, is_swapped), glPixelStorei(GL_UNPACK_LSB_FIRST + pack, is_lsb_first);
    }
  }
};
const Store kStores[] = {{}, {1, 0, 0, 0, 1, 1}, {8, 13, 2, 3, 0, 1}, {2, 11, 1, 0, 1, 0}};

constexpr int kWidth = 8, kHeight = 4, kPixels = kWidth * kHeight;
constexpr std::size_t kBytes = 2048;

/// An image in memory, by the rules of section 3.6.4.
struct Image {
  Format format;
  Type type;
  Store store;
  std::vector<GLubyte> memory = std::vector<GLubyte>(kBytes, 0xA5);

  [[nodiscard]] bool is_signed() const { return type.name == GL_BYTE || type.name == GL_SHORT || type.name == GL_INT; }
  [[nodiscard]] int pixel_bytes() const { return type.bytes * (type.fields ? 1 : format.components); }
  [[nodiscard]] std::size_t place(int i) const {
    const int length = (store.row_length ? store.row_length : kWidth) * pixel_bytes(), a = store.alignment;
    const int row = type.bytes >= a ? length : (length + a - 1) / a * a;
    return std::size_t((store.skip_rows + i / kWidth) * row + (store.skip_pixels + i % kWidth) * pixel_bytes());
  }
  /// Component `k` of pixel `i`: a fraction, or the whole number of an index.
  [[nodiscard]] double value(int i, int k) const {
    std::uint32_t word = 0;
    const GLubyte* const at = &memory[place(i) + std::size_t(type.fields ? 0 : k * type.bytes)];
    for (int n = 0; n < type.bytes; ++n) word |= std::uint32_t(at[store.is_swapped ? type.bytes - 1 - n : n]) << 8 * n;
    if (type.fields) {
      int shift = type.is_reversed ? 0 : 8 * type.bytes - type.bits[0];
      for (int n = 0; n < k; ++n) shift += type.is_reversed ? type.bits[n] : -type.bits[n + 1];
      const std::uint32_t most = (1u << type.bits[k]) - 1;
      return double(word >> shift & most) / most;
    }
    float real;
    std::memcpy(&real, &word, sizeof real);
    if (type.name == GL_FLOAT) return double(real);
    const double most = std::pow(2, 8 * type.bytes) - 1;
    const double whole = is_signed() && word > most / 2 ? double(word) - most - 1 : double(word);
    return format.name == GL_STENCIL_INDEX ? whole : is_signed() ? (2 * whole + 1) / most : whole / most;
  }
  /// Half the distance between two values of a component.
  [[nodiscard]] double half_step(int k) const {
    const double most = std::pow(2, type.fields ? type.bits[k] : 8 * type.bytes) - 1;
    return type.name == GL_FLOAT ? 1e-7 : (is_signed() ? 1 : .5) / most + 1e-9;
  }
  void fill(std::mt19937& random) {
    for (GLubyte& byte : memory) byte = GLubyte(random());
    for (std::size_t at = 0; type.name == GL_FLOAT && at < kBytes; at += 4) {
      const float real = format.name == GL_STENCIL_INDEX ? float(random() % 1000) : float(random() % 4096) / 2048 - .5f;
      std::memcpy(&memory[at], &real, 4);
      if (store.is_swapped) std::reverse(&memory[at], &memory[at] + 4);
    }
  }
  /// The bytes of the colors that the pixels stand for.
  [[nodiscard]] std::vector<GLubyte> colors() const {
    std::vector<GLubyte> bytes;
    for (int i = 0; i < kPixels; ++i) {
      double c[4] = {0, 0, 0, 1};
      for (int k = 0; k < format.components; ++k)
        for (int n = 0; n < 4; ++n)
          if (n == format.channels[k] || (format.channels[k] == 4 && n < 3)) c[n] = value(i, k);
      for (const double v : c) bytes.push_back(GLubyte(std::floor(std::clamp(v, 0.0, 1.0) * 255 + .5)));
    }
    return bytes;
  }
  /// Checks what was read of pixels with these bytes; other memory must be as before.
  void expect_read(const std::vector<GLubyte>& frame) const {
    std::vector<bool> is_free(kBytes, true);
    for (int i = 0; i < kPixels; ++i) {
      std::fill_n(is_free.begin() + std::ptrdiff_t(place(i)), pixel_bytes(), false);
      const GLubyte* const c = &frame[std::size_t(4 * i)];
      for (int k = 0; k < format.components; ++k) {
        const int byte = format.channels[k] == 4 ? std::min(c[0] + c[1] + c[2], 255) : c[format.channels[k]];
        ASSERT_NEAR(value(i, k), byte / 255.0, half_step(k)) << "pixel " << i << ", component " << k;
      }
    }
    for (std::size_t i = 0; i < kBytes; ++i) ASSERT_TRUE(!is_free[i] || memory[i] == 0xA5) << "byte " << i;
  }
};

std::vector<GLubyte> random_bytes(std::size_t count) {
  std::mt19937 random(7);
  std::vector<GLubyte> bytes(count);
  for (GLubyte& b : bytes) b = GLubyte(random());
  return bytes;
}
/// Draws colors of 4 bytes each at a place of the window.
void draw_colors(int x, int y, int width, int height, const std::vector<GLubyte>& bytes) {
  Store().set(), glWindowPos2i(x, y), glDrawPixels(width, height, GL_RGBA, GL_UNSIGNED_BYTE, bytes.data());
}
std::vector<GLubyte> pixel(int x, int y) { return read_colors(x, y, 1, 1); }
GLfloat depth(int x, int y) { return read_pixels<GLfloat>(x, y, 1, 1, GL_DEPTH_COMPONENT, GL_FLOAT)[0]; }
GLubyte stencil(int x, int y) { return read_stencil(x, y, 1, 1)[0]; }

TEST(Pixels, OfEveryFormatAndTypeAreDrawnReadAndBecomeTexels) {
  OffScreen screen;
  std::mt19937 random(1);
  for (const Store& store : kStores)
    for (const Format& format : kFormats)
      for (const Type& type : kTypes) {
        if (type.fields && (type.fields != format.components || format.name == GL_BGR)) continue;
        SCOPED_TRACE(testing::Message() << std::hex << format.name << ", " << type.name << ", " << &store - kStores);
        Image image{format, type, store}, read = image, texels = image;
        image.fill(random), store.set(), glWindowPos2i(3, 5);
        glDrawPixels(kWidth, kHeight, format.name, type.name, image.memory.data());
        const std::vector<GLubyte> colors = image.colors();
        ASSERT_EQ(read_colors(3, 5, kWidth, kHeight), colors);
        glReadPixels(3, 5, kWidth, kHeight, format.name, type.name, read.memory.data());
        read.expect_read(colors);
        glTexImage2D(GL_TEXTURE_2D, 0, 4, kWidth, kHeight, 0, format.name, type.name, image.memory.data());
        glGetTexImage(GL_TEXTURE_2D, 0, format.name, type.name, texels.memory.data());
        texels.expect_read(colors);
        ASSERT_EQ(glGetError(), GLenum(GL_NO_ERROR));
      }
  const std::pair<GLint, std::vector<GLubyte>> bases[] = {
      {GL_ALPHA, {0, 0, 0, 40}},       {GL_LUMINANCE8, {10, 0, 0, 255}},     {1, {10, 0, 0, 255}},
      {GL_INTENSITY, {10, 0, 0, 255}}, {GL_LUMINANCE_ALPHA, {10, 0, 0, 40}}, {GL_RGB, {10, 20, 30, 255}}};
  for (const auto& [internal, texel] : bases) {
    std::vector<GLubyte> got = {10, 20, 30, 40};
    Store().set(), glTexImage2D(GL_TEXTURE_2D, 0, internal, 1, 1, 0, GL_RGBA, GL_UNSIGNED_BYTE, got.data());
    glGetTexImage(GL_TEXTURE_2D, 0, GL_RGBA, GL_UNSIGNED_BYTE, got.data());
    EXPECT_EQ(got, texel) << "of 10, 20, 30, 40 in internal format " << std::hex << internal;
  }
}

TEST(Pixels, DepthsAndStencilValuesOfEveryTypeAreDrawnAndRead) {
  OffScreen screen;
  std::mt19937 random(4);
  glEnable(GL_DEPTH_TEST), glDepthFunc(GL_ALWAYS);
  for (const Store& store : kStores)
    for (const GLenum format : {GL_DEPTH_COMPONENT, GL_STENCIL_INDEX})
      for (const Type& type : kTypes) {
        if (type.fields) continue;
        SCOPED_TRACE(testing::Message() << std::hex << format << ", " << type.name << ", " << &store - kStores);
        Image image{{format, 1, {}}, type, store}, read = image;
        image.fill(random), store.set(), glWindowPos2i(2, 2);
        glDrawPixels(kWidth, kHeight, format, type.name, image.memory.data());
        glReadPixels(2, 2, kWidth, kHeight, format, type.name, read.memory.data());
        const int mask = type.name == GL_BYTE ? 127 : 255;  // by table 4.6
        for (int i = 0; i < kPixels; ++i) {
          const double v = image.value(i, 0), got = read.value(i, 0);
          if (format == GL_STENCIL_INDEX)
            ASSERT_EQ(got, double(std::int64_t(v) & mask)) << "pixel " << i;
          else
            ASSERT_NEAR(got, std::clamp(v, 0.0, 1.0), 6e-8 + 2 * read.half_step(0)) << "pixel " << i;
        }
        EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR));
      }
}

TEST(Pixels, AreZoomed) {
  const auto image = random_bytes(4 * 3 * 2);
  const std::pair<float, float> zooms[] = {{2, 3}, {1.5f, 1}, {-2, 1}, {1, -1}, {-1, -2}, {.5f, .5f}, {-3, 2.5f}};
  for (const auto& [zx, zy] : zooms) {
    OffScreen screen;
    glPixelZoom(zx, zy), draw_colors(8, 8, 3, 2, image);
    for (int i = 0; i < 256; ++i) {
      const int n = int(std::floor((i % 16 - 7.5f) / zx)), m = int(std::floor((i / 16 - 7.5f) / zy));
      const auto at = image.begin() + 4 * (3 * m + n);
      const bool is_inside = n >= 0 && n < 3 && m >= 0 && m < 2;
      EXPECT_EQ(pixel(i % 16, i / 16), is_inside ? std::vector<GLubyte>(at, at + 4) : std::vector<GLubyte>(4))
          << i << " with zooms " << zx << ", " << zy;
    }
  }
}

TEST(Pixels, BitmapsAreDrawnAndMoveTheRasterPosition) {
  const auto bits = random_bytes(400);
  for (const Store& store : kStores) {
    OffScreen screen;
    store.set(), glColor4ub(255, 0, 51, 255), glWindowPos2f(4.75f, 3.25f), glColor4ub(0, 255, 0, 255);
    glBitmap(9, 6, 1.5f, -1, 2.5f, -.5f, bits.data());
    const int a = 8 * store.alignment, row = ((store.row_length ? store.row_length : 9) + a - 1) / a * store.alignment;
    for (int i = 0; i < 256; ++i) {
      const int x = i % 16 - 3, y = i / 16 - 4, bit = x + store.skip_pixels;  // floor(4.75 - 1.5), floor(3.25 + 1)
      const bool is_inside = x >= 0 && x < 9 && y >= 0 && y < 6;
      const int byte = is_inside ? bits[std::size_t((y + store.skip_rows) * row + bit / 8)] : 0;
      const bool is_set = is_inside && (byte >> (store.is_lsb_first ? bit % 8 : 7 - bit % 8) & 1);
      EXPECT_EQ(pixel(i % 16, i / 16), is_set ? std::vector<GLubyte>({255, 0, 51, 255}) : std::vector<GLubyte>(4)) << i;
    }
    EXPECT_EQ((asked<glGetFloatv, GLfloat>(2, GLenum(GL_CURRENT_RASTER_POSITION))), (std::vector<double>{7.25, 2.75}));
  }
  OffScreen screen;
  glRasterPos2f(5, 0), glBitmap(8, 4, 0, 0, 3, 3, bits.data()), glCopyPixels(0, 0, 4, 4, GL_COLOR);
  glDrawPixels(4, 4, GL_RGBA, GL_UNSIGNED_BYTE, bits.data());
  EXPECT_EQ(screen.picture(), std::vector<GLubyte>(1024)) << "nothing is drawn at an invalid raster position";
  EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR)) << "which is no error";
}

TEST(Pixels, AreCopied) {
  OffScreen screen;
  const auto image = random_bytes(4 * 4 * 3);
  draw_colors(1, 1, 4, 3, image), glWindowPos2i(8, 9), glCopyPixels(1, 1, 4, 3, GL_COLOR);
  EXPECT_EQ(read_colors(8, 9, 4, 3), image);
  glEnable(GL_SCISSOR_TEST), glScissor(0, 0, 2, 2), glClearDepth(.25), glClearStencil(7);
  glClear(GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT), glDisable(GL_SCISSOR_TEST), glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_ALWAYS), glWindowPos2i(12, 4), glPixelZoom(2, 1);
  glCopyPixels(1, 0, 1, 2, GL_DEPTH), glCopyPixels(1, 0, 1, 2, GL_STENCIL);
  for (int x = 11; x < 15; ++x) {
    EXPECT_EQ(stencil(x, 5), x == 12 || x == 13 ? 7 : 0) << x;
    EXPECT_NEAR(depth(x, 5), x == 12 || x == 13 ? .25 : 1, 1e-7) << x;
  }
}

TEST(Pixels, AreWrittenThroughScissorAndMasksAndReadThroughNone) {
  OffScreen screen;
  const auto image = random_bytes(1024);
  const std::vector<GLubyte> white(1024, 255);
  draw_colors(0, 0, 16, 16, image);
  glEnable(GL_SCISSOR_TEST), glScissor(3, 2, 5, 4), glColorMask(1, 0, 1, 0), glStencilMask(6);
  draw_colors(0, 0, 16, 16, white), glDrawPixels(16, 16, GL_STENCIL_INDEX, GL_UNSIGNED_BYTE, white.data());
  const auto colors = read_colors(0, 0, 16, 16), stencils = read_stencil(0, 0, 16, 16);
  for (std::size_t i = 0; i < 1024; ++i) {
    const std::size_t x = i / 4 % 16, y = i / 64;
    const bool is_inside = x >= 3 && x < 8 && y >= 2 && y < 6;
    EXPECT_EQ(stencils[i / 4], is_inside ? 6 : 0) << x << ", " << y;
    EXPECT_EQ(colors[i], is_inside && i % 2 == 0 ? 255 : image[i]) << x << ", " << y << ", component " << i % 4;
  }
}

TEST(Pixels, ReadsOutsideTheFrameLeaveMemoryAsItWas) {
  OffScreen screen;
  const auto image = random_bytes(1024);
  draw_colors(0, 0, 16, 16, image);
  std::vector<GLubyte> memory(4 * 22 * 21, 0x5A);
  glReadPixels(-2, -3, 22, 21, GL_RGBA, GL_UNSIGNED_BYTE, memory.data());
  for (int i = 0; i < 4 * 22 * 21; ++i) {
    const int x = i / 4 % 22 - 2, y = i / 88 - 3;
    const bool is_inside = x >= 0 && x < 16 && y >= 0 && y < 16;
    EXPECT_EQ(memory[std::size_t(i)], is_inside ? image[std::size_t(64 * y + 4 * x + i % 4)] : 0x5A) << x << ", " << y;
  }
  for (const auto& [x, y] : {std::pair(16, 0), {-5, 0}, {0, -4}, {2147483647, 0}, {-2147483647, -2147483647}}) {
    std::vector<GLfloat> floats(16, 9);
    glReadPixels(x, y, 4, 4, GL_DEPTH_COMPONENT, GL_FLOAT, floats.data());
    EXPECT_EQ(floats, std::vector<GLfloat>(16, 9)) << x << ", " << y;
  }
  EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR));
}

TEST(Pixels, AreTransferred) {
  OffScreen screen;
  const GLfloat map[] = {.2f, 1, .6f}, indexes[] = {0, .2f, .4f, .8f}, stencils[] = {9, 8, 7, 6};
  glPixelTransferf(GL_RED_SCALE, 2), glPixelTransferf(GL_RED_BIAS, -.2f), glPixelTransferf(GL_BLUE_BIAS, .2f);
  draw_colors(0, 0, 1, 1, {102, 10, 51, 255});
  glPixelTransferf(GL_RED_SCALE, 1), glPixelTransferf(GL_RED_BIAS, 0), glPixelTransferf(GL_BLUE_BIAS, 0);
  EXPECT_EQ(pixel(0, 0), (std::vector<GLubyte>{153, 10, 102, 255}));
  for (const GLenum name : {GL_PIXEL_MAP_R_TO_R, GL_PIXEL_MAP_G_TO_G}) glPixelMapfv(name, 3, map);
  for (const GLenum name : {GL_PIXEL_MAP_I_TO_R, GL_PIXEL_MAP_I_TO_B}) glPixelMapfv(name, 4, indexes);
  glPixelTransferi(GL_MAP_COLOR, 1);
  EXPECT_EQ(pixel(0, 0), (std::vector<GLubyte>{255, 51, 0, 0})) << "entries 1 and 0; maps of one 0";
  glPixelTransferi(GL_MAP_COLOR, 0), glPixelTransferi(GL_INDEX_SHIFT, 1), glPixelTransferi(GL_INDEX_OFFSET, 1);
  const GLubyte index = 5;  // 5 << 1, + 1 is 11, and 3 in a map of 4
  glWindowPos2i(1, 0), glDrawPixels(1, 1, GL_COLOR_INDEX, GL_UNSIGNED_BYTE, &index);
  glPixelMapfv(GL_PIXEL_MAP_S_TO_S, 4, stencils), glPixelTransferi(GL_MAP_STENCIL, 1);
  glDrawPixels(1, 1, GL_STENCIL_INDEX, GL_UNSIGNED_BYTE, &index);
  for (const GLenum name : {GL_MAP_STENCIL, GL_INDEX_SHIFT, GL_INDEX_OFFSET}) glPixelTransferi(name, 0);
  EXPECT_EQ(pixel(1, 0), (std::vector<GLubyte>{204, 0, 204, 0}));
  EXPECT_EQ(stencil(1, 0), 6);
  glPixelTransferf(GL_DEPTH_SCALE, .5f), glPixelTransferf(GL_DEPTH_BIAS, .25f);
  EXPECT_NEAR(depth(0, 0), .75, 1e-7) << "of depth 1";
  EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR));
}

}  // namespace
}  // namespace frontmost::test::pixels_test
