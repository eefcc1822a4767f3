// SPDX-License-Identifier: Apache-2.0
// Output of frontmost compare: text, JSON, sentences, and a page (one HTML file with embedded pictures).
#pragma once

#include <frontmost/precision.h>

#include "cli/compare/compare_culling.h"
#include "cli/compare/compare_methods.h"
#include "cli/json.h"

namespace frontmost::cli {

/// A method, and its agreement with the first method.
struct Compared {
  MethodRun run;
  Agreement agreement;

  /// Returns the number of differences that nothing explains, or 0 for a method that is known to be wrong.
  [[nodiscard]] std::uint64_t unexplained() const { return run.method->is_naive ? 0 : wrong(); }
  [[nodiscard]] std::uint64_t wrong_by_design() const { return run.method->is_naive ? wrong() : 0; }

 private:
  [[nodiscard]] std::uint64_t wrong() const { return agreement.count(Difference::unexplained); }
};

struct Comparisons {
  const Settings& settings;
  const Surfaces& surfaces;
  View view;
  std::vector<Compared> methods;
  CullingRun culling;
  std::vector<std::string> files;  ///< files that were written
};

/// Returns the stages of all methods, in order.
[[nodiscard]] std::vector<std::string> stage_names(const std::vector<Compared>& methods);
[[nodiscard]] std::string mebibytes(std::uint64_t bytes);
/// Returns the unit of differences: "pixels" if each has one sample.
[[nodiscard]] std::string_view spots(const View& view);
/// Returns the grid in words, as in "1920 x 1080 pixels, 4 samples each".
[[nodiscard]] std::string grid_of(const View& view, std::string_view times);
/// Returns the number of runs in words, as in "medians of 5 runs".
[[nodiscard]] std::string runs_of(const Comparisons& all);
[[nodiscard]] std::uint64_t covered_samples(const Visible& visible);

/// Returns a sentence about the results of occlusion culling.
[[nodiscard]] std::string culling_text(const Comparisons& all);
[[nodiscard]] std::string compare_text(const Comparisons& all);
[[nodiscard]] Json compare_json(const Comparisons& all);
/// Returns sentences that tell which method suits, according to these figures.
[[nodiscard]] std::vector<std::string> advice(const Comparisons& all);

/// Returns the names of the page's files: pictures, difference maps, and index.html.
[[nodiscard]] std::vector<std::string> page_names();
/// Writes the page's files into the folder, or none of them. \throws Error file_unwritable.
void write_page(const Comparisons& all, const std::string& folder, const Execution& execution);

}  // namespace frontmost::cli
