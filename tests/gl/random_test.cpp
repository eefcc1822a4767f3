// SPDX-License-Identifier: Apache-2.0
// Random streams of calls: against the interpreter; with other threads and instruction sets; with invalid calls.
#define GL_GLEXT_PROTOTYPES
#include <GL/osmesa.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <sstream>
#include <tuple>

#include "gl/interpreter.h"
#include "support/effort.h"
#include "support/random_scene.h"

namespace frontmost::test {
namespace {

using gl::State, gl::Vertex;
/// A call of glClear, or a primitive, in a state. Some parts of the state differ from the command before.
struct Command {
  State state;
  std::uint32_t varied;
  GLbitfield clears = 0;
  GLenum mode = GL_POINTS;
  std::vector<Vertex> vertices = {};
};
struct CallStream {
  int width, height;
  std::vector<Command> commands = {};
};

// ---- Random streams. No expression draws two numbers in an order that compilers choose.

bool chance(Random& r, int percent) { return r.below(100) < percent; }
template <class T>
T one_of(Random& r, std::initializer_list<T> values) {
  return values.begin()[r.below(int(values.size()))];
}
/// Whole bytes are stored without rounding.
float shade(Random& r) { return float(r.below(256)) / 255; }
gl::Color random_color(Random& r) { return {shade(r), shade(r), shade(r), shade(r)}; }
std::array<int, 4> random_rect(Random& r, const CallStream& to) {
  if (chance(r, 50)) return {0, 0, to.width, to.height};
  const int left = r.below(to.width) - to.width / 4, low = r.below(to.height) - to.height / 4;
  return {left, low, 1 + r.below(to.width), 1 + r.below(to.height)};
}

/// A part of the state: how it varies, and the calls that set it.
struct Part {
  void (*vary)(Random& r, State& s, const CallStream& to);
  void (*set)(const State& s);
};

void enable(GLenum name, bool on) { (on ? glEnable : glDisable)(name); }
GLenum name_of(Random& r, std::initializer_list<GLenum> names) { return one_of(r, names); }
GLenum comparison(Random& r) { return GLenum(GL_NEVER + r.below(8)); }

// ---- Textures of a unit. Texture objects are its own, as those of name 0 are shared.

void enable_texture(const gl::TextureUnit& unit) {
  enable(GL_TEXTURE_1D, unit.is_on && unit.image->is_1d), enable(GL_TEXTURE_2D, unit.is_on && !unit.image->is_1d);
}

// clang-format off
template <std::size_t number>
void vary_image(Random& r, State& s, const CallStream&) {
  const GLenum format = name_of(r, {GL_ALPHA, GL_LUMINANCE, GL_LUMINANCE_ALPHA, GL_INTENSITY, GL_RGB, GL_RGBA});
  gl::Image image{format, chance(r, 30), {}};
  for (int w = 1 << r.below(4), h = image.is_1d ? 1 : 1 << r.below(4);; w = std::max(w / 2, 1), h = std::max(h / 2, 1)) {
    gl::Level level{w, h, std::vector<gl::Texel>(std::size_t(w * h))};
    for (gl::Texel& texel : level.texels) for (std::uint8_t& c : texel) c = std::uint8_t(r.below(256));
    image.levels.push_back(std::move(level));
    if (w * h == 1) break;
  }
  s.units[number].image = std::make_shared<const gl::Image>(std::move(image));
}

template <std::size_t number>
void set_image(const State& s) {
  const gl::TextureUnit& unit = s.units[number];
  glActiveTexture(GL_TEXTURE0 + number), enable_texture(unit);
  for (std::size_t i = 0; unit.image && i < unit.image->levels.size(); ++i) {
    const gl::Level& l = unit.image->levels[i];
    const auto format = GLint(unit.image->format);
    if (unit.image->is_1d) glTexImage1D(GL_TEXTURE_1D, GLint(i), format, l.width, 0, GL_RGBA, GL_UNSIGNED_BYTE, l.texels.data());
    else glTexImage2D(GL_TEXTURE_2D, GLint(i), format, l.width, l.height, 0, GL_RGBA, GL_UNSIGNED_BYTE, l.texels.data());
  }
}

template <std::size_t number>
void vary_texture(Random& r, State& s, const CallStream&) {
  gl::TextureUnit& unit = s.units[number];
  unit.is_on = unit.image && chance(r, number == 0 ? 70 : 50);
  unit.mag_filter = unit.min_filter = name_of(r, {GL_NEAREST, GL_LINEAR});
  if (chance(r, 40)) unit.min_filter = name_of(r, {GL_NEAREST, GL_LINEAR, GL_NEAREST_MIPMAP_NEAREST, GL_LINEAR_MIPMAP_NEAREST,
                                                   GL_NEAREST_MIPMAP_LINEAR, GL_LINEAR_MIPMAP_LINEAR});
  for (GLenum* wrap : {&unit.wrap_s, &unit.wrap_t})
    *wrap = name_of(r, {GL_REPEAT, GL_CLAMP, GL_CLAMP_TO_EDGE, GL_CLAMP_TO_BORDER, GL_MIRRORED_REPEAT});
  unit.env_mode = name_of(r, {GL_MODULATE, GL_REPLACE, GL_DECAL, GL_BLEND, GL_ADD, GL_COMBINE});
  unit.env_color = random_color(r), unit.border_color = random_color(r);
  for (std::size_t part = 0; part < 2; ++part) {
    const int modes = part == 0 ? 8 : 6;  // dot products are of colors alone
    constexpr GLenum names[] = {GL_REPLACE, GL_MODULATE, GL_ADD, GL_ADD_SIGNED, GL_SUBTRACT, GL_INTERPOLATE, GL_DOT3_RGB, GL_DOT3_RGBA};
    unit.combiner.mode[part] = names[r.below(modes)];
    for (std::size_t i = 0; i < 3; ++i) {
      unit.combiner.sources[part][i] = name_of(r, {GL_TEXTURE, GL_CONSTANT, GL_PRIMARY_COLOR, GL_PREVIOUS});
      unit.combiner.operands[part][i] = GLenum(GL_SRC_COLOR + (part == 0 ? r.below(4) : 2 + r.below(2)));
    }
  }
  for (float& scale : unit.combiner.scales) scale = one_of(r, {1.0f, 1.0f, 2.0f, 4.0f});
}

template <std::size_t number>
void set_texture(const State& s) {
  const gl::TextureUnit& unit = s.units[number];
  glActiveTexture(GL_TEXTURE0 + number), enable_texture(unit);
  glTexEnvfv(GL_TEXTURE_ENV, GL_TEXTURE_ENV_COLOR, unit.env_color.data());
  for (const GLenum target : {GL_TEXTURE_1D, GL_TEXTURE_2D}) {
    glTexParameterfv(target, GL_TEXTURE_BORDER_COLOR, unit.border_color.data());
    const std::pair<GLenum, GLenum> values[] = {{GL_TEXTURE_MIN_FILTER, unit.min_filter}, {GL_TEXTURE_MAG_FILTER, unit.mag_filter},
                                                {GL_TEXTURE_WRAP_S, unit.wrap_s}, {GL_TEXTURE_WRAP_T, unit.wrap_t}};
    for (const auto& [name, value] : values) glTexParameteri(target, name, GLint(value));
  }
  const auto env = [](GLenum name, GLenum value) { glTexEnvi(GL_TEXTURE_ENV, name, GLint(value)); };
  env(GL_TEXTURE_ENV_MODE, unit.env_mode), env(GL_COMBINE_RGB, unit.combiner.mode[0]), env(GL_COMBINE_ALPHA, unit.combiner.mode[1]);
  for (GLenum i = 0; i < 3; ++i) {
    env(GL_SOURCE0_RGB + i, unit.combiner.sources[0][i]), env(GL_SOURCE0_ALPHA + i, unit.combiner.sources[1][i]);
    env(GL_OPERAND0_RGB + i, unit.combiner.operands[0][i]), env(GL_OPERAND0_ALPHA + i, unit.combiner.operands[1][i]);
  }
  glTexEnvf(GL_TEXTURE_ENV, GL_RGB_SCALE, unit.combiner.scales[0]);
  glTexEnvf(GL_TEXTURE_ENV, GL_ALPHA_SCALE, unit.combiner.scales[1]);
}

#define VARY [](Random& r, State& s, const CallStream& to) { (void)r, (void)to;
#define SET }, [](const State& s) {
constexpr std::size_t kTextureParts = 4;  ///< the first ones
const Part kParts[] = {
    {vary_image<0>, set_image<0>}, {vary_image<1>, set_image<1>}, {vary_texture<0>, set_texture<0>},
    {vary_texture<1>, set_texture<1>},
    {VARY s.viewport = random_rect(r, to), s.depth_range = {r.below(257) / 256.0, r.below(3) / 2.0};
     SET std::apply(glViewport, s.viewport), std::apply(glDepthRange, s.depth_range); }},
    {VARY s.scissor_test = chance(r, 60), s.scissor = random_rect(r, to);
     SET enable(GL_SCISSOR_TEST, s.scissor_test), std::apply(glScissor, s.scissor); }},
    {VARY s.projection = s.modelview = gl::kIdentity;
       const int kind = r.below(3);
       for (const std::size_t k : {0, 5, 10, 12, 13, 14})
         if (kind == 1) s.modelview[k] = k < 12 ? one_of(r, {0.5, 1.0, 2.0}) : r.below(65) / 64.0 - 0.5;
       if (kind == 2) s.projection = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1.25, -1, 0, 0, -2.25, 0}, s.modelview[14] = -2;
     SET glMatrixMode(GL_PROJECTION), glLoadMatrixd(s.projection.data());
       glMatrixMode(GL_MODELVIEW), glLoadMatrixd(s.modelview.data()); }},
    {VARY s.clip_plane0 = chance(r, 40), s.clip_plane1 = chance(r, 20);
       for (auto& plane : s.clip_planes) for (double& c : plane) c = (r.below(129) - 64) / 64.0;
     SET enable(GL_CLIP_PLANE0, s.clip_plane0), enable(GL_CLIP_PLANE1, s.clip_plane1), glPushMatrix(), glLoadIdentity();
       for (GLenum k = 0; k < 2; ++k) glClipPlane(GL_CLIP_PLANE0 + k, s.clip_planes[k].data());
       glPopMatrix(); }},
    {VARY s.cull_face = chance(r, 60), s.culled = name_of(r, {GL_FRONT, GL_BACK, GL_BACK, GL_FRONT_AND_BACK});
       s.front = name_of(r, {GL_CW, GL_CCW}), s.shade_model = name_of(r, {GL_SMOOTH, GL_FLAT});
     SET enable(GL_CULL_FACE, s.cull_face), glFrontFace(s.front), glCullFace(s.culled), glShadeModel(s.shade_model); }},
    {VARY s.offset = chance(r, 60), s.polygon_offset = {float(r.below(41) - 20) / 8, float(r.below(41) - 20) / 2};
     SET enable(GL_POLYGON_OFFSET_FILL, s.offset), std::apply(glPolygonOffset, s.polygon_offset); }},
    {VARY for (GLenum& mode : s.polygon_modes) mode = chance(r, 70) ? GL_FILL : name_of(r, {GL_LINE, GL_POINT});
     SET glPolygonMode(GL_FRONT, s.polygon_modes[0]), glPolygonMode(GL_BACK, s.polygon_modes[1]); }},
    {VARY s.line_width = one_of(r, {1.0f, 2.0f, 3.0f, 7.0f}), s.point_size = one_of(r, {1.0f, 2.0f, 3.0f, 6.0f, 20.0f});
       s.stipple = chance(r, 70), s.stipple_factor = 1 + r.below(4), s.stipple_pattern = GLushort(r.next());
     SET glLineWidth(s.line_width), glPointSize(s.point_size), enable(GL_LINE_STIPPLE, s.stipple);
       glLineStipple(s.stipple_factor, s.stipple_pattern); }},
    {VARY s.clear_color = random_color(r), s.clear_stencil = r.below(300), s.clear_depth = double(r.unit());
     SET std::apply(glClearColor, s.clear_color), glClearStencil(s.clear_stencil), glClearDepth(s.clear_depth); }},
    {VARY s.alpha_test = chance(r, 60), s.alpha_func = comparison(r), s.alpha_ref = shade(r);
     SET enable(GL_ALPHA_TEST, s.alpha_test), glAlphaFunc(s.alpha_func, s.alpha_ref); }},
    {VARY s.depth_test = chance(r, 80), s.depth_func = comparison(r), s.depth_mask = chance(r, 80);
     SET enable(GL_DEPTH_TEST, s.depth_test), glDepthFunc(s.depth_func), glDepthMask(s.depth_mask); }},
    {VARY s.stencil_test = chance(r, 80), s.stencil_func = comparison(r), s.stencil_mask = one_of(r, {~0u, 1u, 3u});
       s.stencil_ref = one_of(r, {0, 1, 2, 100, 300, -3}), s.stencil_writes = one_of(r, {~0u, 0xFFu, 0x0Fu, 0x55u});
       for (GLenum& op : s.stencil_ops)
         op = name_of(r, {GL_KEEP, GL_ZERO, GL_REPLACE, GL_INCR, GL_DECR, GL_INVERT, GL_INCR_WRAP, GL_DECR_WRAP});
     SET enable(GL_STENCIL_TEST, s.stencil_test), glStencilFunc(s.stencil_func, s.stencil_ref, s.stencil_mask);
       glStencilMask(s.stencil_writes), std::apply(glStencilOp, s.stencil_ops); }},
    {VARY s.blend = chance(r, 70), s.blend_color = random_color(r);
       for (std::size_t k = 0; k < 4; ++k) s.factors[k] = GLenum(r.below(15 - int(k % 2)));  // 14 saturates
       for (GLenum& f : s.factors) f += f < 2 ? 0 : f < 6 ? GL_CONSTANT_COLOR - 2 : GL_SRC_COLOR - 6;
       for (GLenum& e : s.equations)
         e = name_of(r, {GL_FUNC_ADD, GL_FUNC_ADD, GL_FUNC_SUBTRACT, GL_FUNC_REVERSE_SUBTRACT, GL_MIN, GL_MAX});
     SET enable(GL_BLEND, s.blend), std::apply(glBlendColor, s.blend_color), std::apply(glBlendFuncSeparate, s.factors);
       std::apply(glBlendEquationSeparate, s.equations); }},
    {VARY s.logic = chance(r, 30), s.logic_op = GLenum(GL_CLEAR + r.below(16));
       for (bool& on : s.color_mask) on = chance(r, 75);
     SET enable(GL_COLOR_LOGIC_OP, s.logic), glLogicOp(s.logic_op), std::apply(glColorMask, s.color_mask); }},
    {VARY s.fog = chance(r, 50), s.fog_start = r.within(-1, 1), s.fog_color = random_color(r);
       s.fog_end = s.fog_start + one_of(r, {-1.0f, 0.5f, 3.0f});
     SET enable(GL_FOG, s.fog), glFogi(GL_FOG_MODE, GL_LINEAR), glFogf(GL_FOG_START, s.fog_start);
       glFogf(GL_FOG_END, s.fog_end), glFogfv(GL_FOG_COLOR, s.fog_color.data()); }}};
