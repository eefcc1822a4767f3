// SPDX-License-Identifier: Apache-2.0
// All decisions are exact. Signs of tetrahedra tell where points lie in a plane, with a vertex beside the plane as
// their fourth point. Where a surface passes through a plane exactly along an edge, neither of the edge's two triangles
// has corners on both sides of the plane, and yet the surfaces cross there:
//
//        \     |               The edge (o) lies in the plane of a third triangle, and its own two lie on different
//    -----o----- plane         sides of it. find_crossed_pairs() lists such edges with the triangles in whose planes
//         |                    they lie. All are decided here together, because their neighbours have to be known.
#include <algorithm>
#include <optional>
#include <tuple>

#include "lines/crossings/crossings.h"
#include "view/sight.h"

namespace frontmost::lines_detail {
namespace {

struct Edge {
  std::uint32_t from, to;
  friend auto operator<=>(const Edge&, const Edge&) = default;
};

/// The triangles at an edge, each with its third vertex (apex). Only the first two are stored; `count` is the number of
/// all.
struct Wedge {
  std::uint32_t triangles[2] = {no_index, no_index}, apexes[2] = {no_index, no_index};
  int count = 0;

  void add(std::uint32_t triangle, std::uint32_t apex) {
    for (int i = 0; i < std::min(count, 2); ++i)
      if (apexes[i] == apex) return;
    if (count < 2) {
      triangles[count] = triangle;
      apexes[count] = apex;
    }
    ++count;
  }
};

template <class Visitor>
void visit_edges(const glm::uvec3& t, const Visitor& visit) {
  for (int k = 0; k < 3; ++k) {
    const std::uint32_t a = t[k], b = t[k == 2 ? 0 : k + 1];
    visit(Edge{std::min(a, b), std::max(a, b)}, t[k == 0 ? 2 : k - 1]);
  }
}

/// The wedges of all edges that matter: the edges of the contacts, and the sides of the contacts' triangles.
class Wedges {
 public:
  Wedges(const WeldedMesh& mesh, const std::vector<EdgeContact>& contacts) {
    for (const EdgeContact& contact : contacts) {
      edges_.push_back({contact.from, contact.to});
      visit_edges(mesh.triangles[contact.triangle], [&](const Edge& edge, std::uint32_t) { edges_.push_back(edge); });
    }
    std::sort(edges_.begin(), edges_.end());
    edges_.erase(std::unique(edges_.begin(), edges_.end()), edges_.end());
    std::vector<bool> is_asked(mesh.positions.size(), false);
    for (const Edge& edge : edges_) is_asked[edge.from] = is_asked[edge.to] = true;
    wedges_.resize(edges_.size());
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i)
      visit_edges(mesh.triangles[i], [&](const Edge& edge, std::uint32_t apex) {
        if (!is_asked[edge.from] || !is_asked[edge.to]) return;
        const auto it = std::lower_bound(edges_.begin(), edges_.end(), edge);
        if (it != edges_.end() && *it == edge) wedges_[std::size_t(it - edges_.begin())].add(i, apex);
      });
  }
  [[nodiscard]] const Wedge& of(const Edge& edge) const {
    return wedges_[std::size_t(std::lower_bound(edges_.begin(), edges_.end(), edge) - edges_.begin())];
  }

 private:
  std::vector<Edge> edges_;
  std::vector<Wedge> wedges_;
};

struct Contacts {
  [[nodiscard]] std::optional<ContactSegment> segment(const EdgeContact& contact) const {
    const Edge edge{contact.from, contact.to};
    const Wedge& wedge = wedges.of(edge);
    if (wedge.count != 2) return std::nullopt;
    const glm::uvec3& t = mesh.triangles[contact.triangle];
    const int above = turn(t.x, t.y, t.z, wedge.apexes[0]), below = turn(t.x, t.y, t.z, wedge.apexes[1]);
    if (above == 0 && below == 0) return std::nullopt;
    // With an apex in the triangle's plane, all points would lie in one plane. So an apex outside of the plane is
    // chosen.
    const std::uint32_t beside = wedge.apexes[above != 0 ? 0 : 1];
    int sides[3];  // on which side of the edge each corner of the triangle lies
    for (int k = 0; k < 3; ++k) sides[k] = turn(edge.from, edge.to, beside, t[k]);
    const auto any = [&](int sign) { return sides[0] == sign || sides[1] == sign || sides[2] == sign; };
    if (any(1) && any(-1)) return above * below < 0 ? within(edge, wedge, contact.triangle, sides) : std::nullopt;
    for (int k = 0; k < 3; ++k)
      if (sides[k] == 0 && sides[(k + 1) % 3] == 0) return along(edge, t[k], t[(k + 1) % 3]);
    return std::nullopt;
  }

  [[nodiscard]] Signed height(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t x) const {
    if (x == a || x == b || x == c) return {};
    const Positions& at = mesh.positions;
    return FacePlane(at[a], at[b], at[c]).height(at[x]);
  }
  [[nodiscard]] int turn(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t x) const {
    return height(a, b, c, x).sign;
  }
  /// Whether vertex `a` comes before vertex `b` along their line.
  [[nodiscard]] bool is_before(std::uint32_t a, std::uint32_t b) const {
    const glm::dvec3 p = mesh.positions[a], q = mesh.positions[b];
    return std::tie(p.x, p.y, p.z) < std::tie(q.x, q.y, q.z);
  }
  [[nodiscard]] CrossingEnd end_at(std::uint32_t vertex) const { return {mesh.positions[vertex], {vertex, vertex}}; }
  [[nodiscard]] static ContactSegment on(const Edge& a, const Edge& b, const Crossing& segment) {
    return {segment, {std::pair(a.from, a.to), std::pair(b.from, b.to)}};
  }

