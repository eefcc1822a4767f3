/* SPDX-License-Identifier: Apache-2.0
 * OSMesa: OpenGL contexts that draw into memory of the program. libfrontmost-gl has these functions, with the ABI of
 * libOSMesa.so.8. The header is for programs on systems whose Mesa no longer has one.
 *
 *     const int wanted[] = {OSMESA_FORMAT, OSMESA_RGBA, OSMESA_DEPTH_BITS, 24, 0};
 *     OSMesaContext context = OSMesaCreateContextAttribs(wanted, NULL);
 *     OSMesaMakeCurrent(context, pixels, GL_UNSIGNED_BYTE, width, height);
 *     ... OpenGL ...
 *     glFinish();    now `pixels` has the picture, its bottom row first
 */
#ifndef OSMESA_H
#define OSMESA_H

#include <GL/gl.h>

#ifdef __cplusplus
extern "C" {
#endif

#define OSMESA_MAJOR_VERSION 11
#define OSMESA_MINOR_VERSION 2
#define OSMESA_PATCH_VERSION 0

/* Formats of pixels: the order of a pixel's bytes in memory; in 565, of its bits. */
#define OSMESA_COLOR_INDEX GL_COLOR_INDEX /* no context has it */
#define OSMESA_RGBA GL_RGBA
#define OSMESA_BGRA 0x1
#define OSMESA_ARGB 0x2
#define OSMESA_RGB GL_RGB
#define OSMESA_BGR 0x4
#define OSMESA_RGB_565 0x5

/* OSMesaPixelStore */
#define OSMESA_ROW_LENGTH 0x10 /* pixels from one row to the next; 0 for the width */
#define OSMESA_Y_UP 0x11       /* whether the bottom row comes first, as it does by default */

/* OSMesaGetIntegerv */
#define OSMESA_WIDTH 0x20
#define OSMESA_HEIGHT 0x21
#define OSMESA_FORMAT 0x22
#define OSMESA_TYPE 0x23
#define OSMESA_MAX_WIDTH 0x24
#define OSMESA_MAX_HEIGHT 0x25

/* OSMesaCreateContextAttribs: pairs of a name, OSMESA_FORMAT or one of these, and a value; 0 ends them. */
#define OSMESA_DEPTH_BITS 0x30
#define OSMESA_STENCIL_BITS 0x31
#define OSMESA_ACCUM_BITS 0x32
#define OSMESA_PROFILE 0x33
#define OSMESA_CORE_PROFILE 0x34 /* no context has it */
#define OSMESA_COMPAT_PROFILE 0x35
#define OSMESA_CONTEXT_MAJOR_VERSION 0x36
#define OSMESA_CONTEXT_MINOR_VERSION 0x37

typedef struct osmesa_context* OSMesaContext;
typedef void (*OSMESAproc)(void);

/* Return NULL for what is not supported. `shares_with` may be NULL; else both have the same textures and lists. */
OSMesaContext OSMesaCreateContext(GLenum format, OSMesaContext shares_with);
OSMesaContext OSMesaCreateContextExt(GLenum format, GLint depth_bits, GLint stencil_bits, GLint accum_bits,
                                     OSMesaContext shares_with);
OSMesaContext OSMesaCreateContextAttribs(const int* attributes, OSMesaContext shares_with);
void OSMesaDestroyContext(OSMesaContext context);

/* Makes a context the calling thread's, with `buffer` for its picture. `type` is GL_UNSIGNED_BYTE, or
 * GL_UNSIGNED_SHORT_5_6_5 with OSMESA_RGB_565. Context and buffer NULL: the thread has none. */
GLboolean OSMesaMakeCurrent(OSMesaContext context, void* buffer, GLenum type, GLsizei width, GLsizei height);
OSMesaContext OSMesaGetCurrentContext(void);

/* Of the current context. */
void OSMesaPixelStore(GLint name, GLint value);
void OSMesaGetIntegerv(GLint name, GLint* value);
void OSMesaColorClamp(GLboolean enable);

/* The planes of a context, bottom row first; they stay the context's own. */
GLboolean OSMesaGetDepthBuffer(OSMesaContext context, GLint* width, GLint* height, GLint* bytes_per_value,
                               void** buffer);
GLboolean OSMesaGetColorBuffer(OSMesaContext context, GLint* width, GLint* height, GLint* format, void** buffer);

/* Returns NULL for a name that is no function of the library. */
OSMESAproc OSMesaGetProcAddress(const char* name);
void OSMesaPostprocess(OSMesaContext context, const char* filter, unsigned enable_value);

#ifdef __cplusplus
}
#endif

#endif
