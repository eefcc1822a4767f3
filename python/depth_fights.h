// SPDX-License-Identifier: Apache-2.0
// What Python's ExactVisible holds, of which depth fights and their remedies are asked.
#pragma once

#include <frontmost/precision.h>

#include <memory>

#include "python/held.h"

namespace frontmost::python {

struct HeldExact {
  std::shared_ptr<HeldSurfaces> of;
  std::shared_ptr<const ExactVisible> exact;
  std::uint64_t moves = 0;  ///< HeldSurfaces::moves when it was found

  /// \throws Error bad_argument where an object was moved since.
  void check_current() const {
    if (moves != of->moves)
      throw Error(ErrorCode::bad_argument, "exact", "objects were moved since; look at the surfaces again");
  }
};

}  // namespace frontmost::python
