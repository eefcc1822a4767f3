// SPDX-License-Identifier: Apache-2.0
// Shading: colour for what a method found visible, decided last and only where something is seen.
//
//   Visible ----> once for every pixel and primitive in it ----> normal, texture, light ----> R, G, B, A
//                     |                                              |
//                     Surfaces: attributes and materials             shadows: a map, or rays
//
// How dear a material is thus does not depend on how much lies behind what is seen. Colours are linear while they are
// computed.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "frontmost/image.h"
#include "frontmost/raycast.h"
#include "frontmost/scene.h"
#include "frontmost/view.h"

namespace frontmost {

// Environment: the light that comes from all around, made ready to be asked for by any surface.
//
//   a picture of all directions, or code
//     --> the same on an octahedron unfolded to a square           mirrored by smooth surfaces
//     --> that blurred as surfaces of eight roughnesses blur it    mirrored by rough ones
//     --> its mean, its first and its second moments               sent back by matt ones
//
// Directions are those of a Panorama: ahead is the middle of the picture, right a quarter of its width from there, up
// its upper side. In the axes of an environment x is right, y up and z behind.

class Environment;
namespace shading {
struct PrefilteredEnvironment;
const PrefilteredEnvironment& prefiltered(const Environment& environment);
}  // namespace shading

/// Cheap to copy: copies share what was made, which never changes, and may be used by several threads at once.
class Environment {
 public:
  /// From an equirectangular picture with channels R, G and B, twice as wide as high, as load_environment() gives it.
  /// Keeps the picture, which is what a background shows. O(pixels), in parallel; about 7 MB beside the picture, less
  /// for pictures below 1024 x 512. \throws Error bad_argument for other sizes and channels, or values that are not 0
  /// to max_environment_value; limit_exceeded above 16384 x 8192.
  explicit Environment(Image equirectangular, const Execution& execution = {});
  /// A neutral room, grey below and brighter above, with soft boxes that metals mirror; the brightest stands before the
  /// model to the left, where the key light is. Turns with the camera. White matt surfaces send back 0.15 of it from
  /// below and 0.36 from above. About three milliseconds.
  [[nodiscard]] static Environment studio(const Execution& execution = {});
  /// A clear sky without a sun over dull ground; as bright as the studio.
  [[nodiscard]] static Environment sky(const Execution& execution = {});
  /// No light at all.
  [[nodiscard]] static Environment none();

  /// True of studio(): what is ahead in it is ahead of the camera; in others it is ahead in the world, where
  /// NamedView::front looks.
  [[nodiscard]] bool turns_with_camera() const;
  /// The picture that it was made from, or null.
  [[nodiscard]] const Image* picture() const;

  /// Radiance from a direction as a surface of this roughness (0 to 1) mirrors it that is seen from straight ahead: the
  /// mean weighted by the GGX lobe and the cosine. `towards` is in the environment's axes, of any length but zero.
  [[nodiscard]] glm::vec3 radiance(const glm::vec3& towards, float roughness = 0) const;
  /// What a white matt surface with this unit normal sends back: irradiance / pi, by spherical harmonics of order 2.
  /// (R. Ramamoorthi, P. Hanrahan. An Efficient Representation for Irradiance Environment Maps. SIGGRAPH 2001.)
  [[nodiscard]] glm::vec3 irradiance(const glm::vec3& normal) const;

