// SPDX-License-Identifier: Apache-2.0
// A side and its reverse have the same hash. Each side looks for its reverse in a table, and takes it out if it is
// there. In meshes whose triangles are near each other in memory, few sides wait at a time, and the table stays in the
// cache.
//
// Sides must be equal to the bit. This suffices, because polygons of a mesh got their corners from the same vertices by
// the same arithmetic. If the same side occurs many times, as in a stack of equal sheets, a few dozen wait and the rest
// count as open: comparing all with all would take the square of their number.
#include "painter/seen/adjacency.h"

#include <cstring>

namespace frontmost::painter_detail {
namespace {

std::uint64_t bits_of(double value) {
  std::uint64_t bits;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

/// At most so many equal sides wait for a neighbour; further ones count as open. A stack of n sheets seen from above
/// would take n * n comparisons.
constexpr int kMostSame = 64;

/// Odd numbers without a pattern.
constexpr std::uint64_t kMixX = 0x9e3779b97f4a7c15, kMixY = 0xc2b2ae3d27d4eb4f, kMixSum = 0xd6e8feb86659fd93;

std::uint64_t hash_of(const glm::dvec3& at) {
  const std::uint64_t mixed = bits_of(at.x) * kMixX + bits_of(at.y) * kMixY;
  return mixed ^ (mixed >> 29);
}

/// Sides that have no neighbour yet, in a table in which a side and its reverse have the same place. A side leaves once
/// it has found its neighbour: in meshes that lie in the order of the screen, few sides are there at a time.
class OpenSides {
 public:
  OpenSides(const ScreenPolygons& screen, std::vector<std::uint32_t>& across) : screen_(screen), across_(across) {
    while (std::size_t(1) << bits_ < across.size() + across.size() / 4) ++bits_;
    entries_.assign(std::size_t(1) << bits_, {0, no_index});
  }

  /// Adds the side that begins at a corner of a slot's polygon.
  void add(std::uint32_t slot, std::uint32_t corner, std::uint64_t hash) {
    const auto tag = std::uint32_t((hash * kMixSum) >> 32);
    std::size_t i = home(tag);
    int same = 0;
    for (; entries_[i].corner != no_index; i = following(i)) {
      if (entries_[i].tag != tag) continue;
      if (!is_reverse(entries_[i].corner, slot, corner)) {
        if (++same < kMostSame) continue;
        alone_.push_back(corner);
        return;
      }
      // Before this swap, each side has its own slot across.
      std::swap(across_[entries_[i].corner], across_[corner]);
      return remove(i);
    }
    entries_[i] = {tag, corner};
  }
  /// Marks sides that still wait as having no neighbour.
  void finish() {
    for (const std::uint32_t corner : alone_) across_[corner] = no_index;
    for (const Entry& entry : entries_)
      if (entry.corner != no_index) across_[entry.corner] = no_index;
  }

 private:
  struct Entry {
    std::uint32_t tag, corner;
  };

  [[nodiscard]] std::size_t home(std::uint32_t tag) const { return std::size_t(tag) >> (32 - bits_); }
  [[nodiscard]] std::size_t following(std::size_t i) const { return i + 1 == entries_.size() ? 0 : i + 1; }

  /// Closes the gap, so that no search ends too early.
  void remove(std::size_t gap) {
    for (std::size_t i = following(gap); entries_[i].corner != no_index; i = following(i)) {
      const std::size_t mask = entries_.size() - 1, from_home = (i - home(entries_[i].tag)) & mask;
      if (from_home < ((i - gap) & mask)) continue;
      entries_[gap] = entries_[i];
      gap = i;
    }
    entries_[gap].corner = no_index;
  }

  [[nodiscard]] bool is_reverse(std::uint32_t a, std::uint32_t b_slot, std::uint32_t b) const {
    return at(a) == at(end_of(b_slot, b)) && at(end_of(across_[a], a)) == at(b);
  }
  [[nodiscard]] std::uint32_t end_of(std::uint32_t slot, std::uint32_t corner) const {
    const auto first = std::uint32_t(screen_.first_corner(slot));
    return corner + 1 == first + screen_.outline(slot).size() ? first : corner + 1;
  }
  [[nodiscard]] glm::dvec2 at(std::uint32_t corner) const { return glm::dvec2(screen_.corners()[corner].at); }

  const ScreenPolygons& screen_;
  std::vector<std::uint32_t>& across_;
  std::vector<Entry> entries_;
  std::vector<std::uint32_t> alone_;  ///< sides that are not in the table
  unsigned bits_ = 1;
};

}  // namespace

Adjacency::Adjacency(const ScreenPolygons& screen) : across_(screen.corners().size()) {
  OpenSides open(screen, across_);
  for (std::uint32_t slot = 0; slot < screen.count(); ++slot) {
    const Outline outline = screen.outline(slot);
    if (outline.empty()) continue;
    const auto first = std::uint32_t(screen.first_corner(slot));
    for (std::uint32_t i = 0; i < outline.size(); ++i) across_[first + i] = slot;
    std::uint64_t hash_before = hash_of(outline.back().at);
    std::uint32_t before = first + std::uint32_t(outline.size()) - 1;
    for (std::uint32_t i = 0; i < outline.size(); before = first + i++) {
      const std::uint64_t hash = hash_of(outline[i].at);
      open.add(slot, before, hash_before + hash);
      hash_before = hash;
    }
  }
  open.finish();
}

}  // namespace frontmost::painter_detail
