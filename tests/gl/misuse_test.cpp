// SPDX-License-Identifier: Apache-2.0
// Every misuse that the OpenGL 1.5 specification names: a bad call records its error, and changes nothing.
#include <algorithm>
#include <initializer_list>

#include "state_table.h"

namespace frontmost::test::misuse {
namespace {

struct Misuse {
  const char *call, *error_name;
  GLenum error;
  void (*make)();
};
// A call, or several, whose last one is bad.
#define BAD(error, call, ...)                \
  Misuse {                                   \
    call, #error, error, [] { __VA_ARGS__; } \
  }
#define ENUM(...) BAD(GL_INVALID_ENUM, #__VA_ARGS__, __VA_ARGS__)
#define VALUE(...) BAD(GL_INVALID_VALUE, #__VA_ARGS__, __VA_ARGS__)
#define OP(...) BAD(GL_INVALID_OPERATION, #__VA_ARGS__, __VA_ARGS__)
#define OVERFLOW(...) BAD(GL_STACK_OVERFLOW, #__VA_ARGS__, __VA_ARGS__)
#define UNDERFLOW(...) BAD(GL_STACK_UNDERFLOW, #__VA_ARGS__, __VA_ARGS__)

/// Memory of any type for calls, which may write to it.
struct Memory {
  alignas(8) char bytes[4096];
  template <class T>
  operator T*() {
    return reinterpret_cast<T*>(bytes);
  }
} m;
const GLfloat kTriangle[] = {-1, -1, 1, -1, 0, 1};
const GLuint kOne[] = {1, 7};
constexpr GLenum kNoEnum = 0xFFFF, k2D = GL_TEXTURE_2D;

// Calls that many rows make.
void texels(GLint level, GLenum format, GLenum type) { glGetTexImage(k2D, level, format, type, m); }
void parameter(GLenum pname, GLint v) { glTexParameteri(k2D, pname, v); }
void env(GLenum pname, GLint v) { glTexEnvi(GL_TEXTURE_ENV, pname, v); }
void gen(GLenum coordinate, GLint mode) { glTexGeni(coordinate, GL_TEXTURE_GEN_MODE, mode); }
void light(GLenum pname, GLfloat v) { glLightf(GL_LIGHT0, pname, v); }
void image(GLint level, GLint internal, GLsizei w, GLsizei h, GLint border, GLenum format = GL_RGB,
           GLenum type = GL_UNSIGNED_BYTE) {
  glTexImage2D(k2D, level, internal, w, h, border, format, type, m);
}
void part(GLint level, GLint x, GLint y, GLsizei w, GLsizei h, GLenum format = GL_RGB, GLenum type = GL_BYTE) {
  glTexSubImage2D(k2D, level, x, y, w, h, format, type, m);
}
void draw(GLsizei w, GLsizei h, GLenum format, GLenum type) { glDrawPixels(w, h, format, type, m); }
void read(GLsizei w, GLsizei h, GLenum format, GLenum type) { glReadPixels(0, 0, w, h, format, type, m); }
void elements(GLenum mode, GLsizei count, GLenum type) { glDrawElements(mode, count, type, m); }
void set_bytes(GLintptr offset, GLsizeiptr size) { glBufferSubData(GL_ARRAY_BUFFER, offset, size, m); }
void patch(GLint u_stride, GLint u_order, GLint v_stride, GLint v_order, GLfloat u2 = 1, GLfloat v2 = 1) {
  glMap2f(GL_MAP2_VERTEX_3, 0, u2, u_stride, u_order, 0, v2, v_stride, v_order, m);
}
void push_matrices(int n) {
  while (n-- > 0) glPushMatrix();
}
void bind_buffer() {
  glBindBuffer(GL_ARRAY_BUFFER, 1), glBufferData(GL_ARRAY_BUFFER, 16, kTriangle, GL_STATIC_DRAW);
  glVertexPointer(2, GL_FLOAT, 0, nullptr);
}

/// A picture with colors, depths and stencil values; texture 1 and an array, ready to be drawn.
void set_scene() {
  glClearColor(.2f, .4f, .6f, .8f), glClearStencil(3);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
  std::fill_n(m.bytes, sizeof m.bytes, 'A'), glBindTexture(k2D, 1), image(0, GL_RGB, 4, 4, 0, GL_RGB);
  std::fill_n(m.bytes, sizeof m.bytes, 0);
  glEnableClientState(GL_VERTEX_ARRAY), glVertexPointer(2, GL_FLOAT, 0, kTriangle);
  glEnable(GL_DEPTH_TEST), glColor3f(1, 0, 0), glRectf(-.5f, -.5f, .5f, .5f), glColor3f(0, 1, 0);
}

/// Names of what everything() has beside the state.
const char* const kOthers[] = {"colors", "depths", "stencil values", "texels", "bytes of the buffer", "objects"};
std::vector<std::vector<double>> everything() {
  std::vector<std::vector<double>> all = all_values();
  const auto add = [&](const auto& values) { all.emplace_back(values.begin(), values.end()); };
  add(read_colors(0, 0, 16, 16));
  add(read_pixels<GLuint>(0, 0, 16, 16, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT));
  add(read_stencil(0, 0, 16, 16));
  add(asked<glGetTexImage, GLubyte>(48, k2D, 0, GLenum(GL_RGB), GLenum(GL_UNSIGNED_BYTE)));
  add(asked<glGetBufferSubData, GLubyte>(16, GLenum(GL_ARRAY_BUFFER), 0, 16));
  std::vector<int> objects;
  for (GLuint n = 1; n < 8; ++n)
    for (const int is : {glIsList(n), glIsTexture(n), glIsBuffer(n), glIsQuery(n)}) objects.push_back(is);
  add(objects);
  glGetError();  // of a buffer that cannot be read
  return all;
}

/// Makes each call in a new context, after `set_up`; between glBegin and glEnd, if `is_inside`.
void expect_errors(
    std::initializer_list<Misuse> rows, void (*set_up)() = [] {}, bool is_inside = false) {
  for (const Misuse& row : rows) {
    SCOPED_TRACE(row.call);
    OffScreen screen;
    set_scene();
    set_up();
    ASSERT_EQ(glGetError(), GLenum(GL_NO_ERROR)) << "of the calls before";
    const auto before = everything();
    if (is_inside) glBegin(GL_TRIANGLES);
    row.make();
    if (is_inside) glEnd();
    EXPECT_EQ(glGetError(), row.error) << row.error_name << " must be recorded";
    EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR)) << "after one error";
    const auto after = everything();
    for (std::size_t k = 0, n = state_table().size(); k < before.size(); ++k)
      EXPECT_TRUE(before[k] == after[k]) << (k < n ? state_table()[k].name : kOthers[k - n]) << " must be as before";
  }
}

