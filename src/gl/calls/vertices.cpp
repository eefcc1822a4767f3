// SPDX-License-Identifier: Apache-2.0
// glBegin, glEnd and the calls between them, glRect, and the raster position.
//
// A call for each type stores floats in the current values; glVertex hands these to the stream.

#include "calls/call.h"
#include "calls/values.h"
#include "vertex/raster_position.h"

namespace frontmost::gl_detail {
namespace {

/// Stores current values from number `first` on.
template <int first, class... Floats>
inline void store(Context& c, Floats... values) {
  float* to = &c.state.current.values[first];
  ((*to++ = values), ...);
}

template <class T>
inline void set_vertex(T x, T y, T z = 0, T w = 1) {
  const float fx = float(x), fy = float(y), fz = float(z), fw = float(w);
  vertex_call([=](Context& c) {
    store<kX>(c, fx, fy, fz, fw);
    if (c.stream.is_open()) c.stream.vertex(c);
  });
}

template <class T>
inline void set_normal(T x, T y, T z) {
  const float fx = normalized(x), fy = normalized(y), fz = normalized(z);
  vertex_call([=](Context& c) { store<kNormalX>(c, fx, fy, fz); });
}

template <class... T>
inline void set_color(T... values) {
  const auto call = [](float r, float g, float b, float a = 1) {
    vertex_call([=](Context& c) {
      store<kRed>(c, r, g, b, a);
      if (c.state.capabilities.has(Capability::color_material)) [[unlikely]]
        apply_color_material(c.state);
    });
  };
  call(normalized(values)...);
}

template <class T>
inline void set_secondary_color(T r, T g, T b) {
  const float fr = normalized(r), fg = normalized(g), fb = normalized(b);
  vertex_call([=](Context& c) { store<kRed2>(c, fr, fg, fb); });
}

template <class T>
inline void set_texcoord(T s, T t = 0, T r = 0, T q = 1) {
  const float fs = float(s), ft = float(t), fr = float(r), fq = float(q);
  vertex_call([=](Context& c) { store<kTexCoord>(c, fs, ft, fr, fq); });
}

template <class T>
inline void set_multi_texcoord(GLenum target, T s, T t = 0, T r = 0, T q = 1) {
  const std::array<float, 4> coordinates{float(s), float(t), float(r), float(q)};
  vertex_call([=](Context& c) {
    const GLenum unit = target - GL_TEXTURE0;
    if (unit >= GLenum(kTextureUnits)) return c.fail(GL_INVALID_ENUM);
    for (std::size_t i = 0; i < 4; ++i) c.state.current.values[kTexCoord + 4 * unit + i] = coordinates[i];
  });
}

template <class T>
inline void set_fog_coord(T v) {
  vertex_call([f = float(v)](Context& c) { store<kFogCoord>(c, f); });
}

inline void set_edge_flag(GLboolean flag) {
  vertex_call([=](Context& c) { store<kEdgeFlag>(c, flag ? 1.0f : 0.0f); });
}

/// Colors are never indexes here.
template <class T>
inline void set_index(T) {}

/// Calls that are errors between glBegin and glEnd, but leave the state that batches depend on.
template <class Call>
inline void whole_call(const Call& call) {
  vertex_call([call](Context& c) {
    if (c.is_inside_begin()) return c.fail(GL_INVALID_OPERATION);
    call(c);
  });
}

template <class T>
inline void set_raster(T x, T y, T z = 0, T w = 1) {
  whole_call([at = glm::vec4(x, y, z, w)](Context& c) { set_raster_position(c, at, c.stream.execution.isa); });
}

template <class T>
inline void set_window(T x, T y, T z = 0) {
  whole_call([at = glm::vec3(x, y, z)](Context& c) { set_window_position(c, at); });
}

template <class T>
inline void draw_rect(T x1, T y1, T x2, T y2) {
  const float left = float(x1), bottom = float(y1), right = float(x2), top = float(y2);
  whole_call([=](Context& c) {
    c.stream.begin(c, GL_POLYGON);
    for (const glm::vec2 corner : {glm::vec2(left, bottom), {right, bottom}, {right, top}, {left, top}}) {
      store<kX>(c, corner.x, corner.y, 0.0f, 1.0f);
      c.stream.vertex(c);
    }
    c.stream.end(c);
  });
}

}  // namespace

FRONTMOST_GL void glBegin(GLenum mode) {
  vertex_call([=](Context& c) {
    if (c.is_inside_begin()) return c.fail(GL_INVALID_OPERATION);
    if (mode > GL_POLYGON) return c.fail(GL_INVALID_ENUM);
    c.stream.begin(c, mode);
  });
}
FRONTMOST_GL void glEnd() {
  vertex_call([](Context& c) {
    if (!c.is_inside_begin()) return c.fail(GL_INVALID_OPERATION);
    c.stream.end(c);
  });
}

// A pair of entry points: values as arguments, and values behind a pointer. SIZE_n is the pair for n values of a type.
#define PAIR(name, s, parameters, pointers, values, elements, set) \
  FRONTMOST_GL void name##s parameters { set values; }             \
  FRONTMOST_GL void name##s##v pointers { set elements; }
#define SIZE_1(name, s, T, set) PAIR(name##1, s, (T x), (const T* v), (x), (v[0]), set)
#define SIZE_2(name, s, T, set) PAIR(name##2, s, (T x, T y), (const T* v), (x, y), (v[0], v[1]), set)
#define SIZE_3(name, s, T, set) PAIR(name##3, s, (T x, T y, T z), (const T* v), (x, y, z), (v[0], v[1], v[2]), set)
#define SIZE_4(name, s, T, set) \
  PAIR(name##4, s, (T x, T y, T z, T w), (const T* v), (x, y, z, w), (v[0], v[1], v[2], v[3]), set)
#define DOUBLE_TO_SHORT(SIZE, name, set) \
  SIZE(name, d, GLdouble, set) SIZE(name, f, GLfloat, set) SIZE(name, i, GLint, set) SIZE(name, s, GLshort, set)
#define ALL_TYPES(SIZE, name, set) \
  DOUBLE_TO_SHORT(SIZE, name, set) \
  SIZE(name, b, GLbyte, set) SIZE(name, ub, GLubyte, set) SIZE(name, us, GLushort, set) SIZE(name, ui, GLuint, set)

DOUBLE_TO_SHORT(SIZE_2, glVertex, set_vertex)
DOUBLE_TO_SHORT(SIZE_3, glVertex, set_vertex)
DOUBLE_TO_SHORT(SIZE_4, glVertex, set_vertex)
DOUBLE_TO_SHORT(SIZE_3, glNormal, set_normal)
SIZE_3(glNormal, b, GLbyte, set_normal)
ALL_TYPES(SIZE_3, glColor, set_color)
ALL_TYPES(SIZE_4, glColor, set_color)
ALL_TYPES(SIZE_3, glSecondaryColor, set_secondary_color)
DOUBLE_TO_SHORT(SIZE_1, glTexCoord, set_texcoord)
DOUBLE_TO_SHORT(SIZE_2, glTexCoord, set_texcoord)
DOUBLE_TO_SHORT(SIZE_3, glTexCoord, set_texcoord)
DOUBLE_TO_SHORT(SIZE_4, glTexCoord, set_texcoord)
DOUBLE_TO_SHORT(SIZE_2, glRasterPos, set_raster)
DOUBLE_TO_SHORT(SIZE_3, glRasterPos, set_raster)
DOUBLE_TO_SHORT(SIZE_4, glRasterPos, set_raster)
DOUBLE_TO_SHORT(SIZE_2, glWindowPos, set_window)
DOUBLE_TO_SHORT(SIZE_3, glWindowPos, set_window)
PAIR(glFogCoord, d, (GLdouble x), (const GLdouble* v), (x), (v[0]), set_fog_coord)
PAIR(glFogCoord, f, (GLfloat x), (const GLfloat* v), (x), (v[0]), set_fog_coord)
PAIR(glEdgeFlag, , (GLboolean flag), (const GLboolean* v), (flag), (v[0]), set_edge_flag)

#define FOR_TYPES(CALLS) CALLS(d, GLdouble) CALLS(f, GLfloat) CALLS(i, GLint) CALLS(s, GLshort)
#define INDEX(s, T) PAIR(glIndex, s, (T x), (const T* v), (x), (v), set_index)
FOR_TYPES(INDEX)
INDEX(ub, GLubyte)

#define RECT(s, T)                                                                                                \
  PAIR(glRect, s, (T x1, T y1, T x2, T y2), (const T* a, const T* b), (x1, y1, x2, y2), (a[0], a[1], b[0], b[1]), \
       draw_rect)
FOR_TYPES(RECT)

// Calls that have names of extensions, too.
#define ALIASES(name, s, E)                \
  FRONTMOST_GL_ALIAS(name##s##E, name##s); \
  FRONTMOST_GL_ALIAS(name##s##v##E, name##s##v);
#define MULTI(n, s, parameters, pointers, values, elements)                               \
  PAIR(glMultiTexCoord##n, s, parameters, pointers, values, elements, set_multi_texcoord) \
  ALIASES(glMultiTexCoord##n, s, ARB)
#define MULTI_SIZES(s, T)                                                                                         \
  MULTI(1, s, (GLenum unit, T x), (GLenum unit, const T* v), (unit, x), (unit, v[0]))                             \
  MULTI(2, s, (GLenum unit, T x, T y), (GLenum unit, const T* v), (unit, x, y), (unit, v[0], v[1]))               \
  MULTI(3, s, (GLenum unit, T x, T y, T z), (GLenum unit, const T* v), (unit, x, y, z), (unit, v[0], v[1], v[2])) \
  MULTI(4, s, (GLenum unit, T x, T y, T z, T w), (GLenum unit, const T* v), (unit, x, y, z, w),                   \
        (unit, v[0], v[1], v[2], v[3]))
FOR_TYPES(MULTI_SIZES)

#define WINDOW_ALIASES(s, T)    \
  ALIASES(glWindowPos2, s, ARB) \
  ALIASES(glWindowPos3, s, ARB) ALIASES(glWindowPos2, s, MESA) ALIASES(glWindowPos3, s, MESA)
FOR_TYPES(WINDOW_ALIASES)
#define SECONDARY_ALIASES(s, T) ALIASES(glSecondaryColor3, s, EXT)
FOR_TYPES(SECONDARY_ALIASES)
SECONDARY_ALIASES(b, GLbyte)
SECONDARY_ALIASES(ub, GLubyte)
SECONDARY_ALIASES(us, GLushort)
SECONDARY_ALIASES(ui, GLuint)
ALIASES(glFogCoord, d, EXT)
ALIASES(glFogCoord, f, EXT)

}  // namespace frontmost::gl_detail
