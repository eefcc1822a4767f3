// SPDX-License-Identifier: Apache-2.0
// Highway's operations for every instruction set, to be precompiled. Kernels use them through base/highway-inl.h.
#pragma once

// foreach_target.h includes hwy/highway.h once for each instruction set but the static one.
#define HWY_TARGET_INCLUDE "hwy/highway.h"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"

// A kernel includes foreach_target.h again. In Highway 1.0 that header must not find these macros defined.
#undef HWY_TARGET_INCLUDE
#undef HIGHWAY_HWY_FOREACH_TARGET_H_
#undef HWY_HIGHWAY_INCLUDED
#undef HWY_HIGHWAY_PER_TARGET
#undef HWY_SET_MACROS_PER_TARGET
#undef HWY_TARGET_TOGGLE

#define FRONTMOST_ALL_TARGETS_INCLUDED