 private:
  friend const shading::PrefilteredEnvironment& shading::prefiltered(const Environment& environment);
  explicit Environment(std::shared_ptr<const shading::PrefilteredEnvironment> made) : made_(std::move(made)) {}
  std::shared_ptr<const shading::PrefilteredEnvironment> made_;
};

/// What the picture shows.
enum class Shading : std::uint8_t {
  lit,      ///< metallic-roughness under a key light with shadow and an environment
  flat,     ///< base colour as it is, no light
  normals,  ///< world-space shading normals, 0.5 + 0.5 n
  depth,    ///< near bright, far dark, over the depths that are seen
  ids,      ///< a colour of its own for every object
  uv,       ///< texture coordinates as red and green
};

/// Which direct lights count in lit pictures, beside the surroundings.
enum class Lights : std::uint8_t {
  key,   ///< one that moves with the camera
  file,  ///< Scene::lights: a white matt surface that gets E lux sends back E / pi, which is the picture's value
  both,
  none,
};

/// So many suns and spots of a scene have maps of shadows: the first ones.
inline constexpr std::size_t most_mapped_lights = 16;

/// How shadows are found, which what is opaque throws.
enum class Shadows : std::uint8_t {
  off,  ///< none
  /// What a light sees on 256 to 1024 texels squared, as the picture needs, with edges a few of them wide. Of the key
  /// light, and of the first most_mapped_lights suns and spots of the scene; points throw none, and spots none farther
  /// than 75 degrees from their axis.
  map,
  rays,  ///< a ray to every light from every sample: as sharp as the picture
};

/// How much of what lies one behind another a picture shows. Of lit, flat and normals alone.
enum class SeeThrough : std::uint8_t {
  /// Every layer, by the A-buffer, wherever something is visible that can be seen through; what is visible elsewhere.
  /// The Visible has to be the front-most of its view: what others hold is shown by `never`.
  where_needed,
  always,  ///< every layer everywhere, of opaque scenes too: for the A-buffer's sub-samples
  never,   ///< what is visible, over the background
};

/// For how many pixels a colour is found at once. Of lit, flat and normals alone.
/// (K. Vaidyanathan et al. Coarse Pixel Shading. High-Performance Graphics 2014.)
enum class ShadingRate : std::uint8_t {
  each_pixel,
  /// Those of two by two pixels all of whose samples see the same primitive have the colour of the first of them, and
  /// pixels with several layers share those that are as many deep and cover the same samples. For pictures that are
  /// followed by others at once: down to a quarter of the colours are found. Borders of triangles stay as sharp;
  /// textures, with their holes, shadows and highlights do not.
  each_2x2,
};

/// In which numbers a picture is blended: what is half transparent, and the samples of a pixel.
enum class Blend : std::uint8_t {
  linear,  ///< light, as nature does
  srgb,    ///< as viewers blend the shapes of SVG and PDF: a half-transparent red over white is darker
};

/// What is near keeps light from all around off: corners, and what stands on something, are darker. Found on the depths
/// that the picture shows, of what is opaque by its material, so that it costs the same for any model; what is hidden
/// from the eye hides nothing. The key light is not weakened by it.
/// (J. Jimenez, X. Wu, A. Pesce, A. Jarabo. Practical Real-Time Strategies for Accurate Indirect Occlusion. 2016.)
struct AmbientOcclusion {
  double strength = 1;  ///< 0: none, to 1: as much as is hidden
  /// Scene units: what is farther away hides nothing, and what is nearer the more, the nearer it is. None: a tenth of
  /// the diagonal of find_subject().
  std::optional<double> radius = std::nullopt;
};

/// How light beyond what a picture can hold, which is 1, is brought below it.
enum class ToneMapping : std::uint8_t {
  none,  ///< cut off at 1, each channel by itself
  /// Filmic: more contrast, and colours fade as they grow bright. (S. Hill's fit of ACES 1.0, as in
  /// three.js and other viewers, there ACESFilmicToneMapping.)
  aces,
  /// Khronos PBR Neutral: base colours stay what they are up to 0.76, what is brighter fades to white.
  khronos,
};

/// The light of lit pictures: a key light, the scene's own lights, and an environment.
struct LightOptions {
  Shadows shadows = Shadows::map;
  Lights lights = Lights::key;
  std::optional<AmbientOcclusion> ambient_occlusion = std::nullopt;
  /// None: Environment::studio().
  std::optional<Environment> environment = std::nullopt;
  /// Radians, counter-clockwise seen from above, by which the environment is turned about the scene's up. Finite.
  double environment_angle = 0;
  /// Pictures show the environment where nothing hides it, in place of the background, also those that are not lit. Not
  /// figures, pictures of scans, or other blends than linear.
  bool shows_environment = false;
  /// Stops, -32 to 32: light is multiplied by 2^exposure before tone mapping; unlit materials stay as they are.
  double exposure = 0;
  ToneMapping tone_mapping = ToneMapping::none;
  /// Towards the key light, in the world, of any length but zero. None: the camera's upper left.
  std::optional<glm::dvec3> direction = std::nullopt;
  /// Multiplies the key light, 0 to 1e6; 0 leaves it out. None: 1, and 0 beside an environment from a picture, which
  /// has lights of its own.
  std::optional<double> intensity = std::nullopt;
};

/// What lies one behind another.
struct LayerOptions {
  SeeThrough see_through = SeeThrough::where_needed;
  int grid = 0;  ///< the A-buffer's sub-samples: as AbufferOptions::grid
};

/// How the pixels of a picture are found.
struct PixelOptions {
  Blend blend = Blend::linear;                 ///< not of deep images or figures
  ShadingRate rate = ShadingRate::each_pixel;  ///< of views; not of scans, deep images or figures
};

struct ShadeOptions {
  Shading shading = Shading::lit;
  /// sRGB, 0 to 1. None: transparent.
  std::optional<glm::vec3> background = glm::vec3(1.0f);
  /// Multiplies the opacity of everything, 0 to 1. Of lit, flat and normals.
  float opacity = 1.0f;
  LightOptions light = {};   ///< of lit
  LayerOptions layers = {};  ///< of lit, flat and normals
  PixelOptions pixels = {};  ///< of lit, flat and normals
};

/// What is to be shaded, and what a caller may have found already of what shadows need. Borrows everything.
struct ShadeInput {
  /// What is visible in the view: front-most, at every sample. One of both is given.
  const Visible* visible = nullptr;
  const VisiblePixels* pixels = nullptr;  ///< for all shadings but depth; not for figures
  /// For Shadows::map of the key light: what is visible in key_light_view(). Null: shade() finds what is visible of the
  /// surfaces there.
  const Visible* seen_by_light = nullptr;
  /// For Shadows::rays: that of the surfaces. Null: shade() makes one, as it does where materials are see-through.
  const RayIndex* index = nullptr;

