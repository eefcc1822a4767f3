// SPDX-License-Identifier: Apache-2.0
// The whole frame: clearing it, and bringing everything that was submitted into it.

#include "calls/call.h"
#include "calls/osmesa.h"

namespace frontmost::gl_detail {

FRONTMOST_GL void glClear(GLbitfield mask) {
  draw_call([=](Context& c) {
    constexpr GLbitfield kPlanes = GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT;
    if ((mask & ~(kPlanes | GL_ACCUM_BUFFER_BIT)) != 0) return c.fail(GL_INVALID_VALUE);
    if (c.render_mode == GL_RENDER && (mask & kPlanes) != 0) c.stream.clear(c, mask & kPlanes);
  });
}

FRONTMOST_GL void glFlush() {
  client_call([](Context& c) {
    c.finish();
    show_frame();
  });
}

FRONTMOST_GL void glFinish() { glFlush(); }

}  // namespace frontmost::gl_detail
