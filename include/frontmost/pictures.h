// SPDX-License-Identifier: Apache-2.0
// Shading: the colour of what a method found visible. Shading comes last, and only where something is seen.
//
//   Visible ----> once for every pixel and primitive in it ----> normal, texture, light ----> R, G, B, A
//                     |                                              |
//                     Surfaces: attributes and materials             shadows: a map, or rays
//
// The cost of a material therefore does not depend on how much lies behind the visible surface. Colours are linear
// during shading.
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

// Environment: the light that arrives from all directions, prepared so that any surface can look it up.
//
//   a panorama, or code
//     --> an octahedron unfolded to a square                       reflected by smooth surfaces
//     --> the octahedron, blurred for eight roughnesses            reflected by rough surfaces
//     --> its mean, its first and its second moments               reflected by matt surfaces
//
// Directions follow Panorama: the middle of the picture is ahead, a quarter of the width to its right is right, and the
// upper side is up. In the axes of an environment x is right, y up and z behind.

class Environment;
namespace shading {
struct PrefilteredEnvironment;
const PrefilteredEnvironment& prefiltered(const Environment& environment);
}  // namespace shading

/// An environment is cheap to copy. Copies share the prepared maps, which never change, and several threads may use
/// them at once.
class Environment {
 public:
  /// Prepares an equirectangular picture with channels R, G and B, twice as wide as high, as load_environment() returns
  /// it. Keeps the picture, which LightOptions::shows_environment shows. O(pixels), in parallel; about 7 MB beside the
  /// picture, less for pictures below 1024 x 512.
  /// \throws Error bad_argument for other sizes and channels, or values outside 0 to max_environment_value;
  /// limit_exceeded above 16384 x 8192.
  explicit Environment(Image equirectangular, const Execution& execution = {});
  /// A neutral room, grey below and brighter above, with soft boxes that metals reflect. The brightest box stands in
  /// front of the model to the left, where the key light is. The room turns with the camera. Its light gives white matt
  /// surfaces a radiance of 0.15 if they face down, and of 0.36 if they face up. Takes about three milliseconds.
  [[nodiscard]] static Environment studio(const Execution& execution = {});
  /// A clear sky without a sun over dull ground. It is as bright as the studio.
  [[nodiscard]] static Environment sky(const Execution& execution = {});
  /// No light at all.
  [[nodiscard]] static Environment none();

  /// True for studio(), in which ahead is the camera's viewing direction. In other environments ahead is the direction
  /// in which NamedView::front looks.
  [[nodiscard]] bool turns_with_camera() const;
  /// The picture that the environment was made from, or null.
  [[nodiscard]] const Image* picture() const;

  /// Radiance that a surface of this roughness (0 to 1) reflects from the direction `towards` if it is seen head-on:
  /// the mean weighted by the GGX lobe and the cosine. `towards` is in the environment's axes, of any length but zero.
  [[nodiscard]] glm::vec3 radiance(const glm::vec3& towards, float roughness = 0) const;
  /// Radiance of a white matt surface with this unit normal: irradiance / pi, by spherical harmonics of order 2.
  /// (R. Ramamoorthi, P. Hanrahan. An Efficient Representation for Irradiance Environment Maps. SIGGRAPH 2001.)
  [[nodiscard]] glm::vec3 irradiance(const glm::vec3& normal) const;

 private:
  friend const shading::PrefilteredEnvironment& shading::prefiltered(const Environment& environment);
  explicit Environment(std::shared_ptr<const shading::PrefilteredEnvironment> made) : made_(std::move(made)) {}
  std::shared_ptr<const shading::PrefilteredEnvironment> made_;
};

/// The quantity that a picture shows.
enum class Shading : std::uint8_t {
  lit,      ///< metallic-roughness materials under a key light with shadow and an environment
  flat,     ///< base colour without light
  normals,  ///< world-space shading normals, 0.5 + 0.5 n
  depth,    ///< near is bright, far is dark, scaled to the range of depths in the picture
  ids,      ///< each object in its own colour
  uv,       ///< texture coordinates as red and green
};

/// The direct lights of lit pictures, in addition to the environment.
enum class Lights : std::uint8_t {
  key,   ///< the key light, which moves with the camera
  file,  ///< Scene::lights; a white matt surface that receives E lux has the value E / pi
  both,
  none,
};

/// Number of suns and spots that have shadow maps: the first ones of the scene.
inline constexpr std::size_t most_mapped_lights = 16;

