// SPDX-License-Identifier: Apache-2.0
// The promise of the fuzz target, checked without a fuzzer: every seed, every prefix of it, and thousands of mutations
// end in a scene or in an Error.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>

#include "support/reader_fuzz.h"
#include "support/seeds.h"

namespace frontmost {
namespace {

std::map<std::string, std::string> packages() {
  std::map<std::string, std::string> all;
  for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(FRONTMOST_CORPUS) / "threemf")) {
    std::ifstream in(entry.path(), std::ios::binary);
    all[entry.path().filename().string()] = {std::istreambuf_iterator<char>(in), {}};
  }
  return all;
}

TEST(ThreeMfCorpus, SeedsAreRead) {
  const auto all = packages();
  EXPECT_GE(all.size(), 4u);
  for (const auto& [name, bytes] : all) EXPECT_TRUE(fuzz_3mf(bytes)) << name;
}

TEST(ThreeMfCorpus, PrefixesAndMutationsAreReadOrRefused) {
  std::mt19937 random(test::noted_seed(3));
  std::size_t good = 0, bad = 0;
  for (const auto& [name, bytes] : packages()) {
    SCOPED_TRACE(name);
    for (std::size_t size = 0; size < bytes.size(); ++size) (void)fuzz_3mf(bytes.substr(0, size));
    for (int round = 0; round < 600; ++round) {
      std::string changed = bytes;
      for (auto changes = 1 + random() % 3; changes-- > 0;) {
        const std::size_t at = random() % changed.size();
        switch (random() % 4) {
          case 0: changed[at] = char(random()); break;
          case 1: changed[at] = "0123456789-.\" "[random() % 14]; break;
          case 2: changed.erase(at, 1 + random() % 8); break;
          default: changed.insert(at, changed.substr(random() % changed.size(), random() % 60)); break;
        }
      }
      (fuzz_3mf(changed) ? good : bad) += 1;
    }
  }
  EXPECT_GT(good, 100u);
  EXPECT_GT(bad, 1000u);
}

}  // namespace
}  // namespace frontmost
