// SPDX-License-Identifier: Apache-2.0
// Measuring that can be trusted on a machine that does other things too: alternating runs, medians, processor time; how
// much memory this process has; and what the machine allows at most, on one thread.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace frontmost::bench {

/// Milliseconds.
struct Time {
  double wall = 0, processor = 0;  ///< the processor's is summed over all threads of the process
};

/// What counts: one thread's processor time is the steadier clock; of several threads the wall's is the answer.
[[nodiscard]] inline double cost(const Time& time, int threads) { return threads == 1 ? time.processor : time.wall; }

struct Sampling {
  int rounds = 7;            ///< of every contestant in turn
  double most_seconds = 10;  ///< after which no further round is begun, from the third on
};

/// What is measured, and what is done before it each time, unmeasured.
struct Contestant {
  Contestant(std::function<void()> what, std::function<void()> before = nullptr)
      : run(std::move(what)), prepare(std::move(before)) {}
  /// Somebody whose own clock counts.
  static Contestant elsewhere(std::function<Time()> what) {
    Contestant contestant(nullptr);
    contestant.run_timed = std::move(what);
    return contestant;
  }

  std::function<void()> run, prepare;
  std::function<Time()> run_timed;
};

/// Runs the contestants in turn, once unmeasured and then `rounds` times, so that what slows the machine for a while
/// slows them all. A turn is at least 50 ms long. \returns the medians of its mean, in the order given.
[[nodiscard]] std::vector<Time> race(const std::vector<Contestant>& contestants, const Sampling& sampling);

/// Now, on both clocks.
[[nodiscard]] Time now();

struct MachineLimits {
  double fill = 0, read = 0;  ///< bytes a millisecond: overwriting two planes of a picture, reading a large array
  double clock = 0;           ///< cycles a millisecond
};

/// About a second.
[[nodiscard]] MachineLimits measure_machine();

/// Resident memory of this process in bytes; 0 where the system does not say.
[[nodiscard]] std::size_t resident_bytes();
/// The most since reset_peak().
[[nodiscard]] std::size_t peak_resident_bytes();
/// Gives free memory back to the system first, so that what is used again is seen again.
void reset_peak();

}  // namespace frontmost::bench
