// SPDX-License-Identifier: Apache-2.0
// All lists are counted in parts before they are written, so no list grows and no thread waits.
//
//    fillers that share sides      A-M-B, A-N-M ...      one line (a seam) each, found by uniting fillers
//    corners of the seam           A N M B               sorted along any axis on which two of them differ
//    a triangle with the side A-B  becomes A-N-C, N-M-C, M-B-C
#include "lines/mesh/mesh.h"

#include <algorithm>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "base/exact_vector.h"
#include "base/parallel.h"
#include "geometry/disjoint_sets.h"
#include "geometry/places.h"
#include "lines/lists.h"
#include "surfaces/cluster_set.h"

namespace frontmost::lines_detail {
namespace {

constexpr std::size_t kWeldedPerPart = 8192;

/// Calls visit(instance, first, last) for the pieces of a range over all instances within each instance. `firsts` are
/// the instances' first numbers, followed by the count of all.
template <class Visitor>
void visit_instances(const std::vector<std::size_t>& firsts, std::size_t begin, std::size_t end, const Visitor& visit) {
  auto i = std::size_t(std::upper_bound(firsts.begin(), firsts.end(), begin) - firsts.begin()) - 1;
  for (; begin < end; ++i) {
    const std::size_t last = std::min(end, firsts[i + 1]);
    if (begin < last) visit(i, begin - firsts[i], last - firsts[i]);
    begin = last;
  }
}

template <class Size>
std::vector<std::size_t> firsts_of(const Scene& scene, const Size& size) {
  std::vector<std::size_t> firsts{0};
  firsts.reserve(scene.instances.size() + 1);
  for (const Instance& instance : scene.instances) firsts.push_back(firsts.back() + size(scene.meshes[instance.mesh]));
  return firsts;
}

/// The number of kept items before each part, followed by the number of all kept items.
template <class IsKept>
std::vector<std::size_t> counted(std::size_t count, const IsKept& is_kept, const Execution& execution) {
  std::vector<std::size_t> before((count + kWeldedPerPart - 1) / kWeldedPerPart + 1, 0);
  parallel_for(execution, count, kWeldedPerPart, [&](std::size_t begin, std::size_t end) {
    std::size_t kept = 0;
    for (std::size_t i = begin; i < end; ++i) kept += is_kept(i);
    before[begin / kWeldedPerPart + 1] = kept;
  });
  for (std::size_t i = 1; i < before.size(); ++i) before[i] += before[i - 1];
  return before;
}

Buffer<glm::vec3> places_of(const Scene& scene, const Execution& execution) {
  const std::vector<std::size_t> firsts = firsts_of(scene, [](const Mesh& mesh) { return mesh.positions.size(); });
  if (firsts.back() >= std::size_t(1) << 31)
    throw Error(ErrorCode::limit_exceeded, "lines", "more than 2147483647 vertices over all instances");
  Buffer<glm::vec3> places(firsts.back());
  parallel_for(execution, places.size(), kWeldedPerPart, [&](std::size_t begin, std::size_t end) {
    visit_instances(firsts, begin, end, [&](std::size_t i, std::size_t first, std::size_t last) {
      const std::vector<glm::vec3>& positions = scene.meshes[scene.instances[i].mesh].positions;
      const ToWorld to_world(scene.instances[i].world_from_mesh);
      for (std::size_t v = first; v < last; ++v) places[firsts[i] + v] = to_world(positions[v]) + 0.0f;  // -0 is 0
    });
  });
  return places;
}

/// The number of each vertex's place, for the vertices of all instances. Fills `positions`.
Buffer<std::uint32_t> number_places(const Scene& scene, Positions& positions, const Execution& execution) {
  const Buffer<glm::vec3> places = places_of(scene, execution);
  const Buffer<std::uint32_t> first = first_at_place({places.data(), places.size()}, execution);
  Buffer<std::uint32_t> numbers(places.size());
  const auto is_first = [&](std::size_t v) { return first[v] == v && is_finite(places[v]); };
  const std::vector<std::size_t> before = counted(places.size(), is_first, execution);
  Buffer<glm::vec3> kept(before.back());
  parallel_for(execution, places.size(), kWeldedPerPart, [&](std::size_t begin, std::size_t end) {
    std::size_t next = before[begin / kWeldedPerPart];
    for (std::size_t v = begin; v < end; ++v) {
      if (!is_first(v)) continue;
      kept[next] = places[v];
      numbers[v] = std::uint32_t(next++);
    }
  });
  parallel_for(execution, places.size(), kWeldedPerPart, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v)
      if (!is_first(v)) numbers[v] = first[v] == v ? no_index : numbers[first[v]];
  });
  positions = Positions(std::move(kept));
  return numbers;
}

