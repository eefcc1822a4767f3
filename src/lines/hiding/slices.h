// SPDX-License-Identifier: Apache-2.0
// Slices of a cell: sectors around a vertex where many triangles meet, or strips along a direction that most lines
// have.
#pragma once

#include "lines/hiding/fine_cells.h"

namespace frontmost::lines_detail {

/// If most of a crowd meets at one vertex: makes cell `cell` one with sectors. \returns whether it did.
[[nodiscard]] bool divide_by_sectors(const CrowdedGrid& grid, Crowd& crowd, std::uint32_t cell, FineCells& fine);

/// If most lines go one way: makes it one with strips.
[[nodiscard]] bool divide_by_strips(const CrowdedGrid& grid, Crowd& crowd, std::uint32_t cell, FineCells& fine);

}  // namespace frontmost::lines_detail
