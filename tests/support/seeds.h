// SPDX-License-Identifier: Apache-2.0
// A failing test prints the last seeds of its random numbers.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <iostream>

namespace frontmost::test {

/// The last seeds of the running test, the newest at (count - 1) % 4.
struct LastSeeds {
  std::array<std::atomic<std::uint64_t>, 4> seeds = {};
  std::atomic<std::size_t> count = 0;
};
inline LastSeeds last_seeds;

/// Returns the seed, and remembers it for the message of a failure.
inline std::uint64_t noted_seed(std::uint64_t seed) {
  last_seeds.seeds[last_seeds.count++ % last_seeds.seeds.size()] = seed;
  return seed;
}

/// Prints the last seeds at the first failure of a test.
class SeedPrinter : public testing::EmptyTestEventListener {
  void OnTestStart(const testing::TestInfo&) override {
    last_seeds.count = 0;
    is_printed_ = false;
  }
  void OnTestPartResult(const testing::TestPartResult& result) override {
    const std::size_t count = last_seeds.count, most = last_seeds.seeds.size();
    if (!result.failed() || is_printed_ || count == 0) return;
    is_printed_ = true;
    std::cout << "Random numbers: " << count << " seeds, the last of them";
    for (std::size_t i = count > most ? count - most : 0; i < count; ++i)
      std::cout << ' ' << last_seeds.seeds[i % most];
    std::cout << '\n';
  }
  bool is_printed_ = false;
};

/// Every program that includes this header has one printer.
inline const bool has_seed_printer = [] {
  testing::UnitTest::GetInstance()->listeners().Append(new SeedPrinter);
  return true;
}();

}  // namespace frontmost::test
