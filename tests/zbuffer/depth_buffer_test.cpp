// SPDX-License-Identifier: Apache-2.0
// The depth buffer against the state machine, to the bit: functions, formats, masks, ranges, offsets, instruction sets.
#include <gtest/gtest.h>

#include <cfenv>
#include <cstring>

#include "frontmost/zbuffer.h"
#include "support/depth_oracle.h"
#include "support/effort.h"
#include "support/random_scene.h"
#include "support/same_visible.h"

namespace frontmost::test {
namespace {

constexpr DepthFormat all_formats[] = {DepthFormat::d8, DepthFormat::d16, DepthFormat::d24, DepthFormat::f32};

void expect_as_oracle(const DepthOracle& expected, const DepthBuffer& actual, const View& view) {
  const Visible& a = expected.visible();
  const Visible b = actual.visible(view);
  std::size_t differing = 0, first = 0;
  for (std::size_t i = 0; i < a.keys.size(); ++i) {
    const bool same = expected.stored()[i] == actual.stored()[i] && same_sample(a, b, i);
    if (!same && differing++ == 0) first = i;
  }
  EXPECT_EQ(differing, 0u) << "first at sample " << first << ": stored " << expected.stored()[first] << " by "
                           << a.primitives[first] << " expected, " << actual.stored()[first] << " by "
                           << b.primitives[first] << " found";
}

double chosen(Random& random, std::initializer_list<double> values) {
  return *(values.begin() + random.below(int(values.size())));
}

DepthDraw random_call(Random& random, PrimitiveId count) {
  DepthDraw call;
  call.state.func = DepthFunc(random.below(8));
  call.state.mask = random.below(4) != 0;
  call.state.nearer_is_greater = random.below(2) == 1;
  if (random.below(2)) {
    call.state.range_near = chosen(random, {0, 0.25, 1, double(random.unit())});
    call.state.range_far = chosen(random, {1, 0.5, 0, double(random.unit())});
  }
  if (random.below(2)) {
    call.state.offset = {chosen(random, {0, 1, -2, 0.3}), chosen(random, {0, 1, -1, 5e5, -3e3}),
                         chosen(random, {0, 1e-3, -1e-3})};
  }
  if (random.below(3) == 0) call.begin = PrimitiveId(random.below(int(count)));
  if (random.below(3) == 0) call.end = call.begin + PrimitiveId(random.below(int(count)));
  if (random.below(3) == 0) call.id_offset = 1000;
  return call;
}

class DepthOfEveryKind : public testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(DepthBuffer, DepthOfEveryKind, testing::ValuesIn(all_kinds));

TEST_P(DepthOfEveryKind, EqualsTheStateMachineOnEveryInstructionSet) {
  const bool covers_little = GetParam() == Kind::tiny || GetParam() == Kind::slivers;
  std::size_t seen = 0;
  for (std::uint64_t seed = 0; seed < seeds(24); ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    Random random(seed + 500);
    const Scene scene = scene_of(random_mesh(GetParam(), (20 + random.below(60)) * (covers_little ? 6 : 1), seed));
    const Surfaces surfaces(scene);
    View view = random_view(random, 1 + random.below(150), 1 + random.below(140));
    view.culling = Culling(random.below(3));
    view.samples = seed % 6 == 5 ? 2 : 1;
    const DepthFormat format = all_formats[seed % 4];
    std::vector<DepthDraw> calls;
    for (int i = 0; i < 4; ++i) calls.push_back(random_call(random, surfaces.primitive_count()));
    calls[0].state.func = seed % 2 ? DepthFunc::less : DepthFunc::greater;
    const double clear = seed % 2 ? 1.0 : 0.0;

    DepthOracle oracle(view, format);
    oracle.clear(clear);
    for (const DepthDraw& call : calls) oracle.draw(surfaces, call);
    seen += covered(oracle.visible());
    for (const Isa isa : available_isas()) {
      SCOPED_TRACE(name(isa));
      DepthBuffer buffer(view.width, view.height, view.samples, format);
      buffer.clear(clear);
      for (const DepthDraw& call : calls) buffer.draw(surfaces, view, call, {.threads = 1 + int(seed % 3), .isa = isa});
      expect_as_oracle(oracle, buffer, view);
    }
  }
  if (!tries_little) EXPECT_GT(seen, covers_little ? 200u : 1'000u) << "the scenes have become empty";
}

// Tests every function with every format and direction on its own.
TEST(DepthBuffer, EveryFunctionOnEveryFormat) {
  const Scene scene = scene_of(random_mesh(Kind::soup, 60, 5));
  const Surfaces surfaces(scene);
  Random random(8);
  const View view = random_view(random, 120, 90);
  for (const DepthFormat format : all_formats)
    for (int func = 0; func < 8; ++func) {
      std::size_t seen = 0;
      for (const bool nearer_is_greater : {false, true}) {
        SCOPED_TRACE(testing::Message() << "format " << int(format) << " function " << func);
        const DepthState state{.func = DepthFunc(func), .nearer_is_greater = nearer_is_greater};
        DepthOracle oracle(view, format);
        oracle.clear(0.5);
        oracle.draw(surfaces, {.state = state});
        for (const Isa isa : available_isas()) {
          DepthBuffer buffer(view.width, view.height, 1, format);
          buffer.clear(0.5);
          buffer.draw(surfaces, view, {.state = state}, {.isa = isa});
          expect_as_oracle(oracle, buffer, view);
        }
        seen += covered(oracle.visible());
      }
      // No surface need be exactly as deep as the clear value.
      if (DepthFunc(func) == DepthFunc::equal) continue;
      EXPECT_EQ(seen == 0, DepthFunc(func) == DepthFunc::never);
    }
}

// The reversed depth of a float with an infinite far plane is the key itself, and ids follow the order of submission.
TEST(DepthBuffer, ReversedFloatIsTheDefaultZBufferToTheBit) {
  for (const Kind kind : all_kinds)
    for (const int samples : {1, 4, 16}) {
      Random random(31);
      const Scene scene = scene_of(random_mesh(kind, 400, 12));
      const Surfaces surfaces(scene);
      View view = random_view(random, 200, 150);
      view.samples = samples;
      view.projection = make_projection(0.9, 200.0 / 150, {0.5, std::numeric_limits<double>::infinity()});
      const Visible expected = zbuffer(surfaces, view);
      DepthBuffer buffer(view.width, view.height, samples, DepthFormat::f32);
      buffer.clear(0);
      buffer.draw(surfaces, view, {.state = {.func = DepthFunc::greater, .nearer_is_greater = true}});
      EXPECT_EQ(content_hash(buffer.visible(view)), content_hash(expected));
      for (std::size_t i = 0; i < expected.keys.size(); ++i)
        ASSERT_EQ(depth_of_stored(DepthFormat::f32, buffer.stored()[i]), double(expected.keys[i]));
    }
}

// If LESS with another format shows another surface, both must round to the same depth.
TEST(DepthBuffer, OtherFormatsDifferFromTheDefaultOnlyWhereTheyCannotTellDepthsApart) {
  const Scene scene = scene_of(random_mesh(Kind::soup, 300, 21));
  const Surfaces surfaces(scene);
  Random random(5);
  View view = random_view(random, 300, 200);
  view.projection = make_projection(0.9, 1.5, {0.5, 6});
  const Visible expected = zbuffer(surfaces, view);
  std::size_t coarser = expected.keys.size() / 10;
  for (const DepthFormat format : all_formats) {
    DepthBuffer buffer(300, 200, 1, format);
    buffer.draw(surfaces, view);
    const Visible visible = buffer.visible(view);
    std::size_t differing = 0;
    for (std::size_t i = 0; i < expected.keys.size(); ++i) {
      if (visible.primitives[i] == expected.primitives[i]) continue;
      ++differing;
      const auto depth_of = [](float key) { return (1 - double(key)) / (1 - 0.5 / 6); };
      ASSERT_EQ(stored_depth(format, depth_of(visible.keys[i])), stored_depth(format, depth_of(expected.keys[i])));
      ASSERT_LT(visible.primitives[i], expected.primitives[i]) << "of equal ones the first stays";
    }
    EXPECT_LE(differing, coarser) << "more bits, fewer mistakes";
    coarser = differing;
  }
  EXPECT_LT(coarser, 5u);
}

TEST(DepthBuffer, DoesNotDependOnThreadsOrTheCallersRounding) {
  const Scene scene = scene_of(random_mesh(Kind::tiny, 60'000, 3));
  const Surfaces surfaces(scene);
  Random random(11);
  const View view = random_view(random, 700, 500);
  const auto hash_with = [&](int threads) {
    DepthBuffer buffer(700, 500, 1, DepthFormat::d16);
    buffer.draw(surfaces, view, {.state = {.func = DepthFunc::less_equal}}, {.threads = threads});
    return content_hash(buffer.visible(view));
  };
  const std::uint64_t one = hash_with(1);
  for (const int threads : {2, 3, 8}) EXPECT_EQ(hash_with(threads), one);
  std::fesetround(FE_UPWARD);
  const std::uint64_t upward = hash_with(2);
  std::fesetround(FE_TONEAREST);
  EXPECT_EQ(upward, one);
}

// One call, or one call for every triangle: the order and the result are the same.
TEST(DepthBuffer, CallsFollowOneAnother) {
  const Scene scene = scene_of(random_mesh(Kind::coplanar, 50, 3));
  const Surfaces surfaces(scene);
  Random random(2);
  const View view = random_view(random, 90, 70);
  for (const DepthFunc func : {DepthFunc::less, DepthFunc::less_equal, DepthFunc::not_equal, DepthFunc::always}) {
    DepthBuffer whole(90, 70), parts(90, 70);
    whole.draw(surfaces, view, {.state = {.func = func}});
    for (PrimitiveId id = 0; id < surfaces.primitive_count(); ++id)
      parts.draw(surfaces, view, {.state = {.func = func}, .begin = id, .end = id + 1});
    EXPECT_EQ(content_hash(whole.visible(view)), content_hash(parts.visible(view)));
    EXPECT_EQ(0, std::memcmp(whole.stored().data(), parts.stored().data(), 4 * whole.stored().size()));
  }
}

TEST(DepthBuffer, MirroredAndCulledInstancesFaceAsInTheZBuffer) {
  Scene scene = scene_of(random_mesh(Kind::soup, 100, 3));
  scene.instances.push_back({"mirrored", 0, glm::dmat4(1.0)});
  scene.instances[1].world_from_mesh[0][0] = -1;
  const Surfaces surfaces(scene);
  Random random(2);
  View view = random_view(random, 150, 140);
  view.projection = make_projection(0.9, 1, {0.5, std::numeric_limits<double>::infinity()});
  for (const Culling culling : {Culling::none, Culling::back, Culling::front, Culling::both}) {
    view.culling = culling;
    DepthBuffer buffer(150, 140, 1, DepthFormat::f32);
    buffer.clear(0);
    buffer.draw(surfaces, view, {.state = {.func = DepthFunc::greater, .nearer_is_greater = true}});
    EXPECT_EQ(content_hash(buffer.visible(view)), content_hash(zbuffer(surfaces, view)));
  }
}

TEST(DepthBuffer, TheLargestImageAndTheSmallest) {
  Mesh mesh;
  add_triangle(mesh, {-1, -1, 0}, {1, -1, 0}, {-1, 1, 0});
  const Scene scene = scene_of(mesh);
  const Surfaces surfaces(scene);
  for (const glm::ivec2 size : {glm::ivec2(1, 1), glm::ivec2(16384, 3), glm::ivec2(2, 16384)}) {
    View view{size.x, size.y, 1, look_at({0, 0, 2}, {0, 0, 0}, {0, 1, 0}), make_orthographic(-1, 1, -1, 1, {1, 3}), {}};
    DepthOracle oracle(view, DepthFormat::d24);
    oracle.draw(surfaces, {});
    DepthBuffer buffer(size.x, size.y);
    buffer.draw(surfaces, view);
    expect_as_oracle(oracle, buffer, view);
  }
}

}  // namespace
}  // namespace frontmost::test
