// SPDX-License-Identifier: Apache-2.0
// Setup of single triangles, for clusters that cannot be drawn as a whole, and the lists of these triangles by tile.
//
// Triangles are transformed and clipped one after the other. Clipping leaves a fan of triangles, and the top-left rule
// gives each sample on an inner edge to one of them. Snapping, culling and keys equal those of the kernels to the bit.

#include "zbuffer/triangle_records.h"

#include <algorithm>
#include <array>
#include <tuple>
#include <utility>

namespace frontmost::zbuffer_detail {
namespace {

/// The vertices of a cluster on the screen, each computed once.
class SnappedCluster {
 public:
  SnappedCluster(const ClusterSet& set, const Cluster& cluster, const ScreenTransform& t)
      : set_(set), cluster_(cluster), transform_(t) {
    for (std::size_t i = 0; i < cluster.vertex_count; ++i) {
      const HomogeneousVertex v = transform(t, position(i));
      is_plain_[i] = is_plain(t, v);
      if (is_plain_[i]) plain_[i] = snap(t, v);
    }
  }

  /// Returns one of the cluster's triangles, clipped if one of its vertices cannot be snapped.
  [[nodiscard]] ClippedPolygon polygon(std::size_t triangle) const {
    const std::size_t c = cluster_.first_triangle + triangle;
    const std::size_t a = set_.i0[c], b = set_.i1[c], d = set_.i2[c];
    // build_clusters() stores equal vertices for padding, and for a triangle with a vertex that is not finite.
    if (a == b || b == d || a == d) return {};
    if (!is_plain_[a] || !is_plain_[b] || !is_plain_[d])
      return clip_triangle(transform_, {position(a), position(b), position(d)});
    ClippedPolygon whole;
    whole.corners[0] = plain_[a];
    whole.corners[1] = plain_[b];
    whole.corners[2] = plain_[d];
    whole.count = 3;
    return whole;
  }

 private:
  [[nodiscard]] glm::vec3 position(std::size_t vertex) const {
    const std::size_t v = cluster_.first_vertex + vertex;
    return {set_.x[v], set_.y[v], set_.z[v]};
  }

