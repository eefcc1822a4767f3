// SPDX-License-Identifier: Apache-2.0
// The environments that light the views of a run. Each is read or made once.
#pragma once

#include <frontmost/pictures.h>

#include <map>
#include <string>

#include "cli/settings.h"

namespace frontmost::cli {

class Environments {
 public:
  /// Returns the light of pictures, with its environment. \throws Error as load_environment() and Environment do,
  /// naming the file.
  [[nodiscard]] LightOptions light(const LightSettings& settings, const Execution& execution);

 private:
  std::map<std::string, Environment> made_;  ///< by name on the command line
};

}  // namespace frontmost::cli
