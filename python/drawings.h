// SPDX-License-Identifier: Apache-2.0
// State of Python's Drawing. It keeps the surfaces, whose triangles its numbers refer to.
#pragma once

#include <frontmost/lines.h>

#include <memory>

#include "python/held.h"

namespace frontmost::python {

struct HeldDrawing {
  std::shared_ptr<HeldSurfaces> of;
  std::shared_ptr<const Drawing> drawing;
};

}  // namespace frontmost::python
