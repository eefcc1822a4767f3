/* SPDX-License-Identifier: Apache-2.0 */
/* Questions to libfrontmost-gl that OpenGL has no calls for: which draw is seen at a pixel, and why.
 *
 * A C header. Each function asks the current context of the calling thread, and does nothing without one. A *draw* is a
 * glBegin, or a call such as glDrawArrays; draws are counted from 0 since the colors were cleared. A *primitive* is one
 * point, line, triangle, quad or polygon, counted within its draw. */
#ifndef FRONTMOST_GL_H
#define FRONTMOST_GL_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The number of a draw and of a primitive where nothing is seen. */
#define FRONTMOST_NO_PRIMITIVE 0xFFFFFFFFu

/* Keeps all draws from now on until glClear clears the colors, or stops doing so if `keep` is 0. Kept draws need some
 * 100 bytes a vertex. The functions below answer from kept draws only. */
void frontmostKeepDraws(int keep);

/* Writes the draw and the primitive that each pixel of a rectangle shows, rows from the bottom, to arrays of width *
 * height numbers; either may be null. Pixels outside of the frame, and pixels where nothing is seen, have
 * FRONTMOST_NO_PRIMITIVE. A primitive is seen if it passed all tests last, and may write colors. O(pixels). */
void frontmostGetVisible(int x, int y, int width, int height, unsigned* draws, unsigned* primitives);

/* Tells every fragment that came to a pixel since the colors were cleared, in the order of submission, a line each: its
 * draw and primitive, and what became of it: culled, clipped, scissored, failed by a test with the values compared, or
 * drawn. Writes at most `size` characters with the closing 0. \returns the length of the whole text.
 * Triangles that are clipped are told only if all their vertices are before the eye. O(kept triangles). */
size_t frontmostExplain(int x, int y, char* text, size_t size);

#ifdef __cplusplus
}
#endif

#endif
