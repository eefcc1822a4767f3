// SPDX-License-Identifier: Apache-2.0
// Cuts of pieces that have no order: part() divides a list of pieces by the plane of one piece, and least_cuts() tells
// beforehand how many cuts there will be at least.
//
// H. Fuchs, Z. Kedem, B. Naylor. On Visible Surface Generation by A Priori Tree Structures. 1980.
//
// Planes of a few pieces are tested against a few other pieces, spread evenly over the list. Pieces in the chosen plane
// are only ordered by id, and the plane's own triangle is always among them. So neither side is as large as the whole,
// and the division ends.
#include <algorithm>
#include <cmath>

#include "painter/stages.h"

namespace frontmost::painter_detail {
namespace {

/// Twice as many take twice as long, and four times as many five times as long; both find planes that cut 5 % less.
constexpr std::size_t kMostCandidates = 8, kMostWitnesses = 64;
constexpr std::size_t kStepsPerCut = 16;

/// Returns numbers that are spread evenly over [0, count).
std::vector<std::size_t> spread(std::size_t count, std::size_t most) {
  std::vector<std::size_t> numbers(std::min(count, most));
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = i * count / numbers.size();
  return numbers;
}

/// Returns the cost of a candidate. A cut costs much, because it adds a piece to all later steps, and this piece may be
/// cut again. An uneven split costs little: a level of the tree.
std::size_t cost(const Pieces& pieces, const std::vector<std::uint32_t>& members, std::uint32_t candidate) {
  const Plane plane = pieces.face(candidate).plane();
  std::size_t cuts = 0, before = 0, behind = 0;
  for (const std::size_t i : spread(members.size(), kMostWitnesses)) {
    if (members[i] == candidate) continue;
    const Sides sides = pieces.sides(members[i], plane);
    cuts += sides.both();
    before += sides.front;
    behind += sides.back;
  }
  return 8 * cuts + std::max(before, behind) - std::min(before, behind);
}

std::uint32_t choose(const Pieces& pieces, const std::vector<std::uint32_t>& members) {
  std::uint32_t best = members.front();
  std::size_t least = std::size_t(-1);
  for (const std::size_t i : spread(members.size(), kMostCandidates)) {
    const std::size_t found = cost(pieces, members, members[i]);
    if (found >= least) continue;
    least = found;
    best = members[i];
  }
  return best;
}

/// Number of pairs that are tested, and number of other triangles that are then tested for planes through the pair's
/// line. If there are fewer triangles, all are tested.
constexpr std::size_t kPairs = 512, kOthers = 4096;
/// Added to the number of tested triangles that share the line: only once in fifty times is the true number greater.
constexpr double kUnseen = 4;
/// Margin of the estimate, in standard deviations of such a sample.
constexpr double kDeviations = 4;

bool pierces(const glm::dvec3& from, const glm::dvec3& to, const Face& face) {
  const Plane plane = face.plane();
  if (plane.side(from) * plane.side(to) >= 0) return false;
  int turns = 0;
  for (std::size_t k = 0; k < 3; ++k)
    turns += Plane::through(from, to, face.corner(k)).side(face.corner(k == 2 ? 0 : k + 1));
  return std::abs(turns) == 3;
}

/// Returns whether an edge of one triangle pierces the other.
bool pass_through(const Face& a, const Face& b) {
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = k == 2 ? 0 : k + 1;
    if (pierces(a.corner(k), a.corner(next), b) || pierces(b.corner(k), b.corner(next), a)) return true;
  }
  return false;
}

glm::dvec3 normal_of(const Face& face) {
  return glm::cross(face.corner(1) - face.corner(0), face.corner(2) - face.corner(0));
}

/// The line where the planes of two triangles meet, to test whether other planes contain it, too.
class SharedLine {
 public:
  SharedLine(const Face& a, const Face& b) {
    const glm::dvec3 p = normal_of(a), q = normal_of(b), from(a.corners[0]);
    along_ = glm::cross(p, q);
    const double square = glm::dot(along_, along_), sizes = glm::dot(p, p) * glm::dot(q, q);
    at_ = from + glm::cross(along_, p) * (glm::dot(q, glm::dvec3(b.corners[0]) - from) / square);
    rounding_ = 1e-12 * sizes / square;
  }
  /// Returns whether the plane of a triangle contains the line. Also true if rounding leaves the answer open.
  [[nodiscard]] bool may_be_in_plane_of(const Face& face) const {
    const glm::dvec3 normal = normal_of(face), way = at_ - glm::dvec3(face.corners[0]);
    const double allowed = rounding_ * glm::length(normal);
    const double reach = glm::length(way) + glm::length(at_);
    return !(std::abs(glm::dot(normal, along_)) > allowed * glm::length(along_)) &&
           !(std::abs(glm::dot(normal, way)) > allowed * reach);
  }

