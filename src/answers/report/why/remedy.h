// SPDX-License-Identifier: Apache-2.0
// Remedies: changes of a view, in round numbers.
#pragma once

#include "report/why/lone_object.h"
#include "report/why/places.h"

namespace frontmost::why_detail {

/// The remedy for an object that `reason`, one of those before no_sample, keeps from being seen; none if nothing helps.
[[nodiscard]] Remedy remedy_for(SightReason reason, const ObjectPlaces& places, const View& view);
/// The remedy for an object that covers no sample: the first of some growing pictures in which it covers one. None if
/// no picture of up to 16384 pixels each way suffices.
[[nodiscard]] Remedy enlargement_for(const LoneObject& lone, const ObjectPlaces& places, const View& view);

}  // namespace frontmost::why_detail
