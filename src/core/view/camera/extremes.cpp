// SPDX-License-Identifier: Apache-2.0
// The farthest points of a model in directions all around, found without looking at all points.
//
// The search begins with the boxes that reach farthest in each direction. The points found bound a polygon in each of
// two planes (Core): a point within both polygons reaches less far than the kept points. Most boxes lie wholly in the
// core and are passed over. Each vertex of other boxes is tested, and the core is made anew once it has become too
// small.
//
//     . - - - - - - *   --> direction k: the farthest point is kept
//    /             /
//   *     core    /    points and whole boxes within the core are passed over
//    \           /
//     . _ _ _ _ *
//
// A core only saves work. The one rounding of reach() decides which points are kept, so the result depends neither on
// the order of points nor on boxes or clusters.

#include "view/camera/extremes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

namespace frontmost {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

bool comes_before(const glm::vec3& a, const glm::vec3& b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); }

}  // namespace

FilledFrustum::FilledFrustum(const glm::dmat4& world_from_eye, const Projection& sides, double margin)
    : axes(world_from_eye),
      middle((sides.right + sides.left) / 2, (sides.top + sides.bottom) / 2),
      spread(glm::dvec2(sides.right - sides.left, sides.top - sides.bottom) / 2.0 * (1 - 2 * margin)) {
  axes[0] += middle.x * axes[2];
  axes[1] += middle.y * axes[2];
}

Extremes::Extremes(const FilledFrustum& frustum)
    : across_{frustum.axes[0], frustum.axes[1]}, back_(frustum.axes[2]), spread_(frustum.spread) {
  constexpr double step = 6.283185307179586 / around;
  for (int k = 0; k < around; ++k) {
    // Rounded to floats: the last bits of sine and cosine differ between C libraries.
    const bool is_axis = k % (around / 4) == 0;
    const double c = double(float(std::cos(k * step))), s = double(float(std::sin(k * step)));
    cosine_[k] = is_axis ? std::round(c) : c;
    sine_[k] = is_axis ? std::round(s) : s;
  }
  for (int plane = 0; plane < 2; ++plane) {
    const glm::dvec3& across = across_[plane];
    for (int k = 0; k < in_plane; ++k) {
      const glm::dvec3 d = k < around ? cosine_[k] * across + sine_[k] * back_
                                      : across * ((k == around ? 1 : -1) / spread_[plane]) + back_;
      const int i = plane * in_plane + k;
      x_[i] = d.x, abs_x_[i] = std::abs(d.x);
      y_[i] = d.y, abs_y_[i] = std::abs(d.y);
      z_[i] = d.z, abs_z_[i] = std::abs(d.z);
    }
  }
  std::fill_n(reach_, direction_count, -kInfinity);
}

/// The coordinates of a point along the axes of the two planes.
struct Extremes::Projected {
  double across[2], towards;
};

Extremes::Projected Extremes::projected(const glm::dvec3& p) const {
  return {{glm::dot(p, across_[0]), glm::dot(p, across_[1])}, glm::dot(p, back_)};
}

double Extremes::reach(int direction, const Projected& point) const {
  const int plane = direction >= in_plane, k = direction - plane * in_plane;
  const double across = point.across[plane], towards = point.towards;
  if (k < around) return across * cosine_[k] + towards * sine_[k];
  // This value equals, to the bit, the one that Fit (frame.cpp) computes for the point.
  return (k == around ? across : -across) / spread_[plane] + towards;
}

void Extremes::include(const glm::vec3& point) {
  if (!may_change_by({point, point})) return;
  const Projected along = projected(glm::dvec3(point));
  for (int i = 0; i < direction_count; ++i) offer(i, reach(i, along), point);
}

void Extremes::offer(int direction, double reach, const glm::vec3& point) {
  Kept& kept = kept_[direction];
  // Points that reach equally far are kept by a fixed order, so that the result does not depend on which came first.
  if (reach < reach_[direction]) return;
  if (kept.is_set && reach == reach_[direction] && !comes_before(point, kept.point)) return;
  reach_[direction] = reach;
  kept = {point, true};
}

