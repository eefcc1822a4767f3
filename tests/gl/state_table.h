// SPDX-License-Identifier: Apache-2.0
// The state tables of the OpenGL 1.5 specification (6.5 to 6.36), for a context whose frame is 16 x 16 pixels.
#pragma once

#include <vector>

#include "off_screen.h"

namespace frontmost::test {

struct StateValue {
  const char* name;
  GLenum pname;
  std::vector<double> (*read)(GLenum pname, std::size_t count);
  GLbitfield groups;  ///< of glPushAttrib that save the value
  std::vector<double> initial;

  [[nodiscard]] std::vector<double> now() const { return read(pname, initial.size()); }
};

namespace state {
// clang-format off
#define READER(name, ...) inline std::vector<double> name(GLenum pname, std::size_t n) { return __VA_ARGS__; }
#define BY(name, function, target) READER(name, asked<function, GLfloat>(n, GLenum(target), pname))
READER(get, asked<glGetDoublev, GLdouble>(n, pname))
READER(mask, {double(int(asked<glGetIntegerv, GLint>(n, pname)[0]) & 255)})  // at least 8 bits
READER(plane, asked<glGetClipPlane, GLdouble>(n, pname))
READER(level, asked<glGetTexLevelParameterfv, GLfloat>(n, GLenum(GL_TEXTURE_2D), 0, pname))
READER(map, asked<glGetPixelMapfv, GLfloat>(n, pname))
READER(order, asked<glGetMapfv, GLfloat>(n, pname, GLenum(GL_ORDER)))
READER(domain, asked<glGetMapfv, GLfloat>(n, pname, GLenum(GL_DOMAIN)))
READER(points, asked<glGetMapfv, GLfloat>(n, pname, GLenum(GL_COEFF)))
READER(query, asked<glGetQueryiv, GLint>(n, GLenum(GL_SAMPLES_PASSED), pname))
READER(stipple, asked<glGetPolygonStipple, GLubyte>(pname ? n : 0))
BY(light0, glGetLightfv, GL_LIGHT0) BY(light5, glGetLightfv, GL_LIGHT5) BY(front, glGetMaterialfv, GL_FRONT)
BY(back, glGetMaterialfv, GL_BACK) BY(gen_s, glGetTexGenfv, GL_S) BY(gen_t, glGetTexGenfv, GL_T)
BY(gen_r, glGetTexGenfv, GL_R) BY(gen_q, glGetTexGenfv, GL_Q) BY(env, glGetTexEnvfv, GL_TEXTURE_ENV)
BY(lod, glGetTexEnvfv, GL_TEXTURE_FILTER_CONTROL) BY(texture_1d, glGetTexParameterfv, GL_TEXTURE_1D)
BY(texture_2d, glGetTexParameterfv, GL_TEXTURE_2D)
#undef BY
#undef READER
inline std::vector<double> pointer(GLenum pname, std::size_t) {
  GLvoid* value = nullptr;
  glGetPointerv(pname, &value);
  return {double(reinterpret_cast<std::size_t>(value))};
}
}  // namespace state

inline const std::vector<StateValue>& state_table() {
  using namespace state;
#define ROW(reader, groups, pname, ...) {#reader " GL_" #pname, GLenum(GL_##pname), reader, groups, {__VA_ARGS__}}
#define GET(groups, pname, ...) ROW(get, groups, pname, __VA_ARGS__)
#define ON(groups, pname) ROW(get, groups | GL_ENABLE_BIT, pname, 0)
#define MATRIX(pname) GET(0, pname, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1)
#define STORE(NAME) GET(0, NAME##_SWAP_BYTES, 0), GET(0, NAME##_LSB_FIRST, 0), GET(0, NAME##_ROW_LENGTH, 0), \
  GET(0, NAME##_SKIP_ROWS, 0), GET(0, NAME##_SKIP_PIXELS, 0), GET(0, NAME##_ALIGNMENT, 4)
#define ARRAY(NAME) GET(0, NAME##_ARRAY, 0), GET(0, NAME##_ARRAY_STRIDE, 0), \
  GET(0, NAME##_ARRAY_BUFFER_BINDING, 0), ROW(pointer, 0, NAME##_ARRAY_POINTER, 0)
#define TYPED_ARRAY(NAME) ARRAY(NAME), GET(0, NAME##_ARRAY_TYPE, GL_FLOAT)
#define LIGHT(light, white) ROW(light, L, AMBIENT, 0, 0, 0, 1), ROW(light, L, DIFFUSE, white, white, white, 1), \
  ROW(light, L, SPECULAR, white, white, white, 1), ROW(light, L, POSITION, 0, 0, 1, 0), \
  ROW(light, L, CONSTANT_ATTENUATION, 1), ROW(light, L, LINEAR_ATTENUATION, 0), ROW(light, L, SPOT_EXPONENT, 0), \
  ROW(light, L, QUADRATIC_ATTENUATION, 0), ROW(light, L, SPOT_DIRECTION, 0, 0, -1), ROW(light, L, SPOT_CUTOFF, 180)
#define MATERIAL(face) ROW(face, L, AMBIENT, .2f, .2f, .2f, 1), ROW(face, L, DIFFUSE, .8f, .8f, .8f, 1), \
  ROW(face, L, SPECULAR, 0, 0, 0, 1), ROW(face, L, EMISSION, 0, 0, 0, 1), ROW(face, L, SHININESS, 0), \
  ROW(face, L, COLOR_INDEXES, 0, 1, 1)
#define TEXTURE(texture) ROW(texture, T, TEXTURE_BORDER_COLOR, 0, 0, 0, 0), ROW(texture, T, TEXTURE_PRIORITY, 1), \
  ROW(texture, T, TEXTURE_MIN_FILTER, GL_NEAREST_MIPMAP_LINEAR), ROW(texture, T, TEXTURE_MAG_FILTER, GL_LINEAR), \
  ROW(texture, T, TEXTURE_WRAP_S, GL_REPEAT), ROW(texture, T, TEXTURE_WRAP_T, GL_REPEAT), \
  ROW(texture, T, TEXTURE_MIN_LOD, -1000), ROW(texture, T, TEXTURE_MAX_LOD, 1000), \
  ROW(texture, T, TEXTURE_BASE_LEVEL, 0), ROW(texture, T, TEXTURE_MAX_LEVEL, 1000), \
  ROW(texture, T, TEXTURE_LOD_BIAS, 0), ROW(texture, T, GENERATE_MIPMAP, 0)
#define GEN(gen, NAME, ...) ON(T, TEXTURE_GEN_##NAME), ROW(gen, T, TEXTURE_GEN_MODE, GL_EYE_LINEAR), \
  ROW(gen, T, EYE_PLANE, __VA_ARGS__), ROW(gen, T, OBJECT_PLANE, __VA_ARGS__)
#define SOURCE(i, source, operand) ROW(env, T, SOURCE##i##_RGB, source), ROW(env, T, SOURCE##i##_ALPHA, source), \
  ROW(env, T, OPERAND##i##_RGB, operand), ROW(env, T, OPERAND##i##_ALPHA, GL_SRC_ALPHA)
#define PIXEL_MAP(name) GET(0, name##_SIZE, 1), ROW(map, 0, name, 0)
#define MAPS(NAME, ...) ON(E, MAP1_##NAME), ROW(order, 0, MAP1_##NAME, 1), ROW(domain, 0, MAP1_##NAME, 0, 1), \
  ROW(points, 0, MAP1_##NAME, __VA_ARGS__), ON(E, MAP2_##NAME), ROW(order, 0, MAP2_##NAME, 1, 1), \
  ROW(domain, 0, MAP2_##NAME, 0, 1, 0, 1), ROW(points, 0, MAP2_##NAME, __VA_ARGS__)
#define EIGHT(X, name) X(L, name##0), X(L, name##1), X(L, name##2), X(L, name##3), X(L, name##4), X(L, name##5), \
  X(L, name##6), X(L, name##7)
#define PLANE(name) ON(R, name), ROW(plane, R, name, 0, 0, 0, 0)
  constexpr GLbitfield C = GL_CURRENT_BIT, V = GL_VIEWPORT_BIT, R = GL_TRANSFORM_BIT, F = GL_FOG_BIT,
      L = GL_LIGHTING_BIT, O = GL_POINT_BIT, I = GL_LINE_BIT, P = GL_POLYGON_BIT, T = GL_TEXTURE_BIT,
      K = GL_SCISSOR_BIT, B = GL_COLOR_BUFFER_BIT, D = GL_DEPTH_BUFFER_BIT, S = GL_STENCIL_BUFFER_BIT,
      X = GL_PIXEL_MODE_BIT, E = GL_EVAL_BIT, H = GL_HINT_BIT;
  static const std::vector<StateValue> table = {
      // Current values. Indexes of colors are not offered, and stay.
      GET(C, CURRENT_COLOR, 1, 1, 1, 1), GET(C, CURRENT_SECONDARY_COLOR, 0, 0, 0, 1), GET(0, CURRENT_INDEX, 1),
      GET(C, CURRENT_TEXTURE_COORDS, 0, 0, 0, 1), GET(C, CURRENT_NORMAL, 0, 0, 1), GET(C, CURRENT_FOG_COORD, 0),
      GET(C, CURRENT_RASTER_POSITION, 0, 0, 0, 1), GET(C, CURRENT_RASTER_DISTANCE, 0),
      GET(C, CURRENT_RASTER_COLOR, 1, 1, 1, 1), GET(0, CURRENT_RASTER_INDEX, 1),
      GET(C, CURRENT_RASTER_TEXTURE_COORDS, 0, 0, 0, 1), GET(0, CURRENT_RASTER_POSITION_VALID, 1),
      GET(C, EDGE_FLAG, 1),
      // Arrays and buffers.
      GET(0, CLIENT_ACTIVE_TEXTURE, GL_TEXTURE0), TYPED_ARRAY(VERTEX), GET(0, VERTEX_ARRAY_SIZE, 4),
      TYPED_ARRAY(NORMAL), TYPED_ARRAY(FOG_COORDINATE), TYPED_ARRAY(COLOR), GET(0, COLOR_ARRAY_SIZE, 4),
      TYPED_ARRAY(SECONDARY_COLOR), GET(0, SECONDARY_COLOR_ARRAY_SIZE, 3), TYPED_ARRAY(INDEX),
      TYPED_ARRAY(TEXTURE_COORD), GET(0, TEXTURE_COORD_ARRAY_SIZE, 4), ARRAY(EDGE_FLAG),
      GET(0, ARRAY_BUFFER_BINDING, 0), GET(0, ELEMENT_ARRAY_BUFFER_BINDING, 0),
      // Transformation and viewport.
      MATRIX(MODELVIEW_MATRIX), MATRIX(PROJECTION_MATRIX), MATRIX(TEXTURE_MATRIX), GET(0, MODELVIEW_STACK_DEPTH, 1),
      GET(0, PROJECTION_STACK_DEPTH, 1), GET(0, TEXTURE_STACK_DEPTH, 1), GET(V, VIEWPORT, 0, 0, 16, 16),
      GET(V, DEPTH_RANGE, 0, 1), GET(R, MATRIX_MODE, GL_MODELVIEW), ON(R, NORMALIZE), ON(R, RESCALE_NORMAL),
      PLANE(CLIP_PLANE0), PLANE(CLIP_PLANE1), PLANE(CLIP_PLANE2), PLANE(CLIP_PLANE3), PLANE(CLIP_PLANE4),
      PLANE(CLIP_PLANE5),
      // Fog and light.
      GET(F, FOG_COLOR, 0, 0, 0, 0), GET(F, FOG_INDEX, 0), GET(F, FOG_DENSITY, 1), GET(F, FOG_START, 0),
      GET(F, FOG_END, 1), GET(F, FOG_MODE, GL_EXP), GET(F, FOG_COORD_SRC, GL_FRAGMENT_DEPTH), ON(F, FOG),
      ON(F, COLOR_SUM), GET(L, SHADE_MODEL, GL_SMOOTH), ON(L, LIGHTING), ON(L, COLOR_MATERIAL), EIGHT(ON, LIGHT),
      GET(L, COLOR_MATERIAL_PARAMETER, GL_AMBIENT_AND_DIFFUSE), GET(L, COLOR_MATERIAL_FACE, GL_FRONT_AND_BACK),
      GET(L, LIGHT_MODEL_AMBIENT, .2f, .2f, .2f, 1), GET(L, LIGHT_MODEL_LOCAL_VIEWER, 0),
      GET(L, LIGHT_MODEL_TWO_SIDE, 0), GET(L, LIGHT_MODEL_COLOR_CONTROL, GL_SINGLE_COLOR), MATERIAL(front),
      MATERIAL(back), LIGHT(light0, 1), LIGHT(light5, 0),
      // Points, lines and polygons.
      GET(O, POINT_SIZE, 1), ON(O, POINT_SMOOTH), GET(O, POINT_SIZE_MIN, 0), GET(O, POINT_FADE_THRESHOLD_SIZE, 1),
      GET(O, POINT_DISTANCE_ATTENUATION, 1, 0, 0), GET(I, LINE_WIDTH, 1), ON(I, LINE_SMOOTH), ON(I, LINE_STIPPLE),
      GET(I, LINE_STIPPLE_PATTERN, 0xFFFF), GET(I, LINE_STIPPLE_REPEAT, 1), ON(P, CULL_FACE),
      GET(P, CULL_FACE_MODE, GL_BACK), GET(P, FRONT_FACE, GL_CCW), ON(P, POLYGON_SMOOTH),
      GET(P, POLYGON_MODE, GL_FILL, GL_FILL), GET(P, POLYGON_OFFSET_FACTOR, 0), GET(P, POLYGON_OFFSET_UNITS, 0),
      ON(P, POLYGON_OFFSET_POINT), ON(P, POLYGON_OFFSET_LINE), ON(P, POLYGON_OFFSET_FILL), ON(P, POLYGON_STIPPLE),
      ROW(stipple, GL_POLYGON_STIPPLE_BIT, POLYGON_STIPPLE, 255, 255, 255, 255),
      ROW(get, GL_MULTISAMPLE_BIT | GL_ENABLE_BIT, MULTISAMPLE, 1),
      // Textures.
      GET(T, ACTIVE_TEXTURE, GL_TEXTURE0), ON(T, TEXTURE_1D), ON(T, TEXTURE_2D), GET(T, TEXTURE_BINDING_1D, 0),
      GET(T, TEXTURE_BINDING_2D, 0), TEXTURE(texture_1d), TEXTURE(texture_2d), ROW(level, 0, TEXTURE_WIDTH, 0),
      ROW(level, 0, TEXTURE_HEIGHT, 0), ROW(level, 0, TEXTURE_BORDER, 0), ROW(level, 0, TEXTURE_INTERNAL_FORMAT, 1),
      ROW(level, 0, TEXTURE_RED_SIZE, 0), ROW(env, T, TEXTURE_ENV_MODE, GL_MODULATE),
      ROW(env, T, TEXTURE_ENV_COLOR, 0, 0, 0, 0), ROW(lod, T, TEXTURE_LOD_BIAS, 0), GEN(gen_s, S, 1, 0, 0, 0),
      GEN(gen_t, T, 0, 1, 0, 0), GEN(gen_r, R, 0, 0, 0, 0), GEN(gen_q, Q, 0, 0, 0, 0),
      ROW(env, T, COMBINE_RGB, GL_MODULATE), ROW(env, T, COMBINE_ALPHA, GL_MODULATE),
      SOURCE(0, GL_TEXTURE, GL_SRC_COLOR), SOURCE(1, GL_PREVIOUS, GL_SRC_COLOR), SOURCE(2, GL_CONSTANT, GL_SRC_ALPHA),
      ROW(env, T, RGB_SCALE, 1), ROW(env, T, ALPHA_SCALE, 1),
      // Fragments and the frame.
      ON(K, SCISSOR_TEST), GET(K, SCISSOR_BOX, 0, 0, 16, 16), ON(B, ALPHA_TEST), GET(B, ALPHA_TEST_FUNC, GL_ALWAYS),
      GET(B, ALPHA_TEST_REF, 0), ON(S, STENCIL_TEST), GET(S, STENCIL_FUNC, GL_ALWAYS),
      ROW(mask, S, STENCIL_VALUE_MASK, 255), GET(S, STENCIL_REF, 0), GET(S, STENCIL_FAIL, GL_KEEP),
      GET(S, STENCIL_PASS_DEPTH_FAIL, GL_KEEP), GET(S, STENCIL_PASS_DEPTH_PASS, GL_KEEP), ON(D, DEPTH_TEST),
      GET(D, DEPTH_FUNC, GL_LESS), ON(B, BLEND), GET(B, BLEND_SRC_RGB, GL_ONE), GET(B, BLEND_SRC_ALPHA, GL_ONE),
      GET(B, BLEND_DST_RGB, GL_ZERO), GET(B, BLEND_DST_ALPHA, GL_ZERO), GET(B, BLEND_EQUATION, GL_FUNC_ADD),
      GET(B, BLEND_COLOR, 0, 0, 0, 0), ROW(get, B | GL_ENABLE_BIT, DITHER, 1), ON(B, INDEX_LOGIC_OP),
      ON(B, COLOR_LOGIC_OP), GET(B, LOGIC_OP_MODE, GL_COPY), GET(B, DRAW_BUFFER, GL_FRONT),
      ROW(mask, B, INDEX_WRITEMASK, 255), GET(B, COLOR_WRITEMASK, 1, 1, 1, 1), GET(D, DEPTH_WRITEMASK, 1),
      ROW(mask, S, STENCIL_WRITEMASK, 255), GET(B, COLOR_CLEAR_VALUE, 0, 0, 0, 0), GET(B, INDEX_CLEAR_VALUE, 0),
      GET(D, DEPTH_CLEAR_VALUE, 1), GET(S, STENCIL_CLEAR_VALUE, 0), GET(0, ACCUM_CLEAR_VALUE, 0, 0, 0, 0),
      // Pixels.
      STORE(UNPACK), STORE(PACK), GET(X, MAP_COLOR, 0), GET(X, MAP_STENCIL, 0), GET(X, INDEX_SHIFT, 0),
      GET(X, INDEX_OFFSET, 0), GET(X, RED_SCALE, 1), GET(X, GREEN_SCALE, 1), GET(X, BLUE_SCALE, 1),
      GET(X, ALPHA_SCALE, 1), GET(X, DEPTH_SCALE, 1), GET(X, RED_BIAS, 0), GET(X, GREEN_BIAS, 0),
      GET(X, BLUE_BIAS, 0), GET(X, ALPHA_BIAS, 0), GET(X, DEPTH_BIAS, 0), GET(X, ZOOM_X, 1), GET(X, ZOOM_Y, 1),
      GET(X, READ_BUFFER, GL_FRONT), PIXEL_MAP(PIXEL_MAP_I_TO_I), PIXEL_MAP(PIXEL_MAP_S_TO_S),
      PIXEL_MAP(PIXEL_MAP_I_TO_R), PIXEL_MAP(PIXEL_MAP_I_TO_G), PIXEL_MAP(PIXEL_MAP_I_TO_B),
      PIXEL_MAP(PIXEL_MAP_I_TO_A), PIXEL_MAP(PIXEL_MAP_R_TO_R), PIXEL_MAP(PIXEL_MAP_G_TO_G),
      PIXEL_MAP(PIXEL_MAP_B_TO_B), PIXEL_MAP(PIXEL_MAP_A_TO_A),
      // Evaluators, hints and the rest.
      MAPS(COLOR_4, 1, 1, 1, 1), MAPS(INDEX, 1), MAPS(NORMAL, 0, 0, 1), MAPS(TEXTURE_COORD_1, 0),
      MAPS(TEXTURE_COORD_2, 0, 0), MAPS(TEXTURE_COORD_3, 0, 0, 0), MAPS(TEXTURE_COORD_4, 0, 0, 0, 1),
      MAPS(VERTEX_3, 0, 0, 0), MAPS(VERTEX_4, 0, 0, 0, 1), ON(E, AUTO_NORMAL), GET(E, MAP1_GRID_DOMAIN, 0, 1),
      GET(E, MAP2_GRID_DOMAIN, 0, 1, 0, 1), GET(E, MAP1_GRID_SEGMENTS, 1), GET(E, MAP2_GRID_SEGMENTS, 1, 1),
      GET(H, PERSPECTIVE_CORRECTION_HINT, GL_DONT_CARE), GET(H, POINT_SMOOTH_HINT, GL_DONT_CARE),
      GET(H, LINE_SMOOTH_HINT, GL_DONT_CARE), GET(H, POLYGON_SMOOTH_HINT, GL_DONT_CARE),
      GET(H, FOG_HINT, GL_DONT_CARE), GET(H, GENERATE_MIPMAP_HINT, GL_DONT_CARE),
      GET(H, TEXTURE_COMPRESSION_HINT, GL_DONT_CARE), GET(GL_LIST_BIT, LIST_BASE, 0), GET(0, LIST_INDEX, 0),
      GET(0, LIST_MODE, 0), GET(0, ATTRIB_STACK_DEPTH, 0), GET(0, CLIENT_ATTRIB_STACK_DEPTH, 0),
      GET(0, RENDER_MODE, GL_RENDER), ROW(query, 0, CURRENT_QUERY, 0)};
  return table;
}
// clang-format on

/// The values of the whole table, in its order. Errors are dropped: state_test.cpp tells what cannot be asked for.
inline std::vector<std::vector<double>> all_values() {
  std::vector<std::vector<double>> values;
  for (const StateValue& v : state_table()) values.push_back(v.now());
  glGetError();
  return values;
}

}  // namespace frontmost::test
