// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>

#include "frontmost/view.h"
#include "view/answer.h"

namespace frontmost {
namespace {

bool is_mixed(const Visible& visible, int x, int y) {
  const PrimitiveId first = visible.primitives[visible.index(x, y)];
  for (int s = 1; s < visible.view.samples; ++s)
    if (visible.primitives[visible.index(x, y, s)] != first) return true;
  return false;
}

/// Whether every run finds the samples of its mixed pixels within `others`, and no mixed pixel lies beside the picture.
bool has_all_others(const VisiblePixels& pixels) {
  const int width = pixels.view.width, across = int(pixels.runs_across());
  const std::size_t each = std::size_t(pixels.view.samples - 1);
  for (std::size_t number = 0; number < pixels.mixed.size(); ++number) {
    const std::uint32_t mixed = pixels.mixed[number];
    if (mixed == 0) continue;
    const int left = int(number % std::size_t(across)) * VisiblePixels::run;
    const std::size_t end = pixels.places[number] + std::size_t(std::popcount(mixed)) * each;
    if (int(std::bit_width(mixed)) > width - left || end > pixels.other_count) return false;
  }
  return true;
}

}  // namespace

VisiblePixels undefined_pixels(const View& view) {
  validate(view);
  VisiblePixels pixels;
  pixels.view = pixels.first.view = view;
  pixels.first.view.samples = 1;
  const std::size_t count = view.pixel_count(), runs = pixels.runs_across() * std::size_t(view.height);
  pixels.first.primitives = Buffer<PrimitiveId>(count);
  pixels.first.keys = Buffer<float>(count);
  pixels.mixed = Buffer<std::uint16_t>(runs);
  pixels.places = Buffer<std::uint32_t>(runs);
  pixels.others = Buffer<PrimitiveId>(count * std::size_t(view.samples - 1));
  return pixels;
}

VisiblePixels pixels_of(const Visible& visible) {
  check_planes(visible, "pixels_of");
  const View& view = visible.view;
  VisiblePixels pixels = undefined_pixels(view);
  std::copy_n(visible.primitives.begin(), view.pixel_count(), pixels.first.primitives.begin());
  std::copy_n(visible.keys.begin(), view.pixel_count(), pixels.first.keys.begin());
  for (int y = 0; y < view.height; ++y)
    for (int x = 0; x < view.width; ++x) {
      const std::size_t number = std::size_t(y) * pixels.runs_across() + std::size_t(x / VisiblePixels::run);
      if (x % VisiblePixels::run == 0) {
        pixels.mixed[number] = 0;
        pixels.places[number] = std::uint32_t(pixels.other_count);
      }
      if (!is_mixed(visible, x, y)) continue;
      pixels.mixed[number] = std::uint16_t(pixels.mixed[number] | 1u << x % VisiblePixels::run);
      for (int s = 1; s < view.samples; ++s)
        pixels.others[pixels.other_count++] = visible.primitives[visible.index(x, y, s)];
    }
  return pixels;
}

void check_answer(const VisiblePixels& pixels, std::uint32_t primitive_count, const char* who,
                  const Execution& execution) {
  check_answer(pixels.first, primitive_count, who, execution);
  const View &view = pixels.view, &first = pixels.first.view;
  const std::size_t runs = pixels.runs_across() * std::size_t(view.height);
  if (view.width != first.width || view.height != first.height || first.samples != 1 || pixels.mixed.size() != runs ||
      pixels.places.size() != runs || pixels.others.size() < pixels.other_count)
    throw Error(ErrorCode::bad_argument, std::string(who), "the planes do not have the size of their view");
  if (!has_all_others(pixels))
    throw Error(ErrorCode::bad_argument, std::string(who), "mixed pixels lie beyond the planes");
  check_ids({pixels.others.data(), pixels.other_count}, primitive_count, who, execution);
}

}  // namespace frontmost