// clang-format off
// The specification leaves it open whether calls about client arrays and pixel stores are errors between glBegin and
// glEnd. This library promises that they are.
TEST(Misuse, BetweenBeginAndEnd) {
  expect_errors({OP(glBegin(GL_LINES)), OP(glAccum(GL_ADD, 1)), OP(glActiveTexture(GL_TEXTURE1)),
      OP(glAlphaFunc(GL_LESS, .5f)), OP(glAreTexturesResident(1, m, m)), OP(glBeginQuery(GL_SAMPLES_PASSED, 1)),
      OP(glBindBuffer(GL_ARRAY_BUFFER, 1)), OP(glBindTexture(k2D, 2)), OP(glBitmap(8, 8, 0, 0, 1, 1, m)),
      OP(glBlendColor(1, 1, 1, 1)), OP(glBlendEquation(GL_MAX)), OP(glBlendFunc(GL_ZERO, GL_ZERO)),
      OP(glBlendFuncSeparate(GL_ZERO, GL_ZERO, GL_ZERO, GL_ZERO)),
      OP(glBufferData(GL_ARRAY_BUFFER, 8, m, GL_STATIC_DRAW)), OP(glBufferSubData(GL_ARRAY_BUFFER, 0, 8, m)),
      OP(glClear(GL_COLOR_BUFFER_BIT)), OP(glClearAccum(1, 1, 1, 1)), OP(glClearColor(1, 1, 1, 1)),
      OP(glClearDepth(.5)), OP(glClearIndex(1)), OP(glClearStencil(1)), OP(glClipPlane(GL_CLIP_PLANE0, m)),
      OP(glColorMask(0, 0, 0, 0)), OP(glColorMaterial(GL_FRONT, GL_AMBIENT)), OP(glCopyPixels(0, 0, 8, 8, GL_COLOR)),
      OP(glCopyTexImage2D(k2D, 0, GL_RGB, 0, 0, 8, 8, 0)), OP(glCopyTexSubImage2D(k2D, 0, 0, 0, 0, 0, 1, 1)),
      OP(glCullFace(GL_FRONT)), OP(glDeleteBuffers(1, m)), OP(glDeleteLists(1, 1)), OP(glDeleteQueries(1, m)),
      OP(glDeleteTextures(1, kOne)), OP(glDepthFunc(GL_ALWAYS)), OP(glDepthMask(0)), OP(glDepthRange(1, 0)),
      OP(glDisable(GL_DITHER)), OP(glDrawArrays(GL_TRIANGLES, 0, 3)), OP(glDrawBuffer(GL_NONE)),
      OP(glDrawElements(GL_TRIANGLES, 3, GL_UNSIGNED_INT, m)), OP(glDrawPixels(8, 8, GL_RGBA, GL_UNSIGNED_BYTE, m)),
      OP(glEnable(GL_FOG)), OP(glEndList()), OP(glEndQuery(GL_SAMPLES_PASSED)), OP(glEvalMesh1(GL_LINE, 0, 1)),
      OP(glFinish()), OP(glFlush()), OP(glFogf(GL_FOG_DENSITY, 2)), OP(glFrontFace(GL_CW)),
      OP(glFrustum(-1, 1, -1, 1, 1, 2)), OP(glGenBuffers(1, m)), OP(EXPECT_EQ(glGenLists(1), 0u)),
      OP(glGenQueries(1, m)), OP(glGenTextures(1, m)), OP(glGetClipPlane(GL_CLIP_PLANE0, m)),
      OP(EXPECT_EQ(glGetError(), 0u)), OP(glGetIntegerv(GL_FOG, m)), OP(glGetLightfv(GL_LIGHT0, GL_AMBIENT, m)),
      OP(glGetPointerv(GL_VERTEX_ARRAY_POINTER, m)), OP(glGetPolygonStipple(m)),
      OP(glGetQueryiv(GL_SAMPLES_PASSED, GL_CURRENT_QUERY, m)), OP(EXPECT_EQ(glGetString(GL_VENDOR), nullptr)),
      OP(glGetTexEnvfv(GL_TEXTURE_ENV, GL_TEXTURE_ENV_COLOR, m)),
      OP(glGetTexImage(k2D, 0, GL_RGBA, GL_UNSIGNED_BYTE, m)), OP(glHint(GL_FOG_HINT, GL_NICEST)), OP(glIndexMask(0)),
      OP(glIsBuffer(1)), OP(EXPECT_FALSE(glIsEnabled(GL_DITHER))), OP(glIsList(1)), OP(EXPECT_FALSE(glIsTexture(1))),
      OP(glLightf(GL_LIGHT0, GL_SPOT_CUTOFF, 9)), OP(glLightModeli(GL_LIGHT_MODEL_TWO_SIDE, 1)),
      OP(glLineStipple(2, 1)), OP(glLineWidth(2)), OP(glListBase(7)), OP(glLoadIdentity()), OP(glLoadMatrixf(m)),
      OP(glLogicOp(GL_CLEAR)), OP(glMap1f(GL_MAP1_INDEX, 0, 2, 1, 2, m)),
      OP(glMapBuffer(GL_ARRAY_BUFFER, GL_READ_ONLY)), OP(glMapGrid1f(2, 0, 2)), OP(glMatrixMode(GL_TEXTURE)),
      OP(glMultiDrawArrays(GL_TRIANGLES, m, m, 1)), OP(glMultMatrixf(m)), OP(glNewList(1, GL_COMPILE)),
      OP(glOrtho(0, 2, 0, 2, 0, 2)), OP(glPixelMapfv(GL_PIXEL_MAP_I_TO_I, 2, m)), OP(glPixelTransferi(GL_MAP_COLOR, 1)),
      OP(glPixelZoom(2, 2)), OP(glPointParameterf(GL_POINT_SIZE_MIN, 2)), OP(glPointSize(2)),
      OP(glPolygonMode(GL_FRONT, GL_LINE)), OP(glPolygonOffset(1, 1)), OP(glPolygonStipple(m)), OP(glPopAttrib()),
      OP(glPopMatrix()), OP(glPrioritizeTextures(1, kOne, m)), OP(glPushAttrib(GL_FOG_BIT)), OP(glPushMatrix()),
      OP(glRasterPos2f(.5f, .5f)), OP(glReadBuffer(GL_FRONT_LEFT)), OP(glRectf(-1, -1, 1, 1)),
      OP(glReadPixels(0, 0, 1, 1, GL_RGBA, GL_FLOAT, m)), OP(glRenderMode(GL_RENDER)), OP(glRotatef(30, 0, 0, 1)),
      OP(glScissor(1, 1, 1, 1)), OP(glShadeModel(GL_FLAT)), OP(glStencilFunc(GL_NEVER, 1, 1)), OP(glStencilMask(1)),
      OP(glStencilOp(GL_ZERO, GL_ZERO, GL_ZERO)), OP(glTexEnvi(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, GL_DECAL)),
      OP(glTexGeni(GL_S, GL_TEXTURE_GEN_MODE, GL_OBJECT_LINEAR)),
      OP(glTexImage2D(k2D, 0, 4, 1, 1, 0, GL_RGBA, GL_FLOAT, m)), OP(glTexParameteri(k2D, GL_TEXTURE_WRAP_S, GL_CLAMP)),
      OP(glTexSubImage2D(k2D, 0, 0, 0, 1, 1, GL_RGBA, GL_FLOAT, m)), OP(glTranslatef(1, 0, 0)),
      OP(glUnmapBuffer(GL_ARRAY_BUFFER)), OP(glViewport(1, 1, 1, 1)), OP(glWindowPos2i(1, 1)),
      OP(glClientActiveTexture(GL_TEXTURE1)), OP(glDisableClientState(GL_VERTEX_ARRAY)),
      OP(glInterleavedArrays(GL_V3F, 0, m)), OP(glPixelStorei(GL_PACK_ALIGNMENT, 1)), OP(glPopClientAttrib()),
      OP(glPushClientAttrib(1)), OP(glVertexPointer(4, GL_INT, 4, m))}, [] {}, true);
  expect_errors({OP(glCallList(1)),
      OP(glCallLists(1, GL_UNSIGNED_BYTE, "\1"))}, [] { glNewList(1, GL_COMPILE), glLineWidth(3), glEndList(); }, true);
  OffScreen screen;
  glNewList(1, GL_COMPILE), glColor3f(1, 1, 1), glEndList(), glBegin(GL_TRIANGLES), glVertex2f(0, 0), glIndexi(1);
  glColor3f(1, 0, 0), glSecondaryColor3f(1, 0, 0), glNormal3f(0, 0, 1), glMultiTexCoord2f(GL_TEXTURE1, 0, 0);
  glTexCoord1f(0), glFogCoordf(1), glEdgeFlag(1), glMaterialf(GL_FRONT, GL_SHININESS, 1), glEvalCoord1f(0);
  glEvalCoord2f(0, 0), glEvalPoint1(0), glEvalPoint2(0, 0), glArrayElement(0), glCallList(1);
  glCallLists(1, GL_UNSIGNED_BYTE, "\1"), glEnd();
  EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR)) << "of calls that belong there";
}

