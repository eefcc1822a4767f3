// SPDX-License-Identifier: Apache-2.0
// Makes arbitrary calls of OpenGL, valid or not, inside and outside of glBegin, in display lists and with buffers. They
// must not crash or hang, and the pictures of one thread with plain code and of two threads with vectors are equal.
//
// Input: for each call a byte that chooses it, then its arguments. Sizes are at most 67, so that the memory behind
// pointers suffices. It begins with numbers of the input; zeros follow.
#define GL_GLEXT_PROTOTYPES
#include <GL/osmesa.h>
// OpenGL's extensions come after OpenGL.
#include <GL/glext.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

namespace {

constexpr int kWidth = 70, kHeight = 67;

class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : next_(data), end_(data + size) {}
  [[nodiscard]] bool is_empty() const { return next_ == end_; }
  [[nodiscard]] std::uint8_t byte() { return is_empty() ? 0 : *next_++; }

  /// An argument of the type.
  template <class T>
  [[nodiscard]] T argument() {
    if constexpr (std::is_pointer_v<T>) {
      using Value = std::remove_pointer_t<T>;
      return std::is_const_v<Value> ? numbers<std::remove_const_t<Value>>() : answers<std::remove_const_t<Value>>();
    } else if constexpr (std::is_floating_point_v<T>) {
      return T(number());
    } else if constexpr (std::is_same_v<T, GLenum>) {
      // Starts of the ranges that the names of OpenGL 1.5 have.
      static constexpr GLenum kRanges[] = {
          0x200,  0x300,  0x400,  0x500,  0x600,  0xA00,  0xB00,  0xB20,  0xB40,  0xB60,  0xB80,  0xBA0,  0xBC0,
          0xBE0,  0xC00,  0xC20,  0xC40,  0xC60,  0xC80,  0xCA0,  0xCC0,  0xCE0,  0xD00,  0xD20,  0xD40,  0xD80,
          0xDA0,  0xDE0,  0x1000, 0x1100, 0x1200, 0x1300, 0x1400, 0x1500, 0x1600, 0x1700, 0x1800, 0x1900, 0x1A00,
          0x1B00, 0x1C00, 0x1D00, 0x1E00, 0x1F00, 0x2100, 0x2200, 0x2300, 0x2400, 0x2500, 0x2600, 0x2700, 0x2800,
          0x2900, 0x2A00, 0x3000, 0x4000, 0x8000, 0x8030, 0x8060, 0x8070, 0x80C0, 0x80E0, 0x8360, 0x8450, 0x84C0,
          0x84F0, 0x8570, 0x8580, 0x8760, 0x8860, 0x8890, 0x88B0, 0x88E0, 0x8910};
      const std::uint8_t first = byte();
      return first < 100 ? first : kRanges[std::size_t(first - 100) % std::size(kRanges)] + byte() % 32;
    } else if constexpr (sizeof(T) == 1) {
      return T(byte());
    } else {
      const std::uint8_t b = byte();
      return T(b < 248 ? b % 68 : b - 256);
    }
  }

  /// Memory that calls read.
  template <class Value>
  Value* numbers() {
    if constexpr (std::is_void_v<Value>) {
      return numbers<GLubyte>();
    } else {
      static Memory<Value> memory;
      if (!std::exchange(memory.is_known, true)) cleared().push_back([] { std::fill_n(memory.begin(), 32, Value()); });
      if constexpr (std::is_arithmetic_v<Value>)
        for (std::size_t i = 0, count = byte() % 32; i < count; ++i) memory[i] = argument<Value>();
      return memory.data();
    }
  }

  /// Forgets the numbers of another input.
  static void clear_numbers() {
    for (const auto clear : cleared()) clear();
  }

 private:
  template <class Value>
  struct Memory : std::vector<Value> {
    Memory() : std::vector<Value>(std::size_t(1) << (sizeof(Value) == 1 ? 22 : 16)) {}
    bool is_known = false;
  };

  const std::uint8_t *next_, *end_;

  static std::vector<void (*)()>& cleared() {
    static std::vector<void (*)()> list;
    return list;
  }

  /// Memory that calls write.
  template <class Value>
  static Value* answers() {
    if constexpr (std::is_void_v<Value>) {
      return answers<GLubyte>();
    } else {
      static Memory<Value> memory;
      return memory.data();
    }
  }

