// SPDX-License-Identifier: Apache-2.0
// Feeds arbitrary geometry and an arbitrary camera to the z-buffer and the ray caster. They must not crash or hang;
// threads, instruction sets and clusters must not change a bit of the answer. Input: support/geometry_fuzz.h.
#include "support/geometry_fuzz.h"

#include <cstdlib>

using namespace frontmost;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::optional<test::FuzzInput> input = test::read_input(data, size);
  if (!input) return 0;
  const auto& [bytes, scene] = *input;
  try {
    const View view = test::view_of(bytes);
    const Surfaces surfaces(scene);
    // The first two pictures come from the scene's own arrays, the ZBuffer's from clusters.
    const Visible wide = zbuffer(surfaces, view, {.threads = 2, .isa = Isa::best, .watch = nullptr});
    const Visible plain = zbuffer(surfaces, view, {.threads = 1, .isa = Isa::scalar, .watch = nullptr});
    if (content_hash(wide) != content_hash(plain)) std::abort();
    ZBuffer buffer;
    const Execution two{.threads = 2, .isa = Isa::best, .watch = nullptr};
    if (content_hash(buffer.draw(surfaces, view, two)) != content_hash(plain)) std::abort();
    const Execution one{.threads = 1, .isa = Isa::scalar, .watch = nullptr};
    if (content_hash(buffer.draw(surfaces, view, one)) != content_hash(plain)) std::abort();
    const RayIndex index(surfaces, {.threads = 2, .isa = Isa::best, .watch = nullptr});
    const Visible rays = raycast(index, view, {.threads = 2, .isa = Isa::best, .watch = nullptr});
    const Visible plain_rays = raycast(index, view, {.threads = 1, .isa = Isa::scalar, .watch = nullptr});
    if (content_hash(rays) != content_hash(plain_rays)) std::abort();
    for (const PrimitiveId id : wide.primitives) {
      if (id != no_primitive && id >= surfaces.primitive_count()) std::abort();
    }
  } catch (const Error&) {
    // The camera is at its own target or not finite, which is a documented error.
  }
  return 0;
}
