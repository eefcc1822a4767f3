// SPDX-License-Identifier: Apache-2.0
// State of Python's RayIndex and of its answers.
#pragma once

#include <frontmost/raycast.h>
#include <pybind11/numpy.h>

#include <memory>
#include <shared_mutex>
#include <vector>

#include "python/held.h"

namespace frontmost::python {

/// Python's RayIndex. It keeps the surfaces, whose triangles its answers refer to.
struct HeldRayIndex {
  HeldRayIndex(std::shared_ptr<HeldSurfaces> surfaces, const Execution& execution)
      : of(std::move(surfaces)), index(of->surfaces, execution) {}

  /// \throws Error bad_argument if an object was moved since.
  void check_current() const {
    if (moves != of->moves)
      throw Error(ErrorCode::bad_argument, "index", "objects were moved since; refit() follows them");
  }

  const std::shared_ptr<HeldSurfaces> of;
  std::uint64_t moves = of->moves;  ///< HeldSurfaces::moves at the last build or refit
  RayIndex index;
  /// Shared lock for queries, exclusive lock for refit(). Never waited for while holding the interpreter's lock.
  mutable std::shared_mutex reading;
};

/// Python's Hits: arrays with one element for each query.
struct HeldHits {
  py::array_t<std::uint32_t> primitive;
  py::array_t<double> t;
  py::array_t<bool> is_front;
  py::array_t<std::uint32_t> object, face;
};

[[nodiscard]] HeldHits hits_of(const std::shared_ptr<HeldSurfaces>& of, const std::vector<RayHit>& hits);

}  // namespace frontmost::python
