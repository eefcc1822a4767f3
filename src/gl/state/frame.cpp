// SPDX-License-Identifier: Apache-2.0
#include "state/frame.h"

namespace frontmost::gl_detail {

void Frame::resize(int w, int h) {
  width = w;
  height = h;
  stride = (std::size_t(w) + 15) / 16 * 16;
  color = Buffer<std::uint32_t>(stride * std::size_t(h), 0);
  depth = Buffer<std::uint32_t>(stride * std::size_t(h), kMostDepth << 8);
  if (!ids.empty()) ids = Buffer<std::uint32_t>(stride * std::size_t(h), no_primitive);
}

std::vector<glm::dmat4>& MatrixStacks::chosen(const State& state) {
  if (state.transform.matrix_mode == GL_TEXTURE) return texture[std::size_t(state.texture.active)];
  return state.transform.matrix_mode == GL_PROJECTION ? projection : modelview;
}

}  // namespace frontmost::gl_detail
