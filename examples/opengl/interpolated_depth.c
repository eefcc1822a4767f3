/* SPDX-License-Identifier: Apache-2.0 */
/* Which depth may be interpolated over a triangle? A blue wall at z = -1 and an orange floor from z = -0.5 to
 * -1,000,000 cross in the middle of the window, so the upper half must be blue.
 *
 *   key c   near is +1, far is -1, and GL_GREATER passes: the right-handed convention of some textbooks
 *   key o   near is -1, far is +1, and GL_LESS passes: the convention of gluPerspective
 *   key z   interpolates z of the eye in place of -1 / z, which is wrong: hardly any floor is left
 *
 *   cc interpolated_depth.c -lglut -lGL -o interpolated_depth && frontmost gl ./interpolated_depth -o floor.png */
#include <GL/glut.h>

static const double n = -0.25, f = -2e6; /* both negative: places on the z axis, not distances */
static char convention = 'c';

/* Loads the frustum's matrix. Near becomes +1 and far -1, or the other way round where `sign` is -1. */
static void load_projection(double sign) {
  GLdouble m[16] = {0}; /* column by column */
  m[0] = m[5] = 1;
  m[10] = sign * (f + n) / (f - n);
  m[14] = sign * -2 * f * n / (f - n);
  m[11] = -1;
  glMatrixMode(GL_PROJECTION);
  glLoadMatrixd(m);
}

/* A corner at the window's place (x, y), and z of the eye. */
static void corner(double x, double y, double z) {
  if (convention == 'z')
    glVertex3d(x, y, z * 1e-6); /* no division by w: what lies between the corners is linear in z */
  else
    glVertex3d(-z * x, -z * y, z);
}

static void display(void) {
  const int is_greater = convention != 'o';
  if (convention == 'z') {
    glMatrixMode(GL_PROJECTION);
    glLoadIdentity();
  } else {
    load_projection(is_greater ? 1 : -1);
  }
  glDepthFunc(is_greater ? GL_GREATER : GL_LESS);
  glClearDepth(is_greater ? 0 : 1);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  glBegin(GL_QUADS);
  glColor3f(0.2f, 0.4f, 0.9f); /* the wall */
  corner(-0.8, -0.9, -1), corner(0.8, -0.9, -1), corner(0.8, 0.9, -1), corner(-0.8, 0.9, -1);
  glColor3f(1, 0.6f, 0.1f); /* the floor */
  corner(-0.6, -1, -0.5), corner(0.6, -1, -0.5), corner(0.6, 1, -1e6), corner(-0.6, 1, -1e6);
  glEnd();
  glutSwapBuffers();
}

static void keyboard(unsigned char key, int x, int y) {
  (void)x, (void)y;
  convention = (char)key;
  glutPostRedisplay();
}

int main(int argc, char** argv) {
  glutInit(&argc, argv);
  glutInitDisplayMode(GLUT_DOUBLE | GLUT_RGB | GLUT_DEPTH);
  glutInitWindowSize(240, 180);
  glutCreateWindow("interpolated depth");
  glutDisplayFunc(display), glutKeyboardFunc(keyboard);
  glClearColor(1, 1, 1, 1);
  glEnable(GL_DEPTH_TEST);
  glutMainLoop();
  return 0;
}
