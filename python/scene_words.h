// SPDX-License-Identifier: Apache-2.0
// Python's words for scenes.
#pragma once

#include <frontmost/scene.h>

#include "python/words.h"

FRONTMOST_WORDS(frontmost::Axis, "axis",
                {{frontmost::Axis::x, "x"},
                 {frontmost::Axis::y, "y"},
                 {frontmost::Axis::z, "z"},
                 {frontmost::Axis::minus_x, "-x"},
                 {frontmost::Axis::minus_y, "-y"},
                 {frontmost::Axis::minus_z, "-z"},
                 {frontmost::Axis::x, "+x"},
                 {frontmost::Axis::y, "+y"},
                 {frontmost::Axis::z, "+z"}});
