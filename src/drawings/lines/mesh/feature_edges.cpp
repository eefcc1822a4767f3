// SPDX-License-Identifier: Apache-2.0
// Each edge is found at its lower vertex. A kernel finds the edges that may be features; the others are skipped.
//
//    triangles at the edge     what is drawn
//    one                       boundary, unless a gap lies beside it
//    two                       silhouette where only one faces the eye; border; crease by their angle
//    more                      each pair of sides of one surface is judged like two; without pairs, surfaces meet
//
// Objects that touch have equal triangles where they touch. Three or more groups of copies at an edge form pairs only
// if one group is as large as all others together. That group is the surface which the others share, like the wall
// between two rooms.
#include "lines/mesh/feature_edges.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <string>

#include "base/parallel.h"
#include "lines/lists.h"

namespace frontmost::lines_detail {
namespace {

constexpr std::size_t kMostInLeaf = 8, kMostBeside = 64;
constexpr double kShare = 1.0 / 16;  // the widest gap, as a share of an edge's length
constexpr double kAcross = 0.5;      // least cosine of the angle between the directions into both triangles
constexpr std::size_t kVerticesPerPart = 1024;
constexpr float kNormalRounding = 2e-6f;    // of a product of two normals, at most
constexpr double kWidestGap = 1.0 / 65536;  // share of the scene's diagonal: 1/200 mm on A4 paper

struct Classifier {
  Classifier(const SeenMesh& its_seen, const LineOptions& its_options)
      : mesh(its_seen.mesh),
        seen(its_seen),
        options(its_options),
        cosine(options.crease_angle ? std::cos(*options.crease_angle) : kLeastFoldCosine),
        has_borders(options.borders && !mesh.surfaces.empty()) {}

  [[nodiscard]] PlainEdges plain_edges() const {
    // A zero normal means that the normal is unknown. With a limit below 0, its edges would count as plain.
    const float least =
        options.creases ? std::max(float(cosine), 0.0f) + kNormalRounding : -std::numeric_limits<float>::infinity();
    return {least, has_borders, takes_stated_edges()};
  }

  /// A crease angle that the caller asks for outweighs the edges that meshes state.
  [[nodiscard]] bool takes_stated_edges() const {
    return options.creases && !options.crease_angle && !mesh.stated.empty();
  }

  [[nodiscard]] std::optional<EdgeKind> kind_of(const SidePair& pair) const {
    const int a = side_of(pair.first), b = side_of(pair.second);
    if (options.silhouettes && (a * b > 0 || (a == 0) != (b == 0))) return EdgeKind::silhouette;
    return kind_in_every_view(pair);
  }
  [[nodiscard]] std::optional<EdgeKind> kind_in_every_view(const SidePair& pair) const {
    if (has_borders && !(mesh.surface_of(pair.first.triangle) == mesh.surface_of(pair.second.triangle)))
      return EdgeKind::border;
    if (options.creases && is_crease(pair.first, pair.second)) return EdgeKind::crease;
    return std::nullopt;
  }

  /// The side of the edge, as seen from the eye, on which no triangle lies: 1 or -1; 0 if triangles lie on both sides.
  [[nodiscard]] std::int8_t outer_side(std::span<const Side> sides) const {
    int inner = 0;
    for (const Side& side : sides) {
      const int own = side_of(side);
      if (own * inner < 0) return 0;
      if (own != 0) inner = own;
    }
    return std::int8_t(-inner);
  }

  /// The side of the plane through the eye and the edge on which the triangle lies: 1 or -1, whatever its winding.
  [[nodiscard]] int side_of(const Side& side) const { return seen.facing[side.triangle] * (side.is_forward ? 1 : -1); }