  const ClusterSet& set_;
  const Cluster& cluster_;
  const ScreenTransform& transform_;
  std::array<ScreenVertex, Cluster::max_vertices> plain_;
  std::array<bool, Cluster::max_vertices> is_plain_;
};

auto place_of(const TriangleRecord& r) {
  return std::tie(r.x[0], r.y[0], r.x[1], r.y[1], r.x[2], r.y[2], r.key[0], r.key[1], r.key[2]);
}

/// True if `a` comes first: if it is nearer. Records with the same vertices follow each other, the lower id first.
bool comes_before(const TriangleRecord& a, const TriangleRecord& b) {
  if (a.nearest() != b.nearest()) return a.nearest() > b.nearest();
  return std::tuple_cat(place_of(a), std::tie(a.id)) < std::tuple_cat(place_of(b), std::tie(b.id));
}

bool is_at_one_place(const TriangleRecord& a, const TriangleRecord& b) { return place_of(a) == place_of(b); }

}  // namespace

PlaceTarget::PlaceTarget(const ScreenTransform& t, const View& v, const MaterialSides* sides, Isa i)
    : transform(t), view(v), facing(v.culling, sides), low(kSubPixels), high(0), isa(i) {
  for (const glm::ivec2& s : sample_offsets(v.samples)) low = glm::min(low, s), high = glm::max(high, s);
}

bool orient(TriangleRecord& r, const FacingRule& facing) {
  const std::int64_t area = doubled_area(r);
  // A triangle without area is edge-on, whatever its winding was, so the culling rule does not apply.
  if (area == 0 || !facing.keeps(r.id, area < 0)) return false;
  if (area < 0) {
    std::swap(r.x[1], r.x[2]);
    std::swap(r.y[1], r.y[2]);
    std::swap(r.key[1], r.key[2]);
  }
  return true;
}

void append_records(const PlaceTarget& target, const ClusterSet& set, const Cluster& cluster,
                    std::vector<TriangleRecord>& records) {
  const SnappedCluster snapped(set, cluster, target.transform);
  for (std::size_t i = 0; i < cluster.triangle_count; ++i)
    append_polygon(target, snapped.polygon(i), set.id[cluster.first_triangle + i], records);
}

void append_polygon(const PlaceTarget& target, const ClippedPolygon& polygon, PrimitiveId id,
                    std::vector<TriangleRecord>& records) {
  for_each_of_fan(polygon, target.transform, id, [&](TriangleRecord& record) {
    const PixelRect rect = pixel_rect(record, target.view.width, target.view.height);
    if (!rect.is_empty() && orient(record, target.facing)) records.push_back(record);
  });
}

PixelRect pixel_rect(const TriangleRecord& r, int width, int height) {
  // Samples lie within [0, 256) of a pixel, so only pixels between the outermost vertices can be covered.
  const auto [x_min, x_max] = std::minmax({r.x[0], r.x[1], r.x[2]});
  const auto [y_min, y_max] = std::minmax({r.y[0], r.y[1], r.y[2]});
  return {std::max(x_min >> 8, 0), std::max(y_min >> 8, 0), std::min(x_max >> 8, width - 1),
          std::min(y_max >> 8, height - 1)};
}

PixelRect sampled_rect(const TriangleRecord& r, const glm::ivec2& low, const glm::ivec2& high, int width, int height) {
  const auto [x_min, x_max] = std::minmax({r.x[0], r.x[1], r.x[2]});
  const auto [y_min, y_max] = std::minmax({r.y[0], r.y[1], r.y[2]});
  return {std::max((x_min + 255 - high.x) >> 8, 0), std::max((y_min + 255 - high.y) >> 8, 0),
          std::min((x_max - low.x) >> 8, width - 1), std::min((y_max - low.y) >> 8, height - 1)};
}

bool misses(const TriangleRecord& r, const PixelRect& rect) {
  for (int a = 0; a < 3; ++a) {
    const int b = (a + 1) % 3;
    const std::int64_t dx = r.x[b] - r.x[a], dy = r.y[b] - r.y[a];
    // (x, y) is the corner of the rectangle that lies deepest inside the edge. Upper bounds are one past the last
    // pixel, because samples lie within [0, 256) of their pixels. The test leaves out the top-left bias, so it may keep
    // a rectangle that has no covered sample, which only costs time.
    const std::int64_t x = dy < 0 ? (std::int64_t(rect.x1) + 1) * kSubPixels : std::int64_t(rect.x0) * kSubPixels;
    const std::int64_t y = dx > 0 ? (std::int64_t(rect.y1) + 1) * kSubPixels : std::int64_t(rect.y0) * kSubPixels;
    if (dx * (y - r.y[a]) - dy * (x - r.x[a]) < 0) return true;
  }
  return false;
}

void RecordLists::plan(const View& view, const Cutouts* cutouts, std::size_t most_items) {
  const auto is_solid = [&](const TriangleRecord& r) { return !cutouts || !cutouts->has(r.id); };
  auto first_cutout = std::partition(records.begin(), records.end(), is_solid);
  // Any order gives the same picture. With the nearest first, a tile may stop at the first record that all its blocks
  // hide.
  std::sort(records.begin(), first_cutout, comes_before);
  std::sort(first_cutout, records.end(), comes_before);
  // A solid triangle hides all its copies with higher ids. Copies matter because a few bytes of glTF make a million
  // copies of one triangle.
  first_cutout = records.erase(std::unique(records.begin(), first_cutout, is_at_one_place), first_cutout);
  first_cutout_ = std::size_t(first_cutout - records.begin());
  split_into_rounds(view, most_items);
}

void RecordLists::list(const TileRange& round, const View& view) {
  lists_.make(round, records.size(),
              [&](std::size_t i, const auto& add) { visit_tiles(records[i], view, round, add); });
}

/// Splits the tiles into rounds. The lists of a round hold at most `most_items` together, unless the round is a single
/// tile.
void RecordLists::split_into_rounds(const View& view, std::size_t most_items) {
  const TileRange all{0, Tile::count(view)};
  rounds_.assign(1, all);
  // Tiles need not be counted if the bound holds even with every record in every tile.
  if (records.size() <= most_items / all.end) return;
  std::vector<std::uint32_t> counts(all.end, 0);
  for (const TriangleRecord& record : records)
    visit_tiles(record, view, all, [&](std::size_t tile) { ++counts[tile]; });
  rounds_.assign(1, {0, 0});
  std::size_t items = 0;
  for (std::size_t tile = 0; tile < all.end; ++tile) {
    if (items + counts[tile] > most_items && rounds_.back().end > rounds_.back().begin) {
      rounds_.push_back({tile, tile});
      items = 0;
    }
    items += counts[tile];
    rounds_.back().end = tile + 1;
  }
}

}  // namespace frontmost::zbuffer_detail
