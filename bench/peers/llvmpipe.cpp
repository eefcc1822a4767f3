// SPDX-License-Identifier: Apache-2.0
// Draws with Mesa's software OpenGL: depth in 32-bit floats, gl_PrimitiveID in 32-bit integers.
//
// The picture is drawn upside down, which OpenGL does not mind: llvmpipe's first row is then our first row, and its
// fill rule, which is top-left in its own rows, is top-left in ours.
#define GL_GLEXT_PROTOTYPES
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GL/gl.h>
#include <GL/glext.h>

#include <cstdlib>
#include <glm/gtc/type_ptr.hpp>

#include "peers/peer.h"

namespace frontmost::bench {
namespace {

[[noreturn]] void fail(const std::string& what) { throw Error(ErrorCode::unsupported, "llvmpipe: " + what); }

/// One context for the whole process: Mesa reads its settings once.
void ensure_context(int threads) {
  static bool done = false;
  if (done) return;
  // 0 draws on the calling thread.
  setenv("LP_NUM_THREADS", std::to_string(threads == 1 ? 0 : threads).c_str(), 1);
  setenv("GALLIUM_DRIVER", "llvmpipe", 1);
  setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
  const auto get_display =
      reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(eglGetProcAddress("eglGetPlatformDisplayEXT"));
  if (!get_display) fail("EGL has no platform displays");
  const EGLDisplay display = get_display(EGL_PLATFORM_SURFACELESS_MESA, nullptr, nullptr);
  if (!eglInitialize(display, nullptr, nullptr)) fail("EGL does not start");
  eglBindAPI(EGL_OPENGL_API);
  const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_CONTEXT_MINOR_VERSION, 3, EGL_NONE};
  const EGLContext context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes);
  if (context == EGL_NO_CONTEXT || !eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context))
    fail("no OpenGL 3.3 without a display");
  done = true;
}

GLuint compile(GLenum kind, const char* source) {
  const GLuint shader = glCreateShader(kind);
  glShaderSource(shader, 1, &source, nullptr);
  glCompileShader(shader);
  GLint compiled = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
  if (!compiled) fail("a shader does not compile");
  return shader;
}

constexpr const char* kVertexShader =
    "#version 330\n"
    "in vec3 position; uniform mat4 clip;\n"
    "void main() { gl_Position = clip * vec4(position, 1.0); }\n";
constexpr const char* kIdShader =
    "#version 330\n"
    "out uint id;\n"
    "void main() { id = uint(gl_PrimitiveID); }\n";

/// `captures`: records gl_Position instead of drawing.
GLuint link(bool captures) {
  const GLuint program = glCreateProgram();
  glAttachShader(program, compile(GL_VERTEX_SHADER, kVertexShader));
  if (!captures) glAttachShader(program, compile(GL_FRAGMENT_SHADER, kIdShader));
  glBindAttribLocation(program, 0, "position");
  const char* const captured = "gl_Position";
  if (captures) glTransformFeedbackVaryings(program, 1, &captured, GL_INTERLEAVED_ATTRIBS);
  glLinkProgram(program);
  GLint linked = 0;
  glGetProgramiv(program, GL_LINK_STATUS, &linked);
  if (!linked) fail("a program does not link");
  return program;
}

GLuint make_texture(GLint format, GLenum channels, GLenum type, const View& view) {
  GLuint texture = 0;
  glGenTextures(1, &texture);
  glBindTexture(GL_TEXTURE_2D, texture);
  glTexImage2D(GL_TEXTURE_2D, 0, format, view.width, view.height, 0, channels, type, nullptr);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  return texture;
}

GLuint make_buffer(GLenum target, std::size_t bytes, const void* data) {
  GLuint buffer = 0;
  glGenBuffers(1, &buffer);
  glBindBuffer(target, buffer);
  glBufferData(target, GLsizeiptr(bytes), data, GL_STATIC_DRAW);
  return buffer;
}

