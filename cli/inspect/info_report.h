// SPDX-License-Identifier: Apache-2.0
// A SceneReport as text and as JSON.
#pragma once

#include <frontmost/report.h>

#include <string>

#include "cli/json_numbers.h"

namespace frontmost::cli {

[[nodiscard]] Json info_json(const SceneReport& report);
[[nodiscard]] std::string info_text(const SceneReport& report);

}  // namespace frontmost::cli
