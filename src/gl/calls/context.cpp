// SPDX-License-Identifier: Apache-2.0
#include "calls/context.h"

#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <set>

#include "calls/call.h"

namespace frontmost::gl_detail {

thread_local constinit Context* thread_context = nullptr;

Context::Context(Context* shares_with) {
  if (shares_with) shared = shares_with->shared;
  for (auto& of_dimension : maps)
    for (int map = 0; map < kMaps; ++map) of_dimension[std::size_t(map)] = EvaluatorMap::initial(map);
  for (const int target : {0, 1}) {
    if (shares_with) {
      default_textures[target] = shares_with->default_textures[target];
    } else {
      default_textures[target] = std::make_shared<TextureObject>();
      default_textures[target]->target = target == 0 ? GL_TEXTURE_1D : GL_TEXTURE_2D;
    }
    for (TextureUnitState& unit : state.texture.units) unit.bound[target] = default_textures[target];
  }
}

void Context::refuse(const char* call) {
  fail(GL_INVALID_OPERATION);
  static const bool is_verbose = std::getenv("FRONTMOST_GL_VERBOSE") != nullptr;
  if (!is_verbose) return;
  static std::mutex mutex;
  static std::set<std::string> said;
  const std::lock_guard lock(mutex);
  if (said.insert(call).second)
    std::fprintf(stderr, "frontmost-gl: %s: not offered; the call only records GL_INVALID_OPERATION\n", call);
}

}  // namespace frontmost::gl_detail
