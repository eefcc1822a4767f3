// SPDX-License-Identifier: Apache-2.0
// Long calls: they release the interpreter's lock, use the requested threads, react to Ctrl-C, and report progress.
#pragma once

#include <frontmost/base.h>
#include <pybind11/pybind11.h>

#include <atomic>
#include <chrono>
#include <exception>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

namespace frontmost::python {

namespace py = pybind11;

/// One long call. Only the calling thread talks to Python, at most twenty times a second: it checks for Ctrl-C and
/// shows the progress.
class LongCall {
 public:
  /// `threads` and `progress` are the Python arguments of those names. `progress` is None, False, True, or a callable
  /// that takes a stage and a fraction.
  LongCall(int threads, const py::object& progress);
  ~LongCall();
  LongCall(const LongCall&) = delete;
  LongCall& operator=(const LongCall&) = delete;

  [[nodiscard]] Execution execution() const { return {threads_, Isa::best, &watch_}; }
  /// Shows the final progress. \throws an exception that Python raised meanwhile.
  void finish();

 private:
  using Clock = std::chrono::steady_clock;
  bool is_stopped();
  void note(std::string_view stage, double fraction);
  void show();

  int threads_;
  std::thread::id caller_ = std::this_thread::get_id();
  Clock::time_point next_;
  std::atomic<bool> stopped_ = false;
  std::exception_ptr raised_;
  py::object bar_;  ///< called with progress; null without
  bool owns_bar_ = false;
  std::mutex mutex_;
  std::string stage_;
  double fraction_ = 0;
  Watch watch_;
};

/// Runs `work` with an Execution and returns its result. `work` must not touch Python.
template <class Work>
auto run(int threads, const py::object& progress, const Work& work) {
  LongCall running(threads, progress);
  std::exception_ptr failure;
  using Result = decltype(work(running.execution()));
  const auto guarded = [&](const auto& body) {
    try {
      const py::gil_scoped_release released;
      body();
    } catch (const Error&) {
      failure = std::current_exception();
    }
    running.finish();  // throws Ctrl-C or an exception of the caller's callable first, since they are the cause
    if (failure) std::rethrow_exception(failure);
  };
  if constexpr (std::is_void_v<Result>) {
    guarded([&] { work(running.execution()); });
  } else {
    std::optional<Result> result;
    guarded([&] { result.emplace(work(running.execution())); });
    return std::move(*result);
  }
}

}  // namespace frontmost::python