// clang-format on

/// Vertices of a primitive: tiny, thin, large, huge, cut by planes, or where ties are. Many creep over the frame.
std::vector<Vertex> random_vertices(Random& r, const State& s, const CallStream& to, int count) {
  enum Kind { tiny, thin, large, ties, huge, cut, kinds };
  const bool are_filled = s.polygon_modes == State().polygon_modes;  // outlined polygons are not cut by planes
  const int kind = count > 100 ? int(tiny) : r.below(are_filled ? kinds : int(huge));
  const bool has_one_w = chance(r, 60), has_one_z = has_one_w && chance(r, 80), has_ids = chance(r, 50);
  const bool are_flush = chance(r, 20);  // texture coordinates, with texels
  const float reach = kind == tiny ? 1.5f : kind == huge ? one_of(r, {300.0f, 1500.0f, 40000.0f}) : 50.0f;
  float centre_x = r.within(0, float(to.width)), centre_y = r.within(0, float(to.height));
  const float z0 = float(r.below(255) - 127) / 128, w0 = one_of(r, {1.0f, 1.0f, 0.5f, 2.0f});
  gl::Color color = random_color(r);
  std::vector<Vertex> vertices;
  for (int i = 0; i < count; ++i) {
    if (count > 100) centre_x += r.within(-0.5f, 0.5f), centre_y += r.within(-0.5f, 0.5f);
    float x = centre_x + r.within(-reach, reach), y = centre_y + r.within(-reach, reach);
    if (kind == thin) y = centre_y + (x - centre_x) * 0.37f + r.within(-0.02f, 0.02f);
    if (kind == ties) x = std::floor(x / 8) * 8 + float(r.below(2)) / 2;
    if (kind == ties) y = std::floor(y / 16) * 16 + float(r.below(2)) / 2;
    float z = has_one_z ? z0 : r.within(-0.99f, 0.99f), w = has_one_w ? w0 : r.within(0.5f, 2);
    if (kind == cut) z *= 2.5f, w *= chance(r, 20) ? -1.0f : 1.0f;
    x = (x - float(s.viewport[0])) / float(s.viewport[2]) * 2 - 1;
    y = (y - float(s.viewport[1])) / float(s.viewport[3]) * 2 - 1;
    if (!has_ids || chance(r, 20)) color = random_color(r);
    Vertex vertex{{x * w, y * w, z * w, w}, color, {}};
    for (auto& texcoord : vertex.texcoords) {
      const float u = are_flush ? float(r.below(3)) : r.within(-2, 3), t = r.within(-2, 3);
      texcoord = {u, t, 0, are_flush ? 1 : one_of(r, {1.0f, 1.0f, 2.0f, 0.75f})};
    }
    vertices.push_back(vertex);
  }
  return vertices;
}

