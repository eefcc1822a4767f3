// SPDX-License-Identifier: Apache-2.0
// Buffer objects, whose bytes arrays and indices come from, and occlusion queries.

#include <algorithm>
#include <cstring>
#include <limits>

#include "calls/call.h"
#include "calls/names.h"
#include "calls/values.h"
#include "pixels/formats.h"

namespace frontmost::gl_detail {
namespace {

/// Binding of a target; null for other targets, with GL_INVALID_ENUM.
std::shared_ptr<BufferObject>* buffer_binding(Context& c, GLenum target) {
  if (target == GL_ARRAY_BUFFER) return &c.client.array_buffer;
  if (target == GL_ELEMENT_ARRAY_BUFFER) return &c.client.element_buffer;
  c.fail(GL_INVALID_ENUM);
  return nullptr;
}

/// Calls `use` with the buffer that is bound to a target, or records an error.
template <class Use>
void with_buffer(GLenum target, const Use& use) {
  client_call([&](Context& c) {
    std::shared_ptr<BufferObject>* const bound = buffer_binding(c, target);
    if (!bound) return;
    if (!*bound) return c.fail(GL_INVALID_OPERATION);
    use(c, **bound);
  });
}

/// Calls `use` with a range of the bytes of a buffer that is not mapped.
template <class Use>
void with_bytes(GLenum target, GLintptr offset, GLsizeiptr size, const Use& use) {
  with_buffer(target, [&](Context& c, BufferObject& b) {
    const auto have = GLsizeiptr(b.bytes.size());
    if (offset < 0 || size < 0 || offset > have || size > have - offset) return c.fail(GL_INVALID_VALUE);
    if (b.is_mapped) return c.fail(GL_INVALID_OPERATION);
    if (size > 0) use(b.bytes.data() + offset);
  });
}

template <class T>
void get_query(GLuint name, GLenum pname, T* value) {
  client_call([=](Context& c) {
    const auto found = c.queries.find(name);
    if (found == c.queries.end() || !found->second.is_made || name == c.current_query)
      return c.fail(GL_INVALID_OPERATION);
    if (!is_one_of(pname, GL_QUERY_RESULT, GL_QUERY_RESULT_AVAILABLE)) return c.fail(GL_INVALID_ENUM);
    constexpr std::uint64_t kMost = std::numeric_limits<T>::max();
    if (value) *value = pname == GL_QUERY_RESULT ? T(std::min(found->second.samples, kMost)) : T(GL_TRUE);
  });
}

void end_query(Context& c) {
  c.finish();
  const std::uint64_t passed = c.stream.samples_passed;
  c.queries[c.current_query].samples =
      c.current_query_target == GL_SAMPLES_PASSED ? passed : std::min<std::uint64_t>(passed, 1);
  c.stream.counts_samples = false;
  c.current_query = 0;
}

}  // namespace

FRONTMOST_GL void glGenBuffers(GLsizei n, GLuint* names) {
  client_call([=](Context& c) { generate_names(c, c.shared->buffers, n, names); });
}

FRONTMOST_GL void glDeleteBuffers(GLsizei n, const GLuint* names) {
  client_call([=](Context& c) {
    if (n < 0) return c.fail(GL_INVALID_VALUE);
    for (GLsizei i = 0; names && i < n; ++i) {
      const auto found = c.shared->buffers.find(names[i]);
      if (found == c.shared->buffers.end()) continue;
      // Arrays that point into the buffer keep it, so that they never read from an offset as if it were an address.
      for (auto* const bound : {&c.client.array_buffer, &c.client.element_buffer}) {
        if (*bound == found->second) bound->reset();
      }
      c.shared->buffers.erase(found);
    }
  });
}

FRONTMOST_GL void glBindBuffer(GLenum target, GLuint name) {
  client_call([=](Context& c) {
    std::shared_ptr<BufferObject>* const bound = buffer_binding(c, target);
    if (!bound) return;
    if (name == 0) return bound->reset();
    std::shared_ptr<BufferObject>& buffer = c.shared->buffers[name];
    if (!buffer) {
      buffer = std::make_shared<BufferObject>();
      buffer->name = name;
    }
    *bound = buffer;
  });
}

FRONTMOST_GL void glBufferData(GLenum target, GLsizeiptr size, const void* data, GLenum usage) {
  with_buffer(target, [&](Context& c, BufferObject& b) {
    if (!is_one_of(usage, GL_STREAM_DRAW, GL_STREAM_READ, GL_STREAM_COPY, GL_STATIC_DRAW, GL_STATIC_READ,
                   GL_STATIC_COPY, GL_DYNAMIC_DRAW, GL_DYNAMIC_READ, GL_DYNAMIC_COPY)) {
      return c.fail(GL_INVALID_ENUM);
    }
    if (size < 0) return c.fail(GL_INVALID_VALUE);
    auto bytes = allocated<std::byte>(std::size_t(size));
    if (!bytes) return c.fail(GL_OUT_OF_MEMORY);
    if (data && size > 0) std::memcpy(bytes->data(), data, std::size_t(size));
    b.bytes = std::move(*bytes);
    b.usage = usage;
    b.access = GL_READ_WRITE;
    b.is_mapped = false;
  });
}

FRONTMOST_GL void glBufferSubData(GLenum target, GLintptr offset, GLsizeiptr size, const void* data) {
  with_bytes(target, offset, size, [&](std::byte* bytes) {
    if (data) std::memcpy(bytes, data, std::size_t(size));
  });
}
FRONTMOST_GL void glGetBufferSubData(GLenum target, GLintptr offset, GLsizeiptr size, void* data) {
  with_bytes(target, offset, size, [&](const std::byte* bytes) {
    if (data) std::memcpy(data, bytes, std::size_t(size));
  });
}

FRONTMOST_GL void* glMapBuffer(GLenum target, GLenum access) {
  void* bytes = nullptr;
  with_buffer(target, [&](Context& c, BufferObject& b) {
    if (!is_one_of(access, GL_READ_ONLY, GL_WRITE_ONLY, GL_READ_WRITE)) return c.fail(GL_INVALID_ENUM);
    if (b.is_mapped) return c.fail(GL_INVALID_OPERATION);
    b.is_mapped = true;
    b.access = access;
    bytes = b.bytes.data();
  });
  return bytes;
}

FRONTMOST_GL GLboolean glUnmapBuffer(GLenum target) {
  GLboolean was_mapped = GL_FALSE;
  with_buffer(target, [&](Context& c, BufferObject& b) {
    if (!b.is_mapped) return c.fail(GL_INVALID_OPERATION);
    b.is_mapped = false;
    was_mapped = GL_TRUE;
  });
  return was_mapped;
}

FRONTMOST_GL void glGetBufferParameteriv(GLenum target, GLenum pname, GLint* value) {
  with_buffer(target, [&](Context& c, const BufferObject& b) {
    const Results result = pname == GL_BUFFER_SIZE     ? Results(b.bytes.size())
                           : pname == GL_BUFFER_USAGE  ? Results(b.usage)
                           : pname == GL_BUFFER_ACCESS ? Results(b.access)
                           : pname == GL_BUFFER_MAPPED ? Results(b.is_mapped)
                                                       : Results();
    if (result.count < 0) return c.fail(GL_INVALID_ENUM);
    result.write(value);
  });
}

FRONTMOST_GL void glGetBufferPointerv(GLenum target, GLenum pname, void** pointer) {
  with_buffer(target, [&](Context& c, BufferObject& b) {
    if (pname != GL_BUFFER_MAP_POINTER) return c.fail(GL_INVALID_ENUM);
    if (pointer) *pointer = b.is_mapped ? b.bytes.data() : nullptr;
  });
}

// ---- Queries.

FRONTMOST_GL void glGenQueries(GLsizei n, GLuint* names) {
  client_call([=](Context& c) { generate_names(c, c.queries, n, names); });
}

FRONTMOST_GL void glDeleteQueries(GLsizei n, const GLuint* names) {
  client_call([=](Context& c) {
    if (n < 0) return c.fail(GL_INVALID_VALUE);
    for (GLsizei i = 0; names && i < n; ++i) {
      if (names[i] != 0 && names[i] == c.current_query) end_query(c);
      c.queries.erase(names[i]);
    }
  });
}

FRONTMOST_GL GLboolean glIsQuery(GLuint name) {
  return client_call([=](Context& c) -> GLboolean {
    const auto found = c.queries.find(name);
    return found != c.queries.end() && found->second.is_made;
  });
}

FRONTMOST_GL void glBeginQuery(GLenum target, GLuint name) {
  draw_call([=](Context& c) {
    if (!is_one_of(target, GL_SAMPLES_PASSED, GL_ANY_SAMPLES_PASSED)) return c.fail(GL_INVALID_ENUM);
    if (name == 0 || c.current_query != 0) return c.fail(GL_INVALID_OPERATION);
    c.finish();
    c.stream.samples_passed = 0;
    c.stream.counts_samples = true;
    c.queries[name].is_made = true;
    c.current_query = name;
    c.current_query_target = target;
  });
}

FRONTMOST_GL void glEndQuery(GLenum target) {
  draw_call([=](Context& c) {
    if (!is_one_of(target, GL_SAMPLES_PASSED, GL_ANY_SAMPLES_PASSED)) return c.fail(GL_INVALID_ENUM);
    if (c.current_query == 0 || target != c.current_query_target) return c.fail(GL_INVALID_OPERATION);
    end_query(c);
  });
}

FRONTMOST_GL void glGetQueryiv(GLenum target, GLenum pname, GLint* value) {
  client_call([=](Context& c) {
    if (!is_one_of(target, GL_SAMPLES_PASSED, GL_ANY_SAMPLES_PASSED) ||
        !is_one_of(pname, GL_CURRENT_QUERY, GL_QUERY_COUNTER_BITS)) {
      return c.fail(GL_INVALID_ENUM);
    }
    if (value)
      *value = pname == GL_QUERY_COUNTER_BITS ? 32 : target == c.current_query_target ? GLint(c.current_query) : 0;
  });
}

FRONTMOST_GL void glGetQueryObjectiv(GLuint name, GLenum pname, GLint* value) { get_query(name, pname, value); }
FRONTMOST_GL void glGetQueryObjectuiv(GLuint name, GLenum pname, GLuint* value) { get_query(name, pname, value); }

// clang-format off
#define ARB(name) FRONTMOST_GL_ALIAS(name##ARB, name);
ARB(glGenBuffers) ARB(glDeleteBuffers) ARB(glBindBuffer) ARB(glBufferData) ARB(glBufferSubData) ARB(glGetBufferSubData) ARB(glMapBuffer)
ARB(glUnmapBuffer) ARB(glGetBufferParameteriv) ARB(glGetBufferPointerv) ARB(glGenQueries) ARB(glDeleteQueries)
ARB(glIsQuery) ARB(glBeginQuery) ARB(glEndQuery) ARB(glGetQueryiv) ARB(glGetQueryObjectiv)
ARB(glGetQueryObjectuiv)
#undef ARB
// clang-format on

}  // namespace frontmost::gl_detail
