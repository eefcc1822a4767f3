// SPDX-License-Identifier: Apache-2.0
// All that hides something: bands of rows, in which every object's nearest keys are held against all others'.
//
//    band       32 rows of the picture
//    column     64 pixels of a band: of each object there a word for each row, and its keys
//
// Of two objects in a column mostly one lies wholly before the other: then the words' common bits are counted, and no
// keys are compared.
#pragma once

#include <span>
#include <vector>

#include "frontmost/report.h"
#include "report/accounting/object_mask.h"

namespace frontmost::accounting_detail {

struct HiderLists {
  std::vector<HiddenSamples> any;   ///< by whatever is before it
  std::vector<HiddenSamples> only;  ///< by one object alone: what appears when that is taken away
};

/// Ordered by object, then by hider, each pair once. `canvas`: without a margin; `in_frame`: of each object, all of
/// what it covers of the picture. O(bands * triangles of what is in them + covered samples + pairs of objects in a
/// column).
[[nodiscard]] HiderLists find_all_hiders(const PlacedScene& scene, const ObjectCanvas& canvas,
                                         std::span<const ObjectAccount> objects, const Execution& execution);

}  // namespace frontmost::accounting_detail
