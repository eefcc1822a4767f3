// SPDX-License-Identifier: Apache-2.0
// Options of frontmost compare alone.
#include "cli/failure.h"
#include "cli/option.h"

namespace frontmost::cli {
namespace {

constexpr Option compare_options[] = {
    {"output", 'o', "FOLDER", "Write index.html and its pictures there; the folder is made where it is missing.",
     Group::compare, for_compare,
     [](Settings& s, const Given& g) {
       if (g.text.empty()) throw UsageError("the folder's name is empty");
       s.compare.folder = g.string();
     }},
    {"runs", 0, "N", "Run every method N times, for medians; 5 by default.", Group::compare, for_compare,
     [](Settings& s, const Given& g) {
       s.compare.runs = g.integer({1, 1e4});
     }},
    {"explain", 0, "", "Say in words which method suits this scene and machine.", Group::compare, for_compare,
     [](Settings& s, const Given&) { s.compare.explain = true; }},
};

}  // namespace

std::span<const Option> compare_option_table() { return compare_options; }

}  // namespace frontmost::cli
