// SPDX-License-Identifier: Apache-2.0
// Includes the headers of all visibility methods.
#pragma once

#include "frontmost/abuffer.h"    // IWYU pragma: export
#include "frontmost/occlusion.h"  // IWYU pragma: export
#include "frontmost/painter.h"    // IWYU pragma: export
#include "frontmost/raycast.h"    // IWYU pragma: export
#include "frontmost/zbuffer.h"    // IWYU pragma: export
