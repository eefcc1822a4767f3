// SPDX-License-Identifier: Apache-2.0
// Pairs of triangles that may cross are found by a tree of boxes: triangles are sorted by (class of size, place on D.
// Hilbert's curve), in groups of sixteen, groups of sixteen groups, and so on. A group is compared with itself and with
// all later groups whose boxes touch its own, so every pair meets once.
//
// Two triangles that straddle each other's planes meet the planes' common line in an interval each. The common part of
// the intervals ends at those of their four ends that lie within the other triangle, as signs of tetrahedra tell.
// O. Devillers, P. Guigue. Faster Triangle-Triangle Intersection Tests. 2002.
#include "lines/crossings/crossings.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <optional>
#include <string>
#include <tuple>

#include "base/memory.h"
#include "base/parallel.h"
#include "base/work_limit.h"
#include "lines/crossings/space_lanes.h"
#include "lines/lists.h"
#include "surfaces/hilbert.h"
#include "surfaces/radix_sort.h"
#include "view/sight.h"

namespace frontmost::lines_detail {
namespace {

constexpr std::size_t kPerPart = 4096, kBoxGroupsPerPart = 256;
constexpr int kBitsAnAxis = 9, kKeyBits = 3 + 3 * kBitsAnAxis;
constexpr int kExponents = 160;  // more than floats have

/// Spreads the low 9 bits, with two zeros between neighbours.
std::uint32_t spread(std::uint32_t bits) {
  std::uint32_t out = 0;
  for (int i = 0; i < kBitsAnAxis; ++i) out |= (bits >> i & 1u) << 3 * i;
  return out;
}

Box box_of(const WeldedMesh& mesh, std::size_t triangle) {
  Box box;
  for (int k = 0; k < 3; ++k) box.include(mesh.positions.places[mesh.triangles[triangle][k]]);
  return box;
}

/// The exponent of the box's longest side, which is not 0. Equal to std::frexp()'s, but computed many times faster.
int exponent_of(const Box& box) {
  const glm::dvec3 size = glm::dvec3(box.high) - glm::dvec3(box.low);
  const auto bits = bits_as<std::uint64_t>(std::max({size.x, size.y, size.z}));
  return std::clamp(int(bits >> 52) - 1022, -kExponents, kExponents - 1);
}

Box bounds_of(const Buffer<glm::vec3>& places, const Execution& execution) {
  std::vector<Box> parts((places.size() + kPerPart - 1) / kPerPart);
  parallel_for(execution, places.size(), kPerPart, [&](std::size_t begin, std::size_t end) {
    Box box;
    for (std::size_t i = begin; i < end; ++i) box.include(places[i]);
    parts[begin / kPerPart] = box;
  });
  Box all;
  for (const Box& box : parts) all.include(box);
  return all;
}

/// Computes sort keys of 30 bits: the class of size, then the place of the box's middle on D. Hilbert's curve.
class Curve {
 public:
  Curve(const WeldedMesh& mesh, const Execution& execution) {
    find_classes(mesh, execution);
    const Box all = bounds_of(mesh.positions.places, execution);
    low_ = glm::dvec3(all.low);
    const glm::dvec3 extent = glm::dvec3(all.high) - low_;
    scale_ = kSteps / std::max({extent.x, extent.y, extent.z, 1e-300});
    for (std::uint32_t i = 0; i < spread_.size(); ++i) spread_[i] = spread(i);
  }
  [[nodiscard]] std::uint32_t place_of(const Box& box) const {
    const glm::dvec3 at = ((glm::dvec3(box.low) + glm::dvec3(box.high)) * 0.5 - low_) * scale_;
    const auto step = [&](double t) { return spread_[std::size_t(std::clamp(t, 0.0, kSteps))]; };
    const std::uint32_t size = class_of_[std::size_t(exponent_of(box) + kExponents)];
    return size << 3 * kBitsAnAxis | hilbert_place(step(at.x) | step(at.y) << 1 | step(at.z) << 2, kBitsAnAxis);
  }
  /// A power of two that makes most triangles about 1 in size. The kernels take products of many lengths, and denormal
  /// floats cost hundreds of cycles. The scaling rounds nothing, and the kernels leave pairs open whose values become
  /// infinite.
  [[nodiscard]] float scale() const { return std::ldexp(1.0f, std::clamp(-usual_, 0, kMostScale)); }