TEST(Misuse, OfNamesValuesAndState) {
  expect_errors({ENUM(glBegin(GL_POLYGON + 1)), OP(glEnd()), ENUM(glEnable(0)), ENUM(glDisable(kNoEnum)),
      ENUM(glIsEnabled(GL_COLOR)), ENUM(glEnable(GL_LIGHT0 + 8)), ENUM(glEnable(GL_CLIP_PLANE0 + 6)),
      ENUM(glEnable(GL_VERTEX_ARRAY)), ENUM(glEnableClientState(GL_FOG)), ENUM(glGetBooleanv(0, m)),
      ENUM(glGetIntegerv(GL_AMBIENT, m)), ENUM(glGetLightfv(GL_LIGHT0 + 8, GL_AMBIENT, m)),
      ENUM(glGetMaterialfv(GL_FRONT_AND_BACK, GL_AMBIENT, m)), ENUM(glGetClipPlane(GL_CLIP_PLANE0 + 6, m)),
      ENUM(glGetTexEnvfv(0, GL_TEXTURE_ENV_COLOR, m)), ENUM(glGetTexGendv(GL_RED, GL_EYE_PLANE, m)),
      ENUM(glGetTexParameterfv(GL_PROXY_TEXTURE_2D, GL_TEXTURE_PRIORITY, m)),
      ENUM(glGetTexLevelParameteriv(k2D, 0, GL_TEXTURE_WRAP_S, m)),
      VALUE(glGetTexLevelParameteriv(k2D, -1, GL_TEXTURE_WIDTH, m)),
      ENUM(glGetTexImage(GL_PROXY_TEXTURE_2D, 0, GL_RGBA, GL_FLOAT, m)), VALUE(texels(-1, GL_RGBA, GL_FLOAT)),
      ENUM(texels(0, GL_COLOR_INDEX, GL_FLOAT)), OP(texels(0, GL_RGB, GL_UNSIGNED_INT_8_8_8_8)),
      OP(texels(0, GL_DEPTH_COMPONENT, GL_FLOAT)), ENUM(glGetPixelMapfv(GL_MAP_COLOR, m)),
      ENUM(glGetMapdv(0, GL_ORDER, m)), ENUM(glGetPointerv(GL_VERTEX_ARRAY, m)), ENUM(glGetString(GL_FOG)),
      ENUM(glGetQueryiv(GL_FOG, GL_CURRENT_QUERY, m)), OP(glGetQueryObjectiv(0, GL_QUERY_RESULT, m)),
      ENUM(glRenderMode(GL_FILL)), ENUM(glMatrixMode(0)), ENUM(glMatrixMode(GL_MODELVIEW_MATRIX)),
      UNDERFLOW(glPopMatrix()), VALUE(glFrustum(-1, 1, -1, 1, 0, 2)), VALUE(glFrustum(-1, 1, -1, 1, 1, 0)),
      VALUE(glFrustum(1, 1, -1, 1, 1, 2)), VALUE(glFrustum(-1, 1, -1, 1, 2, 2)), VALUE(glOrtho(1, 1, 0, 1, 0, 1)),
      VALUE(glOrtho(0, 1, 0, 1, 1, 1)), VALUE(glViewport(0, 0, -1, 1)), ENUM(glClipPlane(GL_CLIP_PLANE0 + 6, m)),
      ENUM(glLightf(GL_LIGHT0 + 8, GL_SPOT_CUTOFF, 1)), ENUM(glLightfv(GL_FRONT, GL_AMBIENT, m)),
      ENUM(light(GL_SHININESS, 1)), ENUM(light(GL_POSITION, 1)), VALUE(light(GL_SPOT_EXPONENT, -1)),
      VALUE(light(GL_SPOT_EXPONENT, 129)), VALUE(glLighti(GL_LIGHT0, GL_SPOT_CUTOFF, 91)),
      VALUE(light(GL_CONSTANT_ATTENUATION, -1)), VALUE(light(GL_QUADRATIC_ATTENUATION, -1)),
      ENUM(glLightModeli(GL_LIGHT0, 1)), ENUM(glLightModeli(GL_LIGHT_MODEL_COLOR_CONTROL, GL_SMOOTH)),
      ENUM(glMaterialf(GL_FRONT, GL_AMBIENT, 1)), VALUE(glMaterialf(GL_FRONT, GL_SHININESS, -1)),
      VALUE(glMateriali(GL_BACK, GL_SHININESS, 129)), ENUM(glColorMaterial(GL_FRONT, GL_SHININESS)),
      ENUM(glShadeModel(GL_FILL)), ENUM(glFogi(GL_FOG_MODE, GL_REPEAT)), ENUM(glFogf(GL_FOG_COLOR, 1)),
      VALUE(glFogf(GL_FOG_DENSITY, -1)), ENUM(glFogi(GL_FOG_COORD_SRC, GL_FOG)), VALUE(glPointSize(0)),
      ENUM(glPointParameterf(GL_POINT_DISTANCE_ATTENUATION, 1)), VALUE(glPointParameterf(GL_POINT_SIZE_MIN, -1)),
      VALUE(glPointParameteri(GL_POINT_SIZE_MAX, -1)), VALUE(glPointParameterf(GL_POINT_FADE_THRESHOLD_SIZE, -1)),
      VALUE(glLineWidth(0)), ENUM(glCullFace(GL_CW)), ENUM(glPolygonMode(GL_LEFT, GL_FILL)),
      ENUM(glHint(GL_FOG_HINT, GL_LINEAR)), VALUE(glScissor(0, 0, -1, 1)), ENUM(glAlphaFunc(0, 1)),
      ENUM(glDepthFunc(0)), ENUM(glStencilFunc(GL_ZERO, 1, 1)), ENUM(glStencilOp(GL_ONE, GL_KEEP, GL_KEEP)),
      ENUM(glBlendFunc(GL_ONE, GL_SRC_ALPHA_SATURATE)), ENUM(glBlendFuncSeparate(1, 1, 1, GL_SRC_ALPHA_SATURATE)),
      ENUM(glBlendEquation(GL_ADD)), ENUM(glLogicOp(GL_CLEAR - 1)), VALUE(glClear(GL_COLOR_BUFFER_BIT | GL_FOG_BIT)),
      ENUM(glDrawBuffer(GL_COLOR)), OP(glDrawBuffer(GL_FRONT_RIGHT)), OP(glDrawBuffer(GL_AUX0)),
      ENUM(glReadBuffer(GL_FRONT_AND_BACK)), OP(glAccum(GL_LOAD, 1))});
}