bool is_one_surface(const Scene& scene) {
  return scene.instances.size() == 1 && scene.meshes[scene.instances[0].mesh].material_ids.empty();
}

/// Three place numbers for each primitive; the first is no_index if the primitive is left out. Fills `owners` unless
/// the scene is one surface.
Buffer<glm::uvec3> corners_of(const Surfaces& surfaces, const Buffer<std::uint32_t>& numbers, Buffer<SurfaceOf>& owners,
                              const Execution& execution) {
  const Scene& scene = surfaces.scene();
  const std::vector<std::size_t> vertices = firsts_of(scene, [](const Mesh& mesh) { return mesh.positions.size(); });
  const std::vector<std::size_t> firsts = firsts_of(scene, [](const Mesh& mesh) { return mesh.triangles.size(); });
  if (firsts.back() > Corner::most_triangles)
    throw Error(ErrorCode::limit_exceeded, "lines",
                "more than " + std::to_string(Corner::most_triangles) + " triangles over all instances");
  Buffer<glm::uvec3> all(firsts.back());
  if (!is_one_surface(scene)) owners = Buffer<SurfaceOf>(all.size());
  parallel_for(execution, all.size(), kWeldedPerPart, [&](std::size_t begin, std::size_t end) {
    visit_instances(firsts, begin, end, [&](std::size_t i, std::size_t first, std::size_t last) {
      const Mesh& mesh = scene.meshes[scene.instances[i].mesh];
      const std::vector<glm::uvec3>& triangles = mesh.triangles;
      const bool is_mirrored = surfaces.is_mirrored(std::uint32_t(i));
      for (std::size_t t = first; t < last; ++t) {
        glm::uvec3 c;
        for (int k = 0; k < 3; ++k) c[k] = numbers[vertices[i] + triangles[t][is_mirrored && k > 0 ? 3 - k : k]];
        if (c.y == no_index || c.z == no_index || c.x == c.y || c.y == c.z || c.z == c.x) c.x = no_index;
        all[firsts[i] + t] = c;
        if (!owners.empty()) owners[firsts[i] + t] = {std::uint32_t(i), mesh.material_of(std::uint32_t(t))};
      }
    });
  });
  return all;
}

constexpr std::size_t kSeamsPerPoll = 1 << 18;
/// The most triangles that are added: kMostAdded for each, and kAlwaysAdded. Sides that overlap along a line could add
/// as many as the square of their number.
constexpr std::size_t kMostAdded = 4, kAlwaysAdded = 1 << 16;

bool is_straight(const Positions& at, const glm::uvec3& t) {
  const glm::dvec3 a = at[t.x], b = at[t.y], c = at[t.z];
  const BoundedNormal rounded(b - a, c - a);
  for (int axis = 0; axis < 3; ++axis)
    if (std::abs(rounded.value[axis]) > rounded.error[axis]) return false;
  const ExactVector normal = cross(difference(b, a), difference(c, a));
  return normal[0].sign() == 0 && normal[1].sign() == 0 && normal[2].sign() == 0;
}

