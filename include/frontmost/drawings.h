// SPDX-License-Identifier: Apache-2.0
// Hidden lines, and drawings on paper.
#pragma once

#include "frontmost/lines.h"   // IWYU pragma: export
#include "frontmost/sheets.h"  // IWYU pragma: export
