// SPDX-License-Identifier: Apache-2.0
// Masks as pictures, and the folder of masks.
#include <algorithm>

#include "datasets/dataset_files.h"

namespace frontmost::datasets {

Image mask_image(const PixelMask& mask, MaskPart part, const View& view) {
  Buffer<float> values(view.pixel_count(), 0.0f);
  for (int y = mask.box.y; y < mask.box.y + mask.box.height; ++y)
    for (int x = mask.box.x; x < mask.box.x + mask.box.width; ++x) {
      const MaskPixel pixel = mask.at(x, y);
      if (pixel == MaskPixel::visible || (part == MaskPart::whole && pixel == MaskPixel::hidden))
        values[std::size_t(y) * std::size_t(view.width) + std::size_t(x)] = 1;
    }
  Image image{view.width, view.height, {}};
  image.channels.push_back({"Y", std::move(values)});
  return image;
}

void MaskFolder::add(const DatasetView& view, std::size_t number, const ObjectInFrame& object,
                     const Execution& execution) {
  const std::string begin = (is_numbered_ ? six_digits(number) + "_" : "") + six_digits(object.number);
  for (const auto& [part, word] : {std::pair(MaskPart::visible, "_visible.png"), {MaskPart::whole, "_amodal.png"}})
    folder_.add(begin + word, mask_image(object.mask, part, view.visible.view), {}, execution);
}

}  // namespace frontmost::datasets
