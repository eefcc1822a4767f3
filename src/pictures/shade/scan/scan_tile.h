// SPDX-License-Identifier: Apache-2.0
// A rectangle of a scan's pixels shaded by one thread: what its rays met becomes fragments on the faces of the cube,
// which are shaded face by face, and summed.
//
//   rays of a pixel    a a b a        one fragment for a and one for b, at the mean of their rays; by themselves where
//                                     shadows are asked for ray by ray
//   through glass      a - c - d      fragments one behind another: each ray's are laid over each other, nearest first
#pragma once

#include <span>
#include <vector>

#include "frontmost/raycast.h"
#include "shade/scan/scan_faces.h"
#include "shade/tile.h"

namespace frontmost::shading {

/// What the tiles of a scan's picture are made from. Borrows everything.
struct ScanLayer {
  const ScanFaces& faces;
  const ScanDirections& directions;
  const RangeScan& scan;
  bool has_textures;        ///< it matters how far apart neighbouring rays are
  bool merges;              ///< rays of a pixel that met the same primitive are one fragment
  const RayIndex* through;  ///< null: nothing is seen through
  const Surfaces& surfaces;
  float opacity;  ///< of everything
};

/// Reused from tile to tile and from picture to picture by one thread.
class ScanTileWork {
 public:
  ScanTileWork() : pixels_(tile_pixels) {}
  /// Starts a picture; borrows everything. Precondition of shade().
  void begin(const ScanLayer& layer, const FragmentShader::Colorist& colorist, Isa isa);

  /// Premultiplied means over the samples of each pixel, row by row of the tile. False where nothing is seen at all.
  bool shade(const TileRectangle& tile);
  [[nodiscard]] const std::vector<glm::vec4>& pixels() const { return pixels_; }

 private:
  struct Fragment {
    PrimitiveId id;
    std::uint32_t pixel;
    bool begins_ray;  ///< nothing is before it
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
  PixelSteps pixel_steps_;  ///< of the fragments that the shader holds
  std::vector<Fragment> fragments_;
  ScanDirections::Steps steps_;  ///< of the pixel that fragments are found of
  std::vector<glm::vec4> pixels_;
  glm::vec3 arriving_{1};  ///< the part of a ray that is left behind what was laid over it, by channel
};

}  // namespace frontmost::shading
