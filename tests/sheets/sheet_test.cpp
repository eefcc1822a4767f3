// SPDX-License-Identifier: Apache-2.0
// Whole sheets by one call: sizes computed by hand, reported facts, and refused calls.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include "frontmost/scene.h"
#include "frontmost/sheets.h"
#include "support/meshes.h"
#include "support/random_scene.h"

namespace frontmost::test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;
using V = NamedView;

/// A block 40 wide, 30 deep and 20 high, z up.
Scene block(const glm::vec3& size = {40, 30, 20}) {
  Mesh mesh;
  const auto corner = [&](int i) { return glm::vec3(i & 1 ? size.x : 0, i & 2 ? size.y : 0, i & 4 ? size.z : 0); };
  const int faces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& f : faces) {
    add_triangle(mesh, corner(f[0]), corner(f[1]), corner(f[2]));
    add_triangle(mesh, corner(f[0]), corner(f[2]), corner(f[3]));
  }
  Scene scene = scene_of(mesh);
  scene.up = Axis::z;
  return scene;
}

class SheetOfBlock : public testing::Test {
 protected:
  [[nodiscard]] Sheet drawn(const SheetOptions& options) const { return draw_sheet(surfaces_, options); }
  [[nodiscard]] Sheet drawn_with(SheetOptions options, Lettering lettering) const {
    options.lettering = lettering;
    return drawn(options);
  }

  /// Bounds of a view, in millimetres of the page.
  [[nodiscard]] static DrawingBounds box_of(const DrawnView& view) {
    const DrawingBounds box = bounds_of(view.drawing, view.shows_hidden);
    return {view.placed.on_page(box.low), view.placed.on_page(box.high)};
  }
  static void expect_box(const DrawingBounds& box, const glm::dvec2& low, const glm::dvec2& high) {
    for (int axis = 0; axis < 2; ++axis) {
      EXPECT_NEAR(box.low[axis], low[axis], 1e-6);
      EXPECT_NEAR(box.high[axis], high[axis], 1e-6);
    }
  }

  const Scene scene_ = block();
  const Surfaces surfaces_{scene_};
};

TEST_F(SheetOfBlock, ViewsStandInLineFifteenMillimetresApart) {
  const Sheet sheet = drawn({.views = {V::front, V::top, V::left}, .scale = 1});
  EXPECT_NEAR(sheet.page.width, 10 + 40 + 15 + 30 + 10, 1e-6);
  EXPECT_NEAR(sheet.page.height, 10 + 20 + 15 + 30 + 10, 1e-6);
  EXPECT_EQ(sheet.scale, 1);
  ASSERT_EQ(sheet.views.size(), 3u);
  expect_box(box_of(sheet.views[0]), {10, 10}, {50, 30});
  expect_box(box_of(sheet.views[1]), {10, 45}, {50, 75});
  expect_box(box_of(sheet.views[2]), {65, 10}, {95, 30});
  const Sheet third = drawn({.views = {V::front, V::top}, .projection = ProjectionMethod::third_angle, .scale = 2});
  expect_box(box_of(third.views[0]), {10, 85}, {90, 125});
  expect_box(box_of(third.views[1]), {10, 10}, {90, 70});
}

TEST_F(SheetOfBlock, AViewAloneIsInMillimetresWithDashes) {
  const View view = frame(surfaces_, 800, 600, {.direction = V::iso, .orthographic = true});
  const Sheet plain = draw_view(surfaces_, view, {.scale = 2});
  const Sheet dashed = draw_view(surfaces_, view, {.hidden = HiddenLines::dashed, .scale = 2});
  // Seen along the diagonal of a cube, an edge of 1 is sqrt(2/3) long; width and depth appear at 30 degrees.
  EXPECT_NEAR(plain.page.width, 20 + 2 * (40 + 30) * std::sqrt(2.0 / 3) * std::cos(std::numbers::pi / 6), 1e-3);
  ASSERT_EQ(plain.page.layers.size(), 1u);
  ASSERT_EQ(dashed.page.layers.size(), 2u);
  EXPECT_EQ(dashed.page.layers[0].name, "1 hidden");
  EXPECT_EQ(dashed.page.layers[0].groups[0].pen.dashes, (std::vector<double>{3, 0.75}));
  EXPECT_EQ(travel_of({100, 100, "", {dashed.page.layers[0]}}).paths, 3u);  // edges that meet in one vertex
  EXPECT_EQ(dashed.views[0].name, "");
  EXPECT_EQ(dashed.views[0].surfaces.get(), &surfaces_);
}