 private:
  /// Determines classes of size from every sixteenth triangle.
  void find_classes(const WeldedMesh& mesh, const Execution& execution) {
    const std::size_t asked = (mesh.triangles.size() + 15) / 16;
    Buffer<std::int16_t> exponents(asked);
    parallel_for(execution, asked, kPerPart / 16, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) exponents[i] = std::int16_t(exponent_of(box_of(mesh, 16 * i)));
    });
    std::array<std::size_t, 2 * kExponents> counts{};
    for (const std::int16_t exponent : exponents) ++counts[std::size_t(exponent + kExponents)];
    std::size_t seen = 0;
    std::uint32_t above = 0;
    for (std::size_t e = 0; e < counts.size(); ++e) {
      if (10 * seen >= 9 * asked) ++above;
      if (above == 0) usual_ = int(e) - kExponents;
      class_of_[e] = std::min(7u, above / 2);
      seen += counts[e];
    }
  }

  static constexpr double kSteps = (1 << kBitsAnAxis) - 1;
  static constexpr int kMostScale = 60;
  /// The class of each exponent. Class 0 has the smallest nine tenths of all triangles; further classes span a factor
  /// of 4 each.
  std::array<std::uint32_t, 2 * kExponents> class_of_{};
  int usual_ = 0;  ///< the largest exponent of class 0
  glm::dvec3 low_{0};
  double scale_ = 0;
  std::array<std::uint32_t, 1 << kBitsAnAxis> spread_;
};

class BoxTree {
 public:
  /// O(triangles). Twins (Features::twins) are left out.
  BoxTree(const WeldedMesh& mesh, const Features& features, const Execution& execution)
      : kernels_(space_kernels(execution.isa)), triangles_(mesh.triangles.size() - features.twins.size()) {
    const std::vector<std::uint32_t>& left_out = features.twins;
    const std::size_t count = triangles_.count;
    const Curve curve(mesh, execution);
    Buffer<std::uint64_t> keys(count);
    parallel_for(execution, count, kPerPart, [&](std::size_t begin, std::size_t end) {
      // `i` counts only the triangles that are not left out; `t` counts all triangles.
      std::size_t t = begin;
      auto next = left_out.begin();
      for (; next != left_out.end() && *next <= t; ++next) ++t;
      for (std::size_t i = begin; i < end; ++i, ++t) {
        for (; next != left_out.end() && *next == t; ++next) ++t;
        keys[i] = std::uint64_t(curve.place_of(box_of(mesh, t))) << 32 | t;
      }
    });
    keys = radix_sort(std::move(keys), kKeyBits, execution);
    const float scale = curve.scale();
    const bool knows_spread = !features.is_spread.empty();
    levels_.emplace_back(group_count());
    parallel_for(execution, group_count(), kBoxGroupsPerPart, [&](std::size_t begin, std::size_t end) {
      for (std::size_t group = begin; group < end; ++group) {
        Box box;
        for (std::size_t i = group * kSpaceLanes; i < (group + 1) * kSpaceLanes; ++i) {
          const auto number = std::uint32_t(keys[std::min(i, count - 1)]);
          triangles_.numbers[i] = number;
          for (int k = 0; k < 3; ++k) {
            const std::uint32_t vertex = (&mesh.triangles[number].x)[k];
            const glm::vec3 corner = mesh.positions.places[vertex] * scale;
            triangles_.vertices[k][i] = knows_spread && features.is_spread[vertex] ? vertex : vertex | kNotSpread;
            triangles_.corners[3 * k][i] = corner.x;
            triangles_.corners[3 * k + 1][i] = corner.y;
            triangles_.corners[3 * k + 2][i] = corner.z;
            box.include(corner);
          }
        }
        levels_[0].set(group, box);
      }
    });
    while (levels_.back().group_count() > 1) {
      const SpaceBoxes& below = levels_.back();
      SpaceBoxes level(below.group_count());
      for (std::size_t group = 0; group < below.group_count(); ++group) {
        Box box;
        for (std::size_t i = 0; i < kSpaceLanes; ++i) box.include(below.get(group * kSpaceLanes + i));
        level.set(group, box);
      }
      levels_.push_back(std::move(level));
    }
  }