/// The seams of a mesh: the lines on which fillers lie, with the sides of these fillers.
class Seams {
 public:
  Seams(const WeldedMesh& mesh, const std::vector<std::uint32_t>& fillers, const Execution& execution)
      : positions_(mesh.positions), is_corner_(mesh.positions.size(), false) {
    for (std::uint32_t i = 0; i < fillers.size(); ++i) {
      const glm::uvec3& t = mesh.triangles[fillers[i]];
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t a = t[k], b = t[k == 2 ? 0 : k + 1];
        sides_.push_back({std::min(a, b), std::max(a, b), i});
        is_corner_[a] = true;
      }
    }
    // The order of equal sides does not matter, because their fillers are on one line.
    sort_in_parts(sides_, std::less<>(), execution);
    const std::vector<std::uint32_t> seam_of = number_lines(fillers.size());
    for (Side& side : sides_) side.seam = seam_of[side.seam];
    sides_.erase(std::unique(sides_.begin(), sides_.end(), [](const Side& a, const Side& b) { return !(a < b); }),
                 sides_.end());
    sort_corners(execution);
  }

  /// The seam that has a filler's side between these two vertices; no_index if there is none.
  [[nodiscard]] std::uint32_t of(std::uint32_t a, std::uint32_t b) const {
    if (!is_corner_[a] || !is_corner_[b]) return no_index;
    const Side side{std::min(a, b), std::max(a, b), 0};
    const auto found = std::lower_bound(sides_.begin(), sides_.end(), side);
    return found != sides_.end() && !(side < *found) && is_open_[found->seam] ? found->seam : no_index;
  }
  /// The seam's corners strictly between two of its corners.
  [[nodiscard]] std::span<const std::uint32_t> between(std::uint32_t seam, std::uint32_t a, std::uint32_t b) const {
    const auto [first, last] = std::minmax({place_of(seam, a), place_of(seam, b)});
    return {corners_.data() + first + 1, last - first - 1};
  }
  /// Whether one of a seam's corners comes before another along its line.
  [[nodiscard]] bool is_before(std::uint32_t seam, std::uint32_t a, std::uint32_t b) const {
    return positions_[a][axes_[seam]] < positions_[b][axes_[seam]];
  }
  [[nodiscard]] std::size_t count() const { return axes_.size(); }
  void leave(std::uint32_t seam) { is_open_[seam] = false; }

 private:
  /// A side of a filler; at first, `seam` holds the number of the filler.
  struct Side {
    std::uint32_t low, high, seam;
    friend bool operator<(const Side& a, const Side& b) { return a.low != b.low ? a.low < b.low : a.high < b.high; }
  };

  /// The number of each filler's line. Fillers with a common side are on one line, because they share two points.
  [[nodiscard]] std::vector<std::uint32_t> number_lines(std::size_t fillers) {
    DisjointSets<> lines(fillers);
    for (std::size_t s = 1; s < sides_.size(); ++s)
      if (!(sides_[s - 1] < sides_[s])) lines.join(sides_[s - 1].seam, sides_[s].seam);
    std::vector<std::uint32_t> numbers(fillers);
    std::uint32_t count = 0;
    for (std::uint32_t i = 0; i < fillers; ++i) numbers[i] = lines.is_leader(i) ? count++ : numbers[lines.leader_of(i)];
    axes_.assign(count, 0);
    is_open_.assign(count, true);
    return numbers;
  }

  [[nodiscard]] std::size_t place_of(std::uint32_t seam, std::uint32_t vertex) const {
    const auto begin = corners_.begin() + std::ptrdiff_t(first_[seam]),
               end = corners_.begin() + std::ptrdiff_t(first_[seam + 1]);
    const auto at =
        std::lower_bound(begin, end, vertex, [&](std::uint32_t a, std::uint32_t b) { return is_before(seam, a, b); });
    return std::size_t(at - corners_.begin());
  }

  void sort_corners(const Execution& execution) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> members;  // seam, vertex
    for (const Side& side : sides_) {
      members.emplace_back(side.seam, side.low);
      members.emplace_back(side.seam, side.high);
      const glm::dvec3 along = glm::abs(positions_[side.high] - positions_[side.low]);
      // Any axis works on which two points of the line differ, because all its points then differ on that axis.
      axes_[side.seam] = along.x > 0 ? 0 : along.y > 0 ? 1 : 2;
    }
    const auto is_earlier = [&](const auto& a, const auto& b) {
      return a.first != b.first ? a.first < b.first : is_before(a.first, a.second, b.second);
    };
    sort_in_parts(members, is_earlier, execution);
    members.erase(std::unique(members.begin(), members.end()), members.end());
    first_.assign(count() + 1, 0);
    for (const auto& [seam, vertex] : members) {
      ++first_[seam + 1];
      corners_.push_back(vertex);
    }
    for (std::size_t seam = 0; seam < count(); ++seam) first_[seam + 1] += first_[seam];
  }

  const Positions& positions_;
  std::vector<Side> sides_;             ///< ascending, each once
  std::vector<std::uint32_t> corners_;  ///< by seam, along its line
  std::vector<std::size_t> first_;      ///< by seam: index of its first corner
  std::vector<int> axes_;               ///< by seam: an axis on which its corners differ
  std::vector<bool> is_open_;           ///< by seam
  std::vector<bool> is_corner_;         ///< by vertex
};

