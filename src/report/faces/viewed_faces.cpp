// SPDX-License-Identifier: Apache-2.0
#include "report/faces/viewed_faces.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.h"
#include "surfaces/placed_scene.h"

namespace frontmost::faces_detail {
namespace {

/// Triangles that reach farther beyond the picture than this, in pixels, are clipped, so that doubles tell places in
/// it.
constexpr double kBeyond = 65536;
/// Where they are then cut: near the picture, but not in it.
constexpr double kRim = 64;

/// Bits of what a vertex lies outside of.
enum Outside : std::uint8_t {
  kLeft = 1,
  kRight = 2,
  kAbove = 4,
  kBelow = 8,
  kNearer = 16,
  kFarther = 32,
  kFarAway = 64,  ///< from the picture
  kNowhere = 128  ///< not finite
};

/// Right, down and ahead of the eye; the first two in pixels at unit distance, or at every one in parallel projection,
/// from the picture's top left corner.
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
  /// Precondition: between near and far.
  [[nodiscard]] ScreenPoint project(const EyePoint& p) const {
    if (orthographic_) return {p.x, p.y, -p.z};
    const double key = 1 / p.z;
    return {p.x * key, p.y * key, key};
  }
  /// Bits of Outside.
  [[nodiscard]] std::uint8_t outside(const EyePoint& p) const {
    if (!is_finite(p)) return kNowhere;
    const double unit = orthographic_ ? 1 : p.z;
    int bits = 0;
    if (p.z < clip_.near) bits |= kNearer;
    if (p.z > clip_.far) bits |= kFarther;
    // Of what lies behind the eye the sides say nothing, but it is never looked at: kNearer cuts it off first.
    if (p.x < 0) bits |= kLeft;
    if (p.x > width_ * unit) bits |= kRight;
    if (p.y < 0) bits |= kAbove;
    if (p.y > height_ * unit) bits |= kBelow;
    if (std::max(std::abs(p.x), std::abs(p.y)) > kBeyond * std::abs(unit)) bits |= kFarAway;
    return std::uint8_t(bits);
  }
  /// What of a triangle is between near and far and about the picture: a convex polygon.
  [[nodiscard]] std::vector<EyePoint> clip(const std::array<EyePoint, 3>& triangle) const {
    std::vector<EyePoint> polygon(triangle.begin(), triangle.end());
    const double p = orthographic_ ? 0 : 1, o = 1 - p;  // what multiplies the distance, and what stands alone
    cut(polygon, {0, 0, 1}, -clip_.near);
    if (std::isfinite(clip_.far)) cut(polygon, {0, 0, -1}, clip_.far);
    cut(polygon, {1, 0, kRim * p}, kRim * o);
    cut(polygon, {-1, 0, (width_ + kRim) * p}, (width_ + kRim) * o);
    cut(polygon, {0, 1, kRim * p}, kRim * o);
    cut(polygon, {0, -1, (height_ + kRim) * p}, (height_ + kRim) * o);
    return polygon;
  }

 private:
  /// Keeps where dot(normal, p) + offset >= 0.
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

/// Which way a triangle turns on the screen: 1 to the right, -1 to the left; 0 where it is too narrow to be seen.
int facing_of(const ScreenPoint& a, const ScreenPoint& b, const ScreenPoint& c) {
  const double turn = turn_of(a, b, c);
  const double longest = std::max({std::abs(b.x - a.x), std::abs(b.y - a.y), std::abs(c.x - b.x), std::abs(c.y - b.y),
                                   std::abs(a.x - c.x), std::abs(a.y - c.y)});
  return turn > kNarrow * longest ? 1 : turn < -kNarrow * longest ? -1 : 0;
}

/// The faces of consecutive triangles.
class FaceGatherer {
 public:
  /// `facing`: by primitive, 0 for those that are not there, or not whole.
  FaceGatherer(const PlacedScene& placed, const View& view, std::vector<std::int8_t>& facing)
      : placed_(placed), eye_(view), culling_(view.culling), facing_(facing) {}

  void gather(const MeshRange& range) {
    const WorldTriangles world = world_triangles(placed_, range, scratch_);
    is_mirrored_ = placed_.mirrored[range.instance] != 0;
    seen_.resize(world.positions.size());
    outside_.resize(world.positions.size());
    number_.assign(world.positions.size(), no_index);
    for (std::size_t i = 0; i < seen_.size(); ++i) {
      seen_[i] = eye_.see(world.positions[i]);
      outside_[i] = eye_.outside(seen_[i]);
    }
    for (std::size_t i = 0; i < world.corners.size(); ++i)
      add(PrimitiveId(world.first_id + i), world.corners[i] - world.first_position);
  }
  [[nodiscard]] ViewedFaces take() { return std::move(out_); }

 private:
  [[nodiscard]] bool is_culled(int facing) const {
    const bool is_front = (facing < 0) != is_mirrored_;
    return culling_ == Culling::both || (culling_ == Culling::front && is_front) ||
           (culling_ == Culling::back && !is_front);
  }

