// SPDX-License-Identifier: Apache-2.0
// The state of a context, in the groups that glPushAttrib saves, with the initial values of the OpenGL 1.5
// specification.
//
//    a call --changes--> State --snapshot()--> DrawState, which batches keep and kernels read
//
// Every value that a call may set is a field of one group. Capabilities of glEnable are bits of one word, because
// GL_ENABLE_BIT saves them all and each group saves its own (state/capabilities.h).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "state/enums.h"
#include "state/texture.h"

namespace frontmost::gl_detail {

inline constexpr int kLights = 8;
inline constexpr int kClipPlanes = 6;
inline constexpr int kTextureUnits = 4;
inline constexpr int kMostSize = 4096;       ///< of a texture, in texels
inline constexpr float kMostWidth = 255;     ///< of points and lines, in pixels
inline constexpr int kMostViewport = 16384;  ///< pixels
inline constexpr int kModelviewDepth = 32, kProjectionDepth = 32, kTextureDepth = 10;
inline constexpr int kAttribDepth = 16, kListDepth = 64;

inline constexpr int kMaps = 9;        ///< from GL_MAP1_COLOR_4 to GL_MAP1_VERTEX_4
inline constexpr int kMostOrder = 30;  ///< of an evaluator

/// Capabilities of glEnable, except textures and their generated coordinates, which each texture unit has.
enum class Capability : std::uint8_t {
  alpha_test,
  blend,
  color_logic_op,
  color_material,
  cull_face,
  depth_test,
  dither,
  fog,
  light0,
  lighting = light0 + kLights,
  line_smooth,
  line_stipple,
  normalize,
  point_smooth,
  polygon_offset_fill,
  polygon_offset_line,
  polygon_offset_point,
  polygon_smooth,
  polygon_stipple,
  rescale_normal,
  scissor_test,
  stencil_test,
  clip_plane0,
  auto_normal = clip_plane0 + kClipPlanes,
  color_sum,
  index_logic_op,
  multisample,
  map1,  ///< of each map of glMap1, and then of glMap2
  map2 = map1 + kMaps,
  count = map2 + kMaps
};

/// A set of capabilities.
class Capabilities {
 public:
  [[nodiscard]] bool has(Capability c) const { return (bits_ >> unsigned(c) & 1) != 0; }
  [[nodiscard]] bool has(Capability first, int i) const { return (bits_ >> (unsigned(first) + unsigned(i)) & 1) != 0; }
  void set(Capability c, bool on) { bits_ = (bits_ & ~bit(c)) | (on ? bit(c) : 0); }
  [[nodiscard]] std::uint64_t bits() const { return bits_; }
  /// Takes the bits of `mask` from `from`.
  void take(const Capabilities& from, std::uint64_t mask) { bits_ = (bits_ & ~mask) | (from.bits_ & mask); }
  [[nodiscard]] static std::uint64_t bit(Capability c) { return std::uint64_t(1) << unsigned(c); }

 private:
  std::uint64_t bits_ = bit(Capability::dither) | bit(Capability::multisample);
};

/// Numbers of the floats that a vertex consists of. A call such as glColor sets current values; glVertex copies them.
enum Attribute : int {
  kX,
  kY,
  kZ,
  kW,
  kNormalX,
  kNormalY,
  kNormalZ,
  kRed,
  kGreen,
  kBlue,
  kAlpha,
  kRed2,
  kGreen2,
  kBlue2,
  kFogCoord,
  kEdgeFlag,
  kTexCoord,  ///< s, t, r, q of each unit
  kAttributes = kTexCoord + 4 * kTextureUnits
};

struct RasterPosition {
  glm::vec4 window{0, 0, 0, 1};  ///< x, y, z of the window, and w of clip space
  float distance = 0;            ///< from the eye
  glm::vec4 color{1}, secondary{0, 0, 0, 1};
  std::array<glm::vec4, kTextureUnits> texcoords{};
  bool is_valid = true;

  RasterPosition() { texcoords.fill(glm::vec4(0, 0, 0, 1)); }
};

struct CurrentState {
  std::array<float, kAttributes> values{};
  RasterPosition raster;

