// SPDX-License-Identifier: Apache-2.0
#include "shade/textured_gl.h"

#include <cstddef>
#include <glm/gtc/type_ptr.hpp>
#include <map>

namespace frontmost::bench {
namespace {

constexpr const char* kVertexShader =
    "#version 330\n"
    "in vec3 position; in vec3 normal; in vec2 texcoord;\n"
    "uniform mat4 clip; uniform mat4 world; uniform mat3 turn;\n"
    "out vec3 at; out vec3 facing; out vec2 uv;\n"
    "void main() {\n"
    "  vec4 place = world * vec4(position, 1.0);\n"
    "  at = place.xyz; facing = turn * normal; uv = texcoord; gl_Position = clip * place;\n"
    "}\n";
constexpr const char* kFragmentShader =
    "#version 330\n"
    "in vec3 at; in vec3 facing; in vec2 uv;\n"
    "uniform sampler2D colors; uniform vec4 factor; uniform vec3 light; uniform float cutoff; uniform bool "
    "flat_normals;\n"
    "out vec4 color;\n"
    "void main() {\n"
    "  vec4 base = factor * texture(colors, uv);\n"
    "  if (base.a < cutoff) discard;\n"
    "  vec3 n = normalize(flat_normals ? cross(dFdx(at), dFdy(at)) : facing);\n"
    "  color = vec4(base.rgb * (0.15 + 0.85 * abs(dot(n, light))), 1.0);\n"
    "}\n";

struct Vertex {
  glm::vec3 position, normal;
  glm::vec2 texcoord;
};

/// The triangles of a mesh that have one material.
struct Part {
  std::uint32_t material = no_index;
  GLuint corners = 0;
  GLsizei count = 0;
};

struct MeshBuffers {
  GLuint vertex_array = 0, vertices = 0;
  bool is_flat = false;
  std::vector<Part> parts;
};

/// Makes one vertex for each position if all attributes are by position, else one for each corner.
MeshBuffers buffers_of(const Mesh& mesh) {
  const bool is_shared = mesh.normals.triangles.empty() && mesh.texcoords.triangles.empty();
  std::vector<Vertex> vertices;
  std::map<std::uint32_t, std::vector<std::uint32_t>> corners;
  const auto vertex_at = [&](std::uint32_t t, int k) {
    Vertex vertex{mesh.positions[mesh.triangles[t][k]], glm::vec3(0), glm::vec2(0)};
    if (!mesh.normals.empty()) vertex.normal = mesh.normals.values[mesh.corners(mesh.normals, t)[k]];
    if (!mesh.texcoords.empty()) vertex.texcoord = mesh.texcoords.values[mesh.corners(mesh.texcoords, t)[k]];
    return vertex;
  };
  if (is_shared) vertices.resize(mesh.positions.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t number = is_shared ? mesh.triangles[t][k] : std::uint32_t(vertices.size());
      if (is_shared)
        vertices[number] = vertex_at(t, k);
      else
        vertices.push_back(vertex_at(t, k));
      corners[mesh.material_of(t)].push_back(number);
    }
  MeshBuffers buffers;
  buffers.is_flat = mesh.normals.empty();
  glGenVertexArrays(1, &buffers.vertex_array);
  glBindVertexArray(buffers.vertex_array);
  buffers.vertices = make_gl_buffer(GL_ARRAY_BUFFER, vertices.size() * sizeof(Vertex), vertices.data());
  const std::size_t offsets[] = {offsetof(Vertex, position), offsetof(Vertex, normal), offsetof(Vertex, texcoord)};
  for (GLuint a = 0; a < 3; ++a) {
    glEnableVertexAttribArray(a);
    glVertexAttribPointer(a, a < 2 ? 3 : 2, GL_FLOAT, GL_FALSE, sizeof(Vertex),
                          reinterpret_cast<const void*>(offsets[a]));
  }
  for (const auto& [material, numbers] : corners)
    buffers.parts.push_back({material, make_gl_buffer(GL_ELEMENT_ARRAY_BUFFER, 4 * numbers.size(), numbers.data()),
                             GLsizei(numbers.size())});
  return buffers;
}

GLint wrap_of(Texture::Wrap wrap) {
  switch (wrap) {
    case Texture::Wrap::mirror: return GL_MIRRORED_REPEAT;
    case Texture::Wrap::clamp: return GL_CLAMP_TO_EDGE;
    case Texture::Wrap::repeat: break;
  }
  return GL_REPEAT;
}

GLuint color_texture(const Texture& texture) {
  GLuint name = 0;
  glGenTextures(1, &name);
  glBindTexture(GL_TEXTURE_2D, name);
  const glm::u8vec4 white(255);
  const bool is_empty = texture.pixels.empty();
  glTexImage2D(GL_TEXTURE_2D, 0, GL_SRGB8_ALPHA8, is_empty ? 1 : texture.width, is_empty ? 1 : texture.height, 0,
               GL_RGBA, GL_UNSIGNED_BYTE, is_empty ? &white : texture.pixels.data());
  glGenerateMipmap(GL_TEXTURE_2D);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, texture.nearest ? GL_NEAREST : GL_LINEAR_MIPMAP_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, texture.nearest ? GL_NEAREST : GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, wrap_of(texture.wrap_u));
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, wrap_of(texture.wrap_v));
  return name;
}

}  // namespace