/// How shadows are found. Only opaque materials cast shadows.
enum class Shadows : std::uint8_t {
  off,  ///< no shadows
  /// Shadow maps of 256 to 1024 texels squared, by the size of the picture; edges are a few texels wide. The key light
  /// and the first most_mapped_lights suns and spots of the scene have maps. Point lights cast no shadows, and spots
  /// cast none beyond 75 degrees from their axis.
  map,
  rays,  ///< a ray from every sample to every light; edges are as sharp as the picture
};

/// Whether a picture shows surfaces behind translucent ones. Ignored unless the shading is lit, flat or normals.
enum class SeeThrough : std::uint8_t {
  /// Every layer, by the A-buffer, in pixels where a see-through surface is visible; elsewhere the visible surface
  /// alone. Requires a Visible that holds the front-most surfaces of its view; use `never` for any other.
  where_needed,
  always,  ///< every layer in every pixel, opaque scenes included: for the A-buffer's sub-samples
  never,   ///< the visible surface alone, over the background
};

/// For how many pixels one colour is computed. Ignored unless the shading is lit, flat or normals.
/// (K. Vaidyanathan et al. Coarse Pixel Shading. High-Performance Graphics 2014.)
enum class ShadingRate : std::uint8_t {
  each_pixel,
  /// For pictures that are replaced at once: as few as a quarter of the colours are computed. In each block of 2 x 2
  /// pixels, pixels whose samples all see one and the same primitive share the colour of the first of them. In several
  /// layers, fragments share a colour if their primitives, samples and places in the lists agree. Triangle edges stay
  /// as sharp; textures, their holes, shadows and highlights get coarser.
  each_2x2,
};

/// The colour values in which translucent layers, and the samples of a pixel, are blended.
enum class Blend : std::uint8_t {
  linear,  ///< linear light, as in nature
  srgb,    ///< sRGB, as viewers of SVG and PDF blend: half-transparent red over white is darker
};

/// Ambient occlusion: nearby surfaces weaken the environment's light, so corners and contacts between objects are
/// darker. The key light is not weakened. Occlusion is found from the depths of opaque materials in the picture, so its
/// cost does not depend on the model; surfaces that the eye does not see occlude nothing.
/// (J. Jimenez, X. Wu, A. Pesce, A. Jarabo. Practical Real-Time Strategies for Accurate Indirect Occlusion. 2016.)
struct AmbientOcclusion {
  double strength = 1;  ///< 0 (none) to 1 (all light that is occluded)
  /// Scene units: surfaces farther away occlude nothing, and the effect grows towards nearer ones. None: a tenth of the
  /// diagonal of find_subject().
  std::optional<double> radius = std::nullopt;
};

/// How values above 1, the greatest value of a picture, are brought into range.
enum class ToneMapping : std::uint8_t {
  none,  ///< each channel is clamped to 1
  /// Filmic: higher contrast, and bright colours fade to white. (S. Hill's fit of ACES 1.0, as in three.js, where it is
  /// called ACESFilmicToneMapping, and in other viewers.)
  aces,
  /// Khronos PBR Neutral: base colours up to 0.76 are kept, brighter ones fade to white.
  khronos,
};

/// The light of lit pictures: a key light, the scene's own lights, and an environment.
struct LightOptions {
  Shadows shadows = Shadows::map;
  Lights lights = Lights::key;
  std::optional<AmbientOcclusion> ambient_occlusion = std::nullopt;
  /// None: Environment::studio().
  std::optional<Environment> environment = std::nullopt;
  /// Radians: turns the environment about the scene's up axis, counter-clockwise seen from above. Finite.
  double environment_angle = 0;
  /// True: the environment is shown in place of the background, for every Shading. Not supported for figures, pictures
  /// of scans, and blends other than linear.
  bool shows_environment = false;
  /// Stops, -32 to 32: light is multiplied by 2^exposure before tone mapping. Unlit materials are unaffected.
  double exposure = 0;
  ToneMapping tone_mapping = ToneMapping::none;
  /// Direction towards the key light, world space, any length but zero. None: the camera's upper left.
  std::optional<glm::dvec3> direction = std::nullopt;
  /// Multiplies the key light, 0 to 1e6; 0 turns the key light off. None: 1, or 0 if the environment comes from a
  /// picture, which has lights of its own.
  std::optional<double> intensity = std::nullopt;
};

/// Translucent layers of a picture.
struct LayerOptions {
  SeeThrough see_through = SeeThrough::where_needed;
  int grid = 0;  ///< the A-buffer's sub-samples, as AbufferOptions::grid
};

