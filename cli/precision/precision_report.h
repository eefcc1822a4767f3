// SPDX-License-Identifier: Apache-2.0
// Output of frontmost precision: text, JSON, and an SVG drawing of gaps against distance.
#pragma once

#include <frontmost/precision.h>
#include <frontmost/report.h>

#include <glm/glm.hpp>
#include <optional>
#include <string>

#include "cli/json.h"
#include "cli/settings.h"

namespace frontmost::cli {

/// Results for one depth buffer.
struct PrecisionResult {
  DepthSetup setup;
  std::optional<DepthFights> fights;  ///< with a model
  std::optional<FightAreas> areas;    ///< with a model, unless there are too many pairs
  std::string too_many;               ///< the reason if there are no areas
  /// Remedies; only with a model and a single buffer.
  std::vector<FightRemedy> remedies;
  std::vector<std::optional<OffsetRemedy>> offsets;  ///< for the first pairs of objects

  /// The greatest number of pairs of objects that are examined.
  static constexpr std::size_t pairs_shown = 10;
};

struct PrecisionRun {
  const Settings& settings;
  const Surfaces* surfaces = nullptr;  ///< null without a model
  std::optional<ObjectNames> names;    ///< empty without a model
  std::vector<PrecisionResult> results;
  std::vector<std::string> files;  ///< files that were written

  /// The greatest distance of the model's vertices from the eye or from the origin; empty without a model.
  std::optional<double> reach;

  [[nodiscard]] const ClipDistances& clip() const { return results.front().setup.clip; }
};

/// Returns the buffer's name, as in "D24" or "F32 reversed".
[[nodiscard]] std::string setup_name(const DepthSetup& setup);

[[nodiscard]] std::string precision_text(const PrecisionRun& run);
[[nodiscard]] Json precision_json(const PrecisionRun& run);

/// Draws gaps of common formats against distance. `chosen` is highlighted; without it, all lines look alike. `wanted`
/// is a gap and a distance to mark.
[[nodiscard]] std::string precision_plot(const ClipDistances& clip, bool orthographic,
                                         const std::optional<DepthSetup>& chosen,
                                         const std::optional<glm::dvec2>& wanted);

}  // namespace frontmost::cli
