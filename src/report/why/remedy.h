// SPDX-License-Identifier: Apache-2.0
// What to change in a view, in round numbers.
#pragma once

#include "report/why/places.h"

namespace frontmost::why_detail {

/// For an object that `reason`, one of those up to no_sample, keeps from being seen; nothing where nothing helps.
[[nodiscard]] Remedy remedy_for(SightReason reason, const ObjectPlaces& places, const View& view);

}  // namespace frontmost::why_detail
