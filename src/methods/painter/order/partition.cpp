// SPDX-License-Identifier: Apache-2.0
// Divides a list of pieces by the plane of one piece.
//
// H. Fuchs, Z. Kedem, B. Naylor. On Visible Surface Generation by A Priori Tree Structures. 1980.
//
//    planes of a few pieces are tested against a few other pieces, spread evenly over the list
//    the best plane cuts few of the tested pieces and leaves about as many on either side
//
// Pieces in the plane are only ordered by id, and the plane's own triangle is always among them. So neither side is as
// large as the whole, and the division ends.
#include <algorithm>

#include "painter/stages.h"

namespace frontmost::painter_detail {
namespace {

/// Two and four times as many find planes that cut 5 % less, and take two and five times as long.
constexpr std::size_t kMostCandidates = 8, kMostWitnesses = 64;
constexpr std::size_t kStepsPerCut = 16;

/// Numbers spread evenly over [0, count).
std::vector<std::size_t> spread(std::size_t count, std::size_t most) {
  std::vector<std::size_t> numbers(std::min(count, most));
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = i * count / numbers.size();
  return numbers;
}

/// Cost of a candidate: a cut costs one more piece in all later steps, and may be cut again; an uneven split costs as
/// little as a level of the tree.
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

}  // namespace frontmost::painter_detail
