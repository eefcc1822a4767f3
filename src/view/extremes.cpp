// SPDX-License-Identifier: Apache-2.0
// The farthest points of a model in directions all around, found without looking at all of them.

#include "view/extremes.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace frontmost {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

bool comes_before(const glm::vec3& a, const glm::vec3& b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); }

}  // namespace

Extremes::Extremes(const glm::dmat4& axes, const glm::dvec2& spread)
    : across_{axes[0], axes[1]}, back_(axes[2]), spread_(spread) {
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

/// A point along the axes of the two planes.
struct Extremes::Projected {
  double across[2], towards;
};

Extremes::Projected Extremes::projected(const glm::vec3& point) const {
  const glm::dvec3 p(point);
  return {{glm::dot(p, across_[0]), glm::dot(p, across_[1])}, glm::dot(p, back_)};
}

double Extremes::reach(int direction, const Projected& point) const {
  const int plane = direction >= in_plane, k = direction - plane * in_plane;
  const double across = point.across[plane], towards = point.towards;
  if (k < around) return across * cosine_[k] + towards * sine_[k];
  // To the bit what the fitting of a frustum computes of the point.
  return (k == around ? across : -across) / spread_[plane] + towards;
}

void Extremes::include(const glm::vec3& point) {
  if (!may_change_by({point, point})) return;
  const Projected along = projected(point);
  for (int i = 0; i < direction_count; ++i) offer(i, reach(i, along), point);
}

void Extremes::offer(int direction, double reach, const glm::vec3& point) {
  Kept& kept = kept_[direction];
  // Of points that reach equally far the first in a fixed order: what is kept must not depend on who came first.
  if (reach < reach_[direction]) return;
  if (kept.is_set && reach == reach_[direction] && !comes_before(point, kept.point)) return;
  reach_[direction] = reach;
  kept = {point, true};
}

/// A box as sums need it, larger by more than all rounding, so that no point is passed over that would tie.
struct Extremes::Extent {
  glm::dvec3 middle, half;

  explicit Extent(const Box& box) {
    const glm::dvec3 low(box.low), high(box.high);
    middle = 0.5 * (low + high);
    half = 0.5 * (high - low);
    const glm::dvec3 size = glm::abs(middle) + half;
    // Coordinates are floats, exact in double; a reach is three products and two sums of them, and errs by less than
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
  // A few directions at a time, without branches, so that the compiler can take several in one instruction.
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

/// Looks for the farthest vertex of one direction after the other: first where the boxes reach farthest, then wherever
/// they reach as far as what was found.
class Extremes::Search {
 public:
  Search(const ClusterSet& set, Extremes& extremes) : set_(set), extremes_(extremes) {
    for (std::size_t first = 0; first < set.clusters.size(); first += group_size) {
      Box box;
      const std::size_t end = std::min(first + group_size, set.clusters.size());
      for (std::size_t i = first; i < end; ++i) box.include(set.boxes.get(i));
      if (!box.is_empty()) groups_.push_back({first, end, Extent(box)});
    }
    reaches_.resize(groups_.size());
  }

  void run() {
    for (int i = 0; i < direction_count && !groups_.empty(); ++i) {
      for (std::size_t g = 0; g < groups_.size(); ++g) reaches_[g] = extremes_.reach(i, groups_[g].extent);
      const auto farthest = std::max_element(reaches_.begin(), reaches_.end());
      look_at_farthest(i, groups_[std::size_t(farthest - reaches_.begin())]);
      for (std::size_t g = 0; g < groups_.size(); ++g)
        if (reaches_[g] >= extremes_.reach_[i]) look_at(i, groups_[g]);
      // Near the farthest in neighbouring directions too, so that these begin with something to hold boxes against.
      const glm::vec3 point = extremes_.kept_[i].point;
      extremes_.include(point);
    }
  }

 private:
  /// Clusters are neighbours in space, and so are runs of them.
  static constexpr std::size_t group_size = 32;
  struct Group {
    std::size_t first, end;  ///< of the clusters
    Extent extent;
  };

  void look_at_farthest(int direction, const Group& group) {
    std::size_t farthest = group.first;
    double most = -kInfinity;
    for (std::size_t c = group.first; c < group.end; ++c) {
      const double reach = reach_of_cluster(direction, c);
      if (reach > most) most = reach, farthest = c;
    }
    if (most >= extremes_.reach_[direction]) offer_vertices(direction, farthest);
  }
  void look_at(int direction, const Group& group) {
    for (std::size_t c = group.first; c < group.end; ++c)
      if (reach_of_cluster(direction, c) >= extremes_.reach_[direction]) offer_vertices(direction, c);
  }
  [[nodiscard]] double reach_of_cluster(int direction, std::size_t cluster) const {
    const Box box = set_.boxes.get(cluster);
    return box.is_empty() ? -kInfinity : extremes_.reach(direction, Extent(box));
  }
  void offer_vertices(int direction, std::size_t cluster) {
    const std::size_t first = set_.clusters[cluster].first_vertex;
    for (std::size_t v = first; v < first + set_.clusters[cluster].vertex_count; ++v) {
      const glm::vec3 point(set_.x[v], set_.y[v], set_.z[v]);
      extremes_.offer(direction, extremes_.reach(direction, extremes_.projected(point)), point);
    }
  }

  const ClusterSet& set_;
  Extremes& extremes_;
  std::vector<Group> groups_;
  std::vector<double> reaches_;  ///< of the groups, in one direction
};

void Extremes::include(const ClusterSet& set) { Search(set, *this).run(); }

std::vector<glm::vec3> Extremes::points() const {
  std::vector<glm::vec3> points;
  for (const Kept& kept : kept_)
    if (kept.is_set) points.push_back(kept.point);
  std::sort(points.begin(), points.end(), comes_before);
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return points;
}

}  // namespace frontmost
