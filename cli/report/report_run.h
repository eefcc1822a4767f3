// SPDX-License-Identifier: Apache-2.0
// What frontmost report found out, as all of its outputs read it.
#pragma once

#include <frontmost/report.h>

#include <string>
#include <vector>

#include "cli/json.h"
#include "cli/settings.h"

namespace frontmost::cli {

/// Those of one object, of pairs in order.
[[nodiscard]] std::span<const HiddenSamples> pairs_of(const std::vector<HiddenSamples>& all, std::uint32_t object);

struct ReportRun {
  const Settings& settings;
  const Surfaces& surfaces;
  const Visible& visible;
  const Accounting& accounts;
  const std::vector<Explanation>& why;  ///< by object
  const ObjectNames& names;
  std::vector<std::string> files;  ///< that were written

  [[nodiscard]] const View& view() const { return visible.view; }
  [[nodiscard]] const Scene& scene() const { return surfaces.scene(); }
  /// The pairs of one object with the front-most hiders.
  [[nodiscard]] std::span<const HiddenSamples> hiders_of(std::uint32_t object) const {
    return pairs_of(accounts.hidden_by_front, object);
  }
};

/// Of every object, or of those that --why names: by number. \throws UsageError where it names none.
[[nodiscard]] std::vector<std::uint32_t> objects_asked_for(const Settings& settings, const Scene& scene);
/// Says that `where`, a model, has none of what an option names, and which name is near. \throws UsageError always.
[[noreturn]] void complain_of_name(const std::string& where, std::string_view what, std::string_view name,
                                   const std::vector<std::string_view>& known);
/// Names of the nodes that the model's file hides; with --why, only those of that name.
[[nodiscard]] std::vector<std::string> hidden_asked_for(const Settings& settings, const Scene& scene);
/// Numbers of objects, those that show most first, then those of which most is in frame, then by number.
[[nodiscard]] std::vector<std::uint32_t> objects_by_sight(const Accounting& accounts);

/// A line for each object that --why names: why it is seen or not.
[[nodiscard]] std::string why_text(const ReportRun& run);
/// The beginning of a name, of at most so many bytes; characters of several bytes stay whole.
[[nodiscard]] std::string shortened(const std::string& name, std::size_t longest);

/// Two lines: what the picture shows, and how many objects are seen.
[[nodiscard]] std::string report_summary(const ReportRun& run);
/// Empty where nothing of the object is visible.
[[nodiscard]] std::string distance_text(const ObjectAccount& object);
/// Why it is seen or not, and what to change.
[[nodiscard]] std::string why_text(const ReportRun& run, std::uint32_t object);

[[nodiscard]] std::string report_text(const ReportRun& run);
[[nodiscard]] Json object_json(const ReportRun& run, std::uint32_t number);
/// What one view is, and all of its objects.
[[nodiscard]] Json view_report_json(const ReportRun& run);
[[nodiscard]] Json report_json(const ReportRun& run);

/// Prints the reports of all views of a file, and writes their data sets. `outputs` are files that must not be inputs.
void report_views(const Settings& settings, const std::vector<std::string>& outputs);

}  // namespace frontmost::cli
