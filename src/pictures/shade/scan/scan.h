// SPDX-License-Identifier: Apache-2.0
// Pictures of scans: the hits of rays, with the same materials, lights and shadows as other pictures.
#pragma once

#include <functional>
#include <vector>

#include "frontmost/raycast.h"
#include "shade/tile.h"

namespace frontmost::shading {

inline constexpr int cube_faces = 6;

/// Ray directions in the axes of the camera's eye, not normalized; zero if there is no ray.
class ScanDirections {
 public:
  /// Borrows the camera.
  explicit ScanDirections(const RayCamera& camera);

  [[nodiscard]] glm::dvec3 at(int x, int y, int sample) const { return samples_[std::size_t(sample)](x, y); }
  /// The differences from the unit vector along a ray to those of the next column and row. Zero without neighbours.
  struct Steps {
    glm::dvec3 x{0}, y{0};
  };
  [[nodiscard]] Steps steps(int x, int y) const;

 private:
  using At = std::function<glm::dvec3(int, int)>;
  /// Returns the unit vector through the middle of a pixel, or zero if no ray goes there.
  [[nodiscard]] glm::dvec3 middle(const glm::ivec2& at) const;
  [[nodiscard]] glm::dvec3 step_to(const glm::ivec2& from, const glm::ivec2& step) const;

  glm::ivec2 grid_;
  std::vector<At> samples_;
  At middle_;
};

/// The rays of a scan on the faces of a cube around the eye.
///
///          +---------+        Shading needs rays that are affine over a screen. The rays of a panorama are not, but
///         /    up   /|        their intersections with a cube are: each face is the screen of a pinhole that looks
///        +---------+ | right  along an axis of the camera. So a fragment is a place on a face, triangles are set up
///        |         | +        for the faces that show them, and results are as exact as in a pinhole's picture.
///        |  ahead  |/
///        +---------+
///                             The steps from a pixel's ray to those of the next column and row are also expressed on
///                             the face. They convert changes per unit of the face to changes per pixel of the scan.
class ScanFaces {
 public:
  /// Borrows `store` and `large`, like TriangleSource.
  ScanFaces(const TriangleStore& store, const RayCamera& camera, const BitSet* large, bool has_texcoords);

  /// Returns the face on which a direction lies.
  [[nodiscard]] static int face_of(const glm::dvec3& direction);
  [[nodiscard]] const TriangleSource& source(int face) const { return sources_[std::size_t(face)]; }
  [[nodiscard]] glm::vec2 screen(int face, const glm::dvec3& direction) const;
  /// Returns how far the place on the screen moves if the direction changes by `step`.
  [[nodiscard]] glm::vec2 screen_step(int face, const glm::dvec3& direction, const glm::dvec3& step) const;

 private:
  double half_size_;  ///< units of a face's screen from its middle to its sides
  std::vector<TriangleSource> sources_;
};

/// The input for the tiles of a scan's picture. Borrows everything.
struct ScanLayer {
  const ScanFaces& faces;
  const ScanDirections& directions;
  const RangeScan& scan;
  bool has_textures;        ///< whether steps between neighbouring rays are needed
  bool merges;              ///< whether rays of a pixel that hit the same primitive become one fragment
  const RayIndex* through;  ///< null: nothing is see-through
  const Surfaces& surfaces;
  float opacity;  ///< factor of all opacities
};

/// A rectangle of a scan's pixels that one thread shades: hits of rays become fragments on the faces of the cube, which
/// are shaded face by face and summed.
///
///   rays of a pixel    a a b a        one fragment for a and one for b, at the mean of their rays; one for each ray if
///                                     shadows are asked for ray by ray
///   through glass      a - c - d      fragments one behind another, composited for each ray, nearest first
///
/// The object serves one thread, and is used again for every tile and picture.
class ScanTileWork {
 public:
  ScanTileWork() : pixels_(tile_pixels) {}
  /// Starts a picture, and borrows all arguments. Must come before shade().
  void begin(const ScanLayer& layer, const FragmentShader::Colorist& colorist, Isa isa);

  /// Computes the premultiplied colour of each pixel, row by row, as a mean over its samples. \returns false if the
  /// tile is empty.
  bool shade(const TileRectangle& tile);
  [[nodiscard]] const std::vector<glm::vec4>& pixels() const { return pixels_; }

 private:
  struct Fragment {
    PrimitiveId id;
    std::uint32_t pixel;
    bool begins_ray;  ///< whether this is the first fragment of its ray
    int face;
    float weight;
    glm::vec2 screen, step_x, step_y;
  };

  void find_fragments(const TileRectangle& tile);
  void add_pixel(const glm::ivec2& at, std::uint32_t pixel);
  void add_ray(const glm::ivec2& at, int sample, std::uint32_t pixel);
  void add(PrimitiveId id, std::uint32_t pixel, const glm::dvec3& direction, float weight);
  [[nodiscard]] bool is_seen_through(PrimitiveId id) const;
  void shade_face(int face);
  void flush();

  const ScanLayer* layer_ = nullptr;
  const FragmentShader::Colorist* colorist_ = nullptr;
  Isa isa_ = Isa::best;
  FragmentShader shader_;
  PixelSteps pixel_steps_;  ///< steps of the fragments in the shader
  std::vector<Fragment> fragments_;
  ScanDirections::Steps steps_;  ///< steps of the current pixel
  std::vector<glm::vec4> pixels_;
  glm::vec3 arriving_{1};  ///< share of the current ray that earlier fragments leave, by channel
};

class TileCanvas;
struct PreparedScene;

/// Everything from which a picture is made. `Input` is ShadeInput or ScanInput.
template <class Input>
struct RequestFor {
  PreparedScene& scene;
  const Input& input;
  const ShadeOptions& options;
  const Execution& execution;
};
using ScanRequest = RequestFor<ScanInput>;

/// Checks a request. \throws Error bad_argument for a scan whose planes or ids do not fit, or options out of range.
void check_scan(const ScanRequest& request);

/// Paints the picture of a scan. Precondition: check_scan().
void paint_scan(const ScanRequest& request, TileCanvas& canvas, const glm::vec4& background);

}  // namespace frontmost::shading
