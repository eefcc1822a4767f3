// SPDX-License-Identifier: Apache-2.0
// Two triangles that straddle each other's planes meet the planes' common line in an interval each. The common part of
// the intervals ends at those of their four ends that lie within the other triangle. Signs of tetrahedra decide that
// before any point is constructed.
//
// O. Devillers, P. Guigue. Faster Triangle-Triangle Intersection Tests. 2002.
#include "lines/crossings/crossings.h"

#include <algorithm>
#include <atomic>
#include <optional>
#include <string>
#include <tuple>

#include "base/parallel.h"
#include "base/work_limit.h"
#include "lines/crossings/box_tree.h"
#include "lines/lists.h"
#include "view/sight.h"

namespace frontmost::lines_detail {
namespace {

constexpr std::size_t kGroupsPerPart = 16, kPairsPerPoll = 16384;
/// A pair counts as kStepsOfPair steps of ten nanoseconds; the other two bound all steps. A city has 42 thousand
/// segments.
constexpr std::uint64_t kStepsOfPair = 8, kMostSteps = std::uint64_t(1) << 30, kMostStepsOfTriangle = 256;

/// A triangle with its vertices in ascending order, so that every computation with its plane gives the same bits.
class CrossedFace {
 public:
  CrossedFace(const WeldedMesh& mesh, std::uint32_t number)
      : triangle(number),
        vertices(ascending(mesh.triangles[number])),
        plane(mesh.positions[vertices.x], mesh.positions[vertices.y], mesh.positions[vertices.z]) {}

  [[nodiscard]] bool has(std::uint32_t vertex) const {
    return vertex == vertices.x || vertex == vertices.y || vertex == vertices.z;
  }

  const std::uint32_t triangle;
  const glm::uvec3 vertices;
  const FacePlane plane;

 private:
  static glm::uvec3 ascending(glm::uvec3 v) {
    if (v.x > v.y) std::swap(v.x, v.y);
    if (v.y > v.z) std::swap(v.y, v.z);
    if (v.x > v.y) std::swap(v.x, v.y);
    return v;
  }
};

struct Heights {
  Signed of[3];

