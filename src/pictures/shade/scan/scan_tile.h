// SPDX-License-Identifier: Apache-2.0
// A rectangle of a scan's pixels that one thread shades: hits of rays become fragments on the faces of the cube, which
// are shaded face by face and summed.
//
//   rays of a pixel    a a b a        one fragment for a and one for b, at the mean of their rays; one for each ray if
//                                     shadows are asked for ray by ray
//   through glass      a - c - d      fragments one behind another, composited for each ray, nearest first
#pragma once

#include <span>
#include <vector>

#include "frontmost/raycast.h"
#include "shade/scan/scan_faces.h"
#include "shade/tile.h"

namespace frontmost::shading {

/// The input for the tiles of a scan's picture. Borrows everything.
struct ScanLayer {
  const ScanFaces& faces;
  const ScanDirections& directions;
  const RangeScan& scan;
  bool has_textures;        ///< distances between neighbouring rays are needed
  bool merges;              ///< rays of a pixel that hit the same primitive become one fragment
  const RayIndex* through;  ///< null: nothing is see-through
  const Surfaces& surfaces;
  float opacity;  ///< of all surfaces
};

/// Used by one thread, again for every tile and picture.
class ScanTileWork {
 public:
  ScanTileWork() : pixels_(tile_pixels) {}
  /// Starts a picture; borrows everything. Precondition of shade().
  void begin(const ScanLayer& layer, const FragmentShader::Colorist& colorist, Isa isa);

  /// Computes premultiplied means over the samples of each pixel, row by row. \returns false if the tile is empty.
  bool shade(const TileRectangle& tile);
  [[nodiscard]] const std::vector<glm::vec4>& pixels() const { return pixels_; }

 private:
  struct Fragment {
    PrimitiveId id;
    std::uint32_t pixel;
    bool begins_ray;  ///< it is the first of its ray
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
  PixelSteps pixel_steps_;  ///< of the fragments in the shader
  std::vector<Fragment> fragments_;
  ScanDirections::Steps steps_;  ///< of the current pixel
  std::vector<glm::vec4> pixels_;
  glm::vec3 arriving_{1};  ///< share of the current ray that earlier fragments leave, by channel
};

}  // namespace frontmost::shading
