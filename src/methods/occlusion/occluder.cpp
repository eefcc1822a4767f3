// SPDX-License-Identifier: Apache-2.0
// Puts the vertices and triangles of an object on the screen.
#include "occlusion/occluder.h"

#include <cmath>

namespace frontmost::occlusion_detail {
namespace {

ScreenTurn turn_of(std::int64_t twice_area) {
  if (twice_area == 0) return ScreenTurn::none;
  // y goes down.
  return twice_area > 0 ? ScreenTurn::clockwise : ScreenTurn::counter_clockwise;
}

template <class Corner>
std::int64_t twice_area(const Corner& a, const Corner& b, const Corner& c) {
  return std::int64_t(b.x - a.x) * (c.y - a.y) - std::int64_t(c.x - a.x) * (b.y - a.y);
}

/// Returns whether a triangle keeps its turn if its corners move by up to two steps, more than snapping and rounding
/// move them.
template <class Corner>
bool is_turn_certain(const Corner& a, const Corner& b, const Corner& c) {
  const std::int64_t reach =
      std::int64_t(std::abs(b.x - a.x)) + std::abs(b.y - a.y) + std::abs(c.x - a.x) + std::abs(c.y - a.y);
  return std::abs(twice_area(a, b, c)) > 4 * reach + 32;
}

/// Returns whether each triangle without area on the screen has triangles with area beyond all its sides.
bool lies_along_others(const HidingObject& occluder, const OccluderOnScreen& on_screen) {
  const std::uint32_t first = occluder.part.first_triangle;
  for (std::uint32_t t = 0; t < on_screen.triangles.size(); ++t) {
    if (on_screen.triangles[t].turn != ScreenTurn::none) continue;
    for (int side = 0; side < 3; ++side) {
      const std::uint32_t beyond = occluder.mesh.neighbours[first + t][side];
      if (beyond == no_index || on_screen.triangles[beyond - first].turn == ScreenTurn::none) return false;
    }
  }
  return true;
}

}  // namespace

ScreenTurn turn_of(const ClippedPolygon& polygon) {
  bool turns[3] = {};
  for (int i = 2; i < polygon.count; ++i) {
    const auto& corners = polygon.corners;
    turns[int(turn_of(twice_area(corners[0], corners[std::size_t(i - 1)], corners[std::size_t(i)])))] = true;
  }
  const bool clockwise = turns[int(ScreenTurn::clockwise)],
             counter_clockwise = turns[int(ScreenTurn::counter_clockwise)];
  if (clockwise == counter_clockwise) return ScreenTurn::none;
  return clockwise ? ScreenTurn::clockwise : ScreenTurn::counter_clockwise;
}

float distance_rounding(const ScreenTransform& screen, const glm::vec3& world) {
  const glm::vec3 from_eye = glm::abs(world - glm::vec3(screen.eye[0], screen.eye[1], screen.eye[2]));
  return (from_eye.x + from_eye.y + from_eye.z) * (1.0f / (1 << 20));
}

void put_on_screen(const CellGrid& grid, const HidingObject& occluder, OccluderOnScreen& out) {
  const ScreenTransform& screen = grid.transform;
  const OccluderPart& part = occluder.part;
  const ToWorld to_world(occluder.world_from_mesh);
  out.world.resize(part.vertex_count);
  out.vertices.resize(part.vertex_count);
  for (std::uint32_t v = 0; v < part.vertex_count; ++v) {
    out.world[v] = to_world(occluder.mesh.positions[part.first_vertex + v]);
    const HomogeneousVertex h = transform(screen, out.world[v]);
    if (is_plain(screen, h)) {
      const ScreenVertex s = snap(screen, h);
      out.vertices[v] = {s.x, s.y, h.d + distance_rounding(screen, out.world[v])};
    } else {
      out.vertices[v] = {0, 0, std::numeric_limits<float>::quiet_NaN()};
    }
  }
  out.triangles.resize(part.triangle_count);
  out.cut.clear();
  out.has_certain_turns = true;
  for (std::uint32_t t = 0; t < part.triangle_count; ++t) {
    const glm::uvec3 c = occluder.mesh.triangles[part.first_triangle + t] - part.first_vertex;
    const VertexOnScreen &a = out.vertices[c.x], &b = out.vertices[c.y], &e = out.vertices[c.z];
    const float farthest = std::max({a.distance, b.distance, e.distance});
    if (!std::isnan(a.distance + b.distance + e.distance)) {
      out.triangles[t] = {turn_of(twice_area(a, b, e)), false, farthest};
      out.has_certain_turns = out.has_certain_turns && is_turn_certain(a, b, e);
      continue;
    }
    if (!is_finite(out.world[c.x]) || !is_finite(out.world[c.y]) || !is_finite(out.world[c.z])) {
      out.triangles[t] = {};
      continue;
    }
    out.cut.push_back({t, clip_triangle(screen, {out.world[c.x], out.world[c.y], out.world[c.z]})});
    float far = -std::numeric_limits<float>::infinity();
    for (int k = 0; k < 3; ++k)
      far = std::max(far, transform(screen, out.world[c[k]]).d + distance_rounding(screen, out.world[c[k]]));
    out.triangles[t] = {turn_of(out.cut.back().polygon), true, far};
  }
  out.is_told_by_cells = part.is_whole && out.cut.empty() && lies_along_others(occluder, out);
}

}  // namespace frontmost::occlusion_detail