/// A box as centre and half size, enlarged by more than all rounding, so that no point that would tie is passed over.
struct Extremes::Extent {
  glm::dvec3 middle, half;

  explicit Extent(const Box& box) {
    const glm::dvec3 low(box.low), high(box.high);
    middle = 0.5 * (low + high);
    half = 0.5 * (high - low);
    const glm::dvec3 size = glm::abs(middle) + half;
    // Coordinates are floats, exact in double. A reach is three products and two sums of them, and errs by less than
    // 1e-15 of this sum.
    half += 1e-12 * (size.x + size.y + size.z);
  }
};

double Extremes::reach(int i, const Extent& extent) const {
  const auto& [middle, half] = extent;
  return middle.x * x_[i] + middle.y * y_[i] + middle.z * z_[i] + half.x * abs_x_[i] + half.y * abs_y_[i] +
         half.z * abs_z_[i];
}

bool Extremes::may_change_by(const Box& box) const {
  const Extent extent(box);
  // A few directions at a time, without branches, so that the compiler can use vectors.
  constexpr int at_once = 12;
  static_assert(direction_count % at_once == 0);
  const auto [x, y, z] = std::tie(extent.middle.x, extent.middle.y, extent.middle.z);
  const auto [dx, dy, dz] = std::tie(extent.half.x, extent.half.y, extent.half.z);
  for (int first = 0; first < direction_count; first += at_once) {
    double beyond[at_once];
    for (int k = 0, i = first; k < at_once; ++k, ++i)
      beyond[k] = x * x_[i] + y * y_[i] + z * z_[i] + dx * abs_x_[i] + dy * abs_y_[i] + dz * abs_z_[i] - reach_[i];
    bool may = false;
    for (const double distance : beyond) may |= distance >= 0;
    if (may) return true;
  }
  return false;
}

bool Extremes::may_change_by(const Projected& point) const {
  for (int plane = 0; plane < 2; ++plane) {
    const double across = point.across[plane], towards = point.towards;
    const double* const reached = reach_ + plane * in_plane;
    // Without branches, so that the compiler can use vectors.
    double beyond[around];
    for (int k = 0; k < around; ++k) beyond[k] = across * cosine_[k] + towards * sine_[k] - reached[k];
    bool may = false;
    for (const double distance : beyond) may |= distance >= 0;
    for (int k = around; k < in_plane; ++k) may |= reach(plane * in_plane + k, point) >= reached[k];
    if (may) return true;
  }
  return false;
}

/// In each of the two planes, the polygon within the lines through the kept points, stored by the slopes of rays from
/// its middle. A point within both polygons reaches less far than the kept points.
class Extremes::Core {
 public:
  explicit Core(const Extremes& extremes) {
    for (int plane = 0; plane < 2; ++plane) {
      const double* const reached = extremes.reach_ + plane * in_plane;
      const double right = reached[0], far = reached[around / 4], left = reached[around / 2],
                   near = reached[3 * around / 4];
      polygons_[plane] = {{(right - left) / 2, (far - near) / 2}, {(right + left) / 2, (far + near) / 2}, {}, {}};
      Polygon& polygon = polygons_[plane];
      const bool is_flat = !(polygon.half.x > 0 && polygon.half.y > 0);
      polygon.inverse_radius.fill(is_flat ? kInfinity : 0);
      if (!is_flat) polygon.inverse_half = 1.0 / polygon.half;
      for (int k = 0; k < in_plane; ++k) {
        const double sign = k == around ? 1 : -1;
        const glm::dvec2 normal = k < around ? glm::dvec2(extremes.cosine_[k], extremes.sine_[k])
                                             : glm::dvec2(sign / extremes.spread_[plane], 1);
        polygon.cut(normal * polygon.half, reached[k] - glm::dot(normal, polygon.middle));
      }
    }
  }

