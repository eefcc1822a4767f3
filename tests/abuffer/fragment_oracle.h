// SPDX-License-Identifier: Apache-2.0
// The A-buffer by brute force: every sub-sample of every pixel against every triangle. Also a view that its tests
// share.
#pragma once

#include <algorithm>
#include <map>

#include "frontmost/abuffer.h"
#include "support/oracle.h"

namespace frontmost::test {

/// Clipped triangles on the screen, turned to positive area, without culled ones.
inline std::vector<OracleTriangle> screen_triangles(const Surfaces& surfaces, const View& view) {
  const ScreenTransform transform(view);
  std::vector<OracleTriangle> triangles;
  for_each_primitive(surfaces, 0, no_primitive, [&](PrimitiveId id, const std::array<glm::vec3, 3>& world) {
    for_each_triangle(transform, view.culling, clip_triangle(transform, world), id,
                      [&](const OracleTriangle& t) { triangles.push_back(t); });
  });
  return triangles;
}

/// Positions of sub-samples in 1/256 pixel.
inline std::vector<glm::ivec2> oracle_samples(const View& view, int grid) {
  std::vector<glm::ivec2> result;
  if (grid == 0) {
    const auto own = sample_offsets(view.samples);
    return {own.begin(), own.end()};
  }
  for (int y = 0; y < grid; ++y)
    for (int x = 0; x < grid; ++x) result.push_back({128 * (2 * x + 1) / grid, 128 * (2 * y + 1) / grid});
  return result;
}

struct OracleFragment {
  std::uint64_t mask;
  PrimitiveId id;
  float key;  ///< at the pixel's centre
  const OracleTriangle* triangle;
};

/// Fragments of one pixel, in the order of keys at the centre, then ids, then masks.
inline std::vector<OracleFragment> oracle_fragments(const std::vector<OracleTriangle>& triangles,
                                                    const std::vector<glm::ivec2>& samples, int x, int y) {
  std::vector<OracleFragment> list;
  for (const OracleTriangle& t : triangles) {
    std::uint64_t mask = 0;
    for (std::size_t s = 0; s < samples.size(); ++s)
      if (oracle_covers(t, 256 * x + samples[s].x, 256 * y + samples[s].y)) mask |= std::uint64_t(1) << s;
    if (mask) list.push_back({mask, t.id, oracle_key(t, 256 * x + 128, 256 * y + 128), &t});
  }
  std::sort(list.begin(), list.end(), [](const OracleFragment& a, const OracleFragment& b) {
    return a.key != b.key ? a.key > b.key : a.id != b.id ? a.id < b.id : a.mask < b.mask;
  });
  return list;
}

/// Premultiplied mean over the sub-samples of the composited fragments, in double, in the order at each sub-sample.
inline glm::dvec4 oracle_pixel(const std::vector<OracleFragment>& list, const std::vector<glm::ivec2>& samples, int x,
                               int y, std::span<const glm::vec4> colors, double opacity) {
  glm::dvec4 sum(0);
  for (std::size_t s = 0; s < samples.size(); ++s) {
    std::vector<std::pair<float, PrimitiveId>> order;
    for (const OracleFragment& f : list)
      if (f.mask >> s & 1)
        order.push_back({-oracle_key(*f.triangle, 256 * x + samples[s].x, 256 * y + samples[s].y), f.id});
    std::sort(order.begin(), order.end());
    double left = 1;
    for (const auto& [key, id] : order) {
      const glm::dvec4 color(colors[id]);
      const double alpha = color.a * opacity;
      sum += glm::dvec4(glm::dvec3(color) * (left * alpha), 0);
      left *= 1 - alpha;
    }
    sum.a += 1 - left;
  }
  return sum / double(samples.size());
}

/// A view from (0, 0, 1) to the origin.
inline View front_view(int width, int height) {
  return make_view(0.9, width, height).looking({0, 0, 1}, {0, 0, 0}, {0, 1, 0}).between(0.5, 6);
}

}  // namespace frontmost::test
