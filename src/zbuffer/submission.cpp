// SPDX-License-Identifier: Apache-2.0
#include "zbuffer/submission.h"

#include <algorithm>

#include "view/clip.h"

namespace frontmost::zbuffer_detail {
namespace {

constexpr std::uint32_t kPieceTriangles = 2048;
constexpr std::size_t kMostItems = std::size_t(1) << 26;  // 256 MiB

struct CachedVertex {
  std::uint32_t number = no_index;
  bool is_plain = false;
  ScreenVertex screen{};
};

/// Transformed vertices of one mesh, found again while they are in use: meshes name a vertex six times, mostly soon.
class VertexCache {
 public:
  VertexCache(const Mesh& mesh, const ToWorld& world, const ScreenTransform& t)
      : mesh_(mesh), world_(world), transform_(t), entries_(kEntries) {}

  const CachedVertex& get(std::uint32_t number) {
    CachedVertex& entry = entries_[number % kEntries];
    if (entry.number == number) return entry;
    const HomogeneousVertex v = transform(transform_, world_(mesh_.positions[number]));
    entry.number = number;
    entry.is_plain = is_plain(transform_, v);
    if (entry.is_plain) entry.screen = snap(transform_, v);
    return entry;
  }
  [[nodiscard]] glm::vec3 position(std::uint32_t number) const { return world_(mesh_.positions[number]); }

 private:
  static constexpr std::uint32_t kEntries = 512;
  const Mesh& mesh_;
  const ToWorld& world_;
  const ScreenTransform& transform_;
  std::vector<CachedVertex> entries_;
};

class Placer {
 public:
  Placer(const ScreenTransform& t, const View& view, std::vector<PlacedTriangle>& out)
      : transform_(t), view_(view), out_(out) {
    for (const glm::ivec2& s : sample_offsets(view.samples)) low_ = glm::min(low_, s), high_ = glm::max(high_, s);
  }

  void add(const glm::uvec3& corners, VertexCache& vertices, PrimitiveId id) {
    // Copies: the next look-up may take the place of the last.
    const CachedVertex a = vertices.get(corners.x), b = vertices.get(corners.y), c = vertices.get(corners.z);
    if (a.is_plain && b.is_plain && c.is_plain) {
      const ScreenVertex plain[3] = {a.screen, b.screen, c.screen};
      add_polygon(plain, id);
      return;
    }
    const std::array<glm::vec3, 3> world{vertices.position(corners.x), vertices.position(corners.y),
                                         vertices.position(corners.z)};
    if (!is_finite(world[0]) || !is_finite(world[1]) || !is_finite(world[2])) return;
    const ClippedPolygon polygon = clip_triangle(transform_, world);
    if (polygon.count >= 3) add_polygon(std::span(polygon.corners).first(std::size_t(polygon.count)), id);
  }

 private:
  /// A fan: the top-left rule covers its inner edges once.
  void add_polygon(std::span<const ScreenVertex> polygon, PrimitiveId id) {
    float low = polygon[0].key, high = polygon[0].key;
    for (const ScreenVertex& v : polygon) low = std::min(low, v.key), high = std::max(high, v.key);
    for (std::size_t k = 2; k < polygon.size(); ++k) {
      const ScreenVertex* fan[3] = {&polygon[0], &polygon[k - 1], &polygon[k]};
      PlacedTriangle triangle;
      triangle.primitive_low = low;
      triangle.primitive_high = high;
      triangle.corners.id = id;
      for (int v = 0; v < 3; ++v) {
        triangle.corners.x[v] = fan[v]->x + transform_.centre_x;
        triangle.corners.y[v] = fan[v]->y + transform_.centre_y;
        triangle.corners.key[v] = fan[v]->key;
      }
      add_triangle(triangle);
    }
  }

  void add_triangle(PlacedTriangle& triangle) {
    TriangleRecord& r = triangle.corners;
    const PixelRect rect = sampled_rect(r, low_, high_, view_.width, view_.height);
    if (rect.x1 < rect.x0 || rect.y1 < rect.y0 || !orient(r, view_.culling)) return;
    // The plane as every part of the z-buffer sets it up, operation by operation.
    const float x1 = float(r.x[1] - r.x[0]), y1 = float(r.y[1] - r.y[0]), k1 = r.key[1] - r.key[0];
    const float x2 = float(r.x[2] - r.x[0]), y2 = float(r.y[2] - r.y[0]), k2 = r.key[2] - r.key[0];
    const float area = float(doubled_area(r));
    triangle.gx = (k1 * y2 - k2 * y1) / area;
    triangle.gy = (x1 * k2 - x2 * k1) / area;
    triangle.k_min = std::min(r.key[0], std::min(r.key[1], r.key[2]));
    triangle.k_max = std::max(r.key[0], std::max(r.key[1], r.key[2]));
    out_.push_back(triangle);
  }

