// SPDX-License-Identifier: Apache-2.0
// How often a test program has asked for memory: allocation_count.cpp replaces `new` in programs that it is part of.
#pragma once

#include <cstddef>

namespace frontmost::test {

/// Allocations by `new` so far, of all threads.
[[nodiscard]] std::size_t allocation_count();

}  // namespace frontmost::test
