/* SPDX-License-Identifier: Apache-2.0 */
/* Why does the label flicker? Two rectangles in one plane, asked at a pixel; then the cure, glPolygonOffset.
 *
 *   cc z_fighting.c $(pkg-config --cflags --libs frontmost-gl) && ./a.out */
#include <GL/gl.h>
#include <GL/osmesa.h>
#include <frontmost/gl.h>
#include <stdio.h>

enum { WIDTH = 320, HEIGHT = 240 };
static unsigned char pixels[4 * WIDTH * HEIGHT];

/* A corner in the plane z = -5 + 0.4 x + 0.3 y. */
static void corner(double x, double y) { glVertex3d(x, y, -5 + 0.4 * x + 0.3 * y); }

static void board(void) {
  glBegin(GL_QUADS);
  corner(-1.7, -1.2), corner(1.7, -1.2), corner(1.7, 1.2), corner(-1.7, 1.2);
  glEnd();
}
static void label(void) {
  glBegin(GL_TRIANGLE_FAN);
  corner(0.37, -0.21), corner(-1.2, -0.8), corner(1.1, -0.8), corner(1.1, 0.7), corner(-1.2, 0.7), corner(-1.2, -0.8);
  glEnd();
}

static void scene(int is_cured) {
  static unsigned draws[WIDTH * HEIGHT];
  unsigned shown = 0, all = 0, i;
  char text[1000];
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  if (is_cured) glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(1, 1); /* moves the board back */
  glColor3f(0.8f, 0.6f, 0.2f);
  board(); /* draw 0 */
  glDisable(GL_POLYGON_OFFSET_FILL);
  glColor3f(0.1f, 0.2f, 0.6f);
  label(); /* draw 1 */

  frontmostGetVisible(0, 0, WIDTH, HEIGHT, draws, NULL);
  for (i = 0; i < WIDTH * HEIGHT; ++i) shown += draws[i] == 1;
  glDepthFunc(GL_ALWAYS); /* the label again, over everything: so many pixels it has */
  label();                /* draw 2 */
  glDepthFunc(GL_LESS);
  frontmostGetVisible(0, 0, WIDTH, HEIGHT, draws, NULL);
  for (i = 0; i < WIDTH * HEIGHT; ++i) all += draws[i] == 2;
  printf("%s: %u of %u pixels show the label\n", is_cured ? "with glPolygonOffset" : "without an offset", shown, all);
  frontmostExplain(180, 120, text, sizeof text);
  printf("%s", text);
}

int main(void) {
  const OSMesaContext context = OSMesaCreateContextExt(OSMESA_RGBA, 24, 8, 0, NULL);
  if (!context || !OSMesaMakeCurrent(context, pixels, GL_UNSIGNED_BYTE, WIDTH, HEIGHT)) return 1;
  glMatrixMode(GL_PROJECTION);
  glFrustum(-0.4, 0.4, -0.3, 0.3, 1, 100);
  glMatrixMode(GL_MODELVIEW);
  glEnable(GL_DEPTH_TEST);
  frontmostKeepDraws(1);
  scene(0);
  scene(1);
  OSMesaDestroyContext(context);
  return 0;
}
