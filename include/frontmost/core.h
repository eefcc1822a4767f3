// SPDX-License-Identifier: Apache-2.0
// What every method, picture and drawing stands on: meshes, surfaces, views, what is visible in them, images.
#pragma once

#include "frontmost/base.h"     // IWYU pragma: export
#include "frontmost/image.h"    // IWYU pragma: export
#include "frontmost/scene.h"    // IWYU pragma: export
#include "frontmost/version.h"  // IWYU pragma: export
#include "frontmost/view.h"     // IWYU pragma: export
