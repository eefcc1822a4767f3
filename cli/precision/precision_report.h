// SPDX-License-Identifier: Apache-2.0
// What frontmost precision found out: as text, as JSON, and as an SVG drawing of gaps against distance.
#pragma once

#include <frontmost/precision.h>
#include <frontmost/report.h>

#include <glm/glm.hpp>
#include <optional>
#include <string>

#include "cli/json.h"
#include "cli/settings.h"

namespace frontmost::cli {

/// One depth buffer.
struct PrecisionResult {
  DepthSetup setup;
  std::optional<DepthFights> fights;  ///< with a model
  std::optional<FightAreas> areas;    ///< likewise, but where there are too many
  std::string too_many;               ///< why there are no areas
  /// With a model, of a single buffer.
  std::vector<FightRemedy> remedies;
  std::vector<std::optional<OffsetRemedy>> offsets;  ///< of the first pairs of objects

  /// How many pairs of objects are looked into.
  static constexpr std::size_t pairs_shown = 10;
};

struct PrecisionRun {
  const Settings& settings;
  const Surfaces* surfaces = nullptr;  ///< null without a model
  std::optional<ObjectNames> names;    ///< none without a model
  std::vector<PrecisionResult> results;
  std::vector<std::string> files;  ///< that were written

  /// How far corners of the model lie from the eye or from the origin, whichever is more; none without a model.
  std::optional<double> reach;

  [[nodiscard]] const ClipDistances& clip() const { return results.front().setup.clip; }
};

/// "D24", "F32 reversed".
[[nodiscard]] std::string setup_name(const DepthSetup& setup);

[[nodiscard]] std::string precision_text(const PrecisionRun& run);
[[nodiscard]] Json precision_json(const PrecisionRun& run);

/// `chosen` stands out from the formats in use; none: all are drawn alike. `wanted`: a gap and a distance to mark.
[[nodiscard]] std::string precision_plot(const ClipDistances& clip, bool orthographic,
                                         const std::optional<DepthSetup>& chosen,
                                         const std::optional<glm::dvec2>& wanted);

}  // namespace frontmost::cli
