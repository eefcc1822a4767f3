// SPDX-License-Identifier: Apache-2.0
// Options of frontmost sight alone.
#include "cli/option.h"

namespace frontmost::cli {
namespace {

constexpr Option sight_options[] = {
    {"from", 0, "X,Y,Z", "Look from this point, in the model's own coordinates.", Group::sight, for_sight,
     [](Settings& s, const Given& g) { s.sight.from = parse_vector(g.text); }},
    {"to", 0, "X,Y,Z", "Look at this point.", Group::sight, for_sight,
     [](Settings& s, const Given& g) { s.sight.to = parse_vector(g.text); }},
    {"pairs", 0, "FILE", "A file of pairs of points: six numbers a line, with blanks or commas; # starts a comment.",
     Group::sight, for_sight, [](Settings& s, const Given& g) { s.sight.pairs = g.file_name(); }},
};

}  // namespace

std::span<const Option> sight_option_table() { return sight_options; }

}  // namespace frontmost::cli
