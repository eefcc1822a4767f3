// SPDX-License-Identifier: Apache-2.0
// OSMesa: contexts that draw into memory of the program. The ABI is that of libOSMesa.so.8.
#pragma once

#include <vector>

#include "calls/context.h"

struct osmesa_context {
  frontmost::gl_detail::Context gl;
  GLenum format;
  void* buffer = nullptr;  ///< null before OSMesaMakeCurrent
  int row_length = 0;      ///< pixels; 0 for the width
  bool y_up = true;
  std::vector<GLuint> depths;  ///< plane that OSMesaGetDepthBuffer returned

  osmesa_context(GLenum pixel_format, frontmost::gl_detail::Context* shares_with)
      : gl(shares_with), format(pixel_format) {}
};

namespace frontmost::gl_detail {

/// Copies the frame of the calling thread's context to the memory of the program.
void show_frame();

}  // namespace frontmost::gl_detail
