// SPDX-License-Identifier: Apache-2.0
// A scene with its base colour textures, drawn by Mesa's software OpenGL.
#pragma once

#include <memory>

#include "peers/gl.h"

namespace frontmost::bench {

/// Draws all instances with their base colour textures, filtered trilinearly, the holes of alpha mode MASK, and one
/// light at the camera's upper left. Shadows and all other properties of glTF materials are left out. Borrows the
/// scene.
class TexturedGl {
 public:
  /// \throws Error unsupported if there is no such context.
  TexturedGl(const Scene& scene, int width, int height, int threads);
  ~TexturedGl();
  TexturedGl(const TexturedGl&) = delete;
  TexturedGl& operator=(const TexturedGl&) = delete;

  /// Draws one frame of the constructor's size: clears, draws, and waits until the frame is finished. Nothing is read
  /// back.
  void draw(const View& view);
  /// The last frame as a picture, top row first.
  [[nodiscard]] Bitmap read() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace frontmost::bench
