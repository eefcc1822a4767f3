// SPDX-License-Identifier: Apache-2.0
// A rough ball of any number of triangles, written while it is made.
#pragma once

#include <cstdint>
#include <string>

namespace frontmost::bench {

/// Exact number of triangles in a ball of `about` triangles.
[[nodiscard]] std::uint64_t ball_triangle_count(std::uint64_t about);

/// Writes a binary STL or, with `ply`, PLY to `path`, where "-" is standard output. Memory: two rings of vertices.
/// \returns false if the reader of the output stops reading.
bool write_ball(std::uint64_t about, bool ply, const std::string& path);

}  // namespace frontmost::bench
