// SPDX-License-Identifier: Apache-2.0
#include "report/faces/viewed_faces.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.h"
#include "geometry/places.h"
#include "surfaces/placed_scene.h"
#include "view/facing_rule.h"

namespace frontmost::faces_detail {
namespace {

EdgeNeighbours mesh_sides(const Mesh& mesh, const Execution& execution) {
  constexpr std::size_t kTrianglesAtOnce = 8192;
  const Buffer<std::uint32_t> first = first_at_place(mesh.positions, execution);
  std::vector<glm::uvec3> triangles(mesh.triangles.size());
  parallel_for(execution, triangles.size(), kTrianglesAtOnce, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      const glm::uvec3& c = mesh.triangles[t];
      triangles[t] = {first[c.x], first[c.y], first[c.z]};
    }
  });
  return {triangles, mesh.positions.size(), execution};
}

/// Distance from the picture, in pixels. Triangles that extend farther are clipped, so that doubles keep positions
/// exact within the picture.
constexpr double kBeyond = 65536;
/// Distance from the picture at which such triangles are cut, in pixels.
constexpr double kRim = 64;

/// Bits for the regions in which a vertex lies.
enum Outside : std::uint8_t {
  kLeft = 1,
  kRight = 2,
  kAbove = 4,
  kBelow = 8,
  kNearer = 16,
  kFarther = 32,
  kFarAway = 64,  ///< farther than kBeyond from the picture
  kNowhere = 128  ///< not finite
};

/// Coordinates right, down and ahead of the eye. The first two are in pixels at unit distance (at any distance in
/// parallel projection), from the picture's top left corner.
using EyePoint = glm::dvec3;

class Eye {
 public:
  explicit Eye(const View& view)
      : at_(view.eye()),
        right_(view.right()),
        up_(view.up()),
        forward_(view.forward()),
        scale_x_(view.width / (view.projection.right - view.projection.left)),
        scale_y_(view.height / (view.projection.top - view.projection.bottom)),
        left_(view.projection.left * scale_x_),
        top_(view.projection.top * scale_y_),
        width_(view.width),
        height_(view.height),
        clip_(view.projection.clip),
        orthographic_(view.projection.orthographic) {}

  [[nodiscard]] EyePoint see(const glm::vec3& world) const {
    const glm::dvec3 p = glm::dvec3(world) - at_;
    const double ahead = glm::dot(forward_, p), unit = orthographic_ ? 1 : ahead;
    return {scale_x_ * glm::dot(right_, p) - left_ * unit, top_ * unit - scale_y_ * glm::dot(up_, p), ahead};
  }
  /// Precondition: the point lies between near and far.
  [[nodiscard]] ScreenPoint project(const EyePoint& p) const {
    if (orthographic_) return {p.x, p.y, -p.z};
    const double key = 1 / p.z;
    return {p.x * key, p.y * key, key};
  }
  /// The regions in which a point lies, as bits of Outside.
  [[nodiscard]] std::uint8_t outside(const EyePoint& p) const {
    if (!is_finite(p)) return kNowhere;
    const double unit = orthographic_ ? 1 : p.z;
    int bits = 0;
    if (p.z < clip_.near) bits |= kNearer;
    if (p.z > clip_.far) bits |= kFarther;
    // Behind the eye these bits mean nothing, but they are never used there: kNearer cuts such points off first.
    if (p.x < 0) bits |= kLeft;
    if (p.x > width_ * unit) bits |= kRight;
    if (p.y < 0) bits |= kAbove;
    if (p.y > height_ * unit) bits |= kBelow;
    if (std::max(std::abs(p.x), std::abs(p.y)) > kBeyond * std::abs(unit)) bits |= kFarAway;
    return std::uint8_t(bits);
  }
  /// The part of a triangle between near and far and around the picture: a convex polygon.
  [[nodiscard]] std::vector<EyePoint> clip(const std::array<EyePoint, 3>& triangle) const {
    std::vector<EyePoint> polygon(triangle.begin(), triangle.end());
    const double p = orthographic_ ? 0 : 1, o = 1 - p;  // factor of the distance, and constant part
    cut(polygon, {0, 0, 1}, -clip_.near);
    if (std::isfinite(clip_.far)) cut(polygon, {0, 0, -1}, clip_.far);
    cut(polygon, {1, 0, kRim * p}, kRim * o);
    cut(polygon, {-1, 0, (width_ + kRim) * p}, (width_ + kRim) * o);
    cut(polygon, {0, 1, kRim * p}, kRim * o);
    cut(polygon, {0, -1, (height_ + kRim) * p}, (height_ + kRim) * o);
    return polygon;
  }

