/* SPDX-License-Identifier: Apache-2.0 */
/* Three bars, each over the next. The painter's algorithm draws the farthest first, but none of the three is; whichever
 * comes last is seen whole. The depth test needs no order.
 *
 *   keys 1, 2, 3   which bar is drawn last
 *   key d          switches the depth test */
#include <GL/glut.h>

static int last = 2;

/* Bar `i` lies below the others at its start and above at its end. */
static void bar(int i) {
  static const float colors[3][3] = {{0.85f, 0.25f, 0.2f}, {0.25f, 0.65f, 0.3f}, {0.2f, 0.4f, 0.85f}};
  glPushMatrix();
  glRotatef(120.0f * (float)i, 0, 0, 1);
  glColor3fv(colors[i]);
  glBegin(GL_QUADS);
  glVertex3d(-0.85, -0.55, -0.5), glVertex3d(0.85, -0.55, 0.5), glVertex3d(0.85, -0.2, 0.5),
      glVertex3d(-0.85, -0.2, -0.5);
  glEnd();
  glPopMatrix();
}

static void display(void) {
  int i;
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  for (i = 1; i <= 3; ++i) bar((last + i) % 3);
  glutSwapBuffers();
}

static void keyboard(unsigned char key, int x, int y) {
  (void)x, (void)y;
  if (key >= '1' && key <= '3') last = key - '1';
  if (key == 'd') {
    if (glIsEnabled(GL_DEPTH_TEST))
      glDisable(GL_DEPTH_TEST);
    else
      glEnable(GL_DEPTH_TEST);
  }
  glutPostRedisplay();
}

static void reshape(int width, int height) {
  glViewport(0, 0, width, height);
  glMatrixMode(GL_PROJECTION);
  glLoadIdentity();
  glOrtho(-1.1 * width / height, 1.1 * width / height, -1.1, 1.1, -1, 1);
  glMatrixMode(GL_MODELVIEW);
}

int main(int argc, char** argv) {
  glutInit(&argc, argv);
  glutInitDisplayMode(GLUT_DOUBLE | GLUT_RGB | GLUT_DEPTH);
  glutInitWindowSize(240, 180);
  glutCreateWindow("painter");
  glutDisplayFunc(display), glutReshapeFunc(reshape), glutKeyboardFunc(keyboard);
  glClearColor(1, 1, 1, 1);
  glutMainLoop();
  return 0;
}