  [[nodiscard]] bool is_crease(const Side& a, const Side& b) const {
    if (takes_stated_edges()) {
      if (mesh.stated.are_sharp(a.upper, third_of(mesh.triangles[a.triangle], a.upper, a.opposite))) return true;
      const auto is_covered = [&](const Side& side) {
        return mesh.stated.cover(mesh.surface_of(side.triangle).instance);
      };
      if (is_covered(a) || is_covered(b)) return false;
    }
    // Neighbours that run along their edge the same way are wound against each other.
    const glm::dvec3 n = normal_of(mesh, a.triangle), m = normal_of(mesh, b.triangle);
    const double along = glm::dot(n, m) * (a.is_forward == b.is_forward ? -1.0 : 1.0);
    const double size = std::sqrt(glm::dot(n, n) * glm::dot(m, m));
    if (along > cosine * size) return false;
    if (along <= 0) return true;
    const glm::uvec3& t = mesh.triangles[a.triangle];
    const Positions& at = mesh.positions;
    return FacePlane(at[t.x], at[t.y], at[t.z]).height(at[b.opposite]).sign != 0;
  }

  const WeldedMesh& mesh;
  const SeenMesh& seen;
  const LineOptions& options;
  const double cosine;  ///< the least of the angle by which a continuing surface turns
  const bool has_borders;
};

/// A side that belongs to only one triangle.
struct OpenSide {
  /// `from` is a point, and the others are unit vectors; `ahead` points into the triangle.
  glm::dvec3 from, along, normal, ahead;
  double length;
  std::uint32_t number;  ///< of the edge, in the list of all edges
  FeatureEdge edge;
  Box box{};
};

OpenSide open_side(const WeldedMesh& mesh, const FeatureEdge& edge, std::uint32_t number) {
  const glm::dvec3 from = mesh.positions[edge.from], to = mesh.positions[edge.to];
  const std::uint32_t tip = third_of(mesh.triangles[edge.left], edge.from, edge.to);
  const double length = glm::distance(from, to);
  const glm::dvec3 along = (to - from) / length, normal = normal_of(mesh, edge.left);
  const glm::dvec3 to_tip = mesh.positions[tip] - from, across = to_tip - along * glm::dot(to_tip, along);
  OpenSide side{from, along, normal / glm::length(normal), across / glm::length(across), length, number, edge};
  side.box.include(mesh.positions.places[edge.from]);
  side.box.include(mesh.positions.places[edge.to]);
  return side;
}

/// Open sides in a binary tree of boxes.
struct SideTree {
  explicit SideTree(std::vector<OpenSide> all) : sides(std::move(all)), boxes(1) { build(0, 0, sides.size()); }

  /// Visits sides whose boxes touch `box`, until `visit` returns false.
  template <class Visit>
  void visit_near(const Box& box, const Visit& visit) const {
    (void)visit_node(0, 0, sides.size(), box, visit);
  }

  void build(std::size_t node, std::size_t begin, std::size_t end) {
    if (node >= boxes.size()) boxes.resize(node + 1);
    Box box;
    for (std::size_t i = begin; i < end; ++i) box.include(sides[i].box);
    boxes[node] = box;
    if (end - begin <= kMostInLeaf) return;
    const glm::vec3 size = box.high - box.low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const auto place = [&](const OpenSide& side) { return side.box.low[axis] + side.box.high[axis]; };
    const std::size_t middle = begin + (end - begin) / 2;
    std::nth_element(sides.begin() + std::ptrdiff_t(begin), sides.begin() + std::ptrdiff_t(middle),
                     sides.begin() + std::ptrdiff_t(end), [&](const OpenSide& a, const OpenSide& b) {
                       return std::pair(place(a), a.number) < std::pair(place(b), b.number);
                     });
    build(2 * node + 1, begin, middle);
    build(2 * node + 2, middle, end);
  }

  static bool overlap(const Box& a, const Box& b) {
    return glm::all(glm::lessThanEqual(a.low, b.high)) && glm::all(glm::lessThanEqual(b.low, a.high));
  }

  template <class Visit>
  [[nodiscard]] bool visit_node(std::size_t node, std::size_t begin, std::size_t end, const Box& box,
                                const Visit& visit) const {
    if (!overlap(boxes[node], box)) return true;
    if (end - begin <= kMostInLeaf) {
      for (std::size_t i = begin; i < end; ++i)
        if (overlap(sides[i].box, box) && !visit(sides[i])) return false;
      return true;
    }
    const std::size_t middle = begin + (end - begin) / 2;
    return visit_node(2 * node + 1, begin, middle, box, visit) && visit_node(2 * node + 2, middle, end, box, visit);
  }