TEST_F(SheetOfBlock, PerspectiveHasNoScaleAndKeepsItsPictureWhereAsked) {
  const View view = frame(surfaces_, 400, 200);
  const Sheet sheet = draw_view(surfaces_, view, {.page = Paper{{120, 70}, false}, .keeps_picture = true});
  EXPECT_FALSE(sheet.scale);
  EXPECT_NEAR(sheet.views[0].placed.millimetres_per_pixel, 0.25, 1e-12);
  EXPECT_NEAR(sheet.views[0].placed.origin.x, 10, 1e-9);
  EXPECT_NEAR(sheet.views[0].placed.origin.y, 10, 1e-9);
}

TEST_F(SheetOfBlock, UnitsAreOfTheFileOrAsTold) {
  Scene scene = block();
  const auto width = [&](const SheetOptions& options) {
    const Surfaces surfaces(scene);
    return draw_sheet(surfaces, options).page.width;
  };
  EXPECT_NEAR(width({.views = {V::front}, .scale = 1}), 60, 1e-6);
  EXPECT_NEAR(width({.views = {V::front}, .scale = 1, .millimetres_per_unit = 25.4}), 20 + 40 * 25.4, 1e-3);
  scene.source.metres_per_unit = 1;
  EXPECT_NEAR(width({.views = {V::front}, .scale = 0.01}), 20 + 400, 1e-4);
  EXPECT_NEAR(width({.views = {V::front}, .scale = 1, .millimetres_per_unit = 1}), 60, 1e-6);
}

TEST_F(SheetOfBlock, TheTitleBlockSaysWhatTheSheetIs) {
  const Sheet sheet = drawn({.views = {V::front, V::top, V::left, V::iso},
                             .sections = {{V::left, 10.0}},
                             .dimensions = Dimensioning::diameters,
                             .hidden = HiddenLines::dashed,
                             .page = named_paper("a3"),
                             .title_block = TitleBlock{.title = "Block"}});
  EXPECT_EQ(sheet.page.title, "Block");
  EXPECT_EQ(glm::dvec2(sheet.page.width, sheet.page.height), glm::dvec2(420, 297));
  EXPECT_EQ(sheet.scale, standard_scale(*sheet.scale));
  std::vector<std::string> layers, views;
  for (const PageLayer& layer : sheet.page.layers) layers.push_back(layer.name);
  for (const DrawnView& view : sheet.views) views.push_back(view.name);
  EXPECT_THAT(layers, testing::ElementsAre("4 hatching", "2 visible", "9 sections", "7 dimensions", "8 frame"));
  EXPECT_THAT(views, testing::ElementsAre("front", "top", "left", "iso", "A-A"));
  ASSERT_TRUE(sheet.views[4].section);
  EXPECT_NEAR(sheet.views[4].section->faces[0].area, 600, 1e-3);
  EXPECT_FALSE(sheet.views[0].section);
  EXPECT_EQ(sheet.left_out, 0u);
  EXPECT_FALSE(sheet.is_empty);
}

/// All points of a page, sorted, with the texts in strokes.
std::vector<std::pair<double, double>> points_of(Page page) {
  std::vector<std::pair<double, double>> points;
  for (PageLayer& layer : page.layers)
    for (PageGroup& group : layer.groups) {
      for (const PlacedText& text : group.texts) add_text(group, text.text, text.at, text.style);
      for (const glm::dvec2& p : group.points) points.emplace_back(p.x, p.y);
    }
  std::sort(points.begin(), points.end());
  return points;
}

