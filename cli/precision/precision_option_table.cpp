// SPDX-License-Identifier: Apache-2.0
// Options of frontmost precision alone.
#include "cli/failure.h"
#include "cli/option.h"

namespace frontmost::cli {
namespace {

constexpr Option precision_options[] = {
    {"model", 0, "FILE", "Count the pixels of this model where the buffer shows the wrong surface.", Group::precision,
     for_precision, [](Settings& s, const Given& g) { s.model = g.file_name(); }},
    {"format", 0, "D8|D16|D24|F32",
     "Format of the depth buffer; by default D16, D24, F32 and F32 reversed are compared.", Group::precision,
     for_precision, [](Settings& s, const Given& g) { s.precision.format = g.choice<DepthFormat>(); }},
    {"infinite", 0, "", "Put the far plane at infinity: as --far inf.", Group::precision, for_precision,
     [](Settings& s, const Given&) { s.precision.infinite = true; }},
    {"gap", 0, "GAP,DISTANCE", "Say which near plane would resolve GAP at DISTANCE.", Group::precision, for_precision,
     [](Settings& s, const Given& g) {
       const std::vector<double> wanted = parse_numbers(g.text, 2, {1e-300, 1e300});
       s.precision.wanted = glm::dvec2(wanted[0], wanted[1]);
     }},
    {"plot", 0, "FILE", "Draw the gaps against distance, as SVG.", Group::precision, for_precision,
     [](Settings& s, const Given& g) { s.precision.plot = g.file_name(); }},
    {"heat-map", 0, "FILE", "Paint the wrong pixels over the model, as PNG; needs --model and --format.",
     Group::precision, for_precision, [](Settings& s, const Given& g) { s.precision.heat_map = g.file_name(); }},
};

}  // namespace

std::span<const Option> precision_option_table() { return precision_options; }

}  // namespace frontmost::cli