  [[nodiscard]] bool holds(const Projected& point) const {
    return polygons_[0].holds({point.across[0], point.towards}) && polygons_[1].holds({point.across[1], point.towards});
  }
  /// Whether the core holds all points whose coordinates differ from those of `middle` by at most `half`.
  [[nodiscard]] bool holds_all(const Projected& middle, const Projected& half) const {
    for (const double x : {-1.0, 1.0})
      for (const double towards : {-1.0, 1.0})
        if (!holds({{middle.across[0] + x * half.across[0], middle.across[1] + x * half.across[1]},
                    middle.towards + towards * half.towards}))
          return false;
    return true;
  }

 private:
  struct Polygon {
    static constexpr int slopes = 64;  ///< on each side of the rectangle around the middle

    glm::dvec2 middle{0}, half{0};
    glm::dvec2 inverse_half{0};  ///< 0 if the polygon is flat, or nothing is kept yet
    /// By side and slope: points nearer to the middle than the inverse of this value, in units of `half`, are in the
    /// polygon. Along a side the value is the greatest of linear functions, one for each line, and so convex: between
    /// two slopes it is at most the linear interpolation of the values at these slopes.
    std::array<double, 4 * (slopes + 1)> inverse_radius;

    /// Cuts off everything farther than `distance` along `normal`, in units of `half`.
    void cut(const glm::dvec2& normal, double distance) {
      for (int side = 0; side < 4; ++side)
        for (int slope = 0; slope <= slopes; ++slope) {
          const double minor = 2.0 * slope / slopes - 1, major = side % 2 ? -1 : 1;
          const double along = glm::dot(normal, side < 2 ? glm::dvec2(major, minor) : glm::dvec2(minor, major));
          double& inverse = inverse_radius[std::size_t(side * (slopes + 1) + slope)];
          inverse = distance > 0 ? std::max(inverse, along / distance) : kInfinity;
        }
    }
    [[nodiscard]] bool holds(const glm::dvec2& p) const {
      const glm::dvec2 q = (p - middle) * inverse_half;
      const bool is_steep = std::abs(q.y) > std::abs(q.x);
      const double major = is_steep ? q.y : q.x, minor = is_steep ? q.x : q.y, size = std::abs(major);
      if (!(size > 0)) return false;
      const double at = (minor / size + 1) * (slopes / 2);
      const int slope = std::min(int(at), slopes - 1), side = (is_steep ? 2 : 0) + (major < 0 ? 1 : 0);
      const double* const inverse = inverse_radius.data() + side * (slopes + 1) + slope;
      const double between = inverse[0] + (inverse[1] - inverse[0]) * (at - slope);
      return size * between < 1 - 1e-6;  // the margin is far more than rounding; false for infinity
    }
  };
  Polygon polygons_[2];
};

/// Visits the boxes that reach farthest in each direction, and then all boxes that are not within the core of the
/// points found.
template <class Parts>
class Extremes::Search {
 public:
  Search(const Parts& parts, Extremes& extremes)
      : parts_(parts), extremes_(extremes), core_(extremes), is_done_(parts.count(), false) {}

  void run() {
    look_at_farthest();
    core_ = Core(extremes_);
    for (std::size_t i = 0; i < parts_.count(); ++i)
      if (const Box box = parts_.box(i); !box.is_empty() && !is_held(box)) offer_vertices(i);
  }

 private:
  void look_at_farthest() {
    std::array<double, direction_count> most;
    std::array<std::size_t, direction_count> farthest{};
    most.fill(-kInfinity);
    // To start the search, a sample of the parts serves as well as all parts.
    const std::size_t step = parts_.count() / 4096 + 1;
    for (std::size_t part = 0; part < parts_.count(); part += step) {
      const Box box = parts_.box(part);
      if (box.is_empty()) continue;
      const Extent extent(box);
      for (std::size_t i = 0; i < direction_count; ++i)
        if (const double reach = extremes_.reach(int(i), extent); reach > most[i]) most[i] = reach, farthest[i] = part;
    }
    for (std::size_t i = 0; i < direction_count; ++i)
      if (most[i] > -kInfinity) offer_vertices(farthest[i]);
  }

