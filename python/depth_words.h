// SPDX-License-Identifier: Apache-2.0
// Python's words for depth formats.
#pragma once

#include <frontmost/zbuffer.h>

#include "python/words.h"

FRONTMOST_WORDS(frontmost::DepthFormat, "format",
                {{frontmost::DepthFormat::d8, "d8"},
                 {frontmost::DepthFormat::d16, "d16"},
                 {frontmost::DepthFormat::d24, "d24"},
                 {frontmost::DepthFormat::f32, "f32"}});