  std::vector<OpenSide> sides;
  std::vector<Box> boxes;
};

/// Whether the stretches cover the range from 0 to `length`, except for holes of at most `slack`.
bool cover(std::vector<std::pair<double, double>>& stretches, double length, double slack) {
  std::sort(stretches.begin(), stretches.end());
  double reached = 0;
  for (const auto& [begin, end] : stretches) {
    if (begin > reached + slack) return false;
    reached = std::max(reached, end);
  }
  return reached >= length - slack;
}

struct Gaps {
  const SeenMesh& seen;
  const Classifier& classifier;
  const double most;  ///< the widest gap
  const SideTree& tree;

  /// Whether `side` lies at a gap. If so, adds to `continued` the pairs of its vertices and the vertices across the
  /// gap.
  [[nodiscard]] bool is_one(const OpenSide& side, VertexPairs& continued) const {
    const double widest = std::min(most, kShare * side.length);
    Box box = side.box;
    box.low -= glm::vec3(float(widest));
    box.high += glm::vec3(float(widest));
    std::vector<std::pair<double, double>> stretches;
    const std::size_t first = continued.size();
    std::size_t count = 0;
    tree.visit_near(box, [&](const OpenSide& other) {
      if (other.number == side.number) return true;
      const auto stretch = stretch_beside(side, other, widest);
      if (stretch.first < stretch.second && goes_on(side, other)) {
        stretches.push_back(stretch);
        for (const std::uint32_t own : {side.edge.from, side.edge.to})
          for (const std::uint32_t its : {other.edge.from, other.edge.to})
            continued.emplace_back(std::minmax({own, its}));
      }
      return ++count <= kMostBeside;
    });
    const bool is_gap = count <= kMostBeside && cover(stretches, side.length, 2 * widest);
    if (!is_gap) continued.resize(first);
    return is_gap;
  }

  /// The stretch of `side` beside which `other` lies, as distances from the beginning of `side`; empty if there is
  /// none.
  static std::pair<double, double> stretch_beside(const OpenSide& side, const OpenSide& other, double widest) {
    const double slope = glm::dot(other.along, side.along);
    if (slope == 0) return {0, 0};
    const glm::dvec3 start = other.from - side.from;
    const double s = glm::dot(start, side.along), e = s + slope * other.length;
    // The stretch may reach a little beyond the ends of `side`, because triangles that meet the side only at a corner
    // may reach into the side's own triangle.
    const double begin = std::max(-widest, std::min(s, e)), end = std::min(side.length + widest, std::max(s, e));
    const auto is_near = [&](double at) {
      const glm::dvec3 place = start + other.along * ((at - s) / slope);
      return glm::length(place - side.along * at) <= widest;
    };
    return begin < end && is_near(begin) && is_near(end) ? std::pair(begin, end) : std::pair(0.0, 0.0);
  }

