// SPDX-License-Identifier: Apache-2.0
// Evaluators: Bezier curves and patches whose points become the vertices, colors, normals and texture coordinates of
// glEvalCoord. GLU's NURBS are drawn by them.

#include "calls/call.h"

namespace frontmost::gl_detail {
namespace {

constexpr int kComponents[kMaps] = {4, 1, 3, 1, 2, 3, 4, 3, 4};
constexpr int kMapNormal = 2, kMapTexCoord = 3, kMapVertex3 = 7, kMapVertex4 = 8;

/// The Bernstein polynomials of an order, at t.
struct Basis {
  std::array<double, kMostOrder> value{}, slope{};

  Basis(int order, double t) {
    value[0] = 1;
    for (int degree = 1; degree < order; ++degree) {
      if (degree + 1 == order)
        for (int i = 0; i <= degree; ++i)
          slope[std::size_t(i)] =
              degree * ((i > 0 ? value[std::size_t(i - 1)] : 0) - (i < degree ? value[std::size_t(i)] : 0));
      for (int i = degree; i >= 0; --i)
        value[std::size_t(i)] =
            (i > 0 ? t * value[std::size_t(i - 1)] : 0) + (i < degree ? (1 - t) * value[std::size_t(i)] : 0);
    }
  }
};

/// A map at a place: its value, and how it changes along u and v.
struct MapPoint {
  glm::dvec4 value{0, 0, 0, 1}, u{0}, v{0};
};

[[nodiscard]] MapPoint point_of(const EvaluatorMap& map, int components, const glm::dvec2& at) {
  const auto fraction = [&](int axis) {
    return (at[axis] - map.domain[axis][0]) / (map.domain[axis][1] - map.domain[axis][0]);
  };
  const Basis across(map.order[0], fraction(0)), up(map.order[1], map.order[1] > 1 ? fraction(1) : 0);
  MapPoint point;
  for (int k = 0; k < components; ++k) point.value[k] = 0;
  const float* p = map.points.data();
  for (std::size_t i = 0; i < std::size_t(map.order[0]); ++i)
    for (std::size_t j = 0; j < std::size_t(map.order[1]); ++j)
      for (int k = 0; k < components; ++k, ++p) {
        point.value[k] += across.value[i] * up.value[j] * double(*p);
        point.u[k] += across.slope[i] * up.value[j] * double(*p);
        point.v[k] += across.value[i] * up.slope[j] * double(*p);
      }
  return point;
}

/// glEvalCoord: a vertex of the enabled maps; the current values stay as they were.
void evaluate(Context& c, int dimensions, const glm::dvec2& at) {
  State& s = c.state;
  const Capability first = dimensions == 1 ? Capability::map1 : Capability::map2;
  const auto& maps = c.maps[std::size_t(dimensions - 1)];
  const auto is_on = [&](int map) { return s.capabilities.has(first, map); };
  const auto saved = s.current.values;
  const auto set = [&](int attribute, const MapPoint& point, int count) {
    for (int k = 0; k < count; ++k) s.current.values[std::size_t(attribute + k)] = float(point.value[k]);
  };
  const auto point = [&](int map) { return point_of(maps[std::size_t(map)], kComponents[map], at); };
  if (is_on(0)) set(kRed, point(0), 4);
  for (int texcoord = 3; texcoord >= 0; --texcoord)
    if (is_on(kMapTexCoord + texcoord)) {
      set(kTexCoord, point(kMapTexCoord + texcoord), 4);
      break;
    }
  if (is_on(kMapVertex4) || is_on(kMapVertex3)) {
    const MapPoint vertex = point(is_on(kMapVertex4) ? kMapVertex4 : kMapVertex3);
    if (dimensions == 2 && s.capabilities.has(Capability::auto_normal)) {
      // The derivative of a quotient, without its denominator.
      const auto along = [&](const glm::dvec4& d) {
        return is_on(kMapVertex4) ? glm::dvec3(d) * vertex.value.w - glm::dvec3(vertex.value) * d.w : glm::dvec3(d);
      };
      const glm::dvec3 n = glm::cross(along(vertex.u), along(vertex.v));
      const double length = std::sqrt(glm::dot(n, n));
      for (int k = 0; k < 3 && length > 0; ++k) s.current.values[std::size_t(kNormalX + k)] = float(n[k] / length);
    } else if (is_on(kMapNormal)) {
      set(kNormalX, point(kMapNormal), 3);
    }
    set(kX, vertex, 4);
    if (c.is_inside_begin()) c.stream.vertex(c);
  }
  s.current.values = saved;
}

/// Line i of a grid.
[[nodiscard]] double at_line(const EvaluatorGrid& grid, int axis, int i) {
  const double first = grid.domain[axis][0], last = grid.domain[axis][1];
  return i == grid.segments[axis] ? last : first + i * ((last - first) / grid.segments[axis]);
}
void evaluate_at(Context& c, int dimensions, int i, int j) {
  const EvaluatorGrid& grid = c.state.grid[std::size_t(dimensions - 1)];
  evaluate(c, dimensions, {at_line(grid, 0, i), dimensions == 2 ? at_line(grid, 1, j) : 0});
}

template <class T>
void set_map(int dimensions, GLenum target, const std::array<T, 4>& domain, const std::array<GLint, 2>& strides,
             const std::array<GLint, 2>& orders, const T* points) {
  const GLenum map = target - GLenum(dimensions == 1 ? GL_MAP1_COLOR_4 : GL_MAP2_COLOR_4);
  auto made = std::make_shared<EvaluatorMap>();
  const int count = map < kMaps ? kComponents[map] : 0;
  bool is_valid = domain[0] != domain[1] && domain[2] != domain[3] && points;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    made->order[axis] = orders[axis];
    made->domain[axis] = {double(domain[2 * axis]), double(domain[2 * axis + 1])};
    is_valid = is_valid && orders[axis] >= 1 && orders[axis] <= kMostOrder &&
               (axis == std::size_t(dimensions) || strides[axis] >= count);
  }
  for (int i = 0; is_valid && count > 0 && i < orders[0]; ++i)
    for (int j = 0; j < orders[1]; ++j)
      for (int k = 0; k < count; ++k)
        made->points.push_back(float(points[std::ptrdiff_t(i) * strides[0] + std::ptrdiff_t(j) * strides[1] + k]));
  draw_call([=](Context& c) {
    if (map >= kMaps) return c.fail(GL_INVALID_ENUM);
    if (!is_valid) return c.fail(GL_INVALID_VALUE);
    if (c.state.texture.active != 0) return c.fail(GL_INVALID_OPERATION);
    c.maps[std::size_t(dimensions - 1)][map] = *made;
  });
}

template <class T>
void get_map(GLenum target, GLenum query, T* to) {
  client_call([=](Context& c) {
    const bool is_1d = target >= GL_MAP1_COLOR_4 && target < GL_MAP1_COLOR_4 + kMaps;
    const GLenum map = target - (is_1d ? GL_MAP1_COLOR_4 : GL_MAP2_COLOR_4);
    if (map >= kMaps || query < GL_COEFF || query > GL_DOMAIN) return c.fail(GL_INVALID_ENUM);
    const EvaluatorMap& m = c.maps[is_1d ? 0 : 1][map];
    T* next = to;
    const auto put = [&](double v) { *next++ = std::is_integral_v<T> ? T(std::floor(v + 0.5)) : T(v); };
    if (query == GL_COEFF)
      for (const float v : m.points) put(double(v));
    for (std::size_t axis = 0; axis < (is_1d ? 1 : 2); ++axis) {
      if (query == GL_ORDER) put(m.order[axis]);
      if (query == GL_DOMAIN) put(m.domain[axis][0]), put(m.domain[axis][1]);
    }
  });
}

void set_grid(int dimensions, const EvaluatorGrid& grid) {
  draw_call([=](Context& c) {
    if (grid.segments[0] < 1 || grid.segments[1] < 1) return c.fail(GL_INVALID_VALUE);
    c.state.grid[std::size_t(dimensions - 1)] = grid;
  });
}

/// glEvalMesh of a row or a column of points, or of the strip between two of them.
void draw_row(Context& c, GLenum mode, int first, int last, const auto& point) {
  c.stream.begin(c, mode);
  for (int i = first; i <= last; ++i) point(i);
  c.stream.end(c);
}

}  // namespace

