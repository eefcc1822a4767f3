// SPDX-License-Identifier: Apache-2.0
// OSMesa's functions, by declarations of our own. A context draws into its own frame, which is copied to the program's
// memory when the program asks for a finished picture.

#include "calls/osmesa.h"

#include <dlfcn.h>

#include <algorithm>
#include <string_view>

#include "calls/answers.h"
#include "calls/call.h"
#include "pixels/pack.h"
#include "pixels/unpack.h"

namespace frontmost::gl_detail {
namespace {

// clang-format off
enum : GLenum {
  kBgra = 0x1, kArgb, kBgr = 0x4, kRgb565,
  kRowLength = 0x10, kYUp,
  kWidth = 0x20, kHeight, kFormat, kType, kMaxWidth, kMaxHeight,
  kDepthBits = 0x30, kStencilBits, kAccumBits, kProfile, kCoreProfile, kCompatProfile, kMajorVersion, kMinorVersion
};
// clang-format on

using OsmesaFunction = void (*)();

/// A format of OSMesa as one of glReadPixels.
struct FrameFormat {
  GLenum name, format, type;
};

constexpr FrameFormat kFrameFormats[] = {
    {GL_RGBA, GL_RGBA, GL_UNSIGNED_BYTE},      {kBgra, GL_BGRA, GL_UNSIGNED_BYTE},
    {kArgb, GL_BGRA, GL_UNSIGNED_INT_8_8_8_8}, {GL_RGB, GL_RGB, GL_UNSIGNED_BYTE},
    {kBgr, GL_BGR, GL_UNSIGNED_BYTE},          {kRgb565, GL_RGB, GL_UNSIGNED_SHORT_5_6_5}};

const FrameFormat* frame_format(GLenum name) {
  for (const FrameFormat& f : kFrameFormats)
    if (f.name == name) return &f;
  return nullptr;
}

thread_local osmesa_context* current_osmesa = nullptr;

/// Calls `use` with each row of the frame, and the same row of the program's memory as an image.
template <class Use>
void each_frame_row(osmesa_context& c, const Use& use) {
  const FrameFormat& f = *frame_format(c.format);
  const ImageShape shape{c.gl.frame.width, 1, f.format, f.type};
  PixelStore store;
  store.alignment = 1;
  store.row_length = c.row_length;
  const std::size_t stride = image_layout(store, shape)->row_bytes;
  for (int y = 0; y < c.gl.frame.height; ++y) {
    const auto row = std::size_t(c.y_up ? y : c.gl.frame.height - 1 - y);
    use(c.gl.frame.color.data() + c.gl.frame.at(0, y),
        ClientTarget{store, shape, static_cast<std::uint8_t*>(c.buffer) + row * stride});
  }
}

const PixelModeState kNoTransfer;

void show(osmesa_context& c) {
  if (!c.buffer) return;
  c.gl.finish();
  each_frame_row(c, [&](const std::uint32_t* words, const ClientTarget& row) {
    if (!pack({words, 0, {0, 0, row.shape.width, 1}}, {kNoTransfer, c.gl.pixel_maps}, row)) c.gl.fail(GL_OUT_OF_MEMORY);
  });
}

/// Gives the context a frame of this size, with the picture that the memory has.
bool attach(osmesa_context& c, void* buffer, int width, int height) {
  const bool is_first = c.buffer == nullptr, has_size = c.gl.frame.width == width && c.gl.frame.height == height;
  if (c.buffer == buffer && has_size) return true;
  try {
    c.gl.finish();
    if (!has_size) {
      c.gl.frame.resize(width, height);
      c.gl.stream.forget_draws(c.gl);
    }
  } catch (const std::exception&) {
    return false;
  }
  c.buffer = buffer;
  each_frame_row(c, [&](std::uint32_t* words, const ClientTarget& row) {
    const auto pixels = unpack({row.store, row.shape, row.pixels, nullptr}, {kNoTransfer, c.gl.pixel_maps});
    if (pixels) std::copy(pixels->begin(), pixels->end(), words);
  });
  if (is_first) c.gl.state.viewport.rect = c.gl.state.scissor = {0, 0, width, height};
  c.gl.stream.state_changes();
  keep_if_asked(c.gl);
  return true;
}

/// This library's shared object, or null.
void* own_object() {
  Dl_info info;
  if (!dladdr(reinterpret_cast<void*>(&show_frame), &info)) return nullptr;
  void* const object = dlopen(info.dli_fname, RTLD_LAZY | RTLD_NOLOAD);
  return object ? object : dlopen(nullptr, RTLD_LAZY);
}

}  // namespace

void show_frame() {
  if (current_osmesa) show(*current_osmesa);
}

FRONTMOST_GL osmesa_context* OSMesaCreateContextExt(GLenum format, GLint, GLint, GLint, osmesa_context* shares_with) {
  if (!frame_format(format)) return nullptr;
  try {
    return new osmesa_context(format, shares_with ? &shares_with->gl : nullptr);
  } catch (const std::exception&) {
    return nullptr;
  }
}

FRONTMOST_GL osmesa_context* OSMesaCreateContext(GLenum format, osmesa_context* shares_with) {
  return OSMesaCreateContextExt(format, 24, 8, 0, shares_with);
}

FRONTMOST_GL osmesa_context* OSMesaCreateContextAttribs(const int* attributes, osmesa_context* shares_with) {
  GLenum format = GL_RGBA;
  int major = 1, minor = 0;
  for (; attributes && attributes[0] != 0; attributes += 2) {
    const int value = attributes[1];
    switch (GLenum(attributes[0])) {
      case kFormat: format = GLenum(value); break;
      case kMajorVersion: major = value; break;
      case kMinorVersion: minor = value; break;
      case kProfile:
        if (value != int(kCompatProfile)) return nullptr;
        break;
      case kDepthBits:
      case kStencilBits:
      case kAccumBits:
        if (value < 0) return nullptr;
        break;
      default: return nullptr;
    }
  }
  if (major > 1 || (major == 1 && minor > 5)) return nullptr;
  return OSMesaCreateContextExt(format, 24, 8, 0, shares_with);
}

FRONTMOST_GL GLboolean OSMesaMakeCurrent(osmesa_context* context, void* buffer, GLenum type, GLsizei width,
                                         GLsizei height) {
  if (context) {
    const GLenum needed = context->format == kRgb565 ? GL_UNSIGNED_SHORT_5_6_5 : GL_UNSIGNED_BYTE;
    const auto is_size = [](GLsizei v) { return v >= 1 && v <= kMostViewport; };
    if (!buffer || type != needed || !is_size(width) || !is_size(height)) return GL_FALSE;
  } else if (buffer) {
    return GL_FALSE;
  }
  // A program may have released the old memory of a context that only gets another one.
  if (current_osmesa != context) show_frame();
  if (context && !attach(*context, buffer, width, height)) return GL_FALSE;
  current_osmesa = context;
  thread_context = context ? &context->gl : nullptr;
  return GL_TRUE;
}

FRONTMOST_GL osmesa_context* OSMesaGetCurrentContext() { return current_osmesa; }

FRONTMOST_GL void OSMesaDestroyContext(osmesa_context* context) {
  // Nothing is written: many programs release their memory before the context.
  if (context) explain_if_asked(context->gl);
  if (context && context == current_osmesa) {
    current_osmesa = nullptr;
    thread_context = nullptr;
  }
  delete context;
}

FRONTMOST_GL void OSMesaPixelStore(GLint name, GLint value) {
  osmesa_context* const c = current_osmesa;
  if (!c) return;
  if (name == GLint(kYUp)) {
    c->y_up = value != 0;
  } else if (name != GLint(kRowLength)) {
    c->gl.fail(GL_INVALID_ENUM);
  } else if (value < 0) {
    c->gl.fail(GL_INVALID_VALUE);
  } else {
    c->row_length = value;
  }
}

FRONTMOST_GL void OSMesaGetIntegerv(GLint name, GLint* value) {
  osmesa_context* const c = current_osmesa;
  if (!c || !value) return;
  switch (GLenum(name)) {
    case kWidth: *value = c->gl.frame.width; break;
    case kHeight: *value = c->gl.frame.height; break;
    case kFormat: *value = GLint(c->format); break;
    case kType: *value = c->format == kRgb565 ? GL_UNSIGNED_SHORT_5_6_5 : GL_UNSIGNED_BYTE; break;
    case kRowLength: *value = c->row_length; break;
    case kYUp: *value = c->y_up; break;
    case kMaxWidth:
    case kMaxHeight: *value = kMostViewport; break;
    default: c->gl.fail(GL_INVALID_ENUM);
  }
}

FRONTMOST_GL GLboolean OSMesaGetDepthBuffer(osmesa_context* c, GLint* width, GLint* height, GLint* bytes,
                                            void** buffer) {
  if (!c || !c->buffer || !width || !height || !bytes || !buffer) return GL_FALSE;
  c->gl.finish();
  const Frame& frame = c->gl.frame;
  try {
    c->depths.resize(std::size_t(frame.width) * std::size_t(frame.height));
  } catch (const std::exception&) {
    return GL_FALSE;
  }
  GLuint* to = c->depths.data();
  for (int y = 0; y < frame.height; ++y) {
    for (int x = 0; x < frame.width; ++x) *to++ = frame.depth[frame.at(x, y)] >> 8;
  }
  *width = frame.width;
  *height = frame.height;
  *bytes = 4;
  *buffer = c->depths.data();
  return GL_TRUE;
}

FRONTMOST_GL GLboolean OSMesaGetColorBuffer(osmesa_context* c, GLint* width, GLint* height, GLint* format,
                                            void** buffer) {
  if (!c || !c->buffer || !width || !height || !format || !buffer) return GL_FALSE;
  show(*c);
  *width = c->gl.frame.width;
  *height = c->gl.frame.height;
  *format = GLint(c->format);
  *buffer = c->buffer;
  return GL_TRUE;
}

/// \returns the function of this library with the name, or null.
FRONTMOST_GL OsmesaFunction OSMesaGetProcAddress(const char* name) {
  static void* const object = own_object();
  if (!object || !name) return nullptr;
  const std::string_view text = name;
  if (!text.starts_with("gl") && !text.starts_with("OSMesa")) return nullptr;
  void* const function = dlsym(object, name);
  // The search goes on in other libraries, whose functions, such as glob(), are not meant.
  Dl_info own, found;
  if (!function || !dladdr(reinterpret_cast<void*>(&show_frame), &own) || !dladdr(function, &found)) return nullptr;
  return own.dli_fbase == found.dli_fbase ? reinterpret_cast<OsmesaFunction>(function) : nullptr;
}

// What GLEW and PyOpenGL ask of GLX, which is not there. glewInit() succeeds if there is a display, and GLX is 1.2 or
// later. PyOpenGL keeps arrays by context.
FRONTMOST_GL const void* glXGetCurrentDisplay() {
  static constexpr char display = 0;
  return &display;
}
FRONTMOST_GL osmesa_context* glXGetCurrentContext() { return OSMesaGetCurrentContext(); }
FRONTMOST_GL OsmesaFunction glXGetProcAddressARB(const GLubyte* name) {
  return OSMesaGetProcAddress(reinterpret_cast<const char*>(name));
}
FRONTMOST_GL_ALIAS(glXGetProcAddress, glXGetProcAddressARB);
FRONTMOST_GL const char* glXGetClientString(void*, int) { return nullptr; }
FRONTMOST_GL int glXQueryVersion(const void*, int* major, int* minor) {
  if (major) *major = 1;
  if (minor) *minor = 2;
  return 1;
}

FRONTMOST_GL void OSMesaColorClamp(GLboolean) {}
FRONTMOST_GL void OSMesaPostprocess(osmesa_context*, const char*, unsigned) {}

}  // namespace frontmost::gl_detail
