// SPDX-License-Identifier: Apache-2.0
// Strokes: known counts, every line once, arcs for round shapes, and short pen travel.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "frontmost/lines.h"
#include "support/effort.h"
#include "support/meshes.h"
#include "support/seeds.h"

namespace frontmost::test {
namespace {

using std::numbers::pi;

View parallel_view(const glm::dvec3& eye) {
  View view;
  view.width = view.height = 400;
  const bool is_steep = std::abs(eye.y) > 0.9 * glm::length(eye);
  view.world_from_eye = look_at(eye, glm::dvec3(0), is_steep ? glm::dvec3(0, 0, 1) : glm::dvec3(0, 1, 0));
  view.projection = make_orthographic(-2, 2, -2, 2, {0.5, 50});
  return view;
}

/// The prism over a polygon from z = -1 to z = 1, with flat end faces as fans around the axis.
Mesh prism(const std::vector<glm::dvec2>& polygon) {
  Mesh mesh;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::vec2 a(polygon[i]), b(polygon[(i + 1) % polygon.size()]);
    add_quad(mesh, {a, -1}, {b, -1}, {b, 1}, {a, 1});
    add_triangle(mesh, {0, 0, 1}, {a, 1}, {b, 1});
    add_triangle(mesh, {0, 0, -1}, {b, -1}, {a, -1});
  }
  return mesh;
}

std::vector<glm::dvec2> regular(int corners, double radius = 1) {
  std::vector<glm::dvec2> polygon;
  for (int i = 0; i < corners; ++i)
    polygon.push_back(radius * glm::dvec2(std::cos(2 * pi * i / corners), std::sin(2 * pi * i / corners)));
  return polygon;
}

const std::vector<glm::dvec2> square = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};

Strokes strokes_of(const Mesh& mesh, const View& view, const StrokeOptions& options = {}, double crease = 0.5) {
  const Scene scene = scene_of(mesh);
  const Surfaces surfaces(scene);
  return chain_strokes(surfaces, draw_lines(surfaces, view, {.crease_angle = crease}), options);
}

double length_of(const Strokes& all, const Stroke& stroke) {
  double length = 0;
  for (std::uint32_t i = 0; i + (stroke.is_closed ? 0 : 1) < stroke.count; ++i)
    length += glm::distance(all.points[stroke.first + i], all.points[stroke.first + (i + 1) % stroke.count]);
  return length;
}

double length_of(const Strokes& all, bool hidden) {
  double length = 0;
  for (const Stroke& stroke : all.strokes) length += stroke.is_hidden == hidden ? length_of(all, stroke) : 0;
  return length;
}

TEST(StrokesOfACube, FromACorner) {
  const Strokes all = strokes_of(prism(square), parallel_view({4, 5, 6}));
  // Three hidden edges that meet, the outline, and three visible edges that meet.
  ASSERT_EQ(all.strokes.size(), 7u);
  std::size_t closed = 0;
  for (std::size_t i = 0; i < all.strokes.size(); ++i) {
    const Stroke& stroke = all.strokes[i];
    EXPECT_EQ(stroke.is_hidden, i < 3);
    EXPECT_EQ(stroke.kind == EdgeKind::silhouette, stroke.is_closed);
    EXPECT_EQ(stroke.count, stroke.is_closed ? 6u : 2u);
    EXPECT_EQ(stroke.instance, 0u);
    closed += stroke.is_closed;
  }
  EXPECT_EQ(closed, 1u);
  EXPECT_TRUE(all.bulges.empty());
  EXPECT_EQ(strokes_of(prism(square), parallel_view({4, 5, 6}), {.with_hidden = false}).strokes.size(), 4u);
  // If kinds may join, every vertex of the cube is a junction except the hidden one and three of the outline.
  EXPECT_EQ(strokes_of(prism(square), parallel_view({4, 5, 6}), {.by_kind = false, .by_outline = false}).strokes.size(),
            9u);
}

