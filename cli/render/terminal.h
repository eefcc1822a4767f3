// SPDX-License-Identifier: Apache-2.0
// The picture right on the terminal, when there is nowhere else for it to go.
#pragma once

#include <frontmost/image.h>

#include "cli/render/jobs.h"

namespace frontmost::cli {

/// Fits the picture to the terminal, and lets its background through, where the user did not say otherwise.
void prepare_for_terminal(Job& job, const glm::ivec2& terminal);
void show_on_terminal(const Image& picture);

}  // namespace frontmost::cli