/// A triangle. `seams[k]` is the seam of the side from corner k to the next corner, or no_index if there is none.
struct Seamed {
  glm::uvec3 corners, seams;
};

Seamed seamed(const Seams& seams, const glm::uvec3& t) {
  return {t, {seams.of(t.x, t.y), seams.of(t.y, t.z), seams.of(t.z, t.x)}};
}

/// Leaves seams open if closing them would add too many triangles. \returns how many triangles the other seams add.
std::size_t leave_crowded(Seams& seams, const WeldedMesh& mesh, const Execution& execution) {
  std::vector<std::size_t> added(seams.count(), 0);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (i % kSeamsPerPoll == 0) check_cancelled(execution);
    const glm::uvec3& t = mesh.triangles[i];
    const Seamed triangle = seamed(seams, t);
    for (int k = 0; k < 3; ++k) {
      if (triangle.seams[k] == no_index) continue;
      added[triangle.seams[k]] += seams.between(triangle.seams[k], t[k], t[k == 2 ? 0 : k + 1]).size();
    }
  }
  const std::size_t most = kMostAdded * mesh.triangles.size() + kAlwaysAdded;
  std::size_t sum = 0;
  for (std::size_t seam = 0; seam < seams.count(); ++seam) {
    if (sum + added[seam] > most)
      seams.leave(std::uint32_t(seam));
    else
      sum += added[seam];
  }
  return sum;
}

/// Calls add(corners) for the pieces of a triangle. The triangle is halved repeatedly, each time at the middle seam
/// corner of the side with the lowest vertices. So the pieces do not depend on the order of the triangle's corners.
template <class Add>
void split(const Seams& seams, const Seamed& triangle, const Add& add) {
  int side = -1;
  std::span<const std::uint32_t> at;
  std::pair<std::uint32_t, std::uint32_t> lowest;
  for (int k = 0; k < 3; ++k) {
    if (triangle.seams[k] == no_index) continue;
    const std::uint32_t a = triangle.corners[k], b = triangle.corners[k == 2 ? 0 : k + 1];
    const std::span<const std::uint32_t> between = seams.between(triangle.seams[k], a, b);
    const std::pair<std::uint32_t, std::uint32_t> ends = std::minmax({a, b});
    if (between.empty() || (side >= 0 && lowest < ends)) continue;
    side = k, at = between, lowest = ends;
  }
  if (side < 0) {
    add(triangle.corners);
    return;
  }
  const int next = side == 2 ? 0 : side + 1;
  const std::uint32_t middle = at[at.size() / 2];
  // The new side between the halves lies on no seam.
  Seamed from = triangle, to = triangle;
  from.corners[next] = middle;
  from.seams[next] = no_index;
  to.corners[side] = middle;
  to.seams[side == 0 ? 2 : side - 1] = no_index;
  split(seams, from, add);
  split(seams, to, add);
}

