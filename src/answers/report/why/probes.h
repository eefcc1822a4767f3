// SPDX-License-Identifier: Apache-2.0
// What stands before hidden objects: a few samples of each, at which all that is nearer is found.
//
//    eye  ------ A ------ B -----[hidden]----- C        at this sample A and B have to go, and C does not matter
//
// The front-most object is not enough: without A the same sample may see B. So all triangles are placed once more, as
// the z-buffer places them, and held against these samples alone.
#pragma once

#include <span>
#include <vector>

#include "report/accounting/object_mask.h"

namespace frontmost::why_detail {

using accounting_detail::ObjectCanvas;

/// A sample that an object covers.
struct SampleProbe {
  std::uint32_t object;
  int x, y, sample;
};

/// A few samples of each object, spread over what it covers of the picture. `canvas`: without a margin.
[[nodiscard]] std::vector<SampleProbe> choose_probes(const PlacedScene& scene, const ObjectCanvas& canvas,
                                                     std::span<const std::uint32_t> objects,
                                                     const Execution& execution);

/// By probe: the objects that are before its own there, ascending.
[[nodiscard]] std::vector<std::vector<std::uint32_t>> find_before(const PlacedScene& scene, const ObjectCanvas& canvas,
                                                                  const std::vector<SampleProbe>& probes,
                                                                  const Execution& execution);

}  // namespace frontmost::why_detail
