// SPDX-License-Identifier: Apache-2.0
// A file descriptor that is closed in time.
#pragma once

#include <unistd.h>

namespace frontmost {

class Descriptor {
 public:
  explicit Descriptor(int number = -1) : number_(number) {}
  ~Descriptor() { reset(-1); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  [[nodiscard]] int number() const { return number_; }
  /// Closes the descriptor, if there is one, and keeps another.
  void reset(int number) {
    if (number_ >= 0) ::close(number_);
    number_ = number;
  }

 private:
  int number_;
};

}  // namespace frontmost
