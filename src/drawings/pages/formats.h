// SPDX-License-Identifier: Apache-2.0
// The formats behind save(page), and their common parts.
//
// Page --validate()--> layers --> groups --> paths --paint_of()--> fill and line colours
//
// A writer is a class over one page that appends text to a PageText; no writer converts the page first. The appearance
// of a path is computed in one place for all formats, so that all formats give the same picture.
#pragma once

#include "base/output_file.h"
#include "frontmost/sheets.h"

namespace frontmost::detail {

/// Writers get valid pages, and do not commit the file.
void save_svg(const Page& page, OutputFile& file, const Execution& execution);
void save_pdf(std::span<const Page> pages, OutputFile& file, const Execution& execution);
/// \throws Error unsupported if some path is filled, before anything is written.
void save_dxf(const Page& page, OutputFile& file, const Execution& execution);
void save_json(const Page& page, OutputFile& file, const Execution& execution);

/// Reports the progress of writing, path by path.
class WritingProgress {
 public:
  WritingProgress(std::span<const Page> pages, const Execution& execution);
  /// Counts one path. \throws Error cancelled.
  void step() {
    if (++done_ % paths_between == 0) tell();
  }

 private:
  static constexpr std::size_t paths_between = 4096;
  void tell() const;

  const Execution& execution_;
  std::size_t done_ = 0, count_ = 0;
};

/// The appearance of a path with its group's pen: the colours of its fill and its line.
struct PathPaint {
  std::optional<PageColor> fill, line;
  friend bool operator==(const PathPaint&, const PathPaint&) = default;
  [[nodiscard]] bool is_seen() const { return fill || line; }
};
[[nodiscard]] PathPaint paint_of(const PageGroup& group, std::size_t path);

}  // namespace frontmost::detail
