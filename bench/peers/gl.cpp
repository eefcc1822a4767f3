// SPDX-License-Identifier: Apache-2.0
#include "peers/gl.h"

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <cstdlib>

namespace frontmost::bench {

void fail_gl(const std::string& what) { throw Error(ErrorCode::unsupported, "llvmpipe: " + what); }

void ensure_gl_context(int threads) {
  static bool done = false;
  if (done) return;
  // With 0, llvmpipe draws on the calling thread.
  setenv("LP_NUM_THREADS", std::to_string(threads == 1 ? 0 : threads).c_str(), 1);
  setenv("GALLIUM_DRIVER", "llvmpipe", 1);
  setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
  const auto get_display =
      reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(eglGetProcAddress("eglGetPlatformDisplayEXT"));
  if (!get_display) fail_gl("EGL has no platform displays");
  const EGLDisplay display = get_display(EGL_PLATFORM_SURFACELESS_MESA, nullptr, nullptr);
  if (!eglInitialize(display, nullptr, nullptr)) fail_gl("EGL does not start");
  eglBindAPI(EGL_OPENGL_API);
  const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_CONTEXT_MINOR_VERSION, 3, EGL_NONE};
  const EGLContext context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes);
  if (context == EGL_NO_CONTEXT || !eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context))
    fail_gl("no OpenGL 3.3 without a display");
  done = true;
}

GLuint compile_shader(GLenum kind, const char* source) {
  const GLuint shader = glCreateShader(kind);
  glShaderSource(shader, 1, &source, nullptr);
  glCompileShader(shader);
  GLint compiled = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
  if (!compiled) fail_gl("a shader does not compile");
  return shader;
}

void link_program(GLuint program) {
  glLinkProgram(program);
  GLint linked = 0;
  glGetProgramiv(program, GL_LINK_STATUS, &linked);
  if (!linked) fail_gl("a program does not link");
}

GLuint make_gl_buffer(GLenum target, std::size_t bytes, const void* data) {
  GLuint buffer = 0;
  glGenBuffers(1, &buffer);
  glBindBuffer(target, buffer);
  glBufferData(target, GLsizeiptr(bytes), data, GL_STATIC_DRAW);
  return buffer;
}

GLuint make_gl_texture(const GlFormat& format, const View& view) {
  GLuint texture = 0;
  glGenTextures(1, &texture);
  glBindTexture(GL_TEXTURE_2D, texture);
  glTexImage2D(GL_TEXTURE_2D, 0, format.internal, view.width, view.height, 0, format.channels, format.type, nullptr);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  return texture;
}

GlMesh::GlMesh(const Mesh& mesh)
    : corner_count(GLsizei(3 * mesh.triangles.size())), vertex_count(GLsizei(mesh.positions.size())) {
  glGenVertexArrays(1, &vertex_array);
  glBindVertexArray(vertex_array);
  vertices = make_gl_buffer(GL_ARRAY_BUFFER, mesh.positions.size() * sizeof(glm::vec3), mesh.positions.data());
  corners = make_gl_buffer(GL_ELEMENT_ARRAY_BUFFER, mesh.triangles.size() * sizeof(glm::uvec3), mesh.triangles.data());
  glEnableVertexAttribArray(0);
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
}

GlMesh::~GlMesh() {
  for (const GLuint buffer : {vertices, corners}) glDeleteBuffers(1, &buffer);
  glDeleteVertexArrays(1, &vertex_array);
}

glm::mat4 upside_down_clip_from_world(const View& view) {
  glm::dmat4 clip = clip_from_eye(view.projection, opengl_depth) * glm::inverse(view.world_from_eye);
  for (int column = 0; column < 4; ++column) clip[column][1] = -clip[column][1];
  return glm::mat4(clip);
}

}  // namespace frontmost::bench
