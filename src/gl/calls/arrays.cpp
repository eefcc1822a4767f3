// SPDX-License-Identifier: Apache-2.0
// Vertices from arrays.
//
//    enabled arrays --ArrayPlan--> one Fetch for each attribute --for each element--> current values --> stream
//
// A display list keeps the elements as floats, in a plan whose fetches read from its own memory.

#include <algorithm>
#include <cstring>

#include "calls/call.h"
#include "calls/values.h"
#include "pixels/formats.h"
#include "state/capabilities.h"

namespace frontmost::gl_detail {
namespace {

constexpr std::size_t kTypeBytes[] = {1, 1, 2, 2, 4, 4, 4, 0, 0, 0, 8};  ///< from GL_BYTE to GL_DOUBLE

using ElementConverter = void (*)(const std::byte*, int count, float*);

template <class T, bool is_normalized>
void convert(const std::byte* from, int count, float* to) {
  for (int i = 0; i < count; ++i, from += sizeof(T)) {
    T v;
    std::memcpy(&v, from, sizeof v);
    to[i] = is_normalized ? normalized(v) : float(v);
  }
}

void convert_flag(const std::byte* from, int, float* to) { *to = *from != std::byte(0); }

/// Converters from GL_BYTE to GL_DOUBLE, of values and of components of colors and normals; null for floats, which are
/// copied.
constexpr ElementConverter kConverters[][2] = {{convert<GLbyte, false>, convert<GLbyte, true>},
                                               {convert<GLubyte, false>, convert<GLubyte, true>},
                                               {convert<GLshort, false>, convert<GLshort, true>},
                                               {convert<GLushort, false>, convert<GLushort, true>},
                                               {convert<GLint, false>, convert<GLint, true>},
                                               {convert<GLuint, false>, convert<GLuint, true>},
                                               {nullptr, nullptr},
                                               {},
                                               {},
                                               {},
                                               {convert<GLdouble, false>, convert<GLdouble, false>}};

/// Reads one attribute of an element.
struct Fetch {
  const std::byte* at;
  std::size_t stride;
  ElementConverter convert;
  int first, count, whole;  ///< Attribute, components of the array and of the attribute

  void read(std::size_t element, float* to) const {
    const std::byte* const from = at + element * stride;
    if (convert) return convert(from, count, to);
    switch (count) {
      case 1: std::memcpy(to, from, 4); break;
      case 2: std::memcpy(to, from, 8); break;
      case 3: std::memcpy(to, from, 12); break;
      default: std::memcpy(to, from, 16);
    }
  }
};

struct ArrayPlan {
  std::array<Fetch, 6 + kTextureUnits> fetches;
  int fetch_count = 0;
  std::size_t floats = 0;  ///< components of an element
  bool has_vertices = false, has_colors = false;
  bool has_buffers = false, is_within = true;
  std::shared_ptr<const std::vector<float>> kept;

  /// Adds an array, if it is enabled; `last` is the greatest element that will be read.
  void add(const ClientArray& array, int first, int whole, bool is_normalized, std::size_t last) {
    if (!array.is_enabled || (!array.pointer && !array.buffer)) return;
    const std::size_t bytes = kTypeBytes[array.type - GL_BYTE] * std::size_t(array.size);
    const std::size_t stride = array.stride > 0 ? std::size_t(array.stride) : bytes;
    const auto* at = static_cast<const std::byte*>(array.pointer);
    if (array.buffer) {
      has_buffers = true;
      const auto offset = reinterpret_cast<std::uintptr_t>(array.pointer);
      const std::size_t size = array.buffer->bytes.size();
      is_within = is_within && !array.buffer->is_mapped && offset <= size && size - offset >= bytes &&
                  (size - offset - bytes) / stride >= last;
      if (!is_within) return;
      at = array.buffer->bytes.data() + offset;
    }
    const ElementConverter conversion =
        first == kEdgeFlag ? convert_flag : kConverters[array.type - GL_BYTE][is_normalized];
    fetches[std::size_t(fetch_count++)] = {at, stride, conversion, first, array.size, whole};
    floats += std::size_t(array.size);
  }

