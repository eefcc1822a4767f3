// SPDX-License-Identifier: Apache-2.0
// Copies are found with a table of the first triangles of each kind, with open addressing. Vertices are compared by
// their floats, and the hash does not depend on which vertex comes first:
//
//    hash of a triangle  =  sum over its vertices of  mix(x, y, z)
//
// Faces are counter-clockwise to the eye, so two triangles with the same vertices list them in the same cyclic order,
// and a comparison tries three rotations. A triangle that the near plane has cut is a piece by itself and never counts
// as a copy.
//
// A copy that comes back gets the outline of the piece that stayed, under its own id. Higher ids come first, so the
// lowest id, which is seen at equal depths, is on top.
#include <algorithm>
#include <cstring>

#include "base/memory.h"
#include "painter/stages.h"

namespace frontmost::painter_detail {
namespace {

/// At most so many other triangles are compared; a copy that is not found among them stays.
constexpr int kMostProbes = 64;

/// Odd numbers without a pattern.
constexpr std::uint64_t kMix = 0x9e3779b97f4a7c15, kMixCorner = 0xc2b2ae3d27d4eb4f;

/// Hash of three vertices, in any order.
std::uint64_t hash_of(const Face& face) {
  std::uint64_t sum = 0;
  for (const glm::vec3& corner : face.corners) {
    const glm::vec3 no_negative_zero = corner + 0.0f;
    std::uint32_t bits[3];
    std::memcpy(bits, &no_negative_zero, sizeof bits);
    const std::uint64_t mixed = ((bits[0] * kMix) ^ (std::uint64_t(bits[1]) << 32 | bits[2])) * kMixCorner;
    sum += mixed ^ (mixed >> 32);
  }
  return sum * kMix;
}

/// Both faces are counter-clockwise to the eye, so the same vertices are in the same cyclic order.
bool is_copy(const Face& a, const Face& b) {
  for (std::size_t turn = 0; turn < 3; ++turn)
    if (a.corners[0] == b.corners[turn])
      return a.corners[1] == b.corners[(turn + 1) % 3] && a.corners[2] == b.corners[(turn + 2) % 3];
  return false;
}

/// Table of the first triangles of each kind, by their hash.
class FirstOnes {
 public:
  explicit FirstOnes(std::size_t count) {
    while (std::size_t(1) << bits_ < 2 * count) ++bits_;
    entries_.assign(std::size_t(1) << bits_, {0, no_index});
  }
  void prefetch(std::uint64_t hash) const { prefetch_line(&entries_[home(hash)]); }

  /// The piece of which this piece is a copy, or no_index; the piece is then stored.
  std::uint32_t find_or_add(const Pieces& pieces, std::uint32_t piece, std::uint64_t hash) {
    const auto tag = std::uint32_t(hash);
    std::size_t i = home(hash);
    for (int probe = 0; probe < kMostProbes; ++probe, i = (i + 1) & (entries_.size() - 1)) {
      Entry& entry = entries_[i];
      if (entry.piece == no_index) {
        entry = {tag, piece};
        return no_index;
      }
      if (entry.tag == tag && is_copy(pieces.face(entry.piece), pieces.face(piece))) return entry.piece;
    }
    return no_index;
  }

 private:
  struct Entry {
    std::uint32_t tag, piece;
  };
  [[nodiscard]] std::size_t home(std::uint64_t hash) const { return std::size_t(hash >> (64 - bits_)); }

  unsigned bits_ = 1;
  std::vector<Entry> entries_;
};

}  // namespace

Copies::Copies(const Pieces& pieces, std::vector<std::uint32_t>& members) {
  constexpr std::size_t ahead = 16;
  FirstOnes first_ones(members.size());
  std::vector<std::uint64_t> hashes;
  hashes.reserve(members.size());
  for (const std::uint32_t piece : members) hashes.push_back(hash_of(pieces.face(piece)));
  std::size_t kept = 0;
  for (std::size_t i = 0; i < hashes.size(); ++i) {
    if (i + ahead < hashes.size()) first_ones.prefetch(hashes[i + ahead]);
    const std::uint32_t piece = members[i];
    // Only whole triangles: a triangle that the near plane cut is a piece by itself.
    const std::uint32_t first = pieces.is_whole(piece) ? first_ones.find_or_add(pieces, piece, hashes[i]) : no_index;
    if (first == no_index)
      members[kept++] = piece;
    else
      copies_.push_back({pieces.face(first).id, piece});
  }
  members.resize(kept);
  std::stable_sort(copies_.begin(), copies_.end(), [](const Copy& a, const Copy& b) { return a.of < b.of; });
}

Copies::Range Copies::of(PrimitiveId id, const Occluders& occluders) const {
  const auto is_before = [](const Copy& copy, PrimitiveId other) { return copy.of < other; };
  Range range{std::lower_bound(copies_.begin(), copies_.end(), id, is_before), {}};
  range.end = range.begin;
  while (range.end != copies_.end() && range.end->of == id) ++range.end;
  if (range.count() > 0 && occluders.contain(id)) range.end = range.begin;
  return range;
}

void Copies::put_back(Pieces& pieces, std::vector<std::uint32_t>& members, const Occluders& occluders,
                      std::size_t most) const {
  if (copies_.empty()) return;
  std::size_t count = members.size();
  for (const std::uint32_t piece : members) count += of(pieces.face(piece).id, occluders).count();
  if (count > most) refuse_more_polygons_than(most);
  std::vector<std::uint32_t> all;
  all.reserve(count);
  for (const std::uint32_t piece : members) {
    const Range copies = of(pieces.face(piece).id, occluders);
    for (auto copy = copies.end; copy != copies.begin;) {
      --copy;
      all.push_back(copy->piece);
      if (pieces.is_whole(piece)) continue;
      Face face = pieces.face(piece);
      face.id = pieces.face(copy->piece).id;
      pieces.add(pieces.extent(piece), face);
      all.back() = pieces.size() - 1;
    }
    all.push_back(piece);
  }
  members = std::move(all);
}

}  // namespace frontmost::painter_detail