 private:
  glm::dvec3 along_, at_;
  double rounding_;
};

/// Pseudo-random numbers below a limit, the same in every run.
class Picker {
 public:
  explicit Picker(std::size_t count) : count_(count) {}
  std::size_t next() {
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;
    return std::size_t(state_ >> 33) % count_;
  }

 private:
  std::size_t count_;
  std::uint64_t state_ = 1;
};

/// Returns a low estimate of the share of a cut that falls to one pair: pairs that meet in the same line share cuts.
double cuts_of_pair(const Pieces& pieces, const std::vector<std::uint32_t>& members, const SharedLine& line,
                    Picker& picker) {
  const std::size_t count = members.size();
  const bool is_all = count <= kOthers;
  std::size_t found = 0;
  for (std::size_t k = 0; k < std::min(count, kOthers); ++k)
    found += line.may_be_in_plane_of(pieces.face(members[is_all ? k : picker.next()]));
  const double sharing = is_all ? double(found) : (double(found) + kUnseen) * double(count) / kOthers;
  return 2 / std::max(2.0, sharing);
}

}  // namespace

Partition part(Pieces& pieces, const std::vector<std::uint32_t>& members, PaintSteps& steps, Poll& poll) {
  poll.count(std::min<std::size_t>(members.size(), kMostCandidates) *
             std::min<std::size_t>(members.size(), kMostWitnesses));
  const std::uint32_t chosen = choose(pieces, members);
  const Plane plane = pieces.face(chosen).plane();
  const std::uint32_t number = pieces.add_plane(plane);
  Partition partition;
  for (const std::uint32_t piece : members) {
    const Sides sides = pieces.sides(piece, plane);
    poll.count(sides.both() ? kStepsPerCut : 1);
    if (sides.both()) {
      const Pieces::Halves halves = pieces.cut(piece, number);
      partition.before.push_back(halves.front);
      partition.behind.push_back(halves.back);
      ++steps.cuts;
    } else {
      (sides.front ? partition.before : sides.back ? partition.behind : partition.within).push_back(piece);
    }
  }
  // In one plane the lower id is on top.
  std::sort(partition.within.begin(), partition.within.end(),
            [&](std::uint32_t a, std::uint32_t b) { return pieces.face(a).id > pieces.face(b).id; });
  return partition;
}

/// Every two triangles that pass through each other need a cut of their own along the line where they meet, because
/// other pairs meet in other lines. But the planes of m triangles may share a line, as two in one plane or blades
/// around an axis do. Then m - 1 cuts may suffice for all their m * (m - 1) / 2 pairs.
double least_cuts(const Pieces& pieces, const std::vector<std::uint32_t>& members, Poll& poll) {
  constexpr std::size_t tests_per_step = 8;
  const auto count = double(members.size());
  Picker picker(members.size());
  double sum = 0, squares = 0;
  for (std::size_t i = 0; i < kPairs; ++i) {
    poll.count(tests_per_step);
    const std::uint32_t a = members[picker.next()], b = members[picker.next()];
    if (!pieces.is_whole(a) || !pieces.is_whole(b) || !pass_through(pieces.face(a), pieces.face(b))) continue;
    poll.count(std::min(members.size(), kOthers) / tests_per_step);
    const double cuts = cuts_of_pair(pieces, members, {pieces.face(a), pieces.face(b)}, picker);
    sum += cuts;
    squares += cuts * cuts;
  }
  const double mean = sum / kPairs, spread = std::sqrt(std::max(0.0, squares / kPairs - mean * mean) / kPairs);
  return std::max(0.0, mean - kDeviations * spread) * 0.5 * count * count;
}

}  // namespace frontmost::painter_detail