EvaluatorMap EvaluatorMap::initial(int map) {
  EvaluatorMap m;
  m.points.assign(std::size_t(kComponents[map]), map < kMapNormal ? 1.0f : 0.0f);
  if (map == kMapNormal) m.points[2] = 1;
  if (kComponents[map] == 4) m.points[3] = 1;
  return m;
}

#define EVALUATORS(s, T)                                                                                         \
  FRONTMOST_GL void glMap1##s(GLenum target, T u1, T u2, GLint stride, GLint order, const T* points) {           \
    set_map<T>(1, target, {u1, u2, T(0), T(1)}, {stride, 0}, {order, 1}, points);                                \
  }                                                                                                              \
  FRONTMOST_GL void glMap2##s(GLenum target, T u1, T u2, GLint ustride, GLint uorder, T v1, T v2, GLint vstride, \
                              GLint vorder, const T* points) {                                                   \
    set_map<T>(2, target, {u1, u2, v1, v2}, {ustride, vstride}, {uorder, vorder}, points);                       \
  }                                                                                                              \
  FRONTMOST_GL void glGetMap##s##v(GLenum target, GLenum query, T* v) { get_map(target, query, v); }             \
  FRONTMOST_GL void glEvalCoord1##s(T u) {                                                                       \
    vertex_call([=](Context& c) { evaluate(c, 1, {double(u), 0}); });                                            \
  }                                                                                                              \
  FRONTMOST_GL void glEvalCoord2##s(T u, T v) {                                                                  \
    vertex_call([=](Context& c) { evaluate(c, 2, {double(u), double(v)}); });                                    \
  }                                                                                                              \
  FRONTMOST_GL void glEvalCoord1##s##v(const T* u) { glEvalCoord1##s(u[0]); }                                    \
  FRONTMOST_GL void glEvalCoord2##s##v(const T* u) { glEvalCoord2##s(u[0], u[1]); }                              \
  FRONTMOST_GL void glMapGrid1##s(GLint n, T u1, T u2) {                                                         \
    set_grid(1, {{n, 1}, {{{double(u1), double(u2)}, {0, 1}}}});                                                 \
  }                                                                                                              \
  FRONTMOST_GL void glMapGrid2##s(GLint un, T u1, T u2, GLint vn, T v1, T v2) {                                  \
    set_grid(2, {{un, vn}, {{{double(u1), double(u2)}, {double(v1), double(v2)}}}});                             \
  }
