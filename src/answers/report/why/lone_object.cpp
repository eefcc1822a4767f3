// SPDX-License-Identifier: Apache-2.0
#include "report/why/lone_object.h"

#include <algorithm>
#include <cmath>

#include "frontmost/report.h"
#include "report/accounting/object_mask.h"

namespace frontmost::why_detail {
namespace {

constexpr Execution kOneThread{.threads = 1};

Scene scene_of_one(const Scene& scene, std::uint32_t object) {
  const Instance& instance = scene.instances[object];
  const Mesh& mesh = scene.meshes[instance.mesh];
  Scene lone;
  lone.meshes.emplace_back();
  lone.meshes[0].positions = mesh.positions;
  lone.meshes[0].triangles = mesh.triangles;
  lone.instances.push_back({"", 0, instance.world_from_mesh});
  return lone;
}

/// The pixels that a range of positions touches, at least one, within the picture.
struct PixelStretch {
  int first, count;

  PixelStretch(const ValueRange& extent, int size)
      : first(std::clamp(int(std::floor(extent.low)), 0, size - 1)),
        count(std::clamp(int(std::ceil(extent.high)) - first, 1, size - first)) {}
};

/// The pixels where the object may appear in a picture with `factor` times the width and height, with room for the
/// snapping of corners.
accounting_detail::PixelRect touched_pixels(const View& enlarged, const ObjectPlaces& places, int factor) {
  const auto stretch = [factor](const ValueRange& extent, int size) {
    return PixelStretch({extent.low * factor - 1, extent.high * factor + 1}, size);
  };
  const PixelStretch columns = stretch(places.columns, enlarged.width), rows = stretch(places.rows, enlarged.height);
  return {columns.first, rows.first, columns.first + columns.count - 1, rows.first + rows.count - 1};
}

/// The part of a view with these pixels, at the same scale.
View cropped(const View& view, const PixelStretch& columns, const PixelStretch& rows) {
  const Projection& whole = view.projection;
  const double across = (whole.right - whole.left) / view.width, down = (whole.top - whole.bottom) / view.height;
  View part = view;
  part.width = columns.count;
  part.height = rows.count;
  part.projection.left = whole.left + across * columns.first;
  part.projection.right = whole.left + across * (columns.first + columns.count);
  part.projection.top = whole.top - down * rows.first;
  part.projection.bottom = whole.top - down * (rows.first + rows.count);
  return part;
}

}  // namespace

LoneObject::LoneObject(const Scene& scene, std::uint32_t object)
    : scene_(scene_of_one(scene, object)), surfaces_(scene_, kOneThread) {}

bool LoneObject::has_sample(const View& view, const ObjectPlaces& places, int factor) const {
  if (places.columns.is_empty()) return false;
  View enlarged = view;
  enlarged.width *= factor;
  enlarged.height *= factor;
  const accounting_detail::ObjectCanvas canvas(enlarged, touched_pixels(enlarged, places, factor));
  accounting_detail::ObjectMask mask(placed_scene(surfaces_), canvas, Isa::best);
  mask.draw(placed_scene(surfaces_).ranges);
  const auto is_marked = [&](const accounting_detail::MaskPlane& plane) {
    return accounting_detail::count_marked(plane, mask.touched(), Isa::best).count > 0;
  };
  return !mask.touched().is_empty() && std::any_of(mask.planes().begin(), mask.planes().end(), is_marked);
}

double LoneObject::area(const View& view, const ObjectPlaces& places) const {
  if (places.columns.is_empty()) return 0;
  const View part = cropped(view, PixelStretch(places.columns, view.width), PixelStretch(places.rows, view.height));
  double pixels = 0;
  for (const VisibleFace& face : visible_faces(surfaces_, part, kOneThread).faces) pixels += face.pixels;
  return pixels;
}

}  // namespace frontmost::why_detail