TEST(StrokesOfACube, FromTheFrontEveryLineOnce) {
  const Strokes all = strokes_of(prism(square), parallel_view({0, 0, 10}), {.by_kind = false, .by_outline = false});
  // The cube's four back edges lie behind the front ones, and four edges are seen as points.
  ASSERT_EQ(all.strokes.size(), 1u);
  EXPECT_FALSE(all.strokes[0].is_hidden);
  EXPECT_TRUE(all.strokes[0].is_closed);
  EXPECT_EQ(all.strokes[0].count, 4u);
  EXPECT_NEAR(length_of(all, false), 800, 1e-9);
}

TEST(StrokesOnce, WhatIsThereTwiceIsDrawnOnce) {
  const View view = parallel_view({3, 4, 9});
  const Mesh mesh = prism(regular(5));
  Mesh twice = mesh;  // all edges now have more than two triangles, and one of each set is drawn
  for (const glm::uvec3& t : mesh.triangles)
    add_triangle(twice, mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]);
  const StrokeOptions any_kind{.by_kind = false, .by_outline = false};
  const Strokes a = strokes_of(mesh, view, any_kind), b = strokes_of(twice, view, any_kind);
  EXPECT_EQ(a.strokes.size(), b.strokes.size());
  EXPECT_NEAR(length_of(a, false), length_of(b, false), 0.1);
  EXPECT_NEAR(length_of(a, true), length_of(b, true), 0.1);
}

TEST(StrokesOnce, AHiddenEdgeBehindASeenOneKeepsWhatSticksOut) {
  // A plate in front of a wider one of the same height: only the protruding parts of the back edges are drawn.
  Mesh mesh;
  add_quad(mesh, {-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1});
  add_quad(mesh, {-1.5, -1, 0}, {1.5, -1, 0}, {1.5, 1, 0}, {-1.5, 1, 0});
  const Strokes all = strokes_of(mesh, parallel_view({0, 0, 10}), {.by_kind = false, .by_outline = false});
  EXPECT_NEAR(length_of(all, false), 800 + 2 * 200 + 4 * 50, 1e-6);
  EXPECT_NEAR(length_of(all, true), 0, 1e-6);
}

TEST(StrokesOnce, TotalLengthIsThatOfTheParts) {
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    const Scene scene = scene_of(random_mesh(Kind::soup, 60, seed));
    const Surfaces surfaces(scene);
    View view = frame(surfaces, 500, 400);
    const Drawing drawing = draw_lines(surfaces, view);
    double seen = 0, hidden = 0, shorter = 0;
    for (const DrawnPart& part : drawing.parts) {
      const double length = glm::distance(part.from, part.to);
      (part.hidden_by ? hidden : seen) += length;
      if (length < 0.01) shorter += length;
    }
    const Strokes all = chain_strokes(surfaces, drawing);
    // Drawing each line once may shorten the total, never lengthen it. Random soups have a few coinciding edges.
    EXPECT_LE(length_of(all, false), seen * 1.0001 + 0.1);
    EXPECT_GE(length_of(all, false), (seen - shorter) * 0.9 - 1) << seed;
    EXPECT_LE(length_of(all, true), hidden * 1.0001 + 0.1);
  }
}

TEST(StrokesArcs, ADiscIsACircleAndAHexagonStaysOne) {
  const StrokeOptions options{.by_kind = false, .by_outline = false, .arc_tolerance = 0.05};
  const Strokes disc = strokes_of(prism(regular(64)), parallel_view({0, 0, 10}), options);
  ASSERT_EQ(disc.strokes.size(), 1u);
  EXPECT_TRUE(disc.strokes[0].is_closed);
  ASSERT_EQ(disc.strokes[0].count, 2u);
  EXPECT_EQ(std::abs(disc.bulges[0]), 1);
  EXPECT_EQ(disc.bulges[0], disc.bulges[1]);
  EXPECT_NEAR(glm::distance(disc.points[0], disc.points[1]), 200, 0.001);
  for (const int sides : {6, 12, 16}) {
    const Strokes polygon = strokes_of(prism(regular(sides)), parallel_view({0, 0, 10}), options);
    ASSERT_EQ(polygon.strokes.size(), 1u) << sides;
    EXPECT_EQ(polygon.strokes[0].count, std::uint32_t(sides));
    for (const double bulge : polygon.bulges) EXPECT_EQ(bulge, 0);
  }
}

