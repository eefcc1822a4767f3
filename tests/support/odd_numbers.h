// SPDX-License-Identifier: Apache-2.0
// Unusual numbers that readers and methods must handle.
#pragma once

#include <limits>

namespace frontmost::test {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr float kFloatInfinity = std::numeric_limits<float>::infinity();
inline constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

}  // namespace frontmost::test