struct TexturedGl::State {
  const Scene& scene;
  int width, height;
  GLuint frame = 0, color = 0, depth = 0, program = 0, white = 0;
  std::vector<MeshBuffers> meshes{};
  std::map<std::uint32_t, GLuint> textures{};

  [[nodiscard]] GLint uniform(const char* name) const { return glGetUniformLocation(program, name); }
  void use_material(std::uint32_t number) const {
    const Material* const material = number < scene.materials.size() ? &scene.materials[number] : nullptr;
    const glm::vec4 factor = material ? material->base_color : glm::vec4(1);
    const bool is_cut_out = material && material->alpha == Material::Alpha::mask;
    glUniform4fv(uniform("factor"), 1, glm::value_ptr(factor));
    glUniform1f(uniform("cutoff"), is_cut_out ? material->alpha_cutoff : -1.0f);
    const bool has_texture = material && material->base_color_texture.is_set();
    glBindTexture(GL_TEXTURE_2D, has_texture ? textures.at(material->base_color_texture.texture) : white);
  }
};

TexturedGl::TexturedGl(const Scene& scene, int width, int height, int threads) {
  ensure_gl_context(threads);
  state_ = std::make_unique<State>(State{scene, width, height});
  View size;
  size.width = width;
  size.height = height;
  state_->color = make_gl_texture({GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE}, size);
  state_->depth = make_gl_texture({GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT}, size);
  glGenFramebuffers(1, &state_->frame);
  glBindFramebuffer(GL_FRAMEBUFFER, state_->frame);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, state_->color, 0);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, state_->depth, 0);
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) fail_gl("incomplete framebuffer");
  state_->program = glCreateProgram();
  glAttachShader(state_->program, compile_shader(GL_VERTEX_SHADER, kVertexShader));
  glAttachShader(state_->program, compile_shader(GL_FRAGMENT_SHADER, kFragmentShader));
  const char* const attributes[] = {"position", "normal", "texcoord"};
  for (GLuint a = 0; a < 3; ++a) glBindAttribLocation(state_->program, a, attributes[a]);
  link_program(state_->program);
  for (const Mesh& mesh : scene.meshes) state_->meshes.push_back(buffers_of(mesh));
  for (const Material& material : scene.materials) {
    const std::uint32_t texture = material.base_color_texture.texture;
    if (texture != no_index && !state_->textures.count(texture))
      state_->textures[texture] = color_texture(scene.textures[texture]);
  }
  state_->white = color_texture(Texture{});
  if (glGetError() != GL_NO_ERROR) fail_gl("an OpenGL error");
}

TexturedGl::~TexturedGl() {
  glDeleteProgram(state_->program);
  glDeleteFramebuffers(1, &state_->frame);
  for (const GLuint texture : {state_->color, state_->depth, state_->white}) glDeleteTextures(1, &texture);
  for (const auto& [number, name] : state_->textures) glDeleteTextures(1, &name);
  for (const MeshBuffers& mesh : state_->meshes) {
    for (const Part& part : mesh.parts) glDeleteBuffers(1, &part.corners);
    glDeleteBuffers(1, &mesh.vertices);
    glDeleteVertexArrays(1, &mesh.vertex_array);
  }
}

void TexturedGl::draw(const View& view) {
  const State& s = *state_;
  glBindFramebuffer(GL_FRAMEBUFFER, s.frame);
  glViewport(0, 0, s.width, s.height);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glClearColor(1, 1, 1, 1);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  glUseProgram(s.program);
  const glm::mat4 clip = upside_down_clip_from_world(view);
  const glm::vec3 light(glm::normalize(-0.48 * view.right() + 0.68 * view.up() - 0.72 * view.forward()));
  glUniformMatrix4fv(s.uniform("clip"), 1, GL_FALSE, glm::value_ptr(clip));
  glUniform3fv(s.uniform("light"), 1, glm::value_ptr(light));
  for (const Instance& instance : s.scene.instances) {
    const MeshBuffers& mesh = s.meshes[instance.mesh];
    const glm::mat4 world(instance.world_from_mesh);
    const glm::mat3 turn = glm::inverse(glm::transpose(glm::mat3(world)));
    glUniformMatrix4fv(s.uniform("world"), 1, GL_FALSE, glm::value_ptr(world));
    glUniformMatrix3fv(s.uniform("turn"), 1, GL_FALSE, glm::value_ptr(turn));
    glUniform1i(s.uniform("flat_normals"), mesh.is_flat);
    glBindVertexArray(mesh.vertex_array);
    for (const Part& part : mesh.parts) {
      s.use_material(part.material);
      glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, part.corners);
      glDrawElements(GL_TRIANGLES, part.count, GL_UNSIGNED_INT, nullptr);
    }
  }
  glFinish();
}

Bitmap TexturedGl::read() const {
  Bitmap bitmap{state_->width, state_->height,
                Buffer<std::uint8_t>(4 * std::size_t(state_->width) * std::size_t(state_->height))};
  glBindFramebuffer(GL_FRAMEBUFFER, state_->frame);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, state_->width, state_->height, GL_RGBA, GL_UNSIGNED_BYTE, bitmap.rgba.data());
  if (glGetError() != GL_NO_ERROR) fail_gl("an OpenGL error");
  return bitmap;
}

}  // namespace frontmost::bench