CallStream random_stream(std::uint64_t seed) {
  Random r(seed);
  CallStream to{1 + r.below(90), 1 + r.below(70)};
  if (seed % 16 == 0) to.width += 150, to.height += 90;  // several tiles
  State s;
  s.viewport = s.scissor = {0, 0, to.width, to.height};
  const bool has_all_units = chance(r, 40);
  std::uint32_t varied = 0;
  for (std::size_t part = 0; has_all_units && part < kTextureParts; ++part)
    kParts[part].vary(r, s, to), varied |= 1u << part;
  for (int count = 4 + r.below(28); count > 0; --count, varied = 0) {
    for (int changes = r.below(4); changes > 0; --changes) {
      const auto part = std::size_t(r.below(int(std::size(kParts))));
      kParts[part].vary(r, s, to), varied |= 1u << part;
    }
    // Edges that planes make are not compared.
    if (s.polygon_modes != State().polygon_modes)
      s.clip_plane0 = s.clip_plane1 = false, s.projection = s.modelview = gl::kIdentity, varied = ~0u;
    if (s.logic) {  // exact colors, for their bits
      s.shade_model = GL_FLAT, s.fog = false, varied = ~0u;
      for (gl::TextureUnit& unit : s.units) unit.is_on = false;
    }
    const std::size_t number = r.next() % (to.commands.size() + 1);
    const Command* const other = number > 0 ? &to.commands[number - 1] : nullptr;
    Command c{s, varied, 0, GLenum(r.below(GL_POLYGON + 1))};
    if (chance(r, 8)) {
      c.clears = one_of<GLbitfield>(r, {GL_COLOR_BUFFER_BIT, GL_DEPTH_BUFFER_BIT, GL_STENCIL_BUFFER_BIT, 0x4500});
    } else if (other && other->clears == 0 && chance(r, 30)) {  // another pass over the same primitives
      const State& o = other->state;
      c.mode = other->mode, c.vertices = other->vertices;
      s.projection = o.projection, s.modelview = o.modelview, s.viewport = o.viewport, s.depth_range = o.depth_range;
      s.offset = o.offset, s.polygon_offset = o.polygon_offset, s.depth_test = true;
      s.polygon_modes = o.polygon_modes, s.clip_plane0 = o.clip_plane0, s.clip_plane1 = o.clip_plane1;
      s.depth_func = one_of<GLenum>(r, {GL_EQUAL, GL_EQUAL, GL_LEQUAL, GL_GEQUAL, GL_NOTEQUAL});
      c.state = s, c.varied = ~0u;
      const gl::Color color = random_color(r);
      for (Vertex& v : c.vertices) v.color = color;
    } else {
      const bool fills_batches = chance(r, 2);
      c.vertices = random_vertices(r, s, to, fills_batches ? 3000 + r.below(4000) : 1 + r.below(12));
    }
    to.commands.push_back(std::move(c));
  }
  return to;
}

