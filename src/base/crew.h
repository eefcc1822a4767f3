// SPDX-License-Identifier: Apache-2.0
// Threads that stay together over the many short loops of one long call.
#pragma once

#include <memory>

#include "frontmost/base.h"

namespace frontmost {

/// While it lives, the parallel_for()s of the thread that made it share their helpers, which look for the next loop for
/// some 50 us before they go to sleep: to wake one takes as long as many a loop, 40 us. Loops within loops are not
/// helped. To be destroyed in the opposite order of making, on the same thread.
class Crew {
 public:
  /// \throws Error as thread_count().
  explicit Crew(const Execution& execution);
  ~Crew();
  Crew(const Crew&) = delete;
  Crew& operator=(const Crew&) = delete;

  struct Helpers;

 private:
  std::unique_ptr<Helpers> helpers_;
  Helpers* outer_;
};

}  // namespace frontmost
