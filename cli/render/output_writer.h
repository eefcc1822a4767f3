// SPDX-License-Identifier: Apache-2.0
// Writing the files of one view, however it was seen.
#pragma once

#include <frontmost/image.h>

#include <functional>

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

/// Whether the picture goes nowhere but into PNG files of 8 bits, each its own.
[[nodiscard]] bool needs_only_bitmap(const Job& job);

/// Writes every file of the job, and notes it in the result.
void write_files(const OutputSource& source, ViewResult& result);

}  // namespace frontmost::cli