  /// The part of the edge that lies in the triangle. Precondition: the triangle has corners on both sides of the edge.
  [[nodiscard]] std::optional<ContactSegment> within(const Edge& edge, const Wedge& wedge, std::uint32_t triangle,
                                                     const int (&sides)[3]) const {
    const glm::uvec3& t = mesh.triangles[triangle];
    const std::uint32_t apex = wedge.apexes[0];
    std::vector<CrossingEnd> ends;
    for (const std::uint32_t vertex : {edge.from, edge.to}) {
      const int a = turn(t.x, t.y, apex, vertex), b = turn(t.y, t.z, apex, vertex), c = turn(t.z, t.x, apex, vertex);
      if (a * b >= 0 && b * c >= 0 && c * a >= 0) ends.push_back(end_at(vertex));
    }
    for (int k = 0; k < 3 && ends.size() < 2; ++k) {
      if (sides[k] == 0) {
        if (is_before(edge.from, t[k]) != is_before(edge.to, t[k]) && t[k] != edge.from && t[k] != edge.to)
          ends.push_back(end_at(t[k]));
        continue;
      }
      const std::uint32_t p = std::min(t[k], t[(k + 1) % 3]), q = std::max(t[k], t[(k + 1) % 3]);
      const Signed from = height(p, q, apex, edge.from), to = height(p, q, apex, edge.to);
      if (sides[k] * sides[(k + 1) % 3] < 0 && from.sign * to.sign < 0)
        ends.push_back({place_between(mesh.positions[edge.from], mesh.positions[edge.to], root_between(from, to)),
                        {edge.from, edge.to}});
    }
    if (ends.size() != 2) return std::nullopt;
    return on(edge, edge, {ends[0], ends[1], wedge.triangles[0], triangle});
  }

  /// The common part of the edges `one` and p-q, if their triangles alternate around the line on which both edges lie.
  [[nodiscard]] std::optional<ContactSegment> along(const Edge& one, std::uint32_t p, std::uint32_t q) const {
    const Edge other{std::min(p, q), std::max(p, q)};
    const Wedge &own = wedges.of(one), &wedge = wedges.of(other);
    if (wedge.count != 2) return std::nullopt;
    if (place_in(one, wedge, 0) * place_in(one, wedge, 1) >= 0) return std::nullopt;
    const auto ordered = [&](Edge e) { return is_before(e.from, e.to) ? e : Edge{e.to, e.from}; };
    const Edge a = ordered(one), b = ordered(other);
    const std::uint32_t from = is_before(a.from, b.from) ? b.from : a.from, to = is_before(a.to, b.to) ? a.to : b.to;
    if (!is_before(from, to)) return std::nullopt;
    const auto [left, right] = std::minmax(own.triangles[0], wedge.triangles[0]);
    return on(one, other, {end_at(from), end_at(to), left, right});
  }

  /// Where a triangle of `other` lies around an edge: 1 between its two triangles in one sense of rotation, -1 between
  /// them in the other sense, 0 on one of them.
  [[nodiscard]] int place_in(const Edge& edge, const Wedge& other, int which) const {
    const Wedge& own = wedges.of(edge);
    const std::uint32_t first = own.apexes[0], second = own.apexes[1], x = other.apexes[which];
    const auto around = [&](std::uint32_t a, std::uint32_t b) { return turn(edge.from, edge.to, a, b); };
    // A point outside of the first triangle's plane distinguishes that triangle's half plane from the opposite one.
    std::uint32_t beside = no_index;
    for (const std::uint32_t apex : {second, other.apexes[0], other.apexes[1]})
      if (around(first, apex) != 0) beside = apex;
    if (beside == no_index) return 0;
    // 0: in the direction of the first apex; 1: less than half a turn from it; 2: opposite to it; 3: more than half a
    // turn.
    const auto quarter = [&](std::uint32_t apex) {
      const int side = around(first, apex);
      if (side != 0) return side > 0 ? 1 : 3;
      return around(apex, beside) == around(first, beside) ? 0 : 2;
    };
    const int end = quarter(second), at = quarter(x);
    if (end == 0 || at == 0) return 0;
    if (at != end) return at < end ? 1 : -1;
    return at == 2 ? 0 : around(x, second);
  }

  const WeldedMesh& mesh;
  const Wedges wedges;
};

}  // namespace

std::vector<ContactSegment> segments_of(const WeldedMesh& mesh, std::vector<EdgeContact> contacts) {
  if (contacts.empty()) return {};
  std::sort(contacts.begin(), contacts.end());
  contacts.erase(std::unique(contacts.begin(), contacts.end()), contacts.end());
  const Contacts all{mesh, Wedges(mesh, contacts)};
  std::vector<ContactSegment> segments;
  for (const EdgeContact& contact : contacts)
    if (const std::optional<ContactSegment> found = all.segment(contact)) segments.push_back(*found);
  return segments;
}

}  // namespace frontmost::lines_detail
