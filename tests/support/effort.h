// SPDX-License-Identifier: Apache-2.0
// How much a random test tries.
#pragma once

#include <cstdint>

namespace frontmost::test {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool under_sanitizer = true;
#elif defined(__has_feature)
inline constexpr bool under_sanitizer = __has_feature(address_sanitizer) || __has_feature(thread_sanitizer);
#else
inline constexpr bool under_sanitizer = false;
#endif

/// All the seeds that are asked for; an eighth under a sanitizer, which is ten to thirty times slower and looks for
/// other faults than wrong results.
inline constexpr std::uint64_t seeds(std::uint64_t count) { return under_sanitizer ? (count + 7) / 8 : count; }

}  // namespace frontmost::test
