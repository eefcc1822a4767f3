// SPDX-License-Identifier: Apache-2.0
// Where the pictures and maps of a view go: into files, of what is nearest or of layers behind it; into figures, which
// are pictures of polygons; beside a reference; and onto the terminal, when there is nowhere else.
#pragma once

#include <frontmost/image.h>

#include <functional>

#include "cli/render/jobs.h"
#include "cli/render/render_view.h"

namespace frontmost::cli {

/// What all files of a view are made from.
struct OutputSource {
  const Job& job;
  Execution execution;
  std::function<Image(OutputKind)> map;  ///< makes the map of a kind, where a file asks for it
  const Image* picture;                  ///< null where none was asked for, or only its bytes are needed
  const Bitmap* bitmap = nullptr;        ///< the picture where that is enough: see needs_only_bitmap()
  std::function<DeepImage()> deep = {};  ///< makes the deep image, where a file asks for it
};

/// Whether the job writes this.
[[nodiscard]] bool wants(const Job& job, OutputKind kind);

/// Whether the job writes anything in colours: a picture, its polygons, its layers, or a deep image.
[[nodiscard]] bool writes_colors(const Job& job);

/// Whether the picture goes nowhere but into files of 8 bits (PNG, JPEG, WebP), each its own.
[[nodiscard]] bool needs_only_bitmap(const Job& job);

/// Writes every file of the job, and notes it in the result.
void write_files(const OutputSource& source, ViewResult& result);

/// Finds, shades and writes the layers that the job asks for. \throws Error limit_exceeded for layers of more than 2^30
/// samples together.
void write_layers(const Job& job, const RenderContext& context, ViewResult& result);

/// What a report calls them.
inline constexpr std::string_view figure_name = "figure";

/// Whether a picture's name asks for polygons.
[[nodiscard]] bool is_figure(const std::string& path);

/// Orders, shades and writes the figures that the job asks for, after telling how large they will be.
/// \throws Error limit_exceeded for more polygons than the settings allow.
void write_figures(const Job& job, const RenderContext& context, const Sights& sights, ViewResult& result);

/// Reads every job's reference, so that one that cannot be read is told before anything is drawn or written. Those of
/// a long batch together may be more than memory holds: what goes beyond 2^26 pixels is let go, and read once more.
/// \throws Error when one cannot be read.
void read_references(std::vector<Job>& jobs);

/// For a picture that is not written yet: writes the difference picture where they differ by more than the threshold;
/// that is not an error here. \throws Error when the reference cannot be read, or has another size or other channels
[[nodiscard]] ReferenceResult compare_with_reference(const Image& picture, const Job& job, const Execution& execution);

/// Fits the picture to the terminal, and lets its background through, where the user did not say otherwise.
void prepare_for_terminal(Job& job, const glm::ivec2& terminal);
void show_on_terminal(const Image& picture);

}  // namespace frontmost::cli
