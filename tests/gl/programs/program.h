/* SPDX-License-Identifier: Apache-2.0 */
/* What the programs of this folder share: a picture in memory instead of a window, and expectations.
 *
 * The pictures are GL's; what is expected is worked out here by rays in doubles, without GL. Pixels that an edge passes
 * within a fiftieth of a pixel of their centre are left out, because implementations may round corners differently. */
#ifndef PROGRAM_H
#define PROGRAM_H

#define GL_GLEXT_PROTOTYPES
#include <GL/gl.h>
#include <GL/glext.h>
#include <GL/glu.h>
#include <GL/osmesa.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 240, HEIGHT = 180, PIXELS = WIDTH * HEIGHT };

static const char* program_name;
static unsigned char window_memory[4 * PIXELS];
static int failures;

static void open_window(const char* name) {
  const OSMesaContext context = OSMesaCreateContextExt(OSMESA_RGBA, 24, 8, 0, NULL);
  program_name = name;
  if (!context || !OSMesaMakeCurrent(context, window_memory, GL_UNSIGNED_BYTE, WIDTH, HEIGHT)) {
    printf("%s: no context\n", name);
    exit(2);
  }
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
}

/* Says what was expected where it does not hold. */
static void expect(int holds, const char* format, ...) {
  va_list arguments;
  if (holds) return;
  ++failures;
  printf("%s: FAILED: ", program_name);
  va_start(arguments, format);
  vprintf(format, arguments);
  va_end(arguments);
  printf("\n");
}

static int close_window(void) {
  expect(glGetError() == GL_NO_ERROR, "no error is left");
  printf("%s: %s\n", program_name, failures ? "failed" : "all holds");
  return failures != 0;
}

/* RGB of every pixel, rows from the bottom, as 0xRRGGBB. */
typedef struct {
  unsigned at[PIXELS];
} Picture;

static void read_picture(Picture* picture) {
  static unsigned char bytes[4 * PIXELS];
  int i;
  glReadPixels(0, 0, WIDTH, HEIGHT, GL_RGBA, GL_UNSIGNED_BYTE, bytes);
  for (i = 0; i < PIXELS; ++i)
    picture->at[i] = (unsigned)bytes[4 * i] << 16 | (unsigned)bytes[4 * i + 1] << 8 | bytes[4 * i + 2];
}
static int count_of(const Picture* picture, unsigned color) {
  int i, n = 0;
  for (i = 0; i < PIXELS; ++i) n += picture->at[i] == color;
  return n;
}
static int differing(const Picture* a, const Picture* b) {
  int i, n = 0;
  for (i = 0; i < PIXELS; ++i) n += a->at[i] != b->at[i];
  return n;
}
static void set_color(unsigned color) { glColor3ub((GLubyte)(color >> 16), (GLubyte)(color >> 8), (GLubyte)color); }

/* ---- the view: from the origin along -z -------------------------------------------------------------------------- */

typedef struct {
  double left, right, bottom, top, near, far;
} Frustum;
static const Frustum view = {-0.8, 0.8, -0.6, 0.6, 1.5, 12};

static void look(void) {
  glMatrixMode(GL_PROJECTION);
  glLoadIdentity();
  glFrustum(view.left, view.right, view.bottom, view.top, view.near, view.far);
  glMatrixMode(GL_MODELVIEW);
  glLoadIdentity();
}

typedef struct {
  double x, y, z;
} Vector;
static Vector vector(double x, double y, double z) {
  Vector v;
  v.x = x, v.y = y, v.z = z;
  return v;
}
static Vector along(Vector a, double t, Vector d) { return vector(a.x + t * d.x, a.y + t * d.y, a.z + t * d.z); }

/* From the eye to a place on the screen, in pixels from the bottom left; z is -1, so that a ray's parameter is the
 * distance along the viewing axis. */
static Vector ray(double x, double y) {
  return vector((view.left + (view.right - view.left) * x / WIDTH) / view.near,
                (view.bottom + (view.top - view.bottom) * y / HEIGHT) / view.near, -1);
}
/* What glFrustum and glDepthRange(0, 1) make of a distance. */
static double window_depth(double distance) {
  return view.far * (distance - view.near) / (distance * (view.far - view.near));
}

/* ---- boxes ------------------------------------------------------------------------------------------------------- */

typedef struct {
  Vector centre, half;
  double turn_y, turn_x;
  unsigned color[6];
} Box; /* degrees; faces -x +x -y +y -z +z */