TEST(Misuse, OfStacks) {
  expect_errors({OVERFLOW(glPushMatrix())}, [] { push_matrices(31); });
  expect_errors({UNDERFLOW(glPopMatrix())}, [] { glMatrixMode(GL_PROJECTION); });
  expect_errors({UNDERFLOW(glPopMatrix())}, [] { glMatrixMode(GL_TEXTURE); });
  expect_errors({OVERFLOW(glPushMatrix())}, [] { glMatrixMode(GL_PROJECTION), push_matrices(31); });
  expect_errors({OVERFLOW(glPushMatrix())}, [] { glMatrixMode(GL_TEXTURE), push_matrices(9); });
  expect_errors({UNDERFLOW(glPopAttrib()), UNDERFLOW(glPopClientAttrib())});
  expect_errors({OVERFLOW(glPushAttrib(GL_FOG_BIT))}, [] {
    for (int k = 0; k < 16; ++k) glPushAttrib(GL_ALL_ATTRIB_BITS);
  });
  OffScreen screen;
  for (int k = 0; k < 17; ++k) {
    EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR));
    glPushClientAttrib(GL_CLIENT_ALL_ATTRIB_BITS);
  }
  EXPECT_EQ(glGetError(), GLenum(GL_STACK_OVERFLOW)) << "of the 17th";
  EXPECT_EQ(state::get(GL_CLIENT_ATTRIB_STACK_DEPTH, 1)[0], 16);
}

