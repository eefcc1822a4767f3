// SPDX-License-Identifier: Apache-2.0
// Pictures of single rules: order, outlines, stipples, normals, the alpha test, primitives longer than a batch.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <climits>
#include <cmath>
#include <tuple>
#include <utility>
#include <vector>

#include "frontmost/gl.h"
#include "gl/off_screen.h"

namespace frontmost::test {
namespace {

using Rgba = std::array<int, 4>;

Rgba color_at(int x, int y) {
  const std::vector<GLubyte> c = read_colors(x, y, 1, 1);
  return {c[0], c[1], c[2], c[3]};
}
const Rgba kRed{255, 0, 0, 255}, kGreen{0, 255, 0, 255}, kBlack{0, 0, 0, 0};

/// A context whose coordinates are pixels.
struct PixelScreen : OffScreen {
  explicit PixelScreen(int size) : OffScreen(size, size) {
    glMatrixMode(GL_PROJECTION);
    glOrtho(0, size, 0, size, -1, 1);
    glMatrixMode(GL_MODELVIEW);
    glClear(GL_COLOR_BUFFER_BIT);
  }
};

TEST(Polygons, OutlinesAndFilledOnesKeepTheirOrder) {
  const PixelScreen screen(20);
  glPolygonMode(GL_BACK, GL_LINE);
  glBegin(GL_TRIANGLES);
  glColor3f(1, 0, 0);  // clockwise: an outline, whose lower edge is in row 4
  glVertex2d(2, 4.5), glVertex2d(10, 18), glVertex2d(18, 4.5);
  glColor3f(0, 1, 0);
  glVertex2d(0, 0), glVertex2d(20, 0), glVertex2d(10, 19.5);
  glEnd();
  EXPECT_EQ(color_at(10, 4), kGreen);
  glBegin(GL_TRIANGLES);
  glColor3f(1, 0, 0);
  glVertex2d(2, 4.5), glVertex2d(10, 18), glVertex2d(18, 4.5);
  glEnd();
  EXPECT_EQ(color_at(10, 4), kRed);
}

TEST(Polygons, OutlinesHaveAllEdgesAlsoWhereCornersAreInALine) {
  const PixelScreen screen(20);
  glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
  glColor3f(1, 0, 0);
  glBegin(GL_POLYGON);
  glVertex2d(2.5, 2.5), glVertex2d(8.5, 2.5), glVertex2d(15.5, 2.5), glVertex2d(15.5, 15.5), glVertex2d(2.5, 15.5);
  glEnd();
  for (int x = 3; x < 15; ++x) EXPECT_EQ(color_at(x, 2), kRed) << x;
}

TEST(Lines, StipplesGoOnAlongSegmentsShorterThanAPixel) {
  const PixelScreen screen(100);
  glEnable(GL_LINE_STIPPLE);
  glLineStipple(1, 0x00FF);
  glColor3f(1, 0, 0);
  glBegin(GL_LINE_STRIP);
  for (int i = 0; i <= 300; ++i) glVertex2d(i * 0.3, 10.5);
  glEnd();
  for (int x = 0; x < 88; ++x) EXPECT_EQ(color_at(x, 10), x % 16 < 8 ? kRed : kBlack) << x;
}

TEST(Lines, AStripBeginsItsStippleAnewAlsoIfItsFirstSegmentIsClipped) {
  const PixelScreen screen(100);
  glEnable(GL_LINE_STIPPLE);
  glLineStipple(1, 0x00FF);
  glColor3f(1, 0, 0);
  glBegin(GL_LINE_STRIP);
  glVertex2d(0, 5.5), glVertex2d(53, 5.5);
  glEnd();
  glBegin(GL_LINE_STRIP);
  glVertex3d(0, 10.5, 5), glVertex3d(20, 10.5, 5), glVertex3d(20, 10.5, 0), glVertex3d(90, 10.5, 0);
  glEnd();
  EXPECT_EQ(color_at(21, 10), kRed);
  EXPECT_EQ(color_at(30, 10), kBlack);
}

// Around a square of 24 pixels a side, whose edges are lower, right, upper and left.
TEST(Lines, AStippleGoesOnAroundAnOutline) {
  constexpr double from = 4.5, to = 28.5;
  constexpr double corners[4][2] = {{from, from}, {to, from}, {to, to}, {from, to}};
  // The edge that is drawn first, and the corners in the order of vertices.
  const std::tuple<GLenum, int, std::array<int, 4>> cases[] = {
      {GL_QUADS, 3, {0, 1, 2, 3}}, {GL_POLYGON, 0, {0, 1, 2, 3}}, {GL_QUAD_STRIP, 0, {0, 1, 3, 2}}};
  for (const auto& [mode, first, order] : cases) {
    const PixelScreen screen(40);
    glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
    glEnable(GL_LINE_STIPPLE);
    glLineStipple(1, 0x00FF);
    glColor3f(1, 0, 0);
    glBegin(mode);
    for (const int corner : order) glVertex2dv(corners[corner]);
    glEnd();
    for (int i = 1; i < 24; ++i) {
      const std::pair<int, int> places[4] = {{4 + i, 4}, {28, 4 + i}, {28 - i, 28}, {4, 28 - i}};
      for (int edge = 0; edge < 4; ++edge) {
        const int pixels = (edge - first + 4) % 4 * 24 + i;
        EXPECT_EQ(color_at(places[edge].first, places[edge].second), pixels % 16 < 8 ? kRed : kBlack)
            << mode << ", edge " << edge << ", " << i;
      }
    }
  }
}

// A normal is divided by the length of the third row of the inverse matrix.
TEST(Light, RescaledNormalsFollowTheSpecification) {
  const PixelScreen screen(8);
  glEnable(GL_LIGHTING);
  glEnable(GL_LIGHT0);
  glEnable(GL_RESCALE_NORMAL);
  const GLfloat ambient[4] = {0, 0, 0, 1}, towards[4] = {0, 0, 1, 0}, quarter[4] = {0.25f, 0.25f, 0.25f, 1};
  glLightModelfv(GL_LIGHT_MODEL_AMBIENT, ambient);
  glLightfv(GL_LIGHT0, GL_POSITION, towards);
  glMaterialfv(GL_FRONT, GL_DIFFUSE, quarter);
  glMatrixMode(GL_PROJECTION);
  glLoadIdentity();
  glMatrixMode(GL_MODELVIEW);
  glRotatef(90, 1, 0, 0);
  glScalef(1, 1, 2);
  glBegin(GL_QUADS);
  glNormal3f(0, 1, 0);  // (0, 0, 1) of the eye; the third row has the length 1/2, so the normal becomes (0, 0, 2)
  glVertex3f(-1, 0, -1), glVertex3f(1, 0, -1), glVertex3f(1, 0, 1), glVertex3f(-1, 0, 1);
  glEnd();
  EXPECT_NEAR(color_at(4, 4)[0], 128, 1);
}

TEST(Textures, OfOneDimensionHaveNoBorderAcross) {
  const GLubyte texels[4] = {255, 255, 255, 255};
  for (const GLenum wrap : {GL_REPEAT, GL_CLAMP, GL_CLAMP_TO_BORDER, GL_CLAMP_TO_EDGE, GL_MIRRORED_REPEAT})
    for (const GLenum along : {GL_REPEAT, GL_CLAMP_TO_EDGE}) {
      const PixelScreen screen(4);
      glTexImage1D(GL_TEXTURE_1D, 0, GL_LUMINANCE, 4, 0, GL_LUMINANCE, GL_UNSIGNED_BYTE, texels);
      glTexParameteri(GL_TEXTURE_1D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
      glTexParameteri(GL_TEXTURE_1D, GL_TEXTURE_WRAP_S, GLint(along));
      glTexParameteri(GL_TEXTURE_1D, GL_TEXTURE_WRAP_T, GLint(wrap));
      glEnable(GL_TEXTURE_1D);
      glTexCoord1f(0);
      glRecti(0, 0, 4, 4);
      EXPECT_EQ(color_at(2, 2), (Rgba{255, 255, 255, 255})) << wrap << ", " << along;
    }
}

TEST(AlphaTest, ComparesTheBitsOfTheFrame) {
  const PixelScreen screen(4);
  const GLubyte texel[4] = {255, 0, 0, 51};
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA, 1, 1, 0, GL_RGBA, GL_UNSIGNED_BYTE, texel);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexEnvi(GL_TEXTURE_ENV, GL_TEXTURE_ENV_MODE, GL_REPLACE);
  glEnable(GL_TEXTURE_2D);
  glEnable(GL_ALPHA_TEST);
  glAlphaFunc(GL_EQUAL, 0.2f);
  glRecti(0, 0, 4, 4);
  EXPECT_EQ(color_at(2, 2), (Rgba{255, 0, 0, 51}));
}

// The centre of the fan keeps its material, also where the fan goes on in another batch.
TEST(Materials, BelongToTheirVerticesInLongPrimitives) {
  const PixelScreen screen(64);
  glEnable(GL_LIGHTING);
  glShadeModel(GL_SMOOTH);
  const GLfloat red[4] = {1, 0, 0, 1}, green[4] = {0, 1, 0, 1};
  glMaterialfv(GL_FRONT, GL_EMISSION, red);
  glBegin(GL_TRIANGLE_FAN);
  glVertex2d(32, 32);
  glMaterialfv(GL_FRONT, GL_EMISSION, green);
  for (int i = 0; i <= 6000; ++i)
    glVertex2d(32 + 30 * std::cos(i * 6.2831853 / 6000), 32 + 30 * std::sin(i * 6.2831853 / 6000));
  glEnd();
  for (const auto& [x, y] : {std::pair(36, 32), {32, 36}, {27, 32}, {32, 27}})
    EXPECT_GT(color_at(x, y)[0], 190) << x << ", " << y;
}

TEST(Explain, BeginsWithTheFrameAsItWasWhenTheColorsWereCleared) {
  const PixelScreen screen(8);
  frontmostKeepDraws(1);
  glEnable(GL_DEPTH_TEST);
  glClear(GL_DEPTH_BUFFER_BIT);
  glClear(GL_COLOR_BUFFER_BIT);
  glRecti(0, 0, 8, 8);
  char text[200];
  frontmostExplain(3, 3, text, sizeof text);
  EXPECT_STREQ(text, "draw 0, primitive 0: drawn: depth LESS: 0.5000000 against 1.0000000 passes\n");
  // A clear of a part forgets nothing.
  glEnable(GL_SCISSOR_TEST);
  glScissor(0, 0, 2, 2);
  glClear(GL_COLOR_BUFFER_BIT);
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_DEPTH_TEST);
  glRecti(6, 6, 8, 8);
  unsigned draws[64];
  frontmostGetVisible(0, 0, 8, 8, draws, nullptr);
  EXPECT_EQ(draws[3 * 8 + 3], 0u);
  EXPECT_EQ(draws[7 * 8 + 7], 1u);
  EXPECT_EQ(draws[0], FRONTMOST_NO_PRIMITIVE);
}

TEST(Hostile, RectanglesOutsideOfEveryRangeDrawNothingOrAll) {
  const PixelScreen screen(200);
  glColor3f(1, 0, 0);
  glEnable(GL_SCISSOR_TEST);
  for (const int x : {INT_MIN, INT_MAX, -1, 1 << 24})
    for (const int size : {0, 1}) {
      glScissor(x, 0, size, 200);
      glRecti(0, 0, 200, 200);
      glBegin(GL_POINTS);
      glVertex2i(3, 3);
      glEnd();
    }
  EXPECT_EQ(color_at(150, 100), kBlack);
  glDisable(GL_SCISSOR_TEST);
  glViewport(1 << 24, 0, 16, 16);
  glPointSize(3e9f);
  glBegin(GL_POINTS);
  glVertex2d(-1e9, 3);
  glEnd();
  EXPECT_EQ(color_at(150, 100), kBlack);
}

// ---- Stipples of outlines, which batches cut.

/// The lower half of a picture of stippled outlines that `draw` makes.
template <class Draw>
std::vector<GLubyte> stippled(const Draw& draw) {
  const OffScreen screen(64, 64);
  glPolygonMode(GL_FRONT_AND_BACK, GL_LINE), glEnable(GL_LINE_STIPPLE), glLineStipple(3, 0x35);
  draw();
  std::vector<GLubyte> picture = read_colors(0, 0, 64, 32);
  EXPECT_GT(std::count(picture.begin(), picture.end(), 255), 60);
  return picture;
}

TEST(Stipple, IsNotThatOfPrimitivesBefore) {
  const auto before = [](GLenum mode, int count) {  // in the upper half
    glBegin(mode);
    for (int i = 0; i < count; ++i) glVertex2f(-0.9f + 1.7f * float(i) / float(count), i % 2 == 0 ? 0.3f : 0.9f);
    glEnd();
  };
  // The first triangle of this quad has no visible edge.
  const auto quad = [] {
    glBegin(GL_QUADS), glEdgeFlag(0), glVertex2f(-0.9f, -0.9f), glEdgeFlag(1), glVertex2f(0.9f, -0.9f);
    glVertex2f(0.9f, -0.1f), glEdgeFlag(0), glVertex2f(-0.9f, -0.1f), glEdgeFlag(1), glEnd();
  };
  EXPECT_TRUE(stippled([&] { before(GL_LINE_STRIP, 2), glLineWidth(1), quad(); }) == stippled(quad));
  const auto polygon = [] {
    glBegin(GL_POLYGON), glVertex2f(-0.9f, -0.9f), glVertex2f(0.9f, -0.9f), glVertex2f(0.9f, -0.1f);
    glVertex2f(-0.9f, -0.1f), glEnd();
  };
  const std::vector<GLubyte> expected = stippled(polygon);
  // Some of these leave vertices without a triangle to the next batch.
  for (const GLenum mode : {GL_TRIANGLES, GL_TRIANGLE_STRIP, GL_QUADS, GL_QUAD_STRIP})
    for (int count = 2040; count < 4110; count += count == 2060 ? 2025 : 1)
      EXPECT_TRUE(stippled([&] { before(mode, count), polygon(); }) == expected) << mode << ", " << count;
}

TEST(Stipple, GoesOnAfterHiddenEdgesOfAnyNumber) {
  const auto polygon = [](int hidden) {
    glBegin(GL_POLYGON), glVertex2f(-0.9f, -0.9f), glVertex2f(0.9f, -0.9f), glEdgeFlag(0);
    for (int i = 0; i < hidden; ++i) glVertex2f(0.9f, -0.1f);
    glEdgeFlag(1), glVertex2f(0.9f, -0.1f), glVertex2f(-0.9f, -0.1f), glEnd();
  };
  const std::vector<GLubyte> expected = stippled([&] { polygon(0); });
  for (const int hidden : {1, 2040, 2050, 10000}) EXPECT_TRUE(stippled([&] { polygon(hidden); }) == expected) << hidden;
}

}  // namespace
}  // namespace frontmost::test
