// SPDX-License-Identifier: Apache-2.0
// Options that control the run. None of them changes any result.
#include <fmt/format.h>

#include <algorithm>

#include "cli/failure.h"
#include "cli/option.h"
#include "cli/render/file_hash.h"

namespace frontmost::cli {
namespace {

Isa isa_from(const Given& given) {
  // The words omit Isa::best, which is the default.
  const Isa isa = Isa(parse_choice(given.text, given.choices) + int(Isa::scalar));
  const std::span<const Isa> available = available_isas();
  if (std::find(available.begin(), available.end(), isa) != available.end()) return isa;
  std::vector<std::string_view> names;
  for (const Isa one : available) names.push_back(name(one));
  throw UsageError(
      fmt::format("{} is not available on this machine; available are {}", given.text, fmt::join(names, ", ")));
}

Shard shard_from(std::string_view text) {
  constexpr NumberLimits shards{1, 100'000};
  const std::vector<std::string_view> parts = split(text, '/');
  if (parts.size() != 2) throw UsageError(fmt::format("{} is not K/N, such as 3/16", quoted(text)));
  const Shard shard{parse_integer(parts[0], shards), parse_integer(parts[1], shards)};
  if (shard.number > shard.count) throw UsageError(fmt::format("{}: there are only {} shards", text, shard.count));
  return shard;
}

constexpr Option run_options[] = {
    {"batch", 0, "FILE", "Render many views: a JSON file of views and outputs (see frontmost(1)).", Group::run,
     for_render, [](Settings& s, const Given& g) { s.run.batch = g.file_name(); }},
    {"shard", 0, "K/N",
     "Render every N-th view of the batch, 1/N to N/N. A manifest lists the finished views, which the next run skips.",
     Group::run, for_render, [](Settings& s, const Given& g) { s.run.shard = shard_from(g.text); }},
    {"method", 0, "zbuffer|raycast|abuffer",
     "Visibility method; by default zbuffer, and abuffer if the picture has translucent surfaces.", Group::run,
     for_render, [](Settings& s, const Given& g) { s.run.method = g.choice<Method>(); }},
    {"stream", 0, "",
     "Read binary STL and PLY piece by piece, for files larger than memory. The output has the same bytes.", Group::run,
     for_render, [](Settings& s, const Given&) { s.run.stream = true; }},
    {"mpi", 0, "",
     "Share the model among the ranks that mpirun has started: each streams a part, and rank 0 writes the files. "
     "{rank} in a model's name stands for the rank's number, if each rank reads a file of its own.",
     Group::run, for_render, [](Settings& s, const Given&) { s.run.mpi = s.run.stream = true; }},
    {"threads", 0, "N", "Number of threads, 1 to 1024; 0, the default, means one per core.", Group::run,
     for_every_model,
     [](Settings& s, const Given& g) {
       s.run.threads = g.integer({0, 1024});
     }},
    {"isa", 0, "scalar|sse4|avx2|avx512", "Instruction set; the best by default.", Group::run,
     for_render | for_sight | for_lidar | for_compare | for_report | for_explain,
     [](Settings& s, const Given& g) { s.run.isa = isa_from(g); }},
    {"repeat", 0, "N", "Find the visible surfaces N times; --json reports minimum, median and maximum time.",
     Group::run, for_render,
     [](Settings& s, const Given& g) {
       s.run.repeat = g.integer({1, 1e6});
     }},
    {"timeout", 0, "SECONDS", "Give up after so many seconds, with exit status 1.", Group::run,
     for_every_model | for_batch_merge,
     [](Settings& s, const Given& g) {
       s.run.timeout = g.number({1e-3, 1e7});
     }},
    {"json", 0, "", "Print the report as JSON on standard output, and nothing else there.", Group::run,
     for_every_model | for_batch_merge, [](Settings& s, const Given&) { s.run.json = true; }},
    {"quiet", 'q', "", "Show no progress and no warnings.", Group::run, for_every_model | for_batch_merge,
     [](Settings& s, const Given&) { s.run.quiet = true; }},
};

}  // namespace

std::span<const Option> run_option_table() { return run_options; }

std::string Given::file_name() const {
  if (text.empty()) throw UsageError("the file name is empty");
  return string();
}

void apply_as_given(const Option& option, std::string_view text, Settings& settings) {
  option.apply(settings, {text, option.choices()});
  // Options of the run do not change results, except for the method. --hash only adds a report.
  if ((option.group == Group::run && option.name != "method") || option.name == "hash") return;
  RunningHash hash;
  hash.add(settings.said);
  hash.add(option.name);
  hash.add(text);
  settings.said = hash.value();
}

void apply(const Option& option, std::string_view text, Settings& settings) {
  try {
    apply_as_given(option, text, settings);
  } catch (const UsageError& error) {
    throw UsageError(fmt::format("--{}: {}", option.name, error.what()));
  }
}

}  // namespace frontmost::cli
