// SPDX-License-Identifier: Apache-2.0
// A scene with its base colours' textures, drawn by Mesa's software OpenGL.
#pragma once

#include <memory>

#include "peers/gl.h"

namespace frontmost::bench {

/// Draws all instances with their base colour textures, filtered trilinearly, holes of alpha mode MASK, and one light
/// at the camera's upper left. Neither shadows nor anything else that glTF's materials have. Borrows the scene.
class TexturedGl {
 public:
  /// \throws Error unsupported where there is no such context.
  TexturedGl(const Scene& scene, int width, int height, int threads);
  ~TexturedGl();
  TexturedGl(const TexturedGl&) = delete;
  TexturedGl& operator=(const TexturedGl&) = delete;

  /// One frame, of the size that was given: clear, draw, wait until it is finished. Nothing is read back.
  void draw(const View& view);
  /// The last frame as a picture, top row first.
  [[nodiscard]] Bitmap read() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace frontmost::bench
