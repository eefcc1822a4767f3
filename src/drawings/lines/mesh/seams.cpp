// SPDX-License-Identifier: Apache-2.0
// Fillers that share sides lie on one line: together they are a seam. Each stretch between two neighbouring corners of
// a filler occurs twice in it, on its long side and on a short one. So the sides of the other triangles, cut at all
// corners, pair up without the fillers as they did with them.
//
//    fillers that share sides      A-M-B, A-N-M ...      one line each, found by uniting fillers with a common side
//    corners of the line           A N M B               sorted along any axis on which two of them differ
//    a triangle with the side A-B  becomes A-N-C, N-M-C, M-B-C
//
// Lines are exact: whether a triangle has no area is an exact sign, and the order along a line is that of one
// coordinate, without arithmetic.
#include <algorithm>
#include <functional>
#include <vector>

#include "base/exact_vector.h"
#include "base/parallel.h"
#include "geometry/disjoint_sets.h"
#include "lines/lists.h"
#include "lines/mesh/welded_mesh.h"

namespace frontmost::lines_detail {
namespace {

constexpr std::size_t kSeamsPerPoll = 1 << 18;
/// The most triangles that are added: kMostAdded for each, and kAlwaysAdded. Every seam on a plane or a surface stays
/// far below. But sides that overlap along a line could add as many as the square of their number.
constexpr std::size_t kMostAdded = 4, kAlwaysAdded = 1 << 16;

bool is_straight(const Positions& at, const glm::uvec3& t) {
  const glm::dvec3 a = at[t.x], b = at[t.y], c = at[t.z];
  const BoundedNormal rounded(b - a, c - a);
  for (int axis = 0; axis < 3; ++axis)
    if (std::abs(rounded.value[axis]) > rounded.error[axis]) return false;
  const ExactVector normal = cross(difference(b, a), difference(c, a));
  return normal[0].sign() == 0 && normal[1].sign() == 0 && normal[2].sign() == 0;
}

/// The numbers of the triangles without area, ascending.
std::vector<std::uint32_t> fillers_of(const WeldedMesh& mesh, const Buffer<std::int8_t>& facing,
                                      const Execution& execution) {
  std::vector<std::uint32_t> fillers;
  for (std::uint32_t i = 0; i < facing.size(); ++i) {
    if (i % kSeamsPerPoll == 0) check_cancelled(execution);
    // A triangle without area is seen edge-on from every eye.
    if (facing[i] == 0 && is_straight(mesh.positions, mesh.triangles[i])) fillers.push_back(i);
  }
  return fillers;
}

/// The lines of fillers, and the fillers' sides on them.
class Seams {
 public:
  Seams(const WeldedMesh& mesh, const std::vector<std::uint32_t>& fillers, const Execution& execution);

  /// The seam that has a filler's side between these two vertices; no_index if there is none.
  [[nodiscard]] std::uint32_t of(std::uint32_t a, std::uint32_t b) const {
    if (!is_corner_[a] || !is_corner_[b]) return no_index;
    const Side side{std::min(a, b), std::max(a, b), 0};
    const auto found = std::lower_bound(sides_.begin(), sides_.end(), side);
    return found != sides_.end() && !(side < *found) && is_open_[found->seam] ? found->seam : no_index;
  }
  struct Range {
    std::size_t first, last;  ///< last is one beyond
  };
  /// The places of the seam's corners strictly between two of its corners.
  [[nodiscard]] Range between(std::uint32_t seam, std::uint32_t a, std::uint32_t b) const {
    const std::size_t i = place_of(seam, a), j = place_of(seam, b);
    return {std::min(i, j) + 1, std::max(i, j)};
  }
  [[nodiscard]] std::uint32_t corner(std::size_t place) const { return corners_[place]; }
  [[nodiscard]] std::size_t count() const { return axes_.size(); }
  void leave(std::uint32_t seam) { is_open_[seam] = false; }

 private:
  /// A side of a filler; at first, `seam` holds the number of the filler.
  struct Side {
    std::uint32_t low, high, seam;
    friend bool operator<(const Side& a, const Side& b) { return a.low != b.low ? a.low < b.low : a.high < b.high; }
  };
  [[nodiscard]] std::vector<std::uint32_t> number_lines(std::size_t fillers);
  [[nodiscard]] std::size_t place_of(std::uint32_t seam, std::uint32_t vertex) const;
  [[nodiscard]] bool is_before(std::uint32_t seam, std::uint32_t a, std::uint32_t b) const {
    return positions_[a][axes_[seam]] < positions_[b][axes_[seam]];
  }
  void sort_corners(const Execution& execution);

  const Positions& positions_;
  std::vector<Side> sides_;             ///< ascending, each once
  std::vector<std::uint32_t> corners_;  ///< by seam, along its line
  std::vector<std::size_t> first_;      ///< by seam: index of its first corner
  std::vector<int> axes_;               ///< by seam: an axis on which its corners differ
  std::vector<bool> is_open_;           ///< by seam
  std::vector<bool> is_corner_;         ///< by vertex
};

Seams::Seams(const WeldedMesh& mesh, const std::vector<std::uint32_t>& fillers, const Execution& execution)
    : positions_(mesh.positions), is_corner_(mesh.positions.size(), false) {
  for (std::uint32_t i = 0; i < fillers.size(); ++i) {
    const glm::uvec3& t = mesh.triangles[fillers[i]];
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k], b = t[k == 2 ? 0 : k + 1];
      sides_.push_back({std::min(a, b), std::max(a, b), i});
      is_corner_[a] = true;
    }
  }
  // The order of equal sides does not matter: their fillers are on one line.
  sort_in_parts(sides_, std::less<>(), execution);
  const std::vector<std::uint32_t> seam_of = number_lines(fillers.size());
  for (Side& side : sides_) side.seam = seam_of[side.seam];
  sides_.erase(std::unique(sides_.begin(), sides_.end(), [](const Side& a, const Side& b) { return !(a < b); }),
               sides_.end());
  sort_corners(execution);
}