  [[nodiscard]] bool goes_on(const OpenSide& side, const OpenSide& other) const {
    const double cosine = glm::dot(side.normal, other.normal);
    const std::uint32_t own = side.edge.left, its = other.edge.left;  // triangles
    return glm::dot(side.ahead, other.ahead) < -kAcross && std::abs(cosine) > classifier.cosine &&
           seen.facing[own] != 0 && seen.facing[own] == seen.facing[its] * (cosine < 0 ? -1 : 1) &&
           seen.mesh.surface_of(own) == seen.mesh.surface_of(its);
  }
};

/// Removes from `edges` the boundaries across which their surface continues: exporters tessellate each face by itself,
/// so rims share no vertices. All along such a boundary lie others of the same object and material, within `widest` and
/// a sixteenth of its length, at most 64. Their triangles are on the other side, face the same way and are turned by no
/// more than the angle. Where more than a third of all sides are open there is no surface, and all boundaries stay.
/// \returns pairs of a gap's vertices and those across it, the lower first, ascending. O(boundaries log boundaries).
VertexPairs leave_out_gaps(const SeenMesh& seen, const Classifier& classifier, double widest, std::size_t triangles,
                           std::vector<FeatureEdge>& edges) {
  std::vector<OpenSide> sides;
  for (std::size_t i = 0; i < edges.size(); ++i)
    if (edges[i].kind == EdgeKind::boundary && edges[i].right == no_index && seen.facing[edges[i].left] != 0)
      sides.push_back(open_side(seen.mesh, edges[i], std::uint32_t(i)));
  if (sides.empty() || sides.size() > triangles) return {};
  const SideTree tree(std::move(sides));
  const Gaps gaps{seen, classifier, widest, tree};
  VertexPairs continued;
  std::vector<bool> is_gap(edges.size(), false);
  for (const OpenSide& side : tree.sides) is_gap[side.number] = gaps.is_one(side, continued);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < edges.size(); ++i)
    if (!is_gap[i]) edges[kept++] = edges[i];
  edges.resize(kept);
  std::sort(continued.begin(), continued.end());
  continued.erase(std::unique(continued.begin(), continued.end()), continued.end());
  return continued;
}

/// Appends the features among the edges to Corner::last() of the `asked` corners of a paired star.
void add_features(std::uint32_t vertex, std::span<const Corner> corners, std::uint32_t asked,
                  const Classifier& classifier, std::vector<FeatureEdge>& features) {
  const WeldedMesh& mesh = classifier.mesh;
  const std::size_t begin = features.size();
  for (; asked != 0; asked &= asked - 1) {
    const Corner& before = corners[std::size_t(std::countr_zero(asked))];
    const std::uint32_t upper = before.last(mesh);
    std::size_t i = 0;
    while (corners[i].next(mesh) != upper) ++i;
    Side sides[2] = {{upper, corners[i].triangle(), corners[i].last(mesh), true},
                     {upper, before.triangle(), before.next(mesh), false}};
    if (sides[1].opposite < sides[0].opposite) std::swap(sides[0], sides[1]);
    if (const std::optional<EdgeKind> kind = classifier.kind_of({sides[0], sides[1]}))
      features.push_back({vertex, upper, sides[0].triangle, sides[1].triangle, *kind, classifier.outer_side(sides)});
  }
  std::sort(features.begin() + std::ptrdiff_t(begin), features.end(),
            [](const FeatureEdge& a, const FeatureEdge& b) { return a.to < b.to; });
}

struct OwnedSide {
  Side side;
  SurfaceOf surface;
};

/// Sides with the same opposite vertex.
using SidesOfCopy = std::span<const OwnedSide>;

/// A pair with one side from each group: two sides of the same object and material if possible, else the first sides.
SidePair pair_of(const SidesOfCopy& a, const SidesOfCopy& b) {
  for (const OwnedSide& one : a)
    for (const OwnedSide& other : b)
      if (one.surface == other.surface) return {one.side, other.side};
  return {a[0].side, b[0].side};
}

/// Pairs the groups of copies and appends these pairs. \returns false, and appends none, if not every group can be
/// paired. Precondition: `sides` are sorted by opposite vertex.
bool pair_up(std::span<const OwnedSide> sides, std::vector<SidePair>& pairs) {
  std::vector<SidesOfCopy> copies;
  for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
    while (end < sides.size() && sides[end].side.opposite == sides[begin].side.opposite) ++end;
    copies.push_back(sides.subspan(begin, end - begin));
  }
  if (copies.size() < 2) return false;
  // With two groups, their sizes do not matter.
  const auto centre = std::find_if(copies.begin(), copies.end(), [&](const SidesOfCopy& c) {
    return copies.size() == 2 || 2 * c.size() == sides.size();
  });
  if (centre == copies.end()) return false;
  for (auto other = copies.begin(); other != copies.end(); ++other)
    if (other != centre) pairs.push_back(pair_of(*centre, *other));
  return true;
}

