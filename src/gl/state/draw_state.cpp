// SPDX-License-Identifier: Apache-2.0
#include "state/draw_state.h"

#include <algorithm>

namespace frontmost::gl_detail {
namespace {

[[nodiscard]] bool has_mipmaps(GLenum filter) { return filter != GL_NEAREST && filter != GL_LINEAR; }

/// The number of levels that sampling uses, or 0 if the texture is incomplete.
[[nodiscard]] int usable_levels(const TextureObject& t) {
  if (t.base_level < 0 || t.base_level >= kTextureLevels || t.base_level > t.max_level) return 0;
  const TextureLevel& base = t.levels[std::size_t(t.base_level)];
  if (base.width == 0 || base.height == 0) return 0;
  if (!has_mipmaps(t.min_filter)) return 1;
  int width = base.width, height = base.height, levels = 1;
  for (; (width > 1 || height > 1) && t.base_level + levels <= t.max_level; ++levels) {
    width = std::max(width / 2, 1);
    height = std::max(height / 2, 1);
    if (t.base_level + levels >= kTextureLevels) return 0;
    const TextureLevel& level = t.levels[std::size_t(t.base_level + levels)];
    if (level.width != width || level.height != height || level.border != base.border ||
        level.internal_format != base.internal_format)
      return 0;
  }
  return levels;
}

/// The border's color with the components of the base format, as texels have them: luminance is red.
[[nodiscard]] std::uint32_t border_of(const TextureObject& t, GLenum format) {
  std::uint32_t word = 0;
  for (int k = 0; k < 4; ++k) {
    const bool is_red = format == GL_INTENSITY || (k < 3 && format != GL_RGB && format != GL_RGBA);
    word |= std::uint32_t(std::clamp(t.border_color[is_red ? 0 : k], 0.0f, 1.0f) * 255 + 0.5f) << (8 * k);
  }
  if (format == GL_RGB || format == GL_LUMINANCE) word |= 0xFF000000;
  return format == GL_ALPHA ? word & 0xFF000000 : word;
}

/// The levels from the base level on, packed again only if something changed.
[[nodiscard]] std::shared_ptr<const PackedTexture> packed(TextureObject& t, int levels, bool is_1d) {
  const auto level = [&](int i) -> const TextureLevel& { return t.levels[std::size_t(t.base_level + i)]; };
  const std::uint32_t border = border_of(t, level(0).base_format);
  const std::tuple key(t.wrap_s, t.wrap_t, border);
  bool is_same = t.packed && t.packed->sources.size() == std::size_t(levels) && t.packed->key == key;
  for (int i = 0; is_same && i < levels; ++i) is_same = t.packed->sources[std::size_t(i)] == level(i).texels;
  if (is_same) return t.packed;
  auto packed = std::make_shared<PackedTexture>();
  for (int i = 0; i < levels; ++i) packed->sources.push_back(level(i).texels);
  packed->key = key;
  const int b = level(0).border;
  constexpr int kOutside = -2;
  // The texel that is seen at texel i of an axis, which may be outside.
  const auto seen = [&](int i, int size, GLenum mode) {
    if (mode == GL_REPEAT) return (i + size) % size;
    const bool sees_border = mode == GL_CLAMP || mode == GL_CLAMP_TO_BORDER;
    const int inside = std::clamp(i, 0, size - 1);
    return !sees_border || i == inside ? inside : b != 0 ? i : kOutside;
  };
  for (int i = 0; i < levels; ++i) {
    const TextureLevel& from = level(i);
    const int w = packed->width[i] = from.width, h = packed->height[i] = from.height;
    packed->first[i] = std::int32_t(packed->texels.size()) + w + 3;
    const int left = seen(-1, w, t.wrap_s), right = seen(w, w, t.wrap_s);
    for (int y = -1; y <= h; ++y) {
      const int row = is_1d ? -b : seen(y, h, t.wrap_t);
      if (row == kOutside) {
        packed->texels.insert(packed->texels.end(), std::size_t(w + 2), border);
        continue;
      }
      const std::uint32_t* const texels = from.texels->data() + std::ptrdiff_t(row + b) * (w + 2 * b) + b;
      packed->texels.push_back(left == kOutside ? border : texels[left]);
      packed->texels.insert(packed->texels.end(), texels, texels + w);
      packed->texels.push_back(right == kOutside ? border : texels[right]);
    }
  }
  // Texels of weight 0 are read, too: those around the last row and column.
  packed->texels.resize(packed->texels.size() + std::size_t(packed->width[0]) + 3);
  t.packed = packed;
  return packed;
}

[[nodiscard]] std::optional<BoundTexture> texture_of(const TextureUnitState& unit, int number) {
  const int target = unit.is_enabled[1] ? 1 : unit.is_enabled[0] ? 0 : -1;
  if (target < 0 || !unit.bound[target]) return std::nullopt;
  TextureObject& t = *unit.bound[target];
  const int levels = usable_levels(t);
  if (levels == 0) return std::nullopt;
  const GLenum min = t.min_filter;
  const GLenum format = t.levels[std::size_t(t.base_level)].base_format;
  return BoundTexture{t,
                      packed(t, levels, target == 0),
                      format,
                      unit.lod_bias,
                      number,
                      target == 0,
                      levels,
                      has_mipmaps(min),
                      min == GL_LINEAR || min == GL_LINEAR_MIPMAP_NEAREST || min == GL_LINEAR_MIPMAP_LINEAR,
                      min == GL_NEAREST_MIPMAP_LINEAR || min == GL_LINEAR_MIPMAP_LINEAR,
                      t.mag_filter == GL_LINEAR};
}

[[nodiscard]] DrawBounds common(const DrawBounds& a, const WindowRect& r) {
  const auto last = [](int first, int size) {
    return int(std::clamp<std::int64_t>(std::int64_t(first) + size - 1, -1, 1 << 20));
  };
  return {std::max(a.x0, r.x), std::max(a.y0, r.y), std::min(a.x1, last(r.x, r.width)),
          std::min(a.y1, last(r.y, r.height))};
}

void set_vertex_rules(DrawState& d, const MatrixStacks& matrices, const Frame& frame) {
  const State& s = d.state;
  const Capabilities& on = s.capabilities;
  const glm::dmat4& eye = matrices.modelview.back();
  d.eye_from_object = glm::mat4(eye);
  d.clip_from_object = glm::mat4(matrices.projection.back() * eye);
  // The inverse transpose of a 3 x 3 matrix is the matrix of its cofactors divided by the determinant. A singular
  // matrix leaves the cofactors, whose directions are right where they have any.
  const glm::dvec3 a(eye[0]), b(eye[1]), c(eye[2]);
  const glm::dmat3 cofactors(glm::cross(b, c), glm::cross(c, a), glm::cross(a, b));
  const double determinant = glm::dot(a, cofactors[0]);
  glm::dmat3 normal = determinant != 0 ? cofactors / determinant : cofactors;
  if (on.has(Capability::rescale_normal)) {
    const double length = std::sqrt(glm::dot(normal[2], normal[2]));
    if (length > 0) normal /= length;
  }
  d.normal_matrix = glm::mat3(normal);

  d.is_lit = on.has(Capability::lighting);
  d.is_two_sided = d.is_lit && s.lighting.two_side;
  d.has_secondary = d.is_lit ? s.lighting.color_control == GL_SEPARATE_SPECULAR_COLOR : on.has(Capability::color_sum);
  d.has_fog = on.has(Capability::fog);
  d.clip_planes = int(on.bits() >> unsigned(Capability::clip_plane0) & ((1 << kClipPlanes) - 1));
  d.needs_normal = d.is_lit;
  d.needs_eye = d.is_lit || d.has_fog || d.clip_planes != 0;
  for (const BoundTexture& t : d.textures) {
    const TextureUnitState& unit = s.texture.units[std::size_t(t.unit)];
    const glm::dmat4& matrix = matrices.texture[std::size_t(t.unit)].back();
    d.texture_matrix[std::size_t(t.unit)] = glm::mat4(matrix);
    d.has_texture_matrix[std::size_t(t.unit)] = matrix != glm::dmat4(1);
    for (int k = 0; k < 4; ++k)
      if (unit.generates[k] && unit.generated[k].mode != GL_OBJECT_LINEAR) {
        d.needs_eye = true;
        if (unit.generated[k].mode != GL_EYE_LINEAR) d.needs_normal = true;
      }
  }

  const auto add = [&](int first, int count) {
    for (int k = 0; k < count; ++k) d.inputs.push_back(first + k);
  };
  if (d.needs_normal) add(kNormalX, 3);
  add(kRed, 4);
  if (d.has_secondary && !d.is_lit) add(kRed2, 3);
  if (d.has_fog && s.fog.coord_source == GL_FOG_COORDINATE) add(kFogCoord, 1);
  for (const BoundTexture& t : d.textures) add(kTexCoord + 4 * t.unit, 4);
  const bool unfilled = s.polygon.mode[0] != GL_FILL || s.polygon.mode[1] != GL_FILL;
  if (unfilled) add(kEdgeFlag, 1);

  const WindowRect& v = s.viewport.rect;
  const double near = s.viewport.near, far = s.viewport.far;
  d.window_scale = {float(v.width * 128.0), float(v.height * 128.0), float((far - near) / 2), 0};
  d.window_offset = {float(v.x * 256.0 + v.width * 128.0), float(v.y * 256.0 + v.height * 128.0),
                     float((far + near) / 2), 0};
  // Places may reach this many 1/256 pixels beyond the frame: the zbuffer's edges allow extents of 2^22.
  const double room = std::min((16384.0 - std::max(frame.width, frame.height)) / 2, 2048.0) * 256;
  const auto plane = [&](int axis, double sign, double at) {
    // sign * (place - at) >= 0, times w.
    glm::dvec4 p(0);
    p[axis] = sign * double(d.window_scale[axis]);
    p.w = sign * (double(d.window_offset[axis]) - at);
    return glm::vec4(p);
  };
  d.guard = {plane(0, 1, -room), plane(0, -1, frame.width * 256.0 + room), plane(1, 1, -room),
             plane(1, -1, frame.height * 256.0 + room)};
}

void set_fragment_rules(DrawState& d, const Frame& frame) {
  const State& s = d.state;
  const Capabilities& on = s.capabilities;
  d.scissor = {0, 0, frame.width - 1, frame.height - 1};
  if (on.has(Capability::scissor_test)) d.scissor = common(d.scissor, s.scissor);
  d.viewport = common(d.scissor, s.viewport.rect);
  const bool culls = on.has(Capability::cull_face);
  d.culls_all = culls && s.polygon.cull_face == GL_FRONT_AND_BACK;
  // Frontmost's front is clockwise in a window whose rows go up.
  const bool culls_clockwise = (s.polygon.cull_face == GL_BACK) == (s.polygon.front_face == GL_CCW);
  d.culling = !culls ? Culling::none : culls_clockwise ? Culling::front : Culling::back;
  d.color_mask = 0;
  if (s.color.draw_buffer != GL_NONE)
    for (int k = 0; k < 4; ++k) d.color_mask |= s.color.mask[std::size_t(k)] ? 0xFFu << (8 * k) : 0;
  d.tests_depth = on.has(Capability::depth_test);
  d.writes_depth = d.tests_depth && s.depth.mask;
  d.tests_stencil = on.has(Capability::stencil_test);
  d.tests_alpha = on.has(Capability::alpha_test) && s.color.alpha_func != GL_ALWAYS;
  d.blends = on.has(Capability::blend) && !on.has(Capability::color_logic_op);
  d.adds_secondary = d.has_secondary;
  d.grid.width = frame.width;
  d.grid.height = frame.height;

  const auto vary = [&](int first, int count) {
    for (int k = 0; k < count; ++k) d.varyings.push_back(first + k);
  };
  vary(kOutRed, d.has_secondary ? 7 : 4);
  if (d.has_fog) vary(kOutFog, 1);
  for (const BoundTexture& t : d.textures) vary(kOutTexCoord + 3 * t.unit, 3);
}

}  // namespace

std::shared_ptr<const DrawState> snapshot(const DrawInput& input) {
  auto draw = std::make_shared<DrawState>();
  DrawState& d = *draw;
  d.state = input.state;
  d.state.point.size = std::clamp(d.state.point.size, 1.0f, kMostWidth);
  d.state.line.width = std::clamp(d.state.line.width, 1.0f, kMostWidth);
  for (int unit = 0; unit < kTextureUnits; ++unit)
    if (auto texture = texture_of(input.state.texture.units[std::size_t(unit)], unit))
      d.textures.push_back(std::move(*texture));
  set_vertex_rules(d, input.matrices, input.frame);
  set_fragment_rules(d, input.frame);
  return draw;
}

}  // namespace frontmost::gl_detail
