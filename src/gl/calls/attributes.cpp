// SPDX-License-Identifier: Apache-2.0
// glPushAttrib and glPopAttrib: groups of the state, saved and restored.

#include <algorithm>

#include "calls/call.h"
#include "calls/values.h"
#include "state/capabilities.h"

namespace frontmost::gl_detail {
namespace {

template <auto group>
void take(State& to, const State& from) {
  to.*group = from.*group;
}

struct StateGroup {
  GLbitfield bit;
  void (*take)(State& to, const State& from);
};

/// Groups without their capabilities.
constexpr StateGroup kGroups[] = {
    {GL_CURRENT_BIT, take<&State::current>},
    {GL_POINT_BIT, take<&State::point>},
    {GL_LINE_BIT, take<&State::line>},
    {GL_POLYGON_BIT, take<&State::polygon>},
    {GL_POLYGON_STIPPLE_BIT, take<&State::polygon_stipple>},
    {GL_LIGHTING_BIT, take<&State::lighting>},
    {GL_FOG_BIT, take<&State::fog>},
    {GL_DEPTH_BUFFER_BIT, take<&State::depth>},
    {GL_STENCIL_BUFFER_BIT, take<&State::stencil>},
    {GL_COLOR_BUFFER_BIT, take<&State::color>},
    {GL_VIEWPORT_BIT, take<&State::viewport>},
    {GL_SCISSOR_BIT, take<&State::scissor>},
    {GL_TRANSFORM_BIT, take<&State::transform>},
    {GL_TEXTURE_BIT, take<&State::texture>},
    {GL_PIXEL_MODE_BIT, take<&State::pixel>},
    {GL_HINT_BIT, take<&State::hint>},
    {GL_EVAL_BIT, take<&State::grid>},
    {GL_LIST_BIT, take<&State::list_base>},
};

/// Restores the parameters of textures that were bound. A texture that was deleted since gives way to the default.
void restore_textures(Context& c, const SavedState& saved) {
  auto parameters = saved.textures.begin();
  for (TextureUnitState& unit : c.state.texture.units)
    for (const int target : {0, 1}) {
      const TextureObject& was = *parameters++;
      std::shared_ptr<TextureObject>& bound = unit.bound[target];
      const auto found = c.shared->textures.find(was.name);
      if (was.name != 0 && (found == c.shared->textures.end() || found->second != bound)) {
        bound = c.default_textures[target];
      } else {
        auto levels = std::move(bound->levels);
        *bound = was;
        bound->levels = std::move(levels);
      }
    }
}

}  // namespace

FRONTMOST_GL void glPushAttrib(GLbitfield mask) {
  draw_call([=](Context& c) {
    if (int(c.saved.size()) >= kAttribDepth) return c.fail(GL_STACK_OVERFLOW);
    SavedState& saved = c.saved.emplace_back(SavedState{mask, c.state, {}});
    if ((mask & GL_TEXTURE_BIT) == 0) return;
    for (const TextureUnitState& unit : c.state.texture.units)
      for (const auto& texture : unit.bound) saved.textures.emplace_back(*texture).levels = {};
  });
}

FRONTMOST_GL void glPopAttrib() {
  draw_call([](Context& c) {
    if (c.saved.empty()) return c.fail(GL_STACK_UNDERFLOW);
    const SavedState saved = std::move(c.saved.back());
    c.saved.pop_back();
    for (const StateGroup& group : kGroups)
      if ((saved.mask & group.bit) != 0) group.take(c.state, saved.state);
    c.state.capabilities.take(saved.state.capabilities, capabilities_in(saved.mask));
    for (std::size_t i = 0; (saved.mask & GL_ENABLE_BIT) != 0 && i < kTextureUnits; ++i) {
      const TextureUnitState& from = saved.state.texture.units[i];
      std::copy_n(from.is_enabled, 2, c.state.texture.units[i].is_enabled);
      std::copy_n(from.generates, 4, c.state.texture.units[i].generates);
    }
    if ((saved.mask & GL_TEXTURE_BIT) != 0) restore_textures(c, saved);
    apply_color_material(c.state);
  });
}

FRONTMOST_GL void glPushClientAttrib(GLbitfield mask) {
  client_call([=](Context& c) {
    if (int(c.saved_client.size()) >= kAttribDepth) return c.fail(GL_STACK_OVERFLOW);
    c.saved_client.push_back({mask, c.client});
  });
}

FRONTMOST_GL void glPopClientAttrib() {
  client_call([](Context& c) {
    if (c.saved_client.empty()) return c.fail(GL_STACK_UNDERFLOW);
    const SavedClientState saved = std::move(c.saved_client.back());
    c.saved_client.pop_back();
    ClientState next = (saved.mask & GL_CLIENT_VERTEX_ARRAY_BIT) != 0 ? saved.state : c.client;
    const ClientState& pixels = (saved.mask & GL_CLIENT_PIXEL_STORE_BIT) != 0 ? saved.state : c.client;
    next.pack = pixels.pack;
    next.unpack = pixels.unpack;
    c.client = std::move(next);
  });
}

}  // namespace frontmost::gl_detail
