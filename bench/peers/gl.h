// SPDX-License-Identifier: Apache-2.0
// What both llvmpipe peers need of OpenGL.
#pragma once

#define GL_GLEXT_PROTOTYPES
#include <GL/gl.h>
#include <GL/glext.h>
#include <frontmost/frontmost.h>

#include <string>

namespace frontmost::bench {

[[noreturn]] void fail_gl(const std::string& what);

/// One context for the whole process, without a display: Mesa reads its settings once, so the number of threads of the
/// first call holds for all. \throws Error unsupported.
void ensure_gl_context(int threads);

[[nodiscard]] GLuint compile_shader(GLenum kind, const char* source);
void link_program(GLuint program);
[[nodiscard]] GLuint make_gl_buffer(GLenum target, std::size_t bytes, const void* data);

struct GlFormat {
  GLint internal;
  GLenum channels, type;
};
/// As large as the picture, unfiltered.
[[nodiscard]] GLuint make_gl_texture(const GlFormat& format, const View& view);

/// The mesh as bound vertex array with attribute 0.
struct GlMesh {
  explicit GlMesh(const Mesh& mesh);
  ~GlMesh();
  GlMesh(const GlMesh&) = delete;
  GlMesh& operator=(const GlMesh&) = delete;

  GLsizei corner_count, vertex_count;
  GLuint vertex_array = 0, vertices = 0, corners = 0;
};

/// Upside down, which OpenGL does not mind: llvmpipe's first row is then our first row, and its fill rule, which is
/// top-left in its own rows, is top-left in ours.
[[nodiscard]] glm::mat4 upside_down_clip_from_world(const View& view);

}  // namespace frontmost::bench