static Box box(Vector centre, Vector half, double turn_y, double turn_x, unsigned color) {
  Box b;
  int i;
  b.centre = centre, b.half = half, b.turn_y = turn_y, b.turn_x = turn_x;
  for (i = 0; i < 6; ++i) b.color[i] = color;
  return b;
}

/* Counter-clockwise from outside. */
static void draw_box(const Box* b) {
  static const int faces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  int f, k;
  glPushMatrix();
  glTranslated(b->centre.x, b->centre.y, b->centre.z);
  glRotated(b->turn_y, 0, 1, 0);
  glRotated(b->turn_x, 1, 0, 0);
  glBegin(GL_QUADS);
  for (f = 0; f < 6; ++f) {
    set_color(b->color[f]);
    for (k = 0; k < 4; ++k) {
      const int c = faces[f][k];
      glVertex3d(c & 1 ? b->half.x : -b->half.x, c & 2 ? b->half.y : -b->half.y, c & 4 ? b->half.z : -b->half.z);
    }
  }
  glEnd();
  glPopMatrix();
}

/* Into the box's own axes: the turns undone. */
static Vector turned_back(const Box* b, Vector v) {
  const double pi = 3.14159265358979323846, y = b->turn_y * pi / 180, x = b->turn_x * pi / 180;
  const Vector u = vector(cos(y) * v.x - sin(y) * v.z, v.y, sin(y) * v.x + cos(y) * v.z);
  return vector(u.x, cos(x) * u.y + sin(x) * u.z, -sin(x) * u.y + cos(x) * u.z);
}

typedef struct {
  double enter, leave;
  int enter_face, leave_face;
} Passage; /* enter > leave: the ray misses */

static Passage pass(const Box* b, Vector origin, Vector direction) {
  const Vector o = turned_back(b, vector(origin.x - b->centre.x, origin.y - b->centre.y, origin.z - b->centre.z));
  const Vector d = turned_back(b, direction);
  const double from[3] = {o.x, o.y, o.z}, to[3] = {d.x, d.y, d.z}, half[3] = {b->half.x, b->half.y, b->half.z};
  Passage p = {-1e300, 1e300, -1, -1};
  int k;
  for (k = 0; k < 3; ++k) {
    const double low = (-half[k] - from[k]) / to[k], high = (half[k] - from[k]) / to[k];
    const double first = low < high ? low : high, last = low < high ? high : low;
    if (first > p.enter) p.enter = first, p.enter_face = 2 * k + (low < high ? 0 : 1);
    if (last < p.leave) p.leave = last, p.leave_face = 2 * k + (low < high ? 1 : 0);
  }
  return p;
}

/* ---- pictures as they should be ---------------------------------------------------------------------------------- */

/* The color that a ray should show. */
typedef unsigned (*Expectation)(Vector direction);

/* 1 and the color where a pixel shows the same all around its centre. */
static int is_certain(Expectation expected, int i, unsigned* color) {
  static const double at[4][2] = {{-0.02, -0.02}, {0.02, -0.02}, {-0.02, 0.02}, {0.02, 0.02}};
  const double x = i % WIDTH + 0.5, y = i / WIDTH + 0.5;
  int k;
  *color = expected(ray(x, y));
  for (k = 0; k < 4; ++k)
    if (expected(ray(x + at[k][0], y + at[k][1])) != *color) return 0;
  return 1;
}

/* Every certain pixel is as it should be, and nearly all are certain. */
static void expect_picture(const Picture* picture, Expectation expected, const char* what) {
  int i, wrong = 0, uncertain = 0, first = -1;
  unsigned color, first_color = 0;
  for (i = 0; i < PIXELS; ++i) {
    if (!is_certain(expected, i, &color)) {
      ++uncertain;
      continue;
    }
    if (picture->at[i] == color) continue;
    if (wrong++ == 0) first = i, first_color = color;
  }
  expect(wrong == 0, "%s: %d pixels are wrong, the first at %d, %d: %06x instead of %06x", what, wrong, first % WIDTH,
         first / WIDTH, first >= 0 ? picture->at[first] : 0, first_color);
  expect(uncertain < PIXELS / 20, "%s: %d pixels are too near to an edge to tell", what, uncertain);
}

/* How far a depth may be from that of the exact surface at a pixel: corners may be moved by half of 1/256 pixel each
 * way, which on a slant changes the depth, and it is rounded to 24 bits by way of floats. */
static double depth_slack(double (*distance)(Vector), double x, double y) {
  const double h = 1.0 / 256, here = window_depth(distance(ray(x, y)));
  const double across = fabs(window_depth(distance(ray(x + h, y))) - here),
               up = fabs(window_depth(distance(ray(x, y + h))) - here);
  return across + up + 3e-6;
}

#endif
