// SPDX-License-Identifier: Apache-2.0
// Draws with Mesa's software OpenGL: depth in 32-bit floats, gl_PrimitiveID in 32-bit integers.
#include <glm/gtc/type_ptr.hpp>

#include "peers/gl.h"
#include "peers/peer.h"

namespace frontmost::bench {
namespace {

constexpr const char* kVertexShader =
    "#version 330\n"
    "in vec3 position; uniform mat4 clip;\n"
    "void main() { gl_Position = clip * vec4(position, 1.0); }\n";
constexpr const char* kIdShader =
    "#version 330\n"
    "out uint id;\n"
    "void main() { id = uint(gl_PrimitiveID); }\n";

/// `captures`: the program records gl_Position instead of drawing.
GLuint link(bool captures) {
  const GLuint program = glCreateProgram();
  glAttachShader(program, compile_shader(GL_VERTEX_SHADER, kVertexShader));
  if (!captures) glAttachShader(program, compile_shader(GL_FRAGMENT_SHADER, kIdShader));
  glBindAttribLocation(program, 0, "position");
  const char* const captured = "gl_Position";
  if (captures) glTransformFeedbackVaryings(program, 1, &captured, GL_INTERLEAVED_ATTRIBS);
  link_program(program);
  return program;
}

class Llvmpipe : public RasterPeer {
 public:
  explicit Llvmpipe(const PeerInput& input);
  ~Llvmpipe() override;
  Llvmpipe(const Llvmpipe&) = delete;
  Llvmpipe& operator=(const Llvmpipe&) = delete;

  void draw() override;
  [[nodiscard]] PeerImage read() override;
  [[nodiscard]] std::vector<glm::vec4> clip_positions() const override;

 private:
  View view_;
  GlMesh mesh_;
  glm::mat4 clip_;
  GLuint ids_ = 0, depth_ = 0, frame_ = 0, program_ = 0;
};

Llvmpipe::Llvmpipe(const PeerInput& input)
    : view_(input.view), mesh_(input.scene.meshes.at(0)), clip_(upside_down_clip_from_world(input.view)) {
  ids_ = make_gl_texture({GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT}, view_);
  depth_ = make_gl_texture({GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT}, view_);
  glGenFramebuffers(1, &frame_);
  glBindFramebuffer(GL_FRAMEBUFFER, frame_);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, ids_, 0);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth_, 0);
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) fail_gl("incomplete framebuffer");
  program_ = link(false);
  glUseProgram(program_);
  glUniformMatrix4fv(glGetUniformLocation(program_, "clip"), 1, GL_FALSE, glm::value_ptr(clip_));
  glViewport(0, 0, view_.width, view_.height);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
}

Llvmpipe::~Llvmpipe() {
  glDeleteProgram(program_);
  glDeleteFramebuffers(1, &frame_);
  for (const GLuint texture : {ids_, depth_}) glDeleteTextures(1, &texture);
}

void Llvmpipe::draw() {
  const GLuint none[4] = {no_primitive, 0, 0, 0};
  glClearBufferuiv(GL_COLOR, 0, none);
  glClear(GL_DEPTH_BUFFER_BIT);
  glDrawElements(GL_TRIANGLES, mesh_.corner_count, GL_UNSIGNED_INT, nullptr);
  glFinish();
}

PeerImage Llvmpipe::read() {
  PeerImage image{std::vector<PrimitiveId>(view_.pixel_count()), std::vector<float>(view_.pixel_count())};
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, view_.width, view_.height, GL_RED_INTEGER, GL_UNSIGNED_INT, image.primitives.data());
  glReadPixels(0, 0, view_.width, view_.height, GL_DEPTH_COMPONENT, GL_FLOAT, image.depths.data());
  if (glGetError() != GL_NO_ERROR) fail_gl("an OpenGL error");
  return image;
}

std::vector<glm::vec4> Llvmpipe::clip_positions() const {
  std::vector<glm::vec4> positions(static_cast<std::size_t>(mesh_.vertex_count));
  const GLuint program = link(true);
  glUseProgram(program);
  glUniformMatrix4fv(glGetUniformLocation(program, "clip"), 1, GL_FALSE, glm::value_ptr(clip_));
  const std::size_t bytes = positions.size() * sizeof(glm::vec4);
  const GLuint captured = make_gl_buffer(GL_TRANSFORM_FEEDBACK_BUFFER, bytes, nullptr);
  glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, captured);
  glEnable(GL_RASTERIZER_DISCARD);
  glBeginTransformFeedback(GL_POINTS);
  glDrawArrays(GL_POINTS, 0, mesh_.vertex_count);
  glEndTransformFeedback();
  glDisable(GL_RASTERIZER_DISCARD);
  glGetBufferSubData(GL_TRANSFORM_FEEDBACK_BUFFER, 0, GLsizeiptr(bytes), positions.data());
  glDeleteBuffers(1, &captured);
  glDeleteProgram(program);
  glUseProgram(program_);
  if (glGetError() != GL_NO_ERROR) fail_gl("an OpenGL error");
  return positions;
}

}  // namespace

std::unique_ptr<RasterPeer> make_llvmpipe(const PeerInput& input) {
  ensure_gl_context(input.threads);
  return std::make_unique<Llvmpipe>(input);
}

}  // namespace frontmost::bench
