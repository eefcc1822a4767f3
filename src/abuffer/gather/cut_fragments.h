// SPDX-License-Identifier: Apache-2.0
// Holes in fragments: sub-samples that look through are taken out of their masks.
#pragma once

#include "abuffer/gather/gather_kernel.h"
#include "view/ray_volumes.h"

namespace frontmost::abuffer_detail {

/// To be called for the lists of a job before anybody looks at their masks, some of which become 0: such fragments show
/// nothing. O(fragments); nothing where the scene has no cut-outs. Precondition: not flat.
void cut_fragments(const GatherInput& frame, const GatherJob& job, GatherScratch& scratch);

}  // namespace frontmost::abuffer_detail