  [[nodiscard]] bool straddle() const {
    const auto any = [&](int sign) { return of[0].sign == sign || of[1].sign == sign || of[2].sign == sign; };
    return any(1) && any(-1);
  }
  /// The only corner that is not in the plane; -1 if there is none or several.
  [[nodiscard]] int beside() const {
    int corner = -1;
    for (int k = 0; k < 3; ++k) {
      if (of[k].sign == 0) continue;
      if (corner >= 0) return -1;
      corner = k;
    }
    return corner;
  }
};

Heights heights(const WeldedMesh& mesh, const CrossedFace& face, const CrossedFace& over) {
  Heights heights;
  for (int k = 0; k < 3; ++k)
    if (!over.has(face.vertices[k])) heights.of[k] = over.plane.height(mesh.positions[face.vertices[k]]);
  return heights;
}

/// The point in which a face's outline meets the plane of another: one end of its interval.
struct EdgeMeeting {
  CrossingEnd end;
  std::uint32_t p, q;  ///< the edge that passes through the plane, or ends in it
};

/// The two meetings of a face that straddles the plane. A vertex in the plane is represented by one of its edges.
std::array<EdgeMeeting, 2> meetings(const WeldedMesh& mesh, const CrossedFace& face, const Heights& heights) {
  std::array<EdgeMeeting, 2> found;
  std::size_t count = 0;
  for (int i = 0; i < 3 && count < 2; ++i) {
    if (heights.of[i].sign != 0) continue;
    const std::uint32_t vertex = face.vertices[i], other = face.vertices[i == 2 ? 0 : i + 1];
    found[count++] = {{mesh.positions[vertex], {vertex, vertex}}, vertex, other};
  }
  constexpr int sides[3][2] = {{0, 1}, {1, 2}, {0, 2}};
  for (int k = 0; k < 3 && count < 2; ++k) {
    const Signed &a = heights.of[sides[k][0]], &b = heights.of[sides[k][1]];
    if (a.sign * b.sign >= 0) continue;
    const std::uint32_t p = face.vertices[sides[k][0]], q = face.vertices[sides[k][1]];
    const double from_p = std::abs(a.value), sum = from_p + std::abs(b.value);
    const double t = sum > 0 ? from_p / sum : 0.5;
    const glm::dvec3 from = mesh.positions[p], to = mesh.positions[q];
    found[count++] = {{t <= 0.5 ? from + (to - from) * t : to + (from - to) * (1 - t), {p, q}}, p, q};
  }
  return found;
}

/// The orientation of the tetrahedron spanned by two edges; 0 where they meet.
int turn(const WeldedMesh& mesh, std::uint32_t p, std::uint32_t q, std::uint32_t r, std::uint32_t s) {
  if (p == r || p == s || q == r || q == s) return 0;
  const auto& at = mesh.positions;
  return FacePlane(at[p], at[q], at[r]).height(at[s]).sign;
}

/// Whether the line through the meeting's edge passes through the face. The edge does not lie in the face's plane.
bool is_within(const WeldedMesh& mesh, const EdgeMeeting& meeting, const CrossedFace& face) {
  const glm::uvec3& v = face.vertices;
  const int a = turn(mesh, meeting.p, meeting.q, v.x, v.y), b = turn(mesh, meeting.p, meeting.q, v.y, v.z);
  if (a * b < 0) return false;
  const int c = turn(mesh, meeting.p, meeting.q, v.z, v.x);
  return b * c >= 0 && c * a >= 0;
}

std::optional<std::uint32_t> shared_vertex(const CrossedFace& a, const CrossedFace& b) {
  for (int k = 0; k < 3; ++k)
    if (b.has(a.vertices[k])) return a.vertices[k];
  return std::nullopt;
}

/// For two faces that share a vertex and straddle each other's planes: whether they lie on different sides of that
/// vertex along the planes' common line, as most neighbours do. The line meets the first face's opposite edge; seen
/// along that edge, the second face is then turned the wrong way. `heights` are those of the first face over the
/// second.
bool lie_apart(const WeldedMesh& mesh, const std::array<const CrossedFace*, 2>& faces, const Heights& heights,
               std::uint32_t shared) {
  const glm::uvec3 &a = faces[0]->vertices, &b = faces[1]->vertices;
  const int from = a.x == shared ? 1 : 0, to = a.z == shared ? 1 : 2;
  // The second face's other corners. The shared corner followed by these has the same order as all three, unless it is
  // the middle one.
  const std::uint32_t next = b.x == shared ? b.y : b.x;
  const int order = b.y == shared ? -1 : 1;
  return turn(mesh, a[from], a[to], shared, next) * heights.of[from].sign * order > 0;
}

/// The segments found so far, and edges that lie in planes.
struct Found {
  std::vector<Crossing> crossings;
  std::vector<EdgeContact> contacts;

  void add_contact(const CrossedFace& face, int beside, std::uint32_t triangle) {
    if (beside < 0) return;
    const glm::uvec3& v = face.vertices;
    contacts.push_back({beside == 0 ? v.y : v.x, beside == 2 ? v.y : v.z, triangle});
  }
};

/// The segment of two triangles that share at most one vertex.
std::optional<Crossing> crossing(const WeldedMesh& mesh, const std::array<const CrossedFace*, 2>& faces, Found& found) {
  const Heights first = heights(mesh, *faces[0], *faces[1]);
  const int first_beside = first.beside();
  if (!first.straddle() && first_beside < 0) return std::nullopt;
  const Heights second = heights(mesh, *faces[1], *faces[0]);
  const int second_beside = second.beside();
  if (!second.straddle() && second_beside < 0) return std::nullopt;
  found.add_contact(*faces[0], first_beside, faces[1]->triangle);
  found.add_contact(*faces[1], second_beside, faces[0]->triangle);
  if (first_beside >= 0 || second_beside >= 0) return std::nullopt;
  const std::optional<std::uint32_t> shared = shared_vertex(*faces[0], *faces[1]);
  if (shared && lie_apart(mesh, faces, first, *shared)) return std::nullopt;
  const std::array<EdgeMeeting, 2> ends[2] = {meetings(mesh, *faces[0], first), meetings(mesh, *faces[1], second)};
  const EdgeMeeting* within[2][2];
  std::size_t count[2] = {0, 0};
  for (std::size_t k = 0; k < 2; ++k)
    for (const EdgeMeeting& end : ends[k])
      if (is_within(mesh, end, *faces[1 - k])) within[k][count[k]++] = &end;
  // Where edges meet, both triangles have an end there; two ends of one triangle are then enough.
  for (std::size_t k = 0; k < 2; ++k)
    if (count[k] == 2) return Crossing{within[k][0]->end, within[k][1]->end, 0, 0};
  if (count[0] == 0 || count[1] == 0) return std::nullopt;
  const EdgeMeeting &a = *within[0][0], &b = *within[1][0];
  if (turn(mesh, a.p, a.q, b.p, b.q) == 0) return std::nullopt;  // they touch in a point
  return Crossing{a.end, b.end, 0, 0};
}

auto order(const Crossing& c) {
  const glm::dvec3 &a = c.from.place, &b = c.to.place;
  return std::make_tuple(a.x, a.y, a.z, b.x, b.y, b.z, c.left, c.right);
}

bool is_same_line(const Crossing& a, const Crossing& b) {
  return a.from.place == b.from.place && a.to.place == b.to.place;
}

/// Counts the segments of all threads, so that a limit is checked before memory is requested.
class Tally {
 public:
  explicit Tally(std::size_t triangles) : most_(kMost + kMostOfTriangle * triangles) {}