/// Appends the pieces of the triangle's sides that are stated edges.
void add_pieces(const Seams& seams, const Seamed& triangle, const StatedEdges& stated, std::vector<glm::uvec2>& sharp) {
  for (int k = 0; k < 3; ++k) {
    const std::uint32_t a = triangle.corners[k], b = triangle.corners[k == 2 ? 0 : k + 1];
    if (triangle.seams[k] == no_index || !stated.are_sharp(a, b)) continue;
    const std::span<const std::uint32_t> between = seams.between(triangle.seams[k], a, b);
    if (between.empty()) continue;
    for (std::size_t i = 1; i < between.size(); ++i) sharp.emplace_back(between[i - 1], between[i]);
    const bool is_forward = seams.is_before(triangle.seams[k], a, b);
    sharp.emplace_back(is_forward ? a : b, between.front());
    sharp.emplace_back(between.back(), is_forward ? b : a);
  }
}

void leave_out(WeldedMesh& mesh, const std::vector<std::uint32_t>& ascending) {
  std::size_t kept = 0;
  auto next = ascending.begin();
  WeldedMesh rest;
  rest.triangles = Buffer<glm::uvec3>(mesh.triangles.size() - ascending.size());
  rest.ids = Buffer<PrimitiveId>(rest.triangles.size());
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    if (next != ascending.end() && *next == i) {
      ++next;
      continue;
    }
    rest.triangles[kept] = mesh.triangles[i];
    rest.ids[kept++] = mesh.ids[i];
  }
  mesh.triangles = std::move(rest.triangles);
  mesh.ids = std::move(rest.ids);
}

}  // namespace

WeldedMesh weld(const Surfaces& surfaces, const Execution& execution) {
  WeldedMesh welded;
  const Buffer<std::uint32_t> numbers = number_places(surfaces.scene(), welded.positions, execution);
  Buffer<glm::uvec3> all = corners_of(surfaces, numbers, welded.surfaces, execution);
  welded.stated =
      StatedEdges(surfaces.scene(), numbers, all, {welded.positions.places.data(), welded.positions.size()}, execution);
  const auto is_kept = [&](std::size_t id) { return all[id].x != no_index; };
  const std::vector<std::size_t> before = counted(all.size(), is_kept, execution);
  welded.ids = Buffer<PrimitiveId>(before.back());
  const bool keeps_all = before.back() == all.size();
  if (!keeps_all) welded.triangles = Buffer<glm::uvec3>(before.back());
  parallel_for(execution, all.size(), kWeldedPerPart, [&](std::size_t begin, std::size_t end) {
    std::size_t next = before[begin / kWeldedPerPart];
    for (std::size_t id = begin; id < end; ++id) {
      if (!is_kept(id)) continue;
      if (!keeps_all) welded.triangles[next] = all[id];
      welded.ids[next++] = PrimitiveId(id);
    }
  });
  if (keeps_all) welded.triangles = std::move(all);
  return welded;
}

bool close_seams(WeldedMesh& mesh, const Buffer<std::int8_t>& facing, const Execution& execution) {
  std::vector<std::uint32_t> fillers;
  for (std::uint32_t i = 0; i < facing.size(); ++i) {
    if (i % kSeamsPerPoll == 0) check_cancelled(execution);
    // A triangle without area is seen edge-on from every eye.
    if (facing[i] == 0 && is_straight(mesh.positions, mesh.triangles[i])) fillers.push_back(i);
  }
  if (fillers.empty()) return false;
  Seams seams(mesh, fillers, execution);
  leave_out(mesh, fillers);
  const std::size_t count = mesh.triangles.size() + leave_crowded(seams, mesh, execution);
  Buffer<glm::uvec3> triangles(count);
  Buffer<PrimitiveId> ids(count);
  std::size_t filled = 0;
  std::vector<glm::uvec2> sharp;  // pieces of stated edges
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    if (!mesh.stated.empty()) add_pieces(seams, seamed(seams, mesh.triangles[i]), mesh.stated, sharp);
    split(seams, seamed(seams, mesh.triangles[i]), [&](const glm::uvec3& corners) {
      if (filled % kSeamsPerPoll == 0) check_cancelled(execution);
      triangles[filled] = corners;
      ids[filled++] = mesh.ids[i];
    });
  }
  mesh.stated.add(sharp, execution);
  mesh.triangles = std::move(triangles);
  mesh.ids = std::move(ids);
  return true;
}

}  // namespace frontmost::lines_detail
