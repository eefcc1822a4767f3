// SPDX-License-Identifier: Apache-2.0
// Stands for meshopt.cpp in builds without meshoptimizer.
#include "io/models/gltf/compressed.h"

namespace frontmost::gltf {

bool has_meshopt() { return false; }
std::vector<std::byte> decode_meshopt(const JsonValue&, Bytes, std::uint64_t) { return {}; }

}  // namespace frontmost::gltf
