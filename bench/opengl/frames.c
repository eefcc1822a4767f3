/* SPDX-License-Identifier: Apache-2.0 */
/* Frames of OpenGL 1.x at 1920 x 1080, by whichever library the program is run with.
 *
 *   frames [REPETITIONS]   prints for each frame its name, and the least milliseconds of processor time and on the
 * clock */
#define _POSIX_C_SOURCE 200809L
#define GL_GLEXT_PROTOTYPES
#include <GL/osmesa.h>
/* OpenGL's extensions come after OpenGL. */
#include <GL/glext.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { WIDTH = 1920, HEIGHT = 1080, ROWS = 500, COLUMNS = 1000, VERTICES = (ROWS + 1) * (COLUMNS + 1) };

static unsigned char pixels[4 * WIDTH * HEIGHT];
static float normals[VERTICES][3], texcoords[VERTICES][2];
static unsigned indices[6 * ROWS * COLUMNS];
static GLuint buffers[3], list;

/* A sphere of radius 1, whose normals are its positions. */
static void make_sphere(void) {
  const double pi = 3.14159265358979;
  int row, column;
  unsigned n = 0;
  for (row = 0; row <= ROWS; ++row)
    for (column = 0; column <= COLUMNS; ++column) {
      const double around = 2 * pi * column / COLUMNS, up = pi * (row / (double)ROWS - 0.5);
      const int i = row * (COLUMNS + 1) + column;
      normals[i][0] = (float)(cos(around) * cos(up));
      normals[i][1] = (float)sin(up);
      normals[i][2] = (float)(-sin(around) * cos(up));
      texcoords[i][0] = 8.0f * (float)column / COLUMNS;
      texcoords[i][1] = 4.0f * (float)row / ROWS;
    }
  for (row = 0; row < ROWS; ++row)
    for (column = 0; column < COLUMNS; ++column) {
      const unsigned a = (unsigned)(row * (COLUMNS + 1) + column), b = a + COLUMNS + 1;
      indices[n++] = a, indices[n++] = a + 1, indices[n++] = b + 1;
      indices[n++] = a, indices[n++] = b + 1, indices[n++] = b;
    }
  glGenBuffers(3, buffers);
  glBindBuffer(GL_ARRAY_BUFFER, buffers[0]);
  glBufferData(GL_ARRAY_BUFFER, sizeof normals, normals, GL_STATIC_DRAW);
  glVertexPointer(3, GL_FLOAT, 0, NULL);
  glNormalPointer(GL_FLOAT, 0, NULL);
  glBindBuffer(GL_ARRAY_BUFFER, buffers[1]);
  glBufferData(GL_ARRAY_BUFFER, sizeof texcoords, texcoords, GL_STATIC_DRAW);
  glTexCoordPointer(2, GL_FLOAT, 0, NULL);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers[2]);
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, sizeof indices, indices, GL_STATIC_DRAW);
}

static void make_texture(void) {
  enum { SIZE = 256 };
  static unsigned char texels[SIZE * SIZE][4];
  unsigned noise = 1;
  int level, i;
  for (i = 0; i < SIZE * SIZE; ++i) {
    noise = noise * 1664525u + 1013904223u;
    texels[i][0] = (unsigned char)(noise >> 24), texels[i][1] = (unsigned char)(i / SIZE);
    texels[i][2] = (unsigned char)(i % SIZE), texels[i][3] = 128;
  }
  for (level = 0; SIZE >> level > 0; ++level)
    glTexImage2D(GL_TEXTURE_2D, level, GL_RGBA, SIZE >> level, SIZE >> level, 0, GL_RGBA, GL_UNSIGNED_BYTE, texels);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
}

static void sphere(void) {
  glEnable(GL_LIGHTING);
  glEnableClientState(GL_VERTEX_ARRAY);
  glEnableClientState(GL_NORMAL_ARRAY);
  glDrawElements(GL_TRIANGLES, 6 * ROWS * COLUMNS, GL_UNSIGNED_INT, NULL);
}
static void textured_sphere(void) {
  glEnable(GL_TEXTURE_2D);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  glEnableClientState(GL_TEXTURE_COORD_ARRAY);
  sphere();
  glDisableClientState(GL_TEXTURE_COORD_ARRAY);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
}
static void strips(void) {
  int row, column;
  glEnable(GL_LIGHTING);
  for (row = 0; row < ROWS; ++row) {
    glBegin(GL_TRIANGLE_STRIP);
    for (column = 0; column <= COLUMNS; ++column) {
      const int i = row * (COLUMNS + 1) + column, above = i + COLUMNS + 1;
      glNormal3fv(normals[above]), glVertex3fv(normals[above]);
      glNormal3fv(normals[i]), glVertex3fv(normals[i]);
    }
    glEnd();
  }
}
static void triangles(void) {
  unsigned i;
  glEnable(GL_LIGHTING);
  glBegin(GL_TRIANGLES);
  for (i = 0; i < sizeof indices / sizeof *indices; ++i) {
    const float* v = normals[indices[i]];
    glNormal3f(v[0], v[1], v[2]), glVertex3f(v[0], v[1], v[2]);
  }
  glEnd();
}
static void display_list(void) {
  glEnable(GL_LIGHTING);
  glCallList(list);
}