  ArrayPlan(const ClientState& client, std::size_t last) {
    add(client.vertex, kX, 4, false, last);
    has_vertices = fetch_count > 0;
    add(client.normal, kNormalX, 3, true, last);
    const int before_colors = fetch_count;
    add(client.color, kRed, 4, true, last);
    has_colors = fetch_count > before_colors;
    add(client.secondary_color, kRed2, 3, true, last);
    add(client.fog_coord, kFogCoord, 1, false, last);
    add(client.edge_flag, kEdgeFlag, 1, false, last);
    for (int unit = 0; unit < kTextureUnits; ++unit) {
      add(client.texcoords[std::size_t(unit)], kTexCoord + 4 * unit, 4, false, last);
    }
  }

  /// Sets the components that arrays lack, of attributes that they have.
  void set_rest(float* values) const {
    for (int i = 0; i < fetch_count; ++i) {
      const Fetch& f = fetches[std::size_t(i)];
      for (int k = f.count; k < f.whole; ++k) values[f.first + k] = k == 3 ? 1 : 0;
    }
  }
  void read(std::size_t element, float* values) const {
    for (int i = 0; i < fetch_count; ++i) fetches[std::size_t(i)].read(element, values + fetches[std::size_t(i)].first);
  }

  /// Copies elements into memory of the plan. \returns false if there is none.
  template <class Index>
  [[nodiscard]] bool keep(std::size_t count, const Index& index) {
    auto copy = allocated<float>(count * floats);
    if (!copy) return false;
    float* to = copy->data();
    for (std::size_t i = 0; i < count; ++i) {
      for (int k = 0; k < fetch_count; to += fetches[std::size_t(k++)].count)
        fetches[std::size_t(k)].read(index(i), to);
    }
    const auto* at = reinterpret_cast<const std::byte*>(copy->data());
    for (int k = 0; k < fetch_count; ++k) {
      Fetch& f = fetches[std::size_t(k)];
      f = {at, floats * sizeof(float), nullptr, f.first, f.count, f.whole};
      at += std::size_t(f.count) * sizeof(float);
    }
    kept = std::make_shared<const std::vector<float>>(std::move(*copy));
    return true;
  }
};

/// Draws elements. The current values are the same afterwards.
template <class Index>
void submit(Context& c, const ArrayPlan& plan, GLenum mode, std::size_t count, const Index& index, bool is_indexed) {
  std::array<float, kAttributes>& values = c.state.current.values;
  const std::array<float, kAttributes> before = values;
  plan.set_rest(values.data());
  const GLenum(&modes)[2] = c.state.polygon.mode;
  if (is_indexed && mode == GL_TRIANGLES && modes[0] == GL_FILL && modes[1] == GL_FILL) {  // which need no edge flags
    c.stream.indexed_triangles(c, count / 3, index, [&](std::size_t element) { plan.read(element, values.data()); });
    values = before;
    return;
  }
  c.stream.begin(c, mode);
  for (std::size_t i = 0; i < count; ++i) {
    plan.read(index(i), values.data());
    c.stream.vertex(c);
  }
  c.stream.end(c);
  values = before;
}

/// Parameters of glDrawArrays and glDrawElements.
struct Elements {
  GLenum mode;
  GLsizei count;
  GLint first = 0;
  GLenum type = 0;  ///< of indices; 0 for consecutive elements from `first` on
  const void* indices = nullptr;
};

/// Calls `use` with a function that returns the element of a number.
template <class Use>
void with_index(const Elements& e, const std::byte* at, const Use& use) {
  const auto indexed = [&]<class T>(T) {
    use([at](std::size_t i) {
      T v;
      std::memcpy(&v, at + i * sizeof(T), sizeof v);
      return std::size_t(v);
    });
  };
  switch (e.type) {
    case GL_UNSIGNED_BYTE: return indexed(GLubyte());
    case GL_UNSIGNED_SHORT: return indexed(GLushort());
    case GL_UNSIGNED_INT: return indexed(GLuint());
    default: use([first = std::size_t(e.first)](std::size_t i) { return first + i; });
  }
}

/// Calls `use` with the plan and the index function, unless there is nothing to draw or an error, which is recorded.
template <class Use>
void prepare(Context& c, const Elements& e, const Use& use) {
  if (e.mode > GL_POLYGON || (e.type && !is_one_of(e.type, GL_UNSIGNED_BYTE, GL_UNSIGNED_SHORT, GL_UNSIGNED_INT))) {
    return c.fail(GL_INVALID_ENUM);
  }
  if (e.count < 0 || e.first < 0) return c.fail(GL_INVALID_VALUE);
  if (c.is_inside_begin()) return c.fail(GL_INVALID_OPERATION);
  const auto count = std::size_t(e.count);
  const auto* at = static_cast<const std::byte*>(e.indices);
  if (const BufferObject* const buffer = e.type ? c.client.element_buffer.get() : nullptr) {
    const auto offset = reinterpret_cast<std::uintptr_t>(e.indices);
    const std::size_t size = buffer->bytes.size();
    if (buffer->is_mapped || offset > size || (size - offset) / kTypeBytes[e.type - GL_BYTE] < count) {
      return c.fail(GL_INVALID_OPERATION);
    }
    at = buffer->bytes.data() + offset;
  } else if (e.type && !at) {
    return;
  }
  if (count == 0 || !c.client.vertex.is_enabled) return;
  with_index(e, at, [&](const auto& index) {
    ArrayPlan plan(c.client, e.type ? 0 : std::size_t(e.first) + count - 1);
    if (e.type && plan.has_buffers) {
      std::size_t last = 0;
      for (std::size_t i = 0; i < count; ++i) last = std::max(last, index(i));
      plan = ArrayPlan(c.client, last);
    }
    if (!plan.is_within) return c.fail(GL_INVALID_OPERATION);
    if (plan.has_vertices) use(plan, index);
  });
}

void draw_elements(const Elements& e) {
  Context* const context = current_context();
  if (context && context->list) {
    prepare(*context, e, [&](ArrayPlan& plan, const auto& index) {
      if (!plan.keep(std::size_t(e.count), index)) return context->fail(GL_OUT_OF_MEMORY);
      vertex_call([plan, mode = e.mode, count = std::size_t(e.count)](Context& c) {
        if (c.is_inside_begin()) return c.fail(GL_INVALID_OPERATION);
        submit(
            c, plan, mode, count, [](std::size_t i) { return i; }, false);
      });
    });
  } else if (context) {
    prepare(*context, e, [&](const ArrayPlan& plan, const auto& index) {
      submit(*context, plan, e.mode, std::size_t(e.count), index, e.type != 0);
    });
  }
}

// ---- Pointers.

constexpr unsigned type_bit(GLenum type) { return 1u << (type - GL_BYTE); }
constexpr unsigned kReals = type_bit(GL_FLOAT) | type_bit(GL_DOUBLE);
constexpr unsigned kSigned = kReals | type_bit(GL_SHORT) | type_bit(GL_INT);
constexpr unsigned kAllTypes =
    kSigned | type_bit(GL_BYTE) | type_bit(GL_UNSIGNED_BYTE) | type_bit(GL_UNSIGNED_SHORT) | type_bit(GL_UNSIGNED_INT);

struct ArrayRule {
  GLenum array;
  unsigned types;
  int least, most;
};
constexpr ArrayRule kVertexRule{GL_VERTEX_ARRAY, kSigned, 2, 4};
constexpr ArrayRule kNormalRule{GL_NORMAL_ARRAY, kSigned | type_bit(GL_BYTE), 3, 3};
constexpr ArrayRule kColorRule{GL_COLOR_ARRAY, kAllTypes, 3, 4};
constexpr ArrayRule kSecondaryColorRule{GL_SECONDARY_COLOR_ARRAY, kAllTypes, 3, 3};
constexpr ArrayRule kTexCoordRule{GL_TEXTURE_COORD_ARRAY, kSigned, 1, 4};
constexpr ArrayRule kFogCoordRule{GL_FOG_COORD_ARRAY, kReals, 1, 1};
constexpr ArrayRule kIndexRule{GL_INDEX_ARRAY, kSigned | type_bit(GL_UNSIGNED_BYTE), 1, 1};
constexpr ArrayRule kEdgeFlagRule{GL_EDGE_FLAG_ARRAY, type_bit(GL_UNSIGNED_BYTE), 1, 1};

void point_array(const ArrayRule& rule, GLint size, GLenum type, GLsizei stride, const void* pointer) {
  client_call([=](Context& c) {
    if (size < rule.least || size > rule.most || stride < 0) return c.fail(GL_INVALID_VALUE);
    if (type - GL_BYTE > GL_DOUBLE - GL_BYTE || !(rule.types & type_bit(type))) return c.fail(GL_INVALID_ENUM);
    ClientArray& array = *array_of(c.client, rule.array);
    array = {array.is_enabled, size, type, stride, pointer, c.client.array_buffer};
  });
}

/// A format of glInterleavedArrays: components of texture coordinates, colors, normals and vertices, in this order.
struct InterleavedFormat {
  int texcoords, colors, normals, vertices;
  GLenum color_type = GL_FLOAT;
};
// clang-format off
constexpr InterleavedFormat kInterleaved[] = {  // from GL_V2F on
    {0, 0, 0, 2}, {0, 0, 0, 3}, {0, 4, 0, 2, GL_UNSIGNED_BYTE}, {0, 4, 0, 3, GL_UNSIGNED_BYTE}, {0, 3, 0, 3},
    {0, 0, 3, 3}, {0, 4, 3, 3}, {2, 0, 0, 3}, {4, 0, 0, 4}, {2, 4, 0, 3, GL_UNSIGNED_BYTE}, {2, 3, 0, 3}, {2, 0, 3, 3},
    {2, 4, 3, 3}, {4, 4, 3, 4}};
// clang-format on

}  // namespace

#define POINTER(entry, parameters, ...) \
  FRONTMOST_GL void entry parameters { point_array(__VA_ARGS__, stride, pointer); }
POINTER(glVertexPointer, (GLint size, GLenum type, GLsizei stride, const void* pointer), kVertexRule, size, type)
POINTER(glNormalPointer, (GLenum type, GLsizei stride, const void* pointer), kNormalRule, 3, type)
POINTER(glColorPointer, (GLint size, GLenum type, GLsizei stride, const void* pointer), kColorRule, size, type)
POINTER(glSecondaryColorPointer, (GLint size, GLenum type, GLsizei stride, const void* pointer), kSecondaryColorRule,
        size, type)
POINTER(glTexCoordPointer, (GLint size, GLenum type, GLsizei stride, const void* pointer), kTexCoordRule, size, type)
POINTER(glFogCoordPointer, (GLenum type, GLsizei stride, const void* pointer), kFogCoordRule, 1, type)
POINTER(glIndexPointer, (GLenum type, GLsizei stride, const void* pointer), kIndexRule, 1, type)
POINTER(glEdgeFlagPointer, (GLsizei stride, const void* pointer), kEdgeFlagRule, 1, GL_UNSIGNED_BYTE)
// The first extension also gives the number of elements.
POINTER(glVertexPointerEXT, (GLint size, GLenum type, GLsizei stride, GLsizei, const void* pointer), kVertexRule, size,
        type)
POINTER(glNormalPointerEXT, (GLenum type, GLsizei stride, GLsizei, const void* pointer), kNormalRule, 3, type)
POINTER(glColorPointerEXT, (GLint size, GLenum type, GLsizei stride, GLsizei, const void* pointer), kColorRule, size,
        type)
POINTER(glTexCoordPointerEXT, (GLint size, GLenum type, GLsizei stride, GLsizei, const void* pointer), kTexCoordRule,
        size, type)
POINTER(glIndexPointerEXT, (GLenum type, GLsizei stride, GLsizei, const void* pointer), kIndexRule, 1, type)
POINTER(glEdgeFlagPointerEXT, (GLsizei stride, GLsizei, const GLboolean* pointer), kEdgeFlagRule, 1, GL_UNSIGNED_BYTE)
#undef POINTER

FRONTMOST_GL void glInterleavedArrays(GLenum format, GLsizei stride, const GLvoid* pointer) {
  client_call([=](Context& c) {
    if (format - GL_V2F >= std::size(kInterleaved)) return c.fail(GL_INVALID_ENUM);
    if (stride < 0) return c.fail(GL_INVALID_VALUE);
    const InterleavedFormat& f = kInterleaved[format - GL_V2F];
    const int color_bytes = f.color_type == GL_FLOAT ? 4 * f.colors : f.colors;
    const int tight = 4 * (f.texcoords + f.normals + f.vertices) + color_bytes;
    std::uintptr_t at = reinterpret_cast<std::uintptr_t>(pointer);
    const auto point = [&](ClientArray& array, int size, GLenum type, int bytes) {
      array.is_enabled = size > 0;
      if (size == 0) return;
      array = {true, size, type, stride > 0 ? stride : tight, reinterpret_cast<const void*>(at), c.client.array_buffer};
      at += std::uintptr_t(bytes);
    };
    for (ClientArray* const array :
         {&c.client.edge_flag, &c.client.index, &c.client.secondary_color, &c.client.fog_coord}) {
      array->is_enabled = false;
    }
    point(c.client.texcoords[std::size_t(c.client.active_texture)], f.texcoords, GL_FLOAT, 4 * f.texcoords);
    point(c.client.color, f.colors, f.color_type, color_bytes);
    point(c.client.normal, f.normals, GL_FLOAT, 4 * f.normals);
    point(c.client.vertex, f.vertices, GL_FLOAT, 4 * f.vertices);
  });
}

// ---- Drawing.

FRONTMOST_GL void glArrayElement(GLint i) {
  Context* const context = current_context();
  if (!context) return;
  if (i < 0) return context->fail(GL_INVALID_VALUE);
  ArrayPlan plan(context->client, std::size_t(i));
  if (!plan.is_within) return context->fail(GL_INVALID_OPERATION);
  const auto set = [](Context& c, const ArrayPlan& from, std::size_t element) {
    from.set_rest(c.state.current.values.data());
    from.read(element, c.state.current.values.data());
    if (from.has_colors) apply_color_material(c.state);
    if (from.has_vertices && c.is_inside_begin()) c.stream.vertex(c);
  };
  if (!context->list) return set(*context, plan, std::size_t(i));
  if (!plan.keep(1, [i](std::size_t) { return std::size_t(i); })) return context->fail(GL_OUT_OF_MEMORY);
  vertex_call([plan, set](Context& c) { set(c, plan, 0); });
}

FRONTMOST_GL void glDrawArrays(GLenum mode, GLint first, GLsizei count) { draw_elements({mode, count, first}); }
FRONTMOST_GL void glDrawElements(GLenum mode, GLsizei count, GLenum type, const GLvoid* indices) {
  draw_elements({mode, count, 0, type ? type : GL_INVALID_INDEX, indices});
}
FRONTMOST_GL void glDrawRangeElements(GLenum mode, GLuint start, GLuint end, GLsizei count, GLenum type,
                                      const GLvoid* indices) {
  if (end >= start) return glDrawElements(mode, count, type, indices);
  draw_call([](Context& c) { c.fail(GL_INVALID_VALUE); });
}
FRONTMOST_GL void glMultiDrawArrays(GLenum mode, const GLint* first, const GLsizei* count, GLsizei draws) {
  if (draws < 0) glDrawArrays(mode, 0, -1);  // records the error
  for (GLsizei i = 0; first && count && i < draws; ++i) glDrawArrays(mode, first[i], count[i]);
}
FRONTMOST_GL void glMultiDrawElements(GLenum mode, const GLsizei* count, GLenum type, const void* const* indices,
                                      GLsizei draws) {
  if (draws < 0) glDrawArrays(mode, 0, -1);
  for (GLsizei i = 0; indices && count && i < draws; ++i) glDrawElements(mode, count[i], type, indices[i]);
}

FRONTMOST_GL void glLockArraysEXT(GLint first, GLsizei count) {
  client_call([=](Context& c) {
    if (first < 0 || count <= 0) c.fail(GL_INVALID_VALUE);
  });
}
FRONTMOST_GL void glUnlockArraysEXT() {}

FRONTMOST_GL_ALIAS(glSecondaryColorPointerEXT, glSecondaryColorPointer);
FRONTMOST_GL_ALIAS(glFogCoordPointerEXT, glFogCoordPointer);
FRONTMOST_GL_ALIAS(glArrayElementEXT, glArrayElement);
FRONTMOST_GL_ALIAS(glDrawArraysEXT, glDrawArrays);
FRONTMOST_GL_ALIAS(glDrawRangeElementsEXT, glDrawRangeElements);
FRONTMOST_GL_ALIAS(glMultiDrawArraysEXT, glMultiDrawArrays);
FRONTMOST_GL_ALIAS(glMultiDrawElementsEXT, glMultiDrawElements);

}  // namespace frontmost::gl_detail
