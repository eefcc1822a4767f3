// SPDX-License-Identifier: Apache-2.0
// Calls that set a part of the state. Most check their arguments and assign, and are made by the macro SETTER.

#include <algorithm>
#include <cstdint>
#include <initializer_list>

#include "calls/call.h"
#include "calls/values.h"
#include "pixels/unpack.h"

namespace frontmost::gl_detail {
namespace {

/// An entry point that makes assignments, joined by commas, to the state `s`, or records `error` unless `is_valid`.
#define SETTER(entry, parameters, is_valid, error, ...) \
  FRONTMOST_GL void entry parameters {                  \
    draw_call([=](Context& c) {                         \
      [[maybe_unused]] State& s = c.state;              \
      if (!(is_valid)) return c.fail(error);            \
      __VA_ARGS__;                                      \
    });                                                 \
  }

glm::vec4 unit_color(const glm::vec4& v) {
  return {float(unit(v.r)), float(unit(v.g)), float(unit(v.b)), float(unit(v.a))};
}
glm::vec4 vec4_of(const ParameterValues& a) { return {a.v[0], a.v[1], a.v[2], a.v[3]}; }

bool is_comparison(GLenum v) { return v >= GL_NEVER && v <= GL_ALWAYS; }
bool is_face(GLenum v) { return is_one_of(v, GL_FRONT, GL_BACK, GL_FRONT_AND_BACK); }
bool is_stencil_op(GLenum v) {
  return is_one_of(v, GL_KEEP, GL_ZERO, GL_REPLACE, GL_INCR, GL_DECR, GL_INVERT, GL_INCR_WRAP, GL_DECR_WRAP);
}
bool is_target_factor(GLenum v) {
  return is_one_of(v, GL_ZERO, GL_ONE) || (v >= GL_SRC_COLOR && v <= GL_ONE_MINUS_DST_COLOR) ||
         (v >= GL_CONSTANT_COLOR && v <= GL_ONE_MINUS_CONSTANT_ALPHA);
}
bool is_source_factor(GLenum v) { return v == GL_SRC_ALPHA_SATURATE || is_target_factor(v); }
bool is_equation(GLenum v) {
  return is_one_of(v, GL_FUNC_ADD, GL_FUNC_SUBTRACT, GL_FUNC_REVERSE_SUBTRACT, GL_MIN, GL_MAX);
}
bool is_drawn_buffer(GLenum v) { return is_one_of(v, GL_FRONT_LEFT, GL_BACK_LEFT, GL_FRONT, GL_BACK, GL_LEFT); }
bool is_missing_buffer(GLenum v) {
  return is_one_of(v, GL_FRONT_RIGHT, GL_BACK_RIGHT, GL_RIGHT) || (v >= GL_AUX0 && v <= GL_AUX3);
}

/// The pointer that stands beside a name, or null.
template <class T>
T* find(GLenum name, std::initializer_list<std::pair<GLenum, T*>> rows) {
  for (const auto& [key, value] : rows)
    if (key == name) return value;
  return nullptr;
}

// clang-format off
GLenum* hint_of(HintState& h, GLenum target) {
  return find<GLenum>(target, {
      {GL_PERSPECTIVE_CORRECTION_HINT, &h.perspective}, {GL_POINT_SMOOTH_HINT, &h.point},
      {GL_LINE_SMOOTH_HINT, &h.line}, {GL_POLYGON_SMOOTH_HINT, &h.polygon}, {GL_FOG_HINT, &h.fog},
      {GL_GENERATE_MIPMAP_HINT, &h.mipmap}, {GL_TEXTURE_COMPRESSION_HINT, &h.compression}});
}
// clang-format on

}  // namespace

// Fragments.
SETTER(glAlphaFunc, (GLenum func, GLclampf ref), is_comparison(func), GL_INVALID_ENUM, s.color.alpha_func = func,
       s.color.alpha_ref = float(unit(ref)))
SETTER(glBlendFunc, (GLenum from, GLenum to), is_source_factor(from) && is_target_factor(to), GL_INVALID_ENUM,
       s.color.source_rgb = s.color.source_alpha = from, s.color.target_rgb = s.color.target_alpha = to)
SETTER(glBlendFuncSeparate, (GLenum from, GLenum to, GLenum from_a, GLenum to_a),
       is_source_factor(from) && is_target_factor(to) && is_source_factor(from_a) && is_target_factor(to_a),
       GL_INVALID_ENUM, s.color.source_rgb = from, s.color.target_rgb = to, s.color.source_alpha = from_a,
       s.color.target_alpha = to_a)
SETTER(glBlendEquation, (GLenum mode), is_equation(mode), GL_INVALID_ENUM,
       s.color.equation_rgb = s.color.equation_alpha = mode)
SETTER(glBlendEquationSeparate, (GLenum rgb, GLenum alpha), is_equation(rgb) && is_equation(alpha), GL_INVALID_ENUM,
       s.color.equation_rgb = rgb, s.color.equation_alpha = alpha)
SETTER(glBlendColor, (GLclampf r, GLclampf g, GLclampf b, GLclampf a), true, 0,
       s.color.blend_color = unit_color({r, g, b, a}))
SETTER(glLogicOp, (GLenum op), op >= GL_CLEAR && op <= GL_SET, GL_INVALID_ENUM, s.color.logic_op = op)
SETTER(glColorMask, (GLboolean r, GLboolean g, GLboolean b, GLboolean a), true, 0,
       s.color.mask = {r != 0, g != 0, b != 0, a != 0})
SETTER(glDepthFunc, (GLenum func), is_comparison(func), GL_INVALID_ENUM, s.depth.func = func)
SETTER(glDepthMask, (GLboolean flag), true, 0, s.depth.mask = flag != 0)
SETTER(glDepthRange, (GLclampd near, GLclampd far), true, 0, s.viewport.near = unit(near), s.viewport.far = unit(far))
SETTER(glStencilFunc, (GLenum func, GLint ref, GLuint mask), is_comparison(func), GL_INVALID_ENUM,
       s.stencil.func = func, s.stencil.ref = std::clamp(ref, 0, 255), s.stencil.value_mask = mask)
SETTER(glStencilOp, (GLenum fail, GLenum depth_fail, GLenum pass),
       is_stencil_op(fail) && is_stencil_op(depth_fail) && is_stencil_op(pass), GL_INVALID_ENUM, s.stencil.fail = fail,
       s.stencil.depth_fail = depth_fail, s.stencil.pass = pass)
SETTER(glStencilMask, (GLuint mask), true, 0, s.stencil.write_mask = mask)
SETTER(glScissor, (GLint x, GLint y, GLsizei w, GLsizei h), w >= 0 && h >= 0, GL_INVALID_VALUE,
       s.scissor = {x, y, w, h})
SETTER(glSampleCoverage, (GLclampf, GLboolean), true, 0, )  // there are no sample buffers

// Buffers. Every name of a buffer that exists stands for the one frame.
SETTER(glClearColor, (GLclampf r, GLclampf g, GLclampf b, GLclampf a), true, 0,
       s.color.clear = unit_color({r, g, b, a}))
SETTER(glClearDepth, (GLclampd depth), true, 0, s.depth.clear = unit(depth))
SETTER(glClearStencil, (GLint value), true, 0, s.stencil.clear = value)
SETTER(glClearIndex, (GLfloat index), true, 0, s.color.clear_index = index)
SETTER(glIndexMask, (GLuint mask), true, 0, s.color.index_mask = mask)
SETTER(glClearAccum, (GLfloat, GLfloat, GLfloat, GLfloat), true, 0, )  // there is no accumulation buffer
SETTER(glDrawBuffer, (GLenum buffer), is_drawn_buffer(buffer) || is_one_of(buffer, GL_NONE, GL_FRONT_AND_BACK),
       is_missing_buffer(buffer) ? GL_INVALID_OPERATION : GL_INVALID_ENUM, s.color.draw_buffer = buffer)
SETTER(glReadBuffer, (GLenum buffer), is_drawn_buffer(buffer),
       is_missing_buffer(buffer) ? GL_INVALID_OPERATION : GL_INVALID_ENUM, s.pixel.read_buffer = buffer)

// Primitives.
SETTER(glCullFace, (GLenum face), is_face(face), GL_INVALID_ENUM, s.polygon.cull_face = face)
SETTER(glFrontFace, (GLenum turn), is_one_of(turn, GL_CW, GL_CCW), GL_INVALID_ENUM, s.polygon.front_face = turn)
SETTER(glPolygonMode, (GLenum face, GLenum mode), is_face(face) && is_one_of(mode, GL_POINT, GL_LINE, GL_FILL),
       GL_INVALID_ENUM, if (face != GL_BACK) s.polygon.mode[0] = mode;
       if (face != GL_FRONT) s.polygon.mode[1] = mode)
SETTER(glPolygonOffset, (GLfloat factor, GLfloat units), true, 0, s.polygon.offset_factor = factor,
       s.polygon.offset_units = units)
SETTER(glPolygonOffsetEXT, (GLfloat factor, GLfloat bias), true, 0, s.polygon.offset_factor = factor,
       s.polygon.offset_units = bias * float(kMostDepth))
SETTER(glLineWidth, (GLfloat width), width > 0, GL_INVALID_VALUE, s.line.width = width)
SETTER(glLineStipple, (GLint factor, GLushort pattern), true, 0, s.line.stipple_factor = std::clamp(factor, 1, 256),
       s.line.stipple = pattern)
SETTER(glPointSize, (GLfloat size), size > 0, GL_INVALID_VALUE, s.point.size = size)
SETTER(glShadeModel, (GLenum mode), is_one_of(mode, GL_FLAT, GL_SMOOTH), GL_INVALID_ENUM, s.lighting.shade_model = mode)
SETTER(glHint, (GLenum target, GLenum mode), hint_of(s.hint, target) && mode >= GL_DONT_CARE && mode <= GL_NICEST,
       GL_INVALID_ENUM, *hint_of(s.hint, target) = mode)

FRONTMOST_GL void glPolygonStipple(const GLubyte* mask) {
  const Context* const now = current_context();
  if (!now || !mask) return;
  const auto pixels = unpack_bitmap(now->client.unpack, 32, 32, mask);
  PolygonStippleState stipple;
  for (std::size_t y = 0; pixels && y < 32; ++y) {
    stipple.rows[y] = 0;
    for (std::size_t x = 0; x < 32; ++x) stipple.rows[y] |= std::uint32_t((*pixels)[y * 32 + x]) << (31 - x);
  }
  draw_call([stipple, ok = pixels.has_value()](Context& c) {
    if (!ok) return c.fail(GL_OUT_OF_MEMORY);
    c.state.polygon_stipple = stipple;
  });
}

// Places.
SETTER(glViewport, (GLint x, GLint y, GLsizei w, GLsizei h), w >= 0 && h >= 0, GL_INVALID_VALUE,
       s.viewport.rect = {x, y, std::min(w, kMostViewport), std::min(h, kMostViewport)})
SETTER(glActiveTexture, (GLenum unit), unit - GL_TEXTURE0 < GLenum(kTextureUnits), GL_INVALID_ENUM,
       s.texture.active = int(unit - GL_TEXTURE0))

namespace {

/// The inverse that takes planes to eye space; singular matrices take them as they are.
glm::dmat4 inverse_modelview(const Context& c) {
  const glm::dmat4& m = c.matrices.modelview.back();
  return glm::determinant(m) != 0 ? glm::inverse(m) : glm::dmat4(1);
}

}  // namespace

FRONTMOST_GL void glClipPlane(GLenum plane, const GLdouble* equation) {
  if (!equation) return;
  draw_call([plane, e = copied<GLdouble, 4>(equation)](Context& c) {
    if (plane - GL_CLIP_PLANE0 >= GLenum(kClipPlanes)) return c.fail(GL_INVALID_ENUM);
    c.state.transform.clip_planes[plane - GL_CLIP_PLANE0] = glm::dvec4(e[0], e[1], e[2], e[3]) * inverse_modelview(c);
  });
}

FRONTMOST_GL GLint glRenderMode(GLenum mode) {
  return client_call([=](Context& c) {
    if (is_one_of(mode, GL_SELECT, GL_FEEDBACK))
      c.refuse("glRenderMode");
    else if (mode != GL_RENDER)
      c.fail(GL_INVALID_ENUM);
    return GLint(0);
  });
}

// Parameters that an enum names.

// clang-format off
float* parameter_of(LightState& l, GLenum pname) {
  return find<float>(pname, {
      {GL_AMBIENT, &l.ambient.x}, {GL_DIFFUSE, &l.diffuse.x}, {GL_SPECULAR, &l.specular.x},
      {GL_POSITION, &l.position.x}, {GL_SPOT_DIRECTION, &l.spot_direction.x}, {GL_SPOT_EXPONENT, &l.spot_exponent},
      {GL_SPOT_CUTOFF, &l.spot_cutoff}, {GL_CONSTANT_ATTENUATION, &l.attenuation.x},
      {GL_LINEAR_ATTENUATION, &l.attenuation.y}, {GL_QUADRATIC_ATTENUATION, &l.attenuation.z}});
}
float* parameter_of(MaterialState& m, GLenum pname) {
  return find<float>(pname, {
      {GL_AMBIENT, &m.ambient.x}, {GL_DIFFUSE, &m.diffuse.x}, {GL_SPECULAR, &m.specular.x},
      {GL_EMISSION, &m.emission.x}, {GL_SHININESS, &m.shininess}, {GL_COLOR_INDEXES, &m.indexes.x}});
}
float* parameter_of(FogState& f, GLenum pname) {
  return find<float>(pname, {
      {GL_FOG_COLOR, &f.color.x}, {GL_FOG_DENSITY, &f.density}, {GL_FOG_START, &f.start}, {GL_FOG_END, &f.end},
      {GL_FOG_INDEX, &f.index}});
}
float* parameter_of(PointState& p, GLenum pname) {
  return find<float>(pname, {
      {GL_POINT_SIZE_MIN, &p.size_min}, {GL_POINT_SIZE_MAX, &p.size_max}, {GL_POINT_FADE_THRESHOLD_SIZE, &p.fade},
      {GL_POINT_DISTANCE_ATTENUATION, &p.attenuation.x}});
}
// clang-format on

namespace {

/// Sets a parameter of glLight and the like, if it is there and the value is valid. \returns whether it is set.
bool assign(Context& c, float* to, GLenum pname, const ParameterValues& a, bool is_valid) {
  if (!to || !is_valid) {
    c.fail(to ? GL_INVALID_VALUE : GL_INVALID_ENUM);
    return false;
  }
  std::copy_n(a.v.begin(), count_of(pname), to);
  return true;
}

void set_light(Context& c, GLenum name, GLenum pname, const ParameterValues& a) {
  if (name - GL_LIGHT0 >= GLenum(kLights)) return c.fail(GL_INVALID_ENUM);
  LightState& light = c.state.lighting.lights[name - GL_LIGHT0];
  const float v = a.v[0];
  const bool is_valid = pname == GL_SPOT_CUTOFF     ? (v >= 0 && v <= 90) || v == 180
                        : pname == GL_SPOT_EXPONENT ? v >= 0 && v <= 128
                                                    : count_of(pname) > 1 || v >= 0;
  if (!assign(c, parameter_of(light, pname), pname, a, is_valid)) return;
  const glm::dmat4& eye = c.matrices.modelview.back();
  if (pname == GL_POSITION) light.position = glm::vec4(eye * glm::dvec4(light.position));
  if (pname == GL_SPOT_DIRECTION) light.spot_direction = glm::vec3(glm::dmat3(eye) * glm::dvec3(light.spot_direction));
}

void set_light_model(Context& c, GLenum pname, const ParameterValues& a) {
  LightingState& l = c.state.lighting;
  const bool is_control = pname == GL_LIGHT_MODEL_COLOR_CONTROL;
  if (pname == GL_LIGHT_MODEL_AMBIENT)
    l.model_ambient = vec4_of(a);
  else if (pname == GL_LIGHT_MODEL_LOCAL_VIEWER)
    l.local_viewer = a.v[0] != 0;
  else if (pname == GL_LIGHT_MODEL_TWO_SIDE)
    l.two_side = a.v[0] != 0;
  else if (is_control && is_one_of(a.name(), GL_SINGLE_COLOR, GL_SEPARATE_SPECULAR_COLOR))
    l.color_control = a.name();
  else
    c.fail(GL_INVALID_ENUM);
}

/// Sets a parameter of the front's or the back's material, or of both.
void set_materials(LightingState& l, GLenum face, GLenum pname, const float* values) {
  for (const int side : {0, 1})
    for (const GLenum which : {GL_AMBIENT, GL_DIFFUSE, GL_SPECULAR, GL_EMISSION, GL_SHININESS, GL_COLOR_INDEXES})
      if (face != GLenum(side == 0 ? GL_BACK : GL_FRONT) &&
          (pname == which || (pname == GL_AMBIENT_AND_DIFFUSE && is_one_of(which, GL_AMBIENT, GL_DIFFUSE))))
        std::copy_n(values, count_of(which), parameter_of(l.materials[std::size_t(side)], which));
}

void set_material(Context& c, GLenum face, GLenum pname, const ParameterValues& a) {
  LightingState& l = c.state.lighting;
  if (!is_face(face) || (pname != GL_AMBIENT_AND_DIFFUSE && !parameter_of(l.materials[0], pname)))
    return c.fail(GL_INVALID_ENUM);
  if (pname == GL_SHININESS && !(a.v[0] >= 0 && a.v[0] <= 128)) return c.fail(GL_INVALID_VALUE);
  set_materials(l, face, pname, a.v.data());
  apply_color_material(c.state);  // a color that follows the current color cannot be set
  if (c.is_inside_begin())
    c.stream.material_changes(c);
  else
    c.stream.state_changes();
}

void set_fog(Context& c, GLenum pname, const ParameterValues& a) {
  FogState& fog = c.state.fog;
  if (pname == GL_FOG_MODE && is_one_of(a.name(), GL_LINEAR, GL_EXP, GL_EXP2))
    fog.mode = a.name();
  else if (pname == GL_FOG_COORD_SRC && is_one_of(a.name(), GL_FOG_COORD, GL_FRAGMENT_DEPTH))
    fog.coord_source = a.name();
  else if (assign(c, parameter_of(fog, pname), pname, a, pname != GL_FOG_DENSITY || a.v[0] >= 0))
    fog.color = unit_color(fog.color);
}

void set_point(Context& c, GLenum pname, const ParameterValues& a) {
  assign(c, parameter_of(c.state.point, pname), pname, a, count_of(pname) > 1 || a.v[0] >= 0);
}

}  // namespace

std::pair<GLenum*, bool> environment_value(TextureUnitState& unit, GLenum pname, GLenum to) {
  CombineState& c = unit.combine;
  const bool is_source =
      is_one_of(to, GL_TEXTURE, GL_CONSTANT, GL_PRIMARY_COLOR, GL_PREVIOUS) || to - GL_TEXTURE0 < GLenum(kTextureUnits);
  const bool is_combiner = is_one_of(to, GL_REPLACE, GL_MODULATE, GL_ADD, GL_ADD_SIGNED, GL_INTERPOLATE, GL_SUBTRACT);
  const bool is_alpha = is_one_of(to, GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  if (pname == GL_TEXTURE_ENV_MODE)
    return {&unit.env_mode, is_one_of(to, GL_MODULATE, GL_DECAL, GL_BLEND, GL_REPLACE, GL_ADD, GL_COMBINE)};
  if (pname == GL_COMBINE_RGB) return {&c.rgb, is_combiner || is_one_of(to, GL_DOT3_RGB, GL_DOT3_RGBA)};
  if (pname == GL_COMBINE_ALPHA) return {&c.alpha, is_combiner};
  // The names of the three sources follow one another, as those of the operands do.
  if (pname - GL_SOURCE0_RGB < 3) return {&c.source_rgb[pname - GL_SOURCE0_RGB], is_source};
  if (pname - GL_SOURCE0_ALPHA < 3) return {&c.source_alpha[pname - GL_SOURCE0_ALPHA], is_source};
  if (pname - GL_OPERAND0_RGB < 3)
    return {&c.operand_rgb[pname - GL_OPERAND0_RGB], is_alpha || is_one_of(to, GL_SRC_COLOR, GL_ONE_MINUS_SRC_COLOR)};
  if (pname - GL_OPERAND0_ALPHA < 3) return {&c.operand_alpha[pname - GL_OPERAND0_ALPHA], is_alpha};
  return {nullptr, false};
}

namespace {

void set_environment(Context& c, GLenum target, GLenum pname, const ParameterValues& a) {
  TextureUnitState& unit = c.state.texture.units[std::size_t(c.state.texture.active)];
  if (target == GL_TEXTURE_FILTER_CONTROL && pname == GL_TEXTURE_LOD_BIAS) return void(unit.lod_bias = a.v[0]);
  if (target != GL_TEXTURE_ENV) return c.fail(GL_INVALID_ENUM);
  if (pname == GL_TEXTURE_ENV_COLOR) return void(unit.env_color = unit_color(vec4_of(a)));
  if (is_one_of(pname, GL_RGB_SCALE, GL_ALPHA_SCALE)) {
    if (a.v[0] != 1 && a.v[0] != 2 && a.v[0] != 4) return c.fail(GL_INVALID_VALUE);
    (pname == GL_RGB_SCALE ? unit.combine.rgb_scale : unit.combine.alpha_scale) = a.v[0];
    return;
  }
  const auto [value, is_valid] = environment_value(unit, pname, a.name());
  if (!is_valid) return c.fail(GL_INVALID_ENUM);
  *value = a.name();
}

void set_generation(Context& c, GLenum coordinate, GLenum pname, const ParameterValues& a) {
  if (coordinate - GL_S > 3) return c.fail(GL_INVALID_ENUM);
  TexGenState& gen = c.state.texture.units[std::size_t(c.state.texture.active)].generated[coordinate - GL_S];
  if (pname == GL_OBJECT_PLANE) {
    gen.object_plane = vec4_of(a);
  } else if (pname == GL_EYE_PLANE) {
    gen.eye_plane = glm::vec4(glm::dvec4(vec4_of(a)) * inverse_modelview(c));
  } else {
    const GLenum mode = a.name();
    const bool is_valid = is_one_of(mode, GL_OBJECT_LINEAR, GL_EYE_LINEAR) ||
                          (mode == GL_SPHERE_MAP && coordinate <= GL_T) ||
                          (is_one_of(mode, GL_NORMAL_MAP, GL_REFLECTION_MAP) && coordinate <= GL_R);
    if (pname != GL_TEXTURE_GEN_MODE || !is_valid) return c.fail(GL_INVALID_ENUM);
    gen.mode = mode;
  }
}

}  // namespace

void apply_color_material(State& state) {
  if (state.capabilities.has(Capability::color_material))
    set_materials(state.lighting, state.lighting.color_material_face, state.lighting.color_material_mode,
                  &state.current.values[kRed]);
}

SETTER(glColorMaterial, (GLenum face, GLenum mode),
       is_face(face) && is_one_of(mode, GL_AMBIENT, GL_DIFFUSE, GL_SPECULAR, GL_EMISSION, GL_AMBIENT_AND_DIFFUSE),
       GL_INVALID_ENUM, s.lighting.color_material_face = face, s.lighting.color_material_mode = mode,
       apply_color_material(s))

// Entry points for one value, and for a pointer to values, by a function that sets them.
#define PARAMETER_CALL(entry, parameters, call, given, ...) \
  FRONTMOST_GL void entry parameters {                      \
    call([=, a = given](Context& c) {                       \
      if (!a.fits(pname)) return c.fail(GL_INVALID_ENUM);   \
      __VA_ARGS__;                                          \
    });                                                     \
  }
#define BY_NAME(entry, s, T, call, set)                                                     \
  PARAMETER_CALL(entry##s, (GLenum pname, T v), call, ParameterValues(v), set(c, pname, a)) \
  PARAMETER_CALL(entry##s##v, (GLenum pname, const T* v), call, ParameterValues(pname, v), set(c, pname, a))
#define BY_TARGET(entry, s, T, call, set)                                                                          \
  PARAMETER_CALL(entry##s, (GLenum target, GLenum pname, T v), call, ParameterValues(v), set(c, target, pname, a)) \
  PARAMETER_CALL(entry##s##v, (GLenum target, GLenum pname, const T* v), call, ParameterValues(pname, v),          \
                 set(c, target, pname, a))
#define FLOATS_AND_INTS(FORM, entry, ...) FORM(entry, f, GLfloat, __VA_ARGS__) FORM(entry, i, GLint, __VA_ARGS__)

FLOATS_AND_INTS(BY_TARGET, glLight, draw_call, set_light)
FLOATS_AND_INTS(BY_TARGET, glMaterial, vertex_call, set_material)
FLOATS_AND_INTS(BY_TARGET, glTexEnv, draw_call, set_environment)
FLOATS_AND_INTS(BY_TARGET, glTexGen, draw_call, set_generation)
BY_TARGET(glTexGen, d, GLdouble, draw_call, set_generation)
FLOATS_AND_INTS(BY_NAME, glLightModel, draw_call, set_light_model)
FLOATS_AND_INTS(BY_NAME, glFog, draw_call, set_fog)
FLOATS_AND_INTS(BY_NAME, glPointParameter, draw_call, set_point)

FRONTMOST_GL_ALIAS(glBlendFuncSeparateEXT, glBlendFuncSeparate);
FRONTMOST_GL_ALIAS(glBlendEquationEXT, glBlendEquation);
FRONTMOST_GL_ALIAS(glBlendColorEXT, glBlendColor);
FRONTMOST_GL_ALIAS(glActiveTextureARB, glActiveTexture);
FRONTMOST_GL_ALIAS(glBlendEquationSeparateEXT, glBlendEquationSeparate);
FRONTMOST_GL_ALIAS(glBlendEquationSeparateATI, glBlendEquationSeparate);
FRONTMOST_GL_ALIAS(glPointParameterfARB, glPointParameterf);
FRONTMOST_GL_ALIAS(glPointParameterfvARB, glPointParameterfv);
FRONTMOST_GL_ALIAS(glPointParameterfEXT, glPointParameterf);
FRONTMOST_GL_ALIAS(glPointParameterfvEXT, glPointParameterfv);

}  // namespace frontmost::gl_detail
