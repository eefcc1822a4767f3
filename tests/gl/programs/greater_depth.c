/* SPDX-License-Identifier: Apache-2.0 */
/* The depth buffer the other way round: a projection that sends the near plane to +1 and the far plane to -1, cleared to
 * 0, GL_GREATER. What is seen is the same. */
#include "program.h"

enum { GROUND = 0x101830, RED = 0xD04030, GREEN = 0x30B050 };
static Box red, green;

static double distance_of(Vector d, unsigned *color) {
  const Passage r = pass(&red, vector(0, 0, 0), d), g = pass(&green, vector(0, 0, 0), d);
  const double t_red = r.enter < r.leave ? r.enter : 1e30, t_green = g.enter < g.leave ? g.enter : 1e30;
  *color = t_red < t_green ? RED + (unsigned)r.enter_face : t_green < 1e30 ? GREEN + (unsigned)g.enter_face : GROUND;
  return t_red < t_green ? t_red : t_green;
}
static unsigned nearest(Vector d) { unsigned color; distance_of(d, &color); return color; }
static double nearest_distance(Vector d) { unsigned color; return distance_of(d, &color); }

static void draw(Picture *picture, float *depths) {
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  draw_box(&red);
  draw_box(&green);
  read_picture(picture);
  glReadPixels(0, 0, WIDTH, HEIGHT, GL_DEPTH_COMPONENT, GL_FLOAT, depths);
}

int main(void) {
  static Picture less, greater, none;
  static float less_depth[PIXELS], greater_depth[PIXELS], depth[PIXELS];
  const double n = view.near, f = view.far;
  double matrix[16] = {0}, worst = 0, worst_sum = 0;
  int i, seen = 0;
  GLint func;
  red = box(vector(-0.4, 0.1, -4.5), vector(0.8, 0.9, 0.7), 30, -25, RED);
  green = box(vector(0.5, -0.1, -5.5), vector(1.3, 0.8, 0.9), -20, 40, GREEN);
  for (i = 0; i < 6; ++i) red.color[i] += (unsigned)i, green.color[i] += (unsigned)i;
  open_window("greater_depth");
  look();
  glClearColor(0x10 / 255.0f, 0x18 / 255.0f, 0x30 / 255.0f, 1);
  glGetIntegerv(GL_DEPTH_FUNC, &func);
  expect(func == GL_LESS, "GL_LESS at first");
  glEnable(GL_DEPTH_TEST);
  draw(&less, less_depth);
  expect_picture(&less, nearest, "GL_LESS");

  /* Gortler's convention: z_clip = ((f + n) z + 2 f n) / (f - n) with w = -z: near to +1, far to -1. */
  matrix[0] = 2 * n / (view.right - view.left);
  matrix[5] = 2 * n / (view.top - view.bottom);
  matrix[10] = (f + n) / (f - n);
  matrix[14] = 2 * f * n / (f - n);
  matrix[11] = -1;
  glMatrixMode(GL_PROJECTION);
  glLoadMatrixd(matrix);
  glMatrixMode(GL_MODELVIEW);
  glDepthFunc(GL_GREATER);
  glClearDepth(0);
  draw(&greater, greater_depth);
  expect_picture(&greater, nearest, "GL_GREATER");

  for (i = 0; i < PIXELS; ++i) {
    unsigned color, around;
    const double t = distance_of(ray(i % WIDTH + 0.5, i / WIDTH + 0.5), &color);
    if (!is_certain(nearest, i, &around)) continue;
    if (color == GROUND) {
      expect(less_depth[i] == 1 && greater_depth[i] == 0, "where nothing is drawn the depth is what it was cleared to");
      continue;
    }
    ++seen;
    worst = fmax(worst, fabs(less_depth[i] - window_depth(t)) / depth_slack(nearest_distance, i % WIDTH + 0.5, i / WIDTH + 0.5));
    worst_sum = fmax(worst_sum, fabs(less_depth[i] + greater_depth[i] - 1.0));
  }
  expect(seen > 2000, "much is seen");
  expect(worst < 1, "depths are f (d - n) / (d (f - n)), but for %g of what rounding may do", worst);
  expect(worst_sum < 4e-6, "the two depths add up to 1, but for %g", worst_sum);
  printf("greater_depth: at most %g of what rounding may do; from adding up to 1 at most %g\n", worst, worst_sum);

  /* Half of the change is worse than none. */
  glClearDepth(1);
  draw(&none, depth);
  expect(count_of(&none, GROUND) == PIXELS, "GL_GREATER cleared to 1: nothing passes");
  glDepthFunc(GL_LESS);
  glClearDepth(0);
  draw(&none, depth);
  expect(count_of(&none, GROUND) == PIXELS, "GL_LESS cleared to 0: nothing passes");
  return close_window();
}
