// SPDX-License-Identifier: Apache-2.0
// A run on several ranks: one of them writes files and messages, and all end with the same status.
#pragma once

#include <frontmost/streams.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "cli/failure.h"
#include "cli/settings.h"

namespace frontmost::cli {

/// The ranks that stream a model together.
struct Team {
  Ranks* ranks = nullptr;    ///< null: no other ranks
  std::vector<int> readers;  ///< as StreamOptions::readers

  [[nodiscard]] bool is_first() const { return !ranks || ranks->number() == 0; }
};

/// The reason why a run failed, and the program's exit status.
struct RunFailure {
  int status = exit_could_not;
  std::string message;
};

/// Thrown on a rank if another rank has failed.
class FailedElsewhere : public std::exception {
 public:
  explicit FailedElsewhere(RunFailure failure) : failure_(std::move(failure)) {}
  [[nodiscard]] const RunFailure& failure() const { return failure_; }

 private:
  RunFailure failure_;
};

/// Ranks that check before each operation that none of them has failed, so that none waits in vain. While they wait,
/// the message of --timeout mentions this.
class CarefulRanks final : public Ranks {
 public:
  explicit CarefulRanks(std::unique_ptr<Ranks> ranks) : ranks_(std::move(ranks)) {}

  [[nodiscard]] int number() const override { return ranks_->number(); }
  [[nodiscard]] int count() const override { return ranks_->count(); }
  /// Keeps the greatest of each value over all ranks. \throws FailedElsewhere, as do gather(), broadcast() and meet().
  void keep_greatest(std::span<std::uint64_t> values) override;
  std::vector<Message> gather(Message message) override;
  Message broadcast(Message message) override;
  /// Waits until all ranks call it.
  void meet();
  /// Tells the other ranks about a failure, when they call one of the functions above. \returns the failure of the
  /// lowest failed rank.
  RunFailure fail(const RunFailure& failure);
  /// Waits until all ranks call it, whether they failed or not.
  void part();

 private:
  /// Waits until all ranks call it. \returns the failure of the lowest failed rank; status exit_done if there is none.
  RunFailure agree(const RunFailure& mine);
  void check();

  std::unique_ptr<Ranks> ranks_;
};

/// Replaces {rank} in a model's name by each number below `count`, so that each rank reads a file of its own. All ranks
/// read a name without {rank}. `settings` hold all names afterwards. \returns the readers.
[[nodiscard]] std::vector<int> name_files_of_ranks(int count, Settings& settings);

/// Runs on all ranks that --mpi joins. If one fails, all end, and rank 0 prints the reason.
/// \returns the exit status. \throws Error unsupported if MPI is not available.
[[nodiscard]] int run_on_ranks(Settings settings, const std::function<int(const Settings&, const Team&)>& run);

}  // namespace frontmost::cli