  /// The number of groups of up to sixteen triangles.
  [[nodiscard]] std::size_t group_count() const { return triangles_.numbers.size() / kSpaceLanes; }

  /// Calls visit(a, b) once for every pair of triangles that SpaceKernels::crossing leaves open, if one triangle is in
  /// this group and the other in this group or a later one.
  template <class Visitor>
  void visit_pairs(std::size_t group, const Visitor& visit) const {
    const std::size_t begin = group * kSpaceLanes;
    SpaceProbes probes;
    kernels_.set_probes(triangles_, begin, probes);
    visit_groups(group, [&](std::size_t other, const Box& other_box) {
      const std::size_t first = other * kSpaceLanes;
      SpaceMasks masks;
      std::uint32_t found = kernels_.crossing(triangles_, first, other_box, probes, masks);
      for (; found != 0; found &= found - 1) {
        const auto i = std::size_t(std::countr_zero(found));
        if (begin + i >= triangles_.count) break;
        std::uint32_t bits = masks[i];
        if (other == group) bits &= 0xFFFEu << i;
        for (; bits != 0; bits &= bits - 1) {
          const std::size_t j = first + std::size_t(std::countr_zero(bits));
          if (j < triangles_.count) visit(triangles_.numbers[begin + i], triangles_.numbers[j]);
        }
      }
    });
  }

 private:
  /// Calls visit(other, other's box) for `group` itself and for every later group whose box touches the box of `group`.
  template <class Visitor>
  void visit_groups(std::size_t group, const Visitor& visit) const {
    const Box box = levels_[0].get(group);
    struct Step {
      std::size_t level, group;
    };
    Step open[kSpaceLanes * kMostLevels];
    std::size_t count = 0;
    open[count++] = {levels_.size() - 1, 0};
    while (count > 0) {
      const Step step = open[--count];
      const std::size_t first = step.group * kSpaceLanes;
      for (std::uint32_t bits = kernels_.touching(levels_[step.level], first, box); bits != 0; bits &= bits - 1) {
        const std::size_t child = first + std::size_t(std::countr_zero(bits));
        if (step.level > 0)
          open[count++] = {step.level - 1, child};
        else if (child >= group)
          visit(child, levels_[0].get(child));
      }
    }
  }

  static constexpr std::size_t kMostLevels = 9;  ///< 16^8 is more than there are numbers for triangles
  SpaceKernels kernels_;
  SpaceTriangles triangles_;
  std::vector<SpaceBoxes> levels_;  ///< boxes of groups of sixteen triangles, then of groups of such groups
};

constexpr std::size_t kGroupsPerPart = 16, kPairsPerPoll = 16384;
constexpr std::size_t kMostSegments = std::size_t(1) << 20, kMostSegmentsOfTriangle = 16;
/// A pair counts as kStepsOfPair steps of ten nanoseconds; the other two bound all steps.
constexpr std::uint64_t kStepsOfPair = 8, kMostSteps = std::uint64_t(1) << 30, kMostStepsOfTriangle = 256;

/// A triangle with its vertices in ascending order, so that every computation with its plane gives the same bits.
struct CrossedFace {
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

  static glm::uvec3 ascending(glm::uvec3 v) {
    if (v.x > v.y) std::swap(v.x, v.y);
    if (v.y > v.z) std::swap(v.y, v.z);
    if (v.x > v.y) std::swap(v.x, v.y);
    return v;
  }
};

/// The heights of a face's corners over the plane of another; 0 for corners that both share.
struct Heights {
  Heights(const WeldedMesh& mesh, const CrossedFace& face, const CrossedFace& over) {
    for (int k = 0; k < 3; ++k)
      if (!over.has(face.vertices[k])) of[k] = over.plane.height(mesh.positions[face.vertices[k]]);
  }

