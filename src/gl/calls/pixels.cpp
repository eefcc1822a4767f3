// SPDX-License-Identifier: Apache-2.0
// Rectangles of pixels between client memory and the frame, and the modes of their transfer.

#include "calls/pixels.h"

#include <algorithm>

#include "calls/call.h"
#include "calls/values.h"
#include "pixels/pack.h"
#include "pixels/unpack.h"

namespace frontmost::gl_detail {
namespace {

/// The nearest integer in the range of ints; 0 for NaN.
int rounded_int(double v) {
  return v == v ? int(std::floor(std::clamp(v, -2147483648.0, 2147483647.0 - 0.5) + 0.5)) : 0;
}

void set_pixel_store(GLenum name, double value) {
  client_call([=](Context& c) {
    // Six names follow one another, in the same order for both directions.
    constexpr int PixelStore::*kFields[] = {&PixelStore::row_length, &PixelStore::skip_rows, &PixelStore::skip_pixels,
                                            &PixelStore::alignment};
    const bool is_pack = name - GL_PACK_SWAP_BYTES < 6 || is_one_of(name, GL_PACK_SKIP_IMAGES, GL_PACK_IMAGE_HEIGHT);
    PixelStore& store = is_pack ? c.client.pack : c.client.unpack;
    const GLenum i = name - (name < GL_PACK_SWAP_BYTES ? GL_UNPACK_SWAP_BYTES : GL_PACK_SWAP_BYTES);
    const int whole = rounded_int(value);
    if (i < 2) {
      (i == 0 ? store.swap_bytes : store.lsb_first) = value != 0;
    } else if (i >= 6 && name - GL_PACK_SKIP_IMAGES > GL_UNPACK_IMAGE_HEIGHT - GL_PACK_SKIP_IMAGES) {
      c.fail(GL_INVALID_ENUM);
    } else if (whole < 0 || (i == 5 && !is_one_of(GLenum(whole), 1, 2, 4, 8))) {
      c.fail(GL_INVALID_VALUE);
    } else if (i < 6) {
      store.*kFields[i - 2] = whole;
    } else {
      (is_one_of(name, GL_PACK_SKIP_IMAGES, GL_UNPACK_SKIP_IMAGES) ? store.skip_images : store.image_height) = whole;
    }
  });
}

void set_pixel_transfer(GLenum name, double value) {
  draw_call([=](Context& c) {
    PixelModeState& mode = c.state.pixel;
    switch (name) {
      case GL_MAP_COLOR: mode.map_color = value != 0; break;
      case GL_MAP_STENCIL: mode.map_stencil = value != 0; break;
      case GL_INDEX_SHIFT: mode.index_shift = rounded_int(value); break;
      case GL_INDEX_OFFSET: mode.index_offset = rounded_int(value); break;
      case GL_RED_SCALE: mode.scale[0] = float(value); break;
      case GL_RED_BIAS: mode.bias[0] = float(value); break;
      case GL_DEPTH_SCALE: mode.depth_scale = float(value); break;
      case GL_DEPTH_BIAS: mode.depth_bias = float(value); break;
      default: {
        // Scale and bias of green, blue and alpha follow one another.
        const GLenum i = name - GL_GREEN_SCALE;
        if (i >= 6) return c.fail(GL_INVALID_ENUM);
        (i % 2 ? mode.bias : mode.scale)[int(1 + i / 2)] = float(value);
      }
    }
  });
}

bool has_indexes(GLenum map) { return is_one_of(map, GL_PIXEL_MAP_I_TO_I, GL_PIXEL_MAP_S_TO_S); }

template <class T>
void set_pixel_map(GLenum map, GLsizei size, const T* values) {
  const auto copy = copied<T, 256>(values, values && size > 0 ? std::size_t(size) : 0);
  draw_call([=](Context& c) {
    const GLenum i = map - GL_PIXEL_MAP_I_TO_I;
    if (i >= c.pixel_maps.size()) return c.fail(GL_INVALID_ENUM);
    if (size < 1 || size > 256 || (map <= GL_PIXEL_MAP_I_TO_A && (size & (size - 1)) != 0))
      return c.fail(GL_INVALID_VALUE);
    c.pixel_maps[i].size = size;
    for (std::size_t k = 0; k < std::size_t(size); ++k) {
      c.pixel_maps[i].values[k] =
          has_indexes(map) ? float(rounded_int(double(copy[k]))) : float(unit(double(normalized(copy[k]))));
    }
  });
}

template <class T>
void get_pixel_map(GLenum map, T* values) {
  client_call([=](Context& c) {
    const GLenum i = map - GL_PIXEL_MAP_I_TO_I;
    if (i >= c.pixel_maps.size()) return c.fail(GL_INVALID_ENUM);
    for (std::size_t k = 0; values && k < std::size_t(c.pixel_maps[i].size); ++k) {
      const auto v = double(c.pixel_maps[i].values[k]);
      values[k] = std::is_floating_point_v<T>
                      ? T(v)
                      : T(has_indexes(map) ? std::clamp(v, 0.0, kMostOf<T>) : scaled(v, kMostOf<T>));
    }
  });
}

/// Draws at the raster position, `x` and `y` pixels of the image from it.
void draw_words(Context& c, PixelKind kind, const WindowRect& part, std::vector<std::uint32_t>&& words) {
  const PixelModeState& mode = c.state.pixel;
  PixelRectangle r;
  r.kind = kind == PixelKind::depth     ? PixelRectangle::Kind::depth
           : kind == PixelKind::stencil ? PixelRectangle::Kind::stencil
                                        : PixelRectangle::Kind::color;
  r.width = part.width;
  r.height = part.height;
  r.x = c.state.current.raster.window.x + float(part.x) * mode.zoom_x;
  r.y = c.state.current.raster.window.y + float(part.y) * mode.zoom_y;
  r.zoom_x = mode.zoom_x;
  r.zoom_y = mode.zoom_y;
  r.values = std::move(words);
  c.stream.draw(c, std::move(r));
}

}  // namespace

WindowRect inside_frame(const Frame& frame, const WindowRect& rect) {
  const auto limited = [](std::int64_t v, int most) { return int(std::clamp(v, std::int64_t(0), std::int64_t(most))); };
  const int x0 = limited(rect.x, frame.width), y0 = limited(rect.y, frame.height);
  const int x1 = limited(std::int64_t(rect.x) + rect.width, frame.width);
  const int y1 = limited(std::int64_t(rect.y) + rect.height, frame.height);
  return {x0, y0, std::max(x1 - x0, 0), std::max(y1 - y0, 0)};
}

std::optional<std::vector<std::uint32_t>> copy_of_frame(Context& c, const WindowRect& rect, PixelKind kind) {
  c.finish();
  std::optional<std::vector<std::uint32_t>> words =
      allocated<std::uint32_t>(std::size_t(rect.width) * std::size_t(rect.height));
  if (!words) {
    c.fail(GL_OUT_OF_MEMORY);
    return words;
  }
  const Transfer transfer = transfer_of(c);
  const bool changes = kind != PixelKind::color || transfer.changes_colors();
  const WindowRect part = inside_frame(c.frame, rect);
  for (int y = 0; part.width > 0 && y < part.height; ++y) {
    const std::size_t at = c.frame.at(part.x, part.y + y);
    std::uint32_t* const to =
        words->data() + std::size_t(part.y + y - rect.y) * std::size_t(rect.width) + std::size_t(part.x - rect.x);
    for (std::size_t x = 0; x < std::size_t(part.width); ++x) {
      const std::uint32_t word = kind == PixelKind::color   ? c.frame.color[at + x]
                                 : kind == PixelKind::depth ? c.frame.depth[at + x] >> 8
                                                            : c.frame.depth[at + x] & 0xFF;
      to[x] = changes ? transfer.change_word(kind, word) : word;
    }
  }
  return words;
}

FRONTMOST_GL void glPixelStorei(GLenum pname, GLint param) { set_pixel_store(pname, param); }
FRONTMOST_GL void glPixelStoref(GLenum pname, GLfloat param) { set_pixel_store(pname, double(param)); }
FRONTMOST_GL void glPixelTransferi(GLenum pname, GLint param) { set_pixel_transfer(pname, param); }
FRONTMOST_GL void glPixelTransferf(GLenum pname, GLfloat param) { set_pixel_transfer(pname, double(param)); }
FRONTMOST_GL void glPixelMapfv(GLenum map, GLsizei size, const GLfloat* values) { set_pixel_map(map, size, values); }
FRONTMOST_GL void glPixelMapuiv(GLenum map, GLsizei size, const GLuint* values) { set_pixel_map(map, size, values); }
FRONTMOST_GL void glPixelMapusv(GLenum map, GLsizei size, const GLushort* values) { set_pixel_map(map, size, values); }
FRONTMOST_GL void glGetPixelMapfv(GLenum map, GLfloat* values) { get_pixel_map(map, values); }
FRONTMOST_GL void glGetPixelMapuiv(GLenum map, GLuint* values) { get_pixel_map(map, values); }
FRONTMOST_GL void glGetPixelMapusv(GLenum map, GLushort* values) { get_pixel_map(map, values); }

FRONTMOST_GL void glPixelZoom(GLfloat x, GLfloat y) {
  draw_call([=](Context& c) {
    c.state.pixel.zoom_x = x;
    c.state.pixel.zoom_y = y;
  });
}

FRONTMOST_GL void glReadPixels(GLint x, GLint y, GLsizei width, GLsizei height, GLenum format, GLenum type,
                               GLvoid* pixels) {
  client_call([=](Context& c) {
    if (width < 0 || height < 0) return c.fail(GL_INVALID_VALUE);
    if (const GLenum error = pixel_error(format, type)) return c.fail(error);
    const PixelKind kind = pixel_format(format)->kind;
    if (kind == PixelKind::index) return c.fail(GL_INVALID_OPERATION);  // the frame has no indexes
    c.finish();
    WindowRect part = inside_frame(c.frame, {x, y, width, height});
    if (part.width == 0 || part.height == 0) return;
    const Buffer<std::uint32_t>& plane = kind == PixelKind::color ? c.frame.color : c.frame.depth;
    const std::uint32_t* const words = plane.data() + c.frame.at(part.x, part.y);
    part.x -= x;
    part.y -= y;
    const ClientTarget target{c.client.pack, {width, height, format, type}, pixels};
    if (!pack({words, c.frame.stride, part}, transfer_of(c), target)) c.fail(GL_OUT_OF_MEMORY);
  });
}

FRONTMOST_GL void glDrawPixels(GLsizei width, GLsizei height, GLenum format, GLenum type, const GLvoid* pixels) {
  Context* const context = current_context();
  if (!context) return;
  ClientImage image{context->client.unpack, {width, height, format, type}, pixels, nullptr};
  if (context->list) image.keep();
  draw_call([=](Context& c) {
    if (width < 0 || height < 0) return c.fail(GL_INVALID_VALUE);
    if (const GLenum error = pixel_error(format, type)) return c.fail(error);
    if (!c.state.current.raster.is_valid || !image.pixels) return;
    std::optional<std::vector<std::uint32_t>> words = unpack(image, transfer_of(c));
    if (!words) return c.fail(GL_OUT_OF_MEMORY);
    if (!words->empty()) draw_words(c, pixel_format(format)->kind, {0, 0, width, height}, std::move(*words));
  });
}

FRONTMOST_GL void glCopyPixels(GLint x, GLint y, GLsizei width, GLsizei height, GLenum type) {
  draw_call([=](Context& c) {
    if (!is_one_of(type, GL_COLOR, GL_DEPTH, GL_STENCIL)) return c.fail(GL_INVALID_ENUM);
    if (width < 0 || height < 0) return c.fail(GL_INVALID_VALUE);
    const WindowRect part = inside_frame(c.frame, {x, y, width, height});
    if (!c.state.current.raster.is_valid || part.width == 0 || part.height == 0) return;
    const PixelKind kind = type == GL_COLOR   ? PixelKind::color
                           : type == GL_DEPTH ? PixelKind::depth
                                              : PixelKind::stencil;
    std::optional<std::vector<std::uint32_t>> words = copy_of_frame(c, part, kind);
    if (words) draw_words(c, kind, {part.x - x, part.y - y, part.width, part.height}, std::move(*words));
  });
}

FRONTMOST_GL void glBitmap(GLsizei width, GLsizei height, GLfloat x_origin, GLfloat y_origin, GLfloat x_move,
                           GLfloat y_move, const GLubyte* bitmap) {
  Context* const context = current_context();
  if (!context) return;
  // Sizes below 0 and missing bits are dealt with when the call is made.
  const auto bits = std::make_shared<const std::optional<std::vector<std::uint8_t>>>(
      unpack_bitmap(context->client.unpack, std::max(width, 0), std::max(height, 0), bitmap));
  const bool has_bits = bitmap != nullptr;
  draw_call([=](Context& c) {
    if (width < 0 || height < 0) return c.fail(GL_INVALID_VALUE);
    if (!*bits) return c.fail(GL_OUT_OF_MEMORY);
    RasterPosition& raster = c.state.current.raster;
    if (!raster.is_valid) return;
    if (has_bits && !(*bits)->empty()) {
      PixelRectangle r;
      r.kind = PixelRectangle::Kind::bitmap;
      r.width = width;
      r.height = height;
      r.x = std::floor(raster.window.x - x_origin);
      r.y = std::floor(raster.window.y - y_origin);
      r.values.assign((*bits)->begin(), (*bits)->end());
      c.stream.draw(c, std::move(r));
    }
    raster.window.x += x_move;
    raster.window.y += y_move;
  });
}

}  // namespace frontmost::gl_detail