TEST(StrokesArcs, ARoundedPlateHasFourArcsAndFourLines) {
  std::vector<glm::dvec2> outline;
  for (int corner = 0; corner < 4; ++corner)
    for (int i = 0; i <= 12; ++i) {
      const double angle = pi / 2 * (corner + i / 12.0);
      const glm::dvec2 centre((corner == 0 || corner == 3 ? 1 : -1) * 0.7, (corner < 2 ? 1 : -1) * 0.5);
      outline.push_back(centre + 0.3 * glm::dvec2(std::cos(angle), std::sin(angle)));
    }
  const Strokes all = strokes_of(prism(outline), parallel_view({0, 0, 10}),
                                 {.by_kind = false, .by_outline = false, .arc_tolerance = 0.05});
  ASSERT_EQ(all.strokes.size(), 1u);
  ASSERT_EQ(all.strokes[0].count, 8u);
  std::size_t arcs = 0;
  for (const double bulge : all.bulges) {
    if (bulge == 0) continue;
    ++arcs;
    EXPECT_NEAR(std::abs(bulge), std::tan(pi / 8), 1e-4);
  }
  EXPECT_EQ(arcs, 4u);
}

TEST(StrokesArcs, HalvesOfLongArcsLieOnTheCircle) {
  // The outline is a disc without a slice: 300 degrees.
  std::vector<glm::dvec2> outline = {{0, 0}};
  for (int i = 0; i <= 60; ++i) outline.push_back(glm::dvec2(std::cos(i * pi / 36), std::sin(i * pi / 36)));
  const Strokes all = strokes_of(prism(outline), parallel_view({0, 0, 10}),
                                 {.by_kind = false, .by_outline = false, .arc_tolerance = 0.05});
  ASSERT_EQ(all.strokes.size(), 1u);
  ASSERT_EQ(all.strokes[0].count, 4u);
  for (const glm::dvec2& p : all.points) {
    const double radius = glm::distance(p, {200, 200});
    EXPECT_TRUE(radius < 1e-6 || std::abs(radius - 100) < 0.001) << radius;
  }
}

TEST(StrokesOrder, TheNextOneIsAlwaysTheNearest) {
  Mesh mesh;
  Random random(5);
  for (int i = 0; i < 300; ++i) {
    const glm::vec3 at(random.within(-1.9f, 1.9f), random.within(-1.9f, 1.9f), random.within(-1, 1));
    add_triangle(mesh, at, at + glm::vec3(0.02f, 0, 0), at + glm::vec3(0, 0.03f, 0));
  }
  const View view = parallel_view({0, 0, 10});
  const Strokes plain = strokes_of(mesh, view, {.with_hidden = false}),
                all = strokes_of(mesh, view, {.with_hidden = false, .nearest_first = true});
  EXPECT_NEAR(length_of(all, false), length_of(plain, false), 1e-6);
  ASSERT_GT(all.strokes.size(), 250u);
  const auto begin = [&](const Stroke& s) { return all.points[s.first]; };
  const auto end = [&](const Stroke& s) { return all.points[s.is_closed ? s.first : s.first + s.count - 1]; };
  for (std::size_t i = 0; i + 1 < all.strokes.size(); ++i) {
    const double travel = glm::distance(end(all.strokes[i]), begin(all.strokes[i + 1]));
    for (std::size_t j = i + 2; j < all.strokes.size(); ++j)
      EXPECT_GE(std::min(glm::distance(end(all.strokes[i]), begin(all.strokes[j])),
                         glm::distance(end(all.strokes[i]), end(all.strokes[j]))),
                travel - 1e-9);
  }
}

