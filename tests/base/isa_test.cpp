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
  // Only targets that this build has kernels for count.
  const auto finds = [](std::int64_t target) { return (HWY_SUPPORTED_TARGETS & HWY_TARGETS & target) != 0; };
  const auto there = [](Isa isa) { return std::ranges::find(available_isas(), isa) != available_isas().end(); };
  EXPECT_EQ(there(Isa::sse4), finds(HWY_SSE4));
  EXPECT_EQ(there(Isa::avx2), finds(HWY_AVX2));
  EXPECT_EQ(there(Isa::avx512), finds(HWY_AVX3));
}

TEST(Isa, BestIsTheLastAvailable) { EXPECT_EQ(name(Isa::best), name(available_isas().back())); }

TEST(Isa, AskingForWhatTheMachineLacksIsAnError) {
  for (const Isa isa : {Isa::scalar, Isa::sse4, Isa::avx2, Isa::avx512, Isa::neon, Isa::wasm}) {
    const bool there = std::ranges::find(available_isas(), isa) != available_isas().end();
    if (there) {
      EXPECT_NO_THROW((void)highway_targets(isa));
    } else {
      EXPECT_THROW((void)highway_targets(isa), Error);
    }
  }
}

TEST(Isa, NamesAreThoseOfTheCommandLine) {
  EXPECT_EQ(name(Isa::scalar), "scalar");
  EXPECT_EQ(name(Isa::sse4), "sse4");
  EXPECT_EQ(name(Isa::avx2), "avx2");
  EXPECT_EQ(name(Isa::avx512), "avx512");
  EXPECT_EQ(name(Isa::neon), "neon");
  EXPECT_EQ(name(Isa::wasm), "wasm");
  EXPECT_EQ(name(Isa(99)), "unknown");
}

TEST(Isa, WhatIsNoIsaIsNamedInTheError) {
  try {
    (void)highway_targets(Isa(99));
    FAIL() << "there is no such instruction set";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::unsupported);
    EXPECT_STREQ(error.what(), "isa: unknown is not available on this machine");
  }
}

// Each target is one bit, so that a table of kernels has one entry for each; the fallback needs none.
TEST(Isa, TargetsAreSingleBits) {
  std::int64_t all = 0;
  for (const Isa isa : available_isas()) {
    const std::int64_t bit = highway_targets(isa);
    EXPECT_EQ(bit & (bit - 1), 0) << name(isa);
    EXPECT_EQ(all & bit, 0) << name(isa) << ": its own";
    all |= bit;
  }
  EXPECT_EQ(highway_targets(Isa::scalar), 0);
  EXPECT_EQ(highway_targets(Isa::best), highway_targets(available_isas().back()));
}

}  // namespace
}  // namespace frontmost