  double number() {
    const std::uint8_t b = byte();
    constexpr double kRare[] = {1e9,
                                -1e9,
                                1e-9,
                                3e38,
                                1e300,
                                std::numeric_limits<double>::infinity(),
                                std::numeric_limits<double>::quiet_NaN()};
    return b < std::size(kRare) ? kRare[b] : (b - 128) / (b % 2 == 0 ? 64.0 : 4.0);
  }
};

using Call = void (*)(Bytes&);

/// A call with all arguments from the input.
template <auto function>
struct Caller;
template <class Result, class... Arguments, Result (*function)(Arguments...)>
struct Caller<function> {
  static void call(Bytes& bytes) {
    const std::tuple<Arguments...> arguments{bytes.argument<Arguments>()...};  // in this order
    std::apply(function, arguments);
  }
};

template <auto function>
void plain(Bytes& bytes) {
  Caller<function>::call(bytes);
}

/// A place in the buffer that is bound to `binding`, or in memory.
const void* place(Bytes& bytes, GLenum binding) {
  GLint bound = 0;
  glGetIntegerv(binding, &bound);
  return bound != 0 ? reinterpret_cast<const void*>(std::uintptr_t(bytes.byte())) : bytes.argument<const void*>();
}

/// A call of gl...Pointer, whose pointer depends on the bound buffer.
template <void (*function)(GLint, GLenum, GLsizei, const void*)>
void array(Bytes& bytes) {
  const auto size = bytes.argument<GLint>();
  const auto type = bytes.argument<GLenum>();
  const auto stride = bytes.argument<GLsizei>();
  function(size, type, stride, place(bytes, GL_ARRAY_BUFFER_BINDING));
}

/// Indices are bytes, as larger ones would lead out of the arrays.
void draw_elements(Bytes& bytes) {
  const auto mode = bytes.argument<GLenum>();
  const auto count = bytes.argument<GLsizei>();
  glDrawElements(mode, count, GL_UNSIGNED_BYTE, place(bytes, GL_ELEMENT_ARRAY_BUFFER_BINDING));
}

/// Lists call no lists, because two that call each other twice do not end.
void call_lists(Bytes& bytes) {
  GLint compiled = -1;  // stays so inside of glBegin
  glGetIntegerv(GL_LIST_INDEX, &compiled);
  if (compiled == 0) plain<glCallLists>(bytes);
}

void array_element(Bytes& bytes) { glArrayElement(bytes.byte() % 64); }

/// A texture of a size that is valid more often than not.
void texture(Bytes& bytes) {
  const std::uint8_t size = bytes.byte();
  static constexpr GLenum kFormats[] = {GL_RGBA, GL_RGB, GL_LUMINANCE, GL_ALPHA, GL_LUMINANCE_ALPHA, GL_INTENSITY8};
  glTexImage2D(GL_TEXTURE_2D, size >> 6, GLint(kFormats[bytes.byte() % std::size(kFormats)]), 1 << (size & 3),
               1 << (size >> 2 & 3), 0, kFormats[bytes.byte() % 5], GL_UNSIGNED_BYTE, bytes.argument<const void*>());
}

