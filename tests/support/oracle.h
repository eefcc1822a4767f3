// SPDX-License-Identifier: Apache-2.0
// The oracle: every sample against every triangle, without shortcuts. Short enough to be verified by reading.
#pragma once

#include <algorithm>
#include <optional>

#include "frontmost/view.h"
#include "surfaces/cluster_set.h"
#include "view/clip.h"
#include "view/screen_cutout.h"
#include "view/screen_transform.h"

namespace frontmost::test {

struct OracleTriangle {
  std::int64_t x[3], y[3];  // 1/256 pixel from the top left of the image
  float key[3];
  PrimitiveId id;
};

/// True when the sample at (px, py) is inside, or on a left or top edge. Precondition: positive area (y down).
inline bool oracle_covers(const OracleTriangle& t, std::int64_t px, std::int64_t py) {
  for (int a = 0; a < 3; ++a) {
    const int b = (a + 1) % 3;
    const std::int64_t dx = t.x[b] - t.x[a], dy = t.y[b] - t.y[a];
    const std::int64_t edge = dx * (py - t.y[a]) - dy * (px - t.x[a]);
    const bool left = dy < 0, top = dy == 0 && dx > 0;
    if (edge < 0 || (edge == 0 && !left && !top)) return false;
  }
  return true;
}

inline std::int64_t oracle_area(const OracleTriangle& t) {
  return (t.x[1] - t.x[0]) * (t.y[2] - t.y[0]) - (t.x[2] - t.x[0]) * (t.y[1] - t.y[0]);
}

/// The key in floats from the topmost vertex for gentle planes; for steep ones, by edge functions from the farthest
/// vertex, in doubles.
inline float oracle_key(const OracleTriangle& t, std::int64_t px, std::int64_t py) {
  const auto [low, high] = std::minmax({t.key[0], t.key[1], t.key[2]});
  const auto [x_min, x_max] = std::minmax({t.x[0], t.x[1], t.x[2]});
  const auto [y_min, y_max] = std::minmax({t.y[0], t.y[1], t.y[2]});
  int top = 0, far = 0;
  for (int k = 1; k < 3; ++k) {
    if (std::pair(t.y[k], t.x[k]) < std::pair(t.y[top], t.x[top])) top = k;
    if (t.key[k] < t.key[far]) far = k;
  }
  const int p = (far + 1) % 3, q = (far + 2) % 3;
  const auto edge = [&](int a, int b, std::int64_t x, std::int64_t y) {
    return double((t.x[b] - t.x[a]) * (y - t.y[a]) - (t.y[b] - t.y[a]) * (x - t.x[a]));
  };
  const double area = double(oracle_area(t)), far_key = double(t.key[far]);
  // The gradient of a gentle plane is exact, so it may also be computed here.
  const double to_p = double(t.key[p]) - far_key, to_q = double(t.key[q]) - far_key;
  const float gx = float((to_p * double(t.y[q] - t.y[far]) - to_q * double(t.y[p] - t.y[far])) * (1 / area));
  const float gy = float((to_q * double(t.x[p] - t.x[far]) - to_p * double(t.x[q] - t.x[far])) * (1 / area));
  const float limit = low - 1e-30f;
  float key;
  if (std::abs(gx) * float(x_max - x_min) + std::abs(gy) * float(y_max - y_min) <= 4 * limit && high - low <= 2 * limit)
    key = (t.key[top] + float(px - t.x[top]) * gx) + float(py - t.y[top]) * gy;
  else
    key = float(far_key + (edge(q, far, px, py) * (to_p / area) + edge(far, p, px, py) * (to_q / area)));
  return std::min(std::max(key, low), high);
}

/// Calls visit(id, corners) for potentially visible primitives of [begin, end): finite corners in world space, with the
/// winding of mirrored instances reversed.
template <class Visit>
void for_each_primitive(const Surfaces& surfaces, PrimitiveId begin, PrimitiveId end, const Visit& visit) {
  for (PrimitiveId id = begin; id < std::min(end, surfaces.primitive_count()); ++id) {
    std::array<glm::vec3, 3> corners = surfaces.corners(id);
    if (surfaces.is_mirrored(surfaces.source(id).instance)) std::swap(corners[1], corners[2]);
    bool finite = true;
    for (const glm::vec3& p : corners)
      finite = finite && std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
    if (finite) visit(id, corners);
  }
}

/// Calls visit(triangle) for the parts of a primitive that clipping and culling leave, turned to positive area.
template <class Visit>
void for_each_triangle(const ScreenTransform& transform, Culling culling, const ClippedPolygon& polygon, PrimitiveId id,
                       const Visit& visit) {
  for (std::size_t k = 2; k < std::size_t(polygon.count); ++k) {
    OracleTriangle t{};
    const ScreenVertex corners[3] = {polygon.corners[0], polygon.corners[k - 1], polygon.corners[k]};
    for (int v = 0; v < 3; ++v) {
      t.x[v] = corners[v].x + transform.centre_x;
      t.y[v] = corners[v].y + transform.centre_y;
      t.key[v] = corners[v].key;
    }
    t.id = id;
    const std::int64_t area = oracle_area(t);
    const bool front = area < 0;
    if (area == 0 || culling == Culling::both || (culling == Culling::back && !front) ||
        (culling == Culling::front && front))
      continue;
    if (front) std::swap(t.x[1], t.x[2]), std::swap(t.y[1], t.y[2]), std::swap(t.key[1], t.key[2]);
    visit(t);
  }
}

/// Holes of triangles, as a view sees them.
class OracleHoles {
 public:
  OracleHoles(const Surfaces& surfaces, const View& view)
      : cutouts_(placed_scene(surfaces).cutouts.get()), rays_(view) {}
  [[nodiscard]] std::optional<ScreenCutout> of(PrimitiveId id) const {
    if (!cutouts_ || !cutouts_->has(id)) return std::nullopt;
    return ScreenCutout((*cutouts_)[id], rays_);
  }

