// SPDX-License-Identifier: Apache-2.0
// What Python's Drawing holds: the surfaces, whose triangles its numbers mean.
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