TEST(Misuse, OfLists) {
  expect_errors({VALUE(glNewList(0, GL_COMPILE)), ENUM(glNewList(1, GL_RENDER)), VALUE(glDeleteLists(1, -1)),
      OP(glEndList()), VALUE(glCallLists(-1, GL_UNSIGNED_BYTE, "\1")), ENUM(glCallLists(1, GL_DOUBLE, m))});
  expect_errors({OP(glNewList(2, GL_COMPILE)), OP(glNewList(1, GL_COMPILE)),
      VALUE(glGenLists(-1))}, [] { glNewList(1, GL_COMPILE); });
  // Errors of calls in a list come when it is called.
  expect_errors({VALUE(glCallList(1)),
      VALUE(glCallLists(1, GL_UNSIGNED_BYTE, "\1"))}, [] { glNewList(1, GL_COMPILE), glPointSize(0), glEndList(); });
}

TEST(Misuse, OfTextures) {
  expect_errors({ENUM(glBindTexture(0, 1)), ENUM(glBindTexture(GL_PROXY_TEXTURE_2D, 1)),
      OP(glBindTexture(GL_TEXTURE_1D, 1)), VALUE(glGenTextures(-1, m)), VALUE(glDeleteTextures(-1, m)),
      VALUE(glPrioritizeTextures(-1, m, m)), VALUE(glAreTexturesResident(-1, m, m)),
      VALUE(glAreTexturesResident(1, m, m)), VALUE(glAreTexturesResident(2, kOne, m)),
      ENUM(glActiveTexture(GL_TEXTURE0 + 32)), ENUM(glClientActiveTexture(GL_TEXTURE0 + 32)),
      ENUM(glTexParameteri(GL_PROXY_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP)),
      ENUM(parameter(GL_TEXTURE_MAG_FILTER, GL_LINEAR_MIPMAP_LINEAR)), ENUM(parameter(GL_TEXTURE_WRAP_S, GL_NEAREST)),
      ENUM(parameter(GL_TEXTURE_BORDER_COLOR, 1)), VALUE(parameter(GL_TEXTURE_BASE_LEVEL, -1)),
      ENUM(glTexEnvi(k2D, GL_TEXTURE_ENV_MODE, GL_DECAL)), ENUM(env(GL_TEXTURE_WRAP_S, GL_CLAMP)),
      ENUM(env(GL_TEXTURE_ENV_MODE, GL_LINEAR)), ENUM(env(GL_TEXTURE_ENV_COLOR, 1)),
      ENUM(env(GL_COMBINE_ALPHA, GL_DOT3_RGB)), ENUM(env(GL_SOURCE0_RGB, GL_RGB)),
      ENUM(env(GL_OPERAND0_ALPHA, GL_SRC_COLOR)), VALUE(env(GL_RGB_SCALE, 3)),
      ENUM(glTexEnvi(GL_TEXTURE_FILTER_CONTROL, GL_TEXTURE_ENV_MODE, GL_DECAL)),
      ENUM(glTexGeni(GL_S, GL_AMBIENT, GL_EYE_LINEAR)), ENUM(gen(GL_S, GL_LINEAR)), ENUM(gen(GL_R, GL_SPHERE_MAP)),
      ENUM(gen(GL_Q, GL_REFLECTION_MAP)), ENUM(glTexGenf(GL_S, GL_OBJECT_PLANE, 1)),
      ENUM(glTexImage2D(GL_TEXTURE_1D, 0, GL_RGB, 4, 4, 0, GL_RGB, GL_BYTE, m)),
      ENUM(image(0, GL_RGB, 4, 4, 0, GL_INTENSITY)), ENUM(image(0, GL_RGB, 4, 4, 0, GL_RGB, GL_BITMAP)),
      VALUE(image(-1, GL_RGB, 4, 4, 0)), VALUE(image(0, 5, 4, 4, 0)), VALUE(image(0, GL_RGB, -1, 4, 0)),
      VALUE(image(0, GL_RGB, 3, 4, 0)), VALUE(image(0, GL_RGB, 1 << 30, 1, 0)), VALUE(image(0, GL_RGB, 4, 4, 2)),
      VALUE(image(0, GL_RGB, 8, 8, 1)), OP(image(0, GL_RGB, 4, 4, 0, GL_RGBA, GL_UNSIGNED_BYTE_3_3_2)),
      OP(image(0, GL_RGB, 4, 4, 0, GL_BGR, GL_UNSIGNED_SHORT_5_6_5)),
      ENUM(glTexImage1D(k2D, 0, GL_RGB, 4, 0, GL_RGB, GL_BYTE, m)),
      VALUE(glTexImage1D(GL_TEXTURE_1D, 0, GL_RGB, 5, 0, GL_RGB, GL_BYTE, m)),
      ENUM(glTexSubImage2D(GL_PROXY_TEXTURE_2D, 0, 0, 0, 1, 1, GL_RGB, GL_BYTE, m)), ENUM(part(0, 0, 0, 1, 1, GL_FOG)),
      OP(part(0, 0, 0, 1, 1, GL_RGBA, GL_UNSIGNED_SHORT_5_6_5)), VALUE(part(99, 0, 0, 1, 1)), OP(part(1, 0, 0, 1, 1)),
      VALUE(part(0, -1, 0, 1, 1)), VALUE(part(0, 3, 0, 2, 1)), VALUE(part(0, 0, 0, -1, 1)),
      VALUE(part(0, 0x7FFFFFFF, 0, 0x7FFFFFFF, 1)), ENUM(glTexSubImage1D(k2D, 0, 0, 1, GL_RGB, GL_BYTE, m)),
      ENUM(glCopyTexImage2D(GL_PROXY_TEXTURE_2D, 0, GL_RGB, 0, 0, 4, 4, 0)),
      ENUM(glCopyTexImage2D(k2D, 0, 3, 0, 0, 4, 4, 0)), VALUE(glCopyTexImage2D(k2D, 0, GL_RGB, 0, 0, 3, 4, 0)),
      VALUE(glCopyTexSubImage2D(k2D, 0, 3, 0, 0, 0, 2, 1)), OP(glCopyTexSubImage2D(k2D, 2, 0, 0, 0, 0, 1, 1))});
}

