// SPDX-License-Identifier: Apache-2.0
// Texture objects, their parameters and their images.

#include <algorithm>
#include <bit>
#include <cstring>

#include "calls/call.h"
#include "calls/names.h"
#include "calls/pixels.h"
#include "calls/values.h"
#include "pixels/pack.h"
#include "pixels/unpack.h"

namespace frontmost::gl_detail {
namespace {

/// Storage of texels of a base format: texel = red * repeat | (pixel & keep) | fill. glGetTexImage reads
/// pixel = (texel & shown) | shown_fill.
struct BaseFormat {
  GLenum name;
  std::uint32_t repeat, keep, fill, shown, shown_fill;
  GLenum first, last;            ///< internal formats that follow one another
  std::array<GLenum, 4> others;  ///< further internal formats
};

constexpr std::uint32_t kOpaque = 0xFF000000, kEvery = 0xFFFFFFFF;
// clang-format off
constexpr BaseFormat kBaseFormats[] = {
    {GL_ALPHA, 0, kOpaque, 0, kOpaque, 0, GL_ALPHA4, GL_ALPHA16, {GL_ALPHA, GL_COMPRESSED_ALPHA}},
    {GL_LUMINANCE, 0x010101, 0, kOpaque, 0xFF, kOpaque, GL_LUMINANCE4, GL_LUMINANCE16,
     {1, GL_LUMINANCE, GL_COMPRESSED_LUMINANCE}},
    {GL_LUMINANCE_ALPHA, 0x010101, kOpaque, 0, kOpaque | 0xFF, 0, GL_LUMINANCE4_ALPHA4, GL_LUMINANCE16_ALPHA16,
     {2, GL_LUMINANCE_ALPHA, GL_COMPRESSED_LUMINANCE_ALPHA}},
    {GL_INTENSITY, 0x01010101, 0, 0, 0xFF, kOpaque, GL_INTENSITY, GL_INTENSITY16, {GL_COMPRESSED_INTENSITY}},
    {GL_RGB, 0, ~kOpaque, kOpaque, ~kOpaque, kOpaque, GL_RGB2_EXT, GL_RGB16, {3, GL_RGB, GL_R3_G3_B2, GL_COMPRESSED_RGB}},
    {GL_RGBA, 0, kEvery, 0, kEvery, 0, GL_RGBA2, GL_RGBA16, {4, GL_RGBA, GL_COMPRESSED_RGBA}}};
// clang-format on

/// \returns null for other names.
const BaseFormat* base_format(GLenum name) {
  for (const BaseFormat& f : kBaseFormats)
    if (f.name == name) return &f;
  return nullptr;
}

/// \returns the base format of an internal format, 0 if there is none.
GLenum base_of(GLenum internal_format) {
  for (const BaseFormat& f : kBaseFormats) {
    const bool is_other = std::find(f.others.begin(), f.others.end(), internal_format) != f.others.end();
    if (internal_format != 0 && (is_other || (internal_format >= f.first && internal_format <= f.last))) return f.name;
  }
  return 0;
}

/// 0 for GL_TEXTURE_1D, 1 for GL_TEXTURE_2D, -1 for others.
int dimension_of(GLenum target) { return target == GL_TEXTURE_1D ? 0 : target == GL_TEXTURE_2D ? 1 : -1; }
bool is_proxy(GLenum target) { return is_one_of(target, GL_PROXY_TEXTURE_1D, GL_PROXY_TEXTURE_2D); }

/// The texture that the active unit has at the target, or a proxy, if `may_be_proxy`; null for other targets, with
/// GL_INVALID_ENUM.
TextureObject* texture_at(Context& c, GLenum target, bool may_be_proxy = false) {
  if (may_be_proxy && is_proxy(target)) return &c.proxies[target == GL_PROXY_TEXTURE_2D];
  const int i = dimension_of(target);
  if (i >= 0) return c.state.texture.units[std::size_t(c.state.texture.active)].bound[i].get();
  c.fail(GL_INVALID_ENUM);
  return nullptr;
}

// ---- Texels.

/// A rectangle of a level; x and y are from the first texel without the border.
struct TexelPlace {
  int level, x = 0, y = 0, width, height;
};

/// Makes the levels above the base level. Each texel is the mean of four, rounded to the nearest.
[[nodiscard]] bool make_mipmap(TextureObject& t) {
  const int last = std::min(t.max_level, kTextureLevels - 1);
  for (int i = t.base_level; i < last; ++i) {
    const TextureLevel& from = t.levels[std::size_t(i)];
    if (from.width * from.height <= 1 || !from.texels) break;
    TextureLevel to = from;
    const int b = from.border;
    to.width = std::max(from.width / 2, 1);
    to.height = std::max(from.height / 2, 1);
    const std::size_t from_stride = std::size_t(from.width + 2 * b), to_stride = std::size_t(to.width + 2 * b);
    auto texels = allocated<std::uint32_t>(to_stride * std::size_t(to.height + 2 * b));
    if (!texels) return false;
    // Border texels have sources in the border, which are repeated as those of a row or column that is not halved.
    const auto source = [b](int at, int k, int size, int from_size) {
      return std::size_t(b + (at < 0 ? -1 : at >= size ? from_size : from_size > 1 ? 2 * at + k : at));
    };
    for (int y = -b; y < to.height + b; ++y) {
      const std::uint32_t* const low = from.texels->data() + source(y, 0, to.height, from.height) * from_stride;
      const std::uint32_t* const high = from.texels->data() + source(y, 1, to.height, from.height) * from_stride;
      std::uint32_t* const row = texels->data() + std::size_t(y + b) * to_stride;
      for (int x = -b; x < to.width + b; ++x) {
        const std::size_t l = source(x, 0, to.width, from.width), r = source(x, 1, to.width, from.width);
        std::uint32_t mean = 0;
        for (int shift = 0; shift < 32; shift += 8) {
          const auto part = [shift](std::uint32_t word) { return word >> shift & 0xFF; };
          mean |= (part(low[l]) + part(low[r]) + part(high[l]) + part(high[r]) + 2) / 4 << shift;
        }
        row[x + b] = mean;
      }
    }
    to.texels = std::make_shared<std::vector<std::uint32_t>>(std::move(*texels));
    t.levels[std::size_t(i + 1)] = std::move(to);
  }
  return true;
}

/// Writes pixels into a level, and the levels that are made from it. Batches keep the texels that they were given.
void write_texels(Context& c, TextureObject& t, const TexelPlace& place, const std::vector<std::uint32_t>& pixels) {
  TextureLevel& level = t.levels[std::size_t(place.level)];
  if (level.texels && !pixels.empty()) {
    if (level.texels.use_count() > 1) {
      auto copy = allocated<std::uint32_t>(level.texels->size());
      if (!copy) return c.fail(GL_OUT_OF_MEMORY);
      *copy = *level.texels;
      level.texels = std::make_shared<std::vector<std::uint32_t>>(std::move(*copy));
    }
    const BaseFormat& f = *base_format(level.base_format);
    const int b = level.border;
    // The rows of a texture of one dimension are all the same.
    const bool is_1d = t.target == GL_TEXTURE_1D;
    const int rows = is_1d ? 1 + 2 * b : place.height;
    for (int y = 0; y < rows; ++y) {
      const std::uint32_t* const from = pixels.data() + (is_1d ? 0 : std::size_t(y) * std::size_t(place.width));
      std::uint32_t* const to = level.texels->data() +
                                std::size_t(level.width + 2 * b) * std::size_t(is_1d ? y : place.y + b + y) +
                                std::size_t(place.x + b);
      for (std::size_t x = 0; x < std::size_t(place.width); ++x) {
        to[x] = (from[x] & 0xFF) * f.repeat | (from[x] & f.keep) | f.fill;
      }
    }
  }
  if (t.generate_mipmap && place.level == t.base_level && !make_mipmap(t)) c.fail(GL_OUT_OF_MEMORY);
}

// ---- Whole images and parts.

/// Parameters of glTexImage and glCopyTexImage that describe a level. Sizes include the border.
struct LevelShape {
  GLenum target;
  int level, internal_format, width, height, border;
};

bool is_texture_size(int with_border, int border, int level) {
  if (with_border < 2 * border) return false;
  const int size = with_border - 2 * border;
  return size == 0 || (size <= kMostSize >> level && std::has_single_bit(unsigned(size)));
}

/// \returns the level without texels, or nothing, with an error. A proxy whose size is not possible has size 0.
std::optional<TextureLevel> checked_level(Context& c, const LevelShape& s, bool is_1d, bool is_copy) {
  const auto format = GLenum(s.internal_format);
  if (is_one_of(format, GL_DEPTH_COMPONENT, GL_DEPTH_COMPONENT16, GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT32)) {
    c.refuse("depth textures");
    return std::nullopt;
  }
  const GLenum base = is_copy && format <= 4 ? 0 : base_of(format);
  const bool is_level = s.level >= 0 && s.level < kTextureLevels && (s.border == 0 || s.border == 1);
  const bool is_possible = is_level && is_texture_size(s.width, s.border, s.level) &&
                           (is_1d || is_texture_size(s.height, s.border, s.level));
  if (base == 0 || !is_level || (!is_possible && !is_proxy(s.target))) {
    c.fail(base == 0 && is_copy ? GL_INVALID_ENUM : GL_INVALID_VALUE);
    return std::nullopt;
  }
  TextureLevel level;
  if (!is_possible) return level;
  const int width = s.width - 2 * s.border, height = is_1d ? 1 : s.height - 2 * s.border;
  if (width > 0 && height > 0) level = {width, height, s.border, format, base, nullptr};
  return level;
}

/// Source of texels: the memory of the client, or the frame.
struct TexelSource {
  ClientImage image;
  bool is_frame = false;
  int x = 0, y = 0;  ///< in the frame

