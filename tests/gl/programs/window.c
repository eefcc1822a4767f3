/* SPDX-License-Identifier: Apache-2.0 */
/* A program with a window, in the manner of GLUT's examples: a lit teapot that turns; "a" adds an axis, the left button
 * stops. Declares the few calls of GLUT that it uses, so that it is compiled without GLUT's headers. */
#include <GL/gl.h>
#include <stdio.h>
#include <string.h>

enum { GLUT_DOUBLE = 2, GLUT_DEPTH = 16, GLUT_ELAPSED_TIME = 700, GLUT_DOWN = 0 };
void glutInit(int *argc, char **argv);
void glutInitDisplayMode(unsigned mode);
void glutInitWindowSize(int width, int height);
int glutCreateWindow(const char *title);
void glutDisplayFunc(void (*callback)(void));
void glutReshapeFunc(void (*callback)(int width, int height));
void glutKeyboardFunc(void (*callback)(unsigned char key, int x, int y));
void glutMouseFunc(void (*callback)(int button, int state, int x, int y));
void glutIdleFunc(void (*callback)(void));
void glutPostRedisplay(void);
void glutSwapBuffers(void);
void glutSolidTeapot(double size);
int glutGet(GLenum query);
void glutMainLoop(void);

static double angle;
static int has_axis;

static void display(void) {
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  glLoadIdentity();
  glTranslated(0, 0, -4);
  glRotated(20, 1, 0, 0);
  glRotated(angle, 0, 1, 0);
  glutSolidTeapot(1);
  if (has_axis) {
    glDisable(GL_LIGHTING);
    glBegin(GL_LINES);
    glVertex3d(0, -1.4, 0), glVertex3d(0, 1.4, 0);
    glEnd();
    glEnable(GL_LIGHTING);
  }
  glutSwapBuffers();
}
static void reshape(int width, int height) {
  glViewport(0, 0, width, height);
  glMatrixMode(GL_PROJECTION);
  glLoadIdentity();
  glFrustum(-0.5 * width / height, 0.5 * width / height, -0.5, 0.5, 1, 10);
  glMatrixMode(GL_MODELVIEW);
}
static void idle(void) {
  angle = glutGet(GLUT_ELAPSED_TIME) * 0.06;
  glutPostRedisplay();
}
static void keyboard(unsigned char key, int x, int y) {
  (void)x, (void)y;
  has_axis |= key == 'a';
  glutPostRedisplay();
}
static void mouse(int button, int state, int x, int y) {
  (void)button, (void)x, (void)y;
  if (state == GLUT_DOWN) glutIdleFunc(NULL);
}

int main(int argc, char **argv) {
  int i;
  glutInit(&argc, argv);
  for (i = 1; i < argc; ++i) printf("argument %s\n", argv[i]);
  glutInitDisplayMode(GLUT_DOUBLE | GLUT_DEPTH);
  glutInitWindowSize(320, 240);
  glutCreateWindow("teapot");
  glutDisplayFunc(display), glutReshapeFunc(reshape), glutIdleFunc(idle);
  glutKeyboardFunc(keyboard), glutMouseFunc(mouse);
  glEnable(GL_DEPTH_TEST), glEnable(GL_LIGHTING), glEnable(GL_LIGHT0), glEnable(GL_NORMALIZE);
  glutMainLoop();
  return 0;
}
