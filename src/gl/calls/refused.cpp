// SPDX-License-Identifier: Apache-2.0
// Calls of OpenGL 1.5 that do nothing but record GL_INVALID_OPERATION, and calls that have no effect by the standard
// while GL_RENDER is the only mode.

#include "calls/call.h"

namespace frontmost::gl_detail {

#define REFUSED(name, parameters)                               \
  FRONTMOST_GL void name parameters {                           \
    if (Context* const c = current_context()) c->refuse(#name); \
  }

// Accumulation, selection and feedback.
REFUSED(glAccum, (GLenum, GLfloat))
REFUSED(glFeedbackBuffer, (GLsizei, GLenum, GLfloat*))
REFUSED(glSelectBuffer, (GLsizei, GLuint*))
FRONTMOST_GL void glInitNames() {}
FRONTMOST_GL void glLoadName(GLuint) {}
FRONTMOST_GL void glPushName(GLuint) {}
FRONTMOST_GL void glPopName() {}
FRONTMOST_GL void glPassThrough(GLfloat) {}

// Textures of three dimensions and compressed ones.
REFUSED(glTexImage3D, (GLenum, GLint, GLint, GLsizei, GLsizei, GLsizei, GLint, GLenum, GLenum, const void*))
REFUSED(glTexSubImage3D, (GLenum, GLint, GLint, GLint, GLint, GLsizei, GLsizei, GLsizei, GLenum, GLenum, const void*))
REFUSED(glCopyTexSubImage3D, (GLenum, GLint, GLint, GLint, GLint, GLint, GLint, GLsizei, GLsizei))
REFUSED(glCompressedTexImage1D, (GLenum, GLint, GLenum, GLsizei, GLint, GLsizei, const void*))
REFUSED(glCompressedTexImage2D, (GLenum, GLint, GLenum, GLsizei, GLsizei, GLint, GLsizei, const void*))
REFUSED(glCompressedTexImage3D, (GLenum, GLint, GLenum, GLsizei, GLsizei, GLsizei, GLint, GLsizei, const void*))
REFUSED(glCompressedTexSubImage1D, (GLenum, GLint, GLint, GLsizei, GLenum, GLsizei, const void*))
REFUSED(glCompressedTexSubImage2D, (GLenum, GLint, GLint, GLint, GLsizei, GLsizei, GLenum, GLsizei, const void*))
REFUSED(glCompressedTexSubImage3D,
        (GLenum, GLint, GLint, GLint, GLint, GLsizei, GLsizei, GLsizei, GLenum, GLsizei, const void*))
REFUSED(glGetCompressedTexImage, (GLenum, GLint, void*))
FRONTMOST_GL_ALIAS(glTexImage3DEXT, glTexImage3D);
FRONTMOST_GL_ALIAS(glTexSubImage3DEXT, glTexSubImage3D);
FRONTMOST_GL_ALIAS(glCopyTexSubImage3DEXT, glCopyTexSubImage3D);

// The imaging subset.
#define PARAMETERS(name)                              \
  REFUSED(name##fv, (GLenum, GLenum, const GLfloat*)) \
  REFUSED(name##iv, (GLenum, GLenum, const GLint*))
#define ASKED_PARAMETERS(name)                  \
  REFUSED(name##fv, (GLenum, GLenum, GLfloat*)) \
  REFUSED(name##iv, (GLenum, GLenum, GLint*))
REFUSED(glColorTable, (GLenum, GLenum, GLsizei, GLenum, GLenum, const void*))
REFUSED(glColorSubTable, (GLenum, GLsizei, GLsizei, GLenum, GLenum, const void*))
REFUSED(glCopyColorTable, (GLenum, GLenum, GLint, GLint, GLsizei))
REFUSED(glCopyColorSubTable, (GLenum, GLsizei, GLint, GLint, GLsizei))
REFUSED(glGetColorTable, (GLenum, GLenum, GLenum, void*))
PARAMETERS(glColorTableParameter)
ASKED_PARAMETERS(glGetColorTableParameter)
REFUSED(glConvolutionFilter1D, (GLenum, GLenum, GLsizei, GLenum, GLenum, const void*))
REFUSED(glConvolutionFilter2D, (GLenum, GLenum, GLsizei, GLsizei, GLenum, GLenum, const void*))
REFUSED(glConvolutionParameterf, (GLenum, GLenum, GLfloat))
REFUSED(glConvolutionParameteri, (GLenum, GLenum, GLint))
PARAMETERS(glConvolutionParameter)
ASKED_PARAMETERS(glGetConvolutionParameter)
REFUSED(glCopyConvolutionFilter1D, (GLenum, GLenum, GLint, GLint, GLsizei))
REFUSED(glCopyConvolutionFilter2D, (GLenum, GLenum, GLint, GLint, GLsizei, GLsizei))
REFUSED(glGetConvolutionFilter, (GLenum, GLenum, GLenum, void*))
REFUSED(glSeparableFilter2D, (GLenum, GLenum, GLsizei, GLsizei, GLenum, GLenum, const void*, const void*))
REFUSED(glGetSeparableFilter, (GLenum, GLenum, GLenum, void*, void*, void*))
REFUSED(glHistogram, (GLenum, GLsizei, GLenum, GLboolean))
REFUSED(glResetHistogram, (GLenum))
REFUSED(glGetHistogram, (GLenum, GLboolean, GLenum, GLenum, void*))
ASKED_PARAMETERS(glGetHistogramParameter)
REFUSED(glMinmax, (GLenum, GLenum, GLboolean))
REFUSED(glResetMinmax, (GLenum))
REFUSED(glGetMinmax, (GLenum, GLboolean, GLenum, GLenum, void*))
ASKED_PARAMETERS(glGetMinmaxParameter)

}  // namespace frontmost::gl_detail