  /// \returns whether these pixels may become texels; an error is recorded otherwise.
  [[nodiscard]] bool is_valid(Context& c) const {
    if (is_frame) return true;
    const GLenum error = image.shape.format == GL_STENCIL_INDEX ? GLenum(GL_INVALID_ENUM)
                                                                : pixel_error(image.shape.format, image.shape.type);
    if (error) {
      c.fail(error);
    } else if (image.shape.format == GL_DEPTH_COMPONENT) {
      c.refuse("depth textures");
    } else {
      return true;
    }
    return false;
  }
  /// \returns nothing if there is no memory, and no pixels if the client gave none.
  [[nodiscard]] std::optional<std::vector<std::uint32_t>> pixels(Context& c, int width, int height) const {
    if (is_frame) return copy_of_frame(c, {x, y, width, height}, PixelKind::color);
    return image.pixels ? unpack(image, transfer_of(c)) : std::optional(std::vector<std::uint32_t>());
  }
};

TexelSource from_frame(int x, int y) { return {{}, true, x, y}; }
/// The pixels of the client, kept if a display list is compiled.
TexelSource from_client(const ImageShape& shape, const void* pixels) {
  const Context* const c = current_context();
  TexelSource source{{c ? c->client.unpack : PixelStore(), shape, pixels, nullptr}};
  if (c && c->list) source.image.keep();
  return source;
}

/// Replaces a level.
void set_image(const LevelShape& s, int dimensions, const TexelSource& source) {
  const bool is_1d = dimensions == 1;
  const auto call = [=](Context& c) {
    if (!is_one_of(s.target, is_1d ? GL_TEXTURE_1D : GL_TEXTURE_2D,
                   is_1d ? GL_PROXY_TEXTURE_1D : GL_PROXY_TEXTURE_2D)) {
      return c.fail(GL_INVALID_ENUM);
    }
    TextureObject* const t = texture_at(c, s.target, !source.is_frame);
    if (!t || !source.is_valid(c)) return;
    std::optional<TextureLevel> level = checked_level(c, s, is_1d, source.is_frame);
    if (!level) return;
    std::optional<std::vector<std::uint32_t>> pixels(std::in_place);
    if (level->width > 0 && !is_proxy(s.target)) {
      pixels = source.pixels(c, s.width, s.height);
      auto texels = allocated<std::uint32_t>(std::size_t(s.width) * std::size_t(level->height + 2 * s.border));
      if (!texels || !pixels) return c.fail(GL_OUT_OF_MEMORY);
      level->texels = std::make_shared<std::vector<std::uint32_t>>(std::move(*texels));
    }
    t->levels[std::size_t(s.level)] = std::move(*level);
    if (!is_proxy(s.target)) write_texels(c, *t, {s.level, -s.border, -s.border, s.width, s.height}, *pixels);
  };
  is_proxy(s.target) ? client_call(call) : draw_call(call);
}

/// Replaces a part of a level.
void set_part(GLenum target, int dimensions, const TexelPlace& place, const TexelSource& source) {
  draw_call([=](Context& c) {
    if (dimension_of(target) != dimensions - 1) return c.fail(GL_INVALID_ENUM);
    TextureObject& t = *texture_at(c, target);
    if (!source.is_valid(c)) return;
    if (place.level < 0 || place.level >= kTextureLevels) return c.fail(GL_INVALID_VALUE);
    const TextureLevel& level = t.levels[std::size_t(place.level)];
    if (level.width == 0) return c.fail(GL_INVALID_OPERATION);
    const auto is_inside = [b = level.border](int first, int count, int size) {
      return count >= 0 && first >= -b && std::int64_t(first) + count <= size + b;
    };
    if (!is_inside(place.x, place.width, level.width) || !is_inside(place.y, place.height, level.height)) {
      return c.fail(GL_INVALID_VALUE);
    }
    const std::optional<std::vector<std::uint32_t>> pixels = source.pixels(c, place.width, place.height);
    if (!pixels) return c.fail(GL_OUT_OF_MEMORY);
    write_texels(c, t, place, *pixels);
  });
}

// ---- Parameters.

struct EnumParameter {
  GLenum name;
  GLenum TextureObject::*field;
  std::array<GLenum, 6> values;
};
constexpr std::array<GLenum, 6> kWraps = {GL_REPEAT, GL_CLAMP, GL_CLAMP_TO_EDGE, GL_CLAMP_TO_BORDER,
                                          GL_MIRRORED_REPEAT};
constexpr EnumParameter kEnumParameters[] = {
    {GL_TEXTURE_MIN_FILTER,
     &TextureObject::min_filter,
     {GL_NEAREST, GL_LINEAR, GL_NEAREST_MIPMAP_NEAREST, GL_LINEAR_MIPMAP_NEAREST, GL_NEAREST_MIPMAP_LINEAR,
      GL_LINEAR_MIPMAP_LINEAR}},
    {GL_TEXTURE_MAG_FILTER, &TextureObject::mag_filter, {GL_NEAREST, GL_LINEAR}},
    {GL_TEXTURE_WRAP_S, &TextureObject::wrap_s, kWraps},
    {GL_TEXTURE_WRAP_T, &TextureObject::wrap_t, kWraps},
    {GL_TEXTURE_WRAP_R, &TextureObject::wrap_r, kWraps}};
constexpr std::pair<GLenum, float TextureObject::*> kFloatParameters[] = {
    {GL_TEXTURE_MIN_LOD, &TextureObject::min_lod},
    {GL_TEXTURE_MAX_LOD, &TextureObject::max_lod},
    {GL_TEXTURE_LOD_BIAS, &TextureObject::lod_bias}};
constexpr std::pair<GLenum, int TextureObject::*> kLevelParameters[] = {
    {GL_TEXTURE_BASE_LEVEL, &TextureObject::base_level}, {GL_TEXTURE_MAX_LEVEL, &TextureObject::max_level}};

/// \returns an error or GL_NO_ERROR.
GLenum set_parameter(TextureObject& t, GLenum name, const std::array<double, 4>& v) {
  for (const EnumParameter& p : kEnumParameters) {
    if (p.name != name) continue;
    const GLenum value = v[0] >= 1 && v[0] <= 65535 ? GLenum(v[0]) : GL_INVALID_INDEX;
    if (std::find(p.values.begin(), p.values.end(), value) == p.values.end()) return GL_INVALID_ENUM;
    t.*p.field = value;
    return GL_NO_ERROR;
  }
  for (const auto& [float_name, field] : kFloatParameters) {
    if (float_name == name) return t.*field = float(v[0]), GL_NO_ERROR;
  }
  for (const auto& [level_name, field] : kLevelParameters) {
    if (level_name != name) continue;
    if (!(v[0] >= 0)) return GL_INVALID_VALUE;
    t.*field = int(std::min(v[0], 1e9));
    return GL_NO_ERROR;
  }
  if (name == GL_TEXTURE_BORDER_COLOR) {
    for (int i = 0; i < 4; ++i) t.border_color[i] = float(unit(v[std::size_t(i)]));
  } else if (name == GL_TEXTURE_PRIORITY) {
    t.priority = float(unit(v[0]));
  } else if (name == GL_GENERATE_MIPMAP) {
    t.generate_mipmap = v[0] != 0;
  } else {
    return GL_INVALID_ENUM;
  }
  return GL_NO_ERROR;
}

Results texture_parameter(const TextureObject& t, GLenum name) {
  for (const EnumParameter& p : kEnumParameters)
    if (p.name == name) return Results(t.*p.field);
  for (const auto& [float_name, field] : kFloatParameters)
    if (float_name == name) return Results(t.*field);
  for (const auto& [level_name, field] : kLevelParameters)
    if (level_name == name) return Results(t.*field);
  switch (name) {
    case GL_TEXTURE_BORDER_COLOR: return Results::of(&t.border_color[0], 4).as_normalized();
    case GL_TEXTURE_PRIORITY: return Results(t.priority).as_normalized();
    case GL_TEXTURE_RESIDENT: return Results(GL_TRUE);
    case GL_GENERATE_MIPMAP: return Results(t.generate_mipmap);
    default: return {};
  }
}

Results level_parameter(const TextureLevel& level, bool is_1d, GLenum name) {
  const BaseFormat& f = *base_format(level.base_format);
  const auto bits = [&](bool has) { return Results(has && level.width > 0 ? 8 : 0); };
  switch (name) {
    case GL_TEXTURE_WIDTH: return Results(level.width + 2 * level.border);
    case GL_TEXTURE_HEIGHT: return Results(level.height + (is_1d ? 0 : 2 * level.border));
    case GL_TEXTURE_DEPTH: return Results(level.width > 0 ? 1 : 0);
    case GL_TEXTURE_BORDER: return Results(level.border);
    case GL_TEXTURE_INTERNAL_FORMAT: return Results(level.internal_format);
    case GL_TEXTURE_RED_SIZE:
    case GL_TEXTURE_GREEN_SIZE:
    case GL_TEXTURE_BLUE_SIZE: return bits((f.shown & 0xFF00) != 0);
    case GL_TEXTURE_ALPHA_SIZE: return bits((f.shown & kOpaque) != 0);
    case GL_TEXTURE_LUMINANCE_SIZE: return bits(f.repeat == 0x010101);
    case GL_TEXTURE_INTENSITY_SIZE: return bits(f.repeat == 0x01010101);
    case GL_TEXTURE_DEPTH_SIZE:
    case GL_TEXTURE_COMPRESSED: return Results(0);
    default: return {};
  }
}

template <class T>
void tex_parameter(GLenum target, GLenum name, const T* values, bool is_vector) {
  std::array<double, 4> v{};
  const bool is_border = name == GL_TEXTURE_BORDER_COLOR;
  for (std::size_t i = 0; values && i < (is_border && is_vector ? 4 : 1); ++i)
    v[i] = is_border ? double(normalized(values[i])) : double(values[i]);
  draw_call([=](Context& c) {
    TextureObject* const t = texture_at(c, target);
    const GLenum error = is_border && !is_vector ? GL_INVALID_ENUM : t ? set_parameter(*t, name, v) : GL_NO_ERROR;
    if (error) c.fail(error);
  });
}

/// Writes a parameter of a texture, or of a level if `level` is not null.
template <class T>
void get_tex_parameter(GLenum target, const GLint* level, GLenum name, T* values) {
  client_call([=](Context& c) {
    const TextureObject* const t = texture_at(c, target, level != nullptr);
    if (!t) return;
    if (level && (*level < 0 || *level >= kTextureLevels)) return c.fail(GL_INVALID_VALUE);
    const bool is_1d = is_one_of(target, GL_TEXTURE_1D, GL_PROXY_TEXTURE_1D);
    const Results results =
        level ? level_parameter(t->levels[std::size_t(*level)], is_1d, name) : texture_parameter(*t, name);
    if (results.count < 0) return c.fail(GL_INVALID_ENUM);
    results.write(values);
  });
}

}  // namespace

// ---- Objects.

FRONTMOST_GL void glGenTextures(GLsizei n, GLuint* names) {
  client_call([=](Context& c) { generate_names(c, c.shared->textures, n, names); });
}

FRONTMOST_GL void glDeleteTextures(GLsizei n, const GLuint* names) {
  client_call([=](Context& c) {
    if (n < 0) return c.fail(GL_INVALID_VALUE);
    c.stream.state_changes();
    for (GLsizei i = 0; names && i < n; ++i) {
      const auto found = c.shared->textures.find(names[i]);
      if (found == c.shared->textures.end()) continue;
      for (TextureUnitState& u : c.state.texture.units) {
        for (int d : {0, 1}) {
          if (u.bound[d] == found->second) u.bound[d] = c.default_textures[d];
        }
      }
      c.shared->textures.erase(found);
    }
  });
}

FRONTMOST_GL void glBindTexture(GLenum target, GLuint name) {
  draw_call([=](Context& c) {
    const int i = dimension_of(target);
    if (i < 0) return c.fail(GL_INVALID_ENUM);
    std::shared_ptr<TextureObject>& bound = c.state.texture.units[std::size_t(c.state.texture.active)].bound[i];
    if (name == 0) {
      bound = c.default_textures[i];
      return;
    }
    std::shared_ptr<TextureObject>& texture = c.shared->textures[name];
    if (!texture) {
      texture = std::make_shared<TextureObject>();
      texture->name = name;
      texture->target = target;
    }
    if (texture->target != target) return c.fail(GL_INVALID_OPERATION);
    bound = texture;
  });
}

FRONTMOST_GL void glPrioritizeTextures(GLsizei n, const GLuint* names, const GLclampf* priorities) {
  std::vector<std::pair<GLuint, float>> given;
  for (GLsizei i = 0; names && priorities && i < n; ++i)
    given.emplace_back(names[i], float(unit(double(priorities[i]))));
  draw_call([=](Context& c) {
    if (n < 0) return c.fail(GL_INVALID_VALUE);
    for (const auto& [name, priority] : given) {
      const auto found = c.shared->textures.find(name);
      if (found != c.shared->textures.end() && found->second) found->second->priority = priority;
    }
  });
}

FRONTMOST_GL GLboolean glAreTexturesResident(GLsizei n, const GLuint* names, GLboolean*) {
  return client_call([=](Context& c) -> GLboolean {
    bool are_textures = n >= 0;
    for (GLsizei i = 0; names && i < n; ++i) {
      const auto found = c.shared->textures.find(names[i]);
      are_textures = are_textures && found != c.shared->textures.end() && found->second;
    }
    if (!are_textures) c.fail(GL_INVALID_VALUE);
    return are_textures;
  });
}

#define SETS(entry, value, values, is_vector) \
  FRONTMOST_GL void entry(GLenum target, GLenum pname, value) { tex_parameter(target, pname, values, is_vector); }
SETS(glTexParameteri, GLint v, &v, false)
SETS(glTexParameterf, GLfloat v, &v, false)
SETS(glTexParameteriv, const GLint* v, v, true)
SETS(glTexParameterfv, const GLfloat* v, v, true)
#define GETS(entry, level_entry, T)                                                                            \
  FRONTMOST_GL void entry(GLenum target, GLenum pname, T* v) { get_tex_parameter(target, nullptr, pname, v); } \
  FRONTMOST_GL void level_entry(GLenum target, GLint level, GLenum pname, T* v) {                              \
    get_tex_parameter(target, &level, pname, v);                                                               \
  }
GETS(glGetTexParameteriv, glGetTexLevelParameteriv, GLint)
GETS(glGetTexParameterfv, glGetTexLevelParameterfv, GLfloat)
#undef SETS
#undef GETS

// ---- Images.

FRONTMOST_GL void glTexImage1D(GLenum target, GLint level, GLint internal_format, GLsizei width, GLint border,
                               GLenum format, GLenum type, const GLvoid* pixels) {
  set_image({target, level, internal_format, width, 1, border}, 1, from_client({width, 1, format, type}, pixels));
}
FRONTMOST_GL void glTexImage2D(GLenum target, GLint level, GLint internal_format, GLsizei width, GLsizei height,
                               GLint border, GLenum format, GLenum type, const GLvoid* pixels) {
  set_image({target, level, internal_format, width, height, border}, 2,
            from_client({width, height, format, type}, pixels));
}
FRONTMOST_GL void glTexSubImage1D(GLenum target, GLint level, GLint x, GLsizei width, GLenum format, GLenum type,
                                  const GLvoid* pixels) {
  set_part(target, 1, {level, x, 0, width, 1}, from_client({width, 1, format, type}, pixels));
}
FRONTMOST_GL void glTexSubImage2D(GLenum target, GLint level, GLint x, GLint y, GLsizei width, GLsizei height,
                                  GLenum format, GLenum type, const GLvoid* pixels) {
  set_part(target, 2, {level, x, y, width, height}, from_client({width, height, format, type}, pixels));
}
FRONTMOST_GL void glCopyTexImage1D(GLenum target, GLint level, GLenum format, GLint x, GLint y, GLsizei width,
                                   GLint border) {
  set_image({target, level, GLint(format), width, 1, border}, 1, from_frame(x, y));
}
FRONTMOST_GL void glCopyTexImage2D(GLenum target, GLint level, GLenum format, GLint x, GLint y, GLsizei width,
                                   GLsizei height, GLint border) {
  set_image({target, level, GLint(format), width, height, border}, 2, from_frame(x, y));
}
FRONTMOST_GL void glCopyTexSubImage1D(GLenum target, GLint level, GLint to, GLint x, GLint y, GLsizei width) {
  set_part(target, 1, {level, to, 0, width, 1}, from_frame(x, y));
}
FRONTMOST_GL void glCopyTexSubImage2D(GLenum target, GLint level, GLint to_x, GLint to_y, GLint x, GLint y,
                                      GLsizei width, GLsizei height) {
  set_part(target, 2, {level, to_x, to_y, width, height}, from_frame(x, y));
}

FRONTMOST_GL void glGetTexImage(GLenum target, GLint level, GLenum format, GLenum type, GLvoid* pixels) {
  client_call([=](Context& c) {
    const TextureObject* const t = texture_at(c, target);
    if (!t) return;
    if (level < 0 || level >= kTextureLevels) return c.fail(GL_INVALID_VALUE);
    const bool has_colors = format != GL_COLOR_INDEX && format != GL_STENCIL_INDEX;
    if (const GLenum error = has_colors ? pixel_error(format, type) : GL_INVALID_ENUM) return c.fail(error);
    if (format == GL_DEPTH_COMPONENT) return c.fail(GL_INVALID_OPERATION);
    const TextureLevel& l = t->levels[std::size_t(level)];
    if (!l.texels) return;
    const int b = l.border, width = l.width + 2 * b, height = target == GL_TEXTURE_1D ? 1 : l.height + 2 * b;
    auto words = allocated<std::uint32_t>(std::size_t(width) * std::size_t(height));
    if (!words) return c.fail(GL_OUT_OF_MEMORY);
    const BaseFormat& f = *base_format(l.base_format);
    for (std::size_t i = 0; i < words->size(); ++i) (*words)[i] = ((*l.texels)[i] & f.shown) | f.shown_fill;
    const ClientTarget to{c.client.pack, {width, height, format, type}, pixels};
    if (!pack({words->data(), std::size_t(width), {0, 0, width, height}}, transfer_of(c), to)) c.fail(GL_OUT_OF_MEMORY);
  });
}

// clang-format off
#define EXT(name) FRONTMOST_GL_ALIAS(name##EXT, name);
EXT(glGenTextures) EXT(glDeleteTextures)
EXT(glBindTexture) EXT(glPrioritizeTextures) EXT(glAreTexturesResident) EXT(glTexSubImage1D) EXT(glTexSubImage2D)
EXT(glCopyTexImage1D) EXT(glCopyTexImage2D) EXT(glCopyTexSubImage1D) EXT(glCopyTexSubImage2D)
#undef EXT
// clang-format on

}  // namespace frontmost::gl_detail