TEST_F(SheetOfBlock, TextsAreWhereTheirStrokesWouldBe) {
  SheetOptions options{.views = {V::front, V::top}, .sections = {{V::left, std::nullopt}}};
  options.dimensions = Dimensioning::all;
  options.page = named_paper("a3");
  options.title_block = TitleBlock{.title = "A block", .author = "E. Example"};
  const Sheet drawn = drawn_with(options, Lettering::strokes), written = drawn_with(options, Lettering::text);
  EXPECT_EQ(travel_of(drawn.page).texts, 0u);
  EXPECT_EQ(points_of(drawn.page), points_of(written.page));
  EXPECT_LT(travel_of(written.page).paths, travel_of(drawn.page).paths);
  std::multiset<std::string> texts;
  for (const PageLayer& layer : written.page.layers)
    for (const PageGroup& group : layer.groups)
      for (const PlacedText& text : group.texts) texts.insert(text.text);
  for (const char* const text : {"A block", "E. Example", "Legal owner", "A-A", "40", "30", "20"})
    EXPECT_EQ(texts.count(text), 1u) << text;
  EXPECT_EQ(texts.count("A"), 2u + 2u) << "the ends of the cutting line, and zones on both sides";
}

TEST(SheetOfSpheres, CurvedSurfacesAreMadeAnewAndStay) {
  std::optional<Sheet> sheet;
  {
    const Scene scene = builtin("spheres");
    const Surfaces surfaces(scene);
    sheet = draw_sheet(surfaces, {.views = {V::front, V::top}});
    EXPECT_GT(sheet->views[0].surfaces->primitive_count(), surfaces.primitive_count());
  }
  // Triangle numbers stay meaningful after the input is gone.
  for (const DrawnView& view : sheet->views) {
    ASSERT_FALSE(view.drawing.edges.empty());
    for (const DrawnEdge& edge : view.drawing.edges)
      EXPECT_TRUE(edge.left == no_primitive || edge.left < view.surfaces->primitive_count());
  }
}

TEST(SheetOfNothing, IsEmpty) {
  const Scene scene;
  const Surfaces surfaces(scene);
  const Sheet sheet = draw_sheet(surfaces, {.views = {V::front}});
  EXPECT_TRUE(sheet.is_empty);
  EXPECT_TRUE(sheet.page.layers.empty());
}

/// The plane cuts the block in half.
TEST_F(SheetOfBlock, PlanesMayCrossTheModel) {
  const SheetOptions whole_options{.views = {V::front}, .hidden = HiddenLines::dashed, .page = Paper{}};
  const Sheet whole = drawn(whole_options);
  const ClipDistances fitted = whole.views[0].drawing.view.projection.clip;
  const double middle = (fitted.near + fitted.far) / 2;
  const auto edges_drawn = [](const Sheet& sheet) {
    std::set<std::uint32_t> edges;
    for (const DrawnPart& part : sheet.views[0].drawing.parts) edges.insert(part.edge);
    return edges.size();
  };
  EXPECT_EQ(edges_drawn(whole), 12u);
  for (const bool is_near : {true, false}) {
    SheetOptions options = whole_options;
    (is_near ? options.near : options.far) = middle;
    const Sheet half = drawn(options);
    EXPECT_FALSE(half.is_empty);
    EXPECT_EQ(half.scale, whole.scale);
    // The remaining face across the view direction has its four edges; edges along that direction are seen end-on.
    const DrawingBounds box = box_of(half.views[0]), all = box_of(whole.views[0]);
    expect_box(box, all.low, all.high);
    EXPECT_EQ(edges_drawn(half), 8u);
  }
  SheetOptions options{.sections = {{V::front}}, .far = fitted.near + 0.1};
  const Sheet nothing = drawn(options);
  EXPECT_TRUE(nothing.is_empty) << "the section lies behind the far plane";
  EXPECT_TRUE(nothing.page.layers.empty());
}