  void add(PrimitiveId id, const glm::uvec3& c) {
    const int all = outside_[c.x] & outside_[c.y] & outside_[c.z], any = outside_[c.x] | outside_[c.y] | outside_[c.z];
    if ((any & kNowhere) != 0 || (all & (kNearer | kFarther)) != 0) return;
    if ((any & (kNearer | kFarther | kFarAway)) != 0) return add_clipped(id, {seen_[c.x], seen_[c.y], seen_[c.z]});
    if ((all & (kLeft | kRight | kAbove | kBelow)) != 0) return;
    ViewedFace face{{point(c.x), point(c.y), point(c.z)}, id};
    const int facing =
        facing_of(out_.points[face.corners[0]], out_.points[face.corners[1]], out_.points[face.corners[2]]);
    if (facing == 0 || is_culled(facing)) return;
    facing_[id] = std::int8_t(facing);
    out_.faces.push_back(face);
  }

  void add_clipped(PrimitiveId id, const std::array<EyePoint, 3>& triangle) {
    const std::vector<EyePoint> polygon = eye_.clip(triangle);
    const auto first = std::uint32_t(out_.points.size());
    for (const EyePoint& p : polygon) out_.points.push_back(eye_.project(p));
    for (std::uint32_t i = 2; i < polygon.size(); ++i) {
      const ScreenPoint* const p = out_.points.data() + first;
      const int facing = facing_of(p[0], p[i - 1], p[i]);
      if (facing != 0 && !is_culled(facing)) out_.faces.push_back({{first, first + i - 1, first + i}, id});
    }
  }

  /// The number of a vertex's point.
  std::uint32_t point(std::uint32_t vertex) {
    std::uint32_t& number = number_[vertex];
    if (number == no_index) {
      number = std::uint32_t(out_.points.size());
      out_.points.push_back(eye_.project(seen_[vertex]));
    }
    return number;
  }

  const PlacedScene& placed_;
  Eye eye_;
  Culling culling_;
  std::vector<std::int8_t>& facing_;
  bool is_mirrored_ = false;
  WorldScratch scratch_;
  std::vector<EyePoint> seen_;
  std::vector<std::uint8_t> outside_;
  std::vector<std::uint32_t> number_;
  ViewedFaces out_;
};

ViewedFaces joined(const std::vector<ViewedFaces>& parts) {
  ViewedFaces all;
  std::size_t points = 0, faces = 0;
  for (const ViewedFaces& part : parts) points += part.points.size(), faces += part.faces.size();
  if (points >= no_index || faces >= no_index)
    throw Error(ErrorCode::limit_exceeded, "more than 4294967294 faces or corners within the view");
  all.points.reserve(points);
  all.faces.reserve(faces);
  for (const ViewedFaces& part : parts) {
    const auto first = std::uint32_t(all.points.size());
    all.points.insert(all.points.end(), part.points.begin(), part.points.end());
    for (const ViewedFace& face : part.faces)
      all.faces.push_back({{face.corners[0] + first, face.corners[1] + first, face.corners[2] + first}, face.id});
  }
  return all;
}

}  // namespace

ViewedFaces viewed_faces(const Surfaces& surfaces, const View& view, const std::vector<MeshSides>& sides,
                         const Execution& execution) {
  constexpr std::size_t kRangesAtOnce = 16, kFacesAtOnce = 8192;
  const PlacedScene& placed = surfaces.placed();
  std::vector<std::int8_t> facing(surfaces.primitive_count(), 0);
  std::vector<ViewedFaces> parts((placed.ranges.size() + kRangesAtOnce - 1) / kRangesAtOnce);
  parallel_for(execution, placed.ranges.size(), kRangesAtOnce, [&](std::size_t begin, std::size_t end) {
    FaceGatherer gatherer(placed, view, facing);
    for (std::size_t i = begin; i < end; ++i) gatherer.gather(placed.ranges[i]);
    parts[begin / kRangesAtOnce] = gatherer.take();
  });
  ViewedFaces all = joined(parts);
  parts.clear();
  all.ending.resize(all.faces.size());
  parallel_for(execution, all.faces.size(), kFacesAtOnce, [&](std::size_t begin, std::size_t end) {
    const auto& first = placed.first_primitives;
    std::size_t instance = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const PrimitiveId id = all.faces[i].id;
      if (i == begin) instance = std::size_t(std::upper_bound(first.begin(), first.end(), id) - first.begin()) - 1;
      while (first[instance + 1] <= id) ++instance;
      const MeshSides& mesh = sides[placed.scene->instances[instance].mesh];
      for (int side = 0; side < 3; ++side) {
        const std::uint32_t beyond = mesh.beyond(id - first[instance], side);
        const int own = facing[id], other = beyond == no_index ? 0 : facing[first[instance] + beyond];
        const int plain = own != 0 && mesh.is_wound_alike(id - first[instance], side) ? own : -own;
        if (beyond == no_index || own == 0 || other != plain) all.ending[i] |= std::uint8_t(1 << side);
      }
    }
  });
  return all;
}

}  // namespace frontmost::faces_detail
