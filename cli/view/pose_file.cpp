// SPDX-License-Identifier: Apache-2.0
// Camera poses in files: 16 numbers with any separators.
#include <fmt/format.h>
#include <frontmost/files.h>

#include <filesystem>

#include "cli/failure.h"
#include "cli/values.h"
#include "cli/view/view_options.h"

namespace frontmost::cli {
namespace {

/// A pose takes a few hundred characters; anything much longer is another kind of file.
constexpr std::uint64_t largest_pose_file = 1 << 16;

glm::dmat4 pose_in(const std::string& text, const std::string& path) {
  std::vector<double> values;
  std::size_t number = 0;
  const auto refuse = [&](const std::string& place, const std::string& why) {
    throw Error(ErrorCode::file_malformed, path, place, why);
  };
  for (std::string_view line : split(text, '\n')) {
    const std::string place = fmt::format("line {}", ++number);
    try {
      for (std::string_view word = take_matrix_word(line); !word.empty(); word = take_matrix_word(line))
        values.push_back(parse_number(word, {-1e300, 1e300}));
    } catch (const UsageError& error) {
      refuse(place, error.what());
    }
    if (values.size() > 16) refuse(place, "more than 16 numbers");
  }
  try {
    return matrix_of(std::move(values));
  } catch (const UsageError& error) {
    refuse("", error.what());
  }
  return {};
}

}  // namespace

void read_pose_file(ViewSettings& settings) {
  if (!settings.pose_file || settings.pose) return;
  const std::string& path = *settings.pose_file;
  std::error_code ignored;
  if (path != "-" && !std::filesystem::exists(path, ignored))
    throw UsageError(fmt::format("--pose: {} is neither 16 numbers nor a file that can be read", cli::quoted(path)));
  settings.pose = pose_in(load_text(path, largest_pose_file), path);
}

}  // namespace frontmost::cli