/// A peg along z about (20, 15), 4 thick, from z = 5 on; `bore`: the radius of a hole along it, or 0.
Mesh upright_peg(float height, float bore) {
  constexpr int sides = 36;
  Mesh mesh;
  const auto at = [&](float radius, int k, float z) {
    const double angle = 2 * std::numbers::pi * (k % sides) / sides;
    return glm::vec3(20 + radius * std::cos(angle), 15 + radius * std::sin(angle), z + 5);
  };
  const auto add_quad = [&](const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec3& d) {
    add_triangle(mesh, a, b, c);
    add_triangle(mesh, a, c, d);
  };
  for (int i = 0; i < sides; ++i) {
    add_quad(at(2, i, 0), at(2, i + 1, 0), at(2, i + 1, height), at(2, i, height));
    add_quad(at(bore, i, height), at(2, i, height), at(2, i + 1, height), at(bore, i + 1, height));
    add_quad(at(2, i, 0), at(bore, i, 0), at(bore, i + 1, 0), at(2, i + 1, 0));
    if (bore > 0) add_quad(at(bore, i + 1, 0), at(bore, i, 0), at(bore, i, height), at(bore, i + 1, height));
  }
  return mesh;
}

/// The number of faces that a section from this side shows of a block and another object.
std::size_t faces_of(Mesh other, const std::string& name, V direction,
                     const std::vector<std::string>* uncut = nullptr) {
  Scene scene = block();
  other.name = name;
  add(scene, std::move(other));
  SheetOptions options{.sections = {{direction}}};
  if (uncut != nullptr) options.uncut = *uncut;
  return draw_sheet(Surfaces(scene), options).views.at(0).section->faces.size();
}

TEST(UncutObjects, AreFastenersAndShaftsAlongTheirAxis) {
  const std::vector<std::string> none, others{"Stud"};
  for (const char* const name : {"Bolt-2", "BOLTS", "hex bolt M6 (left)", "pin_1"}) {
    EXPECT_EQ(faces_of(upright_peg(7, 0), name, V::front), 1u) << name;
    EXPECT_EQ(faces_of(upright_peg(7, 0), name, V::top), 2u) << name << ", cut across";
    EXPECT_EQ(faces_of(upright_peg(7, 0), name, V::front, &none), 2u) << name;
  }
  for (const char* const name : {"boltless", "spin", "part", ""})
    EXPECT_EQ(faces_of(upright_peg(7, 0), name, V::front), 2u) << name << ", shorter than twice its thickness";
  EXPECT_EQ(faces_of(upright_peg(7, 0), "studs 4", V::front, &others), 1u);
  EXPECT_EQ(faces_of(upright_peg(30, 0), "part", V::front), 1u) << "a shaft by its shape";
  EXPECT_EQ(faces_of(upright_peg(30, 1), "part", V::front), 2u) << "a tube";
  EXPECT_EQ(faces_of(upright_peg(30, 1), "washer", V::front), 1u);
  // An object without a cylinder has no axis.
  for (const V direction : {V::front, V::top}) {
    Mesh nut = block({30, 20, 15}).meshes[0];
    EXPECT_EQ(faces_of(std::move(nut), "nut", direction), 1u);
  }
}

TEST(UncutObjects, AreCutIfThePlaneMeetsNothingElse) {
  Scene scene = scene_of(upright_peg(30, 0));
  scene.instances[0].name = "shaft";
  scene.up = Axis::z;
  EXPECT_EQ(draw_sheet(Surfaces(scene), {.sections = {{V::front}}}).views.at(0).section->faces.size(), 1u);
}

TEST_F(SheetOfBlock, TheStepsAreTold) {
  std::vector<std::string> told;
  Watch watch;
  watch.progress = [&](std::string_view stage, double) {
    if (told.empty() || told.back() != stage) told.emplace_back(stage);
  };
  (void)draw_sheet(surfaces_, {.views = {V::front}}, {1, Isa::best, &watch});
  EXPECT_THAT(told, testing::IsSupersetOf({"views", "rounds", "layout", "tones", "page"}));
}

