// SPDX-License-Identifier: Apache-2.0
// A view is finished if an earlier run noted it under the same key, and its files are unchanged. The key hashes all
// that determines the files' bytes: the program's version, the bytes of the model and of all files that it names, and
// all options that affect results. So time and place of the earlier run do not matter, and only views that changed in a
// batch file are made again.
#include "cli/render/shard.h"

#include <fmt/format.h>
#include <frontmost/version.h>

#include <algorithm>
#include <map>
#include <set>

#include "cli/failure.h"
#include "cli/inputs.h"
#include "cli/outputs.h"

namespace frontmost::cli {
namespace {

std::set<std::string> paths_of(const Job& job) {
  const std::vector<std::string> paths = output_paths({job});
  return {paths.begin(), paths.end()};
}

/// Returns a hash of the model's contents. Its path does not count.
std::uint64_t hash_of_model(const Settings& settings, const std::vector<std::filesystem::path>& used) {
  RunningHash hash;
  hash.add(std::string_view(FRONTMOST_VERSION));
  const auto add_name = [&](const std::string& model) {
    hash.add(std::string_view(model.starts_with("builtin:") ? model : ""));
  };
  add_name(settings.model);
  for (const std::string& model : settings.more_models) add_name(model);
  for (const std::filesystem::path& file : used) hash.add(hash_of_file(file.string()).hash);
  return hash.value();
}

/// Computes keys of jobs. Hashes of environments are kept, because several jobs may share one.
class ViewHasher {
 public:
  explicit ViewHasher(std::uint64_t model) : model_(model) {}

  std::uint64_t operator()(const Job& job) {
    RunningHash hash;
    hash.add(model_);
    hash.add(job.said);
    for (const std::string& path : paths_of(job)) hash.add(std::string_view(path));
    // The pose is hashed by value, because the option may name a file.
    if (job.view.pose)
      for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row) hash.add_bits((*job.view.pose)[column][row]);
    if (is_environment_file(job.output.light)) hash.add(environment(*job.output.light.environment));
    return hash.value();
  }

 private:
  std::uint64_t environment(const std::string& path) {
    const auto [found, is_new] = environments_.try_emplace(path);
    if (is_new) found->second = hash_of_file(path).hash;
    return found->second;
  }

  std::uint64_t model_;
  std::map<std::string, std::uint64_t> environments_;
};

/// Returns the finished views in a manifest, or none if the file is missing or empty, as a power failure may leave it.
std::vector<FinishedView> noted_in(const std::string& path) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error || size == 0) return {};
  return read_manifest(path).finished;
}

}  // namespace

void check_shard(const Settings& settings, const std::vector<Job>& jobs) {
  if (!settings.run.shard) return;
  if (!settings.run.batch) throw UsageError("--shard needs --batch, whose views it shares among runs");
  const auto is_input = [](const std::string& model) { return model == "-"; };
  if (is_input(settings.model) || std::any_of(settings.more_models.begin(), settings.more_models.end(), is_input))
    throw UsageError("--shard: a model from standard input cannot be identified when a run is repeated; give a file");
  for (const Job& job : jobs) {
    const auto refuse = [&](const char* why) { throw UsageError(fmt::format("--shard: view {} {}", job.name, why)); };
    const std::set<std::string> paths = paths_of(job);
    if (paths.empty())
      refuse("has no output file; give one (-o, --depth or --ids), so that a repeated run can skip the view");
    if (paths.count("-"))
      refuse("is written to standard output; give a file, so that a repeated run can skip the view");
    if (job.output.reference)
      refuse("has a --reference; leave it out, because a repeated run skips the view and its comparison");
  }
}

std::string manifest_path(const Settings& settings) {
  return manifest_name(model_name(settings.model) + "." + model_name(*settings.run.batch), *settings.run.shard);
}

ShardRun::ShardRun(const Settings& settings, const std::vector<Job>& jobs,
                   const std::vector<std::filesystem::path>& used)
    : path_(manifest_path(settings)), is_open_(jobs.size()) {
  const Shard shard = *settings.run.shard;
  ViewHasher hasher(hash_of_model(settings, used));
  RunningHash all;
  for (const Job& job : jobs) {
    keys_.push_back(hasher(job));
    all.add(keys_.back());
    is_open_[job.number] = shard.contains(job.number);
  }
  Manifest manifest{all.value(), jobs.size(), shard, {}};
  for (FinishedView& view : noted_in(path_)) {
    const bool holds = view.number < jobs.size() && is_open_[view.number] && view.key == keys_[view.number] &&
                       view.files.size() == paths_of(jobs[view.number]).size() && !changed_file(view, ".");
    if (!holds) continue;
    is_open_[view.number] = false;
    manifest.finished.push_back(std::move(view));
  }
  finished_count_ = manifest.finished.size();
  write_manifest(manifest, path_);
}

std::vector<Job> ShardRun::remaining(std::vector<Job> jobs) const {
  const auto end = std::remove_if(jobs.begin(), jobs.end(), [&](const Job& job) { return !is_open_[job.number]; });
  jobs.erase(end, jobs.end());
  return jobs;
}

void ShardRun::note(const Job& job) const {
  FinishedView view{job.number, job.name, keys_[job.number], {}};
  for (const std::string& path : paths_of(job)) view.files.push_back({path, hash_of_file(path)});
  append_to_manifest(view, path_);
}

}  // namespace frontmost::cli