  CurrentState() {
    values[kW] = values[kNormalZ] = values[kRed] = values[kGreen] = values[kBlue] = values[kAlpha] = values[kEdgeFlag] =
        1;
    for (int unit = 0; unit < kTextureUnits; ++unit) values[std::size_t(kTexCoord + 4 * unit + 3)] = 1;
  }
};

struct PointState {
  float size = 1, size_min = 0, size_max = 255, fade = 1;
  glm::vec3 attenuation{1, 0, 0};
};

struct LineState {
  float width = 1;
  int stipple_factor = 1;
  std::uint16_t stipple = 0xFFFF;
};

struct PolygonState {
  GLenum cull_face = GL_BACK, front_face = GL_CCW;
  GLenum mode[2] = {GL_FILL, GL_FILL};  ///< front, back
  float offset_factor = 0, offset_units = 0;
};

struct PolygonStippleState {
  std::array<std::uint32_t, 32> rows;  ///< row 0 is the lowest; the leftmost pixel is the highest bit

  PolygonStippleState() { rows.fill(0xFFFFFFFF); }
};

struct LightState {
  glm::vec4 ambient{0, 0, 0, 1}, diffuse{0, 0, 0, 1}, specular{0, 0, 0, 1};
  glm::vec4 position{0, 0, 1, 0};      ///< eye space
  glm::vec3 spot_direction{0, 0, -1};  ///< eye space
  float spot_exponent = 0, spot_cutoff = 180;
  glm::vec3 attenuation{1, 0, 0};  ///< constant, linear, quadratic
};

struct MaterialState {
  glm::vec4 ambient{0.2f, 0.2f, 0.2f, 1}, diffuse{0.8f, 0.8f, 0.8f, 1}, specular{0, 0, 0, 1}, emission{0, 0, 0, 1};
  float shininess = 0;
  glm::vec3 indexes{0, 1, 1};
};

struct LightingState {
  GLenum shade_model = GL_SMOOTH;
  glm::vec4 model_ambient{0.2f, 0.2f, 0.2f, 1};
  bool local_viewer = false, two_side = false;
  GLenum color_control = GL_SINGLE_COLOR;
  GLenum color_material_face = GL_FRONT_AND_BACK, color_material_mode = GL_AMBIENT_AND_DIFFUSE;
  std::array<LightState, kLights> lights;
  std::array<MaterialState, 2> materials;  ///< front, back

  LightingState() { lights[0].diffuse = lights[0].specular = glm::vec4(1); }
};

struct FogState {
  GLenum mode = GL_EXP, coord_source = GL_FRAGMENT_DEPTH;
  float density = 1, start = 0, end = 1, index = 0;
  glm::vec4 color{0};
};

struct DepthTestState {
  GLenum func = GL_LESS;
  bool mask = true;
  double clear = 1;
};

struct StencilState {
  GLenum func = GL_ALWAYS, fail = GL_KEEP, depth_fail = GL_KEEP, pass = GL_KEEP;
  GLint ref = 0, clear = 0;
  GLuint value_mask = 0xFFFFFFFF, write_mask = 0xFFFFFFFF;
};

struct ColorBufferState {
  GLenum alpha_func = GL_ALWAYS;
  float alpha_ref = 0;
  GLenum source_rgb = GL_ONE, source_alpha = GL_ONE, target_rgb = GL_ZERO, target_alpha = GL_ZERO;
  GLenum equation_rgb = GL_FUNC_ADD, equation_alpha = GL_FUNC_ADD;
  glm::vec4 blend_color{0};
  GLenum logic_op = GL_COPY, draw_buffer = GL_FRONT;
  std::array<bool, 4> mask{true, true, true, true};
  glm::vec4 clear{0};
  float clear_index = 0;
  GLuint index_mask = 0xFFFFFFFF;
};

/// x, y, width, height in pixels from the lower left.
struct WindowRect {
  int x = 0, y = 0, width = 0, height = 0;
};

struct ViewportState {
  WindowRect rect;
  double near = 0, far = 1;
};

struct TransformState {
  GLenum matrix_mode = GL_MODELVIEW;
  std::array<glm::dvec4, kClipPlanes> clip_planes{};  ///< eye space
};

struct TexGenState {
  GLenum mode = GL_EYE_LINEAR;
  glm::vec4 object_plane{0}, eye_plane{0};
};

struct CombineState {
  GLenum rgb = GL_MODULATE, alpha = GL_MODULATE;
  GLenum source_rgb[3] = {GL_TEXTURE, GL_PREVIOUS, GL_CONSTANT},
         source_alpha[3] = {GL_TEXTURE, GL_PREVIOUS, GL_CONSTANT};
  GLenum operand_rgb[3] = {GL_SRC_COLOR, GL_SRC_COLOR, GL_SRC_ALPHA};
  GLenum operand_alpha[3] = {GL_SRC_ALPHA, GL_SRC_ALPHA, GL_SRC_ALPHA};
  float rgb_scale = 1, alpha_scale = 1;
};

struct TextureUnitState {
  bool is_enabled[2] = {false, false};  ///< GL_TEXTURE_1D, GL_TEXTURE_2D
  bool generates[4] = {false, false, false, false};
  GLenum env_mode = GL_MODULATE;
  glm::vec4 env_color{0};
  float lod_bias = 0;
  CombineState combine;
  TexGenState generated[4];                 ///< s, t, r, q
  std::shared_ptr<TextureObject> bound[2];  ///< for GL_TEXTURE_1D and GL_TEXTURE_2D, never null once a context is made

