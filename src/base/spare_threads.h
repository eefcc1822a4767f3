// SPDX-License-Identifier: Apache-2.0
// How many more threads the system would give: limits on processes and on memory refuse some.
#pragma once

#include <functional>
#include <thread>

namespace frontmost {

/// Starts a thread. \throws std::system_error or std::bad_alloc where there is none.
using StartThread = std::function<std::thread(std::function<void()>)>;

/// Starts threads until `wanted` live at once or one is refused, and ends them. \returns how many there were.
/// About 15 us a thread.
[[nodiscard]] int count_spare_threads(int wanted, const StartThread& start);

}  // namespace frontmost