TEST(Misuse, OfPixels) {
  expect_errors({ENUM(glPixelStorei(GL_RED_SCALE, 1)), VALUE(glPixelStorei(GL_UNPACK_ALIGNMENT, 3)),
      VALUE(glPixelStoref(GL_PACK_ALIGNMENT, 16)), VALUE(glPixelStorei(GL_UNPACK_ROW_LENGTH, -1)),
      VALUE(glPixelStorei(GL_PACK_SKIP_PIXELS, -1)), ENUM(glPixelTransferf(GL_ZOOM_X, 1)),
      ENUM(glPixelMapfv(GL_MAP_COLOR, 1, m)), VALUE(glPixelMapfv(GL_PIXEL_MAP_R_TO_R, 0, m)),
      VALUE(glPixelMapusv(GL_PIXEL_MAP_A_TO_A, 1 << 20, nullptr)), VALUE(glPixelMapfv(GL_PIXEL_MAP_I_TO_I, 3, m)),
      VALUE(glPixelMapfv(GL_PIXEL_MAP_S_TO_S, 6, m)), VALUE(draw(-1, 1, GL_RGB, GL_FLOAT)),
      ENUM(draw(1, 1, GL_INTENSITY, GL_FLOAT)), ENUM(draw(1, 1, GL_RGB, GL_BITMAP)),
      OP(draw(1, 1, GL_RGBA, GL_UNSIGNED_BYTE_3_3_2)), VALUE(read(1, -1, GL_RGB, GL_FLOAT)),
      ENUM(read(1, 1, GL_RGBA8, GL_FLOAT)), OP(read(1, 1, GL_COLOR_INDEX, GL_FLOAT)),
      OP(read(1, 1, GL_BGR, GL_UNSIGNED_SHORT_5_6_5)), VALUE(glCopyPixels(0, 0, -1, 1, GL_COLOR)),
      ENUM(glCopyPixels(0, 0, 1, 1, GL_RGBA)), VALUE(glBitmap(-1, 1, 0, 0, 4, 4, m))});
}

