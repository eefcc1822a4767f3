// SPDX-License-Identifier: Apache-2.0
// The objects in front of hidden objects, found at a few samples of each hidden object.
//
//    eye  ------ A ------ B -----[hidden]----- C        A and B have to be removed for this sample, C does not
//
// The front-most object is not enough: without A the same sample may see B. All triangles are therefore placed once
// more, as in the z-buffer, and tested at these samples alone.
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

/// Chooses a few samples of each object, spread over the part of the picture that it covers. `canvas` has no margin.
[[nodiscard]] std::vector<SampleProbe> choose_probes(const PlacedScene& scene, const ObjectCanvas& canvas,
                                                     std::span<const std::uint32_t> objects,
                                                     const Execution& execution);

/// The objects in front of each probe's own object, ascending, by probe.
[[nodiscard]] std::vector<std::vector<std::uint32_t>> find_before(const PlacedScene& scene, const ObjectCanvas& canvas,
                                                                  const std::vector<SampleProbe>& probes,
                                                                  const Execution& execution);

}  // namespace frontmost::why_detail
