// SPDX-License-Identifier: Apache-2.0
// The ZBuffer object: frames that reuse memory equal those of zbuffer(), and allocate none.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "frontmost/frontmost.h"
#include "support/allocation_count.h"
#include "support/effort.h"
#include "support/random_scene.h"
#include "surfaces/cluster_set.h"

namespace frontmost::test {
namespace {

TEST(ZBuffer, FramesAfterTheFirstAreWhatTheFunctionGives) {
  ZBuffer buffer;
  Random random(11);
  for (std::uint64_t seed = 0; seed < seeds(60); ++seed) {
    const Scene scene = scene_of(random_mesh(Kind(seed % 8), seed % 5 == 0 ? 0 : 80, seed));
    const Surfaces surfaces(scene);
    // Two of the sizes need equal memory, and some views leave most tiles empty.
    constexpr std::array<std::pair<int, int>, 4> kSizes{{{400, 300}, {300, 400}, {700, 500}, {64, 64}}};
    const auto [width, height] = kSizes[seed / 4 % 4];
    View view = random_view(random, width, height);
    view.samples = seed % 7 == 0 ? 4 : 1;
    for (int frame = 0; frame < 2; ++frame) {
      const Visible& reused = buffer.draw(surfaces, view);
      const Visible fresh = zbuffer(surfaces, view);
      ASSERT_EQ(content_hash(reused), content_hash(fresh)) << "seed " << seed;
      ASSERT_EQ(reused.view.width, width);
    }
  }
}

TEST(ZBuffer, EmptyTilesAreClearedAfterSomethingWasSeenThere) {
  const Scene scene = scene_of(random_mesh(Kind::tiny, 200, 1));
  const Scene nothing = scene_of({});
  const Surfaces surfaces(scene), empty(nothing);
  const View view = frame(surfaces, 500, 300);
  ZBuffer buffer;
  for (int round = 0; round < 2; ++round) {
    const Visible& drawn = buffer.draw(surfaces, view);
    EXPECT_LT(std::size_t(std::count(drawn.primitives.begin(), drawn.primitives.end(), no_primitive)),
              view.sample_count());
    const Visible& cleared = buffer.draw(empty, view);
    EXPECT_EQ(std::size_t(std::count(cleared.primitives.begin(), cleared.primitives.end(), no_primitive)),
              view.sample_count());
    EXPECT_EQ(std::size_t(std::count(cleared.keys.begin(), cleared.keys.end(), 0.0f)), view.sample_count());
  }
}

TEST(ZBuffer, TakenPlanesAreLeftAlone) {
  const Scene scene = scene_of(random_mesh(Kind::tiny, 200, 1));
  const Surfaces surfaces(scene);
  const View view = frame(surfaces, 300, 200);
  ZBuffer buffer;
  const std::uint64_t hash = content_hash(buffer.draw(surfaces, view));
  const Visible taken = buffer.take();
  View other = view;
  other.culling = Culling::both;
  EXPECT_NE(content_hash(buffer.draw(surfaces, other)), hash);
  EXPECT_EQ(content_hash(taken), hash);
  EXPECT_EQ(content_hash(buffer.draw(surfaces, view)), hash);
}

// Planes are reused whatever their content.
TEST(ZBuffer, PlanesGivenBackAreUsedAgain) {
  const Scene scene = scene_of(random_mesh(Kind::tiny, 200, 1));
  const Surfaces surfaces(scene);
  Random random(3);
  View view = random_view(random, 300, 200);
  ZBuffer buffer;
  const Visible expected = buffer.draw(surfaces, view);
  Visible taken = buffer.take();
  const PrimitiveId* const primitives = taken.primitives.data();
  std::fill(taken.primitives.begin(), taken.primitives.end(), 7u);
  std::fill(taken.keys.begin(), taken.keys.end(), 0.5f);
  buffer.give_back(std::move(taken));
  const Visible& again = buffer.draw(surfaces, view);
  EXPECT_EQ(content_hash(again), content_hash(expected));
  EXPECT_EQ(again.primitives.data(), primitives);
  // Planes of another size, or with one missing, are as good as none.
  Visible other = nothing_visible(random_view(random, 30, 20));
  other.keys = {};
  buffer.give_back(std::move(other));
  EXPECT_EQ(content_hash(buffer.draw(surfaces, view)), content_hash(expected));
}

TEST(ZBuffer, RefusesABadViewAndGoesOn) {
  const Scene scene = scene_of(random_mesh(Kind::tiny, 50, 1));
  const Surfaces surfaces(scene);
  const View view = frame(surfaces, 300, 200);
  ZBuffer buffer;
  View bad = view;
  bad.width = 0;
  EXPECT_THROW(buffer.draw(surfaces, bad), Error);
  EXPECT_EQ(content_hash(buffer.draw(surfaces, view)), content_hash(zbuffer(surfaces, view)));
}

TEST(ZBuffer, GoesOnAfterAFrameWasCancelled) {
  const Scene scene = scene_of(random_mesh(Kind::through_eye, 200, 3));
  const Surfaces surfaces(scene);
  Random random(3);
  const View view = random_view(random, 600, 400);
  ZBuffer buffer;
  for (std::size_t polls = 0; polls < 40; ++polls) {
    try {
      buffer.draw(surfaces, view, CountingWatch(polls + 1).execution());
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::cancelled);
    }
    ASSERT_EQ(content_hash(buffer.draw(surfaces, view)), content_hash(zbuffer(surfaces, view))) << polls;
  }
}

// operator new does not supply planes and tile scratches; unchanged addresses show that they are kept.
TEST(ZBuffer, FramesAfterTheFirstAllocateNothing) {
  for (const Kind kind : {Kind::tiny, Kind::through_eye, Kind::huge}) {
    const Scene scene = scene_of(random_mesh(kind, 500, 1));
    const Surfaces surfaces(scene);
    View view = frame(surfaces, 640, 480);
    ZBuffer buffer;
    const Execution execution{.threads = 1};
    const Visible& visible = buffer.draw(surfaces, view, execution);
    const PrimitiveId* primitives = visible.primitives.data();
    const float* keys = visible.keys.data();
    const std::size_t before = allocation_count();
    for (int i = 0; i < 5; ++i) buffer.draw(surfaces, view, execution);
    EXPECT_EQ(allocation_count(), before);
    EXPECT_EQ(visible.primitives.data(), primitives);
    EXPECT_EQ(visible.keys.data(), keys);
  }
}

// The flight of examples/flight.cpp: memory grows up to the most demanding frame, and is then reused.
TEST(ZBuffer, AFlightAllocatesNothingOnceItHasBeenFlown) {
  const Scene scene = builtin("city");
  const Surfaces surfaces(scene);
  const glm::dvec3 middle = surfaces.bounds().centre(), up = direction(scene.up);
  (void)cluster_set(surfaces);  // otherwise the first frame makes them
  ZBuffer buffer;
  const int frames = tries_little ? 40 : 300;
  const auto fly = [&] {
    View view = frame(surfaces, 640, 480);
    const std::size_t before = allocation_count();
    for (int i = 0; i < frames; ++i) {
      buffer.draw(surfaces, view, {.threads = 1});
      const glm::dvec3 eye = view.eye() + 0.02 * glm::distance(view.eye(), middle) * view.right();
      view = view.looking(eye, middle, up).enclosing(surfaces.bounds());
    }
    return allocation_count() - before;
  };
  EXPECT_LT(fly(), std::size_t(frames));
  EXPECT_EQ(fly(), 0u);
}

}  // namespace
}  // namespace frontmost::test