  /// At every sample, or of `pixels` at the first.
  [[nodiscard]] const Visible& first() const { return pixels ? pixels->first : *visible; }
  [[nodiscard]] const View& view() const { return pixels ? pixels->view : visible->view; }
};

/// A scan that is to be shaded, of cameras all around. Borrows everything.
struct ScanInput {
  const RangeScan* scan = nullptr;
  /// That of the surfaces, for Shadows::rays and for what is seen through. Null: shade() makes one where it needs it.
  const RayIndex* index = nullptr;
};

/// The view in which the key light sees what `visible` shows: whatever is visible in it is lit, the rest in shadow. For
/// pictures made of parts, of which shade() is given only the triangles that are seen; `bounds` are those of the whole.
/// None where nothing is visible, or where there is no key light. O(pixels).
/// \throws Error bad_argument for light options out of range.
[[nodiscard]] std::optional<View> key_light_view(const Visible& visible, const Box& bounds,
                                                 const LightOptions& light = {}, const Execution& execution = {});

/// A picture with channels R, G, B, A. Shades once per pixel and primitive and averages over the samples.
/// Where something is visible that can be seen through, or the opacity is below 1, the A-buffer of the same view says
/// all that is seen, in true order at every sample: of 64 x 64 pixels at a time, or of all with a grid of sub-samples.
/// \throws Error bad_argument for an opacity, a grid, ambient occlusion or light options out of range; limit_exceeded
/// for more than 4096 lights that count, or where shadows by rays are too much work; unsupported for depths of pixels.
/// Borrows everything; O(covered pixels). The bytes do not depend on threads or instruction set.
[[nodiscard]] Image shade(const Surfaces& surfaces, const ShadeInput& input, const ShadeOptions& options = {},
                          const Execution& execution = {});
/// The same of nothing but what is visible.
[[nodiscard]] Image shade(const Surfaces& surfaces, const Visible& visible, const ShadeOptions& options = {},
                          const Execution& execution = {});
[[nodiscard]] Image shade(const Surfaces& surfaces, const VisiblePixels& pixels, const ShadeOptions& options = {},
                          const Execution& execution = {});

/// The same picture as a PNG file of shade()'s holds it, to the byte, without the planes of floats that are four times
/// as large: for pictures that are only to be shown or saved.
[[nodiscard]] Bitmap shade_bitmap(const Surfaces& surfaces, const ShadeInput& input, const ShadeOptions& options = {},
                                  const Execution& execution = {});
[[nodiscard]] Bitmap shade_bitmap(const Surfaces& surfaces, const Visible& visible, const ShadeOptions& options = {},
                                  const Execution& execution = {});
[[nodiscard]] Bitmap shade_bitmap(const Surfaces& surfaces, const VisiblePixels& pixels,
                                  const ShadeOptions& options = {}, const Execution& execution = {});

/// Every fragment of the picture by itself, nearest first: channels R, G, B (multiplied by A), A, Z and ZBack, and the
/// integers "primitive", "object" and "material". A is the part that a sample hides of what those before it leave
/// uncovered, at the options' sub-samples: laid over each other with nothing in between, samples give the picture that
/// shade() gives with SeeThrough::always over a transparent background, edges included. Z is the planar depth at the
/// pixel's centre; surfaces have no thickness, so ZBack is the same. O(fragments * sub-samples); 36 bytes a fragment,
/// twice that while it works. Options as for shade(). \throws Error as shade() and abuffer() do, unsupported for other
/// shadings than lit, flat and normals.
[[nodiscard]] DeepImage shade_deep(const Surfaces& surfaces, const ShadeInput& input, const ShadeOptions& options = {},
                                   const Execution& execution = {});
[[nodiscard]] DeepImage shade_deep(const Surfaces& surfaces, const Visible& visible, const ShadeOptions& options = {},
                                   const Execution& execution = {});

class Shader;
namespace shading {
struct PreparedScene;
PreparedScene& prepared(Shader& shader, const Execution& execution);  // for draw_figure() in sheets.h
}  // namespace shading

/// Shades pictures of the same surfaces one after another, each as the function of that name gives it, to the byte.
/// What does not depend on the view is made when the first picture needs it, and kept: textures' mip levels, smooth
/// normals, what throws shadows, the studio; and every light's map as long as the light sees the same. From the second
/// picture of a size on, views of opaque scenes allocate nothing, but for rays of shadows, the blend srgb and a shown
/// environment, as long as none needs more than those before: other materials, other meshes without normals, another
/// size. Memory: the last picture; a third of the texels that were seen; 12 bytes a triangle of meshes without normals;
/// up to 8.25 MiB of what a light sees, of 17 lights at most; half a megabyte a thread; surfaces of what is opaque
/// beside glass, and an index for rays, where they are needed. Not for several threads at once.
class Shader {
 public:
  /// Borrows the surfaces and their scene, which must stay as they are, but for what Surfaces::move() moves: each call
  /// shows it where it is. O(instances + materials).
  explicit Shader(const Surfaces& surfaces);
  ~Shader();
  Shader(Shader&&) noexcept;
  Shader& operator=(Shader&&) noexcept;
  Shader(const Shader&) = delete;
  Shader& operator=(const Shader&) = delete;

