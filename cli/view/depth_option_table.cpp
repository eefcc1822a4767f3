// SPDX-License-Identifier: Apache-2.0
// Options of a depth buffer, named after OpenGL's state.
#include "cli/failure.h"
#include "cli/option.h"

namespace frontmost::cli {
namespace {

/// Marks the depth buffer as used: any of these options selects it instead of the exact default.
DepthSettings& used(Settings& settings) {
  settings.view.depth.is_used = true;
  return settings.view.depth;
}

constexpr Option depth_options[] = {
    {"depth-format", 0, "D8|D16|D24|F32",
     "Store depths in a depth buffer of this format; D24 by default if another option of this group is given.",
     Group::depth, for_render, [](Settings& s, const Given& g) { used(s).format = g.choice<DepthFormat>(); }},
    {"depth-func", 0, "NEVER|LESS|EQUAL|LEQUAL|GREATER|NOTEQUAL|GEQUAL|ALWAYS",
     "Depth test that fragments must pass; LESS by default, GREATER with --reversed. Triangles are drawn in the order "
     "of the file.",
     Group::depth, for_render, [](Settings& s, const Given& g) { used(s).func = g.choice<DepthFunc>(); }},
    {"depth-mask", 0, "off|on", "Whether passing fragments store their depth; on by default.", Group::depth, for_render,
     [](Settings& s, const Given& g) { used(s).mask = g.choice<int>() == 1; }},
    {"depth-clear", 0, "DEPTH", "Initial value of the depth buffer; 1 by default, 0 with --reversed.", Group::depth,
     for_render,
     [](Settings& s, const Given& g) {
       used(s).clear = g.number({-3e38, 3e38});
     }},
    {"depth-range", 0, "NEAR,FAR", "Stored depths of the near and far planes, 0 to 1 in any order; 0,1 by default.",
     Group::depth, for_render,
     [](Settings& s, const Given& g) {
       const std::vector<double> ends = parse_numbers(g.text, 2, {0, 1});
       used(s).range = glm::dvec2(ends[0], ends[1]);
     }},
    {"polygon-offset", 0, "FACTOR,UNITS", "Add to every depth its slope times FACTOR, and UNITS steps of the format.",
     Group::depth, for_render,
     [](Settings& s, const Given& g) {
       const std::vector<double> offset = parse_numbers(g.text, 2, {-1e30, 1e30});
       used(s).offset = {offset[0], offset[1], 0};
     }},
    {"reversed", 0, "", "Reversed depths: 1 at the near plane, 0 at the far plane.", Group::depth,
     for_render | for_precision, [](Settings& s, const Given&) { used(s).reversed = true; }},
};

}  // namespace

std::span<const Option> depth_option_table() { return depth_options; }

}  // namespace frontmost::cli
