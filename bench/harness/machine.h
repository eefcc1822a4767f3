// SPDX-License-Identifier: Apache-2.0
// What this machine allows at most, on one thread.
#pragma once

#include <cstddef>

namespace frontmost::bench {

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
