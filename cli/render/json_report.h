// SPDX-License-Identifier: Apache-2.0
// The report of a run of `frontmost render`: JSON, or lines of hashes.
//
//   {"model": ..., "triangles": ...,            one view: its facts stand beside those of the model
//    "name": ..., "view": {...}, "seen": {...}, "files": [...], "timings_ms": {...}}
//
//   {"model": ..., "triangles": ...,            a batch: facts by view
//    "views": [{"name": ..., "view": {...}, ...}, ...], "timings_ms": {...}}
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/json.h"
#include "cli/render/render_view.h"

namespace frontmost::cli {

/// Milliseconds of the steps that all views share.
struct RunTimings {
  double load = 0, surfaces = 0, total = 0;
  std::optional<double> index;  ///< for the method raycast
};

/// Facts about the model.
struct ModelFacts {
  std::uint64_t triangles = 0;
  const std::vector<std::string>& warnings;
  bool lets_light_through = false;                            ///< whether some materials blend
  std::optional<int> passes = std::nullopt;                   ///< passes over a stream
  glm::dvec3 origin{0};                                       ///< the scene's origin
  std::size_t lights = 0;                                     ///< number of the scene's own lights
  std::optional<std::size_t> finished_before = std::nullopt;  ///< views of a shard that an earlier run finished
};

/// Returns the report of one view or of a batch. The facts of a single view are at the top level, those of a batch
/// under "views". Precondition: exactly one job for each view.
[[nodiscard]] Json render_json(const Settings& settings, const ModelFacts& model, const std::vector<Job>& jobs,
                               const std::vector<ViewResult>& views, const RunTimings& timings);
/// Returns a line "what HASH path" for each result, "visible HASH" first. Lines of a batch begin with "view:".
[[nodiscard]] std::string hash_lines(const std::vector<ViewResult>& views, bool is_batch);

}  // namespace frontmost::cli
