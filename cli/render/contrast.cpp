// SPDX-License-Identifier: Apache-2.0
#include "cli/render/contrast.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace frontmost::cli {
namespace {

constexpr float most_steps = 8;
constexpr std::size_t one_in = 1000;

float linear(float srgb) { return srgb <= 0.04045f ? srgb / 12.92f : std::pow((srgb + 0.055f) / 1.055f, 2.4f); }

/// Values of a channel that are like the background's, in its own scale.
struct Alike {
  float low, high;
  [[nodiscard]] bool holds(float value) const { return value >= low && value <= high; }
};

/// `scale` takes an sRGB value from 0 to 1 to the channel's.
template <class Scale>
std::array<Alike, 3> alike_to(const glm::vec3& background, const Scale& scale) {
  std::array<Alike, 3> alike{};
  for (int c = 0; c < 3; ++c) {
    const float low = background[c] - most_steps / 255, high = background[c] + most_steps / 255;
    // White that is brighter than white is shown as white.
    alike[std::size_t(c)] = {low <= 0 ? -INFINITY : scale(low), high >= 1 ? INFINITY : scale(high)};
  }
  return alike;
}

/// `stands_out` is asked for pixels that see something.
template <class StandsOut>
bool too_few(std::span<const PrimitiveId> primitives, const StandsOut& stands_out) {
  std::size_t covered = 0, distinct = 0;
  for (std::size_t i = 0; i < primitives.size(); ++i) {
    if (primitives[i] == no_primitive) continue;
    ++covered;
    if (!stands_out(i)) continue;
    if (++distinct * one_in >= primitives.size()) return false;
  }
  return covered > 0 && distinct * one_in < covered;
}

}  // namespace

bool nothing_stands_out(const Image& picture, std::span<const PrimitiveId> primitives, const glm::vec3& background) {
  const std::size_t pixels = std::size_t(picture.width) * std::size_t(picture.height);
  std::array<const float*, 3> planes{};
  for (std::size_t c = 0; c < 3; ++c) {
    const Channel* const channel = picture.find(std::array{"R", "G", "B"}[c]);
    if (!channel) return false;
    planes[c] = channel->floats().data();
  }
  const std::array<Alike, 3> alike = alike_to(background, linear);
  return too_few(primitives.first(pixels), [&](std::size_t i) {
    return !alike[0].holds(planes[0][i]) || !alike[1].holds(planes[1][i]) || !alike[2].holds(planes[2][i]);
  });
}

bool nothing_stands_out(const Bitmap& picture, std::span<const PrimitiveId> primitives, const glm::vec3& background) {
  const std::size_t pixels = std::size_t(picture.width) * std::size_t(picture.height);
  const std::array<Alike, 3> alike = alike_to(background, [](float srgb) { return 255 * srgb; });
  return too_few(primitives.first(pixels), [&](std::size_t i) {
    const std::uint8_t* const rgba = picture.rgba.data() + 4 * i;
    return !alike[0].holds(rgba[0]) || !alike[1].holds(rgba[1]) || !alike[2].holds(rgba[2]);
  });
}

bool nothing_stands_out(const Figure& figure, const glm::vec3& background) {
  const auto is_like = [&](const FigureShape& shape) {
    // What shows of a shape through which the background is seen.
    const float opacity = float(shape.color.a) / 255;
    const glm::vec3 color = glm::vec3(shape.color) / 255.0f;
    const glm::vec3 apart = glm::abs(color - background) * opacity * 255.0f;
    return std::max({apart.r, apart.g, apart.b}) <= most_steps;
  };
  return !figure.shapes.empty() && std::all_of(figure.shapes.begin(), figure.shapes.end(), is_like);
}

std::string contrast_warning() {
  return fmt::format(
      "nothing in the picture stands out from its background: fewer than 1 in {} of the pixels that see something "
      "differ from it by more than {:.0f} of 255 steps; another --background would show them",
      one_in, most_steps);
}

}  // namespace frontmost::cli