GLubyte scratch[64];
using Call = void (*)();
// clang-format off
#define C(...) [] { __VA_ARGS__; }
/// Calls that are errors anywhere.
constexpr Call kInvalid[] = {
    C(glEnable(GL_FRONT)), C(glBegin(GL_POLYGON + 1)), C(glEnd()), C(glClear(0x80000000 | GL_COLOR_BUFFER_BIT)),
    C(glBlendFunc(GL_ONE, GL_ADD)), C(glDepthFunc(0)), C(glAlphaFunc(GL_ALWAYS + 1, 0.5f)), C(glStencilFunc(0, 1, 1)),
    C(glStencilOp(GL_ZERO, GL_ZERO, GL_ONE)), C(glLogicOp(GL_CLEAR - 1)), C(glLineWidth(0)), C(glPointSize(-1)),
    C(glViewport(0, 0, -1, 5)), C(glScissor(0, 0, 5, -1)), C(glShadeModel(GL_FRONT)), C(glFrustum(-1, 1, -1, 1, 0, 1)),
    C(glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA, 3, 3, 0, GL_RGBA, GL_UNSIGNED_BYTE, scratch)), C(glPopAttrib()),
    C(glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_LINEAR)), C(glNewList(0, GL_COMPILE)), C(glPopMatrix())};
