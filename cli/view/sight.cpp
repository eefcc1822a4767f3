// SPDX-License-Identifier: Apache-2.0
// The ways to look, behind two faces: at all pixels of a view (look_at_surfaces) and along single rays (RayScene).
// Callers name the way once, by an index or by settings, and do not branch again.
#include "cli/view/sight.h"

#include <frontmost/tessellate.h>
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

CurvedScan RayScene::scan(const RayCamera& camera, const Execution& execution) const {
  if (curved) return frontmost::scan(*curved, camera, execution);
  return {frontmost::scan(*triangles, camera, execution), {}};
}

std::vector<CurvedHit> RayScene::closest(std::span<const Segment> segments, const Execution& execution) const {
  std::vector<CurvedHit> hits(segments.size());
  if (curved) {
    closest_hits(*curved, segments, hits, execution);
    return hits;
  }
  std::vector<RayHit> flat(segments.size());
  closest_hits(*triangles, segments, flat, execution);
  for (std::size_t i = 0; i < hits.size(); ++i) {
    hits[i].primitive = flat[i].primitive;
    hits[i].t = flat[i].t;
    hits[i].is_front = flat[i].is_front;
  }
  return hits;
}

PrimitiveSource RayScene::source(PrimitiveId id) const { return curved ? curved->source(id) : surfaces.source(id); }

RayElement RayScene::element(PrimitiveId id) const {
  const PrimitiveSource from = source(id);
  const Mesh& mesh = scene().meshes[from.mesh];
  if (!curved || !mesh.is_curved()) return {from.instance, "triangle", from.triangle};
  const auto spheres = std::uint32_t(mesh.spheres.size());
  if (from.triangle < spheres) return {from.instance, "sphere", from.triangle};
  return {from.instance, "patch", from.triangle - spheres};
}

Image RayScene::ids(const RangeScan& scan, IdKind kind) const {
  const std::span<const PrimitiveId> primitives(scan.primitives.data(), scan.primitives.size());
  return id_image(
      scene(), [&](PrimitiveId id) { return source(id); }, {scan.width, scan.height}, primitives, kind);
}

Buffer<float> RayScene::incidences(const CurvedScan& scan, const Execution& execution) const {
  return curved ? incidence_angles(scan, execution) : incidence_angles(scan.scan, surfaces, execution);
}

OwnRayScene::OwnRayScene(const Surfaces& surfaces, const Execution& execution) : surfaces_(surfaces) {
  if (has_curved(surfaces.scene()))
    curved_.emplace(surfaces.scene(), execution);
  else
    triangles_.emplace(surfaces, execution);
}

}  // namespace frontmost::cli
