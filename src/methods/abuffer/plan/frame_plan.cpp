// SPDX-License-Identifier: Apache-2.0
// Makes the plan of a frame: finds how clusters are drawn, and lists them and single triangles by tile.
//
//    cluster on the screen     whole           listed in the tiles that its box touches
//                              over 16 tiles   taken apart: every tile would look at all of its triangles
//                              to be clipped   taken apart, triangle by triangle, and clipped
//    triangles of the last two are "singles", listed in the tiles that they touch themselves
//
// If the lists of singles would be too long, tiles go through all singles instead.
#include "abuffer/plan/frame_plan.h"

#include <algorithm>

#include "base/parallel.h"
#include "view/clip.h"
#include "view/triangle_keys.h"

namespace frontmost::abuffer_detail {
namespace {

// A cluster on more tiles than this is taken apart, because every tile would go through all of its triangles.
constexpr int kMaxTilesOfCluster = 16;
// The most items in the lists of singles (256 MiB). Beyond this limit, tiles go through all singles instead of a list.
constexpr std::size_t kMostSingleItems = std::size_t(1) << 26;

struct TileSpan {
  int x0, y0, x1, y1;
  [[nodiscard]] std::size_t count() const {
    return x1 < x0 || y1 < y0 ? 0 : std::size_t(x1 - x0 + 1) * std::size_t(y1 - y0 + 1);
  }
};

/// Returns the tiles that the bounds touch. Bounds are in 1/256 pixel from the image's top left.
TileSpan tiles_of(std::int32_t x0, std::int32_t y0, std::int32_t x1, std::int32_t y1, const View& view) {
  constexpr int shift = 8 + 6;
  static_assert(1 << shift == kTileSize * kSubPixels);
  return {std::max(x0, 0) >> shift, std::max(y0, 0) >> shift, std::min(x1, view.width * kSubPixels - 1) >> shift,
          std::min(y1, view.height * kSubPixels - 1) >> shift};
}

TileSpan tiles_of(const ClusterPlace& p, const ScreenTransform& t, const View& view) {
  return tiles_of(p.x0 + t.centre_x, p.y0 + t.centre_y, p.x1 + t.centre_x, p.y1 + t.centre_y, view);
}

TileSpan tiles_of(const ScreenTriangle& s, const View& view) {
  return tiles_of(std::min({s.x[0], s.x[1], s.x[2]}), std::min({s.y[0], s.y[1], s.y[2]}),
                  std::max({s.x[0], s.x[1], s.x[2]}), std::max({s.y[0], s.y[1], s.y[2]}), view);
}

/// True if the whole tile is outside of one edge. Bounding boxes of long, thin, diagonal triangles are mostly empty,
/// and listing them in all tiles of the box would be wasted.
bool misses(const ScreenTriangle& t, int tile_x, int tile_y) {
  constexpr std::int64_t size = kTileSize * kSubPixels;
  for (int a = 0; a < 3; ++a) {
    const int b = (a + 1) % 3;
    const std::int64_t dx = t.x[b] - t.x[a], dy = t.y[b] - t.y[a];
    // The corner of the tile at which the edge function is greatest; if it is outside, all of the tile is outside.
    const std::int64_t x = (tile_x + (dy < 0 ? 1 : 0)) * size, y = (tile_y + (dx > 0 ? 1 : 0)) * size;
    if (dx * (y - t.y[a]) - dy * (x - t.x[a]) < 0) return true;
  }
  return false;
}

/// Lists are made on one thread, because a frame may be thinned within a loop that uses all threads.
const Execution kAlone{.threads = 1};

template <class Add>
void for_tiles(const TileSpan& rect, int tiles_x, const Add& add) {
  for (int y = rect.y0; y <= rect.y1; ++y)
    for (int x = rect.x0; x <= rect.x1; ++x) add(x, y, std::size_t(y) * std::size_t(tiles_x) + std::size_t(x));
}

}  // namespace

bool orient(ScreenTriangle& t, const FacingRule& facing) {
  const std::int64_t area = doubled_area(t);
  const bool front = area < 0;  // y is down
  if (area == 0 || !facing.keeps(t.id, front)) return false;
  if (front) {
    std::swap(t.x[1], t.x[2]);
    std::swap(t.y[1], t.y[2]);
    std::swap(t.key[1], t.key[2]);
  }
  return true;
}

FragmentPlan::FragmentPlan(const Surfaces& surfaces, const View& view, const Execution& execution) {
  const IeeeScope ieee;
  const auto tiles_along = [](int pixels) { return (pixels + kTileSize - 1) / kTileSize; };
  frame_ = std::make_shared<Frame>(Frame{cluster_set(surfaces, execution),
                                         ScreenTransform(view),
                                         view,
                                         FacingRule(view.culling, placed_scene(surfaces).sides.get()),
                                         tiles_along(view.width),
                                         tiles_along(view.height),
                                         {}});
  transform_all(execution);
  take_apart(execution);
  make_lists({});
}

Rectangle FragmentPlan::tile(std::size_t number) const {
  const int x = int(number % std::size_t(frame_->tiles_x)) * kTileSize,
            y = int(number / std::size_t(frame_->tiles_x)) * kTileSize;
  return {x, y, std::min(kTileSize, view().width - x), std::min(kTileSize, view().height - y)};
}

void FragmentPlan::transform_all(const Execution& execution) {
  constexpr std::size_t kGrain = 256;
  const std::size_t vertices = set().x.size(), clusters = set().clusters.size();
  ScreenClusters& screen = frame_->screen;
  screen = {Buffer<std::int32_t>(vertices), Buffer<std::int32_t>(vertices), Buffer<float>(vertices),
            std::vector<ClusterPlace>(clusters)};
  parallel_for(execution, clusters, kGrain, [&](std::size_t begin, std::size_t end) {
    transform_clusters(set(), transform(), execution.isa, begin, end, screen);
  });
}

void FragmentPlan::take_apart(const Execution& execution) {
  std::vector<std::uint32_t> apart;
  for (std::size_t i = 0; i < screen().places.size(); ++i) {
    ClusterPlace& place = frame_->screen.places[i];
    if (place.fate == ScreenFate::whole && tiles_of(place, transform(), view()).count() > kMaxTilesOfCluster)
      place.fate = ScreenFate::spread;
    if (place.fate == ScreenFate::spread || place.fate == ScreenFate::apart) apart.push_back(std::uint32_t(i));
  }
  constexpr std::size_t kGrain = 64;
  std::vector<std::vector<ScreenTriangle>> parts((apart.size() + kGrain - 1) / kGrain);
  parallel_for(execution, apart.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Cluster& cluster = set().clusters[apart[i]];
      if (screen().places[apart[i]].fate == ScreenFate::spread)
        append_snapped(cluster, parts[begin / kGrain]);
      else
        append_clipped(cluster, parts[begin / kGrain]);
    }
  });
  for (const std::vector<ScreenTriangle>& part : parts) singles_.insert(singles_.end(), part.begin(), part.end());
}

