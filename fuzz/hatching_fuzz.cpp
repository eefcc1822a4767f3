// SPDX-License-Identifier: Apache-2.0
// Feeds arbitrary geometry, camera and light to hatching and stippling. They must not crash or hang; lines and dots lie
// in the picture, on their rows; threads and instruction sets change no bit. Input: support/geometry_fuzz.h.
#include <cmath>
#include <cstdlib>

#include "support/geometry_fuzz.h"

using namespace frontmost;

namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

bool is_within(const glm::dvec2& p, const View& view) {
  constexpr double rounding = 1e-6;
  return p.x >= -rounding && p.y >= -rounding && p.x <= view.width + rounding && p.y <= view.height + rounding;
}

void check(const std::vector<HatchLine>& lines, const HatchOptions& options, const View& view) {
  for (const HatchLine& line : lines) {
    require(line.set < options.sets.size() && is_within(line.from, view) && is_within(line.to, view));
    const HatchSet& set = options.sets[line.set];
    const glm::dvec2 across(std::sin(set.angle), std::cos(set.angle));
    for (const glm::dvec2& end : {line.from, line.to}) {
      const double row = (glm::dot(across, end) - set.offset) / set.spacing;
      require(std::abs(row - std::round(row)) < 1e-4);
    }
    require(glm::distance(line.from, line.to) >= options.shortest - 1e-6);
  }
}

bool equal(const std::vector<HatchLine>& a, const std::vector<HatchLine>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const HatchLine& x, const HatchLine& y) {
    return x.from == y.from && x.to == y.to && x.set == y.set && x.instance == y.instance;
  });
}

bool equal(const std::vector<Stipple>& a, const std::vector<Stipple>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const Stipple& x, const Stipple& y) { return x.at == y.at && x.instance == y.instance; });
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // Every line is tested against all triangles that it passes.
  const std::optional<test::FuzzInput> input = test::read_input(data, size, 64);
  if (!input) return 0;
  const auto& [bytes, scene] = *input;
  ToneOptions tone;
  tone.casts_shadows = bytes.spare & 1;
  if (bytes.spare & 2) tone.to_light = glm::dvec3(bytes.eye_y, bytes.eye_x, 1);
  HatchOptions options{hatch_sets(3 + bytes.spare % 7, bytes.fov), tone};
  options.shortest = bytes.spare & 4 ? 1 : 0;
  options.nearest_first = bytes.spare & 8;
  const StippleOptions dots{2.0 + bytes.spare % 5, tone, true, bool(bytes.spare & 16)};
  const Execution wide{.threads = 2, .isa = Isa::best, .watch = nullptr},
      plain{.threads = 1, .isa = Isa::scalar, .watch = nullptr};
  try {
    const View view = test::view_of(bytes);
    const Surfaces surfaces(scene);
    const std::vector<HatchLine> lines = hatch(surfaces, view, options, wide);
    check(lines, options, view);
    require(equal(lines, hatch(surfaces, view, options, plain)));
    const std::vector<Stipple> stipples = stipple(surfaces, view, dots, wide);
    for (const Stipple& dot : stipples) require(is_within(dot.at, view));
    require(equal(stipples, stipple(surfaces, view, dots, plain)));
  } catch (const Error&) {
    // The camera is at its own target or not finite, which is a documented error.
  }
  return 0;
}
