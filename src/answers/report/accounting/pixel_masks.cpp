// SPDX-License-Identifier: Apache-2.0
// Masks as pixels: an object is drawn alone within the frame, and compared with what is visible.
#include "base/parallel.h"
#include "report/accounting/object_mask.h"
#include "view/answer.h"

namespace frontmost {

using namespace accounting_detail;

struct PixelMasks::Parts {
  Parts(const Surfaces& surfaces, const Visible& seen, Isa chosen)
      : scene(placed_scene(surfaces)),
        visible(seen),
        isa(chosen),
        canvas(seen.view, 1),
        first(first_ranges(scene)),
        mask(scene, canvas, chosen) {}

  const PlacedScene& scene;
  const Visible& visible;
  Isa isa;
  ObjectCanvas canvas;
  std::vector<std::size_t> first;
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
  const std::size_t begin = parts.first[object], end = parts.first[object + 1];
  parts.mask.draw(std::span(parts.scene.ranges).subspan(begin, end - begin));
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

}  // namespace frontmost
