// SPDX-License-Identifier: Apache-2.0
// The formats behind save(page), and how they walk over a page.
//
//   Page --validate()--> layers --> groups --> paths --paint_of()--> is it filled, has it a line, which colours?
//
// A writer is a class over one page that appends text to a PageText; none of them keeps the page in another form. What
// a path looks like is worked out in one place for all formats, so that a picture is the same in each.
#pragma once

#include "base/output_file.h"
#include "frontmost/sheets.h"

namespace frontmost::detail {

/// Writers get pages that are valid, and do not commit the file.
void save_svg(const Page& page, OutputFile& file, const Execution& execution);
void save_pdf(std::span<const Page> pages, OutputFile& file, const Execution& execution);
/// \throws Error unsupported where something is filled, before anything is written.
void save_dxf(const Page& page, OutputFile& file, const Execution& execution);
void save_json(const Page& page, OutputFile& file, const Execution& execution);

/// Tells the watch how far writing is, path by path.
class WritingProgress {
 public:
  WritingProgress(std::span<const Page> pages, const Execution& execution);
  /// One path more. \throws Error cancelled.
  void step() {
    if (++done_ % paths_between == 0) tell();
  }

 private:
  static constexpr std::size_t paths_between = 4096;
  void tell() const;

  const Execution& execution_;
  std::size_t done_ = 0, count_ = 0;
};

/// What a path looks like with its group's pen: whether it is filled, and with which line around it.
struct PathPaint {
  std::optional<PageColor> fill, line;
  friend bool operator==(const PathPaint&, const PathPaint&) = default;
  [[nodiscard]] bool is_seen() const { return fill || line; }
};
[[nodiscard]] PathPaint paint_of(const PageGroup& group, std::size_t path);

}  // namespace frontmost::detail
