// SPDX-License-Identifier: Apache-2.0
#include "state/capabilities.h"

namespace frontmost::gl_detail {
namespace {

struct CapabilityRow {
  GLenum name;
  Capability capability;
  GLbitfield group;  ///< beside GL_ENABLE_BIT
  int repeats = 1;   ///< how many follow one another, such as GL_LIGHT0 to GL_LIGHT7
};

constexpr CapabilityRow kRows[] = {
    {GL_ALPHA_TEST, Capability::alpha_test, GL_COLOR_BUFFER_BIT},
    {GL_AUTO_NORMAL, Capability::auto_normal, GL_EVAL_BIT},
    {GL_BLEND, Capability::blend, GL_COLOR_BUFFER_BIT},
    {GL_CLIP_PLANE0, Capability::clip_plane0, GL_TRANSFORM_BIT, kClipPlanes},
    {GL_COLOR_LOGIC_OP, Capability::color_logic_op, GL_COLOR_BUFFER_BIT},
    {GL_COLOR_MATERIAL, Capability::color_material, GL_LIGHTING_BIT},
    {GL_COLOR_SUM, Capability::color_sum, GL_FOG_BIT},
    {GL_CULL_FACE, Capability::cull_face, GL_POLYGON_BIT},
    {GL_DEPTH_TEST, Capability::depth_test, GL_DEPTH_BUFFER_BIT},
    {GL_DITHER, Capability::dither, GL_COLOR_BUFFER_BIT},
    {GL_FOG, Capability::fog, GL_FOG_BIT},
    {GL_INDEX_LOGIC_OP, Capability::index_logic_op, GL_COLOR_BUFFER_BIT},
    {GL_LIGHT0, Capability::light0, GL_LIGHTING_BIT, kLights},
    {GL_LIGHTING, Capability::lighting, GL_LIGHTING_BIT},
    {GL_LINE_SMOOTH, Capability::line_smooth, GL_LINE_BIT},
    {GL_LINE_STIPPLE, Capability::line_stipple, GL_LINE_BIT},
    {GL_MAP1_COLOR_4, Capability::map1, GL_EVAL_BIT, kMaps},
    {GL_MAP2_COLOR_4, Capability::map2, GL_EVAL_BIT, kMaps},
    {GL_MULTISAMPLE, Capability::multisample, GL_MULTISAMPLE_BIT},
    {GL_NORMALIZE, Capability::normalize, GL_TRANSFORM_BIT},
    {GL_POINT_SMOOTH, Capability::point_smooth, GL_POINT_BIT},
    {GL_POLYGON_OFFSET_FILL, Capability::polygon_offset_fill, GL_POLYGON_BIT},
    {GL_POLYGON_OFFSET_LINE, Capability::polygon_offset_line, GL_POLYGON_BIT},
    {GL_POLYGON_OFFSET_POINT, Capability::polygon_offset_point, GL_POLYGON_BIT},
    {GL_POLYGON_SMOOTH, Capability::polygon_smooth, GL_POLYGON_BIT},
    {GL_POLYGON_STIPPLE, Capability::polygon_stipple, GL_POLYGON_BIT},
    {GL_RESCALE_NORMAL, Capability::rescale_normal, GL_TRANSFORM_BIT},
    {GL_SCISSOR_TEST, Capability::scissor_test, GL_SCISSOR_BIT},
    {GL_STENCIL_TEST, Capability::stencil_test, GL_STENCIL_BUFFER_BIT},
};

/// First and last names of capabilities that are not offered.
constexpr GLenum kRefused[][2] = {
    {GL_TEXTURE_3D, GL_TEXTURE_3D},
    {GL_TEXTURE_CUBE_MAP, GL_TEXTURE_CUBE_MAP},
    {GL_SAMPLE_ALPHA_TO_COVERAGE, GL_SAMPLE_COVERAGE},
    {GL_CONVOLUTION_1D, GL_SEPARABLE_2D},
    {GL_HISTOGRAM, GL_HISTOGRAM},
    {GL_MINMAX, GL_MINMAX},
    {GL_COLOR_TABLE, GL_POST_COLOR_MATRIX_COLOR_TABLE},
};

}  // namespace

std::optional<Capability> capability_of(GLenum name) {
  for (const CapabilityRow& row : kRows)
    if (const GLenum i = name - row.name; i < GLenum(row.repeats)) return Capability(GLenum(row.capability) + i);
  return std::nullopt;
}

bool* switch_of(TextureUnitState& unit, GLenum name) {
  switch (name) {
    case GL_TEXTURE_1D: return &unit.is_enabled[0];
    case GL_TEXTURE_2D: return &unit.is_enabled[1];
    case GL_TEXTURE_GEN_S: return &unit.generates[0];
    case GL_TEXTURE_GEN_T: return &unit.generates[1];
    case GL_TEXTURE_GEN_R: return &unit.generates[2];
    case GL_TEXTURE_GEN_Q: return &unit.generates[3];
    default: return nullptr;
  }
}

ClientArray* array_of(ClientState& client, GLenum name) {
  switch (name) {
    case GL_VERTEX_ARRAY: return &client.vertex;
    case GL_NORMAL_ARRAY: return &client.normal;
    case GL_COLOR_ARRAY: return &client.color;
    case GL_SECONDARY_COLOR_ARRAY: return &client.secondary_color;
    case GL_FOG_COORD_ARRAY: return &client.fog_coord;
    case GL_EDGE_FLAG_ARRAY: return &client.edge_flag;
    case GL_INDEX_ARRAY: return &client.index;
    case GL_TEXTURE_COORD_ARRAY: return &client.texcoords[std::size_t(client.active_texture)];
    default: return nullptr;
  }
}

bool is_refused_capability(GLenum name) {
  for (const auto& [first, last] : kRefused)
    if (name >= first && name <= last) return true;
  return false;
}

std::uint64_t capabilities_in(GLbitfield groups) {
  std::uint64_t bits = 0;
  for (const CapabilityRow& row : kRows)
    if ((groups & (row.group | GL_ENABLE_BIT)) != 0)
      bits |= ((std::uint64_t(1) << row.repeats) - 1) << unsigned(row.capability);
  return bits;
}

}  // namespace frontmost::gl_detail
