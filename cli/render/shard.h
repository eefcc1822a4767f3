// SPDX-License-Identifier: Apache-2.0
// One shard of a batch: every so many-th view, each noted in a manifest when it is finished, so that a run that is
// repeated goes on where the last one ended.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cli/render/jobs.h"
#include "cli/render/manifest.h"

namespace frontmost::cli {

/// \throws UsageError for what cannot be noted, or not be taken for finished: no batch file, a model from standard
/// input, views without files, references.
void check_shard(const Settings& settings, const std::vector<Job>& jobs);
/// Where the manifest of the settings' shard lies: in the folder that the program runs in, as files with relative
/// names.
[[nodiscard]] std::string manifest_path(const Settings& settings);

class ShardRun {
 public:
  /// `jobs` are those of the whole batch; `used` are the model's files, which have been read. Reads what an earlier run
  /// has noted, and writes a manifest of what of that holds still.
  ShardRun(const Settings& settings, const std::vector<Job>& jobs, const std::vector<std::filesystem::path>& used);

  /// Takes away the jobs of other shards, and those that are finished.
  [[nodiscard]] std::vector<Job> remaining(std::vector<Job> jobs) const;
  /// How many of the shard's were finished before.
  [[nodiscard]] std::size_t finished_count() const { return finished_count_; }
  /// Its files are whole.
  void note(const Job& job) const;

 private:
  std::string path_;
  std::vector<std::uint64_t> keys_;  ///< of all views
  std::vector<bool> is_open_;        ///< likewise: of this shard, and not finished
  std::size_t finished_count_ = 0;
};

}  // namespace frontmost::cli
