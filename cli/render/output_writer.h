// SPDX-License-Identifier: Apache-2.0
// Outputs of a view: image files of the front-most surface or of layers, figures (pictures of polygons), the comparison
// with a reference, and the terminal if there is no other output.
#pragma once

#include <frontmost/image.h>

#include <functional>

#include "cli/render/jobs.h"
#include "cli/render/render_view.h"

namespace frontmost::cli {

/// The source of all files of a view.
struct OutputSource {
  const Job& job;
  Execution execution;
  std::function<Image(OutputKind)> map;  ///< makes the map of a kind when a file needs it
  const Image* picture;                  ///< null if not needed, or if the bitmap suffices
  const Bitmap* bitmap = nullptr;        ///< the picture in bytes, if it suffices: see needs_only_bitmap()
  std::function<DeepImage()> deep = {};  ///< makes the deep image when a file needs it
};

/// Whether the job writes outputs of this kind.
[[nodiscard]] bool wants(const Job& job, OutputKind kind);

/// Whether the job writes coloured outputs: a picture, polygons, layers, or a deep image.
[[nodiscard]] bool writes_colors(const Job& job);

/// Whether the picture goes only into separate 8-bit files (PNG, JPEG, WebP), and has no edges.
[[nodiscard]] bool needs_only_bitmap(const Job& job);

/// Writes all files of the job and notes them in the result.
void write_files(const OutputSource& source, ViewResult& result);

/// Finds, shades and writes the job's layers. \throws Error limit_exceeded if all layers together have more than 2^30
/// samples.
void write_layers(const Job& job, const RenderContext& context, ViewResult& result);

/// The name of figures in reports.
inline constexpr std::string_view figure_name = "figure";

/// Whether the suffix of a picture's name asks for polygons.
[[nodiscard]] bool is_figure(const std::string& path);

/// Sorts, shades and writes the job's figures, after printing their approximate size.
/// \throws Error limit_exceeded for more polygons than the settings allow.
void write_figures(const Job& job, const RenderContext& context, const Sights& sights, ViewResult& result);

/// Reads the references of all jobs, so that an unreadable reference is reported before anything is drawn. References
/// of a long batch may not fit into memory, so pictures beyond 2^26 pixels are dropped and read again later. \throws
/// Error if a reference cannot be read.
void read_references(std::vector<Job>& jobs);

/// Compares a picture that is not written yet with the reference. Writes the difference picture if the pictures differ
/// by more than the threshold, which is no error here. \throws Error if the reference cannot be read, or has another
/// size or other channels.
[[nodiscard]] ReferenceResult compare_with_reference(const Image& picture, const Job& job, const Execution& execution);

/// Fits the picture to the terminal, and makes its background transparent, unless the user chose otherwise.
void prepare_for_terminal(Job& job, const glm::ivec2& terminal);
void show_on_terminal(const Image& picture);

}  // namespace frontmost::cli