  TextureUnitState() {
    generated[0].object_plane = generated[0].eye_plane = {1, 0, 0, 0};
    generated[1].object_plane = generated[1].eye_plane = {0, 1, 0, 0};
  }
};

struct TextureState {
  int active = 0;
  std::array<TextureUnitState, kTextureUnits> units;
};

struct PixelMap {
  std::array<float, 256> values{};
  int size = 1;
};

/// Transfer operations, and the state of pixel rectangles.
struct PixelModeState {
  GLenum read_buffer = GL_FRONT;
  float zoom_x = 1, zoom_y = 1;
  glm::vec4 scale{1}, bias{0};
  float depth_scale = 1, depth_bias = 0;
  int index_shift = 0, index_offset = 0;
  bool map_color = false, map_stencil = false;
};

/// Rows of pixels in the memory of the client.
struct PixelStore {
  bool swap_bytes = false, lsb_first = false;
  int row_length = 0, skip_rows = 0, skip_pixels = 0, alignment = 4;
  int image_height = 0, skip_images = 0;
};

struct HintState {
  GLenum perspective = GL_DONT_CARE, point = GL_DONT_CARE, line = GL_DONT_CARE, polygon = GL_DONT_CARE,
         fog = GL_DONT_CARE, mipmap = GL_DONT_CARE, compression = GL_DONT_CARE;
};

/// Bytes that glBufferData holds.
struct BufferObject {
  GLuint name = 0;
  std::vector<std::byte> bytes;
  GLenum usage = GL_STATIC_DRAW, access = GL_READ_WRITE;
  bool is_mapped = false;
};

/// One of the arrays that glDrawArrays reads.
struct ClientArray {
  bool is_enabled = false;
  int size = 4;
  GLenum type = GL_FLOAT;
  int stride = 0;
  const void* pointer = nullptr;  ///< an offset into `buffer`, if there is one
  std::shared_ptr<BufferObject> buffer;
};

struct ClientState {
  ClientState() { secondary_color.size = 3; }

  PixelStore pack, unpack;
  ClientArray vertex, normal, color, secondary_color, fog_coord, edge_flag, index;
  std::array<ClientArray, kTextureUnits> texcoords;
  int active_texture = 0;
  std::shared_ptr<BufferObject> array_buffer, element_buffer;
};

/// Control points of a curve or a patch.
struct EvaluatorMap {
  std::array<int, 2> order{1, 1};
  std::array<std::array<double, 2>, 2> domain{{{0, 1}, {0, 1}}};
  std::vector<float> points;  ///< along u, and for each of them along v

  [[nodiscard]] static EvaluatorMap initial(int map);
};

/// What glMapGrid sets.
struct EvaluatorGrid {
  std::array<int, 2> segments{1, 1};
  std::array<std::array<double, 2>, 2> domain{{{0, 1}, {0, 1}}};
};

/// All that glPushAttrib can save.
struct State {
  Capabilities capabilities;
  CurrentState current;
  PointState point;
  LineState line;
  PolygonState polygon;
  PolygonStippleState polygon_stipple;
  LightingState lighting;
  FogState fog;
  DepthTestState depth;
  StencilState stencil;
  ColorBufferState color;
  ViewportState viewport;
  WindowRect scissor;
  TransformState transform;
  TextureState texture;
  PixelModeState pixel;
  HintState hint;
  std::array<EvaluatorGrid, 2> grid;  ///< of one and of two dimensions
  GLuint list_base = 0;
};

}  // namespace frontmost::gl_detail
