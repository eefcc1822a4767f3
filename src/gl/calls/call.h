// SPDX-License-Identifier: Apache-2.0
// How an entry point reaches its context.
//
//    draw_call     changes state or draws; goes into display lists; an error between glBegin and glEnd
//    vertex_call   the same, and also legal between glBegin and glEnd
//    client_call   runs at once, also while a list is compiled: glGet, glGenLists, glReadPixels, client arrays
//
// Each takes a lambda with the context as its argument. Captures are by value, because a display list keeps them.
#pragma once

#include <array>
#include <utility>

#include "calls/context.h"

#define FRONTMOST_GL extern "C" __attribute__((visibility("default")))
/// Exports a function of this file by the name of an extension, too.
#define FRONTMOST_GL_ALIAS(alias_name, name) FRONTMOST_GL decltype(name) alias_name __attribute__((alias(#name)))

namespace frontmost::gl_detail {

extern thread_local constinit Context* thread_context __attribute__((tls_model("initial-exec")));

inline Context* current_context() { return thread_context; }

/// Puts a call into the list that is compiled. Not inlined, so that calls outside of lists need no stack.
template <class Call>
[[gnu::noinline]] void listed_call(Context& c, const Call call) {
  c.list->append(call);
  if (c.list_mode != GL_COMPILE) call(c);
}

template <class Call>
inline void vertex_call(const Call& call) {
  Context* const c = thread_context;
  if (!c) return;
  if (c->list) [[unlikely]]
    return listed_call(*c, call);
  call(*c);
}

template <class Call>
inline void draw_call(const Call& call) {
  vertex_call([call](Context& c) {
    if (c.is_inside_begin()) return c.fail(GL_INVALID_OPERATION);
    c.stream.state_changes();
    call(c);
  });
}

/// \returns what the call returns, or a value-initialised one if it may not be made.
template <class Call>
inline auto client_call(const Call& call) -> decltype(call(std::declval<Context&>())) {
  Context* const c = thread_context;
  using Result = decltype(call(*c));
  if (!c) return Result();
  if (c->is_inside_begin()) {
    c->fail(GL_INVALID_OPERATION);
    return Result();
  }
  return call(*c);
}

/// Values behind a pointer, copied so that a lambda may keep them.
template <class T, std::size_t n>
[[nodiscard]] std::array<T, n> copied(const T* values, std::size_t count = n) {
  std::array<T, n> copy{};
  for (std::size_t i = 0; i < count && i < n; ++i) copy[i] = values[i];
  return copy;
}

}  // namespace frontmost::gl_detail