 private:
  /// Keeps the part where dot(normal, p) + offset >= 0.
  static void cut(std::vector<EyePoint>& polygon, const glm::dvec3& normal, double offset) {
    std::vector<EyePoint> kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const EyePoint &a = polygon[i], &b = polygon[i + 1 == polygon.size() ? 0 : i + 1];
      const double from = glm::dot(normal, a) + offset, to = glm::dot(normal, b) + offset;
      if (from >= 0) kept.push_back(a);
      if ((from < 0) != (to < 0)) kept.push_back(a + (b - a) * (from / (from - to)));
    }
    polygon = std::move(kept);
  }

  glm::dvec3 at_, right_, up_, forward_;
  double scale_x_, scale_y_, left_, top_, width_, height_;
  ClipDistances clip_;
  bool orthographic_;
};

/// The winding of a triangle on the screen: 1 to the right, -1 to the left, 0 if it is too narrow to be seen.
int facing_of(const ScreenPoint& a, const ScreenPoint& b, const ScreenPoint& c) {
  const double turn = turn_of(a, b, c);
  const double longest = std::max({std::abs(b.x - a.x), std::abs(b.y - a.y), std::abs(c.x - b.x), std::abs(c.y - b.y),
                                   std::abs(a.x - c.x), std::abs(a.y - c.y)});
  return turn > kNarrow * longest ? 1 : turn < -kNarrow * longest ? -1 : 0;
}

/// Consecutive vertices of an instance, and the index of their first point.
struct VertexRange {
  static constexpr std::size_t most = 4096;

  std::uint32_t instance;
  std::size_t begin, end;
  std::size_t first_point;
};

/// Screen positions of the vertices of all instances that the view may show.
class VerticesOfView {
 public:
  VerticesOfView(const PlacedScene& placed, const Eye& eye, const Execution& execution)
      : eye_(eye), first_(placed.scene->instances.size(), none) {
    std::vector<VertexRange> ranges;
    std::size_t count = 0;
    for (std::uint32_t i = 0; i < first_.size(); ++i) {
      if (!may_show(placed.instance_bounds[i])) continue;
      first_[i] = count;
      const std::size_t vertices = placed.scene->meshes[placed.scene->instances[i].mesh].positions.size();
      for (std::size_t begin = 0; begin < vertices; begin += VertexRange::most)
        ranges.push_back({i, begin, std::min(begin + VertexRange::most, vertices), count + begin});
      count += vertices;
    }
    points = Buffer<ScreenPoint>(count);
    outside = Buffer<std::uint8_t>(count);
    parallel_for(execution, ranges.size(), 4, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) see(placed, ranges[i]);
    });
  }
  /// Index of the point of an instance's vertex 0; `none` for instances outside the view.
  static constexpr std::size_t none = std::size_t(-1);
  [[nodiscard]] std::size_t first(std::uint32_t instance) const { return first_[instance]; }

  Buffer<ScreenPoint> points;    ///< undefined if nearer than near, farther than far or not finite
  Buffer<std::uint8_t> outside;  ///< bits of Outside, by point

 private:
  [[nodiscard]] bool may_show(const Box& bounds) const {
    if (bounds.is_empty()) return false;
    int all = kLeft | kRight | kAbove | kBelow | kNearer | kFarther;
    for (int k = 0; k < 8; ++k)
      all &= eye_.outside(eye_.see({(k & 1 ? bounds.high : bounds.low).x, (k & 2 ? bounds.high : bounds.low).y,
                                    (k & 4 ? bounds.high : bounds.low).z}));
    return all == 0;
  }

  void see(const PlacedScene& placed, const VertexRange& range) {
    const Instance& instance = placed.scene->instances[range.instance];
    const glm::vec3* const positions = placed.scene->meshes[instance.mesh].positions.data();
    const ToWorld world(instance.world_from_mesh);
    for (std::size_t i = range.begin; i < range.end; ++i) {
      const EyePoint at = eye_.see(world(positions[i]));
      const std::size_t number = range.first_point + (i - range.begin);
      points[number] = eye_.project(at);
      outside[number] = eye_.outside(at);
    }
  }

  Eye eye_;
  std::vector<std::size_t> first_;
};