/// Calls that are errors only between glBegin and glEnd.
constexpr Call kMisplaced[] = {
    C(glEnable(GL_BLEND)), C(glDisable(GL_DEPTH_TEST)), C(glClear(GL_COLOR_BUFFER_BIT)), C(glBegin(GL_POINTS)),
    C(glPushMatrix()), C(glViewport(0, 0, 1, 1)), C(glScissor(0, 0, 1, 1)), C(glLoadIdentity()), C(glScalef(2, 2, 2)),
    C(glMatrixMode(GL_TEXTURE)), C(glDepthFunc(GL_NEVER)), C(glDepthRange(1, 0)), C(glFinish()), C(glLogicOp(GL_SET)),
    C(glShadeModel(GL_FLAT)), C(glFrontFace(GL_CW)), C(glBindTexture(GL_TEXTURE_2D, 7)), C(glRectf(-1, -1, 1, 1)),
    C(glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA, 4, 4, 0, GL_RGBA, GL_UNSIGNED_BYTE, scratch)), C(glColorMask(0, 0, 0, 0)),
    C(glDrawPixels(1, 1, GL_RGBA, GL_UNSIGNED_BYTE, scratch)), C(glPolygonMode(GL_FRONT_AND_BACK, GL_LINE))};
#undef C
// clang-format on

