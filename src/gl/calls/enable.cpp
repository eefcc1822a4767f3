// SPDX-License-Identifier: Apache-2.0
// glEnable and its relatives, by the table of capabilities.

#include "calls/call.h"
#include "calls/values.h"
#include "state/capabilities.h"

namespace frontmost::gl_detail {
namespace {

void set_capability(Context& c, GLenum name, bool on) {
  State& s = c.state;
  if (const auto capability = capability_of(name)) {
    s.capabilities.set(*capability, on);
    apply_color_material(s);
  } else if (bool* const flag = switch_of(s.texture.units[std::size_t(s.texture.active)], name)) {
    *flag = on;
  } else if (!is_refused_capability(name)) {
    c.fail(GL_INVALID_ENUM);
  } else if (on) {
    c.refuse("glEnable");
  }
}

void set_array(GLenum name, bool on) {
  client_call([=](Context& c) {
    if (ClientArray* const array = array_of(c.client, name))
      array->is_enabled = on;
    else
      c.fail(GL_INVALID_ENUM);
  });
}

}  // namespace

FRONTMOST_GL void glEnable(GLenum cap) {
  draw_call([=](Context& c) { set_capability(c, cap, true); });
}
FRONTMOST_GL void glDisable(GLenum cap) {
  draw_call([=](Context& c) { set_capability(c, cap, false); });
}
FRONTMOST_GL GLboolean glIsEnabled(GLenum cap) {
  return client_call([=](Context& c) -> GLboolean {
    if (const auto capability = capability_of(cap)) return c.state.capabilities.has(*capability);
    if (const bool* flag = switch_of(c.state.texture.units[std::size_t(c.state.texture.active)], cap)) return *flag;
    if (const ClientArray* array = array_of(c.client, cap)) return array->is_enabled;
    if (!is_refused_capability(cap)) c.fail(GL_INVALID_ENUM);
    return GL_FALSE;
  });
}

FRONTMOST_GL void glEnableClientState(GLenum array) { set_array(array, true); }
FRONTMOST_GL void glDisableClientState(GLenum array) { set_array(array, false); }
FRONTMOST_GL void glClientActiveTexture(GLenum unit) {
  client_call([=](Context& c) {
    if (unit - GL_TEXTURE0 >= GLenum(kTextureUnits)) return c.fail(GL_INVALID_ENUM);
    c.client.active_texture = int(unit - GL_TEXTURE0);
  });
}
FRONTMOST_GL_ALIAS(glClientActiveTextureARB, glClientActiveTexture);

}  // namespace frontmost::gl_detail
