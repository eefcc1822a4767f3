// SPDX-License-Identifier: Apache-2.0
#include "harness/stopwatch.h"

#include <algorithm>
#include <chrono>
#include <ctime>

namespace frontmost::bench {
namespace {

double median(std::vector<double> samples) {
  std::sort(samples.begin(), samples.end());
  const std::size_t n = samples.size();
  return n % 2 == 1 ? samples[n / 2] : (samples[n / 2 - 1] + samples[n / 2]) / 2;
}

struct Samples {
  std::vector<double> wall, processor;
};

Time timed(const Contestant& contestant) {
  if (contestant.run_timed) return contestant.run_timed();
  if (contestant.prepare) contestant.prepare();
  const Time before = now();
  contestant.run();
  const Time after = now();
  return {after.wall - before.wall, after.processor - before.processor};
}

/// One turn: again and again for a while, so that a quick contestant finds its caches as it left them more often than
/// as a slow one did. What asks for preparation runs once.
Time turn(const Contestant& contestant) {
  constexpr double kLeastMs = 50;
  Time sum = timed(contestant);
  if (contestant.prepare) return sum;
  int count = 1;
  for (; sum.wall < kLeastMs; ++count) {
    const Time next = timed(contestant);
    sum.wall += next.wall;
    sum.processor += next.processor;
  }
  return {sum.wall / count, sum.processor / count};
}

}  // namespace

Time now() {
  timespec processor{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &processor);
  const auto wall = std::chrono::steady_clock::now().time_since_epoch();
  return {std::chrono::duration<double, std::milli>(wall).count(),
          1e3 * double(processor.tv_sec) + 1e-6 * double(processor.tv_nsec)};
}

std::vector<Time> race(const std::vector<Contestant>& contestants, const Sampling& sampling) {
  for (const Contestant& contestant : contestants) (void)timed(contestant);
  std::vector<Samples> samples(contestants.size());
  const double start = now().wall;
  for (int round = 0; round < sampling.rounds; ++round) {
    if (round >= 2 && now().wall - start > 1e3 * sampling.most_seconds) break;
    for (std::size_t i = 0; i < contestants.size(); ++i) {
      const Time time = turn(contestants[i]);
      samples[i].wall.push_back(time.wall);
      samples[i].processor.push_back(time.processor);
    }
  }
  std::vector<Time> times;
  times.reserve(samples.size());
  for (const Samples& s : samples) times.push_back({median(s.wall), median(s.processor)});
  return times;
}

}  // namespace frontmost::bench
