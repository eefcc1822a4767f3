// SPDX-License-Identifier: Apache-2.0
#include "cli/failure.h"

namespace frontmost::cli {

bool names_culprit(std::string_view message) {
  const std::string_view first = message.substr(0, message.find(": "));
  if (first.starts_with("standard ") || first.starts_with("-") || first.starts_with("builtin:")) return true;
  // No value and no method has these in its name, and hardly a file has not.
  return first.find_first_of("./") != std::string_view::npos;
}

std::string with_culprit(const std::string& message, const Settings& settings) {
  if (names_culprit(message) || settings.model.empty() || message.starts_with(settings.model + ": ")) return message;
  const bool is_of_pose = message.starts_with("pose: ") && settings.view.pose;
  const std::string culprit = !is_of_pose               ? settings.model
                              : settings.view.pose_file ? *settings.view.pose_file
                                                        : std::string("--pose");
  return culprit + ": " + message;
}

}  // namespace frontmost::cli
