// SPDX-License-Identifier: Apache-2.0
// Calls that ask for values of the state.

#include "calls/call.h"
#include "calls/values.h"
#include "pixels/formats.h"
#include "state/capabilities.h"

namespace frontmost::gl_detail {
namespace {

constexpr char kExtensions[] =
    "GL_ARB_multitexture GL_ARB_occlusion_query GL_ARB_occlusion_query2 GL_ARB_point_parameters "
    "GL_ARB_texture_border_clamp "
    "GL_ARB_texture_env_add GL_ARB_texture_env_combine GL_ARB_texture_env_crossbar GL_ARB_texture_env_dot3 "
    "GL_ARB_texture_mirrored_repeat GL_ARB_transpose_matrix GL_ARB_vertex_buffer_object GL_ARB_window_pos GL_EXT_bgra "
    "GL_EXT_blend_color GL_EXT_blend_equation_separate GL_EXT_blend_func_separate GL_EXT_blend_minmax "
    "GL_EXT_blend_subtract GL_EXT_compiled_vertex_array GL_EXT_copy_texture GL_EXT_draw_range_elements "
    "GL_EXT_fog_coord GL_EXT_multi_draw_arrays GL_EXT_packed_pixels GL_EXT_point_parameters GL_EXT_polygon_offset "
    "GL_EXT_rescale_normal GL_EXT_secondary_color GL_EXT_separate_specular_color GL_EXT_stencil_wrap "
    "GL_EXT_subtexture GL_EXT_texture GL_EXT_texture_edge_clamp GL_EXT_texture_env_add GL_EXT_texture_env_combine "
    "GL_EXT_texture_lod_bias GL_EXT_texture_object GL_EXT_vertex_array GL_NV_texgen_reflection "
    "GL_SGIS_generate_mipmap GL_SGIS_texture_edge_clamp GL_SGIS_texture_lod";

template <int n, class T>
Results floats(const glm::vec<n, T>& v) {
  return Results::of(&v.x, n);
}
Results color(const glm::vec4& v) { return floats(v).as_normalized(); }
Results matrix(const std::vector<glm::dmat4>& stack, bool transposed = false) {
  const glm::dmat4 m = transposed ? glm::transpose(stack.back()) : stack.back();
  return Results::of(&m[0][0], 16);
}
Results rect(const WindowRect& r) { return Results(r.x, r.y, r.width, r.height); }
GLuint name_of(const std::shared_ptr<BufferObject>& buffer) { return buffer ? buffer->name : 0; }

using Row = std::pair<GLenum, double>;

// clang-format off
constexpr Row kConstants[] = {
    {GL_SUBPIXEL_BITS, 8}, {GL_RED_BITS, 8}, {GL_GREEN_BITS, 8}, {GL_BLUE_BITS, 8}, {GL_ALPHA_BITS, 8},
    {GL_STENCIL_BITS, 8}, {GL_DEPTH_BITS, 24}, {GL_INDEX_BITS, 0}, {GL_ACCUM_RED_BITS, 0}, {GL_ACCUM_GREEN_BITS, 0},
    {GL_ACCUM_BLUE_BITS, 0}, {GL_ACCUM_ALPHA_BITS, 0}, {GL_RGBA_MODE, 1}, {GL_INDEX_MODE, 0}, {GL_DOUBLEBUFFER, 0},
    {GL_STEREO, 0}, {GL_AUX_BUFFERS, 0}, {GL_SAMPLE_BUFFERS, 0}, {GL_SAMPLES, 0}, {GL_SAMPLE_COVERAGE_INVERT, 0},
    {GL_SAMPLE_COVERAGE_VALUE, 1}, {GL_NUM_COMPRESSED_TEXTURE_FORMATS, 0}, {GL_NAME_STACK_DEPTH, 0},
    {GL_MAX_NAME_STACK_DEPTH, 0}, {GL_MAX_EVAL_ORDER, kMostOrder}, {GL_SELECTION_BUFFER_SIZE, 0}, {GL_FEEDBACK_BUFFER_SIZE, 0},
    {GL_FEEDBACK_BUFFER_TYPE, 0}, {GL_MAX_LIGHTS, kLights}, {GL_MAX_CLIP_PLANES, kClipPlanes},
    {GL_MAX_MODELVIEW_STACK_DEPTH, kModelviewDepth}, {GL_MAX_PROJECTION_STACK_DEPTH, kProjectionDepth},
    {GL_MAX_TEXTURE_STACK_DEPTH, kTextureDepth}, {GL_MAX_ATTRIB_STACK_DEPTH, kAttribDepth},
    {GL_MAX_CLIENT_ATTRIB_STACK_DEPTH, kAttribDepth}, {GL_MAX_LIST_NESTING, kListDepth},
    {GL_MAX_TEXTURE_SIZE, kMostSize}, {GL_MAX_TEXTURE_UNITS, kTextureUnits},
    {GL_MAX_TEXTURE_LOD_BIAS, kTextureLevels - 1},
    {GL_MAX_PIXEL_MAP_TABLE, std::tuple_size_v<decltype(PixelMap::values)>}, {GL_MAX_ELEMENTS_VERTICES, 65536},
    {GL_MAX_ELEMENTS_INDICES, 65536}, {GL_POINT_SIZE_GRANULARITY, 0.125}, {GL_LINE_WIDTH_GRANULARITY, 0.125},
    {GL_CURRENT_INDEX, 1}, {GL_CURRENT_RASTER_INDEX, 1}};
// clang-format on

/// The values of glGet that are one number, are not converted as colors are, and are not found otherwise.
Results number_of(const Context& c, GLenum pname) {
  const State& s = c.state;
  const ClientState& client = c.client;
  const auto unit = std::size_t(s.texture.active);
  const ClientArray& texcoords = client.texcoords[std::size_t(client.active_texture)];
#define ARRAY(NAME, array)                                                    \
  {NAME##_ARRAY_TYPE, (array).type}, {NAME##_ARRAY_STRIDE, (array).stride}, { \
    NAME##_ARRAY_BUFFER_BINDING, name_of((array).buffer)                      \
  }
#define STORE(NAME, store)                                                              \
  {NAME##_SWAP_BYTES, (store).swap_bytes}, {NAME##_LSB_FIRST, (store).lsb_first},       \
      {NAME##_ROW_LENGTH, (store).row_length}, {NAME##_SKIP_ROWS, (store).skip_rows},   \
      {NAME##_SKIP_PIXELS, (store).skip_pixels}, {NAME##_ALIGNMENT, (store).alignment}, \
      {NAME##_IMAGE_HEIGHT, (store).image_height}, {                                    \
    NAME##_SKIP_IMAGES, (store).skip_images                                             \
  }
  // clang-format off
  const Row rows[] = {
      {GL_CURRENT_FOG_COORD, s.current.values[kFogCoord]}, {GL_EDGE_FLAG, s.current.values[kEdgeFlag]},
      {GL_CURRENT_RASTER_DISTANCE, s.current.raster.distance},
      {GL_CURRENT_RASTER_POSITION_VALID, s.current.raster.is_valid},
      // Client arrays and pixel stores.
      {GL_CLIENT_ACTIVE_TEXTURE, GL_TEXTURE0 + client.active_texture},
      {GL_ARRAY_BUFFER_BINDING, name_of(client.array_buffer)},
      {GL_ELEMENT_ARRAY_BUFFER_BINDING, name_of(client.element_buffer)}, ARRAY(GL_VERTEX, client.vertex),
      ARRAY(GL_COLOR, client.color), ARRAY(GL_SECONDARY_COLOR, client.secondary_color),
      ARRAY(GL_TEXTURE_COORD, texcoords), ARRAY(GL_NORMAL, client.normal), ARRAY(GL_INDEX, client.index),
      ARRAY(GL_FOG_COORDINATE, client.fog_coord), {GL_VERTEX_ARRAY_SIZE, client.vertex.size},
      {GL_COLOR_ARRAY_SIZE, client.color.size}, {GL_SECONDARY_COLOR_ARRAY_SIZE, client.secondary_color.size},
      {GL_TEXTURE_COORD_ARRAY_SIZE, texcoords.size}, {GL_EDGE_FLAG_ARRAY_STRIDE, client.edge_flag.stride},
      {GL_EDGE_FLAG_ARRAY_BUFFER_BINDING, name_of(client.edge_flag.buffer)}, STORE(GL_PACK, client.pack),
      STORE(GL_UNPACK, client.unpack),
      // Transform, light and primitives.
      {GL_MATRIX_MODE, s.transform.matrix_mode}, {GL_MODELVIEW_STACK_DEPTH, c.matrices.modelview.size()},
      {GL_PROJECTION_STACK_DEPTH, c.matrices.projection.size()},
      {GL_TEXTURE_STACK_DEPTH, c.matrices.texture[unit].size()}, {GL_SHADE_MODEL, s.lighting.shade_model},
      {GL_COLOR_MATERIAL_FACE, s.lighting.color_material_face},
      {GL_COLOR_MATERIAL_PARAMETER, s.lighting.color_material_mode},
      {GL_LIGHT_MODEL_LOCAL_VIEWER, s.lighting.local_viewer}, {GL_LIGHT_MODEL_TWO_SIDE, s.lighting.two_side},
      {GL_LIGHT_MODEL_COLOR_CONTROL, s.lighting.color_control}, {GL_FOG_MODE, s.fog.mode},
      {GL_FOG_COORD_SRC, s.fog.coord_source}, {GL_POINT_SIZE, s.point.size}, {GL_LINE_WIDTH, s.line.width},
      {GL_LINE_STIPPLE_PATTERN, s.line.stipple}, {GL_LINE_STIPPLE_REPEAT, s.line.stipple_factor},
      {GL_CULL_FACE_MODE, s.polygon.cull_face}, {GL_FRONT_FACE, s.polygon.front_face},
      {GL_POLYGON_OFFSET_FACTOR, s.polygon.offset_factor}, {GL_POLYGON_OFFSET_UNITS, s.polygon.offset_units},
      // Textures and fragments.
      {GL_ACTIVE_TEXTURE, GL_TEXTURE0 + s.texture.active},
      {GL_TEXTURE_BINDING_1D, s.texture.units[unit].bound[0]->name},
      {GL_TEXTURE_BINDING_2D, s.texture.units[unit].bound[1]->name}, {GL_ALPHA_TEST_FUNC, s.color.alpha_func},
      {GL_STENCIL_FUNC, s.stencil.func}, {GL_STENCIL_REF, s.stencil.ref},
      {GL_STENCIL_VALUE_MASK, GLint(s.stencil.value_mask)}, {GL_STENCIL_WRITEMASK, GLint(s.stencil.write_mask)},
      {GL_STENCIL_FAIL, s.stencil.fail}, {GL_STENCIL_PASS_DEPTH_FAIL, s.stencil.depth_fail},
      {GL_STENCIL_PASS_DEPTH_PASS, s.stencil.pass}, {GL_STENCIL_CLEAR_VALUE, s.stencil.clear},
      {GL_DEPTH_FUNC, s.depth.func}, {GL_DEPTH_WRITEMASK, s.depth.mask}, {GL_BLEND_SRC, s.color.source_rgb},
      {GL_BLEND_SRC_RGB, s.color.source_rgb}, {GL_BLEND_SRC_ALPHA, s.color.source_alpha},
      {GL_BLEND_DST, s.color.target_rgb}, {GL_BLEND_DST_RGB, s.color.target_rgb},
      {GL_BLEND_DST_ALPHA, s.color.target_alpha}, {GL_BLEND_EQUATION, s.color.equation_rgb},
      {GL_BLEND_EQUATION_ALPHA, s.color.equation_alpha}, {GL_LOGIC_OP_MODE, s.color.logic_op},
      {GL_DRAW_BUFFER, s.color.draw_buffer}, {GL_INDEX_CLEAR_VALUE, s.color.clear_index},
      {GL_INDEX_WRITEMASK, GLint(s.color.index_mask)},
      // Pixels.
      {GL_READ_BUFFER, s.pixel.read_buffer}, {GL_ZOOM_X, s.pixel.zoom_x}, {GL_ZOOM_Y, s.pixel.zoom_y},
      {GL_MAP_COLOR, s.pixel.map_color}, {GL_MAP_STENCIL, s.pixel.map_stencil}, {GL_INDEX_SHIFT, s.pixel.index_shift},
      {GL_INDEX_OFFSET, s.pixel.index_offset}, {GL_RED_SCALE, s.pixel.scale.r}, {GL_GREEN_SCALE, s.pixel.scale.g},
      {GL_BLUE_SCALE, s.pixel.scale.b}, {GL_ALPHA_SCALE, s.pixel.scale.a}, {GL_DEPTH_SCALE, s.pixel.depth_scale},
      {GL_RED_BIAS, s.pixel.bias.r}, {GL_GREEN_BIAS, s.pixel.bias.g}, {GL_BLUE_BIAS, s.pixel.bias.b},
      {GL_ALPHA_BIAS, s.pixel.bias.a}, {GL_DEPTH_BIAS, s.pixel.depth_bias},
      // Hints, lists and modes.
      {GL_PERSPECTIVE_CORRECTION_HINT, s.hint.perspective}, {GL_POINT_SMOOTH_HINT, s.hint.point},
      {GL_LINE_SMOOTH_HINT, s.hint.line}, {GL_POLYGON_SMOOTH_HINT, s.hint.polygon}, {GL_FOG_HINT, s.hint.fog},
      {GL_GENERATE_MIPMAP_HINT, s.hint.mipmap}, {GL_TEXTURE_COMPRESSION_HINT, s.hint.compression},
      {GL_LIST_BASE, s.list_base}, {GL_LIST_INDEX, c.list_name}, {GL_LIST_MODE, c.list ? c.list_mode : 0},
      {GL_RENDER_MODE, c.render_mode}, {GL_ATTRIB_STACK_DEPTH, c.saved.size()},
      {GL_CLIENT_ATTRIB_STACK_DEPTH, c.saved_client.size()}};
  // clang-format on
  for (const auto& [name, value] : rows)
    if (name == pname) return Results(value);
  for (const auto& [name, value] : kConstants)
    if (name == pname) return Results(value);
  if (pname >= GL_PIXEL_MAP_I_TO_I_SIZE && pname <= GL_PIXEL_MAP_A_TO_A_SIZE)
    return Results(c.pixel_maps[pname - GL_PIXEL_MAP_I_TO_I_SIZE].size);
  return {};
}

/// The values of glGet that are several numbers, or are converted as colors are.
Results numbers_of(const Context& c, GLenum pname) {
  const State& s = c.state;
  const float* const current = s.current.values.data();
  const auto unit = std::size_t(s.texture.active);
  switch (pname) {
    case GL_CURRENT_COLOR: return Results::of(current + kRed, 4).as_normalized();
    case GL_CURRENT_SECONDARY_COLOR: return color({current[kRed2], current[kGreen2], current[kBlue2], 1});
    case GL_CURRENT_NORMAL: return Results::of(current + kNormalX, 3).as_normalized();
    case GL_CURRENT_TEXTURE_COORDS: return Results::of(current + kTexCoord + 4 * s.texture.active, 4);
    case GL_CURRENT_RASTER_POSITION: return floats(s.current.raster.window);
    case GL_CURRENT_RASTER_COLOR: return color(s.current.raster.color);
    case GL_CURRENT_RASTER_SECONDARY_COLOR: return color(s.current.raster.secondary);
    case GL_CURRENT_RASTER_TEXTURE_COORDS: return floats(s.current.raster.texcoords[unit]);
    case GL_MODELVIEW_MATRIX: return matrix(c.matrices.modelview);
    case GL_PROJECTION_MATRIX: return matrix(c.matrices.projection);
    case GL_TEXTURE_MATRIX: return matrix(c.matrices.texture[unit]);
    case GL_TRANSPOSE_MODELVIEW_MATRIX: return matrix(c.matrices.modelview, true);
    case GL_TRANSPOSE_PROJECTION_MATRIX: return matrix(c.matrices.projection, true);
    case GL_TRANSPOSE_TEXTURE_MATRIX: return matrix(c.matrices.texture[unit], true);
    case GL_MAP1_GRID_DOMAIN: return Results::of(s.grid[0].domain[0].data(), 2);
    case GL_MAP2_GRID_DOMAIN: return Results::of(s.grid[1].domain[0].data(), 4);
    case GL_MAP1_GRID_SEGMENTS: return Results(s.grid[0].segments[0]);
    case GL_MAP2_GRID_SEGMENTS: return Results(s.grid[1].segments[0], s.grid[1].segments[1]);
    case GL_VIEWPORT: return rect(s.viewport.rect);
    case GL_DEPTH_RANGE: return Results(s.viewport.near, s.viewport.far).as_normalized();
    case GL_DEPTH_CLEAR_VALUE: return Results(s.depth.clear).as_normalized();
    case GL_LIGHT_MODEL_AMBIENT: return color(s.lighting.model_ambient);
    case GL_POLYGON_MODE: return Results(s.polygon.mode[0], s.polygon.mode[1]);
    case GL_SCISSOR_BOX: return rect(s.scissor);
    case GL_ALPHA_TEST_REF: return Results(s.color.alpha_ref).as_normalized();
    case GL_BLEND_COLOR: return color(s.color.blend_color);
    case GL_COLOR_WRITEMASK: return Results::of(s.color.mask.data(), 4);
    case GL_COLOR_CLEAR_VALUE: return color(s.color.clear);
    case GL_ACCUM_CLEAR_VALUE: return color(glm::vec4(0));
    case GL_COMPRESSED_TEXTURE_FORMATS: return Results::of<int>(nullptr, 0);
    case GL_MAX_VIEWPORT_DIMS: return Results(kMostViewport, kMostViewport);
    case GL_POINT_SIZE_RANGE:
    case GL_LINE_WIDTH_RANGE:
    case GL_ALIASED_POINT_SIZE_RANGE:
    case GL_ALIASED_LINE_WIDTH_RANGE: return Results(1, 255);
    default: return number_of(c, pname);
  }
}

/// Reads a parameter that parameter_of() finds.
template <class StateGroup>
Results parameter(const StateGroup& group, GLenum pname) {
  StateGroup copy = group;
  const float* const values = parameter_of(copy, pname);
  if (!values) return {};
  const Results r = Results::of(values, count_of(pname));
  return is_color(pname) ? r.as_normalized() : r;
}

Results any_value(Context& c, GLenum pname) {
  if (const auto capability = capability_of(pname)) return Results(c.state.capabilities.has(*capability));
  if (const bool* on = switch_of(c.state.texture.units[std::size_t(c.state.texture.active)], pname))
    return Results(*on);
  if (const ClientArray* array = array_of(c.client, pname)) return Results(array->is_enabled);
  if (is_refused_capability(pname)) return Results(false);
  if (const Results fog = parameter(c.state.fog, pname); fog.count > 0) return fog;
  if (const Results point = parameter(c.state.point, pname); point.count > 0) return point;
  return numbers_of(c, pname);
}

Results light_value(const Context& c, GLenum light, GLenum pname) {
  return light - GL_LIGHT0 < GLenum(kLights) ? parameter(c.state.lighting.lights[light - GL_LIGHT0], pname) : Results();
}

Results material_value(const Context& c, GLenum face, GLenum pname) {
  return is_one_of(face, GL_FRONT, GL_BACK) ? parameter(c.state.lighting.materials[face == GL_BACK], pname) : Results();
}

Results environment(const Context& c, GLenum target, GLenum pname) {
  TextureUnitState unit = c.state.texture.units[std::size_t(c.state.texture.active)];
  if (target == GL_TEXTURE_FILTER_CONTROL && pname == GL_TEXTURE_LOD_BIAS) return Results(unit.lod_bias);
  if (target != GL_TEXTURE_ENV) return {};
  if (pname == GL_TEXTURE_ENV_COLOR) return color(unit.env_color);
  if (pname == GL_RGB_SCALE) return Results(unit.combine.rgb_scale);
  if (pname == GL_ALPHA_SCALE) return Results(unit.combine.alpha_scale);
  const GLenum* const value = environment_value(unit, pname, 0).first;
  return value ? Results(*value) : Results();
}

Results generation(const Context& c, GLenum coordinate, GLenum pname) {
  if (coordinate - GL_S > 3) return {};
  const TexGenState& gen = c.state.texture.units[std::size_t(c.state.texture.active)].generated[coordinate - GL_S];
  if (pname == GL_TEXTURE_GEN_MODE) return Results(gen.mode);
  return pname == GL_OBJECT_PLANE ? floats(gen.object_plane)
         : pname == GL_EYE_PLANE  ? floats(gen.eye_plane)
                                  : Results();
}

/// Writes what `find` returns for the names; an unknown name is an error.
template <auto find, class T, class... Names>
void get(T* to, Names... names) {
  client_call([=](Context& c) {
    const Results found = find(c, names...);
    if (found.count < 0) return c.fail(GL_INVALID_ENUM);
    found.write(to);
  });
}

/// Whether an object has the name. Names that glGen... gave out have none before they are bound.
template <class Objects>
GLboolean is_used(const Objects& objects, GLuint name) {
  const auto found = objects.find(name);
  return found != objects.end() && found->second;
}

}  // namespace

#define GETTER(entry, T, find) \
  FRONTMOST_GL void entry(GLenum target, GLenum pname, T* values) { get<find>(values, target, pname); }
GETTER(glGetLightfv, GLfloat, light_value)
GETTER(glGetLightiv, GLint, light_value)
GETTER(glGetMaterialfv, GLfloat, material_value)
GETTER(glGetMaterialiv, GLint, material_value)
GETTER(glGetTexEnvfv, GLfloat, environment)
GETTER(glGetTexEnviv, GLint, environment)
GETTER(glGetTexGenfv, GLfloat, generation)
GETTER(glGetTexGeniv, GLint, generation)
GETTER(glGetTexGendv, GLdouble, generation)
FRONTMOST_GL void glGetBooleanv(GLenum pname, GLboolean* values) { get<any_value>(values, pname); }
FRONTMOST_GL void glGetIntegerv(GLenum pname, GLint* values) { get<any_value>(values, pname); }
FRONTMOST_GL void glGetFloatv(GLenum pname, GLfloat* values) { get<any_value>(values, pname); }
FRONTMOST_GL void glGetDoublev(GLenum pname, GLdouble* values) { get<any_value>(values, pname); }

FRONTMOST_GL void glGetClipPlane(GLenum plane, GLdouble* equation) {
  get<[](Context& c, GLenum name) {
    const GLenum i = name - GL_CLIP_PLANE0;
    return i < GLenum(kClipPlanes) ? floats(c.state.transform.clip_planes[i]) : Results();
  }>(equation, plane);
}

FRONTMOST_GL void glGetPointerv(GLenum pname, GLvoid** to) {
  client_call([=](Context& c) {
    const bool is_none = is_one_of(pname, GL_SELECTION_BUFFER_POINTER, GL_FEEDBACK_BUFFER_POINTER);
    // Pointers follow one another as the arrays do, but for those of fog coordinates and secondary colors.
    const GLenum array = pname == GL_FOG_COORDINATE_ARRAY_POINTER    ? GL_FOG_COORDINATE_ARRAY
                         : pname == GL_SECONDARY_COLOR_ARRAY_POINTER ? GL_SECONDARY_COLOR_ARRAY
                         : pname >= GL_VERTEX_ARRAY_POINTER && pname <= GL_EDGE_FLAG_ARRAY_POINTER
                             ? pname - GL_VERTEX_ARRAY_POINTER + GL_VERTEX_ARRAY
                             : 0;
    const ClientArray* const found = array_of(c.client, array);
    if (!found && !is_none) return c.fail(GL_INVALID_ENUM);
    if (to) *to = found ? const_cast<void*>(found->pointer) : nullptr;
  });
}

FRONTMOST_GL_ALIAS(glGetPointervEXT, glGetPointerv);

FRONTMOST_GL void glGetPolygonStipple(GLubyte* mask) {
  client_call([=](Context& c) {
    const PixelStore& store = c.client.pack;
    const auto layout = image_layout(store, {32, 32, GL_COLOR_INDEX, GL_BITMAP});
    for (std::size_t y = 0; mask && layout && y < 32; ++y)
      for (std::size_t x = 0; x < 32; ++x) {
        const std::size_t bit = std::size_t(layout->first_bit) + x;
        GLubyte& byte = mask[layout->first + y * layout->row_bytes + bit / 8];
        const int place = store.lsb_first ? int(bit % 8) : 7 - int(bit % 8);
        const int value = int(c.state.polygon_stipple.rows[y] >> (31 - x) & 1);
        byte = GLubyte((byte & ~(1 << place)) | value << place);
      }
  });
}

FRONTMOST_GL const GLubyte* glGetString(GLenum name) {
  return client_call([=](Context& c) -> const GLubyte* {
    const char* text = nullptr;
    switch (name) {
      case GL_VENDOR:
      case GL_RENDERER: text = "Frontmost"; break;
      case GL_VERSION: text = "1.1 Frontmost"; break;
      case GL_EXTENSIONS: text = kExtensions; break;
      default: c.fail(GL_INVALID_ENUM);
    }
    return reinterpret_cast<const GLubyte*>(text);
  });
}

FRONTMOST_GL GLenum glGetError() {
  return client_call([](Context& c) { return c.take_error(); });
}

FRONTMOST_GL GLboolean glIsTexture(GLuint name) {
  return client_call([=](Context& c) { return is_used(c.shared->textures, name); });
}
FRONTMOST_GL GLboolean glIsBuffer(GLuint name) {
  return client_call([=](Context& c) { return is_used(c.shared->buffers, name); });
}
FRONTMOST_GL_ALIAS(glIsTextureEXT, glIsTexture);
FRONTMOST_GL_ALIAS(glIsBufferARB, glIsBuffer);

}  // namespace frontmost::gl_detail
