// SPDX-License-Identifier: Apache-2.0
// Results of frontmost report, which all of its outputs read.
#pragma once

#include <frontmost/report.h>

#include <string>
#include <vector>

#include "cli/json.h"
#include "cli/settings.h"

namespace frontmost::cli {

/// Returns the pairs of one hidden object. Precondition: `all` is sorted.
[[nodiscard]] std::span<const HiddenSamples> pairs_of(const std::vector<HiddenSamples>& all, std::uint32_t object);

struct ReportRun {
  const Settings& settings;
  const Surfaces& surfaces;
  const Visible& visible;
  const Accounting& accounts;
  const std::vector<Explanation>& why;  ///< by object
  const ObjectNames& names;
  std::vector<std::string> files;  ///< files that were written

  [[nodiscard]] const View& view() const { return visible.view; }
  [[nodiscard]] const Scene& scene() const { return surfaces.scene(); }
  /// Returns the pairs of one object with its front-most hiders.
  [[nodiscard]] std::span<const HiddenSamples> hiders_of(std::uint32_t object) const {
    return pairs_of(accounts.hidden_by_front, object);
  }
};

/// Returns the numbers of all objects, or of those that --why names. \throws UsageError if --why names no object.
[[nodiscard]] std::vector<std::uint32_t> objects_asked_for(const Settings& settings, const Scene& scene);
/// Reports that `where`, a model, has no `what` called `name`, and suggests similar names. \throws UsageError always.
[[noreturn]] void complain_of_name(const std::string& where, std::string_view what, std::string_view name,
                                   const std::vector<std::string_view>& known);
/// Returns the names of the nodes that the model's file hides; with --why NAME, only of nodes called NAME.
[[nodiscard]] std::vector<std::string> hidden_asked_for(const Settings& settings, const Scene& scene);
/// Returns the numbers of objects, sorted by visible samples, then by samples in the frame, then by number.
[[nodiscard]] std::vector<std::uint32_t> objects_by_sight(const Accounting& accounts);

/// Returns a line for each object that --why names: why it is visible or not.
[[nodiscard]] std::string why_text(const ReportRun& run);
/// Returns the start of a name, at most `longest` bytes. UTF-8 characters stay whole.
[[nodiscard]] std::string shortened(const std::string& name, std::size_t longest);

/// Returns two lines: the picture, and the number of visible objects.
[[nodiscard]] std::string report_summary(const ReportRun& run);
/// Returns the object's distance, or an empty text if nothing of the object is visible.
[[nodiscard]] std::string distance_text(const ObjectAccount& object);
/// Returns why the object is visible or not, and what to change.
[[nodiscard]] std::string why_text(const ReportRun& run, std::uint32_t object);

[[nodiscard]] std::string report_text(const ReportRun& run);
[[nodiscard]] Json object_json(const ReportRun& run, std::uint32_t number);
/// Returns the report of one view, with all of its objects.
[[nodiscard]] Json view_report_json(const ReportRun& run);
[[nodiscard]] Json report_json(const ReportRun& run);

/// Prints the reports of all views of a file, and writes their data sets. No input may be one of `outputs`.
void report_views(const Settings& settings, const std::vector<std::string>& outputs);

}  // namespace frontmost::cli
