// SPDX-License-Identifier: Apache-2.0
// Drawing one object alone: its triangles, placed as the z-buffer places them, marked on the canvas.
#pragma once

#include <vector>

#include "report/accounting/mask.h"
#include "surfaces/placed_scene.h"
#include "view/screen_cutout.h"
#include "zbuffer/place/place_kernel.h"

namespace frontmost::accounting_detail {

/// The picture and what is around it. Vertices lie on it where the picture has them, to the bit, moved by the margin.
struct ObjectCanvas {
  glm::ivec2 margin;          ///< in pixels, to the left of the picture and above it; negative where only a part is
  PixelRect frame;            ///< the picture, or its part, on the canvas
  View view;                  ///< of which the size, the samples and the culling are the canvas'
  ScreenTransform transform;  ///< to the canvas' top left corner
  ScreenRays rays;            ///< of the picture, about its own top left corner

  /// `scale`: AccountingOptions::canvas. Preconditions: the view is valid, and the scale in range.
  ObjectCanvas(const View& picture, double scale);
  /// A part of the picture alone. Preconditions: the view is valid, and the part not empty and within the picture.
  ObjectCanvas(const View& picture, const PixelRect& part);
};

/// Where the ranges of each instance begin among those of the scene, and the end of the last.
[[nodiscard]] std::vector<std::size_t> first_ranges(const PlacedScene& scene);

/// The mask of one object after another. For one thread; borrows everything.
class ObjectMask {
 public:
  ObjectMask(const PlacedScene& scene, const ObjectCanvas& canvas, Isa isa);

  /// Marks what the object of these ranges covers, in place of the one before.
  void draw(std::span<const MeshRange> ranges);

  /// By sample.
  [[nodiscard]] std::span<const MaskPlane> planes() const { return planes_; }
  /// Everything that is marked lies within; empty where nothing is.
  [[nodiscard]] const PixelRect& touched() const { return touched_; }
  /// Whether a triangle reaches across the near plane.
  [[nodiscard]] bool is_cut_by_near() const { return is_cut_by_near_; }

 private:
  void clear();
  /// Whether triangles that follow one another have vertices from all over the mesh: all of them are placed at once
  /// then.
  [[nodiscard]] bool is_strewn(std::span<const MeshRange> ranges) const;
  void draw_at_once(std::span<const MeshRange> ranges);
  /// Precondition: their vertices are those of the scratch.
  void draw_triangles(const WorldTriangles& triangles);
  void draw_small();
  void draw_large(const TriangleRecord& record);
  void draw_cutout(const TriangleRecord& record);
  void touch(const PixelRect& rect);

  const PlacedScene& scene_;
  const ObjectCanvas& canvas_;
  zbuffer_detail::PlaceTarget target_;
  Buffer<std::uint64_t> words_;
  std::vector<MaskPlane> planes_;
  zbuffer_detail::TriangleBatch batch_, cutout_batch_;
  zbuffer_detail::PlaceScratch scratch_;
  std::vector<TriangleRecord> large_, cutouts_;
  RowSpans spans_;
  PixelRect touched_;
  bool is_cut_by_near_ = false;
};

}  // namespace frontmost::accounting_detail
