// SPDX-License-Identifier: Apache-2.0
// The methods of visibility behind two interfaces: all pixels of a view (look_at_surfaces) and single rays (RayScene).
// Callers choose the method once, by an index or by settings.
#include "cli/view/sight.h"

#include <frontmost/zbuffer.h>

namespace frontmost::cli {

DepthState depth_state(const DepthSettings& settings) {
  DepthState state;
  state.func = settings.func.value_or(settings.reversed ? DepthFunc::greater : DepthFunc::less);
  state.mask = settings.mask;
  state.range_near = settings.range.x;
  state.range_far = settings.range.y;
  state.nearer_is_greater = settings.reversed;
  state.offset = settings.offset;
  return state;
}

double depth_clear(const DepthSettings& settings) { return settings.clear.value_or(settings.reversed ? 0.0 : 1.0); }

SeenView look_at_surfaces(const Surfaces& surfaces, const View& view, const DepthSettings& settings,
                          const Execution& execution, const RayIndex* index) {
  if (index) return {raycast(*index, view, execution), {}};
  if (!settings.is_used) return {zbuffer(surfaces, view, execution), {}};
  DepthBuffer buffer(view.width, view.height, view.samples, settings.format);
  buffer.clear(depth_clear(settings));
  buffer.draw(surfaces, view, {.state = depth_state(settings)}, execution);
  Buffer<float> depths = buffer.depths();
  return {std::move(buffer).visible(view), std::move(depths)};
}

std::string_view name(DepthFormat format) {
  constexpr std::string_view names[] = {"D8", "D16", "D24", "F32"};
  return names[int(format)];
}

std::string_view name(DepthFunc func) {
  constexpr std::string_view names[] = {"NEVER", "LESS", "EQUAL", "LEQUAL", "GREATER", "NOTEQUAL", "GEQUAL", "ALWAYS"};
  return names[int(func)];
}

std::vector<RayHit> RayScene::closest(std::span<const Segment> segments, const Execution& execution) const {
  std::vector<RayHit> hits(segments.size());
  closest_hits(index, segments, hits, execution);
  return hits;
}

Image RayScene::ids(const RangeScan& scan, IdKind kind) const {
  const std::span<const PrimitiveId> primitives(scan.primitives.data(), scan.primitives.size());
  return id_image(surfaces, {scan.width, scan.height}, primitives, kind);
}

}  // namespace frontmost::cli