TEST_F(SheetOfBlock, WhatCannotBeMeantIsRefusedByTheNameOfItsField) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const Paper fitting{.fits_drawing = true};
  const std::pair<SheetOptions, const char*> refused[] = {
      {{}, "views: "},
      {{.views = {V::front, V::front}}, "views: 'front' is there twice"},
      {{.views = {V::iso, V::three_quarter}}, "views: 'iso' and 'three-quarter' have one place"},
      {{.sections = {{V::iso}}}, "sections: 'iso'"},
      {{.sections = {{V::left, nan}}}, "sections: "},
      {{.sections = {{V::left, 3.0}, {V::left, 3.0}}}, "sections: 'left' is there twice"},
      {{.sections = std::vector<SectionView>(25)}, "sections: 24"},
      {{.sections = {{V::left}}, .style = DrawingStyle::figure}, "sections: figures"},
      {{.sections = {{V::left}}, .stipple = 1}, "sections: hatching"},
      {{.sections = {{V::left, 50.0}}}, "sections left=50: the plane misses the model, which lies from x = 0 to 40"},
      {{.sections = {{V::left}}, .dimensions = Dimensioning::diameters}, "dimensions: "},
      {{.views = {V::front}, .hidden_views = std::vector{V::front}}, "hidden_views: needs"},
      {{.views = {V::front}, .hidden = HiddenLines::thin, .hidden_views = std::vector{V::top}}, "hidden_views: top"},
      {{.views = {V::front}, .pen = 0}, "pen: must be from 0.01 to 10"},
      {{.views = {V::front}, .crease_angle = 4}, "crease_angle: "},
      {{.views = {V::front}, .shortest_stroke = -1}, "shortest_stroke: "},
      {{.views = {V::front}, .page = Paper{{0, 9}}}, "page: "},
      {{.views = {V::front}, .page = fitting}, "page: a page fitted to the drawing needs a scale"},
      {{.views = {V::front}, .page = fitting, .scale = 1, .title_block = TitleBlock{}}, "page: a frame"},
      {{.views = {V::front}, .page = Paper{{100, 90}}, .title_block = TitleBlock{}}, "page: 100 x 90 mm have no room"},
      {{.views = {V::front, V::top}, .page = Paper{{25, 25}}, .margin = 6},
       "page: 25 x 25 mm have no room for so many"},
      {{.views = {V::front}, .margin = nan}, "margin: "},
      {{.views = {V::front}, .margin = 150}, "margin: 150 mm at each side leave nothing of a page of 210 x 297 mm"},
      {{.views = {V::front}, .scale = 0}, "scale: must be"},
      {{.views = {V::front}, .page = Paper{}, .scale = 50},
       "scale: at 50:1 the drawing takes 2000.0 x 1000.0 mm, and the page has 277.0 x 190.0 mm between its margins; "
       "5:1 "
       "would fit"},
      {{.views = {V::front}, .scale = 1e4}, "scale: at 10000:1 the page would be 400 x 200 m"},
      {{.views = {V::front}, .millimetres_per_unit = -1}, "millimetres_per_unit: "},
      {{.views = {V::front}, .plot = true, .lettering = Lettering::text}, "lettering: plotters have no fonts"},
      {{.views = {V::front}, .hatch = 0.1}, "hatch: "},
      {{.views = {V::front}, .scale = 2000, .hatch = 0.2}, "hatch: 0.2 mm would be too many"},
      {{.views = {V::front}, .scale = 2000, .stipple = 0.2}, "stipple: 0.2 mm would be too many"},
      {{.views = {V::front}, .tessellation_error = nan}, "tessellation_error: "},
      {{.views = {V::front}, .near = 1e4}, "near: leaves nothing of the front view, in which the model lies from "},
      {{.views = {V::front}, .far = -1e4}, "far: leaves nothing of the front view, in which the model lies from "},
      {{.views = {V::front}, .near = 2, .far = 1}, "far: must be greater than near"},
  };
  for (const auto& [options, reason] : refused) {
    try {
      (void)drawn(options);
      ADD_FAILURE() << reason;
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), StartsWith(reason));
    }
  }
}

