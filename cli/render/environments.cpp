// SPDX-License-Identifier: Apache-2.0
#include "cli/render/environments.h"

#include <frontmost/files.h>

namespace frontmost::cli {
namespace {

Environment make(const std::string& name, const Execution& execution) {
  if (name == "studio") return Environment::studio(execution);
  if (name == "sky") return Environment::sky(execution);
  if (name == "none") return Environment::none();
  Image picture = load_environment(name);
  try {
    return Environment(std::move(picture), execution);
  } catch (const Error& error) {
    if (error.code() == ErrorCode::cancelled) throw;
    throw error.within(name);
  }
}

}  // namespace

LightOptions Environments::light(const LightSettings& settings, const Execution& execution) {
  LightOptions options = settings.options;
  if (!settings.environment) return options;  // the shader uses its studio
  auto found = made_.find(*settings.environment);
  if (found == made_.end()) found = made_.emplace(*settings.environment, make(*settings.environment, execution)).first;
  options.environment = found->second;
  return options;
}

}  // namespace frontmost::cli
