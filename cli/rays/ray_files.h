// SPDX-License-Identifier: Apache-2.0
// Files of rays and of scans. Input is lines of a few numbers each, output is points.
//
//   # from            to            one pair of points per line, or one direction: LineRule gives the number of values
//   0, -5, 1.8        4, 20, 1.8
#pragma once

#include <string>
#include <vector>

#include "cli/view/sight.h"

namespace frontmost::cli {

/// The number of values that each line must have, and the text of the error if a line has more or fewer values: "a pair
/// of points needs six numbers".
struct LineRule {
  std::size_t count;
  const char* text;
};

/// Returns the numbers of all lines, in order. # starts a comment, and lines without numbers are skipped. \throws Error
/// file_unreadable; file_malformed naming the line; limit_exceeded for more than 1 GiB or 2^22 lines with numbers.
[[nodiscard]] std::vector<double> read_number_lines(const std::string& path, const LineRule& rule);

/// The points of a scan and their attributes.
struct ScanPoints {
  const RangeScan& scan;
  const RayScene& rays;
  const Buffer<float>& incidences;
  bool robot_axes = false;  ///< true: scanner axes (x ahead, y left, z up); false: the model's coordinates
};

/// Returns a binary PLY with a vertex for each ray that meets something, sorted by ring and step. Properties: x, y, z
/// and range (floats; x, y and z are doubles in the coordinates of a model far from zero), object, triangle (within its
/// object), ring and step (32 bits), and incidence (float, degrees).
[[nodiscard]] std::string points_ply(const ScanPoints& points);

}  // namespace frontmost::cli