/// The kind with which an edge is drawn, and the triangles that cause it.
struct Drawn {
  EdgeKind kind;
  std::uint32_t left, right;
};

/// An edge with several pairs is drawn once, by its first kind.
std::optional<Drawn> first_of(std::span<const SidePair> pairs, const Classifier& classifier) {
  std::optional<Drawn> first;
  for (const SidePair& pair : pairs)
    if (const std::optional<EdgeKind> kind = classifier.kind_of(pair); kind && (!first || *kind < first->kind))
      first = {*kind, pair.first.triangle, pair.second.triangle};
  return first;
}

/// How an edge is drawn, if at all. `sides` are all sides of the edge, copies included; `distinct` has one side for
/// each opposite vertex.
std::optional<Drawn> drawn_of(std::span<const Side> sides, std::span<const Side> distinct,
                              const Classifier& classifier) {
  if (distinct.size() == 2) {
    const SidePair pair(distinct[0], distinct[1]);
    return first_of({&pair, 1}, classifier);
  }
  if (distinct.size() > 2) {
    const auto surface_of = [&](std::uint32_t triangle) { return classifier.mesh.surface_of(triangle); };
    if (const auto pairs = paired_sides(sides, surface_of)) return first_of(*pairs, classifier);
  }
  if (!classifier.options.boundaries) return std::nullopt;
  return Drawn{EdgeKind::boundary, distinct[0].triangle, distinct.size() > 1 ? distinct[1].triangle : no_index};
}

/// Appends the features among the edges from a vertex to higher ones. `sides` is memory.
void add_features(std::uint32_t v, std::span<const Corner> corners, const Classifier& classifier,
                  std::vector<Side>& sides, Features& features) {
  sides.clear();
  for (const Corner& corner : corners) {
    const std::uint32_t next = corner.next(classifier.mesh), last = corner.last(classifier.mesh);
    if (next > v) sides.push_back({next, corner.triangle(), last, true});
    if (last > v) sides.push_back({last, corner.triangle(), next, false});
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) { return a.key() < b.key(); });
  std::vector<Side> distinct;
  for (auto begin = sides.begin(); begin != sides.end();) {
    const auto end = std::find_if(begin, sides.end(), [&](const Side& s) { return s.upper != begin->upper; });
    distinct.clear();
    for (auto side = begin; side != end; ++side) {
      if (distinct.empty() || distinct.back().opposite != side->opposite)
        distinct.push_back(*side);
      else if (side->opposite > side->upper)  // each triangle counts at one of its three edges only
        features.twins.push_back(side->triangle);
    }
    if (const std::optional<Drawn> drawn = drawn_of({&*begin, std::size_t(end - begin)}, distinct, classifier))
      features.edges.push_back(
          {v, begin->upper, drawn->left, drawn->right, drawn->kind, classifier.outer_side(distinct)});
    begin = end;
  }
}

/// Silhouettes of ripples get the kind that they would have in other views; without one, they are removed.
void judge_ripples(const SeenMesh& seen, const CornerTable& table, const Classifier& classifier,
                   std::vector<FeatureEdge>& edges, const Execution& execution) {
  const std::vector<std::uint8_t> is_ripple = find_ripples(seen, table, edges, execution);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    FeatureEdge edge = edges[i];
    if (is_ripple[i]) {
      const auto side = [&](std::uint32_t triangle, bool is_forward) {
        return Side{edge.to, triangle, third_of(seen.mesh.triangles[triangle], edge.from, edge.to), is_forward};
      };
      const auto kind = classifier.kind_in_every_view({side(edge.left, true), side(edge.right, false)});
      if (!kind) continue;
      edge.kind = *kind;
    }
    edges[kept++] = edge;
  }
  edges.resize(kept);
}

}  // namespace

