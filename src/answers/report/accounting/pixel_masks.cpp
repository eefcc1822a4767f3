// SPDX-License-Identifier: Apache-2.0
// Masks as pixels, and in COCO's formats: run lengths and polygons.
//
//    row 0      ####         one polygon: each run continues the only run above that it touches
//    row 1      ######
//    row 2      ##  ##       where a run splits or two merge, polygons end and others begin
//
// An object is drawn alone within the frame, and compared with what is visible.
#include <algorithm>

#include "base/parallel.h"
#include "report/accounting/object_mask.h"
#include "view/answer.h"

namespace frontmost {

using namespace accounting_detail;

namespace {

bool is_in(MaskPixel pixel, MaskPart part) {
  return pixel == MaskPixel::visible || (part == MaskPart::whole && pixel == MaskPixel::hidden);
}

/// Appends a number, five bits a character, the lowest bits first; the fifth bit of the last character is the sign.
void append_number(std::int64_t value, std::string& text) {
  for (bool more = true; more;) {
    const std::int64_t low = value & 31;
    value >>= 5;
    more = value != ((low & 16) != 0 ? -1 : 0);
    text += char('0' + (more ? low | 32 : low));
  }
}

/// Pixels [x0, x1) of a row, and the left and right sides of their polygon so far: corners from the top, x and y
/// alternating.
struct MaskRun {
  int x0, x1;
  std::vector<int> left{}, right{};
  bool is_continued = false;

  [[nodiscard]] bool touches(const MaskRun& other) const { return x0 < other.x1 && other.x0 < x1; }
};

std::vector<MaskRun> runs_of_row(const PixelMask& mask, MaskPart part, int row) {
  std::vector<MaskRun> runs;
  const MaskPixel* const pixels = mask.pixels.data() + std::size_t(row) * std::size_t(mask.box.width);
  for (int i = 0; i < mask.box.width; ++i) {
    const int x = mask.box.x + i;
    if (!is_in(pixels[i], part)) continue;
    if (runs.empty() || runs.back().x1 != x) runs.push_back({x, x});
    runs.back().x1 = x + 1;
  }
  return runs;
}

/// The only run of the list that `by` touches; null if it touches none or several.
MaskRun* only_touched(std::vector<MaskRun>& runs, const MaskRun& by) {
  MaskRun* found = nullptr;
  for (MaskRun& run : runs) {
    if (!run.touches(by)) continue;
    if (found) return nullptr;
    found = &run;
  }
  return found;
}

/// The finished polygon of a run that ends at y: down the right side and up the left side.
std::vector<int> closed_polygon(MaskRun& run, int y) {
  std::vector<int> polygon = std::move(run.right);
  polygon.insert(polygon.end(), {run.x1, y, run.x0, y});
  for (std::size_t i = run.left.size(); i > 0; i -= 2)
    polygon.insert(polygon.end(), {run.left[i - 2], run.left[i - 1]});
  return polygon;
}

/// Continues the polygon of the run `above` with `run`, the run below it; y is the border between the two rows.
void go_on(MaskRun& above, MaskRun& run, int y) {
  run.left = std::move(above.left);
  run.right = std::move(above.right);
  if (run.x0 != above.x0) run.left.insert(run.left.end(), {above.x0, y, run.x0, y});
  if (run.x1 != above.x1) run.right.insert(run.right.end(), {above.x1, y, run.x1, y});
  above.is_continued = true;
}

}  // namespace

struct PixelMasks::Parts {
  Parts(const Surfaces& surfaces, const Visible& seen, Isa chosen)
      : scene(placed_scene(surfaces)), visible(seen), isa(chosen), canvas(seen.view, 1), mask(scene, canvas, chosen) {}

  const PlacedScene& scene;
  const Visible& visible;
  Isa isa;
  ObjectCanvas canvas;
  ObjectMask mask;
};

PixelMasks::PixelMasks(const Surfaces& surfaces, const Visible& visible, const Execution& execution) {
  validate(visible.view);
  check_answer(visible, surfaces.primitive_count(), "pixel masks", execution);
  parts_ = std::make_unique<Parts>(surfaces, visible, execution.isa);
}

PixelMasks::~PixelMasks() = default;

PixelMask PixelMasks::of(std::uint32_t object) {
  const IeeeScope ieee;
  Parts& parts = *parts_;
  parts.mask.draw(object);
  const PixelRect touched = common_part(parts.mask.touched(), parts.canvas.frame);
  PixelMask result;
  if (touched.is_empty()) return result;
  const MaskPlane& plane = parts.mask.planes()[0];
  const PixelRect rect = count_marked(plane, touched, parts.isa).rect;
  if (rect.is_empty()) return result;
  result.box = {rect.x0, rect.y0, rect.x1 - rect.x0 + 1, rect.y1 - rect.y0 + 1};
  result.pixels = Buffer<MaskPixel>(std::size_t(result.box.width) * std::size_t(result.box.height));
  const PrimitiveId first = parts.scene.first_primitives[object];
  const std::uint32_t count = parts.scene.first_primitives[object + 1] - first;
  MaskPixel* pixel = result.pixels.data();
  for (int y = rect.y0; y <= rect.y1; ++y) {
    const std::uint64_t* const words = plane.row(y);
    const PrimitiveId* const ids = parts.visible.primitives.data() + parts.visible.index(0, y);
    for (int x = rect.x0; x <= rect.x1; ++x) {
      const bool is_marked = (words[x / kWordPixels] >> (x % kWordPixels) & 1) != 0;
      *pixel++ = !is_marked ? MaskPixel::outside : ids[x] - first < count ? MaskPixel::visible : MaskPixel::hidden;
    }
  }
  return result;
}

std::string coco_runs(const PixelMask& mask, MaskPart part, const glm::ivec2& size) {
  std::vector<std::int64_t> runs;
  std::int64_t end = 0;  // end of the runs so far
  for (int x = mask.box.x; x < mask.box.x + mask.box.width; ++x)
    for (int y = mask.box.y; y < mask.box.y + mask.box.height; ++y) {
      if (!is_in(mask.at(x, y), part)) continue;
      const std::int64_t at = std::int64_t(x) * size.y + y;
      if (runs.empty() || at > end) runs.insert(runs.end(), {at - end, 0});
      ++runs.back();
      end = at + 1;
    }
  const std::int64_t rest = std::int64_t(size.x) * size.y - end;
  if (rest > 0) runs.push_back(rest);
  std::string text;
  for (std::size_t i = 0; i < runs.size(); ++i) append_number(i > 2 ? runs[i] - runs[i - 2] : runs[i], text);
  return text;
}

std::vector<std::vector<int>> coco_polygons(const PixelMask& mask, MaskPart part) {
  std::vector<std::vector<int>> polygons;
  std::vector<MaskRun> above;
  for (int row = 0; row <= mask.box.height; ++row) {
    const int y = mask.box.y + row;
    std::vector<MaskRun> runs;
    if (row < mask.box.height) runs = runs_of_row(mask, part, row);
    for (MaskRun& run : runs) {
      MaskRun* const only = only_touched(above, run);
      if (only && only_touched(runs, *only) == &run)
        go_on(*only, run, y);
      else
        run.left = {run.x0, y}, run.right = {run.x1, y};
    }
    for (MaskRun& run : above)
      if (!run.is_continued) polygons.push_back(closed_polygon(run, y));
    above = std::move(runs);
  }
  return polygons;
}

}  // namespace frontmost
