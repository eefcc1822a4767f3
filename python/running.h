// SPDX-License-Identifier: Apache-2.0
// Long calls: without the interpreter's lock, on as many threads as asked for, ended by Ctrl-C, and watched.
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

/// One long call. Only the thread that makes it asks Python anything, and that twenty times a second at most: whether
/// there was a Ctrl-C, and to show how far the work is.
class LongCall {
 public:
  /// `threads` and `progress` are the arguments of those names; `progress` is None, False, True, or what is called with
  /// a stage and a fraction.
  LongCall(int threads, const py::object& progress);
  ~LongCall();
  LongCall(const LongCall&) = delete;
  LongCall& operator=(const LongCall&) = delete;

  [[nodiscard]] Execution execution() const { return {threads_, Isa::best, &watch_}; }
  /// Shows the last of the progress. \throws what Python raised meanwhile.
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
  py::object bar_;  ///< to be called; null without progress
  bool owns_bar_ = false;
  std::mutex mutex_;
  std::string stage_;
  double fraction_ = 0;
  Watch watch_;
};

/// The work's result; the work is given an Execution, and must not touch Python.
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
    running.finish();  // Ctrl-C, or what a callable of the caller's raised, is the reason where there is one
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
