// SPDX-License-Identifier: Apache-2.0
// The compared methods, and how to run and time each. Each method runs in a process of its own, so that its memory can
// be measured.
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

/// A step of the work, and the milliseconds that it took each time.
struct Stage {
  std::string name;
  std::vector<double> times;
};

/// Collects the times of stages, in the order of their first occurrence.
class StageClock {
 public:
  /// Runs `work`, notes its time, and returns its result.
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

/// The answer of a method, and the size of its input.
struct Answer {
  Visible visible;
  std::optional<Visible> behind;  ///< layer behind the front-most, if the method finds it
  std::uint64_t primitives = 0;   ///< triangles that the method works on
};

/// The number of fragments, and the length of the longest list, for methods that keep lists of fragments.
struct KeptLists {
  std::uint64_t fragments = 0, longest = 0;
};

struct ComparedMethod {
  std::string_view name;   ///< as in render --method
  std::string_view title;  ///< the common name
  std::string_view how;    ///< the principle, in a sentence
  Answer (*answer)(const Surfaces&, const View&, const Execution&, StageClock&);
  KeptLists (*lists)(const Surfaces&, const View&, const Execution&) = nullptr;  ///< counts the lists, outside of the
                                                                                 ///< timing
  bool is_naive = false;  ///< known to be wrong: shown, but not counted among those that agree
};

/// Returns the compared methods. All others are compared with the first one.
[[nodiscard]] std::span<const ComparedMethod> compared_methods();

/// The run of one method.
struct MethodRun {
  const ComparedMethod* method = nullptr;
  std::vector<Stage> stages;     ///< "load" and "surfaces" have one time, stages of the method --runs times
  std::uint64_t peak_bytes = 0;  ///< peak of resident memory beyond model and surfaces
  Answer answer;
  std::optional<KeptLists> lists;

  /// Returns the number of times that the method ran.
  [[nodiscard]] std::size_t runs() const { return stages.empty() ? 0 : stages.back().times.size(); }
  /// Returns the median time of a stage, or nothing if the method lacks the stage.
  [[nodiscard]] std::optional<double> median_of(std::string_view stage) const;
};

/// Reads the model and runs the method in a process of its own. Precondition: this process has no threads yet. \throws
/// the method's error; Error unsupported if the other process ends without a result.
[[nodiscard]] MethodRun run_alone(const ComparedMethod& method, const Settings& settings);

}  // namespace frontmost::cli
