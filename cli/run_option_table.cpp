// SPDX-License-Identifier: Apache-2.0
// Options that say how to run; none changes any result.
#include <fmt/format.h>

#include <algorithm>

#include "cli/failure.h"
#include "cli/option.h"

namespace frontmost::cli {
namespace {

Isa isa_from(const Given& given) {
  // The words leave out Isa::best, which is the default.
  const Isa isa = Isa(parse_choice(given.text, given.choices) + int(Isa::scalar));
  const std::span<const Isa> available = available_isas();
  if (std::find(available.begin(), available.end(), isa) != available.end()) return isa;
  std::vector<std::string_view> names;
  for (const Isa one : available) names.push_back(name(one));
  throw UsageError(fmt::format("{} does not run here; {} do", given.text, fmt::join(names, ", ")));
}

constexpr Option run_options[] = {
    {"batch", 0, "FILE", "Render many views: a JSON file of views and outputs (see frontmost(1)).", Group::run,
     for_render, [](Settings& s, const Given& g) { s.run.batch = g.file_name(); }},
    {"method", 0, "zbuffer|raycast|abuffer",
     "Visibility method; by default the z-buffer, and the A-buffer for what can be seen through.", Group::run,
     for_render, [](Settings& s, const Given& g) { s.run.method = g.choice<Method>(); }},
    {"stream", 0, "", "Read binary STL and PLY piece by piece: files larger than memory, with the same bytes.",
     Group::run, for_render, [](Settings& s, const Given&) { s.run.stream = true; }},
    {"threads", 0, "N", "Threads, 1 to 1024; 0, the default, is one per core.", Group::run, for_every_model,
     [](Settings& s, const Given& g) {
       s.run.threads = g.integer({0, 1024});
     }},
    {"isa", 0, "scalar|sse4|avx2|avx512", "Instruction set; the best by default.", Group::run,
     for_render | for_sight | for_lidar | for_compare | for_report,
     [](Settings& s, const Given& g) { s.run.isa = isa_from(g); }},
    {"repeat", 0, "N", "Find what is visible N times, for timing.", Group::run, for_render,
     [](Settings& s, const Given& g) {
       s.run.repeat = g.integer({1, 1e6});
     }},
    {"timeout", 0, "SECONDS", "Give up after this long, with exit status 1.", Group::run, for_every_model,
     [](Settings& s, const Given& g) {
       s.run.timeout = g.number({1e-3, 1e7});
     }},
    {"json", 0, "", "Report on standard output as JSON, and nothing else there.", Group::run, for_every_model,
     [](Settings& s, const Given&) { s.run.json = true; }},
    {"quiet", 'q', "", "No progress and no warnings.", Group::run, for_every_model,
     [](Settings& s, const Given&) { s.run.quiet = true; }},
};

}  // namespace

std::span<const Option> run_option_table() { return run_options; }

std::string Given::file_name() const {
  if (text.empty()) throw UsageError("the file name is empty");
  return string();
}

void apply(const Option& option, std::string_view text, Settings& settings) {
  try {
    option.apply(settings, {text, option.choices()});
  } catch (const UsageError& error) {
    throw UsageError(fmt::format("--{}: {}", option.name, error.what()));
  }
}

}  // namespace frontmost::cli
