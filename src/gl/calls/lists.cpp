// SPDX-License-Identifier: Apache-2.0
// Display lists: making, calling and naming them.

#include <cmath>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <limits>

#include "calls/call.h"

namespace frontmost::gl_detail {
namespace {

constexpr GLsizei kMostListsAtOnce = 1 << 20;

/// Makes the calls of a list; unknown names and too deep ones do nothing.
void run_list(Context& c, GLuint name) {
  const auto found = c.shared->lists.find(name);
  if (found == c.shared->lists.end() || !found->second || c.list_depth >= kListDepth) return;
  const std::shared_ptr<const CallList> list = found->second;  // stays while it runs
  ++c.list_depth;
  list->run(c);
  --c.list_depth;
}

/// Bytes of an element of glCallLists, or 0 for unknown types. Types follow one another from GL_BYTE to GL_4_BYTES.
std::size_t element_bytes(GLenum type) {
  constexpr std::size_t sizes[] = {1, 1, 2, 2, 4, 4, 4, 2, 3, 4};
  return type - GL_BYTE < std::size(sizes) ? sizes[type - GL_BYTE] : 0;
}

template <class T>
T value_at(const std::uint8_t* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

/// The element as what is added to the list base; negative ones wrap around.
GLuint offset_at(GLenum type, const std::uint8_t* bytes) {
  switch (type) {
    case GL_BYTE: return GLuint(value_at<GLbyte>(bytes));
    case GL_SHORT: return GLuint(value_at<GLshort>(bytes));
    case GL_UNSIGNED_SHORT: return value_at<GLushort>(bytes);
    case GL_INT:
    case GL_UNSIGNED_INT: return value_at<GLuint>(bytes);
    case GL_FLOAT: {
      const double whole = std::floor(double(value_at<GLfloat>(bytes)));
      return std::fabs(whole) < 4294967296.0 ? GLuint(std::int64_t(whole)) : 0;
    }
    default: {  // GL_UNSIGNED_BYTE, and several bytes, the highest first
      GLuint value = 0;
      for (std::size_t i = 0; i < element_bytes(type); ++i) value = value << 8 | bytes[i];
      return value;
    }
  }
}

/// The first of `range` names in a row that are free; 0 if there are none.
GLuint free_names(const std::map<GLuint, std::shared_ptr<const CallList>>& lists, GLuint range) {
  constexpr std::uint64_t end = std::uint64_t(1) << 32;
  std::uint64_t first = lists.empty() ? 1 : std::uint64_t(lists.rbegin()->first) + 1;
  if (first + range <= end) return GLuint(first);
  first = 1;
  for (const auto& [name, list] : lists) {
    if (name - first >= range) return GLuint(first);
    first = std::uint64_t(name) + 1;
  }
  return 0;
}

}  // namespace

FRONTMOST_GL void glNewList(GLuint name, GLenum mode) {
  client_call([=](Context& c) {
    if (name == 0) return c.fail(GL_INVALID_VALUE);
    if (mode != GL_COMPILE && mode != GL_COMPILE_AND_EXECUTE) return c.fail(GL_INVALID_ENUM);
    if (c.list) return c.fail(GL_INVALID_OPERATION);
    c.list = std::make_shared<CallList>();
    c.list_name = name;
    c.list_mode = mode;
  });
}

FRONTMOST_GL void glEndList() {
  client_call([](Context& c) {
    if (!c.list) return c.fail(GL_INVALID_OPERATION);
    c.shared->lists[c.list_name] = std::move(c.list);
    c.list.reset();
    c.list_name = 0;
  });
}

FRONTMOST_GL void glCallList(GLuint name) {
  vertex_call([=](Context& c) { run_list(c, name); });
}

FRONTMOST_GL void glCallLists(GLsizei n, GLenum type, const GLvoid* names) {
  const std::size_t size = element_bytes(type);
  const auto* bytes = static_cast<const std::uint8_t*>(names);
  const auto offsets = std::make_shared<std::vector<GLuint>>();
  for (GLsizei i = 0; names && size > 0 && i < n; ++i, bytes += size) offsets->push_back(offset_at(type, bytes));
  vertex_call([n, size, offsets](Context& c) {
    if (n < 0) return c.fail(GL_INVALID_VALUE);
    if (size == 0) return c.fail(GL_INVALID_ENUM);
    // The base is asked for each time, because a list may change it.
    for (const GLuint offset : *offsets) run_list(c, c.state.list_base + offset);
  });
}

FRONTMOST_GL void glListBase(GLuint base) {
  draw_call([=](Context& c) { c.state.list_base = base; });
}

FRONTMOST_GL GLuint glGenLists(GLsizei range) {
  return client_call([=](Context& c) -> GLuint {
    if (range < 0) c.fail(GL_INVALID_VALUE);
    if (range <= 0) return 0;
    auto& lists = c.shared->lists;
    const GLuint first = range <= kMostListsAtOnce ? free_names(lists, GLuint(range)) : 0;
    if (first == 0) c.fail(GL_OUT_OF_MEMORY);
    for (GLuint i = 0; first != 0 && i < GLuint(range); ++i) lists.emplace(first + i, nullptr);
    return first;
  });
}

FRONTMOST_GL void glDeleteLists(GLuint first, GLsizei range) {
  client_call([=](Context& c) {
    if (range < 0) return c.fail(GL_INVALID_VALUE);
    auto& lists = c.shared->lists;
    const std::uint64_t end = std::uint64_t(first) + std::uint64_t(range);
    const bool is_open = end > std::numeric_limits<GLuint>::max();
    lists.erase(lists.lower_bound(first), is_open ? lists.end() : lists.lower_bound(GLuint(end)));
  });
}

FRONTMOST_GL GLboolean glIsList(GLuint name) {
  return client_call([=](Context& c) -> GLboolean { return c.shared->lists.count(name) != 0; });
}

}  // namespace frontmost::gl_detail