/// Depth, stencil value, red, green, blue and alpha of each pixel.
using Picture = std::vector<GLuint>;

/// Draws a stream. If `errors` is given, invalid calls go among the others.
Picture drawn(const CallStream& stream, Random* errors = nullptr) {
  const int width = stream.width, height = stream.height;
  const auto size = std::size_t(width * height);
  std::vector<GLubyte> color(4 * size), stencil(size);
  Picture depth(size), picture;
  const OSMesaContext context = OSMesaCreateContext(OSMESA_RGBA, nullptr);
  EXPECT_TRUE(OSMesaMakeCurrent(context, color.data(), GL_UNSIGNED_BYTE, width, height));
  for (GLuint unit = 0; unit < gl::kUnits; ++unit) {
    glActiveTexture(GL_TEXTURE0 + unit);
    glBindTexture(GL_TEXTURE_1D, 1 + unit), glBindTexture(GL_TEXTURE_2D, 1 + gl::kUnits + unit);
  }
  // Makes an invalid call, or none.
  const auto err = [&](const auto& calls) {
    if (!errors || !chance(*errors, 20)) return false;
    calls[errors->next() % std::size(calls)]();
    return true;
  };
  for (const Command& c : stream.commands) {
    for (std::size_t part = 0; part < std::size(kParts); ++part)
      if ((c.varied >> part & 1) != 0) kParts[part].set(c.state);
    EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR));
    const bool is_invalid = err(kInvalid);
    EXPECT_EQ(glGetError() != GL_NO_ERROR, is_invalid);
    glClear(c.clears);
    if (c.clears != 0) continue;
    bool errs = false;
    glBegin(c.mode);
    for (const Vertex& v : c.vertices) {
      glColor4fv(v.color.data());
      for (std::size_t unit = 0; unit < gl::kUnits; ++unit)
        glMultiTexCoord4fv(GLenum(GL_TEXTURE0 + unit), v.texcoords[unit].data());
      errs |= err(kMisplaced);
      glVertex4fv(v.position.data());
    }
    glEnd();
    EXPECT_EQ(glGetError(), GLenum(errs ? GL_INVALID_OPERATION : GL_NO_ERROR));
  }
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, color.data());
  glReadPixels(0, 0, width, height, GL_STENCIL_INDEX, GL_UNSIGNED_BYTE, stencil.data());
  glReadPixels(0, 0, width, height, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT, depth.data());
  OSMesaDestroyContext(context);
  for (std::size_t i = 0, k = 0; i < size; ++i, k += 4)
    picture.insert(picture.end(), {depth[i] >> 8, stencil[i], color[k], color[k + 1], color[k + 2], color[k + 3]});
  return picture;
}

