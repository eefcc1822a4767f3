// SPDX-License-Identifier: Apache-2.0
// Small models that would take minutes are refused by counted work; the error names the excess.
#include <gtest/gtest.h>

#include "frontmost/lines.h"
#include "support/costly_meshes.h"
#include "support/refusal.h"

namespace frontmost::test {
namespace {

TEST(TooMuch, HatchingOfSheetsBehindEachOther) {
  const Scene scene = scene_of(parallel_sheets(10000, 1e-3));
  const Surfaces surfaces(scene);
  const View view = frame(surfaces, 3840, 2160, {.direction = NamedView::iso});
  EXPECT_EQ(refusal_of(ErrorCode::limit_exceeded, [&] { (void)hatch(surfaces, view, {.sets = hatch_sets(3, 0.8)}); }),
            "hatch: too many of 20000 triangles lie over each other");
}

TEST(TooMuch, SliversThroughOnePointOfAPlane) {
  const Scene scene = scene_of(flat_slivers(20000));
  const Surfaces surfaces(scene);
  const View view = frame(surfaces, 3840, 2160, {.direction = NamedView::iso});
  const std::string refusal = refusal_of(ErrorCode::limit_exceeded, [&] { (void)draw_lines(surfaces, view); });
  EXPECT_TRUE(
      refusal.starts_with("lines: too many triangles are close to each other to find where they intersect: most of "
                          "them, "))
      << refusal;
}

}  // namespace
}  // namespace frontmost::test