  void add(std::size_t count) {
    if ((all_ += count) > most_)
      throw Error(ErrorCode::limit_exceeded, "lines",
                  "more than " + std::to_string(most_) + " segments where triangles pass through each other");
  }

 private:
  static constexpr std::size_t kMost = std::size_t(1) << 20, kMostOfTriangle = 16;
  std::size_t most_;
  std::atomic<std::size_t> all_{0};
};

/// Appends the segment of two triangles, if there is one.
void add_crossing(const WeldedMesh& mesh, std::uint32_t left, std::uint32_t right, Found& found) {
  const CrossedFace one(mesh, left), two(mesh, right);
  std::optional<Crossing> segment = crossing(mesh, {&one, &two}, found);
  if (!segment) return;
  segment->left = left;
  segment->right = right;
  found.crossings.push_back(*segment);
}

/// Puts the lesser end first, and drops segments whose ends were rounded to one place.
void order_ends(std::vector<Crossing>& crossings) {
  for (Crossing& c : crossings) {
    const glm::dvec3 &p = c.from.place, &q = c.to.place;
    if (std::make_tuple(q.x, q.y, q.z) < std::make_tuple(p.x, p.y, p.z)) std::swap(c.from, c.to);
  }
  crossings.erase(
      std::remove_if(crossings.begin(), crossings.end(), [](const Crossing& c) { return c.from.place == c.to.place; }),
      crossings.end());
}

}  // namespace

std::vector<Crossing> find_crossings(const WeldedMesh& mesh, const Features& features, const Execution& execution) {
  if (mesh.triangles.size() < features.twins.size() + 2) return {};
  const BoxTree tree(mesh, features, execution);
  const std::size_t parts = (tree.group_count() + kGroupsPerPart - 1) / kGroupsPerPart;
  std::vector<std::vector<Crossing>> crossings(parts);
  std::vector<std::vector<EdgeContact>> contacts(parts);
  Tally tally(mesh.triangles.size());
  WorkLimit work(execution, kMostSteps + kMostStepsOfTriangle * mesh.triangles.size(), "lines");
  parallel_for(execution, tree.group_count(), kGroupsPerPart, [&](std::size_t begin, std::size_t end) {
    Found found;
    std::size_t counted = 0, asked = 0;
    const auto count = [&] {
      const std::size_t all = found.crossings.size() + found.contacts.size();
      tally.add(all - counted);
      counted = all;
    };
    for (std::size_t group = begin; group < end; ++group) {
      check_cancelled(execution);
      tree.visit_pairs(group, [&](std::uint32_t a, std::uint32_t b) {
        add_crossing(mesh, std::min(a, b), std::max(a, b), found);
        if (++asked % kPairsPerPoll != 0) return;
        work.add(kStepsOfPair * kPairsPerPoll, [] {
          return std::string("too many triangles come near each other to find where they pass through each other");
        });
        count();
      });
    }
    count();
    crossings[begin / kGroupsPerPart] = std::move(found.crossings);
    contacts[begin / kGroupsPerPart] = std::move(found.contacts);
  });
  std::vector<Crossing> all = joined(crossings, execution);
  add_contacts(mesh, features, joined(contacts, execution), all);
  order_ends(all);
  sort_in_parts(
      all, [](const Crossing& a, const Crossing& b) { return order(a) < order(b); }, execution);
  all.erase(std::unique(all.begin(), all.end(), is_same_line), all.end());
  return all;
}

}  // namespace frontmost::lines_detail
