// SPDX-License-Identifier: Apache-2.0
// The oracle: every sample against every triangle by the sample rule, without shortcuts.
#pragma once

#include "frontmost/raycast.h"
#include "raycast/tile/sample_rule.h"
#include "support/oracle.h"

namespace frontmost::test {

inline bool keeps(Culling culling, int facing) {
  return facing != 0 && culling != Culling::both && !(culling == Culling::back && facing > 0) &&
         !(culling == Culling::front && facing < 0);
}

class RayOracle {
 public:
  explicit RayOracle(const View& view) : t_(view), visible_(nothing_visible(view)) {}

  /// `cutout` holds the triangle's holes; may be null.
  void meet(const std::array<glm::vec3, 3>& world, PrimitiveId id, const ScreenCutout* cutout = nullptr) {
    cutout_ = cutout;
    const raycast_detail::SampleTriangle triangle = raycast_detail::make_triangle(t_, world);
    constexpr int tile = raycast_detail::kTileSize;
    for (int y = 0; y < visible_.view.height; y += tile)
      for (int x = 0; x < visible_.view.width; x += tile) {
        const float tx = float((x + tile / 2) * 256 - t_.centre_x), ty = float((y + tile / 2) * 256 - t_.centre_y);
        const raycast_detail::TileKeyPlane plane = raycast_detail::key_plane(visible_.view, t_, triangle, {tx, ty});
        if (plane.is_outside) continue;
        meet_tile({x, y}, {tx, ty}, triangle.corners, plane, id);
      }
  }

  [[nodiscard]] const Visible& visible() const { return visible_; }

 private:
  void meet_tile(const glm::ivec2& first, const glm::vec2& centre,
                 const std::array<raycast_detail::SampleCorner, 3>& corners, const raycast_detail::TileKeyPlane& plane,
                 PrimitiveId id) {
    const auto samples = sample_offsets(visible_.view.samples);
    const int x1 = std::min(first.x + raycast_detail::kTileSize, visible_.view.width);
    const int y1 = std::min(first.y + raycast_detail::kTileSize, visible_.view.height);
    for (std::size_t s = 0; s < samples.size(); ++s)
      for (int y = first.y; y < y1; ++y)
        for (int x = first.x; x < x1; ++x) {
          const float sx = float(256 * x + samples[s].x - t_.centre_x),
                      sy = float(256 * y + samples[s].y - t_.centre_y);
          if (!keeps(visible_.view.culling, raycast_detail::facing(t_, corners, sx, sy))) continue;
          const float raw = plane.raw(sx - centre.x, sy - centre.y);
          if (cutout_ && cutout_->is_hole(256 * x + samples[s].x, 256 * y + samples[s].y)) continue;
          if (plane.sees(raw)) keep_nearest(visible_, visible_.index(x, y, int(s)), plane.clamped(raw), id);
        }
  }

  ScreenTransform t_;
  Visible visible_;
  const ScreenCutout* cutout_ = nullptr;
};

inline Visible ray_oracle(const Surfaces& surfaces, const View& view) {
  RayOracle oracle(view);
  const OracleHoles holes(surfaces, view);
  for_each_primitive(surfaces, 0, no_primitive, [&](PrimitiveId id, const std::array<glm::vec3, 3>& world) {
    const std::optional<ScreenCutout> cutout = holes.of(id);
    oracle.meet(world, id, cutout ? &*cutout : nullptr);
  });
  return oracle.visible();
}

}  // namespace frontmost::test
