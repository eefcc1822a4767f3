// SPDX-License-Identifier: Apache-2.0
// Names of textures, buffers and queries.
#pragma once

#include "calls/context.h"

namespace frontmost::gl_detail {

/// Gives out the lowest names that the map does not have.
template <class Map>
void generate_names(Context& c, Map& map, GLsizei n, GLuint* names) {
  if (n < 0) return c.fail(GL_INVALID_VALUE);
  GLuint name = 0;
  auto next = map.begin();
  for (GLsizei i = 0; names && i < n; ++i) {
    for (++name; next != map.end() && next->first <= name; ++next) name += next->first == name;
    map.emplace_hint(next, name, typename Map::mapped_type());
    names[i] = name;
  }
}

}  // namespace frontmost::gl_detail
