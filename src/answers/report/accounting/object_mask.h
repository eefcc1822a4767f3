// SPDX-License-Identifier: Apache-2.0
// Drawing one object alone: its triangles are placed as in the z-buffer and marked on the canvas.
#pragma once

#include <vector>

#include "report/accounting/mask.h"
#include "surfaces/placed_scene.h"
#include "view/screen_cutout.h"
#include "zbuffer/place/triangle_batch.h"

namespace frontmost::accounting_detail {

/// The picture and its surroundings. Vertices have the picture's positions, to the bit, shifted by the margin.
struct ObjectCanvas {
  glm::ivec2 margin;          ///< pixels to the left of the picture and above it; negative for a part of the picture
  PixelRect frame;            ///< the picture, or the part of it, on the canvas
  View view;                  ///< only its size, samples and culling are the canvas'
  ScreenTransform transform;  ///< relative to the canvas' top left corner
  ScreenRays rays;            ///< of the picture, relative to the picture's top left corner

  /// `scale`: AccountingOptions::canvas. Preconditions: the view is valid, and the scale in range.
  ObjectCanvas(const View& picture, double scale);
  /// A canvas of a part of the picture. Preconditions: the view is valid; the part is not empty and lies within the
  /// picture.
  ObjectCanvas(const View& picture, const PixelRect& part);
};

/// Index of the first range of each instance, and the number of all ranges.
[[nodiscard]] std::vector<std::size_t> first_ranges(const PlacedScene& scene);

/// Draws the mask of one object after another. For one thread; borrows everything.
class ObjectMask {
 public:
  ObjectMask(const PlacedScene& scene, const ObjectCanvas& canvas, Isa isa);

  /// Marks what the object of these ranges covers. Replaces the mask of the object before.
  void draw(std::span<const MeshRange> ranges);

  /// One plane for each sample number.
  [[nodiscard]] std::span<const MaskPlane> planes() const { return planes_; }
  /// A rectangle around all marked samples; empty if none is marked.
  [[nodiscard]] const PixelRect& touched() const { return touched_; }
  /// Whether a triangle reaches across the near plane.
  [[nodiscard]] bool is_cut_by_near() const { return is_cut_by_near_; }

 private:
  void clear();
  /// Whether consecutive triangles have vertices from all over the mesh. All vertices are then placed at once.
  [[nodiscard]] bool is_strewn(std::span<const MeshRange> ranges) const;
  void draw_at_once(std::span<const MeshRange> ranges);
  /// Precondition: the scratch holds the vertices of these triangles.
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
