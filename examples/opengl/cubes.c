/* SPDX-License-Identifier: Apache-2.0 */
/* Two cubes through each other. The lid of one is open, so that culling shows the inside.
 *
 *   key d   switches the depth test
 *   key c   switches culling
 *   key b   culls backs, key f fronts */
#include <GL/glut.h>

static void toggle(GLenum capability) {
  if (glIsEnabled(capability))
    glDisable(capability);
  else
    glEnable(capability);
}

/* A cube of half width 1, its faces counter-clockwise from outside. An open one has no top. */
static void cube(float red, float green, float blue, int is_open) {
  static const int faces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  static const float lights[6] = {0.5f, 0.85f, 0.4f, 1, 0.45f, 0.7f};
  int i, k;
  glBegin(GL_QUADS);
  for (i = 0; i < 6; ++i) {
    if (is_open && i == 3) continue;
    glColor3f(lights[i] * red, lights[i] * green, lights[i] * blue);
    for (k = 0; k < 4; ++k) {
      const int v = faces[i][k];
      glVertex3i((v & 1) ? 1 : -1, (v & 2) ? 1 : -1, (v & 4) ? 1 : -1);
    }
  }
  glEnd();
}

static void display(void) {
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  glLoadIdentity();
  gluLookAt(2.2, 4, 5.2, 0, 0, 0, 0, 1, 0);
  glPushMatrix();
  glTranslatef(0.6f, -0.2f, 0);
  cube(1, 0.65f, 0.2f, 0);
  glPopMatrix();
  glTranslatef(-0.7f, 0.3f, 0.3f);
  glRotatef(35, 0, 1, 0);
  cube(0.35f, 0.55f, 1, 1);
  glutSwapBuffers();
}

static void keyboard(unsigned char key, int x, int y) {
  (void)x, (void)y;
  if (key == 'd') toggle(GL_DEPTH_TEST);
  if (key == 'c') toggle(GL_CULL_FACE);
  if (key == 'b') glCullFace(GL_BACK);
  if (key == 'f') glCullFace(GL_FRONT);
  glutPostRedisplay();
}

static void reshape(int width, int height) {
  glViewport(0, 0, width, height);
  glMatrixMode(GL_PROJECTION);
  glLoadIdentity();
  gluPerspective(32, (double)width / height, 1, 20);
  glMatrixMode(GL_MODELVIEW);
}

int main(int argc, char** argv) {
  glutInit(&argc, argv);
  glutInitDisplayMode(GLUT_DOUBLE | GLUT_RGB | GLUT_DEPTH);
  glutInitWindowSize(240, 180);
  glutCreateWindow("cubes");
  glutDisplayFunc(display), glutReshapeFunc(reshape), glutKeyboardFunc(keyboard);
  glClearColor(1, 1, 1, 1);
  glEnable(GL_DEPTH_TEST);
  glutMainLoop();
  return 0;
}
