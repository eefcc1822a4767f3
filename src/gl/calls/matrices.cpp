// SPDX-License-Identifier: Apache-2.0
// The stacks of matrices. All matrices are doubles.

#include "calls/call.h"
#include "calls/values.h"
#include "scene/turn.h"

namespace frontmost::gl_detail {

namespace {

glm::dmat4& top(Context& c) { return c.matrices.chosen(c.state).back(); }

void multiply(const glm::dmat4& m) {
  draw_call([m](Context& c) { top(c) = top(c) * m; });
}

/// The matrix behind a pointer, column by column.
template <class T>
glm::dmat4 matrix_at(const T* values) {
  glm::dmat4 m(1);
  for (int i = 0; values && i < 16; ++i) m[i / 4][i % 4] = double(values[i]);
  return m;
}

void rotate(double degrees, glm::dvec3 axis) {
  const double length = std::sqrt(glm::dot(axis, axis));
  if (!(length > 0)) return;
  axis /= length;
  const glm::dvec2 turned = turn_of_degrees(degrees);
  const glm::dvec3 sines = axis * turned.y, rest = axis * (1 - turned.x);
  glm::dmat4 m(1);
  m[0] = {axis.x * rest.x + turned.x, axis.y * rest.x + sines.z, axis.z * rest.x - sines.y, 0};
  m[1] = {axis.x * rest.y - sines.z, axis.y * rest.y + turned.x, axis.z * rest.y + sines.x, 0};
  m[2] = {axis.x * rest.z + sines.y, axis.y * rest.z - sines.x, axis.z * rest.z + turned.x, 0};
  multiply(m);
}

void scale(double x, double y, double z) {
  glm::dmat4 m(1);
  m[0].x = x;
  m[1].y = y;
  m[2].z = z;
  multiply(m);
}

void translate(double x, double y, double z) {
  glm::dmat4 m(1);
  m[3] = {x, y, z, 1};
  multiply(m);
}

/// Multiplies by the matrix of glFrustum or glOrtho, if the box has a volume.
void project(const glm::dvec3& low, const glm::dvec3& high, bool is_frustum) {
  draw_call([=](Context& c) {
    const double near = low.z, far = high.z;
    if (low.x == high.x || low.y == high.y || near == far || (is_frustum && (near <= 0 || far <= 0)))
      return c.fail(GL_INVALID_VALUE);
    const glm::dvec3 size = high - low, sum = high + low;
    glm::dmat4 m(1);
    if (is_frustum) {
      m[0].x = 2 * near / size.x;
      m[1].y = 2 * near / size.y;
      m[2] = {sum.x / size.x, sum.y / size.y, -sum.z / size.z, -1};
      m[3] = {0, 0, -2 * far * near / size.z, 0};
    } else {
      m[0].x = 2 / size.x;
      m[1].y = 2 / size.y;
      m[2].z = -2 / size.z;
      m[3] = {-sum.x / size.x, -sum.y / size.y, -sum.z / size.z, 1};
    }
    top(c) = top(c) * m;
  });
}

}  // namespace

#define MATRIX_CALLS(s, T)                                                                                  \
  FRONTMOST_GL void glLoadMatrix##s(const T* m) {                                                           \
    if (m) draw_call([m = matrix_at(m)](Context& c) { top(c) = m; });                                       \
  }                                                                                                         \
  FRONTMOST_GL void glLoadTransposeMatrix##s(const T* m) {                                                  \
    if (m) draw_call([m = glm::transpose(matrix_at(m))](Context& c) { top(c) = m; });                       \
  }                                                                                                         \
  FRONTMOST_GL void glMultMatrix##s(const T* m) { multiply(matrix_at(m)); }                                 \
  FRONTMOST_GL void glMultTransposeMatrix##s(const T* m) { multiply(glm::transpose(matrix_at(m))); }        \
  FRONTMOST_GL_ALIAS(glLoadTransposeMatrix##s##ARB, glLoadTransposeMatrix##s);                              \
  FRONTMOST_GL_ALIAS(glMultTransposeMatrix##s##ARB, glMultTransposeMatrix##s);                              \
  FRONTMOST_GL void glRotate##s(T degrees, T x, T y, T z) { rotate(double(degrees), glm::dvec3(x, y, z)); } \
  FRONTMOST_GL void glScale##s(T x, T y, T z) { scale(double(x), double(y), double(z)); }                   \
  FRONTMOST_GL void glTranslate##s(T x, T y, T z) { translate(double(x), double(y), double(z)); }

MATRIX_CALLS(f, GLfloat)
MATRIX_CALLS(d, GLdouble)

FRONTMOST_GL void glMatrixMode(GLenum mode) {
  draw_call([=](Context& c) {
    if (!is_one_of(mode, GL_MODELVIEW, GL_PROJECTION, GL_TEXTURE)) return c.fail(GL_INVALID_ENUM);
    c.state.transform.matrix_mode = mode;
  });
}
FRONTMOST_GL void glLoadIdentity() {
  draw_call([](Context& c) { top(c) = glm::dmat4(1); });
}
FRONTMOST_GL void glPushMatrix() {
  draw_call([](Context& c) {
    auto& stack = c.matrices.chosen(c.state);
    const GLenum mode = c.state.transform.matrix_mode;
    const int most = mode == GL_MODELVIEW ? kModelviewDepth : mode == GL_PROJECTION ? kProjectionDepth : kTextureDepth;
    if (int(stack.size()) >= most) return c.fail(GL_STACK_OVERFLOW);
    stack.push_back(stack.back());
  });
}
FRONTMOST_GL void glPopMatrix() {
  draw_call([](Context& c) {
    auto& stack = c.matrices.chosen(c.state);
    if (stack.size() < 2) return c.fail(GL_STACK_UNDERFLOW);
    stack.pop_back();
  });
}
FRONTMOST_GL void glFrustum(GLdouble left, GLdouble right, GLdouble bottom, GLdouble top, GLdouble near, GLdouble far) {
  project({left, bottom, near}, {right, top, far}, true);
}
FRONTMOST_GL void glOrtho(GLdouble left, GLdouble right, GLdouble bottom, GLdouble top, GLdouble near, GLdouble far) {
  project({left, bottom, near}, {right, top, far}, false);
}

}  // namespace frontmost::gl_detail