TEST(StrokesOrder, OfEndsAsNearTheFirst) {
  // Spokes from one point: all ends there are equally near.
  Drawing drawing;
  constexpr int count = 100;
  for (int i = 0; i < count; ++i) {
    const double turn = 2 * pi * i / count;
    drawing.edges.push_back({});
    drawing.parts.push_back(
        {std::uint32_t(i), 0, 1, {200, 200}, {200 + 50 * std::cos(turn), 200 + 50 * std::sin(turn)}});
  }
  const Scene scene = scene_of(prism(square));
  const Surfaces surfaces(scene);
  const Strokes all = chain_strokes(surfaces, drawing, {.by_instance = false, .nearest_first = true});
  // Each stroke comes in along one spoke, and leaves along the lowest that is left: spokes 0 and 1, 2 and 3, and so on.
  // The first stroke begins at spoke 62, which ends nearest to the picture's corner.
  EXPECT_EQ(all.strokes.size(), std::size_t(count / 2));
  double length = 0;
  for (const Stroke& stroke : all.strokes) length += length_of(all, stroke);
  EXPECT_NEAR(length, 50 * count, 0.3 * count);
  EXPECT_EQ(all.points[1], glm::dvec2(200, 200));
  EXPECT_EQ(all.points[0], drawing.parts[62].to);
  EXPECT_EQ(all.points[2], drawing.parts[63].to);
}

/// Short lines within a three-hundredth of the picture, and one on its other side. The tests of LaidLines count the
/// comparisons in such crowds, and in those of long lines below.
Drawing far_crowd(int count) {
  Drawing drawing;
  Random random(4);
  for (int i = 0; i <= count; ++i) {
    const double x = i == 0 ? 3000 : random.within(0, 10), y = i == 0 ? 3000 : random.within(0, 10);
    const double angle = random.within(0, 6);
    drawing.edges.push_back({});
    drawing.parts.push_back({std::uint32_t(i), 0, 1, {x, y}, {x + 0.1 * std::cos(angle), y + 0.1 * std::sin(angle)}});
  }
  return drawing;
}

TEST(StrokesOnce, ACrowdFarFromTheRestIsNoMatter) {
  const Scene scene = scene_of(prism(square));
  const Surfaces surfaces(scene);
  const Drawing drawing = far_crowd(tries_little ? 4000 : 20000);
  const Strokes all = chain_strokes(surfaces, drawing, {.by_instance = false, .nearest_first = true});
  double length = 0;
  for (const Stroke& stroke : all.strokes) length += length_of(all, stroke);
  EXPECT_NEAR(length, 0.1 * double(drawing.parts.size()), 0.05 * 0.1 * double(drawing.parts.size()));
}

TEST(StrokesOnce, NorIsItWhereMoreCountsAsOneLine) {
  const Scene scene = scene_of(prism(square));
  const Surfaces surfaces(scene);
  const Drawing drawing = far_crowd(tries_little ? 4000 : 20000);
  for (const double apart : {0.09, 0.12, 1.0}) {
    // All lines are 0.1 long. If `apart` is greater, each is just a point unless it meets another line, as many of
    // 20000 do.
    const bool is_empty = chain_strokes(surfaces, drawing, {.by_instance = false, .apart = apart}).strokes.empty();
    EXPECT_EQ(is_empty, apart == 1.0 || (tries_little && apart > 0.1));
  }
}

TEST(StrokesOnce, NorAreLongLinesSideBySide) {
  const Scene scene = scene_of(prism(square));
  const Surfaces surfaces(scene);
  Drawing drawing;
  constexpr int count = 3000;
  for (int i = 0; i < count; ++i) {
    const double y = 2000.0 * i / count;
    drawing.edges.push_back({});
    drawing.parts.push_back({std::uint32_t(i), 0, 1, {0, y}, {3000, y + 300}});
  }
  EXPECT_EQ(chain_strokes(surfaces, drawing, {.by_instance = false}).strokes.size(), std::size_t(count));
}

/// Pieces of straight lines, by the line they lie on.
struct PiecesOfLines {
  Drawing drawing;
  double length = 0;  ///< total length that the pieces cover
};