  const ScreenTransform& transform_;
  const View& view_;
  std::vector<PlacedTriangle>& out_;
  glm::ivec2 low_{kSubPixels}, high_{0};  // of the sample offsets
};

/// Calls add(tile) for every tile in which the triangle may cover a sample.
template <class Add>
void for_each_tile(const PlacedTriangle& triangle, const TileGrid& grid, const Add& add) {
  const PixelRect rect = pixel_rect(triangle.corners, grid.width, grid.height);
  const int x0 = rect.x0 / kSubmissionTile, x1 = rect.x1 / kSubmissionTile;
  const int y0 = rect.y0 / kSubmissionTile, y1 = rect.y1 / kSubmissionTile;
  const bool single = x0 == x1 && y0 == y1;
  for (int y = y0; y <= y1; ++y)
    for (int x = x0; x <= x1; ++x) {
      const std::size_t tile = std::size_t(y) * std::size_t(grid.across) + std::size_t(x);
      if (single || !misses(triangle.corners, grid.rect(tile))) add(tile);
    }
}

void bin(const TileGrid& grid, PlacedPiece& placed) {
  placed.begin.assign(grid.count() + 1, 0);
  for (const PlacedTriangle& triangle : placed.triangles)
    for_each_tile(triangle, grid, [&](std::size_t tile) { ++placed.begin[tile + 1]; });
  for (std::size_t tile = 0; tile < grid.count(); ++tile) placed.begin[tile + 1] += placed.begin[tile];
  placed.items.resize(placed.begin[grid.count()]);
  // Filling moves each start to its end, which is the next one's start.
  for (std::uint32_t i = 0; i < placed.triangles.size(); ++i)
    for_each_tile(placed.triangles[i], grid, [&](std::size_t tile) { placed.items[placed.begin[tile]++] = i; });
  for (std::size_t tile = grid.count(); tile > 0; --tile) placed.begin[tile] = placed.begin[tile - 1];
  placed.begin[0] = 0;
}

}  // namespace

PixelRect TileGrid::rect(std::size_t tile) const {
  const int x = int(tile % std::size_t(across)) * kSubmissionTile,
            y = int(tile / std::size_t(across)) * kSubmissionTile;
  return {x, y, std::min(x + kSubmissionTile, width) - 1, std::min(y + kSubmissionTile, height) - 1};
}

std::vector<Piece> pieces_of(const Surfaces& surfaces, const PrimitiveRange& range) {
  std::vector<Piece> pieces;
  const std::vector<Instance>& instances = surfaces.scene().instances;
  for (std::uint32_t i = 0; i < instances.size(); ++i) {
    const PrimitiveId first = surfaces.first_primitive(i);
    const auto count = std::uint32_t(surfaces.scene().meshes[instances[i].mesh].triangles.size());
    const PrimitiveId low = std::max(range.begin, first), high = std::min(range.end, first + count);
    for (PrimitiveId id = low; id < high;) {
      const std::uint32_t size = std::min(kPieceTriangles, high - id);
      pieces.push_back({i, id - first, id - first + size, first});
      id += size;
    }
  }
  return pieces;
}

std::size_t pieces_at_once(const TileGrid& grid) {
  constexpr std::size_t kMost = 128;  // 2^18 triangles
  // Clipping makes seven pieces of a triangle at most, but they do not overlap: a tile and a half each, on average.
  return std::clamp<std::size_t>(kMostItems / (grid.count() * kPieceTriangles), 1, kMost);
}

void place(const Surfaces& surfaces, const Piece& piece, const ScreenTransform& transform, const View& view,
           PlacedPiece& placed) {
  placed.triangles.clear();
  const Instance& instance = surfaces.scene().instances[piece.instance];
  const Mesh& mesh = surfaces.scene().meshes[instance.mesh];
  const bool mirrored = surfaces.is_mirrored(piece.instance);
  const ToWorld world(instance.world_from_mesh);
  VertexCache vertices(mesh, world, transform);
  Placer placer(transform, view, placed.triangles);
  for (std::uint32_t i = piece.begin; i < piece.end; ++i) {
    const glm::uvec3& c = mesh.triangles[i];
    placer.add(mirrored ? glm::uvec3(c.x, c.z, c.y) : c, vertices, piece.first + i);
  }
  if (!placed.triangles.empty()) bin(TileGrid(view), placed);
}

}  // namespace frontmost::zbuffer_detail
