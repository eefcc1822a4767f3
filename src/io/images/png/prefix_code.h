// SPDX-License-Identifier: Apache-2.0
// Prefix codes as deflate has them (RFC 1951, 3.2.2): Huffman's lengths, and the codes that follow from lengths alone.
#pragma once

#include <cstdint>
#include <span>

namespace frontmost::detail {

/// How many bits the code of each symbol has if symbol i occurs counts[i] times: as few in all as Huffman's method
/// finds, at most `most_bits` for each; 0 for what does not occur. Of two symbols with one count the lower has no fewer
/// bits, so that the result is the same everywhere. Preconditions: two symbols at least occur, and 2^most_bits is at
/// least twice their number. O(n log n).
/// D. Huffman. A Method for the Construction of Minimum-Redundancy Codes. 1952.
void find_code_lengths(std::span<const std::uint32_t> counts, int most_bits, std::span<std::uint8_t> lengths);

/// The codes of those lengths, the first bit lowest, as they lie in the stream. `codes` of length 0 stay as they are.
void assign_codes(std::span<const std::uint8_t> lengths, std::span<std::uint16_t> codes);

}  // namespace frontmost::detail
