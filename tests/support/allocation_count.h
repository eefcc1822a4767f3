// SPDX-License-Identifier: Apache-2.0
// Counts allocations of a test program: allocation_count.cpp replaces `new` in programs that link it.
#pragma once

#include <cstddef>

namespace frontmost::test {

/// Allocations by `new` so far, over all threads.
[[nodiscard]] std::size_t allocation_count();

}  // namespace frontmost::test
