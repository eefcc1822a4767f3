// SPDX-License-Identifier: Apache-2.0
// Rendering one view of a model that is read piece by piece.
#pragma once

#include <frontmost/stream.h>

#include "cli/render/render_view.h"

namespace frontmost::cli {

/// How to run.
struct StreamContext {
  const RunSettings& run;
  Execution execution;
  bool keep_picture = false;
};

/// As render_view(): a pass to find the camera, unless it was told; one to find what is visible; and one for shadows
/// and smooth normals, where the picture has them.
/// \throws Error unsupported where standard input would have to be read again
[[nodiscard]] ViewResult render_streamed_view(const Job& job, Stream& stream, const StreamContext& context);

}  // namespace frontmost::cli
