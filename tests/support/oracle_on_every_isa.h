// SPDX-License-Identifier: Apache-2.0
// A method against its oracle, to the bit, on every instruction set of this machine.
#pragma once

#include "support/effort.h"
#include "support/random_scene.h"
#include "support/same_visible.h"

namespace frontmost::test {

/// `oracle(surfaces, view)` says what is right, `method(surfaces, view, execution)` is tested: over random scenes of a
/// kind that must not have become empty.
template <class Oracle, class Method>
void expect_oracle_on_every_isa(Kind kind, const Oracle& oracle, const Method& method) {
  std::size_t seen = 0;
  for (std::uint64_t seed = 0; seed < seeds(24); ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const RandomCase random = random_case(kind, seed);
    const Surfaces surfaces(random.scene);
    const Visible expected = oracle(surfaces, random.view);
    seen += covered(expected);
    for (const Isa isa : available_isas()) {
      SCOPED_TRACE(name(isa));
      expect_same(expected, method(surfaces, random.view, Execution{.threads = 1, .isa = isa}));
    }
  }
  EXPECT_GT(seen, seeds(24) * 20) << "the scenes have become empty";
}

}  // namespace frontmost::test