/// \returns a description of a wrong pixel, or nothing. Counts pixels whose stencil or colors, or whose depth, are
/// hardly known.
std::string compare(const CallStream& stream, const Picture& picture, int& doubtful, int& deep) {
  gl::Interpreter expected{stream.width, stream.height};
  for (const Command& c : stream.commands)
    c.clears != 0 ? expected.clear(c.state, c.clears) : expected.draw(c.state, c.mode, c.vertices);
  std::ostringstream text;
  text.precision(9);
  for (std::size_t i = 0; i < expected.pixels.size(); ++i) {
    const gl::Pixel& p = expected.pixels[i];
    const gl::Range stencil = p.stencil < 0 ? gl::Range(0, 255) : gl::Range(p.stencil);
    const gl::Range of[] = {p.depth, stencil, p.color[0], p.color[1], p.color[2], p.color[3]};
    bool is_right = true, is_doubtful = false;
    for (std::size_t k = 0; k < 6; ++k) {
      is_right = is_right && of[k].holds(picture[6 * i + k]);
      is_doubtful = is_doubtful || (k > 0 && of[k].high - of[k].low > 5);
    }
    doubtful += is_doubtful;
    deep += of[0].high - of[0].low > 1000;
    if (is_right || text.tellp() > 0) continue;
    text << "x " << int(i) % stream.width << ", y " << int(i) / stream.width << ": depth, stencil, color ";
    for (std::size_t k = 0; k < 6; ++k) text << picture[6 * i + k] << " [" << of[k].low << ", " << of[k].high << "] ";
  }
  return text.str();
}