EVALUATORS(d, GLdouble)
EVALUATORS(f, GLfloat)
FRONTMOST_GL void glGetMapiv(GLenum target, GLenum query, GLint* v) { get_map(target, query, v); }

FRONTMOST_GL void glEvalPoint1(GLint i) {
  vertex_call([=](Context& c) { evaluate_at(c, 1, i, 0); });
}
FRONTMOST_GL void glEvalPoint2(GLint i, GLint j) {
  vertex_call([=](Context& c) { evaluate_at(c, 2, i, j); });
}
FRONTMOST_GL void glEvalMesh1(GLenum mode, GLint i1, GLint i2) {
  draw_call([=](Context& c) {
    if (mode != GL_POINT && mode != GL_LINE) return c.fail(GL_INVALID_ENUM);
    draw_row(c, mode == GL_POINT ? GL_POINTS : GL_LINE_STRIP, i1, i2, [&](int i) { evaluate_at(c, 1, i, 0); });
  });
}
FRONTMOST_GL void glEvalMesh2(GLenum mode, GLint i1, GLint i2, GLint j1, GLint j2) {
  draw_call([=](Context& c) {
    if (mode != GL_POINT && mode != GL_LINE && mode != GL_FILL) return c.fail(GL_INVALID_ENUM);
    if (mode == GL_FILL) {
      for (int j = j1; j < j2; ++j)
        draw_row(c, GL_QUAD_STRIP, i1, i2, [&](int i) {
          evaluate_at(c, 2, i, j);
          evaluate_at(c, 2, i, j + 1);
        });
      return;
    }
    const GLenum rows = mode == GL_POINT ? GL_POINTS : GL_LINE_STRIP;
    for (int j = j1; j <= j2; ++j) draw_row(c, rows, i1, i2, [&](int i) { evaluate_at(c, 2, i, j); });
    if (mode == GL_POINT) return;
    for (int i = i1; i <= i2; ++i) draw_row(c, rows, j1, j2, [&](int j) { evaluate_at(c, 2, i, j); });
  });
}

}  // namespace frontmost::gl_detail
