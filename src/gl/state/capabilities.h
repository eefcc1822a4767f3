// SPDX-License-Identifier: Apache-2.0
// The table of capabilities, by which glEnable, glIsEnabled, glGet, glPushAttrib and glPopAttrib find their bits.
#pragma once

#include <cstdint>
#include <optional>

#include "state/state.h"

namespace frontmost::gl_detail {

/// The capability of glEnable that is called `name`, if the table has it.
[[nodiscard]] std::optional<Capability> capability_of(GLenum name);
/// The switch of a texture unit that is called `name`, such as GL_TEXTURE_2D or GL_TEXTURE_GEN_S, or null.
[[nodiscard]] bool* switch_of(TextureUnitState& unit, GLenum name);
/// The array of glEnableClientState that is called `name`, or null. Texture coordinates are those of the active
/// unit.
[[nodiscard]] ClientArray* array_of(ClientState& client, GLenum name);
/// Whether OpenGL 1.5 has a capability with this name that is not offered here.
[[nodiscard]] bool is_refused_capability(GLenum name);
/// Bits of the capabilities that glPushAttrib(groups) saves.
[[nodiscard]] std::uint64_t capabilities_in(GLbitfield groups);

}  // namespace frontmost::gl_detail
