/* SPDX-License-Identifier: Apache-2.0 */
/* Panes that let half of the light through, before and behind an opaque one: right only if everything opaque is drawn
 * first and the panes from far to near, with their depths tested but not stored. */
#include "program.h"

typedef struct { double z, alpha; double r, g, b; } Pane;
static const Pane wall = {-9, 1, 0.2, 0.3, 0.9};                                      /* opaque */
static const Pane panes[3] = {{-10, 0.5, 1, 1, 1}, {-7, 0.5, 1, 0.1, 0.1}, {-5, 0.25, 0.1, 1, 0.2}};  /* far, middle, near */
static const double ground[3] = {0.1, 0.1, 0.1};

static void draw_pane(const Pane *p) {
  glColor4d(p->r, p->g, p->b, p->alpha);
  glBegin(GL_QUADS);
  glVertex3d(-8, -8, p->z); glVertex3d(8, -8, p->z); glVertex3d(8, 8, p->z); glVertex3d(-8, 8, p->z);
  glEnd();
}

/* alpha * pane + (1 - alpha) * there, as often as panes pass. */
static void lay_on(double *there, const Pane *p) {
  there[0] += p->alpha * (p->r - there[0]), there[1] += p->alpha * (p->g - there[1]), there[2] += p->alpha * (p->b - there[2]);
}

static void check(const double *expected, const char *what) {
  static unsigned char bytes[4 * PIXELS];
  int i, k, worst = 0;
  glReadPixels(0, 0, WIDTH, HEIGHT, GL_RGBA, GL_UNSIGNED_BYTE, bytes);
  for (i = 0; i < PIXELS; ++i)
    for (k = 0; k < 3; ++k) {
      const int off = abs((int)bytes[4 * i + k] - (int)floor(expected[k] * 255 + 0.5));
      if (off > worst) worst = off;
    }
  expect(worst <= 2, "%s: within 2 steps of %g %g %g, not %d away", what, expected[0] * 255, expected[1] * 255, expected[2] * 255, worst);
}

static void clear(double *there) {
  glDepthMask(GL_TRUE);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  memcpy(there, ground, sizeof ground);
}

int main(void) {
  double there[3];
  int i;
  open_window("transparency");
  look();
  glClearColor((GLfloat)ground[0], (GLfloat)ground[1], (GLfloat)ground[2], 1);
  expect(!glIsEnabled(GL_BLEND), "blending is off at first");
  glEnable(GL_DEPTH_TEST);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glEnable(GL_BLEND);

  /* Right: opaque first, then panes from far to near, their depths not stored. The far pane is behind the wall. */
  clear(there);
  draw_pane(&wall), lay_on(there, &wall);
  glDepthMask(GL_FALSE);
  for (i = 0; i < 3; ++i) draw_pane(&panes[i]);
  lay_on(there, &panes[1]), lay_on(there, &panes[2]);
  check(there, "opaque first, then from far to near");

  /* Panes from near to far, depths not stored: all pass, in the wrong order. */
  clear(there);
  draw_pane(&wall), lay_on(there, &wall);
  glDepthMask(GL_FALSE);
  for (i = 2; i >= 0; --i) draw_pane(&panes[i]);
  lay_on(there, &panes[2]), lay_on(there, &panes[1]);
  check(there, "from near to far, depths not stored");

  /* From near to far, depths stored: the near pane hides the others. */
  clear(there);
  draw_pane(&wall), lay_on(there, &wall);
  for (i = 2; i >= 0; --i) draw_pane(&panes[i]);
  lay_on(there, &panes[2]);
  check(there, "from near to far, depths stored");

  /* Opaque last: what the near pane's depth hides is missing behind it. */
  clear(there);
  draw_pane(&panes[2]), lay_on(there, &panes[2]);
  draw_pane(&wall);
  check(there, "a pane before the wall, depths stored");

  /* Alpha test instead: what is half there is there or not. */
  clear(there);
  glDisable(GL_BLEND);
  glEnable(GL_ALPHA_TEST);
  glAlphaFunc(GL_GREATER, 0.4f);
  draw_pane(&wall), lay_on(there, &wall);
  for (i = 0; i < 3; ++i) draw_pane(&panes[i]);
  there[0] = panes[1].r, there[1] = panes[1].g, there[2] = panes[1].b;
  check(there, "alpha greater than 0.4: the near pane is not there, the middle one is opaque");
  return close_window();
}