  [[nodiscard]] bool is_held(const Box& box) const {
    const Extent extent(box);
    const auto reach = [&](const glm::dvec3& axis) { return glm::dot(extent.half, glm::abs(axis)); };
    return core_.holds_all(extremes_.projected(extent.middle),
                           {{reach(extremes_.across_[0]), reach(extremes_.across_[1])}, reach(extremes_.back_)});
  }

  void offer_vertices(std::size_t part) {
    if (is_done_[part]) return;
    is_done_[part] = true;
    parts_.visit(part, [&](const glm::vec3& vertex) { offer(vertex); });
    if (!is_changed_ || missed_ < missed_at_most_) return;
    core_ = Core(extremes_);
    missed_at_most_ *= 2;  // if many points lie at the rim, no core holds them
    missed_ = 0;
    is_changed_ = false;
  }
  void offer(const glm::vec3& vertex) {
    const Projected along = extremes_.projected(glm::dvec3(vertex));
    if (core_.holds(along)) return;
    if (!extremes_.may_change_by(along)) {
      ++missed_;
      return;
    }
    is_changed_ = true;
    for (int i = 0; i < direction_count; ++i) extremes_.offer(i, extremes_.reach(i, along), vertex);
  }

  const Parts parts_;
  Extremes& extremes_;
  Core core_;
  std::vector<bool> is_done_;  ///< by part
  int missed_at_most_ = 1024;  ///< this many full tests cost more than making another core
  int missed_ = 0;             ///< points outside the core that changed nothing, since the core was made
  bool is_changed_ = false;    ///< whether a kept point has changed since the core was made
};

namespace {

/// Parts of a Search: the boxes of a placed scene, whose triangles are neighbours in the file. The boxes of left-out
/// objects are empty.
struct PlacedParts {
  const PlacedScene& placed;
  std::vector<bool> is_left_out;  ///< by box

  PlacedParts(const PlacedScene& scene, std::span<const std::uint32_t> left_out)
      : placed(scene), is_left_out(scene.boxes.size(), false) {
    for (const MeshRange& range : placed.ranges)
      if (std::binary_search(left_out.begin(), left_out.end(), range.instance))
        std::fill_n(is_left_out.begin() + range.first_box, range.box_count(), true);
  }
  [[nodiscard]] std::size_t count() const { return placed.boxes.size(); }
  [[nodiscard]] Box box(std::size_t i) const { return is_left_out[i] ? Box() : placed.boxes[i]; }
  template <class Visit>
  void visit(std::size_t i, const Visit& vertex) const {
    placed.visit_box(i, vertex);
  }
};

/// Parts of a Search: clusters, whose triangles are neighbours in space.
struct ClusterParts {
  const ClusterSet& set;

  [[nodiscard]] std::size_t count() const { return set.clusters.size(); }
  [[nodiscard]] Box box(std::size_t i) const { return set.boxes.get(i); }
  template <class Visit>
  void visit(std::size_t i, const Visit& vertex) const {
    const std::size_t first = set.clusters[i].first_vertex;
    for (std::size_t v = first; v < first + set.clusters[i].vertex_count; ++v)
      vertex(glm::vec3(set.x[v], set.y[v], set.z[v]));
  }
};

}  // namespace

void Extremes::include(const PlacedScene& placed, std::span<const std::uint32_t> left_out) {
  Search<PlacedParts>(PlacedParts(placed, left_out), *this).run();
}
void Extremes::include(const ClusterSet& set) { Search<ClusterParts>({set}, *this).run(); }

std::vector<glm::vec3> Extremes::points() const {
  std::vector<glm::vec3> points;
  for (const Kept& kept : kept_)
    if (kept.is_set) points.push_back(kept.point);
  std::sort(points.begin(), points.end(), comes_before);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return points;
}

}  // namespace frontmost
