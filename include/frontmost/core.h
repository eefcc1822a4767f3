// SPDX-License-Identifier: Apache-2.0
// Core: everything that methods, pictures and drawings share: scenes, surfaces, views, visible samples and images.
#pragma once

#include "frontmost/base.h"     // IWYU pragma: export
#include "frontmost/image.h"    // IWYU pragma: export
#include "frontmost/scene.h"    // IWYU pragma: export
#include "frontmost/version.h"  // IWYU pragma: export
#include "frontmost/view.h"     // IWYU pragma: export
