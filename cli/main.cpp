// SPDX-License-Identifier: Apache-2.0
// frontmost: the command-line program. Selects the command, and turns exceptions into a message and an exit status.
#include <fmt/format.h>
#include <frontmost/version.h>

#include <algorithm>
#include <filesystem>
#include <new>
#include <vector>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/failure.h"
#include "cli/values.h"
#include "cli/view/view_options.h"

namespace frontmost::cli {
namespace {

using Arguments = std::span<const char* const>;

bool asks_for_help(const Arguments& words) {
  for (const std::string_view word : words) {
    if (word == "--") return false;
    if (word == "--help" || word == "-h") return true;
  }
  return false;
}

[[noreturn]] void complain_of_command(std::string_view word) {
  std::vector<std::string_view> names;
  for (const Command& command : commands()) names.push_back(command.name);
  std::error_code ignored;
  if (word.substr(0, 8) == "builtin:" || std::filesystem::exists(word, ignored)) {
    throw UsageError(fmt::format("'{}' is not a command; did you mean 'frontmost render {}'?", word, word));
  }
  const std::string_view nearest = nearest_word(word, names);
  if (nearest.empty()) throw UsageError(fmt::format("unknown command '{}'; see frontmost --help", word));
  throw UsageError(fmt::format("unknown command '{}'; did you mean '{}'?", word, nearest));
}

int run_command(const Command& command, Settings settings) {
  if (!command.bit) return command.run(settings);
  // Signals are caught before the first file is read, which may be a pipe that nobody writes to.
  catch_interruptions(settings.run.timeout);
  try {
    read_pose_file(settings.view);
    return command.run(settings);
  } catch (const Error& error) {
    throw with_culprit(error, settings);
  } catch (const UsageError&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw with_culprit({ErrorCode::limit_exceeded, "out of memory"}, settings);
  } catch (const std::exception& error) {
    throw with_culprit({ErrorCode::unsupported, error.what()}, settings);
  }
}

int dispatch(Arguments words) {
  if (words.empty()) throw UsageError("no command given; see frontmost --help");
  const std::string_view first = words[0];
  if (first == "--version") {
    print("frontmost " FRONTMOST_VERSION "\n");
    return exit_done;
  }
  if (first == "help" && words.size() > 1) {
    words = words.subspan(1);
    const Command* const command = find_command(words[0]);
    if (!command) complain_of_command(words[0]);
    print(help_for(*command));
    return exit_done;
  }
  if (first == "--help" || first == "-h" || first == "help") {
    print(help_overview());
    return exit_done;
  }
  const Command* const command = find_command(first);
  if (!command) complain_of_command(first);
  if (asks_for_help(words.subspan(1))) {
    print(help_for(*command));
    return exit_done;
  }
  return run_command(*command, parse_command_line(*command, words.subspan(1)));
}

int run(const Arguments& words) {
  try {
    return dispatch(words);
  } catch (const UsageError& error) {
    complain(error.what());
    return exit_usage;
  } catch (const Error& error) {
    if (error.code() == ErrorCode::cancelled) return report_interruption();
    complain(error.what());
  } catch (const std::bad_alloc&) {
    complain("out of memory");
  } catch (const std::exception& error) {
    complain(error.what());
  }
  return exit_could_not;
}

}  // namespace
}  // namespace frontmost::cli

int main(int count, char** words) {
  return frontmost::cli::run({words + std::min(count, 1), std::size_t(std::max(count - 1, 0))});
}
