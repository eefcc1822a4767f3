// SPDX-License-Identifier: Apache-2.0
// An order of painting in which translucent neighbours follow each other.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

namespace frontmost::shading {

using NodePair = std::pair<std::uint32_t, std::uint32_t>;

/// What is painted at once, numbered as it has been painted so far.
struct SheetNodes {
  std::vector<std::uint8_t> opacities;  ///< one for each
  std::vector<NodePair> over;           ///< the second is painted after the first; sorted, each once
  std::vector<NodePair> beside;         ///< translucent ones of one opacity, both ways; sorted, each once
};

/// Nodes in the order of painting, and the number of the sheet of each, rising. Translucent nodes of one sheet have the
/// same opacity, and none is over another; opaque ones have sheets without a translucent one.
struct SheetOrder {
  std::vector<std::uint32_t> nodes, sheets;
};

/// Of all that may be painted next, what is opaque goes first, in the order that it had; then what lies beside nothing
/// that still has to wait; where there is nothing of the kind, what lies beside least of it. O(n log n) in the number
/// of nodes and pairs.
[[nodiscard]] SheetOrder order_in_sheets(const SheetNodes& nodes);

}  // namespace frontmost::shading
