// SPDX-License-Identifier: Apache-2.0
// frontmostGetVisible and frontmostExplain: which draw is seen, and what became of every fragment.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "frontmost/gl.h"
#include "gl/off_screen.h"

namespace frontmost::test {
namespace {

using testing::HasSubstr;

void square(double size, double z) {
  glBegin(GL_QUADS);
  glVertex3d(-size, -size, z);
  glVertex3d(size, -size, z);
  glVertex3d(size, size, z);
  glVertex3d(-size, size, z);
  glEnd();
}

std::vector<std::string> explained(int x, int y) {
  std::string text(frontmostExplain(x, y, nullptr, 0), '\0');
  text.resize(text.size() + 1);
  EXPECT_EQ(text.size(), frontmostExplain(x, y, text.data(), text.size()) + 1);
  std::vector<std::string> lines;
  for (std::size_t at = 0, end; (end = text.find('\n', at)) != std::string::npos; at = end + 1)
    lines.push_back(text.substr(at, end - at));
  return lines;
}

TEST(Explain, EveryVerdictInTheOrderOfSubmission) {
  OffScreen screen(64, 64);
  frontmostKeepDraws(1);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
  glEnable(GL_DEPTH_TEST);
  square(1, 0);  // draw 0, window depth 0.5
  square(1, 0.2);
  glEnable(GL_CULL_FACE);
  glCullFace(GL_FRONT);
  square(1, -0.5);
  glDisable(GL_CULL_FACE);
  glEnable(GL_SCISSOR_TEST);
  glScissor(0, 0, 5, 5);
  square(1, -0.5);
  glDisable(GL_SCISSOR_TEST);
  glEnable(GL_ALPHA_TEST);
  glAlphaFunc(GL_LESS, 0.5f);
  square(1, -0.5);
  glDisable(GL_ALPHA_TEST);
  glEnable(GL_STENCIL_TEST);
  glStencilFunc(GL_EQUAL, 3, 255);
  square(1, -0.5);
  glDisable(GL_STENCIL_TEST);
  const GLdouble plane[4] = {0, 0, 1, -0.9};
  glClipPlane(GL_CLIP_PLANE0, plane);
  glEnable(GL_CLIP_PLANE0);
  square(1, -0.5);
  glDisable(GL_CLIP_PLANE0);
  square(0.5, -0.5);  // draw 7

  const std::vector<std::string> lines = explained(30, 33);
  ASSERT_EQ(lines.size(), 8u);
  EXPECT_EQ(lines[0], "draw 0, primitive 0: drawn: depth LESS: 0.5000000 against 1.0000000 passes");
  EXPECT_EQ(lines[1], "draw 1, primitive 0: depth LESS: 0.6000000 against 0.5000000 fails");
  EXPECT_EQ(lines[2], "draw 2, primitive 0: culled: seen from the front");
  EXPECT_THAT(lines[3], HasSubstr("draw 3, primitive 0: scissored"));
  EXPECT_EQ(lines[4], "draw 4, primitive 0: alpha LESS: 1 LESS 0.5 fails");
  EXPECT_EQ(lines[5], "draw 5, primitive 0: stencil EQUAL: 3 against 0, by mask 255, fails");
  EXPECT_EQ(lines[6], "draw 6, primitive 0: clipped: behind the user's clip plane");
  EXPECT_EQ(lines[7], "draw 7, primitive 0: drawn: depth LESS: 0.2500000 against 0.5000000 passes");

  std::vector<unsigned> draws(64 * 64), primitives(64 * 64);
  frontmostGetVisible(0, 0, 64, 64, draws.data(), primitives.data());
  EXPECT_EQ(draws[33 * 64 + 30], 7u);
  EXPECT_EQ(draws[10 * 64 + 10], 0u);
  EXPECT_EQ(primitives[10 * 64 + 10], 0u);
}

TEST(Explain, PrimitivesAreCountedAsProgramsCount) {
  OffScreen screen(90, 30);
  frontmostKeepDraws(1);
  glClear(GL_COLOR_BUFFER_BIT);
  glMatrixMode(GL_PROJECTION);
  glOrtho(0, 90, 0, 30, -1, 1);
  glBegin(GL_QUADS);  // two quads, of two triangles each
  for (const int x : {0, 30}) glVertex2i(x, 0), glVertex2i(x + 30, 0), glVertex2i(x + 30, 30), glVertex2i(x, 30);
  glEnd();
  glBegin(GL_POINTS);
  glVertex2d(70.5, 10.5);
  glVertex2d(80.5, 10.5);
  glEnd();
  unsigned draw = 0, primitive = 0;
  const auto at = [&](int x, int y) {
    frontmostGetVisible(x, y, 1, 1, &draw, &primitive);
    return std::pair(draw, primitive);
  };
  EXPECT_EQ(at(10, 10), std::pair(0u, 0u));
  EXPECT_EQ(at(40, 20), std::pair(0u, 1u));
  EXPECT_EQ(at(80, 10), std::pair(1u, 1u));
  EXPECT_EQ(at(75, 10), std::pair(FRONTMOST_NO_PRIMITIVE, FRONTMOST_NO_PRIMITIVE));
  EXPECT_EQ(at(-1, 10), std::pair(FRONTMOST_NO_PRIMITIVE, FRONTMOST_NO_PRIMITIVE));
  glClear(GL_COLOR_BUFFER_BIT);
  EXPECT_EQ(at(10, 10), std::pair(FRONTMOST_NO_PRIMITIVE, FRONTMOST_NO_PRIMITIVE));
}

TEST(Explain, StripsLongerThanABatchCountOn) {
  OffScreen screen(100, 10);
  frontmostKeepDraws(1);
  glClear(GL_COLOR_BUFFER_BIT);
  glMatrixMode(GL_PROJECTION);
  glOrtho(0, 10000, 0, 10, -1, 1);
  glBegin(GL_TRIANGLE_STRIP);
  for (int i = 0; i <= 10000; ++i) glVertex2i(i, 0), glVertex2i(i, 10);
  glEnd();
  unsigned primitive = 0;
  frontmostGetVisible(99, 2, 1, 1, nullptr, &primitive);
  EXPECT_NEAR(double(primitive), 2 * 9950, 2);
}

// Kernels draw the pixel again for explain(); it must come out as it was.
TEST(Explain, LeavesThePictureAsItWas) {
  OffScreen screen(64, 64);
  frontmostKeepDraws(1);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glColor4f(0.3f, 0.9f, 0.5f, 0.4f);
  for (int i = 0; i < 4; ++i) square(1, -0.1 * i);
  const auto before = screen.picture();
  EXPECT_EQ(explained(20, 20).size(), 4u);
  EXPECT_EQ(screen.picture(), before);
}

}  // namespace
}  // namespace frontmost::test
