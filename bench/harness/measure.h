// SPDX-License-Identifier: Apache-2.0
// Measuring on a machine that does other things too: alternating runs, medians and processor time; the memory of this
// process; and the limits of the machine on one thread.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace frontmost::bench {

/// Times in milliseconds.
struct Time {
  double wall = 0, processor = 0;  ///< the processor's time is summed over all threads of the process
};

/// The time to compare: processor time for one thread, as it is the steadier clock; wall time for several threads.
[[nodiscard]] inline double cost(const Time& time, int threads) { return threads == 1 ? time.processor : time.wall; }

struct Sampling {
  int rounds = 7;            ///< for each contestant
  double most_seconds = 10;  ///< no further round begins after this time, from the third round on
};

/// Work to measure, and unmeasured work to do before each run.
struct Contestant {
  Contestant(std::function<void()> what, std::function<void()> before = nullptr)
      : run(std::move(what)), prepare(std::move(before)) {}
  /// A contestant that runs elsewhere and reports its own time.
  static Contestant elsewhere(std::function<Time()> what) {
    Contestant contestant(nullptr);
    contestant.run_timed = std::move(what);
    return contestant;
  }

  std::function<void()> run, prepare;
  std::function<Time()> run_timed;
};

/// Runs the contestants in turn, once unmeasured and then `rounds` times, so that a slow spell of the machine hits all.
/// A turn lasts at least 50 ms. \returns the median of the mean times per turn of each contestant, in the order given.
[[nodiscard]] std::vector<Time> race(const std::vector<Contestant>& contestants, const Sampling& sampling);

/// The present time on both clocks.
[[nodiscard]] Time now();

struct MachineLimits {
  double fill = 0, read = 0;  ///< bytes a millisecond: overwriting two planes of a picture, reading a large array
  double clock = 0;           ///< cycles a millisecond
};

/// Takes about a second.
[[nodiscard]] MachineLimits measure_machine();

/// Resident memory of this process in bytes; 0 where the system does not say.
[[nodiscard]] std::size_t resident_bytes();
/// Most resident memory since reset_peak(), in bytes.
[[nodiscard]] std::size_t peak_resident_bytes();
/// Resets the peak, after returning free memory to the system, so that memory in use again counts again.
void reset_peak();

}  // namespace frontmost::bench
