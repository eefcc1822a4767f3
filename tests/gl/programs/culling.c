/* SPDX-License-Identifier: Apache-2.0 */
/* Faces that are left out by the way they are wound, and the toggles of the textbooks. */
#include "program.h"

enum { GROUND = 0x000000 };
static Box cube;

static unsigned front_face(Vector d) { const Passage p = pass(&cube, vector(0, 0, 0), d); return p.enter < p.leave ? cube.color[p.enter_face] : GROUND; }
static unsigned back_face(Vector d) { const Passage p = pass(&cube, vector(0, 0, 0), d); return p.enter < p.leave ? cube.color[p.leave_face] : GROUND; }
static unsigned mirrored_back_face(Vector d) { return back_face(vector(-d.x, d.y, d.z)); }

static void draw(Picture *picture) {
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  draw_box(&cube);
  read_picture(picture);
}
static GLint integer_of(GLenum name) { GLint value = -1; glGetIntegerv(name, &value); return value; }
static void toggle(GLenum capability) { if (glIsEnabled(capability)) glDisable(capability); else glEnable(capability); }

int main(void) {
  static Picture picture, other;
  int f;
  cube = box(vector(0.1, -0.1, -5), vector(1.2, 1.1, 1), 32, 28, 0);
  for (f = 0; f < 6; ++f) cube.color[f] = 0x3050A0u + 0x201808u * (unsigned)f;
  open_window("culling");
  look();

  /* What holds before anything was said. */
  expect(!glIsEnabled(GL_CULL_FACE), "culling is off at first");
  expect(integer_of(GL_CULL_FACE_MODE) == GL_BACK, "back faces are those to be culled at first");
  expect(integer_of(GL_FRONT_FACE) == GL_CCW, "counter-clockwise is front at first");

  /* A closed convex body: its back faces are hidden by its front faces, so to cull them is to be rid of the depth test. */
  toggle(GL_CULL_FACE);
  expect(glIsEnabled(GL_CULL_FACE), "a toggle switches it on");
  draw(&picture);
  expect_picture(&picture, front_face, "back faces culled, no depth test");
  glEnable(GL_DEPTH_TEST);
  toggle(GL_CULL_FACE);
  expect(!glIsEnabled(GL_CULL_FACE), "a second toggle switches it off");
  draw(&other);
  expect_picture(&other, front_face, "nothing culled, depth test");
  expect(differing(&picture, &other) == 0, "both pictures are the same, not other in %d pixels", differing(&picture, &other));

  /* Front faces culled: the inside is seen. */
  glEnable(GL_CULL_FACE);
  glCullFace(GL_FRONT);
  draw(&picture);
  expect_picture(&picture, back_face, "front faces culled");
  /* The other winding for front, and back faces culled: the same faces. */
  glCullFace(GL_BACK);
  glFrontFace(GL_CW);
  draw(&other);
  expect(differing(&picture, &other) == 0, "clockwise front faces: the same picture, not other in %d pixels", differing(&picture, &other));
  glFrontFace(GL_CCW);
  /* A mirrored object is wound the other way. */
  glPushMatrix();
  glScaled(-1, 1, 1);
  draw(&other);
  glPopMatrix();
  expect_picture(&other, mirrored_back_face, "mirrored, back faces culled");

  /* Both culled: no polygon is left, but lines are. */
  glCullFace(GL_FRONT_AND_BACK);
  draw(&picture);
  expect(count_of(&picture, GROUND) == PIXELS, "front and back culled: nothing is drawn");
  glColor3ub(255, 255, 255);
  glBegin(GL_LINES);
  glVertex3d(-1, 0.013, -5);
  glVertex3d(1, 0.013, -5);
  glEnd();
  read_picture(&picture);
  expect(count_of(&picture, 0xFFFFFF) > 40, "lines are not culled");

  /* Misuse changes nothing and leaves one error. */
  glCullFace(GL_LINE);
  expect(glGetError() == GL_INVALID_ENUM, "no such face: GL_INVALID_ENUM");
  expect(glGetError() == GL_NO_ERROR, "and the error is told once");
  expect(integer_of(GL_CULL_FACE_MODE) == GL_FRONT_AND_BACK, "the mode stays");
  glBegin(GL_TRIANGLES);
  glEnable(GL_CULL_FACE);
  glEnd();
  expect(glGetError() == GL_INVALID_OPERATION, "state cannot change between glBegin and glEnd");
  return close_window();
}
