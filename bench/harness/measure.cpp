// SPDX-License-Identifier: Apache-2.0
#include "harness/measure.h"

#include <frontmost/base.h>
#include <malloc.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <string>

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

/// One turn: repeats a contestant for a while, so that a quick one finds its caches warm as often as a slow one does. A
/// contestant with a preparation runs once.
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

constexpr std::size_t kPlanes = std::size_t(1920) * 1080 * 8;
constexpr std::size_t kLargeArray = std::size_t(512) << 20;

/// Keeps a result from being optimised away.
void keep(std::uint64_t value) { asm volatile("" : : "r"(value)); }

double milliseconds(const std::function<void()>& work) {
  return race({Contestant(work)}, {.rounds = 9, .most_seconds = 1})[0].processor;
}

std::uint64_t sum(const Buffer<std::uint64_t>& array) {
  std::uint64_t parts[4] = {};
  for (std::size_t i = 0; i < array.size(); i += 4)
    for (std::size_t k = 0; k < 4; ++k) parts[k] += array[i + k];
  return parts[0] + parts[1] + parts[2] + parts[3];
}

/// A chain of multiplications. Each waits 3 cycles for the one before, on every x86-64 processor since 2011.
void multiply(std::uint64_t count) {
  std::uint64_t value = 3;
  for (std::uint64_t i = 0; i < count; ++i) value *= value;
  keep(value);
}

/// Reads a field of /proc/self/status, such as "VmHWM:   1234 kB", as bytes.
std::size_t status_bytes(const char* field) {
  std::FILE* file = std::fopen("/proc/self/status", "r");
  if (file == nullptr) return 0;
  char line[256];
  std::size_t kilobytes = 0;
  while (std::fgets(line, sizeof line, file) != nullptr)
    if (std::strncmp(line, field, std::strlen(field)) == 0)
      (void)std::sscanf(line + std::strlen(field), ": %zu", &kilobytes);
  std::fclose(file);
  return kilobytes * 1024;
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

MachineLimits measure_machine() {
  MachineLimits limits;
  Buffer<std::uint64_t> planes(kPlanes / 8, 1), large(kLargeArray / 8, 1);
  limits.fill = double(kPlanes) / milliseconds([&] { std::memset(planes.data(), 1, kPlanes); });
  keep(planes[planes.size() / 2]);
  limits.read = double(kLargeArray) / milliseconds([&] { keep(sum(large)); });
  constexpr std::uint64_t kMultiplications = 10'000'000;
  limits.clock = 3 * double(kMultiplications) / milliseconds([] { multiply(kMultiplications); });
  return limits;
}

std::size_t resident_bytes() { return status_bytes("VmRSS"); }
std::size_t peak_resident_bytes() { return status_bytes("VmHWM"); }

void reset_peak() {
#if defined(__GLIBC__)
  malloc_trim(0);
#endif
  if (std::FILE* file = std::fopen("/proc/self/clear_refs", "w")) {
    std::fputs("5", file);  // resets the peak to the present resident size
    std::fclose(file);
  }
}

}  // namespace frontmost::bench
