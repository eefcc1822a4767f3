// SPDX-License-Identifier: Apache-2.0
#include "io/images/png/prefix_code.h"

#include <algorithm>
#include <array>
#include <vector>

namespace frontmost::detail {
namespace {

constexpr int longest_code = 15;

struct SymbolCount {
  std::uint32_t count = 0;
  std::uint32_t symbol = 0;
};

/// Depths of the leaves of Huffman's tree. `leaves` are sorted by count.
std::vector<int> depths_of(const std::vector<SymbolCount>& leaves) {
  const std::size_t leaf_count = leaves.size(), root = 2 * leaf_count - 2;
  std::vector<std::uint32_t> counts(root + 1), parents(root + 1);
  for (std::size_t i = 0; i < leaf_count; ++i) counts[i] = leaves[i].count;
  // Leaves and joined nodes both come in the order of their counts: the least is at the front of one of two queues.
  std::size_t leaf = 0, joined = leaf_count;
  for (std::size_t next = leaf_count; next <= root; ++next)
    for (int child = 0; child < 2; ++child) {
      const bool takes_leaf = leaf < leaf_count && (joined == next || counts[leaf] <= counts[joined]);
      const std::size_t least = takes_leaf ? leaf++ : joined++;
      counts[next] += counts[least];
      parents[least] = std::uint32_t(next);
    }
  std::vector<int> depths(root + 1);
  for (std::size_t i = root; i-- > 0;) depths[i] = depths[parents[i]] + 1;
  depths.resize(leaf_count);
  return depths;
}

}  // namespace

void find_code_lengths(std::span<const std::uint32_t> counts, int most_bits, std::span<std::uint8_t> lengths) {
  std::vector<SymbolCount> leaves;
  for (std::size_t i = 0; i < counts.size(); ++i)
    if (counts[i] > 0) leaves.push_back({counts[i], std::uint32_t(i)});
  const auto less = [](const SymbolCount& a, const SymbolCount& b) {
    return a.count != b.count ? a.count < b.count : a.symbol < b.symbol;
  };
  std::sort(leaves.begin(), leaves.end(), less);
  std::vector<int> depths = depths_of(leaves);
  // Counts that are nearer to each other make a flatter tree; half of them, rounded up, still have their order. It
  // happens with a few symbols that hardly ever occur, and costs next to nothing.
  while (*std::max_element(depths.begin(), depths.end()) > most_bits) {
    for (SymbolCount& leaf : leaves) leaf.count = (leaf.count + 1) / 2;
    depths = depths_of(leaves);
  }
  std::fill(lengths.begin(), lengths.end(), std::uint8_t(0));
  for (std::size_t i = 0; i < leaves.size(); ++i) lengths[leaves[i].symbol] = std::uint8_t(depths[i]);
}

void assign_codes(std::span<const std::uint8_t> lengths, std::span<std::uint16_t> codes) {
  std::array<unsigned, longest_code + 2> next = {};  // the first code of each length, then the next
  for (const std::uint8_t length : lengths)
    if (length > 0) ++next[length + 1u];
  for (std::size_t length = 1; length < next.size(); ++length) next[length] = (next[length] + next[length - 1]) << 1;
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    if (lengths[i] == 0) continue;
    const unsigned code = next[lengths[i]]++;
    unsigned reversed = 0;
    for (int bit = 0; bit < lengths[i]; ++bit) reversed |= (code >> bit & 1) << (lengths[i] - 1 - bit);
    codes[i] = std::uint16_t(reversed);
  }
}

}  // namespace frontmost::detail