TEST(Misuse, OfArraysAndBuffers) {
  expect_errors({VALUE(glVertexPointer(1, GL_FLOAT, 0, m)), VALUE(glVertexPointer(5, GL_FLOAT, 0, m)),
      ENUM(glVertexPointer(3, GL_BYTE, 0, m)), VALUE(glVertexPointer(3, GL_FLOAT, -1, m)),
      ENUM(glNormalPointer(GL_UNSIGNED_BYTE, 0, m)), VALUE(glColorPointer(2, GL_FLOAT, 0, m)),
      VALUE(glSecondaryColorPointer(2, GL_FLOAT, 0, m)), VALUE(glTexCoordPointer(0, GL_FLOAT, 0, m)),
      ENUM(glTexCoordPointer(2, GL_UNSIGNED_SHORT, 0, m)), ENUM(glFogCoordPointer(GL_INT, 0, m)),
      ENUM(glIndexPointer(GL_BYTE, 0, m)), VALUE(glEdgeFlagPointer(-1, m)), ENUM(glInterleavedArrays(GL_RGBA, 0, m)),
      VALUE(glInterleavedArrays(GL_V3F, -1, m)), ENUM(glDrawArrays(GL_POLYGON + 1, 0, 3)),
      VALUE(glDrawArrays(GL_TRIANGLES, 0, -3)), ENUM(elements(kNoEnum, 3, GL_UNSIGNED_INT)),
      VALUE(elements(GL_TRIANGLES, -3, GL_UNSIGNED_INT)), ENUM(elements(GL_TRIANGLES, 3, GL_INT)),
      VALUE(glDrawRangeElements(GL_TRIANGLES, 3, 2, 3, GL_UNSIGNED_INT, m)),
      VALUE(glMultiDrawArrays(GL_TRIANGLES, m, m, -1)),
      VALUE(glMultiDrawElements(GL_TRIANGLES, m, GL_UNSIGNED_INT, m, -1))});
  expect_errors({ENUM(glBindBuffer(k2D, 1)), VALUE(glGenBuffers(-1, m)), VALUE(glDeleteBuffers(-1, m)),
      OP(glBufferData(GL_ARRAY_BUFFER, 4, m, GL_STATIC_DRAW)), OP(set_bytes(0, 4)),
      OP(glGetBufferSubData(GL_ARRAY_BUFFER, 0, 4, m)), OP(glMapBuffer(GL_ARRAY_BUFFER, GL_READ_ONLY)),
      OP(glUnmapBuffer(GL_ARRAY_BUFFER))});
  expect_errors({ENUM(glBufferData(GL_FOG, 4, m, GL_STATIC_DRAW)),
      ENUM(glBufferData(GL_ARRAY_BUFFER, 4, m, GL_FASTEST)),
      VALUE(glBufferData(GL_ARRAY_BUFFER, -4, m, GL_STATIC_DRAW)), ENUM(glBufferSubData(0, 0, 4, m)),
      VALUE(set_bytes(-1, 4)), VALUE(set_bytes(13, 4)), VALUE(set_bytes(8, GLsizeiptr(~std::size_t(0) >> 1))),
      VALUE(glGetBufferSubData(GL_ARRAY_BUFFER, 0, -1, m)), ENUM(glMapBuffer(GL_ARRAY_BUFFER, GL_FOG)),
      OP(EXPECT_FALSE(glUnmapBuffer(GL_ARRAY_BUFFER))), ENUM(glGetBufferParameteriv(GL_ARRAY_BUFFER, GL_FOG, m)),
      ENUM(glGetBufferPointerv(GL_ARRAY_BUFFER, GL_BUFFER_SIZE, m))}, bind_buffer);
  expect_errors({OP(EXPECT_EQ(glMapBuffer(GL_ARRAY_BUFFER, GL_READ_ONLY), nullptr)), OP(set_bytes(0, 4)),
      OP(glGetBufferSubData(GL_ARRAY_BUFFER, 0, 4, m)),
      OP(glDrawArrays(GL_POINTS, 0, 1))}, [] { bind_buffer(), glMapBuffer(GL_ARRAY_BUFFER, GL_WRITE_ONLY); });
}

