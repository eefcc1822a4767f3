// SPDX-License-Identifier: Apache-2.0
// One method in a process of its own, so that the memory it takes can be told from everybody else's.
#pragma once

#include "cli/compare/compare_methods.h"
#include "cli/settings.h"

namespace frontmost::cli {

/// How it went.
struct MethodRun {
  const ComparedMethod* method = nullptr;
  std::vector<Stage> stages;     ///< "load" and "surfaces" once, those of the method --runs times
  std::uint64_t peak_bytes = 0;  ///< of resident memory, beyond what model and surfaces hold
  Answer answer;
  std::optional<KeptLists> lists;

  /// Medians; null for a stage that it has not.
  [[nodiscard]] std::optional<double> median_of(std::string_view stage) const;
};

/// Reads the model and runs the method. Precondition: this process has no threads yet.
/// \throws what the method throws there; Error unsupported when it ends otherwise.
[[nodiscard]] MethodRun run_alone(const ComparedMethod& method, const Settings& settings);

}  // namespace frontmost::cli
