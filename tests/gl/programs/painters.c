/* SPDX-License-Identifier: Apache-2.0 */
/* The painter's algorithm: from far to near, without a depth buffer. Right for what can be put in order; three triangles
 * that each cover the next cannot. */
#include "program.h"

enum { GROUND = 0x181818, COLORS = 6 };
static const unsigned color_of[COLORS] = {0xC03030, 0x30A040, 0x3050C0, 0xB09020, 0x9030A0, 0x20A0A0};

typedef struct { Vector corner[3]; unsigned color; } Triangle;
static Triangle triangles[COLORS];
static int triangle_count;

/* Distance along the ray, or a huge number. */
static double hit(const Triangle *t, Vector d) {
  const Vector a = t->corner[0], b = t->corner[1], c = t->corner[2];
  const Vector u = vector(b.x - a.x, b.y - a.y, b.z - a.z), v = vector(c.x - a.x, c.y - a.y, c.z - a.z);
  const Vector n = vector(u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x);
  const double along_n = n.x * d.x + n.y * d.y + n.z * d.z, s = (n.x * a.x + n.y * a.y + n.z * a.z) / along_n;
  const Vector p = along(vector(0, 0, 0), s, d);
  int k;
  for (k = 0; k < 3; ++k) {
    const Vector e = t->corner[k], f = t->corner[(k + 1) % 3];
    const Vector g = vector(f.x - e.x, f.y - e.y, f.z - e.z), h = vector(p.x - e.x, p.y - e.y, p.z - e.z);
    if (n.x * (g.y * h.z - g.z * h.y) + n.y * (g.z * h.x - g.x * h.z) + n.z * (g.x * h.y - g.y * h.x) < 0) return 1e30;
  }
  return s;
}
static unsigned nearest(Vector d) {
  double best = 1e29;
  unsigned color = GROUND;
  int i;
  for (i = 0; i < triangle_count; ++i) {
    const double s = hit(&triangles[i], d);
    if (s < best) best = s, color = triangles[i].color;
  }
  return color;
}

static void draw(Picture *picture, const int *order) {
  int i, k;
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  glBegin(GL_TRIANGLES);
  for (i = 0; i < triangle_count; ++i) {
    const Triangle *t = &triangles[order[i]];
    set_color(t->color);
    for (k = 0; k < 3; ++k) glVertex3d(t->corner[k].x, t->corner[k].y, t->corner[k].z);
  }
  glEnd();
  read_picture(picture);
}

int main(void) {
  static const int far_to_near[COLORS] = {0, 1, 2, 3, 4, 5}, near_to_far[COLORS] = {5, 4, 3, 2, 1, 0}, shuffled[COLORS] = {3, 0, 5, 1, 4, 2};
  static const int orders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  static Picture picture, tested;
  int i, k, wrong;
  open_window("painters");
  look();
  glClearColor(0x18 / 255.0f, 0x18 / 255.0f, 0x18 / 255.0f, 1);

  /* Six triangles in layers of their own, tilted so that each reaches through its layer. */
  triangle_count = COLORS;
  for (i = 0; i < COLORS; ++i) {
    const double z = -9 + i, a = 0.9 * i;
    for (k = 0; k < 3; ++k) {
      const double b = a + k * 2.0943951;
      triangles[i].corner[k] = vector(1.9 * cos(b) + 0.3 * sin(5 * a), 1.5 * sin(b) + 0.3 * cos(3 * a), z + 0.3 * cos(b + 1));
    }
    triangles[i].color = color_of[i];
  }
  draw(&picture, far_to_near);
  expect_picture(&picture, nearest, "from far to near, no depth test");
  glEnable(GL_DEPTH_TEST);
  draw(&tested, near_to_far);
  expect(differing(&picture, &tested) == 0, "from near to far with the depth test: the same picture, not other in %d pixels", differing(&picture, &tested));
  draw(&tested, shuffled);
  expect(differing(&picture, &tested) == 0, "in any order with the depth test");
  glDisable(GL_DEPTH_TEST);
  draw(&tested, near_to_far);
  expect(differing(&picture, &tested) > 2000, "from near to far without it, much is wrong");

  /* A cycle: each triangle has a near and a far end, and covers the next one's far end. */
  triangle_count = 3;
  for (i = 0; i < 3; ++i) {
    const double a = i * 2.0943951, c = cos(a), s = sin(a);
    const double x[3] = {-1.3, 2.1, -1.3}, y[3] = {-0.9, -0.45, 0}, z[3] = {-7, -5, -7};
    for (k = 0; k < 3; ++k) triangles[i].corner[k] = vector(c * x[k] - s * y[k], s * x[k] + c * y[k], z[k]);
    triangles[i].color = color_of[i];
  }
  for (i = 0; i < 6; ++i) {
    glDisable(GL_DEPTH_TEST);
    draw(&picture, orders[i]);
    glEnable(GL_DEPTH_TEST);
    draw(&tested, orders[i]);
    expect_picture(&tested, nearest, "a cycle with the depth test, in every order");
    wrong = differing(&picture, &tested);
    expect(wrong > 100, "a cycle without the depth test: no order is right, yet %d %d %d is", orders[i][0], orders[i][1], orders[i][2]);
    printf("painters: order %d %d %d: %d pixels wrong\n", orders[i][0], orders[i][1], orders[i][2], wrong);
  }
  return close_window();
}
