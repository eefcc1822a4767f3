// SPDX-License-Identifier: Apache-2.0
// The lesson on the A-buffer: the fragments of a pixel with their masks, composited by depth and in the file's order.
#include <frontmost/abuffer.h>

#include <algorithm>

#include "web/lessons/lessons.h"

namespace frontmost::web {
namespace {

constexpr int kGrid = 8, kBits = kGrid * kGrid;

int count_bits(std::uint64_t mask) {
  int count = 0;
  for (; mask != 0; mask &= mask - 1) ++count;
  return count;
}

/// Composites fragments, nearest first: each hides its share of the rest. Colours are those of triangles, with straight
/// alpha.
void composite(std::span<const Fragment> fragments, double opacity, const std::vector<std::uint8_t>& palette,
               std::uint8_t* rgba) {
  double left = 1, sum[3] = {};
  for (const Fragment& fragment : fragments) {
    const double hides = left * opacity * count_bits(fragment.mask) / kBits;
    for (std::size_t c = 0; c < 3; ++c) sum[c] += hides * palette[4 * fragment.primitive + c];
    left -= hides;
  }
  if (left >= 1) return;
  for (std::size_t c = 0; c < 3; ++c) rgba[c] = std::uint8_t(std::clamp(sum[c] / (1 - left), 0.0, 255.0));
  rgba[3] = std::uint8_t((1 - left) * 255 + 0.5);
}

/// The colours that triangles have in other lessons, too.
std::vector<std::uint8_t> palette_of(std::uint32_t triangles) {
  Visible each;
  each.primitives = Buffer<PrimitiveId>(triangles);
  for (PrimitiveId id = 0; id < triangles; ++id) each.primitives[id] = id;
  return triangle_colors(each);
}

PlainJson fragments_json(const FragmentLists& lists, int x, int y) {
  PlainJson json = PlainJson::array();
  for (const Fragment& fragment : lists.at(x, y)) {
    std::string bits;
    for (int i = 0; i < kBits; ++i) bits += fragment.mask >> i & 1 ? '1' : '0';
    json.push_back({{"triangle", fragment.primitive},
                    {"depth", depth_of_key(lists.view, fragment.key)},
                    {"mask", bits},
                    {"covered", double(count_bits(fragment.mask)) / kBits}});
  }
  return json;
}

}  // namespace

PlainJson layers_lesson(const PlainJson& question) {
  static std::vector<std::uint8_t> sorted, unsorted;
  const LessonScene& stage = lesson_scene(question);
  const View view = lesson_view(stage, question);
  const double opacity = std::clamp(question.value("opacity", 0.5), 0.05, 1.0);
  const FragmentLists lists = abuffer(stage.surfaces, view, {kGrid, float(opacity)});
  const std::vector<std::uint8_t> palette = palette_of(stage.surfaces.primitive_count());
  sorted.assign(4 * view.pixel_count(), 0);
  unsorted = sorted;
  std::size_t differing = 0, longest = 0;
  std::vector<Fragment> by_file;
  for (std::size_t i = 0; i < view.pixel_count(); ++i) {
    const auto list = lists.at(int(i % std::size_t(view.width)), int(i / std::size_t(view.width)));
    composite(list, opacity, palette, &sorted[4 * i]);
    // Triangles drawn later lie on top, as without a depth buffer.
    by_file.assign(list.begin(), list.end());
    std::sort(by_file.begin(), by_file.end(),
              [](const Fragment& a, const Fragment& b) { return a.primitive > b.primitive; });
    composite(by_file, opacity, palette, &unsorted[4 * i]);
    differing += !std::equal(&sorted[4 * i], &sorted[4 * i] + 4, &unsorted[4 * i]);
    longest = std::max(longest, list.size());
  }
  const int x = question.value("x", view.width / 2), y = question.value("y", view.height / 2);
  return {{"width", view.width},
          {"height", view.height},
          {"pixels", place_of(sorted.data(), sorted.size())},
          {"unsorted", place_of(unsorted.data(), unsorted.size())},
          {"differing", differing},
          {"fragments", lists.fragments.size()},
          {"longest", longest},
          {"list", fragments_json(lists, std::clamp(x, 0, view.width - 1), std::clamp(y, 0, view.height - 1))}};
}

}  // namespace frontmost::web
