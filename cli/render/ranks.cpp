// SPDX-License-Identifier: Apache-2.0
// A rank that fails would leave the others waiting for it. So before each common operation, the ranks check whether one
// has failed, by a maximum of small integers; then all end with that rank's message:
//
//   rank 0   ... agree, greatest, ... agree  <- waits       : all are well but rank 2 -> its message -> all end
//   rank 1   ... agree, greatest, ... agree  <- waits       :
//   rank 2   ... agree, greatest, throws, fail() -> agree   :
//
// A rank that crashes cannot report it; the launcher of the ranks, such as mpirun, ends the others. Files appear only
// when they are complete, so none is left half written.
#include "cli/render/ranks.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <frontmost/version.h>

#include <filesystem>

#include "cli/console.h"
#include "cli/mpi/ranks_module.h"
#include "cli/render/file_hash.h"

namespace frontmost::cli {
namespace {

std::unique_ptr<Ranks> join_mpi() {
  std::error_code ignored;
  const std::filesystem::path beside = std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path();
  for (const std::filesystem::path& folder : {beside, (beside / FRONTMOST_MODULES).lexically_normal()}) {
    const std::filesystem::path path = folder / mpi_module;
    if (!std::filesystem::exists(path, ignored)) continue;
    // MPI's own modules look up its symbols globally, hence RTLD_GLOBAL.
    void* const module = dlopen(path.c_str(), RTLD_NOW | RTLD_GLOBAL);
    void* const join = module ? dlsym(module, join_function) : nullptr;
    if (!join) throw Error(ErrorCode::unsupported, "--mpi", dlerror());
    const WaitingForRanks waiting;
    return std::unique_ptr<Ranks>(reinterpret_cast<JoinRanks>(join)());
  }
  throw Error(ErrorCode::unsupported,
              fmt::format("--mpi: {} is missing; install the package frontmost-mpi, or build with -DFRONTMOST_MPI=ON",
                          (beside / FRONTMOST_MODULES / mpi_module).lexically_normal().string()));
}

Ranks::Message message_of(std::string_view text) {
  const auto* first = reinterpret_cast<const std::byte*>(text.data());
  return {first, first + text.size()};
}

std::string text_of(const Ranks::Message& message) {
  return {reinterpret_cast<const char*>(message.data()), message.size()};
}

/// Returns a hash of all settings that determine the messages between ranks.
std::uint64_t hash_of(const Settings& settings) {
  RunningHash hash;
  hash.add(settings.said);
  hash.add(FRONTMOST_VERSION);
  hash.add(std::uint64_t(settings.run.json) << 1 | std::uint64_t(settings.output.hash));
  hash.add(settings.run.batch.value_or(""));
  hash.add(settings.model);
  for (const std::string& model : settings.more_models) hash.add(model);
  return hash.value();
}

/// Checks that all ranks run the same command. Ranks with another command would send messages that do not fit.
void check_same_command(const Settings& settings, Ranks& ranks) {
  const std::uint64_t hash = hash_of(settings);
  std::uint64_t ends[2] = {hash, ~hash};
  ranks.keep_greatest(ends);
  if (ends[0] == hash && ends[1] == ~hash) return;
  throw UsageError(
      "--mpi: the ranks have different command lines or different versions of frontmost; start all of them alike");
}

/// Returns the current exception as the program would report it. Must be called in a handler. Interruptions are
/// rethrown, because the signal that stops one rank stops all.
RunFailure current_failure(const Settings& settings) {
  try {
    throw;
  } catch (const UsageError& error) {
    return {exit_usage, error.what()};
  } catch (const Error& error) {
    if (error.code() == ErrorCode::cancelled) throw;
    return {exit_could_not, with_culprit(error, settings).what()};
  } catch (const std::bad_alloc&) {
    return {exit_could_not, with_culprit({ErrorCode::limit_exceeded, "out of memory"}, settings).what()};
  } catch (const std::exception& error) {
    return {exit_could_not, with_culprit({ErrorCode::unsupported, error.what()}, settings).what()};
  }
}

int run_carefully(const Settings& settings, CarefulRanks& ranks, const std::function<int()>& run) {
  RunFailure failure;
  try {
    const int status = run();
    ranks.meet();
    return status;
  } catch (const FailedElsewhere& elsewhere) {
    failure = elsewhere.failure();
  } catch (...) {
    RunFailure mine = current_failure(settings);
    if (ranks.number() > 0) mine.message += fmt::format(" (rank {})", ranks.number());
    failure = ranks.fail(mine);
  }
  if (ranks.number() == 0) complain(failure.message);
  // The launcher ends all ranks when one ends with an error, so all ranks wait until the message is printed.
  ranks.part();
  return failure.status;
}

}  // namespace

RunFailure CarefulRanks::agree(const RunFailure& mine) {
  const WaitingForRanks waiting;
  // The urgency is greatest for the lowest rank that failed.
  std::uint64_t urgency = mine.status == exit_done ? 0 : std::uint64_t(count() - number());
  ranks_->keep_greatest({&urgency, 1});
  if (urgency == 0) return {exit_done, {}};
  const auto first = std::size_t(count()) - std::size_t(urgency);
  std::vector<Message> messages = ranks_->gather(message_of(fmt::format("{} {}", mine.status, mine.message)));
  const std::string told = text_of(ranks_->broadcast(messages.empty() ? Message() : std::move(messages[first])));
  const std::size_t space = told.find(' ');
  return {std::stoi(told.substr(0, space)), told.substr(space + 1)};
}

void CarefulRanks::check() {
  RunFailure failure = agree({exit_done, {}});
  if (failure.status != exit_done) throw FailedElsewhere(std::move(failure));
}

void CarefulRanks::keep_greatest(std::span<std::uint64_t> values) {
  check();
  const WaitingForRanks waiting;
  ranks_->keep_greatest(values);
}

std::vector<Ranks::Message> CarefulRanks::gather(Message message) {
  check();
  const WaitingForRanks waiting;
  return ranks_->gather(std::move(message));
}

Ranks::Message CarefulRanks::broadcast(Message message) {
  check();
  const WaitingForRanks waiting;
  return ranks_->broadcast(std::move(message));
}

void CarefulRanks::meet() { check(); }

RunFailure CarefulRanks::fail(const RunFailure& failure) { return agree(failure); }

void CarefulRanks::part() {
  const WaitingForRanks waiting;
  std::uint64_t nothing = 0;
  ranks_->keep_greatest({&nothing, 1});
}

std::vector<int> name_files_of_ranks(int count, Settings& settings) {
  constexpr std::string_view place = "{rank}";
  std::vector<std::string> given = std::move(settings.more_models), names;
  given.insert(given.begin(), settings.model);
  std::vector<int> readers;
  for (const std::string& name : given) {
    const bool is_one_each = name.find(place) != std::string::npos;
    for (int rank = 0; rank < (is_one_each ? count : 1); ++rank) {
      std::string own = name;
      for (std::size_t at = 0; (at = own.find(place, at)) != std::string::npos;)
        own.replace(at, place.size(), std::to_string(rank));
      names.push_back(std::move(own));
      readers.push_back(is_one_each ? rank : -1);
    }
  }
  settings.model = names.front();
  settings.more_models.assign(names.begin() + 1, names.end());
  return readers;
}

int run_on_ranks(Settings settings, const std::function<int(const Settings&, const Team&)>& run) {
  CarefulRanks ranks(join_mpi());
  const Settings given = settings;
  const Team team{&ranks, name_files_of_ranks(ranks.count(), settings)};
  if (!team.is_first()) settings.run.quiet = true;
  return run_carefully(settings, ranks, [&] {
    check_same_command(given, ranks);
    return run(settings, team);
  });
}

}  // namespace frontmost::cli
