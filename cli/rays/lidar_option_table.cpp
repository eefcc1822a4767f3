// SPDX-License-Identifier: Apache-2.0
// Options of frontmost lidar alone.
#include "cli/failure.h"
#include "cli/option.h"

namespace frontmost::cli {
namespace {

glm::dvec2 elevations_from(const Given& given) {
  const std::vector<double> ends = parse_numbers(given.text, 2, {-90, 90});
  if (ends[0] > ends[1]) throw UsageError("the lowest comes first");
  return {ends[0], ends[1]};
}

constexpr Option lidar_options[] = {
    {"from", 0, "X,Y,Z", "Where the scanner stands, in the model's own coordinates.", Group::lidar, for_lidar,
     [](Settings& s, const Given& g) { s.lidar.from = parse_vector(g.text); }},
    {"forward", 0, "X,Y,Z", "Where it looks first; also an axis. By default the model's front view's direction.",
     Group::lidar, for_lidar, [](Settings& s, const Given& g) { s.lidar.forward = parse_direction(g.text); }},
    {"rings", 0, "N", "Rings of rays, 1 to 16384; 16 by default.", Group::lidar, for_lidar,
     [](Settings& s, const Given& g) {
       s.lidar.rings = g.integer({1, 16384});
     }},
    {"elevations", 0, "LOW,HIGH", "Degrees above the horizon between which rings are spread; -15,15 by default.",
     Group::lidar, for_lidar, [](Settings& s, const Given& g) { s.lidar.elevations = elevations_from(g); }},
    {"steps", 0, "N", "Rays of a ring, turning to the right; 1 to 16384; 1024 by default.", Group::lidar, for_lidar,
     [](Settings& s, const Given& g) {
       s.lidar.steps = g.integer({1, 16384});
     }},
    {"directions", 0, "FILE", "Instead of rings: three numbers a line, x right, y up, z behind; # starts a comment.",
     Group::lidar, for_lidar, [](Settings& s, const Given& g) { s.lidar.directions = g.file_name(); }},
    {"output", 'o', "FILE", "Points (.ply), or a range image with a row for each ring (.exr, .npy: ranges alone).",
     Group::output, for_lidar | may_repeat,
     [](Settings& s, const Given& g) { s.lidar.outputs.push_back(g.file_name()); }},
};

}  // namespace

std::span<const Option> lidar_option_table() { return lidar_options; }

}  // namespace frontmost::cli