PiecesOfLines pieces_of_lines(int line_count, int piece_count, std::uint64_t seed) {
  std::mt19937_64 random(test::noted_seed(seed));
  const auto up_to = [&](double most) { return most * double(random() >> 11) / double(1ull << 53); };
  const auto near = [&](const glm::dvec2& place, double most) {
    const double x = up_to(most);
    return place + glm::dvec2(x, up_to(most));
  };
  PiecesOfLines result;
  for (int line = 0; line < line_count; ++line) {
    // Some lines are level, upright, and exactly or nearly diagonal.
    const double angle = line % 3 == 0 ? line / 3 * pi / 4 : line % 3 == 1 ? pi / 4 + up_to(0.1) - 0.05 : up_to(2 * pi);
    const glm::dvec2 along(std::cos(angle), std::sin(angle)), middle = near(glm::dvec2(1000), 300);
    std::vector<std::pair<double, double>> covered;
    for (int i = 0; i < piece_count; ++i) {
      const double length = std::pow(10, up_to(3.5) - 0.5), begin = up_to(1800 - length) - 900;
      covered.emplace_back(begin, begin + length);
      const auto place = [&](double at) { return near(middle + along * at, 4e-4); };
      glm::dvec2 ends[2] = {place(begin), place(begin + length)};
      if (random() % 2 == 0) std::swap(ends[0], ends[1]);
      result.drawing.parts.push_back({std::uint32_t(result.drawing.edges.size()), 0, 1, ends[0], ends[1]});
      result.drawing.edges.push_back({});
    }
    std::sort(covered.begin(), covered.end());
    double end = -1e9;
    for (const auto& [from, to] : covered) {
      result.length += std::max(0.0, to - std::max(from, end));
      end = std::max(end, to);
    }
  }
  return result;
}

TEST(StrokesOnce, PiecesOfOneLineCoverItOnceHoweverLongTheyAre) {
  const Scene scene = scene_of(prism(square));
  const Surfaces surfaces(scene);
  for (std::uint64_t seed = 0; seed < seeds(20); ++seed) {
    PiecesOfLines pieces = pieces_of_lines(30, 40, seed);
    std::shuffle(pieces.drawing.parts.begin(), pieces.drawing.parts.end(), std::mt19937_64(seed));
    const Strokes all = chain_strokes(surfaces, pieces.drawing, {.by_instance = false});
    // A piece may extend under another by up to the width of a point.
    EXPECT_NEAR(length_of(all, false), pieces.length, 0.01 * double(all.strokes.size())) << seed;
    EXPECT_LT(all.strokes.size(), 30u * 40u / 2) << seed;
  }
}

TEST(StrokesOnce, LongLinesThatCrossAreNoQuadraticMatter) {
  const Scene scene = scene_of(prism(square));
  const Surfaces surfaces(scene);
  const std::size_t count = tries_little ? 4000 : 40000;
  for (const bool is_star : {false, true}) {
    const PiecesOfLines source = pieces_of_lines(int(count), 1, 7);
    Drawing drawing = source.drawing;
    for (std::size_t i = 0; i < count; ++i) {
      DrawnPart& part = drawing.parts[i];
      const double angle = 2 * pi * double(i) / double(count);
      if (is_star) part.from = {1000, 1000};
      part.to = part.from + 800.0 * glm::dvec2(std::cos(angle), std::sin(angle));
    }
    EXPECT_EQ(chain_strokes(surfaces, drawing, {.by_instance = false}).strokes.size(), count);
  }
}

TEST(StrokesOnce, CopiesInACrowdAreDrawnOnce) {
  const Scene scene = scene_of(prism(square));
  const Surfaces surfaces(scene);
  Drawing drawing = far_crowd(3000);
  const StrokeOptions options{.by_instance = false};
  const Strokes once = chain_strokes(surfaces, drawing, options);
  const std::vector<DrawnPart> parts = drawing.parts;
  drawing.parts.insert(drawing.parts.end(), parts.rbegin(), parts.rend());
  EXPECT_EQ(chain_strokes(surfaces, drawing, options).points, once.points);
}

/// A drawing of these lines, all visible.
Drawing drawing_of(const std::vector<std::array<glm::dvec2, 2>>& parts) {
  Drawing drawing;
  for (const auto& [from, to] : parts) {
    drawing.parts.push_back({std::uint32_t(drawing.edges.size()), 0, 1, from, to});
    drawing.edges.push_back({});
  }
  return drawing;
}