TEST(Misuse, OfQueriesAndEvaluators) {
  expect_errors({ENUM(glBeginQuery(GL_FOG, 1)), OP(glBeginQuery(GL_SAMPLES_PASSED, 0)), ENUM(glEndQuery(0)),
      OP(glEndQuery(GL_SAMPLES_PASSED)), VALUE(glGenQueries(-1, m)), VALUE(glDeleteQueries(-1, m))});
  expect_errors({OP(glBeginQuery(GL_SAMPLES_PASSED, 1)), OP(glBeginQuery(GL_SAMPLES_PASSED, 2)),
      OP(glGetQueryObjectiv(1, GL_QUERY_RESULT, m)),
      OP(glGetQueryObjectuiv(1, GL_QUERY_RESULT_AVAILABLE, m))}, [] { glBeginQuery(GL_SAMPLES_PASSED, 1); });
  expect_errors({ENUM(glGetQueryObjectiv(1, GL_CURRENT_QUERY, m)),
      OP(glEndQuery(GL_SAMPLES_PASSED))}, [] { glBeginQuery(GL_SAMPLES_PASSED, 1), glEndQuery(GL_SAMPLES_PASSED); });
  expect_errors({ENUM(glMap1f(GL_MAP2_VERTEX_3, 0, 1, 3, 2, m)), VALUE(glMap1f(GL_MAP1_VERTEX_3, 1, 1, 3, 2, m)),
      VALUE(glMap1d(GL_MAP1_VERTEX_3, 0, 1, 2, 2, m)), VALUE(glMap1f(GL_MAP1_VERTEX_3, 0, 1, 3, 0, m)),
      ENUM(glMap2f(GL_MAP1_VERTEX_3, 0, 1, 3, 2, 0, 1, 6, 2, m)), VALUE(patch(3, 2, 6, 2, 0)),
      VALUE(patch(3, 2, 6, 2, 1, 0)), VALUE(patch(3, 2, 2, 2)), VALUE(patch(3, 0, 6, 2)), VALUE(patch(3, 999, 6, 2)),
      VALUE(glMapGrid1f(0, 0, 1)), VALUE(glMapGrid2d(1, 0, 1, -1, 0, 1)), ENUM(glEvalMesh1(GL_FILL, 0, 1)),
      ENUM(glEvalMesh2(GL_POLYGON, 0, 1, 0, 1))});
  expect_errors({OP(glMap1f(GL_MAP1_VERTEX_3, 0, 1, 3, 2, m)),
      OP(patch(3, 2, 6, 2))}, [] { glActiveTexture(GL_TEXTURE1); });
}

TEST(Misuse, OfWhatIsNotOffered) {
  expect_errors({OP(glRenderMode(GL_SELECT)), OP(glRenderMode(GL_FEEDBACK)), OP(glSelectBuffer(8, m)),
      OP(glFeedbackBuffer(8, GL_2D, m)), OP(glTexImage3D(GL_TEXTURE_3D, 0, GL_RGB, 1, 1, 1, 0, GL_RGB, GL_FLOAT, m)),
      OP(glCompressedTexImage2D(k2D, 0, GL_RGB, 4, 4, 0, 8, m)),
      OP(glColorTable(0x80D0, GL_RGB, 1, GL_RGB, GL_FLOAT, m)), OP(glEnable(GL_TEXTURE_3D)),
      OP(image(0, GL_DEPTH_COMPONENT, 4, 4, 0, GL_DEPTH_COMPONENT, GL_FLOAT))});
}
// clang-format on

}  // namespace
}  // namespace frontmost::test::misuse
