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

#include "frontmost/curved.h"
#include "frontmost/figure.h"
#include "frontmost/image.h"
#include "frontmost/ray_camera.h"
#include "frontmost/raycast.h"
#include "frontmost/surfaces.h"
#include "frontmost/visible.h"

namespace frontmost {

/// What the picture shows.
enum class Shading : std::uint8_t {
  lit,      ///< metallic-roughness, key light with shadow, sky and ground
  flat,     ///< base colour as it is, no light
  normals,  ///< world-space shading normals, 0.5 + 0.5 n
  depth,    ///< near bright, far dark, over the depths that are seen
  ids,      ///< a colour of its own for every object
  uv,       ///< texture coordinates as red and green
};

/// How the shadows of the key light are found.
enum class Shadows : std::uint8_t {
  off,   ///< none
  map,   ///< what the light sees on 256 to 1024 texels squared, as the picture needs, with edges a few of them wide
  rays,  ///< a ray to the light from every sample, exact: as sharp as the picture
};

/// How much of what lies one behind another a picture shows. Of lit, flat and normals alone.
enum class SeeThrough : std::uint8_t {
  where_needed,  ///< every layer, by the A-buffer, of scenes in which something can be seen through
  always,        ///< the same of opaque scenes: for the A-buffer's sub-samples
  never,         ///< what is visible, over the background
};

struct ShadeOptions {
  Shading shading = Shading::lit;
  /// sRGB, 0 to 1. None: transparent.
  std::optional<glm::vec3> background = glm::vec3(1.0f);
  Shadows shadows = Shadows::map;
  /// Multiplies the opacity of everything, 0 to 1. Lit, flat and normals alone.
  float opacity = 1.0f;
  SeeThrough see_through = SeeThrough::where_needed;
  /// The A-buffer's sub-samples: as AbufferOptions::grid.
  int grid = 0;
};

/// What is to be shaded, and what a caller may have found already of what shadows need. Borrows everything.
struct ShadeInput {
  ShadeInput(const Visible& what_is_visible, const Visible* light_sees = nullptr, const RayIndex* ray_index = nullptr)
      : visible(what_is_visible), seen_by_light(light_sees), index(ray_index) {}

