// SPDX-License-Identifier: Apache-2.0
// One shard of a batch: every n-th view. Each finished view is noted in a manifest, so that a repeated run continues
// where the last one ended.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cli/render/jobs.h"
#include "cli/render/manifest.h"

namespace frontmost::cli {

/// Checks the settings of a shard. \throws UsageError for settings whose views cannot be noted or recognized as
/// finished: no batch file, a model from standard input, views without files, references.
void check_shard(const Settings& settings, const std::vector<Job>& jobs);
/// Returns the path of the shard's manifest: in the current folder, like files with relative names.
[[nodiscard]] std::string manifest_path(const Settings& settings);

class ShardRun {
 public:
  /// Reads the manifest of an earlier run, and writes a manifest of the views that are still valid. `jobs` holds the
  /// whole batch; `used` are the model's files, which have been read.
  ShardRun(const Settings& settings, const std::vector<Job>& jobs, const std::vector<std::filesystem::path>& used);

  /// Returns the jobs without those of other shards and those that are finished.
  [[nodiscard]] std::vector<Job> remaining(std::vector<Job> jobs) const;
  /// Returns the number of the shard's jobs that an earlier run finished.
  [[nodiscard]] std::size_t finished_count() const { return finished_count_; }
  /// Notes that all files of the job are complete.
  void note(const Job& job) const;

 private:
  std::string path_;
  std::vector<std::uint64_t> keys_;  ///< by view
  std::vector<bool> is_open_;        ///< by view: whether it belongs to this shard and is not finished
  std::size_t finished_count_ = 0;
};

}  // namespace frontmost::cli