  /// The result stays as it is until the next shade() or take().
  const Image& shade(const ShadeInput& input, const ShadeOptions& options = {}, const Execution& execution = {});
  const Image& shade(const ScanInput& input, const ShadeOptions& options = {}, const Execution& execution = {});
  /// The result stays as it is until the next shade_bitmap() or take_bitmap().
  const Bitmap& shade_bitmap(const ShadeInput& input, const ShadeOptions& options = {},
                             const Execution& execution = {});
  [[nodiscard]] DeepImage shade_deep(const ShadeInput& input, const ShadeOptions& options = {},
                                     const Execution& execution = {});
  [[nodiscard]] Image normal_image(const Visible& visible, const Execution& execution = {});

  /// Move the last result out; the next one is allocated.
  [[nodiscard]] Image take();
  [[nodiscard]] Bitmap take_bitmap();

 private:
  friend shading::PreparedScene& shading::prepared(Shader& shader, const Execution& execution);
  struct State;
  std::unique_ptr<State> state_;
};

/// A picture of a scan, with the materials, lights and shadows of other pictures; once per pixel and primitive, and
/// averaged over the samples of the scan's camera. The key light is that of a pinhole in the same pose; the map of its
/// shadows holds what the scan sees. Textures are as sharp as the distance between neighbouring rays asks for. Where
/// materials are blended, or the opacity is below 1, the rays go on behind what they met first. `depth` is the range.
/// \throws Error bad_argument for a scan or options that do not fit. O(rays).
[[nodiscard]] Image shade(const Surfaces& surfaces, const ScanInput& input, const ShadeOptions& options = {},
                          const Execution& execution = {});
[[nodiscard]] Image shade(const Surfaces& surfaces, const RangeScan& scan, const ShadeOptions& options = {},
                          const Execution& execution = {});

/// World-space unit shading normals at the first sample: channels N.X, N.Y, N.Z; zero where nothing is seen.
[[nodiscard]] Image normal_image(const Surfaces& surfaces, const Visible& visible, const Execution& execution = {});

}  // namespace frontmost
