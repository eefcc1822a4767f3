// SPDX-License-Identifier: Apache-2.0
// All hiding pairs of objects. The picture is divided into bands of rows; in each band the nearest keys of every object
// are compared with those of all others.
//
//    band       32 rows of the picture
//    column     64 pixels of a band: each object there has a word for each row, and its keys
//
// In most columns one of two objects lies wholly in front of the other. The common bits of their words are then
// counted, without comparing keys.
#pragma once

#include <span>
#include <vector>

#include "frontmost/report.h"
#include "report/accounting/object_mask.h"

namespace frontmost::accounting_detail {

struct HiderLists {
  std::vector<HiddenSamples> any;   ///< by every object in front of it
  std::vector<HiddenSamples> only;  ///< by a single object: samples that appear when it is removed
};

/// Ordered by object, then by hider, each pair once. `canvas` has no margin; `objects[i].in_frame` holds all that
/// object i covers in the picture. O(bands * triangles in them + covered samples + pairs of objects in a column).
[[nodiscard]] HiderLists find_all_hiders(const PlacedScene& scene, const ObjectCanvas& canvas,
                                         std::span<const ObjectAccount> objects, const Execution& execution);

}  // namespace frontmost::accounting_detail
