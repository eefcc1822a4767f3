// SPDX-License-Identifier: Apache-2.0
// The views of lights. Surfaces that are visible in the view of a light are lit by it, others are in its shadow.
//
//   key light   along its direction, at the visible points; it moves with the camera
//   sun         likewise, but with a larger window on a fixed grid: it stays while the camera moves a little
//   spot        from the lamp along its cone; the same for every camera
#pragma once

#include <optional>

#include "frontmost/raycast.h"
#include "frontmost/scene.h"
#include "frontmost/view.h"
#include "shade/batch.h"
#include "view/ray_volumes.h"

namespace frontmost::shading {

/// The visible points of a picture, for its lights: the eye, the resolution, and the places of the surfaces. Works for
/// views and for scans alike.
class SeenPoints {
 public:
  /// Both constructors borrow their argument.
  SeenPoints(const Visible& visible) : view(visible.view), visible_(&visible), rays_(view) {}
  SeenPoints(const RangeScan& scan) : view(view_in_pose(scan)), scan_(&scan), rays_(view) {}

  /// For a scan: a pinhole in the scan's pose with as many pixels; its projection means nothing.
  const View view;

  /// Calls visit(point) for the first sample of every `stride`-th pixel of a row. `point` is in world axes, relative to
  /// the eye. Leaves out points so far away that sums of their coordinates could overflow.
  template <class Visit>
  void visit_row(int y, int stride, const Visit& visit) const {
    constexpr double farthest = 1e30;
    for (int x = 0; x < view.width; x += stride) {
      if (visible_) {
        const std::size_t i = visible_->index(x, y);
        if (visible_->primitives[i] == no_primitive) continue;
        const double depth = double(depth_of_key(view, visible_->keys[i]));
        if (depth < farthest) visit(rays_.point(x + 0.5, y + 0.5, depth));
      } else if (scan_->ranges[scan_->index(x, y)] < float(farthest)) {
        visit(point_of(*scan_, x, y) - view.eye());
      }
    }
  }

 private:
  static View view_in_pose(const RangeScan& scan) {
    View view;
    view.width = scan.width;
    view.height = scan.height;
    view.world_from_eye = scan.camera.world_from_eye;
    return view;
  }

  const Visible* visible_ = nullptr;
  const RangeScan* scan_ = nullptr;
  ScreenRays rays_;
};

/// Returns the view of the key light. It looks along -to_light at the points of `visible`, with room for everything
/// within `bounds` that may stand between. Returns none if nothing is visible, or nothing can cast a shadow.
[[nodiscard]] std::optional<View> view_of_light(const SeenPoints& visible, const Box& bounds,
                                                const glm::dvec3& to_light, const Execution& execution);

/// Returns view_of_light() for a sun of the file, with the window on a fixed grid.
[[nodiscard]] std::optional<View> view_of_sun(const SeenPoints& visible, const Box& bounds, const Light& sun,
                                              const Execution& execution);

/// Returns the view of a spot of the file, for pictures of this size, or none if nothing can cast a shadow. The view
/// reaches at most 75 degrees from the axis; points beyond have no shadow.
[[nodiscard]] std::optional<View> view_of_spot(const View& picture, const Box& bounds, const Light& spot);

/// The data of a map in the form that the kernel reads.
struct ShadowGrid {
  static constexpr int taps = 8;     ///< taps of the filter along each axis
  static constexpr int block = 4;    ///< side length of a block in texels; `nearest` and `farthest` have a number for
                                     ///< each
  static constexpr int window = 12;  ///< side length in texels of the square that such a number summarizes

  int size = 0;                 ///< texels per side, a multiple of `block`; 0: everything is lit
  const float* keys = nullptr;  ///< row by row; greater is nearer to the light
  /// The greatest and the least key in each block's window, by rows of blocks. The window begins at the block, and
  /// contains every filter that begins in the block. Most points need no filter, because they are nearer than all keys
  /// of the window, or farther.
  const float *nearest = nullptr, *farthest = nullptr;
  glm::vec3 to_light{0};                     ///< for spots, opposite to their axis
  glm::vec3 texel_x{0}, texel_y{0}, key{0};  ///< change of texel x, texel y and key per unit step in the world
  glm::vec3 at_eye{0};                       ///< texel x, texel y and key at the eye
  float key_bias = 0, key_slope_bias = 0;
  // For spots, the texels are still to be divided by the key, which is depth / near. Biases are fractions of the key.
  bool is_spot = false;
  glm::vec3 lamp{0};  ///< position relative to the eye
};

/// Points in world axes from the eye, and normals of the flat surface there. Arrays have room for loops over whole
/// vectors.
struct ShadowPoints {
  static constexpr int most = batch_room;
  const float *x, *y, *z;
  const float *normal_x, *normal_y, *normal_z;
  int count;  ///< at most batch_capacity
};

/// The shadow map of one light: the light's view, drawn by the same z-buffer as pictures. Initially everything is lit.
/// Maps drawn one after another reuse the memory.
class ShadowMap {
 public:
  /// Makes the map from the view of the light as drawn. Borrows the keys.
  void draw(const Visible& seen_by_light, const Execution& execution);
  /// Sets the eye, to which points are relative. Precondition: something was drawn.
  void measure_from(const glm::dvec3& eye);
  /// Makes everything lit.
  void clear() { grid_.size = 0; }
  /// Returns the view that was drawn.
  [[nodiscard]] const View& view() const { return light_; }
  [[nodiscard]] const ShadowGrid& grid() const { return grid_; }

  /// Sets light[i] of each point that `is_asked` to the share of the light that arrives there, 0 to 1. Shadow edges are
  /// a few texels wide. Both arrays have room for loops over whole vectors.
  void find_light(const ShadowPoints& points, const bool* is_asked, float* light, Isa isa) const;

 private:
  View light_;
  ShadowGrid grid_;
  Buffer<float> nearest_, farthest_;
};

}  // namespace frontmost::shading