/// By filler, the number of its line. Fillers with a common side are on one line, since they share two points.
std::vector<std::uint32_t> Seams::number_lines(std::size_t fillers) {
  DisjointSets<> lines(fillers);
  for (std::size_t s = 1; s < sides_.size(); ++s) {
    if (!(sides_[s - 1] < sides_[s])) lines.join(sides_[s - 1].seam, sides_[s].seam);
  }
  std::vector<std::uint32_t> numbers(fillers);
  std::uint32_t count = 0;
  for (std::uint32_t i = 0; i < fillers; ++i) numbers[i] = lines.is_leader(i) ? count++ : numbers[lines.leader_of(i)];
  axes_.assign(count, 0);
  is_open_.assign(count, true);
  return numbers;
}

void Seams::sort_corners(const Execution& execution) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> members;  // seam, vertex
  for (const Side& side : sides_) {
    members.emplace_back(side.seam, side.low);
    members.emplace_back(side.seam, side.high);
    const glm::dvec3 along = glm::abs(positions_[side.high] - positions_[side.low]);
    // Any axis works on which two points of the line differ: then all of them do.
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

std::size_t Seams::place_of(std::uint32_t seam, std::uint32_t vertex) const {
  const auto begin = corners_.begin() + std::ptrdiff_t(first_[seam]),
             end = corners_.begin() + std::ptrdiff_t(first_[seam + 1]);
  const auto at =
      std::lower_bound(begin, end, vertex, [&](std::uint32_t a, std::uint32_t b) { return is_before(seam, a, b); });
  return std::size_t(at - corners_.begin());
}

/// A triangle, and the seam of the side from corner k to the next; no_index where the side is on no seam.
struct Seamed {
  glm::uvec3 corners, seams;
};

Seamed seamed(const Seams& seams, const glm::uvec3& t) {
  return {t, {seams.of(t.x, t.y), seams.of(t.y, t.z), seams.of(t.z, t.x)}};
}

/// Gives up seams for which there is no room.
/// \returns how many triangles the others add.
std::size_t leave_crowded(Seams& seams, const WeldedMesh& mesh, const Execution& execution) {
  std::vector<std::size_t> added(seams.count(), 0);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    if (i % kSeamsPerPoll == 0) check_cancelled(execution);
    const glm::uvec3& t = mesh.triangles[i];
    const Seamed triangle = seamed(seams, t);
    for (int k = 0; k < 3; ++k) {
      if (triangle.seams[k] == no_index) continue;
      const Seams::Range range = seams.between(triangle.seams[k], t[k], t[k == 2 ? 0 : k + 1]);
      added[triangle.seams[k]] += range.last - range.first;
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

/// Calls add(corners) for the pieces of a triangle. It is halved repeatedly, at the middle corner of the side with the
/// lowest vertices. So the same triangle in another order of its corners gives the same pieces.
template <class Add>
void split(const Seams& seams, const Seamed& triangle, const Add& add) {
  int side = -1;
  Seams::Range at{0, 0};
  std::pair<std::uint32_t, std::uint32_t> lowest;
  for (int k = 0; k < 3; ++k) {
    if (triangle.seams[k] == no_index) continue;
    const std::uint32_t a = triangle.corners[k], b = triangle.corners[k == 2 ? 0 : k + 1];
    const Seams::Range range = seams.between(triangle.seams[k], a, b);
    const std::pair<std::uint32_t, std::uint32_t> ends{std::min(a, b), std::max(a, b)};
    if (range.first == range.last || (side >= 0 && lowest < ends)) continue;
    side = k, at = range, lowest = ends;
  }
  if (side < 0) {
    add(triangle.corners);
    return;
  }
  const int next = side == 2 ? 0 : side + 1;
  const std::uint32_t middle = seams.corner(at.first + (at.last - at.first) / 2);
  // The new side between the halves lies on no seam.
  Seamed from = triangle, to = triangle;
  from.corners[next] = middle;
  from.seams[next] = no_index;
  to.corners[side] = middle;
  to.seams[side == 0 ? 2 : side - 1] = no_index;
  split(seams, from, add);
  split(seams, to, add);
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

bool close_seams(WeldedMesh& mesh, const Buffer<std::int8_t>& facing, const Execution& execution) {
  const std::vector<std::uint32_t> fillers = fillers_of(mesh, facing, execution);
  if (fillers.empty()) return false;
  Seams seams(mesh, fillers, execution);
  leave_out(mesh, fillers);
  const std::size_t count = mesh.triangles.size() + leave_crowded(seams, mesh, execution);
  Buffer<glm::uvec3> triangles(count);
  Buffer<PrimitiveId> ids(count);
  std::size_t filled = 0;
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    split(seams, seamed(seams, mesh.triangles[i]), [&](const glm::uvec3& corners) {
      if (filled % kSeamsPerPoll == 0) check_cancelled(execution);
      triangles[filled] = corners;
      ids[filled++] = mesh.ids[i];
    });
  }
  mesh.triangles = std::move(triangles);
  mesh.ids = std::move(ids);
  return true;
}

}  // namespace frontmost::lines_detail
