// SPDX-License-Identifier: Apache-2.0
// Every two triangles that pass through each other take a cut of their own, along the line where they meet; other
// planes have other lines. So the number of such pairs tells before cutting begins whether it would reach its limit. If
// the planes of m triangles share a line, as two in one plane or blades around an axis do, m - 1 cuts may suffice for
// all their m * (m - 1) / 2 pairs.
#include <algorithm>
#include <cmath>

#include "painter/stages.h"

namespace frontmost::painter_detail {
namespace {

/// Pairs that are tested, and other triangles that are then tested for sharing their line; all of them if there are
/// fewer.
constexpr std::size_t kPairs = 512, kOthers = 4096;
/// Once in fifty times, so many more than were found among the tested triangles share the line.
constexpr double kUnseen = 4;
/// Margin of the estimate, in standard deviations of such a sample.
constexpr double kDeviations = 4;

bool pierces(const glm::dvec3& from, const glm::dvec3& to, const std::array<glm::dvec3, 3>& corners) {
  const Plane plane = Plane::through(corners[0], corners[1], corners[2]);
  if (plane.side(from) * plane.side(to) >= 0) return false;
  int turns = 0;
  for (std::size_t k = 0; k < 3; ++k) turns += Plane::through(from, to, corners[k]).side(corners[k == 2 ? 0 : k + 1]);
  return std::abs(turns) == 3;
}

/// Whether an edge of one triangle pierces the other.
bool pass_through(const Face& a, const Face& b) {
  const auto corners_of = [](const Face& face) {
    return std::array<glm::dvec3, 3>{glm::dvec3(face.corners[0]), glm::dvec3(face.corners[1]),
                                     glm::dvec3(face.corners[2])};
  };
  const std::array<glm::dvec3, 3> p = corners_of(a), q = corners_of(b);
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = k == 2 ? 0 : k + 1;
    if (pierces(p[k], p[next], q) || pierces(q[k], q[next], p)) return true;
  }
  return false;
}

glm::dvec3 normal_of(const Face& face) {
  const glm::dvec3 a(face.corners[0]), b(face.corners[1]), c(face.corners[2]);
  return glm::cross(b - a, c - a);
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
  /// Also true if rounding leaves the answer open.
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

/// Numbers below a limit, the same in every run.
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

/// The share of a cut that falls to one of the pairs that meet in a line, estimated low.
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

double least_cuts(const Pieces& pieces, const std::vector<std::uint32_t>& members, Poll& poll) {
  constexpr std::size_t tests_per_step = 8;
  const auto count = double(members.size());
  Picker picker(members.size());
  double sum = 0, squares = 0;
  for (std::size_t i = 0; i < kPairs; ++i) {
    poll.count(8);
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
