// SPDX-License-Identifier: Apache-2.0
// State of Python's ExactVisible, which finds depth fights and their remedies.
#pragma once

#include <frontmost/precision.h>

#include <memory>

#include "python/held.h"

namespace frontmost::python {

struct HeldExact {
  std::shared_ptr<HeldSurfaces> of;
  std::shared_ptr<const ExactVisible> exact;
  std::uint64_t moves = 0;  ///< HeldSurfaces::moves at the time of the search

  /// \throws Error bad_argument if an object was moved since.
  void check_current() const {
    if (moves != of->moves)
      throw Error(ErrorCode::bad_argument, "exact", "objects were moved since; look at the surfaces again");
  }
};

}  // namespace frontmost::python
