// SPDX-License-Identifier: Apache-2.0
#include "shade/picture_parts.h"

#include <algorithm>
#include <mutex>

#include "base/parallel.h"

namespace frontmost::shading {

DepthRange depth_range(const Visible& visible, const Execution& execution) {
  // Keys are monotonic in depth, so their extremes suffice.
  DepthRange keys;
  std::mutex mutex;
  constexpr std::size_t samples_at_once = 1u << 16;
  parallel_for(execution, visible.keys.size(), samples_at_once, [&](std::size_t begin, std::size_t end) {
    DepthRange part;
    for (std::size_t i = begin; i < end; ++i)
      if (visible.primitives[i] != no_primitive) part.include({visible.keys[i], visible.keys[i]});
    const std::lock_guard lock(mutex);
    keys.include(part);
  });
  if (!(keys.nearest <= keys.farthest)) return {0, 0};
  return {depth_of_key(visible.view, keys.farthest), depth_of_key(visible.view, keys.nearest)};
}

bool lacks_normals(const Scene& scene) {
  return std::any_of(scene.meshes.begin(), scene.meshes.end(), [](const Mesh& m) { return m.normals.empty(); });
}

bool shows_materials(Shading shading) {
  return shading == Shading::lit || shading == Shading::flat || shading == Shading::normals;
}

void check_given(const ShadeInput& input, const char* who) {
  if (!input.visible == !input.pixels)
    throw Error(ErrorCode::bad_argument, who, "either what is visible or its pixels must be given");
}

void check_opacity(const ShadeOptions& options) {
  if (!(options.opacity >= 0.0f && options.opacity <= 1.0f))
    throw Error(ErrorCode::bad_argument, "shade: opacity", "must be 0 to 1");
}

}  // namespace frontmost::shading
