// SPDX-License-Identifier: Apache-2.0
// Included before each file of Masked Occlusion Culling, whose own functions have names that newer compilers' headers
// define too.
#pragma once

#include <cpuid.h>
#include <immintrin.h>

#define __cpuidex masked_cpuidex
#define _xgetbv masked_xgetbv
