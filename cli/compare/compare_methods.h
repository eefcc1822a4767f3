// SPDX-License-Identifier: Apache-2.0
// The methods that frontmost compare lays side by side, how each is run and timed, and the run of one in a process of
// its own, so that the memory it takes can be told from everybody else's.
#pragma once

#include <frontmost/scene.h>
#include <frontmost/view.h>

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cli/settings.h"
#include "cli/stopwatch.h"

namespace frontmost::cli {

/// Something that took time, once or several times; milliseconds.
struct Stage {
  std::string name;
  std::vector<double> times;
};

/// Collects the times of stages, in the order in which they first came.
class StageClock {
 public:
  /// Calls `work` and returns what it returns.
  template <class Work>
  auto time(std::string_view name, const Work& work) {
    const Stopwatch watch;
    auto result = work();
    note(name, watch.milliseconds());
    return result;
  }
  void note(std::string_view name, double milliseconds);
  [[nodiscard]] const std::vector<Stage>& stages() const { return stages_; }

 private:
  std::vector<Stage> stages_;
};

/// What a method answers, and how much it had to do for that.
struct Answer {
  Visible visible;
  std::optional<Visible> behind;  ///< what shows through the front-most, of methods that know
  std::uint64_t primitives = 0;   ///< triangles that it works on
};

/// The lists of fragments, of methods that keep them.
struct KeptLists {
  std::uint64_t fragments = 0, longest = 0;
};

struct ComparedMethod {
  std::string_view name;   ///< as for render --method
  std::string_view title;  ///< as people call it
  std::string_view how;    ///< in a sentence
  Answer (*answer)(const Surfaces&, const View&, const Execution&, StageClock&);
  KeptLists (*lists)(const Surfaces&, const View&, const Execution&) = nullptr;  ///< counted apart, beside the clock
  bool is_naive = false;  ///< known to be wrong: shown to be seen, and not counted among those that agree
};

/// The first is the one that the others are compared with.
[[nodiscard]] std::span<const ComparedMethod> compared_methods();

/// How it went.
struct MethodRun {
  const ComparedMethod* method = nullptr;
  std::vector<Stage> stages;     ///< "load" and "surfaces" once, those of the method --runs times
  std::uint64_t peak_bytes = 0;  ///< of resident memory, beyond what model and surfaces hold
  Answer answer;
  std::optional<KeptLists> lists;

  /// How often the method ran.
  [[nodiscard]] std::size_t runs() const { return stages.empty() ? 0 : stages.back().times.size(); }
  /// Medians; null for a stage that it has not.
  [[nodiscard]] std::optional<double> median_of(std::string_view stage) const;
};

/// Reads the model and runs the method. Precondition: this process has no threads yet.
/// \throws what the method throws there; Error unsupported when it ends otherwise.
[[nodiscard]] MethodRun run_alone(const ComparedMethod& method, const Settings& settings);

}  // namespace frontmost::cli