/// How the colours of pixels are computed and blended.
struct PixelOptions {
  Blend blend = Blend::linear;                 ///< ignored for deep images and figures
  ShadingRate rate = ShadingRate::each_pixel;  ///< ignored for scans, deep images and figures
};

struct ShadeOptions {
  Shading shading = Shading::lit;
  /// sRGB, 0 to 1. None: transparent.
  std::optional<glm::vec3> background = glm::vec3(1.0f);
  /// Multiplies every opacity, 0 to 1. Ignored unless the shading is lit, flat or normals.
  float opacity = 1.0f;
  LightOptions light = {};   ///< all but a shown environment is ignored unless the shading is lit
  LayerOptions layers = {};  ///< ignored unless the shading is lit, flat or normals
  PixelOptions pixels = {};  ///< ignored unless the shading is lit, flat or normals
};

/// Visible surfaces to be shaded, and results for shadows that the caller already has. Borrows everything.
struct ShadeInput {
  /// The front-most surface at every sample of the view. Exactly one of `visible` and `pixels` is set.
  const Visible* visible = nullptr;
  const VisiblePixels* pixels = nullptr;  ///< not for Shading::depth, nor for figures
  /// For Shadows::map of the key light: what is visible in key_light_view(). Null: shade() computes it.
  const Visible* seen_by_light = nullptr;
  /// For Shadows::rays: the index of the surfaces. If it is null, or if there are see-through materials,
  /// shade() makes its own.
  const RayIndex* index = nullptr;

  /// The surface at every sample of `visible`, or at the first sample of each pixel of `pixels`.
  [[nodiscard]] const Visible& first() const { return pixels ? pixels->first : *visible; }
  [[nodiscard]] const View& view() const { return pixels ? pixels->view : visible->view; }
};

/// A scan to be shaded, from a camera that is no pinhole. Borrows everything.
struct ScanInput {
  const RangeScan* scan = nullptr;
  /// The index of the surfaces, for Shadows::rays and see-through materials. Null: shade() makes one where needed.
  const RayIndex* index = nullptr;
};

/// \returns the view in which the key light sees the surfaces of `visible`: surfaces that are visible in this view are
/// lit, all others are in shadow. It serves pictures in parts, for which shade() gets only the visible triangles;
/// `bounds` are those of the whole scene. None if nothing is visible, or if there is no key light. O(pixels).
/// \throws Error bad_argument for light options out of range.
[[nodiscard]] std::optional<View> key_light_view(const Visible& visible, const Box& bounds,
                                                 const LightOptions& light = {}, const Execution& execution = {});

/// \returns a picture with channels R, G, B, A. Each primitive is shaded once per pixel; the pixel's colour is the mean
/// over its samples. Where a see-through surface is visible, or `opacity` is below 1, the A-buffer of the same view
/// finds all layers in depth order. The A-buffer works on tiles of 64 x 64 pixels, or, with a grid of sub-samples, on
/// the whole picture. O(covered pixels). Borrows everything. The bytes do not depend on threads or instruction set.
/// \throws Error bad_argument for an opacity, a grid, ambient occlusion or light options out of range; limit_exceeded
/// for more than 4096 lights that count, or too much work for ray shadows; unsupported for Shading::depth of `pixels`.
[[nodiscard]] Image shade(const Surfaces& surfaces, const ShadeInput& input, const ShadeOptions& options = {},
                          const Execution& execution = {});
/// Shades `visible`, or `pixels`, if the caller has no results for shadows.
[[nodiscard]] Image shade(const Surfaces& surfaces, const Visible& visible, const ShadeOptions& options = {},
                          const Execution& execution = {});
[[nodiscard]] Image shade(const Surfaces& surfaces, const VisiblePixels& pixels, const ShadeOptions& options = {},
                          const Execution& execution = {});

/// \returns the picture of shade() as the bytes that a PNG file of the picture holds. A bitmap needs a quarter of the
/// memory of an image, so it suits pictures that are only shown or saved.
[[nodiscard]] Bitmap shade_bitmap(const Surfaces& surfaces, const ShadeInput& input, const ShadeOptions& options = {},
                                  const Execution& execution = {});
[[nodiscard]] Bitmap shade_bitmap(const Surfaces& surfaces, const Visible& visible, const ShadeOptions& options = {},
                                  const Execution& execution = {});
[[nodiscard]] Bitmap shade_bitmap(const Surfaces& surfaces, const VisiblePixels& pixels,
                                  const ShadeOptions& options = {}, const Execution& execution = {});

