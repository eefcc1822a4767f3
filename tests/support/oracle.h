// SPDX-License-Identifier: Apache-2.0
// The oracle: every sample against every triangle, with nothing clever. Short enough to be believed by reading.
#pragma once

#include <algorithm>

#include "frontmost/visible.h"
#include "view/clip.h"
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

inline float oracle_key(const OracleTriangle& t, std::int64_t px, std::int64_t py) {
  const float area = float(oracle_area(t));
  const float x1 = float(t.x[1] - t.x[0]), y1 = float(t.y[1] - t.y[0]), k1 = t.key[1] - t.key[0];
  const float x2 = float(t.x[2] - t.x[0]), y2 = float(t.y[2] - t.y[0]), k2 = t.key[2] - t.key[0];
  const float gx = (k1 * y2 - k2 * y1) / area, gy = (x1 * k2 - x2 * k1) / area;
  const float key = (t.key[0] + float(px - t.x[0]) * gx) + float(py - t.y[0]) * gy;
  const auto [low, high] = std::minmax({t.key[0], t.key[1], t.key[2]});
  return std::min(std::max(key, low), high);
}

class Oracle {
 public:
  explicit Oracle(const View& view)
      : transform_(view),
        visible_{view, Buffer<PrimitiveId>(view.sample_count(), no_primitive),
                 Buffer<float>(view.sample_count(), 0.0f)} {}

  void draw(const std::array<glm::vec3, 3>& world, PrimitiveId id) {
    for (const glm::vec3& p : world)
      if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) return;
    const ClippedPolygon polygon = clip_triangle(transform_, world);
    for (std::size_t k = 2; k < std::size_t(polygon.count); ++k) {
      OracleTriangle t{};
      const ScreenVertex corners[3] = {polygon.corners[0], polygon.corners[k - 1], polygon.corners[k]};
      for (int v = 0; v < 3; ++v) {
        t.x[v] = corners[v].x + transform_.centre_x;
        t.y[v] = corners[v].y + transform_.centre_y;
        t.key[v] = corners[v].key;
      }
      t.id = id;
      draw(t);
    }
  }

  [[nodiscard]] const Visible& visible() const { return visible_; }

 private:
  void draw(OracleTriangle t) {
    const std::int64_t area = oracle_area(t);
    const bool front = area < 0;
    const Culling culling = visible_.view.culling;
    if (area == 0 || culling == Culling::both || (culling == Culling::back && !front) ||
        (culling == Culling::front && front))
      return;
    if (front) std::swap(t.x[1], t.x[2]), std::swap(t.y[1], t.y[2]), std::swap(t.key[1], t.key[2]);
    const auto samples = sample_offsets(visible_.view.samples);
    for (std::size_t s = 0; s < samples.size(); ++s)
      for (int y = 0; y < visible_.view.height; ++y)
        for (int x = 0; x < visible_.view.width; ++x) {
          const std::int64_t px = 256 * x + samples[s].x, py = 256 * y + samples[s].y;
          if (oracle_covers(t, px, py)) keep(visible_.index(x, y, int(s)), oracle_key(t, px, py), t.id);
        }
  }

  void keep(std::size_t at, float key, PrimitiveId id) {
    const bool nearer = visible_.primitives[at] == no_primitive || key > visible_.keys[at] ||
                        (key == visible_.keys[at] && id < visible_.primitives[at]);
    if (!nearer) return;
    visible_.keys[at] = key;
    visible_.primitives[at] = id;
  }

  ScreenTransform transform_;
  Visible visible_;
};

inline Visible oracle(const Surfaces& surfaces, const View& view) {
  Oracle oracle(view);
  for (PrimitiveId id = 0; id < surfaces.primitive_count(); ++id) {
    std::array<glm::vec3, 3> corners = surfaces.corners(id);
    if (surfaces.is_mirrored(surfaces.source(id).instance)) std::swap(corners[1], corners[2]);
    oracle.draw(corners, id);
  }
  return oracle.visible();
}

}  // namespace frontmost::test
