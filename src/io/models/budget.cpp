// SPDX-License-Identifier: Apache-2.0
#include "io/models/budget.h"

namespace frontmost {

void Budget::charge(std::uint64_t count, std::uint64_t size, const std::string& place, const ModelSource& source) {
  if (count > left_ / size)
    source.fail_limit(place, std::to_string(count) + " elements are far more than a file of this size should make");
  left_ -= count * size;
}

}  // namespace frontmost
