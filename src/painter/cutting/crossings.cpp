// SPDX-License-Identifier: Apache-2.0
// Every two triangles that pass through each other take a cut of their own: along the line where they meet, and other
// planes have other lines. So their number tells whether cutting will come to its limit, before it begins; unless many
// lie in the same planes or around an axis, whose lines are the same.
#include "painter/cutting/crossings.h"

#include <algorithm>
#include <cmath>

namespace frontmost::painter_detail {
namespace {

/// And with how many others each is held against that passes through.
constexpr std::size_t kPairs = 512, kOthers = 32;
/// Of the spread of such a sample.
constexpr double kDeviations = 4;

bool pierces(const glm::dvec3& from, const glm::dvec3& to, const std::array<glm::dvec3, 3>& corners) {
  const Plane plane = Plane::through(corners[0], corners[1], corners[2]);
  if (plane.side(from) * plane.side(to) >= 0) return false;
  int turns = 0;
  for (std::size_t k = 0; k < 3; ++k) turns += Plane::through(from, to, corners[k]).side(corners[k == 2 ? 0 : k + 1]);
  return std::abs(turns) == 3;
}

/// An edge of one pierces the other.
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

bool are_in_one_plane(const Face& a, const Face& b) {
  const Plane plane = a.plane();
  return std::all_of(b.corners.begin(), b.corners.end(),
                     [&](const glm::vec3& corner) { return plane.side(glm::dvec3(corner)) == 0; });
}

glm::dvec3 normal_of(const Face& face) {
  const glm::dvec3 a(face.corners[0]), b(face.corners[1]), c(face.corners[2]);
  return glm::cross(b - a, c - a);
}

/// Whether the planes may meet in one line. Then one cut parts several pairs, as of blades around an axis n of n * n
/// / 2.
bool may_share_line(const Face& a, const Face& b, const Face& c) {
  constexpr double rounding = 1e-12;
  const glm::dvec3 p = normal_of(a), q = normal_of(b), r = normal_of(c);
  return !(std::abs(glm::dot(glm::cross(p, q), r)) > rounding * glm::length(p) * glm::length(q) * glm::length(r));
}

}  // namespace

double least_crossings(const Pieces& pieces, const std::vector<std::uint32_t>& members, Poll& poll) {
  const std::size_t count = members.size();
  std::uint64_t random = 1;
  const auto pick = [&] {
    random = random * 6364136223846793005u + 1442695040888963407u;
    return members[std::size_t(random >> 33) % count];
  };
  std::size_t found = 0;
  for (std::size_t i = 0; i < kPairs; ++i) {
    poll.count(8);
    const std::uint32_t a = pick(), b = pick();
    if (a != b && are_in_one_plane(pieces.face(a), pieces.face(b))) return 0;
    if (!pieces.is_whole(a) || !pieces.is_whole(b) || !pass_through(pieces.face(a), pieces.face(b))) continue;
    ++found;
    poll.count(kOthers);
    for (std::size_t k = 0; k < kOthers; ++k) {
      const std::uint32_t c = pick();
      if (c != a && c != b && may_share_line(pieces.face(a), pieces.face(b), pieces.face(c))) return 0;
    }
  }
  const double share = double(found) / kPairs, spread = std::sqrt(share * (1 - share) / kPairs);
  return std::max(0.0, share - kDeviations * spread) * 0.5 * double(count) * double(count);
}

}  // namespace frontmost::painter_detail
