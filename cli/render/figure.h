// SPDX-License-Identifier: Apache-2.0
// render -o FILE.svg or .pdf: a picture of polygons, painted one over the other.
#pragma once

#include "cli/render/render_view.h"

namespace frontmost::cli {

/// What a report calls them.
inline constexpr std::string_view figure_name = "figure";

/// Whether a picture's name asks for polygons.
[[nodiscard]] bool is_figure(const std::string& path);

/// Orders, shades and writes the figures that the job asks for, after telling how large they will be.
/// \throws Error limit_exceeded for more polygons than the settings allow.
void write_figures(const Job& job, const RenderContext& context, const Sights& sights, ViewResult& result);

}  // namespace frontmost::cli
