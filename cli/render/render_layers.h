// SPDX-License-Identifier: Apache-2.0
// render --layers: files of what is nearest, of what is behind that, and so on.
#pragma once

#include "cli/render/render_view.h"

namespace frontmost::cli {

/// Finds, shades and writes the layers that the job asks for. \throws Error limit_exceeded for layers of more than 2^30
/// samples together.
void write_layers(const Job& job, const RenderContext& context, ViewResult& result);

}  // namespace frontmost::cli