/* Forty rectangles of half the window's width and height. */
static void rectangles(void) {
  int i;
  glEnable(GL_TEXTURE_2D);
  glLoadIdentity();
  for (i = 0; i < 40; ++i) {
    const float x = -1 + 0.025f * (float)i, y = -1 + 0.02f * (float)i, z = 0.9f - 0.04f * (float)i;
    glBegin(GL_QUADS);
    glTexCoord2f(0, 0), glVertex3f(x, y, z);
    glTexCoord2f(4, 0.5f), glVertex3f(x + 1, y, z);
    glTexCoord2f(4.5f, 3), glVertex3f(x + 1, y + 1, z);
    glTexCoord2f(0.2f, 2.5f), glVertex3f(x, y + 1, z);
    glEnd();
  }
}
static void flat_matrices(void) {
  glMatrixMode(GL_PROJECTION), glPushMatrix(), glLoadIdentity();
  glMatrixMode(GL_MODELVIEW), glPushMatrix();
}
static void old_matrices(void) {
  glMatrixMode(GL_PROJECTION), glPopMatrix();
  glMatrixMode(GL_MODELVIEW), glPopMatrix();
}
static void textured_rectangles(void) {
  flat_matrices();
  rectangles();
  old_matrices();
}
static void blended_rectangles(void) {
  flat_matrices();
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  rectangles();
  old_matrices();
}
static void nothing(void) {}
static void read_back(void) { glReadPixels(0, 0, WIDTH, HEIGHT, GL_RGBA, GL_UNSIGNED_BYTE, pixels); }

static double milliseconds(clockid_t clock) {
  struct timespec t;
  clock_gettime(clock, &t);
  return (double)t.tv_sec * 1e3 + (double)t.tv_nsec * 1e-6;
}

static void measure(const char* name, void (*draw)(void), int repetitions, int is_cleared) {
  double least = 1e30, least_wall = 1e30;
  int i;
  for (i = 0; i < repetitions; ++i) {
    double begin, wall;
    glPushAttrib(GL_ENABLE_BIT);
    glFinish();
    begin = milliseconds(CLOCK_PROCESS_CPUTIME_ID), wall = milliseconds(CLOCK_MONOTONIC);
    if (is_cleared) glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    draw();
    glFinish();
    least = fmin(least, milliseconds(CLOCK_PROCESS_CPUTIME_ID) - begin);
    least_wall = fmin(least_wall, milliseconds(CLOCK_MONOTONIC) - wall);
    glPopAttrib();
  }
  printf("%s\t%.2f\t%.2f\n", name, least, least_wall);
}

int main(int argc, char** argv) {
  const int repetitions = argc > 1 ? atoi(argv[1]) : 10;
  const OSMesaContext context = OSMesaCreateContextExt(OSMESA_RGBA, 24, 8, 0, NULL);
  if (!context || !OSMesaMakeCurrent(context, pixels, GL_UNSIGNED_BYTE, WIDTH, HEIGHT)) return 1;
  fprintf(stderr, "%s, %s\n", (const char*)glGetString(GL_RENDERER), (const char*)glGetString(GL_VERSION));
  glEnable(GL_DEPTH_TEST), glEnable(GL_LIGHT0);
  glMatrixMode(GL_PROJECTION);
  glFrustum(-0.16, 0.16, -0.09, 0.09, 0.25, 10);
  glMatrixMode(GL_MODELVIEW);
  glTranslatef(0, 0, -3);
  glRotatef(25, 1, 0.3f, 0);
  make_sphere();
  make_texture();
  list = glGenLists(1);
  glNewList(list, GL_COMPILE);
  strips();
  glEndList();
  measure("sphere, a million triangles from buffers, lit", sphere, repetitions, 1);
  measure("the same, with a texture", textured_sphere, repetitions, 1);
  measure("the same as strips, glVertex3fv", strips, repetitions, 1);
  measure("the same as triangles, 3 million glVertex3f", triangles, repetitions, 1);
  measure("the strips as display list", display_list, repetitions, 1);
  measure("40 textured rectangles", textured_rectangles, repetitions, 1);
  measure("40 blended rectangles", blended_rectangles, repetitions, 1);
  measure("glClear", nothing, 5 * repetitions, 1);
  measure("glReadPixels", read_back, 5 * repetitions, 0);
  if (glGetError() != GL_NO_ERROR) return 1;
  OSMesaDestroyContext(context);
  return 0;
}