TEST_F(SheetOfBlock, AGivenViewHasNothingOfNamedOnes) {
  const View perspective = frame(surfaces_, 64, 48);
  const std::pair<SheetOptions, const char*> refused[] = {
      {{.views = {V::front}}, "views: "},
      {{.sections = {{V::front}}}, "views: "},
      {{.dimensions = Dimensioning::diameters}, "dimensions: "},
      {{.scale = 1}, "scale: a perspective view has no scale"},
      {{.standard_scale = true}, "scale: a perspective view has no scale"},
      {{.centre_lines = true}, "centre_lines: perspective"}};
  for (const auto& [options, reason] : refused) {
    try {
      (void)draw_view(surfaces_, perspective, options);
      ADD_FAILURE() << reason;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::bad_argument);
      EXPECT_THAT(error.what(), StartsWith(reason));
    }
  }
}

/// An open surface 20 deep whose top is bent twice, along lines that are `apart` from each other. They bound a slope of
/// 45 degrees. If `is_behind`, a plate lies over it.
Scene bent_twice(float apart, bool is_behind) {
  Mesh mesh;
  const glm::vec2 profile[] = {{-10, 0}, {-apart / 2, 0}, {apart / 2, apart}, {10, apart}};
  for (int i = 0; i < 3; ++i) {
    const glm::vec2 a = profile[i], b = profile[i + 1];
    add_quad(mesh, {a.x, 0, a.y}, {b.x, 0, b.y}, {b.x, 20, b.y}, {a.x, 20, a.y});
  }
  if (is_behind) add_quad(mesh, {-11, -1, 3}, {11, -1, 3}, {11, 21, 3}, {-11, 21, 3});
  Scene scene = scene_of(mesh);
  scene.up = Axis::z;
  return scene;
}

TEST(Plots, InkReachesHalfTheWidthOfEachPen) {
  const auto covered = [](float apart, bool is_behind, SheetOptions options) {
    const Scene scene = bent_twice(apart, is_behind);
    options.views = {V::top};
    options.scale = 1;
    options.plot = true;
    return draw_sheet(Surfaces(scene), options).views[0].placed.strokes.covered;
  };
  // Creases of figures are 0.18 mm wide, all visible lines of technical drawings 0.5 mm.
  const SheetOptions figure{.style = DrawingStyle::figure};
  EXPECT_EQ(covered(0.15f, false, figure), 0u);
  EXPECT_EQ(covered(0.08f, false, figure), 1u);
  EXPECT_EQ(covered(0.15f, false, {}), 1u);
  EXPECT_EQ(covered(0.3f, false, {}), 0u);
  // Thin hidden lines are 0.13 mm wide. The gaps of dashed ones are paper.
  EXPECT_EQ(covered(0.08f, true, {.hidden = HiddenLines::thin}), 0u);
  EXPECT_EQ(covered(0.05f, true, {.hidden = HiddenLines::thin}), 1u);
  EXPECT_EQ(covered(0.05f, true, {.hidden = HiddenLines::dashed}), 0u);
}

TEST(NamedPaper, HasItsSizeAndItsName) {
  EXPECT_EQ(named_paper("A3").size, glm::dvec2(297, 420));
  EXPECT_TRUE(named_paper("a3").may_turn);
  EXPECT_EQ(named_paper("a5-landscape").size, glm::dvec2(210, 148));
  EXPECT_FALSE(named_paper("letter-portrait").may_turn);
  EXPECT_EQ(paper_name({420, 297}), "A3");
  EXPECT_EQ(paper_name({215.9, 355.6}), "Legal");
  EXPECT_EQ(paper_name({420, 200.5}), "420 x 200.5");
  for (const char* const none : {"", "a9", "a4-", "-landscape", "a4-landscape-portrait", "fit"})
    EXPECT_THROW((void)named_paper(none), Error) << none;
  EXPECT_EQ(scale_text(0.2), "1:5");
  EXPECT_EQ(scale_text(2), "2:1");
  EXPECT_EQ(scale_text(1 / 3.2), "1:3.2");
  EXPECT_EQ(standard_scale(4.9), 2);
  EXPECT_EQ(standard_scale(0.2), 0.2);
  EXPECT_EQ(standard_scale(1e-20), 1e-20);
}

}  // namespace
}  // namespace frontmost::test
