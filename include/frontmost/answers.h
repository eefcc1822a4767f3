// SPDX-License-Identifier: Apache-2.0
// Answers: what is seen, what hides the rest, and what a depth buffer cannot tell apart.
#pragma once

#include "frontmost/precision.h"  // IWYU pragma: export
#include "frontmost/report.h"     // IWYU pragma: export