TEST(StrokesOnce, LinesBesideEachOtherAreOneWhereTheyAreAskedToBe) {
  const Scene scene = scene_of(prism(square));
  const Surfaces surfaces(scene);
  const Drawing drawing = drawing_of({{{{100, 100}, {200, 100}}},
                                      {{{150, 100.09}, {250, 100.09}}},  // half of it protrudes
                                      {{{120, 100.03}, {130, 99.97}}},   // crosses the line
                                      {{{110, 100}, {115, 100.5}}}});    // leaves the line
  StrokeOptions options{.by_instance = false};
  EXPECT_NEAR(length_of(chain_strokes(surfaces, drawing, options), false), 100 + 100 + 10 + 5.02, 0.01);
  options.apart = 0.1;
  EXPECT_NEAR(length_of(chain_strokes(surfaces, drawing, options), false), 100 + 50 + 5.02, 0.01);
  options.apart = 0.07;
  EXPECT_NEAR(length_of(chain_strokes(surfaces, drawing, options), false), 100 + 100 + 5.02, 0.01);
}

TEST(StrokesOnce, TinyPiecesAreNoLinesButLinesOfThemAre) {
  const Scene scene = scene_of(prism(square));
  const Surfaces surfaces(scene);
  std::vector<std::array<glm::dvec2, 2>> parts = {{{{210, 300}, {210.05, 300}}}};
  for (int i = 0; i < 10; ++i) parts.push_back({{{210 + 0.05 * i, 320}, {210 + 0.05 * (i + 1), 320}}});
  // A loop back to its start is not a point either, although its ends meet.
  parts.push_back({{{250, 250}, {251, 250}}});
  parts.push_back({{{251, 250}, {251, 251}}});
  parts.push_back({{{251, 251}, {250, 250}}});
  const Drawing drawing = drawing_of(parts);
  EXPECT_EQ(chain_strokes(surfaces, drawing, {.apart = 0.04}).strokes.size(), 3u);
  const Strokes few = chain_strokes(surfaces, drawing, {.apart = 0.06});
  ASSERT_EQ(few.strokes.size(), 2u);
  EXPECT_NEAR(length_of(few, few.strokes[0]), 0.5, 1e-9);
  EXPECT_NEAR(length_of(few, few.strokes[1]), 2 + std::sqrt(2.0), 1e-9);
}

/// Two tubes along z, with nearly equal radii.
Mesh bolt_in_bore() {
  Mesh mesh = prism(regular(24)), bore = prism(regular(31));
  for (glm::vec3& p : mesh.positions) p.z *= 1.5f;
  const auto first = std::uint32_t(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), bore.positions.begin(), bore.positions.end());
  for (const glm::uvec3& t : bore.triangles) mesh.triangles.push_back(t + first);
  return mesh;
}

double intersection_length(const Strokes& all, bool hidden) {
  double length = 0;
  for (const Stroke& stroke : all.strokes)
    if (stroke.kind == EdgeKind::intersection && stroke.is_hidden == hidden) length += length_of(all, stroke);
  return length;
}

TEST(Strokes, HiddenIntersectionsAreLeftOutWhereSurfacesGraze) {
  const View view = parallel_view({4, 5, 6});
  const Strokes all = strokes_of(bolt_in_bore(), view), few = strokes_of(bolt_in_bore(), view, {.grazing_angle = 0.5});
  EXPECT_GT(intersection_length(all, true), 1000);
  // Visible intersections stay, and so does the one where the bolt leaves the bore at a right angle.
  EXPECT_NEAR(intersection_length(few, false), intersection_length(all, false), 1e-9);
  EXPECT_LT(intersection_length(few, true), intersection_length(all, true) / 4);
  EXPECT_THROW((void)strokes_of(bolt_in_bore(), view, {.grazing_angle = 1.6}), Error);
}

TEST(StrokesOrder, StopsWhenAsked) {
  const Scene scene = scene_of(prism(square));
  const Surfaces surfaces(scene);
  const Drawing drawing = far_crowd(5000);
  bool is_ordering = false;
  Watch watch;
  watch.progress = [&](std::string_view, double fraction) { is_ordering = fraction >= 0.8; };
  watch.cancelled = [&] { return is_ordering; };
  try {
    (void)chain_strokes(surfaces, drawing, {.by_instance = false, .nearest_first = true}, {.watch = &watch});
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::cancelled);
  }
}

