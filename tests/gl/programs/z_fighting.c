/* SPDX-License-Identifier: Apache-2.0 */
/* Two surfaces in one plane, and what makes them agree: the same vertices, or a polygon offset. */
#include "program.h"

enum { GROUND = 0, FIRST = 0xE0A020, SECOND = 0x20A0E0 };

/* The plane z = -6 + 0.4 x + 0.3 y. */
static void corner(double x, double y) { glVertex3d(x, y, -6 + 0.4 * x + 0.3 * y); }
static void first_quad(void) {
  set_color(FIRST);
  glBegin(GL_TRIANGLES);
  corner(-2, -1.5); corner(2, -1.5); corner(2, 1.5);
  corner(-2, -1.5); corner(2, 1.5); corner(-2, 1.5);
  glEnd();
}
/* The same rectangle in other triangles: around a point that is not the middle. */
static void second_quad(void) {
  set_color(SECOND);
  glBegin(GL_TRIANGLE_FAN);
  corner(0.37, -0.21); corner(-2, -1.5); corner(2, -1.5); corner(2, 1.5); corner(-2, 1.5); corner(-2, -1.5);
  glEnd();
}
static void again(void) { first_quad(); }

static void draw(Picture *picture, GLenum func, void (*second)(void), double factor, double units) {
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  glDepthFunc(func);
  glDisable(GL_POLYGON_OFFSET_FILL);
  first_quad();
  if (factor != 0 || units != 0) glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset((GLfloat)factor, (GLfloat)units);
  second();
  glDisable(GL_POLYGON_OFFSET_FILL);
  read_picture(picture);
}

/* Depth, in steps of 24 bits, that an offset adds to a surface that faces the eye. */
static double steps_of(double factor, double units, double slant) {
  static unsigned plain[PIXELS], moved[PIXELS];
  const int middle = HEIGHT / 2 * WIDTH + WIDTH / 2;
  int i;
  glDepthFunc(GL_LESS);
  for (i = 0; i < 2; ++i) {
    glClear(GL_DEPTH_BUFFER_BIT);
    if (i) glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset((GLfloat)factor, (GLfloat)units);
    glBegin(GL_QUADS);
    glVertex3d(-3, -3, -6 - 3 * slant); glVertex3d(3, -3, -6 + 3 * slant); glVertex3d(3, 3, -6 + 3 * slant); glVertex3d(-3, 3, -6 - 3 * slant);
    glEnd();
    glDisable(GL_POLYGON_OFFSET_FILL);
    glReadPixels(0, 0, WIDTH, HEIGHT, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT, i ? moved : plain);
  }
  return ((double)moved[middle] - (double)plain[middle]) / 4294967295.0 * 16777215.0;
}

int main(void) {
  static Picture picture, alone;
  int first, second, all;
  double steps, slope, expected, k, m;
  open_window("z_fighting");
  look();
  glEnable(GL_DEPTH_TEST);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  first_quad();
  read_picture(&alone);
  all = count_of(&alone, FIRST);
  expect(all > 5000, "the rectangle is seen");

  /* The same vertices have the same depths: GL_LESS keeps the first, GL_LEQUAL and GL_EQUAL take the second. */
  draw(&picture, GL_LESS, again, 0, 0);
  expect(differing(&picture, &alone) == 0, "GL_LESS, drawn again");
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  first_quad();
  glDepthFunc(GL_EQUAL);
  glClear(GL_COLOR_BUFFER_BIT);
  first_quad();
  read_picture(&picture);
  expect(differing(&picture, &alone) == 0, "GL_EQUAL finds every pixel of the same triangles, not all but %d", differing(&picture, &alone));

  /* Other triangles: a fight. Which pixels it goes to is nobody's promise. */
  draw(&picture, GL_LESS, second_quad, 0, 0);
  first = count_of(&picture, FIRST), second = count_of(&picture, SECOND);
  expect(first + second == all, "every pixel shows one or the other");
  printf("z_fighting: without offset %d pixels show the first, %d the second\n", first, second);

  /* Pulled nearer, the second is seen everywhere; pushed away, nowhere. */
  draw(&picture, GL_LESS, second_quad, -1, -1);
  expect(count_of(&picture, SECOND) == all, "offset -1, -1: the second is seen in all of %d pixels, not in %d", all, count_of(&picture, SECOND));
  draw(&picture, GL_LESS, second_quad, 1, 1);
  expect(count_of(&picture, FIRST) == all, "offset 1, 1: the first is seen in all of %d pixels, not in %d", all, count_of(&picture, FIRST));

  /* factor * m + units * r: r is one step of the buffer or a little more, m the greater slope in x or y. */
  steps = steps_of(0, 40, 0);
  expect(steps >= 39 && steps <= 80, "40 units are 40 steps or up to twice as many, not %g", steps);
  steps = steps_of(3, 0, 0);
  expect(fabs(steps) <= 1, "no slope, no change by the factor, not %g", steps);
  /* At the middle of the screen: plane z = -6 + k x; the distance along a ray is 6 / (1 + k x / n') and so on: by doubles. */
  k = 0.5;
  m = 1e-4;
  slope = (window_depth(6 / (1 + k * ray(WIDTH / 2 + 0.5 + m, 0).x)) - window_depth(6 / (1 + k * ray(WIDTH / 2 + 0.5, 0).x))) / m;
  expected = 3 * fabs(slope) * 16777215.0;
  steps = steps_of(3, 0, k);
  expect(fabs(steps / expected - 1) < 0.02, "3 slopes are %g steps, not %g", expected, steps);
  return close_window();
}
