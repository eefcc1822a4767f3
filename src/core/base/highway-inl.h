// SPDX-License-Identifier: Apache-2.0
// Highway for kernels: include this header, and no header of Highway.
//
// A *_kernel.cpp defines HWY_TARGET_INCLUDE as its own name first. This header then includes that file again for each
// instruction set but the static one. The rest of the file is compiled for the static instruction set.
//
// Highway's operations take 1.4 s to parse for four instruction sets. So base/all_targets.h, which is precompiled,
// declares them for every instruction set. A kernel then only needs the macros of its instruction set.
#ifdef HWY_TARGET_INCLUDE
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#endif

#ifndef FRONTMOST_ALL_TARGETS_INCLUDED
#include "hwy/highway.h"
#elif defined(HWY_SET_MACROS_PER_TARGET) == defined(HWY_TARGET_TOGGLE)  // not included for this instruction set yet
#include "hwy/ops/set_macros-inl.h"
#endif
