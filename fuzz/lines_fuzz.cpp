// SPDX-License-Identifier: Apache-2.0
// Feeds arbitrary geometry and an arbitrary camera to hidden lines. They must not crash or hang; parts follow each
// other within the picture; threads and instruction sets change no bit. Input: support/geometry_fuzz.h.
#include <cstdlib>

#include "support/geometry_fuzz.h"

using namespace frontmost;

namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

bool equal(const DrawnPart& a, const DrawnPart& b) {
  return a.edge == b.edge && a.begin == b.begin && a.end == b.end && a.from == b.from && a.to == b.to &&
         a.hidden_by == b.hidden_by && a.is_outline == b.is_outline;
}

void check(const Drawing& drawing) {
  const DrawnPart* before = nullptr;
  for (const DrawnPart& part : drawing.parts) {
    require(part.edge < drawing.edges.size() && part.begin >= 0 && part.begin < part.end && part.end <= 1);
    require(!part.is_outline || part.hidden_by == 0);
    if (before && before->edge == part.edge) require(before->end == part.begin && before->to == part.from);
    require(!before || before->edge <= part.edge);
    before = &part;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // Any two triangles may cross, and any crossing may hide behind all others.
  const std::optional<test::FuzzInput> input = test::read_input(data, size, 64);
  if (!input) return 0;
  const auto& [bytes, scene] = *input;
  LineOptions options;
  if (bytes.spare & 1) options.crease_angle = 0;
  options.counts_hidden = bytes.spare & 2;
  options.outlines = bytes.spare & 4;
  try {
    const View view = test::view_of(bytes);
    const Surfaces surfaces(scene);
    const Drawing wide = draw_lines(surfaces, view, options, {.threads = 2, .isa = Isa::best, .watch = nullptr});
    const Drawing plain = draw_lines(surfaces, view, options, {.threads = 1, .isa = Isa::scalar, .watch = nullptr});
    check(wide);
    require(wide.parts.size() == plain.parts.size());
    for (std::size_t i = 0; i < wide.parts.size(); ++i) require(equal(wide.parts[i], plain.parts[i]));
  } catch (const Error&) {
    // The camera is at its own target or not finite, which is a documented error.
  }
  return 0;
}
