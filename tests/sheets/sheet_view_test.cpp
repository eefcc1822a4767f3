// SPDX-License-Identifier: Apache-2.0
// Sheets: position, layer, group and pen of strokes on the page.
#include <cmath>
#include <numbers>

#include "frontmost/sheets.h"
#include "io/drawings/sample_page.h"
#include "support/random_scene.h"

namespace frontmost::test {
namespace {

/// Two objects. The tests add strokes of every class, each from (0, 0) to (10, 0) pixels.
Scene two_objects() {
  Mesh mesh;
  add_triangle(mesh, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  Scene scene = scene_of(mesh);
  scene.instances.push_back({"other", 0, glm::dmat4(1)});
  return scene;
}

Strokes strokes_of(const std::vector<Stroke>& classes) {
  Strokes all;
  for (Stroke stroke : classes) {
    stroke.first = std::uint32_t(all.points.size());
    stroke.count = 2;
    all.points.insert(all.points.end(), {{0, 0}, {10, 0}});
    all.strokes.push_back(stroke);
  }
  return all;
}

constexpr Stroke hidden{EdgeKind::crease, true, false, 0, 0, 0, false},
    seen{EdgeKind::silhouette, false, false, 0, 0, 0, false}, crease{EdgeKind::crease, false, false, 0, 0, 0, false},
    outline{EdgeKind::silhouette, false, true, 1, 0, 0, false};

TEST(DrawSheet, LayersGroupsAndPens) {
  const Scene scene = two_objects();
  const Surfaces surfaces(scene);
  const SheetView view{"front", strokes_of({hidden, hidden, outline, seen, crease}), {20, 30}, 0.5};
  const Page page = page_of(surfaces, std::span(&view, 1), figure_pens(), {100, 80});
  EXPECT_EQ(page.width, 100);
  EXPECT_EQ(page.title, "test");
  ASSERT_EQ(page.layers.size(), 3u);
  EXPECT_EQ(page.layers[0].name, "1 hidden");
  ASSERT_EQ(page.layers[0].groups.size(), 1u);
  EXPECT_EQ(page.layers[0].groups[0].name, "front: object");
  EXPECT_EQ(page.layers[0].groups[0].paths.size(), 2u);
  EXPECT_EQ(page.layers[0].groups[0].points[1], glm::dvec2(25, 30));
  EXPECT_FALSE(page.layers[0].groups[0].pen.dashes.empty());
  ASSERT_EQ(page.layers[1].groups.size(), 2u);  // contours and creases have pens of their own
  EXPECT_GT(page.layers[1].groups[0].pen.width, page.layers[1].groups[1].pen.width);
  EXPECT_EQ(page.layers[2].groups[0].name, "front: other");
  EXPECT_GT(page.layers[2].groups[0].pen.width, page.layers[1].groups[0].pen.width);
  EXPECT_NO_THROW(validate(page));
  // Hidden contours and creases share one pen.
  const SheetView below{"", strokes_of({hidden, {EdgeKind::silhouette, true, false, 0, 0, 0, false}}), {0, 0}, 1};
  EXPECT_EQ(page_of(surfaces, std::span(&below, 1), figure_pens(), {100, 80}).layers[0].groups.size(), 1u);
  // In a technical drawing, visible ones share a pen too.
  EXPECT_EQ(page_of(surfaces, std::span(&view, 1), technical_pens(), {100, 80}).layers[1].groups.size(), 1u);
}

TEST(DrawSheet, ViewsAreNamedApartAndEmptyLayersAreNotThere) {
  const Scene scene = two_objects();
  const Surfaces surfaces(scene);
  const SheetView views[] = {{"front", strokes_of({seen}), {0, 0}, 1}, {"top", strokes_of({seen, seen}), {0, 50}, 1}};
  const Page page = page_of(surfaces, views, technical_pens(), {100, 80});
  ASSERT_EQ(page.layers.size(), 1u);
  EXPECT_EQ(page.layers[0].name, "2 visible");
  ASSERT_EQ(page.layers[0].groups.size(), 2u);
  EXPECT_EQ(page.layers[0].groups[1].name, "top: object");
  EXPECT_EQ(page.layers[0].groups[1].paths.size(), 2u);
  EXPECT_TRUE(page_of(surfaces, {}, technical_pens(), {100, 80}).layers.empty());
}

TEST(DrawSheet, GroupsWithAndWithoutArcsAreWhole) {
  const Scene scene = two_objects();
  const Surfaces surfaces(scene);
  Strokes arcs = strokes_of({seen, seen});
  arcs.bulges = {1, 0, 0, 0};
  const SheetView view{"", arcs, {0, 0}, 1};
  const Page page = page_of(surfaces, std::span(&view, 1), technical_pens(), {100, 80});
  EXPECT_NO_THROW(validate(page));
  EXPECT_EQ(page.layers[0].groups[0].name, "object");
  const PenTravel sum = travel_of(page);
  EXPECT_EQ(sum.arcs, 1u);
  EXPECT_EQ(sum.paths, 2u);
  EXPECT_NEAR(sum.down, 5 * std::numbers::pi + 10, 1e-9);
  EXPECT_NEAR(sum.up, 10, 1e-9);
}

TEST(PenTravelOf, AClosedPathEndsWhereItBegins) {
  Page page;
  PageGroup group{"", {}};
  group.add(std::vector<glm::dvec2>{{3, 4}, {6, 4}, {6, 8}}, true);
  group.add(std::vector<glm::dvec2>{{3, 5}}, false);
  page.layers = {{"", {group}}};
  const PenTravel sum = travel_of(page);
  EXPECT_EQ(sum.down, 3 + 4 + 5);
  EXPECT_EQ(sum.up, 5 + 1);
  EXPECT_EQ(sum.points, 4u);
}

TEST(BoundsOfADrawing, CountHiddenPartsWhereAskedFor) {
  Drawing drawing;
  EXPECT_TRUE(bounds_of(drawing, true).is_empty());
  DrawnPart part;
  part.from = {1, 2};
  part.to = {3, -4};
  drawing.parts.push_back(part);
  part.to = {9, 9};
  part.hidden_by = 1;
  drawing.parts.push_back(part);
  EXPECT_EQ(bounds_of(drawing, false).high, glm::dvec2(3, 2));
  EXPECT_EQ(bounds_of(drawing, true).high, glm::dvec2(9, 9));
  EXPECT_EQ(bounds_of(drawing, true).low, glm::dvec2(1, -4));
}

TEST(DrawSheet, CentreLinesBeginAndEndInDashes) {
  const Scene scene = two_objects();
  const Surfaces surfaces(scene);
  for (double length = 1; length < 400; length += 3.7) {
    SheetView view{"front", {}, {20, 30}, 0.5};
    view.centre_lines.push_back({{0, 0}, {2 * length, 0}});
    const Page page = page_of(surfaces, std::span(&view, 1), technical_pens(), {500, 80});
    ASSERT_EQ(page.layers.size(), 1u);
    EXPECT_EQ(page.layers[0].name, "6 centre lines");
    const std::vector<double>& dashes = page.layers[0].groups.at(0).pen.dashes;
    if (dashes.empty()) {
      EXPECT_LT(length, 15);
      continue;
    }
    ASSERT_EQ(dashes.size(), 4u);
    const double between = dashes[1] + dashes[2] + dashes[3];
    const double count = (length + between) / (dashes[0] + between), odd = 2 * std::round((count - 1) / 2) + 1;
    EXPECT_GE(odd, 3) << length;
    EXPECT_NEAR(odd * (dashes[0] + between) - between, length, 0.02 * odd / 2) << length;
    EXPECT_NEAR(dashes[0], 6, 3.1) << length;
  }
}

}  // namespace
}  // namespace frontmost::test