/// The faces of some ranges of triangles. Corner numbers that are not below the number of all vertices refer to
/// `clipped`.
struct FacePart {
  std::vector<ViewedFace> faces;
  std::vector<ScreenPoint> clipped;
};

/// Gathers the faces of consecutive triangles.
class FaceGatherer {
 public:
  /// `facing` has an entry for each primitive: 0 for triangles that are not seen, or not whole.
  FaceGatherer(const PlacedScene& placed, const Eye& eye, Culling culling, const VerticesOfView& vertices,
               std::vector<std::int8_t>& facing)
      : placed_(placed), eye_(eye), rule_(culling, placed.sides.get()), vertices_(vertices), facing_(facing) {}

  void gather(const MeshRange& range) {
    const std::size_t first_point = vertices_.first(range.instance);
    if (first_point == VerticesOfView::none) return;
    is_mirrored_ = placed_.mirrored[range.instance] != 0;
    PrimitiveId id = placed_.first_id(range);
    for (const glm::uvec3& c : placed_.corners(range)) add(id++, range.instance, first_point, c);
  }
  [[nodiscard]] FacePart take() { return std::move(out_); }

 private:
  [[nodiscard]] bool is_culled(PrimitiveId id, int facing) const {
    return !rule_.keeps(id, (facing < 0) != is_mirrored_);
  }

  void add(PrimitiveId id, std::uint32_t instance, std::size_t first_point, const glm::uvec3& c) {
    const std::size_t x = first_point + c.x, y = first_point + c.y, z = first_point + c.z;
    const int a = vertices_.outside[x], b = vertices_.outside[y], d = vertices_.outside[z];
    const int all = a & b & d, any = a | b | d;
    if ((any & kNowhere) != 0 || (all & (kNearer | kFarther)) != 0) return;
    if ((any & (kNearer | kFarther | kFarAway)) != 0) return add_clipped(id, instance, c);
    if ((all & (kLeft | kRight | kAbove | kBelow)) != 0) return;
    const int facing = facing_of(vertices_.points[x], vertices_.points[y], vertices_.points[z]);
    if (facing == 0 || is_culled(id, facing)) return;
    facing_[id] = std::int8_t(facing);
    out_.faces.push_back({{std::uint32_t(x), std::uint32_t(y), std::uint32_t(z)}, id});
  }

  void add_clipped(PrimitiveId id, std::uint32_t instance, const glm::uvec3& c) {
    const Instance& placed = placed_.scene->instances[instance];
    const std::vector<glm::vec3>& positions = placed_.scene->meshes[placed.mesh].positions;
    const ToWorld world(placed.world_from_mesh);
    const std::vector<EyePoint> polygon =
        eye_.clip({eye_.see(world(positions[c.x])), eye_.see(world(positions[c.y])), eye_.see(world(positions[c.z]))});
    const std::size_t first = out_.clipped.size();
    for (const EyePoint& p : polygon) out_.clipped.push_back(eye_.project(p));
    const auto number = std::uint32_t(vertices_.points.size() + first);
    for (std::uint32_t i = 2; i < polygon.size(); ++i) {
      const ScreenPoint* const p = out_.clipped.data() + first;
      const int facing = facing_of(p[0], p[i - 1], p[i]);
      if (facing != 0 && !is_culled(id, facing)) out_.faces.push_back({{number, number + i - 1, number + i}, id});
    }
  }

  const PlacedScene& placed_;
  const Eye& eye_;
  FacingRule rule_;
  const VerticesOfView& vertices_;
  std::vector<std::int8_t>& facing_;
  bool is_mirrored_ = false;
  FacePart out_;
};

