// SPDX-License-Identifier: Apache-2.0
// All segments in which the triangles of a mesh cross, as a single view finds them.
#pragma once

#include "lines/crossings/crossings.h"

namespace frontmost::test {

inline std::vector<lines_detail::Crossing> crossings_of(const lines_detail::WeldedMesh& mesh,
                                                        const lines_detail::Features& features,
                                                        const Execution& execution) {
  return find_crossings(features, find_crossed_pairs(mesh, features, execution), execution);
}

}  // namespace frontmost::test
