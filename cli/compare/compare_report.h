// SPDX-License-Identifier: Apache-2.0
// What frontmost compare found out: as text, as JSON, in words, and as a page, one HTML file that holds its pictures.
#pragma once

#include <frontmost/precision.h>

#include "cli/compare/compare_culling.h"
#include "cli/compare/compare_methods.h"
#include "cli/json.h"

namespace frontmost::cli {

/// A method, and how far it agrees with the first.
struct Compared {
  MethodRun run;
  Agreement agreement;

  /// Where nothing explains the difference: a mistake, unless the method is known to make some.
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
  std::vector<std::string> files;  ///< that were written
};

/// The stages of all methods, in order.
[[nodiscard]] std::vector<std::string> stage_names(const std::vector<Compared>& methods);
[[nodiscard]] std::string mebibytes(std::uint64_t bytes);
/// What is counted where methods differ: "pixels" as long as each has one sample.
[[nodiscard]] std::string_view spots(const View& view);
/// "1920 x 1080 pixels, 4 samples each".
[[nodiscard]] std::string grid_of(const View& view, std::string_view times);
/// "medians of 5 runs".
[[nodiscard]] std::string runs_of(const Comparisons& all);
[[nodiscard]] std::uint64_t covered_samples(const Visible& visible);

/// What occlusion culling proved, in a sentence.
[[nodiscard]] std::string culling_text(const Comparisons& all);
[[nodiscard]] std::string compare_text(const Comparisons& all);
[[nodiscard]] Json compare_json(const Comparisons& all);
/// Which method suits, from these figures: sentences.
[[nodiscard]] std::vector<std::string> advice(const Comparisons& all);

/// The names of the page's files: pictures and maps of differences, and index.html.
[[nodiscard]] std::vector<std::string> page_names();
/// Writes them all into the folder, or none. \throws Error file_unwritable.
void write_page(const Comparisons& all, const std::string& folder, const Execution& execution);

}  // namespace frontmost::cli
