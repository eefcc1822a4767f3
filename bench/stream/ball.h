// SPDX-License-Identifier: Apache-2.0
// A rough ball of any number of triangles, written as it is made.
#pragma once

#include <cstdint>
#include <string>

namespace frontmost::bench {

/// What a file of about so many triangles holds exactly.
[[nodiscard]] std::uint64_t ball_triangle_count(std::uint64_t about);

/// Writes a binary STL or, with `ply`, PLY to `path`, "-" for standard output. Memory: two rings of vertices.
/// \returns false where something reads no further.
bool write_ball(std::uint64_t about, bool ply, const std::string& path);

}  // namespace frontmost::bench
