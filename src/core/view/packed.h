// SPDX-License-Identifier: Apache-2.0
// A sample as one number: the greater number is nearer, or equally near with a lower id; 0 is nothing.
//
//   bit 63          32 31           0
//       | key, a float | id, inverted |      floats that are not negative are ordered like their bits
#pragma once

#include "base/memory.h"

namespace frontmost {

[[nodiscard]] inline std::uint64_t packed_sample(PrimitiveId id, float key) {
  return id == no_primitive ? 0 : std::uint64_t(bits_as<std::uint32_t>(key)) << 32 | std::uint32_t(~id);
}

inline void unpack_sample(std::uint64_t packed, PrimitiveId& id, float& key) {
  id = ~std::uint32_t(packed);
  key = bits_as<float>(std::uint32_t(packed >> 32));
}

}  // namespace frontmost