  [[nodiscard]] bool straddle() const {
    const auto any = [&](int sign) { return of[0].sign == sign || of[1].sign == sign || of[2].sign == sign; };
    return any(1) && any(-1);
  }
  /// Index of the only corner that is not in the plane; -1 if no corner or several are outside of the plane.
  [[nodiscard]] int beside() const {
    int corner = -1;
    for (int k = 0; k < 3; ++k) {
      if (of[k].sign == 0) continue;
      if (corner >= 0) return -1;
      corner = k;
    }
    return corner;
  }

  Signed of[3];
};

/// A point in which a face's outline meets the plane of another face: an end of the first face's interval.
struct EdgeMeeting {
  CrossingEnd end;
  std::uint32_t p, q;  ///< the edge that passes through the plane, or ends in it
};

/// The two points in which the outline of a face meets the plane that it straddles. A vertex in the plane is
/// represented by one of its edges.
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
    found[count++] = {{place_between(mesh.positions[p], mesh.positions[q], root_between(a, b)), {p, q}}, p, q};
  }
  return found;
}

/// The orientation of the tetrahedron spanned by the edges p-q and r-s; 0 if these edges share a vertex.
int turn(const WeldedMesh& mesh, std::uint32_t p, std::uint32_t q, std::uint32_t r, std::uint32_t s) {
  if (p == r || p == s || q == r || q == s) return 0;
  const auto& at = mesh.positions;
  return FacePlane(at[p], at[q], at[r]).height(at[s]).sign;
}

/// Whether the line through the meeting's edge passes through the face. Precondition: the edge does not lie in the
/// face's plane.
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
/// along that edge, the second face is then turned the wrong way. `heights`: of the first face over the second.
bool lie_apart(const WeldedMesh& mesh, const std::array<const CrossedFace*, 2>& faces, const Heights& heights,
               std::uint32_t shared) {
  const glm::uvec3 &a = faces[0]->vertices, &b = faces[1]->vertices;
  const int from = a.x == shared ? 1 : 0, to = a.z == shared ? 1 : 2;
  // The shared corner followed by the two others has the same order as all three, unless it is the middle one.
  const std::uint32_t next = b.x == shared ? b.y : b.x;
  const int order = b.y == shared ? -1 : 1;
  return turn(mesh, a[from], a[to], shared, next) * heights.of[from].sign * order > 0;
}

struct Found {
  std::vector<Crossing> crossings;
  std::vector<EdgeContact> contacts;

  void add_contact(const CrossedFace& face, int beside, std::uint32_t triangle) {
    if (beside < 0) return;
    const glm::uvec3& v = face.vertices;
    contacts.push_back({beside == 0 ? v.y : v.x, beside == 2 ? v.y : v.z, triangle});
  }
};

/// The segment in which two triangles cross, if there is one. Adds contacts to `found`. Precondition: the triangles
/// share at most one vertex.
std::optional<Crossing> crossing(const WeldedMesh& mesh, const std::array<const CrossedFace*, 2>& faces, Found& found) {
  const Heights first(mesh, *faces[0], *faces[1]);
  const int first_beside = first.beside();
  if (!first.straddle() && first_beside < 0) return std::nullopt;
  const Heights second(mesh, *faces[1], *faces[0]);
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
  // Where two edges meet, both triangles have an end at the same point. So two ends of one triangle are enough.
  for (std::size_t k = 0; k < 2; ++k)
    if (count[k] == 2) return Crossing{within[k][0]->end, within[k][1]->end, faces[0]->triangle, faces[1]->triangle};
  if (count[0] == 0 || count[1] == 0) return std::nullopt;
  const EdgeMeeting &a = *within[0][0], &b = *within[1][0];
  if (turn(mesh, a.p, a.q, b.p, b.q) == 0) return std::nullopt;  // they touch in a point
  return Crossing{a.end, b.end, faces[0]->triangle, faces[1]->triangle};
}

auto order(const Crossing& c) {
  const glm::dvec3 &a = c.from.place, &b = c.to.place;
  return std::make_tuple(a.x, a.y, a.z, b.x, b.y, b.z, c.left, c.right);
}

bool is_before(const Crossing& a, const Crossing& b) { return order(a) < order(b); }

void remove_repeated(std::vector<Crossing>& sorted) {
  const auto is_same_line = [](const Crossing& a, const Crossing& b) {
    return a.from.place == b.from.place && a.to.place == b.to.place;
  };
  sorted.erase(std::unique(sorted.begin(), sorted.end(), is_same_line), sorted.end());
}