ViewedFaces joined(const std::vector<FacePart>& parts, Buffer<ScreenPoint> vertices) {
  std::size_t points = vertices.size(), faces = 0;
  for (const FacePart& part : parts) points += part.clipped.size(), faces += part.faces.size();
  if (points >= no_index || faces >= no_index)
    throw Error(ErrorCode::limit_exceeded, "visible faces", "more than 4294967294 faces or vertices within the view");
  ViewedFaces all{Buffer<ScreenPoint>(), Buffer<ViewedFace>(faces), Buffer<std::uint8_t>(faces)};
  const std::size_t vertex_count = vertices.size();
  if (points == vertex_count) {
    all.points = std::move(vertices);
  } else {
    all.points = Buffer<ScreenPoint>(points);
    std::copy(vertices.begin(), vertices.end(), all.points.begin());
  }
  std::size_t first_clipped = vertex_count;
  ViewedFace* next = all.faces.begin();
  for (const FacePart& part : parts) {
    std::copy(part.clipped.begin(), part.clipped.end(), all.points.begin() + first_clipped);
    const auto moved = std::uint32_t(first_clipped - vertex_count);
    for (ViewedFace face : part.faces) {
      if (face.corners[0] >= vertex_count)
        for (std::uint32_t& corner : face.corners) corner += moved;
      *next++ = face;
    }
    first_clipped += part.clipped.size();
  }
  return all;
}

/// Sets ViewedFaces::ending for [begin, end).
void find_endings(const PlacedScene& placed, const std::vector<EdgeNeighbours>& sides,
                  const std::vector<std::int8_t>& facing, std::size_t begin, std::size_t end, ViewedFaces& all) {
  const auto& first = placed.first_primitives;
  std::size_t instance = 0;
  for (std::size_t i = begin; i < end; ++i) {
    const PrimitiveId id = all.faces[i].id;
    if (i == begin) instance = std::size_t(std::upper_bound(first.begin(), first.end(), id) - first.begin()) - 1;
    while (first[instance + 1] <= id) ++instance;
    const EdgeNeighbours& mesh = sides[placed.scene->instances[instance].mesh];
    const int own = facing[id];
    int ending = 0;
    for (int side = 0; side < 3; ++side) {
      const std::uint32_t beyond = mesh.beyond(id - first[instance], side);
      const int other = beyond == no_index ? 0 : facing[first[instance] + beyond];
      const int plain = own != 0 && mesh.is_wound_alike(id - first[instance], side) ? own : -own;
      if (beyond == no_index || own == 0 || other != plain) ending |= 1 << side;
    }
    all.ending[i] = std::uint8_t(ending);
  }
}

}  // namespace

std::vector<EdgeNeighbours> sides_of_meshes(const Scene& scene, const Execution& execution) {
  std::vector<bool> is_placed(scene.meshes.size(), false);
  for (const Instance& instance : scene.instances) is_placed[instance.mesh] = true;
  std::vector<EdgeNeighbours> sides(scene.meshes.size());
  parallel_for(execution, scene.meshes.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t m = begin; m < end; ++m)
      if (is_placed[m]) sides[m] = mesh_sides(scene.meshes[m], execution);
  });
  return sides;
}

ViewedFaces viewed_faces(const Surfaces& surfaces, const View& view, const std::vector<EdgeNeighbours>& sides,
                         const Execution& execution) {
  constexpr std::size_t kRangesAtOnce = 16, kFacesAtOnce = 8192;
  const PlacedScene& placed = placed_scene(surfaces);
  const Eye eye(view);
  VerticesOfView vertices(placed, eye, execution);
  std::vector<std::int8_t> facing(surfaces.primitive_count(), 0);
  std::vector<FacePart> parts((placed.ranges.size() + kRangesAtOnce - 1) / kRangesAtOnce);
  parallel_for(execution, placed.ranges.size(), kRangesAtOnce, [&](std::size_t begin, std::size_t end) {
    FaceGatherer gatherer(placed, eye, view.culling, vertices, facing);
    for (std::size_t i = begin; i < end; ++i) gatherer.gather(placed.ranges[i]);
    parts[begin / kRangesAtOnce] = gatherer.take();
  });
  ViewedFaces all = joined(parts, std::move(vertices.points));
  parallel_for(execution, all.faces.size(), kFacesAtOnce,
               [&](std::size_t begin, std::size_t end) { find_endings(placed, sides, facing, begin, end, all); });
  return all;
}

}  // namespace frontmost::faces_detail