bool FragmentPlan::is_drawn(ScreenTriangle& t) const { return tiles_of(t, view()).count() > 0 && orient(t, facing()); }

ScreenTriangle FragmentPlan::snapped(const Cluster& cluster, std::size_t triangle) const {
  const std::size_t c = cluster.first_triangle + triangle;
  const std::uint8_t numbers[3] = {set().i0[c], set().i1[c], set().i2[c]};
  ScreenTriangle t;
  t.id = set().id[c];
  for (int k = 0; k < 3; ++k) {
    const std::size_t v = cluster.first_vertex + numbers[k];
    t.x[k] = screen().x[v] + transform().centre_x;
    t.y[k] = screen().y[v] + transform().centre_y;
    t.key[k] = screen().key[v];
  }
  return t;
}

void FragmentPlan::append_snapped(const Cluster& cluster, std::vector<ScreenTriangle>& triangles) const {
  for (std::size_t i = 0; i < cluster.triangle_count; ++i) {
    ScreenTriangle t = snapped(cluster, i);
    if (is_drawn(t)) triangles.push_back(t);
  }
}

void FragmentPlan::append_clipped(const Cluster& cluster, std::vector<ScreenTriangle>& triangles) const {
  const auto position = [&](std::size_t vertex) {
    const std::size_t v = cluster.first_vertex + vertex;
    return glm::vec3(set().x[v], set().y[v], set().z[v]);
  };
  for (std::size_t c = cluster.first_triangle; c < cluster.first_triangle + cluster.triangle_count; ++c) {
    if (set().i0[c] == set().i1[c]) continue;  // has a vertex that is not finite, or no area
    const ClippedPolygon polygon =
        clip_triangle(transform(), {position(set().i0[c]), position(set().i1[c]), position(set().i2[c])});
    for (int k = 2; k < polygon.count; ++k) {
      const ScreenVertex fan[3] = {polygon.corners[0], polygon.corners[std::size_t(k - 1)],
                                   polygon.corners[std::size_t(k)]};
      ScreenTriangle t;
      t.id = set().id[c];
      for (int v = 0; v < 3; ++v) {
        t.x[v] = fan[v].x + transform().centre_x;
        t.y[v] = fan[v].y + transform().centre_y;
        t.key[v] = fan[v].key;
      }
      if (is_drawn(t)) triangles.push_back(t);
    }
  }
}

