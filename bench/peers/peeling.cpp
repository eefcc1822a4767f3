// SPDX-License-Identifier: Apache-2.0
// Depth peeling with Mesa's software OpenGL. A layer needs its nearest fragments only, so each layer is resolved by
// depth into a picture of its own and then blended under the sum.
#include <array>
#include <glm/gtc/type_ptr.hpp>

#include "peers/gl.h"
#include "peers/peer.h"

namespace frontmost::bench {
namespace {

constexpr const char* kVertexShader =
    "#version 330\n"
    "in vec3 position; uniform mat4 clip; uniform vec3 shift; out vec3 world;\n"
    "void main() { world = position + shift * float(gl_InstanceID); gl_Position = clip * vec4(world, 1.0); }\n";
constexpr const char* kLayerShader =
    "#version 330\n"
    "in vec3 world; uniform vec3 light; uniform sampler2D before; uniform bool is_first; out vec4 color;\n"
    "void main() {\n"
    "  if (!is_first && gl_FragCoord.z <= texelFetch(before, ivec2(gl_FragCoord.xy), 0).r) discard;\n"
    "  vec3 normal = normalize(cross(dFdx(world), dFdy(world)));\n"
    "  color = vec4(vec3(0.15 + 0.85 * abs(dot(normal, light))) * 0.4, 0.4);\n"
    "}\n";
constexpr const char* kCoverShader =
    "#version 330\n"
    "void main() { gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0); }\n";
constexpr const char* kBlendShader =
    "#version 330\n"
    "uniform sampler2D layer; out vec4 color;\n"
    "void main() { color = texelFetch(layer, ivec2(gl_FragCoord.xy), 0); }\n";

GLuint make_program(const char* vertex_shader, const char* fragment_shader) {
  const GLuint program = glCreateProgram();
  glAttachShader(program, compile_shader(GL_VERTEX_SHADER, vertex_shader));
  glAttachShader(program, compile_shader(GL_FRAGMENT_SHADER, fragment_shader));
  glBindAttribLocation(program, 0, "position");
  link_program(program);
  return program;
}

GLuint make_target(GLuint color, GLuint depth) {
  GLuint target = 0;
  glGenFramebuffers(1, &target);
  glBindFramebuffer(GL_FRAMEBUFFER, target);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, color, 0);
  if (depth != 0) glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth, 0);
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) fail_gl("incomplete framebuffer");
  return target;
}

/// Nothing is deleted, as the process ends with the peer.
class Peeling : public PeelingPeer {
 public:
  explicit Peeling(const PeerInput& input);

  void draw() override;
  [[nodiscard]] std::vector<glm::vec4> read() override;
  [[nodiscard]] int layer_count() const override { return layer_count_; }

 private:
  [[nodiscard]] bool draw_layer(int number);
  void blend_layer();

  View view_;
  GlMesh mesh_;
  GLsizei copies_;
  std::array<GLuint, 2> depths_{}, layers_{};
  GLuint layer_ = 0, sum_ = 0, layer_program_ = 0, blend_program_ = 0, query_ = 0;
  int layer_count_ = 0;
};

Peeling::Peeling(const PeerInput& input)
    : view_(input.view), mesh_(input.scene.meshes.at(0)), copies_(GLsizei(input.scene.instances.size())) {
  for (GLuint& depth : depths_) depth = make_gl_texture({GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT}, view_);
  layer_ = make_gl_texture({GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE}, view_);
  for (std::size_t i = 0; i < 2; ++i) layers_[i] = make_target(layer_, depths_[i]);
  sum_ = make_target(make_gl_texture({GL_RGBA16F, GL_RGBA, GL_HALF_FLOAT}, view_), 0);
  layer_program_ = make_program(kVertexShader, kLayerShader);
  blend_program_ = make_program(kCoverShader, kBlendShader);
  glGenQueries(1, &query_);

  glUseProgram(layer_program_);
  const glm::mat4 clip = upside_down_clip_from_world(view_);
  const glm::vec3 light = glm::normalize(glm::vec3(-view_.forward() + 0.5 * view_.up() - 0.3 * view_.right()));
  const auto& instances = input.scene.instances;
  const glm::vec3 shift =
      copies_ > 1 ? glm::vec3(instances[1].world_from_mesh[3] - instances[0].world_from_mesh[3]) : glm::vec3(0);
  glUniformMatrix4fv(glGetUniformLocation(layer_program_, "clip"), 1, GL_FALSE, glm::value_ptr(clip));
  glUniform3fv(glGetUniformLocation(layer_program_, "light"), 1, glm::value_ptr(light));
  glUniform3fv(glGetUniformLocation(layer_program_, "shift"), 1, glm::value_ptr(shift));
  glViewport(0, 0, view_.width, view_.height);
  glDepthFunc(GL_LESS);
  glBlendFunc(GL_ONE_MINUS_DST_ALPHA, GL_ONE);
}

bool Peeling::draw_layer(int number) {
  const auto current = std::size_t(number % 2);
  glBindFramebuffer(GL_FRAMEBUFFER, layers_[current]);
  glEnable(GL_DEPTH_TEST);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  glUseProgram(layer_program_);
  glUniform1i(glGetUniformLocation(layer_program_, "is_first"), number == 0);
  glBindTexture(GL_TEXTURE_2D, depths_[1 - current]);
  glBeginQuery(GL_ANY_SAMPLES_PASSED, query_);
  glDrawElementsInstanced(GL_TRIANGLES, mesh_.corner_count, GL_UNSIGNED_INT, nullptr, copies_);
  glEndQuery(GL_ANY_SAMPLES_PASSED);
  GLuint any = 0;
  glGetQueryObjectuiv(query_, GL_QUERY_RESULT, &any);
  return any != 0;
}

void Peeling::blend_layer() {
  glBindFramebuffer(GL_FRAMEBUFFER, sum_);
  glUseProgram(blend_program_);
  glBindTexture(GL_TEXTURE_2D, layer_);
  glDisable(GL_DEPTH_TEST);
  glEnable(GL_BLEND);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glDisable(GL_BLEND);
}

void Peeling::draw() {
  glBindFramebuffer(GL_FRAMEBUFFER, sum_);
  glClearColor(0, 0, 0, 0);
  glClear(GL_COLOR_BUFFER_BIT);
  layer_count_ = 0;
  while (draw_layer(layer_count_)) {
    blend_layer();
    ++layer_count_;
  }
  glFinish();
}

std::vector<glm::vec4> Peeling::read() {
  std::vector<glm::vec4> pixels(view_.pixel_count());
  glBindFramebuffer(GL_FRAMEBUFFER, sum_);
  glReadPixels(0, 0, view_.width, view_.height, GL_RGBA, GL_FLOAT, pixels.data());
  if (glGetError() != GL_NO_ERROR) fail_gl("an OpenGL error");
  return pixels;
}

}  // namespace

std::unique_ptr<PeelingPeer> make_peeling(const PeerInput& input) {
  ensure_gl_context(input.threads);
  return std::make_unique<Peeling>(input);
}

}  // namespace frontmost::bench
