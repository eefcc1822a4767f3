// SPDX-License-Identifier: Apache-2.0
// Comparing two answers of a method, bit by bit.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "frontmost/visible.h"

namespace frontmost::test {

inline bool same_sample(const Visible& a, const Visible& b, std::size_t i) {
  return a.primitives[i] == b.primitives[i] && std::memcmp(&a.keys[i], &b.keys[i], sizeof(float)) == 0;
}

inline void expect_same(const Visible& expected, const Visible& actual) {
  ASSERT_EQ(expected.keys.size(), actual.keys.size());
  std::size_t count = 0, first = 0;
  for (std::size_t i = 0; i < expected.keys.size(); ++i)
    if (!same_sample(expected, actual, i) && count++ == 0) first = i;
  if (count == 0) return;
  ADD_FAILURE() << count << " samples differ, first " << first << " (x " << first % std::size_t(expected.view.width)
                << ", y " << first / std::size_t(expected.view.width) << "): primitive " << expected.primitives[first]
                << " key " << expected.keys[first] << " expected, " << actual.primitives[first] << " key "
                << actual.keys[first] << " found";
}

inline std::size_t covered(const Visible& visible) {
  return visible.primitives.size() -
         std::size_t(std::count(visible.primitives.begin(), visible.primitives.end(), no_primitive));
}

}  // namespace frontmost::test
