// SPDX-License-Identifier: Apache-2.0
// What Python's RayIndex holds, and its answers.
#pragma once

#include <frontmost/raycast.h>
#include <pybind11/numpy.h>

#include <memory>
#include <shared_mutex>
#include <vector>

#include "python/held.h"

namespace frontmost::python {

/// Python's RayIndex. Answers name triangles of the surfaces, which it keeps.
struct HeldRayIndex {
  HeldRayIndex(std::shared_ptr<HeldSurfaces> surfaces, const Execution& execution)
      : of(std::move(surfaces)), index(of->surfaces, execution) {}

  /// \throws Error bad_argument where an object was moved since.
  void check_current() const {
    if (moves != of->moves)
      throw Error(ErrorCode::bad_argument, "index", "objects were moved since; refit() follows them");
  }

  const std::shared_ptr<HeldSurfaces> of;
  std::uint64_t moves = of->moves;  ///< HeldSurfaces::moves when it was made or refitted
  RayIndex index;
  /// Held by whoever asks, and alone by refit(); never waited for with the interpreter's lock.
  mutable std::shared_mutex reading;
};

/// Python's Hits: arrays with an element for each query.
struct HeldHits {
  py::array_t<std::uint32_t> primitive;
  py::array_t<double> t;
  py::array_t<bool> is_front;
  py::array_t<std::uint32_t> object, face;
};

[[nodiscard]] HeldHits hits_of(const std::shared_ptr<HeldSurfaces>& of, const std::vector<RayHit>& hits);

}  // namespace frontmost::python
