/* SPDX-License-Identifier: Apache-2.0 */
/* From the depth buffer back to the scene: every pixel's depth, read and unprojected, is a point of the surface. */
#include "program.h"

enum { GROUND = 0, GRAY = 0x808080 };
static Box cube;

static unsigned hit(Vector d) { const Passage p = pass(&cube, vector(0, 0, 0), d); return p.enter < p.leave ? GRAY + (unsigned)p.enter_face : GROUND; }

static double distance_of(Vector d) { return pass(&cube, vector(0, 0, 0), d).enter; }

int main(void) {
  static float depths[PIXELS];
  static unsigned whole[PIXELS];
  static unsigned short half[PIXELS];
  static Picture picture;
  GLdouble model[16], projection[16], range[2];
  GLint viewport[4], bits = 0;
  double worst = 0, worst_round = 0, slack, farthest;
  int i, f, seen = 0, wrong_whole = 0, wrong_half = 0, background = 0, near_pixel = -1;
  cube = box(vector(0.2, -0.1, -5), vector(1.1, 0.9, 1.3), 40, 30, GRAY);
  for (f = 0; f < 6; ++f) cube.color[f] = GRAY + (unsigned)f;
  open_window("depth_readback");
  look();
  glEnable(GL_DEPTH_TEST);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  draw_box(&cube);
  read_picture(&picture);
  expect_picture(&picture, hit, "the faces");
  glReadPixels(0, 0, WIDTH, HEIGHT, GL_DEPTH_COMPONENT, GL_FLOAT, depths);
  glReadPixels(0, 0, WIDTH, HEIGHT, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT, whole);
  glReadPixels(0, 0, WIDTH, HEIGHT, GL_DEPTH_COMPONENT, GL_UNSIGNED_SHORT, half);

  glGetDoublev(GL_MODELVIEW_MATRIX, model);
  glGetDoublev(GL_PROJECTION_MATRIX, projection);
  glGetDoublev(GL_DEPTH_RANGE, range);
  glGetIntegerv(GL_VIEWPORT, viewport);
  glGetIntegerv(GL_DEPTH_BITS, &bits);
  expect(viewport[0] == 0 && viewport[1] == 0 && viewport[2] == WIDTH && viewport[3] == HEIGHT, "the viewport is the window at first");
  expect(range[0] == 0 && range[1] == 1, "the depth range is 0 to 1 at first");
  expect(bits == 24, "24 bits of depth, as was asked for, not %d", bits);

  for (i = 0; i < PIXELS; ++i) {
    const double x = i % WIDTH + 0.5, y = i / WIDTH + 0.5;
    const Vector d = ray(x, y);
    const Passage p = pass(&cube, vector(0, 0, 0), d);
    unsigned color;
    GLdouble px, py, pz, wx, wy, wz;
    wrong_whole += fabs(whole[i] / 4294967295.0 - depths[i]) > 1.5 / 16777215;
    wrong_half += fabs(half[i] / 65535.0 - depths[i]) > 0.75 / 65535;
    if (!is_certain(hit, i, &color)) continue;
    if (color == GROUND) { expect(depths[i] == 1, "where nothing is drawn the depth is 1"); ++background; continue; }
    ++seen;
    gluUnProject(x, y, depths[i], model, projection, viewport, &px, &py, &pz);
    /* The point of the surface is p.enter times the direction. */
    /* As far from there as the slack of its depth is long: depth grows by f n / ((f - n) t^2) with the distance t. */
    slack = depth_slack(distance_of, x, y) * (view.far - view.near) * p.enter * p.enter / (view.far * view.near) * sqrt(d.x * d.x + d.y * d.y + 1);
    farthest = sqrt(pow(px - p.enter * d.x, 2) + pow(py - p.enter * d.y, 2) + pow(pz + p.enter, 2));
    worst = fmax(worst, farthest / slack);
    gluProject(px, py, pz, model, projection, viewport, &wx, &wy, &wz);
    worst_round = fmax(worst_round, fmax(fmax(fabs(wx - x), fabs(wy - y)), fabs(wz - depths[i])));
    if (near_pixel < 0 || depths[i] < depths[near_pixel]) near_pixel = i;
  }
  expect(seen > 3000 && background > 3000, "the cube is seen before nothing");
  expect(wrong_whole == 0, "unsigned integers mean value / (2^32 - 1), but for %d", wrong_whole);
  expect(wrong_half == 0, "unsigned shorts mean value / (2^16 - 1), but for %d", wrong_half);
  expect(worst < 1.05, "unprojected points lie on the surface, but for %g of what rounding may do", worst);
  expect(worst_round < 1e-6, "projected again they are where they were, but for %g", worst_round);
  printf("depth_readback: unprojected points are from the surface by %g of what rounding may do at most; the nearest depth is %.7f\n", worst, depths[near_pixel]);

  /* Another range: the same values, squeezed. */
  {
    static float squeezed[PIXELS];
    double off = 0;
    glDepthRange(0.25, 0.75);
    glClear(GL_DEPTH_BUFFER_BIT);
    draw_box(&cube);
    glReadPixels(0, 0, WIDTH, HEIGHT, GL_DEPTH_COMPONENT, GL_FLOAT, squeezed);
    for (i = 0; i < PIXELS; ++i)
      if (depths[i] < 1) off = fmax(off, fabs(squeezed[i] - (0.25 + 0.5 * depths[i])));
      else expect(squeezed[i] == 1, "the range does not hold for clearing");
    expect(off < 2e-6, "glDepthRange(0.25, 0.75) gives 0.25 + depth / 2, but for %g", off);
  }
  return close_window();
}
