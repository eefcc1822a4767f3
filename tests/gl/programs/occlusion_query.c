/* SPDX-License-Identifier: Apache-2.0 */
/* How many samples pass: the question that culls hidden objects. */
#include "program.h"

enum { GROUND = 0, WALL = 0x707070, BEHIND = 0xF02020, BESIDE = 0x20F020, PART = 0x2020F0 };
static Box wall, behind, beside, part;

static double enter(const Box *b, Vector d) { const Passage p = pass(b, vector(0, 0, 0), d); return p.enter < p.leave ? p.enter : 1e30; }
static unsigned seen_part(Vector d) { const double w = enter(&wall, d), p = enter(&part, d); return p < w ? PART : w < 1e29 ? WALL : GROUND; }
static unsigned any_part(Vector d) { return enter(&part, d) < 1e29 ? PART : GROUND; }

/* How many pixels should pass, from those that are certain to those that may. */
static void count(Expectation expected, unsigned color, unsigned *least, unsigned *most) {
  unsigned c;
  int i;
  *least = *most = 0;
  for (i = 0; i < PIXELS; ++i) {
    if (is_certain(expected, i, &c)) { if (c == color) ++*least, ++*most; }
    else ++*most;
  }
}

static unsigned ask(const Box *b, GLuint query) {
  GLuint available = 0, samples = 0;
  glBeginQuery(GL_SAMPLES_PASSED, query);
  draw_box(b);
  glEndQuery(GL_SAMPLES_PASSED);
  glGetQueryObjectuiv(query, GL_QUERY_RESULT_AVAILABLE, &available);
  glGetQueryObjectuiv(query, GL_QUERY_RESULT, &samples); /* waits */
  return samples;
}

int main(void) {
  static Picture before, after;
  GLuint query;
  unsigned samples, least, most, drawn;
  wall = box(vector(0, 0, -4), vector(1.1, 0.8, 0.05), 0, 0, WALL);
  behind = box(vector(0.1, 0, -6), vector(0.5, 0.5, 0.5), 30, 20, BEHIND);
  beside = box(vector(2.2, 0.3, -6), vector(0.4, 0.4, 0.4), 30, 20, BESIDE);
  part = box(vector(-1.5, 0.2, -6), vector(0.7, 0.6, 0.5), 15, 25, PART);
  open_window("occlusion_query");
  look();
  glEnable(GL_DEPTH_TEST);
  glEnable(GL_CULL_FACE);
  glGenQueries(1, &query);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  draw_box(&wall);
  read_picture(&before);

  /* Asked with the masks off, nothing changes. */
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  glDepthMask(GL_FALSE);
  expect(ask(&behind, query) == 0, "what the wall hides passes nowhere");
  samples = ask(&part, query);
  count(seen_part, PART, &least, &most);
  expect(samples >= least && samples <= most, "beside the wall %u to %u samples pass, not %u", least, most, samples);
  expect(ask(&part, query) == samples, "asked again the same, for no depth was stored");
  read_picture(&after);
  expect(differing(&before, &after) == 0, "masked draws change nothing");

  /* What is drawn then are those samples. */
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glDepthMask(GL_TRUE);
  drawn = ask(&part, query);
  read_picture(&after);
  expect(drawn == samples, "drawn as well as asked: the same number, %u not %u", drawn, samples);
  expect((unsigned)count_of(&after, PART) == samples, "as many pixels have changed: %d, not %u", count_of(&after, PART), samples);
  expect(ask(&part, query) == 0, "a second time GL_LESS lets none of them pass");
  expect(ask(&beside, query) > 200, "what nothing hides passes");

  /* Without the depth test all covered samples pass; culled faces give none. */
  glDisable(GL_DEPTH_TEST);
  samples = ask(&part, query);
  count(any_part, PART, &least, &most);
  expect(samples >= least && samples <= most, "without the depth test %u to %u, not %u", least, most, samples);
  glCullFace(GL_FRONT_AND_BACK);
  expect(ask(&part, query) == 0, "culled faces have no samples");
  return close_window();
}
