// SPDX-License-Identifier: Apache-2.0
// The visible edges of a view, drawn over its picture: render --edges.
#pragma once

#include <frontmost/lines.h>
#include <frontmost/sheets.h>

#include "cli/render/render_view.h"

namespace frontmost::cli {

/// \throws UsageError for outputs and options that exclude edges, and for outputs without a picture or figure.
void check_edges(const Settings& settings, const Job& job);

/// Returns the visible edges of the surfaces, in pixels of the view. The first view takes longer than further ones.
[[nodiscard]] Strokes edges_of(const RenderContext& context, const View& view);

/// Draws edges over a picture of the view.
void add_edges(Image& picture, const Strokes& edges, const Job& job, const View& view, const Execution& execution);

/// Adds a layer of edges to the page of a figure of the view.
void add_edges(Page& page, const Strokes& edges, const Job& job, const RenderContext& context, const View& view);

}  // namespace frontmost::cli
