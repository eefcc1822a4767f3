// SPDX-License-Identifier: Apache-2.0
// A run that several ranks share: one of them writes and speaks, and all of them end alike.
#pragma once

#include <frontmost/streams.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "cli/failure.h"
#include "cli/settings.h"

namespace frontmost::cli {

/// With whom a model is streamed.
struct Team {
  Ranks* ranks = nullptr;    ///< null: nobody
  std::vector<int> readers;  ///< as StreamOptions::readers

  [[nodiscard]] bool is_first() const { return !ranks || ranks->number() == 0; }
};

/// Why a run failed, and how the program ends then.
struct RunFailure {
  int status = exit_could_not;
  std::string message;
};

/// Thrown where another rank has failed.
class FailedElsewhere : public std::exception {
 public:
  explicit FailedElsewhere(RunFailure failure) : failure_(std::move(failure)) {}
  [[nodiscard]] const RunFailure& failure() const { return failure_; }

 private:
  RunFailure failure_;
};

/// Ranks that ask each other before everything whether all are well, so that none waits for one that has failed. While
/// they wait, --timeout says so.
class CarefulRanks final : public Ranks {
 public:
  explicit CarefulRanks(std::unique_ptr<Ranks> ranks) : ranks_(std::move(ranks)) {}

  [[nodiscard]] int number() const override { return ranks_->number(); }
  [[nodiscard]] int count() const override { return ranks_->count(); }
  /// \throws FailedElsewhere, as all that follow
  void keep_greatest(std::span<std::uint64_t> values) override;
  std::vector<Message> gather(Message message) override;
  Message broadcast(Message message) override;
  /// Waits for all others to come here, too.
  void meet();
  /// Tells the others, who are at any of the above, or come there. \returns whose failure counts: of several the one of
  /// the lowest rank.
  RunFailure fail(const RunFailure& failure);
  /// Waits for all others to come here, too, whether they are well or not.
  void part();

 private:
  /// \returns the failure of the lowest rank that has one; its status is exit_done where none has.
  RunFailure agree(const RunFailure& mine);
  void check();

  std::unique_ptr<Ranks> ranks_;
};

/// Replaces {rank} in a model's name by every number below `count`: a file for each rank. Names without it are read by
/// all. `settings` hold all of them afterwards. \returns the readers.
[[nodiscard]] std::vector<int> name_files_of_ranks(int count, Settings& settings);

/// Runs on all ranks that --mpi joins. Where it fails on one, it ends on all, and rank 0 says why.
/// \returns the exit status. \throws Error unsupported where there is no MPI
[[nodiscard]] int run_on_ranks(Settings settings, const std::function<int(const Settings&, const Team&)>& run);

}  // namespace frontmost::cli
