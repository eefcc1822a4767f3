// SPDX-License-Identifier: Apache-2.0
// What rays are read from and written to: files of numbers, a few on every line, and a scan as a file of points.
//
//   # from            to            a pair of points a line, or a direction: LineRule says how many numbers
//   0, -5, 1.8        4, 20, 1.8
#pragma once

#include <string>
#include <vector>

#include "cli/view/sight.h"

namespace frontmost::cli {

/// How many numbers a line holds, and why, as complaints say it: "six numbers make a pair of points".
struct LineRule {
  std::size_t count;
  const char* text;
};

/// The numbers of all lines that hold any, one line after the other; # starts a comment.
/// \throws Error file_unreadable; file_malformed naming the line; limit_exceeded for more than 1 GiB or 2^22 such
/// lines.
[[nodiscard]] std::vector<double> read_number_lines(const std::string& path, const LineRule& rule);

/// Points of a scan, and what goes with them.
struct ScanPoints {
  const RangeScan& scan;
  const RayScene& rays;
  const Buffer<float>& incidences;
  bool robot_axes = false;  ///< x ahead, y left, z up of the scanner; else the model's own coordinates
};

/// A binary PLY with a vertex for every ray that meets something, by rings and then by steps: x, y, z and range
/// (floats; in the coordinates of a model that lies far from zero x, y and z are doubles), object, triangle (within its
/// object), ring and step (32 bits), and the incidence (a float, degrees).
[[nodiscard]] std::string points_ply(const ScanPoints& points);

}  // namespace frontmost::cli