TEST(StrokesOrder, APenGoesOnWhereStrokesTouch) {
  // Nine visible edges of a cube with about eight odd vertices: fewer pen lifts than chains.
  const StrokeOptions plain{.with_hidden = false, .by_kind = false, .by_outline = false};
  StrokeOptions plot = plain;
  plot.nearest_first = true;
  const View view = parallel_view({4, 5, 6});
  const Strokes a = strokes_of(prism(square), view, plain), b = strokes_of(prism(square), view, plot);
  EXPECT_EQ(a.strokes.size(), 6u);
  EXPECT_LE(b.strokes.size(), 3u);
  EXPECT_NEAR(length_of(a, false), length_of(b, false), 1e-9);
}

TEST(StrokesOrder, ArcsSurviveTurningRound) {
  std::vector<glm::dvec2> outline;
  for (int i = 0; i <= 30; ++i) outline.push_back(glm::dvec2(std::cos(i * pi / 30), std::sin(i * pi / 30)));
  Mesh mesh;  // half rings, bent up, from right to left: the pen comes from the left
  for (std::size_t i = 0; i + 1 < outline.size(); ++i) {
    const glm::vec2 a(outline[i]), b(outline[i + 1]);
    add_quad(mesh, {a, 0}, {b, 0}, {b * 0.5f, 0}, {a * 0.5f, 0});
  }
  const StrokeOptions options{.arc_tolerance = 0.05, .nearest_first = true};
  const Strokes all = strokes_of(mesh, parallel_view({0, 0, 10}), options);
  ASSERT_EQ(all.strokes.size(), 1u);
  double around = 0;
  for (std::size_t i = 0; i < all.points.size(); ++i) around += std::abs(4 * std::atan(all.bulges[i]));
  EXPECT_NEAR(around, 2 * pi, 0.01);
}

TEST(Strokes, AreTheSameForAnyNumberOfThreads) {
  const Scene scene = scene_of(random_mesh(Kind::shared_grid, 400, 3));
  const Surfaces surfaces(scene);
  const Drawing drawing = draw_lines(surfaces, frame(surfaces, 500, 400));
  const StrokeOptions options{.arc_tolerance = 0.2, .nearest_first = true};
  const Strokes one = chain_strokes(surfaces, drawing, options, {.threads = 1}),
                many = chain_strokes(surfaces, drawing, options, {.threads = 5});
  EXPECT_EQ(one.points, many.points);
  EXPECT_EQ(one.bulges, many.bulges);
  EXPECT_EQ(one.strokes.size(), many.strokes.size());
}

TEST(Strokes, NothingAndNonsense) {
  const Scene empty;
  const Surfaces surfaces(empty);
  EXPECT_TRUE(chain_strokes(surfaces, draw_lines(surfaces, parallel_view({0, 0, 5}))).strokes.empty());
  for (const double bad : {0.0, 2.0, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_THROW((void)chain_strokes(surfaces, {}, {.tolerance = bad}), Error);
  for (const double bad : {0.001, 1.1, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_THROW((void)chain_strokes(surfaces, {}, {.apart = bad}), Error);
  for (const double bad : {-1.0, 101.0, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_THROW((void)chain_strokes(surfaces, {}, {.arc_tolerance = bad}), Error);
}

TEST(Strokes, NeedNoMemoryForADrawingOfNextToNothing) {
  // A flat sliver seen along its length is a point, for which a grid must not get ten million cells a side.
  for (const float width : {0.f, 1e-7f, 1e-5f, 1e-3f}) {
    Mesh sliver;
    add_triangle(sliver, {0, 0, -1}, {width, 0, 0}, {0, 0, 1});
    EXPECT_LE(strokes_of(sliver, parallel_view({0, 0, 5})).strokes.size(), 1u) << width;
    add_triangle(sliver, {0, 0, -1}, {0, 0, 0}, {0, width, 1});
    EXPECT_LE(strokes_of(sliver, parallel_view({0, 0, 5})).strokes.size(), 2u) << width;
  }
}

}  // namespace
}  // namespace frontmost::test
