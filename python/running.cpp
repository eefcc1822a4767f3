// SPDX-License-Identifier: Apache-2.0
#include "python/running.h"

namespace frontmost::python {
namespace {

constexpr std::chrono::milliseconds between_looks{50};

}  // namespace

LongCall::LongCall(int threads, const py::object& progress) : threads_(threads), next_(Clock::now() + between_looks) {
  if (threads < 0 || threads > 1024)
    throw py::value_error("threads: " + std::to_string(threads) + " is not 0 (one per core) to 1024");
  watch_.cancelled = [this] { return is_stopped(); };
  if (progress.is_none() || progress.is(py::bool_(false))) return;
  if (progress.is(py::bool_(true))) {
    bar_ = py::module_::import("frontmost._progress").attr("Bar")();
    owns_bar_ = true;
  } else if (PyCallable_Check(progress.ptr())) {
    bar_ = progress;
  } else {
    throw py::type_error("progress: must be a bool, or a function of a stage and a fraction");
  }
  watch_.progress = [this](std::string_view stage, double fraction) { note(stage, fraction); };
}

LongCall::~LongCall() = default;

bool LongCall::is_stopped() {
  if (std::this_thread::get_id() == caller_ && !stopped_ && Clock::now() >= next_) {
    const py::gil_scoped_acquire acquired;
    try {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      if (bar_) show();
    } catch (...) {
      raised_ = std::current_exception();
      stopped_ = true;
    }
    next_ = Clock::now() + between_looks;
  }
  return stopped_;
}

void LongCall::note(std::string_view stage, double fraction) {
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock) return;  // another thread is noting progress
  stage_ = stage;
  fraction_ = fraction;
}

void LongCall::show() {
  std::string stage;
  double fraction;
  {
    const std::scoped_lock lock(mutex_);
    stage = stage_;
    fraction = fraction_;
  }
  if (!stage.empty()) bar_(stage, fraction);
}

void LongCall::finish() {
  if (raised_) std::rethrow_exception(raised_);
  if (!bar_) return;
  show();
  if (owns_bar_) bar_.attr("close")();
}

}  // namespace frontmost::python