glm::mat4 upside_down_clip_from_world(const View& view) {
  glm::dmat4 clip = clip_from_eye(view.projection, opengl_depth) * glm::inverse(view.world_from_eye);
  for (int column = 0; column < 4; ++column) clip[column][1] = -clip[column][1];
  return glm::mat4(clip);
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
  GLsizei corner_count_, vertex_count_;
  glm::mat4 clip_;
  GLuint vertex_array_ = 0, vertices_ = 0, corners_ = 0;
  GLuint ids_ = 0, depth_ = 0, frame_ = 0, program_ = 0;
};

Llvmpipe::Llvmpipe(const PeerInput& input)
    : view_(input.view),
      corner_count_(GLsizei(3 * input.scene.meshes.at(0).triangles.size())),
      vertex_count_(GLsizei(input.scene.meshes.at(0).positions.size())),
      clip_(upside_down_clip_from_world(input.view)) {
  ensure_context(input.threads);
  const Mesh& mesh = input.scene.meshes[0];
  glGenVertexArrays(1, &vertex_array_);
  glBindVertexArray(vertex_array_);
  vertices_ = make_buffer(GL_ARRAY_BUFFER, mesh.positions.size() * sizeof(glm::vec3), mesh.positions.data());
  corners_ = make_buffer(GL_ELEMENT_ARRAY_BUFFER, mesh.triangles.size() * sizeof(glm::uvec3), mesh.triangles.data());
  glEnableVertexAttribArray(0);
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 0, nullptr);

  ids_ = make_texture(GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, view_);
  depth_ = make_texture(GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT, view_);
  glGenFramebuffers(1, &frame_);
  glBindFramebuffer(GL_FRAMEBUFFER, frame_);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, ids_, 0);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth_, 0);
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) fail("incomplete framebuffer");
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
  for (const GLuint buffer : {vertices_, corners_}) glDeleteBuffers(1, &buffer);
  glDeleteVertexArrays(1, &vertex_array_);
}

void Llvmpipe::draw() {
  const GLuint none[4] = {no_primitive, 0, 0, 0};
  glClearBufferuiv(GL_COLOR, 0, none);
  glClear(GL_DEPTH_BUFFER_BIT);
  glDrawElements(GL_TRIANGLES, corner_count_, GL_UNSIGNED_INT, nullptr);
  glFinish();
}

PeerImage Llvmpipe::read() {
  PeerImage image{std::vector<PrimitiveId>(view_.pixel_count()), std::vector<float>(view_.pixel_count())};
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, view_.width, view_.height, GL_RED_INTEGER, GL_UNSIGNED_INT, image.primitives.data());
  glReadPixels(0, 0, view_.width, view_.height, GL_DEPTH_COMPONENT, GL_FLOAT, image.depths.data());
  if (glGetError() != GL_NO_ERROR) fail("an OpenGL error");
  return image;
}

std::vector<glm::vec4> Llvmpipe::clip_positions() const {
  std::vector<glm::vec4> positions(static_cast<std::size_t>(vertex_count_));
  const GLuint program = link(true);
  glUseProgram(program);
  glUniformMatrix4fv(glGetUniformLocation(program, "clip"), 1, GL_FALSE, glm::value_ptr(clip_));
  const std::size_t bytes = positions.size() * sizeof(glm::vec4);
  const GLuint captured = make_buffer(GL_TRANSFORM_FEEDBACK_BUFFER, bytes, nullptr);
  glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, captured);
  glEnable(GL_RASTERIZER_DISCARD);
  glBeginTransformFeedback(GL_POINTS);
  glDrawArrays(GL_POINTS, 0, vertex_count_);
  glEndTransformFeedback();
  glDisable(GL_RASTERIZER_DISCARD);
  glGetBufferSubData(GL_TRANSFORM_FEEDBACK_BUFFER, 0, GLsizeiptr(bytes), positions.data());
  glDeleteBuffers(1, &captured);
  glDeleteProgram(program);
  glUseProgram(program_);
  if (glGetError() != GL_NO_ERROR) fail("an OpenGL error");
  return positions;
}

}  // namespace

std::unique_ptr<RasterPeer> make_llvmpipe(const PeerInput& input) { return std::make_unique<Llvmpipe>(input); }

}  // namespace frontmost::bench