std::optional<std::vector<SidePair>> paired_sides(std::span<const Side> sides, const SurfaceOfTriangle& surface_of) {
  std::vector<OwnedSide> owned;
  owned.reserve(sides.size());
  for (const Side& side : sides) owned.push_back({side, surface_of(side.triangle)});
  // The stable sort keeps sides of one object with the same opposite vertex together, also in `left`.
  std::stable_sort(owned.begin(), owned.end(),
                   [](const OwnedSide& a, const OwnedSide& b) { return a.surface.instance < b.surface.instance; });
  std::vector<SidePair> pairs;
  std::vector<OwnedSide> left;
  for (auto begin = owned.begin(); begin != owned.end();) {
    const auto end = std::find_if(begin, owned.end(),
                                  [&](const OwnedSide& s) { return s.surface.instance != begin->surface.instance; });
    if (!pair_up({&*begin, std::size_t(end - begin)}, pairs)) left.insert(left.end(), begin, end);
    begin = end;
  }
  std::stable_sort(left.begin(), left.end(),
                   [](const OwnedSide& a, const OwnedSide& b) { return a.side.opposite < b.side.opposite; });
  if (!left.empty() && !pair_up(left, pairs)) return std::nullopt;
  return pairs;
}

CornerTable corner_table(const WeldedMesh& mesh, const Execution& execution) {
  if (mesh.triangles.size() > Corner::most_triangles)
    throw Error(ErrorCode::limit_exceeded, "lines",
                "more than " + std::to_string(Corner::most_triangles) + " triangles");
  const auto list = [&](std::size_t t, const auto& add) {
    for (std::uint32_t k = 0; k < 3; ++k) add((&mesh.triangles[t].x)[k], Corner(std::uint32_t(t), k));
  };
  return {mesh.positions.size(), mesh.triangles.size(), list, execution};
}

Features find_features(const SeenMesh& seen, const CornerTable& table, const Surfaces& surfaces,
                       const LineOptions& options, const Execution& execution) {
  const Classifier classifier(seen, options);
  const StarsKernel find_stars = stars_kernel(execution.isa);
  const std::size_t vertices = seen.mesh.positions.size();
  const std::size_t parts = (vertices + kVerticesPerPart - 1) / kVerticesPerPart;
  std::vector<std::vector<FeatureEdge>> edges(parts);
  std::vector<std::vector<std::uint32_t>> twins(parts);
  Buffer<std::uint8_t> is_spread(vertices);
  parallel_for(execution, vertices, kVerticesPerPart, [&](std::size_t begin, std::size_t end) {
    Features found;
    std::vector<Side> sides;
    Buffer<Star> stars(end - begin);
    find_stars(seen, table, classifier.plain_edges(), begin, end, stars.data());
    for (std::size_t i = begin; i < end; ++i) {
      const auto v = std::uint32_t(i);
      const Star& star = stars[i - begin];
      is_spread[v] = star.is_spread;
      if (star.is_paired) {
        add_features(v, table[v], star.asked, classifier, found.edges);
      } else {
        add_features(v, table[v], classifier, sides, found);
      }
    }
    edges[begin / kVerticesPerPart] = std::move(found.edges);
    twins[begin / kVerticesPerPart] = std::move(found.twins);
  });
  Features all{joined(edges, execution), {}, joined(twins, execution), std::move(is_spread)};
  std::sort(all.twins.begin(), all.twins.end());
  if (options.silhouettes && !options.ripples) judge_ripples(seen, table, classifier, all.edges, execution);
  if (options.creases && !options.crease_angle) judge_creases(seen, table, all.edges, execution);
  if (options.boundaries)
    all.continued = leave_out_gaps(seen, classifier, kWidestGap * double(surfaces.bounds().diagonal()),
                                   seen.mesh.triangles.size() - all.twins.size(), all.edges);
  return all;
}

bool meet_at_gap(const WeldedMesh& mesh, const VertexPairs& continued, std::uint32_t a, std::uint32_t b) {
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) {
      const std::pair<std::uint32_t, std::uint32_t> pair = std::minmax({mesh.triangles[a][i], mesh.triangles[b][k]});
      if (std::binary_search(continued.begin(), continued.end(), pair)) return true;
    }
  return false;
}

}  // namespace frontmost::lines_detail
