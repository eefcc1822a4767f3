// SPDX-License-Identifier: Apache-2.0
#include "harness/machine.h"

#include <frontmost/base.h>
#include <malloc.h>

#include <cstdio>
#include <cstring>
#include <string>

#include "harness/stopwatch.h"

namespace frontmost::bench {
namespace {

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

/// A chain of multiplications, of which each waits 3 cycles for the one before: so on every x86-64 since 2011.
void multiply(std::uint64_t count) {
  std::uint64_t value = 3;
  for (std::uint64_t i = 0; i < count; ++i) value *= value;
  keep(value);
}

/// "VmHWM:   1234 kB" of /proc/self/status.
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
    std::fputs("5", file);  // the peak becomes what is resident now
    std::fclose(file);
  }
}

}  // namespace frontmost::bench
