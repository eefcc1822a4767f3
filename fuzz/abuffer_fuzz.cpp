// SPDX-License-Identifier: Apache-2.0
// Feeds arbitrary geometry and an arbitrary camera to the A-buffer and to pictures of its layers. They must not crash
// or hang; lists are in order and their nearest layer is the z-buffer's; threads and instruction sets change no bit.
// Input: support/geometry_fuzz.h.
#include <cstdlib>

#include "support/flat_picture.h"
#include "support/geometry_fuzz.h"

using namespace frontmost;

namespace {

constexpr Execution kWide{.threads = 2, .isa = Isa::best, .watch = nullptr};
constexpr Execution kPlain{.threads = 1, .isa = Isa::scalar, .watch = nullptr};

void require(bool holds) {
  if (!holds) std::abort();
}

bool equal(const Fragment& a, const Fragment& b) {
  const float found[] = {a.key, a.key_dx, a.key_dy, a.opacity}, wanted[] = {b.key, b.key_dx, b.key_dy, b.opacity};
  return a.mask == b.mask && a.primitive == b.primitive && std::memcmp(found, wanted, sizeof found) == 0;
}

/// Colours, some opaque, some nearly invisible.
std::vector<glm::vec4> colors_of(std::size_t count, std::uint8_t seed) {
  std::vector<glm::vec4> colors;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t mixed = (std::uint32_t(i) + 1) * 2654435761u + seed;
    colors.emplace_back(float(mixed & 15) / 15, float(mixed >> 8 & 15) / 15, float(mixed >> 16 & 15) / 15,
                        float(mixed >> 24 & 3) / 3);
  }
  return colors;
}

void check_lists(const Surfaces& surfaces, const View& view, const AbufferOptions& options) {
  const FragmentLists lists = abuffer(surfaces, view, options, kWide), plain = abuffer(surfaces, view, options, kPlain);
  require(lists.fragments.size() == plain.fragments.size());
  for (std::size_t i = 0; i < lists.fragments.size(); ++i) require(equal(lists.fragments[i], plain.fragments[i]));
  const std::size_t samples = lists.samples.size();
  for (int y = 0; y < view.height; ++y)
    for (int x = 0; x < view.width; ++x) {
      const Fragment* before = nullptr;
      for (const Fragment& f : lists.at(x, y)) {
        require(f.mask != 0 && (samples == 64 || f.mask >> samples == 0) && f.primitive < surfaces.primitive_count());
        require(f.key >= 0 && f.key <= 1);
        if (before) require(before->key > f.key || (before->key == f.key && before->primitive <= f.primitive));
        before = &f;
      }
    }
}

void check_picture(const Surfaces& surfaces, const View& view, const AbufferOptions& options) {
  const Image wide = test::flat_picture(surfaces, view, options, kWide);
  require(content_hash(wide) == content_hash(test::flat_picture(surfaces, view, options, kPlain)));
  for (const Channel& channel : wide.channels)
    for (const float value : channel.floats()) require(value >= 0 && value <= 1.00001f);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::optional<test::FuzzInput> input = test::read_input(data, size);
  if (!input) return 0;
  const auto& [bytes, scene] = *input;
  constexpr int kGrids[] = {0, 2, 4, 8};
  const AbufferOptions options{kGrids[bytes.spare % 4], bytes.spare & 4 ? 1.0f : 0.7f};
  try {
    const View view = test::view_of(bytes);
    const Scene colored = test::painted(scene, colors_of(scene.meshes[0].triangles.size(), bytes.spare));
    const Surfaces surfaces(colored);
    check_lists(surfaces, view, options);
    check_picture(surfaces, view, options);
    const std::vector<Visible> layers = visible_layers(surfaces, view, 2, options, kWide);
    require(content_hash(layers[0]) == content_hash(zbuffer(surfaces, view, kWide)));
  } catch (const Error&) {
    // The camera is at its own target or not finite, which is a documented error.
  }
  return 0;
}