TEST(RandomStreams, EqualTheInterpreter) {
  int doubtful = 0, deep = 0, pixels = 0;
  for (std::uint64_t seed = 0; seed < seeds(100); ++seed) {
    const CallStream stream = random_stream(seed);
    EXPECT_EQ(compare(stream, drawn(stream), doubtful, deep), "") << "seed " << seed;
    pixels += stream.width * stream.height;
  }
  // A sanitizer draws a dozen streams only, of which one has many such pixels. Two textures leave more colors in doubt.
  const bool are_few = seeds(100) < 100;
  EXPECT_LT(doubtful, pixels / (are_few ? 5 : 10));
  EXPECT_LT(deep, pixels / (are_few ? 15 : 30));
}

TEST(LongPrimitives, GoOnWithTheirStipple) {
  State s;
  s.viewport = s.scissor = {0, 0, 90, 70};
  s.stipple = true, s.stipple_pattern = 0x0F35, s.stipple_factor = 2;
  s.polygon_modes = {GL_LINE, GL_LINE};
  for (const char* const threads : {"1", "3"})
    for (const GLenum mode : {GL_LINE_STRIP, GL_LINE_LOOP, GL_POLYGON}) {
      setenv("FRONTMOST_GL_THREADS", threads, 1);
      CallStream stream{90, 70};
      // The second stipple begins anew, in the batch where the first one ends. Fifteen batches are more than wait.
      for (const int count : {mode == GL_LINE_STRIP ? 60000 : 10000, 30}) {
        Command c{s, count > 30 ? ~0u : 0, 0, mode};
        for (int i = 0; i < count; ++i) {
          const double angle = 6.28 * i / count, size = count > 30 ? 0.8 : 0.2;
          c.vertices.push_back(
              {{float(size * std::cos(angle)), float(size * std::sin(angle)), 0, 1}, {1, 1, 1, 1}, {}});
        }
        stream.commands.push_back(std::move(c));
      }
      int doubtful = 0, deep = 0;
      EXPECT_EQ(compare(stream, drawn(stream), doubtful, deep), "") << "mode " << mode << ", threads " << threads;
      EXPECT_EQ(doubtful, 0);
    }
  unsetenv("FRONTMOST_GL_THREADS");
}

TEST(RandomStreams, DoNotDependOnThreadsOrInstructionSets) {
  for (std::uint64_t seed = 0; seed < seeds(1000); seed += 4) {
    const CallStream stream = random_stream(seed);
    Picture expected;
    for (const char* const isa : {"scalar", "sse4", "avx2", "avx512"})
      for (const char* const threads : {"1", "2", "5"}) {
        setenv("FRONTMOST_GL_ISA", isa, 1);
        setenv("FRONTMOST_GL_THREADS", threads, 1);
        const Picture picture = drawn(stream);
        if (expected.empty()) expected = picture;
        EXPECT_TRUE(picture == expected) << "seed " << seed << ", " << isa << ", " << threads << " threads";
      }
  }
  unsetenv("FRONTMOST_GL_ISA");
  unsetenv("FRONTMOST_GL_THREADS");
}

TEST(RandomStreams, IgnoreInvalidCalls) {
  for (std::uint64_t seed = 0; seed < seeds(1000); ++seed) {
    Random errors(seed);
    const CallStream stream = random_stream(seed);
    EXPECT_TRUE(drawn(stream) == drawn(stream, &errors)) << "seed " << seed;
  }
}

}  // namespace
}  // namespace frontmost::test
