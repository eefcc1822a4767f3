// SPDX-License-Identifier: Apache-2.0
// OpenGL code that both llvmpipe peers share.
#pragma once

#define GL_GLEXT_PROTOTYPES
#include <GL/gl.h>
#include <GL/glext.h>
#include <frontmost/frontmost.h>

#include <string>

namespace frontmost::bench {

[[noreturn]] void fail_gl(const std::string& what);

/// Makes one context for the whole process, without a display. Mesa reads its settings once, so the number of threads
/// of the first call holds for all. \throws Error unsupported.
void ensure_gl_context(int threads);

[[nodiscard]] GLuint compile_shader(GLenum kind, const char* source);
void link_program(GLuint program);
[[nodiscard]] GLuint make_gl_buffer(GLenum target, std::size_t bytes, const void* data);

struct GlFormat {
  GLint internal;
  GLenum channels, type;
};
/// A texture of the picture's size, unfiltered.
[[nodiscard]] GLuint make_gl_texture(const GlFormat& format, const View& view);

/// The mesh as a bound vertex array with positions in attribute 0.
struct GlMesh {
  explicit GlMesh(const Mesh& mesh);
  ~GlMesh();
  GlMesh(const GlMesh&) = delete;
  GlMesh& operator=(const GlMesh&) = delete;

  GLsizei corner_count, vertex_count;
  GLuint vertex_array = 0, vertices = 0, corners = 0;
};

/// A clip matrix that turns the picture upside down, which OpenGL does not mind. llvmpipe's first row is then our first
/// row, and its fill rule, top-left in its own rows, is top-left in ours.
[[nodiscard]] glm::mat4 upside_down_clip_from_world(const View& view);

}  // namespace frontmost::bench