 private:
  const Cutouts* cutouts_;
  ScreenRays rays_;
};

/// Calls visit(index, key) for every sample that a triangle covers, except in holes.
template <class Visit>
void for_each_covered(const Visible& visible, const OracleTriangle& t, const Visit& visit,
                      const std::optional<ScreenCutout>& cutout = std::nullopt) {
  const auto samples = sample_offsets(visible.view.samples);
  for (std::size_t s = 0; s < samples.size(); ++s)
    for (int y = 0; y < visible.view.height; ++y)
      for (int x = 0; x < visible.view.width; ++x) {
        const std::int64_t px = 256 * x + samples[s].x, py = 256 * y + samples[s].y;
        if (!oracle_covers(t, px, py)) continue;
        if (cutout && cutout->is_hole(std::int32_t(px), std::int32_t(py))) continue;
        visit(visible.index(x, y, int(s)), oracle_key(t, px, py));
      }
}

/// Keeps a fragment if it is nearer than the kept one, or equally near with a lower id.
inline void keep_nearest(Visible& visible, std::size_t at, float key, PrimitiveId id) {
  const bool nearer = visible.primitives[at] == no_primitive || key > visible.keys[at] ||
                      (key == visible.keys[at] && id < visible.primitives[at]);
  if (!nearer) return;
  visible.keys[at] = key;
  visible.primitives[at] = id;
}

inline Visible oracle(const Surfaces& surfaces, const View& view) {
  const ScreenTransform transform(view);
  const OracleHoles holes(surfaces, view);
  Visible visible = nothing_visible(view);
  for_each_primitive(surfaces, 0, no_primitive, [&](PrimitiveId id, const std::array<glm::vec3, 3>& world) {
    const std::optional<ScreenCutout> cutout = holes.of(id);
    for_each_triangle(transform, view.culling, clip_triangle(transform, world), id, [&](const OracleTriangle& t) {
      for_each_covered(
          visible, t, [&](std::size_t at, float key) { keep_nearest(visible, at, key, id); }, cutout);
    });
  });
  return visible;
}

}  // namespace frontmost::test