  const Visible& visible;  ///< front-most
  /// For Shadows::map: what is visible in key_light_view(). Null: shade() finds what is visible of the surfaces there.
  const Visible* seen_by_light;
  /// For Shadows::rays: that of the surfaces. Null: shade() makes one, as it does where materials are see-through.
  const RayIndex* index;
};

/// The view in which the key light sees what `visible` shows: whatever is visible in it is lit, the rest in shadow. For
/// pictures made of parts, of which shade() is given only the triangles that are seen; `bounds` and `up` are those of
/// the whole. None where nothing is visible. O(pixels).
[[nodiscard]] std::optional<View> key_light_view(const Visible& visible, const Box& bounds, Axis up,
                                                 const Execution& execution = {});

/// A picture with channels R, G, B, A. Shades once per pixel and primitive and averages over the samples.
/// Where materials are blended, or the opacity is below 1, the A-buffer of the same view says all that is seen through,
/// in true order at every sample.
/// \throws Error bad_argument for an opacity or a grid out of range.
/// Borrows everything; O(covered pixels). The bytes do not depend on threads or instruction set.
[[nodiscard]] Image shade(const Surfaces& surfaces, const ShadeInput& input, const ShadeOptions& options = {},
                          const Execution& execution = {});

/// The same picture as a PNG file of shade()'s holds it, to the byte, without the planes of floats that are four times
/// as large: for pictures that are only to be shown or saved.
[[nodiscard]] Bitmap shade_bitmap(const Surfaces& surfaces, const ShadeInput& input, const ShadeOptions& options = {},
                                  const Execution& execution = {});

/// Every fragment of the picture by itself, nearest first: channels R, G, B (multiplied by A), A, Z and ZBack, and the
/// integers "primitive", "object" and "material". A is the part that a sample hides of what those before it leave
/// uncovered, at the options' sub-samples: laid over each other with nothing in between, samples give the picture that
/// shade() gives over a transparent background, edges included. Z is the planar depth at the pixel's centre; surfaces
/// have no thickness, so ZBack is the same.
/// O(fragments * sub-samples); 36 bytes a fragment, twice that while it works. Options as for shade().
/// \throws Error as shade() and abuffer() do, unsupported for other shadings than lit, flat and normals.
[[nodiscard]] DeepImage shade_deep(const Surfaces& surfaces, const ShadeInput& input, const ShadeOptions& options = {},
                                   const Execution& execution = {});

struct FigureOptions {
  /// Shading, shadows, opacity and the background count; see-through does not: figures are translucent where the scene
  /// is.
  ShadeOptions shade;
  /// Steps of 8-bit sRGB, 0 to 255, by which the colour of a polygon may differ from what is seen there. Where it
  /// varies by more it is cut. 255: a triangle has the colour of its middle, and is never cut for it.
  double tolerance = 6;
  /// True: what is hidden is left out. False: all polygons are there in the order of painting, one over the other.
  bool visible_only = true;
  /// Neighbours of one colour become one shape, where no later polygon covers any of them.
  bool merges_neighbours = false;
  /// More polygons are an error.
  std::size_t most_polygons = 2'000'000;
};

/// A picture of polygons, with the colours that shade() gives the same view, textures, shadows and smooth normals
/// included; of alpha mode MASK holes are left out. The order is the painter's, exact where surfaces pass through each
/// other. Against the hairlines that viewers leave between neighbours, polygons reach up to 4 pixels under what is
/// painted over them (the print trade's trapping). What is visible has one sample a pixel.
/// O(n log n) in the number of polygons, and the pixels that they cover. The same for any number of threads.
/// (M. Newell, R. Newell, T. Sancha. A Solution to the Hidden Surface Problem. 1972.)
/// \throws Error bad_argument for a Visible of more samples, an opacity or a tolerance out of range; limit_exceeded for
/// more polygons than FigureOptions::most_polygons, or triangles that pass through each other too often.
[[nodiscard]] Figure draw_figure(const Surfaces& surfaces, const ShadeInput& input, const FigureOptions& options = {},
                                 const Execution& execution = {});
/// The same of a view, which need not have one sample. \throws Error as validate(view) does, too.
[[nodiscard]] Figure draw_figure(const Surfaces& surfaces, const View& view, const FigureOptions& options = {},
                                 const Execution& execution = {});

/// Shades pictures of the same surfaces one after another, each as the function of that name gives it, to the byte.
/// What does not depend on the view is made when the first picture needs it, and kept: textures' mip levels, smooth
/// normals, what throws shadows; and the key light's map as long as the light sees the same. From the second picture of
/// a size on, opaque scenes without rays for shadows allocate nothing, as long as no picture needs more than those
/// before: other materials, other meshes without normals, another size. Memory: the last picture; a third of the
/// textures' texels that were seen; 12 bytes a triangle of meshes without normals; up to 8 MiB of what the light sees;
/// half a megabyte a thread; and, where they are needed, surfaces of what is opaque beside glass, and an index for
/// rays. Not for several threads at once; each call uses the threads that it is given.
class Shader {
 public:
  /// Borrows the surfaces and their scene, which must stay as they are. O(instances + materials).
  explicit Shader(const Surfaces& surfaces);
  ~Shader();
  Shader(Shader&&) noexcept;
  Shader& operator=(Shader&&) noexcept;
  Shader(const Shader&) = delete;
  Shader& operator=(const Shader&) = delete;

  /// The result stays as it is until the next shade() or take().
  const Image& shade(const ShadeInput& input, const ShadeOptions& options = {}, const Execution& execution = {});
  /// The result stays as it is until the next shade_bitmap() or take_bitmap().
  const Bitmap& shade_bitmap(const ShadeInput& input, const ShadeOptions& options = {},
                             const Execution& execution = {});
  [[nodiscard]] DeepImage shade_deep(const ShadeInput& input, const ShadeOptions& options = {},
                                     const Execution& execution = {});
  [[nodiscard]] Image normal_image(const Visible& visible, const Execution& execution = {});
  [[nodiscard]] Figure draw_figure(const ShadeInput& input, const FigureOptions& options = {},
                                   const Execution& execution = {});

  /// Move the last result out; the next one is allocated.
  [[nodiscard]] Image take();
  [[nodiscard]] Bitmap take_bitmap();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// A picture of a scan, one sample a pixel: `lit` by a light at the eye, from base colours without textures and the
/// planes of the triangles, all opaque and without shadows; `normals` are those of the planes, and `depth` is the
/// range. O(pixels). \throws Error unsupported for Shading::uv.
[[nodiscard]] Image shade(const Surfaces& surfaces, const RangeScan& scan, const ShadeOptions& options = {},
                          const Execution& execution = {});

/// The same where rays met curved surfaces, whose own normals count. Precondition: index and scan are of the scene.
[[nodiscard]] Image shade(const CurvedIndex& index, const Scene& scene, const CurvedScan& scan,
                          const ShadeOptions& options = {}, const Execution& execution = {});

/// World-space unit shading normals at the first sample: channels N.X, N.Y, N.Z; zero where nothing is seen.
[[nodiscard]] Image normal_image(const Surfaces& surfaces, const Visible& visible, const Execution& execution = {});

}  // namespace frontmost
