// SPDX-License-Identifier: Apache-2.0
// A table with open addressing. It is filled once; later only its counts change. Counts are atomic because several
// threads ask at once. Positions are no longer written by then.
#include "stream/touched_positions.h"

#include <cstring>

namespace frontmost::streaming {
namespace {

/// More vertices than smooth normals examine at one position (shade/geometry/smooth_normals.cpp: 256), so that such a
/// position is recognised there as having too many.
constexpr std::uint32_t most_at_one_place = 1000;

std::array<std::uint32_t, 3> bits_of(const glm::vec3& position) {
  const glm::vec3 p = position + 0.0f;  // turns -0 into 0
  std::array<std::uint32_t, 3> bits;
  std::memcpy(bits.data(), &p, sizeof bits);
  return bits;
}

std::uint64_t hash_of(const std::array<std::uint32_t, 3>& bits) {
  std::uint64_t h = bits[0] * 0x9E3779B97F4A7C15u;
  h = (h ^ bits[1]) * 0xC2B2AE3D27D4EB4Fu;
  h = (h ^ (h >> 29) ^ bits[2]) * 0x9E3779B97F4A7C15u;
  return h ^ (h >> 32);
}

std::size_t power_of_two(std::size_t least) {
  std::size_t size = 64;
  while (size < least) size *= 2;
  return size;
}

}  // namespace

TouchedPositions::TouchedPositions(std::size_t corner_count)
    : filter_(power_of_two(16 * corner_count) / 64), slots_(power_of_two(2 * corner_count)) {}

std::size_t TouchedPositions::slot_of(const Bits& bits) const {
  const std::size_t mask = slots_.size() - 1;
  std::size_t slot = std::size_t(hash_of(bits)) & mask;
  while (slots_[slot].count.load(std::memory_order_relaxed) != 0 && slots_[slot].bits != bits) slot = (slot + 1) & mask;
  return slot;
}

void TouchedPositions::add(const glm::vec3& position) {
  const Bits bits = bits_of(position);
  Slot& slot = slots_[slot_of(bits)];
  slot.bits = bits;
  slot.count.store(1, std::memory_order_relaxed);
  const std::uint64_t bit = hash_of(bits) & (filter_.size() * 64 - 1);
  filter_[bit / 64] |= std::uint64_t(1) << (bit % 64);
}

bool TouchedPositions::touches(const Mesh& mesh, std::uint32_t triangle) {
  bool touches = false;
  for (int k = 0; k < 3; ++k) {
    const Bits bits = bits_of(mesh.positions[mesh.triangles[triangle][k]]);
    const std::uint64_t bit = hash_of(bits) & (filter_.size() * 64 - 1);
    if (!((filter_[bit / 64] >> (bit % 64)) & 1)) continue;
    Slot& slot = slots_[slot_of(bits)];
    if (slot.count.load(std::memory_order_relaxed) == 0) continue;
    touches |= slot.count.fetch_add(1, std::memory_order_relaxed) <= most_at_one_place;
  }
  return touches;
}

}  // namespace frontmost::streaming