/// \returns every fragment of the picture, nearest first, with channels R, G, B (premultiplied), A, Z, ZBack and the
/// integers "primitive", "object" and "material". A is the share that the fragment hides of the part of the pixel that
/// nearer fragments leave uncovered, at the sub-samples of the options. Compositing all fragments over a transparent
/// background gives the picture that shade() makes with SeeThrough::always, edges included. Z and ZBack are the planar
/// depth at the pixel's centre.
/// O(fragments * sub-samples); 36 bytes a fragment, twice that while it works. Options as for shade().
/// \throws Error as shade() and abuffer() do; unsupported for shadings other than lit, flat and normals.
[[nodiscard]] DeepImage shade_deep(const Surfaces& surfaces, const ShadeInput& input, const ShadeOptions& options = {},
                                   const Execution& execution = {});
[[nodiscard]] DeepImage shade_deep(const Surfaces& surfaces, const Visible& visible, const ShadeOptions& options = {},
                                   const Execution& execution = {});

class Shader;
namespace shading {
struct PreparedScene;
PreparedScene& prepared(Shader& shader, const Execution& execution);  // for draw_figure() in sheets.h
}  // namespace shading

/// Shades pictures of the same surfaces one after another. Each member returns the same bytes as the function of its
/// name. Keeps data that do not depend on the view: mip levels, smooth normals, shadow casters, the studio; and each
/// light's shadow map, as long as what the light sees does not change. From the second picture of a size on, opaque
/// scenes need no allocation, except for Shadows::rays, Blend::srgb, a shown environment, or materials and meshes
/// without normals that come into sight. Memory: the last picture; a third of the visible texels; 12 bytes a triangle
/// of meshes without normals; up to 8.25 MiB for each of up to 17 shadow maps; half a megabyte a thread; where needed,
/// surfaces of the opaque part of a scene with glass, and an index for rays. Not for several threads at once.
class Shader {
 public:
  /// Borrows the surfaces and their scene, which must not change except by Surfaces::move(). Each call shows moved
  /// instances in their new places. O(instances + materials).
  explicit Shader(const Surfaces& surfaces);
  ~Shader();
  Shader(Shader&&) noexcept;
  Shader& operator=(Shader&&) noexcept;
  Shader(const Shader&) = delete;
  Shader& operator=(const Shader&) = delete;

  /// The result is valid until the next shade() or take().
  const Image& shade(const ShadeInput& input, const ShadeOptions& options = {}, const Execution& execution = {});
  const Image& shade(const ScanInput& input, const ShadeOptions& options = {}, const Execution& execution = {});
  /// The result is valid until the next shade_bitmap() or take_bitmap().
  const Bitmap& shade_bitmap(const ShadeInput& input, const ShadeOptions& options = {},
                             const Execution& execution = {});
  [[nodiscard]] DeepImage shade_deep(const ShadeInput& input, const ShadeOptions& options = {},
                                     const Execution& execution = {});
  [[nodiscard]] Image normal_image(const Visible& visible, const Execution& execution = {});

  /// Moves the last result out; the next call allocates a new one.
  [[nodiscard]] Image take();
  [[nodiscard]] Bitmap take_bitmap();

 private:
  friend shading::PreparedScene& shading::prepared(Shader& shader, const Execution& execution);
  struct State;
  std::unique_ptr<State> state_;
};

/// \returns a picture of a scan, with the same materials, lights and shadows as other pictures. Each primitive is
/// shaded once per pixel; the pixel's colour is the mean over the samples of the scan's camera. The key light is that
/// of a pinhole camera in the same pose, and its shadow map holds what the scan sees. Textures are filtered by the
/// distance between neighbouring rays. Behind blended materials, or with `opacity` below 1, the rays continue.
/// Shading::depth shows the range.
/// O(rays). \throws Error bad_argument for a scan or options that do not fit.
[[nodiscard]] Image shade(const Surfaces& surfaces, const ScanInput& input, const ShadeOptions& options = {},
                          const Execution& execution = {});
[[nodiscard]] Image shade(const Surfaces& surfaces, const RangeScan& scan, const ShadeOptions& options = {},
                          const Execution& execution = {});

/// World-space unit shading normals at the first sample: channels N.X, N.Y, N.Z; zero where nothing is seen.
[[nodiscard]] Image normal_image(const Surfaces& surfaces, const Visible& visible, const Execution& execution = {});

}  // namespace frontmost
