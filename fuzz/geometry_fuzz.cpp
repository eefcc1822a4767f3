// SPDX-License-Identifier: Apache-2.0
// Arbitrary geometry and an arbitrary camera into the z-buffer and the ray caster. Must not crash or hang; and threads and instruction
// sets must not change a bit of the answer.
//
// Input: 16 bytes of view, then triangles of nine floats each. Floats are taken as they are, so that NaN, infinities,
// denormals and huge values all occur.
#include <frontmost/frontmost.h>

#include <cstdlib>
#include <cstring>

namespace {

using namespace frontmost;

struct ViewBytes {
  std::uint8_t width, height, samples, culling, orthographic, fov, up, spare;
  float eye_x, eye_y;
};
constexpr std::size_t most_triangles = 256;

Scene scene_of(const std::uint8_t* data, std::size_t size) {
  Scene scene;
  scene.meshes.emplace_back();
  scene.instances.emplace_back();
  Mesh& mesh = scene.meshes[0];
  const std::size_t count = std::min(size / sizeof(glm::vec3) / 3, most_triangles);
  mesh.positions.resize(3 * count);
  if (count > 0) std::memcpy(mesh.positions.data(), data, 3 * count * sizeof(glm::vec3));
  for (std::uint32_t i = 0; i < count; ++i) mesh.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
  return scene;
}

View view_of(const ViewBytes& bytes) {
  View view;
  view.width = 1 + bytes.width % 96;
  view.height = 1 + bytes.height % 96;
  view.samples = 1 << (bytes.samples % 5);
  view.culling = Culling(bytes.culling % 4);
  view.world_from_eye = look_at({bytes.eye_x, bytes.eye_y, 3}, {0, 0, 0}, {0, bytes.up % 2, 1});
  const double aspect = double(view.width) / view.height;
  if (bytes.orthographic % 2) {
    view.projection = make_orthographic(-aspect, aspect, -1, 1, {0.5, 100});
  } else {
    view.projection = make_projection(glm::radians(1.0 + bytes.fov % 170), aspect, {0.01, bytes.fov % 2 ? 1e6 : 10});
  }
  return view;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  ViewBytes bytes;
  if (size < sizeof(bytes)) return 0;
  std::memcpy(&bytes, data, sizeof(bytes));
  const Scene scene = scene_of(data + sizeof(bytes), size - sizeof(bytes));
  try {
    const View view = view_of(bytes);
    const Surfaces surfaces(scene);
    const Visible wide = zbuffer(surfaces, view, {.threads = 2, .isa = Isa::best, .watch = nullptr});
    const Visible plain = zbuffer(surfaces, view, {.threads = 1, .isa = Isa::scalar, .watch = nullptr});
    if (content_hash(wide) != content_hash(plain)) std::abort();
    const RayIndex index(surfaces, {.threads = 2, .isa = Isa::best, .watch = nullptr});
    const Visible rays = raycast(index, view, {.threads = 2, .isa = Isa::best, .watch = nullptr});
    const Visible plain_rays = raycast(index, view, {.threads = 1, .isa = Isa::scalar, .watch = nullptr});
    if (content_hash(rays) != content_hash(plain_rays)) std::abort();
    for (const PrimitiveId id : wide.primitives) {
      if (id != no_primitive && id >= surfaces.primitive_count()) std::abort();
    }
  } catch (const Error&) {
    // A camera at its own target, or not finite: a stated outcome.
  }
  return 0;
}
