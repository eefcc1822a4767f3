// SPDX-License-Identifier: Apache-2.0
// A SceneReport as text and as JSON, and what its unit of length may be.
#pragma once

#include <frontmost/report.h>

#include <optional>
#include <string>

#include "cli/json.h"

namespace frontmost::cli {

/// How long a unit of the model is.
struct ModelUnit {
  double metres;
  bool is_guess;
};

/// The file's own or, where it says none, the one that is likely by its size. None: anything may be meant.
[[nodiscard]] std::optional<ModelUnit> unit_of_model(const SceneReport& report, std::optional<double> metres_per_unit);

[[nodiscard]] Json info_json(const SceneReport& report, const std::optional<ModelUnit>& unit);
[[nodiscard]] std::string info_text(const SceneReport& report, const std::optional<ModelUnit>& unit);

}  // namespace frontmost::cli
