// SPDX-License-Identifier: Apache-2.0
// The visible points of a picture, for its lights: the eye, the resolution, and the places of the surfaces. Works for
// views and for scans alike.
#pragma once

#include "frontmost/raycast.h"
#include "frontmost/view.h"
#include "view/ray_volumes.h"

namespace frontmost::shading {

class SeenPoints {
 public:
  /// Both constructors borrow their argument.
  SeenPoints(const Visible& visible) : view(visible.view), visible_(&visible), rays_(view) {}
  SeenPoints(const RangeScan& scan) : view(view_in_pose(scan)), scan_(&scan), rays_(view) {}

  /// For a scan: a pinhole in the scan's pose with as many pixels; its projection means nothing.
  const View view;

  /// Calls visit(point) for the first sample of every `stride`-th pixel of a row; `point` is in world axes from the
  /// eye. Leaves out points that are too far away for sums of their coordinates.
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

}  // namespace frontmost::shading
