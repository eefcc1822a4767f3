// SPDX-License-Identifier: Apache-2.0
// The picture in bytes equals the converted picture in floats.
#include <gtest/gtest.h>

#include "frontmost/pictures.h"
#include "frontmost/sheets.h"
#include "frontmost/zbuffer.h"
#include "image/srgb_pixels.h"
#include "support/same_visible.h"

namespace frontmost::shading {
namespace {

std::vector<std::uint8_t> bytes_of(const Bitmap& bitmap) { return {bitmap.rgba.begin(), bitmap.rgba.end()}; }

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
    View view = frame(surfaces, 131, 77);  // the picture has partial tiles
    view.samples = 4;
    const Visible visible = zbuffer(surfaces, view);
    for (const Shading shading : {Shading::lit, Shading::flat, Shading::depth, Shading::ids})
      for (const std::optional<glm::vec3>& background : {std::optional(glm::vec3(0.3f, 1, 0)), {}}) {
        const ShadeOptions options{shading, background};
        const Bitmap bitmap = shade_bitmap(surfaces, visible, options);
        EXPECT_NO_THROW(validate(bitmap));
        EXPECT_EQ(bytes_of(bitmap), converted(shade(surfaces, visible, options))) << name << ", " << int(shading);
        for (const Isa isa : available_isas())
          EXPECT_EQ(bytes_of(shade_bitmap(surfaces, visible, options, {.isa = isa})), bytes_of(bitmap)) << int(isa);
      }
  }
}

TEST(ShadeBitmap, OfPixelsIsThatOfPlanes) {
  for (const char* name : {"gallery", "cubes", "spheres"}) {
    const Scene scene = builtin(name);
    for (const int samples : {1, 2, 4, 16})
      for (const Shading shading : {Shading::lit, Shading::flat, Shading::normals, Shading::ids, Shading::uv}) {
        const Surfaces surfaces(scene);  // a new object, so that the z-buffer draws without clusters
        View view = frame(surfaces, 131, 77);
        view.samples = samples;
        const Visible visible = zbuffer(surfaces, view);
        const Bitmap bitmap = shade_bitmap(surfaces, visible, {shading});
        EXPECT_EQ(bytes_of(shade_bitmap(surfaces, zbuffer_pixels(surfaces, view), {shading})), bytes_of(bitmap));
        EXPECT_EQ(bytes_of(shade_bitmap(surfaces, zbuffer_pixels(surfaces, view), {shading})), bytes_of(bitmap))
            << "by clusters";
      }
  }
}

TEST(ShadeBitmap, OfPixelsThatAreNotThoseOfTheSurfacesIsRefused) {
  const Scene scene = builtin("cubes"), other = builtin("teapot");
  const Surfaces surfaces(scene);
  View view = frame(surfaces, 60, 48);
  view.samples = 4;
  const VisiblePixels pixels = zbuffer_pixels(surfaces, view);
  EXPECT_THROW((void)shade_bitmap(surfaces, pixels, {Shading::depth}), Error);
  EXPECT_THROW((void)shade_bitmap(surfaces, zbuffer_pixels(Surfaces(other), view)), Error);
  EXPECT_THROW((void)draw_figure(surfaces, {.pixels = &pixels}), Error);
  EXPECT_THROW((void)shade(surfaces, ShadeInput{}), Error) << "nothing is given";
  EXPECT_THROW((void)shade(surfaces, ShadeInput{&pixels.first, &pixels}), Error) << "both are given";
  EXPECT_THROW((void)shade_deep(surfaces, ShadeInput{}), Error);
  EXPECT_THROW((void)draw_figure(surfaces, ShadeInput{}), Error);
  EXPECT_THROW((void)shade(surfaces, ScanInput{}), Error);
  VisiblePixels short_of_runs = pixels, short_of_others = pixels;
  short_of_runs.mixed = Buffer<std::uint16_t>(1);
  ++short_of_others.other_count;
  short_of_others.others = Buffer<PrimitiveId>(pixels.other_count);
  EXPECT_THROW((void)shade_bitmap(surfaces, short_of_runs), Error);
  EXPECT_THROW((void)shade_bitmap(surfaces, short_of_others), Error);
  const auto mixed = std::size_t(std::find_if(pixels.mixed.begin(), pixels.mixed.end(), [](auto m) { return m != 0; }) -
                                 pixels.mixed.begin());
  ASSERT_LT(mixed, pixels.mixed.size());
  VisiblePixels far_place = pixels, beside = pixels;
  far_place.places[mixed] = std::uint32_t(pixels.other_count);
  EXPECT_THROW((void)shade_bitmap(surfaces, far_place), Error);
  beside.mixed[3] = 0x8000;  // x 63 of 60
  beside.places[3] = 0;
  EXPECT_THROW((void)shade_bitmap(surfaces, beside), Error);
}

}  // namespace
}  // namespace frontmost::shading
