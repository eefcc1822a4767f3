/* SPDX-License-Identifier: Apache-2.0 */
/* Two cubes that pass through each other. With the depth test every pixel shows the nearer one; without it, the one that
 * was drawn last. */
#include "program.h"

enum { GROUND = 0x202020, RED = 0xE03020, BLUE = 0x2050E0 };
static Box red, blue;

static unsigned nearest(Vector d) {
  const Passage r = pass(&red, vector(0, 0, 0), d), b = pass(&blue, vector(0, 0, 0), d);
  const int hits_red = r.enter < r.leave, hits_blue = b.enter < b.leave;
  if (hits_red && hits_blue) return r.enter < b.enter ? RED : BLUE;
  return hits_red ? RED : hits_blue ? BLUE : GROUND;
}
static unsigned blue_last(Vector d) {
  const Passage r = pass(&red, vector(0, 0, 0), d), b = pass(&blue, vector(0, 0, 0), d);
  return b.enter < b.leave ? BLUE : r.enter < r.leave ? RED : GROUND;
}

static void draw(Picture *picture, const Box *first, const Box *second) {
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  draw_box(first);
  draw_box(second);
  read_picture(picture);
}

int main(void) {
  static Picture tested, tested_other_way, untested;
  red = box(vector(-0.3, 0, -5), vector(1, 1, 1), 25, 20, RED);
  blue = box(vector(0.4, 0.2, -4.8), vector(0.9, 0.9, 0.9), -40, 35, BLUE);
  open_window("intersecting_cubes");
  look();
  glClearColor(0x20 / 255.0f, 0x20 / 255.0f, 0x20 / 255.0f, 1);

  expect(!glIsEnabled(GL_DEPTH_TEST), "the depth test is off at first");
  glEnable(GL_DEPTH_TEST);
  draw(&tested, &red, &blue);
  draw(&tested_other_way, &blue, &red);
  expect_picture(&tested, nearest, "with the depth test");
  expect_picture(&tested_other_way, nearest, "with the depth test, drawn the other way round");

  glDisable(GL_DEPTH_TEST);
  draw(&untested, &red, &blue);
  expect_picture(&untested, blue_last, "without the depth test");
  expect(differing(&tested, &untested) > 1000, "the two pictures differ by much, not by %d pixels", differing(&tested, &untested));
  expect(count_of(&tested, RED) > 1000 && count_of(&tested, BLUE) > 1000, "both cubes are seen");
  return close_window();
}
