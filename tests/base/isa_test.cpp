// SPDX-License-Identifier: Apache-2.0
#include "base/isa.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace frontmost {
namespace {

TEST(Isa, ScalarIsAlwaysThereAndComesFirst) {
  ASSERT_FALSE(available_isas().empty());
  EXPECT_EQ(available_isas().front(), Isa::scalar);
}

TEST(Isa, HighwayFindsTheSame) {
  const auto finds = [](std::int64_t target) { return (hwy::SupportedTargets() & target) != 0; };
  const auto there = [](Isa isa) { return std::ranges::find(available_isas(), isa) != available_isas().end(); };
  EXPECT_EQ(there(Isa::sse4), finds(HWY_SSE4));
  EXPECT_EQ(there(Isa::avx2), finds(HWY_AVX2));
  EXPECT_EQ(there(Isa::avx512), finds(HWY_AVX3));
}

TEST(Isa, BestIsTheLastAvailable) { EXPECT_EQ(name(Isa::best), name(available_isas().back())); }

TEST(Isa, AskingForWhatTheMachineLacksIsAnError) {
  for (const Isa isa : {Isa::scalar, Isa::sse4, Isa::avx2, Isa::avx512}) {
    const bool there = std::ranges::find(available_isas(), isa) != available_isas().end();
    if (there) {
      EXPECT_NO_THROW((void)highway_targets(isa));
    } else {
      EXPECT_THROW((void)highway_targets(isa), Error);
    }
  }
}

}  // namespace
}  // namespace frontmost
