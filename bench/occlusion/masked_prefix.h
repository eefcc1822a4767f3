// SPDX-License-Identifier: Apache-2.0
// Before each file of Masked Occlusion Culling: it has functions of its own by names that newer compilers' headers
// have.
#pragma once

#include <cpuid.h>
#include <immintrin.h>

#define __cpuidex masked_cpuidex
#define _xgetbv masked_xgetbv
