/* SPDX-License-Identifier: Apache-2.0 */
/* A mirror on the floor: the stencil marks where it is seen, and what it shows is drawn there alone, turned upside down. */
#include "program.h"

enum { GROUND = 0x303848, MIRROR = 0x8890A0 };
static Box cube;
static const double floor_y = -0.9;                                    /* the mirror: x -1.6 to 1.6, z -7 to -3.5 */
static const double mirror_x = 1.6, mirror_near = -3.5, mirror_far = -7;

/* Where the ray meets the mirror, or a huge number. */
static double mirror_distance(Vector d) {
  const double t = floor_y / d.y;
  const Vector p = along(vector(0, 0, 0), t, d);
  return d.y < 0 && fabs(p.x) < mirror_x && p.z < mirror_near && p.z > mirror_far ? t : 1e30;
}
static unsigned seen(Vector d) {
  const Passage p = pass(&cube, vector(0, 0, 0), d);
  const double t = mirror_distance(d);
  if (p.enter < p.leave && p.enter < t) return cube.color[p.enter_face];
  if (t < 1e29) { /* the ray goes on upwards from there */
    const Passage q = pass(&cube, along(vector(0, 0, 0), t, d), vector(d.x, -d.y, d.z));
    return q.enter < q.leave ? cube.color[q.enter_face] : MIRROR;
  }
  return GROUND;
}

static void draw_mirror(void) {
  set_color(MIRROR);
  glBegin(GL_QUADS);
  glVertex3d(-mirror_x, floor_y, mirror_near); glVertex3d(mirror_x, floor_y, mirror_near); glVertex3d(mirror_x, floor_y, mirror_far); glVertex3d(-mirror_x, floor_y, mirror_far);
  glEnd();
}

int main(void) {
  static Picture picture;
  static unsigned char stencil[PIXELS];
  GLint bits = 0;
  int f, i, marked = 0, wrong = 0;
  cube = box(vector(0.2, 0.1, -5), vector(0.6, 0.6, 0.6), 35, 25, 0);
  for (f = 0; f < 6; ++f) cube.color[f] = 0xC04020u + 0x001828u * (unsigned)f;
  open_window("stencil_mirror");
  look();
  glGetIntegerv(GL_STENCIL_BITS, &bits);
  expect(bits >= 8, "eight bits of stencil, not %d", bits);
  glClearColor(0x30 / 255.0f, 0x38 / 255.0f, 0x48 / 255.0f, 1);
  glClearStencil(0);
  glEnable(GL_DEPTH_TEST);
  glEnable(GL_CULL_FACE);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);

  /* 1: mark the mirror's pixels, and draw its color there without its depth. */
  glEnable(GL_STENCIL_TEST);
  glStencilFunc(GL_ALWAYS, 1, 0xFF);
  glStencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
  glDepthMask(GL_FALSE);
  draw_mirror();
  glDepthMask(GL_TRUE);

  /* 2: the mirrored cube, only there; what was counter-clockwise is clockwise now. */
  glStencilFunc(GL_EQUAL, 1, 0xFF);
  glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
  glFrontFace(GL_CW);
  glPushMatrix();
  glTranslated(0, 2 * floor_y, 0);
  glScaled(1, -1, 1);
  draw_box(&cube);
  glPopMatrix();
  glFrontFace(GL_CCW);

  /* 3: the mirror's depth, so that it hides what is below it for the rest of the picture. */
  glDisable(GL_STENCIL_TEST);
  glClear(GL_DEPTH_BUFFER_BIT);
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  draw_mirror();
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);

  /* 4: the cube itself. */
  draw_box(&cube);
  read_picture(&picture);
  expect_picture(&picture, seen, "the picture");

  glReadPixels(0, 0, WIDTH, HEIGHT, GL_STENCIL_INDEX, GL_UNSIGNED_BYTE, stencil);
  for (i = 0; i < PIXELS; ++i) {
    const double x = i % WIDTH + 0.5, y = i / WIDTH + 0.5;
    const int in = mirror_distance(ray(x, y)) < 1e29;
    if (in != (mirror_distance(ray(x - 0.02, y - 0.02)) < 1e29) || in != (mirror_distance(ray(x + 0.02, y + 0.02)) < 1e29)) continue;
    if (in != (mirror_distance(ray(x - 0.02, y + 0.02)) < 1e29) || in != (mirror_distance(ray(x + 0.02, y - 0.02)) < 1e29)) continue;
    marked += in;
    wrong += stencil[i] != in;
  }
  expect(wrong == 0, "the stencil is 1 in the mirror and 0 elsewhere, but for %d pixels", wrong);
  expect(marked > 3000, "the mirror is large");

  /* Counting: how many faces lie over each other at a pixel; of a cube two, a front and a back one, or none. */
  glClear(GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
  glDisable(GL_CULL_FACE);
  glDisable(GL_DEPTH_TEST);
  glEnable(GL_STENCIL_TEST);
  glStencilFunc(GL_ALWAYS, 0, 0xFF);
  glStencilOp(GL_KEEP, GL_KEEP, GL_INCR);
  draw_box(&cube);
  glReadPixels(0, 0, WIDTH, HEIGHT, GL_STENCIL_INDEX, GL_UNSIGNED_BYTE, stencil);
  for (i = wrong = 0; i < PIXELS; ++i) wrong += stencil[i] != 0 && stencil[i] != 2;
  expect(wrong == 0, "a closed body covers a pixel twice or not at all, but for %d pixels", wrong);
  return close_window();
}