// clang-format off
constexpr Call kCalls[] = {
    array<glVertexPointer>, array<glColorPointer>, array<glTexCoordPointer>, draw_elements, call_lists, array_element,
    texture, plain<glBegin>, plain<glEnd>, plain<glVertex2i>, plain<glVertex3f>, plain<glVertex4d>, plain<glColor4ub>,
    plain<glColor3fv>, plain<glNormal3b>, plain<glTexCoord2f>, plain<glMultiTexCoord4fv>, plain<glEdgeFlag>,
    plain<glRectf>, plain<glSecondaryColor3f>, plain<glFogCoordf>, plain<glEnable>, plain<glDisable>,
    plain<glDepthFunc>, plain<glDepthMask>, plain<glDepthRange>, plain<glClear>, plain<glClearColor>,
    plain<glClearDepth>, plain<glClearStencil>, plain<glCullFace>, plain<glFrontFace>, plain<glPolygonMode>,
    plain<glPolygonOffset>, plain<glLineWidth>, plain<glLineStipple>, plain<glPolygonStipple>, plain<glPointSize>,
    plain<glShadeModel>, plain<glStencilFunc>, plain<glStencilOp>, plain<glStencilMask>, plain<glAlphaFunc>,
    plain<glBlendFunc>, plain<glBlendFuncSeparate>, plain<glBlendEquation>, plain<glBlendColor>, plain<glLogicOp>,
    plain<glColorMask>, plain<glScissor>, plain<glViewport>, plain<glMatrixMode>, plain<glLoadIdentity>,
    plain<glLoadMatrixf>, plain<glMultMatrixd>, plain<glPushMatrix>, plain<glPopMatrix>, plain<glRotatef>,
    plain<glScaled>, plain<glTranslatef>, plain<glFrustum>, plain<glOrtho>, plain<glClipPlane>, plain<glLightfv>,
    plain<glLightModelfv>, plain<glMaterialfv>, plain<glColorMaterial>, plain<glFogfv>, plain<glFogi>, plain<glTexEnvi>,
    plain<glTexEnvfv>, plain<glTexGeni>, plain<glTexGendv>, plain<glTexParameteri>, plain<glTexParameterfv>,
    plain<glBindTexture>, plain<glActiveTexture>, plain<glTexImage1D>, plain<glTexImage2D>, plain<glTexSubImage1D>,
    plain<glTexSubImage2D>, plain<glCopyTexImage2D>, plain<glCopyTexSubImage2D>, plain<glGetTexImage>,
    plain<glDeleteTextures>, plain<glPixelStorei>, plain<glPixelTransferf>, plain<glPixelMapfv>, plain<glPixelZoom>,
    plain<glRasterPos3f>, plain<glWindowPos2i>, plain<glBitmap>, plain<glDrawPixels>, plain<glCopyPixels>,
    plain<glReadPixels>, plain<glNewList>, plain<glEndList>, plain<glDrawArrays>, plain<glListBase>,
    plain<glDeleteLists>, plain<glPushAttrib>, plain<glPopAttrib>, plain<glPushClientAttrib>, plain<glPopClientAttrib>,
    plain<glEnableClientState>, plain<glDisableClientState>, plain<glClientActiveTexture>, plain<glBindBuffer>,
    plain<glBufferData>, plain<glBufferSubData>, plain<glDeleteBuffers>, plain<glMapBuffer>, plain<glUnmapBuffer>,
    plain<glBeginQuery>, plain<glEndQuery>, plain<glMap1f>, plain<glMap2d>, plain<glEvalCoord2f>, plain<glMapGrid2f>,
    plain<glEvalMesh2>, plain<glRenderMode>, plain<glGetIntegerv>, plain<glGetFloatv>, plain<glGetLightfv>,
    plain<glGetTexLevelParameteriv>, plain<glGetMapfv>, plain<glIsEnabled>, plain<glAccum>, plain<glFlush>};
// clang-format on

/// Colors, and depths with stencils, after the calls.
std::vector<GLuint> pictures(Bytes bytes, const char* threads, const char* isa) {
  setenv("FRONTMOST_GL_THREADS", threads, 1);
  setenv("FRONTMOST_GL_ISA", isa, 1);
  Bytes::clear_numbers();
  std::vector<GLuint> colors(kWidth * kHeight);
  const OSMesaContext context = OSMesaCreateContextExt(OSMESA_RGBA, 24, 8, 0, nullptr);
  if (!context || OSMesaMakeCurrent(context, colors.data(), GL_UNSIGNED_BYTE, kWidth, kHeight) == GL_FALSE)
    std::abort();
  for (int calls = 0; !bytes.is_empty() && calls < 2000; ++calls) kCalls[bytes.byte() % std::size(kCalls)](bytes);
  glEnd();
  glEndList();
  glFinish();
  GLint width = 0, height = 0, size = 0;
  void* depths = nullptr;
  if (OSMesaGetDepthBuffer(context, &width, &height, &size, &depths) == GL_FALSE) std::abort();
  const auto* const values = static_cast<const GLuint*>(depths);
  colors.insert(colors.end(), values, values + std::size_t(width) * std::size_t(height));
  OSMesaDestroyContext(context);
  return colors;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (pictures({data, size}, "1", "scalar") != pictures({data, size}, "2", "best")) std::abort();
  return 0;
}