/// Sorts segments by their ends, of which the lesser one becomes the first, and removes repeated ones, and those whose
/// ends were rounded to one place.
void arrange(std::vector<Crossing>& all, const Execution& execution) {
  for (Crossing& c : all) {
    const glm::dvec3 &p = c.from.place, &q = c.to.place;
    if (std::tie(q.x, q.y, q.z) < std::tie(p.x, p.y, p.z)) std::swap(c.from, c.to);
  }
  std::erase_if(all, [](const Crossing& c) { return c.from.place == c.to.place; });
  sort_in_parts(all, is_before, execution);
  remove_repeated(all);
}

}  // namespace

CrossedPairs find_crossed_pairs(const WeldedMesh& mesh, const Features& features, const Execution& execution) {
  if (mesh.triangles.size() < features.twins.size() + 2) return {};
  const BoxTree tree(mesh, features, execution);
  const std::size_t parts = (tree.group_count() + kGroupsPerPart - 1) / kGroupsPerPart;
  std::vector<std::vector<Crossing>> crossings(parts);
  std::vector<std::vector<EdgeContact>> contacts(parts);
  // Segments are counted over all threads, so that the limit is checked before memory is requested.
  const std::size_t most_segments = kMostSegments + kMostSegmentsOfTriangle * mesh.triangles.size();
  std::atomic<std::size_t> segments{0};
  WorkLimit work(execution, kMostSteps + kMostStepsOfTriangle * mesh.triangles.size(), "lines");
  parallel_for(execution, tree.group_count(), kGroupsPerPart, [&](std::size_t begin, std::size_t end) {
    Found found;
    std::size_t counted = 0, asked = 0;
    const auto count = [&] {
      const std::size_t all = found.crossings.size() + found.contacts.size();
      if ((segments += all - counted) > most_segments)
        throw Error(ErrorCode::limit_exceeded, "lines",
                    "more than " + std::to_string(most_segments) + " segments in which triangles intersect");
      counted = all;
    };
    for (std::size_t group = begin; group < end; ++group) {
      check_cancelled(execution);
      tree.visit_pairs(group, [&](std::uint32_t a, std::uint32_t b) {
        const CrossedFace one(mesh, std::min(a, b)), two(mesh, std::max(a, b));
        if (const std::optional<Crossing> segment = crossing(mesh, {&one, &two}, found))
          found.crossings.push_back(*segment);
        if (++asked % kPairsPerPoll != 0) return;
        work.add(kStepsOfPair * kPairsPerPoll,
                 [] { return std::string("too many triangles are close to each other to find where they intersect"); });
        count();
      });
    }
    count();
    crossings[begin / kGroupsPerPart] = std::move(found.crossings);
    contacts[begin / kGroupsPerPart] = std::move(found.contacts);
  });
  CrossedPairs pairs{joined(crossings, execution), segments_of(mesh, joined(contacts, execution))};
  arrange(pairs.crossings, execution);
  return pairs;
}

std::vector<Crossing> find_crossings(const Features& features, const CrossedPairs& pairs, const Execution& execution) {
  const auto is_drawn = [&](const std::pair<std::uint32_t, std::uint32_t>& edge) {
    const auto ends = [](const FeatureEdge& feature) { return std::pair(feature.from, feature.to); };
    const auto found =
        std::lower_bound(features.edges.begin(), features.edges.end(), edge,
                         [&](const FeatureEdge& feature, const auto& wanted) { return ends(feature) < wanted; });
    return found != features.edges.end() && ends(*found) == edge;
  };
  std::vector<Crossing> added;
  for (const ContactSegment& contact : pairs.contacts)
    if (!is_drawn(contact.edges[0]) && !is_drawn(contact.edges[1])) added.push_back(contact.segment);
  arrange(added, execution);
  std::vector<Crossing> all;
  all.reserve(pairs.crossings.size() + added.size());
  std::merge(pairs.crossings.begin(), pairs.crossings.end(), added.begin(), added.end(), std::back_inserter(all),
             is_before);
  remove_repeated(all);
  return all;
}

}  // namespace frontmost::lines_detail
