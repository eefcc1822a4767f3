// SPDX-License-Identifier: Apache-2.0
// Feeds arbitrary geometry to a depth buffer in an arbitrary state. The buffer must not crash or hang; threads and
// instruction sets change no bit; and drawing in two calls gives the picture of one call.
//
// Input: the bytes of a state, then the input of support/geometry_fuzz.h.
#include <cmath>
#include <cstdlib>

#include "support/geometry_fuzz.h"

using namespace frontmost;

namespace {

struct StateBytes {
  std::uint8_t func, format, flags, range_near, range_far, clear;
  std::uint16_t cut;
  float factor, units;
};

DepthState state_of(const StateBytes& bytes) {
  DepthState state;
  state.func = DepthFunc(bytes.func % 8);
  state.mask = bytes.flags & 1;
  state.nearer_is_greater = bytes.flags & 2;
  state.range_near = bytes.range_near / 255.0;
  state.range_far = bytes.range_far / 255.0;
  state.offset = {bytes.factor, bytes.units, bytes.flags & 4 ? 0.01 : 0.0};
  return state;
}

bool same(const DepthBuffer& a, const DepthBuffer& b, const View& view) {
  return content_hash(a.visible(view)) == content_hash(b.visible(view)) &&
         std::equal(a.stored().begin(), a.stored().end(), b.stored().begin());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  StateBytes bytes;
  test::ViewBytes view_bytes;
  constexpr std::size_t kHead = sizeof(bytes) + sizeof(view_bytes);
  if (size < kHead) return 0;
  std::memcpy(&bytes, data, sizeof(bytes));
  std::memcpy(&view_bytes, data + sizeof(bytes), sizeof(view_bytes));
  const Scene scene = test::scene_of(data + kHead, size - kHead);
  try {
    const View view = test::view_of(view_bytes);
    const Surfaces surfaces(scene);
    const DepthState state = state_of(bytes);
    const auto cleared = [&] {
      DepthBuffer buffer(view.width, view.height, view.samples, DepthFormat(bytes.format % 4));
      buffer.clear(bytes.clear / 255.0);
      return buffer;
    };
    DepthBuffer wide = cleared(), plain = cleared(), twice = cleared();
    wide.draw(surfaces, view, {.state = state}, {.threads = 2, .isa = Isa::best, .watch = nullptr});
    plain.draw(surfaces, view, {.state = state}, {.threads = 1, .isa = Isa::scalar, .watch = nullptr});
    const PrimitiveId cut = std::min<PrimitiveId>(bytes.cut, surfaces.primitive_count());
    twice.draw(surfaces, view, {.state = state, .begin = 0, .end = cut});
    twice.draw(surfaces, view, {.state = state, .begin = cut});
    if (!same(wide, plain, view) || !same(wide, twice, view)) std::abort();
  } catch (const Error&) {
    // The camera or the state is refused.
  }
  return 0;
}
