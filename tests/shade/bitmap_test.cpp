// SPDX-License-Identifier: Apache-2.0
// The picture in bytes is that in floats, converted.
#include <gtest/gtest.h>

#include "frontmost/shade.h"
#include "frontmost/zbuffer.h"
#include "image/srgb_pixels.h"

namespace frontmost::shading {
namespace {

std::vector<std::uint8_t> converted(const Image& image) {
  const ColorPlanes planes = color_planes(image).value();
  std::vector<std::uint8_t> bytes(4 * std::size_t(image.width) * std::size_t(image.height));
  for (int y = 0; y < image.height; ++y)
    srgb8_row(planes, y, true, bytes.data() + 4 * std::size_t(y) * std::size_t(image.width));
  return bytes;
}

TEST(ShadeBitmap, IsTheImageInBytes) {
  for (const char* name : {"gallery", "cubes"}) {
    const Scene scene = builtin(name);
    const Surfaces surfaces(scene);
    View view = frame(surfaces, 131, 77);  // tiles that are not whole
    view.samples = 4;
    const Visible visible = zbuffer(surfaces, view);
    for (const Shading shading : {Shading::lit, Shading::flat, Shading::depth, Shading::ids})
      for (const std::optional<glm::vec3>& background : {std::optional(glm::vec3(0.3f, 1, 0)), {}}) {
        const ShadeOptions options{shading, background};
        const Bitmap bitmap = shade_bitmap(surfaces, visible, options);
        EXPECT_NO_THROW(validate(bitmap));
        const std::vector<std::uint8_t> bytes(bitmap.rgba.begin(), bitmap.rgba.end());
        EXPECT_EQ(bytes, converted(shade(surfaces, visible, options))) << name << ", " << int(shading);
      }
  }
}

}  // namespace
}  // namespace frontmost::shading
