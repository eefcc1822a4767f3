// SPDX-License-Identifier: Apache-2.0
// Bitwise comparison of answers: of any two methods; of the z-buffer's two ways to draw; and of a method and its
// oracle, on every instruction set of this machine.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "base/parallel.h"
#include "frontmost/view.h"
#include "frontmost/zbuffer.h"
#include "support/effort.h"
#include "support/random_scene.h"
#include "zbuffer/direct/direct_frame.h"

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

/// The id at sample `s` of a pixel.
inline PrimitiveId id_at(const VisiblePixels& pixels, const glm::ivec2& at, int s) {
  constexpr int run = VisiblePixels::run;
  const std::size_t number = std::size_t(at.y) * pixels.runs_across() + std::size_t(at.x / run);
  const unsigned mixed = pixels.mixed[number];
  if (s == 0 || !(mixed >> at.x % run & 1u)) return pixels.first.primitives[pixels.first.index(at.x, at.y)];
  std::size_t place = pixels.places[number];
  for (int x = 0; x < at.x % run; ++x) place += (mixed >> x & 1u) * std::size_t(pixels.view.samples - 1);
  return pixels.others[place + std::size_t(s) - 1];
}

/// Compares pixels. \returns the number of mixed ones.
inline std::size_t expect_same_pixels(const Visible& expected, const VisiblePixels& actual) {
  const View& view = expected.view;
  Visible all{view, Buffer<PrimitiveId>(view.sample_count()), Buffer<float>(expected.keys)};
  for (std::size_t i = 0; i < view.pixel_count(); ++i) all.keys[i] = actual.first.keys[i];
  for (int s = 0; s < view.samples; ++s)
    for (int y = 0; y < view.height; ++y)
      for (int x = 0; x < view.width; ++x) all.primitives[all.index(x, y, s)] = id_at(actual, {x, y}, s);
  expect_same(expected, all);
  return view.samples > 1 ? actual.other_count / std::size_t(view.samples - 1) : 0;
}

inline Visible draw_clusters(const Surfaces& surfaces, const View& view, const Execution& execution = {}) {
  ZBuffer buffer;
  buffer.draw(surfaces, view, execution);
  return buffer.take();
}

/// Draws in both ways, which must give the same answer. \returns that answer.
inline Visible draw_both_ways(const Surfaces& surfaces, const View& view, const Execution& execution = {}) {
  Visible visible = draw_clusters(surfaces, view, execution);
  const IeeeScope ieee;
  expect_same(visible, zbuffer_detail::draw_directly(placed_scene(surfaces), view, execution));
  return visible;
}

/// Compares `method(surfaces, view, execution)` with `oracle(surfaces, view)`, over random scenes of a kind, which must
/// not all be empty.
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