ScreenTriangle FragmentPlan::triangle(const TriangleNumber& number) const {
  if (number.cluster == no_index) return singles_[number.index];
  ScreenTriangle t = snapped(set().clusters[number.cluster], number.index);
  (void)is_drawn(t);  // makes its area positive
  return t;
}

FragmentPlan FragmentPlan::without(std::span<const TriangleNumber> hidden) const {
  std::vector<TriangleNumber> sorted(hidden.begin(), hidden.end());
  std::sort(sorted.begin(), sorted.end(), [](const TriangleNumber& a, const TriangleNumber& b) {
    return a.cluster != b.cluster ? a.cluster < b.cluster : a.index < b.index;
  });
  FragmentPlan plan(frame_);
  std::vector<bool> left_out(screen().places.size(), false);
  for (const TriangleNumber& n : sorted)
    if (n.cluster != no_index) left_out[n.cluster] = true;
  auto next = sorted.begin();
  const auto is_hidden = [&](std::uint32_t cluster, std::uint32_t index) {
    if (next == sorted.end() || next->cluster != cluster || next->index != index) return false;
    ++next;
    return true;
  };
  for (std::uint32_t c = 0; c < left_out.size(); ++c)
    for (std::uint32_t i = 0; left_out[c] && i < set().clusters[c].triangle_count; ++i) {
      ScreenTriangle t = snapped(set().clusters[c], i);
      if (is_drawn(t) && !is_hidden(c, i)) plan.singles_.push_back(t);
    }
  // Singles have the highest cluster number, no_index, and so come last.
  for (std::uint32_t i = 0; i < singles_.size(); ++i)
    if (!is_hidden(no_index, i)) plan.singles_.push_back(singles_[i]);
  plan.make_lists(left_out);
  return plan;
}

void FragmentPlan::make_lists(const std::vector<bool>& left_out) {
  const auto list_cluster = [&](std::size_t i, const auto& add) {
    const ClusterPlace& place = screen().places[i];
    if (place.fate == ScreenFate::whole && (left_out.empty() || !left_out[i]))
      for_tiles(tiles_of(place, transform(), view()), frame_->tiles_x,
                [&](int, int, std::size_t tile) { add(tile, std::uint32_t(i)); });
  };
  cluster_lists_ = TileNumbers(tile_count(), screen().places.size(), list_cluster, kAlone);
  std::size_t items = 0;
  for (const ScreenTriangle& t : singles_) items += tiles_of(t, view()).count();
  if (items > kMostSingleItems) return;
  const auto list_single = [&](std::size_t i, const auto& add) {
    const ScreenTriangle& t = singles_[i];
    for_tiles(tiles_of(t, view()), frame_->tiles_x, [&](int x, int y, std::size_t tile) {
      if (!misses(t, x, y)) add(tile, std::uint32_t(i));
    });
  };
  single_lists_.emplace(tile_count(), singles_.size(), list_single, kAlone);
}

}  // namespace frontmost::abuffer_detail
